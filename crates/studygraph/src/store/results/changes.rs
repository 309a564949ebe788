//! What publishing would write and remove, by what is in the folder and what is to be there.
//!
//! Must not know: how anything is written.

use super::{FileState, Folder, Known, PAGE, complete, here, is_drawn};
use crate::store::manifest::{Machine, Manifest, Program, StageRecord, StudyFolder, TableRecord};

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
        compare(old.as_ref(), &with_earlier_tables(old.as_ref(), manifest.clone()), draws, self)
    }
}

/// Stages without tables of their own take those of the earlier manifest that are still there.
pub(super) fn with_earlier_tables(old: Option<&Known>, mut new: Manifest) -> Manifest {
    let Some(old) = old else { return new };
    for stage in new.stages.iter_mut().filter(|stage| !complete(stage)) {
        let mut stages = old.manifest.stages.iter();
        let earlier = stages.find(|earlier| earlier.name == stage.name && earlier.kind == stage.kind);
        let intact = |table: &TableRecord| old.table_state(table) == FileState::Intact;
        if let Some(earlier) = earlier.filter(|earlier| earlier.tables.iter().all(intact)) {
            let StageRecord { status, why, .. } = std::mem::replace(stage, earlier.clone());
            *stage = StageRecord { status, why, ..stage.clone() };
        }
    }
    new
}

/// What brings a folder from what is known of it to what `new` says; `draws`: with page and figures.
pub(super) fn compare(old: Option<&Known>, new: &Manifest, draws: bool, folder: &Folder) -> Changes {
    let new_tables: Vec<&TableRecord> = new.stages.iter().flat_map(|stage| &stage.tables).collect();
    let old_files = || old.iter().flat_map(|old| &old.manifest.files).map(|record| record.file.clone());
    let old_tables: Vec<&TableRecord> =
        old.iter().flat_map(|old| &old.manifest.stages).flat_map(|stage| &stage.tables).collect();
    let intact = |file: &str| old.is_some_and(|old| old.state(file) == FileState::Intact);
    let intact_table = |table: &TableRecord| {
        old_tables.contains(&table) && old.is_some_and(|old| old.table_state(table) == FileState::Intact)
    };
    let tables: Vec<String> =
        new_tables.iter().filter(|table| !intact_table(table)).map(|table| table.file.clone()).collect();
    let held = |table: &&TableRecord| {
        let known = old_tables.contains(table);
        table.files.iter().filter(|file| !(known && intact(file))).cloned().collect::<Vec<_>>()
    };
    let files: Vec<String> = new_tables.iter().flat_map(held).collect();
    let with_hdf5 = cfg!(feature = "hdf5");
    let hdf5 = with_hdf5 && (new_tables != old_tables || !tables.is_empty() || !intact(&folder.hdf5_file()));
    let listed = |file: &str| {
        let of_table = |table: &&TableRecord| table.file == file || table.files.iter().any(|held| held == file);
        new_tables.iter().any(of_table) || (with_hdf5 && file == folder.hdf5_file()) || is_drawn(file)
    };
    let remove: Vec<String> = old_files().filter(|file| !listed(file) && here(file)).collect();
    let says_something_new = old.is_none_or(|old| essence(&old.manifest) != essence(new));
    let any = says_something_new || hdf5 || !tables.is_empty() || !files.is_empty() || !remove.is_empty();
    let pictures: Vec<String> = old_files().filter(|file| is_drawn(file)).collect();
    let drawn =
        draws && (any || !pictures.iter().any(|file| file == PAGE) || !pictures.iter().all(|file| intact(file)));
    let mut foreign = old.map_or_else(Vec::new, Known::changed);
    foreign.retain(|file| !remove.contains(file) && (draws || !is_drawn(file)));
    Changes { manifest: any || drawn, tables, files, hdf5, drawn, remove, foreign }
}

/// A manifest without what may differ although the results are the same.
pub(super) fn essence(manifest: &Manifest) -> Manifest {
    let mut essence = manifest.clone();
    (essence.program, essence.machine) = (Program::default(), Machine::default());
    essence.study_folder = StudyFolder::default();
    (essence.written, essence.seconds) = (String::new(), 0.0);
    essence.files.clear();
    for stage in &mut essence.stages {
        stage.seconds = 0.0;
        stage.left_out.iter_mut().for_each(|left_out| left_out.saved_seconds = None);
        if complete(stage) {
            stage.status.clear();
            stage.why.clear();
        }
    }
    essence
}
