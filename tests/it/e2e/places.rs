//! Folders that cannot be written, files where folders should be: one message, no panic, and nothing lost.
//!
//! Everything is tried with paths that run through a regular file, which no user, root included, can make a folder of.

use std::fs;

use crate::desk::Desk;

/// The last line of standard error is the program's; it must be one sentence that names the path.
fn one_message(error: &str, path: &str) {
    let own: Vec<&str> = error.lines().filter(|line| line.starts_with("gearstudy: ")).collect();
    assert_eq!(own.len(), 1, "{error}");
    assert!(own[0].contains(path) && !error.contains("panicked"), "{error}");
}

#[test]
fn results_that_cannot_be_there_are_one_message_before_anything_is_computed() {
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("file"), "").unwrap();
    for results in ["file", "file/below"] {
        let (_, error) = desk.run(&["run", "quick.yaml", "--results", results], 1);
        one_message(&error, results);
    }
    desk.run(&["run", "quick.yaml"], 0);
    let statuses = desk.statuses("quick");
    assert!(statuses.iter().all(|(_, status)| status == "ran"), "nothing was computed in vain: {statuses:?}");
}

#[test]
fn a_file_where_the_study_s_folder_should_be_is_left_alone() {
    let desk = Desk::with("quick.yaml");
    fs::create_dir(desk.path("results")).unwrap();
    fs::write(desk.path("results/quick"), "mine").unwrap();
    let (_, error) = desk.run(&["run", "quick.yaml"], 1);
    one_message(&error, "results/quick");
    assert_eq!(fs::read_to_string(desk.path("results/quick")).unwrap(), "mine");
}

/// Where a table should go there is a folder: the table cannot be renamed into place.
#[test]
fn a_table_that_cannot_be_put_in_place_is_named() {
    let desk = Desk::with("quick.yaml");
    fs::create_dir_all(desk.path("results/quick/ste.curve.parquet")).unwrap();
    let (_, error) = desk.run(&["run", "quick.yaml"], 1);
    one_message(&error, "ste.curve.parquet");
    let left: Vec<_> = fs::read_dir(desk.path("results/quick"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .filter(|name| name.starts_with('.'))
        .collect();
    assert!(left.is_empty(), "{left:?}");
    fs::remove_dir(desk.path("results/quick/ste.curve.parquet")).unwrap();
    desk.run(&["run", "quick.yaml"], 0);
    desk.run(&["table", "quick.yaml", "ste.curve"], 0);
}

#[test]
fn damage_in_the_cache_or_the_results_is_mended() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml"], 0);
    let before = desk.contents("quick");
    fs::write(desk.path("results/quick/ste.curve.parquet"), "no table").unwrap();
    fs::remove_file(desk.path("results/quick/quick.h5")).unwrap();
    fs::write(desk.path("results/quick/manifest.json"), "{ \"format\": ").unwrap();
    let mut cut = 0;
    for folder in fs::read_dir(desk.path(".gearstudy/cache/entries")).unwrap() {
        for entry in fs::read_dir(folder.unwrap().path()).unwrap() {
            let path = entry.unwrap().path();
            let bytes = fs::read(&path).unwrap();
            fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
            cut += 1;
        }
    }
    assert!(cut > 8);
    let (plan, _) = desk.run(&["plan", "quick.yaml"], 0);
    assert!(plan.contains("object damaged"), "{plan}");
    desk.run(&["run", "quick.yaml"], 0);
    assert_eq!(before, desk.contents("quick"));
    desk.run(&["table", "quick.yaml", "ste.curve"], 0);
    assert!(desk.run(&["run", "quick.yaml"], 0).0.contains("nothing to do"));
}

#[test]
fn an_empty_variable_is_one_that_is_not_set() {
    let desk = Desk::with("quick.yaml");
    let words = ["run", "quick.yaml", "--only", "pair", "--quiet"];
    desk.command(&words).env("GEARSTUDY_CACHE", "").assert().code(0);
    assert!(desk.path(".gearstudy/cache/entries").is_dir());
    desk.command(&words).env("GEARSTUDY_CACHE", "elsewhere").assert().code(0);
    assert!(desk.path("elsewhere/entries").is_dir());
    // On the command line an empty name is a slip.
    desk.command(&[&words[..], &["--cache", ""]].concat()).assert().code(1);
}

#[cfg(unix)]
#[test]
fn folders_whose_names_are_not_utf8_are_refused_before_anything_runs() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    let desk = Desk::with("quick.yaml");
    let odd = OsStr::from_bytes(b"w\xf6rter");
    for option in ["--results", "--cache"] {
        for command in ["run", "plan", "status", "report"] {
            let output = desk.command(&[command, "quick.yaml", option]).arg(odd).output().unwrap();
            let error = String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(output.status.code(), Some(1), "{command}: {error}");
            one_message(&error, "is not UTF-8: `w\u{fffd}rter`; name another with --");
        }
    }
    let output = desk.command(&["run", "quick.yaml"]).env("GEARSTUDY_CACHE", odd).output().unwrap();
    assert!(String::from_utf8_lossy(&output.stderr).contains("--cache or GEARSTUDY_CACHE"));
    assert!(!desk.path(".gearstudy").exists() && !desk.path("results").exists());
    // A study itself may be called as it likes.
    let study = OsStr::from_bytes(b"\xf6.yaml");
    fs::copy(desk.path("quick.yaml"), desk.path(".").join(study)).unwrap();
    for words in [&["run", "--only", "pair"][..], &["plan", "--json"], &["status", "--json"], &["check"]] {
        let output = desk.command(words).arg(study).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(matches!(output.status.code(), Some(0 | 4)), "{words:?} {:?}: {error}", output.status);
    }
}
