//! Running a study: stages and chunks on all threads, everything finished kept at once.
//!
//! Whatever is finished is in the cache before anything depends on it, so a run can be stopped or killed at any moment
//! and the next one goes on from there. Failures are never kept. Tables stay in memory only while a stage that is not
//! finished reads them. Order and number of threads enter no result. Must not know: how progress is drawn.

use std::any::Any;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use rayon::{ScopeFifo, ThreadPoolBuilder};

use super::board::{Board, Known, Part, State, Step};
use super::events::{Event, Observer, Silent};
use super::key::Why;
use super::options::Options;
use super::outcome::{Fault, Outcome, together};
use super::plan;
use crate::base::error::{Diagnostic, Failure};
use crate::base::record::Record;
use crate::base::seed::Seed;
use crate::stage::{Context, Demand, Inputs, Kind, Stage};
use crate::store::cache::Cache;
use crate::store::entry::{Entry, StoredTable, part};
use crate::store::error::StoreError;
use crate::store::facts::Facts;
use crate::store::results::{Folder, Published};
use crate::study::Study;
use crate::table::data::Table;
use crate::table::schema::{Column, Schema};

/// Why a run could not even be begun or ended.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    #[error(transparent)]
    Study(#[from] Diagnostic),
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error("cannot start {threads} threads: {problem}")]
    Threads { threads: usize, problem: String },
}

/// Runs a study and brings its results folder up to date.
///
/// # Errors
/// As [`execute`] and [`Folder::publish`].
pub fn run(
    study: &Study,
    cache: &Cache,
    options: &Options,
    observer: &dyn Observer,
    stop: &AtomicBool,
    folder: &Folder,
) -> Result<(Outcome, Published), RunError> {
    let facts = || Facts::collect(study.path.parent().unwrap_or(Path::new("")), options.threads());
    let publish = |outcome: &Outcome| {
        folder.publish(outcome.manifest(study), facts, &|stage, table| outcome.bytes(cache, stage, table))
    };
    let outcome = execute(study, cache, options, observer, stop)?;
    match publish(&outcome) {
        // Plans look at headers only; a table that is found damaged now is forgotten, and computed again.
        Err(StoreError::Damaged { .. }) => {
            let outcome = execute(study, cache, options, observer, stop)?;
            let published = publish(&outcome)?;
            Ok((outcome, published))
        }
        published => Ok((outcome, published?)),
    }
}

/// Runs a study.
///
/// # Errors
/// What is wrong with its graph or the options; a cache that cannot be written. Stages that fail are no error here:
/// the outcome tells.
pub fn execute(
    study: &Study,
    cache: &Cache,
    options: &Options,
    observer: &dyn Observer,
    stop: &AtomicBool,
) -> Result<Outcome, RunError> {
    let began = Instant::now();
    let mut board = Board::new(study, cache, options, &Silent)?;
    let queued = board.settle();
    board.observer = observer;
    observer.event(&Event::Planned { plan: &plan::of(&board) });
    if !queued.is_empty() {
        let threads = options.threads();
        let pool = ThreadPoolBuilder::new().num_threads(threads).thread_name(|index| format!("stage {index}")).build();
        let pool = pool.map_err(|error| RunError::Threads { threads, problem: error.to_string() })?;
        let run = Run { cache, options, observer, stop, board: Mutex::new(board), loaded: Mutex::default(), shares: Mutex::default() };
        pool.in_place_scope_fifo(|scope| run.spawn(scope, &queued));
        board = run.board.into_inner().unwrap_or_else(PoisonError::into_inner);
    }
    board.close();
    let journal = board.next_journal();
    if journal != board.journal {
        cache.put_journal(&study.name, &journal)?;
    }
    let stopped = stop.load(Ordering::Relaxed) && board.nodes.iter().any(|progress| progress.given_up);
    Ok(Outcome::of(&board, stopped, began.elapsed().as_secs_f64()))
}

/// Why a part gave no tables.
enum Ended {
    GivenUp,
    Fault(Fault),
}

impl From<StoreError> for Ended {
    fn from(error: StoreError) -> Self {
        Self::Fault(error.into())
    }
}

/// Tables by node and name.
type Loaded = BTreeMap<(usize, String), Arc<Table>>;

struct Run<'a> {
    cache: &'a Cache,
    options: &'a Options,
    observer: &'a dyn Observer,
    stop: &'a AtomicBool,
    /// Locked only for moments, and before `loaded`.
    board: Mutex<Board<'a>>,
    loaded: Mutex<Loaded>,
    /// By node and part, 0 to 1.
    shares: Mutex<BTreeMap<(usize, usize), f64>>,
}

impl<'a> Run<'a> {
    fn board(&self) -> MutexGuard<'_, Board<'a>> {
        self.board.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn loaded(&self) -> MutexGuard<'_, Loaded> {
        self.loaded.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn spawn<'s>(&'s self, scope: &ScopeFifo<'s>, queued: &[usize]) {
        for &node in queued {
            let missing = self.board().nodes[node].missing.clone();
            if missing.is_empty() {
                scope.spawn_fifo(move |scope| {
                    self.board().step(node, Step::Start);
                    self.complete(scope, node);
                });
            }
            for index in missing {
                scope.spawn_fifo(move |scope| self.run_part(scope, node, index));
            }
        }
    }

    fn run_part<'s>(&'s self, scope: &ScopeFifo<'s>, node: usize, index: usize) {
        let result = if self.begin(node) { self.compute(node, index) } else { Err(Ended::GivenUp) };
        let mut board = self.board();
        let progress = &mut board.nodes[node];
        match result {
            Ok(known) => {
                progress.known[index] = known;
                progress.ran += 1;
            }
            Err(Ended::GivenUp) => progress.given_up = true,
            Err(Ended::Fault(fault)) => {
                if progress.fault.as_ref().is_none_or(|(first, _)| index < *first) {
                    progress.fault = Some((index, fault));
                }
                if !self.options.keep_going {
                    let why = format!("`{}` failed", board.study.nodes[node].name);
                    board.halted.get_or_insert(why);
                }
            }
        }
        board.nodes[node].open -= 1;
        if board.nodes[node].open == 0 {
            drop(board);
            self.complete(scope, node);
        }
    }

    /// Whether a part may begin; the first one starts its stage.
    fn begin(&self, node: usize) -> bool {
        let mut board = self.board();
        if self.stop.load(Ordering::Relaxed) {
            board.halted = Some("stopped".to_owned());
        }
        if board.halted.is_some() {
            return false;
        }
        if board.nodes[node].state == State::Queued {
            board.step(node, Step::Start);
        }
        true
    }

    /// All parts of a stage have reported.
    fn complete<'s>(&'s self, scope: &ScopeFifo<'s>, node: usize) {
        let mut board = self.board();
        let step = if let Some((_, fault)) = board.nodes[node].fault.take() {
            Step::Fail(fault)
        } else if board.nodes[node].given_up {
            if self.stop.load(Ordering::Relaxed) {
                board.halted = Some("stopped".to_owned());
            }
            Step::Skip(board.halted.clone().unwrap_or_else(|| "stopped".to_owned()))
        } else {
            drop(board);
            let tables = catch_unwind(AssertUnwindSafe(|| self.put_together(node)));
            let step = match tables.unwrap_or_else(|panic| Err(Ended::Fault(Fault::Bug(message(&*panic))))) {
                Ok(tables) => Step::Finish(tables),
                Err(Ended::Fault(fault)) => Step::Fail(fault),
                Err(Ended::GivenUp) => Step::Skip("stopped".to_owned()),
            };
            board = self.board();
            step
        };
        if matches!(step, Step::Fail(_)) && !self.options.keep_going {
            let why = format!("`{}` failed", board.study.nodes[node].name);
            board.halted.get_or_insert(why);
        }
        board.step(node, step);
        let queued = if board.halted.is_some() { Vec::new() } else { board.settle() };
        self.loaded().retain(|(node, _), _| board.is_read(*node));
        drop(board);
        self.spawn(scope, &queued);
    }

    /// What the tables of a stage are, all parts being known; keeps in memory what others are going to read.
    fn put_together(&self, node: usize) -> Result<Vec<StoredTable>, Ended> {
        let (parts, known, names, is_read) = {
            let mut board = self.board();
            let known = board.known_tables(node);
            let entry = board.nodes[node].known.first().and_then(|known| known.entry.as_ref());
            let names: Vec<String> =
                entry.iter().flat_map(|entry| &entry.tables).map(|table| table.name.clone()).collect();
            (Arc::clone(&board.nodes[node].parts), known, names, board.is_read(node))
        };
        let single = parts.len() == 1;
        if !is_read && let Some(known) = known {
            return Ok(known);
        }
        let mut stored = Vec::new();
        for name in &names {
            if single && self.fresh(node, 0, name).is_none() {
                continue;
            }
            let table = self.whole(node, &parts, name)?;
            if known.is_none() {
                stored.push(StoredTable::describe(&table)?);
            }
            if is_read {
                self.loaded().insert((node, name.clone()), table);
            }
        }
        if let Some(known) = known {
            return Ok(known);
        }
        let whole = self.board().nodes[node].whole;
        if let Some(whole) = whole {
            self.cache.put_whole(whole, stored.clone())?;
        }
        Ok(stored)
    }

    /// A table of a part that was just computed.
    fn fresh(&self, node: usize, index: usize, name: &str) -> Option<Arc<Table>> {
        self.board().nodes[node].known[index].tables.iter().find(|table| table.name() == name).cloned()
    }

    /// A table of a stage, all chunks together.
    fn whole(&self, node: usize, parts: &[Part], name: &str) -> Result<Arc<Table>, Ended> {
        let mut tables = Vec::new();
        for (index, part) in parts.iter().enumerate() {
            tables.push(match self.fresh(node, index, name) {
                Some(table) => table,
                None => match self.cache.table(part.key, name) {
                    Ok(table) => Arc::new(table),
                    Err(StoreError::Damaged { problem, .. }) => self.repair(node, index, name, problem)?,
                    Err(other) => return Err(other.into()),
                },
            });
        }
        if let [table] = &tables[..] {
            return Ok(Arc::clone(table));
        }
        let tables = tables.into_iter().map(Arc::unwrap_or_clone).collect();
        Ok(Arc::new(together(name, tables)?))
    }

    /// Computes a part again whose header was sound but not the table.
    fn repair(&self, node: usize, index: usize, name: &str, problem: String) -> Result<Arc<Table>, Ended> {
        let known = self.compute(node, index)?;
        let table = known.tables.iter().find(|table| table.name() == name).cloned();
        let mut board = self.board();
        board.nodes[node].why.push(Why::ObjectDamaged(problem));
        board.nodes[node].ran += 1;
        board.nodes[node].known[index].entry = known.entry;
        table.ok_or_else(|| Ended::Fault(Fault::Bug(format!("it gave no table `{name}` this time"))))
    }

    /// A table that some stage reads.
    fn input(&self, node: usize, name: &str) -> Result<Arc<Table>, Ended> {
        if let Some(table) = self.loaded().get(&(node, name.to_owned())) {
            return Ok(Arc::clone(table));
        }
        let parts = Arc::clone(&self.board().nodes[node].parts);
        let table = self.whole(node, &parts, name)?;
        self.loaded().insert((node, name.to_owned()), Arc::clone(&table));
        Ok(table)
    }

    /// Tells how much of a stage is done, all its parts together.
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
    fn compute(&self, node: usize, index: usize) -> Result<Known, Ended> {
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
        let context = Context {
            seed: if of_study.stage.uses_seed() { Seed::of_stage(study.seed, name) } else { Seed::of_stage(0, "") },
            demand: &demand,
            stop: self.stop,
            progress: &|share| {
                self.progressed(node, index, share);
            },
            warn: &|message| {
                self.observer.event(&Event::Warned { stage: name, message: &message });
                warnings.lock().unwrap_or_else(PoisonError::into_inner).push(message);
            },
        };
        let began = Instant::now();
        let result = catch_unwind(AssertUnwindSafe(|| match &part.axis {
            None => of_study.stage.run(&context, &inputs),
            Some((field, values)) => {
                built(of_study.kind, &of_study.record.with_axis(field, values))?.run(&context, &inputs)
            }
        }));
        let tables = match result {
            Ok(Ok(tables)) => tables,
            Ok(Err(Failure::Failed(message))) => return Err(Ended::Fault(Fault::Failed(message))),
            Ok(Err(Failure::Stopped)) => return Err(Ended::GivenUp),
            Err(panic) => return Err(Ended::Fault(Fault::Bug(message(&*panic)))),
        };
        let seconds = began.elapsed().as_secs_f64();
        if parts.len() > 1 {
            self.progressed(node, index, 1.0);
        }
        let tables = demanded(&outputs, &demand, tables)?;
        // Warnings of parallel loops come in any order.
        let mut warnings = warnings.into_inner().unwrap_or_else(PoisonError::into_inner);
        warnings.sort();
        warnings.dedup();
        let entry: Entry = self.cache.put(part.key, &tables.iter().collect::<Vec<_>>(), seconds, warnings)?;
        Ok(Known { entry: Some(entry), tables: tables.into_iter().map(Arc::new).collect() })
    }
}

fn built(kind: &Kind, record: &Record) -> Result<Box<dyn Stage>, Failure> {
    (kind.build)(record).map_err(|diagnostic| Failure::new(diagnostic.message))
}

/// A table without the columns on demand that its reader did not ask for: its key says nothing of them.
fn seen(table: Arc<Table>, wanted: &[String]) -> Result<Arc<Table>, StoreError> {
    let keep = |column: &Column| !column.on_demand || wanted.contains(&column.name);
    if table.schema().columns.iter().all(keep) { Ok(table) } else { Ok(Arc::new(part(&table, keep)?)) }
}

/// The demanded tables in the order of the stage, each with the demanded columns; more than that is dropped.
fn demanded(outputs: &[Schema], demand: &Demand, tables: Vec<Table>) -> Result<Vec<Table>, Ended> {
    let bug = |message: String| Ended::Fault(Fault::Bug(message));
    let mut kept = Vec::new();
    for schema in outputs.iter().filter(|schema| demand.table(&schema.name)) {
        let wanted = demand.narrowed(schema.clone());
        let table = tables.iter().find(|table| table.name() == schema.name);
        let table = table.ok_or_else(|| bug(format!("the stage gave no table `{}`", schema.name)))?;
        let table = part(table, |column| wanted.position(&column.name).is_some())?;
        if *table.schema() != wanted {
            return Err(bug(format!("table `{}` has other columns than its stage declares", schema.name)));
        }
        kept.push(table);
    }
    Ok(kept)
}

/// What a panic said.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("it panicked without a message").to_owned()
}
