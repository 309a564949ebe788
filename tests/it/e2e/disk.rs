//! `gearstudy diff` where the files are not what the manifests say, or are not files.

use std::fs;

use serde_json::Value;

use super::diff::{committed, git, json};
use studygraph::store::parquet;
use studygraph::table::data::{Data, Table};

/// Equal manifests say nothing of the files beside them.
#[test]
fn files_that_are_not_what_their_manifest_says_are_told_first() {
    let desk = committed();
    let file = |name: &str| desk.path("results/quick").join(name);
    let whole = |name: &str| fs::read(file(name)).unwrap();
    let told = |words: &[&str]| -> Vec<(String, String)> {
        let diff = json(&desk, words, 4);
        assert_eq!(diff["state"], "changed");
        let damaged = diff["damaged"].as_array().unwrap();
        let text = |value: &Value| value.as_str().unwrap().to_owned();
        damaged.iter().map(|damage| (text(&damage["file"]), text(&damage["problem"]))).collect()
    };
    let (name, hdf5) = ("ste.summary.parquet", "quick.h5");
    let (summary, all) = (whole(name), whole(hdf5));
    // Edited: a table with one other value; as many bytes or not.
    let table = parquet::read(summary.clone()).unwrap();
    let position = table.schema().position("mean").unwrap();
    let mut columns = table.columns().to_vec();
    let Data::Float(values) = &mut columns[position] else { panic!() };
    values[0] *= 1.5;
    let edited = Table::from_columns(table.schema().clone(), columns).unwrap();
    fs::write(file(name), parquet::write(&edited).unwrap()).unwrap();
    assert_eq!(told(&[]), [(name.to_owned(), "holds other values than its manifest says".to_owned())]);
    let (pretty, _) = desk.run(&["diff"], 4);
    assert!(pretty.lines().nth(2).unwrap().starts_with("1 file is not what its manifest says"), "{pretty}");
    assert!(pretty.contains("! results: quick/ste.summary.parquet holds other values"), "{pretty}");
    for format in ["markdown", "html"] {
        let (text, _) = desk.run(&["diff", "--format", format], 4);
        assert!(
            text.find("not what its manifest says").unwrap()
                < text.find("= quick").or(text.find("id=\"study-quick\"")).unwrap()
        );
    }
    // Of two folders each is looked at, and of two commits.
    assert_eq!(told(&["results", "results"]).len(), 2);
    git(&desk, &["commit", "-qam", "edited"]);
    assert_eq!(told(&["HEAD~1", "HEAD"]).len(), 1);
    // Truncated, absent, no table at all, another size of what is not a table.
    fs::write(file(name), &summary[..summary.len() / 2]).unwrap();
    assert!(told(&["HEAD~1"])[0].1.starts_with("is damaged"), "{:?}", told(&["HEAD~1"]));
    fs::remove_file(file(name)).unwrap();
    assert!(told(&["HEAD~1"])[0].1.starts_with("is not there; HEAD~1 ("), "{:?}", told(&["HEAD~1"]));
    fs::create_dir(file(name)).unwrap();
    assert_eq!(told(&["HEAD~1"])[0].1, "cannot be read: it is not a regular file");
    fs::remove_dir(file(name)).unwrap();
    fs::write(file(name), &summary).unwrap();
    fs::write(file(hdf5), &all[1..]).unwrap();
    assert!(told(&["HEAD~1"])[0].1.starts_with("has "), "{:?}", told(&["HEAD~1"]));
    fs::write(file(hdf5), &all).unwrap();
    json(&desk, &["HEAD~1"], 0);
    // What git does not keep need not be here; where it is, it must be right.
    fs::write(file("ste.curve.parquet"), "PAR1 nonsense PAR1").unwrap();
    assert_eq!(told(&["HEAD~1"])[0].0, "ste.curve.parquet");
    fs::remove_file(file("ste.curve.parquet")).unwrap();
    json(&desk, &["HEAD~1"], 0);
}

/// Results that were moved to another disk, with a link in their place.
#[cfg(unix)]
#[test]
fn the_results_folder_may_be_a_link() {
    let desk = committed();
    let elsewhere = tempfile::tempdir().unwrap();
    let moved = elsewhere.path().join("moved");
    let copied = std::process::Command::new("cp").arg("-r").arg(desk.path("results")).arg(&moved).status().unwrap();
    assert!(copied.success());
    fs::remove_dir_all(desk.path("results")).unwrap();
    std::os::unix::fs::symlink(&moved, desk.path("results")).unwrap();
    assert_eq!(json(&desk, &[], 0)["studies"][0]["name"], "quick");
    json(&desk, &["main", "quick"], 0);
    fs::remove_file(moved.join("quick/ste.summary.parquet")).unwrap();
    assert_eq!(json(&desk, &[], 4)["damaged"][0]["file"], "ste.summary.parquet");
    // In the same repository, and the link itself committed.
    fs::remove_file(desk.path("results")).unwrap();
    git(&desk, &["checkout", "-q", "--", "results"]);
    fs::rename(desk.path("results"), desk.path("kept")).unwrap();
    std::os::unix::fs::symlink("kept", desk.path("results")).unwrap();
    fs::write(desk.path(".gitignore"), ".gearstudy/\n").unwrap();
    git(&desk, &["add", "-A"]);
    git(&desk, &["commit", "-qm", "moved"]);
    assert_eq!(json(&desk, &[], 0)["studies"][0]["name"], "quick");
}

/// The verdicts of a study that is gone are told one by one, and what is read is named as the study names it.
#[test]
fn what_is_gone_and_what_came_in_is_told_by_name() {
    let desk = committed();
    let verdicts = |diff: &Value| -> Vec<Value> { diff["verdicts"].as_array().unwrap().clone() };
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    // The second giver of designs: `ste` reads it through a port of its own.
    fs::write(desk.path("quick.yaml"), text.replacen("seed: 1", "seed: 2", 1)).unwrap();
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let diff = json(&desk, &[], 4);
    let stages = diff["studies"][0]["stages"].as_array().unwrap();
    let ste = stages.iter().find(|stage| stage["name"] == "ste").unwrap();
    let why = &ste["why"][0];
    assert_eq!((&why["part"], &why["what"]), (&"input".into(), &"designs_2".into()));
    let from: Vec<&str> = why["from"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    assert!(!from.is_empty() && from.iter().all(|name| name.starts_with("optimum.")), "{from:?}");
    let (pretty, _) = desk.run(&["diff"], 4);
    let shown = "why: input optimum (best, history, passes, elements changed)";
    assert!(pretty.contains(shown) && !pretty.contains("designs_2"), "{pretty}");
    let several = desk.run(&["diff", "--tolerance", "mean=1"], 4).0;
    assert!(several.contains("the tolerance of `mean` is that of 3 columns: optimum.history.mean, "), "{several}");
    fs::remove_dir_all(desk.path("results/quick")).unwrap();
    fs::create_dir_all(desk.path("results/empty")).unwrap();
    fs::write(desk.path("quick.yaml"), text.replacen("study: quick", "study: other", 1)).unwrap();
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    // With the same tables it would be the same study under another name.
    let path = desk.path("results/other/manifest.json");
    let mut manifest: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    for stage in manifest["stages"].as_array_mut().unwrap() {
        for table in stage["tables"].as_array_mut().unwrap() {
            table["content"] = "0".repeat(32).into();
        }
    }
    fs::write(&path, serde_json::to_vec(&manifest).unwrap()).unwrap();
    let gone = verdicts(&json(&desk, &[], 4));
    assert!(
        !gone.is_empty() && gone.iter().all(|flip| flip["after"].is_null() && flip["study"] == "quick"),
        "{gone:?}"
    );
    let (pretty, _) = desk.run(&["diff"], 4);
    assert!(pretty.contains(" → gone: "), "{pretty}");
}

/// Whoever writes a manifest does not write the terminal, nor the page.
#[test]
fn names_and_cells_steer_neither_terminal_nor_page() {
    let desk = committed();
    let path = desk.path("results/quick/manifest.json");
    let mut manifest: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    let bad = "x\u{1b}[2J|`</code><script>alert(1)</script>*\u{202e}\r";
    for stage in manifest["stages"].as_array_mut().unwrap() {
        if stage["name"] == "ste" {
            stage["kind"] = bad.into();
            stage["tables"][0]["name"] = format!("ste.{bad}").into();
            stage["tables"][0]["content"] = bad.into();
        }
        if stage["name"] == "stiffness" {
            stage["name"] = bad.into();
        }
    }
    fs::write(&path, serde_json::to_vec(&manifest).unwrap()).unwrap();
    for format in ["pretty", "markdown", "html", "json"] {
        let (out, error) = desk.run(&["diff", "--format", format], 4);
        for text in [&out, &error] {
            let steers = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
            assert!(!text.contains(steers), "{format}: {}", text.escape_debug());
        }
        assert!(out.contains("\\u001b[2J") || out.contains("\\u001b\\[2J"), "{format}: {out}");
        if format == "markdown" || format == "html" {
            assert!(!out.contains("<script>alert"), "{out}");
        }
        if format == "markdown" {
            assert!(!out.contains("x\\u001b[2J|"), "{out}");
        }
    }
    let (out, _) = desk.run(&["table", "quick.yaml"], 0);
    assert!(!out.contains('\u{1b}') && out.contains("\\u001b[2J"), "{out}");
}

/// A file named by its name alone goes into the current folder, and that is what a message names.
#[cfg(target_os = "linux")]
#[test]
fn where_nothing_can_be_written_is_said() {
    let desk = committed();
    let at = |name: &str| desk.path(name).display().to_string();
    let words = ["--results", &at("results"), "--cache", &at(".gearstudy/cache"), "archive", &at("quick.yaml")];
    // Not even root writes there.
    let output = desk.command(&[&words[..], &["-o", "a.zip"]].concat()).current_dir("/proc").output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(1) && error.contains("cannot write into `.`"), "{error}");
}
