//! What a part of a stage that cuts itself may read: the other parts of the run, and those of the last success.
//!
//! Must not know: what is in a part.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::board::Board;
use super::fault::Ended;
use super::key::Cut;
use super::options::Options;
use crate::stage::Others;
use crate::store::cache::Cache;
use crate::table::data::{Cell, Table};
use declare::digest::Digest;
use declare::error::Failure;

/// Reads a table of a part.
type Reads<'r> = &'r (dyn Fn(usize, &str) -> Result<Arc<Table>, Ended> + Sync);

/// The other parts of one.
pub(super) struct OfStage<'r> {
    node: usize,
    cache: &'r Cache,
    spans: &'r Mutex<Spans>,
    of_part: Reads<'r>,
    /// As [`earlier`].
    earlier: Vec<Digest>,
    /// Why another part could not be read.
    ended: Mutex<Option<Ended>>,
}

/// Keys of parts of the last success of a stage whose rows are the same functions of their values.
pub(super) fn earlier(board: &Board, options: &Options, node: usize) -> Vec<Digest> {
    // A stage that is forced is computed, whatever is known.
    let is_forced = options.force.applies(&board.study.nodes[node].name);
    match (board.nodes[node].parts.first(), board.last(node)) {
        (Some(now), Some(last)) if matches!(now.cut, Cut::Part { .. }) && !is_forced => {
            let alike = last.keys.iter().filter(|key| {
                let now = &now.record;
                (&key.config, &key.code, &key.seed, &key.demand) == (&now.config, &now.code, &now.seed, &now.demand)
                    && key.inputs == now.inputs
            });
            alike.map(|record| record.key).collect()
        }
        _ => Vec::new(),
    }
}

impl<'r> OfStage<'r> {
    pub(super) fn new(
        node: usize,
        earlier: Vec<Digest>,
        (cache, spans): (&'r Cache, &'r Mutex<Spans>),
        of_part: Reads<'r>,
    ) -> Self {
        Self { node, cache, spans, of_part, earlier, ended: Mutex::default() }
    }

    /// Why another part could not be read.
    pub(super) fn ended(&self) -> Option<Ended> {
        self.ended.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

impl Others for OfStage<'_> {
    fn of_part(&self, part: usize, table: &str) -> Result<Arc<Table>, Failure> {
        (self.of_part)(part, table).map_err(|ended| {
            self.ended.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(ended);
            Failure::Stopped
        })
    }

    fn earlier(&self, table: &str, first: &[Cell], last: &[Cell]) -> Vec<Arc<Table>> {
        let known = self.spans(table);
        let meets = |span: &&Span| !before(&span.last, first) && !before(last, &span.first);
        // What is gone or damaged is computed.
        known.iter().filter(meets).filter_map(|span| self.cache.table(span.key, table).ok().map(Arc::new)).collect()
    }
}

/// By node and table, what its parts hold.
pub(super) type Spans = BTreeMap<(usize, String), Arc<Vec<Span>>>;

/// A table of a part, and the keys of its first and its last row.
pub(super) struct Span {
    key: Digest,
    first: Vec<Cell>,
    last: Vec<Cell>,
}

impl OfStage<'_> {
    /// Those of the last success, in the order of their rows. They are looked at once in a run, and not held.
    fn spans(&self, table: &str) -> Arc<Vec<Span>> {
        let mut all = self.spans.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = all.get(&(self.node, table.to_owned())) {
            return Arc::clone(known);
        }
        let mut found: Vec<Span> =
            self.earlier.iter().filter_map(|key| span(*key, &self.cache.table(*key, table).ok()?)).collect();
        found.sort_by(|one, two| order(&one.first, &two.first));
        let found = Arc::new(found);
        all.insert((self.node, table.to_owned()), Arc::clone(&found));
        found
    }
}

fn span(key: Digest, table: &Table) -> Option<Span> {
    let columns: Vec<usize> = table.schema().key_columns().collect();
    let of = |row: usize| columns.iter().map(|column| table.columns()[*column].cell(row)).collect();
    let last = table.rows().checked_sub(1)?;
    Some(Span { key, first: of(0), last: of(last) })
}

fn before(one: &[Cell], two: &[Cell]) -> bool {
    order(one, two).is_lt()
}

/// As tables sort their rows.
pub(super) fn order(one: &[Cell], two: &[Cell]) -> Ordering {
    let cells = one.iter().zip(two).map(|(one, two)| match (one, two) {
        (Cell::Float(one), Cell::Float(two)) => one.total_cmp(two),
        (Cell::Integer(one), Cell::Integer(two)) => one.cmp(two),
        (Cell::Text(one), Cell::Text(two)) => one.cmp(two),
        (Cell::Flag(one), Cell::Flag(two)) => one.cmp(two),
        _ => Ordering::Equal,
    });
    cells.fold(Ordering::Equal, Ordering::then)
}
