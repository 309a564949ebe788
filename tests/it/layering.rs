//! Holds the source to what cargo cannot: who may import whom inside a crate, what the kernels never name, and what
//! every file keeps to. Which crate may name which, their `Cargo.toml` say.
//!
//! Eight of nine Rust programs measured have import cycles between their modules; nothing but a test prevents them.

mod cycles;
mod dangerous;
mod owners;
mod source;
mod swallowed;

use owners::OWNERS;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use source::{code, paths, without_tests};

/// A layer and what it may import directly; it may also import what those may. An arrow is "may import".
type Layers = &'static [(&'static str, &'static [&'static str])];

/// The folders of the crates, and their layers.
const CRATES: &[(&str, Layers)] = &[
    ("crates/cholesky/src/", &[]),
    (
        "crates/declare/src/",
        &[
            ("declared", &["parameter", "record"]),
            ("digest", &[]),
            ("error", &[]),
            ("number", &["units"]),
            ("parameter", &["units"]),
            ("record", &["digest", "error", "units"]),
            ("registry", &["declared"]),
            ("seed", &["digest"]),
            ("text", &[]),
            ("units", &[]),
            ("work", &[]),
        ],
    ),
    (
        "crates/declare-derive/src/",
        &[
            ("doc", &[]),
            ("marks", &[]),
            ("types", &["marks"]),
            ("fields", &["doc", "types"]),
            ("words", &["fields"]),
            ("joint", &["words"]),
        ],
    ),
    (
        "crates/gearmesh/src/",
        &[("prelude", &["gear", "optimize"]), ("gear", &["numeric"]), ("optimize", &["numeric"]), ("numeric", &[])],
    ),
    (
        "crates/studygraph/src/",
        &[
            ("runner", &["study", "diff"]),
            ("diff", &["history", "page"]),
            ("history", &["store"]),
            ("study", &["presence", "program"]),
            ("program", &["about", "stage"]),
            ("store", &["about", "git", "presence", "table", "threads", "warning"]),
            ("stage", &["table", "warning"]),
            ("warning", &[]),
            ("about", &[]),
            ("git", &[]),
            ("page", &[]),
            ("presence", &[]),
            ("table", &[]),
            ("threads", &[]),
        ],
    ),
    (
        "src/",
        &[
            ("cli", &["report", "query", "rexs"]),
            ("rexs", &["program"]),
            ("program", &["stage"]),
            ("stage", &[]),
            ("report", &[]),
            ("query", &[]),
        ],
    ),
];

/// Crates that compute: no files, clocks, threads, printing, chance order; and elementary functions from `libm` alone,
/// since those of the C library differ between CPUs.
const KERNELS: &[&str] = &["crates/cholesky/src/", "crates/declare/src/", "crates/gearmesh/src/"];

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

/// The only layer that the program's entry names.
const MAIN_MAY_IMPORT: &[&str] = &["cli"];

const MOST_LINES: usize = 450;

/// What is wrong with one source file, at `path` from the top.
fn faults(path: &str, text: &str) -> Vec<String> {
    let code = code(text);
    let shipped = if is_test(path) { String::new() } else { without_tests(&code) };
    let mut faults = Vec::new();
    shape(text, &code, &mut faults);
    imports(path, &code, &shipped, &mut faults);
    if let Some(kernel) = KERNELS.iter().find(|kernel| path.starts_with(**kernel)) {
        for (line, word) in words(&shipped, NEVER_IN_KERNELS) {
            faults.push(format!("{line}: `{word}` has no place in `{kernel}`, which only computes"));
        }
    }
    let own: Vec<_> = ["crate", "studygraph"].into_iter().flat_map(|root| paths(&code, root)).collect();
    let own: Vec<_> = own.into_iter().flat_map(|(_, path)| path).collect();
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

/// The layers of the crate that a file belongs to, and its path in there.
fn crate_of(path: &str) -> Option<(Layers, &str)> {
    CRATES.iter().find_map(|(folder, layers)| Some((*layers, path.strip_prefix(folder)?)))
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
    let Some((layers, inside)) = crate_of(path) else {
        faults.push("1: it belongs to no crate; add it to the table and to ARCHITECTURE.md".to_owned());
        return;
    };
    let layer = inside.split(['/', '.']).next().unwrap_or("");
    let is_main = path == "src/main.rs";
    if inside == "lib.rs" {
        return;
    }
    let allowed: BTreeSet<&str> =
        if is_main { MAIN_MAY_IMPORT.iter().copied().collect() } else { reach(layers, layer) };
    if !is_main && allowed.is_empty() {
        faults.push(format!("1: `{layer}` is not a layer; add it to the table and to ARCHITECTURE.md"));
        return;
    }
    let own = kind_of(path);
    let mut named = paths(code, if is_main { "gearstudy" } else { "crate" });
    named.extend(relative(inside, shipped));
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
    let kind = path.strip_prefix("src/stage/kinds/")?.split(['/', '.']).next()?;
    (kind != "mod").then_some(kind)
}

/// The layer itself and everything its arrows reach.
fn reach(layers: Layers, layer: &str) -> BTreeSet<&'static str> {
    let mut reached = BTreeSet::new();
    let mut open: Vec<&'static str> = layers.iter().filter(|(name, _)| *name == layer).map(|(name, _)| *name).collect();
    while let Some(name) = open.pop() {
        if reached.insert(name) {
            open.extend(layers.iter().filter(|(other, _)| *other == name).flat_map(|(_, next)| next.iter().copied()));
        }
    }
    reached
}

/// The module of a file.
fn module_of(path: &str) -> Vec<&str> {
    let mut module: Vec<&str> = path.trim_end_matches(".rs").split('/').collect();
    if matches!(module.last(), Some(&("mod" | "lib" | "main"))) {
        module.pop();
    }
    module
}

/// Paths that begin with `super`, as seen from the crate's root.
fn relative(path: &str, code: &str) -> Vec<(usize, Vec<String>)> {
    let module = module_of(path);
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

pub(crate) fn rust_files(folder: &Path) -> Vec<PathBuf> {
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
    let from_top = |file: &Path| file.strip_prefix(top).unwrap().to_string_lossy().replace('\\', "/");
    let mut found = Vec::new();
    let sources: Vec<PathBuf> = CRATES.iter().flat_map(|(folder, _)| rust_files(&top.join(folder))).collect();
    assert!(sources.len() > 200, "the source is not where it is looked for");
    for file in sources {
        let (path, text) = (from_top(&file), fs::read_to_string(&file).unwrap());
        found.extend(faults(&path, &text).into_iter().map(|fault| format!("{path}:{fault}")));
    }
    for folder in ["tests", "benches"] {
        for file in rust_files(&top.join(folder)) {
            let text = fs::read_to_string(&file).unwrap();
            let mut faults = Vec::new();
            shape(&text, &code(&text), &mut faults);
            found.extend(faults.into_iter().map(|fault| format!("{}:{fault}", from_top(&file))));
        }
    }
    assert!(found.is_empty(), "\n{}\n", found.join("\n"));
}

#[test]
fn the_layers_have_no_cycle() {
    for (_, layers) in CRATES {
        for (layer, _) in *layers {
            for (other, _) in *layers {
                let both = reach(layers, layer).contains(other) && reach(layers, other).contains(layer);
                assert!(layer == other || !both, "{layer}, {other}");
            }
        }
    }
}

/// A folder of `crates` that the table above does not know would be held to nothing.
#[test]
fn every_crate_is_in_the_table() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    for entry in fs::read_dir(top.join("crates")).unwrap() {
        let folder = format!("crates/{}/src/", entry.unwrap().file_name().to_string_lossy());
        assert!(CRATES.iter().any(|(known, _)| *known == folder), "{folder}");
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
        let graph = "crates/studygraph/src/";
        found(&format!("{graph}runner/plan.rs"), "use crate::{study::Study, store::x, table::y};", &[]);
        found(
            &format!("{graph}store/object.rs"),
            "\nfn f(x: crate::study::Study) {}",
            &["3: `store` may not import `study`"],
        );
        found(&format!("{graph}stage/mod.rs"), "use crate::store;", &["`stage` may not import `store`"]);
        found("src/report/page.rs", "use crate::{stage::pair, report::plot};", &["`report` may not import `stage`"]);
        found(
            "crates/gearmesh/src/optimize/mod.rs",
            "use crate::gear::geometry;",
            &["`optimize` may not import `gear`"],
        );
        // Tests import as their layer does.
        let tests = "#[cfg(test)]\nmod tests { use crate::gear::Pair; }";
        found("crates/gearmesh/src/numeric/x.rs", tests, &["may not import `gear`"]);
        found("src/colour/mod.rs", "", &["`colour` is not a layer"]);
        found("crates/colour/src/mod.rs", "", &["it belongs to no crate"]);
        let main = "fn main() { gearstudy::stage::run(); gearstudy::cli::main(); }";
        found("src/main.rs", main, &["may not import `stage`"]);
    }

    #[test]
    fn the_long_way_round_is_found() {
        let gear = "crates/gearmesh/src/gear/";
        found(&format!("{gear}compliance/energy.rs"), "use super::super::geometry; use super::Material;", &[]);
        found(
            &format!("{gear}compliance/mod.rs"),
            "use super::super::optimize::Strategy;",
            &["may not import `optimize`"],
        );
        found("crates/gearmesh/src/numeric/mod.rs", "use super::gear;", &["`numeric` may not import `gear`"]);
    }

    #[test]
    fn a_kind_knows_no_other_kind() {
        let kinds = "src/stage/kinds/";
        found(&format!("{kinds}ste.rs"), "use super::super::Stage; use crate::stage::kinds::ste::part;", &[]);
        let known = ["may not know the kind `stiffness`"];
        found(&format!("{kinds}ste.rs"), "use crate::stage::kinds::stiffness;", &known);
        found(&format!("{kinds}ste.rs"), "use super::stiffness::Table;", &known);
        found(&format!("{kinds}mod.rs"), "use crate::stage::kinds::stiffness;", &[]);
    }

    #[test]
    fn kernels_only_compute() {
        let mesh = |file: &str| format!("crates/gearmesh/src/{file}");
        found(
            &mesh("numeric/root.rs"),
            "use std::collections::HashMap;",
            &["`HashMap` has no place in `crates/gearmesh"],
        );
        found(&mesh("gear/x.rs"), "fn f(a: f64) -> f64 { libm::sin(a) + a.sin() }", &["`.sin(`"]);
        found(&mesh("gear/x.rs"), "fn f() { println!(); }", &["`println!`"]);
        found(&mesh("optimize/x.rs"), "use rayon::prelude::*;", &["`rayon`"]);
        let hidden = "// std::fs\nlet a = \"std::time\"; #[cfg(test)] mod tests { use std::fs; }";
        found("crates/declare/src/units.rs", hidden, &[]);
        found(&mesh("gear/contact/tests.rs"), "fn f(a: f64) -> f64 { a.sin() }", &[]);
        found("crates/studygraph/src/store/x.rs", "use std::fs;", &[]);
        found(&mesh("gear/x.rs"), "struct MyHashMapLike; fn expand() { x.single(); }", &[]);
    }

    #[test]
    fn some_crates_have_one_place() {
        let runner = "crates/studygraph/src/runner/";
        found(&format!("{runner}graph.rs"), "use petgraph::Graph;", &[]);
        found(
            &format!("{runner}plan.rs"),
            "use petgraph::Graph;",
            &["`petgraph` may be named only in crates/studygraph"],
        );
        found("src/stage/x.rs", "fn f(p: parquet::Row) {}", &["`parquet` may be named only in crates/studygraph"]);
        found(&format!("{runner}x.rs"), "use crate::store::parquet; fn f() { parquet::write() }", &[]);
    }

    #[test]
    fn the_shape_of_files_is_kept() {
        let file = "crates/declare/src/units.rs";
        assert_eq!(faults(file, "use std::fmt;\n").len(), 1);
        found(file, &"\n".repeat(MOST_LINES), &["more than 450 lines"]);
        found(file, &"\n".repeat(MOST_LINES - 1), &[]);
        found(
            file,
            "fn f() { todo!() }\n#[ignore]\nfn g() { unimplemented!() }",
            &["2: `todo!`", "4: `unimpl", "3: `#[ig"],
        );
    }
}
