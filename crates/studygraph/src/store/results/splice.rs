//! Bringing a results folder up to date for a run that had to do with a few of its stages: the records of all others, their
//! rows and their numbers stay where they are.
//!
//! Only where all files are known to be as the last run left them, and where the same tables of the same columns come of the
//! same stages. Then every file has the bytes that a run of all stages would give it. Whatever else there is to do is left to
//! such a run, and nothing was touched. Must not know: the cache, how anything is drawn, who says that files are as they were.

use std::collections::HashMap;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use super::publish::{Listed, unwritten};
use super::{Changes, Folder, Known, MANIFEST, Published, Source, is_drawn};
use crate::store::bundle::{self, Rows, is_bundle};
use crate::store::error::StoreError;
use crate::store::facts::Facts;
use crate::store::file::{self, Durability};
#[cfg(feature = "hdf5")]
use crate::store::hdf5;
use crate::store::manifest::{Cut, Manifest, More, StageRecord, TableRecord, shown_places};
use crate::store::parquet;
use crate::table::data::{Table, TableError};

/// What a run of some stages comes to.
pub struct Part<'a> {
    /// As of a run of these stages alone.
    pub manifest: Manifest,
    /// How many stages there are in all.
    pub stages: usize,
    /// The kind of stage that says what a page shows.
    pub reader: &'a str,
    /// Asked when the folder is locked: whether all files are as the last run left them.
    pub is_as_before: &'a dyn Fn() -> bool,
}

/// What came of publishing a part.
pub enum Spliced {
    Published(Box<Published>),
    /// All must be written: with what the folder says of all stages, where it is as the last run left it.
    Refused(Option<Box<Manifest>>),
}

/// A file of tables before and after.
struct Change {
    /// The first that changed, and the group that HDF5 has its tables in.
    record: TableRecord,
    group: String,
    old: Arc<Table>,
    new: Table,
}

impl Folder {
    /// Brings the folder up to date.
    ///
    /// # Errors
    /// As [`Folder::publish`].
    pub fn publish_part(
        &self,
        part: Part<'_>,
        facts: impl FnOnce() -> Facts,
        source: Source<'_>,
    ) -> Result<Spliced, StoreError> {
        let _lock = self.lock_while(source.waits)?;
        if !(part.is_as_before)() {
            return Ok(Spliced::Refused(None));
        }
        let published = self.splice(part, facts, source)?;
        Ok(published.map_or_else(
            || Spliced::Refused(self.manifest().map(Box::new)),
            |published| Spliced::Published(Box::new(published)),
        ))
    }

    /// The folder is locked. None where all must be written, and nothing was touched.
    fn splice(
        &self,
        part: Part<'_>,
        facts: impl FnOnce() -> Facts,
        source: Source<'_>,
    ) -> Result<Option<Published>, StoreError> {
        let path = self.path().join(MANIFEST);
        let text = file::read(&path, file::MOST_MANIFEST).map_err(StoreError::io("read", &path))?;
        let Some(cut) = Cut::of(&text).filter(|cut| cut.len() == part.stages) else { return Ok(None) };
        let Some((own, new)) = placed(&cut, part.manifest) else { return Ok(None) };
        let Ok(old) = cut.read(own.iter().copied()) else { return Ok(None) };
        let Some(new) = taking_over(&old, new).filter(|_| cut.says(&old, &own)) else { return Ok(None) };
        let old = Known::as_indexed(self.clone(), old);
        let tables = self.to_be_written(&old.manifest, &new, source)?;
        let needs_hdf5 = cfg!(feature = "hdf5") && !tables.is_empty();
        let hdf5 = if needs_hdf5 { self.hdf5_with(&tables) } else { None };
        if needs_hdf5 && hdf5.is_none() {
            return Ok(None);
        }
        let mut changes = Changes {
            manifest: true,
            tables: tables.iter().map(|change| change.record.file.clone()).collect(),
            hdf5: hdf5.is_some(),
            drawn: source.draw.is_some(),
            ..Changes::default()
        };
        // What is about to be replaced is struck from the manifest; from here on files are touched.
        let text = match self.left_by(&old, &changes) {
            None => text,
            Some(files) => {
                let Some(text) = Manifest::with_other_files(text, &files) else { return Ok(None) };
                file::write(&path, &text, Durability::Synced)?;
                text
            }
        };
        let cut = Cut::of(&text).ok_or_else(|| damaged(&path))?;
        file::sweep(self.path());
        let mut listed = self.put_changed(&old, tables, hdf5.as_deref(), source)?;
        let Facts { program, study_folder, machine, written } = facts();
        let new = Manifest { program, study_folder, machine, written, files: Vec::new(), ..new };
        let shown = shown(&cut, &own, &new, part.reader).map_err(unwritten)?;
        let (drawn_by, undrawn) = self.put_pages(Some(&old), &shown, &mut changes, &mut listed, source)?;
        let new = Manifest { files: listed.files, ..new };
        self.remove(&changes.remove)?;
        let text = cut.text_with(&new, &own).map_err(unwritten)?.ok_or_else(|| damaged(&path))?;
        let seen = listed.seen.clone();
        self.put_manifest(|writer| writer.write_all(&text).map_err(serde_json::Error::io), true, drawn_by, seen)?;
        Ok(Some(Published { manifest: Manifest { more: shown.more, ..new }, changes, undrawn, seen: listed.seen }))
    }

    /// The files of tables that are not what they were.
    fn to_be_written(&self, old: &Manifest, new: &Manifest, source: Source<'_>) -> Result<Vec<Change>, StoreError> {
        let both = old.stages.iter().zip(&new.stages).flat_map(|(old, new)| old.tables.iter().zip(&new.tables));
        let mut of_file: Vec<(&TableRecord, Vec<&TableRecord>)> = Vec::new();
        for (old, new) in both.filter(|(old, new)| old != new) {
            match of_file.iter_mut().find(|(known, _)| known.file == new.file) {
                Some((_, members)) => members.push(new),
                None => of_file.push((old, vec![new])),
            }
        }
        let mut changes = Vec::new();
        for (old, members) in of_file {
            (source.next)(&old.file)?;
            let record = members[0].clone();
            let group = record.file.split('.').next().unwrap_or_default().to_owned();
            let before = self.shared(old)?;
            let new = if is_bundle(&record.file) {
                let own = members.iter().map(|record| Ok((record.stage(), source.computed(record)?)));
                with_rows(&before, own.collect::<Result<Vec<_>, StoreError>>()?)
                    .map_err(|error| StoreError::Format { table: record.file.clone(), problem: error.to_string() })?
            } else {
                source.computed(&record)?
            };
            changes.push(Change { record, group, old: before, new });
        }
        Ok(changes)
    }

    /// The HDF5 file with what changed; none where it must be made anew.
    #[cfg(feature = "hdf5")]
    fn hdf5_with(&self, tables: &[Change]) -> Option<Vec<u8>> {
        let changed = |change: &'_ Change| (change.group.clone(), change.record.table().to_owned());
        let tables = tables.iter().map(|change| (changed(change), &*change.old, &change.new));
        hdf5::patched(&self.path().join(self.hdf5_file()), tables)
    }

    #[cfg(not(feature = "hdf5"))]
    #[allow(clippy::unused_self)] // the same shape with and without the feature
    fn hdf5_with(&self, _tables: &[Change]) -> Option<Vec<u8>> {
        None
    }

    /// Writes what changed; lists what did not as it was, in the same order.
    fn put_changed(
        &self,
        old: &Known,
        tables: Vec<Change>,
        hdf5: Option<&[u8]>,
        source: Source<'_>,
    ) -> Result<Listed, StoreError> {
        let mut listed = Listed::default();
        let mut tables: HashMap<String, Change> =
            tables.into_iter().map(|change| (change.record.file.clone(), change)).collect();
        let files = old.manifest.files.iter().map(|record| &record.file).filter(|file| !is_drawn(file));
        for file in files {
            match (tables.remove(file), hdf5) {
                (Some(Change { record, new, .. }), _) if is_bundle(file) => {
                    self.put(&mut listed, file, &parquet::write(&new)?, record.varies())?;
                    self.opened.put(file, new);
                }
                (Some(Change { record, .. }), _) => {
                    let bytes = (source.bytes)(record.stage(), record.table())?;
                    self.put(&mut listed, file, &bytes, record.varies())?;
                    self.opened.forget(file);
                }
                (None, Some(bytes)) if *file == self.hdf5_file() => {
                    (source.next)(file)?;
                    self.put(&mut listed, file, bytes, true)?;
                }
                (None, _) => listed.keep(Some(old), file, None),
            }
        }
        Ok(listed)
    }
}

/// What was as it should be a moment ago.
fn damaged(path: &Path) -> StoreError {
    StoreError::Damaged { path: path.display().to_string(), problem: "its stages are others than they were".to_owned() }
}

/// A manifest's stages in the order of a whole one, and their places there; none where one is not there.
fn placed(cut: &Cut, mut part: Manifest) -> Option<(Vec<usize>, Manifest)> {
    let by_name: HashMap<&[u8], usize> = cut.names().zip(0..).collect();
    let place = |stage: StageRecord| by_name.get(stage.name.as_bytes()).map(|&place| (place, stage));
    let mut stages: Vec<(usize, StageRecord)> = part.stages.drain(..).map(place).collect::<Option<_>>()?;
    stages.sort_by_key(|(place, _)| *place);
    let (own, stages) = stages.into_iter().unzip();
    Some((own, Manifest { stages, ..part }))
}

/// What a run of some stages came to, its tables in the files that theirs are in. None where other tables come of a stage, or other files, or too many rows.
fn taking_over(old: &Manifest, mut new: Manifest) -> Option<Manifest> {
    for (old, new) in old.stages.iter().zip(&mut new.stages) {
        if old.kind != new.kind || !old.is_complete() {
            return None;
        }
        if !new.is_complete() {
            // The tables of its last success stay.
            let (status, why) = (new.status.clone(), new.why.clone());
            *new = StageRecord { status, why, ..old.clone() };
            continue;
        }
        if old.tables.len() != new.tables.len() {
            return None;
        }
        for (old, new) in old.tables.iter().zip(&mut new.tables) {
            let is_alike = old.name == new.name && old.description == new.description && old.columns == new.columns;
            let is_plain = new.files.is_empty() && !bundle::is_long(old.rows.max(new.rows));
            if !is_alike || old.files != new.files || bundle::fits(old) != bundle::fits(new) {
                return None;
            }
            new.file.clone_from(&old.file);
            if old != new && !is_plain {
                return None;
            }
        }
    }
    Some(new)
}

/// A bundle with other rows of some stages.
fn with_rows(bundle: &Table, mut own: Vec<(&str, Table)>) -> Result<Table, TableError> {
    own.sort_by_key(|(stage, _)| *stage);
    let (mut parts, mut from) = (Vec::new(), 0);
    for (stage, table) in own {
        let rows = bundle::rows_of(bundle, stage).unwrap_or_default();
        parts.push(Rows::Of(from..rows.start));
        parts.push(Rows::Own(stage, table));
        from = rows.end;
    }
    parts.push(Rows::Of(from..bundle.rows()));
    bundle::together(Some(bundle), &parts)
}

/// What a page shows of all stages, those in these places being as they are now.
fn shown(cut: &Cut, own: &[usize], new: &Manifest, reader: &str) -> Result<Manifest, serde_json::Error> {
    let kinds: Vec<&str> = cut.kinds().collect();
    let mut by_kind = shown_places(&kinds, reader).into_iter().peekable();
    let (mut places, mut more) = (Vec::new(), More::default());
    for ((place, kind), (warns, omissions)) in kinds.iter().enumerate().zip(cut.told()) {
        let own = own.binary_search(&place).ok().map(|at| &new.stages[at]);
        if by_kind.next_if_eq(&place).is_some() || own.map_or(warns, StageRecord::is_told) {
            places.push(place);
        } else {
            more.add(kind, own.map_or(omissions, |stage| stage.left_out.len()));
        }
    }
    let mut stages = cut.read(places.iter().copied())?.stages;
    for (stage, place) in stages.iter_mut().zip(places) {
        match own.binary_search(&place) {
            Ok(at) => stage.clone_from(&new.stages[at]),
            Err(_) => *stage = stage.clone().unchanged(),
        }
    }
    Ok(Manifest { stages, more, ..new.without_stages() })
}
