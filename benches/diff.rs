//! Comparing results: from two folders on disk to the text of the report.

use std::fs;
use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group};

use crate::brief;
use studygraph::diff::compare::{Options, compare};
use studygraph::diff::pretty;
use studygraph::history::side::Side;
use studygraph::store::entry::StoredTable;
use studygraph::store::manifest::{FORMAT, Manifest, StageRecord, TableRecord};
use studygraph::store::parquet;
use studygraph::table::data::{Data, Table};
use studygraph::table::schema::{Column, Schema};

criterion_group!(name = benches; config = brief(); targets = diff);

/// Two keys and nine numbers that a compressor finds nothing in; one value in ten moved, and one row less.
fn table(rows: usize, moved: bool) -> Table {
    let kept = if moved { rows - 1 } else { rows };
    let float = |column: usize| -> Data {
        let frequency = 0.37 * (column + 1) as f64;
        let shift = |row: usize| if moved && row % 10 == column { 1e-6 } else { 0.0 };
        Data::Float((0..kept).map(|row| libm::sin(frequency * row as f64) + shift(row)).collect())
    };
    let names: [_; 9] = std::array::from_fn(|column| format!("value_{column}"));
    let mut columns = vec![Column::text("design", "").key(), Column::integer("point", "").key()];
    columns.extend(names.iter().map(|name| Column::float(name, "um", "")));
    let count = i64::try_from(kept).expect("it is small");
    let mut data = vec![Data::Text(vec!["optimum".to_owned(); kept]), Data::Integer((1..=count).collect())];
    data.extend((0..names.len()).map(float));
    Table::from_columns(Schema::new("curve", "", columns), data).expect("keys ascend")
}

/// The results of a study with this table alone.
fn publish(folder: &Path, table: &Table) {
    let described = StoredTable::describe(table).expect("it is a table");
    let record = TableRecord::new("stage", table.schema(), &described);
    let stage = StageRecord {
        name: "stage".to_owned(),
        kind: "ste".to_owned(),
        version: 1,
        keys: Vec::new(),
        config: serde_json::Value::Null.into(),
        status: "ran".to_owned(),
        why: String::new(),
        seconds: 0.0,
        work: std::collections::BTreeMap::new(),
        warnings: Vec::new(),
        left_out: Vec::new(),
        tables: vec![record],
    };
    let manifest = Manifest { format: FORMAT, study: "bench".to_owned(), stages: vec![stage], ..Manifest::default() };
    fs::create_dir(folder).expect("the folder is ours");
    let bytes = serde_json::to_vec(&manifest).expect("it is a manifest");
    fs::write(folder.join("manifest.json"), bytes).expect("the folder is ours");
    fs::write(folder.join("stage.curve.parquet"), parquet::write(table).expect("it is a table")).expect("it is ours");
}

fn diff(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("diff");
    group.sample_size(10);
    for (name, rows) in [("1e5 rows x 9", 100_000), ("1e6 rows x 9", 1_000_000)] {
        let folder = tempfile::tempdir().expect("there is a place for temporary files");
        let (old, new) = (folder.path().join("old"), folder.path().join("new"));
        let (before, after) = (table(rows, false), table(rows, true));
        publish(&old, &before);
        publish(&new, &after);
        group.bench_function(format!("report {name}"), |bencher| {
            bencher.iter(|| {
                let side = |path, label: &str| Side::folder(path, label).expect("it can be read");
                let (old, new) = (side(&old, "old"), side(&new, "new"));
                let found = compare(&old, &new, &Options::default()).expect("both are results");
                assert_eq!(found.studies[0].stages[0].tables[0].columns[0].beyond, rows / 10);
                black_box(pretty::text(&found, 120))
            });
        });
        group.bench_function(format!("values {name}"), |bencher| {
            bencher.iter(|| {
                studygraph::diff::table::compare("stage.curve", black_box(&before), black_box(&after), None, &|_| None)
            });
        });
    }
}
