//! What every registered kind, family, method and optimiser promises, whoever adds one: it is named, documented, can be
//! read, built and run, and gives exactly the tables it declares.

mod friction;
mod goals;
mod keys;
mod members;
mod profiles;
mod samples;
mod searches;
mod tools;
pub mod walk;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use declare::units::parse_unit;
use gearstudy::program;
use gearstudy::stage::kinds::KINDS;
use gearstudy::stage::names;
use studygraph::diff::curves::told;
use studygraph::diff::table::compare;
use studygraph::runner::events::Silent;
use studygraph::runner::execute::execute;
use studygraph::runner::options::Options;
use studygraph::store::cache::Cache;
use studygraph::study::{self, declared, describe};
use studygraph::table::data::{Data, Table};
use studygraph::table::schema::Type;
use walk::{load, walk};

/// All examples as one study, each stage called after its kind.
pub fn examples() -> String {
    let mut text = "study: examples\nseed: 3\nstages:\n".to_owned();
    for kind in KINDS {
        text += &format!("  {}:\n", kind.name);
        for line in kind.example.trim().lines() {
            text += &format!("    {line}\n");
        }
    }
    text
}

fn is_name(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}

/// A sentence that a reader sees on its own.
fn is_sentence(text: &str) -> bool {
    text.len() > 8 && text.ends_with('.') && !text.starts_with(char::is_whitespace) && !text.contains("  ")
}

#[test]
fn every_kind_has_a_name_of_its_own_and_is_documented() {
    let names: BTreeSet<_> = KINDS.iter().map(|kind| kind.name).collect();
    assert_eq!(names.len(), KINDS.len());
    let list = describe::list(KINDS);
    for kind in KINDS {
        assert!(is_name(kind.name) && kind.version >= 1, "{}", kind.name);
        assert!(is_sentence(kind.summary), "{}: {:?}", kind.name, kind.summary);
        assert!(list.contains(kind.name) && list.contains(kind.summary));
        let about = describe::kind(kind);
        for field in kind.fields {
            assert!(
                about.contains(&format!("\n  {}: ", field.name)) && about.contains(field.summary),
                "{}",
                field.name
            );
        }
        for line in kind.example.trim().lines() {
            assert!(about.contains(line), "{line}");
        }
        // The code digest of a kind covers a file of its own; without one, a change to it would not be noticed.
        let shared = program::code_digest("no such kind");
        assert!(program::code_digest(kind.name).len() > shared.len(), "{} has no code of its own", kind.name);
    }
}

#[test]
fn every_declared_field_is_one_that_a_study_can_give() {
    assert_eq!(declared::faults(KINDS), Vec::<String>::new());
}

/// A comparison takes them for curves wherever they are given: the points are in the order of the column they are over.
#[test]
fn tables_that_are_declared_to_hold_curves_do() {
    let study = load(&examples());
    let done = walk(&study);
    let all = studies();
    let mut seen = Vec::new();
    for node in &study.nodes {
        for curves in node.kind.curves {
            let place = format!("{}.{}", node.kind.name, curves.table);
            // Some, not every method gives.
            let of_kind = all.iter().flat_map(|study| &study.nodes).filter(|other| other.kind.name == node.kind.name);
            let mut schemas = of_kind.flat_map(|node| node.stage.outputs());
            let schema = schemas.find(|schema| schema.name == curves.table);
            let schema = schema.unwrap_or_else(|| panic!("{place} is no table"));
            for column in [curves.along, curves.quantity] {
                assert!(schema.column(column).is_some_and(|column| column.kind == Type::Float), "{place}: {column}");
            }
            let Some(table) = done[&node.name].tables.iter().find(|table| table.name() == curves.table) else {
                continue;
            };
            let raised = table.schema().columns.iter().zip(table.columns()).map(|(column, data)| match data {
                Data::Float(values) if column.name == curves.quantity => {
                    Data::Float(values.iter().map(|value| value + 1.0).collect())
                }
                data => data.clone(),
            });
            let other = Table::from_columns(table.schema().clone(), raised.collect()).unwrap();
            let mut diff = compare(&place, table, &other, None, &|_| None);
            told(&mut diff, (table, &other), (curves.along, curves.quantity), &|_| None);
            let found = diff.curves.unwrap_or_else(|| panic!("{place} is in another order"));
            assert_eq!(found.columns[0].name, curves.quantity, "{place}");
            assert!(found.compared > 0 && found.beyond == found.compared && found.resampled == 0, "{place}: {found:?}");
            seen.push(place);
        }
    }
    assert!(seen.iter().any(|place| place == "ste.curve") && seen.len() >= 5, "{seen:?}");
}

/// The studies of this repository and the examples: every kind, in use.
fn studies() -> Vec<study::Study> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies");
    let mut paths: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    paths.sort();
    assert!(!paths.is_empty());
    let mut studies = vec![load(&examples())];
    studies.extend(paths.iter().map(|path| program::load(path).unwrap_or_else(|error| panic!("{error}"))));
    studies
}

#[test]
fn every_table_is_declared_in_full() {
    let mut kinds = BTreeSet::new();
    for study in studies() {
        for node in &study.nodes {
            kinds.insert(node.kind.name);
            let schemas = node.stage.outputs();
            let names: BTreeSet<_> = schemas.iter().map(|schema| schema.name.as_str()).collect();
            assert_eq!(names.len(), schemas.len(), "{}: two tables of one name", node.kind.name);
            for schema in &schemas {
                let place = format!("{}.{}", node.kind.name, schema.name);
                assert!(is_name(&schema.name) && !schema.columns.is_empty(), "{place}");
                assert!(is_sentence(&schema.description), "{place}: {:?}", schema.description);
                let columns: BTreeSet<_> = schema.columns.iter().map(|column| column.name.as_str()).collect();
                assert_eq!(columns.len(), schema.columns.len(), "{place}: two columns of one name");
                for column in &schema.columns {
                    let place = format!("{place}.{}", column.name);
                    assert!(is_name(&column.name), "{place}");
                    assert!(is_sentence(&column.description), "{place}: {:?}", column.description);
                    assert!(
                        column.unit.is_empty() || column.kind == Type::Float,
                        "{place} is not a number and has a unit"
                    );
                    assert!(column.unit.is_empty() || parse_unit(&column.unit).is_ok(), "{place}: {}", column.unit);
                    assert!(
                        !column.key || !(column.volatile || column.on_demand || column.allows_nan),
                        "{place}: a key"
                    );
                    let tolerance = column.tolerance;
                    assert!(tolerance.absolute >= 0.0 && (0.0..0.1).contains(&tolerance.relative), "{place}");
                }
            }
            for omission in node.stage.left_out(&walk::demand(node.stage.as_ref(), true)) {
                assert!(!omission.what.is_empty() && !omission.why.is_empty(), "{}", node.kind.name);
            }
        }
    }
    assert_eq!(kinds.len(), KINDS.len(), "only {kinds:?} are in use");
}

/// A table without a key has one row: otherwise rows could not be told apart.
#[test]
fn every_example_runs_and_gives_finite_tables_whose_rows_have_keys() {
    let ran = walk(&load(&examples()));
    assert_eq!(ran.len(), KINDS.len());
    for (stage, ran) in ran {
        for table in &ran.tables {
            let keyed = table.schema().columns.iter().any(|column| column.key);
            assert!(keyed || table.rows() <= 1, "{stage}.{}: {} rows without a key", table.name(), table.rows());
            for (column, data) in table.schema().columns.iter().zip(table.columns()) {
                if let Data::Float(values) = data {
                    let finite = values.iter().all(|value| value.is_finite() || column.allows_nan && value.is_nan());
                    assert!(finite, "{stage}.{}.{}", table.name(), column.name);
                }
            }
        }
    }
}

/// Second method: the runner, with cache, threads, chunks and demand, gives what the walk gives.
#[test]
fn the_runner_gives_what_a_plain_walk_through_the_stages_gives() {
    let quick = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies/quick.yaml");
    {
        let study = program::load(&quick).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::open(folder.path()).unwrap();
        let stop = std::sync::atomic::AtomicBool::new(false);
        let outcome = execute(&study, &cache, &Options::default(), &Silent, &stop).unwrap();
        assert_eq!(outcome.faults().count(), 0);
        let plain = walk(&study);
        let mut compared = 0;
        for stage in &outcome.stages {
            // Chunks report their worst cases, a stage by itself the worst of all.
            let without_count = |warnings: &[String]| -> Vec<String> {
                let shown =
                    |warning: &String| warning.split(". This is the worst of ").next().unwrap_or_default().to_owned();
                warnings.iter().map(shown).collect()
            };
            assert_eq!(without_count(&stage.warnings), without_count(&plain[&stage.name].warnings), "{}", stage.name);
            for (schema, _) in &stage.tables {
                let table = outcome.table(&cache, &stage.name, &schema.name).unwrap();
                let other = plain[&stage.name].tables.iter().find(|other| other.name() == schema.name).unwrap();
                assert_eq!(table.rows(), other.rows());
                for column in table.schema().columns.iter().filter(|column| !column.volatile) {
                    let (one, two) = (table.column(&column.name).unwrap(), other.column(&column.name).unwrap());
                    let same = (0..table.rows()).all(|row| one.cell(row).to_string() == two.cell(row).to_string());
                    assert!(same, "{}.{}.{}", stage.name, schema.name, column.name);
                    compared += 1;
                }
            }
        }
        assert!(compared > 100, "{compared}");
    }
}

/// What is read by name is there: tables of the ports in what their stages give, columns in the tables they are read from.
#[test]
fn every_table_that_is_read_by_name_is_written_by_its_kind() {
    let mut ports = 0;
    for study in studies() {
        let outputs = |name: &str| study.nodes.iter().find(|node| node.name == name).unwrap().stage.outputs();
        for node in &study.nodes {
            for port in node.stage.inputs().iter().filter(|port| port.through.is_none() && port.only_for.is_empty()) {
                for want in &port.wants {
                    let given = outputs(&port.stage);
                    let table = given.iter().find(|schema| schema.name == want.table);
                    let lacks = |column: &&String| table.is_some_and(|table| table.column(column).is_none());
                    assert!(table.is_some(), "{}: `{}` has no `{}`", node.name, port.stage, want.table);
                    assert_eq!(want.columns.iter().find(lacks), None, "{}: `{}.{}`", node.name, port.stage, want.table);
                    ports += 1;
                }
            }
        }
        for read in names::READ {
            for node in study.nodes.iter().filter(|node| node.kind.name == read.kind) {
                let given = node.stage.outputs();
                let table = given.iter().find(|schema| schema.name == read.table);
                // A gear alone has no pair.
                let Some(table) = table else {
                    assert!(node.stage.lacks(read.table).is_some(), "`{}` has no `{}`", node.name, read.table);
                    continue;
                };
                for column in read.columns {
                    assert!(table.column(column).is_some(), "`{}.{}` has no `{column}`", node.name, read.table);
                }
            }
        }
    }
    assert!(ports > 50, "{ports}");
}
