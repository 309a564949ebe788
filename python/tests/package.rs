//! Python's tests of the package, run with the interpreter that `make setup` installs on what cargo has built.
//!
//! Where there is none they are skipped, loudly; where one is named that does not work, that is a failure.

#![allow(clippy::disallowed_methods, reason = "a test that cannot read a file fails by what it expects of it")]

use std::env;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

fn interpreter() -> Option<PathBuf> {
    if let Some(named) = env::var_os("GEARSTUDY_PYTHON").filter(|named| !named.is_empty()) {
        return Some(named.into());
    }
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../.venv/bin/python");
    own.exists().then_some(own)
}

/// What cargo made of the crate, beside this test or a folder above it.
fn built() -> PathBuf {
    let here = env::current_exe().unwrap();
    let folders = here.ancestors().skip(1).take(2);
    let name = format!("{}_gearstudy{}", env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX);
    folders
        .map(|folder| folder.join(&name))
        .find(|path| path.is_file())
        .expect("cargo builds the library before its tests")
}

#[test]
fn python_tests() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let Some(python) = interpreter() else {
        // Past the capture of a test that passes: nobody shall take this for a check that was made.
        let line = "\nSKIPPED: python/tests: no .venv and no $GEARSTUDY_PYTHON; `make setup` installs it\n";
        std::io::stderr().write_all(line.as_bytes()).unwrap();
        return;
    };
    // A package as it is installed: sources are copied, since a folder of links is no folder of a package.
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("gearstudy");
    fs::create_dir(&package).unwrap();
    for entry in fs::read_dir(root.join("gearstudy")).unwrap() {
        let path = entry.unwrap().path();
        if path.is_file() {
            fs::copy(&path, package.join(path.file_name().unwrap())).unwrap();
        }
    }
    fs::copy(built(), package.join("_gearstudy.abi3.so")).unwrap();
    let status = Command::new(&python)
        .args(["-m", "pytest", "-q", "-n", "2", "-p", "no:cacheprovider"])
        .arg(root.join("tests"))
        .current_dir(folder.path())
        .env("PYTHONPATH", folder.path())
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("GEARSTUDY_ROOT", root.parent().unwrap())
        .env("GEARSTUDY_EXAMPLES", built().parent().unwrap().join("../examples"))
        .status()
        .unwrap_or_else(|error| panic!("{}: {error}", python.display()));
    assert!(status.success(), "python/tests");
}
