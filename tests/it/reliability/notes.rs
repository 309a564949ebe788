//! A run with nothing to do reads nothing but a note: whatever happened to a file, it is noticed all the same.

use std::fs;
use std::path::{Path, PathBuf};

use super::cache::{TINY, tiny};
use crate::desk::Desk;

fn files(folder: &Path) -> Vec<PathBuf> {
    let paths = fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> =
        paths.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect();
    files.sort();
    files
}

fn says_nothing_to_do(desk: &Desk) -> bool {
    desk.run(&["run", "tiny.yaml"], 0).0.contains("nothing to do")
}

/// A run that cannot look into the cache says so, unless it does not look.
fn relies_on_its_note(desk: &Desk) -> bool {
    let note = files(&desk.path(".gearstudy/cache/notes")).remove(0);
    let bytes = fs::read(&note).unwrap();
    assert!(says_nothing_to_do(desk));
    // Without its note it looks, and notes it again.
    fs::remove_file(&note).unwrap();
    assert!(says_nothing_to_do(desk));
    fs::read(&note).unwrap() == bytes
}

#[test]
fn whatever_a_note_relies_on_is_looked_at() {
    let desk = tiny();
    desk.run(&["run", "tiny.yaml"], 0);
    assert!(says_nothing_to_do(&desk) && relies_on_its_note(&desk));
    let expected = desk.contents("tiny");
    let cache = desk.path(".gearstudy/cache");
    let results: Vec<PathBuf> = files(&desk.path("results"));
    let entries = files(&cache.join("entries"));
    assert!(results.len() > 8 && entries.len() == 3, "{results:?} {entries:?}");
    for path in results.iter().chain(&entries) {
        let bytes = fs::read(path).unwrap();
        for what in ["gone", "cut", "changed"] {
            match what {
                "gone" => fs::remove_file(path).unwrap(),
                "cut" => fs::write(path, &bytes[..bytes.len() / 2]).unwrap(),
                _ => {
                    let mut other = bytes.clone();
                    other[bytes.len() / 3] ^= 1;
                    fs::write(path, other).unwrap();
                }
            }
            desk.run(&["run", "tiny.yaml"], 0);
            let name = path.display();
            assert_eq!(desk.contents("tiny"), expected, "{what}: {name}");
            assert!(path.is_file(), "{what}: {name}");
            let is_index = path.ends_with("files.json");
            let is_body = entries.contains(path) && what == "changed";
            assert!(is_index || is_body || fs::read(path).unwrap().len().abs_diff(bytes.len()) < 99, "{what}: {name}");
            desk.run(&["run", "tiny.yaml"], 0);
        }
    }
}

#[test]
fn another_study_another_option_or_another_folder_is_another_question() {
    let desk = tiny();
    desk.run(&["run", "tiny.yaml"], 0);
    assert!(says_nothing_to_do(&desk));
    let ran = |words: &[&str]| !desk.run(words, 0).0.contains("nothing to do");
    assert!(ran(&["run", "tiny.yaml", "--force"]));
    assert!(ran(&["run", "tiny.yaml", "--results", "elsewhere"]));
    assert!(ran(&["run", "tiny.yaml", "--cache", "other"]) || desk.path("other/entries").is_dir());
    assert!(ran(&["run", "tiny.yaml", "--want", "designs.parameters"]));
    assert!(!ran(&["run", "tiny.yaml", "--want", "designs.parameters"]));
    assert!(ran(&["run", "tiny.yaml"]), "the tables are fewer again");
    assert!(!ran(&["run", "tiny.yaml"]));
    fs::write(desk.path("tiny.yaml"), TINY.replace("12 um", "13 um")).unwrap();
    assert!(ran(&["run", "tiny.yaml"]));
    fs::write(desk.path("tiny.yaml"), TINY.replace("12 um", "13 mum")).unwrap();
    desk.run(&["run", "tiny.yaml"], 2);
}
