//! Cleaning the cache up, and reading all of it.
//!
//! Only what is certainly of this program goes: files whose names are keys, and those under temporary names. Whatever
//! else lies there is somebody's; it is named and left alone. Must not know: why an entry is old.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use super::packs::{self, Content as OfPack, FOLDER, Packs};
use super::{Cache, NOTES};
use crate::store::error::StoreError;
use crate::store::file::{self, TEMPORARY};
use crate::store::journal::Journal;
use crate::store::{entry, lock};
use declare::digest::Digest;

/// A run that is just ending, or whose lock lives on for a moment in a process it started, is given a little time.
const ENDING: Duration = Duration::from_millis(200);

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
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Removed {
    pub entries: usize,
    pub bytes: u64,
    pub kept: usize,
    pub kept_bytes: u64,
    /// Files that killed runs were at.
    pub leftovers: usize,
    /// What is none of ours, and stayed.
    pub foreign: Vec<PathBuf>,
}

/// What lies in a cache.
#[derive(Default)]
struct Content {
    entries: Vec<(PathBuf, Digest)>,
    leftovers: Vec<PathBuf>,
    foreign: Vec<PathBuf>,
}

impl Cache {
    /// Reads every byte of every entry; the damaged ones, and folders that cannot be looked into. `remove`: so that a run
    /// with nothing else to do need not read them all to know.
    #[must_use]
    pub fn verify(&self, remove: bool) -> Vec<(PathBuf, String)> {
        let mut content = Content::default();
        let unseen = content.add_entries(&self.root);
        let mut damaged: Vec<(PathBuf, String)> =
            unseen.into_iter().map(|(path, error)| (path, error.to_string())).collect();
        for (path, key) in content.entries {
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
                damaged.push((path, problem));
            }
        }
        for (path, key, problem) in self.packs.checked() {
            if let Some(key) = key.filter(|_| remove) {
                self.packs.forget(key);
            }
            damaged.push((path, problem));
        }
        self.packs.flush();
        damaged
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
    pub fn clean(root: &Path, remove: Remove, dry_run: bool) -> Result<Removed, StoreError> {
        let lock_path = root.join("lock");
        let lock = match fs::metadata(&lock_path) {
            Ok(metadata) if metadata.is_file() => File::open(&lock_path).map_err(StoreError::io("open", &lock_path))?,
            Ok(_) => return Err(StoreError::io("lock", &lock_path)(io::Error::other("it is not a regular file"))),
            // No cache: there is none, or the folder is something else.
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Removed::default()),
            Err(error) => return Err(StoreError::io("open", &lock_path)(error)),
        };
        lock::hold(&lock, &lock_path, false, ENDING)?;
        let referenced = if remove == Remove::Unreferenced { referenced(root)? } else { BTreeSet::new() };
        let now = SystemTime::now();
        let content = content(root)?;
        let mut removed = Removed { foreign: content.foreign, ..Removed::default() };
        for (path, key) in content.entries {
            // Another computer may be cleaning up too.
            let Some(metadata) = there(fs::metadata(&path)).map_err(StoreError::io("read", &path))? else { continue };
            let age = metadata.modified().ok().and_then(|time| now.duration_since(time).ok()).unwrap_or_default();
            let doomed = match remove {
                Remove::All => true,
                Remove::OlderThan(limit) => age >= limit,
                Remove::Unreferenced => !referenced.contains(&key),
            };
            if doomed {
                discard(&path, dry_run)?;
                removed.entries += 1;
                removed.bytes += metadata.len();
            } else {
                removed.kept += 1;
                removed.kept_bytes += metadata.len();
            }
        }
        let packs = Packs::new(root);
        for OfPack { path, entries, has_waste } in packs.all() {
            let Some(metadata) = there(fs::metadata(&path)).map_err(StoreError::io("read", &path))? else { continue };
            let age = metadata.modified().ok().and_then(|time| now.duration_since(time).ok()).unwrap_or_default();
            let doomed = |key: &Digest| match remove {
                Remove::All => true,
                Remove::OlderThan(limit) => age >= limit,
                Remove::Unreferenced => !referenced.contains(key),
            };
            let (gone, kept): (Vec<_>, Vec<_>) = entries.into_iter().partition(|(key, _)| doomed(key));
            let size = |entries: &[(Digest, u64)]| entries.iter().map(|(_, bytes)| bytes).sum::<u64>();
            removed.entries += gone.len();
            removed.kept += kept.len();
            removed.kept_bytes += size(&kept);
            removed.bytes += size(&gone);
            if kept.is_empty() {
                discard(&path, dry_run)?;
            } else if !dry_run && (has_waste || !gone.is_empty()) {
                packs.rewrite(&path, &kept.iter().map(|(key, _)| *key).collect::<Vec<_>>())?;
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

/// The keys that the journals name.
fn referenced(root: &Path) -> Result<BTreeSet<Digest>, StoreError> {
    let mut keys = BTreeSet::new();
    for (path, _) in list(&root.join("journals"))? {
        // What is not a journal names nothing.
        let bytes = file::read(&path, file::MOST_MANIFEST).unwrap_or_default();
        let journal: Journal = serde_json::from_slice(&bytes).unwrap_or_default();
        for stage in journal.stages {
            keys.extend(stage.keys.iter().map(|record| record.key).chain(stage.whole));
        }
    }
    Ok(keys)
}

fn content(root: &Path) -> Result<Content, StoreError> {
    let mut content = Content::default();
    let packs = list(&root.join(FOLDER))?;
    let foreign = packs.into_iter().filter(|(path, kind)| !is_leftover(path, *kind) && packs::number(path).is_none());
    content.foreign.extend(foreign.map(|(path, _)| path));
    for folder in [root.to_owned(), root.join("journals"), root.join(FOLDER), root.join(NOTES)] {
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
        for (folder, kind) in look(&root.join("entries")) {
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

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// What is in a folder, sorted; nothing where there is no folder.
fn list(folder: &Path) -> Result<Vec<(PathBuf, fs::FileType)>, StoreError> {
    let read = || -> io::Result<Vec<_>> {
        fs::read_dir(folder)?.map(|entry| entry.and_then(|entry| Ok((entry.path(), entry.file_type()?)))).collect()
    };
    let mut paths = there(read()).map_err(StoreError::io("read", folder))?.unwrap_or_default();
    paths.sort_by(|(a, _), (b, _)| a.cmp(b));
    Ok(paths)
}
