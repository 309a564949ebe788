//! Tables of a stage that cuts itself: they come in pieces, in the order of their rows, and are passed on piece by piece, as
//! there may be more rows than memory holds.
//!
//! Must not know: what is in a piece.

use std::cmp::Ordering;
use std::sync::Arc;

use super::fault::{Ended, Fault};
use super::key::KeyedChunk;
use super::others::order;
use super::outcome::is_cut;
use super::work::Run;
use crate::store::entry::StoredTable;
use crate::store::error::StoreError;
use crate::table::content::Content;
use crate::table::data::{Cell, Data};
use declare::digest::Digest;

impl Run<'_> {
    /// What is known of a table in pieces, found without holding more than a column of a piece; none where the whole must
    /// be there for it.
    pub(super) fn described(
        &self,
        node: usize,
        parts: &[KeyedChunk],
        name: &str,
    ) -> Result<Option<StoredTable>, Ended> {
        let filled = self.filled(node, name);
        if !is_cut(parts) || filled.len() < 2 {
            return Ok(None);
        }
        let schema = Arc::clone(self.of_part(node, filled[0], parts[filled[0]].key, name)?.shared_schema());
        if schema.columns.iter().any(|column| column.on_demand) {
            return Ok(None);
        }
        let rows = {
            let board = self.board();
            let entries = board.nodes[node].known.iter().filter_map(|known| known.entry.as_ref());
            entries.flat_map(|entry| &entry.tables).filter(|table| table.name == name).map(|table| table.rows).sum()
        };
        let mut content = Content::new(&schema, rows);
        let mut ends: Vec<[Vec<Cell>; 2]> = vec![[Vec::new(), Vec::new()]; filled.len()];
        for (position, column) in schema.columns.iter().enumerate().filter(|(_, column)| !column.volatile) {
            content.begin(column);
            for (index, ends) in filled.iter().zip(&mut ends) {
                let data = self.column_of_part(node, *index, parts[*index].key, (name, position))?;
                if column.key
                    && let Some(last) = data.len().checked_sub(1)
                {
                    ends[0].push(data.cell(0));
                    ends[1].push(data.cell(last));
                }
                content.add(&data);
            }
        }
        let in_order = |pair: &[[Vec<Cell>; 2]]| order(&pair[0][1], &pair[1][0]) == Ordering::Less;
        if schema.key_columns().next().is_some() && !ends.windows(2).all(in_order) {
            let bug = format!("the parts of table `{name}` are not in the order of its rows");
            return Err(Ended::Fault(Fault::Bug(bug)));
        }
        let content = content.finish();
        Ok(Some(StoredTable { name: name.to_owned(), rows, content, base: content, columns: Vec::new(), body: None }))
    }

    fn column_of_part(
        &self,
        node: usize,
        index: usize,
        key: Digest,
        (name, position): (&str, usize),
    ) -> Result<Data, Ended> {
        match self.cache.column(key, name, position) {
            Err(StoreError::Damaged { problem, .. }) => {
                let table = self.repair(node, index, name, problem)?;
                let found = table.columns().get(position).cloned();
                found.ok_or_else(|| Ended::Fault(Fault::Bug(format!("table `{name}` has fewer columns this time"))))
            }
            found => Ok(found?),
        }
    }
}
