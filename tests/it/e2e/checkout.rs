//! Branches with results of which git keeps a part: what a checkout leaves lying is of another run, not damaged.

use std::fs;

use super::diff::{committed, git, json};
use crate::desk::Desk;

/// The quick study on `main`, with another relief on `f`; `main` is checked out, and the tables are those of `f`.
fn branched() -> Desk {
    let desk = committed();
    git(&desk, &["checkout", "-qb", "f"]);
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let changed = text.replacen("amount: 12 um", "amount: 13 um", 1);
    assert_ne!(text, changed);
    fs::write(desk.path("quick.yaml"), changed).unwrap();
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    git(&desk, &["commit", "-qam", "two"]);
    git(&desk, &["checkout", "-q", "main"]);
    desk
}

#[test]
fn tables_of_another_branch_are_not_damaged_and_the_cache_has_the_right_ones() {
    let desk = branched();
    let (out, _) = desk.run(&["status", "quick.yaml"], 0);
    assert!(out.contains("files of another run lie here") && !out.contains("damaged"), "{out}");
    assert!(out.contains("next: gearstudy run quick.yaml takes them from the cache"), "{out}");
    let (out, error) = desk.run(&["status", "--check", "quick.yaml"], 4);
    assert!(!out.contains("damaged") && !error.contains("damaged"), "{out}{error}");
    assert!(error.contains("not up to date: quick"), "{error}");
    // The manifests agree.
    let (out, _) = desk.run(&["diff"], 0);
    assert!(out.contains("of another run") && out.contains("`gearstudy run`"), "{out}");
    let of_f = json(&desk, &["f"], 4);
    let text = of_f.to_string();
    assert!(!text.contains("content hash alone") && of_f["damaged"].as_array().unwrap().is_empty(), "{of_f:#}");
    let table = || desk.run(&["table", "quick.yaml", "ste.curve", "--format", "csv"], 0).0;
    let from_cache = table();
    desk.run(&["query", "--format", "csv", "select count(*) from ste.curve"], 0);
    let (_, error) = desk.run(&["archive", "quick.yaml", "-o", "a.zip"], 1);
    assert!(error.contains("of another run") && error.contains("first: gearstudy run quick.yaml"), "{error}");
    let (verdicts, _) = desk.run(&["report", "quick.yaml"], 0);
    // A new page changes nothing of the tables.
    let (out, _) = desk.run(&["status", "quick.yaml"], 0);
    assert!(out.contains("of another run") && !out.contains("damaged"), "{out}");
    let (out, _) = desk.run(&["run", "quick.yaml"], 0);
    assert!(out.contains("nothing to compute, results brought up to date") && !out.contains("was not what"), "{out}");
    assert_eq!(desk.run(&["status", "--check", "quick.yaml"], 0).0.lines().next(), Some("quick: up to date"));
    assert_eq!(table(), from_cache);
    assert_eq!(desk.run(&["report", "quick.yaml"], 0).0, verdicts);
}

#[test]
fn without_the_cache_the_tables_of_another_run_are_named_as_such() {
    let desk = branched();
    fs::rename(desk.path(".gearstudy"), desk.path("aside")).unwrap();
    let (_, error) = desk.run(&["table", "quick.yaml", "ste.curve"], 1);
    assert!(error.contains("is of another run, and the cache does not have it"), "{error}");
    assert!(desk.run(&["query", "select * from ste.curve"], 2).1.contains("is of another run"));
    let (out, _) = desk.run(&["status", "quick.yaml"], 0);
    assert!(out.contains("of another run") && out.contains("stages again"), "{out}");
    let (out, _) = desk.run(&["diff"], 0);
    let said = "of another run, as `git checkout` leaves them; `gearstudy run` computes the right ones again";
    let lines = out.replace('\n', " ");
    assert!(lines.contains(said) && !lines.contains("from the cache"), "{out}");
    let (_, error) = desk.run(&["report", "quick.yaml"], 1);
    assert!(error.contains("is of another run") && !error.contains("damaged"), "{error}");
}

/// A file that is neither that of the manifest nor that of the other run.
#[test]
fn a_damaged_table_is_damaged_on_whatever_branch() {
    let desk = branched();
    let path = desk.path("results/quick/ste.curve.parquet");
    let mut bytes = fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&path, bytes).unwrap();
    let (out, error) = desk.run(&["status", "--check", "quick.yaml"], 4);
    assert!(out.contains("ste.curve.parquet: damaged") && error.contains("damaged"), "{out}{error}");
    assert!(desk.run(&["diff"], 4).0.contains("ste.curve.parquet"));
}
