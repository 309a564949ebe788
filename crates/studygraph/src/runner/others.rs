//! What a part of a stage that cuts itself may read: the other parts of the run, and those of the last success.
//!
//! Must not know: what is in a part.

use std::sync::{Arc, Mutex, PoisonError};

use super::key::KeyedChunk;
use super::work::{Ended, Run};
use crate::stage::Others;
use crate::table::data::Table;
use declare::digest::Digest;
use declare::error::Failure;

/// The other parts of one.
pub(super) struct OfStage<'r, 'a> {
    run: &'r Run<'a>,
    node: usize,
    parts: &'r [KeyedChunk],
    /// Keys of parts of the last success whose rows are the same functions of their values.
    earlier: Vec<Digest>,
    /// Why another part could not be read.
    ended: Mutex<Option<Ended>>,
}

impl<'r, 'a> OfStage<'r, 'a> {
    pub(super) fn new(run: &'r Run<'a>, node: usize, parts: &'r [KeyedChunk]) -> Self {
        let board = run.board();
        let last = board.journal.stage(&board.study.nodes[node].name);
        let earlier = match (parts.first(), last) {
            (Some(now), Some(last)) if now.axis().is_some() => {
                let alike = last.keys.iter().filter(|key| {
                    let now = &now.record;
                    (&key.config, &key.code, &key.seed, &key.demand) == (&now.config, &now.code, &now.seed, &now.demand)
                        && key.inputs == now.inputs
                });
                alike.filter_map(|key| Digest::from_hex(&key.key)).collect()
            }
            _ => Vec::new(),
        };
        Self { run, node, parts, earlier, ended: Mutex::default() }
    }

    /// Why another part could not be read.
    pub(super) fn ended(&self) -> Option<Ended> {
        self.ended.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

impl Others for OfStage<'_, '_> {
    fn of_part(&self, part: usize, table: &str) -> Result<Arc<Table>, Failure> {
        self.run.of_part(self.node, part, self.parts[part].key, table).map_err(|ended| {
            self.ended.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(ended);
            Failure::Stopped
        })
    }

    fn earlier(&self) -> usize {
        // A stage that is forced is computed, whatever is known.
        if self.run.options.force.applies(&self.run.board().study.nodes[self.node].name) {
            0
        } else {
            self.earlier.len()
        }
    }

    fn of_earlier(&self, index: usize, table: &str) -> Option<Arc<Table>> {
        // What is gone or damaged is computed.
        self.run.cache.table(*self.earlier.get(index)?, table).ok().map(Arc::new)
    }
}
