//! The program as a user runs it: real commands on real studies in an empty folder.

mod bad;
mod checkout;
mod clones;
mod completions;
mod diff;
mod disk;
mod editor;
mod ended;
mod git;
mod identity;
mod json;
mod limits;
mod places;
mod python;
mod readme;
mod set;
mod status;
mod stubborn;
mod texts;
mod trust;
mod unread;
mod warnings;
mod watch;
mod work;

use std::fs;

use serde_json::Value;

use crate::desk::Desk;

#[test]
fn a_study_runs_once_and_then_there_is_nothing_to_do() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml"], 0);
    let results = desk.path("results/quick");
    for file in ["manifest.json", "report.html", "quick.h5", "ste.summary.parquet", "stiffness.curve.parquet"] {
        assert!(results.join(file).is_file(), "{file} is missing");
    }
    assert!(fs::read_dir(results.join("figures")).is_ok_and(|mut figures| figures.next().is_some()));
    let before = fs::read(results.join("manifest.json")).unwrap();
    let (out, _) = desk.run(&["run", "quick.yaml"], 0);
    assert!(out.contains("nothing to do"), "{out}");
    assert_eq!(before, fs::read(results.join("manifest.json")).unwrap(), "a run with nothing to do rewrites nothing");
}

#[test]
fn a_figure_that_is_no_more_is_removed_and_what_is_not_ours_stays() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml"], 0);
    fs::write(desk.path("results/quick/figures/notes.txt"), "mine").unwrap();
    fs::write(desk.path("results/quick/notes.txt"), "mine").unwrap();
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let renamed = text.replace("- name: torque\n", "- name: sweep\n").replace("  optimum:\n", "  found:\n");
    let renamed = renamed.replace("designs: [designs, optimum]", "designs: [designs, found]");
    fs::write(desk.path("quick.yaml"), renamed).unwrap();
    desk.run(&["run", "quick.yaml"], 0);
    let there = |name: &str| desk.path("results/quick").join(name).exists();
    assert!(there("figures/sweep.svg") && !there("figures/torque.svg"));
    assert!(there("found.best.parquet") && !there("optimum.best.parquet"));
    assert!(there("figures/notes.txt") && there("notes.txt"));
}

#[test]
fn an_added_torque_touches_only_what_depends_on_it() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml"], 0);
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let more = text
        .replace("{ from: 50 N m, to: 250 N m, count: 5 }", "[50 N m, 100 N m, 150 N m, 200 N m, 250 N m, 300 N m]");
    assert_ne!(text, more);
    fs::write(desk.path("quick.yaml"), more).unwrap();
    let (plan, _) = desk.run(&["plan", "quick.yaml"], 0);
    assert!(plan.contains("1 of 6"), "the plan says that one chunk of six is missing:\n{plan}");
    desk.run(&["run", "quick.yaml"], 0);
    // The report reads the table at 150 N m, whose content has one row more.
    assert_eq!(desk.ran("quick"), ["ste", "report"]);
}

#[test]
fn one_and_three_threads_give_the_same_contents() {
    let contents = |jobs: &str| {
        let desk = Desk::with("quick.yaml");
        desk.run(&["run", "quick.yaml", "--jobs", jobs], 0);
        desk.contents("quick")
    };
    let one = contents("1");
    assert!(one.len() > 8);
    assert_eq!(one, contents("3"));
}

#[test]
fn tables_are_printed_and_filtered() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let (csv, _) = desk.run(
        &[
            "table",
            "quick.yaml",
            "ste.summary",
            "--where",
            "design=unmodified",
            "--where",
            "torque=100 N m",
            "--columns",
            "design,torque,peak_to_peak",
            "--format",
            "csv",
        ],
        0,
    );
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines.len(), 2, "{csv}");
    assert_eq!(lines[0], "design,torque [N m],peak_to_peak [um]");
    assert!(lines[1].starts_with("unmodified,100,"), "{csv}");
    let (json, _) = desk.run(&["table", "quick.yaml", "optimum.best", "--format", "json"], 0);
    assert!(serde_json::from_str::<Value>(&json).unwrap().as_array().is_some_and(|rows| rows.len() == 1));
    let (list, _) = desk.run(&["table", "quick.yaml"], 0);
    assert!(list.contains("ste.curve") && list.contains("stiffness.summary"), "{list}");
    let (_, error) = desk.run(&["table", "quick.yaml", "ste.sumary"], 1);
    assert!(error.contains("did you mean `ste.summary`"), "{error}");
    let (_, error) = desk.run(&["table", "quick.yaml", "ste.summary", "--where", "torque>55"], 1);
    assert!(error.contains("`gearstudy query \"select * from … where torque>55\"`"), "{error}");
}

#[test]
fn a_word_that_names_nothing_ends_with_1_whatever_it_should_name() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    for words in [
        &["table", "r1x"][..],
        &["table", "quick.yaml", "r1x"],
        &["run", "r1x"],
        &["run", "quik.yaml"],
        &["run", "quick.yaml", "--only", "r1x"],
        &["check", "r1x"],
        &["check", "r1x.yaml", "--format", "json"],
        &["report", "r1x"],
        &["status", "r1x"],
        &["status", "r1x", "quick.yaml", "r1y"],
        &["diff", "r1x"],
        &["archive", "r1x", "-o", "r1x.zip"],
        &["kinds", "r1x"],
    ] {
        desk.run(words, 1);
    }
    // A study that is there and invalid is another matter.
    fs::write(desk.path("bad.yaml"), "study: bad\n").unwrap();
    for words in [&["table", "bad.yaml"][..], &["check", "bad.yaml", "r1x"], &["status", "r1x", "bad.yaml"]] {
        desk.run(words, 2);
    }
}

#[test]
fn what_is_computed_on_demand_can_be_asked_for() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml"], 0);
    desk.run(&["table", "quick.yaml", "stiffness.iso6336"], 1);
    desk.run(&["run", "quick.yaml", "--want", "stiffness.iso6336,ste.summary.largest_pressure"], 0);
    let (iso, _) = desk.run(&["table", "quick.yaml", "stiffness.iso6336", "--format", "csv"], 0);
    assert!(iso.starts_with("theoretical [N/(mm um)]") && iso.lines().count() == 2, "{iso}");
    let (pressure, _) = desk.run(&["table", "quick.yaml", "ste.summary", "--columns", "largest_pressure"], 0);
    assert!(pressure.contains("largest_pressure [MPa]"), "{pressure}");
    let (_, error) = desk.run(&["plan", "quick.yaml", "--want", "stiffness.iso633"], 1);
    assert!(error.contains("known here: ") && error.contains("`iso6336`"), "{error}");
    desk.run(&["plan", "quick.yaml", "--want", "stiffness"], 1);
}

#[test]
fn only_force_and_dry_run_do_what_they_say() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml", "--dry-run"], 0);
    assert!(!desk.path("results").exists() && !desk.path(".gearstudy").exists(), "a dry run writes nothing");
    desk.run(&["run", "quick.yaml", "--only", "stiffness"], 0);
    assert_eq!(desk.ran("quick"), ["pair", "stiffness"]);
    desk.run(&["run", "quick.yaml"], 0);
    let before = desk.contents("quick");
    let (out, _) = desk.run(&["run", "quick.yaml", "--force", "--explain"], 0);
    assert!(out.contains("forced"), "{out}");
    assert_eq!(before, desk.contents("quick"), "computing again gives the same contents");
    let (_, error) = desk.run(&["run", "quick.yaml", "--only", "stifness"], 1);
    assert!(error.contains("did you mean `stiffness`"), "{error}");
}

#[test]
fn results_and_cache_go_where_they_are_told() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml", "--results", "out", "--cache", "kept"], 0);
    assert!(desk.path("out/quick/report.html").is_file() && desk.path("kept").is_dir());
    assert!(!desk.path("results").exists() && !desk.path(".gearstudy").exists());
    let output =
        desk.command(&["run", "quick.yaml", "--results", "elsewhere"]).env("GEARSTUDY_CACHE", "kept").output().unwrap();
    assert!(output.status.success());
    let manifest = fs::read(desk.path("elsewhere/quick/manifest.json")).unwrap();
    let manifest: Value = serde_json::from_slice(&manifest).unwrap();
    let all_hits = manifest["stages"].as_array().unwrap().iter().all(|stage| stage["status"] == "hit");
    assert!(all_hits, "all came from the cache that was named");
}

#[test]
fn words_that_make_no_sense_end_with_code_1() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["rum", "quick.yaml"], 1);
    desk.run(&["run"], 1);
    desk.run(&["run", "quick.yaml", "--jobs", "0"], 1);
    desk.run(&["--help"], 0);
    desk.run(&["--version"], 0);
}

#[test]
fn what_a_user_asks_about_the_program_is_answered() {
    let desk = Desk::with("quick.yaml");
    let (kinds, _) = desk.run(&["kinds"], 0);
    for kind in ["geometry", "modification", "stiffness", "ste", "optimizer", "report"] {
        assert!(kinds.contains(kind), "{kinds}");
        let (about, _) = desk.run(&["kinds", kind], 0);
        assert!(about.contains("kind:") && about.lines().count() > 5, "{about}");
    }
    let (_, error) = desk.run(&["kinds", "tip_relief"], 1);
    assert!(error.contains("it belongs to geometry, modification, ") && error.contains("` shows it"), "{error}");
    let (_, error) = desk.run(&["kinds", "geometri"], 1);
    assert!(error.contains("did you mean `geometry`"), "{error}");
    let (schema, _) = desk.run(&["schema"], 0);
    assert!(serde_json::from_str::<Value>(&schema).is_ok());
    desk.run(&["new", "mine.yaml"], 0);
    desk.run(&["check", "mine.yaml"], 0);
    desk.run(&["new", "mine.yaml"], 1);
}
