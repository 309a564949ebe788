//! What CalculiX answered before: the same deck has the same answer, and the finer ones take a minute each.
//!
//! An answer is kept under the digest of its deck and of the code that reads it out, one file each in
//! `tests/reference/calculix`; any other deck is computed. `GEARSTUDY_CALCULIX=anew` computes all of them and keeps what came
//! out; empty the folder before, or what no test asks for any more stays. Decks that take seconds are never kept, so that the
//! program itself is asked in every run of the tests. Must not know: what is in a deck.

use std::env;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

/// Whatever may change an answer besides its deck.
const READERS: [&str; 5] = [
    include_str!("press.rs"),
    include_str!("program.rs"),
    include_str!("wheel.rs"),
    include_str!("../../../crates/gearmesh/src/gear/finite_elements/mesh.rs"),
    include_str!("../../../crates/gearmesh/src/gear/finite_elements/root_stress.rs"),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference/calculix")
}

fn file(deck: &str) -> PathBuf {
    let mut hasher = blake3::Hasher::new_derive_key("gearstudy 1 deck of CalculiX");
    for text in READERS.into_iter().chain([deck]) {
        hasher.update(&(text.len() as u64).to_le_bytes()).update(text.as_bytes());
    }
    folder().join(format!("{}.json", &hasher.finalize().to_hex()[..32]))
}

fn is_anew() -> bool {
    env::var("GEARSTUDY_CALCULIX").is_ok_and(|word| word == "anew")
}

/// The recorded answer to a deck; none if there is no record, or if all answers are to be computed.
pub fn answer<Answer: DeserializeOwned>(deck: &str) -> Option<Answer> {
    let text = fs::read(file(deck)).ok().filter(|_| !is_anew())?;
    Some(serde_json::from_slice(&text).expect("a record of this folder is what was written"))
}

/// Keeps what was answered, where that is asked for.
pub fn keep(deck: &str, answered: &impl Serialize) {
    if !is_anew() {
        // Past the capture of a test that passes: together they are minutes of every run.
        let missing = format!("\nNOT RECORDED: {}; GEARSTUDY_CALCULIX=anew does\n", file(deck).display());
        std::io::stderr().write_all(missing.as_bytes()).unwrap();
        return;
    }
    fs::create_dir_all(folder()).unwrap();
    fs::write(file(deck), serde_json::to_string_pretty(answered).unwrap() + "\n").unwrap();
}
