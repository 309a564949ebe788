//! A cache or a journal that takes nothing costs time, never results.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::desk::Desk;

/// A study of four stages that takes some milliseconds.
pub const TINY: &str = "\
study: tiny
title: Geometry, one modification and a figure
seed: 1
stages:
  pair:
    kind: geometry
    module: 3 mm
    pressure_angle: 20 deg
    material: { youngs_modulus: 206 GPa, poisson_ratio: 0.3 }
    pinion: { teeth: 24, face_width: 20 mm, bore_radius: 18 mm }
    gear: { teeth: 36, face_width: 20 mm, bore_radius: 28 mm }
  designs:
    kind: modification
    pair: pair
    designs:
      unmodified: []
      short:
        - tip_relief: { gear: both, amount: 12 um, fraction: 0.5, curve: linear }
  report:
    kind: report
    published:
      - cell: pair.pair.contact_ratio
        value: 1.6
        tolerance: 10 %
        where: by hand
    figures:
      - name: relief
        title: The relief
        table: designs.resolved
        x: length
        y: amount
        series: gear
";

pub fn tiny() -> Desk {
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("tiny.yaml"), TINY).unwrap();
    desk
}

/// The warnings of the program.
fn warnings(error: &str) -> Vec<&str> {
    error.lines().filter(|line| line.starts_with("gearstudy: ")).collect()
}

/// Runs the study in good order elsewhere: what its tables must be.
fn undisturbed() -> Vec<(String, String)> {
    let desk = tiny();
    desk.run(&["run", "tiny.yaml"], 0);
    desk.contents("tiny")
}

/// A folder becomes a regular file: nobody, root included, can make anything below it.
fn spoil(folder: &Path) {
    fs::remove_dir_all(folder).unwrap();
    fs::write(folder, "no folder").unwrap();
}

#[test]
fn a_journal_without_its_folder_gets_one() {
    let desk = tiny();
    desk.run(&["run", "tiny.yaml"], 0);
    let journals = desk.path(".gearstudy/cache/journals");
    fs::remove_dir_all(&journals).unwrap();
    let (_, error) = desk.run(&["run", "tiny.yaml", "--force"], 0);
    assert_eq!(error, "");
    assert!(journals.join("tiny.json").is_file());
}

#[test]
fn a_journal_that_cannot_be_kept_is_a_warning() {
    let desk = tiny();
    desk.run(&["run", "tiny.yaml"], 0);
    let before = desk.contents("tiny");
    spoil(&desk.path(".gearstudy/cache/journals"));
    for _ in 0..2 {
        let (_, error) = desk.run(&["run", "tiny.yaml", "--force"], 0);
        assert!(
            matches!(warnings(&error)[..], [one] if one.contains("journals") && one.contains("warning")),
            "{error}"
        );
        assert_eq!(desk.contents("tiny"), before);
    }
    // Damaged, a folder that is not empty, a pipe: each is told once and mended where that loses nothing.
    fs::remove_file(desk.path(".gearstudy/cache/journals")).unwrap();
    fs::create_dir_all(desk.path(".gearstudy/cache/journals")).unwrap();
    let journal = desk.path(".gearstudy/cache/journals/tiny.json");
    fs::write(&journal, "{ \"stages\": [").unwrap();
    let (_, error) = desk.run(&["run", "tiny.yaml"], 0);
    assert!(matches!(warnings(&error)[..], [one] if one.contains("tiny.json")), "{error}");
    assert_eq!(desk.run(&["run", "tiny.yaml"], 0).1, "");
}

/// Results are published although nothing can be kept, and one warning says what that costs.
#[test]
fn a_cache_that_takes_nothing_costs_time_only() {
    let desk = tiny();
    fs::write(desk.path("file"), "").unwrap();
    let expected = undisturbed();
    let all_again = |error: &str, cache: &str| {
        let told = warnings(error);
        assert_eq!(told.len(), 1, "{error}");
        assert!(told[0].contains("warning") && told[0].contains(cache), "{error}");
        assert!(told[0].contains("the next run computes 3 stages again"), "{error}");
    };
    // It cannot even be made.
    for cache in ["file", "file/below"] {
        let (_, error) = desk.run(&["run", "tiny.yaml", "--cache", cache], 0);
        all_again(&error, cache);
        assert!(error.contains("directory") || error.contains("exists"), "the system's words: {error}");
        assert_eq!(desk.contents("tiny"), expected);
        fs::remove_dir_all(desk.path("results")).unwrap();
    }
    // A plan does without it as a run does.
    let (out, error) = desk.run(&["plan", "tiny.yaml", "--cache", "file"], 0);
    assert!(out.contains("never ran") && matches!(warnings(&error)[..], [one] if one.contains("file")), "{error}");
    // It can be opened, but nothing can be kept in it.
    desk.run(&["run", "tiny.yaml", "--only", "pair", "--cache", "kept"], 0);
    fs::remove_dir_all(desk.path("results")).unwrap();
    spoil(&desk.path("kept/entries"));
    spoil(&desk.path("kept/journals"));
    let (_, error) = desk.run(&["run", "tiny.yaml", "--cache", "kept"], 0);
    assert_eq!(warnings(&error).len(), 2, "cache and journal: {error}");
    assert!(error.contains("the next run computes 3 stages again"), "{error}");
    assert_eq!(desk.contents("tiny"), expected);
    // Quiet or not: it went wrong.
    let (_, error) = desk.run(&["run", "tiny.yaml", "--cache", "kept", "--quiet"], 0);
    assert!(error.contains("the next run computes 3 stages again"), "{error}");
    desk.run(&["table", "tiny.yaml", "designs.resolved"], 0);
}

/// When cache and results are both on the full disk, the results are what failed.
#[test]
fn results_are_named_where_results_cannot_be_written() {
    let desk = tiny();
    fs::write(desk.path("file"), "").unwrap();
    let (_, error) = desk.run(&["run", "tiny.yaml", "--cache", "file/cache", "--results", "file/results"], 1);
    let told = warnings(&error);
    // Nothing is computed that could not be published.
    let [only] = &told[..] else { panic!("{error}") };
    assert!(only.contains("file/results") && !only.contains("file/cache"), "{error}");
}

/// Pipes, devices and folders where files should be: no wait, no end, and what is somebody's stays.
#[cfg(unix)]
#[test]
fn what_is_no_file_is_neither_opened_nor_lost() {
    let desk = tiny();
    desk.run(&["run", "tiny.yaml"], 0);
    let (expected, cache) = (desk.contents("tiny"), desk.path(".gearstudy/cache"));
    let entries: Vec<_> = fs::read_dir(cache.join("entries"))
        .unwrap()
        .flat_map(|folder| fs::read_dir(folder.unwrap().path()).unwrap().map(|entry| entry.unwrap().path()))
        .collect();
    let others = ["journals/tiny.json", "lock", "CACHEDIR.TAG", ".gitignore"].map(|name| cache.join(name));
    for path in entries.iter().chain(&others) {
        for kind in ["pipe", "device", "folder", "full folder"] {
            fs::remove_file(path).unwrap();
            match kind {
                "pipe" => assert!(Command::new("mkfifo").arg(path).status().unwrap().success()),
                "device" => std::os::unix::fs::symlink("/dev/zero", path).unwrap(),
                _ => fs::create_dir(path).unwrap(),
            }
            if kind == "full folder" {
                fs::write(path.join("mine"), "mine").unwrap();
            }
            let what = format!("{kind} for {}", path.display());
            let mut command = desk.command(&["run", "tiny.yaml"]);
            let output = command.timeout(std::time::Duration::from_secs(20)).output().unwrap();
            let error = String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(output.status.code(), Some(0), "{what}\n{error}");
            assert_eq!(desk.contents("tiny"), expected, "{what}");
            if kind == "full folder" {
                assert_eq!(fs::read_to_string(path.join("mine")).unwrap(), "mine", "{what}");
                let marks = path.ends_with("CACHEDIR.TAG") || path.ends_with(".gitignore");
                assert!(marks || error.contains("warning"), "{what}\n{error}");
                fs::remove_dir_all(path).unwrap();
            }
            // Mended, or mended now.
            desk.run(&["run", "tiny.yaml"], 0);
            let (_, error) = desk.run(&["run", "tiny.yaml"], 0);
            assert_eq!(error, "", "{what}");
            if !path.is_file() {
                // The marks are nobody's business once they are there; to write into a pipe would wait.
                let _ = fs::remove_file(path).or_else(|_| fs::remove_dir(path));
                fs::write(path, "").unwrap();
            }
        }
    }
}
