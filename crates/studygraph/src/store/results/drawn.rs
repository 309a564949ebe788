//! Page and figures: drawn from what is published, put beside it, and removed when they are no more.
//!
//! Must not know: how anything is drawn.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::fs;
use std::sync::Arc;

use super::publish::{Draw, Drawn, Listed, Source, is_absent, worse};
use super::{Changes, FIGURES, Folder, Known, MEASURED, PAGE, here, is_drawn};
use crate::store::bundle::is_bundle;
use crate::store::error::StoreError;
use crate::store::file;
use crate::store::manifest::{Manifest, TableRecord, own_file};

impl Folder {
    pub(super) fn drawings(&self, manifest: &Manifest, draw: Draw<'_>) -> Result<Vec<Drawn>, String> {
        let fault = RefCell::new(None);
        let records: HashMap<&str, &TableRecord> =
            manifest.stages.iter().flat_map(|stage| &stage.tables).map(|record| (&*record.name, record)).collect();
        let table = |name: &str| {
            let found = match records.get(name) {
                Some(record) if is_bundle(&record.file) => self.table(record).map(Arc::new),
                Some(record) => self.shared(record),
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
        let drawn = self.drawings(manifest, draw);
        // It may have taken long.
        (source.next)(PAGE)?;
        match drawn.and_then(|drawn| self.put_drawn(drawn)) {
            Ok(drawn) => {
                changes.remove.extend(self.former(&earlier, &drawn));
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
    pub(super) fn former(&self, earlier: &[String], drawn: &Listed) -> Vec<String> {
        let new: HashSet<&String> = drawn.files.iter().map(|record| &record.file).collect();
        let is_new = |file: &String| new.contains(file);
        if earlier.iter().any(|file| file == PAGE) {
            return earlier.iter().filter(|file| is_drawn(file) && here(file) && !is_new(file)).cloned().collect();
        }
        let figures = |folder: &str| -> Vec<String> {
            let entries = fs::read_dir(self.path().join(folder)).into_iter().flatten().flatten();
            let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
            let figures = names
                .filter(|name| name.split_once('.').is_some_and(|(_, ending)| ["svg", "vl.json"].contains(&ending)));
            figures.map(|name| format!("{folder}/{name}")).collect()
        };
        [FIGURES, MEASURED].into_iter().flat_map(figures).filter(|file| !is_new(file)).collect()
    }
}
