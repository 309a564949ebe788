//! `gearstudy status` as a user asks it: after runs, in a clone, of several studies, of what is not a file.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::diff::{committed, git};
use crate::desk::Desk;

/// Neither the cache nor a run is needed to say where results stand.
#[test]
fn status_says_what_is_up_to_date_stale_and_missing() {
    let desk = Desk::with("quick.yaml");
    let states = |words: &[&str]| -> Vec<(String, String, String)> {
        let (json, _) = desk.run(&[&["status", "--json"], words].concat(), 0);
        let said: Value = serde_json::from_str(&json).unwrap();
        let text = |value: &Value| value.as_str().unwrap().to_owned();
        let stages = said[0]["stages"].as_array().unwrap().clone();
        stages.iter().map(|stage| (text(&stage["name"]), text(&stage["state"]), text(&stage["why"]))).collect()
    };
    let (out, _) = desk.run(&["status", "quick.yaml"], 0);
    assert_eq!(out, "quick: no results; next: gearstudy run quick.yaml\n");
    assert!(states(&["quick.yaml"]).iter().all(|(_, state, _)| state == "missing"));
    desk.run(&["run", "quick.yaml", "--quiet"], 0);
    fs::remove_dir_all(desk.path(".gearstudy")).unwrap();
    let again = "quick: up to date; the cache does not have 6 of 6 stages, so a run computes them again\n";
    assert_eq!(desk.run(&["status", "quick.yaml"], 0).0, again);
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    fs::write(desk.path("quick.yaml"), text.replace("module: 3 mm", "module: 3.1 mm")).unwrap();
    let said = states(&["quick.yaml"]);
    assert_eq!(said[0], ("pair".into(), "stale".into(), "config changed: module".into()));
    assert!(said[1..].iter().all(|(_, state, _)| state == "waits"), "{said:?}");
    assert!(said.iter().any(|(name, _, why)| name == "stiffness" && why == "for pair"), "{said:?}");
    assert!(!desk.path(".gearstudy").exists(), "status makes no cache");
    // A stage under another name: the old one is gone, the new one never ran.
    let renamed = text.replace("\n  ste:", "\n  loaded:").replace("ste.", "loaded.");
    fs::write(desk.path("quick.yaml"), renamed).unwrap();
    let (out, _) = desk.run(&["status", "quick.yaml"], 0);
    assert!(out.contains("the results have stages that the study has not: ste"), "{out}");
    assert!(states(&["quick.yaml"]).contains(&("loaded".into(), "missing".into(), "never ran".into())));
    // Without names: those in the folder `studies`.
    fs::write(desk.path("quick.yaml"), &text).unwrap();
    assert!(desk.run(&["status"], 1).1.contains("no studies in `studies`"));
    fs::create_dir(desk.path("studies")).unwrap();
    fs::rename(desk.path("quick.yaml"), desk.path("studies/quick.yaml")).unwrap();
    assert_eq!(desk.run(&["status"], 0).0, again.replace("quick.yaml", "studies/quick.yaml"));
    fs::remove_file(desk.path("results/quick/figures/torque.svg")).unwrap();
    let (out, _) = desk.run(&["status"], 0);
    assert_eq!(out, "quick: the report is not that of the last run; next: gearstudy report studies/quick.yaml\n");
}

/// A clone has what git keeps: that is not a fault, and what a run does there is what `status` says it does.
#[test]
fn tables_that_git_does_not_keep_are_not_missing() {
    let desk = committed();
    let kept = git(&desk, &["ls-files", "results/quick"]);
    let listed = desk.manifest("quick")["files"].as_array().unwrap().clone();
    let absent = listed.iter().filter(|file| !kept.contains(file["file"].as_str().unwrap())).count();
    // HDF5 file, page and figures are not of a stage.
    let others = listed.iter().filter(|file| !file["file"].as_str().unwrap().ends_with(".parquet")).count();
    let tables = absent - others;
    git(&desk, &["clone", "-q", ".", "clone"]);
    let clone = |words: &[&str]| {
        let output = desk.command(words).current_dir(desk.path("clone")).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let next = "next: gearstudy run quick.yaml";
    let status = clone(&["status", "quick.yaml"]);
    assert_eq!(status, format!("quick: up to date, {absent} files not here; {next} computes 6 of 6 stages again\n"));
    let value: Value = serde_json::from_str(&clone(&["status", "--json", "quick.yaml"])).unwrap();
    assert_eq!((&value[0]["up_to_date"], &value[0]["tables_here"]), (&true.into(), &false.into()));
    assert_eq!(value[0]["stages_not_in_cache"], 6);
    let stages = value[0]["stages"].as_array().unwrap();
    assert!(stages.iter().all(|stage| stage["state"] == "up to date"), "{value:#}");
    let names = |stage: &Value| stage["not_here"].as_array().unwrap().len();
    assert_eq!(stages.iter().map(names).sum::<usize>(), tables);
    let cache = desk.path(".gearstudy/cache").display().to_string();
    let status = clone(&["--cache", &cache, "status", "quick.yaml"]);
    assert_eq!(status, format!("quick: up to date, {absent} files not here; {next} takes them from the cache\n"));
    // Whoever checks has to have every file, or a cache that can give them back.
    clone(&["--cache", &cache, "status", "--check", "quick.yaml"]);
    let checked = desk.command(&["status", "--check", "quick.yaml"]).current_dir(desk.path("clone")).output().unwrap();
    assert_eq!(checked.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&checked.stderr).contains("missing; `gearstudy run` writes it anew"));
    // Verdicts that are not here are not the same as none.
    let report = desk.command(&["report", "--check", "quick.yaml"]).current_dir(desk.path("clone")).output().unwrap();
    assert_eq!(report.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&report.stderr).contains("is not here, and the cache does not have it"));
    clone(&["--cache", &cache, "report", "--check", "quick.yaml"]);
    // It does.
    clone(&["--cache", &cache, "run", "--quiet", "quick.yaml"]);
    assert_eq!(clone(&["--cache", &cache, "status", "quick.yaml"]), "quick: up to date\n");
}

/// Whatever of the published files is not there, and no cache has it: `--check` ends with 4, and a run brings it back.
#[test]
fn a_file_that_is_gone_is_missing_unless_the_cache_has_it() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let (results, cache, aside) = (desk.path("results/quick"), desk.path(".gearstudy"), desk.path("aside"));
    let page = "the report is not that of the last run";
    for (file, told) in [
        ("quick.h5", "up to date, 1 file not here (quick.h5); next: gearstudy run quick.yaml"),
        ("report.html", page),
        ("figures/torque.svg", page),
        ("files.json", page),
    ] {
        fs::remove_file(results.join(file)).unwrap();
        let (out, _) = desk.run(&["status", "quick.yaml"], 0);
        assert!(out.contains(told), "{file}: {out}");
        let (_, error) = desk.run(&["status", "--check", "quick.yaml"], 4);
        assert!(file == "files.json" || error.contains(&format!("results/quick/{file}")), "{error}");
        let (_, error) = desk.run(&["report", "--check", "quick.yaml"], 4);
        let named = if file == "files.json" { page } else { file };
        assert!(error.contains(named) && error.contains("first: gearstudy run quick.yaml"), "{error}");
        let value: Value =
            serde_json::from_str(&desk.run(&["report", "--check", "--json", "quick.yaml"], 4).0).unwrap();
        assert!(value[0]["stale"].as_str().unwrap().contains(named), "{value:#}");
        desk.run(&["run", "--quiet", "quick.yaml"], 0);
        assert_eq!(desk.run(&["status", "--check", "quick.yaml"], 0).0.lines().next(), Some("quick: up to date"));
    }
    fs::remove_file(results.join("ste.curve.parquet")).unwrap();
    // `table` and `query` have it from the cache.
    desk.run(&["status", "--check", "quick.yaml"], 0);
    desk.run(&["table", "quick.yaml", "ste.curve"], 0);
    desk.run(&["report", "--check", "quick.yaml"], 0);
    fs::rename(&cache, &aside).unwrap();
    let (_, error) = desk.run(&["report", "--check", "quick.yaml"], 4);
    assert!(error.contains("`results/quick/ste.curve.parquet` is missing"), "{error}");
    let (out, error) = desk.run(&["status", "--check", "quick.yaml"], 4);
    assert!(out.contains("1 file not here (ste.curve.parquet)"), "{out}");
    assert!(error.contains("missing; `gearstudy run` writes it anew:\n  results/quick/ste.curve.parquet"), "{error}");
    let value: Value = serde_json::from_str(&desk.run(&["status", "--check", "--json", "quick.yaml"], 4).0).unwrap();
    assert_eq!((&value[0]["tables_here"], &value[0]["not_here"]), (&false.into(), &Value::Array(Vec::new())));
    assert!(
        desk.run(&["table", "quick.yaml", "ste.curve"], 1).1.contains("is not here, and the cache does not have it")
    );
}

/// Studies by name, and one that is broken between others.
/// What is shown need not be what the study is now; that is said, and changes nothing.
#[test]
fn tables_and_verdicts_that_are_stale_are_told_in_a_line() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml", "--quiet"], 0);
    let shows = [&["table", "quick.yaml", "ste.summary"][..], &["table", "quick.yaml"], &["report", "quick.yaml"]];
    let before = shows.map(|words| desk.run(words, 0));
    assert!(before.iter().all(|(_, error)| error.is_empty()), "{before:?}");
    // That a file is not as it was written is for `status` to tell: while a run publishes, it need not be.
    let curve = desk.path("results/quick/ste.curve.parquet");
    let kept = fs::read(&curve).unwrap();
    fs::write(&curve, "other").unwrap();
    assert_eq!(desk.run(shows[0], 0).1, "");
    fs::write(&curve, kept).unwrap();
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    fs::write(desk.path("quick.yaml"), text.replace("module: 3 mm", "module: 3.1 mm")).unwrap();
    for (words, (out, _)) in shows.iter().zip(before) {
        let (now, error) = desk.run(words, 0);
        assert_eq!(now, out);
        let said = "gearstudy: quick: the results are not those of the study now: stage `pair` is not up to date: stale: config \
                    changed: module; first: gearstudy run quick.yaml\n";
        assert_eq!(error, said, "{words:?}");
        assert_eq!(desk.run(&[words, &["--quiet"][..]].concat(), 0).1, "");
    }
}

#[test]
fn studies_have_names_and_one_that_is_broken_silences_no_other() {
    let desk = Desk::with("quick.yaml");
    fs::create_dir(desk.path("studies")).unwrap();
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    fs::rename(desk.path("quick.yaml"), desk.path("studies/quick.yaml")).unwrap();
    fs::write(desk.path("studies/file.yaml"), text.replace("study: quick", "study: other")).unwrap();
    desk.run(&["run", "--quiet", "quick"], 0);
    assert_eq!(desk.run(&["status", "quick"], 0).0, "quick: up to date\n");
    assert_eq!(desk.run(&["status", "other"], 0).0, "other: no results; next: gearstudy run studies/file.yaml\n");
    desk.run(&["archive", "quick", "-o", "a.zip"], 0);
    desk.run(&["check", "quick", "other"], 0);
    assert!(desk.run(&["status", "quik"], 1).1.contains("did you mean `quick`?"));
    fs::write(desk.path("studies/broken.yaml"), text.replace("seed: 1", "sead: 1")).unwrap();
    fs::create_dir_all(desk.path("results/other")).unwrap();
    fs::write(desk.path("results/other/manifest.json"), "{").unwrap();
    let (out, error) = desk.run(&["status"], 2);
    let lines: Vec<&str> = out.lines().collect();
    assert_eq!(lines.len(), 3, "{out}");
    assert!(lines[0].starts_with("studies/broken.yaml:") && lines[0].contains("sead"), "{out}");
    assert!(lines[1].contains("results/other/manifest.json` is damaged"), "{out}");
    assert_eq!(lines[2], "quick: up to date");
    assert_eq!(error, "gearstudy: 2 of 3 studies could not be looked at\n");
    let value: Value = serde_json::from_str(&desk.run(&["status", "--json"], 2).0).unwrap();
    assert!(value[0]["problem"].as_str().unwrap().contains("sead") && value[2]["study"] == "quick", "{value:#}");
    // By itself a study is refused as everywhere.
    assert!(desk.run(&["status", "broken"], 2).1.contains("help"), "{}", desk.run(&["status", "broken"], 2).1);
}

/// A pipe nobody writes to, a device without an end, a folder, a file of many bytes: refused at once.
#[cfg(unix)]
#[test]
fn what_is_no_file_is_refused_at_once() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let (manifest, table) = (desk.path("results/quick/manifest.json"), desk.path("results/quick/ste.summary.parquet"));
    let (whole, rows) = (fs::read(&manifest).unwrap(), fs::read(&table).unwrap());
    let refused = |words: &[&str], code: i32, wanted: &str| {
        let mut command = desk.command(words);
        let output = command.timeout(std::time::Duration::from_secs(20)).output().unwrap();
        let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(code), "{words:?}: {said}");
        assert!(said.contains(wanted), "{words:?}: {said}");
    };
    let pipe = |path: &Path| assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
    let make = |path: &Path, what: &str| match what {
        "pipe" => pipe(path),
        "device" => std::os::unix::fs::symlink("/dev/zero", path).unwrap(),
        "folder" => fs::create_dir(path).unwrap(),
        _ => fs::File::create(path).unwrap().set_len(1 << 40).unwrap(),
    };
    let replace = |path: &Path, bytes: &[u8]| {
        if path.is_dir() {
            fs::remove_dir(path).unwrap();
        } else {
            fs::remove_file(path).unwrap();
        }
        fs::write(path, bytes).unwrap();
    };
    for what in ["pipe", "device", "folder", "large"] {
        let wanted = if what == "large" { "more than 64 MiB" } else { "not a regular file" };
        fs::remove_file(&manifest).unwrap();
        make(&manifest, what);
        refused(&["status", "quick.yaml"], 1, wanted);
        refused(&["archive", "quick.yaml", "-o", "a.zip"], 1, wanted);
        refused(&["table", "quick.yaml"], 1, wanted);
        refused(&["diff", "results", "results"], 1, wanted);
        replace(&manifest, &whole);
        fs::remove_file(&table).unwrap();
        make(&table, what);
        refused(&["diff", "results", "results"], 4, "ste.summary.parquet");
        refused(&["status", "quick.yaml"], 0, "`ste.summary.parquet` is not as the manifest lists it");
        refused(&["table", "quick.yaml", "ste.summary"], 1, "ste.summary.parquet");
        replace(&table, &rows);
    }
    pipe(&desk.path("a.zip"));
    refused(&["verify", "a.zip"], 1, "it is neither a file nor a folder");
    fs::create_dir(desk.path("studies")).unwrap();
    pipe(&desk.path("studies/pipe.yaml"));
    refused(&["status"], 1, "there are no studies");
}
