//! All tables of a study in one HDF5 file, but for those of files, which lie beside it: `/stage/table/column`, one dataset
//! per column. A table that is too long for it is a group that says which file has it.
//!
//! Attributes of a table: `description`, `columns` (their order). Of a column: `unit`, `description`, `type`, and,
//! where they are not the usual ones, `key`, `volatile`, `allows_nan`, `on_demand`, `absolute_tolerance`,
//! `relative_tolerance`. Words are UTF-8 of variable length, flags the enumeration that h5py reads as bool. No times are
//! kept, so the same tables give the same bytes. A file is built in memory and written by whoever wants it: libhdf5 goes on
//! after a write that failed, and what it could not write is zeros then. It has one lock for all. Must not know: studies,
//! where tables come from.

mod raw;

use std::path::Path;
use std::str::FromStr;
use std::sync::atomic::{AtomicU64, Ordering};

use hdf5_metno::types::VarLenUnicode;
use hdf5_metno::{Dataset, File, FileBuilder, Group, H5Type, Location};

use super::error::StoreError;
use super::manifest::TableRecord;
use super::parquet::flags;
use crate::table::data::{Data, Table};
use crate::table::schema::{Column, Schema, Tolerance, Type};

/// A file that is being built in memory.
pub struct Writer {
    file: File,
    /// For messages.
    name: String,
}

impl Writer {
    /// Begins a file; `name` is for messages.
    ///
    /// # Errors
    /// When there is no memory for it.
    pub fn new(name: &str) -> Result<Self, StoreError> {
        static NUMBER: AtomicU64 = AtomicU64::new(0);
        let mut builder = FileBuilder::new();
        // Nothing of this name is opened or made, but libhdf5 takes two open files of one name for one.
        builder.access_plist().file_locking(false).core_filebacked(false);
        // From version 2 on the root has times too.
        builder.create_plist().obj_track_times(false);
        let unique = format!("{name} {}", NUMBER.fetch_add(1, Ordering::Relaxed));
        let file = builder.create(unique).map_err(|error| format(name.to_owned(), &error))?;
        Ok(Self { file, name: name.to_owned() })
    }

    /// Adds the table of a stage.
    ///
    /// # Errors
    /// When a word holds a zero byte, which HDF5 cannot.
    pub fn add(&mut self, stage: &str, table: &Table) -> Result<(), StoreError> {
        let failed = |error: hdf5_metno::Error| format(format!("{stage}.{}", table.name()), &error);
        let parent = if self.file.link_exists(stage) { self.file.group(stage) } else { group(&self.file, stage) };
        let group = parent.and_then(|parent| group(&parent, table.name())).map_err(failed)?;
        write_table(&group, table).map_err(failed)
    }

    /// Says of a table where it is instead: `rows` and `file`, and no columns.
    ///
    /// # Errors
    /// When there is no memory for it.
    pub fn leave_out(&mut self, stage: &str, record: &TableRecord) -> Result<(), StoreError> {
        let failed = |error: hdf5_metno::Error| format(record.name.clone(), &error);
        let parent = if self.file.link_exists(stage) { self.file.group(stage) } else { group(&self.file, stage) };
        let group = parent.and_then(|parent| group(&parent, record.table())).map_err(failed)?;
        let rows = record.rows as u64;
        word(&record.description)
            .and_then(|text| set(&group, "description", &text))
            .and_then(|()| set(&group, "rows", &rows))
            .and_then(|()| set(&group, "file", &word(&record.file)?))
            .map_err(failed)
    }

    /// Hands on the bytes of the file.
    ///
    /// # Errors
    /// When libhdf5 could not write all of it, be it on closing.
    pub fn finish<T>(self, take: impl FnOnce(&[u8]) -> T) -> Result<T, StoreError> {
        let failed = |error: hdf5_metno::Error| format(self.name.clone(), &error);
        let taken = raw::image(&self.file, take).map_err(failed)?;
        self.file.close().map_err(|error| format(self.name.clone(), &error))?;
        Ok(taken)
    }
}

/// Reads one table back.
///
/// # Errors
/// A sentence, when the file is not one of ours.
pub fn read(path: &Path, stage: &str, table: &str) -> Result<Table, String> {
    read_table(path, stage, table).map_err(|error| error.to_string())?
}

/// Without libhdf5's own lock (1.10.7 or later): no file is written in place, and the lock fails on some network disks.
fn unlocked() -> FileBuilder {
    let mut builder = FileBuilder::new();
    builder.access_plist().file_locking(false);
    builder
}

fn format(table: String, error: &hdf5_metno::Error) -> StoreError {
    StoreError::Format { table, problem: short(&error.to_string()) }
}

/// What the system said, where the library adds times, descriptors and addresses to it.
fn short(error: &str) -> String {
    let said = error.split_once("error message = '").and_then(|(_, rest)| rest.split_once('\''));
    said.map_or_else(|| error.replace('\n', " "), |(said, _)| said.to_owned())
}

fn group(parent: &Group, name: &str) -> hdf5_metno::Result<Group> {
    parent.create_group_builder().obj_track_times(false).create(name)
}

fn write_table(group: &Group, table: &Table) -> hdf5_metno::Result<()> {
    set(group, "description", &word(&table.schema().description)?)?;
    if table.schema().on_demand {
        set(group, "on_demand", &true)?;
    }
    let names = table.schema().columns.iter().map(|column| word(&column.name)).collect::<Result<Vec<_>, _>>()?;
    group.new_attr_builder().with_data(&names).create("columns")?;
    for (column, data) in table.schema().columns.iter().zip(table.columns()) {
        match data {
            Data::Float(values) => numbers(group, column, values)?,
            Data::Integer(values) => numbers(group, column, values)?,
            Data::Flag(values) => numbers(group, column, values)?,
            Data::Text(values) => {
                let words = values.iter().map(|value| word(value)).collect::<Result<Vec<_>, _>>()?;
                let builder = group.new_dataset::<VarLenUnicode>().obj_track_times(false).shape(words.len());
                let dataset = builder.create(column.name.as_str())?;
                raw::write_words(&dataset, &words)?;
                describe(&dataset, column)?;
            }
        }
    }
    Ok(())
}

fn numbers<T: H5Type>(group: &Group, column: &Column, values: &[T]) -> hdf5_metno::Result<()> {
    let builder = group.new_dataset_builder().obj_track_times(false);
    describe(&builder.with_data(values).create(column.name.as_str())?, column)
}

fn describe(dataset: &Dataset, column: &Column) -> hdf5_metno::Result<()> {
    set(dataset, "unit", &word(&column.unit)?)?;
    set(dataset, "description", &word(&column.description)?)?;
    set(dataset, "type", &word(column.kind.name())?)?;
    for (name, flag) in flags(column) {
        if flag {
            set(dataset, name, &true)?;
        }
    }
    let tolerances =
        [("absolute_tolerance", column.tolerance.absolute), ("relative_tolerance", column.tolerance.relative)];
    for (name, tolerance) in tolerances {
        if tolerance != 0.0 {
            set(dataset, name, &tolerance)?;
        }
    }
    Ok(())
}

fn set<T: H5Type>(location: &Location, name: &str, value: &T) -> hdf5_metno::Result<()> {
    location.new_attr::<T>().create(name)?.write_scalar(value)
}

fn word(text: &str) -> hdf5_metno::Result<VarLenUnicode> {
    VarLenUnicode::from_str(text).map_err(|error| format!("`{text}`: {error}").into())
}

fn get<T: H5Type>(location: &Location, name: &str) -> hdf5_metno::Result<Option<T>> {
    if location.attr_names()?.iter().any(|attribute| attribute == name) {
        location.attr(name)?.read_scalar().map(Some)
    } else {
        Ok(None)
    }
}

fn get_word(location: &Location, name: &str) -> hdf5_metno::Result<String> {
    Ok(get::<VarLenUnicode>(location, name)?.map_or_else(String::new, |word| word.as_str().to_owned()))
}

fn read_table(path: &Path, stage: &str, table: &str) -> hdf5_metno::Result<Result<Table, String>> {
    let group = unlocked().open(path)?.group(stage)?.group(table)?;
    let mut columns = Vec::new();
    let mut data = Vec::new();
    for name in group.attr("columns")?.read_raw::<VarLenUnicode>()? {
        let dataset = group.dataset(name.as_str())?;
        let kind = get_word(&dataset, "type")?;
        let Some(kind) = Type::from_name(&kind) else {
            return Ok(Err(format!("column `{name}` has the unknown type `{kind}`")));
        };
        data.push(match kind {
            Type::Float => Data::Float(dataset.read_raw()?),
            Type::Integer => Data::Integer(dataset.read_raw()?),
            Type::Flag => Data::Flag(dataset.read_raw()?),
            Type::Text => {
                let words = dataset.read_raw::<VarLenUnicode>()?;
                Data::Text(words.iter().map(|word| word.as_str().to_owned()).collect())
            }
        });
        let set = |name: &str| Ok::<_, hdf5_metno::Error>(get::<bool>(&dataset, name)?.unwrap_or(false));
        let number = |name: &str| Ok::<_, hdf5_metno::Error>(get::<f64>(&dataset, name)?.unwrap_or(0.0));
        columns.push(Column {
            name: name.as_str().to_owned(),
            kind,
            unit: get_word(&dataset, "unit")?,
            description: get_word(&dataset, "description")?,
            key: set("key")?,
            tolerance: Tolerance { absolute: number("absolute_tolerance")?, relative: number("relative_tolerance")? },
            volatile: set("volatile")?,
            allows_nan: set("allows_nan")?,
            on_demand: set("on_demand")?,
        });
    }
    let schema = Schema {
        name: table.to_owned(),
        description: get_word(&group, "description")?,
        columns,
        on_demand: get::<bool>(&group, "on_demand")?.unwrap_or(false),
        files: Vec::new(),
    };
    Ok(Table::from_columns(schema, data).map_err(|error| error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::parquet::tests::{assert_identical, everything};

    /// The tables as a file; where it lies goes with it.
    fn written(tables: &[(&str, Table)]) -> (tempfile::TempDir, std::path::PathBuf, Vec<u8>) {
        let mut writer = Writer::new("study.h5").unwrap();
        for (stage, table) in tables {
            writer.add(stage, table).unwrap();
        }
        let bytes = writer.finish(<[u8]>::to_vec).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("other.h5");
        std::fs::write(&path, &bytes).unwrap();
        (folder, path, bytes)
    }

    #[test]
    fn every_table_comes_back_identical() {
        // 70,000 words take two rounds of the library's largest buffer.
        let rows = [0, 1, 7, 3000, 70_000];
        let tables: Vec<_> = rows.iter().map(|rows| (format!("stage{rows}"), everything(*rows))).collect();
        let named: Vec<_> = tables.iter().map(|(stage, table)| (stage.as_str(), table.clone())).collect();
        let (_folder, path, _) = written(&named);
        for (stage, table) in &tables {
            assert_identical(table, &read(&path, stage, "curve").unwrap());
        }
        assert!(read(&path, "stage0", "absent").is_err());
        assert!(!std::path::Path::new("study.h5").exists(), "it is in memory alone");
    }

    #[test]
    fn the_same_tables_give_the_same_bytes() {
        // Version 1, which this may be, has no times of the root in any case.
        assert!(!Writer::new("study.h5").unwrap().file.create_plist().unwrap().obj_track_times());
        let first = written(&[("ste", everything(300))]).2;
        // Times in HDF5 count seconds.
        std::thread::sleep(std::time::Duration::from_millis(1100));
        assert!(first == written(&[("ste", everything(300))]).2);
    }

    #[test]
    fn two_tables_of_one_stage_lie_side_by_side() {
        let mut schema = everything(0).schema().clone();
        schema.name = "summary".to_owned();
        let summary = Table::from_rows(schema, vec![]).unwrap();
        let (_folder, path, _) = written(&[("ste", everything(2)), ("ste", summary)]);
        assert_eq!(read(&path, "ste", "summary").unwrap().rows(), 0);
        assert_eq!(read(&path, "ste", "curve").unwrap().rows(), 2);
    }

    #[test]
    fn a_message_is_what_the_system_said() {
        let long = "H5F__close_cb(): can't close file: file write failed: time = Sat Nov 21 06:16:37 2026\n, filename = \
                    '/r/.partial-S', errno = 28, error message = 'No space left on device', buf = 0x562b, offset = 0";
        assert_eq!(short(long), "No space left on device");
        assert_eq!(short("a\nb"), "a b");
    }

    #[test]
    fn a_word_that_hdf5_cannot_hold_is_an_error() {
        let schema = Schema::new("t", "", vec![Column::text("word", "")]);
        let table = Table::from_rows(schema, vec![vec!["a\0b".into()]]).unwrap();
        let mut writer = Writer::new("study.h5").unwrap();
        assert!(writer.add("s", &table).unwrap_err().to_string().contains("s.t"));
    }
}
