//! Verifying an archive: its study is run again from nothing, and every table is compared with the archived one; page,
//! figures, drawings and HDF5 are made again from the archived tables (`files.rs`).
//!
//! What is run is what this program makes of the study in the archive; tables and columns on demand are asked for as the
//! archived manifest shows them. Must not know: how it is shown.

mod files;

use std::io::{Read, Seek};
use std::path::Path;
use std::sync::atomic::AtomicBool;

use super::events::Observer;
use super::execute::{self, RunError};
use super::options::Options;
use super::outcome::Outcome;
use super::standing;
use crate::about::About;
use crate::diff::model::{Difference, TableDiff};
use crate::diff::table;
use crate::program::Program;
use crate::store::archive::open::Archive;
use crate::store::archive::{self, ArchiveError};
use crate::store::bundle::Opened;
use crate::store::cache::Cache;
use crate::store::error::StoreError;
use crate::store::manifest::{Manifest, TableRecord, Unread};
use crate::store::parquet;
use crate::store::results::{Draw, MANIFEST};
use crate::study::{self, LoadError};
use crate::table::data::Table;

/// Why an archive could not be verified; a difference is not an error.
#[derive(Debug, thiserror::Error)]
pub enum VerifyError {
    #[error(transparent)]
    Archive(#[from] ArchiveError),
    /// The study in it is none for this program.
    #[error("{0}")]
    Study(Box<LoadError>),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error("stopped")]
    Stopped,
    /// With the names of stages.
    #[error("{} failed", .0.join(", "))]
    Failed(Vec<String>),
}

/// What came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Verification {
    pub study: String,
    pub title: String,
    /// Of the archived manifest.
    pub version: String,
    /// What is not the same about the program, a sentence each.
    pub notes: Vec<String>,
    pub tables: Vec<Verified>,
    /// All files of the results that are not tables.
    pub files: Vec<VerifiedFile>,
}

/// A file that is made from tables.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VerifiedFile {
    pub file: String,
    pub agreement: Agreement,
}

/// What came of making a file again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Agreement {
    Identical,
    /// Other bytes, and nothing wrong with them: why.
    Otherwise(String),
    /// Not what the tables say: why.
    Different(String),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Verified {
    /// `stage.table`.
    pub name: String,
    pub rows: usize,
    /// What was archived against what was computed; [`Difference::Removed`] for a table that this program does not give.
    pub diff: TableDiff,
}

impl Verification {
    /// Identical, within tolerance, different: how many tables.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        let mut counts = [0; 3];
        for table in &self.tables {
            counts[match table.diff.state {
                Difference::Same => 0,
                Difference::WithinTolerance => 1,
                Difference::Unknown | Difference::Changed | Difference::Removed | Difference::Added => 2,
            }] += 1;
        }
        counts
    }
}

/// A study and its manifest, out of an archive.
pub struct Unpacked {
    pub study: study::Study,
    pub manifest: Manifest,
}

/// Takes study and manifest out of an archive; the study's file goes into `work`.
///
/// # Errors
/// When they are not there, are none, or do not belong together.
pub fn unpack<R: Read + Seek>(
    archive: &mut Archive<R>,
    work: &Path,
    program: &'static Program,
) -> Result<Unpacked, VerifyError> {
    let name = archive.described()?;
    let bytes = archive.bytes(&name)?;
    // Under our own name, not the archive's.
    let path = work.join("study.yaml");
    std::fs::write(&path, &bytes).map_err(|error| RunError::from(StoreError::io("write", &path)(error)))?;
    let study = study::load(&path, program).map_err(|mut error| {
        error.path = name.clone().into();
        VerifyError::Study(Box::new(error))
    })?;
    let inside = archive::results(&study.name) + MANIFEST;
    let bytes = archive.bytes(&inside)?;
    let manifest = Manifest::parse(&bytes).map_err(|unread| match unread {
        Unread::Damaged(problem) => archive.damaged(&inside, &problem),
        other => archive.refused(&inside, &other.to_string()),
    })?;
    let digest = study::digest(&study.text);
    let problem = if manifest.study != study.name || manifest.study_digest != digest {
        Some(format!("it is not about the study `{name}` beside it"))
    } else if manifest.stages.iter().all(|stage| stage.tables.is_empty()) {
        Some("it lists no tables".to_owned())
    } else {
        None
    };
    match problem {
        Some(problem) => Err(archive.damaged(&inside, &problem).into()),
        None => Ok(Unpacked { study, manifest }),
    }
}

/// Runs the study of an archive in the empty folder `work` and compares; `draw` draws the report.
///
/// # Errors
/// [`VerifyError`].
pub fn verify<R: Read + Seek>(
    archive: &mut Archive<R>,
    work: &Path,
    options: &Options,
    observer: &dyn Observer,
    stop: &AtomicBool,
    draw: Draw<'_>,
    program: &'static Program,
) -> Result<Verification, VerifyError> {
    archive.intact()?;
    let Unpacked { study, manifest } = unpack(archive, work, program)?;
    let folder = archive::results(&study.name);
    let records: Vec<&TableRecord> = manifest.stages.iter().flat_map(|stage| &stage.tables).collect();
    let opened = Opened::default();
    for record in &records {
        // Before anything runs: what is not there, or not what it should be, cannot be compared.
        let entry = format!("{folder}{}", record.file);
        let bytes = archive.bytes(&entry)?;
        archived(archive, &entry, record, bytes, &opened)?;
    }
    let made = files::check(archive, &manifest, (draw, program.about.code), work)?;
    let cache = Cache::open(&work.join("cache")).map_err(RunError::from)?;
    let options = Options { wanted: standing::demand(&study, &manifest), ..options.clone() };
    let outcome = execute::execute(&study, &cache, &options, observer, stop)?;
    if outcome.stopped {
        return Err(VerifyError::Stopped);
    }
    let failed: Vec<String> = outcome.faults().map(|(stage, fault)| format!("{stage}: {fault}")).collect();
    if !failed.is_empty() {
        return Err(VerifyError::Failed(failed));
    }
    let mut tables = Vec::new();
    for record in records {
        let entry = format!("{folder}{}", record.file);
        let bytes = archive.bytes(&entry)?;
        let diff = match computed(&outcome, &cache, record)? {
            // The very bytes: nothing of the archive need be understood.
            Some((_, computed)) if computed == bytes => TableDiff { by_values: true, ..TableDiff::default() },
            Some((table, _)) => compared(&archived(archive, &entry, record, bytes, &opened)?, &table),
            None => TableDiff {
                state: Difference::Removed,
                note: "this program gives no such table".to_owned(),
                ..TableDiff::default()
            },
        };
        let diff = TableDiff { name: record.name.clone(), ..diff };
        tables.push(Verified { name: record.name.clone(), rows: record.rows, diff });
    }
    let notes = notes(&manifest, &program.about);
    Ok(Verification {
        study: study.name,
        title: study.title,
        version: manifest.program.version,
        notes,
        tables,
        files: made,
    })
}

/// Compares by the tolerances of the computed table.
fn compared(archived: &Table, computed: &Table) -> TableDiff {
    let diff = table::compare("", archived, computed, None, &|_| None);
    if diff.state != Difference::Same || archived.content_hash() == computed.content_hash() {
        return diff;
    }
    // Another hash, and no value is another one.
    if archived.schema() == computed.schema() {
        let note = "numbers of the key differ in their last digits".to_owned();
        return TableDiff { state: Difference::WithinTolerance, note, ..diff };
    }
    let note = "the values are equal, but not what the columns are".to_owned();
    TableDiff { state: Difference::Changed, note, ..diff }
}

/// A table as this program computes it, and its Parquet file.
fn computed(outcome: &Outcome, cache: &Cache, record: &TableRecord) -> Result<Option<(Table, Vec<u8>)>, RunError> {
    let (stage, name) = record.name.split_once('.').unwrap_or((&record.name, ""));
    let is_there = outcome.stage(stage).is_some_and(|stage| stage.tables.iter().any(|(schema, _)| schema.name == name));
    if !is_there {
        return Ok(None);
    }
    Ok(Some((outcome.table(cache, stage, name)?, outcome.bytes(cache, stage, name)?)))
}

/// A table of the archive, which must hold what its manifest says.
fn archived<R: Read + Seek>(
    archive: &Archive<R>,
    entry: &str,
    record: &TableRecord,
    bytes: Vec<u8>,
    opened: &Opened,
) -> Result<Table, ArchiveError> {
    let damaged = |problem: String| archive.damaged(entry, &problem);
    let table = opened.table(record, entry, || parquet::read(bytes).map_err(damaged), damaged)?;
    if table.content_hash().to_string() == record.content {
        Ok(table)
    } else {
        Err(archive.damaged(entry, "its values are not those that the manifest names"))
    }
}

/// What is not the same about the program that made an archive and this one.
fn notes(manifest: &Manifest, about: &About) -> Vec<String> {
    let mut notes = Vec::new();
    let program = &manifest.program;
    for (what, archived, own) in
        [("gearstudy", program.version.as_str(), about.version), ("the compiler", &program.rustc, about.rustc)]
    {
        if archived != own {
            notes.push(format!("made with another version of {what}: {archived}; this is {own}"));
        }
    }
    if program.dependencies.is_empty() {
        notes.push("it does not say which versions of libraries it was made with".to_owned());
    } else if program.dependencies != about.dependencies {
        notes.push("made with other versions of libraries (another Cargo.lock)".to_owned());
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::schema::{Column, Schema};

    fn table(key: f64, value: f64, unit: &str, description: &str) -> Table {
        let columns = vec![Column::float("at", "mm", "").key(), Column::float("x", unit, description)];
        Table::from_rows(Schema::new("t", "", columns), vec![vec![key.into(), value.into()]]).unwrap()
    }

    #[test]
    fn another_hash_of_the_same_values_is_told_for_what_it_is() {
        let archived = table(0.1, 0.0, "um", "");
        let against = |computed: Table| (compared(&archived, &computed).state, compared(&archived, &computed).note);
        assert_eq!(against(table(0.1, 0.0, "um", "")), (Difference::Same, String::new()));
        assert_eq!(against(table(0.1, -0.0, "um", "")).0, Difference::Same, "a sign of zero is not content");
        assert_eq!(against(table(0.1_f64.next_up(), 0.0, "um", "")).0, Difference::WithinTolerance);
        assert_eq!(against(table(0.1, 1.0, "um", "")).0, Difference::Changed);
        assert_eq!(against(table(0.1, 0.0, "mm", "")).0, Difference::Changed);
        let (state, note) = against(table(0.1, 0.0, "um", "other words"));
        assert!(state == Difference::Same || note.contains("what the columns are"), "{note}");
    }
}
