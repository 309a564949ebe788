//! `--format json`: what every command prints is what `docs/json.md` says, no more and no less; and what ends with code 4.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use serde_json::Value;

use super::diff::{committed, git};
use crate::desk::Desk;

fn page() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/json.md")).unwrap()
}

/// The rows of the table of a section: what stands between backquotes in the first cell, and the rest of the row.
fn rows(section: &str) -> Vec<(Vec<String>, String)> {
    let page = page();
    let from = page.find(&format!("\n## {section}\n")).unwrap_or_else(|| panic!("no section {section}"));
    let text = &page[from + 4..];
    let text = text.find("\n## ").map_or(text, |end| &text[..end]);
    let quoted = |cell: &str| cell.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>();
    let row = |line: &str| {
        let (first, rest) = line.strip_prefix("| `")?.split_once(" | ")?;
        Some((quoted(&format!("`{first}")), rest.to_owned()))
    };
    text.lines().filter_map(row).collect()
}

/// Every path at which a value stands that holds no other ones.
fn paths(value: &Value, at: &str, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(fields) if !fields.is_empty() => {
            for (name, value) in fields {
                paths(value, &if at.is_empty() { name.clone() } else { format!("{at}.{name}") }, found);
            }
        }
        Value::Array(items) if !items.is_empty() => {
            for item in items {
                paths(item, &format!("{at}[]"), found);
            }
        }
        _ => drop(found.insert(at.to_owned())),
    }
}

/// What the samples have is documented, and what is documented stands in one of them.
fn as_documented(section: &str, samples: &[Value]) {
    let mut found = BTreeSet::new();
    for sample in samples {
        paths(sample, "", &mut found);
    }
    let documented = rows(section);
    assert!(!documented.is_empty(), "{section} has no table");
    let covers = |path: &str, found: &str| match path.strip_suffix(".*") {
        // Nothing of it may be there, and items of lists may be values.
        Some(stem) => found == stem || found.starts_with(&format!("{stem}.")) || stem.strip_suffix("[]") == Some(found),
        // Of a list or an object that is empty, or null where it does not apply.
        None => {
            path == found
                || path.starts_with(&format!("{found}."))
                || path.starts_with(&format!("{found}[]"))
                || found.strip_suffix("[]").is_some_and(|list| list == path)
        }
    };
    for path in &found {
        let known = documented.iter().any(|(paths, _)| paths.iter().any(|known| covers(known, path)));
        // Below a list that is documented as such.
        let inside =
            documented.iter().flat_map(|(paths, _)| paths).any(|known| path.starts_with(&format!("{known}[]")));
        assert!(known || inside, "{section}: `{path}` is not in docs/json.md");
    }
    for (paths, meaning) in documented.iter().filter(|(_, meaning)| !meaning.starts_with("only w")) {
        for path in paths {
            let stem = path.trim_end_matches(".*");
            let there = found.iter().any(|found| {
                found == stem || found.starts_with(&format!("{stem}.")) || found.starts_with(&format!("{stem}[]"))
            });
            assert!(there, "{section}: `{path}` is in docs/json.md ({meaning}), but nowhere else: {found:#?}");
        }
    }
}

fn answer(desk: &Desk, words: &[&str], code: i32) -> Value {
    let (out, error) = desk.run(&[words, &["--format", "json"]].concat(), code);
    serde_json::from_str(&out).unwrap_or_else(|wrong| panic!("{words:?}: {wrong}\n{out}\n{error}"))
}

fn lines(text: &str) -> Vec<Value> {
    text.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}"))).collect()
}

/// Every line is an event that the page names, with the fields that it names.
fn as_events(lines: &[Value]) {
    let known: BTreeMap<String, BTreeSet<String>> = rows("`run`, `watch`, `shard merge`")
        .into_iter()
        .map(|(names, rest)| {
            let fields = rest.split(" | ").next().unwrap().split('`').skip(1).step_by(2).map(str::to_owned);
            (names[0].clone(), fields.chain(["event".to_owned()]).collect())
        })
        .collect();
    for line in lines {
        let event = line["event"].as_str().unwrap();
        let fields: BTreeSet<String> = line.as_object().unwrap().keys().cloned().collect();
        assert_eq!(Some(&fields), known.get(event), "{line}");
    }
}

fn of<'a>(lines: &'a [Value], event: &str) -> Vec<&'a Value> {
    lines.iter().filter(|line| line["event"] == event).collect()
}

#[test]
fn a_run_in_json_is_lines_of_events() {
    let desk = Desk::with("quick.yaml");
    let (out, error) = desk.run(&["run", "quick.yaml", "--format", "json"], 0);
    assert_eq!(error, "");
    let first = lines(&out);
    as_events(&first);
    assert_eq!((&first[0]["event"], &first[0]["stages"]), (&"started".into(), &6.into()));
    let last = first.last().unwrap();
    assert_eq!((&last["event"], &last["code"]), (&"ended".into(), &0.into()));
    let finished = of(&first, "finished");
    assert_eq!((finished.len(), &finished[0]["ran"], &finished[0]["verdicts"]["holds"]), (1, &6.into(), &1.into()));
    assert!(desk.path(finished[0]["page"].as_str().unwrap()).is_file());
    // Each stage runs before it is done, and what it has computed never shrinks.
    for stage in ["pair", "stiffness", "designs", "optimum", "ste", "report"] {
        let of_stage: Vec<&Value> = first.iter().filter(|line| line["stage"] == stage).collect();
        let states: Vec<&str> = of_stage.iter().filter_map(|line| line["state"].as_str()).collect();
        assert_eq!(states, ["running", "done"], "{stage}");
        let shares: Vec<f64> = of_stage.iter().filter_map(|line| line["share"].as_f64()).collect();
        assert!(shares.is_sorted() && shares.last() == Some(&1.0), "{stage}: {shares:?}");
    }
    assert!(of(&first, "warning")[0]["message"].as_str().unwrap().contains("half root angles"));
    // With nothing to do, the verdicts are those of the results.
    let again = lines(&desk.run(&["run", "quick.yaml", "--format", "json"], 0).0);
    as_events(&again);
    let finished = of(&again, "finished");
    assert_eq!((&finished[0]["ran"], &finished[0]["verdicts"]["holds"]), (&0.into(), &1.into()));
    let explained = lines(&desk.run(&["run", "quick.yaml", "--explain", "--format", "json"], 0).0);
    as_events(&explained);
    assert_eq!(of(&explained, "planned")[0]["plan"]["up_to_date"], true);
    // What was changed from outside, a study with two mistakes, a stage that fails.
    fs::write(desk.path("results/quick/report.html"), "mine").unwrap();
    let noted = lines(&desk.run(&["run", "quick.yaml", "--format", "json"], 0).0);
    as_events(&noted);
    assert!(of(&noted, "note")[0]["message"].as_str().unwrap().contains("written anew"));
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    fs::write(desk.path("wrong.yaml"), text.replace("teeth: 24", "z: 24").replace("kind: ste\n", "kind: sta\n"))
        .unwrap();
    let (out, error) = desk.run(&["run", "wrong.yaml", "--format", "json"], 2);
    let wrong = lines(&out);
    as_events(&wrong);
    assert_eq!((wrong.len(), wrong[0]["mistakes"].as_array().unwrap().len()), (1, 2), "{out}");
    assert!(error.contains("unknown field `z`"), "{error}");
    let fails = text.replace("study: quick", "study: fails").replace("fraction: 1.0", "length: 60 mm");
    fs::write(desk.path("fails.yaml"), fails).unwrap();
    let failed = lines(&desk.run(&["run", "fails.yaml", "--format", "json"], 3).0);
    as_events(&failed);
    let stage = failed.iter().find(|line| line["state"] == "failed").unwrap();
    assert!(stage["stage"] == "designs" && stage["why"].as_str().unwrap().contains("the active flank"), "{stage}");
    assert_eq!(failed.last().unwrap()["code"], 3);
}

#[test]
fn every_answer_in_json_has_the_shape_that_the_page_says() {
    let desk = Desk::with("quick.yaml");
    as_documented("`new`", &[answer(&desk, &["new", "mine.yaml"], 0)]);
    fs::write(desk.path("wrong.yaml"), "study: wrong\nstages:\n  pair: { kind: geometri }\n").unwrap();
    as_documented("`check`", &[answer(&desk, &["check", "quick.yaml", "wrong.yaml"], 2)]);
    let fresh = answer(&desk, &["plan", "quick.yaml", "--limit-memory", "1MB"], 0);
    desk.run(&["run", "quick.yaml", "--quiet"], 0);
    let known = answer(&desk, &["plan", "quick.yaml", "--want", "optimum.evaluations"], 0);
    let stages = known[0]["stages"].as_array().unwrap();
    let again: Vec<&Value> = stages.iter().filter(|stage| stage["again_seconds"].is_number()).collect();
    assert_eq!(again.iter().map(|stage| &stage["name"]).collect::<Vec<_>>(), ["optimum"]);
    as_documented("`plan`", &[fresh, known]);
    as_documented("`status`", &[answer(&desk, &["status", "quick.yaml", "--check"], 0)]);
    let reported = answer(&desk, &["report", "quick.yaml", "--check"], 0);
    assert_eq!(
        (&reported[0]["verdicts"]["holds"], &reported[0]["entries"][0]["verdict"]),
        (&1.into(), &"holds".into())
    );
    as_documented("`report`", &[reported]);
    let tables = answer(&desk, &["table", "quick.yaml"], 0);
    assert!(tables.as_array().unwrap().iter().any(|table| table["name"] == "ste.summary" && table["rows"] == 20));
    as_documented("`table`", &[tables]);
    as_documented("`query`", &[answer(&desk, &["query"], 0)]);
    as_documented("`kinds`", &[answer(&desk, &["kinds"], 0)]);
    as_documented("`kinds ste`", &[answer(&desk, &["kinds", "ste"], 0)]);
    assert_eq!(answer(&desk, &["kinds", "optimizer.design.tip_relief"], 0)["fields"][0]["name"], "gear");
    as_documented("`archive`", &[answer(&desk, &["archive", "quick.yaml", "-o", "quick.zip"], 0)]);
    as_documented("`verify`", &[answer(&desk, &["verify", "quick.zip"], 0)]);
    as_documented("`gc`", &[answer(&desk, &["gc", "--dry-run"], 0)]);
    let elsewhere = ["--cache", "other"];
    let plan = [&["shard", "plan", "quick.yaml", "--shards", "2", "--into", "plan"], &elsewhere[..]].concat();
    as_documented("`shard plan`", &[answer(&desk, &plan, 0)]);
    as_documented(
        "`shard run`",
        &[answer(&desk, &["shard", "run", "plan", "0"], 0), answer(&desk, &["shard", "run", "plan", "0"], 0)],
    );
    as_documented("`shard status`", &[answer(&desk, &["shard", "status", "plan"], 0)]);
    desk.run(&["shard", "run", "plan", "1", "--quiet"], 0);
    let merged = lines(&desk.run(&["shard", "merge", "plan", "--format", "json"], 0).0);
    as_events(&merged);
    assert_eq!((&merged[0]["event"], &merged.last().unwrap()["code"]), (&"merged".into(), &0.into()));
}

/// What is stale, damaged or changed ends with code 4, once somebody asks; nothing is written for it.
#[test]
fn whoever_checks_is_told_by_the_exit_code() {
    let desk = committed();
    fs::create_dir(desk.path("studies")).unwrap();
    fs::rename(desk.path("quick.yaml"), desk.path("studies/quick.yaml")).unwrap();
    for words in [&["status", "--check"][..], &["report", "--check", "quick"], &["diff"]] {
        desk.run(words, 0);
    }
    let page = desk.path("results/quick/report.html");
    let before = fs::metadata(&page).unwrap().modified().unwrap();
    let text = fs::read_to_string(desk.path("studies/quick.yaml")).unwrap();
    // A comment makes nothing stale but the text.
    fs::write(desk.path("studies/quick.yaml"), format!("# More.\n{text}")).unwrap();
    desk.run(&["diff"], 0);
    fs::write(desk.path("studies/quick.yaml"), text.replace("amount: 12 um", "amount: 13 um")).unwrap();
    assert!(desk.run(&["status", "--check"], 4).1.contains("not up to date: quick"));
    desk.run(&["status"], 0);
    let (_, error) = desk.run(&["report", "--check", "quick"], 4);
    assert!(error.contains("stage `designs` is not up to date") && error.contains("first: gearstudy run"), "{error}");
    assert_eq!(before, fs::metadata(&page).unwrap().modified().unwrap(), "a check writes nothing");
    let (out, _) = desk.run(&["diff"], 4);
    assert!(out.contains("quick: the results are not those of the study now: stage `designs`"), "{out}");
    let old = answer(&desk, &["diff"], 4);
    assert_eq!((&old["state"], &old["stale"][0]["study"]), (&"same".into(), &"quick".into()));
    desk.run(&["run", "quick", "--quiet"], 0);
    let new = answer(&desk, &["diff"], 4);
    assert_eq!(new["stale"], Value::Array(Vec::new()));
    as_documented("`diff`", &[old, new]);
    // A claim that does not hold is a verdict that needs attention.
    let wrong = text.replace("claim: best <= short", "claim: best >= short");
    assert_ne!(text, wrong);
    fs::write(desk.path("studies/quick.yaml"), wrong).unwrap();
    desk.run(&["run", "quick", "--quiet"], 0);
    let (_, error) = desk.run(&["report", "--check", "quick"], 4);
    assert_eq!(error, "gearstudy: quick: 1 verdict needs attention\n");
    desk.run(&["report", "quick"], 0);
    git(&desk, &["status"]);
}

/// A table that only memory had is computed again when it is asked for later; the plan says the price, and it is paid once.
#[test]
fn the_price_of_a_table_on_demand_is_told_before_it_is_paid_and_paid_once() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml", "--quiet"], 0);
    let seconds = desk.manifest("quick")["stages"].as_array().unwrap().clone();
    let seconds = seconds.iter().find(|stage| stage["name"] == "optimum").unwrap()["seconds"].as_f64().unwrap();
    let plan = || answer(&desk, &["plan", "quick.yaml", "--want", "optimum.evaluations"], 0);
    let priced = |plan: &Value| -> Vec<(String, f64)> {
        let stages = plan[0]["stages"].as_array().unwrap().clone();
        let price = |stage: &Value| Some((stage["name"].as_str()?.to_owned(), stage["again_seconds"].as_f64()?));
        stages.iter().filter_map(price).collect()
    };
    assert_eq!(priced(&plan()), [("optimum".to_owned(), seconds)], "what the manifest says it took");
    let (out, _) = desk.run(&["plan", "quick.yaml", "--want", "optimum.evaluations"], 0);
    assert!(out.contains("run: demand changed; all of it is computed again, which took "), "{out}");
    desk.run(&["run", "quick.yaml", "--quiet", "--want", "optimum.evaluations"], 0);
    assert_eq!(desk.ran("quick"), ["optimum"]);
    // With and without it, both are known now.
    assert!(priced(&plan()).is_empty());
    desk.run(&["run", "quick.yaml", "--quiet"], 0);
    assert!(desk.ran("quick").is_empty());
    desk.run(&["run", "quick.yaml", "--quiet", "--want", "optimum.evaluations"], 0);
    assert!(desk.ran("quick").is_empty());
}
