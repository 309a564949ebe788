//! What a run will take, before it runs: rows, bytes, memory and time of every stage that has something to compute.
//!
//! Rows of stages that are up to date are known, those of the others are estimated, and go into the estimates of whoever
//! reads them. Must not know: limits, how any of it is shown.

use std::collections::BTreeMap;

use super::board::{Board, distinct};
use super::chunk::chunks;
use crate::stage::{Ahead, Estimate, RowCount, Stage};
use declare::record::Record;

/// What a stage, or a whole run, will take.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    /// By table, what is to be computed; of a run one line, without a name.
    pub tables: Vec<(String, RowCount)>,
    /// Bytes on disk, in the cache and in the results, at most.
    pub bytes: u64,
    /// The most bytes in memory.
    pub memory: u64,
    /// About how long it takes on so many threads as there are.
    pub seconds: f64,
    /// Whether a thread that waits for its parts may begin another stage meanwhile.
    pub parallel: bool,
}

/// All stages of a run.
pub struct Foresight {
    /// By node; nothing where nothing is to be computed.
    pub stages: Vec<Option<Expected>>,
    pub total: Expected,
    /// By node, what is to be computed: the number of each part, and its seconds on one thread.
    pub parts: Vec<Vec<(usize, f64)>>,
}

/// Bytes of the program itself.
const PROGRAM: u64 = 20_000_000;
/// What the process holds over what it asked for at once: the system's allocator keeps much of what was given back. 1.4 to 2
/// were measured with long tables.
const KEPT: u64 = 2;

/// Another record in the place of a node's own, to see what would become of the run.
pub type Instead<'a> = Option<(usize, &'a Record)>;

/// Looks ahead.
#[must_use]
pub fn foresee(board: &Board, threads: usize, instead: Instead) -> Foresight {
    let mut wholes: Vec<Estimate> = board.nodes.iter().map(|_| Estimate::default()).collect();
    let mut stages: Vec<Option<Expected>> = vec![None; board.nodes.len()];
    let mut processor = 0.0;
    let mut seconds = vec![Vec::new(); board.nodes.len()];
    if board.nodes.iter().all(|progress| progress.state.is_final()) {
        let total = Expected { tables: Vec::new(), bytes: 0, memory: 0, seconds: 0.0, parallel: false };
        return Foresight { stages, total, parts: vec![Vec::new(); board.nodes.len()] };
    }
    for &node in &board.graph.order {
        let (progress, of_study, demand) = (&board.nodes[node], &board.study.nodes[node], &board.graph.demands[node]);
        if progress.state.is_final() {
            let rows: BTreeMap<&str, usize> = progress.tables.iter().map(|table| (&*table.name, table.rows)).collect();
            wholes[node] = board.graph.outputs[node].iter().fold(Estimate::new(false), |all, schema| {
                let found = rows.get(&*schema.name).copied().unwrap_or(0);
                all.columns(demand, schema.clone(), RowCount::exact(found))
            });
            continue;
        }
        let mut ahead = Ahead::default();
        let mut read = 0;
        for input in &board.graph.inputs[node] {
            read += wholes[input.node].held;
            for want in &input.wants {
                let rows = wholes[input.node].of_table(&want.table).unwrap_or(RowCount::NONE);
                ahead.know(&input.port, &want.table, rows);
            }
        }
        let record = instead.filter(|(at, _)| *at == node).map_or(&of_study.record, |(_, record)| record);
        let estimate = |stage: &dyn Stage| stage.estimate(demand, &ahead);
        let built = |record: &Record| (of_study.kind.build)(record).ok().map(|stage| estimate(stage.as_ref()));
        let mut whole = match instead {
            Some((at, record)) if at == node => built(record).unwrap_or_default(),
            _ => estimate(of_study.stage.as_ref()),
        };
        let known = !progress.parts.is_empty() && instead.is_none();
        let missing = |index: &usize| board.is_own(node, *index) && (!known || progress.missing.contains(index));
        let instead_of =
            instead.filter(|(at, _)| *at == node).and_then(|(_, record)| (of_study.kind.build)(record).ok());
        let stage = instead_of.as_deref().unwrap_or(of_study.stage.as_ref());
        let (count, parts): (usize, Vec<(usize, Estimate)>) = match (stage.parts(), chunks(of_study.kind, record)) {
            (Some(own), _) => {
                let count = own.each.len();
                let each = (0..count).filter(missing);
                (count, each.map(|part| (part, stage.estimate_part(part, demand, &ahead))).collect())
            }
            (None, None) => (1, vec![(0, whole.clone())]),
            (None, Some(all)) => {
                let values = all.values.iter().enumerate().filter(|(index, _)| missing(index));
                let each =
                    values.filter_map(|(index, values)| Some((index, built(&record.with_axis(all.field, values))?)));
                (all.values.len(), each.collect())
            }
        };
        // What is only a part of its stage is read by nobody, nor put together.
        if !(0..count).all(|index| board.is_own(node, index)) {
            whole = Estimate::new(whole.parallel);
        }
        seconds[node] = parts.iter().map(|(index, part)| (*index, part.seconds)).collect();
        let parts: Vec<Estimate> = parts.into_iter().map(|(_, part)| part).collect();
        let (expected, alone) = together(&whole, &parts, read, threads);
        processor += alone;
        stages[node] = Some(expected);
        wholes[node] = whole;
    }
    let total = total(board, &stages, &wholes, processor, threads);
    Foresight { stages, total, parts: seconds }
}

/// A stage from the parts that are to be computed, and its seconds on one thread.
fn together(whole: &Estimate, parts: &[Estimate], read: u64, threads: usize) -> (Expected, f64) {
    let mut tables: Vec<(String, RowCount)> = Vec::new();
    for (name, rows) in parts.iter().flat_map(|part| &part.tables) {
        match tables.iter_mut().find(|(known, _)| known == name) {
            Some((_, known)) => *known = known.and(*rows),
            None => tables.push((name.clone(), *rows)),
        }
    }
    // As many parts as there are threads are computed at once; then all are put together, from their own tables.
    let mut held: Vec<u64> = parts.iter().map(|part| part.memory).collect();
    held.sort_unstable_by(|one, two| two.cmp(one));
    let at_once: u64 = held.iter().take(threads).fold(0, |sum, held| sum.saturating_add(*held));
    let joining = if parts.len() > 1 { whole.held.saturating_mul(2) } else { 0 };
    let seconds: f64 = parts.iter().map(|part| part.seconds).sum();
    let shared = if whole.parallel { threads } else { threads.min(parts.len()) }.max(1);
    // Once in the cache; as a table and in HDF5 among the results.
    let cached = parts.iter().fold(0_u64, |sum, part| sum.saturating_add(part.bytes));
    let expected = Expected {
        tables,
        bytes: cached.saturating_add(whole.bytes.saturating_mul(2)),
        memory: at_once.saturating_add(joining).saturating_add(read),
        seconds: seconds / shared as f64,
        parallel: whole.parallel,
    };
    (expected, seconds)
}

fn total(board: &Board, stages: &[Option<Expected>], wholes: &[Estimate], processor: f64, threads: usize) -> Expected {
    let running = || stages.iter().flatten();
    let rows = running().flat_map(|stage| &stage.tables).fold(RowCount::NONE, |total, (_, rows)| total.and(*rows));
    let held = wholes.iter().fold(0_u64, |sum, whole| sum.saturating_add(whole.bytes));
    // The results are put together last: HDF5 as one file in memory, and one table.
    let publishing = held.saturating_add(wholes.iter().map(|whole| whole.held).max().unwrap_or(0));
    let asked = at_once(board, stages, threads).max(if running().next().is_some() { publishing } else { 0 });
    Expected {
        tables: vec![(String::new(), rows)],
        bytes: running().fold(0, |sum, stage| sum.saturating_add(stage.bytes)),
        memory: if asked > 0 { PROGRAM.saturating_add(asked.saturating_mul(KEPT)) } else { 0 },
        seconds: running().map(|stage| stage.seconds).fold(processor / threads as f64, f64::max),
        parallel: true,
    }
}

/// The most memory of stages that may run at the same time: whatever set that is, for any of its stages it is among those
/// that neither read from it nor are read by it, near or far. Of those that take one thread there are no more than threads.
fn at_once(board: &Board, stages: &[Option<Expected>], threads: usize) -> u64 {
    let memory = |node: usize| stages[node].as_ref().map_or(0, |stage| stage.memory);
    let mut running: Vec<usize> = (0..stages.len()).filter(|&node| memory(node) > 0).collect();
    // Those that take most come first, so that few are looked at where there are very many.
    running.sort_by_key(|&node| std::cmp::Reverse(memory(node)));
    let above = Above::of(board, &running);
    let alone = |node: usize| board.study.nodes[node].stage.runs_alone();
    let parallel = |node: usize| stages[node].as_ref().is_some_and(|stage| stage.parallel);
    let shared: Vec<usize> = (0..running.len()).filter(|&place| parallel(running[place])).collect();
    let single: Vec<usize> = (0..running.len()).filter(|&place| !parallel(running[place])).collect();
    let all = |(place, &node): (usize, &usize)| {
        let beside = |&&other: &&usize| {
            let apart = other != place && !alone(node) && !alone(running[other]);
            other == place || apart && !above.holds(node, other) && !above.holds(running[other], place)
        };
        let single = single.iter().filter(beside).take(threads);
        shared.iter().filter(beside).chain(single).map(|&place| memory(running[place])).fold(0, u64::saturating_add)
    };
    running.iter().enumerate().map(all).max().unwrap_or(0)
}

/// Which of some nodes each node reads from, near or far: a bit for each of them.
struct Above {
    bits: Vec<u64>,
    words: usize,
}

impl Above {
    fn of(board: &Board, some: &[usize]) -> Self {
        let words = some.len().div_ceil(64);
        let mut above = Self { bits: vec![0; words * board.nodes.len()], words };
        let mut place = vec![None; board.nodes.len()];
        some.iter().enumerate().for_each(|(at, &node)| place[node] = Some(at));
        for &node in &board.graph.order {
            for input in distinct(&board.graph.inputs[node]) {
                for word in 0..words {
                    above.bits[node * words + word] |= above.bits[input * words + word];
                }
                if let Some(at) = place[input] {
                    above.bits[node * words + at / 64] |= 1 << (at % 64);
                }
            }
        }
        above
    }

    fn holds(&self, node: usize, place: usize) -> bool {
        self.bits[node * self.words + place / 64] >> (place % 64) & 1 == 1
    }
}
