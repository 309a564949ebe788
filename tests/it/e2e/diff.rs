//! `gearstudy diff` on real runs in a git repository made for it.

use std::fs;
use std::process::Command;

use serde_json::Value;

use crate::desk::Desk;
use studygraph::diff::compare::{Options, compare};
use studygraph::diff::pretty;
use studygraph::history::side::Side;
use studygraph::store::parquet;
use studygraph::table::data::{Data, Table};

/// What a project keeps of its results.
const IGNORED: &str = ".gearstudy/\nresults/*/*\n!results/*/manifest.json\n!results/*/*.summary.parquet\n\
    !results/*/*.verdicts.parquet\n";

pub fn git(desk: &Desk, words: &[&str]) -> String {
    let identity = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"];
    let output = Command::new("git").arg("-C").arg(desk.path("")).args(identity).args(words).output().unwrap();
    assert!(output.status.success(), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// A repository in which the quick study was run and its results committed.
pub fn committed() -> Desk {
    let desk = Desk::with("quick.yaml");
    git(&desk, &["init", "-q", "-b", "main"]);
    fs::write(desk.path(".gitignore"), IGNORED).unwrap();
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    git(&desk, &["add", "-A"]);
    git(&desk, &["commit", "-qm", "one"]);
    desk
}

fn edit(desk: &Desk, from: &str, to: &str) {
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let changed = text.replacen(from, to, 1);
    assert_ne!(text, changed, "`{from}` is not in the study");
    fs::write(desk.path("quick.yaml"), changed).unwrap();
}

pub fn json(desk: &Desk, words: &[&str], code: i32) -> Value {
    let words = [&["diff", "--format", "json"], words].concat();
    serde_json::from_str(&desk.run(&words, code).0).unwrap()
}

fn stage<'a>(diff: &'a Value, name: &str) -> &'a Value {
    let stages = diff["studies"][0]["stages"].as_array().unwrap();
    stages.iter().find(|stage| stage["name"] == name).unwrap_or_else(|| panic!("no stage {name} in {diff:#}"))
}

/// `part what`, for every reason of a stage.
fn why(diff: &Value, name: &str) -> Vec<String> {
    let reasons = stage(diff, name)["why"].as_array().unwrap();
    let one = |why: &Value| format!("{} {}", why["part"].as_str().unwrap(), why["what"].as_str().unwrap());
    reasons.iter().map(|why| one(why).trim().to_owned()).collect()
}

fn table<'a>(diff: &'a Value, name: &str) -> &'a Value {
    let tables = stage(diff, name.split('.').next().unwrap())["tables"].as_array().unwrap();
    tables.iter().find(|table| table["name"] == name).unwrap()
}

#[test]
fn every_change_has_its_reason_and_its_numbers() {
    let desk = committed();
    let same = json(&desk, &[], 0);
    assert_eq!((&same["state"], &same["studies"][0]["name"]), (&"same".into(), &"quick".into()));

    edit(&desk, "face_width: 20 mm, bore_radius: 18 mm", "face_width: 22 mm, bore_radius: 18 mm");
    edit(&desk, "seed: 1", "seed: 2");
    edit(&desk, "count: 5", "count: 9");
    edit(&desk, "best <= short &&", "best > short &&");
    edit(
        &desk,
        "table: stiffness.curve\n        x: cycle_position\n        y: stiffness\n        segments: pairs",
        "table: optimum.history\n        x: generation\n        y: best",
    );
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let diff = json(&desk, &[], 4);
    assert_eq!(why(&diff, "pair"), ["config pinion.face_width"]);
    let field = &stage(&diff, "pair")["why"][0];
    assert_eq!((&field["before"], &field["after"]), (&"20 mm".into(), &"22 mm".into()));
    assert_eq!(why(&diff, "stiffness"), ["input pair"]);
    // The report no longer reads the stiffness, but the search.
    let reads = |port: &str| {
        let reasons = stage(&diff, "report")["why"].as_array().unwrap();
        let found = reasons.iter().find(|why| why["what"] == port).unwrap();
        (found["before"].clone(), found["after"].clone())
    };
    assert_eq!(reads("stiffness"), ("read".into(), Value::Null));
    assert_eq!(reads("optimum"), (Value::Null, "read".into()));
    assert_eq!(
        (stage(&diff, "designs")["state"].as_str(), why(&diff, "designs")),
        (Some("same"), vec!["input pair".into()])
    );
    assert_eq!(why(&diff, "optimum"), ["input pair", "input stiffness", "seed"]);
    let seed = stage(&diff, "optimum")["why"].as_array().unwrap().last().unwrap();
    assert_eq!((&seed["before"], &seed["after"]), (&"1".into(), &"2".into()));
    assert!(why(&diff, "ste").contains(&"config torque".to_owned()));
    assert_eq!(stage(&diff, "ste")["why"][0]["after"], "75 N m, 125 N m, 175 N m, 225 N m");

    // 4 designs at 4 more torques; what the other rows hold is compared by key.
    let summary = table(&diff, "ste.summary");
    assert_eq!((&summary["rows_added"], &summary["rows_removed"]), (&16.into(), &0.into()));
    assert_eq!(summary["columns"][0]["compared"], 20);
    // The wider pinion alone is wider.
    let gears = table(&diff, "pair.gears");
    assert_eq!(gears["columns"].as_array().unwrap().len(), 1);
    assert_eq!((&gears["worst"][0]["column"], &gears["worst"][0]["difference"]), (&"face_width".into(), &2.0.into()));
    assert_eq!(gears["worst"][0]["key"], serde_json::json!([["gear", "pinion"]]));

    // The claim that was turned round fails: said first of all, in every format.
    let flip = &diff["verdicts"][0];
    assert_eq!((&flip["before"], &flip["after"]), (&"holds".into(), &"unexplained".into()));
    assert_eq!(flip["needs_attention"], true);
    let (pretty, _) = desk.run(&["diff"], 4);
    assert!(pretty.lines().nth(2) == Some("1 verdict flipped"), "{pretty}");
    assert!(pretty.lines().all(|line| line.chars().count() <= 120), "{pretty}");
    let (markdown, _) = desk.run(&["diff", "--format", "markdown"], 4);
    assert!(markdown.find("holds → unexplained").unwrap() < markdown.find("### ≠ quick").unwrap(), "{markdown}");
    let (html, _) = desk.run(&["diff", "--format", "html"], 4);
    assert!(html.find("holds → unexplained").unwrap() < html.find("pinion.face_width").unwrap());
    for foreign in ["http:", "https:", "src=", "url(", "@import", "<link"] {
        assert!(!html.contains(foreign), "the page refers to something else: {foreign}");
    }
    assert_eq!(desk.run(&["diff"], 4).0, pretty, "the same comparison is the same text");
    let (quiet, error) = desk.run(&["diff", "--quiet"], 4);
    assert!(quiet.is_empty() && error.is_empty(), "{quiet}{error}");

    // The two commits are compared as the commit and the folder were, and either way round.
    git(&desk, &["commit", "-qam", "two"]);
    assert_eq!(json(&desk, &[], 0)["state"], "same");
    let commits = json(&desk, &["HEAD~1", "HEAD", "quick"], 4);
    assert_eq!(commits["studies"], diff["studies"]);
    let back = json(&desk, &["HEAD", "HEAD~1", "quick.yaml"], 4);
    assert_eq!(table(&back, "ste.summary")["rows_removed"], 16);

    // Without a cache, what is not kept in git is compared by its content hash, and is said to be.
    let without = json(&desk, &["--cache", "none", "HEAD~1"], 4);
    let curve = table(&without, "ste.curve");
    assert_eq!((&curve["by_values"], &curve["state"]), (&false.into(), &"changed".into()));
    assert!(curve["note"].as_str().unwrap().starts_with("is not kept at HEAD~1 ("), "{curve:#}");
    assert_eq!(table(&without, "ste.summary")["by_values"], true);
    assert!(!desk.path("none").exists(), "a comparison makes no cache");
}

#[test]
fn stages_and_studies_come_and_go() {
    let desk = committed();
    edit(&desk, "study: quick", "study: other");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let diff = json(&desk, &[], 4);
    assert_eq!((&diff["studies"][0]["name"], &diff["studies"][0]["state"]), (&"other".into(), &"added".into()));
    assert_eq!((&diff["studies"][1]["name"], &diff["studies"][1]["state"]), (&"quick".into(), &"same".into()));
    json(&desk, &["quick"], 0);
    // The same results under two names, folder against folder, without git.
    let folders = json(&desk, &["results/quick", "results/other"], 0);
    assert_eq!(folders["studies"].as_array().unwrap().len(), 1);

    edit(&desk, "study: other", "study: quick");
    edit(
        &desk,
        "  report:\n",
        "  again: { kind: ste, stiffness: stiffness, designs: designs, torque: 50 N m }\n\n  report:\n",
    );
    edit(&desk, "[designs, optimum]", "designs");
    edit(&desk, "best: ste.summary[design=optimum,", "best: ste.summary[design=long,");
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let (at, end) = (text.find("  optimum:\n").unwrap(), text.find("  ste:\n").unwrap());
    fs::write(desk.path("quick.yaml"), format!("{}{}", &text[..at], &text[end..])).unwrap();
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let diff = json(&desk, &["quick"], 4);
    assert_eq!(
        (stage(&diff, "again")["state"].as_str(), stage(&diff, "optimum")["state"].as_str()),
        (Some("added"), Some("removed"))
    );
    assert!(why(&diff, "ste").contains(&"config designs".to_owned()), "{:?}", why(&diff, "ste"));

    // What git ignores as a whole was never meant to be compared.
    fs::write(desk.path(".gitignore"), format!("{IGNORED}results/other/\n")).unwrap();
    let diff = json(&desk, &[], 4);
    assert!(diff["remarks"][0].as_str().unwrap().contains("other is left out"), "{diff:#}");
    fs::remove_dir_all(desk.path("results/quick")).unwrap();
    assert_eq!(json(&desk, &["HEAD", "results", "quick"], 4)["studies"][0]["state"], "removed");
}

#[test]
fn tolerances_of_the_command_line_come_before_those_of_the_study() {
    let desk = committed();
    edit(&desk, "bore_radius: 28 mm", "bore_radius: 28.0001 mm");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let diff = json(&desk, &[], 4);
    let column = |diff: &Value| {
        let columns = table(diff, "stiffness.summary")["columns"].as_array().unwrap().clone();
        columns.into_iter().find(|column| column["name"] == "mean").unwrap()
    };
    assert_eq!((&column(&diff)["beyond"], &column(&diff)["changed"]), (&1.into(), &1.into()));
    let loose = json(&desk, &["--tolerance", "stiffness.summary.mean=1 %"], 4);
    assert_eq!((&column(&loose)["beyond"], &column(&loose)["relative_tolerance"]), (&0.into(), &0.01.into()));

    edit(&desk, "seed: 1", "seed: 1\ntolerances: { mean: 1e6 N/m }");
    desk.run(&["check", "quick.yaml"], 2);
    edit(&desk, "{ mean: 1e6 N/m }", "{ stiffness.summary.mean: 1e6 N/m }");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    assert!(desk.ran("quick").is_empty(), "a tolerance computes nothing anew");
    let studys = json(&desk, &[], 4);
    assert_eq!((&column(&studys)["beyond"], &column(&studys)["absolute_tolerance"]), (&0.into(), &1e6.into()));
    let strict = json(&desk, &["--tolerance", "stiffness.summary.mean=0"], 4);
    assert_eq!(column(&strict)["beyond"], 1);

    for (words, said) in [
        (["--tolerance", "meen=1"], "there is no column `meen`; did you mean `mean`?"),
        (["--tolerance", "stiffness.summary.mean=1 mm"], "does not fit `stiffness.summary.mean`, which is in N/m"),
        (["--tolerance", "ste.summary.design=1"], "it has no tolerance"),
        (["--tolerance", "mean"], "is not a tolerance; write"),
    ] {
        let (_, error) = desk.run(&[&["diff"][..], &words].concat(), 1);
        assert!(error.contains(said), "{error}");
    }
    edit(&desk, "stiffness.summary.mean:", "stiffness.sumary.mean:");
    let (_, error) = desk.run(&["check", "quick.yaml"], 2);
    assert!(error.contains("did you mean `stiffness.summary.mean`?"), "{error}");
}

#[test]
fn what_makes_no_sense_is_said_in_one_sentence() {
    let desk = Desk::with("quick.yaml");
    let said = |words: &[&str]| desk.run(&[&["diff"][..], words].concat(), 1).1;
    assert!(said(&[]).contains("there is no results folder `results`"), "{}", said(&[]));
    fs::create_dir(desk.path("results")).unwrap();
    assert!(said(&[]).contains("is not in a git repository; two folders"), "{}", said(&[]));
    git(&desk, &["init", "-q", "-b", "main"]);
    assert!(said(&[]).contains("no commit yet"), "{}", said(&[]));
    git(&desk, &["add", "quick.yaml"]);
    git(&desk, &["commit", "-qm", "one"]);
    assert!(said(&[]).contains("there are no results at HEAD ("), "{}", said(&[]));
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    git(&desk, &["add", "-A"]);
    git(&desk, &["commit", "-qm", "two"]);
    assert!(said(&["mian"]).contains("did you mean `main`?"), "{}", said(&["mian"]));
    assert!(said(&["main", "quik"]).contains("did you mean `quick`?"), "{}", said(&["main", "quik"]));
    assert!(said(&["--", "quik"]).contains("has results of a study `quik`"), "{}", said(&["--", "quik"]));
    assert!(said(&["--", "--all"]).contains("`--all`"));
    desk.run(&["diff", "main", "--", "quick"], 0);
    assert!(said(&["reslts"]).contains("did you mean `results`?"), "{}", said(&["reslts"]));
    assert!(said(&["./reslts/"]).contains("did you mean `./results`?"), "{}", said(&["./reslts/"]));

    // A damaged table is told, the others go on; a damaged manifest ends with 1, after the other studies.
    edit(&desk, "face_width: 20 mm, bore_radius: 18 mm", "face_width: 22 mm, bore_radius: 18 mm");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    fs::write(desk.path("results/quick/pair.gears.parquet"), "PAR1 nonsense PAR1").unwrap();
    let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n";
    fs::write(desk.path("results/quick/ste.summary.parquet"), pointer).unwrap();
    let diff = json(&desk, &["--cache", "none"], 4);
    let note = |table: &str| self::table(&diff, table)["note"].as_str().unwrap().to_owned();
    assert!(note("pair.gears").contains("is damaged"), "{}", note("pair.gears"));
    assert!(note("ste.summary").contains("git lfs pull"), "{}", note("ste.summary"));
    assert_eq!(table(&diff, "stiffness.summary")["by_values"], true);
    fs::create_dir(desk.path("results/broken")).unwrap();
    fs::write(desk.path("results/broken/manifest.json"), "{").unwrap();
    let (out, error) = desk.run(&["diff"], 1);
    assert!(out.contains("≠ quick") && error.contains("is damaged"), "{out}\n{error}");
}

/// The results as another program would have left them: other digests of code, and more as `change` says.
fn other_program(desk: &Desk, folder: &str, change: impl Fn(&mut Value)) {
    let path = desk.path(folder).join("quick/manifest.json");
    let mut manifest: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    manifest["program"]["version"] = "0.0.9".into();
    for stage in manifest["stages"].as_array_mut().unwrap() {
        for key in stage["keys"].as_array_mut().unwrap() {
            key["code"] = "0".repeat(64).into();
            match key.get_mut("chunks") {
                Some(chunks) => chunks.as_array_mut().unwrap().iter_mut().for_each(|of| of[0] = "1".repeat(64).into()),
                None => key["key"] = "1".repeat(64).into(),
            }
        }
    }
    change(&mut manifest);
    fs::write(path, serde_json::to_vec(&manifest).unwrap()).unwrap();
}

fn copied(desk: &Desk, to: &str) {
    for folder in ["quick", "quick/figures"] {
        fs::create_dir_all(desk.path(to).join(folder)).unwrap();
        for entry in fs::read_dir(desk.path("results").join(folder)).unwrap().map(Result::unwrap) {
            if entry.path().is_file() {
                fs::copy(entry.path(), desk.path(to).join(folder).join(entry.file_name())).unwrap();
            }
        }
    }
}

#[test]
fn another_program_with_the_same_values_is_one_line() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    copied(&desk, "old");
    other_program(&desk, "old", |_| ());
    let diff = json(&desk, &["old", "results"], 0);
    assert!(["pair", "ste", "report"].iter().all(|name| why(&diff, name) == ["code"]), "{diff:#}");
    let (pretty, _) = desk.run(&["diff", "old", "results"], 0);
    let lines: Vec<&str> = pretty.lines().collect();
    assert!(lines.contains(&"  = code changed in 6 stages, values the same"), "{pretty}");
    assert_eq!(pretty.matches("code").count(), 1, "{pretty}");
    assert_eq!(pretty.matches("0.0.9").count(), 1, "{pretty}");
    for format in ["markdown", "html"] {
        let (text, _) = desk.run(&["diff", "old", "results", "--format", format], 0);
        assert!(text.matches("code changed in 6 stages").count() == 1, "{text}");
        assert!(text.matches("0.0.9").count() == 1, "{text}");
    }

    // One value of one stage moved, and another demand: that stage by itself, the others still in one line.
    other_program(&desk, "old", |manifest| {
        let stages = manifest["stages"].as_array_mut().unwrap();
        let pair = stages.iter_mut().find(|stage| stage["name"] == "pair").unwrap();
        pair["keys"][0]["demand"] = "0".repeat(64).into();
        let stiffness = stages.iter_mut().find(|stage| stage["name"] == "stiffness").unwrap();
        let tables = stiffness["tables"].as_array_mut().unwrap();
        let summary = tables.iter_mut().find(|table| table["name"] == "stiffness.summary").unwrap();
        let file = desk.path("old/quick/stiffness.summary.parquet");
        let table = parquet::read(fs::read(&file).unwrap()).unwrap();
        let position = table.schema().position("mean").unwrap();
        let mut columns = table.columns().to_vec();
        let Data::Float(values) = &mut columns[position] else { panic!() };
        values[0] *= 1.001;
        let table = Table::from_columns(table.schema().clone(), columns).unwrap();
        summary["content"] = table.content_hash().to_string().into();
        fs::write(file, parquet::write(&table).unwrap()).unwrap();
    });
    let diff = json(&desk, &["old", "results"], 4);
    assert_eq!(
        (why(&diff, "pair"), why(&diff, "stiffness")),
        (vec!["code".into(), "demand".into()], vec!["code".into()])
    );
    let summary = table(&diff, "stiffness.summary");
    assert_eq!((&summary["state"], &summary["columns"][0]["name"]), (&"changed".into(), &"mean".into()));
    let (pretty, _) = desk.run(&["diff", "old", "results"], 4);
    assert!(pretty.contains("  ≠ stiffness (stiffness): changed\n      why: code\n"), "{pretty}");
    assert!(pretty.contains("  = code changed in 4 stages, values the same"), "{pretty}");
    assert!(pretty.contains("  = code and demand changed in pair, values the same"), "{pretty}");

    // In a terminal of 80 columns no line is longer.
    let side = |name: &str, label: &str| Side::folder(&desk.path(name), label).unwrap();
    let (old, new) = (side("old", "old"), side("results", "new"));
    let text = pretty::text(&compare(&old, &new, &Options::default()).unwrap(), 80);
    let longest = text.lines().map(|line| line.chars().count()).max().unwrap();
    assert!((60..=80).contains(&longest), "{longest}\n{text}");
}

#[test]
fn a_stage_with_another_name_is_told_as_that() {
    let desk = committed();
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let text = text
        .replace("  stiffness: { kind", "  springs: { kind")
        .replace("stiffness: stiffness\n", "stiffness: springs\n");
    fs::write(desk.path("quick.yaml"), text.replace("table: stiffness.curve", "table: springs.curve")).unwrap();
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let (out, _) = desk.run(&["diff", "--format", "json", "--cache", "none"], 4);
    let diff: Value = serde_json::from_str(&out).unwrap();
    let springs = stage(&diff, "springs");
    assert_eq!((&springs["state"], &springs["renamed_from"]), (&"same".into(), &"stiffness".into()));
    let stages = diff["studies"][0]["stages"].as_array().unwrap();
    assert!(stages.iter().all(|stage| stage["name"] != "stiffness" && stage["state"] != "added"), "{diff:#}");
    for name in ["optimum", "ste"] {
        assert_eq!(stage(&diff, name)["state"], "same", "a name is in no key");
    }
    let (pretty, _) = desk.run(&["diff"], 4);
    assert!(pretty.contains("= springs (stiffness): same, renamed from stiffness\n"), "{pretty}");
    // With other values it is another stage.
    edit(&desk, "root: trochoid", "root: circular_fillet");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let diff = json(&desk, &[], 4);
    assert_eq!(
        (&stage(&diff, "springs")["state"], &stage(&diff, "stiffness")["state"]),
        (&"added".into(), &"removed".into())
    );
}

/// A study of which git cannot say whether it is kept out on purpose is not compared as if it were not.
#[test]
fn an_error_of_git_is_not_taken_for_a_study_that_is_kept() {
    let desk = committed();
    edit(&desk, "study: quick", "study: other");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    fs::write(desk.path(".git/index"), "damaged").unwrap();
    let (_, error) = desk.run(&["diff"], 1);
    assert!(error.contains("it is not known whether git keeps `") && error.contains("index"), "{error}");
}
