//! One set of results: those of a commit, or those in a folder.
//!
//! Must not know: what is done with them.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::git::{Commit, Files, Repository};
use crate::presence;
use crate::store::bundle::Opened;
use crate::store::cache::{Cache, Lookup};
use crate::store::error::StoreError;
use crate::store::file;
use crate::store::index::{self, Index};
use crate::store::manifest::{FileRecord, KeyRecord, Manifest, StageRecord, TableRecord};
use crate::store::parquet;
use crate::store::results::{FileState, Folder, Known, MANIFEST, held_text, here};
use crate::table::data::Table;
use crate::threads;

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
    opened: Opened,
}

/// A table of one side.
pub enum Got {
    Table(Box<Table>),
    /// Not there, or not to be trusted: a phrase that follows `ste.curve`.
    Without(String),
}

/// The file of a table where the results lie.
enum Held {
    Table(Box<Table>),
    Absent,
    /// There, but git has its contents elsewhere: a phrase.
    Elsewhere(String),
    /// Whole, and of another run than the manifest.
    OtherRun,
    /// Not what the manifest says: a phrase that follows the file's name.
    Damaged(String),
}

/// Files of a manifest that are there and not its own.
#[derive(Default)]
pub struct Odd {
    /// Each, and a phrase that follows its name.
    pub damaged: Vec<(String, String)>,
    /// Whole ones that another run wrote.
    pub other_run: Vec<String>,
}

impl Side {
    /// The results in a folder: `<study>/manifest.json` in it, or `manifest.json` itself.
    ///
    /// # Errors
    /// When the system cannot say which of the two it is.
    pub fn folder(path: &Path, label: impl Into<String>) -> Result<Self, String> {
        let single = presence::is_file(&path.join(MANIFEST)).map_err(presence::unread(path))?;
        Ok(Self { label: label.into(), source: Source::Folder(path.to_owned()), single, opened: Opened::default() })
    }

    /// The results that a commit holds in `folder`.
    ///
    /// # Errors
    /// When git cannot list them.
    pub fn commit(repository: &Repository, commit: &Commit, folder: &Path) -> Result<Self, String> {
        let files = repository.files(commit, folder)?;
        let single = files.paths().any(|path| path == Path::new(MANIFEST));
        Ok(Self { label: commit.label(), source: Source::Commit(files), single, opened: Opened::default() })
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

    fn read(&self, path: &Path, maximum: u64) -> Result<Option<Vec<u8>>, String> {
        match &self.source {
            Source::Commit(files) => files.read(path).map_err(|problem| format!("cannot be read: {problem}")),
            Source::Folder(folder) => match file::read(&folder.join(path), maximum) {
                Ok(bytes) => Ok(Some(bytes)),
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
                Err(error) => Err(format!("cannot be read: {error}")),
            },
        }
    }

    /// The folders with a manifest, sorted, and those that cannot be read, of which [`Side::manifest`] says so; one with an
    /// empty name for the results of a single study.
    ///
    /// # Errors
    /// When the folder of all of them cannot be read.
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
                let entries = presence::entries(folder).map_err(presence::unread(folder))?;
                let paths = entries.into_iter().map(|(path, _)| path);
                // Reading it reports whatever is in the place of the manifest.
                let with_manifest = paths.filter(|path| presence::exists(&path.join(MANIFEST)).unwrap_or(true));
                with_manifest.filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned())).collect()
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
        let read = self.read(&path, file::MOST_MANIFEST).map_err(|problem| wrong(&problem))?;
        let Some(bytes) = read else { return Ok(None) };
        Manifest::parse(&bytes).map(Some).map_err(|unread| wrong(&unread.to_string()))
    }

    /// A table of a study, checked against its manifest, and what is wrong with its file. Where the file is not kept or
    /// damaged, the cache may still have the table.
    pub fn table(
        &self,
        study: &str,
        stage: &StageRecord,
        record: &TableRecord,
        cache: Option<&Cache>,
    ) -> (Got, Option<String>) {
        let (why, damage) = match self.held(study, record) {
            Held::Table(table) => return (Got::Table(table), None),
            Held::Absent => match &self.source {
                Source::Commit(_) => (format!("is not kept at {}", self.label), None),
                Source::Folder(_) => (format!("is not there in {}", self.label), None),
            },
            Held::Elsewhere(why) => (format!("at {} {why}", self.label), None),
            Held::OtherRun => (format!("is of another run in {}", self.label), None),
            Held::Damaged(problem) => (format!("at {} {problem}", self.label), Some(problem)),
        };
        (cached(cache, stage, record).map_or(Got::Without(why), |table| Got::Table(Box::new(table))), damage)
    }

    fn held(&self, study: &str, record: &TableRecord) -> Held {
        // A manifest from elsewhere may name anything.
        if Path::new(&record.file).file_name().is_none_or(|name| *name != *record.file) {
            return Held::Damaged("lies elsewhere".to_owned());
        }
        let bytes = match self.read(&Path::new(study).join(&record.file), file::MOST_TABLE) {
            // Git has all that a commit holds, here or elsewhere.
            Err(problem) if matches!(self.source, Source::Commit(_)) => return Held::Elsewhere(problem),
            Err(problem) => return Held::Damaged(problem),
            Ok(None) => return Held::Absent,
            Ok(Some(bytes)) => bytes,
        };
        if file::is_pointer(&bytes) {
            return Held::Elsewhere(file::POINTER.to_owned());
        }
        let place = format!("{study}/{}", record.file);
        let read = || parquet::read(bytes);
        match self.opened.table(record, &place, read, |problem| problem) {
            Ok(table) if table.content_hash().to_string() == record.content => Held::Table(Box::new(table)),
            _ if self.is_of_other_run(study, &record.file) => Held::OtherRun,
            Err(problem) => Held::Damaged(format!("is damaged: {problem}")),
            Ok(_) => Held::Damaged("holds other values than its manifest says".to_owned()),
        }
    }

    /// Whether a file that is not what the manifest says is whole, as the index notes it.
    fn is_of_other_run(&self, study: &str, file: &str) -> bool {
        let Source::Folder(folder) = &self.source else { return false };
        let noted = Index::read(&folder.join(study)).and_then(|(index, _)| index.find(file).cloned());
        let Some(noted) = noted else { return false };
        let read = self.read(&Path::new(study).join(file), file::MOST_TABLE);
        read.is_ok_and(|bytes| bytes.is_some_and(|bytes| index::digest(&bytes) == noted.digest))
    }

    /// The files of a table that are not the lines it holds.
    fn changed_files(&self, study: &str, record: &TableRecord, table: &Table) -> Vec<(String, String)> {
        let changed = |file: &String| match self.read(&Path::new(study).join(file), file::MOST_TABLE) {
            Ok(Some(bytes)) if !file::is_pointer(&bytes) => {
                let text = held_text(table, file).filter(|text| text.as_bytes() != bytes)?;
                let is_alike = index::differ_in_line_ends(&bytes, &index::digest(text.as_bytes()));
                let other = || format!("is not what the table `{}` holds", record.name);
                Some((file.clone(), if is_alike { index::LINE_ENDS.to_owned() } else { other() }))
            }
            _ => None,
        };
        // A manifest from elsewhere may name anything.
        let here = |file: &&String| Path::new(file).file_name().is_some_and(|name| name == file.as_str());
        record.files.iter().filter(here).filter_map(changed).collect()
    }

    /// Whether this file is there, whatever is in it. One that cannot be read is: [`Side::damage`] reports it.
    #[must_use]
    pub fn has(&self, study: &str, file: &str) -> bool {
        let path = Path::new(study).join(file);
        match &self.source {
            Source::Commit(files) => files.has(&path),
            Source::Folder(folder) => presence::link_metadata(&folder.join(path)).map_or(true, |found| found.is_some()),
        }
    }

    /// What is wrong with the files that a manifest lists, but for tables that are `read` anyway. What is not there is for
    /// the caller to judge: git seldom keeps all.
    #[must_use]
    pub fn damage(&self, study: &str, manifest: &Manifest, read: &(dyn Fn(&TableRecord) -> bool + Sync)) -> Odd {
        let tables: Vec<&TableRecord> = manifest.stages.iter().flat_map(|stage| &stage.tables).collect();
        let of_table = |record: &&TableRecord| match self.held(study, record) {
            Held::Damaged(problem) => vec![(record.file.clone(), problem)],
            Held::Table(table) => self.changed_files(study, record, &table),
            _ => Vec::new(),
        };
        let looked_at = |record: &&&TableRecord| !read(record) || !record.files.is_empty();
        let mut found: Vec<(String, String)> =
            threads::with_all(|| tables.par_iter().filter(looked_at).flat_map_iter(of_table).collect());
        let known = match &self.source {
            Source::Folder(folder) => Folder::new(folder, study).known().ok().flatten(),
            Source::Commit(_) => None,
        };
        let others: Vec<(String, String)> = threads::with_all(|| {
            let others = manifest.files.par_iter().filter(|listed| here(&listed.file));
            others
                .filter_map(|listed| Some((listed.file.clone(), self.changed(study, listed, known.as_ref())?)))
                .collect()
        });
        // What is wrong with a table's values says more than that its bytes are other ones.
        let told: Vec<String> = found.iter().map(|(file, _)| file.clone()).collect();
        let others = others.into_iter().filter(|(file, _)| !told.contains(file));
        let is_of_other_run = |file: &str| known.as_ref().is_some_and(|known| known.state(file) == FileState::OtherRun);
        let (other_run, others): (Vec<_>, Vec<_>) = others.partition(|(file, _)| is_of_other_run(file));
        found.extend(others);
        Odd { damaged: found, other_run: other_run.into_iter().map(|(file, _)| file).collect() }
    }

    /// Why a listed file that is there is not the one that was written.
    fn changed(&self, study: &str, listed: &FileRecord, known: Option<&Known>) -> Option<String> {
        let bytes = match self.read(&Path::new(study).join(&listed.file), file::MOST_TABLE) {
            Err(_) if matches!(self.source, Source::Commit(_)) => return None,
            Err(problem) => return Some(problem),
            Ok(bytes) => bytes.filter(|bytes| !file::is_pointer(bytes))?,
        };
        let expected = known.and_then(|known| known.expected(&listed.file)).map(|(_, digest)| digest);
        let size = bytes.len() as u64;
        match (listed.bytes, expected.or(listed.digest.as_deref())) {
            (_, Some(digest)) if index::digest(&bytes) != digest && index::differ_in_line_ends(&bytes, digest) => {
                Some(index::LINE_ENDS.to_owned())
            }
            (Some(expected), _) if size != expected => Some(format!("has {size} bytes; its manifest says {expected}")),
            (_, Some(digest)) if index::digest(&bytes) != digest => {
                Some("has other bytes than were written".to_owned())
            }
            _ => None,
        }
    }
}

/// The table of a manifest in a folder, or from the cache where its file is not there or of another run.
///
/// # Errors
/// A sentence: the file is damaged, or nobody has the table.
pub fn published(
    folder: &Folder,
    stage: &StageRecord,
    record: &TableRecord,
    cache: &dyn Fn() -> Result<Option<Cache>, StoreError>,
) -> Result<Table, String> {
    let problem = match folder.table(record) {
        Ok(table) => return Ok(table),
        Err(problem) => problem,
    };
    let known = folder.known().map_err(|error| error.to_string())?;
    let file = folder.path().join(&record.file);
    let why = match known.map(|known| known.table_state(record)) {
        Some(FileState::OtherRun) => "is of another run",
        Some(FileState::Absent) => "is not here",
        Some(FileState::Pointer) => file::POINTER,
        _ => return Err(problem.to_string()),
    };
    let cache = cache().map_err(|error| error.to_string())?;
    cached(cache.as_ref(), stage, record).ok_or_else(|| {
        format!("`{}` {why}, and the cache does not have it; `gearstudy run` computes it again", file.display())
    })
}

/// The table as it was computed on this machine, chunk by chunk.
#[must_use]
pub fn cached(cache: Option<&Cache>, stage: &StageRecord, record: &TableRecord) -> Option<Table> {
    let part = |key| cache?.table(key, record.table()).ok();
    let parts: Vec<Table> = stage.keys.iter().map(|record| part(record.key)).collect::<Option<_>>()?;
    let table = Table::concatenated(parts).ok()??;
    (table.content_hash().to_string() == record.content).then_some(table)
}

/// Whether the cache has the tables of all stages that share a file. Files of no stage are drawn from those.
#[must_use]
pub fn is_cached(cache: Option<&Cache>, manifest: &Manifest, file: &String) -> bool {
    let has = |table: &TableRecord| table.file == *file || table.files.contains(file);
    let mut stages = manifest.stages.iter().filter(|stage| stage.tables.iter().any(has));
    let found = |record: &KeyRecord| cache.is_some_and(|cache| matches!(cache.look_up(record.key), Lookup::Found(_)));
    stages.all(|stage| stage.keys.iter().all(found))
}
