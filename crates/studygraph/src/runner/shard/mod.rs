//! A run in pieces on any number of machines: planned once, computed shard by shard, merged into one cache.
//!
//! Nothing but files passes between them: `plan.json`, one pack for each shard, no server, no lock. Whoever starts the
//! shards (a loop, Slurm, Snakemake) needs to know only that shard i leaves `shards/i.pack`. A shard that is run twice, or
//! on two machines at once, gives the same tables, and either file is as good.
//!
//! What is divided are parts of stages. A stage that takes longer than [`CHEAP`] or has several parts is divided up; every
//! other one is computed by each shard that needs it, which costs less than to wait for it. Where a stage that is divided
//! up reads another such stage, it is on a higher level, and its shards wait for those below. What nobody divided up reads
//! (reports) is computed when all is merged. Must not know: what starts the shards.

mod compute;
mod merge;
mod plan;

#[cfg(test)]
pub(in crate::runner) use compute::of_study;
pub use compute::{Ran, compute};
pub use merge::{Merged, State, merge, state, states};
pub use plan::{Level, Shard, ShardPlan, plan};

use std::path::{Path, PathBuf};

use super::execute::RunError;
use crate::store::error::StoreError;
use crate::study::LoadError;

/// Seconds on one thread up to which a stage is computed by every shard that needs it.
pub const CHEAP: f64 = 1.0;

/// Why a shard, a plan or a merge came to nothing.
#[derive(Debug, thiserror::Error)]
pub enum ShardError {
    /// There is no plan, or it is not for this program, or there is no such shard.
    #[error("{0}")]
    Plan(String),
    #[error("{0}")]
    Study(Box<LoadError>),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A stage failed: it would fail everywhere.
    #[error("{0}")]
    Failed(String),
    #[error("stopped; nothing of this shard is kept")]
    Stopped,
}

/// The file of a plan.
#[must_use]
pub fn plan_file(folder: &Path) -> PathBuf {
    folder.join("plan.json")
}

/// What was known when it was planned, and others need.
#[must_use]
pub fn known_file(folder: &Path) -> PathBuf {
    folder.join("known.pack")
}

/// What a shard leaves.
#[must_use]
pub fn pack_file(folder: &Path, shard: usize) -> PathBuf {
    folder.join("shards").join(format!("{shard}.pack"))
}

/// What a shard leaves instead whose stage failed.
#[must_use]
pub fn failed_file(folder: &Path, shard: usize) -> PathBuf {
    folder.join("shards").join(format!("{shard}.failed"))
}

/// `0-3, 7, 9-11`.
#[must_use]
pub fn ranges(numbers: impl IntoIterator<Item = usize>) -> String {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for number in numbers {
        match runs.last_mut() {
            Some((_, last)) if *last + 1 == number => *last = number,
            _ => runs.push((number, number)),
        }
    }
    let one = |(from, to): (usize, usize)| if from == to { from.to_string() } else { format!("{from}-{to}") };
    runs.into_iter().map(one).collect::<Vec<_>>().join(",")
}
