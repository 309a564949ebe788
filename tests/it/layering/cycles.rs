//! Files of a crate import each other in one direction. A file and a file of a module inside it are one unit, and may
//! import each other.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fs;
use std::path::Path;

use super::source::{code, paths, without_tests};
use super::{CRATES, is_test, module_of, relative, rust_files};

/// The modules that have a file, each with those that its file imports.
type Imports = BTreeMap<String, BTreeSet<String>>;

/// The imports between files of a crate, each given by its path in the crate and its text.
fn imports(files: &[(String, String)]) -> Imports {
    let modules: BTreeSet<String> = files.iter().map(|(path, _)| module_of(path).join("::")).collect();
    let is_inside = |inner: &str, outer: &str| inner == outer || inner.starts_with(&format!("{outer}::"));
    let of_file = |(path, text): &(String, String)| {
        let module = module_of(path).join("::");
        let shipped = without_tests(&code(text));
        let targets = paths(&shipped, "crate").into_iter().chain(relative(path, &shipped));
        let files = targets.filter_map(|(_, target)| {
            (1..=target.len()).rev().map(|end| target[..end].join("::")).find(|prefix| modules.contains(prefix))
        });
        let others = files.filter(|file| !is_inside(file, &module) && !is_inside(&module, file)).collect();
        (module, others)
    };
    files.iter().map(of_file).collect()
}

/// The shortest circle through a module.
fn circle_through<'i>(imports: &'i Imports, module: &'i str) -> Option<Vec<&'i str>> {
    let mut importers: BTreeMap<&str, &str> = BTreeMap::new();
    let mut open = VecDeque::from([module]);
    while let Some(importer) = open.pop_front() {
        for imported in imports.get(importer).into_iter().flatten() {
            if !importers.contains_key(imported.as_str()) {
                importers.insert(imported, importer);
                open.push_back(imported);
            }
        }
    }
    let mut circle = vec![module];
    loop {
        circle.push(importers.get(circle[circle.len() - 1])?);
        if circle[circle.len() - 1] == module {
            circle.reverse();
            return Some(circle);
        }
    }
}

/// The shortest circle through each module that is in one, once.
fn circles(files: &[(String, String)]) -> Vec<String> {
    let imports = imports(files);
    let mut members = BTreeSet::new();
    let mut found = Vec::new();
    for module in imports.keys() {
        if let Some(circle) = circle_through(&imports, module).filter(|_| !members.contains(module.as_str())) {
            found.push(circle.join(" → "));
            members.extend(circle);
        }
    }
    found
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    for folder in CRATES.iter().map(|(folder, _)| *folder).chain(["python/src/"]) {
        let sources = rust_files(&top.join(folder)).into_iter().map(|file| {
            let path = file.strip_prefix(top.join(folder)).unwrap().to_string_lossy().replace('\\', "/");
            (path, fs::read_to_string(&file).unwrap())
        });
        let files: Vec<_> = sources.filter(|(path, _)| !is_test(path)).collect();
        assert!(!files.is_empty(), "{folder}");
        found.extend(circles(&files).into_iter().map(|circle| format!("{folder}: {circle}")));
    }
    assert!(found.is_empty(), "files import each other in a circle:\n{}", found.join("\n"));
}

#[test]
fn planted_circles_are_found() {
    let found = |files: &[(&str, &str)]| {
        circles(&files.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect::<Vec<_>>())
    };
    let files = [
        ("a.rs", "use crate::b::X;"),
        ("b.rs", "fn f() { super::c::{Y, d::Z}; }"),
        ("c/mod.rs", "mod d;"),
        ("c/d.rs", "use crate::{a::V, e};"),
        ("e.rs", "use crate::c::d::W;"),
    ];
    assert_eq!(found(&files), ["a → b → c::d → a", "e → c::d → e"]);
    // A module and a module inside it, imports of tests, comments.
    let files = [
        ("a.rs", "mod b; use self::b::X; use crate::c;"),
        ("a/b.rs", "use super::Y; use crate::a::Z;"),
        ("c.rs", "// crate::a\n#[cfg(test)]\nmod tests { use crate::a; }"),
        ("lib.rs", "mod a; pub use crate::a::Z;"),
    ];
    assert!(found(&files).is_empty());
}
