//! Dividing a study up: which parts of which stages belong to which shard.
//!
//! The plan follows from the study, the program, the number of shards and what the cache knows already. Parts stay in
//! their order and are cut where the foreseen cost says. Must not know: how a shard is computed.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{CHEAP, ShardError, known_file, plan_file};
use crate::about::About;
use crate::presence;
use crate::program::Program;
use crate::runner::board::{Board, StageState};
use crate::runner::events::Silent;
use crate::runner::execute::RunError;
use crate::runner::foresee::foresee;
use crate::runner::options::{Options, Share, Wanted};
use crate::stage::Want;
use crate::store::cache::Cache;
use crate::store::error::StoreError;
use crate::store::file::{self, Durability};
use crate::store::shards::{self, Part};
use crate::study::{self, Study, load_text};

const FORMAT: u32 = 1;
/// A part that is said to cost nothing costs its file.
const LEAST: f64 = 1e-3;

/// `plan.json`. Field names are read by other programs: additions only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShardPlan {
    pub format: u32,
    /// Of the program.
    pub version: String,
    pub code: String,
    pub dependencies: String,
    pub study: String,
    /// Where the study was read.
    pub path: PathBuf,
    /// BLAKE3 of its text.
    pub study_digest: String,
    pub text: String,
    pub only: Vec<String>,
    /// `stage.table` or `stage.table.column`.
    pub want: Vec<String>,
    /// Whether there is a `known.pack`.
    pub known: bool,
    /// The first shard of each level and the one behind its last.
    pub levels: Vec<Level>,
    pub shards: Vec<Shard>,
    /// BLAKE3 of the file; it names the plan in every pack.
    #[serde(skip)]
    pub digest: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Level {
    pub first: usize,
    pub end: usize,
}

/// What one shard computes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shard {
    pub level: usize,
    /// Foreseen, on one thread.
    pub seconds: f64,
    /// By stage, ranges of parts: first and last.
    pub parts: BTreeMap<String, Vec<(usize, usize)>>,
}

impl Shard {
    /// As the options of a run have it.
    #[must_use]
    pub fn share(&self) -> Share {
        let numbers = |ranges: &Vec<(usize, usize)>| ranges.iter().flat_map(|&(first, last)| first..=last).collect();
        self.parts.iter().map(|(stage, ranges)| (stage.clone(), numbers(ranges))).collect()
    }
}

/// Divides a study into at most `count` shards, and writes the plan into `folder`; whether there was the same one already.
///
/// # Errors
/// When the folder has another plan; when it cannot be written; what is wrong with the study's graph or the options.
pub fn plan(
    study: &Study,
    cache: &Cache,
    options: &Options,
    count: usize,
    folder: &Path,
) -> Result<(ShardPlan, bool), ShardError> {
    let made = divided(study, cache, options, count)?;
    match ShardPlan::read(folder) {
        Ok(there)
            if (&there.study_digest, &there.only, &there.want)
                == (&made.0.study_digest, &made.0.only, &made.0.want) =>
        {
            there.check(&study.program.about, folder)?;
            return Ok((there, true));
        }
        Ok(there) => {
            let problem = if there.study == study.name { "for another text of it" } else { "of another study" };
            return Err(ShardError::Plan(format!(
                "`{}` has a plan of `{}`, {problem}; name another folder, or remove that one",
                folder.display(),
                there.study
            )));
        }
        Err(_) if !presence::exists(&plan_file(folder)).map_err(StoreError::io("read", &plan_file(folder)))? => {}
        Err(error) => return Err(error),
    }
    let (mut plan, known) = made;
    std::fs::create_dir_all(folder.join("shards")).map_err(StoreError::io("make the folder", folder))?;
    let bytes = serde_json::to_vec(&plan)
        .map_err(|error| StoreError::Format { table: "plan".to_owned(), problem: error.to_string() })?;
    plan.digest = blake3::hash(&bytes).to_string();
    if plan.known {
        shards::write(&known_file(folder), &plan.digest, None, cache, &known)?;
    }
    // Last: where there is a plan, all it needs is there.
    file::write(&plan_file(folder), &bytes, Durability::Synced)?;
    Ok((plan, false))
}

impl ShardPlan {
    /// # Errors
    /// When there is none that can be read.
    pub fn read(folder: &Path) -> Result<Self, ShardError> {
        let path = plan_file(folder);
        let wrong = |problem: String| ShardError::Plan(format!("`{}`: {problem}", path.display()));
        let bytes = file::read(&path, file::MOST_TABLE).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => {
                ShardError::Plan(format!("`{}` has no plan; `shard plan STUDY --into` makes one", folder.display()))
            }
            _ => wrong(error.to_string()),
        })?;
        let mut plan: Self =
            serde_json::from_slice(&bytes).map_err(|error| wrong(format!("it is no plan: {error}")))?;
        if plan.format != FORMAT {
            return Err(wrong(format!("it has format {}; this version reads format {FORMAT}", plan.format)));
        }
        if study::digest(&plan.text) != plan.study_digest {
            return Err(wrong("the study in it is not the one that was planned".to_owned()));
        }
        plan.digest = blake3::hash(&bytes).to_string();
        Ok(plan)
    }

    /// Whether this program gives what the plan is for.
    ///
    /// # Errors
    /// When it was built from other sources than the one that planned.
    pub fn check(&self, about: &About, folder: &Path) -> Result<(), ShardError> {
        if (self.code.as_str(), self.dependencies.as_str()) == (about.code, about.dependencies) {
            return Ok(());
        }
        let short = |code: &str| code.chars().take(8).collect::<String>();
        let what = if self.code == about.code { "other dependencies" } else { "other sources" };
        Err(ShardError::Plan(format!(
            "`{}` was planned by version {} (code {}), and this is version {} (code {}), built from {what}: their numbers may \
             differ, so they are never mixed; use that program, or plan again into another folder",
            folder.display(),
            self.version,
            short(&self.code),
            about.version,
            short(about.code)
        )))
    }

    /// The study that was planned.
    ///
    /// # Errors
    /// When this program does not read it.
    pub fn load(&self, program: &'static Program) -> Result<Study, ShardError> {
        load_text(&self.text, &self.path, program).map_err(|error| ShardError::Study(Box::new(error)))
    }

    /// The options that say what is planned, with those that say how it is run.
    #[must_use]
    pub fn options(&self, how: &Options) -> Options {
        let wanted = self.want.iter().filter_map(|name| {
            let mut words = name.splitn(3, '.').map(str::to_owned);
            let (stage, table) = (words.next()?, words.next()?);
            Some(Wanted { stage, want: Want { table, columns: words.collect() } })
        });
        Options { only: self.only.clone(), wanted: wanted.collect(), ..how.clone() }
    }

    /// # Errors
    /// When there is no shard of this number.
    pub fn shard(&self, index: usize) -> Result<&Shard, ShardError> {
        self.shards.get(index).ok_or_else(|| {
            let message = match self.shards.len() {
                0 => format!("there is no shard {index}: the plan has none, nothing is left to compute"),
                count => format!("there is no shard {index}; the plan has 0 to {}", count - 1),
            };
            ShardError::Plan(message)
        })
    }
}

/// The plan, and what of the cache goes with it.
fn divided(
    study: &Study,
    cache: &Cache,
    options: &Options,
    count: usize,
) -> Result<(ShardPlan, Vec<Part>), ShardError> {
    let mut board = Board::new(study, cache, options, &Silent).map_err(RunError::Study)?;
    board.settle();
    let mut foresight = foresee(&board, 1, None);
    // What is made of all other parts is left to whoever has them: a later level, or the merge.
    for (own, of_study) in foresight.parts.iter_mut().zip(&study.nodes) {
        if let Some(parts) = of_study.stage.parts().filter(|parts| parts.last_is_of_all) {
            own.retain(|(part, _)| part + 1 < parts.each.len());
        }
    }
    let nodes = study.nodes.len();
    let (mut levels, mut divides, mut reads) = (vec![0; nodes], vec![false; nodes], vec![false; nodes]);
    for &node in &board.graph.order {
        if board.nodes[node].state == StageState::Skipped {
            continue;
        }
        let parts = &foresight.parts[node];
        let seconds: f64 = parts.iter().map(|(_, seconds)| seconds).sum();
        divides[node] = !parts.is_empty() && (parts.len() > 1 || seconds > CHEAP);
        let below = board.graph.inputs[node].iter().map(|input| levels[input.node] + usize::from(divides[input.node]));
        levels[node] = below.max().unwrap_or(0);
    }
    for &node in board.graph.order.iter().rev() {
        if divides[node] || reads[node] {
            board.graph.inputs[node].iter().for_each(|input| reads[input.node] = true);
        }
    }
    // What shards read, was computed before, and costs more than to read it.
    let mut known = Vec::new();
    for node in (0..nodes).filter(|&node| reads[node]) {
        let progress = &board.nodes[node];
        if progress.parts.len() > 1 || progress.seconds() > CHEAP {
            let entries = progress.known.iter().enumerate().filter(|(_, known)| known.entry.is_some());
            known.extend(entries.map(|(part, _)| (study.nodes[node].name.clone(), part, progress.parts[part].key)));
        }
    }
    let all: f64 = (0..nodes).filter(|&node| divides[node]).map(|node| cost(&foresight.parts[node])).sum();
    let mut plan = ShardPlan {
        format: FORMAT,
        version: study.program.about.version.to_owned(),
        code: study.program.about.code.to_owned(),
        dependencies: study.program.about.dependencies.to_owned(),
        study: study.name.clone(),
        path: study.path.clone(),
        study_digest: study::digest(&study.text),
        text: study.text.clone(),
        only: options.only.clone(),
        want: options.wanted.iter().map(written).collect(),
        known: !known.is_empty(),
        levels: Vec::new(),
        shards: Vec::new(),
        digest: String::new(),
    };
    for level in 0..=levels.iter().copied().max().unwrap_or(0) {
        let of_level = || board.graph.order.iter().filter(|&&node| divides[node] && levels[node] == level);
        let total: f64 = of_level().map(|&node| cost(&foresight.parts[node])).sum();
        let first = plan.shards.len();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let wanted = ((count as f64 * total / all).round() as usize).clamp(1, count);
        let mut before = 0.0;
        let mut last = None;
        for &node in of_level() {
            for &(part, seconds) in &foresight.parts[node] {
                // By the middle of its cost, so that a large part is nobody's neighbour by accident.
                let middle = before + 0.5 * (seconds + LEAST);
                before += seconds + LEAST;
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                let slot = ((middle / total * wanted as f64) as usize).min(wanted - 1);
                if last != Some(slot) {
                    plan.shards.push(Shard { level, seconds: 0.0, parts: BTreeMap::new() });
                    last = Some(slot);
                }
                if let Some(shard) = plan.shards.last_mut() {
                    add(shard, &study.nodes[node].name, part, seconds);
                }
            }
        }
        if plan.shards.len() > first {
            plan.levels.push(Level { first, end: plan.shards.len() });
        }
    }
    // Levels on which nothing is to be computed have no number.
    for (number, level) in plan.levels.clone().into_iter().enumerate() {
        plan.shards[level.first..level.end].iter_mut().for_each(|shard| shard.level = number);
    }
    Ok((plan, known))
}

fn cost(parts: &[(usize, f64)]) -> f64 {
    parts.iter().map(|(_, seconds)| seconds + LEAST).sum()
}

fn add(shard: &mut Shard, stage: &str, part: usize, seconds: f64) {
    shard.seconds += seconds;
    let ranges = shard.parts.entry(stage.to_owned()).or_default();
    match ranges.last_mut() {
        Some((_, last)) if *last + 1 == part => *last = part,
        _ => ranges.push((part, part)),
    }
}

fn written(wanted: &Wanted) -> String {
    let columns = wanted.want.columns.iter().map(|column| format!(".{column}"));
    format!("{}.{}{}", wanted.stage, wanted.want.table, columns.collect::<String>())
}
