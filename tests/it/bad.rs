//! The folder `tests/bad`: studies that must be refused, each with its message beside it.
//!
//! `UPDATE_EXPECTED=1` writes the messages as they are now; look at what changed before it is kept.

use std::path::{Path, PathBuf};
use std::{env, fs};

use gearstudy::program::load;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad")
}

/// The message of a file, which is called by its name alone: messages must not depend on where the project lies.
fn message(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    match load(path) {
        Ok(_) => format!("{name}: this study was accepted\n"),
        Err(error) => format!("{error}\n").replace(&path.display().to_string(), &name),
    }
}

#[test]
fn every_bad_study_gets_its_message() {
    let mut wrong = Vec::new();
    let mut paths: Vec<_> = fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    paths.sort();
    assert!(paths.len() >= 14, "only {} bad studies", paths.len());
    for path in paths {
        let (expected, found) = (path.with_extension("expected"), message(&path));
        if env::var_os("UPDATE_EXPECTED").is_some() {
            fs::write(&expected, &found).unwrap();
        }
        let wanted = fs::read_to_string(&expected).unwrap_or_else(|error| format!("({error})\n"));
        if wanted != found {
            wrong.push(format!("expected {wanted}but got  {found}"));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn every_message_belongs_to_a_study() {
    for entry in fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        let known = path.extension().is_some_and(|extension| extension == "yaml" || extension == "expected");
        assert!(known && path.with_extension("yaml").exists(), "{}", path.display());
    }
}
