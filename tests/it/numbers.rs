//! `docs/numbers.md` leads from every column of every table to its method, its error bar, and a test that exists.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use crate::registry::examples;
use crate::registry::walk::load;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A line of a table of the page: tables, columns, tests.
struct Line {
    kinds_and_table: String,
    columns: Vec<String>,
    bar: String,
    tests: Vec<String>,
}

/// What stands in backquotes.
fn quoted(text: &str) -> Vec<String> {
    text.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

fn lines(page: &str) -> Vec<Line> {
    let (mut kind, mut table) = (String::new(), String::new());
    let mut found = Vec::new();
    for line in page.lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            heading.clone_into(&mut kind);
        }
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let [_, of, columns, _, bar, tests, _] = cells[..] else { continue };
        if of == "table" || of.starts_with("--") {
            continue;
        }
        for name in if of.is_empty() { vec![table.clone()] } else { quoted(of) } {
            table = if name.contains('.') { name } else { format!("{kind}.{name}") };
            found.push(Line {
                kinds_and_table: table.clone(),
                columns: quoted(columns),
                bar: bar.to_owned(),
                tests: quoted(tests),
            });
        }
    }
    found
}

fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, into);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            into.push(path);
        }
    }
}

/// The functions that are tests, by what stands before them.
fn tests() -> BTreeSet<String> {
    let mut files = Vec::new();
    for folder in ["src", "crates", "tests"] {
        sources(&root().join(folder), &mut files);
    }
    let mut found = BTreeSet::new();
    for file in files {
        let text = fs::read_to_string(file).unwrap();
        let mut attribute = false;
        for line in text.lines().map(str::trim) {
            if let Some(name) = line.strip_prefix("fn ").filter(|_| attribute) {
                found.insert(name.split(['(', '<']).next().unwrap().to_owned());
            }
            attribute = line == "#[test]" || (attribute && line.starts_with('#'));
        }
    }
    found
}

#[test]
fn every_column_leads_to_its_method_its_bar_and_its_test() {
    let page = fs::read_to_string(root().join("docs/numbers.md")).unwrap();
    let lines = lines(&page);
    let mut told: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for line in &lines {
        told.entry(&line.kinds_and_table).or_default().extend(line.columns.iter().map(String::as_str));
    }
    let study = load(&examples());
    let mut declared: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for node in &study.nodes {
        for schema in node.stage.outputs() {
            let columns = schema.columns.iter().map(|column| column.name.clone()).collect();
            declared.insert(format!("{}.{}", node.kind.name, schema.name), columns);
        }
    }
    assert!(declared.len() > 30, "{declared:?}");
    let mut missing = Vec::new();
    for (table, columns) in &declared {
        for column in columns {
            // Variables of a search: the family's name and the field's.
            let variable =
                table.starts_with("optimizer.") && ["relief_", "crowning_"].iter().any(|part| column.contains(part));
            if !variable && !told.get(table.as_str()).is_some_and(|told| told.contains(column.as_str())) {
                missing.push(format!("{table}.{column}"));
            }
        }
    }
    assert!(missing.is_empty(), "docs/numbers.md does not have {missing:?}");
    for (table, columns) in &told {
        let Some(declared) = declared.get(*table) else {
            // What the examples do not ask for.
            assert!(
                ["stiffness.root_stress", "stiffness.root_influences"].contains(table) || table.starts_with("export."),
                "there is no table `{table}`"
            );
            continue;
        };
        for column in columns {
            let elsewhere = table.starts_with("accuracy.") || table.starts_with("report.");
            assert!(elsewhere || declared.contains(*column), "there is no `{table}.{column}`");
        }
    }

    let known = tests();
    assert!(known.len() > 500, "{}", known.len());
    for line in &lines {
        assert!(!line.columns.is_empty() || line.bar.is_empty() || !line.tests.is_empty(), "{}", line.kinds_and_table);
        assert!(line.bar.is_empty() || !line.tests.is_empty(), "{} names no test", line.kinds_and_table);
        for test in &line.tests {
            assert!(known.contains(test), "docs/numbers.md names `{test}`, which is not a test");
        }
    }
}

/// Tests that other pages name exist too, and their links lead somewhere.
#[test]
fn pages_name_tests_and_sections_that_exist() {
    let known = tests();
    let mut files: Vec<PathBuf> = Vec::new();
    for folder in ["docs", "docs/decisions", "docs/papers"] {
        let entries = fs::read_dir(root().join(folder)).unwrap().flatten().map(|entry| entry.path());
        files.extend(entries.filter(|path| path.extension().is_some_and(|ending| ending == "md")));
    }
    let anchors = |text: &str| -> BTreeSet<String> {
        let heading = |line: &str| {
            let title = line.trim_start_matches('#').trim().to_lowercase();
            let kept = title.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
            kept.map(|c| if c == ' ' { '-' } else { c }).collect::<String>()
        };
        let headings = text.lines().filter(|line| line.starts_with('#')).map(heading);
        let named = text.split("<a id=\"").skip(1).filter_map(|rest| rest.split('"').next()).map(str::to_owned);
        headings.chain(named).collect()
    };
    for file in &files {
        let text = fs::read_to_string(file).unwrap();
        let shown = file.display();
        // `file.rs: function`, as methods are held by.
        for name in quoted(&text).iter().filter_map(|quote| quote.split_once(".rs: ")).map(|(_, name)| name.trim()) {
            assert!(known.contains(name) || !name.contains('_'), "{shown} names `{name}`, which is not a test");
        }
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            if link.contains("://") {
                continue;
            }
            let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if path.is_empty() { file.clone() } else { file.parent().unwrap().join(path) };
            assert!(target.exists(), "{shown} links to {link}, which is not there");
            if !anchor.is_empty() {
                let there = anchors(&fs::read_to_string(target).unwrap());
                assert!(there.contains(anchor), "{shown} links to {link}, which is not there");
            }
        }
    }
}
