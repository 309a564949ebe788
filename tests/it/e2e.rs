//! The program as a user runs it: real commands on real studies in an empty folder.

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// An empty folder with one study in it.
struct Desk {
    folder: TempDir,
}

impl Desk {
    fn with(study: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies").join(study);
        fs::copy(source, folder.path().join(study)).unwrap();
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
        command.current_dir(self.folder.path()).env_remove("GEARSTUDY_CACHE").args(words);
        command
    }

    /// Runs a command that must end with `code`; its standard output and standard error.
    fn run(&self, words: &[&str], code: i32) -> (String, String) {
        let output = self.command(words).output().unwrap();
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        assert_eq!(output.status.code(), Some(code), "{words:?}\n{out}\n{err}");
        (out, err)
    }

    fn manifest(&self, study: &str) -> Value {
        let path = self.path("results").join(study).join("manifest.json");
        serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
    }

    /// `stage.table` and its content hash, for every table of the last run.
    fn contents(&self, study: &str) -> Vec<(String, String)> {
        let manifest = self.manifest(study);
        let stages = manifest["stages"].as_array().unwrap();
        let tables = stages.iter().flat_map(|stage| stage["tables"].as_array().unwrap().clone());
        let text = |value: &Value| value.as_str().unwrap().to_owned();
        tables.map(|table| (text(&table["name"]), text(&table["content"]))).collect()
    }

    fn statuses(&self, study: &str) -> Vec<(String, String)> {
        let manifest = self.manifest(study);
        let text = |value: &Value| value.as_str().unwrap().to_owned();
        manifest["stages"]
            .as_array()
            .unwrap()
            .iter()
            .map(|stage| (text(&stage["name"]), text(&stage["status"])))
            .collect()
    }
}

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
    let ran: Vec<String> =
        desk.statuses("quick").into_iter().filter(|(_, status)| status == "ran").map(|(name, _)| name).collect();
    assert_eq!(ran, ["ste", "report"]);
}

#[test]
fn one_and_two_threads_give_the_same_contents() {
    let contents = |jobs: &str| {
        let desk = Desk::with("quick.yaml");
        desk.run(&["run", "quick.yaml", "--jobs", jobs], 0);
        desk.contents("quick")
    };
    let one = contents("1");
    assert!(one.len() > 8);
    assert_eq!(one, contents("2"));
    assert_eq!(one, contents("5"));
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
}

#[test]
fn only_force_and_dry_run_do_what_they_say() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml", "--dry-run"], 0);
    assert!(!desk.path("results").exists() && !desk.path(".gearstudy").exists(), "a dry run writes nothing");
    desk.run(&["run", "quick.yaml", "--only", "stiffness"], 0);
    let names: Vec<String> =
        desk.statuses("quick").into_iter().filter(|(_, status)| status == "ran").map(|(name, _)| name).collect();
    assert_eq!(names, ["pair", "stiffness"]);
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
    assert!(
        desk.statuses_in("elsewhere").iter().all(|status| status == "hit"),
        "all came from the cache that was named"
    );
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
    let (_, error) = desk.run(&["kinds", "geometri"], 1);
    assert!(error.contains("did you mean `geometry`"), "{error}");
    let (schema, _) = desk.run(&["schema"], 0);
    assert!(serde_json::from_str::<Value>(&schema).is_ok());
    desk.run(&["new", "mine.yaml"], 0);
    desk.run(&["check", "mine.yaml"], 0);
    desk.run(&["new", "mine.yaml"], 1);
}

impl Desk {
    fn statuses_in(&self, results: &str) -> Vec<String> {
        let path = self.path(results).join("quick/manifest.json");
        let manifest: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
        manifest["stages"]
            .as_array()
            .unwrap()
            .iter()
            .map(|stage| stage["status"].as_str().unwrap().to_owned())
            .collect()
    }
}
