//! The results folder of a study: `<stage>.<table>.parquet`, `<study>.h5`, the files that tables hold line by line
//! (`<stage>.<file>`), `report.html` and `figures/`, `manifest.json`, and `files.json`, which git need not keep.
//!
//! The manifest lists every file with its digest; where the bytes differ from run to run, the index does (`index.rs`).
//! `known` says which files are as listed, `publish` brings the folder up to date. Must not know: the cache (tables come
//! through a closure), stages, how anything is drawn.

mod bundled;
mod changes;
mod drawn;
mod known;
mod pieces;
mod publish;
mod remove;
#[cfg(test)]
mod tests;

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use changes::Changes;
pub use known::{FileState, Known};
#[cfg(feature = "hdf5")]
pub use publish::hdf5_bytes;
pub use publish::{Bytes, Draw, Drawn, Elsewhere, Pieces, Published, Source, Tables};

use super::bundle::{Opened, is_bundle};
use super::error::StoreError;
use super::file;
use super::lock::{self, Lock, Told};
use super::manifest::{AGAIN, FORMAT, Manifest, StudyFolder, TableRecord, Unread, check_version};
use super::parquet;
use crate::presence;
use crate::table::data::{Data, Table};

pub const MANIFEST: &str = "manifest.json";
pub const PAGE: &str = "report.html";
pub const FIGURES: &str = "figures";
/// Figures of what was measured: they differ from run to run.
pub const MEASURED: &str = "figures/measured";

/// Cells of a table that is kept once it was read.
const MOST_KEPT: usize = 1 << 14;

/// Where the results of one study lie.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
    study: String,
    told: Told,
    opened: Arc<Opened>,
}

impl Folder {
    /// The folder of `study` under `results`; nothing is made yet.
    #[must_use]
    pub fn new(results: &Path, study: &str) -> Self {
        Self { path: results.join(study), study: study.to_owned(), told: |_| {}, opened: Arc::default() }
    }

    /// The folder at a path, whatever links lead there; none where there is no such folder.
    #[must_use]
    pub fn at(path: &Path) -> Option<Self> {
        let path = path.canonicalize().ok()?;
        Some(Self::new(path.parent()?, &path.file_name()?.to_string_lossy()))
    }

    /// Who hears why a lock is waited for.
    #[must_use]
    pub fn telling(self, told: Told) -> Self {
        Self { told, ..self }
    }

    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    #[must_use]
    pub fn hdf5_file(&self) -> String {
        format!("{}.h5", self.study)
    }

    /// The manifest of the last run; none when there is none that can be read: a run writes a new one.
    #[must_use]
    pub fn manifest(&self) -> Option<Manifest> {
        self.read_manifest().ok().flatten()
    }

    /// The file of the study whose results these are, and the name that it stated, as the manifest records them; none where it
    /// does not, or is damaged.
    ///
    /// # Errors
    /// When the manifest cannot be read, or is one that a run must not replace.
    pub fn study_file(&self) -> Result<Option<(PathBuf, String)>, StoreError> {
        /// All else in the manifest is passed over.
        #[derive(serde::Deserialize)]
        struct Recorded {
            #[serde(default)]
            format: u32,
            #[serde(default)]
            study_folder: StudyFolder,
        }
        let path = self.path.join(MANIFEST);
        let bytes = match file::read(&path, file::MOST_MANIFEST) {
            Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::InvalidData) => return Ok(None),
            other => other.map_err(StoreError::io("read", &path))?,
        };
        let recorded: Option<Recorded> = serde_json::from_slice(&bytes).ok();
        if recorded.as_ref().is_none_or(|recorded| recorded.format > FORMAT) {
            check_version(&bytes).map_err(|unread| unread_manifest(&path, unread))?;
        }
        let Some(Recorded { study_folder, .. }) = recorded else { return Ok(None) };
        let Some(file) = study_folder.file else { return Ok(None) };
        let folder = std::path::absolute(&self.path).map_err(StoreError::io("find", &self.path))?;
        let name = study_folder.name.unwrap_or_else(|| self.study.clone());
        Ok(Some((presence::without_dots(&folder.join(file)), name)))
    }

    /// The manifest of the last run; none when there is none.
    ///
    /// # Errors
    /// When it is not a file, too large, damaged, or of another format.
    pub fn read_manifest(&self) -> Result<Option<Manifest>, StoreError> {
        Ok(self.read()?.map(|(manifest, _)| manifest))
    }

    /// The manifest, and what is known of the files that it lists; none when there is none.
    ///
    /// # Errors
    /// As [`Folder::read_manifest`].
    pub fn known(&self) -> Result<Option<Known>, StoreError> {
        Ok(self.read()?.map(|(manifest, bytes)| Known::new(self.clone(), manifest, &bytes)))
    }

    fn read(&self) -> Result<Option<(Manifest, Vec<u8>)>, StoreError> {
        let path = self.path.join(MANIFEST);
        let bytes = match file::read(&path, file::MOST_MANIFEST) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            other => other.map_err(StoreError::io("read", &path))?,
        };
        let manifest = Manifest::parse(&bytes).map_err(|unread| unread_manifest(&path, unread))?;
        Ok(Some((manifest, bytes)))
    }

    /// A published table.
    ///
    /// # Errors
    /// When its file is missing, damaged, or holds other values than the manifest says.
    pub fn table(&self, record: &TableRecord) -> Result<Table, StoreError> {
        let damaged = |problem: String| self.damaged(&record.file, &problem);
        let table = self.opened.table(record, &record.file, || self.whole(&record.file), damaged)?;
        if table.content_hash().to_string() == record.content {
            Ok(table)
        } else {
            Err(damaged("its values are not those that the manifest names".to_owned()))
        }
    }

    /// What is published for a record, of a bundle all of it. One that is not large is read once for all who ask, until the
    /// folder is locked anew.
    fn shared(&self, record: &TableRecord) -> Result<Arc<Table>, StoreError> {
        if is_bundle(&record.file) {
            return self.opened.whole(&record.file, || self.whole(&record.file));
        }
        if record.rows * record.columns.len() > MOST_KEPT {
            return self.table(record).map(Arc::new);
        }
        self.opened.whole(&record.file, || self.table(record))
    }

    fn damaged(&self, file: &str, problem: &str) -> StoreError {
        let path = self.path.join(file).display().to_string();
        StoreError::Damaged { path, problem: format!("{problem}; `gearstudy run` writes it anew") }
    }

    /// All that a Parquet file holds.
    ///
    /// # Errors
    /// When it is missing or damaged.
    pub fn whole(&self, file: &str) -> Result<Table, StoreError> {
        let path = self.path.join(file);
        let bytes = file::read(&path, file::MOST_TABLE).map_err(StoreError::io("read", &path))?;
        if file::is_pointer(&bytes) {
            return Err(StoreError::NotForHere { path: path.display().to_string(), problem: file::POINTER.to_owned() });
        }
        parquet::read(bytes).map_err(|problem| self.damaged(file, &problem))
    }

    /// What `look` finds, which reads the manifest and then files. While a run publishes, its files and its manifest do
    /// not belong together: where `look` finds a fault, it looks once more when no run publishes.
    ///
    /// # Errors
    /// Those of `look`.
    pub fn settled<T, E>(&self, look: impl Fn() -> Result<T, E>) -> Result<T, E> {
        look().or_else(|fault| {
            if !presence::is_folder(&self.path).unwrap_or(false) {
                return Err(fault);
            }
            // Where the folder cannot be locked, a second look is all that can be had.
            let _lock = self.lock().ok();
            look()
        })
    }

    /// One publisher at a time, on this computer or another; nothing is left behind.
    ///
    /// # Errors
    /// As [`lock::publisher`].
    pub fn lock(&self) -> Result<Lock, StoreError> {
        self.lock_while(&|_| Ok(()))
    }

    /// The same; `waits` is asked with the folder's path while somebody else has it, and what it says ends the wait.
    ///
    /// # Errors
    /// As [`lock::publisher`].
    pub fn lock_while(&self, waits: &dyn Fn(&str) -> Result<(), StoreError>) -> Result<Lock, StoreError> {
        let lock = lock::publisher(&self.path, self.told, waits)?;
        // Somebody else may have published until now.
        self.opened.clear();
        Ok(lock)
    }
}

fn unread_manifest(path: &Path, unread: Unread) -> StoreError {
    let path = path.display().to_string();
    match unread {
        Unread::Damaged(problem) => StoreError::Damaged { path, problem: format!("{problem}; {AGAIN}") },
        Unread::Newer(_) => {
            let remedy = "or delete the file, and `gearstudy run STUDY` writes all results anew";
            StoreError::NotForHere { path, problem: format!("{unread}, {remedy}") }
        }
        Unread::Pointer => StoreError::NotForHere { path, problem: unread.to_string() },
    }
}

/// A manifest from elsewhere may name anything; only files right here, and figures, are ours.
#[must_use]
pub fn here(file: &str) -> bool {
    let inside = |folder: &str| file.strip_prefix(folder)?.strip_prefix('/');
    let name = inside(MEASURED).or_else(|| inside(FIGURES)).unwrap_or(file);
    Path::new(name).file_name().is_some_and(|own| own == name)
}

/// Whether a listed file is the page or a figure of it.
#[must_use]
pub fn is_drawn(file: &str) -> bool {
    file == PAGE || file.strip_prefix(FIGURES).is_some_and(|rest| rest.starts_with('/'))
}

/// The text of a file `stage.name` that a table holds line by line; none when it holds no files.
#[must_use]
pub fn held_text(table: &Table, file: &str) -> Option<String> {
    let (Some(Data::Text(names)), Some(Data::Text(lines))) = (table.column("file"), table.column("text")) else {
        return None;
    };
    let (_, own) = split(file);
    let mut text = String::new();
    for (_, line) in names.iter().zip(lines).filter(|(name, _)| *name == own) {
        text += line;
        text.push('\n');
    }
    Some(text)
}

/// `stage.table`; stages have no dot in their name.
fn split(name: &str) -> (&str, &str) {
    name.split_once('.').unwrap_or((name, ""))
}
