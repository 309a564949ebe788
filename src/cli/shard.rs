//! `shard`: a run in pieces, by whoever starts them.
//!
//! Must not know: how a study is divided up, what a pack holds.

use std::path::{Path, PathBuf};

use serde_json::{Value as Json, json};

use super::arguments::{Limits, Output, Places, Selection, Sharding};
use super::engine::kubernetes;
use super::format::{duration, rough};
use super::progress::{self, Watcher, out};
use super::scratch::Scratch;
use super::signals::stop_flag;
use super::studies::load_all;
use super::{Ending, events, json, run};
use crate::program::PROGRAM;
use studygraph::runner::execute::RunError;
use studygraph::runner::options::Options;
use studygraph::runner::shard::{self, Ran, ShardError, ShardPlan, State, ranges};
use studygraph::store::cache::Cache;
use studygraph::study::Study;

pub(super) fn shard(asked: &Sharding, places: &Places, quiet: bool) -> Result<(), Ending> {
    match asked {
        Sharding::Plan { study, changes, only, want, shards, into, manifest, output } => {
            let study = &load_all(std::slice::from_ref(study), changes)?[0];
            let selection = Selection { only: only.clone(), want: want.clone(), force: None };
            let plan = planned(study, places, &selection, *shards as usize, into, told(quiet, *output))?;
            if let Some(image) = manifest {
                kubernetes::write(&plan, into, image, quiet || output.is_json())?;
            }
            Ok(())
        }
        Sharding::Run { folder, shard, limits, jobs, output } => {
            one(folder, *shard, limits, jobs.map(usize::from), told(quiet, *output))
        }
        Sharding::Status { folder, check, missing, output } => status(folder, *check, *missing, output.is_json()),
        Sharding::Merge { folder, limits, jobs, output } => {
            let result = merge(folder, places, limits, jobs.map(usize::from), told(quiet, *output));
            if output.is_json() {
                events::ended(&result);
            }
            result
        }
    }
}

/// How it is told what was done.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Told {
    Nothing,
    Words,
    Json,
}

pub(super) const fn told(quiet: bool, output: Output) -> Told {
    match (output.is_json(), quiet) {
        (true, _) => Told::Json,
        (false, true) => Told::Nothing,
        (false, false) => Told::Words,
    }
}

/// What is wrong, and the exit code that belongs to it.
pub(super) fn ending(error: ShardError) -> Ending {
    match error {
        ShardError::Study(error) => Ending::Invalid(error),
        ShardError::Failed(message) => Ending::Failed(message),
        ShardError::Stopped => Ending::Stopped,
        ShardError::Run(RunError::Study(found)) => Ending::Usage(found.to_string()),
        ShardError::Run(RunError::Beyond(found)) => Ending::Beyond(found.to_string()),
        other => Ending::Usage(other.to_string()),
    }
}

/// Divides a study up, or finds that it was.
pub(super) fn planned(
    study: &Study,
    places: &Places,
    selection: &Selection,
    count: usize,
    into: &Path,
    told: Told,
) -> Result<ShardPlan, Ending> {
    run::check_owner(study, places)?;
    let options = run::options(selection, &run::How::default())?;
    // Only looked into: what is known already is not computed again.
    let known = Cache::open_if_there(&places.cache).unwrap_or_else(|problem| {
        progress::told(&format!("warning: {problem}"));
        None
    });
    let elsewhere = Scratch::new()?;
    let cache = known.unwrap_or_else(|| Cache::open_if_possible(elsewhere.path()));
    let (plan, was_there) = shard::plan(study, &cache, &options, count, into).map_err(ending)?;
    let longest = plan.shards.iter().map(|shard| shard.seconds).fold(0.0, f64::max);
    let all: f64 = plan.shards.iter().map(|shard| shard.seconds).sum();
    if told == Told::Json {
        json::answer(&json!({
            "study": plan.study, "folder": into.display().to_string(), "plan": plan.digest, "was_there": was_there,
            "shards": plan.shards.len(), "levels": plan.levels.len(), "seconds": all, "longest_seconds": longest,
        }));
    } else if told == Told::Words {
        let word = if was_there { "was planned already" } else { "planned" };
        let text = match (plan.shards.len(), plan.levels.len()) {
            (0, _) => format!("{}: {word}: nothing is left to compute but what `shard merge` does", plan.study),
            (shards, levels) => {
                let levels = if levels > 1 { format!(" on {levels} levels") } else { String::new() };
                let (folder, last) = (into.display(), shards - 1);
                format!(
                    "{}: {word}: {shards} shards{levels}, ~ {} on one thread, the longest ~ {}; next: gearstudy shard run \
                     {folder} I for I from 0 to {last}, then gearstudy shard merge {folder}",
                    plan.study,
                    rough(all),
                    rough(longest)
                )
            }
        };
        out(&(text + "\n"));
    }
    Ok(plan)
}

fn one(folder: &Path, index: usize, limits: &Limits, jobs: Option<usize>, told: Told) -> Result<(), Ending> {
    let scratch = Scratch::new()?;
    let silent = told != Told::Words;
    let bars = progress::bars(silent);
    let stop = stop_flag(bars.clone());
    let watcher = Watcher::new(silent, 12, bars);
    let how = Options { jobs: jobs.unwrap_or(0), limits: run::limits(limits), ..Options::default() };
    let ran = watcher.telling(|| shard::compute(folder, index, scratch.path(), &PROGRAM, &how, &watcher, &stop));
    let ran = ran.map_err(ending)?;
    if told == Told::Json {
        let (state, parts, bytes, seconds) = match ran {
            Ran::Already => ("was there", 0, 0, 0.0),
            Ran::Packed { parts, bytes, seconds } => ("packed", parts, bytes, seconds),
        };
        json::answer(&json!({
            "shard": index, "state": state, "parts": parts, "bytes": bytes, "seconds": seconds,
        }));
        return Ok(());
    }
    let line = match ran {
        Ran::Already => format!("shard {index}: nothing to do, its pack is there\n"),
        Ran::Packed { parts, bytes, seconds } => {
            #[allow(clippy::cast_precision_loss)]
            let megabytes = bytes as f64 / 1e6;
            format!("shard {index}: {parts} parts in {}, {megabytes:.1} MB\n", duration(seconds))
        }
    };
    if told == Told::Words {
        out(&line);
    }
    Ok(())
}

/// Where every shard stands; a damaged one ends with code 4.
fn status(folder: &Path, check: bool, missing: bool, as_json: bool) -> Result<(), Ending> {
    let plan = ShardPlan::read(folder).map_err(ending)?;
    let states = shard::states(folder, &plan, check);
    let of = |is: fn(&State) -> bool| -> Vec<usize> {
        states.iter().enumerate().filter(|(_, state)| is(state)).map(|(index, _)| index).collect()
    };
    let sound = of(|state| *state == State::Sound);
    let absent = of(|state| *state == State::Missing);
    let damaged = of(|state| matches!(state, State::Damaged(_)));
    let failed = of(|state| matches!(state, State::Failed(_)));
    if missing {
        for index in of(|state| *state != State::Sound) {
            out(&format!("{index}\n"));
        }
        return Ok(());
    }
    let problem = |index: &usize| match &states[*index] {
        State::Damaged(problem) | State::Failed(problem) => problem.clone(),
        State::Sound | State::Missing => String::new(),
    };
    if as_json {
        let named = |numbers: &[usize]| -> Vec<Json> {
            numbers.iter().map(|index| json!({ "shard": index, "problem": problem(index) })).collect()
        };
        let levels: Vec<Json> = plan.levels.iter().map(|level| json!([level.first, level.end])).collect();
        let value = json!({
            "study": plan.study, "plan": plan.digest, "shards": states.len(), "levels": levels, "sound": sound,
            "missing": absent, "damaged": named(&damaged), "failed": named(&failed),
        });
        json::answer(&value);
    } else {
        let count = |word: &str, numbers: &[usize]| match numbers.len() {
            0 => String::new(),
            count => format!(", {count} {word} ({})", ranges(numbers.iter().copied())),
        };
        out(&format!(
            "{}: {} of {} shards are there{}{}{}\n",
            plan.study,
            sound.len(),
            states.len(),
            count("missing", &absent),
            count("damaged", &damaged),
            count("failed", &failed)
        ));
        for index in damaged.iter().chain(&failed) {
            out(&format!("  shard {index}: {}\n", problem(index)));
        }
    }
    if damaged.is_empty() { Ok(()) } else { Err(Ending::Differs(String::new())) }
}

/// Takes all shards into the cache and publishes as a run does.
pub(super) fn merge(
    folder: &Path,
    places: &Places,
    limits: &Limits,
    jobs: Option<usize>,
    told: Told,
) -> Result<(), Ending> {
    let (plan, merged) = {
        let cache = Cache::open_if_possible(&places.cache);
        let merged = shard::merge(folder, &PROGRAM, &cache).map_err(ending)?;
        if let Some(problem) = cache.problems().0 {
            return Err(Ending::Usage(format!(
                "the cache `{}` does not take the shards: {problem}",
                places.cache.display()
            )));
        }
        merged
    };
    match told {
        Told::Nothing => {}
        Told::Json => events::line(&json!({
            "event": "merged", "study": plan.study, "parts": merged.parts, "shards": merged.shards,
            "bytes": merged.bytes,
        })),
        Told::Words => {
            #[allow(clippy::cast_precision_loss)]
            let megabytes = merged.bytes as f64 / 1e6;
            out(&format!("{}: {} parts of {} shards, {megabytes:.1} MB\n", plan.study, merged.parts, merged.shards));
        }
    }
    let study = plan.load(&PROGRAM).map_err(ending)?;
    let selection = Selection { only: plan.only.clone(), want: plan.want.clone(), force: None };
    let (quiet, json) = (told == Told::Nothing, told == Told::Json);
    let how = run::How { limits: *limits, jobs, quiet, json, ..run::How::default() };
    run::run(std::slice::from_ref(&study), places, &selection, &how)
}

/// Where a plan lies when nobody says: a folder of its own for each text of a study and each program.
pub(super) fn default_folder(study: &Study) -> PathBuf {
    let of = format!("{}{}{}", study.text, PROGRAM.about.code, PROGRAM.about.dependencies);
    let digest = declare::digest::Writer::new("gearstudy 1 shards").text(&of).finish().to_string();
    Path::new(".gearstudy/shards").join(format!("{}-{}", study.name, &digest[..8]))
}
