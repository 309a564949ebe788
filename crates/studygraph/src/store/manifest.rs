//! `manifest.json`: what was run, from what, where, and what came of it.
//!
//! Must not know: how any of it was computed. Field names are read by other programs: additions only.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::entry::{StoredColumn, StoredTable};
use crate::table::schema::{Column, Schema};
use declare::digest::Digest;

pub const FORMAT: u32 = 1;

/// The record of one run of one study.
#[derive(Clone, Debug, Default, Serialize, Deserialize, PartialEq)]
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
    #[serde(default)]
    pub study_folder: StudyFolder,
    pub machine: Machine,
    /// UTC, RFC 3339. The only time in the file besides the seconds.
    pub written: String,
    pub seconds: f64,
    pub stages: Vec<StageRecord>,
    /// Tolerances of the study, by column: they decide what a comparison calls a difference, never a result.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tolerances: Vec<(String, String)>,
    /// Every file beside the manifest that belongs to it, so that a later run can tell what is missing or stale.
    #[serde(default)]
    pub files: Vec<FileRecord>,
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
    /// Whether anything in that work tree differed from the commit.
    pub uncommitted_changes: Option<bool>,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize, PartialEq)]
pub struct Machine {
    pub system: String,
    pub processor: String,
    pub cores: usize,
    pub threads: usize,
}

#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct StageRecord {
    pub name: String,
    pub kind: String,
    pub version: u32,
    /// One per chunk.
    pub keys: Vec<KeyRecord>,
    /// The fields after defaults as a reader would write them, so that two runs can say *from what to what*. No part of
    /// any key; null in manifests of earlier versions.
    #[serde(default, skip_serializing_if = "serde_json::Value::is_null")]
    pub config: serde_json::Value,
    /// `hit`, `ran`, `failed`, `skipped`.
    pub status: String,
    /// Why it ran.
    pub why: String,
    /// Seconds of computing, when it was computed (kept from then on a hit).
    pub seconds: f64,
    /// Work that was counted then, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub work: BTreeMap<String, u64>,
    pub warnings: Vec<String>,
    pub left_out: Vec<OmissionRecord>,
    pub tables: Vec<TableRecord>,
}

/// The parts of a cache key, each a digest in hexadecimal, so that two runs can say *why* they differ.
#[derive(Clone, Debug, Default, Serialize, Deserialize, PartialEq, Eq)]
pub struct KeyRecord {
    pub key: String,
    /// All fields but the chunked axis.
    pub config: String,
    /// Field, and the start of its digest: which part of `config` it was that changed.
    #[serde(default)]
    pub fields: Vec<(String, String)>,
    /// The values of the chunked axis; empty for a stage that runs in one piece.
    #[serde(default)]
    pub axis: String,
    /// Kind, version and sources.
    pub code: String,
    /// Empty for a stage that draws no random numbers.
    pub seed: String,
    pub demand: String,
    /// Port, and the digest of what came in through it.
    pub inputs: Vec<(String, String)>,
}

#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct OmissionRecord {
    pub what: String,
    pub why: String,
    /// About what it would have taken, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub saved_seconds: Option<f64>,
}

#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct TableRecord {
    /// `stage.table`.
    pub name: String,
    pub description: String,
    pub rows: usize,
    /// Content hash: schema and values without volatile columns.
    pub content: String,
    /// The Parquet file, relative to the manifest.
    pub file: String,
    pub columns: Vec<ColumnRecord>,
    /// Files beside the manifest that hold the table's lines: `stage.name`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<String>,
    /// What readers may see of a table with columns on demand: each sees some of them, so the content of all does not
    /// tell. None for a table that every reader sees whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
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

#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct ColumnRecord {
    pub name: String,
    #[serde(rename = "type")]
    pub kind: String,
    pub unit: String,
    pub description: String,
    pub key: bool,
    pub volatile: bool,
    pub absolute_tolerance: f64,
    pub relative_tolerance: f64,
}

impl TableRecord {
    /// The record of one table of a stage.
    #[must_use]
    pub fn new(stage: &str, schema: &Schema, table: &StoredTable) -> Self {
        let on_demand = table.columns.iter().map(|column| (column.name.clone(), column.content.to_string()));
        let parts = PartsRecord { base: table.base.to_string(), on_demand: on_demand.collect() };
        Self {
            name: format!("{stage}.{}", table.name),
            description: schema.description.clone(),
            rows: table.rows,
            content: table.content.to_string(),
            file: format!("{stage}.{}.parquet", table.name),
            columns: schema.columns.iter().map(ColumnRecord::from).collect(),
            files: schema.files.iter().map(|name| format!("{stage}.{name}")).collect(),
            parts: (!table.columns.is_empty()).then_some(parts),
        }
    }

    /// Whether its file holds what differs from run to run.
    #[must_use]
    pub fn varies(&self) -> bool {
        self.columns.iter().any(|column| column.volatile)
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
