//! Commands that run, plan, or ask what a run would do.
//!
//! Must not know: how any of it is decided.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use indicatif::MultiProgress;
use serde_json::{Value, json};

use super::arguments::{self, Places, Selection};
use super::events::{self, Lines};
use super::format::duration;
use super::pages::{self, Counts};
use super::plan::{plan_json, plan_text};
use super::progress::{self, Watcher, out, tell};
use super::scratch::Scratch;
use super::signals::stop_flag;
use super::{Ending, draw, json, studies};
use crate::program::PROGRAM;
use crate::stage::Want;
use studygraph::presence;
use studygraph::runner::events::Observer;
use studygraph::runner::execute::{self, RunError};
use studygraph::runner::fault::Fault;
use studygraph::runner::limits::{Limits, MOST_ROWS};
use studygraph::runner::note::{self, Where};
use studygraph::runner::options::{Force, Options, Wanted};
use studygraph::runner::outcome::Outcome;
use studygraph::runner::ownership;
use studygraph::runner::plan::{self, Plan};
use studygraph::store::cache::Cache;
use studygraph::store::error::StoreError;
use studygraph::store::manifest::Manifest;
use studygraph::store::results::{Folder, Tables};
use studygraph::study::Study;

/// How to run.
#[derive(Default)]
pub(super) struct How {
    pub(super) limits: arguments::Limits,
    pub(super) explain: bool,
    pub(super) keep_going: bool,
    pub(super) jobs: Option<usize>,
    pub(super) quiet: bool,
    /// As lines of JSON.
    pub(super) json: bool,
}

impl How {
    /// Whether nobody is told in words how it goes.
    fn is_silent(&self) -> bool {
        self.quiet || self.json
    }
}

pub(super) fn limits(given: &arguments::Limits) -> Limits {
    Limits { memory: given.limit_memory, rows: given.limit_rows.unwrap_or(MOST_ROWS) }
}

/// # Errors
/// A name that is neither `stage.table` nor `stage.table.column`.
pub(super) fn options(selection: &Selection, how: &How) -> Result<Options, Ending> {
    let force = match &selection.force {
        None => Force::Nothing,
        Some(names) if names.is_empty() => Force::All,
        Some(names) => Force::Stages(names.iter().cloned().collect()),
    };
    let wanted = selection.want.iter().map(|name| wanted(name).map_err(Ending::Usage)).collect::<Result<_, _>>()?;
    let (jobs, keep_going, limits) = (how.jobs.unwrap_or(0), how.keep_going, limits(&how.limits));
    Ok(Options { only: selection.only.clone(), force, wanted, jobs, keep_going, limits, ..Options::default() })
}

/// # Errors
/// As [`options`].
pub(super) fn wanted(name: &str) -> Result<Wanted, String> {
    let mut parts = name.split('.').map(str::to_owned);
    match (parts.next(), parts.next(), parts.next(), parts.next()) {
        (Some(stage), Some(table), column, None) => {
            Ok(Wanted { stage, want: Want { table, columns: column.into_iter().collect() } })
        }
        _ => Err(format!("`{name}` is not a table or column; write `stage.table` or `stage.table.column`")),
    }
}

pub(super) fn run(studies: &[Study], places: &Places, selection: &Selection, how: &How) -> Result<(), Ending> {
    let bars = progress::bars(how.is_silent());
    let stop = stop_flag(bars.clone());
    let mut failures = Vec::new();
    for study in studies {
        match run_one(study, places, selection, how, bars.as_ref(), &stop) {
            Err(Ending::Failed(message)) if how.keep_going => failures.push(message),
            Err(ending) => return Err(ending),
            Ok(()) => {}
        }
    }
    if failures.is_empty() { Ok(()) } else { Err(Ending::Failed(failures.join("; "))) }
}

/// Whether all these studies are known to be up to date without being read; says so then.
///
/// # Errors
/// As a run with these options.
pub(super) fn is_up_to_date(
    files: &[PathBuf],
    places: &Places,
    selection: &Selection,
    how: &How,
) -> Result<bool, Ending> {
    let options = options(selection, how)?;
    // Lines of JSON have the verdicts too, which no note has.
    if how.explain || how.json {
        return Ok(false);
    }
    let note = |word: &PathBuf| {
        let study = &studies::file(word).ok()?;
        let at = Where { study, results: &places.results, cache: &places.cache };
        note::of(&at, PROGRAM.about.code, &options)
    };
    let Some(notes) = files.iter().map(note).collect::<Option<Vec<_>>>() else { return Ok(false) };
    let names: BTreeSet<&str> = notes.iter().map(|note| note.study.as_str()).collect();
    if names.len() < notes.len() {
        return Ok(false);
    }
    for note in &notes {
        note.tell_warnings(&Watcher::new(how.is_silent(), 0, None));
        if !how.quiet {
            let folder = Folder::new(&places.results, &note.study);
            tell(&nothing_to_do(&note.study, note.stages, &folder));
        }
    }
    Ok(!notes.is_empty())
}

fn count(stages: usize) -> String {
    format!("{stages} stage{}", if stages == 1 { "" } else { "s" })
}

fn nothing_to_do(study: &str, stages: usize, folder: &Folder) -> String {
    format!("{study}: nothing to do, {} up to date; {}\n", count(stages), pages::path(folder).display())
}

pub(super) fn run_one(
    study: &Study,
    places: &Places,
    selection: &Selection,
    how: &How,
    bars: Option<&MultiProgress>,
    stop: &AtomicBool,
) -> Result<(), Ending> {
    let cache = Cache::open_if_possible(&places.cache);
    let folder = Folder::new(&places.results, &study.name).telling(progress::told);
    let options = options(selection, how)?;
    let lines = how.json.then(|| Lines::of(study));
    if how.explain {
        let plan = plan::plan(study, &cache, &options).map_err(|error| Ending::without_place(&error))?;
        match lines {
            Some(_) => events::line(&json!({ "event": "planned", "plan": plan_json(study, &plan) })),
            None => tell(&plan_text(study, &plan)),
        }
    }
    let width = study.nodes.iter().map(|node| node.name.chars().count()).max().unwrap_or(0);
    let watcher = Watcher::new(how.is_silent(), width, bars.cloned());
    let observer: &dyn Observer = lines.as_ref().map_or(&watcher, |lines| lines);
    // Tables are read while the folder is locked; afterwards they may be those of another run.
    let verdicts = RefCell::new(None);
    let draw = |manifest: &Manifest, tables: Tables<'_>| {
        let drawn = pages::draw(manifest, tables)?;
        verdicts.replace(Some(Counts::of(manifest, tables)));
        Ok(drawn)
    };
    let run = || execute::run(study, &cache, &options, observer, stop, &folder, Some(&draw));
    let (outcome, published) = watcher.telling(run).map_err(|error| match error {
        RunError::Study(diagnostic) => Ending::without_place(&diagnostic),
        RunError::Beyond(diagnostic) => Ending::Invalid(Box::new(study.refused(*diagnostic))),
        RunError::Store(StoreError::Stopped { .. }) => Ending::Stopped,
        other => Ending::Usage(other.to_string()),
    })?;
    for file in &published.changes.foreign {
        // Somebody else had changed it.
        let message = format!("`{file}` was not what the last run wrote; it is written anew");
        match &lines {
            Some(lines) => lines.note(&message),
            None if how.quiet => {}
            None => tell(&format!("{}: {message}\n", study.name)),
        }
    }
    if let Some(problem) = published.undrawn {
        return Err(Ending::Usage(problem));
    }
    succeeded(study, &outcome)?;
    let verdicts = verdicts.take();
    match &lines {
        Some(lines) => {
            let manifest = &published.manifest;
            let counts =
                verdicts.unwrap_or_else(|| Counts::of(manifest, &pages::read(&folder, manifest, &places.cache)));
            lines.finished(outcome.stages.len(), outcome.ran(), outcome.seconds, &folder, &counts);
        }
        None if how.quiet => {}
        None => tell(&summed_up(study, &outcome, &folder, verdicts.as_ref())),
    }
    Ok(())
}

/// # Errors
/// What ended the run before everything was there.
fn succeeded(study: &Study, outcome: &Outcome) -> Result<(), Ending> {
    if outcome.stopped {
        return Err(Ending::Stopped);
    }
    for (_, fault) in outcome.faults() {
        if let Fault::Study(wrong) = fault {
            draw::invalid_study(&study.refused(wrong.clone()));
        }
    }
    let failed: Vec<&str> = outcome.faults().map(|(stage, _)| stage).collect();
    if !failed.is_empty() {
        return Err(Ending::Failed(format!("{}: {} failed", study.name, failed.join(", "))));
    }
    Ok(())
}

fn summed_up(study: &Study, outcome: &Outcome, folder: &Folder, verdicts: Option<&Counts>) -> String {
    let work = match (outcome.ran(), verdicts) {
        (0, None) => return nothing_to_do(&study.name, outcome.stages.len(), folder),
        (0, Some(_)) => "nothing to compute, results brought up to date".to_owned(),
        (ran, _) => format!("{} ran in {}", count(ran), duration(outcome.seconds)),
    };
    let verdicts = verdicts.map(Counts::summary).filter(|text| !text.is_empty()).map(|text| format!("; {text}"));
    format!("{}: {work}{}; {}\n", study.name, verdicts.unwrap_or_default(), pages::path(folder).display())
}

/// # Errors
/// When a run would replace the results of another study of the same name.
pub(super) fn check_owner(study: &Study, places: &Places) -> Result<(), Ending> {
    ownership::check(study, &Folder::new(&places.results, &study.name))
        .map(drop)
        .map_err(|error| Ending::without_place(&error))
}

/// A plan writes nothing: where there is no cache yet, an empty one elsewhere stands for it.
pub(super) fn plan_of(study: &Study, places: &Places, options: &Options) -> Result<Plan, Ending> {
    check_owner(study, places)?;
    let elsewhere;
    // One that cannot be read is opened, which says why.
    let root = if presence::exists(&places.cache).unwrap_or(true) {
        places.cache.as_path()
    } else {
        elsewhere = Scratch::new()?;
        elsewhere.path()
    };
    // As a run, which does without one that cannot be opened.
    let cache = Cache::open_if_possible(root);
    let plan = plan::plan(study, &cache, options).map_err(|error| Ending::without_place(&error));
    let (entries, journal) = cache.problems();
    for problem in entries.into_iter().chain(journal) {
        progress::told(&format!("warning: {problem}"));
    }
    plan
}

pub(super) fn plan(
    studies: &[Study],
    places: &Places,
    selection: &Selection,
    how: &How,
    as_json: bool,
) -> Result<(), Ending> {
    let mut all = Vec::new();
    for study in studies {
        let plan = plan_of(study, places, &options(selection, how)?)?;
        progress::warned(study);
        if as_json {
            all.push(plan_json(study, &plan));
        } else {
            out(&plan_text(study, &plan));
        }
    }
    if as_json {
        json::answer(&Value::Array(all));
    }
    Ok(())
}
