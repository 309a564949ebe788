//! Which shards are there, and all of them taken into a cache.
//!
//! Must not know: how results are published.

use std::path::Path;

use super::plan::ShardPlan;
use super::{ShardError, failed_file, known_file, pack_file, ranges};
use crate::program::Program;
use crate::store::cache::Cache;
use crate::store::error::StoreError;
use crate::store::{file, shards};

/// What of a shard is there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum State {
    Sound,
    Missing,
    /// A sentence says why it cannot be trusted.
    Damaged(String),
    /// What its stage said.
    Failed(String),
}

/// What was taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Merged {
    pub shards: usize,
    pub parts: usize,
    pub bytes: u64,
}

/// A message of a stage is no longer.
const LONGEST_MESSAGE: u64 = 1 << 20;

/// What of a shard is there; `check` reads every byte of it.
#[must_use]
pub fn state(folder: &Path, plan: &ShardPlan, index: usize, check: bool) -> State {
    match shards::open(&pack_file(folder, index), &plan.digest, Some(index)) {
        Ok(Some(mut pack)) => match if check { pack.check() } else { Ok(()) } {
            Ok(()) => State::Sound,
            Err(StoreError::Damaged { problem, .. }) => State::Damaged(problem),
            Err(error) => State::Damaged(error.to_string()),
        },
        Ok(None) => match file::read(&failed_file(folder, index), LONGEST_MESSAGE) {
            Ok(message) => State::Failed(String::from_utf8_lossy(&message).into_owned()),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => State::Missing,
            Err(error) => State::Damaged(format!("why it failed cannot be read: {error}")),
        },
        Err(problem) => State::Damaged(problem),
    }
}

/// The same of all shards.
#[must_use]
pub fn states(folder: &Path, plan: &ShardPlan, check: bool) -> Vec<State> {
    (0..plan.shards.len()).map(|index| state(folder, plan, index, check)).collect()
}

/// Takes all of a pack into a cache.
///
/// # Errors
/// When it is missing or damaged; [`StoreError::NotDeterministic`] when the cache has other tables under its keys.
pub(super) fn take(path: &Path, plan: &ShardPlan, shard: Option<usize>, cache: &Cache) -> Result<Merged, ShardError> {
    let damaged = |problem: String| StoreError::Damaged { path: path.display().to_string(), problem };
    let pack = shards::open(path, &plan.digest, shard).map_err(damaged)?;
    let mut pack = pack.ok_or_else(|| damaged("it is missing".to_owned()))?;
    let mut merged = Merged { shards: 1, ..Merged::default() };
    pack.each(|key, bytes| {
        merged.parts += 1;
        merged.bytes += bytes.len() as u64;
        cache.take_entry(key, bytes)
    })?;
    Ok(merged)
}

/// Takes all shards of a plan into a cache; what is left to compute a run computes.
///
/// # Errors
/// When the plan is not for this program; when shards are missing, damaged or failed. What was taken before that was seen
/// is found by the next merge.
pub fn merge(folder: &Path, program: &'static Program, cache: &Cache) -> Result<(ShardPlan, Merged), ShardError> {
    let plan = ShardPlan::read(folder)?;
    plan.check(&program.about, folder)?;
    let states = states(folder, &plan, false);
    let numbers = |is: fn(&State) -> bool| -> Vec<usize> {
        states.iter().enumerate().filter(|(_, state)| is(state)).map(|(index, _)| index).collect()
    };
    let mut problems = Vec::new();
    for (word, is) in [
        ("missing", (|state| matches!(state, State::Missing)) as fn(&State) -> bool),
        ("damaged", |state| matches!(state, State::Damaged(_))),
        ("failed", |state| matches!(state, State::Failed(_))),
    ] {
        let found = numbers(is);
        if !found.is_empty() {
            problems.push(format!("{} {word} ({})", found.len(), ranges(found)));
        }
    }
    if !problems.is_empty() {
        let message = format!(
            "of {} shards in `{}` {}; `shard run {} I` computes one",
            states.len(),
            folder.display(),
            problems.join(", "),
            folder.display()
        );
        return Err(ShardError::Plan(message));
    }
    let mut all = Merged::default();
    if plan.known {
        take(&known_file(folder), &plan, None, cache)?;
    }
    for index in 0..plan.shards.len() {
        let path = pack_file(folder, index);
        let one = take(&path, &plan, Some(index), cache).map_err(|error| match error {
            ShardError::Store(StoreError::Damaged { problem, .. }) => {
                // Its header was sound, so whoever looks for missing shards would never see it; what cannot be removed is
                // found damaged again.
                let _ = std::fs::remove_file(&path);
                let folder = folder.display();
                let again = format!("it is removed, and `shard run {folder} {index}` computes it again");
                ShardError::Plan(format!("shard {index} is damaged: {problem}; {again}"))
            }
            other => other,
        })?;
        all = Merged { shards: all.shards + 1, parts: all.parts + one.parts, bytes: all.bytes + one.bytes };
    }
    Ok((plan, all))
}
