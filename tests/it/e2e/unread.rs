//! Folders and files that the system does not let be read: never taken for absent ones.

use std::fs;
use std::path::Path;

use crate::desk::Desk;

/// A link to itself in the place of a folder: it cannot be read, be it by root.
#[cfg(unix)]
fn obstruct(path: &Path) {
    fs::rename(path, path.with_extension("aside")).unwrap();
    std::os::unix::fs::symlink(path, path).unwrap();
}

#[cfg(unix)]
fn two_studies() -> Desk {
    let desk = Desk::with("quick.yaml");
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    fs::write(desk.path("other.yaml"), text.replace("study: quick", "study: other")).unwrap();
    desk.run(&["run", "--quiet", "quick.yaml", "other.yaml"], 0);
    fs::rename(desk.path("results/quick"), desk.path("quick.aside")).unwrap();
    std::os::unix::fs::symlink("quick", desk.path("results/quick")).unwrap();
    desk
}

#[cfg(unix)]
#[test]
fn results_that_cannot_be_read_are_not_absent() {
    let desk = two_studies();
    let (out, error) = desk.run(&["gc", "--days", "0"], 1);
    assert!(out.is_empty() && error.contains("quick/manifest.json"), "{out}{error}");
    let (_, error) = desk.run(&["diff", "results", "results"], 1);
    assert!(error.contains("`quick/manifest.json` of results cannot be read: "), "{error}");
    let (_, error) = desk.run(&["query", "select count(*) from quick.ste.summary"], 1);
    assert!(error.contains("`quick/manifest.json` of results cannot be read: "), "{error}");
    // Another study is answered for, and a list says which one is missing from it.
    let (out, _) = desk.run(&["query", "--format", "csv", "select count(*) as n from other.ste.summary"], 0);
    assert!(out.starts_with("n\n"), "{out}");
    let (out, error) = desk.run(&["query"], 0);
    assert!(out.contains("other.ste.summary") && !out.contains("quick."), "{out}");
    assert!(error.contains("warning: `quick/manifest.json` of results cannot be read: "), "{error}");
    assert!(desk.run(&["query", "--study", "quick"], 1).1.contains("cannot be read"));
    for words in [&["status", "quick.yaml"][..], &["table", "quick.yaml"], &["report", "quick.yaml"]] {
        assert!(desk.run(words, 1).1.contains("cannot read"), "{words:?}");
    }
    // Nothing of the cache is gone.
    fs::remove_file(desk.path("results/quick")).unwrap();
    fs::rename(desk.path("quick.aside"), desk.path("results/quick")).unwrap();
    assert_eq!(desk.run(&["status", "quick.yaml"], 0).0, "quick: up to date\n");
}

/// A link to a disk that is not mounted, in the place of a study's results, is not their absence; a file that cannot be read is not a
/// damaged one. Locks of editors beside a study are not studies.
#[cfg(unix)]
#[test]
fn a_link_that_leads_nowhere_is_not_an_absent_study() {
    let desk = two_studies();
    fs::remove_file(desk.path("results/quick")).unwrap();
    std::os::unix::fs::symlink("/not/mounted/quick", desk.path("results/quick")).unwrap();
    for words in [&["gc", "--days", "0"][..], &["diff", "results", "results"], &["status", "quick.yaml"]] {
        assert!(desk.run(words, 1).1.contains("the link `results/quick` leads nowhere"), "{words:?}");
    }
    fs::remove_file(desk.path("results/quick")).unwrap();
    fs::rename(desk.path("quick.aside"), desk.path("results/quick")).unwrap();
    let table = desk.path("results/quick/ste.summary.parquet");
    obstruct(&table);
    let (out, error) = desk.run(&["status", "--check", "quick.yaml"], 4);
    assert!(out.contains("ste.summary.parquet: cannot be read") && !error.contains("writes it anew"), "{out}{error}");
    fs::remove_file(&table).unwrap();
    fs::rename(table.with_extension("aside"), &table).unwrap();
    fs::create_dir(desk.path("studies")).unwrap();
    fs::rename(desk.path("quick.yaml"), desk.path("studies/quick.yaml")).unwrap();
    std::os::unix::fs::symlink("ada@host.1:2", desk.path("studies/.#quick.yaml")).unwrap();
    assert_eq!(desk.run(&["status", "quick"], 0).0, "quick: up to date\n");
}

/// What a check of the cache cannot read or remove is not gone from it.
#[cfg(unix)]
#[test]
fn entries_of_the_cache_that_stay_are_not_said_to_be_gone() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let entries = desk.path(".gearstudy/cache/entries");
    let folders: Vec<_> = fs::read_dir(&entries).unwrap().map(|folder| folder.unwrap().path()).collect();
    // Where links lead in a circle, also the owner of all files cannot read.
    let aside = desk.path("aside");
    fs::rename(&folders[0], &aside).unwrap();
    fs::create_dir(&folders[0]).unwrap();
    let entry = fs::read_dir(&aside).unwrap().next().unwrap().unwrap().file_name();
    std::os::unix::fs::symlink(folders[0].join(&entry), folders[0].join(&entry)).unwrap();
    let (_, error) = desk.run(&["status", "--check", "quick.yaml"], 1);
    assert!(error.contains("cannot read `.gearstudy/cache/entries/") && !error.contains("gone from it"), "{error}");
    fs::remove_dir_all(&folders[0]).unwrap();
    fs::rename(&aside, &folders[0]).unwrap();
    // A damaged one is gone, and said to be so.
    let path = folders[0].join(&entry);
    let mut bytes = fs::read(&path).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(&path, bytes).unwrap();
    let (_, error) = desk.run(&["status", "--check", "quick.yaml"], 4);
    assert!(error.contains("damaged in the cache, and gone from it now") && !path.exists(), "{error}");
}

#[cfg(unix)]
#[test]
fn a_results_folder_and_a_cache_that_cannot_be_read_are_not_absent() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    let cache = desk.path(".gearstudy");
    obstruct(&cache);
    for words in [&["diff", "results", "results"][..], &["query"], &["gc"], &["status", "--check", "quick.yaml"]] {
        assert!(desk.run(words, 1).1.contains(".gearstudy/cache"), "{words:?}");
    }
    let (out, error) = desk.run(&["status", "quick.yaml"], 0);
    assert!(out.contains("up to date") && error.contains("warning: cannot read `.gearstudy/cache`"), "{out}{error}");
    fs::remove_file(&cache).unwrap();
    fs::rename(cache.with_extension("aside"), &cache).unwrap();
    obstruct(&desk.path("results"));
    for words in [
        &["diff", "results", "results"][..],
        &["diff"],
        &["query"],
        &["gc", "--days", "0"],
        &["status", "quick.yaml"],
        &["archive", "quick.yaml", "-o", "a.zip"],
    ] {
        let (out, error) = desk.run(words, 1);
        assert!(out.is_empty() && error.contains("results"), "{words:?}: {out}{error}");
        assert!(!error.contains("there is no") && !error.contains("no results"), "{words:?}: {error}");
    }
}

#[cfg(unix)]
#[test]
fn a_folder_of_studies_that_cannot_be_read_is_not_empty() {
    let desk = Desk::with("quick.yaml");
    std::os::unix::fs::symlink("studies", desk.path("studies")).unwrap();
    for words in [&["status"][..], &["run", "quick"], &["check", "quick"]] {
        let (_, error) = desk.run(words, 1);
        assert!(error.contains("cannot read `studies`"), "{words:?}: {error}");
    }
    // A file that is named by its path needs no list.
    desk.run(&["check", "quick.yaml"], 0);
}
