//! What publishing would write and remove, by what is in the folder and what is to be there.
//!
//! Must not know: how anything is written.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use super::{FileState, Folder, Known, PAGE, here, is_drawn};
use crate::store::bundle::{self, is_bundle};
use crate::store::manifest::{Manifest, OmissionRecord, StageRecord, TableRecord};

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
    /// Page and figures.
    pub drawn: bool,
    /// Files of tables that are no more.
    pub remove: Vec<String>,
    /// Files that somebody else changed.
    pub foreign: Vec<String>,
}

impl Folder {
    /// What [`Folder::publish`] would do. Reads the manifest, and of the files what has to be read.
    #[must_use]
    pub fn changes(&self, manifest: &Manifest, draws: bool) -> Changes {
        let old = self.known().ok().flatten();
        compare(old.as_ref(), &with_earlier_tables(old.as_ref(), manifest), draws, self)
    }
}

/// Stages without tables of their own take those of the earlier manifest that are still there.
pub(super) fn with_earlier_tables<'m>(old: Option<&Known>, manifest: &'m Manifest) -> Cow<'m, Manifest> {
    let mut new = Cow::Borrowed(manifest);
    if !bundle::is_assigned(manifest) {
        bundle::assign(new.to_mut());
    }
    let Some(old) = old.filter(|_| !manifest.stages.iter().all(StageRecord::is_complete)) else { return new };
    let stages: HashMap<(&str, &str), &StageRecord> =
        old.manifest.stages.iter().map(|stage| ((&*stage.name, &*stage.kind), stage)).collect();
    for (index, stage) in manifest.stages.iter().enumerate().filter(|(_, stage)| !stage.is_complete()) {
        let earlier = stages.get(&(&*stage.name, &*stage.kind)).copied();
        let intact = |table: &TableRecord| old.table_state(table) == FileState::Intact;
        if let Some(earlier) = earlier.filter(|earlier| earlier.tables.iter().all(intact)) {
            let (status, why) = (stage.status.clone(), stage.why.clone());
            new.to_mut().stages[index] = StageRecord { status, why, ..earlier.clone() };
        }
    }
    // Stages that take their tables along may make or unmake a bundle.
    if matches!(new, Cow::Owned(_)) {
        bundle::assign(new.to_mut());
    }
    new
}

/// What brings a folder from what is known of it to what `new` says; `draws`: with page and figures.
pub(super) fn compare(old: Option<&Known>, new: &Manifest, draws: bool, folder: &Folder) -> Changes {
    let new_tables: Vec<&TableRecord> = new.stages.iter().flat_map(|stage| &stage.tables).collect();
    let old_files = || old.iter().flat_map(|old| &old.manifest.files).map(|record| record.file.clone());
    let old_tables: Vec<&TableRecord> =
        old.iter().flat_map(|old| &old.manifest.stages).flat_map(|stage| &stage.tables).collect();
    let by_name: HashMap<&str, &TableRecord> = old_tables.iter().map(|table| (&*table.name, *table)).collect();
    let is_known = |table: &TableRecord| by_name.get(&*table.name).is_some_and(|old| *old == table);
    let intact = |file: &str| old.is_some_and(|old| old.state(file) == FileState::Intact);
    let intact_table =
        |table: &TableRecord| is_known(table) && old.is_some_and(|old| old.table_state(table) == FileState::Intact);
    // A bundle has other rows as well where a stage is no more.
    let mut members: HashMap<&str, isize> = HashMap::new();
    for (tables, step) in [(&old_tables, -1), (&new_tables, 1)] {
        for table in tables.iter().filter(|table| is_bundle(&table.file)) {
            *members.entry(&table.file).or_default() += step;
        }
    }
    let is_whole = |table: &TableRecord| members.get(&*table.file).is_none_or(|more| *more == 0);
    let mut met = HashSet::new();
    let tables: Vec<String> = new_tables
        .iter()
        .filter(|table| !(is_whole(table) && intact_table(table)) && met.insert(&table.file))
        .map(|table| table.file.clone())
        .collect();
    let held = |table: &&TableRecord| {
        let known = is_known(table);
        table.files.iter().filter(|file| !(known && intact(file))).cloned().collect::<Vec<_>>()
    };
    let files: Vec<String> = new_tables.iter().flat_map(held).collect();
    let with_hdf5 = cfg!(feature = "hdf5");
    let hdf5 = with_hdf5 && (new_tables != old_tables || !tables.is_empty() || !intact(&folder.hdf5_file()));
    let of_tables: HashSet<&str> =
        new_tables.iter().flat_map(|table| table.files.iter().chain([&table.file])).map(String::as_str).collect();
    let listed = |file: &str| of_tables.contains(file) || (with_hdf5 && file == folder.hdf5_file()) || is_drawn(file);
    let remove: Vec<String> = old_files().filter(|file| !listed(file) && here(file)).collect();
    let says_something_new = || old.is_none_or(|old| !say_the_same(&old.manifest, new));
    let any = hdf5 || !tables.is_empty() || !files.is_empty() || !remove.is_empty() || says_something_new();
    let pictures: Vec<String> = old_files().filter(|file| is_drawn(file)).collect();
    let drawn =
        draws && (any || !pictures.iter().any(|file| file == PAGE) || !pictures.iter().all(|file| intact(file)));
    let is_moved = old.is_some_and(|old| new.study_folder.names_another_file(&old.manifest.study_folder));
    let mut foreign = old.map_or_else(Vec::new, Known::changed);
    foreign.retain(|file| !remove.contains(file) && (draws || !is_drawn(file)));
    Changes { manifest: any || drawn || is_moved, tables, files, hdf5, drawn, remove, foreign }
}

/// Whether two manifests say the same of the results, whoever computed them, when and where.
pub(super) fn say_the_same(one: &Manifest, other: &Manifest) -> bool {
    essence(one) == essence(other)
        && one.stages.len() == other.stages.len()
        && one.stages.iter().zip(&other.stages).all(|(one, other)| essence_of_stage(one) == essence_of_stage(other))
}

// Every field is named, so that a new one has to be thought of; nothing is copied, since a run with nothing to do comes by.
fn essence(manifest: &Manifest) -> impl PartialEq {
    let Manifest {
        format,
        study,
        title,
        seed,
        source,
        study_digest,
        program: _,
        study_folder: _,
        machine: _,
        written: _,
        seconds: _,
        stages: _,
        tolerances,
        files: _,
        more: _,
    } = manifest;
    (format, study, title, seed, source, study_digest, tolerances)
}

fn essence_of_stage(stage: &StageRecord) -> impl PartialEq {
    let StageRecord { name, kind, version, keys, config, status, why, seconds: _, work, warnings, left_out, tables } =
        stage;
    // What a finished stage did this time is not part of what it gave.
    let ended = (!stage.is_complete()).then_some((status, why));
    let left_out: Vec<_> = left_out.iter().map(|OmissionRecord { what, why, saved_seconds: _ }| (what, why)).collect();
    (name, kind, version, keys, config, ended, work, warnings, left_out, tables)
}
