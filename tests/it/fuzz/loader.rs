//! The reader of studies under changed studies: bytes, words, numbers, lines and levels.

use std::fs;
use std::path::Path;

use rand_core::Rng;

use super::drive;
use crate::registry;
use declare::seed::Seed;
use gearstudy::program;

const WORDS: [&str; 36] = [
    "",
    " ",
    "  ",
    "\n",
    "\t",
    ":",
    ": ",
    "-",
    "- ",
    "{",
    "}",
    "[",
    "]",
    ",",
    "&a ",
    "*a",
    "<<: ",
    "|",
    ">",
    "'",
    "\"",
    "#",
    "~",
    "null",
    "true",
    ".nan",
    ".inf",
    "1e999",
    "-1e-999",
    "0x10",
    "mm",
    "um",
    "µm",
    "N m",
    "kind: ste",
    "\u{feff}",
];

const NUMBERS: [&str; 14] = [
    "0",
    "-1",
    "1e308",
    "1e-308",
    "999999999999999999999",
    "0.0000000001",
    ".5",
    "5.",
    "1_000",
    "٣",
    "1e",
    "--2",
    "1/2",
    "017",
];

/// The studies of this repository, the examples, and what was refused before.
fn texts() -> Vec<String> {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    for folder in ["studies", "tests/bad", "tests/corpus"] {
        let entries = fs::read_dir(top.join(folder)).unwrap();
        paths.extend(entries.map(|entry| entry.unwrap().path()));
    }
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    paths.sort();
    let mut texts: Vec<String> = paths.iter().filter_map(|path| fs::read_to_string(path).ok()).collect();
    texts.push(registry::examples());
    // A page of text is enough to go wrong in, and quick to read.
    for text in &mut texts {
        text.truncate(text.floor_char_boundary(12_000));
    }
    texts
}

fn below(generator: &mut impl Rng, maximum: usize) -> usize {
    if maximum == 0 { 0 } else { (generator.next_u64() % maximum as u64) as usize }
}

fn changed(text: &str, number: u64) -> String {
    let mut generator = Seed::of_stage(1, "loader").generator(number);
    let mut text = text.to_owned();
    for _ in 0..=below(&mut generator, 6) {
        let at = text.floor_char_boundary(below(&mut generator, text.len() + 1));
        let end = text.floor_char_boundary((at + below(&mut generator, 12)).min(text.len()));
        match below(&mut generator, 7) {
            0 => text.replace_range(at..at, WORDS[below(&mut generator, WORDS.len())]),
            1 => text.replace_range(at..end, WORDS[below(&mut generator, WORDS.len())]),
            2 => text.replace_range(at..end, ""),
            3 => {
                // The next number becomes another one.
                let Some(start) = text[at..].find(|c: char| c.is_ascii_digit()).map(|found| at + found) else {
                    continue;
                };
                let length =
                    text[start..].find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len() - start);
                text.replace_range(start..start + length, NUMBERS[below(&mut generator, NUMBERS.len())]);
            }
            kind => {
                let mut lines: Vec<&str> = text.split_inclusive('\n').collect();
                let (one, two) = (below(&mut generator, lines.len()), below(&mut generator, lines.len()));
                if lines.is_empty() {
                    continue;
                }
                match kind {
                    4 => lines.swap(one, two),
                    5 => lines.insert(one, lines[two]),
                    _ => drop(lines.remove(one)),
                }
                text = lines.concat();
            }
        }
    }
    text
}

fn read(text: &str) {
    if let Err(error) = program::load_text(text, Path::new("t.yaml")) {
        assert!(error.to_string().len() < 4000, "{error}");
        if let Some(place) = error.diagnostic.place {
            assert!(error.text.get(place.offset..place.offset + place.length).is_some(), "{place:?}: {error}");
        }
    }
}

#[test]
fn no_study_panics_or_hangs() {
    let texts = texts();
    drive("studies", 3000, move |number| {
        let text = &texts[(number % texts.len() as u64) as usize];
        read(&changed(text, number));
    });
}
