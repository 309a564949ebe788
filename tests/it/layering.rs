//! Holds the source to its layers: who may import whom, what the kernels never name, and what every file keeps to.
//!
//! Eight of nine Rust programs measured have import cycles between their modules; nothing but a test prevents them.

mod source;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use source::{code, paths, without_tests};

/// A layer and what it may import directly; it may also import what those may. An arrow is "may import".
const LAYERS: &[(&str, &[&str])] = &[
    ("cli", &["report", "query", "runner"]),
    ("report", &["study", "store"]),
    ("diff", &["history"]),
    ("query", &["history"]),
    ("history", &["store"]),
    ("runner", &["study", "diff"]),
    ("study", &["stage"]),
    ("stage", &["gear", "optimize", "table"]),
    ("gear", &["numeric"]),
    ("optimize", &["numeric"]),
    ("numeric", &["base"]),
    ("store", &["table"]),
    ("table", &["base"]),
    ("base", &[]),
];

/// Layers that compute: no files, clocks, threads, printing, chance order; and elementary functions from `libm` alone,
/// since those of the C library differ between CPUs.
const KERNELS: &[&str] = &["base", "numeric", "gear", "optimize"];

const NEVER_IN_KERNELS: &[&str] = &[
    "std::env",
    "std::fs",
    "std::io",
    "std::net",
    "std::process",
    "std::thread",
    "std::time",
    "rayon",
    "HashMap",
    "HashSet",
    "print!",
    "println!",
    "eprint!",
    "eprintln!",
    "dbg!",
    "static mut",
    "thread_local!",
    "OnceLock",
    "LazyLock",
    ".sin(",
    ".cos(",
    ".tan(",
    ".sin_cos(",
    ".asin(",
    ".acos(",
    ".atan(",
    ".atan2(",
    ".exp(",
    ".exp2(",
    ".exp_m1(",
    ".ln(",
    ".ln_1p(",
    ".log(",
    ".log2(",
    ".log10(",
    ".powf(",
    ".sinh(",
    ".cosh(",
    ".tanh(",
    ".asinh(",
    ".acosh(",
    ".atanh(",
    ".cbrt(",
    ".hypot(",
];

/// A crate and the only files or folders that may name it.
const OWNERS: &[(&str, &[&str])] = &[
    ("petgraph", &["runner/graph.rs"]),
    ("faer", &["gear/finite_elements/"]),
    ("minijinja", &["report/", "diff/"]),
    ("parquet", &["store/"]),
    ("hdf5_metno", &["store/hdf5"]),
    ("hdf5_metno_sys", &["store/hdf5/raw.rs"]),
    ("roxmltree", &["study/"]),
    ("serde_saphyr", &["study/"]),
    ("clap", &["cli/"]),
    ("polars", &["query/frame.rs"]),
    ("sqlparser", &["query/names.rs"]),
    ("ctrlc", &["cli/"]),
    ("sha2", &["store/archive.rs"]),
    ("spdx", &["cli/rights.rs"]),
    ("miette", &["cli/"]),
];

/// The only layers that the program's entry and the library's root name.
const MAIN_MAY_IMPORT: &[&str] = &["cli"];

const MOST_LINES: usize = 450;

/// What is wrong with one file of `src/`, at `path` relative to it.
fn faults(path: &str, text: &str) -> Vec<String> {
    let code = code(text);
    let shipped = if is_test(path) { String::new() } else { without_tests(&code) };
    let mut faults = Vec::new();
    shape(text, &code, &mut faults);
    imports(path, &code, &shipped, &mut faults);
    let layer = layer_of(path);
    if KERNELS.contains(&layer) {
        for (line, word) in words(&shipped, NEVER_IN_KERNELS) {
            faults.push(format!("{line}: `{word}` has no place in `{layer}`, which only computes"));
        }
    }
    let own: Vec<_> = paths(&code, "crate").into_iter().flat_map(|(_, path)| path).collect();
    for (owned, owners) in OWNERS {
        // A file that imports a module of ours by that name (`store::parquet`) means the module.
        if !owners.iter().any(|owner| path.starts_with(owner)) && !own.iter().any(|part| part == owned) {
            for (line, _) in paths(&code, owned) {
                faults.push(format!("{line}: `{owned}` may be named only in {}", owners.join(", ")));
            }
        }
    }
    faults
}

fn is_test(path: &str) -> bool {
    path.split('/').any(|part| part == "tests" || part == "tests.rs")
}

fn layer_of(path: &str) -> &str {
    path.split(['/', '.']).next().unwrap_or("")
}

/// The rules for every file, whatever its layer; also for tests and benches.
fn shape(text: &str, code: &str, faults: &mut Vec<String>) {
    if !text.starts_with("//!") {
        faults.push("1: a file opens with `//!`: what it is, what it must not know, its source".to_owned());
    }
    let lines = text.lines().count();
    if lines > MOST_LINES {
        faults.push(format!("{lines}: more than {MOST_LINES} lines; would two files be clearer?"));
    }
    for (line, word) in words(code, &["todo!", "unimplemented!", "#[ignore"]) {
        faults.push(format!("{line}: `{word}`: unfinished or switched off"));
    }
}

fn imports(path: &str, code: &str, shipped: &str, faults: &mut Vec<String>) {
    let layer = layer_of(path);
    let root = path == "lib.rs" || path == "main.rs";
    let allowed: BTreeSet<&str> = if root { MAIN_MAY_IMPORT.iter().copied().collect() } else { reach(layer) };
    if !root && allowed.is_empty() {
        faults.push(format!("1: `{layer}` is no layer; add it to the table and to ARCHITECTURE.md"));
        return;
    }
    let own = kind_of(path);
    let mut named = paths(code, if path == "main.rs" { "gearstudy" } else { "crate" });
    named.extend(relative(path, shipped));
    named.sort();
    for (line, target) in named {
        let first = target[0].as_str();
        if !allowed.contains(first) {
            faults.push(format!("{line}: `{layer}` may not import `{first}`"));
        }
        if let (Some(own), ["stage", "kinds", other, ..]) =
            (own, &target.iter().map(String::as_str).collect::<Vec<_>>()[..])
            && own != *other
        {
            faults.push(format!("{line}: the stage kind `{own}` may not know the kind `{other}`, only its tables"));
        }
    }
}

/// The stage kind a file belongs to.
fn kind_of(path: &str) -> Option<&str> {
    let kind = path.strip_prefix("stage/kinds/")?.split(['/', '.']).next()?;
    (kind != "mod").then_some(kind)
}

/// The layer itself and everything its arrows reach.
fn reach(layer: &str) -> BTreeSet<&'static str> {
    let mut reached = BTreeSet::new();
    let mut open: Vec<&'static str> = LAYERS.iter().filter(|(name, _)| *name == layer).map(|(name, _)| *name).collect();
    while let Some(name) = open.pop() {
        if reached.insert(name) {
            open.extend(LAYERS.iter().filter(|(other, _)| *other == name).flat_map(|(_, next)| next.iter().copied()));
        }
    }
    reached
}

/// Paths that begin with `super`, as seen from the crate's root.
fn relative(path: &str, code: &str) -> Vec<(usize, Vec<String>)> {
    let mut module: Vec<&str> = path.trim_end_matches(".rs").split('/').collect();
    if matches!(module.last(), Some(&("mod" | "lib" | "main"))) {
        module.pop();
    }
    let mut found = Vec::new();
    for (line, path) in paths(code, "super") {
        let ups = 1 + path.iter().take_while(|part| *part == "super").count();
        let base = &module[..module.len().saturating_sub(ups)];
        let target: Vec<String> =
            base.iter().map(|part| (*part).to_owned()).chain(path.into_iter().skip(ups - 1)).collect();
        found.push((line, target));
    }
    found
}

/// Where any of `wanted` stands as a word of its own.
fn words<'a>(code: &str, wanted: &[&'a str]) -> Vec<(usize, &'a str)> {
    let is_word = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    let mut found = Vec::new();
    for &word in wanted {
        for (at, _) in code.match_indices(word) {
            let starts = word.starts_with('.') || !is_word(code[..at].chars().next_back());
            let ends = !is_word(word.chars().next_back()) || !is_word(code[at + word.len()..].chars().next());
            // `libm::sin(` is how it should be; `.sin(` is not.
            if starts && ends {
                found.push((1 + code[..at].matches('\n').count(), word));
            }
        }
    }
    found
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let Ok(entries) = fs::read_dir(folder) else { return files };
    for entry in entries {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}

#[test]
fn every_file_keeps_to_its_layer() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    let sources = rust_files(&top.join("src"));
    assert!(sources.len() > 20, "the source is not where it is looked for");
    for file in sources {
        let path = file.strip_prefix(top.join("src")).unwrap().to_string_lossy().replace('\\', "/");
        let text = fs::read_to_string(&file).unwrap();
        found.extend(faults(&path, &text).into_iter().map(|fault| format!("src/{path}:{fault}")));
    }
    for folder in ["tests", "benches"] {
        for file in rust_files(&top.join(folder)) {
            let text = fs::read_to_string(&file).unwrap();
            let mut faults = Vec::new();
            shape(&text, &code(&text), &mut faults);
            let path = file.strip_prefix(top).unwrap().display();
            found.extend(faults.into_iter().map(|fault| format!("{path}:{fault}")));
        }
    }
    assert!(found.is_empty(), "\n{}\n", found.join("\n"));
}

#[test]
fn the_layers_have_no_cycle_and_rest_on_base() {
    for (layer, _) in LAYERS {
        assert!(reach(layer).contains("base"), "{layer}");
        for (other, _) in LAYERS {
            assert!(
                layer == other || !(reach(layer).contains(other) && reach(other).contains(layer)),
                "{layer}, {other}"
            );
        }
    }
}

#[cfg(test)]
mod planted {
    use super::*;

    #[track_caller]
    fn found(path: &str, text: &str, wanted: &[&str]) {
        let faults = faults(path, &format!("//! What it is.\n{text}"));
        assert_eq!(faults.len(), wanted.len(), "{faults:?}");
        for (fault, wanted) in faults.iter().zip(wanted) {
            assert!(fault.contains(wanted), "{faults:?}");
        }
    }

    #[test]
    fn arrows_downwards_are_allowed_and_others_found() {
        found("runner/plan.rs", "use crate::{base::error, study::Study, store::x, table::y};", &[]);
        found("gear/contact.rs", "use crate::stage::Stage;", &["2: `gear` may not import `stage`"]);
        found("store/object.rs", "\nfn f(x: crate::study::Study) {}", &["3: `store` may not import `study`"]);
        found("report/page.rs", "use crate::{runner::plan, base::error};", &["`report` may not import `runner`"]);
        found("optimize/mod.rs", "use crate::gear::geometry;", &["`optimize` may not import `gear`"]);
        found("stage/mod.rs", "use crate::store;", &["`stage` may not import `store`"]);
        // Tests import as their layer does.
        found("gear/x.rs", "#[cfg(test)]\nmod tests { use crate::stage::Stage; }", &["may not import `stage`"]);
        found("colour/mod.rs", "", &["`colour` is no layer"]);
        found(
            "main.rs",
            "fn main() { gearstudy::runner::run(); gearstudy::cli::main(); }",
            &["may not import `runner`"],
        );
    }

    #[test]
    fn the_long_way_round_is_found() {
        found("gear/compliance/energy.rs", "use super::super::geometry; use super::Material;", &[]);
        found("gear/compliance/mod.rs", "use super::super::stage::Stage;", &["may not import `stage`"]);
        found("base/mod.rs", "use super::gear;", &["`base` may not import `gear`"]);
    }

    #[test]
    fn a_kind_knows_no_other_kind() {
        found("stage/kinds/ste.rs", "use super::super::Stage; use crate::stage::kinds::ste::part;", &[]);
        found("stage/kinds/ste.rs", "use crate::stage::kinds::stiffness;", &["may not know the kind `stiffness`"]);
        found("stage/kinds/ste.rs", "use super::stiffness::Table;", &["may not know the kind `stiffness`"]);
        found("stage/kinds/mod.rs", "use crate::stage::kinds::stiffness;", &[]);
    }

    #[test]
    fn kernels_only_compute() {
        found("numeric/root.rs", "use std::collections::HashMap;", &["`HashMap` has no place in `numeric`"]);
        found("gear/x.rs", "fn f(a: f64) -> f64 { libm::sin(a) + a.sin() }", &["`.sin(`"]);
        found("gear/x.rs", "fn f() { println!(); }", &["`println!`"]);
        found("optimize/x.rs", "use rayon::prelude::*;", &["`rayon`"]);
        found("base/x.rs", "// std::fs\nlet a = \"std::time\"; #[cfg(test)] mod tests { use std::fs; }", &[]);
        found("gear/contact/tests.rs", "fn f(a: f64) -> f64 { a.sin() }", &[]);
        found("store/x.rs", "use std::fs;", &[]);
        found("gear/x.rs", "struct MyHashMapLike; fn expand() { x.single(); }", &[]);
    }

    #[test]
    fn some_crates_have_one_place() {
        found("runner/graph.rs", "use petgraph::Graph;", &[]);
        found("runner/plan.rs", "use petgraph::Graph;", &["`petgraph` may be named only in runner/graph.rs"]);
        found("stage/x.rs", "fn f(p: parquet::Row) {}", &["`parquet` may be named only in store/"]);
        found("runner/x.rs", "use crate::store::parquet; fn f() { parquet::write() }", &[]);
    }

    #[test]
    fn the_shape_of_files_is_kept() {
        assert_eq!(faults("base/x.rs", "use std::fmt;\n").len(), 1);
        found("base/x.rs", &"\n".repeat(MOST_LINES), &["more than 450 lines"]);
        found("base/x.rs", &"\n".repeat(MOST_LINES - 1), &[]);
        found(
            "base/x.rs",
            "fn f() { todo!() }\n#[ignore]\nfn g() { unimplemented!() }",
            &["2: `todo!`", "4: `unimpl", "3: `#[ig"],
        );
    }
}
