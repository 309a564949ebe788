//! The cache: entries by key, and journals by study, in one folder that may be deleted at any time.
//!
//! ```text
//! CACHEDIR.TAG  .gitignore  lock  entries/<2 digits>/<62 digits>  journals/<study>.json
//! ```
//!
//! Every file is written under a temporary name and renamed, so a run may be killed at any moment and several may run
//! at once: both compute, the second finds that the first was right. A run holds the lock shared, cleaning up holds it
//! alone. Must not know: what a key is made of, what tables mean.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use super::entry::{self, Entry, OfRun, StoredTable};
use super::error::StoreError;
use super::file::{self, Durability, TEMPORARY};
use super::journal::Journal;
use super::parquet;
use crate::base::digest::Digest;
use crate::table::data::Table;

/// Where the cache is when nobody says otherwise, under the current folder: one for all studies of a project.
pub const DEFAULT: &str = ".gearstudy/cache";

/// An open cache; others may have it open too.
pub struct Cache {
    root: PathBuf,
    /// Held until the cache is dropped.
    _lock: File,
}

/// What is known about a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Lookup {
    Found(Entry),
    Missing,
    /// There is a file, but it cannot be trusted: a sentence says why.
    Damaged(String),
}

/// What to remove.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remove {
    /// What the last run of no study needs.
    Unreferenced,
    /// What was written longer ago than this, needed or not.
    OlderThan(Duration),
    /// Everything.
    All,
}

/// What cleaning up did, or would do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Removed {
    pub entries: usize,
    pub bytes: u64,
    pub kept: usize,
    pub kept_bytes: u64,
}

impl Cache {
    /// Opens the cache in `root`, making it when there is none; waits while it is being cleaned up.
    ///
    /// # Errors
    /// When the folder cannot be made or locked.
    pub fn open(root: &Path) -> Result<Self, StoreError> {
        let lock_path = root.join("lock");
        // To open a pipe would wait for somebody at its other end.
        if lock_path.metadata().is_ok_and(|metadata| !metadata.is_file()) {
            return Err(StoreError::io("lock", &lock_path)(std::io::Error::other("it is no regular file")));
        }
        let lock = match File::open(&lock_path) {
            Ok(lock) => lock,
            Err(_) => Self::create(root, &lock_path)?,
        };
        file::lock(&lock, &lock_path, true)?;
        Ok(Self { root: root.to_owned(), _lock: lock })
    }

    fn create(root: &Path, lock: &Path) -> Result<File, StoreError> {
        for folder in [root.join("entries"), root.join("journals")] {
            fs::create_dir_all(&folder).map_err(StoreError::io("make the cache folder", &folder))?;
        }
        let tag =
            "Signature: 8a477f597d28d172789f06886806bc55\n# A cache of gearstudy; see https://bford.info/cachedir/\n";
        file::write(&root.join("CACHEDIR.TAG"), tag.as_bytes(), Durability::Lazy)?;
        file::write(&root.join(".gitignore"), b"*\n", Durability::Lazy)?;
        let options = File::options().read(true).write(true).create(true).truncate(false).open(lock);
        options.map_err(StoreError::io("open", lock))
    }

    fn path(&self, key: Digest) -> PathBuf {
        let name = key.to_string();
        self.root.join("entries").join(&name[..2]).join(&name[2..])
    }

    /// What is known about a key, without reading tables.
    #[must_use]
    pub fn look_up(&self, key: Digest) -> Lookup {
        match entry::open(&self.path(key), key) {
            Ok(Some((entry, _))) => Lookup::Found(entry),
            Ok(None) => Lookup::Missing,
            Err(problem) => Lookup::Damaged(problem),
        }
    }

    /// Keeps what was computed for a key.
    ///
    /// # Errors
    /// [`StoreError::NotDeterministic`] when there are other tables under this key already; when it cannot be written.
    pub fn put(&self, key: Digest, tables: &[&Table], of_run: OfRun) -> Result<Entry, StoreError> {
        let (entry, bytes) = Entry::encode(key, tables, of_run)?;
        self.keep(&entry, &bytes)?;
        Ok(entry)
    }

    /// Keeps what is known about tables whose rows lie under other keys.
    ///
    /// # Errors
    /// As [`Cache::put`].
    pub fn put_whole(&self, key: Digest, tables: Vec<StoredTable>) -> Result<Entry, StoreError> {
        let entry = Entry { key, tables, of_run: OfRun::default() };
        self.keep(&entry, &entry.file(&[])?)?;
        Ok(entry)
    }

    fn keep(&self, entry: &Entry, bytes: &[u8]) -> Result<(), StoreError> {
        if let Lookup::Found(earlier) = self.look_up(entry.key) {
            earlier.agree(entry)?;
        }
        let path = self.path(entry.key);
        let folder = path.parent().unwrap_or(&self.root);
        fs::create_dir_all(folder).map_err(StoreError::io("make the cache folder", folder))?;
        file::write(&path, bytes, Durability::Synced)
    }

    /// The Parquet bytes of a table, checked.
    ///
    /// # Errors
    /// [`StoreError::Damaged`] also when there is no such entry or table: the caller computes it again.
    pub fn bytes(&self, key: Digest, table: &str) -> Result<Vec<u8>, StoreError> {
        let path = self.path(key);
        let damaged = |problem: String| StoreError::Damaged { path: path.display().to_string(), problem };
        let (entry, mut file) =
            entry::open(&path, key).map_err(damaged)?.ok_or_else(|| damaged("it is missing".to_owned()))?;
        let bytes = entry.body(&mut file, table).map_err(damaged)?;
        bytes.ok_or_else(|| damaged(format!("it has no table `{table}`")))
    }

    /// # Errors
    /// As [`Cache::bytes`].
    pub fn table(&self, key: Digest, table: &str) -> Result<Table, StoreError> {
        let path = self.path(key).display().to_string();
        parquet::read(self.bytes(key, table)?).map_err(|problem| StoreError::Damaged { path, problem })
    }

    /// Removes an entry that turned out to be damaged, so that the next plan knows.
    pub fn forget(&self, key: Digest) {
        // Somebody else may have removed it, or written it anew, already: either is as good.
        let _ = fs::remove_file(self.path(key));
    }

    fn journal_path(&self, study: &str) -> PathBuf {
        self.root.join("journals").join(format!("{study}.json"))
    }

    /// The journal of a study; an empty one when there is none that can be read.
    #[must_use]
    pub fn journal(&self, study: &str) -> Journal {
        let bytes = fs::read(self.journal_path(study)).unwrap_or_default();
        serde_json::from_slice(&bytes).unwrap_or_default()
    }

    /// # Errors
    /// When it cannot be written.
    pub fn put_journal(&self, study: &str, journal: &Journal) -> Result<(), StoreError> {
        let path = self.journal_path(study);
        let bytes = serde_json::to_vec(journal)
            .map_err(|error| StoreError::Format { table: study.to_owned(), problem: error.to_string() })?;
        file::write(&path, &bytes, Durability::Lazy)
    }

    /// Reads every byte of every entry, and names the files that are damaged.
    ///
    /// # Errors
    /// When a folder cannot be read.
    pub fn verify(&self) -> Result<Vec<(PathBuf, String)>, StoreError> {
        let mut damaged = Vec::new();
        // What is under a temporary name is not there yet, or was left behind.
        for (path, key) in entries(&self.root)?.into_iter().filter_map(|(path, key)| Some((path, key?))) {
            let problem = match entry::open(&path, key) {
                Err(problem) => Some(problem),
                Ok(None) => None,
                Ok(Some((entry, _))) => entry
                    .tables
                    .iter()
                    .filter(|table| table.body.is_some())
                    .find_map(|table| self.table(entry.key, &table.name).err().map(|error| error.to_string())),
            };
            damaged.extend(problem.map(|problem| (path, problem)));
        }
        Ok(damaged)
    }

    /// Removes entries, and what killed runs left behind. The cache must not be open anywhere.
    ///
    /// # Errors
    /// [`StoreError::InUse`] while a run has the cache open; when a file cannot be removed.
    pub fn clean(root: &Path, remove: Remove, dry_run: bool) -> Result<Removed, StoreError> {
        let lock_path = root.join("lock");
        let Ok(lock) = File::open(&lock_path) else { return Ok(Removed::default()) };
        lock_alone(&lock, &lock_path)?;
        let referenced = if remove == Remove::Unreferenced { referenced(root)? } else { BTreeSet::new() };
        let now = SystemTime::now();
        let mut removed = Removed::default();
        for (path, key) in entries(root)? {
            let metadata = fs::metadata(&path).map_err(StoreError::io("read", &path))?;
            let age = metadata.modified().ok().and_then(|time| now.duration_since(time).ok()).unwrap_or_default();
            // A name that is no key is the leftover of a killed run: nobody else writes now.
            let doomed = key.is_none_or(|key| match remove {
                Remove::All => true,
                Remove::OlderThan(limit) => age > limit,
                Remove::Unreferenced => !referenced.contains(&key),
            });
            if doomed {
                if !dry_run {
                    fs::remove_file(&path).map_err(StoreError::io("remove", &path))?;
                }
                removed.entries += 1;
                removed.bytes += metadata.len();
            } else {
                removed.kept += 1;
                removed.kept_bytes += metadata.len();
            }
        }
        Ok(removed)
    }
}

/// Takes the lock when no run holds it. A run that is just ending, or whose lock lives on for a moment in a process it
/// started, is given a little time.
fn lock_alone(lock: &File, path: &Path) -> Result<(), StoreError> {
    for _ in 0..20 {
        match lock.try_lock() {
            Err(fs::TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(10)),
            Err(fs::TryLockError::Error(error)) if error.kind() != std::io::ErrorKind::Unsupported => {
                return Err(StoreError::io("lock", path)(error));
            }
            _ => return Ok(()),
        }
    }
    Err(StoreError::InUse { path: path.display().to_string() })
}

/// The keys that the journals name.
fn referenced(root: &Path) -> Result<BTreeSet<Digest>, StoreError> {
    let mut keys = BTreeSet::new();
    for path in list(&root.join("journals"))? {
        let bytes = fs::read(&path).map_err(StoreError::io("read", &path))?;
        let journal: Journal = serde_json::from_slice(&bytes).unwrap_or_default();
        for stage in journal.stages {
            let texts = stage.keys.iter().map(|record| &record.key).chain(&stage.whole);
            keys.extend(texts.filter_map(|text| Digest::from_hex(text)));
        }
    }
    Ok(keys)
}

/// Every file under `entries/` with its key; leftovers of killed runs have none.
fn entries(root: &Path) -> Result<Vec<(PathBuf, Option<Digest>)>, StoreError> {
    let mut found = Vec::new();
    for folder in list(&root.join("entries"))? {
        let start = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        for path in list(&folder)? {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let key = if name.starts_with(TEMPORARY) { None } else { Digest::from_hex(&format!("{start}{name}")) };
            found.push((path, key));
        }
    }
    Ok(found)
}

fn list(folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
    let entries = fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let mut paths: Vec<_> = entries.map_err(StoreError::io("read", folder))?.iter().map(fs::DirEntry::path).collect();
    paths.sort();
    Ok(paths)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::digest::Writer;
    use crate::store::journal::JournalStage;
    use crate::store::manifest::KeyRecord;
    use crate::store::parquet::tests::{assert_identical, everything};

    fn key(name: &str) -> Digest {
        Writer::new("test").text(name).finish()
    }

    fn filled(root: &Path) -> Cache {
        let cache = Cache::open(root).unwrap();
        let second = Table::from_rows(everything(0).schema().clone(), vec![]).unwrap();
        let mut schema = second.schema().clone();
        schema.name = "empty".to_owned();
        let second = Table::from_rows(schema, vec![]).unwrap();
        let work = [("contact_solves".to_owned(), 7)].into();
        let of_run = OfRun { seconds: 1.5, work, warnings: vec!["warned".to_owned()] };
        cache.put(key("a"), &[&everything(20), &second], of_run).unwrap();
        cache
    }

    #[test]
    fn what_was_put_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().join("deep/cache");
        let cache = filled(&root);
        let Lookup::Found(entry) = cache.look_up(key("a")) else { panic!() };
        let of_run = entry.of_run;
        assert_eq!((of_run.seconds, of_run.work["contact_solves"], of_run.warnings[0].as_str()), (1.5, 7, "warned"));
        assert_eq!(entry.tables[0].content, everything(20).content_hash());
        assert_identical(&cache.table(key("a"), "curve").unwrap(), &everything(20));
        assert_eq!(cache.table(key("a"), "empty").unwrap().rows(), 0);
        assert!(cache.table(key("a"), "absent").is_err());
        assert_eq!(cache.look_up(key("b")), Lookup::Missing);
        assert_eq!(fs::read(root.join(".gitignore")).unwrap(), b"*\n");
        assert!(cache.verify().unwrap().is_empty());
    }

    #[test]
    fn every_cut_and_every_flipped_byte_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let cache = filled(folder.path());
        let path = cache.path(key("a"));
        let whole = fs::read(&path).unwrap();
        let readable = || {
            matches!(cache.look_up(key("a")), Lookup::Found(_))
                && ["curve", "empty"].iter().all(|table| cache.table(key("a"), table).is_ok())
        };
        assert!(readable());
        for length in (0..whole.len()).step_by(97) {
            fs::write(&path, &whole[..length]).unwrap();
            assert!(matches!(cache.look_up(key("a")), Lookup::Damaged(_)), "cut to {length}");
        }
        for position in (0..whole.len()).step_by(13) {
            let mut bytes = whole.clone();
            bytes[position] ^= 0x10;
            fs::write(&path, &bytes).unwrap();
            assert!(!readable(), "flipped byte {position}");
            assert_eq!(cache.verify().unwrap().len(), 1, "flipped byte {position}");
        }
        fs::write(cache.path(key("b")), &whole).unwrap_or_else(|_| {
            fs::create_dir_all(cache.path(key("b")).parent().unwrap()).unwrap();
            fs::write(cache.path(key("b")), &whole).unwrap();
        });
        assert_eq!(cache.look_up(key("b")), Lookup::Damaged("it belongs to another key".to_owned()));
    }

    #[test]
    fn two_contents_for_one_key_are_refused_and_the_first_stays() {
        let folder = tempfile::tempdir().unwrap();
        let cache = filled(folder.path());
        let error = cache.put(key("a"), &[&everything(21)], OfRun::default()).unwrap_err().to_string();
        assert!(error.contains("not deterministic") && error.contains("`curve`"), "{error}");
        assert_eq!(cache.table(key("a"), "curve").unwrap().rows(), 20);
        cache.put(key("b"), &[&everything(3)], OfRun::default()).unwrap();
        cache.put(key("b"), &[&everything(3)], OfRun::default()).unwrap();
    }

    #[test]
    fn cleaning_keeps_what_journals_name_and_waits_for_nobody() {
        let folder = tempfile::tempdir().unwrap();
        let cache = filled(folder.path());
        cache.put(key("b"), &[&everything(3)], OfRun::default()).unwrap();
        let record = KeyRecord { key: key("a").to_string(), ..KeyRecord::default() };
        let stage = JournalStage { name: "s".into(), keys: vec![record], ..JournalStage::default() };
        cache.put_journal("study", &Journal { stages: vec![stage.clone()] }).unwrap();
        assert_eq!(cache.journal("study").stage("s"), Some(&stage));
        fs::write(cache.path(key("a")).with_file_name(".partial-x"), "left behind").unwrap();

        let busy = Cache::clean(folder.path(), Remove::All, false).unwrap_err();
        assert!(matches!(busy, StoreError::InUse { .. }));
        drop(cache);
        let counts = |removed: Removed| (removed.entries, removed.kept);
        assert_eq!(counts(Cache::clean(folder.path(), Remove::Unreferenced, true).unwrap()), (2, 1));
        assert_eq!(counts(Cache::clean(folder.path(), Remove::Unreferenced, false).unwrap()), (2, 1));
        assert_eq!(
            counts(Cache::clean(folder.path(), Remove::OlderThan(Duration::from_hours(1)), false).unwrap()),
            (0, 1)
        );
        let cache = Cache::open(folder.path()).unwrap();
        assert!(matches!(cache.look_up(key("a")), Lookup::Found(_)));
        assert_eq!(cache.look_up(key("b")), Lookup::Missing);
        drop(cache);
        assert_eq!(counts(Cache::clean(folder.path(), Remove::All, false).unwrap()), (1, 0));
        assert_eq!(counts(Cache::clean(&folder.path().join("none"), Remove::All, false).unwrap()), (0, 0));
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_one_clear_error() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("file"), "").unwrap();
        let error = Cache::open(&folder.path().join("file/cache")).err().unwrap().to_string();
        assert!(error.contains("cannot make the cache folder"), "{error}");
    }
}
