//! `manifest.json`: what was run, from what, where, and what came of it.
//!
//! Must not know: how any of it was computed. Field names are read by other programs: additions only, or another format.

mod config;
mod lines;
mod shown;
mod unread;
mod wire;

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};
use std::io::Write;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

pub use config::Config;
pub use shown::More;
pub use unread::{Unread, check_version};

use super::entry::{StoredColumn, StoredTable};
pub use super::key_record::{KeyRecord, Short};
use super::{hexadecimal, shared};
use crate::table::schema::{Column, Schema};
use declare::digest::Digest;
use declare::text::merge_conflict;

/// The format that is written; all up to it are read.
pub const FORMAT: u32 = 2;

impl<'a> From<&'a Manifest> for Cow<'a, Manifest> {
    fn from(manifest: &'a Manifest) -> Self {
        Self::Borrowed(manifest)
    }
}

impl From<Manifest> for Cow<'_, Manifest> {
    fn from(manifest: Manifest) -> Self {
        Self::Owned(manifest)
    }
}

/// The record of one run of one study.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Manifest {
    pub format: u32,
    pub study: String,
    pub title: String,
    pub seed: u64,
    /// The paper the study reproduces, if any: a key and the tables and figures it covers.
    pub source: Option<Source>,
    /// BLAKE3 of the study file's bytes.
    pub study_digest: String,
    pub program: Program,
    /// The repository that the study's file lies in.
    pub study_folder: StudyFolder,
    pub machine: Machine,
    /// UTC, RFC 3339. The only time in the file besides the seconds.
    pub written: String,
    pub seconds: f64,
    pub stages: Vec<StageRecord>,
    /// Tolerances of the study, by column: they decide what a comparison calls a difference, never a result.
    pub tolerances: Vec<(String, String)>,
    /// Every file beside the manifest that belongs to it, so that a later run can tell what is missing or stale.
    pub files: Vec<FileRecord>,
    /// Of one that has not all stages, what else there is; never written.
    pub more: More,
}

#[derive(Clone, Debug, Serialize, Deserialize, PartialEq, Eq)]
pub struct FileRecord {
    /// Relative to the manifest.
    pub file: String,
    /// None where `varies`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bytes: Option<u64>,
    /// BLAKE3 of its bytes, in hexadecimal; none where `varies`, and in manifests of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub digest: Option<String>,
    /// Set where the bytes do not follow from study and program alone: what they are in this folder stands in
    /// `files.json`, which is not kept under version control.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub varies: bool,
}

#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct Source {
    pub paper: String,
    #[serde(default)]
    pub tables: Vec<i64>,
    #[serde(default)]
    pub figures: Vec<i64>,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize, PartialEq)]
pub struct Program {
    pub version: String,
    /// Digest of all sources it was built from; empty in manifests of earlier versions, whose `commit` is that of the
    /// study's folder.
    #[serde(default)]
    pub code: String,
    /// The commit it was built from, where it was built in a repository that tracks its sources.
    pub commit: Option<String>,
    /// Whether the sources it was built from differed from that commit.
    pub uncommitted_changes: Option<bool>,
    pub rustc: String,
    pub profile: String,
    /// BLAKE3 of `Cargo.lock`; empty when it is not known.
    #[serde(default)]
    pub dependencies: String,
}

/// Where the study's file lay when it was run.
#[derive(Clone, Debug, Default, Serialize, Deserialize, PartialEq, Eq)]
pub struct StudyFolder {
    /// The commit of the folder, when it is a git work tree.
    pub commit: Option<String>,
    /// Whether the study differed from that commit: its file, or one that it names.
    pub uncommitted_changes: Option<bool>,
    /// The study's file, relative to the folder of the manifest, with `/`; none where the text was in no file, and in
    /// manifests of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The name that the file states; none where that is the name of the results.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

impl StudyFolder {
    /// Whether these are the results of another file than a manifest says, or of a file that states another name. What is in no
    /// file replaces none that is recorded.
    #[must_use]
    pub fn names_another_file(&self, recorded: &Self) -> bool {
        self.file.is_some() && (&self.file, &self.name) != (&recorded.file, &recorded.name)
    }
}

#[derive(Clone, Debug, Default, Serialize, Deserialize, PartialEq)]
pub struct Machine {
    pub system: String,
    pub processor: String,
    pub cores: usize,
    pub threads: usize,
}

#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct StageRecord {
    pub name: String,
    pub kind: String,
    pub version: u32,
    /// One per chunk.
    pub keys: Vec<KeyRecord>,
    /// The fields after defaults as a reader would write them, so that two runs can say *from what to what*. No part of
    /// any key; null in manifests of earlier versions.
    pub config: Config,
    /// `hit`, `ran`, `failed`, `skipped`.
    pub status: String,
    /// Why it ran.
    pub why: String,
    /// Seconds of computing, when it was computed (kept from then on a hit).
    pub seconds: f64,
    /// Work that was counted then, by name.
    pub work: BTreeMap<String, u64>,
    pub warnings: Vec<String>,
    pub left_out: Vec<OmissionRecord>,
    pub tables: Vec<TableRecord>,
}

#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct OmissionRecord {
    #[serde(with = "shared")]
    pub what: Arc<str>,
    #[serde(with = "shared")]
    pub why: Arc<str>,
    /// About what it would have taken, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub saved_seconds: Option<f64>,
}

#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct TableRecord {
    /// `stage.table`.
    pub name: String,
    #[serde(serialize_with = "shared::serialize")]
    pub description: Arc<str>,
    pub rows: usize,
    /// Content hash: schema and values without volatile columns.
    pub content: String,
    /// The Parquet file, relative to the manifest: its own, or one that many tables share (`bundle.rs`).
    pub file: String,
    #[serde(serialize_with = "shared::serialize")]
    pub columns: Arc<[ColumnRecord]>,
    /// Files beside the manifest that hold the table's lines: `stage.name`.
    pub files: Vec<String>,
    /// What readers may see of a table with columns on demand: each sees some of them, so the content of all does not
    /// tell. None for a table that every reader sees whole.
    pub parts: Option<PartsRecord>,
}

/// Content hashes of the parts of a table, in hexadecimal.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq, Eq)]
pub struct PartsRecord {
    /// Without the columns on demand.
    pub base: String,
    /// Column on demand, and its content by itself.
    pub on_demand: Vec<(String, String)>,
}

// Numbers in JSON are numbers, so every record equals itself, and shared ones need not be compared.
impl Eq for ColumnRecord {}

#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct ColumnRecord {
    pub name: String,
    #[serde(rename = "type")]
    pub kind: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    pub description: String,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub key: bool,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub volatile: bool,
    #[serde(default, skip_serializing_if = "is_zero")]
    pub absolute_tolerance: f64,
    #[serde(default, skip_serializing_if = "is_zero")]
    pub relative_tolerance: f64,
}

#[allow(clippy::trivially_copy_pass_by_ref)] // as serde calls it
fn is_zero(number: &f64) -> bool {
    *number == 0.0
}

/// The name of the file that a table has by itself.
pub(super) fn own_file(table: &str) -> String {
    [table, ".parquet"].concat()
}

/// The remedy for a manifest that cannot be read.
pub const AGAIN: &str = "`gearstudy run STUDY` writes it anew";

impl Manifest {
    /// As text, lines of which differ where something else differs.
    ///
    /// # Errors
    /// When it cannot be written as JSON, which cannot be.
    pub fn text(&self) -> Result<Vec<u8>, serde_json::Error> {
        self.text_with(&self.files)
    }

    /// Says what is alike with the same words in memory, so that comparing tables of one kind is quick.
    pub fn share(&mut self, other: &Self) {
        let mut known: HashMap<(&str, &str), &TableRecord> = HashMap::new();
        for stage in &other.stages {
            known.extend(stage.tables.iter().map(|table| ((stage.kind.as_str(), table.table()), table)));
        }
        let mut shared: HashMap<*const ColumnRecord, Arc<[ColumnRecord]>> = HashMap::new();
        for (stage, same) in self.stages.iter_mut().zip(&other.stages) {
            if stage.config == same.config {
                stage.config = same.config.clone();
            }
        }
        for stage in &mut self.stages {
            for table in &mut stage.tables {
                let columns = shared.entry(table.columns.as_ptr()).or_insert_with(|| {
                    let alike = known.get(&(&*stage.kind, table.name.split_once('.').map_or("", |(_, table)| table)));
                    let alike = alike.filter(|alike| alike.columns == table.columns);
                    Arc::clone(alike.map_or(&table.columns, |alike| &alike.columns))
                });
                table.columns = Arc::clone(columns);
            }
        }
    }

    /// The same with another list of files.
    ///
    /// # Errors
    /// As [`Manifest::text`].
    pub fn text_with(&self, files: &[FileRecord]) -> Result<Vec<u8>, serde_json::Error> {
        let mut text = Vec::new();
        self.write_with(files, &mut text)?;
        Ok(text)
    }

    /// Writes the text, which is as long as what is held of it.
    ///
    /// # Errors
    /// As [`Manifest::text`]; what the writer says.
    pub fn write(&self, writer: &mut impl Write) -> Result<(), serde_json::Error> {
        self.write_with(&self.files, writer)
    }

    fn write_with(&self, files: &[FileRecord], writer: &mut impl Write) -> Result<(), serde_json::Error> {
        wire::text(self, files)
            .serialize(&mut serde_json::Serializer::with_formatter(&mut *writer, lines::Lines::default()))?;
        writer.write_all(b"\n").map_err(serde_json::Error::io)
    }

    /// The text of a manifest with another list of files; none where it was not written as this program does.
    #[must_use]
    pub fn with_other_files(text: Vec<u8>, files: &[FileRecord]) -> Option<Vec<u8>> {
        wire::with_other_files(text, files)
    }

    /// The manifest that a file holds.
    ///
    /// # Errors
    /// That the bytes are no manifest, or one of another format.
    pub fn parse(bytes: &[u8]) -> Result<Self, Unread> {
        let parsed: Result<Self, _> = serde_json::from_slice(bytes);
        let is_known = |manifest: &Self| (1..=FORMAT).contains(&manifest.format);
        if parsed.as_ref().is_ok_and(is_known) {
            return parsed.map_err(|error| Unread::Damaged(error.to_string()));
        }
        check_version(bytes)?;
        let problem = match parsed {
            Ok(manifest) => format!("it has format {}, and this version reads formats 1 to {FORMAT}", manifest.format),
            Err(error) => match std::str::from_utf8(bytes).ok().and_then(merge_conflict) {
                Some((first, last)) => format!("it holds a merge conflict in lines {first} to {last}"),
                None => error.to_string(),
            },
        };
        Err(Unread::Damaged(problem))
    }
}

/// What a manifest says of a schema.
#[derive(Clone)]
pub struct Described {
    description: Arc<str>,
    columns: Arc<[ColumnRecord]>,
    files: Arc<[String]>,
}

impl Described {
    #[must_use]
    pub fn of(schema: &Schema) -> Self {
        let columns = schema.columns.iter().map(ColumnRecord::from).collect();
        Self { description: schema.description.as_str().into(), columns, files: schema.files.as_slice().into() }
    }
}

impl TableRecord {
    /// The record of one table of a stage.
    #[must_use]
    pub fn new(stage: &str, schema: &Schema, table: &StoredTable) -> Self {
        Self::described(stage, &Described::of(schema), table)
    }

    /// The same where it is known what the manifest says of the schema.
    #[must_use]
    pub fn described(stage: &str, described: &Described, table: &StoredTable) -> Self {
        let on_demand = table.columns.iter().map(|column| (column.name.clone(), hexadecimal::text(&column.content)));
        let parts = || PartsRecord { base: hexadecimal::text(&table.base), on_demand: on_demand.collect() };
        let name = [stage, ".", &table.name].concat();
        Self {
            file: own_file(&name),
            name,
            description: Arc::clone(&described.description),
            rows: table.rows,
            content: hexadecimal::text(&table.content),
            columns: Arc::clone(&described.columns),
            files: described.files.iter().map(|name| format!("{stage}.{name}")).collect(),
            parts: (!table.columns.is_empty()).then(parts),
        }
    }

    /// Whether its file holds what differs from run to run.
    #[must_use]
    pub fn varies(&self) -> bool {
        self.columns.iter().any(|column| column.volatile)
    }

    /// The name of its stage.
    #[must_use]
    pub fn stage(&self) -> &str {
        self.name.split_once('.').map_or(&self.name, |(stage, _)| stage)
    }

    /// The table's own name, without its stage's.
    #[must_use]
    pub fn table(&self) -> &str {
        self.name.split_once('.').map_or("", |(_, table)| table)
    }

    /// What is known of the table without its file; none when a digest is none.
    #[must_use]
    pub fn stored(&self) -> Option<StoredTable> {
        let name = self.table().to_owned();
        let content = Digest::from_hex(&self.content)?;
        let (base, columns) = match &self.parts {
            None => (content, Vec::new()),
            Some(parts) => {
                let column = |(name, content): &(String, String)| {
                    Some(StoredColumn { name: name.clone(), content: Digest::from_hex(content)? })
                };
                (Digest::from_hex(&parts.base)?, parts.on_demand.iter().map(column).collect::<Option<_>>()?)
            }
        };
        Some(StoredTable { name, rows: self.rows, content, base, columns, body: None })
    }
}

impl From<&Column> for ColumnRecord {
    fn from(column: &Column) -> Self {
        Self {
            name: column.name.clone(),
            kind: column.kind.name().to_owned(),
            unit: column.unit.clone(),
            description: column.description.clone(),
            key: column.key,
            volatile: column.volatile,
            absolute_tolerance: column.tolerance.absolute,
            relative_tolerance: column.tolerance.relative,
        }
    }
}

#[cfg(test)]
mod tests;
