//! Which files of a results folder are as its manifest lists them.
//!
//! A file whose stamp is as noted in the index is not read; any other one is, once. Must not know: what is done about it.

use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::sync::{Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;

use super::{Folder, MANIFEST, here};
use crate::presence;
use crate::store::file;
use crate::store::index::{self, Index, Seen};
use crate::store::manifest::{FileRecord, Manifest, StageRecord, TableRecord};
use crate::threads;

/// What became of a published file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileState {
    /// Byte for byte as it was written.
    Intact,
    Absent,
    /// There, with other bytes than were written; or no file at all.
    Changed,
    /// Whole, but a file of another run: git exchanges the manifest on a checkout and leaves files that it does not keep,
    /// and the index describes them as they were written.
    OtherRun,
    /// A pointer of Git LFS is in its place.
    Pointer,
    /// The system does not let it be read.
    Unreadable,
    /// There, and listed, but nobody knows its digest: the manifest is of an earlier version, or the index is lost.
    Unknown,
    /// There, and not listed.
    Unlisted,
}

/// A manifest and what is known of its files.
pub struct Known {
    pub manifest: Manifest,
    folder: Folder,
    /// Of the manifest as it was written.
    pub(super) digest: String,
    index: Index,
    /// Places in the manifest's list of files, and in the index.
    records: HashMap<String, usize>,
    noted: HashMap<String, usize>,
    /// Of each table's file: which stage, which of its tables.
    tables: HashMap<String, (usize, usize)>,
    /// Whether the digests in the index are those of this manifest.
    belongs: bool,
    /// Stamps tell something of files that were not touched since this moment; none when they tell nothing.
    moment: Option<i64>,
    /// What was asked: every file belongs to several questions.
    states: Mutex<BTreeMap<String, FileState>>,
    /// What had to be read.
    looked: Mutex<BTreeMap<String, Option<Seen>>>,
    /// Tables without a digest whose values were read: whether they are those of the manifest.
    values: Mutex<BTreeMap<String, bool>>,
}

impl Known {
    pub(super) fn new(folder: Folder, manifest: Manifest, bytes: &[u8]) -> Self {
        let (index, moment) = Index::read(folder.path()).unwrap_or_default();
        let digest = index::manifest_digest(bytes);
        let belongs = index.manifest == digest;
        let moment = index.is_of_this_boot().then_some(moment);
        let (states, looked, values) = (Mutex::default(), Mutex::default(), Mutex::default());
        let places = |names: &mut dyn Iterator<Item = &String>| -> HashMap<String, usize> {
            names.enumerate().map(|(place, name)| (name.clone(), place)).collect()
        };
        let records = places(&mut manifest.files.iter().map(|record| &record.file));
        let noted = places(&mut index.files.iter().map(|seen| &seen.file));
        // Tables that share a file are alike in what is asked of one.
        let mut tables = HashMap::new();
        for (stage, record) in manifest.stages.iter().enumerate() {
            for (table, own) in record.tables.iter().enumerate() {
                if !tables.contains_key(&own.file) {
                    tables.insert(own.file.clone(), (stage, table));
                }
            }
        }
        Self { manifest, folder, digest, index, records, noted, tables, belongs, moment, states, looked, values }
    }

    /// The manifest's text, where it and the index are still what was read.
    pub(super) fn still(&self) -> Option<Vec<u8>> {
        let text = self.text()?;
        let index = Index::read(self.folder.path()).map(|(index, _)| index).unwrap_or_default();
        (index == self.index).then_some(text)
    }

    /// The manifest's text, where that is still what was read.
    pub(super) fn text(&self) -> Option<Vec<u8>> {
        let text = file::read(&self.folder.path().join(MANIFEST), file::MOST_MANIFEST).ok()?;
        (index::manifest_digest(&text) == self.digest).then_some(text)
    }

    /// The stages of the manifest, which are no longer known here.
    pub(super) fn take_stages(&mut self) -> Vec<StageRecord> {
        self.tables.clear();
        std::mem::take(&mut self.manifest.stages)
    }

    /// A file as it was last looked at.
    fn noted(&self, file: &str) -> Option<&Seen> {
        self.noted.get(file).map(|&place| &self.index.files[place])
    }

    /// The same, but every file is going to be read.
    #[must_use]
    pub fn without_stamps(self) -> Self {
        Self { moment: None, states: Mutex::default(), ..self }
    }

    /// What the index says; empty where there is none.
    #[must_use]
    pub fn index(&self) -> &Index {
        &self.index
    }

    /// Digest of the sources of the program that drew page and figures; empty where that is not known.
    #[must_use]
    pub fn drawn_by(&self) -> &str {
        &self.index.drawn_by
    }

    /// Whether the index does not say what it should.
    pub(super) fn is_outdated(&self) -> bool {
        !self.belongs || !held(&self.looked).is_empty()
    }

    /// Size and digest that a file should have.
    #[must_use]
    pub fn expected(&self, file: &str) -> Option<(u64, &str)> {
        let record = self.record(file)?;
        if record.varies {
            let seen = self.noted(file).filter(|_| self.belongs)?;
            return Some((seen.bytes, &seen.digest));
        }
        Some((record.bytes?, record.digest.as_deref()?))
    }

    #[must_use]
    pub fn state(&self, file: &str) -> FileState {
        if let Some(state) = held(&self.states).get(file) {
            return *state;
        }
        let state = match self.look(file) {
            FileState::Changed | FileState::Unknown if self.is_pointer(file) => FileState::Pointer,
            state => state,
        };
        held(&self.states).insert(file.to_owned(), state);
        state
    }

    fn look(&self, file: &str) -> FileState {
        let path = self.folder.path().join(file);
        let metadata = match presence::metadata(&path) {
            Ok(Some(metadata)) => metadata,
            // A link that leads nowhere is something, but not what was written.
            Ok(None) => match presence::link_metadata(&path) {
                Ok(None) => return FileState::Absent,
                Ok(Some(_)) => return FileState::Changed,
                Err(_) => return FileState::Unreadable,
            },
            Err(_) => return FileState::Unreadable,
        };
        let Some(record) = self.record(file) else { return FileState::Unlisted };
        if !metadata.is_file() || !here(file) {
            return FileState::Changed;
        }
        let noted = self.noted(file).filter(|noted| noted.bytes == metadata.len());
        let expected = match self.expected(file) {
            Some((bytes, digest)) if bytes == metadata.len() => Some(digest),
            Some(_) => None,
            None if record.varies && !self.belongs && noted.is_some() => None,
            None => return FileState::Unknown,
        };
        if expected.is_none() && noted.is_none() {
            return FileState::Changed;
        }
        let Some(seen) = self.seen(file) else { return FileState::Unreadable };
        if expected.is_some_and(|digest| seen.digest == digest) {
            FileState::Intact
        } else if noted.is_some_and(|noted| noted.digest == seen.digest) {
            FileState::OtherRun
        } else if self.expected(file).is_none() {
            FileState::Unknown
        } else {
            FileState::Changed
        }
    }

    fn is_pointer(&self, file: &str) -> bool {
        // What is longer, or cannot be read, is no pointer.
        let bytes = file::read(&self.folder.path().join(file), file::MOST_POINTER);
        bytes.is_ok_and(|bytes| file::is_pointer(&bytes))
    }

    /// The same for a table: where no digest is known, its values tell.
    #[must_use]
    pub fn table_state(&self, record: &TableRecord) -> FileState {
        let state = self.state(&record.file);
        let varies = || self.record(&record.file).is_some_and(|listed| listed.varies);
        if state != FileState::Unknown && !(state == FileState::OtherRun && varies()) {
            return state;
        }
        let known = held(&self.values).get(&record.name).copied();
        let good = known.unwrap_or_else(|| self.folder.table(record).is_ok());
        held(&self.values).insert(record.name.clone(), good);
        match state {
            _ if good => FileState::Intact,
            FileState::OtherRun => state,
            _ => FileState::Changed,
        }
    }

    /// Whether a changed file differs in its line ends alone: git made them others when it checked the file out.
    #[must_use]
    pub fn has_other_line_ends(&self, file: &str) -> bool {
        let Some((_, digest)) = self.expected(file).filter(|_| self.state(file) == FileState::Changed) else {
            return false;
        };
        let bytes = file::read(&self.folder.path().join(file), file::MOST_TABLE);
        bytes.is_ok_and(|bytes| index::differ_in_line_ends(&bytes, digest))
    }

    /// Listed files that are there, but not as they were written, whatever they are.
    #[must_use]
    pub fn changed(&self) -> Vec<String> {
        let files = self.manifest.files.iter();
        files.filter(|record| self.is_changed(record)).map(|record| record.file.clone()).collect()
    }

    /// The same, with all threads: for many bytes.
    #[must_use]
    pub fn changed_in_parallel(&self) -> Vec<String> {
        threads::with_all(|| {
            let files = self.manifest.files.par_iter();
            files.filter(|record| self.is_changed(record)).map(|record| record.file.clone()).collect()
        })
    }

    fn is_changed(&self, record: &FileRecord) -> bool {
        let table = self.tables.get(&record.file).map(|&(stage, table)| &self.manifest.stages[stage].tables[table]);
        let state = table.map_or_else(|| self.state(&record.file), |table| self.table_state(table));
        matches!(state, FileState::Changed | FileState::Unreadable)
    }

    /// A file as a new manifest and a new index list it when nobody writes it. `values`: whether it varies, of a table
    /// whose values were found good without a digest.
    pub(super) fn kept(&self, file: &str, values: Option<bool>) -> Option<(FileRecord, Option<Seen>)> {
        let record = self.record(file)?.clone();
        match (self.state(file), values) {
            (FileState::Intact, _) => Some((record, self.seen(file))),
            // It is described as it lies there, by which it is known still.
            (FileState::OtherRun, _) if !record.varies => Some((record, self.seen(file))),
            (FileState::Unknown | FileState::OtherRun, Some(varies)) => {
                let seen = self.seen(file)?;
                let (bytes, digest) = if varies { (None, None) } else { (Some(seen.bytes), Some(seen.digest.clone())) };
                Some((FileRecord { bytes, digest, varies, ..record }, Some(seen)))
            }
            // What it should be is known still.
            _ => Some((record, self.noted(file).filter(|_| self.belongs).cloned())),
        }
    }

    fn record(&self, file: &str) -> Option<&FileRecord> {
        self.records.get(file).map(|&place| &self.manifest.files[place])
    }

    /// What a file is now; from the index where its stamp is as noted.
    fn seen(&self, file: &str) -> Option<Seen> {
        let path = self.folder.path().join(file);
        if let (Some(moment), Some(noted)) = (self.moment, self.noted(file))
            && let (Some(stamp), Ok(metadata)) = (noted.stamp, fs::metadata(&path))
            && stamp.is_before(moment)
            && (stamp, noted.bytes) == (index::Stamp::of(&metadata), metadata.len())
        {
            return Some(noted.clone());
        }
        if let Some(known) = held(&self.looked).get(file) {
            return known.clone();
        }
        let seen = index::look(&path, file).ok();
        held(&self.looked).insert(file.to_owned(), seen.clone());
        seen
    }
}

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
