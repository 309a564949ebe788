//! Page and figures: drawn from what is published, put beside it, and removed when they are no more.
//!
//! Must not know: how anything is drawn.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::fs;
use std::sync::Arc;

use super::publish::{Draw, Drawn, Elsewhere, Listed, Published, Source, is_absent, worse};
use super::{Changes, FIGURES, FileState, Folder, Known, MEASURED, PAGE, here, is_drawn};
use crate::presence;
use crate::store::bundle::is_bundle;
use crate::store::error::StoreError;
use crate::store::facts::Facts;
use crate::store::file;
use crate::store::manifest::{Manifest, TableRecord, own_file};

impl Folder {
    /// Page and figures of a manifest; `elsewhere` may have tables that are not here.
    pub(super) fn drawings(
        &self,
        manifest: &Manifest,
        draw: Draw<'_>,
        elsewhere: Elsewhere<'_>,
    ) -> Result<Vec<Drawn>, String> {
        let fault = RefCell::new(None);
        let records: HashMap<&str, &TableRecord> =
            manifest.stages.iter().flat_map(|stage| &stage.tables).map(|record| (&*record.name, record)).collect();
        let table = |name: &str| {
            let found = match records.get(name) {
                Some(record) => {
                    let is_part = is_bundle(&record.file);
                    let here = if is_part { self.table(record).map(Arc::new) } else { self.shared(record) };
                    here.or_else(|error| elsewhere(record).map(Arc::new).ok_or(error))
                }
                None if is_bundle(name) => self.opened.whole(&own_file(name), || self.whole(&own_file(name))),
                None => return None,
            };
            found.map_err(|error| worse(&mut fault.borrow_mut(), error)).ok()
        };
        let drawn = draw(manifest, &table);
        match (drawn, fault.take()) {
            // A clone has only the tables that git keeps, and a page may be drawn without.
            (Ok(drawn), Some(fault)) if is_absent(&fault) => Ok(drawn),
            // What is wrong with a file says more than that its table is missing. A page that leaves it out would stay.
            (_, Some(fault)) => Err(fault.to_string()),
            (drawn, None) => drawn,
        }
    }

    /// Draws page and figures of the last run again, with the code of this digest; none when there is none. `elsewhere` is
    /// asked for tables that are not here, or of another run.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn redraw(
        &self,
        draw: Draw<'_>,
        code: &str,
        elsewhere: Elsewhere<'_>,
    ) -> Result<Option<Published>, StoreError> {
        if !presence::is_folder(self.path()).map_err(StoreError::io("read", self.path()))? {
            return Ok(None);
        }
        let _lock = self.lock()?;
        let Some(old) = self.known()? else { return Ok(None) };
        let new = Manifest { files: Vec::new(), ..old.manifest.clone() };
        // Before anything is touched: the page that is there may be all that can be had.
        let of_other_run = |file: &str| StoreError::OtherRun { path: self.path().join(file).display().to_string() };
        let other_run = |record: &&TableRecord| old.state(&record.file) == FileState::OtherRun;
        let records = || new.stages.iter().flat_map(|stage| &stage.tables);
        if let Some(bundle) = records().filter(|record| is_bundle(&record.file)).find(other_run) {
            // What many stages share is read as a whole, whose parts nothing else knows.
            return Err(of_other_run(&bundle.file));
        }
        let missed = RefCell::new(None);
        let elsewhere = |record: &TableRecord| {
            let state = old.table_state(record);
            let found = matches!(state, FileState::Absent | FileState::Pointer | FileState::OtherRun)
                .then(|| elsewhere(record))
                .flatten();
            if found.is_none() && state == FileState::OtherRun {
                missed.borrow_mut().get_or_insert_with(|| of_other_run(&record.file));
            }
            found
        };
        let drawn = match self.drawings(&new, draw, &elsewhere) {
            Ok(drawn) => drawn,
            Err(problem) => {
                let problem = missed.take().map_or(problem, |missed: StoreError| missed.to_string());
                let changes = Changes::default();
                let (undrawn, seen) = (Some(problem), Vec::new());
                return Ok(Some(Published { manifest: old.manifest, changes, undrawn, seen }));
            }
        };
        let changes = Changes { manifest: true, drawn: true, ..Changes::default() };
        let nothing = |_: &str, _: &str| Err(StoreError::InUse { path: String::new(), who: String::new() });
        let source = Source { draw: Some(&|_, _| Ok(drawn.clone())), code, ..Source::of(&nothing) };
        self.strike(&old, old.text(), &changes)?;
        self.write(Some(old), new, changes, None::<fn() -> Facts>, source).map(Some)
    }

    /// Draws and writes page and figures, or lists those of before. Gives by whom they were drawn, and why there are none.
    pub(super) fn put_pages(
        &self,
        old: Option<&Known>,
        manifest: &Manifest,
        changes: &mut Changes,
        listed: &mut Listed,
        source: Source<'_>,
    ) -> Result<(String, Option<String>), StoreError> {
        let mut undrawn = None;
        let earlier: Vec<String> =
            old.iter().flat_map(|old| &old.manifest.files).map(|record| record.file.clone()).collect();
        let Some(draw) = source.draw.filter(|_| changes.drawn) else {
            let drawn_by = old.map_or_else(String::new, |old| old.drawn_by().to_owned());
            earlier.iter().filter(|file| is_drawn(file)).for_each(|file| listed.keep(old, file, None));
            self.opened.clear();
            return Ok((drawn_by, None));
        };
        (source.next)(PAGE)?;
        let drawn = self.drawings(manifest, draw, &|_| None);
        // It may have taken long.
        (source.next)(PAGE)?;
        match drawn.and_then(|drawn| self.put_drawn(drawn)) {
            Ok(drawn) => {
                changes.remove.extend(self.former(&earlier, &drawn)?);
                listed.files.extend(drawn.files);
                listed.seen.extend(drawn.seen);
            }
            // Tables are worth more than their picture: they are published without.
            Err(problem) => undrawn = Some(problem),
        }
        self.opened.clear();
        Ok((source.code.to_owned(), undrawn))
    }

    pub(super) fn put_drawn(&self, drawn: Vec<Drawn>) -> Result<Listed, String> {
        let mut listed = Listed::default();
        for Drawn { file, bytes, varies } in drawn {
            let folder = self.path().join(&file);
            let folder = folder.parent().unwrap_or(self.path());
            fs::create_dir_all(folder).map_err(|error| StoreError::io("make", folder)(error).to_string())?;
            self.put(&mut listed, &file, &bytes, varies).map_err(|error| error.to_string())?;
        }
        for folder in [FIGURES, MEASURED] {
            file::sweep(&self.path().join(folder));
        }
        Ok(listed)
    }

    /// Figures that are no more, which would be taken for current ones. Where no page was listed, by an earlier version or
    /// because a run was killed, nobody knows which were ours: what is called a figure is taken for one.
    ///
    /// # Errors
    /// When a folder of figures cannot be read.
    pub(super) fn former(&self, earlier: &[String], drawn: &Listed) -> Result<Vec<String>, StoreError> {
        let new: HashSet<&String> = drawn.files.iter().map(|record| &record.file).collect();
        let is_new = |file: &String| new.contains(file);
        if earlier.iter().any(|file| file == PAGE) {
            return Ok(earlier.iter().filter(|file| is_drawn(file) && here(file) && !is_new(file)).cloned().collect());
        }
        let mut former = Vec::new();
        for folder in [FIGURES, MEASURED] {
            let path = self.path().join(folder);
            let entries = presence::entries(&path).map_err(StoreError::io("read", &path))?;
            let names = entries.iter().filter_map(|(path, _)| Some(path.file_name()?.to_string_lossy()));
            let figures = names
                .filter(|name| name.split_once('.').is_some_and(|(_, ending)| ["svg", "vl.json"].contains(&ending)));
            former.extend(figures.map(|name| format!("{folder}/{name}")).filter(|file| !is_new(file)));
        }
        Ok(former)
    }
}
