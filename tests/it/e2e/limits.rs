//! What a run would take is said before it runs, and what is beyond the limits is refused.

use std::fs;
use std::process::Command;

use serde_json::Value;

use crate::desk::Desk;

const PAIR: &str = "
  pair:
    kind: geometry
    module: 3 mm
    rack: { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38 }
    pinion: { teeth: 19, face_width: 20 mm, bore_radius: 14.079 mm }
    gear: { teeth: 48, face_width: 18 mm, bore_radius: 38.823 mm }
";

fn desk(stages: &str) -> Desk {
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("large.yaml"), format!("study: large\ntitle: Large\nseed: 1\nstages:\n{PAIR}{stages}"))
        .unwrap();
    desk
}

const OUTLINE: &str =
    "    outline: { points: 100000, teeth: all }\n  files: { kind: export, pair: pair, formats: csv }\n";

const HYPERCUBE: &str = "
  stiffness: { kind: stiffness, pair: pair }
  search:
    kind: optimizer
    stiffness: stiffness
    at: { torque: 50 N m }
    method: { latin_hypercube: { points: 16000000 } }
    design:
      - tip_relief: { gear: both, amount: [0 um, 8 um], length: [0 mm, 6 mm], curve: parabolic }
";

#[test]
fn what_is_beyond_the_limits_is_refused_with_what_to_change() {
    let desk = desk(OUTLINE);
    let (out, error) = desk.run(&["run", "large.yaml", "--limit-memory", "500MB"], 2);
    assert_eq!(out, "", "nothing ran");
    assert!(error.starts_with("large.yaml:12:24: this run would take about "), "{error}");
    for part in [
        "and may take 500 MB of memory; stage `",
        "rows of its table `",
        "\n  help: in stage `",
        "allow more with `--limit-memory ",
    ] {
        assert!(error.contains(part), "{part}: {error}");
    }
    assert!(!desk.path("results").exists(), "nothing was written");
    let (plan, _) = desk.run(&["plan", "large.yaml", "--limit-memory", "500MB"], 0);
    assert!(plan.contains("`run` refuses it: this run would take about "), "{plan}");
    // What is advised fits.
    let points = error.split("`outline.points: ").nth(1).and_then(|rest| rest.split('`').next()).unwrap();
    let text = fs::read_to_string(desk.path("large.yaml")).unwrap();
    fs::write(desk.path("large.yaml"), text.replace("points: 100000", &format!("points: {points}"))).unwrap();
    let (plan, _) = desk.run(&["plan", "large.yaml", "--limit-memory", "500MB"], 0);
    assert!(!plan.contains("refuses"), "{plan}");
    fs::write(desk.path("large.yaml"), text.replace("points: 100000, teeth: all", "points: 100000")).unwrap();
    let (plan, _) = desk.run(&["plan", "large.yaml", "--limit-memory", "500MB"], 0);
    assert!(!plan.contains("refuses"), "{plan}");
}

#[test]
fn rows_are_limited_too_and_the_limits_may_stand_in_the_environment() {
    let desk = desk(OUTLINE);
    let (_, error) = desk.run(&["run", "large.yaml", "--limit-rows", "1000000"], 2);
    assert!(error.contains("and may take 1 000 000 rows") && error.contains("`--limit-rows "), "{error}");
    let output = Command::new(env!("CARGO_BIN_EXE_gearstudy"))
        .current_dir(desk.path("."))
        .env("GEARSTUDY_LIMIT_ROWS", "7")
        .args(["run", "quick.yaml"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("and may take 7 rows"));
    let (_, error) = desk.run(&["run", "quick.yaml", "--limit-memory", "7"], 1);
    assert!(error.contains("write a number and kB, MB, GB"), "{error}");
}

/// Sixteen million points took 1.3 GB to be drawn, by a command that only reads.
#[cfg(target_os = "linux")]
#[test]
fn checking_draws_nothing() {
    let desk = desk(HYPERCUBE);
    let program = env!("CARGO_BIN_EXE_gearstudy");
    for command in ["check", "plan"] {
        let script = format!("ulimit -v 1000000; exec '{program}' {command} large.yaml");
        let output = Command::new("sh").current_dir(desk.path(".")).args(["-c", &script]).output().unwrap();
        assert!(output.status.success(), "{command}: {output:?}");
    }
}

/// The accuracy stage measures what the allocator was asked for while a stage ran.
#[test]
fn memory_is_foreseen_from_above() {
    let desk = desk(concat!(
        "    outline: { points: 500, teeth: all }\n",
        "  stiffness: { kind: stiffness, pair: pair, method: { finite_element: { elements_across: 6 } }, torque: 50 N m }\n",
        "  designs: { kind: modification, pair: pair, designs: { none: [] } }\n",
        "  ste: { kind: ste, stiffness: stiffness, designs: designs, positions: 2000, torque: { from: 1 N m, to: 200 N m, count: 12 } }\n",
        "  of_pair: { kind: accuracy, of: pair, quantities: [outline.x], reference: {}, ladders: { l: [{}] }, repeats: 1 }\n",
        "  of_stiffness: { kind: accuracy, of: stiffness, quantities: [curve.stiffness], reference: {}, ladders: { l: [{}] }, repeats: 1 }\n",
        "  of_ste: { kind: accuracy, of: ste, quantities: [curve.pairs], reference: {}, ladders: { l: [{}] }, repeats: 1 }\n",
    ));
    let (plan, _) = desk.run(&["plan", "large.yaml", "--json", "--want", "pair.outline"], 0);
    let plan: Value = serde_json::from_str(&plan).unwrap();
    let stages = plan[0]["stages"].as_array().unwrap();
    desk.run(&["run", "large.yaml", "--want", "pair.outline"], 0);
    for (stage, minimum) in [("pair", 0.2), ("stiffness", 0.1), ("ste", 0.05)] {
        let expected =
            stages.iter().find(|planned| planned["name"] == stage).unwrap()["expected"]["memory_bytes"].clone();
        let table = format!("of_{stage}.reference");
        let (measured, _) = desk.run(&["table", "large.yaml", &table, "--format", "json"], 0);
        let measured: Value = serde_json::from_str(&measured).unwrap();
        let measured = 1e6 * measured[0]["megabytes"].as_f64().unwrap();
        let share = measured / expected.as_f64().unwrap();
        assert!((minimum..=1.0).contains(&share), "{stage}: {measured} of {expected} foreseen bytes");
    }
}

/// `ulimit -f`: a write beyond it is an error that names the file, and not the end by a signal.
#[cfg(unix)]
#[test]
fn a_limit_on_the_size_of_files_is_reported() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml", "--quiet"], 0);
    for words in [
        "run quick.yaml --quiet --results new --cache none",
        "archive quick.yaml -o a.zip",
        "query 'SELECT * FROM quick.ste.curve' -o a.csv",
        "report quick.yaml --results new",
    ] {
        let line = format!("ulimit -f 4; \"$0\" {words}");
        let output = Command::new("sh")
            .args(["-c", &line, env!("CARGO_BIN_EXE_gearstudy")])
            .current_dir(desk.path(""))
            .env_remove("GEARSTUDY_CACHE")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(1), "{words}: {}: {said}", output.status);
        assert!(said.contains("too large") || words.starts_with("report"), "{words}: {said}");
    }
}

/// The fault of this disk is none of the archive; and a file that could not be written to its end does not stay.
#[cfg(unix)]
#[test]
fn a_limit_on_the_size_of_files_is_no_fault_of_what_is_read() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml", "--quiet"], 0);
    desk.run(&["archive", "quick.yaml", "-o", "a.zip"], 0);
    let limited = |words: &str| {
        let line = format!("ulimit -f 1; \"$0\" {words}");
        let mut command = Command::new("sh");
        command.args(["-c", &line, env!("CARGO_BIN_EXE_gearstudy")]).current_dir(desk.path(""));
        let output = command.env_remove("GEARSTUDY_CACHE").output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{words}");
        String::from_utf8(output.stderr).unwrap()
    };
    let said = limited("verify a.zip");
    assert!(said.contains("cannot write") && said.contains("too large"), "{said}");
    assert!(!said.contains("damaged") && !said.contains("`a.zip`"), "{said}");
    let said = limited("new n.yaml");
    assert!(said.contains("cannot write n.yaml") && !desk.path("n.yaml").exists(), "{said}");
    desk.run(&["new", "n.yaml"], 0);
}

/// Nobody reads the answer to its end, or it cannot be written: temporary folders go, and the code is that of the work.
#[cfg(unix)]
#[test]
fn an_answer_that_is_not_read_leaves_nothing_behind() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml", "--quiet"], 0);
    desk.run(&["archive", "quick.yaml", "-o", "a.zip"], 0);
    fs::remove_file(desk.path("results/quick/quick.h5")).unwrap();
    let temporary = tempfile::tempdir().unwrap();
    for (words, expected) in [
        ("verify a.zip --jobs 1 | true", 0),
        ("verify a.zip --json > /dev/full", 1),
        ("status quick.yaml | true", 0),
        ("status --check quick.yaml | true", 4),
    ] {
        let line = format!("{{ \"$0\" {}; echo $? > code; }} {}", split(words).0, split(words).1);
        let mut command = Command::new("sh");
        command.args(["-c", &line, env!("CARGO_BIN_EXE_gearstudy")]).current_dir(desk.path(""));
        let output = command.env("TMPDIR", temporary.path()).env_remove("GEARSTUDY_CACHE").output().unwrap();
        let code = fs::read_to_string(desk.path("code")).unwrap();
        assert_eq!(code.trim(), expected.to_string(), "{words}: {}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(fs::read_dir(temporary.path()).unwrap().count(), 0, "{words}");
    }
}

/// A command and what becomes of its answer.
#[cfg(unix)]
fn split(line: &str) -> (&str, &str) {
    line.split_at(line.find(['|', '>']).unwrap())
}

#[test]
fn a_query_has_a_time_limit() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml", "--quiet"], 0);
    let endless =
        "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT COUNT(*) FROM n, quick.ste.curve";
    let began = std::time::Instant::now();
    let (_, said) = desk.run(&["query", endless, "--timeout", "1"], 2);
    assert!(said.contains("the query takes more than 1 s") && said.contains("--timeout"), "{said}");
    assert!(began.elapsed() < std::time::Duration::from_secs(30));
}

/// What a study reads goes into results and archives, so nothing outside of its folder is read.
#[cfg(unix)]
#[test]
fn a_link_beside_a_study_leads_nowhere_else() {
    let desk = Desk::with("quick.yaml");
    let trace = "roll_lengths [mm], deviations [um]\n4,-2\n8,0\n12,1\n16,-4\n";
    fs::create_dir_all(desk.path("own/data")).unwrap();
    fs::write(desk.path("outside.csv"), trace).unwrap();
    fs::write(desk.path("own/data/inside.csv"), trace).unwrap();
    let study = format!(
        "study: linked\nstages:\n{PAIR}  designs: {{ kind: modification, pair: pair, designs: \
         {{ made: [measured: {{ gear: pinion, file: trace.csv }}] }} }}\n"
    );
    fs::write(desk.path("own/linked.yaml"), study).unwrap();
    let link = desk.path("own/trace.csv");
    std::os::unix::fs::symlink("data/inside.csv", &link).unwrap();
    desk.run(&["check", "own/linked.yaml"], 0);
    for target in ["../outside.csv", "/etc/passwd", "/dev/zero"] {
        fs::remove_file(&link).unwrap();
        std::os::unix::fs::symlink(target, &link).unwrap();
        for command in ["check", "run"] {
            let (_, said) = desk.run(&[command, "own/linked.yaml"], 2);
            assert!(said.contains("`trace.csv` is a link that leads out of the folder of the study"), "{said}");
        }
    }
}

/// A killed `verify` leaves its temporary folder; the next one takes it away, and not that of one that lives.
#[cfg(target_os = "linux")]
#[test]
fn what_a_killed_command_left_is_removed_by_the_next() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml", "--quiet"], 0);
    desk.run(&["archive", "quick.yaml", "-o", "a.zip"], 0);
    let temporary = tempfile::tempdir().unwrap();
    let count = || fs::read_dir(temporary.path()).unwrap().count();
    let mut kills = 0;
    for _ in 0..4 {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
        command.args(["verify", "a.zip", "--quiet"]).current_dir(desk.path("")).env("TMPDIR", temporary.path());
        let mut child = command.spawn().unwrap();
        while count() == 0 && child.try_wait().unwrap().is_none() {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        child.kill().unwrap();
        kills += usize::from(child.wait().unwrap().code().is_none());
    }
    assert!(kills > 0);
    let output = desk.command(&["verify", "a.zip", "--quiet"]).env("TMPDIR", temporary.path()).output().unwrap();
    assert_eq!((output.status.code(), count()), (Some(0), 0));
    // A file of a killed archive beside the new one.
    let boot = fs::read_to_string("/proc/sys/kernel/random/boot_id").unwrap();
    let space = boot + &fs::read_link("/proc/self/ns/pid").unwrap().display().to_string();
    let mut ended = Command::new("true").spawn().unwrap();
    ended.wait().unwrap();
    let left = desk.path(&format!(".partial-{}-{}-0", &blake3::hash(space.as_bytes()).to_hex()[..8], ended.id()));
    fs::write(&left, "half").unwrap();
    desk.run(&["archive", "quick.yaml", "-o", "a.zip"], 0);
    assert!(!left.exists());
}
