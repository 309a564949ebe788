//! The packs of a cache: which entry lies where, and a group of new ones that is written through at once.
//!
//! A run appends to a pack of its own, `packs/<number>.pack`, made with the next number; what a later segment or a pack of a
//! larger number says of a key counts. Entries wait in memory for their group, [`GROUP`] at most and the time that the disk
//! takes: so long a finished stage can be lost. What the disk does not take stays in memory. Must not know: keys, stages.

use std::collections::{HashMap, HashSet};
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::pack::{Ending, MAGIC, Pack, Place, Said, Small};
use crate::presence;
use crate::store::entry::CacheEntry;
use crate::store::error::StoreError;
use crate::store::file;
use crate::table::data::Table;
use declare::digest::Digest;

pub(super) const FOLDER: &str = "packs";
/// How long an entry waits for others.
const GROUP: Duration = Duration::from_millis(100);

#[derive(Clone)]
enum Found {
    At { pack: usize, place: Place },
    Waiting(Arc<Small>),
    Gone,
}

struct Open {
    path: PathBuf,
    file: File,
    pack: Pack,
    ending: Ending,
    /// How often it says something of a key.
    said: usize,
}

/// What of a pack counts.
pub(super) struct Content {
    pub(super) path: PathBuf,
    /// Keys, and bytes of their entries.
    pub(super) entries: Vec<(Digest, u64)>,
    /// Whether it holds anything else: entries that were written again, an end that is cut short.
    pub(super) has_waste: bool,
}

#[derive(Default)]
struct State {
    /// Whether it is known what lies in the folder.
    is_read: bool,
    packs: Vec<Open>,
    found: HashMap<Digest, Found>,
    /// The pack of this run.
    own: Option<usize>,
    waiting: Vec<Arc<Small>>,
    gone: Vec<Digest>,
    /// What the disk did not take.
    unkept: HashSet<Digest>,
    closing: bool,
}

/// The packs of one cache.
pub(super) struct Packs {
    folder: PathBuf,
    state: Mutex<State>,
    /// Held while a segment is written.
    writing: Mutex<()>,
    news: Condvar,
    /// Hears why something could not be written.
    problem: Mutex<Option<String>>,
}

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Packs {
    pub(super) fn new(root: &Path) -> Self {
        let (state, writing, news, problem) = (Mutex::default(), Mutex::default(), Condvar::new(), Mutex::default());
        Self { folder: root.join(FOLDER), state, writing, news, problem }
    }

    /// The state, with what is on the disk.
    fn read(&self) -> MutexGuard<'_, State> {
        let mut state = held(&self.state);
        if !state.is_read {
            state.is_read = true;
            // A folder that cannot be read is one without packs: what is in it is computed again.
            for (_, path) in numbered(&self.folder).unwrap_or_default() {
                state.add(path);
            }
        }
        state
    }

    /// What is known about a key, and where; nothing when it is not in a pack.
    pub(super) fn look_up(&self, key: Digest) -> Option<Result<CacheEntry, String>> {
        let state = self.read();
        match state.found.get(&key)? {
            Found::Gone => None,
            Found::Waiting(small) => Some(Ok(small.entry.clone())),
            Found::At { pack, place } => {
                let Open { file, pack, .. } = &state.packs[*pack];
                Some(pack.entry(file, place, key))
            }
        }
    }

    /// A table; nothing when the key is not in a pack. An error comes with the pack.
    pub(super) fn table(&self, key: Digest, name: &str) -> Option<Result<Option<Table>, (PathBuf, String)>> {
        let state = self.read();
        let found = match state.found.get(&key)? {
            Found::Gone => return None,
            Found::Waiting(small) => {
                let small = Arc::clone(small);
                drop(state);
                small.table(name).map_err(|problem| (self.folder.clone(), problem))
            }
            Found::At { pack, place } => {
                let Open { file, pack, path, .. } = &state.packs[*pack];
                pack.table(file, place, name).map_err(|problem| (path.clone(), problem))
            }
        };
        Some(found)
    }

    /// The pack that an entry lies in.
    pub(super) fn path(&self, key: Digest) -> Option<PathBuf> {
        let state = self.read();
        match state.found.get(&key)? {
            Found::At { pack, .. } => Some(state.packs[*pack].path.clone()),
            _ => None,
        }
    }

    /// Whether every byte of an entry is what was written.
    pub(super) fn is_sound(&self, key: Digest) -> bool {
        let state = self.read();
        match state.found.get(&key) {
            None | Some(Found::Gone) => false,
            Some(Found::Waiting(_)) => true,
            Some(Found::At { pack, place }) => {
                let Open { file, pack, .. } = &state.packs[*pack];
                pack.small(file, place, key).is_ok()
            }
        }
    }

    pub(super) fn is_unkept(&self, key: Digest) -> bool {
        held(&self.state).unkept.contains(&key)
    }

    /// Keeps an entry with the next group.
    pub(super) fn put(&self, small: Small) {
        let small = Arc::new(small);
        let mut state = self.read();
        state.found.insert(small.entry.key, Found::Waiting(Arc::clone(&small)));
        state.waiting.push(small);
        drop(state);
        self.news.notify_one();
    }

    /// Notes that an entry is damaged.
    pub(super) fn forget(&self, key: Digest) {
        let mut state = self.read();
        if let Some(Found::At { .. }) = state.found.get(&key) {
            state.found.insert(key, Found::Gone);
            state.gone.push(key);
        }
    }

    /// Why something was not written, the first time.
    pub(super) fn take_problem(&self) -> Option<String> {
        held(&self.problem).take()
    }

    /// Writes through what waits.
    pub(super) fn flush(&self) {
        let _one = held(&self.writing);
        let mut state = held(&self.state);
        if state.waiting.is_empty() && state.gone.is_empty() {
            return;
        }
        let (waiting, gone) = (std::mem::take(&mut state.waiting), std::mem::take(&mut state.gone));
        let written = self.write(state, &waiting, &gone);
        if let Err(error) = written {
            held(&self.problem).get_or_insert_with(|| error.to_string());
            let mut state = held(&self.state);
            // What a write left behind is cut off by whoever reads it; nothing comes after it.
            state.own = None;
            state.unkept.extend(waiting.iter().map(|small| small.entry.key));
        }
    }

    fn write(
        &self,
        mut state: MutexGuard<'_, State>,
        waiting: &[Arc<Small>],
        gone: &[Digest],
    ) -> Result<(), StoreError> {
        let own = match state.own {
            Some(own) => own,
            None => {
                let open = self.begin()?;
                state.packs.push(open);
                let own = state.packs.len() - 1;
                *state.own.insert(own)
            }
        };
        let mut places = Vec::new();
        let Open { file, pack, path, .. } = &mut state.packs[own];
        let segment = pack.segment(waiting, gone, |key, said| {
            if let Said::Entry(place) = said {
                places.push((key, place));
            }
        })?;
        let path = path.clone();
        let mut file = file.try_clone().map_err(StoreError::io("write", &path))?;
        drop(state);
        file.write_all(&segment).and_then(|()| file.sync_data()).map_err(StoreError::io("write", &path))?;
        let mut state = held(&self.state);
        for ((key, place), written) in places.into_iter().zip(waiting) {
            // What was put again meanwhile is newer.
            if matches!(state.found.get(&key), Some(Found::Waiting(small)) if Arc::ptr_eq(small, written)) {
                state.found.insert(key, Found::At { pack: own, place });
            }
        }
        Ok(())
    }

    /// A new pack with the next number.
    fn begin(&self) -> Result<Open, StoreError> {
        fs::create_dir_all(&self.folder).map_err(StoreError::io("make the cache folder", &self.folder))?;
        let mut number =
            numbered(&self.folder).ok().and_then(|packs| packs.last().map(|(number, _)| *number)).unwrap_or(0);
        let mut options = File::options();
        options.read(true).append(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o644);
        loop {
            number += 1;
            let path = self.folder.join(format!("{number:08}.pack"));
            match options.open(&path) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                opened => {
                    let mut file = opened.map_err(StoreError::io("write", &path))?;
                    file.write_all(MAGIC).map_err(StoreError::io("write", &path))?;
                    let pack = Pack::begun();
                    return Ok(Open { path, file, pack, ending: Ending::Whole, said: 0 });
                }
            }
        }
    }

    /// Writes groups through, until [`Packs::close`].
    pub(super) fn keep_writing(self: &Arc<Self>) -> io::Result<JoinHandle<()>> {
        let packs = Arc::clone(self);
        thread::Builder::new().name("packs".to_owned()).spawn(move || {
            loop {
                let state = held(&packs.state);
                let idle = |state: &mut State| state.waiting.is_empty() && !state.closing;
                let state = packs.news.wait_while(state, idle).unwrap_or_else(PoisonError::into_inner);
                let (state, _) = packs
                    .news
                    .wait_timeout_while(state, GROUP, |state| !state.closing)
                    .unwrap_or_else(PoisonError::into_inner);
                let closing = state.closing;
                drop(state);
                packs.flush();
                if closing {
                    return;
                }
            }
        })
    }

    pub(super) fn close(&self) {
        held(&self.state).closing = true;
        self.news.notify_all();
    }

    /// Every entry with where it lies and what is wrong with it; packs that are damaged themselves come without a key.
    pub(super) fn checked(&self) -> Vec<(PathBuf, Option<Digest>, String)> {
        let state = self.read();
        let mut damaged = Vec::new();
        for (key, found) in &state.found {
            let Found::At { pack, place } = found else { continue };
            let Open { file, pack, path, .. } = &state.packs[*pack];
            if let Err(problem) = pack.small(file, place, *key) {
                damaged.push((path.clone(), Some(*key), problem));
            }
        }
        damaged.sort();
        let broken = state.packs.iter().filter(|open| open.ending == Ending::Damaged);
        let told = "what follows its first bytes is not what was written; `gearstudy gc` writes it anew without";
        damaged.extend(broken.map(|open| (open.path.clone(), None, told.to_owned())));
        damaged
    }

    /// The packs, and what of their entries counts.
    pub(super) fn all(&self) -> Vec<Content> {
        let state = self.read();
        let empty = |open: &Open| Content { path: open.path.clone(), entries: Vec::new(), has_waste: false };
        let mut packs: Vec<Content> = state.packs.iter().map(empty).collect();
        for (key, found) in &state.found {
            if let Found::At { pack, place } = found {
                packs[*pack].entries.push((*key, place.bytes()));
            }
        }
        for (content, open) in packs.iter_mut().zip(&state.packs) {
            content.entries.sort_unstable();
            content.has_waste = open.ending != Ending::Whole || open.said > content.entries.len();
        }
        packs
    }

    /// Writes a pack anew with these entries alone; nobody else may have the cache open.
    ///
    /// # Errors
    /// When it cannot be written; it is as it was.
    pub(super) fn rewrite(&self, path: &Path, kept: &[Digest]) -> Result<(), StoreError> {
        let state = self.read();
        let mut pack = Pack::begun();
        let mut bytes = MAGIC.to_vec();
        // What is damaged is left out.
        let sound = |key: &Digest| match state.found.get(key)? {
            Found::At { pack, place } => {
                let Open { file, pack, .. } = &state.packs[*pack];
                pack.small(file, place, *key).ok().map(Arc::new)
            }
            _ => None,
        };
        let entries: Vec<Arc<Small>> = kept.iter().filter_map(sound).collect();
        bytes.extend(pack.segment(&entries, &[], |_, _| ())?);
        file::write(path, &bytes, file::Durability::Synced)
    }
}

impl State {
    fn add(&mut self, path: PathBuf) {
        // What cannot be opened, or is no file, holds nothing.
        if !presence::is_file(&path).unwrap_or(false) {
            return;
        }
        let Ok(mut file) = File::open(&path) else { return };
        let number = self.packs.len();
        let (found, mut count) = (&mut self.found, 0);
        let read = Pack::read(&mut file, |key, said| {
            count += 1;
            found.insert(
                key,
                match said {
                    Said::Entry(place) => Found::At { pack: number, place },
                    Said::Gone => Found::Gone,
                },
            );
        });
        let (pack, ending) = read.unwrap_or((Pack::default(), Ending::Damaged));
        self.packs.push(Open { path, file, pack, ending, said: count });
    }
}

/// The packs in a folder by their numbers, ascending.
///
/// # Errors
/// When the folder cannot be read; none is one without packs.
pub(super) fn numbered(folder: &Path) -> io::Result<Vec<(u64, PathBuf)>> {
    let entries = presence::entries(folder)?.into_iter().map(|(path, _)| path);
    let mut packs: Vec<(u64, PathBuf)> = entries.filter_map(|path| Some((number(&path)?, path))).collect();
    packs.sort();
    Ok(packs)
}

/// None for what is not called as a pack is.
pub(super) fn number(path: &Path) -> Option<u64> {
    let name = path.file_name()?.to_str()?.strip_suffix(".pack")?;
    (name.len() >= 8 && name.bytes().all(|byte| byte.is_ascii_digit())).then(|| name.parse().ok()).flatten()
}
