//! The tables of a run as the page has them: by stage, packed, unpacked by the page's script when one is opened.
//!
//! As elements of the page they were half of it. What differs from run to run is not packed, or the page would too. Must not
//! know: figures, verdicts.

use std::io::{self, Write};
use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::{Compression, GzBuilder};
use serde::{Serialize, Serializer};

use super::{ReportError, Tables};
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

/// A table of which the page shows something.
struct Found<'a> {
    name: String,
    record: &'a TableRecord,
    rows: usize,
    /// Bytes of its values as JSON.
    size: usize,
    table: Option<Arc<Table>>,
}

/// A table as the page's script has it.
#[derive(Serialize)]
struct Entry<'a> {
    name: &'a str,
    rows: usize,
    columns: Vec<ColumnView<'a>>,
    values: Vec<Values<'a>>,
}

#[derive(Serialize)]
struct ColumnView<'a> {
    name: &'a str,
    unit: String,
    kind: &'a str,
    meaning: String,
}

impl<'a> Entry<'a> {
    fn of(Found { name, record, rows, table, .. }: &'a Found<'_>) -> Self {
        let is_bundle = bundle::is_bundle(&record.file);
        let values = table.as_ref().map_or_else(Vec::new, |table| shown(record, table, is_bundle));
        Entry { name, rows: *rows, columns: columns(record, is_bundle), values }
    }
}

/// The first values of a column; nulls where there is nothing to be shown.
#[derive(Clone, Copy)]
struct Values<'t> {
    data: Option<&'t Data>,
    rows: usize,
}

/// # Errors
/// When it cannot be compressed, which is a mistake of this program.
pub fn records<'a>(manifest: &'a Manifest, tables: Tables<'_>) -> Result<Records<'a>, ReportError> {
    let failed = |error: io::Error| ReportError::Page(error.to_string());
    let mut stages: Vec<StageTables> = manifest.stages.iter().map(StageTables::of).collect();
    // Those of many stages of a kind stand behind those of single stages, as one.
    let mut found: Vec<Found> = Vec::new();
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
        let rows = table.as_ref().filter(|_| is_bundle).map_or(record.rows, |table| table.rows());
        let is_stored = table.is_some() || is_long;
        let size = table.as_ref().map_or(0, |table| length(&shown(record, table, is_bundle)));
        // What has no room need not be held either.
        let table = table.map(|table| if size > ROOM { first_rows(&table) } else { table });
        stages[at].tables.push(TableView { record, name: name.clone(), rows, is_stored });
        found.push(Found { name, record, rows, size, table });
    }
    // Of thousands of stages few have tables of their own.
    stages.retain(|stage| !stage.tables.is_empty() || !stage.files.is_empty());
    let mut entries: Vec<Entry> = found.iter().map(Entry::of).collect();
    let sizes: Vec<usize> = found.iter().map(|found| found.size).collect();
    let mut by_size: Vec<usize> = (0..entries.len()).collect();
    by_size.sort_by_key(|&entry| sizes[entry]);
    let mut room = ROOM;
    for entry in by_size {
        let fits = sizes[entry] <= room;
        room = if fits { room - sizes[entry] } else { 0 };
        for values in entries[entry].values.iter_mut().filter(|_| !fits) {
            values.rows = values.rows.min(FIRST_ROWS);
        }
    }
    let mut packer = GzBuilder::new().write(Vec::new(), Compression::best());
    let text = serde_json::to_vec(&entries).map_err(io::Error::from).map_err(failed)?;
    packer.write_all(&text).map_err(failed)?;
    Ok(Records { stages, packed: STANDARD.encode(packer.finish().map_err(failed)?) })
}

/// The script says a column that differs from run to run by a dash.
fn columns(record: &TableRecord, is_bundle: bool) -> Vec<ColumnView<'_>> {
    fn view(column: &ColumnRecord) -> ColumnView<'_> {
        let mut meaning = column.description.clone();
        for (is, remark) in [(column.key, "part of the key"), (column.volatile, "varies from run to run")] {
            if is {
                meaning = format!("{meaning} ({remark})");
            }
        }
        ColumnView { name: &column.name, unit: unit_symbol(&column.unit), kind: &column.kind, meaning }
    }
    let stage =
        ColumnView { name: bundle::STAGE, unit: String::new(), kind: "text", meaning: "Name of the stage.".to_owned() };
    is_bundle.then_some(stage).into_iter().chain(record.columns.iter().map(view)).collect()
}

/// By the record's columns, and only what it says; none where it says nothing.
fn shown<'t>(record: &TableRecord, table: &'t Table, is_bundle: bool) -> Vec<Values<'t>> {
    let stage = is_bundle.then(|| table.column(bundle::STAGE));
    let own = record.columns.iter().map(|column| table.column(&column.name).filter(|_| !column.volatile));
    stage.into_iter().chain(own).map(|data| Values { data, rows: table.rows() }).collect()
}

impl Serialize for Values<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.data {
            None => serializer.collect_seq((0..self.rows).map(|_| ())),
            // JSON has no NaN: null says "not applicable here".
            Some(Data::Float(values)) => serializer.collect_seq(&values[..self.rows]),
            Some(Data::Integer(values)) => serializer.collect_seq(&values[..self.rows]),
            Some(Data::Text(values)) => serializer.collect_seq(&values[..self.rows]),
            Some(Data::Flag(values)) => serializer.collect_seq(&values[..self.rows]),
        }
    }
}

/// Bytes of columns as JSON; where they are more than there is room, only that they are.
fn length(columns: &[Values]) -> usize {
    let mut length = Length(0);
    for values in columns {
        // It refuses nothing but what has no room.
        if serde_json::to_writer(&mut length, values).is_err() {
            break;
        }
    }
    length.0
}

fn first_rows(table: &Arc<Table>) -> Arc<Table> {
    let columns = table.columns().iter().map(|data| data.slice(0..FIRST_ROWS.min(table.rows()))).collect();
    let first = Table::from_columns(Arc::clone(table.shared_schema()), columns);
    first.map_or_else(|_| Arc::clone(table), Arc::new)
}

/// Counts what is written, up to what there is room for.
struct Length(usize);

impl Write for Length {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len();
        if self.0 > ROOM { Err(io::ErrorKind::StorageFull.into()) } else { Ok(bytes.len()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
