//! What a run would do, and why, without doing any of it.
//!
//! Inputs enter keys by content, so below a stage that must run nothing is certain: it may come out as before. Must
//! not know: how a plan is shown.

use super::board::{Board, StageState};
use super::events::Silent;
use super::foresee::{Expected, foresee};
use super::key::{Why, phrase};
use super::options::Options;
use super::refuse;
use crate::stage::Omission;
use crate::store::cache::{Cache, Lookup};
use crate::study::Study;
use declare::error::Diagnostic;
use declare::work::Work;

/// What is to be done, every stage after all it reads.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    pub stages: Vec<Planned>,
    /// What all stages take together.
    pub total: Expected,
    /// Why it is not run: it would take more than it may.
    pub refused: Option<Diagnostic>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    pub name: String,
    pub kind: &'static str,
    pub action: Action,
    /// Chunks in all, and those that must be computed; 1 of 1 for a stage that is not cut. 0 while it waits.
    pub chunks: usize,
    pub missing: usize,
    /// What it will take; nothing where nothing is to be computed.
    pub expected: Option<Expected>,
    /// What it does not compute, and why.
    pub left_out: Vec<Omission>,
    /// Work that was counted in what is known.
    pub work: Work,
    /// What it took when it was computed; 0 when it was not.
    pub seconds: f64,
    /// Of a stage that is computed again only because more is asked of it: what it took the last time, all of which it
    /// takes once more. Nothing where that is not known any more.
    pub again: Option<f64>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Action {
    /// Nothing to do.
    Hit,
    Run(Vec<Why>),
    /// Its key is known only once these stages have run; if they come out as before, there is nothing to do.
    Wait(Vec<String>),
    /// Not asked for.
    Skip(String),
}

impl Action {
    /// As one phrase: `hit`, `run: config changed: teeth`, `wait for a, b`, `skip: not asked for`.
    #[must_use]
    pub fn phrase(&self) -> String {
        match self {
            Self::Hit => "hit".to_owned(),
            Self::Run(why) => format!("run: {}", phrase(why)),
            Self::Wait(names) => format!("wait for {}", names.join(", ")),
            Self::Skip(why) => format!("skip: {why}"),
        }
    }
}

impl Plan {
    /// Whether a run would compute nothing.
    #[must_use]
    pub fn is_up_to_date(&self) -> bool {
        self.stages.iter().all(|stage| matches!(stage.action, Action::Hit | Action::Skip(_)))
    }
}

/// Reads the cache, changes nothing.
///
/// # Errors
/// What is wrong with the study's graph, or with the names in the options.
pub fn plan(study: &Study, cache: &Cache, options: &Options) -> Result<Plan, Diagnostic> {
    let mut board = Board::new(study, cache, options, &Silent)?;
    board.settle();
    Ok(of(&board, options))
}

/// The plan that a settled board shows.
pub fn of(board: &Board, options: &Options) -> Plan {
    let threads = options.threads();
    let mut foresight = foresee(board, threads, None);
    let refused = refuse::refusal(board, &foresight, &options.limits, threads);
    let stages = board.graph.order.iter().map(|&node| {
        let (progress, of_study) = (&board.nodes[node], &board.study.nodes[node]);
        let action = match progress.state {
            StageState::Want | StageState::Ready => {
                let waits = |&input: &usize| !board.nodes[input].state.has_tables();
                let mut inputs: Vec<usize> = board.graph.inputs[node].iter().map(|input| input.node).collect();
                inputs.sort_unstable();
                inputs.dedup();
                inputs.retain(waits);
                Action::Wait(inputs.into_iter().map(|input| board.study.nodes[input].name.clone()).collect())
            }
            StageState::Hit | StageState::Done => Action::Hit,
            StageState::Queued | StageState::Running => Action::Run(progress.why.clone()),
            StageState::Failed | StageState::Skipped => Action::Skip(progress.skipped.clone()),
        };
        Planned {
            name: of_study.name.clone(),
            kind: of_study.kind.name,
            action,
            chunks: progress.parts.len(),
            missing: progress.missing.len(),
            expected: foresight.stages[node].take(),
            left_out: left_out(board, node),
            seconds: progress.seconds(),
            again: (progress.state == StageState::Queued && progress.why == [Why::Demand])
                .then(|| took(board, node))
                .flatten(),
            work: progress.work(board.study.program.counters),
        }
    });
    Plan { stages: stages.collect(), total: foresight.total, refused }
}

/// Seconds that a stage took when it was computed last, as far as the cache still has what came of it.
fn took(board: &Board, node: usize) -> Option<f64> {
    let seconds = |key| match board.cache.look_up(key) {
        Lookup::Found(entry) => Some(entry.of_run.seconds),
        Lookup::Missing | Lookup::Damaged(_) => None,
    };
    board.last(node)?.keys.iter().map(|record| seconds(record.key)).sum()
}

/// What a stage itself leaves out, and what nobody asks it for.
pub fn left_out(board: &Board, node: usize) -> Vec<Omission> {
    let stage = &board.study.nodes[node].stage;
    let mut omissions = stage.left_out(&board.graph.demands[node]);
    omissions.extend(board.graph.unasked(node, stage.as_ref()));
    omissions
}
