//! Where every stage of a run stands: one state each, one function that changes it.
//!
//! ```text
//! Want → Ready → Hit
//!              → Queued → Running → Done | Failed | Skipped
//! Want → Skipped     Queued → Skipped
//! ```
//!
//! A plan is a board on which everything that can be known without computing is known; a run goes on from there. Must
//! not know: threads, how a stage is computed.

use std::cell::LazyCell;
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

use super::events::{Event, Observer};
use super::fault::Fault;
use super::graph::{Graph, Input};
use super::key::{self, KeyedChunk, Why, explain, phrase};
use super::options::Options;
use crate::store::cache::{Cache, Lookup};
use crate::store::entry::{CacheEntry, StoredTable};
use crate::store::journal::{Failed, Journal, JournalStage};
use crate::study::Study;
use crate::table::data::Table;
use crate::warning::Warning;
use declare::digest::Digest;
use declare::error::Diagnostic;

/// Where a stage stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StageState {
    /// Not all its inputs are known.
    Want,
    /// They are, so its keys are.
    Ready,
    /// The cache has all of it.
    Hit,
    Queued,
    Running,
    Done,
    Failed,
    /// Not run: not asked for, or something it needs failed, or the user stopped.
    Skipped,
}

impl StageState {
    #[must_use]
    pub const fn is_final(self) -> bool {
        matches!(self, Self::Hit | Self::Done | Self::Failed | Self::Skipped)
    }

    /// Whether its tables are there.
    #[must_use]
    pub const fn has_tables(self) -> bool {
        matches!(self, Self::Hit | Self::Done)
    }

    const fn may_become(self, next: Self) -> bool {
        matches!(
            (self, next),
            (Self::Want, Self::Ready | Self::Skipped)
                | (Self::Ready, Self::Hit | Self::Queued)
                | (Self::Queued, Self::Running | Self::Skipped)
                | (Self::Running, Self::Done | Self::Failed | Self::Skipped)
        )
    }
}

/// A change of state, with what comes with it.
pub enum Step {
    Ready(Arc<Vec<KeyedChunk>>),
    Hit(Vec<StoredTable>),
    Queue(Vec<Why>),
    Start,
    Finish(Vec<StoredTable>),
    Fail(Fault),
    Skip(String),
}

impl Step {
    const fn state(&self) -> StageState {
        match self {
            Self::Ready(_) => StageState::Ready,
            Self::Hit(_) => StageState::Hit,
            Self::Queue(_) => StageState::Queued,
            Self::Start => StageState::Running,
            Self::Finish(_) => StageState::Done,
            Self::Fail(_) => StageState::Failed,
            Self::Skip(_) => StageState::Skipped,
        }
    }
}

/// What is known about a part that was looked up or computed.
#[derive(Default)]
pub struct Known {
    pub entry: Option<CacheEntry>,
    /// Just computed and still in memory.
    pub tables: Vec<Arc<Table>>,
}

/// What is known about a stage.
pub struct Progress {
    pub state: StageState,
    /// From Ready on.
    pub parts: Arc<Vec<KeyedChunk>>,
    pub known: Vec<Known>,
    /// The parts to compute.
    pub missing: Vec<usize>,
    pub why: Vec<Why>,
    /// Parts that have not reported yet.
    pub open: usize,
    /// The part that waits for all others, since it is made of them.
    pub held: Option<usize>,
    /// Parts that were computed.
    pub ran: usize,
    /// Whether a part was not even begun, or given up, because the run stops.
    pub given_up: bool,
    /// The fault of the first part that has one.
    pub fault: Option<(usize, Fault)>,
    /// The key of what several chunks are together.
    pub whole: Option<Digest>,
    /// From Hit or Done on.
    pub tables: Vec<StoredTable>,
    pub skipped: String,
}

/// All stages of a run.
pub struct Board<'a> {
    pub study: &'a Study,
    pub graph: Graph,
    pub nodes: Vec<Progress>,
    pub observer: &'a dyn Observer,
    /// Why nothing new is begun.
    pub halted: Option<String>,
    pub(super) cache: &'a Cache,
    options: &'a Options,
    pub journal: Journal,
    /// The places of stages in the journal.
    last: HashMap<String, usize>,
    /// The place of every node in the order of the graph.
    places: Vec<usize>,
    /// Places of nodes that wait and of which something they read has come to its end, or that were never looked at.
    due: BTreeSet<usize>,
    /// How many readers of each node have not come to their end.
    open_readers: Vec<usize>,
    /// Nodes whose last reader has come to its end since somebody asked.
    unread: Vec<usize>,
}

impl<'a> Board<'a> {
    /// # Errors
    /// As [`Graph::new`]; a name in the options that is not a stage.
    pub fn new(
        study: &'a Study,
        cache: &'a Cache,
        options: &'a Options,
        observer: &'a dyn Observer,
    ) -> Result<Self, Diagnostic> {
        let graph = Graph::new(study, &options.wanted)?;
        if let super::options::Force::Stages(names) = &options.force {
            names.iter().try_for_each(|name| super::graph::find(study, name).map(drop))?;
        }
        let needed = graph.needed(study, &options.only)?;
        let progress = || Progress {
            state: StageState::Want,
            parts: Arc::new(Vec::new()),
            known: Vec::new(),
            missing: Vec::new(),
            why: Vec::new(),
            open: 0,
            held: None,
            ran: 0,
            given_up: false,
            fault: None,
            whole: None,
            tables: Vec::new(),
            skipped: String::new(),
        };
        let nodes = needed.iter().map(|_| progress()).collect();
        let journal = cache.journal(&study.name);
        let last = journal.by_name();
        let mut places = vec![0; graph.order.len()];
        graph.order.iter().enumerate().for_each(|(place, &node)| places[node] = place);
        let due = (0..graph.order.len()).collect();
        let open_readers = graph.readers.iter().map(Vec::len).collect();
        let halted = None;
        let mut board = Self {
            study,
            graph,
            nodes,
            observer,
            halted,
            cache,
            options,
            journal,
            last,
            places,
            due,
            open_readers,
            unread: Vec::new(),
        };
        for (node, needed) in needed.into_iter().enumerate() {
            if !needed {
                board.step(node, Step::Skip("not asked for".to_owned()));
            }
        }
        Ok(board)
    }

    /// The one place where a state changes.
    pub fn step(&mut self, node: usize, step: Step) {
        let stage = self.study.nodes[node].name.as_str();
        let progress = &mut self.nodes[node];
        let next = step.state();
        debug_assert!(progress.state.may_become(next), "`{stage}`: {:?} to {next:?}", progress.state);
        progress.state = next;
        if next.is_final() {
            for input in distinct(&self.graph.inputs[node]) {
                self.open_readers[input] -= 1;
                if self.open_readers[input] == 0 {
                    self.unread.push(input);
                }
            }
            let readers = &self.graph.readers[node];
            self.due.extend(readers.iter().map(|&reader| self.places[reader]));
        }
        let event = match step {
            Step::Ready(parts) => {
                progress.known = parts.iter().map(|_| Known::default()).collect();
                progress.parts = parts;
                return;
            }
            Step::Hit(tables) => {
                progress.tables = tables;
                Event::Hit { stage }
            }
            Step::Queue(why) => {
                progress.why = why;
                progress.open = progress.missing.len();
                let is_of_all = |part: &&usize| progress.parts[**part].is_of_all();
                progress.held = progress.missing.iter().find(is_of_all).copied().filter(|_| progress.open > 1);
                return;
            }
            Step::Start => {
                let why = phrase(&progress.why);
                return self.observer.event(&Event::Started { stage, why: &why, chunks: progress.missing.len() });
            }
            Step::Finish(tables) => {
                progress.tables = tables;
                progress.known.iter_mut().for_each(|known| known.tables.clear());
                // Sentences by themselves were told as they came.
                for message in &progress.warnings(Warning::is_of_cases) {
                    self.observer.event(&Event::Warned { stage, message });
                }
                Event::Finished { stage, seconds: progress.seconds() }
            }
            Step::Fail(fault) => {
                progress.known.iter_mut().for_each(|known| known.tables.clear());
                let (_, fault) = progress.fault.insert((0, fault));
                Event::Failed { stage, fault }
            }
            Step::Skip(why) => {
                progress.skipped = why;
                Event::Skipped { stage, why: &progress.skipped }
            }
        };
        self.observer.event(&event);
    }

    /// Takes every stage as far as it goes without computing; gives those that were queued. Looked at are only stages of
    /// which something has changed: a study may have very many.
    pub fn settle(&mut self) -> Vec<usize> {
        let mut queued = Vec::new();
        while let Some(place) = self.due.pop_first() {
            let node = self.graph.order[place];
            if self.nodes[node].state != StageState::Want {
                continue;
            }
            let inputs = self.graph.inputs[node].iter().map(|input| input.node);
            let lost = |&input: &usize| matches!(self.nodes[input].state, StageState::Failed | StageState::Skipped);
            if let Some(lost) = inputs.clone().find(lost) {
                let verb = if self.nodes[lost].state == StageState::Failed { "failed" } else { "was not run" };
                self.step(node, Step::Skip(format!("`{}` {verb}", self.study.nodes[lost].name)));
            } else if inputs.clone().all(|input| self.nodes[input].state.has_tables()) {
                let tables = |input: usize| self.nodes[input].tables.as_slice();
                let parts = key::parts(self.study, &self.graph, node, tables);
                self.step(node, Step::Ready(Arc::new(parts)));
                if self.look_up(node) {
                    queued.push(node);
                }
            }
        }
        queued
    }

    /// What a stage was last computed from.
    #[must_use]
    pub fn last(&self, node: usize) -> Option<JournalStage> {
        self.journal.stage(*self.last.get(&self.study.nodes[node].name)?)
    }

    /// Takes a ready stage to Hit, or to Queued (then true).
    fn look_up(&mut self, node: usize) -> bool {
        let name = &self.study.nodes[node].name;
        // Asked only where something is to be computed.
        let last = LazyCell::new(|| {
            let place = self.last.get(name).copied();
            place.and_then(|place| self.journal.stage(place)).unwrap_or_default()
        });
        let forced = self.options.force.applies(name);
        let parts = Arc::clone(&self.nodes[node].parts);
        let mut reasons: Vec<Why> = Vec::new();
        let progress = &mut self.nodes[node];
        for (index, part) in parts.iter().enumerate().filter(|(index, _)| self.options.is_own(name, *index)) {
            let why = match self.cache.look_up(part.key) {
                _ if forced => vec![Why::Forced],
                Lookup::Found(entry) => {
                    progress.known[index].entry = Some(entry);
                    continue;
                }
                Lookup::Damaged(problem) => vec![Why::ObjectDamaged(problem)],
                Lookup::Missing if last.keys.iter().any(|record| record.key == part.record.key) => {
                    vec![Why::ObjectMissing]
                }
                Lookup::Missing if last.failed.contains(&Failed(part.key)) => vec![Why::FailedBefore],
                Lookup::Missing => explain(&last.keys, &part.record, part.axis()),
            };
            progress.missing.push(index);
            reasons.extend(why);
        }
        reasons.dedup();
        let mut distinct: Vec<Why> = Vec::new();
        for why in reasons {
            if !distinct.contains(&why) {
                distinct.push(why);
            }
        }
        if distinct.is_empty() {
            match self.known_tables(node) {
                Some(tables) => {
                    self.step(node, Step::Hit(tables));
                    return false;
                }
                None => distinct.push(Why::NotPutTogether),
            }
        }
        self.step(node, Step::Queue(distinct));
        true
    }

    /// What a stage's tables are, when all its parts are known, and, where there are several, what they are together. Those of a
    /// single part are the stage's own from then on: its entry need not have them too.
    pub fn known_tables(&mut self, node: usize) -> Option<Vec<StoredTable>> {
        let progress = &mut self.nodes[node];
        if let [Known { entry: Some(entry), .. }] = &mut progress.known[..] {
            return Some(std::mem::take(&mut entry.tables));
        }
        let entries: Vec<&CacheEntry> = progress.known.iter().filter_map(|known| known.entry.as_ref()).collect();
        if entries.len() != progress.parts.len() {
            return None;
        }
        let whole = key::whole(entries.iter().map(|entry| entry.tables.as_slice()));
        progress.whole = Some(whole);
        match self.cache.look_up(whole) {
            Lookup::Found(entry) => Some(entry.tables),
            Lookup::Missing | Lookup::Damaged(_) => None,
        }
    }

    /// Whether some parts of a stage are left to others.
    #[must_use]
    pub fn is_shared(&self, node: usize) -> bool {
        let name = &self.study.nodes[node].name;
        (0..self.nodes[node].parts.len()).any(|part| !self.options.is_own(name, part))
    }

    /// Whether a part of a stage is to be computed here.
    #[must_use]
    pub fn is_own(&self, node: usize, part: usize) -> bool {
        self.options.is_own(&self.study.nodes[node].name, part)
    }

    /// Whether a stage that is not finished yet reads from this one.
    #[must_use]
    pub fn is_read(&self, node: usize) -> bool {
        self.open_readers[node] > 0
    }

    /// The nodes whose last reader has come to its end since this was asked before.
    pub fn take_unread(&mut self) -> Vec<usize> {
        std::mem::take(&mut self.unread)
    }

    /// Skips what cannot be reached any more.
    pub fn close(&mut self) {
        for node in self.graph.order.clone() {
            if !self.nodes[node].state.is_final() {
                let why = self.halted.clone().unwrap_or_else(|| "not reached".to_owned());
                self.step(node, Step::Skip(why));
            }
        }
    }

    /// The journal after this run: stages without news keep what they had.
    #[must_use]
    pub fn next_journal(&self) -> Journal {
        let mut journal = Journal::default();
        for (node, progress) in self.study.nodes.iter().zip(&self.nodes) {
            let last = self.last.get(&node.name).copied();
            let keys = || progress.parts.iter().map(|part| part.record.clone());
            match (progress.state, last) {
                (StageState::Hit | StageState::Done, _) => journal.add(&JournalStage {
                    name: node.name.clone(),
                    keys: keys().collect(),
                    whole: progress.whole,
                    failed: Vec::new(),
                }),
                (StageState::Failed, last) => journal.add(&JournalStage {
                    name: node.name.clone(),
                    failed: keys().map(|record| Failed(record.key)).collect(),
                    ..last.and_then(|last| self.journal.stage(last)).unwrap_or_default()
                }),
                (_, Some(last)) => journal.add_from(&self.journal, last),
                (_, None) => {}
            }
        }
        journal
    }
}

/// The nodes that are read, each once.
pub fn distinct(inputs: &[Input]) -> Vec<usize> {
    let mut nodes: Vec<usize> = inputs.iter().map(|input| input.node).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}
