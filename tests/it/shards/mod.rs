//! A study in pieces, as a user runs it: by hand, by Slurm, GNU Parallel and Snakemake, with pieces that are killed. Whoever
//! runs it, what is published is what one run publishes, byte for byte.

mod busy;
mod kills;
mod parallel;
mod slurm;
mod snakemake;

use std::env;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use serde_json::Value;

use crate::desk::Desk;
use crate::reliability::published::{Published, differences, published};

/// A study of 128 parts, each some milliseconds.
const SWEPT: &str = "\
study: swept
seed: 1
stages:
  pair:
    kind: geometry
    module: 3 mm
    pinion: { teeth: 24, face_width: 20 mm, bore_radius: 18 mm }
    gear: { teeth: 36, face_width: 20 mm, bore_radius: 28 mm }
  stiffness: { kind: stiffness, pair: pair, method: energy, contact: linear }
  designs:
    kind: modification
    pair: pair
    designs:
      unmodified: []
      short:
        - tip_relief: { gear: both, amount: 12 um, fraction: 0.5, curve: linear }
  ste: { kind: ste, stiffness: stiffness, designs: designs, torque: { from: 50 N m, to: 250 N m, count: 128 } }
  report:
    kind: report
    published:
      - label: Relief helps at the largest torque
        claim: short <= unmodified
        with:
          short: ste.summary[design=short, torque=250 N m].peak_to_peak
          unmodified: ste.summary[design=unmodified, torque=250 N m].peak_to_peak
    figures:
      - { name: torque, title: Peak-to-peak over torque, table: ste.summary, x: torque, y: peak_to_peak, series: design }
";

fn swept() -> Desk {
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("swept.yaml"), SWEPT).unwrap();
    desk
}

/// What one run publishes.
fn local() -> &'static Published {
    static LOCAL: OnceLock<Published> = OnceLock::new();
    LOCAL.get_or_init(|| {
        let desk = swept();
        desk.run(&["run", "swept.yaml", "--quiet"], 0);
        published(&desk.path("results/swept"))
    })
}

/// # Panics
/// When what is published is not what one run publishes, or there is nothing.
fn assert_as_local(desk: &Desk) {
    let now = published(&desk.path("results/swept"));
    assert!(
        now.len() > 10 && now.contains_key("ste.curve.parquet") && now.contains_key("swept.h5"),
        "{:?}",
        now.keys()
    );
    let differing = differences(local(), &now);
    assert!(differing.is_empty(), "{differing:?}");
}

fn shards_there(desk: &Desk, folder: &str) -> usize {
    let (out, _) = desk.run(&["shard", "status", folder, "--json"], 0);
    serde_json::from_str::<Value>(&out).unwrap()["sound"].as_array().unwrap().len()
}

/// Whether all of these programs are there; where one is not, the check is skipped, loudly, and in continuous integration
/// it fails.
fn installed(check: &str, programs: &[&str], packages: &str) -> bool {
    let on_path = |program: &&&str| {
        let folders = env::var_os("PATH").unwrap_or_default();
        env::split_paths(&folders).chain([PathBuf::from("/usr/sbin")]).any(|folder| folder.join(program).is_file())
    };
    let missing: Vec<&&str> = programs.iter().filter(|program| !on_path(program)).collect();
    if missing.is_empty() {
        return true;
    }
    skipped(&format!("{check}: {missing:?} missing; `make setup` installs them (Debian: {packages})"));
    false
}

/// Past the capture of a test that passes: nobody shall take this for a check that was made.
fn skipped(why: &str) {
    assert!(env::var_os("CI").is_none_or(|set| set.is_empty()), "{why}");
    std::io::stderr().write_all(format!("\nSKIPPED: {why}\n").as_bytes()).unwrap();
}

fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_gearstudy"))
}

#[test]
fn pieces_by_hand_in_any_order_are_one_run() {
    let desk = swept();
    let (out, _) = desk.run(&["shard", "plan", "swept.yaml", "--shards", "6", "--into", "plan"], 0);
    assert!(out.contains("swept: planned: 6 shards, ") && out.contains("gearstudy shard merge plan"), "{out}");
    let (_, error) = desk.run(&["shard", "merge", "plan"], 1);
    assert!(error.contains("of 6 shards in `plan` 6 missing (0-5)"), "{error}");
    assert!(!desk.path("results").exists(), "nothing is published in part");
    for index in ["5", "0", "3", "1", "2"] {
        desk.run(&["shard", "run", "plan", index, "--quiet"], 0);
    }
    let (out, _) = desk.run(&["shard", "status", "plan"], 0);
    assert_eq!(out, "swept: 5 of 6 shards are there, 1 missing (4)\n");
    assert_eq!(desk.run(&["shard", "status", "plan", "--missing"], 0).0, "4\n");
    // Two at once.
    let start = || {
        std::process::Command::new(program())
            .args(["shard", "run", "plan", "4", "--quiet"])
            .current_dir(desk.path(""))
            .spawn()
            .unwrap()
    };
    let children = [start(), start()];
    for mut child in children {
        assert!(child.wait().unwrap().success());
    }
    assert_eq!(fs::read_dir(desk.path("plan/shards")).unwrap().count(), 6, "and nothing beside them");
    let (out, _) = desk.run(&["shard", "run", "plan", "4"], 0);
    assert!(out.contains("nothing to do"), "{out}");
    desk.run(&["shard", "merge", "plan"], 0);
    assert_as_local(&desk);
    assert!(desk.ran("swept").contains(&"report".to_owned()));
    let (out, _) = desk.run(&["run", "swept.yaml"], 0);
    assert!(out.contains("nothing to do"), "a run finds all of it: {out}");
    let (out, _) = desk.run(&["shard", "merge", "plan"], 0);
    assert!(out.contains("128 parts of 6 shards"), "again, and no harm done: {out}");
    // A folder keeps its plan; what was computed once is not planned again.
    let (out, _) = desk.run(&["shard", "plan", "swept.yaml", "--shards", "9", "--into", "plan"], 0);
    assert!(out.contains("was planned already: 6 shards"), "{out}");
    let (_, error) = desk.run(&["shard", "plan", "quick.yaml", "--shards", "9", "--into", "plan"], 1);
    assert!(error.contains("`plan` has a plan of `swept`, of another study"), "{error}");
    let (out, _) = desk.run(&["shard", "plan", "swept.yaml", "--shards", "9", "--into", "second"], 0);
    assert!(out.contains("nothing is left to compute"), "{out}");
}

#[test]
fn what_cannot_be_is_told() {
    let desk = swept();
    let (_, error) = desk.run(&["shard", "run", "plan", "0"], 1);
    assert!(error.contains("`plan` has no plan; `shard plan STUDY --into` makes one"), "{error}");
    desk.run(&["shard", "plan", "swept.yaml", "--shards", "3", "--into", "plan", "--manifest", "gearstudy:0.1"], 0);
    let (_, error) = desk.run(&["shard", "run", "plan", "3"], 1);
    assert!(error.contains("there is no shard 3; the plan has 0 to 2"), "{error}");
    let (_, error) = desk.run(&["shard", "run", "plan", "0", "--limit-rows", "10"], 2);
    assert!(error.contains("rows"), "{error}");
    assert_eq!(shards_there(&desk, "plan"), 0);
    // A plan of another program.
    let plan = fs::read_to_string(desk.path("plan/plan.json")).unwrap();
    let code = serde_json::from_str::<Value>(&plan).unwrap()["code"].as_str().unwrap().to_owned();
    fs::write(desk.path("plan/plan.json"), plan.replace(&code, &code.chars().rev().collect::<String>())).unwrap();
    for words in [&["shard", "run", "plan", "0"][..], &["shard", "merge", "plan"]] {
        let (_, error) = desk.run(words, 1);
        assert!(error.contains("built from other sources"), "{error}");
    }
    let (_, error) = desk.run(&["run", "swept.yaml", "--engine", "slrum"], 1);
    assert!(error.contains("slurm"), "{error}");
    let (_, error) = desk.run(&["run", "swept.yaml", "--shards", "3"], 1);
    assert!(error.contains("--engine"), "{error}");
    fs::write(desk.path("site.yaml"), "partitoin: main\n").unwrap();
    let (_, error) = desk.run(&["run", "swept.yaml", "--engine", "slurm", "--profile", "site.yaml"], 2);
    assert!(
        error.contains("site.yaml:1:1: unknown field `partitoin` of the profile\n  help: did you mean `partition`?"),
        "{error}"
    );
}

/// The manifest is what Kubernetes' documentation says of indexed jobs; there is no cluster here.
#[test]
fn the_manifest_names_every_shard_once() {
    let desk = swept();
    desk.run(&["shard", "plan", "swept.yaml", "--shards", "5", "--into", "plan", "--manifest", "a/b:1"], 0);
    let text = fs::read_to_string(desk.path("plan/job.yaml")).unwrap();
    let Some(out) = crate::python::run("manifest.py", &[desk.path("plan/job.yaml").as_os_str()]) else { return };
    assert_eq!(out.trim(), "1 job, 5 completions, first 0, image a/b:1", "{text}");
}
