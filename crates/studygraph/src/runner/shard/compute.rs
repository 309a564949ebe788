//! One shard: its parts computed in a cache of its own, and packed.
//!
//! Must not know: which other shards there are, but for those below that it reads.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use super::merge::{State, state, take};
use super::plan::ShardPlan;
use super::{ShardError, failed_file, known_file, pack_file, ranges};
use crate::program::Program;
use crate::runner::events::Observer;
use crate::runner::execute::execute;
use crate::runner::options::Options;
use crate::store::cache::Cache;
use crate::store::file::{self, Durability};
use crate::store::shards::{self, Part};
use crate::study::Study;

/// What came of a shard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ran {
    /// Its pack was there, every byte of it.
    Already,
    Packed {
        parts: usize,
        bytes: u64,
        seconds: f64,
    },
}

/// Computes a shard of the plan in `folder`, unless its pack is there; `scratch` is an empty folder of its own.
///
/// # Errors
/// When the plan is not for this program, shards below are missing, a stage fails, the run is stopped, or the pack cannot
/// be written. Nothing is left in the place of the pack then.
pub fn compute(
    folder: &Path,
    index: usize,
    scratch: &Path,
    program: &'static Program,
    how: &Options,
    observer: &dyn Observer,
    stop: &AtomicBool,
) -> Result<Ran, ShardError> {
    let plan = ShardPlan::read(folder)?;
    plan.check(&program.about, folder)?;
    plan.shard(index)?;
    if state(folder, &plan, index, true) == State::Sound {
        return Ok(Ran::Already);
    }
    let study = plan.load(program)?;
    of_study(&study, &plan, (folder, index), scratch, how, observer, stop)
}

/// The same of a study that was read, whatever is there.
pub(in crate::runner) fn of_study(
    study: &Study,
    plan: &ShardPlan,
    (folder, index): (&Path, usize),
    scratch: &Path,
    how: &Options,
    observer: &dyn Observer,
    stop: &AtomicBool,
) -> Result<Ran, ShardError> {
    let shard = plan.shard(index)?;
    for folder in [folder, &folder.join("shards")] {
        file::sweep_ended(folder);
    }
    let cache = Cache::open_if_possible(&scratch.join("cache"));
    if plan.known {
        take(&known_file(folder), plan, None, &cache)?;
    }
    let below = 0..plan.levels[shard.level].first;
    let missing: Vec<usize> =
        below.clone().filter(|&below| state(folder, plan, below, false) != State::Sound).collect();
    if !missing.is_empty() {
        let message = format!("shard {index} reads what shards {} compute; run those first", ranges(missing));
        return Err(ShardError::Plan(message));
    }
    for below in below {
        take(&pack_file(folder, below), plan, Some(below), &cache)?;
    }
    let only = shard.parts.keys().cloned().collect();
    let options = Options { only, share: shard.share(), ..plan.options(how) };
    let outcome = execute(study, &cache, &options, observer, stop)?;
    if outcome.stopped {
        return Err(ShardError::Stopped);
    }
    let failed: Vec<String> =
        outcome.faults().map(|(stage, fault)| format!("stage `{stage}` failed: {fault}")).collect();
    if !failed.is_empty() {
        let message = failed.join("\n");
        file::write(&failed_file(folder, index), message.as_bytes(), Durability::Lazy)?;
        return Err(ShardError::Failed(format!("shard {index}: {message}")));
    }
    let mut parts: Vec<Part> = Vec::new();
    for (stage, own) in &options.share {
        let keys = outcome.stage(stage).map(|stage| stage.keys.as_slice()).unwrap_or_default();
        for &part in own {
            let key = keys.get(part).map(|record| record.key);
            let missing =
                || ShardError::Plan(format!("stage `{stage}` has no part {part}; the plan is not of this study"));
            parts.push((stage.clone(), part, key.ok_or_else(missing)?));
        }
    }
    let bytes = shards::write(&pack_file(folder, index), &plan.digest, Some(index), &cache, &parts)?;
    // It may have failed before, on a machine that lacked something.
    let _ = std::fs::remove_file(failed_file(folder, index));
    Ok(Ran::Packed { parts: parts.len(), bytes, seconds: outcome.seconds })
}
