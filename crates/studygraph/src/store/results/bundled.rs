//! Making a file that holds the tables of many stages, and taking a table out of one.
//!
//! Must not know: which tables those are (`store/bundle.rs` says), the cache, stages.

use std::collections::HashMap;

use super::{FileState, Folder, Known, Source};
use crate::store::bundle::{self, Rows, is_bundle};
use crate::store::error::StoreError;
use crate::store::manifest::TableRecord;
use crate::store::{file, index, parquet};
use crate::table::data::Table;

impl Folder {
    /// All rows of a bundle. What its file, or a table's own, has already is taken from there: of a bundle whose bytes are
    /// those that were written, its rows are what the manifest says.
    pub(super) fn bundle(
        &self,
        old: Option<&Known>,
        members: &[&TableRecord],
        source: Source<'_>,
    ) -> Result<Table, StoreError> {
        let (file, own) = members.first().map_or(("", ""), |record| (record.file.as_str(), record.table()));
        let earlier = old.iter().flat_map(|old| &old.manifest.stages).flat_map(|stage| &stage.tables);
        let earlier: HashMap<&str, &TableRecord> =
            earlier.filter(|table| table.table() == own).map(|table| (table.stage(), table)).collect();
        let whole = old.and_then(|old| self.as_written(old, file));
        let table = |record: &TableRecord, kept: Option<&TableRecord>| {
            let kept = kept.filter(|kept| old.is_some_and(|old| old.state(&kept.file) == FileState::Intact));
            // What is not what it should be is made again.
            kept.and_then(|kept| self.table(kept).ok()).map_or_else(|| source.computed(record), Ok)
        };
        let mut ordered = members.to_vec();
        ordered.sort_by_cached_key(|record| record.stage());
        let mut parts: Vec<Rows> = Vec::new();
        for record in ordered {
            let kept = earlier.get(record.stage()).copied();
            let kept = kept.filter(|kept| (&kept.content, &kept.columns) == (&record.content, &record.columns));
            let rows = kept.filter(|kept| kept.file == file).zip(whole.as_ref());
            let rows = rows.and_then(|(_, whole)| bundle::rows_of(whole, record.stage()));
            match (rows.filter(|rows| rows.len() == record.rows), parts.last_mut()) {
                (Some(rows), Some(Rows::Of(before))) if before.end == rows.start => before.end = rows.end,
                (Some(rows), _) => parts.push(Rows::Of(rows)),
                (None, _) => parts.push(Rows::Own(record.stage(), table(record, kept)?)),
            }
        }
        let whole = whole.filter(|_| parts.iter().any(|part| matches!(part, Rows::Of(_))));
        bundle::together(whole.as_ref(), &parts)
            .map_err(|error| StoreError::Format { table: file.to_owned(), problem: error.to_string() })
    }

    /// What a file holds whose bytes are those that were written, whatever its stamp says.
    fn as_written(&self, old: &Known, file: &str) -> Option<Table> {
        let (_, digest) = old.expected(file).filter(|_| old.state(file) == FileState::Intact)?;
        let bytes = file::read(&self.path().join(file), file::MOST_TABLE).ok()?;
        if index::digest(&bytes) == digest { parquet::read(bytes).ok() } else { None }
    }

    /// A table that had its rows in a bundle and has a file of its own now, of a stage that was not asked for.
    pub(super) fn kept_by_bundle(&self, old: Option<&Known>, record: &TableRecord) -> Option<Table> {
        let old = old?;
        let mut tables = old.manifest.stages.iter().flat_map(|stage| &stage.tables);
        let kept = tables.find(|kept| kept.name == record.name && is_bundle(&kept.file))?;
        let is_same = kept.content == record.content && old.state(&kept.file) == FileState::Intact;
        is_same.then(|| self.table(kept).ok()).flatten()
    }
}
