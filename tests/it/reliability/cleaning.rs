//! `gc` with what is none of its own in the cache, with leftovers, and with a cache that cannot be read.

use std::fs;

use super::cache::tiny;

#[test]
fn what_is_foreign_is_left_alone_and_named() {
    let desk = tiny();
    desk.run(&["run", "tiny.yaml"], 0);
    let cache = desk.path(".gearstudy/cache");
    let folder = fs::read_dir(cache.join("entries")).unwrap().next().unwrap().unwrap().path();
    let foreign = [
        cache.join("entries/notes.txt"),
        cache.join("entries/zz/mine"),
        folder.join("Thumbs.db"),
        folder.join("sub/file"),
    ];
    for path in &foreign {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "mine").unwrap();
    }
    let kept = desk.contents("tiny");
    // What results need is never removed.
    fs::remove_dir_all(desk.path("results")).unwrap();
    let (out, error) = desk.run(&["gc", "--days", "0", "--dry-run"], 0);
    assert!(out.starts_with("would delete 3 entries"), "{out}");
    for name in ["notes.txt", "entries/zz", "Thumbs.db", "sub"] {
        assert!(error.contains(name), "{error}");
    }
    let (out, _) = desk.run(&["gc", "--days", "0"], 0);
    assert!(out.starts_with("deleted 3 entries"), "{out}");
    for path in &foreign {
        assert_eq!(fs::read_to_string(path).unwrap(), "mine");
    }
    desk.run(&["run", "tiny.yaml"], 0);
    assert_eq!(desk.contents("tiny"), kept);
}

#[test]
fn leftovers_go_wherever_they_are() {
    let desk = tiny();
    desk.run(&["run", "tiny.yaml"], 0);
    let cache = desk.path(".gearstudy/cache");
    let folder = fs::read_dir(cache.join("entries")).unwrap().next().unwrap().unwrap().path();
    let left =
        [cache.clone(), cache.join("journals"), cache.join("entries"), folder].map(|at| at.join(".partial-Ab12"));
    for path in &left {
        fs::write(path, "left behind").unwrap();
    }
    let (out, error) = desk.run(&["gc", "--dry-run"], 0);
    assert!(out.contains("4 leftovers"), "{out}");
    assert!(left.iter().all(|path| path.exists()), "a dry run removes nothing");
    let (out, again) = desk.run(&["gc"], 0);
    assert!(out.starts_with("deleted 0 entries") && out.contains("4 leftovers"), "{out}");
    assert!(left.iter().all(|path| !path.exists()));
    assert_eq!((error, again), (String::new(), String::new()));
}

#[test]
fn a_cache_that_cannot_be_read_is_an_error() {
    let desk = tiny();
    let (out, _) = desk.run(&["gc"], 0);
    assert!(out.starts_with("deleted 0 entries"), "there is none: {out}");
    fs::write(desk.path("file"), "").unwrap();
    for cache in ["file", "file/below"] {
        let (out, error) = desk.run(&["gc", "--cache", cache], 1);
        assert!(out.is_empty() && error.contains(cache), "{out}{error}");
    }
    desk.run(&["run", "tiny.yaml"], 0);
    let entries = desk.path(".gearstudy/cache/entries");
    fs::remove_dir_all(&entries).unwrap();
    fs::write(&entries, "no folder").unwrap();
    let (out, error) = desk.run(&["gc"], 1);
    assert!(out.is_empty() && error.contains("entries"), "{out}{error}");
    // A folder that is not a cache has nothing to clean, whatever lies in it.
    fs::create_dir_all(desk.path("mine/entries/ab")).unwrap();
    fs::write(desk.path("mine/entries/ab/cd"), "mine").unwrap();
    desk.run(&["gc", "--cache", "mine", "--days", "0"], 0);
    assert_eq!(fs::read_to_string(desk.path("mine/entries/ab/cd")).unwrap(), "mine");
}

/// Nobody waits for a pipe, and whoever waits can be stopped.
#[cfg(unix)]
#[test]
fn pipes_and_folders_in_the_place_of_files_stop_no_cleaning() {
    let desk = tiny();
    desk.run(&["run", "tiny.yaml"], 0);
    let cache = desk.path(".gearstudy/cache");
    let folder = fs::read_dir(cache.join("entries")).unwrap().next().unwrap().unwrap().path();
    let entry = fs::read_dir(&folder).unwrap().next().unwrap().unwrap().path();
    for path in [&entry, &cache.join("journals/tiny.json"), &cache.join("CACHEDIR.TAG")] {
        fs::remove_file(path).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(path).status().unwrap().success());
    }
    fs::create_dir(cache.join("entries/00")).unwrap_or_default();
    fs::remove_dir_all(desk.path("results")).unwrap();
    let mut command = desk.command(&["gc", "--days", "0"]);
    let output = command.timeout(std::time::Duration::from_secs(20)).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stdout).starts_with("deleted 2 entries"));
}

/// Two commits with results, other results in the folder: what each needs is computed by nobody again.
#[test]
fn what_results_and_named_commits_need_is_kept() {
    let desk = tiny();
    let git = |words: &[&str]| {
        let identity = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"];
        let mut command = std::process::Command::new("git");
        let output = command.arg("-C").arg(desk.path("")).args(identity).args(words).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    let run = |width: &str| {
        let text = fs::read_to_string(desk.path("tiny.yaml")).unwrap();
        let (before, rest) = text.split_once("face_width: ").unwrap();
        let (_, after) = rest.split_once(" mm").unwrap();
        fs::write(desk.path("tiny.yaml"), format!("{before}face_width: {width} mm{after}")).unwrap();
        desk.run(&["run", "tiny.yaml"], 0);
    };
    git(&["init", "-q"]);
    for (width, message) in [("20", "first"), ("21", "second")] {
        run(width);
        git(&["add", "-f", "results/tiny/manifest.json"]);
        git(&["commit", "-qm", message]);
        git(&["tag", message]);
    }
    run("22");
    let (out, error) = desk.run(&["gc", "--max-size", "1kB", "--keep", "first"], 0);
    assert!(!out.starts_with("deleted 0 entries") && out.contains("needed by results"), "{out}");
    assert!(error.contains("what results need is more than 0.0 MB by itself, and stays"), "{error}");
    let computed = |width: &str| {
        run(width);
        desk.ran("tiny").len()
    };
    assert_eq!(computed("20"), 0, "of the named commit");
    assert_eq!(computed("22"), 0, "of the results in the folder");
    assert!(computed("21") > 0, "of nobody");
    let (_, error) = desk.run(&["gc", "--keep", "frist"], 1);
    assert!(error.contains("did you mean `first`"), "{error}");
    // Results that cannot be read need nobody knows what: nothing goes.
    fs::write(desk.path("results/tiny/manifest.json"), "{").unwrap();
    let (out, error) = desk.run(&["gc", "--days", "0"], 1);
    assert!(out.is_empty() && error.contains("is damaged"), "{out}{error}");
}
