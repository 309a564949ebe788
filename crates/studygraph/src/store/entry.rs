//! One file per cache key: what was computed, and the tables themselves.
//!
//! Why one file and not a pool of objects: an entry is there whole or not at all, so a key never names a table that is
//! missing; storing costs one fsync however many tables there are; and cleaning up is deleting files. What is lost is
//! that two keys with equal tables store them twice. Tables are Parquet, byte for byte what goes into the results.
//!
//! ```text
//! "gearstudy entry 1\n" · length of header (u64, little endian) · BLAKE3 of header · header (JSON) · Parquet …
//! ```
//!
//! A plan reads the header only; the file's size shows a cut, and the digest of each table is checked when it is read.
//! Must not know: what a key is made of.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::error::StoreError;
use super::parquet;
use crate::table::data::{Data, Table};
use crate::table::schema::{Column, Schema};
use crate::warning::Warning;
use declare::digest::{Digest, Writer};

const MAGIC: &[u8; 18] = b"gearstudy entry 1\n";
const PREFIX: usize = MAGIC.len() + 8 + 32;
/// A header longer than this is not one of ours.
const LONGEST_HEADER: u64 = 1 << 28;

/// What is known about a key without reading tables.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CacheEntry {
    /// The key again, so that a file under a wrong name is found out.
    #[serde(with = "super::hexadecimal")]
    pub key: Digest,
    pub tables: Vec<StoredTable>,
    #[serde(flatten)]
    pub of_run: OfRun,
}

/// What is told of the computing besides its tables.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OfRun {
    pub seconds: f64,
    /// Work that was counted, by name; none in entries of earlier versions.
    #[serde(default)]
    pub work: BTreeMap<String, u64>,
    pub warnings: Vec<Warning>,
}

/// One table of an entry.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredTable {
    pub name: String,
    pub rows: usize,
    /// [`Table::content_hash`].
    #[serde(with = "super::hexadecimal")]
    pub content: Digest,
    /// The same without the columns on demand: what a reader sees who asked for none of them.
    #[serde(with = "super::hexadecimal")]
    pub base: Digest,
    /// Each column on demand by itself.
    pub columns: Vec<StoredColumn>,
    /// Nothing for a table that is put together from the entries of chunks.
    pub body: Option<Body>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredColumn {
    pub name: String,
    #[serde(with = "super::hexadecimal")]
    pub content: Digest,
}

/// The Parquet bytes of a table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Body {
    pub bytes: u64,
    #[serde(with = "super::hexadecimal")]
    pub digest: Digest,
}

impl StoredTable {
    /// Describes a table; its body is stored elsewhere.
    ///
    /// # Errors
    /// When a part of the table is not a table, which cannot be: it has fewer columns of the same rows.
    pub fn describe(table: &Table) -> Result<Self, StoreError> {
        let content = table.content_hash();
        let on_demand: Vec<&Column> = table.schema().columns.iter().filter(|column| column.on_demand).collect();
        let base = if on_demand.is_empty() { content } else { part(table, |column| !column.on_demand)?.content_hash() };
        let columns = on_demand.iter().map(|wanted| {
            let alone = part(table, |column| column.name == wanted.name)?;
            Ok(StoredColumn { name: wanted.name.clone(), content: alone.content_hash() })
        });
        let columns = columns.collect::<Result<_, StoreError>>()?;
        Ok(Self { name: table.name().to_owned(), rows: table.rows(), content, base, columns, body: None })
    }

    /// The digest of what a reader sees who asked for these columns on demand.
    pub fn write_seen(&self, wanted: &[String], writer: &mut Writer) {
        writer.text(&self.name).digest(&self.base);
        let seen: Vec<_> = self.columns.iter().filter(|column| wanted.contains(&column.name)).collect();
        writer.count(seen.len());
        for column in seen {
            writer.text(&column.name).digest(&column.content);
        }
    }
}

/// The table cut down to some of its columns; rows stay in their order.
///
/// # Errors
/// As [`Table::from_columns`].
pub fn part(table: &Table, keep: impl Fn(&Column) -> bool) -> Result<Table, StoreError> {
    let kept = table.schema().columns.iter().zip(table.columns()).filter(|(column, _)| keep(column));
    let (columns, data): (Vec<Column>, Vec<Data>) = kept.map(|(column, data)| (column.clone(), data.clone())).unzip();
    let schema = Schema { columns, ..table.schema().clone() };
    Table::from_columns(schema, data)
        .map_err(|error| StoreError::Format { table: table.name().to_owned(), problem: error.to_string() })
}

impl CacheEntry {
    /// The file of an entry whose tables are `tables`, and the entry.
    ///
    /// # Errors
    /// When a table cannot be written as Parquet.
    pub fn encode(key: Digest, tables: &[&Table], of_run: OfRun) -> Result<(Self, Vec<u8>), StoreError> {
        let mut stored = Vec::with_capacity(tables.len());
        let mut bodies = Vec::new();
        for table in tables {
            let body = parquet::write(table)?;
            let digest = digest(&body);
            let described = StoredTable::describe(table)?;
            stored.push(StoredTable { body: Some(Body { bytes: body.len() as u64, digest }), ..described });
            bodies.extend(body);
        }
        let entry = Self { key, tables: stored, of_run };
        let file = entry.file(&bodies)?;
        Ok((entry, file))
    }

    /// The file of an entry whose tables lie in other entries.
    ///
    /// # Errors
    /// When the entry cannot be written as JSON, which cannot be.
    pub fn file(&self, bodies: &[u8]) -> Result<Vec<u8>, StoreError> {
        let header = serde_json::to_vec(self).map_err(|error| {
            let table = self.tables.first().map_or_else(String::new, |table| table.name.clone());
            StoreError::Format { table, problem: error.to_string() }
        })?;
        let mut file = Vec::with_capacity(PREFIX + header.len() + bodies.len());
        file.extend_from_slice(MAGIC);
        file.extend_from_slice(&(header.len() as u64).to_le_bytes());
        file.extend_from_slice(blake3::hash(&header).as_bytes());
        file.extend_from_slice(&header);
        file.extend_from_slice(bodies);
        Ok(file)
    }

    /// Reads the header of `size` bytes; the file stands where the tables begin.
    ///
    /// # Errors
    /// A sentence that says what is damaged.
    pub fn read(file: &mut impl Read, size: u64, key: Digest) -> Result<Self, String> {
        let mut prefix = [0; PREFIX];
        file.read_exact(&mut prefix).map_err(|_| "it is cut short".to_owned())?;
        let (magic, rest) = prefix.split_at(MAGIC.len());
        let (length, expected) = rest.split_at(8);
        if magic != MAGIC {
            return Err("it does not begin as it should".to_owned());
        }
        let length = u64::from_le_bytes(length.try_into().map_err(|_| "it is cut short")?);
        if length > LONGEST_HEADER.min(size) {
            return Err("it is cut short".to_owned());
        }
        let mut header = vec![0; usize::try_from(length).map_err(|error| error.to_string())?];
        file.read_exact(&mut header).map_err(|_| "it is cut short".to_owned())?;
        if blake3::hash(&header).as_bytes() != expected {
            return Err("its header is not what was written".to_owned());
        }
        let entry: Self = serde_json::from_slice(&header).map_err(|error| error.to_string())?;
        let bodies: u64 = entry.tables.iter().filter_map(|table| table.body.as_ref()).map(|body| body.bytes).sum();
        if PREFIX as u64 + length + bodies != size {
            return Err("it has not the size that was written".to_owned());
        }
        if entry.key != key {
            return Err("it belongs to another key".to_owned());
        }
        Ok(entry)
    }

    /// The Parquet bytes of one table, checked; `file` as [`CacheEntry::read`] left it. `None`: not stored here.
    ///
    /// # Errors
    /// A sentence that says what is damaged.
    pub fn body(&self, file: &mut (impl Read + Seek), name: &str) -> Result<Option<Vec<u8>>, String> {
        let mut offset = 0u64;
        for table in &self.tables {
            let Some(body) = &table.body else { continue };
            if table.name == name {
                let offset = i64::try_from(offset).map_err(|error| error.to_string())?;
                file.seek(SeekFrom::Current(offset)).map_err(|error| error.to_string())?;
                let mut bytes = vec![0; usize::try_from(body.bytes).map_err(|error| error.to_string())?];
                file.read_exact(&mut bytes).map_err(|error| error.to_string())?;
                let intact = digest(&bytes) == body.digest;
                return if intact { Ok(Some(bytes)) } else { Err(format!("table `{name}` is not what was written")) };
            }
            offset += body.bytes;
        }
        Ok(None)
    }

    /// # Errors
    /// [`StoreError::NotDeterministic`] when `other` has other tables than this entry.
    pub fn agree(&self, other: &Self) -> Result<(), StoreError> {
        let content = |entry: &Self, name: &str| entry.tables.iter().find(|t| t.name == name).map(|t| t.content);
        let names = self.tables.iter().chain(&other.tables).map(|table| table.name.as_str());
        match names.into_iter().find(|name| content(self, name) != content(other, name)) {
            Some(table) => Err(StoreError::NotDeterministic { table: table.to_owned() }),
            None => Ok(()),
        }
    }
}

/// Opens and reads the entry at `path`; `None` when there is no such file.
///
/// What is not a file is not opened: a pipe would be waited for.
///
/// # Errors
/// A sentence that says what is damaged.
pub fn open(path: &Path, key: Digest) -> Result<Option<(CacheEntry, File)>, String> {
    match fs::metadata(path) {
        Ok(metadata) if metadata.is_file() => {}
        Ok(_) => return Err("it is not a regular file".to_owned()),
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error.to_string()),
    }
    let mut file = match File::open(path) {
        Ok(file) => file,
        // Cleaned up in this moment.
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error.to_string()),
    };
    // Another run may have replaced it since.
    let size = file.metadata().map_err(|error| error.to_string())?.len();
    let entry = CacheEntry::read(&mut file, size, key)?;
    Ok(Some((entry, file)))
}

fn digest(bytes: &[u8]) -> Digest {
    Digest(*blake3::hash(bytes).as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::parquet::tests::everything;

    #[test]
    fn a_reader_sees_only_the_columns_it_asked_for() {
        let table = everything(9);
        let stored = StoredTable::describe(&table).unwrap();
        assert_eq!(stored.content, table.content_hash());
        let seen = |stored: &StoredTable, wanted: &[&str]| {
            let mut writer = Writer::new("test");
            stored.write_seen(&wanted.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>(), &mut writer);
            writer.finish()
        };
        let narrow = part(&table, |column| !column.on_demand).unwrap();
        let narrow = StoredTable::describe(&narrow).unwrap();
        assert_eq!(seen(&stored, &[]), seen(&narrow, &[]));
        assert_ne!(seen(&stored, &["stiffness"]), seen(&stored, &[]));
        // A column nobody asked for changes nothing for a reader.
        let mut other = table.columns().to_vec();
        if let Data::Float(values) = &mut other[3] {
            values[0] += 1.0;
        }
        let other = StoredTable::describe(&Table::from_columns(table.schema().clone(), other).unwrap()).unwrap();
        assert_ne!(other.content, stored.content);
        assert_eq!(seen(&other, &[]), seen(&stored, &[]));
        assert_ne!(seen(&other, &["stiffness"]), seen(&stored, &["stiffness"]));
    }
}
