//! Computing one part of a stage: its inputs, the call, what is kept of it.
//!
//! Inputs come from memory while somebody else has them, else from the cache; a table found damaged there is computed
//! again on the spot. Must not know: which part is next.

use std::any::Any;
use std::collections::{BTreeMap, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use super::board::{Board, Known};
use super::events::{Event, Observer};
use super::fault::{Ended, Fault};
use super::key::{Cut, KeyedChunk, Why};
use super::options::Options;
use super::others::{OfStage, Spans, earlier};
use super::outcome::{filled, together};
use crate::stage::{Context, Demand, Inputs, Kind, Stage};
use crate::store::cache::Cache;
use crate::store::entry::{OfRun, part};
use crate::store::error::StoreError;
use crate::table::data::Table;
use crate::table::schema::{Column, Schema};
use crate::warning::{self, Warning};
use declare::digest::Digest;
use declare::error::Failure;
use declare::record::Record;
use declare::seed::Seed;
use declare::work::Tally;

/// Tables by node and name.
pub(super) type Loaded = BTreeMap<usize, BTreeMap<String, Arc<Table>>>;

pub(super) struct Run<'a> {
    pub(super) cache: &'a Cache,
    pub(super) options: &'a Options,
    pub(super) observer: &'a dyn Observer,
    pub(super) stop: &'a AtomicBool,
    /// Locked only for moments, and before `loaded`.
    pub(super) board: Mutex<Board<'a>>,
    pub(super) loaded: Mutex<Loaded>,
    /// By node and part, 0 to 1.
    pub(super) shares: Mutex<BTreeMap<(usize, usize), f64>>,
    pub(super) turns: Mutex<Turns>,
    /// By node and table, what parts of the last success hold.
    pub(super) spans: Mutex<Spans>,
}

/// Who is at work, and who waits until nobody is.
#[derive(Default)]
pub(super) struct Turns {
    pub(super) running: usize,
    /// Stages that run alone, in the order in which they became ready.
    pub(super) waiting: VecDeque<usize>,
}

impl<'a> Run<'a> {
    pub(super) fn board(&self) -> MutexGuard<'_, Board<'a>> {
        self.board.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn loaded(&self) -> MutexGuard<'_, Loaded> {
        self.loaded.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Run<'_> {
    /// A table of a part that was just computed.
    pub(super) fn fresh(&self, node: usize, index: usize, name: &str) -> Option<Arc<Table>> {
        self.board().nodes[node].known[index].tables.iter().find(|table| table.name() == name).cloned()
    }

    /// A table of a part, which is known.
    pub(super) fn of_part(&self, node: usize, index: usize, key: Digest, name: &str) -> Result<Arc<Table>, Ended> {
        if let Some(table) = self.fresh(node, index, name) {
            return Ok(table);
        }
        match self.cache.table(key, name) {
            Ok(table) => Ok(Arc::new(table)),
            Err(StoreError::Damaged { problem, .. }) => self.repair(node, index, name, problem),
            Err(other) => Err(other.into()),
        }
    }

    /// The parts of a stage that have rows of a table, all parts being known.
    pub(super) fn filled(&self, node: usize, name: &str) -> Vec<usize> {
        let board = self.board();
        let rows = board.nodes[node].known.iter().map(|known| {
            let stored = known.entry.iter().flat_map(|entry| &entry.tables).find(|table| table.name == name);
            // Who has no entry is asked for the table.
            stored.map_or(1, |table| table.rows)
        });
        filled(rows)
    }

    /// A table of a stage, all chunks together.
    pub(super) fn whole(&self, node: usize, parts: &[KeyedChunk], name: &str) -> Result<Arc<Table>, Ended> {
        let mut tables = Vec::new();
        for index in self.filled(node, name) {
            tables.push(self.of_part(node, index, parts[index].key, name)?);
        }
        if let [table] = &tables[..] {
            return Ok(Arc::clone(table));
        }
        let tables = tables.into_iter().map(Arc::unwrap_or_clone).collect();
        Ok(Arc::new(together(name, tables)?))
    }

    /// Computes a part again whose header was sound but not the table.
    pub(super) fn repair(&self, node: usize, index: usize, name: &str, problem: String) -> Result<Arc<Table>, Ended> {
        let known = self.compute(node, index)?;
        let table = known.tables.iter().find(|table| table.name() == name).cloned();
        let key = self.board().nodes[node].parts[index].key;
        let table = match table {
            Some(table) => Some(table),
            // It was not kept in memory.
            None => self.cache.table(key, name).ok().map(Arc::new),
        };
        let mut board = self.board();
        board.nodes[node].why.push(Why::ObjectDamaged(problem));
        board.nodes[node].ran += 1;
        board.nodes[node].known[index].entry = known.entry;
        table.ok_or_else(|| Ended::Fault(Fault::Bug(format!("it gave no table `{name}` this time"))))
    }

    /// A table that some stage reads.
    fn input(&self, node: usize, name: &str) -> Result<Arc<Table>, Ended> {
        if let Some(table) = self.loaded().get(&node).and_then(|tables| tables.get(name)) {
            return Ok(Arc::clone(table));
        }
        let parts = Arc::clone(&self.board().nodes[node].parts);
        let table = self.whole(node, &parts, name)?;
        self.loaded().entry(node).or_default().insert(name.to_owned(), Arc::clone(&table));
        Ok(table)
    }

    /// Tells how much of a stage is computed, all its parts together.
    fn progressed(&self, node: usize, index: usize, share: f64) {
        let (study, parts) = {
            let board = self.board();
            (board.study, board.nodes[node].missing.len())
        };
        let mut shares = self.shares.lock().unwrap_or_else(PoisonError::into_inner);
        shares.insert((node, index), if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) });
        let sum: f64 = shares.range((node, 0)..=(node, usize::MAX)).map(|(_, share)| share).sum();
        let share = sum / parts.max(1) as f64;
        self.observer.event(&Event::Progressed { stage: &study.nodes[node].name, share });
    }

    /// Computes a part and keeps it in the cache.
    pub(super) fn compute(&self, node: usize, index: usize) -> Result<Known, Ended> {
        let (study, parts, demand, outputs, inputs) = {
            let board = self.board();
            let graph = &board.graph;
            (
                board.study,
                Arc::clone(&board.nodes[node].parts),
                graph.demands[node].clone(),
                graph.outputs[node].clone(),
                graph.inputs[node].clone(),
            )
        };
        let (of_study, part) = (&study.nodes[node], &parts[index]);
        let mut ports = Vec::new();
        for input in &inputs {
            let mut tables = Vec::new();
            for want in &input.wants {
                tables.push(seen(self.input(input.node, &want.table)?, &want.columns)?);
            }
            ports.push((input.port.clone(), tables));
        }
        let ports = ports.iter().map(|(port, tables)| (port.clone(), tables.iter().map(Arc::as_ref).collect()));
        let inputs = Inputs { ports: ports.collect() };
        let name = of_study.name.as_str();
        let warnings = Mutex::new(Vec::new());
        let work = Tally::default();
        let context = Context {
            seed: if of_study.stage.uses_seed() { Seed::of_stage(study.seed, name) } else { Seed::of_stage(0, "") },
            demand: &demand,
            stop: self.stop,
            progress: &|share| {
                self.progressed(node, index, if share > NEARLY { NEARLY } else { share });
            },
            warn: &|message| {
                // Cases are told when all are known.
                if let Warning::Alone(message) = &message {
                    self.observer.event(&Event::Warned { stage: name, message });
                }
                warnings.lock().unwrap_or_else(PoisonError::into_inner).push(message);
            },
            is_heard: true,
            work: &work,
        };
        let began = Instant::now();
        let of_part = |part: usize, table: &str| self.of_part(node, part, parts[part].key, table);
        let others =
            OfStage::new(node, earlier(&self.board(), self.options, node), (self.cache, &self.spans), &of_part);
        let result = catch_unwind(AssertUnwindSafe(|| match &part.cut {
            Cut::Whole => of_study.stage.run(&context, &inputs),
            Cut::Axis(field, values) => {
                built(of_study.kind, &of_study.record.with_axis(field, values))?.run(&context, &inputs)
            }
            Cut::Part { index, .. } => of_study.stage.run_part(*index, &context, &inputs, &others),
        }));
        if let Some(ended) = others.ended() {
            return Err(ended);
        }
        let tables = match result {
            Ok(Ok(tables)) => tables,
            Ok(Err(Failure::Failed(message))) => return Err(Ended::Fault(Fault::Failed(message))),
            Ok(Err(Failure::Study(wrong))) => return Err(Ended::Fault(Fault::Study(wrong))),
            Ok(Err(Failure::Stopped)) => return Err(Ended::GivenUp),
            Err(panic) => return Err(Ended::Fault(Fault::Bug(message(&*panic)))),
        };
        let seconds = began.elapsed().as_secs_f64();
        self.progressed(node, index, 1.0);
        let tables = demanded(&outputs, &demand, tables)?;
        // Warnings of parallel loops come in any order.
        let warnings = warning::gathered(warnings.into_inner().unwrap_or_else(PoisonError::into_inner));
        let of_run = OfRun { seconds, work: work.total().named(), warnings };
        let entry = self.cache.put(part.key, &tables.iter().collect::<Vec<_>>(), of_run)?;
        // Of a stage that cuts itself there may be more rows than memory holds.
        let kept = if matches!(part.cut, Cut::Part { .. }) { Vec::new() } else { tables };
        Ok(Known { entry: Some(entry), tables: kept.into_iter().map(Arc::new).collect() })
    }
}

/// The most that a stage says of itself: whether it is computed is seen when it has come back.
const NEARLY: f64 = 0.99;

fn built(kind: &Kind, record: &Record) -> Result<Box<dyn Stage>, Failure> {
    (kind.build)(record).map_err(|wrong| Failure::new(wrong.first.message))
}

/// A table without the columns on demand that its reader did not ask for: its key says nothing of them.
pub(super) fn seen(table: Arc<Table>, wanted: &[String]) -> Result<Arc<Table>, StoreError> {
    let keep = |column: &Column| !column.on_demand || wanted.contains(&column.name);
    if table.schema().columns.iter().all(keep) { Ok(table) } else { Ok(Arc::new(part(&table, keep)?)) }
}

/// The demanded tables in the order of the stage, each with the demanded columns; more than that is dropped.
pub(super) fn demanded(outputs: &[Schema], demand: &Demand, mut tables: Vec<Table>) -> Result<Vec<Table>, Ended> {
    let bug = |message: String| Ended::Fault(Fault::Bug(message));
    let mut kept = Vec::new();
    for schema in outputs.iter().filter(|schema| demand.table(&schema.name)) {
        let wanted = demand.narrowed(schema.clone());
        let position = tables.iter().position(|table| table.name() == schema.name);
        let position = position.ok_or_else(|| bug(format!("the stage gave no table `{}`", schema.name)))?;
        let mut table = tables.swap_remove(position);
        if *table.schema() != wanted {
            table = part(&table, |column| wanted.position(&column.name).is_some())?;
        }
        if *table.schema() != wanted {
            return Err(bug(format!("table `{}` has other columns than its stage declares", schema.name)));
        }
        kept.push(table);
    }
    Ok(kept)
}

/// What a panic said.
pub(super) fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("it panicked without a message").to_owned()
}
