//! Running a study: stages and chunks on all threads, everything finished kept at once.
//!
//! Whatever is finished is in the cache before anything depends on it, so a run can be stopped or killed at any moment
//! and the next one goes on from there. Failures are never kept. Tables stay in memory only while a stage that is not
//! finished reads them. Order and number of threads enter no result. Must not know: how progress is drawn.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use rayon::{ScopeFifo, ThreadPoolBuilder};

use super::board::{Board, StageState, Step};
use super::events::{Event, Observer, Silent};
use super::fault::{Ended, Fault};
use super::note;
use super::options::Options;
use super::outcome::Outcome;
use super::ownership;
use super::plan;
use super::work::{Run, message};
use crate::stage::memory;
use crate::store::cache::Cache;
use crate::store::entry::StoredTable;
use crate::store::error::StoreError;
use crate::store::facts::Facts;
use crate::store::manifest::{Manifest, StudyFolder};
use crate::store::results::{Draw, Folder, Published, Source};
use crate::study::Study;
use crate::table::data::Table;
use declare::error::Diagnostic;

/// Why a run could not even be begun or ended.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    #[error(transparent)]
    Study(#[from] Diagnostic),
    /// It would take more than it may.
    #[error("{}", .0.message)]
    Beyond(Box<Diagnostic>),
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error("cannot start {threads} threads: {problem}")]
    Threads { threads: usize, problem: String },
}

/// Runs a study and brings its results folder up to date; `draw` draws the report. What the outcome knew of keys, fields and tables
/// is in the manifest.
///
/// # Errors
/// As [`execute`], [`ownership::check`] and [`Folder::publish`]. What could not be kept is published all the same, and told last of all.
pub fn run(
    study: &Study,
    cache: &Cache,
    options: &Options,
    observer: &dyn Observer,
    stop: &AtomicBool,
    folder: &Folder,
    draw: Option<Draw<'_>>,
) -> Result<(Outcome, Published), RunError> {
    let moved = ownership::check(study, folder)?;
    let publish = |outcome: &mut Outcome| {
        let manifest = Manifest { study_folder: moved.clone().unwrap_or_default(), ..outcome.take_manifest(study) };
        publish_outcome(manifest, (study, options), outcome, (cache, folder), observer, stop, draw)
    };
    for message in &study.warnings().collect::<Vec<_>>() {
        observer.event(&Event::Warning { message });
    }
    let mut outcome = execute(study, cache, options, observer, stop)?;
    let mut published = publish(&mut outcome);
    if let Err(StoreError::Damaged { .. }) = published {
        // Plans look at headers only; a table that is found damaged now is forgotten, and computed again.
        outcome = execute(study, cache, options, observer, stop)?;
        published = publish(&mut outcome);
    }
    // A run of the same study says the same, whatever was computed.
    let recalled = outcome.stages.iter().filter(|stage| stage.ran == 0 && !stage.warnings.is_empty());
    let recalled: Vec<_> = recalled.map(|stage| (stage.name.as_str(), stage.warnings.as_slice())).collect();
    observer.event(&Event::Recalled { warnings: &recalled });
    for message in &warnings(cache, &outcome) {
        observer.event(&Event::Warning { message });
    }
    let published = published?;
    note::keep(study, (cache, options, folder), (&outcome, &published));
    Ok((outcome, published))
}

/// Brings the results folder up to date with what a run came to.
fn publish_outcome(
    manifest: Manifest,
    (study, options): (&Study, &Options),
    outcome: &Outcome,
    (cache, folder): (&Cache, &Folder),
    observer: &dyn Observer,
    stop: &AtomicBool,
    draw: Option<Draw<'_>>,
) -> Result<Published, StoreError> {
    let facts = || {
        let study_folder = StudyFolder::of(&study.files()).unwrap_or_else(|problem| {
            let path = study.path.display();
            let message = &format!("the results do not name the commit of `{path}`, since git refuses: {problem}");
            observer.event(&Event::Warning { message });
            StudyFolder::default()
        });
        let mut facts = Facts::collect(&study.program.about, study_folder, options.threads());
        let StudyFolder { file, name, .. } = ownership::recorded(study, folder.path());
        facts.study_folder = StudyFolder { file, name, ..facts.study_folder };
        facts
    };
    // What a run that was stopped had finished is published; only whoever asks meanwhile gets less.
    let go_on = |file: &str| {
        let is_late = !outcome.stopped && stop.load(Ordering::Relaxed);
        if is_late { Err(StoreError::Stopped { path: file.to_owned() }) } else { Ok(()) }
    };
    let next = |file: &str| {
        observer.event(&Event::Publishing { file });
        go_on(file)
    };
    let bytes = |stage: &str, table: &str| outcome.bytes(cache, stage, table);
    let table = |stage: &str, table: &str| outcome.table(cache, stage, table);
    let pieces = |stage: &str, table: &str| {
        let file = format!("{stage}.{table}.parquet");
        let found = outcome.pieces(cache, stage, table)?;
        let found = found.map(move |piece| go_on(&file).and(piece));
        Some(Box::new(found) as Box<dyn Iterator<Item = Result<Table, StoreError>>>)
    };
    let source = Source {
        bytes: &bytes,
        pieces: Some(&pieces),
        table: Some(&table),
        draw,
        next: &next,
        waits: &go_on,
        code: study.program.about.code,
    };
    folder.publish(manifest, facts, source)
}

/// What the next run will miss.
#[must_use]
pub fn warnings(cache: &Cache, outcome: &Outcome) -> Vec<String> {
    let (entries, journal) = cache.problems();
    let entries = entries.map(|problem| {
        let again = match outcome.unkept(cache) {
            0 => String::new(),
            1 => "; the next run computes 1 stage again".to_owned(),
            many => format!("; the next run computes {many} stages again"),
        };
        format!("the cache `{}` does not keep what was computed: {problem}{again}", cache.root().display())
    });
    let journal =
        journal.map(|problem| format!("{problem}; until one can be written, runs cannot say why they compute"));
    entries.into_iter().chain(journal).collect()
}

/// Runs a study.
///
/// # Errors
/// What is wrong with its graph or the options. Stages that fail are not an error here: the outcome tells; nor is a
/// cache that takes nothing.
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
    if !queued.is_empty() {
        if let Some(refused) = plan::of(&board, options).refused {
            return Err(RunError::Beyond(Box::new(refused)));
        }
        // Of what the study's text took; threads have memory of their own.
        memory::give_back();
        let threads = options.threads();
        let pool = ThreadPoolBuilder::new().num_threads(threads).thread_name(|index| format!("stage {index}")).build();
        let pool = pool.map_err(|error| RunError::Threads { threads, problem: error.to_string() })?;
        let run = Run {
            cache,
            options,
            observer,
            stop,
            board: Mutex::new(board),
            loaded: Mutex::default(),
            shares: Mutex::default(),
            turns: Mutex::default(),
            spans: Mutex::default(),
        };
        pool.in_place_scope_fifo(|scope| run.spawn(scope, 0, queued));
        debug_assert!(run.board().halted.is_some() || run.loaded().is_empty(), "nobody reads these tables any more");
        board = run.board.into_inner().unwrap_or_else(PoisonError::into_inner);
    }
    board.close();
    cache.flush();
    let journal = board.next_journal();
    if journal == board.journal {
        cache.note_use(&study.name);
    } else {
        cache.put_journal(&study.name, &journal);
    }
    let stopped = stop.load(Ordering::Relaxed) && board.nodes.iter().any(|progress| progress.given_up);
    let outcome = Outcome::of(&board, stopped, began.elapsed().as_secs_f64());
    drop(board);
    // Of what the threads took, all of it.
    memory::give_back();
    Ok(outcome)
}

impl Run<'_> {
    /// Starts what was queued, after `finished` stages came to their end. Stages that run alone wait until no other one
    /// runs or can. They are held back here and not by a lock in the stage: a thread that waits for parts of one stage
    /// takes up another one meanwhile, which must never wait for the first.
    fn spawn<'s>(&'s self, scope: &ScopeFifo<'s>, finished: usize, queued: Vec<usize>) {
        let nodes = self.board().study.nodes.as_slice();
        let (alone, mut ready): (Vec<usize>, Vec<usize>) =
            queued.into_iter().partition(|node| nodes[*node].stage.runs_alone());
        {
            let mut turns = self.turns.lock().unwrap_or_else(PoisonError::into_inner);
            turns.waiting.extend(alone);
            turns.running = turns.running - finished + ready.len();
            if turns.running == 0
                && let Some(next) = turns.waiting.pop_front()
            {
                turns.running = 1;
                ready.push(next);
            }
        }
        for node in ready {
            let (missing, held) = {
                let board = self.board();
                (board.nodes[node].missing.clone(), board.nodes[node].held)
            };
            if missing.is_empty() {
                scope.spawn_fifo(move |scope| {
                    self.board().step(node, Step::Start);
                    self.complete(scope, node);
                });
            }
            for index in missing.into_iter().filter(|index| Some(*index) != held) {
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
        let progress = &mut board.nodes[node];
        progress.open -= 1;
        if progress.open == 1
            && let Some(last) = progress.held.take()
        {
            if progress.fault.is_none() && !progress.given_up {
                drop(board);
                return scope.spawn_fifo(move |scope| self.run_part(scope, node, last));
            }
            progress.open = 0;
        }
        if progress.open == 0 {
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
        if board.nodes[node].state == StageState::Queued {
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
        } else if board.is_shared(node) {
            Step::Skip("other parts are left to others".to_owned())
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
        let mut loaded = self.loaded();
        // Its own tables too: the last reader may have been skipped while they were put together.
        let own = Some(node).filter(|node| !board.is_read(*node));
        for node in board.take_unread().into_iter().chain(own) {
            loaded.remove(&node);
        }
        drop(loaded);
        drop(board);
        self.spawn(scope, 1, queued);
    }

    /// What the tables of a stage are, all parts being known; keeps in memory what others are going to read.
    fn put_together(&self, node: usize) -> Result<Vec<StoredTable>, Ended> {
        let (parts, known, names, is_read) = {
            let mut board = self.board();
            let entry = board.nodes[node].known.first().and_then(|known| known.entry.as_ref());
            let names: Vec<String> =
                entry.iter().flat_map(|entry| &entry.tables).map(|table| table.name.clone()).collect();
            let known = board.known_tables(node);
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
            if !is_read && let Some(described) = self.described(node, &parts, name)? {
                stored.push(described);
                continue;
            }
            let table = self.whole(node, &parts, name)?;
            if known.is_none() {
                stored.push(StoredTable::describe(&table)?);
            }
            if is_read {
                self.loaded().entry(node).or_default().insert(name.clone(), table);
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
}
