//! The cache: entries by key, and journals by study, in one folder that may be deleted at any time.
//!
//! ```text
//! CACHEDIR.TAG  .gitignore  lock  entries/<2 digits>/<62 digits>  packs/<number>.pack  journals/<study>.json
//! ```
//!
//! The first small entries that a run keeps, and every large one, are files of their own, each written through. Where a run
//! keeps many, the small ones share a pack (`packs.rs`): a file and an `fsync` for each would take longer than to compute them.
//!
//! Every file is written under a temporary name and renamed, so a run may be killed at any moment and several may run
//! at once: both compute, the second finds that the first was right. A run holds the lock shared, cleaning up holds it
//! alone. The lock saves work and no more: an entry that is removed under a run is computed again, since every byte that
//! is read is checked. So nothing is lost where the lock reaches one computer only, or is none.
//!
//! What the cache does not take (a full disk, a folder nobody may write) is kept in memory until the cache is dropped: at
//! most the tables of one run, compressed. The run is none the worse, the next one computes it again, and is told so.
//! Must not know: what a key is made of, what tables mean.

mod carried;
mod cleaning;
mod pack;
mod packs;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{Cursor, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, Once, OnceLock, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime};

pub use cleaning::{Faulty, Left, Remove, Removed};

use self::pack::Small;
use self::packs::Packs;
use super::entry::{self, CacheEntry, OfRun, StoredTable};
use super::error::StoreError;
use super::file::{self, Durability};
use super::journal::Journal;
use super::{lock, parquet};
use crate::presence;
use crate::table::data::{Data, Table};
use declare::digest::Digest;

/// Where the cache is when nobody says otherwise, under the current folder: one for all studies of a project.
pub const DEFAULT: &str = ".gearstudy/cache";

/// Where it is noted which studies are up to date.
pub const NOTES: &str = "notes";
const ENTRIES: &str = "entries";
const JOURNALS: &str = "journals";

/// Cleaning up takes less.
const WHILE_CLEANED: Duration = Duration::from_secs(10);

/// A use is noted again after so long.
const NOTED_EVERY: Duration = Duration::from_hours(1);

/// An open cache; others may have it open too.
pub struct Cache {
    root: PathBuf,
    /// Held until the cache is dropped; none when nothing is read or written there.
    lock: Option<File>,
    unkept: Mutex<Unkept>,
    packs: Arc<Packs>,
    /// Writes packs, once there is something to write.
    writer: OnceLock<Option<JoinHandle<()>>>,
    /// Small entries that this run kept.
    kept: AtomicUsize,
    /// Done once there is something to write.
    swept: Once,
}

/// So many small entries of a run have files of their own.
const ALONE: usize = 32;

/// What is not on the disk although it should be.
#[derive(Default)]
struct Unkept {
    /// The files of entries.
    entries: BTreeMap<Digest, Arc<Vec<u8>>>,
    /// The first reason.
    why: Option<String>,
    /// Why a journal could not be read or written.
    journal: Option<String>,
}

/// What is known about a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Lookup {
    Found(CacheEntry),
    Missing,
    /// There is a file, but it cannot be trusted: a sentence says why.
    Damaged(String),
}

impl Cache {
    /// Opens the cache in `root`, making it when there is none; waits while it is being cleaned up.
    ///
    /// # Errors
    /// When the folder cannot be made or locked.
    pub fn open(root: &Path) -> Result<Self, StoreError> {
        let path = root.join("lock");
        let lock = match path.metadata() {
            Ok(metadata) if metadata.is_file() => File::open(&path).map_err(StoreError::io("open", &path))?,
            // To open a pipe would wait for somebody at its other end. Nothing is lost with it, nor with an empty folder.
            Ok(metadata) => {
                let removed = if metadata.is_dir() { fs::remove_dir(&path) } else { fs::remove_file(&path) };
                removed.map_err(StoreError::io("remove what is not a file,", &path))?;
                Self::create(root, &path)?
            }
            Err(error) if error.kind() == ErrorKind::NotFound => Self::create(root, &path)?,
            Err(error) => return Err(StoreError::io("open", &path)(error)),
        };
        lock::hold(&lock, &path, true, WHILE_CLEANED)?;
        Ok(Self::new(root, Some(lock), Unkept::default()))
    }

    /// Opens the cache in `root` to look into it; none where there is none, and none is made.
    ///
    /// # Errors
    /// When it cannot be read or locked.
    pub fn open_if_there(root: &Path) -> Result<Option<Self>, StoreError> {
        let is_there = presence::exists(root).map_err(StoreError::io("read", root))?;
        is_there.then(|| Self::open(root)).transpose()
    }

    /// Opens the cache in `root`, or does without: then everything is kept in memory, and [`Cache::problems`] says why.
    #[must_use]
    pub fn open_if_possible(root: &Path) -> Self {
        Self::open(root)
            .unwrap_or_else(|error| Self::new(root, None, Unkept { why: Some(error.to_string()), ..Unkept::default() }))
    }

    fn new(root: &Path, lock: Option<File>, unkept: Unkept) -> Self {
        let (unkept, packs) = (Mutex::new(unkept), Arc::new(Packs::new(root)));
        let (writer, kept, swept) = (OnceLock::new(), AtomicUsize::new(0), Once::new());
        Self { root: root.to_owned(), lock, unkept, packs, writer, kept, swept }
    }

    fn create(root: &Path, lock: &Path) -> Result<File, StoreError> {
        fs::create_dir_all(root).map_err(StoreError::io("make the cache folder", root))?;
        let tag =
            "Signature: 8a477f597d28d172789f06886806bc55\n# A cache of gearstudy; see https://bford.info/cachedir/\n";
        for (name, text) in [("CACHEDIR.TAG", tag), (".gitignore", "*\n")] {
            // Without these marks backups take the cache along and git shows it: no reason to do without it.
            let _ = file::write(&root.join(name), text.as_bytes(), Durability::Lazy);
        }
        let options = File::options().read(true).write(true).create(true).truncate(false).open(lock);
        options.map_err(StoreError::io("open", lock))
    }

    /// The files that hold the entries of these keys.
    #[must_use]
    pub fn files(&self, keys: impl Iterator<Item = Digest>) -> BTreeSet<PathBuf> {
        keys.map(|key| self.packs.path(key).unwrap_or_else(|| self.path(key))).collect()
    }

    fn unkept(&self) -> MutexGuard<'_, Unkept> {
        self.unkept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn in_memory(&self, key: Digest) -> Option<Arc<Vec<u8>>> {
        self.unkept().entries.get(&key).cloned()
    }

    /// Whether an entry is in memory alone: the next run will not find it.
    #[must_use]
    pub fn is_unkept(&self, key: Digest) -> bool {
        self.in_memory(key).is_some() || self.packs.is_unkept(key)
    }

    /// What went wrong that costs no results: with entries, with journals.
    #[must_use]
    pub fn problems(&self) -> (Option<String>, Option<String>) {
        let mut unkept = self.unkept();
        if let Some(problem) = self.packs.take_problem() {
            unkept.why.get_or_insert(problem);
        }
        (unkept.why.clone(), unkept.journal.clone())
    }

    #[must_use]
    pub fn root(&self) -> &Path {
        &self.root
    }

    fn path(&self, key: Digest) -> PathBuf {
        let name = key.to_string();
        self.root.join(ENTRIES).join(&name[..2]).join(&name[2..])
    }

    /// Writes a file, making its folder; an empty folder in its place goes. The first time files that killed runs left are
    /// removed: a run that writes nothing looks for none.
    fn replace(&self, path: &Path, bytes: &[u8], durability: Durability) -> Result<(), StoreError> {
        self.swept.call_once(|| self.sweep());
        let folder = path.parent().unwrap_or(path);
        fs::create_dir_all(folder).map_err(StoreError::io("make the cache folder", folder))?;
        let written = file::write(path, bytes, durability);
        // What is not empty is somebody's, and stays.
        if written.is_err() && fs::remove_dir(path).is_ok() {
            return file::write(path, bytes, durability);
        }
        written
    }

    fn sweep(&self) {
        let upper = ["", ENTRIES, JOURNALS, NOTES, packs::FOLDER].map(|folder| self.root.join(folder));
        // A folder that cannot be read is swept by a later run.
        let of_entries = presence::entries(&self.root.join(ENTRIES)).unwrap_or_default();
        let of_entries = of_entries.into_iter().filter(|(_, kind)| kind.is_dir()).map(|(path, _)| path);
        upper.into_iter().chain(of_entries).for_each(|folder| file::sweep_ended(&folder));
    }

    /// What is known about a key, without reading tables.
    #[must_use]
    pub fn look_up(&self, key: Digest) -> Lookup {
        let found = match self.in_memory(key) {
            Some(bytes) => CacheEntry::read(&mut Cursor::new(&*bytes), bytes.len() as u64, key).map(Some),
            None if self.lock.is_none() => Ok(None),
            None if let Some(found) = self.packs.look_up(key) => found.map(Some),
            None => entry::open(&self.path(key), key).map(|found| found.map(|(entry, _)| entry)),
        };
        match found {
            Ok(Some(entry)) => Lookup::Found(entry),
            Ok(None) => Lookup::Missing,
            Err(problem) => Lookup::Damaged(problem),
        }
    }

    /// Keeps what was computed for a key.
    ///
    /// # Errors
    /// [`StoreError::NotDeterministic`] when there are other tables under this key already; when a table cannot be written
    /// as Parquet.
    pub fn put(&self, key: Digest, tables: &[&Table], of_run: OfRun) -> Result<CacheEntry, StoreError> {
        let is_small = || tables.iter().map(|table| pack::size(table)).sum::<usize>() <= pack::SMALL;
        if self.lock.is_some() && is_small() && self.kept.fetch_add(1, Ordering::Relaxed) >= ALONE {
            return self.put_small(key, tables, of_run);
        }
        let (entry, bytes) = CacheEntry::encode(key, tables, of_run)?;
        self.keep(&entry, bytes)?;
        Ok(entry)
    }

    fn put_small(&self, key: Digest, tables: &[&Table], of_run: OfRun) -> Result<CacheEntry, StoreError> {
        let small = Small::new(key, tables, of_run)?;
        let entry = small.entry.clone();
        if let Lookup::Found(earlier) = self.look_up(key) {
            earlier.agree(&entry)?;
            // Computed again although it is there.
            if self.packs.is_sound(key) {
                return Ok(entry);
            }
        }
        // A damaged file would be in its way only where no pack has the key.
        self.packs.put(small);
        // Without the thread it is written at the end.
        self.writer.get_or_init(|| self.packs.keep_writing().ok());
        Ok(entry)
    }

    /// Writes through what waits for others to be written with. What the disk does not take stays in memory.
    pub fn flush(&self) {
        self.packs.flush();
    }

    /// Keeps what is known about tables whose rows lie under other keys.
    ///
    /// # Errors
    /// As [`Cache::put`].
    pub fn put_whole(&self, key: Digest, tables: Vec<StoredTable>) -> Result<CacheEntry, StoreError> {
        let entry = CacheEntry { key, tables, of_run: OfRun::default() };
        self.keep(&entry, entry.file(&[])?)?;
        Ok(entry)
    }

    fn keep(&self, entry: &CacheEntry, bytes: Vec<u8>) -> Result<(), StoreError> {
        if let Lookup::Found(earlier) = self.look_up(entry.key) {
            earlier.agree(entry)?;
        }
        if self.lock.is_some() {
            let Err(error) = self.replace(&self.path(entry.key), &bytes, Durability::Synced) else {
                return Ok(());
            };
            // Computed again although it was there: that file may serve the next run as well.
            if !self.is_unkept(entry.key) && self.is_sound(entry.key) {
                return Ok(());
            }
            self.unkept().why.get_or_insert_with(|| error.to_string());
        }
        self.unkept().entries.insert(entry.key, Arc::new(bytes));
        Ok(())
    }

    /// Whether every byte of an entry is what was written.
    fn is_sound(&self, key: Digest) -> bool {
        let Lookup::Found(entry) = self.look_up(key) else { return false };
        entry.tables.iter().filter(|table| table.body.is_some()).all(|table| self.bytes(key, &table.name).is_ok())
    }

    /// The Parquet bytes of a table, checked.
    ///
    /// # Errors
    /// [`StoreError::Damaged`] also when there is no such entry or table: the caller computes it again.
    pub fn bytes(&self, key: Digest, table: &str) -> Result<Vec<u8>, StoreError> {
        if let Some(table) = self.packed(key, table)? {
            return parquet::write(&table);
        }
        let path = self.path(key);
        let damaged = |problem: String| StoreError::Damaged { path: path.display().to_string(), problem };
        let bytes = if let Some(bytes) = self.in_memory(key) {
            let mut file = Cursor::new(&*bytes);
            let entry = CacheEntry::read(&mut file, bytes.len() as u64, key).map_err(damaged)?;
            entry.body(&mut file, table).map_err(damaged)?
        } else {
            let found = if self.lock.is_some() { entry::open(&path, key).map_err(damaged)? } else { None };
            let (entry, mut file) = found.ok_or_else(|| damaged("it is missing".to_owned()))?;
            entry.body(&mut file, table).map_err(damaged)?
        };
        bytes.ok_or_else(|| damaged(format!("it has no table `{table}`")))
    }

    /// A table from a pack; none when its entry is in none.
    fn packed(&self, key: Digest, table: &str) -> Result<Option<Table>, StoreError> {
        if self.lock.is_none() || self.in_memory(key).is_some() {
            return Ok(None);
        }
        let damaged = |path: PathBuf, problem| StoreError::Damaged { path: path.display().to_string(), problem };
        match self.packs.table(key, table) {
            None => Ok(None),
            Some(Err((path, problem))) => Err(damaged(path, problem)),
            Some(Ok(None)) => Err(damaged(self.root.join(packs::FOLDER), format!("an entry has no table `{table}`"))),
            Some(Ok(found)) => Ok(found),
        }
    }

    /// # Errors
    /// As [`Cache::bytes`].
    pub fn table(&self, key: Digest, table: &str) -> Result<Table, StoreError> {
        if let Some(table) = self.packed(key, table)? {
            return Ok(table);
        }
        let path = self.path(key).display().to_string();
        parquet::read(self.bytes(key, table)?).map_err(|problem| StoreError::Damaged { path, problem })
    }

    /// One column of a table alone.
    ///
    /// # Errors
    /// As [`Cache::bytes`].
    pub fn column(&self, key: Digest, table: &str, position: usize) -> Result<Data, StoreError> {
        let path = self.path(key).display().to_string();
        let found = match self.packed(key, table)? {
            Some(table) => table.columns().get(position).cloned().ok_or_else(|| "it has fewer columns".to_owned()),
            None => parquet::read_column(self.bytes(key, table)?, position),
        };
        found.map_err(|problem| StoreError::Damaged { path, problem })
    }

    /// Removes an entry that turned out to be damaged, so that the next plan knows.
    pub fn forget(&self, key: Digest) {
        if self.lock.is_some() && !self.is_unkept(key) {
            // Somebody else may have removed it, or written it anew, already: either is as good. What cannot be removed
            // is found damaged again.
            let _ = fs::remove_file(self.path(key));
            self.packs.forget(key);
        }
    }

    /// Where the journal of a study lies.
    #[must_use]
    pub fn journal_path(&self, study: &str) -> PathBuf {
        self.root.join(JOURNALS).join(format!("{study}.json"))
    }

    /// The journal of a study; an empty one when there is none that can be read.
    #[must_use]
    pub fn journal(&self, study: &str) -> Journal {
        if self.lock.is_none() {
            return Journal::default();
        }
        let path = self.journal_path(study);
        let parsed = match file::read(&path, file::MOST_MANIFEST) {
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(Journal::default()),
            Err(error) => Err(error.to_string()),
            Ok(bytes) => Journal::parse(bytes).map_err(|error| error.to_string()),
        };
        parsed.unwrap_or_else(|problem| {
            self.unkept().journal.get_or_insert_with(|| format!("cannot read `{}`: {problem}", path.display()));
            Journal::default()
        })
    }

    /// Notes that what a study's journal names was used now. All of it is noted by the time of one file, and that no more
    /// often than cleaning up can tell apart.
    pub fn note_use(&self, study: &str) {
        if self.lock.is_none() {
            return;
        }
        let path = self.journal_path(study);
        let now = SystemTime::now();
        let is_old = |noted: SystemTime| now.duration_since(noted).is_ok_and(|since| since >= NOTED_EVERY);
        if fs::metadata(&path).is_ok_and(|found| found.is_file() && found.modified().is_ok_and(is_old)) {
            // Where it cannot be noted, entries seem older than they are, and are computed again once.
            let _ = File::options().append(true).open(&path).and_then(|journal| journal.set_modified(now));
        }
    }

    /// Keeps the journal of a study. One that cannot be written costs explanations only; [`Cache::problems`] has it.
    pub fn put_journal(&self, study: &str, journal: &Journal) {
        if self.lock.is_none() {
            return;
        }
        let path = self.journal_path(study);
        if let Err(error) = self.replace(&path, &journal.bytes(), Durability::Lazy) {
            self.unkept().journal = Some(error.to_string());
        }
    }
}

impl Drop for Cache {
    fn drop(&mut self) {
        self.packs.close();
        if let Some(writer) = self.writer.take().flatten() {
            // A thread that panicked has written what it could.
            let _ = writer.join();
        }
        self.packs.flush();
    }
}
