//! What the command line does with studies, for a program that has this one in it: nothing is printed, no signal is taken.
//!
//! Must not know: who calls.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use serde_json::Value;

use super::arguments::CACHE;
use super::diff::curves;
use super::events::Lines;
use super::plan::plan_json;
use super::{pages, run};
use declare::error::Diagnostic;
use studygraph::diff::compare::{self, compare};
use studygraph::history::side::{Side, published};
use studygraph::presence;
use studygraph::runner::execute::{self, RunError};
use studygraph::runner::fault::Fault;
use studygraph::runner::options::{Options, Wanted};
use studygraph::store::cache::Cache;
use studygraph::store::manifest::{StageRecord, TableRecord};
use studygraph::store::results::Folder;
use studygraph::study::Study;
use studygraph::table::data::Table;

/// Where results and computed tables lie.
#[derive(Clone, Debug)]
pub struct Places {
    results: PathBuf,
    cache: PathBuf,
}

/// Why a study did not run to its end.
#[derive(Debug)]
pub enum Problem {
    /// What the study says is wrong, with its place.
    Study(Vec<Diagnostic>),
    /// What was asked, computed, read or written.
    Said(String),
    /// Somebody asked it to stop.
    Stopped,
}

impl Places {
    /// A cache that is not named is that of the command line.
    #[must_use]
    pub fn new(results: PathBuf, cache: Option<PathBuf>) -> Self {
        let of_environment = || std::env::var_os("GEARSTUDY_CACHE").filter(|path| !path.is_empty()).map(PathBuf::from);
        let cache = cache.or_else(of_environment).unwrap_or_else(|| PathBuf::from(CACHE));
        Self { results, cache }
    }

    /// The folder of a study's results.
    #[must_use]
    pub fn folder(&self, study: &str) -> Folder {
        Folder::new(&self.results, study)
    }

    fn check(&self) -> Result<(), Problem> {
        let places = super::Places { results: self.results.clone(), cache: self.cache.clone() };
        places.check().map_err(Problem::Said)
    }
}

/// A table or column that is wanted although nothing reads it.
///
/// # Errors
/// A name that is neither `stage.table` nor `stage.table.column`.
pub fn wanted(name: &str) -> Result<Wanted, String> {
    run::wanted(name)
}

/// The page of a study's results; none before it was run.
///
/// # Errors
/// When it cannot be read.
pub fn page(folder: &Folder) -> Result<Option<PathBuf>, String> {
    let page = pages::path(folder);
    let is_there = presence::is_file(&page).map_err(presence::unread(&page))?;
    Ok(Some(page).filter(|_| is_there))
}

/// A table of the results of a study; from the cache where it is not there, or another run left its own.
///
/// # Errors
/// When it is damaged, or nobody has it.
pub fn table(study: &str, places: &Places, stage: &StageRecord, record: &TableRecord) -> Result<Table, String> {
    published(&places.folder(study), stage, record, &|| Cache::open_if_there(&places.cache))
}

/// Runs a study and publishes its results; `tell` hears the events of `gearstudy run --format json`.
///
/// # Errors
/// Why it did not come to its end; what is finished is kept.
pub fn run(
    study: &Study,
    places: &Places,
    options: &Options,
    tell: &(dyn Fn(&Value) + Sync),
    stop: &AtomicBool,
) -> Result<(), Problem> {
    places.check()?;
    let cache = Cache::open_if_possible(&places.cache);
    let folder = places.folder(&study.name);
    let lines = Lines::telling(&study.name, tell);
    let ran = execute::run(study, &cache, options, &lines, stop, &folder, Some(&pages::draw));
    let (outcome, published) = ran.map_err(|error| match error {
        RunError::Study(wrong) => Problem::Study(vec![wrong]),
        RunError::Beyond(wrong) => Problem::Study(vec![*wrong]),
        RunError::Store(studygraph::store::error::StoreError::Stopped { .. }) => Problem::Stopped,
        other => Problem::Said(other.to_string()),
    })?;
    if outcome.stopped {
        return Err(Problem::Stopped);
    }
    let of_study = outcome.faults().find_map(|(_, fault)| match fault {
        Fault::Study(wrong) => Some(wrong.clone().into_iter().collect()),
        _ => None,
    });
    if let Some(wrong) = of_study {
        return Err(Problem::Study(wrong));
    }
    let failed: Vec<String> = outcome.faults().map(|(stage, fault)| format!("`{stage}`: {fault}")).collect();
    if !failed.is_empty() {
        return Err(Problem::Said(failed.join("; ")));
    }
    published.undrawn.map_or(Ok(()), |problem| Err(Problem::Said(problem)))
}

/// What a run would do, as `gearstudy plan --format json` has it.
///
/// # Errors
/// Names in the options that are no stages, tables or columns; a cache that is there and cannot be read is done without.
pub fn plan(study: &Study, places: &Places, options: &Options) -> Result<Value, Problem> {
    places.check()?;
    let places = super::Places { results: places.results.clone(), cache: places.cache.clone() };
    match run::plan_of(study, &places, options) {
        Ok(plan) => Ok(plan_json(study, &plan)),
        Err(ending) => Err(Problem::Said(ending.to_string())),
    }
}

/// What differs between two folders of results, as `gearstudy diff --format json` has it.
///
/// # Errors
/// When one of them cannot be read.
pub fn diff(before: &Folder, after: &Folder) -> Result<Value, String> {
    let side = |folder: &Folder| Side::folder(folder.path(), folder.path().display().to_string());
    let options = compare::Options { curves: Some(&curves), ..compare::Options::default() };
    let comparison = compare(&side(before)?, &side(after)?, &options)?;
    serde_json::to_value(comparison).map_err(|error| format!("the comparison cannot be written: {error}"))
}
