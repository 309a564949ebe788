//! Where memory may be handled by hand: cargo denies `unsafe` in every crate (`[workspace.lints.rust]`), and a file that
//! allows itself what is denied is found here. What macros of PyO3 write is not in any file.

use std::fs;
use std::path::Path;

use super::source::code;
use super::{rust_files, words};

/// The counted allocator, an unsafe trait, and a call of the C library; the few calls of libhdf5 that its safe wrapper lacks.
const MAY: [&str; 2] = ["crates/studygraph/src/stage/memory.rs", "crates/studygraph/src/store/hdf5/raw.rs"];

/// Lines that handle memory by hand, or allow it.
fn found(text: &str) -> Vec<usize> {
    let mut lines: Vec<_> = words(&code(text), &["unsafe", "unsafe_code"]).into_iter().map(|(line, _)| line).collect();
    lines.sort_unstable();
    lines
}

#[test]
fn memory_is_handled_by_hand_in_two_files() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut by_hand = Vec::new();
    for folder in ["benches", "crates", "python", "src", "tests"] {
        for file in rust_files(&top.join(folder)) {
            if !found(&fs::read_to_string(&file).unwrap()).is_empty() {
                by_hand.push(file.strip_prefix(top).unwrap().to_string_lossy().replace('\\', "/"));
            }
        }
    }
    assert_eq!(by_hand, MAY);
    let manifest = |folder: &Path| fs::read_to_string(folder.join("Cargo.toml")).unwrap();
    assert!(
        manifest(top).contains("\n[workspace.lints.rust]\n") && manifest(top).contains("\nunsafe_code = \"deny\"\n")
    );
    let crates = fs::read_dir(top.join("crates")).unwrap().map(|entry| entry.unwrap().path());
    for folder in crates.chain([top.to_owned(), top.join("python")]) {
        assert!(manifest(&folder).contains("\n[lints]\nworkspace = true\n"), "{}", folder.display());
    }
}

#[test]
fn a_word_in_a_text_is_no_danger() {
    assert!(found("// unsafe\nlet a = \"unsafe\";").is_empty());
    assert_eq!(found("fn f() {\n    unsafe { g() }\n}\n#[allow(unsafe_code)]\nunsafe fn h() {}"), [2, 4, 5]);
}
