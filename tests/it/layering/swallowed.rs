//! "Cannot be read" is never "does not exist": who asks the disk for a file or folder, and drops the error of the answer, is
//! listed here with the reason. `clippy.toml` forbids what drops it by itself.

use std::fs;
use std::path::Path;

use super::source::{code, without_tests};
use super::{CRATES, is_test, rust_files};

/// Files that drop errors, in how many places, and why that does no harm.
const MAY: &[(&str, usize, &str)] = &[
    ("crates/studygraph/src/history/git.rs", 1, "what is no link is looked up as it is, which finds the error again"),
    (
        "crates/studygraph/src/history/side.rs",
        2,
        "what cannot be read is taken for present, and read, which reports it",
    ),
    ("crates/studygraph/src/runner/note.rs", 4, "without a note a run reads everything"),
    ("crates/studygraph/src/runner/ownership.rs", 1, "what is not recorded is not compared"),
    ("crates/studygraph/src/store/cache.rs", 2, "a use that is not noted makes an entry look older; leftovers stay"),
    ("crates/studygraph/src/store/cache/packs.rs", 1, "an entry that is not found is computed again"),
    ("crates/studygraph/src/git.rs", 2, "what cannot be read is left to git, which says why"),
    ("crates/studygraph/src/store/archive/open.rs", 1, "a file that cannot be read is opened, which reports it"),
    ("crates/studygraph/src/store/facts.rs", 1, "what cannot be read is left to git"),
    ("crates/studygraph/src/store/file.rs", 2, "the next run removes the leftovers"),
    ("crates/studygraph/src/store/index.rs", 1, "without the index every file is read"),
    ("crates/studygraph/src/store/results.rs", 2, "a fault that was found is reported without a second look"),
    ("crates/studygraph/src/store/results/publish.rs", 1, "an index that is not refreshed costs reading"),
    ("src/cli/complete.rs", 1, "completion has nobody to report to"),
    ("src/cli/diff.rs", 2, "names to suggest; folders to lock, which are compared all the same"),
    ("src/cli/run.rs", 1, "a cache that cannot be read is opened, which reports it"),
    ("src/cli/scratch.rs", 2, "the next run removes the leftovers"),
    ("src/cli/serve.rs", 3, "a browser is answered that there is no such page"),
    ("src/cli/watch.rs", 3, "the study is loaded, which reports it; a page that cannot be read is not shown"),
];

const QUESTIONS: &[&str] = &["presence::", "metadata(", "canonicalize("];
const DROPS: &[&str] = &[".ok()", ".is_ok", ".unwrap_or", ".flatten()", ".map_or("];

/// The lines of questions to the disk whose errors are dropped.
fn found(code: &str) -> Vec<usize> {
    let mut lines: Vec<usize> = Vec::new();
    for question in QUESTIONS {
        for (at, _) in code.match_indices(question) {
            let before = code[..at].rsplit('\n').next().unwrap_or_default();
            if before.trim_start().starts_with("use ") || before.contains("fn ") || before.contains("schema") {
                continue;
            }
            let rest = &code[at..];
            let statement = &rest[..rest.find([';', '?', '{']).unwrap_or(rest.len())];
            let is_dropped = DROPS.iter().any(|drop| statement.contains(drop)) || before.contains("let Ok(");
            let line = 1 + code[..at].matches('\n').count();
            if is_dropped && !lines.contains(&line) {
                lines.push(line);
            }
        }
    }
    lines.sort_unstable();
    lines
}

#[test]
fn no_error_of_a_question_to_the_disk_is_dropped_without_a_reason() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut wrong = Vec::new();
    for folder in CRATES.iter().map(|(folder, _)| *folder).chain(["python/src/"]) {
        for file in rust_files(&top.join(folder)) {
            let path = file.strip_prefix(top).unwrap().to_string_lossy().replace('\\', "/");
            if is_test(&path) {
                continue;
            }
            let lines = found(&without_tests(&code(&fs::read_to_string(&file).unwrap())));
            let may = MAY.iter().find(|(file, ..)| *file == path).map_or(0, |(_, number, _)| *number);
            if lines.len() != may {
                wrong.push(format!("{path}: {lines:?}, of which {may} may"));
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}\n", wrong.join("\n"));
}

#[test]
fn dropped_errors_are_found_in_every_form() {
    for text in [
        "let there = fs::metadata(path).is_ok();",
        "let Ok(metadata) = fs::metadata(&path) else { return };",
        "fs::canonicalize(path).ok();",
        "let all = presence::entries(folder)\n    .unwrap_or_default();",
        "for entry in presence::entries(folder).into_iter().flatten() {",
    ] {
        assert_eq!(found(text), [1], "{text}");
    }
    for text in ["let found = presence::metadata(path)?;", "use studygraph::presence::exists;", "fn metadata() {}"] {
        assert!(found(text).is_empty(), "{text}");
    }
    let all = [
        "Path::exists",
        "Path::is_file",
        "Path::is_dir",
        "Path::is_symlink",
        "Path::try_exists",
        "Path::read_dir",
        "fs::read_dir",
        "fs::exists",
    ];
    let lint = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("clippy.toml")).unwrap();
    assert!(all.iter().all(|name| lint.contains(&format!("::{name}\""))), "{lint}");
}
