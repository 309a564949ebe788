//! Making a file that holds the tables of many stages, and taking a table out of one.
//!
//! Must not know: which tables those are (`store/bundle.rs` says), the cache, stages.

use std::collections::HashMap;

use super::{FileState, Folder, Known, Source, split};
use crate::store::bundle::{self, is_bundle};
use crate::store::error::StoreError;
use crate::store::manifest::TableRecord;
use crate::store::parquet;
use crate::table::data::Table;

impl Folder {
    /// The file of a bundle. What its file, or a table's own, has already is taken from there.
    pub(super) fn bundle(
        &self,
        old: Option<&Known>,
        members: &[&TableRecord],
        source: Source<'_>,
    ) -> Result<Vec<u8>, StoreError> {
        let earlier: HashMap<&str, &TableRecord> = old
            .iter()
            .flat_map(|old| &old.manifest.stages)
            .flat_map(|stage| &stage.tables)
            .map(|table| (&*table.name, table))
            .collect();
        let table = |record: &&'_ TableRecord| {
            let (stage, name) = split(&record.name);
            let kept = earlier.get(&*record.name).filter(|kept| {
                (&kept.content, &kept.columns) == (&record.content, &record.columns)
                    && old.is_some_and(|old| old.state(&kept.file) == FileState::Intact)
            });
            // What is not what it should be is made again.
            let kept = kept.and_then(|kept| self.table(kept).ok());
            match (kept, source.table) {
                (Some(table), _) => Ok(table),
                (None, Some(table)) => table(stage, name),
                (None, None) => parquet::read((source.bytes)(stage, name)?)
                    .map_err(|problem| StoreError::Format { table: record.name.clone(), problem }),
            }
        };
        let parts = members.iter().map(|record| Ok((record.stage(), table(record)?)));
        let parts = parts.collect::<Result<Vec<_>, StoreError>>()?;
        let whole = bundle::together(parts).map_err(|error| {
            let table = members.first().map_or_else(String::new, |record| record.file.clone());
            StoreError::Format { table, problem: error.to_string() }
        })?;
        parquet::write(&whole)
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
