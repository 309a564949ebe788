//! The results folder of a study: `<stage>.<table>.parquet`, `<study>.h5`, `manifest.json`.
//!
//! Only what changed is written, so version control sees no noise and a run with nothing to do reads the manifest and
//! the sizes of the files, nothing else. A stage that did not finish, or was not asked for, keeps the tables of its
//! last success; its status says so. Files that a manifest never listed are never touched. Must not know: the cache
//! (tables come through a closure), stages.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use super::error::StoreError;
use super::facts::Facts;
use super::file::{self, Durability};
#[cfg(feature = "hdf5")]
use super::hdf5;
use super::manifest::{FORMAT, FileRecord, Machine, Manifest, Program, StageRecord, TableRecord};
use super::parquet;
use crate::table::data::Table;

pub const MANIFEST: &str = "manifest.json";

/// Where the results of one study lie.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
    study: String,
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
        Self { path: results.join(study), study: study.to_owned() }
    }

    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    #[must_use]
    pub fn hdf5_file(&self) -> String {
        format!("{}.h5", self.study)
    }

    /// The manifest of the last run; none when there is none that can be read.
    #[must_use]
    pub fn manifest(&self) -> Option<Manifest> {
        let manifest: Manifest = serde_json::from_slice(&fs::read(self.path.join(MANIFEST)).ok()?).ok()?;
        (manifest.format == FORMAT).then_some(manifest)
    }

    /// A published table.
    ///
    /// # Errors
    /// When its file is missing, damaged, or holds other values than the manifest says.
    pub fn table(&self, record: &TableRecord) -> Result<Table, StoreError> {
        let path = self.path.join(&record.file);
        let bytes = fs::read(&path).map_err(StoreError::io("read", &path))?;
        let damaged = |problem: String| StoreError::Damaged { path: path.display().to_string(), problem };
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
        // Another run may have published while this one waited.
        let old = self.manifest();
        let mut new = self.with_earlier_tables(old.as_ref(), manifest);
        let changes = self.compare(old.as_ref(), &new);
        if let Some(mut old) = old.clone() {
            // Whatever is about to be replaced is struck from the list first: if this run is killed, the next one
            // must not take a new file for the old one of the same size.
            old.files.retain(|record| !changes.tables.contains(&record.file));
            self.write_manifest(&old)?;
        }
        for table in new.stages.iter().flat_map(|stage| &stage.tables) {
            let path = self.path.join(&table.file);
            if changes.tables.contains(&table.file) {
                let (stage, name) = split(&table.name);
                file::write(&path, &bytes(stage, name)?, Durability::Lazy)?;
            }
            new.files.push(self.record(&table.file)?);
        }
        self.write_hdf5(&mut new, changes.hdf5)?;
        new = match old {
            // Files that were missing are there again, and nothing else is new: the record of who computed it stands.
            Some(old) if essence(&old) == essence(&new) => Manifest { files: new.files, ..old },
            _ => {
                let Facts { program, machine, written } = facts();
                Manifest { program, machine, written, ..new }
            }
        };
        self.write_manifest(&new)?;
        for name in &changes.remove {
            let path = self.path.join(name);
            match fs::remove_file(&path) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                    return Err(StoreError::io("remove", &path)(error));
                }
                _ => {}
            }
        }
        Ok(Published { manifest: new, changes })
    }

    /// One publisher at a time; a folder can be locked itself, so nothing is left behind.
    fn lock(&self) -> Result<Option<File>, StoreError> {
        if !cfg!(unix) {
            return Ok(None);
        }
        let folder = File::open(&self.path).map_err(StoreError::io("open", &self.path))?;
        file::lock(&folder, &self.path, false)?;
        Ok(Some(folder))
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
        let with_hdf5 = cfg!(feature = "hdf5");
        let hdf5 = with_hdf5 && (new_tables != old_tables || !tables.is_empty() || !intact(&self.hdf5_file()));
        let listed =
            |file: &str| new_tables.iter().any(|table| table.file == file) || (with_hdf5 && file == self.hdf5_file());
        // A manifest from elsewhere may name anything; only files right here are ours.
        let here = |file: &str| Path::new(file).file_name().is_some_and(|name| name == file);
        let old_files = old.iter().flat_map(|old| &old.files).map(|record| record.file.clone());
        let remove: Vec<String> = old_files.filter(|file| !listed(file) && here(file)).collect();
        let says_something_new = old.is_none_or(|old| essence(old) != essence(new));
        let manifest = says_something_new || hdf5 || !tables.is_empty() || !remove.is_empty();
        Changes { manifest, tables, hdf5, remove }
    }

    fn intact(&self, manifest: &Manifest, file: &str) -> bool {
        let size = fs::metadata(self.path.join(file)).map(|metadata| metadata.len()).ok();
        manifest.files.iter().any(|record| record.file == file && Some(record.bytes) == size)
    }

    fn record(&self, file: &str) -> Result<FileRecord, StoreError> {
        let path = self.path.join(file);
        let metadata = fs::metadata(&path).map_err(StoreError::io("read", &path))?;
        Ok(FileRecord { file: file.to_owned(), bytes: metadata.len() })
    }

    #[cfg(feature = "hdf5")]
    fn write_hdf5(&self, manifest: &mut Manifest, changed: bool) -> Result<(), StoreError> {
        let path = self.path.join(self.hdf5_file());
        if changed {
            let mut writer = hdf5::Writer::create(&path)?;
            for record in manifest.stages.iter().flat_map(|stage| &stage.tables) {
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

    fn write_manifest(&self, manifest: &Manifest) -> Result<(), StoreError> {
        let path = self.path.join(MANIFEST);
        let mut bytes = serde_json::to_vec_pretty(manifest)
            .map_err(|error| StoreError::Format { table: MANIFEST.to_owned(), problem: error.to_string() })?;
        bytes.push(b'\n');
        file::write(&path, &bytes, Durability::Lazy)
    }
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
    (essence.written, essence.seconds) = (String::new(), 0.0);
    essence.files.clear();
    for stage in &mut essence.stages {
        stage.seconds = 0.0;
        if complete(stage) {
            stage.status.clear();
            stage.why.clear();
        }
    }
    essence
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;
    use crate::store::parquet::tests::{assert_identical, everything};
    use crate::table::schema::Schema;

    fn tables() -> Vec<(&'static str, Table)> {
        let named = |name: &str, rows| {
            let table = everything(rows);
            let schema = Schema { name: name.to_owned(), ..table.schema().clone() };
            Table::from_columns(schema, table.columns().to_vec()).unwrap()
        };
        vec![("ste", named("curve", 30)), ("ste", named("summary", 3)), ("pair", named("geometry", 1))]
    }

    fn manifest(tables: &[(&str, Table)]) -> Manifest {
        let stage = |name: &str| StageRecord {
            name: name.to_owned(),
            kind: name.to_owned(),
            version: 1,
            keys: vec![],
            status: "ran".to_owned(),
            why: "never ran".to_owned(),
            seconds: 0.1,
            warnings: vec![],
            left_out: vec![],
            tables: tables
                .iter()
                .filter(|(stage, _)| *stage == name)
                .map(|(stage, table)| TableRecord {
                    name: format!("{stage}.{}", table.name()),
                    description: table.schema().description.clone(),
                    rows: table.rows(),
                    content: table.content_hash().to_string(),
                    file: format!("{stage}.{}.parquet", table.name()),
                    columns: vec![],
                })
                .collect(),
        };
        Manifest {
            format: FORMAT,
            study: "s".to_owned(),
            stages: vec![stage("pair"), stage("ste")],
            ..Manifest::default()
        }
    }

    fn publish(folder: &Folder, tables: &[(&str, Table)], manifest: Manifest) -> (Published, usize) {
        let asked = Cell::new(0);
        let bytes = |stage: &str, name: &str| {
            asked.set(asked.get() + 1);
            parquet::write(&tables.iter().find(|(s, table)| *s == stage && table.name() == name).unwrap().1)
        };
        let facts = || Facts { program: Program::default(), machine: Machine::default(), written: "now".into() };
        (folder.publish(manifest, facts, &bytes).unwrap(), asked.get())
    }

    fn files(folder: &Folder) -> Vec<String> {
        let entries = fs::read_dir(folder.path()).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn everything_is_written_once_and_reads_back() {
        let root = tempfile::tempdir().unwrap();
        let folder = Folder::new(root.path(), "s");
        let tables = tables();
        let (first, _) = publish(&folder, &tables, manifest(&tables));
        assert_eq!(first.changes.tables.len(), 3);
        for record in first.manifest.stages.iter().flat_map(|stage| &stage.tables) {
            let (_, table) = tables.iter().find(|(stage, t)| format!("{stage}.{}", t.name()) == record.name).unwrap();
            assert_identical(table, &folder.table(record).unwrap());
            #[cfg(feature = "hdf5")]
            {
                let (stage, name) = split(&record.name);
                assert_identical(table, &hdf5::read(&folder.path().join("s.h5"), stage, name).unwrap());
            }
        }
        let stamp = |name: &str| fs::metadata(folder.path().join(name)).unwrap().modified().unwrap();
        let stamps: Vec<_> = files(&folder).iter().map(|name| stamp(name)).collect();
        let again = Manifest { seconds: 9.0, ..manifest(&tables) };
        let panics = || panic!("nothing is written, so nobody asks for facts");
        let second = folder.publish(again, panics, &|_, _| panic!("nothing is read")).unwrap();
        assert_eq!(second.changes, Changes::default());
        assert_eq!(stamps, files(&folder).iter().map(|name| stamp(name)).collect::<Vec<_>>());
    }

    #[test]
    fn only_what_changed_is_asked_for() {
        let root = tempfile::tempdir().unwrap();
        let folder = Folder::new(root.path(), "s");
        let mut tables = tables();
        publish(&folder, &tables, manifest(&tables));
        fs::write(folder.path().join("notes.txt"), "mine").unwrap();
        tables[1].1 = Table::from_rows(tables[1].1.schema().clone(), vec![]).unwrap();
        let (published, asked) = publish(&folder, &tables, manifest(&tables));
        assert_eq!((published.changes.tables, asked), (vec!["ste.summary.parquet".to_owned()], 1));
        // A file that was lost or cut comes back.
        fs::write(folder.path().join("ste.curve.parquet"), "x").unwrap();
        assert_eq!(folder.changes(&manifest(&tables)).tables, ["ste.curve.parquet"]);
        assert_eq!(publish(&folder, &tables, manifest(&tables)).1, 1);
        // A table that is no more takes its file along; what was never listed stays.
        tables.remove(0);
        let (published, asked) = publish(&folder, &tables, manifest(&tables));
        assert_eq!((published.changes.remove, asked), (vec!["ste.curve.parquet".to_owned()], 0));
        assert!(!files(&folder).contains(&"ste.curve.parquet".to_owned()));
        assert!(files(&folder).contains(&"notes.txt".to_owned()));
    }

    #[test]
    fn a_stage_that_failed_keeps_its_last_tables() {
        let root = tempfile::tempdir().unwrap();
        let folder = Folder::new(root.path(), "s");
        let tables = tables();
        let (first, _) = publish(&folder, &tables, manifest(&tables));
        let mut failed = manifest(&tables);
        let stage = &mut failed.stages[1];
        (stage.status, stage.why) = ("failed".to_owned(), "no".to_owned());
        stage.tables.clear();
        let (second, asked) = publish(&folder, &tables, failed);
        assert_eq!(asked, 0);
        assert_eq!(second.manifest.stages[1].status, "failed");
        assert_eq!(second.manifest.stages[1].tables, first.manifest.stages[1].tables);
        assert!(publish(&folder, &tables, manifest(&tables)).0.changes.manifest);
        assert_eq!(folder.manifest().unwrap().stages[1].status, "ran");
    }

    /// A clone has the manifest and the small tables only: running there brings the others back and changes nothing else.
    #[test]
    fn missing_files_come_back_without_a_new_manifest() {
        let root = tempfile::tempdir().unwrap();
        let folder = Folder::new(root.path(), "s");
        let tables = tables();
        publish(&folder, &tables, manifest(&tables));
        let before = fs::read(folder.path().join(MANIFEST)).unwrap();
        fs::remove_file(folder.path().join("ste.curve.parquet")).unwrap();
        fs::remove_file(folder.path().join(folder.hdf5_file())).unwrap();
        let panics = || panic!("the facts of the first run stand");
        let bytes = |_: &str, name: &str| {
            let (_, table) = tables.iter().find(|(_, table)| table.name() == name).unwrap();
            parquet::write(table)
        };
        let again = folder.publish(manifest(&tables), panics, &bytes).unwrap();
        assert_eq!(again.changes.tables, ["ste.curve.parquet"]);
        assert_eq!(before, fs::read(folder.path().join(MANIFEST)).unwrap());
        assert_eq!(folder.changes(&manifest(&tables)), Changes::default());
    }

    #[test]
    fn after_a_kill_no_new_file_passes_for_the_old_one() {
        let root = tempfile::tempdir().unwrap();
        let folder = Folder::new(root.path(), "s");
        let old = tables();
        publish(&folder, &old, manifest(&old));
        let mut new = tables();
        for (_, table) in &mut new[..2] {
            *table = Table::from_rows(table.schema().clone(), vec![]).unwrap();
        }
        // The first new file happens to be as long as the old one; the second never comes.
        let length = fs::metadata(folder.path().join("ste.curve.parquet")).unwrap().len();
        let bytes = |_: &str, name: &str| match name {
            "curve" => Ok(vec![b'x'; usize::try_from(length).unwrap()]),
            _ => Err(StoreError::InUse { path: "killed".to_owned() }),
        };
        assert!(folder.publish(manifest(&new), || unreachable!(), &bytes).is_err());
        assert_eq!(folder.changes(&manifest(&old)).tables, ["ste.curve.parquet", "ste.summary.parquet"]);
        publish(&folder, &old, manifest(&old));
        for record in &folder.manifest().unwrap().stages[1].tables {
            folder.table(record).unwrap();
        }
    }

    #[test]
    fn a_manifest_from_elsewhere_removes_nothing_outside() {
        let root = tempfile::tempdir().unwrap();
        let folder = Folder::new(root.path(), "s");
        let tables = tables();
        publish(&folder, &tables, manifest(&tables));
        fs::write(root.path().join("precious"), "").unwrap();
        let mut wicked = folder.manifest().unwrap();
        wicked.files.push(FileRecord { file: "../precious".into(), bytes: 0 });
        folder.write_manifest(&wicked).unwrap();
        publish(&folder, &tables, Manifest { title: "new".into(), ..manifest(&tables) });
        assert!(root.path().join("precious").exists());
    }
}
