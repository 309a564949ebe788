//! Bringing a results folder up to date: tables, HDF5, page, figures, index, manifest, in this order.
//!
//! Only what changed is written, so version control sees no noise. One process publishes at a time, the page too, and
//! whatever is about to be replaced is struck from the manifest first: killed at any moment, a run leaves a manifest that
//! vouches for nothing that may be half new. A stage that did not finish, or was not asked for, keeps the tables of its
//! last success; its status says so. Files that a manifest never listed are not touched. Must not know: the cache, stages,
//! how anything is drawn.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::fs;
use std::io::{BufWriter, ErrorKind, Write};
use std::sync::Arc;

use super::changes::{compare, say_the_same, with_earlier_tables};
use super::{Changes, FileState, Folder, Known, MANIFEST, held_text, here, is_drawn, split};
use crate::presence;
use crate::store::bundle::{self, is_bundle};
use crate::store::error::StoreError;
use crate::store::facts::Facts;
use crate::store::file::{self, Durability};
#[cfg(feature = "hdf5")]
use crate::store::hdf5;
use crate::store::index::{self, Digesting, Index, Seen};
use crate::store::lock;
use crate::store::manifest::{FileRecord, Manifest, StudyFolder, TableRecord};
use crate::store::parquet;
use crate::table::data::Table;

/// Bytes of a manifest that are handed to the system at once.
const BUFFER: usize = 1 << 17;

/// Gives the Parquet file of (stage, table).
pub type Bytes<'a> = &'a dyn Fn(&str, &str) -> Result<Vec<u8>, StoreError>;
/// Gives the table of (stage, table).
pub type TableOf<'a> = &'a dyn Fn(&str, &str) -> Result<Table, StoreError>;
/// The pieces of a table, in the order of its rows.
pub type Pieces<'a> = Box<dyn Iterator<Item = Result<Table, StoreError>> + 'a>;
/// Gives the table of (stage, table) in pieces, where it comes so.
pub type PiecesOf<'a> = &'a dyn Fn(&str, &str) -> Option<Pieces<'a>>;
/// Gives a published table by its name, `stage.table`; of many stages as one, `_kind.table`.
pub type Tables<'a> = &'a dyn Fn(&str) -> Option<Arc<Table>>;
/// Draws page and figures of a manifest and its tables.
pub type Draw<'a> = &'a dyn Fn(&Manifest, Tables<'_>) -> Result<Vec<Drawn>, String>;
/// Gives a table that is not here, or not that of the manifest, from where else it is kept.
pub type Elsewhere<'a> = &'a dyn Fn(&TableRecord) -> Option<Table>;
/// Hears which file is made next, and says whether to go on: all of them can take minutes.
pub type Next<'a> = &'a dyn Fn(&str) -> Result<(), StoreError>;

/// Where what is published comes from.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    pub bytes: Bytes<'a>,
    /// Asked first: tables that need not fit into memory.
    pub pieces: Option<PiecesOf<'a>>,
    /// Gives a table of a bundle; where there is nothing, it is read from its Parquet file.
    pub table: Option<TableOf<'a>>,
    pub draw: Option<Draw<'a>>,
    pub next: Next<'a>,
    /// Asked while somebody else has the folder: whether this run waits on.
    pub waits: Next<'a>,
    /// The digest of the code that draws.
    pub code: &'a str,
}

impl<'a> Source<'a> {
    /// Tables without a page, all in one go.
    #[must_use]
    pub fn of(bytes: Bytes<'a>) -> Self {
        Self { bytes, pieces: None, table: None, draw: None, next: &|_| Ok(()), waits: &|_| Ok(()), code: "" }
    }

    /// The table of a record, as it was computed.
    ///
    /// # Errors
    /// When it cannot be had.
    pub(super) fn computed(&self, record: &TableRecord) -> Result<Table, StoreError> {
        let (stage, name) = split(&record.name);
        match self.table {
            Some(table) => table(stage, name),
            None => parquet::read((self.bytes)(stage, name)?)
                .map_err(|problem| StoreError::Format { table: record.name.clone(), problem }),
        }
    }
}

/// A file that was drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drawn {
    /// [`PAGE`], or something in [`FIGURES`].
    pub file: String,
    pub bytes: Vec<u8>,
    /// Whether it shows what differs from run to run.
    pub varies: bool,
}

/// What publishing did.
#[derive(Clone, Debug, PartialEq)]
pub struct Published {
    /// As it stands in the folder.
    pub manifest: Manifest,
    pub changes: Changes,
    /// Why there is no page; all else is published.
    pub undrawn: Option<String>,
    /// The files as the index has them; none where that had to be written anew.
    pub seen: Vec<Seen>,
}

/// What the new manifest and the new index list.
#[derive(Default)]
pub(super) struct Listed {
    pub(super) files: Vec<FileRecord>,
    pub(super) seen: Vec<Seen>,
}

impl Folder {
    /// Brings the folder up to date. `manifest` comes without files and facts, but for the study's file where the folder must
    /// record it anew; `facts` is asked only when something is written.
    ///
    /// # Errors
    /// When a table cannot be had or a file not be written, or when the source says so; what was there before stays valid.
    pub fn publish<'m>(
        &self,
        manifest: impl Into<Cow<'m, Manifest>>,
        facts: impl FnOnce() -> Facts,
        source: Source<'_>,
    ) -> Result<Published, StoreError> {
        let manifest: Cow<'m, Manifest> = manifest.into();
        let draws = source.draw.is_some();
        let nothing = |old: Known| {
            let seen = if old.is_outdated() { Vec::new() } else { old.index().files.clone() };
            Published { manifest: old.manifest, changes: Changes::default(), undrawn: None, seen }
        };
        let mut before = None;
        if let Some(mut old) = self.known().ok().flatten() {
            old.manifest.share(&manifest);
            let new = with_earlier_tables(Some(&old), &manifest);
            let changes = compare(Some(&old), &new, draws, self);
            if changes == Changes::default() {
                if old.is_outdated() {
                    self.refresh(&old);
                }
                return Ok(nothing(old));
            }
            let new = if let Cow::Owned(new) = new { Some(new) } else { None };
            before = Some((old, new, changes));
        }
        fs::create_dir_all(self.path()).map_err(StoreError::io("make the results folder", self.path()))?;
        let _lock = self.lock_while(source.waits)?;
        // Another run may have published while this one waited; mostly none has, and what was found still holds.
        if let Some((old, new, changes)) = before
            && let Some(text) = old.still()
        {
            self.strike(&old, Some(text), &changes)?;
            return self.write(Some(old), new.unwrap_or_else(|| manifest.into_owned()), changes, Some(facts), source);
        }
        // A damaged manifest is written anew; one that cannot be read at the moment lists files that nobody would know of
        // afterwards.
        let old = match self.known() {
            Err(StoreError::Io { action, path, source }) if source.kind() != ErrorKind::InvalidData => {
                return Err(StoreError::Io { action, path, source });
            }
            Err(kept @ StoreError::NotForHere { .. }) => return Err(kept),
            known => known.ok().flatten().map(|mut known| {
                known.manifest.share(&manifest);
                known
            }),
        };
        let new = with_earlier_tables(old.as_ref(), &manifest);
        let changes = compare(old.as_ref(), &new, draws, self);
        match old {
            Some(old) if changes == Changes::default() => Ok(nothing(old)),
            old => {
                if let Some(old) = &old {
                    self.strike(old, old.text(), &changes)?;
                }
                let new = if let Cow::Owned(new) = new { Some(new) } else { None };
                self.write(old, new.unwrap_or_else(|| manifest.into_owned()), changes, Some(facts), source)
            }
        }
    }

    /// The folder is locked, and what is about to be replaced is struck from the manifest.
    pub(super) fn write(
        &self,
        mut old: Option<Known>,
        mut new: Manifest,
        mut changes: Changes,
        facts: Option<impl FnOnce() -> Facts>,
        source: Source<'_>,
    ) -> Result<Published, StoreError> {
        file::sweep(self.path());
        let mut listed = Listed::default();
        let (tables, files): (HashSet<&String>, HashSet<&String>) =
            (changes.tables.iter().collect(), changes.files.iter().collect());
        let mut bundles: HashMap<&str, Vec<&TableRecord>> = HashMap::new();
        for table in new.stages.iter().flat_map(|stage| &stage.tables).filter(|table| is_bundle(&table.file)) {
            bundles.entry(&table.file).or_default().push(table);
        }
        for (_, table) in bundle::published(&new) {
            if let Some(members) = bundles.get(table.file.as_str()).filter(|_| tables.contains(&table.file)) {
                (source.next)(&table.file)?;
                let all = self.bundle(old.as_ref(), members, source)?;
                self.put(&mut listed, &table.file, &parquet::write(&all)?, table.varies())?;
                self.opened.put(&table.file, all);
            } else if tables.contains(&table.file) {
                let (stage, name) = split(&table.name);
                (source.next)(&table.file)?;
                let kept = self.kept_by_bundle(old.as_ref(), table);
                let pieces = source.pieces.filter(|_| kept.is_none()).and_then(|pieces| pieces(stage, name));
                if let Some(pieces) = pieces {
                    listed.add(self.put_pieces(&table.file, pieces)?, table.varies());
                    continue;
                }
                let bytes = kept.map_or_else(|| (source.bytes)(stage, name), |kept| parquet::write(&kept))?;
                self.put(&mut listed, &table.file, &bytes, table.varies())?;
            } else {
                let is_good = old.as_ref().is_some_and(|old| old.table_state(table) == FileState::Intact);
                listed.keep(old.as_ref(), &table.file, is_good.then(|| table.varies()));
            }
            let wanted: Vec<&String> = table.files.iter().filter(|file| files.contains(file)).collect();
            if let Some(first) = wanted.first() {
                (source.next)(first)?;
                self.put_held(&mut listed, table, &wanted)?;
            }
            let others = table.files.iter().filter(|file| !wanted.contains(file));
            others.for_each(|file| listed.keep(old.as_ref(), file, None));
        }
        let stands = old.as_ref().is_some_and(|old| say_the_same(&old.manifest, &new));
        // Thousands of them are a fifth of what is held, and nobody asks for them from here on.
        let stages = old.as_mut().map(Known::take_stages).filter(|_| stands);
        if changes.hdf5 {
            (source.next)(&self.hdf5_file())?;
            self.put_hdf5(&mut listed, &new)?;
        } else if cfg!(feature = "hdf5") {
            listed.keep(old.as_ref(), &self.hdf5_file(), None);
        }
        new.files.clear();
        new = match (old.as_ref().zip(stages), facts) {
            // Files that were missing are there again, and nothing else is new: the record of who computed it stands.
            (Some((old, stages)), _) => {
                let Manifest { program, study_folder, machine, written, seconds, .. } = &old.manifest;
                let (program, mut study_folder) = (program.clone(), study_folder.clone());
                let (machine, written) = (machine.clone(), written.clone());
                if new.study_folder.names_another_file(&study_folder) {
                    let StudyFolder { file, name, .. } = new.study_folder;
                    study_folder = StudyFolder { file, name, ..study_folder };
                }
                Manifest { program, study_folder, machine, written, seconds: *seconds, stages, ..new }
            }
            (_, Some(facts)) => {
                let Facts { program, study_folder, machine, written } = facts();
                Manifest { program, study_folder, machine, written, ..new }
            }
            (_, None) => new,
        };
        let (drawn_by, undrawn) = self.put_pages(old.as_ref(), &new, &mut changes, &mut listed, source)?;
        self.remove(&changes.remove)?;
        new.files = listed.files;
        self.put_manifest(&new, old.is_some(), drawn_by, listed.seen.clone())?;
        Ok(Published { manifest: new, changes, undrawn, seen: listed.seen })
    }

    /// Writes the index, and then gives its name to the manifest that says that all is as it should be. Its text, which for
    /// thousands of stages is the largest of all that is written, is never in memory as a whole.
    fn put_manifest(
        &self,
        manifest: &Manifest,
        replaces: bool,
        drawn_by: String,
        seen: Vec<Seen>,
    ) -> Result<(), StoreError> {
        let path = self.path().join(MANIFEST);
        // A manifest that replaces another is there whole, or the other one is: what it lists would be nobody's.
        let durability = if replaces { Durability::Synced } else { Durability::Lazy };
        file::write_by(&path, durability, |file| {
            let mut writer = BufWriter::with_capacity(BUFFER, Digesting::new(file));
            let filled = manifest.write(&mut writer).and_then(|()| writer.flush().map_err(serde_json::Error::io));
            filled.map_err(|error| {
                if error.is_io() { StoreError::io("write", &path)(error.into()) } else { unwritten(error) }
            })?;
            Index::new(writer.get_ref().digest(), drawn_by, seen).write(self.path())
        })
    }

    /// Takes whatever is about to be replaced from the list: if this run is killed, the next one must not take a new file
    /// for the old one. `text` is the manifest's, where it has one that is whole.
    pub(super) fn strike(&self, old: &Known, text: Option<Vec<u8>>, changes: &Changes) -> Result<(), StoreError> {
        let written: HashSet<&String> = changes.tables.iter().chain(&changes.files).collect();
        let replaced = |file: &String| {
            written.contains(file) || (changes.hdf5 && *file == self.hdf5_file()) || (changes.drawn && is_drawn(file))
        };
        let earlier = &old.manifest.files;
        let files: Vec<FileRecord> = earlier.iter().filter(|record| !replaced(&record.file)).cloned().collect();
        if files.len() == earlier.len() {
            return Ok(());
        }
        let text = match text.and_then(|text| Manifest::with_other_files(text, &files)) {
            Some(text) => text,
            None => old.manifest.text_with(&files).map_err(unwritten)?,
        };
        file::write(&self.path().join(MANIFEST), &text, Durability::Synced)
    }

    pub(super) fn put(&self, listed: &mut Listed, file: &str, bytes: &[u8], varies: bool) -> Result<(), StoreError> {
        let path = self.path().join(file);
        file::write(&path, bytes, Durability::Lazy)?;
        listed.add(index::written(&path, file, bytes)?, varies);
        Ok(())
    }

    /// Writes files whose lines a table holds; its own file is there.
    fn put_held(&self, listed: &mut Listed, record: &TableRecord, wanted: &[&String]) -> Result<(), StoreError> {
        let table = self.table(record)?;
        for file in wanted.iter().filter(|file| here(file)) {
            let text = held_text(&table, file).ok_or_else(|| {
                let problem = "it holds no files".to_owned();
                StoreError::Format { table: record.name.clone(), problem }
            })?;
            self.put(listed, file, text.as_bytes(), record.varies())?;
        }
        Ok(())
    }

    #[cfg(feature = "hdf5")]
    fn put_hdf5(&self, listed: &mut Listed, manifest: &Manifest) -> Result<(), StoreError> {
        let name = self.hdf5_file();
        // Its bytes depend on the version of libhdf5 as well.
        let put = |bytes: &[u8]| self.put(listed, &name, bytes, true);
        hdf5_bytes(&name, manifest, &|record| self.shared(record), put)?
    }

    #[cfg(not(feature = "hdf5"))]
    #[allow(clippy::unused_self, clippy::unnecessary_wraps)] // the same shape with and without the feature
    fn put_hdf5(&self, _listed: &mut Listed, _manifest: &Manifest) -> Result<(), StoreError> {
        Ok(())
    }

    /// Notes what had to be read. Without it all is read again next time, so a folder that cannot be written is not a
    /// fault, and nobody who publishes is waited for.
    fn refresh(&self, known: &Known) {
        if presence::exists(&self.path().join(lock::NAME)).unwrap_or(true) {
            return;
        }
        let Ok(_lock) = self.lock() else { return };
        if self.known().ok().flatten().is_none_or(|now| now.digest != known.digest) {
            return;
        }
        let mut listed = Listed::default();
        known.manifest.files.iter().for_each(|record| listed.keep(Some(known), &record.file, Some(record.varies)));
        let _ = Index::new(known.digest.clone(), known.drawn_by().to_owned(), listed.seen).write(self.path());
    }
}

impl Listed {
    /// Lists a file that was written.
    pub(super) fn add(&mut self, seen: Seen, varies: bool) {
        let (bytes, digest) = (Some(seen.bytes).filter(|_| !varies), Some(seen.digest.clone()).filter(|_| !varies));
        self.files.push(FileRecord { file: seen.file.clone(), bytes, digest, varies });
        self.seen.push(seen);
    }

    /// Lists a file that nobody writes now, as [`Known::kept`].
    pub(super) fn keep(&mut self, old: Option<&Known>, file: &str, values: Option<bool>) {
        let Some((record, seen)) = old.and_then(|old| old.kept(file, values)) else { return };
        self.files.push(record);
        self.seen.extend(seen);
    }
}

pub(super) fn is_absent(fault: &StoreError) -> bool {
    matches!(fault, StoreError::Io { source, .. } if source.kind() == ErrorKind::NotFound)
}

/// Keeps the first fault; that a file is not there gives way to any other.
pub(super) fn worse(fault: &mut Option<StoreError>, other: StoreError) {
    if fault.as_ref().is_none_or(is_absent) {
        *fault = Some(other);
    }
}

/// Hands on the HDF5 file of all tables, but for those of files, which lie beside it already, and long ones, of which it says so.
/// `table` gives what is published for a record: of a bundle all of it.
///
/// # Errors
/// When a table cannot be had, or holds what HDF5 cannot.
#[cfg(feature = "hdf5")]
pub fn hdf5_bytes<T>(
    name: &str,
    manifest: &Manifest,
    table: &dyn Fn(&TableRecord) -> Result<Arc<Table>, StoreError>,
    take: impl FnOnce(&[u8]) -> T,
) -> Result<T, StoreError> {
    let mut writer = hdf5::Writer::new(name)?;
    for (group, record) in bundle::published(manifest).filter(|(_, record)| record.files.is_empty()) {
        if bundle::is_long(record.rows) {
            writer.leave_out(group, record)?;
            continue;
        }
        writer.add(group, &*table(record)?)?;
    }
    writer.finish(take)
}

#[allow(clippy::needless_pass_by_value)] // for `map_err`
fn unwritten(error: serde_json::Error) -> StoreError {
    StoreError::Format { table: MANIFEST.to_owned(), problem: error.to_string() }
}
