//! What the documents show is what the program does: every command line parses, every study loads, and the message in
//! the README is the one a user gets.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Parser;
use clap::error::ErrorKind;

use gearstudy::cli::arguments::Arguments;
use gearstudy::program;

use crate::layering::rust_files;

fn documents() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = vec![root.join("README.md"), root.join("ARCHITECTURE.md")];
    let folders = ["docs", "docs/decisions"].into_iter().flat_map(|folder| fs::read_dir(root.join(folder)).unwrap());
    let docs = folders.map(|entry| entry.unwrap().path());
    paths.extend(docs.filter(|path| path.extension().is_some_and(|extension| extension == "md")));
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), fs::read_to_string(&path).unwrap())).collect()
}

/// Fenced blocks: the word behind the fence, and the text.
fn blocks(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let Some(language) = line.trim_start().strip_prefix("```") else { continue };
        let inside: Vec<_> = lines.by_ref().take_while(|line| !line.trim_start().starts_with("```")).collect();
        found.push((language.trim().to_owned(), inside.join("\n") + "\n"));
    }
    found
}

/// Command lines in fenced blocks, and between backticks.
fn commands(text: &str) -> Vec<String> {
    let fenced = blocks(text).into_iter().flat_map(|(_, block)| {
        let lines = block.lines().map(|line| line.trim_start().trim_start_matches("$ ").to_owned());
        lines.collect::<Vec<_>>()
    });
    let inline = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("```"))
        .flat_map(|line| line.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>());
    let all = fenced
        .chain(inline)
        .map(|line| line.split("  #").flat_map(|line| line.split(" | ")).next().unwrap_or("").trim().to_owned());
    all.filter(|line| line.strip_prefix("gearstudy ").is_some_and(|rest| !rest.starts_with(['…', '.']))).collect()
}

/// The words of a command, with something in the place of `STUDY`, `[KIND]`, `N`, `…`, `${number}` and their like.
fn words(command: &str) -> Vec<String> {
    let shown = |word: &str| {
        let plain = word.trim_matches(['[', ']', '"', '\'']).trim_end_matches('…');
        let placeholder = !plain.is_empty() && plain.chars().all(|c| c.is_ascii_uppercase())
            || word == "…"
            || plain.starts_with("${");
        if placeholder { "1".to_owned() } else { plain.to_owned() }
    };
    // A quoted word may hold spaces: `--where 'torque=50 N m'`.
    let mut words = Vec::new();
    for (index, part) in command.split(['\'', '"']).enumerate() {
        if index % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(shown));
        }
    }
    words
}

#[test]
fn every_command_line_in_the_documents_parses() {
    let mut count = 0;
    for (path, text) in documents() {
        for command in commands(&text) {
            let parsed = Arguments::try_parse_from(words(&command));
            // A command that is only named, and what ends with a text of its own (`--help`), are right as well.
            let only_named = |error: &clap::Error| {
                error.kind() == ErrorKind::MissingRequiredArgument && command.split_whitespace().count() == 2
            };
            let fine = parsed.as_ref().err().is_none_or(|error| !error.use_stderr() || only_named(error));
            assert!(fine, "{}: `{command}`: {}", path.display(), parsed.err().unwrap());
            count += 1;
        }
    }
    assert!(count >= 8, "only {count} commands were found");
}

#[test]
fn every_study_in_the_documents_loads() {
    let mut count = 0;
    for (path, text) in documents() {
        for (language, block) in blocks(&text) {
            if language == "yaml" && block.lines().any(|line| line.starts_with("study:")) {
                program::load_text(&block, Path::new("study.yaml"))
                    .unwrap_or_else(|error| panic!("{}: {error}\n{block}", path.display()));
                count += 1;
            }
        }
    }
    assert!(count >= 1);
}

#[test]
fn every_source_file_that_is_named_exists() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders =
        ["src", "crates", "python", "tests", "benches"].iter().flat_map(|folder| rust_files(&top.join(folder)));
    let sources: Vec<_> = folders.chain([top.join("build.rs")]).collect();
    let comments = sources.iter().map(|path| (path.clone(), fs::read_to_string(path).unwrap()));
    let mut missing = Vec::new();
    let mut count = 0;
    for (path, text) in documents().into_iter().chain(comments) {
        let names = text.split('`').filter(|name| !name.contains(['<', '\n', ' ', '{']));
        for name in names.map(Path::new).filter(|name| name.extension().is_some_and(|end| end == "rs")) {
            count += 1;
            if !sources.iter().any(|source| source.ends_with(name)) {
                missing.push(format!("{}: {}", path.display(), name.display()));
            }
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
    assert!(count >= 100, "only {count} names were found");
}

#[test]
fn the_readme_s_message_is_the_one_a_user_gets() {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).unwrap();
    let blocks = blocks(&text);
    let (_, study) = blocks.iter().find(|(_, block)| block.starts_with("study:")).unwrap();
    let (_, message) = blocks.iter().find(|(_, block)| block.starts_with("my-study.yaml:")).unwrap();
    let slip = study.replacen("module: 3 mm", "module: 3", 1);
    let error = program::load_text(&slip, Path::new("my-study.yaml")).err().unwrap();
    assert_eq!(error.to_string().trim(), message.trim());
}
