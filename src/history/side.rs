//! One set of results: those of a commit, or those in a folder.
//!
//! Must not know: what is done with them.

use std::fs;
use std::path::{Path, PathBuf};

use super::git::{Commit, Files, Repository};
use crate::base::digest::Digest;
use crate::store::cache::Cache;
use crate::store::manifest::{FORMAT, Manifest, StageRecord, TableRecord};
use crate::store::parquet;
use crate::store::results::MANIFEST;
use crate::table::data::Table;

/// Where the files come from.
enum Source {
    Folder(PathBuf),
    Commit(Files),
}

/// One set of results.
pub struct Side {
    /// In words, for headings: `HEAD (59b124e)`.
    pub label: String,
    source: Source,
    /// Set when the folder is that of one study, not that of all.
    single: bool,
}

/// A table of one side.
pub enum Got {
    Table(Box<Table>),
    /// Not there, or not to be trusted: a phrase that follows `ste.curve`.
    Without(String),
}

impl Side {
    /// The results in a folder: `<study>/manifest.json` in it, or `manifest.json` itself.
    #[must_use]
    pub fn folder(path: &Path, label: impl Into<String>) -> Self {
        let single = path.join(MANIFEST).is_file();
        Self { label: label.into(), source: Source::Folder(path.to_owned()), single }
    }

    /// The results that a commit holds in `folder`.
    ///
    /// # Errors
    /// When git cannot list them.
    pub fn commit(repository: &Repository, commit: &Commit, folder: &Path) -> Result<Self, String> {
        let files = repository.files(commit, folder)?;
        let single = files.paths().any(|path| path == Path::new(MANIFEST));
        Ok(Self { label: commit.label(), source: Source::Commit(files), single })
    }

    /// Whether it holds the results of one study alone, whatever it is called.
    #[must_use]
    pub fn is_single(&self) -> bool {
        self.single
    }

    /// The folder, when it is one.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        match &self.source {
            Source::Folder(path) => Some(path),
            Source::Commit(_) => None,
        }
    }

    fn read(&self, path: &Path) -> Result<Option<Vec<u8>>, String> {
        match &self.source {
            Source::Commit(files) => files.read(path),
            Source::Folder(folder) => match fs::read(folder.join(path)) {
                Ok(bytes) => Ok(Some(bytes)),
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
                Err(error) => Err(format!("cannot read `{}`: {error}", folder.join(path).display())),
            },
        }
    }

    /// The folders with a manifest, sorted; one with an empty name for the results of a single study.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn studies(&self) -> Result<Vec<String>, String> {
        if self.single {
            return Ok(vec![String::new()]);
        }
        let mut names = match &self.source {
            Source::Commit(files) => {
                let manifests = files.paths().filter(|path| path.components().count() == 2 && path.ends_with(MANIFEST));
                manifests.filter_map(|path| Some(path.parent()?.to_string_lossy().into_owned())).collect::<Vec<_>>()
            }
            Source::Folder(folder) => {
                let entries = match fs::read_dir(folder) {
                    Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
                    other => other.map_err(|error| format!("cannot read `{}`: {error}", folder.display()))?,
                };
                let with_manifest = entries.flatten().filter(|entry| entry.path().join(MANIFEST).is_file());
                with_manifest.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
            }
        };
        names.sort();
        Ok(names)
    }

    /// The manifest in one of [`Side::studies`].
    ///
    /// # Errors
    /// A sentence, when it is damaged, of another format, or a pointer of Git LFS.
    pub fn manifest(&self, study: &str) -> Result<Option<Manifest>, String> {
        let path = Path::new(study).join(MANIFEST);
        let wrong = |problem: &str| format!("`{}` of {} {problem}", path.display(), self.label);
        let Some(bytes) = self.read(&path)? else { return Ok(None) };
        if let Some(pointer) = pointer(&bytes) {
            return Err(wrong(pointer));
        }
        let manifest: Manifest =
            serde_json::from_slice(&bytes).map_err(|error| wrong(&format!("is damaged: {error}")))?;
        if manifest.format == FORMAT {
            Ok(Some(manifest))
        } else {
            Err(wrong(&format!("has format {}; this version reads format {FORMAT}", manifest.format)))
        }
    }

    /// A table of a study, checked against its manifest. Where its file is not kept, the cache may still have it.
    pub fn table(&self, study: &str, stage: &StageRecord, record: &TableRecord, cache: Option<&Cache>) -> Got {
        let why = match self.read(&Path::new(study).join(&record.file)) {
            Err(problem) => problem,
            Ok(None) => match &self.source {
                Source::Commit(_) => format!("is not kept at {}", self.label),
                Source::Folder(_) => format!("is not there in {}", self.label),
            },
            Ok(Some(bytes)) => match (pointer(&bytes), parquet::read(bytes)) {
                (Some(pointer), _) => format!("at {} {pointer}", self.label),
                (None, Err(problem)) => format!("at {} is damaged: {problem}", self.label),
                (None, Ok(table)) if table.content_hash().to_string() == record.content => {
                    return Got::Table(Box::new(table));
                }
                (None, Ok(_)) => format!("at {} holds other values than its manifest says", self.label),
            },
        };
        cached(cache, stage, record).map_or(Got::Without(why), |table| Got::Table(Box::new(table)))
    }
}

/// What a file of Git LFS looks like before its contents were fetched.
fn pointer(bytes: &[u8]) -> Option<&'static str> {
    bytes
        .starts_with(b"version https://git-lfs.github.com/spec/")
        .then_some("is a pointer of Git LFS: `git lfs pull` fetches it")
}

/// The table as it was computed on this machine, chunk by chunk.
fn cached(cache: Option<&Cache>, stage: &StageRecord, record: &TableRecord) -> Option<Table> {
    let part = |key: &str| cache?.table(Digest::from_hex(key)?, record.table()).ok();
    let parts: Vec<Table> = stage.keys.iter().map(|record| part(&record.key)).collect::<Option<_>>()?;
    let table = Table::concatenated(&parts.iter().collect::<Vec<_>>()).ok()??;
    (table.content_hash().to_string() == record.content).then_some(table)
}
