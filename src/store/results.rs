//! The results folder of a study: `<stage>.<table>.parquet`, `<study>.h5`, `manifest.json`, and the files that tables hold
//! line by line, `<stage>.<file>`.
//!
//! Only what changed is written, so version control sees no noise and a run with nothing to do reads the manifest and
//! the sizes of the files, nothing else. A stage that did not finish, or was not asked for, keeps the tables of its
//! last success; its status says so. Files that a manifest never listed are never touched. Must not know: the cache
//! (tables come through a closure), stages.

#[cfg(test)]
mod tests;

use std::fs;
use std::path::{Path, PathBuf};

use super::error::StoreError;
use super::facts::Facts;
use super::file::{self, Durability};
#[cfg(feature = "hdf5")]
use super::hdf5;
use super::lock::{self, Lock, Told};
use super::manifest::{FORMAT, FileRecord, Machine, Manifest, Program, StageRecord, StudyFolder, TableRecord};
use super::parquet;
use crate::table::data::{Data, Table};

pub const MANIFEST: &str = "manifest.json";

/// Where the results of one study lie.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
    study: String,
    told: Told,
}

/// Gives the Parquet file of (stage, table).
pub type Bytes<'a> = &'a dyn Fn(&str, &str) -> Result<Vec<u8>, StoreError>;

/// What publishing would write and remove.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Whether the manifest says something new; always so when anything else changes.
    pub manifest: bool,
    /// Parquet files to write.
    pub tables: Vec<String>,
    /// Files to write whose lines tables hold.
    pub files: Vec<String>,
    pub hdf5: bool,
    /// Files of tables that are no more.
    pub remove: Vec<String>,
}

/// What publishing did.
#[derive(Clone, Debug, PartialEq)]
pub struct Published {
    /// As it stands in the folder.
    pub manifest: Manifest,
    pub changes: Changes,
}

impl Folder {
    /// The folder of `study` under `results`; nothing is made yet.
    #[must_use]
    pub fn new(results: &Path, study: &str) -> Self {
        Self { path: results.join(study), study: study.to_owned(), told: |_| {} }
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

    /// The manifest of the last run; none when there is none.
    ///
    /// # Errors
    /// When it is no file, too large, damaged, or of another format.
    pub fn read_manifest(&self) -> Result<Option<Manifest>, StoreError> {
        let path = self.path.join(MANIFEST);
        let bytes = match file::read(&path, file::MOST_MANIFEST) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            other => other.map_err(StoreError::io("read", &path))?,
        };
        let damaged = |problem: String| StoreError::Damaged { path: path.display().to_string(), problem };
        let manifest: Manifest = serde_json::from_slice(&bytes).map_err(|error| damaged(error.to_string()))?;
        if manifest.format == FORMAT {
            return Ok(Some(manifest));
        }
        Err(damaged(format!("it has format {}; this program reads format {FORMAT}", manifest.format)))
    }

    /// A published table.
    ///
    /// # Errors
    /// When its file is missing, damaged, or holds other values than the manifest says.
    pub fn table(&self, record: &TableRecord) -> Result<Table, StoreError> {
        let path = self.path.join(&record.file);
        let bytes = file::read(&path, file::MOST_TABLE).map_err(StoreError::io("read", &path))?;
        // Runs look at sizes only, so a file of the right size with wrong bytes has to be pointed out.
        let damaged = |problem: String| StoreError::Damaged {
            path: path.display().to_string(),
            problem: format!("{problem}; delete it, and the next run writes it anew"),
        };
        let table = parquet::read(bytes).map_err(damaged)?;
        if table.content_hash().to_string() == record.content {
            Ok(table)
        } else {
            Err(damaged("its values are not those that the manifest names".to_owned()))
        }
    }

    /// What [`Folder::publish`] would do. Reads the manifest and the sizes of files.
    #[must_use]
    pub fn changes(&self, manifest: &Manifest) -> Changes {
        let old = self.manifest();
        self.compare(old.as_ref(), &self.with_earlier_tables(old.as_ref(), manifest.clone()))
    }

    /// Brings the folder up to date. `manifest` comes without facts and files; `facts` is asked only when something is
    /// written.
    ///
    /// # Errors
    /// When a table cannot be had or a file not be written; what was there before stays valid.
    pub fn publish(
        &self,
        manifest: Manifest,
        facts: impl FnOnce() -> Facts,
        bytes: Bytes<'_>,
    ) -> Result<Published, StoreError> {
        if let Some(old) = self.manifest()
            && self.compare(Some(&old), &self.with_earlier_tables(Some(&old), manifest.clone())) == Changes::default()
        {
            return Ok(Published { manifest: old, changes: Changes::default() });
        }
        fs::create_dir_all(&self.path).map_err(StoreError::io("make the results folder", &self.path))?;
        let _lock = self.lock()?;
        file::sweep(&self.path);
        // Another run may have published while this one waited.
        let old = self.manifest();
        let mut new = self.with_earlier_tables(old.as_ref(), manifest);
        let changes = self.compare(old.as_ref(), &new);
        if let Some(mut old) = old.clone() {
            // Whatever is about to be replaced is struck from the list first: if this run is killed, the next one
            // must not take a new file for the old one of the same size.
            old.files.retain(|record| ![&changes.tables, &changes.files].iter().any(|new| new.contains(&record.file)));
            self.write_manifest(&old)?;
        }
        for table in new.stages.iter().flat_map(|stage| &stage.tables) {
            let path = self.path.join(&table.file);
            if changes.tables.contains(&table.file) {
                let (stage, name) = split(&table.name);
                file::write(&path, &bytes(stage, name)?, Durability::Lazy)?;
            }
            new.files.push(self.record(&table.file)?);
            let wanted: Vec<&String> = table.files.iter().filter(|file| changes.files.contains(file)).collect();
            if !wanted.is_empty() {
                self.write_files(table, &wanted)?;
            }
            new.files.extend(table.files.iter().map(|file| self.record(file)).collect::<Result<Vec<_>, _>>()?);
        }
        self.write_hdf5(&mut new, changes.hdf5)?;
        new = match old {
            // Files that were missing are there again, and nothing else is new: the record of who computed it stands.
            Some(old) if essence(&old) == essence(&new) => Manifest { files: new.files, ..old },
            _ => {
                let Facts { program, study_folder, machine, written } = facts();
                Manifest { program, study_folder, machine, written, ..new }
            }
        };
        self.remove(&changes.remove)?;
        self.write_manifest(&new)?;
        Ok(Published { manifest: new, changes })
    }

    /// One publisher at a time, on this computer or another; nothing is left behind.
    ///
    /// # Errors
    /// As [`lock::publisher`].
    pub fn lock(&self) -> Result<Lock, StoreError> {
        lock::publisher(&self.path, self.told)
    }

    /// Stages without tables of their own take those of the earlier manifest that are still there.
    fn with_earlier_tables(&self, old: Option<&Manifest>, mut new: Manifest) -> Manifest {
        let Some(old) = old else { return new };
        for stage in new.stages.iter_mut().filter(|stage| !complete(stage)) {
            let earlier = old.stages.iter().find(|earlier| earlier.name == stage.name && earlier.kind == stage.kind);
            if let Some(earlier) =
                earlier.filter(|earlier| earlier.tables.iter().all(|table| self.intact(old, &table.file)))
            {
                let StageRecord { status, why, .. } = std::mem::replace(stage, earlier.clone());
                *stage = StageRecord { status, why, ..stage.clone() };
            }
        }
        new
    }

    fn compare(&self, old: Option<&Manifest>, new: &Manifest) -> Changes {
        let new_tables: Vec<&TableRecord> = new.stages.iter().flat_map(|stage| &stage.tables).collect();
        let old_tables: Vec<&TableRecord> =
            old.iter().flat_map(|old| &old.stages).flat_map(|stage| &stage.tables).collect();
        let intact = |file: &str| old.is_some_and(|old| self.intact(old, file));
        let tables: Vec<String> = new_tables
            .iter()
            .filter(|table| !(old_tables.contains(table) && intact(&table.file)))
            .map(|table| table.file.clone())
            .collect();
        let held = |table: &&&TableRecord| {
            let known = old_tables.contains(table);
            table.files.iter().filter(|file| !(known && intact(file))).cloned().collect::<Vec<_>>()
        };
        let files: Vec<String> = new_tables.iter().flat_map(|table| held(&table)).collect();
        let with_hdf5 = cfg!(feature = "hdf5");
        let hdf5 = with_hdf5 && (new_tables != old_tables || !tables.is_empty() || !intact(&self.hdf5_file()));
        let listed = |file: &str| {
            let of_table = |table: &&TableRecord| table.file == file || table.files.iter().any(|held| held == file);
            new_tables.iter().any(of_table) || (with_hdf5 && file == self.hdf5_file())
        };
        let old_files = old.iter().flat_map(|old| &old.files).map(|record| record.file.clone());
        let remove: Vec<String> = old_files.filter(|file| !listed(file) && here(file)).collect();
        let says_something_new = old.is_none_or(|old| essence(old) != essence(new));
        let manifest = says_something_new || hdf5 || !tables.is_empty() || !files.is_empty() || !remove.is_empty();
        Changes { manifest, tables, files, hdf5, remove }
    }

    /// Whether a file is there in the size that the manifest lists.
    #[must_use]
    pub fn intact(&self, manifest: &Manifest, file: &str) -> bool {
        let metadata = fs::metadata(self.path.join(file)).ok().filter(fs::Metadata::is_file);
        let size = metadata.map(|metadata| metadata.len());
        manifest.files.iter().any(|record| record.file == file && Some(record.bytes) == size)
    }

    fn record(&self, file: &str) -> Result<FileRecord, StoreError> {
        let path = self.path.join(file);
        let metadata = fs::metadata(&path).map_err(StoreError::io("read", &path))?;
        Ok(FileRecord { file: file.to_owned(), bytes: metadata.len() })
    }

    /// Writes files whose lines a table holds; its own file is there.
    fn write_files(&self, record: &TableRecord, wanted: &[&String]) -> Result<(), StoreError> {
        let table = self.table(record)?;
        for file in wanted.iter().filter(|file| here(file)) {
            let text = held_text(&table, file).ok_or_else(|| {
                let problem = "it holds no files".to_owned();
                StoreError::Format { table: record.name.clone(), problem }
            })?;
            file::write(&self.path.join(file), text.as_bytes(), Durability::Lazy)?;
        }
        Ok(())
    }

    #[cfg(feature = "hdf5")]
    fn write_hdf5(&self, manifest: &mut Manifest, changed: bool) -> Result<(), StoreError> {
        let path = self.path.join(self.hdf5_file());
        if changed {
            let mut writer = hdf5::Writer::create(&path)?;
            // A table of files lies there as these files already.
            let tables = manifest.stages.iter().flat_map(|stage| &stage.tables);
            for record in tables.filter(|record| record.files.is_empty()) {
                writer.add(split(&record.name).0, &self.table(record)?)?;
            }
            writer.finish(&path)?;
        }
        manifest.files.push(self.record(&self.hdf5_file())?);
        Ok(())
    }

    #[cfg(not(feature = "hdf5"))]
    #[allow(clippy::unused_self, clippy::unnecessary_wraps)] // the same shape with and without the feature
    fn write_hdf5(&self, _manifest: &mut Manifest, _changed: bool) -> Result<(), StoreError> {
        Ok(())
    }

    /// Removes files before the manifest is written that does not list them: should this run not get so far, the next one
    /// finds them in the list that is there. A file that is in no list stays for ever, so the folder must know that they
    /// are gone before it knows the new manifest: the one place where a folder has to be written through.
    fn remove(&self, files: &[String]) -> Result<(), StoreError> {
        for name in files {
            let path = self.path.join(name);
            match fs::remove_file(&path) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                    return Err(StoreError::io("remove", &path)(error));
                }
                _ => {}
            }
        }
        if cfg!(unix) && !files.is_empty() {
            let folder = fs::File::open(&self.path).and_then(|folder| folder.sync_all());
            folder.map_err(StoreError::io("write", &self.path))?;
        }
        Ok(())
    }

    fn write_manifest(&self, manifest: &Manifest) -> Result<(), StoreError> {
        let path = self.path.join(MANIFEST);
        let mut bytes = serde_json::to_vec_pretty(manifest)
            .map_err(|error| StoreError::Format { table: MANIFEST.to_owned(), problem: error.to_string() })?;
        bytes.push(b'\n');
        file::write(&path, &bytes, Durability::Lazy)
    }
}

/// A manifest from elsewhere may name anything; only files right here are ours.
fn here(file: &str) -> bool {
    Path::new(file).file_name().is_some_and(|name| name == file)
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

fn complete(stage: &StageRecord) -> bool {
    matches!(stage.status.as_str(), "hit" | "ran")
}

/// `stage.table`; stages have no dot in their name.
fn split(name: &str) -> (&str, &str) {
    name.split_once('.').unwrap_or((name, ""))
}

/// A manifest without what may differ although the results are the same.
fn essence(manifest: &Manifest) -> Manifest {
    let mut essence = manifest.clone();
    (essence.program, essence.machine) = (Program::default(), Machine::default());
    essence.study_folder = StudyFolder::default();
    (essence.written, essence.seconds) = (String::new(), 0.0);
    essence.files.clear();
    for stage in &mut essence.stages {
        stage.seconds = 0.0;
        stage.left_out.iter_mut().for_each(|left_out| left_out.saved_seconds = None);
        if complete(stage) {
            stage.status.clear();
            stage.why.clear();
        }
    }
    essence
}
