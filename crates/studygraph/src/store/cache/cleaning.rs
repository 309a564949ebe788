//! Cleaning the cache up, and reading all of it.
//!
//! Only what is certainly of this program goes: files whose names are keys, and those under temporary names. Whatever
//! else lies there is somebody's; it is named and left alone. Must not know: why an entry is to be kept.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use super::packs::{self, FOLDER, Packs};
use super::{Cache, ENTRIES, JOURNALS, NOTES};
use crate::presence;
use crate::store::error::StoreError;
use crate::store::file::{self, TEMPORARY};
use crate::store::journal::Journal;
use crate::store::{entry, lock};
use declare::digest::Digest;

/// A run that is just ending, or whose lock lives on for a moment in a process it started, is given a little time.
const ENDING: Duration = Duration::from_millis(200);

/// What to remove.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remove<'a> {
    /// What the last run of no study needs.
    Unreferenced,
    /// What is not to be kept, and was neither written nor used for so long; and, where all entries would have more than
    /// `most` bytes, what of the rest is not to be kept and was used longest ago.
    Unused { keep: &'a BTreeSet<Digest>, unused: Duration, most: Option<u64> },
    /// Everything.
    All,
}

/// What cleaning up did, or would do.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Removed {
    pub entries: usize,
    pub bytes: u64,
    pub kept: usize,
    pub kept_bytes: u64,
    /// Those of the kept that are to be kept whatever their age.
    pub needed: usize,
    pub needed_bytes: u64,
    /// Files that killed runs were at.
    pub leftovers: usize,
    /// What is none of ours, and stayed.
    pub foreign: Vec<PathBuf>,
}

/// An entry, or a folder of entries, with a fault.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Faulty {
    pub path: PathBuf,
    pub problem: String,
    pub left: Left,
}

/// What a check leaves of an entry with a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Left {
    /// It is removed.
    Nothing,
    /// It is damaged, and still there.
    Damaged,
    /// The system does not let it be read, and it is as it was.
    Unread,
}

/// What lies in a cache.
#[derive(Default)]
struct Content {
    entries: Vec<(PathBuf, Digest)>,
    leftovers: Vec<PathBuf>,
    foreign: Vec<PathBuf>,
}

/// An entry that may go.
struct Found {
    place: Place,
    key: Digest,
    bytes: u64,
    /// Since it was written or last used.
    age: Duration,
}

/// Where an entry lies.
enum Place {
    File(PathBuf),
    /// Which of all packs.
    Pack(usize),
}

impl Cache {
    /// Reads every byte of every entry; those with a fault, and folders that cannot be looked into. `remove`: damaged ones go,
    /// so that a run with nothing else to do need not read them all to know.
    #[must_use]
    pub fn verify(&self, remove: bool) -> Vec<Faulty> {
        let mut content = Content::default();
        let unread = |path: PathBuf, problem: String| Faulty { path, problem, left: Left::Unread };
        let unseen = content.add_entries(&self.root);
        let reason = |error: StoreError| match error {
            StoreError::Io { source, .. } => source.to_string(),
            other => other.to_string(),
        };
        let mut faulty: Vec<Faulty> = unseen.into_iter().map(|(path, error)| unread(path, reason(error))).collect();
        // What is somebody's and can be read does no harm there.
        for path in content.foreign.into_iter().filter(|path| is_in_an_entrys_place(path)) {
            if let Err(error) = presence::metadata(&path) {
                faulty.push(unread(path, error.to_string()));
            }
        }
        for (path, key) in content.entries {
            if let Err(error) = File::open(&path)
                && error.kind() != ErrorKind::NotFound
            {
                faulty.push(unread(path, error.to_string()));
                continue;
            }
            let problem = match entry::open(&path, key) {
                Err(problem) => Some(problem),
                Ok(None) => None,
                Ok(Some((entry, _))) => entry
                    .tables
                    .iter()
                    .filter(|table| table.body.is_some())
                    .find_map(|table| self.bytes(entry.key, &table.name).err().map(|error| error.to_string())),
            };
            if let Some(problem) = problem {
                if remove {
                    self.forget(key);
                }
                let is_gone = matches!(presence::link_metadata(&path), Ok(None));
                faulty.push(Faulty { path, problem, left: if is_gone { Left::Nothing } else { Left::Damaged } });
            }
        }
        for (path, key, problem) in self.packs.checked() {
            let removed = key.filter(|_| remove);
            if let Some(key) = removed {
                self.packs.forget(key);
            }
            faulty.push(Faulty { path, problem, left: removed.map_or(Left::Damaged, |_| Left::Nothing) });
        }
        self.packs.flush();
        faulty
    }

    /// The keys of all entries, in files of their own and in packs, as far as the folders can be looked into.
    #[must_use]
    pub fn keys(&self) -> BTreeSet<Digest> {
        let mut content = Content::default();
        content.add_entries(&self.root);
        let packed = self.packs.all().into_iter().flat_map(|pack| pack.entries).map(|(key, _)| key);
        content.entries.into_iter().map(|(_, key)| key).chain(packed).collect()
    }

    /// Removes entries, and what killed runs left behind. The cache must not be open anywhere.
    ///
    /// # Errors
    /// [`StoreError::InUse`] while a run has the cache open; when a folder cannot be read or a file not be removed.
    pub fn clean(root: &Path, remove: Remove<'_>, dry_run: bool) -> Result<Removed, StoreError> {
        let lock_path = root.join("lock");
        let lock = match fs::metadata(&lock_path) {
            Ok(metadata) if metadata.is_file() => File::open(&lock_path).map_err(StoreError::io("open", &lock_path))?,
            Ok(_) => return Err(StoreError::io("lock", &lock_path)(io::Error::other("it is not a regular file"))),
            // No cache: there is none, or the folder is something else.
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Removed::default()),
            Err(error) => return Err(StoreError::io("open", &lock_path)(error)),
        };
        lock::hold(&lock, &lock_path, false, ENDING)?;
        let journals = journals(root)?;
        let now = SystemTime::now();
        let content = content(root)?;
        let mut removed = Removed { foreign: content.foreign, ..Removed::default() };
        let mut found = Vec::new();
        let used = |key: &Digest, written: SystemTime| journals.get(key).map_or(written, |used| written.max(*used));
        let age = |used: SystemTime| now.duration_since(used).unwrap_or_default();
        for (path, key) in content.entries {
            // Another computer may be cleaning up too.
            let Some(metadata) = there(fs::metadata(&path)).map_err(StoreError::io("read", &path))? else { continue };
            let age = age(used(&key, metadata.modified().unwrap_or(now)));
            found.push(Found { place: Place::File(path), key, bytes: metadata.len(), age });
        }
        let packs = Packs::new(root);
        let all_packs = packs.all();
        for (index, pack) in all_packs.iter().enumerate() {
            let Some(metadata) = there(fs::metadata(&pack.path)).map_err(StoreError::io("read", &pack.path))? else {
                continue;
            };
            let written = metadata.modified().unwrap_or(now);
            for (key, bytes) in &pack.entries {
                found.push(Found { place: Place::Pack(index), key: *key, bytes: *bytes, age: age(used(key, written)) });
            }
        }
        // The longest unused first; of equals the order of their keys.
        found.sort_by(|a, b| b.age.cmp(&a.age).then(a.key.0.cmp(&b.key.0)));
        let mut left: u64 = found.iter().map(|entry| entry.bytes).sum();
        let mut kept: Vec<Vec<Digest>> = all_packs.iter().map(|_| Vec::new()).collect();
        for entry in found {
            let is_kept = matches!(remove, Remove::Unused { keep, .. } if keep.contains(&entry.key));
            let doomed = match remove {
                Remove::All => true,
                Remove::Unused { unused, most, .. } => {
                    !is_kept && (entry.age >= unused || most.is_some_and(|most| left > most))
                }
                Remove::Unreferenced => !journals.contains_key(&entry.key),
            };
            if doomed {
                if let Place::File(path) = &entry.place {
                    discard(path, dry_run)?;
                }
                left -= entry.bytes;
                removed.entries += 1;
                removed.bytes += entry.bytes;
                continue;
            }
            if let Place::Pack(index) = entry.place {
                kept[index].push(entry.key);
            }
            removed.kept += 1;
            removed.kept_bytes += entry.bytes;
            removed.needed += usize::from(is_kept);
            removed.needed_bytes += if is_kept { entry.bytes } else { 0 };
        }
        for (pack, mut kept) in all_packs.into_iter().zip(kept) {
            if kept.is_empty() {
                discard(&pack.path, dry_run)?;
            } else if !dry_run && (pack.has_waste || kept.len() < pack.entries.len()) {
                // In the order in which they were written.
                let order: BTreeMap<Digest, usize> =
                    pack.entries.iter().enumerate().map(|(at, (key, _))| (*key, at)).collect();
                kept.sort_by_key(|key| order.get(key).copied());
                packs.rewrite(&pack.path, &kept)?;
            }
        }
        for path in content.leftovers {
            discard(&path, dry_run)?;
            removed.leftovers += 1;
        }
        Ok(removed)
    }
}

fn discard(path: &Path, dry_run: bool) -> Result<(), StoreError> {
    if dry_run { Ok(()) } else { there(fs::remove_file(path)).map(drop).map_err(StoreError::io("remove", path)) }
}

/// None for what is not there.
fn there<T>(result: io::Result<T>) -> io::Result<Option<T>> {
    match result {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        other => other.map(Some),
    }
}

/// The keys that the journals name, and when a run last used them.
fn journals(root: &Path) -> Result<BTreeMap<Digest, SystemTime>, StoreError> {
    let mut keys = BTreeMap::new();
    for (path, _) in list(&root.join(JOURNALS))? {
        let bytes = match file::read(&path, file::MOST_MANIFEST) {
            // What is not a journal names nothing.
            Err(error) if error.kind() == ErrorKind::InvalidData => continue,
            read => there(read).map_err(StoreError::io("read", &path))?.unwrap_or_default(),
        };
        let journal = Journal::parse(bytes).unwrap_or_default();
        let found = presence::metadata(&path).map_err(StoreError::io("read", &path))?;
        let used = found.and_then(|found| found.modified().ok()).unwrap_or(SystemTime::UNIX_EPOCH);
        for stage in journal.stages() {
            for key in stage.keys.iter().map(|record| record.key).chain(stage.whole) {
                let known = keys.entry(key).or_insert(used);
                *known = used.max(*known);
            }
        }
    }
    Ok(keys)
}

fn content(root: &Path) -> Result<Content, StoreError> {
    let mut content = Content::default();
    let packs = list(&root.join(FOLDER))?;
    let foreign = packs.into_iter().filter(|(path, kind)| !is_leftover(path, *kind) && packs::number(path).is_none());
    content.foreign.extend(foreign.map(|(path, _)| path));
    for folder in [root.to_owned(), root.join(JOURNALS), root.join(FOLDER), root.join(NOTES)] {
        let left = list(&folder)?.into_iter().filter(|(path, kind)| is_leftover(path, *kind));
        content.leftovers.extend(left.map(|(path, _)| path));
    }
    content.add_entries(root).into_iter().next().map_or(Ok(content), |(_, error)| Err(error))
}

fn is_leftover(path: &Path, kind: fs::FileType) -> bool {
    name(path).starts_with(TEMPORARY) && !kind.is_dir()
}

impl Content {
    /// What lies among the entries; the folders that cannot be looked into, and why.
    fn add_entries(&mut self, root: &Path) -> Vec<(PathBuf, StoreError)> {
        let mut unseen = Vec::new();
        let mut look = |folder: &Path| {
            list(folder).unwrap_or_else(|error| {
                unseen.push((folder.to_owned(), error));
                Vec::new()
            })
        };
        for (folder, kind) in look(&root.join(ENTRIES)) {
            let start = name(&folder);
            if is_leftover(&folder, kind) {
                self.leftovers.push(folder);
            } else if !kind.is_dir() || Digest::from_hex(&format!("{start}{:062}", 0)).is_none() {
                self.foreign.push(folder);
            } else {
                for (path, kind) in look(&folder) {
                    match Digest::from_hex(&format!("{start}{}", name(&path))) {
                        _ if is_leftover(&path, kind) => self.leftovers.push(path),
                        Some(key) if kind.is_file() => self.entries.push((path, key)),
                        _ => self.foreign.push(path),
                    }
                }
            }
        }
        unseen
    }
}

/// Whether something among the entries has the name of one, or of a folder of them.
fn is_in_an_entrys_place(path: &Path) -> bool {
    let folder = path.parent().map(name).unwrap_or_default();
    [name(path) + &"0".repeat(62), folder + &name(path)].iter().any(|key| Digest::from_hex(key).is_some())
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// What is in a folder, sorted; nothing where there is no folder.
fn list(folder: &Path) -> Result<Vec<(PathBuf, fs::FileType)>, StoreError> {
    presence::entries(folder).map_err(StoreError::io("read", folder))
}
