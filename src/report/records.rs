//! The tables of a run as the page has them: by stage, packed, unpacked by the page's script when one is opened.
//!
//! As elements of the page they were half of it. What differs from run to run is not packed, or the page would too. Must not
//! know: figures, verdicts.

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::{Compression, GzBuilder};
use serde::Serialize;
use serde_json::{Value, json};

use super::ReportError;
use super::figure::Tables;
use declare::number::unit_symbol;
use studygraph::store::manifest::{ColumnRecord, Manifest, TableRecord};
use studygraph::table::data::{Cell, Data, Table};

/// Bytes of unpacked values on a page. Small tables come first; of one that has no room the page has the first rows.
const ROOM: usize = 200_000;
const FIRST_ROWS: usize = 8;

/// The tables of a stage.
#[derive(Serialize)]
pub struct StageTables<'a> {
    stage: &'a str,
    kind: &'a str,
    tables: Vec<TableView<'a>>,
    /// Files of lines, such as drawings.
    files: Vec<&'a str>,
}

#[derive(Serialize)]
struct TableView<'a> {
    record: &'a TableRecord,
    is_stored: bool,
}

/// What the page shows of tables.
pub struct Records<'a> {
    pub stages: Vec<StageTables<'a>>,
    /// JSON, compressed, in base64.
    pub packed: String,
}

/// # Errors
/// When it cannot be compressed, which is a mistake of this program.
pub fn records<'a>(manifest: &'a Manifest, tables: Tables<'_>) -> Result<Records<'a>, ReportError> {
    let failed = |error: std::io::Error| ReportError::Page(error.to_string());
    let mut entries: Vec<(Value, Vec<Value>)> = Vec::new();
    let mut stages = Vec::new();
    for stage in &manifest.stages {
        let mut views = Vec::new();
        for record in &stage.tables {
            let table = tables(&record.name);
            views.push(TableView { record, is_stored: table.is_some() });
            entries.push((described(record), table.map_or_else(Vec::new, |table| columns(record, &table))));
        }
        let files = stage.tables.iter().flat_map(|record| &record.files).map(String::as_str).collect();
        stages.push(StageTables { stage: &stage.name, kind: &stage.kind, tables: views, files });
    }
    let sizes: Vec<usize> =
        entries.iter().map(|(_, columns)| columns.iter().map(|values| values.to_string().len()).sum()).collect();
    let mut by_size: Vec<usize> = (0..entries.len()).collect();
    by_size.sort_by_key(|&entry| sizes[entry]);
    let mut room = ROOM;
    for entry in by_size {
        let fits = sizes[entry] <= room;
        room = if fits { room - sizes[entry] } else { 0 };
        for values in entries[entry].1.iter_mut().filter(|_| !fits).filter_map(Value::as_array_mut) {
            values.truncate(FIRST_ROWS);
        }
    }
    let all: Vec<Value> = entries
        .into_iter()
        .map(|(mut entry, values)| {
            entry["values"] = Value::Array(values);
            entry
        })
        .collect();
    let mut packer = GzBuilder::new().write(Vec::new(), Compression::best());
    packer.write_all(Value::Array(all).to_string().as_bytes()).map_err(failed)?;
    Ok(Records { stages, packed: STANDARD.encode(packer.finish().map_err(failed)?) })
}

/// The script says a column that differs from run to run by a dash.
fn described(record: &TableRecord) -> Value {
    let column = |column: &ColumnRecord| {
        let mut meaning = column.description.clone();
        for (is, remark) in [(column.key, "part of the key"), (column.volatile, "varies from run to run")] {
            if is {
                meaning = format!("{meaning} ({remark})");
            }
        }
        json!({ "name": column.name, "unit": unit_symbol(&column.unit), "kind": column.kind, "meaning": meaning })
    };
    let columns: Vec<Value> = record.columns.iter().map(column).collect();
    json!({ "name": record.name, "rows": record.rows, "columns": columns })
}

/// By the record's columns, and only what it says.
fn columns(record: &TableRecord, table: &Table) -> Vec<Value> {
    let value = |data: &Data, row: usize| match data.cell(row) {
        // JSON has no NaN: null says "not applicable here".
        Cell::Float(value) => serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number),
        Cell::Integer(value) => json!(value),
        Cell::Text(value) => json!(value),
        Cell::Flag(value) => json!(value),
    };
    let column = |column: &ColumnRecord| match table.column(&column.name).filter(|_| !column.volatile) {
        Some(data) => Value::Array((0..table.rows()).map(|row| value(data, row)).collect()),
        None => Value::Array(vec![Value::Null; table.rows()]),
    };
    record.columns.iter().map(column).collect()
}
