//! Scripts in `tests/python/`, run with the interpreter that `make setup` installs: `$GEARSTUDY_PYTHON` or `.venv`.
//!
//! Where there is none they are skipped, loudly; where one is named that does not work, that is a failure.

use std::env;
use std::ffi::OsStr;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

fn interpreter() -> Option<PathBuf> {
    if let Some(named) = env::var_os("GEARSTUDY_PYTHON").filter(|named| !named.is_empty()) {
        return Some(named.into());
    }
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join(".venv/bin/python");
    own.exists().then_some(own)
}

/// Runs a script, which must end well; what it prints.
pub fn run(script: &str, arguments: &[&OsStr]) -> Option<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let file = root.join("tests/python").join(script);
    let all: Vec<&OsStr> = std::iter::once(file.as_os_str()).chain(arguments.iter().copied()).collect();
    started(script, &all, root)
}

/// Runs a few lines in a folder.
pub fn run_lines(name: &str, lines: &str, folder: &Path) -> Option<String> {
    started(name, &[OsStr::new("-c"), OsStr::new(lines)], folder)
}

fn started(script: &str, arguments: &[&OsStr], folder: &Path) -> Option<String> {
    let Some(python) = interpreter() else {
        // Past the capture of a test that passes: nobody shall take this for a check that was made.
        let line =
            format!("\nSKIPPED: tests/python/{script}: no .venv and no $GEARSTUDY_PYTHON; `make setup` installs it\n");
        std::io::stderr().write_all(line.as_bytes()).unwrap();
        return None;
    };
    let output = Command::new(&python)
        .args(arguments)
        .current_dir(folder)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .unwrap_or_else(|error| panic!("{}: {error}", python.display()));
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(output.status.success(), "{script}:\n{}{}", text(&output.stdout), text(&output.stderr));
    Some(text(&output.stdout))
}
