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
use studygraph::store::bundle;
use studygraph::store::manifest::{ColumnRecord, Manifest, StageRecord, TableRecord};
use studygraph::table::data::{Data, Table};

/// Bytes of unpacked values on a page. Small tables come first; of one that has no room the page has the first rows.
const ROOM: usize = 200_000;
const FIRST_ROWS: usize = 8;
/// A table of more rows has no room whatever is in it, and may not have any in memory: the page has none of its rows.
const LONG: usize = ROOM / 2;

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
    /// As it is published: `stage.table`, or `_kind.table` of many stages.
    name: String,
    rows: usize,
    is_stored: bool,
}

impl<'a> StageTables<'a> {
    /// A stage without its tables.
    fn of(stage: &'a StageRecord) -> Self {
        let files = stage.tables.iter().flat_map(|record| &record.files).map(String::as_str).collect();
        Self { stage: &stage.name, kind: &stage.kind, tables: Vec::new(), files }
    }
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
    let mut entries: Vec<(Value, (usize, Vec<Value>))> = Vec::new();
    let mut stages: Vec<StageTables> = manifest.stages.iter().map(StageTables::of).collect();
    // Those of many stages of a kind stand behind those of single stages, as one.
    for (group, record) in bundle::published(manifest) {
        let is_bundle = bundle::is_bundle(&record.file);
        let name = format!("{group}.{}", record.table());
        let is_long = record.rows > LONG;
        let table = if is_long { None } else { tables(&name) };
        let at = stages.iter().position(|known| known.stage == group).unwrap_or_else(|| {
            stages.push(StageTables {
                stage: group,
                kind: "tables of many stages",
                tables: Vec::new(),
                files: Vec::new(),
            });
            stages.len() - 1
        });
        let rows = table.as_ref().filter(|_| is_bundle).map_or(record.rows, Table::rows);
        let is_stored = table.is_some() || is_long;
        let shown = table.map_or((0, Vec::new()), |table| {
            let own = shown(record, &table, is_bundle);
            // What has no room at all need not be written to know it.
            let size =
                own.iter().fold(0, |size, data| if size > ROOM { size } else { size + length(*data, table.rows()) });
            let rows = if size > ROOM { table.rows().min(FIRST_ROWS) } else { table.rows() };
            (size, own.into_iter().map(|data| values(data, rows)).collect())
        });
        entries.push((described(record, &name, rows, is_bundle), shown));
        stages[at].tables.push(TableView { record, name, rows, is_stored });
    }
    // Of thousands of stages few have tables of their own.
    stages.retain(|stage| !stage.tables.is_empty() || !stage.files.is_empty());
    let sizes: Vec<usize> = entries.iter().map(|(_, (size, _))| *size).collect();
    let mut by_size: Vec<usize> = (0..entries.len()).collect();
    by_size.sort_by_key(|&entry| sizes[entry]);
    let mut room = ROOM;
    for entry in by_size {
        let fits = sizes[entry] <= room;
        room = if fits { room - sizes[entry] } else { 0 };
        for values in entries[entry].1.1.iter_mut().filter(|_| !fits).filter_map(Value::as_array_mut) {
            values.truncate(FIRST_ROWS);
        }
    }
    let all: Vec<Value> = entries
        .into_iter()
        .map(|(mut entry, (_, values))| {
            entry["values"] = Value::Array(values);
            entry
        })
        .collect();
    let mut packer = GzBuilder::new().write(Vec::new(), Compression::best());
    packer.write_all(Value::Array(all).to_string().as_bytes()).map_err(failed)?;
    Ok(Records { stages, packed: STANDARD.encode(packer.finish().map_err(failed)?) })
}

/// The script says a column that differs from run to run by a dash.
fn described(record: &TableRecord, name: &str, rows: usize, is_bundle: bool) -> Value {
    let column = |column: &ColumnRecord| {
        let mut meaning = column.description.clone();
        for (is, remark) in [(column.key, "part of the key"), (column.volatile, "varies from run to run")] {
            if is {
                meaning = format!("{meaning} ({remark})");
            }
        }
        json!({ "name": column.name, "unit": unit_symbol(&column.unit), "kind": column.kind, "meaning": meaning })
    };
    let stage = json!({ "name": bundle::STAGE, "unit": "", "kind": "text", "meaning": "Name of the stage." });
    let stage = is_bundle.then_some(stage);
    let columns: Vec<Value> = stage.into_iter().chain(record.columns.iter().map(column)).collect();
    json!({ "name": name, "rows": rows, "columns": columns })
}

/// By the record's columns, and only what it says; none where it says nothing.
fn shown<'t>(record: &TableRecord, table: &'t Table, is_bundle: bool) -> Vec<Option<&'t Data>> {
    let stage = is_bundle.then(|| table.column(bundle::STAGE));
    let own = record.columns.iter().map(|column| table.column(&column.name).filter(|_| !column.volatile));
    stage.into_iter().chain(own).collect()
}

fn value(data: &Data, row: usize) -> Value {
    match data {
        // JSON has no NaN: null says "not applicable here".
        Data::Float(values) => serde_json::Number::from_f64(values[row]).map_or(Value::Null, Value::Number),
        Data::Integer(values) => json!(values[row]),
        Data::Text(values) => json!(values[row]),
        Data::Flag(values) => json!(values[row]),
    }
}

fn values(data: Option<&Data>, rows: usize) -> Value {
    Value::Array((0..rows).map(|row| data.map_or(Value::Null, |data| value(data, row))).collect())
}

/// Bytes of so many values as JSON; where they are more than there is room, only that they are.
fn length(data: Option<&Data>, rows: usize) -> usize {
    let mut length = "[]".len() + rows.saturating_sub(1);
    for row in 0..rows {
        length += data.map_or("null".len(), |data| value(data, row).to_string().len());
        if length > ROOM {
            break;
        }
    }
    length
}
