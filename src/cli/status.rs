//! `status`: what of the results is up to date, what is not, and why.
//!
//! Must not know: how it is found out.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::arguments::{Changes, Places};
use super::progress::{self, out};
use super::{Ending, json, studies};
use crate::program;
use declare::error::Diagnostic;
use declare::number::counted;
use studygraph::runner::standing::{Condition, StageStanding, Standing, standing_of};
use studygraph::store::cache::{Cache, Left, Lookup};
use studygraph::store::file;
use studygraph::store::index;
use studygraph::store::results::{FileState, Folder, Known, is_drawn};
use studygraph::study::{self, Settings, Study};

/// What is said of page and figures that are not as the last run wrote them.
pub(super) const OTHER_PAGE: &str = "the report is not that of the last run";

/// A study and where it stands.
struct Told {
    study: Study,
    standing: Standing,
    /// What reading every file found.
    read: Option<Read>,
    /// Stages that are not stale, but whose tables the cache does not have: a run computes them again.
    uncached: usize,
    /// Files that are not here and that the cache cannot give back.
    lost: Vec<String>,
}

/// Files that were read.
struct Read {
    files: usize,
    bytes: u64,
    /// Not as they were written.
    damaged: Vec<String>,
    /// Of these, texts of which the line ends alone differ.
    line_ends: Vec<String>,
    /// Nobody knows what they should be.
    unknown: Vec<String>,
    /// Files that cannot be read.
    unreadable: Vec<String>,
}

/// Why nothing can be said of a study.
enum Fault {
    Study(study::LoadError),
    Other(String),
}

/// Says it of every study; one that cannot be read silences no other. `check`: every byte is read, of the cache too,
/// and what is damaged, stale, of another run or missing ends with code 4.
pub(super) fn status(
    words: &[PathBuf],
    changes: &Changes,
    places: &Places,
    as_json: bool,
    check: bool,
) -> Result<(), Ending> {
    let settings = studies::settings(changes);
    let files = studies::named_or_all(words)?;
    // Only looked into: a missing one is not made.
    let (cache, unread) = match Cache::open_if_there(&places.cache) {
        Ok(cache) => (cache, None),
        Err(problem) => (None, Some(problem.to_string())),
    };
    if let Some(problem) = &unread {
        progress::told(&format!("warning: {problem}"));
    }
    let mut faults = Vec::new();
    let (mut all, mut values) = (Vec::new(), Vec::new());
    let (mut damaged, mut line_ends, mut lost, mut stale) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut unreadable, mut pointers) = (Vec::new(), Vec::new());
    for file in &files {
        match told(file, &settings, places, cache.as_ref(), check) {
            Ok(told) => {
                studies::distinct(&all, &told.study)?;
                if as_json {
                    values.push(value(&told));
                } else {
                    out(&(text(&told) + &pointers_text(&told.standing) + &read_text(&told)));
                }
                let folder = Folder::new(&places.results, &told.study.name);
                let path = |name: &String| folder.path().join(name).display().to_string();
                if let Some(read) = &told.read {
                    damaged.extend(read.damaged.iter().filter(|name| !read.line_ends.contains(name)).map(path));
                    line_ends.extend(read.line_ends.iter().map(path));
                    unreadable.extend(read.unreadable.iter().map(path));
                }
                let (of_lfs, not_here): (Vec<&String>, Vec<&String>) =
                    told.lost.iter().filter(|_| check).partition(|name| told.standing.pointers.contains(name));
                lost.extend(not_here.into_iter().map(path));
                pointers.extend(of_lfs.into_iter().map(path));
                if check && !is_up_to_date(&told.standing) {
                    stale.push(told.study.name.clone());
                }
                all.push(told.study);
            }
            Err(fault) => {
                let problem = match &fault {
                    // The first line names the place; help is for those who ask for this study alone.
                    Fault::Study(error) => error.to_string().lines().next().unwrap_or_default().to_owned(),
                    Fault::Other(problem) => problem.clone(),
                };
                if as_json {
                    values.push(json!({ "file": file, "problem": problem }));
                } else if files.len() > 1 {
                    out(&format!("{problem}\n"));
                }
                faults.push(fault);
            }
        }
    }
    if as_json {
        json::answer(&Value::Array(values));
    }
    let mut advice = Vec::new();
    if !damaged.is_empty() {
        advice.push(format!("damaged; `gearstudy run` writes it anew:\n  {}", damaged.join("\n  ")));
    }
    if !line_ends.is_empty() {
        let again = "`gearstudy run` writes it anew, and `results/** -text` in .gitattributes keeps git from it";
        advice.push(format!("only its line ends differ (git's autocrlf); {again}:\n  {}", line_ends.join("\n  ")));
    }
    if !pointers.is_empty() {
        advice.push(format!("pointers of Git LFS; `git lfs pull` fetches them:\n  {}", pointers.join("\n  ")));
    }
    if !lost.is_empty() {
        advice.push(format!("missing; `gearstudy run` writes it anew:\n  {}", lost.join("\n  ")));
    }
    let of_cache = cache.as_ref().filter(|_| check).map(|cache| cache.verify(true)).unwrap_or_default();
    let of_cache = |left: Left| of_cache.iter().filter(move |faulty| faulty.left == left);
    for (left, what) in [
        (Left::Nothing, "damaged in the cache, and gone from it now"),
        (Left::Damaged, "damaged in the cache, and still there"),
    ] {
        let named: Vec<String> =
            of_cache(left).map(|faulty| format!("{}: {}", faulty.path.display(), faulty.problem)).collect();
        if !named.is_empty() {
            advice.push(format!("{what}:\n  {}", named.join("\n  ")));
        }
    }
    if !stale.is_empty() {
        advice.push(format!("not up to date: {}", stale.join(", ")));
    }
    let unread_entries =
        of_cache(Left::Unread).map(|faulty| format!("cannot read `{}`: {}", faulty.path.display(), faulty.problem));
    let unread_files = unreadable.iter().map(|path| format!("cannot read `{path}`: check its permissions"));
    let unread_entries: Vec<String> = unread_entries.chain(unread_files).collect();
    if !advice.is_empty() {
        advice.extend(unread_entries.iter().cloned());
    }
    let is_invalid = |fault: &Fault| matches!(fault, Fault::Study(error) if !error.is_of_no_file());
    let (invalid, number) = (faults.iter().any(is_invalid), faults.len());
    match faults.pop() {
        None if advice.is_empty() => {
            let unread: Vec<String> = unread.into_iter().filter(|_| check).chain(unread_entries).collect();
            if unread.is_empty() { Ok(()) } else { Err(Ending::Usage(unread.join("\n"))) }
        }
        None => Err(Ending::Differs(advice.join("\n"))),
        Some(Fault::Study(error)) if files.len() == 1 => Err(Ending::Invalid(Box::new(error))),
        Some(Fault::Other(problem)) if files.len() == 1 => Err(Ending::Usage(problem)),
        Some(_) => {
            let message = format!("{number} of {} studies could not be looked at", files.len());
            Err(if invalid { Ending::Unreadable(message) } else { Ending::Usage(message) })
        }
    }
}

fn told(file: &Path, settings: &Settings, places: &Places, cache: Option<&Cache>, check: bool) -> Result<Told, Fault> {
    let study = program::load_changed(file, settings).map_err(Fault::Study)?;
    let folder = Folder::new(&places.results, &study.name);
    // What is odd while a run publishes need not be so.
    let look = || match standing_now(&study, &folder, check) {
        Ok((standing, read)) if is_odd(&standing) => Err(Box::new(Ok((standing, read)))),
        Ok(found) => Ok(found),
        Err(error) => Err(Box::new(Err(error))),
    };
    let (standing, read) = folder
        .settled(look)
        .or_else(|odd| *odd)
        .map_err(|error| Fault::Other(format!("{}: {}", study.path.display(), error.message)))?;
    let (uncached, lost) = not_here(&standing, cache);
    Ok(Told { study, standing, read, uncached, lost })
}

/// The number of stages that are not stale, but whose tables the cache does not have; and the files that are not here and that
/// the cache cannot give back.
pub(super) fn not_here(standing: &Standing, cache: Option<&Cache>) -> (usize, Vec<String>) {
    let kept = |stage: &&StageStanding| {
        let kept = |key| cache.is_some_and(|cache| matches!(cache.look_up(key), Lookup::Found(_)));
        let is_stale = !matches!(stage.state, Condition::UpToDate | Condition::OtherRun(_));
        is_stale || stage.keys.iter().all(|key| kept(*key))
    };
    let uncached: Vec<&StageStanding> = standing.stages.iter().filter(|stage| !kept(stage)).collect();
    let mut lost: Vec<String> = uncached.iter().flat_map(|stage| &stage.absent).cloned().collect();
    if standing.absent().is_empty() {
        // Where tables are missing as well, as in a clone, the run that brings them makes page and HDF5 file.
        lost.extend(standing.missing.iter().cloned());
    }
    (uncached.len(), lost)
}

fn standing_now(study: &Study, folder: &Folder, check: bool) -> Result<(Standing, Option<Read>), Diagnostic> {
    let known = folder.known().map_err(|error| Diagnostic::new(error.to_string()))?;
    let known = if check { known.map(Known::without_stamps) } else { known };
    let read = known.as_ref().filter(|_| check).map(|known| {
        let is_unreadable = |file: &String| known.state(file) == FileState::Unreadable;
        let (unreadable, damaged) = known.changed_in_parallel().into_iter().partition(is_unreadable);
        let damaged: Vec<String> = damaged;
        let (mut files, mut bytes, mut unknown) = (0, 0, Vec::new());
        for record in &known.manifest.files {
            match (known.state(&record.file), known.expected(&record.file)) {
                (FileState::Intact, Some((size, _))) => (files, bytes) = (files + 1, bytes + size),
                (FileState::Unknown, _) => unknown.push(record.file.clone()),
                _ => {}
            }
        }
        let line_ends = damaged.iter().filter(|file| known.has_other_line_ends(file)).cloned().collect();
        Read { files, bytes, damaged, line_ends, unknown, unreadable }
    });
    Ok((standing_of(study, known.as_ref())?, read))
}

/// Whether something is not as a run leaves it.
fn is_odd(standing: &Standing) -> bool {
    let damaged = standing.stages.iter().any(|stage| matches!(stage.state, Condition::Damaged(_)));
    let other_run = standing.stages.iter().any(|stage| matches!(stage.state, Condition::OtherRun(_)));
    let is_as_written = standing.foreign.is_empty() && standing.other_run.is_empty() && standing.missing.is_empty();
    damaged || other_run || !is_as_written || (!standing.report && standing.has_results)
}

/// A clone has neither all tables nor the page, and is up to date nevertheless.
pub(super) fn is_up_to_date(standing: &Standing) -> bool {
    standing.is_up_to_date() && (standing.report || !standing.absent().is_empty())
}

fn value(told: &Told) -> Value {
    let Told { study, standing, read, uncached, .. } = told;
    let report = &standing.report;
    let of_stage = |stage: &StageStanding| {
        json!({
            "name": stage.name, "state": stage.state.word(), "why": stage.state.why(), "not_here": stage.absent,
        })
    };
    let stages: Vec<Value> = standing.stages.iter().map(of_stage).collect();
    let tables_here = standing.has_results && standing.absent().is_empty();
    let mut value = json!({
        "study": study.name, "file": study.path.to_string_lossy(),
        "up_to_date": is_up_to_date(standing),
        "results": standing.has_results, "tables_here": tables_here, "stages_not_in_cache": uncached,
        "text_changed": standing.text_changed, "gone": standing.gone, "report_up_to_date": report, "stages": stages,
        "foreign": standing.foreign, "other_run": standing.other_run, "not_here": standing.missing,
        "lfs_pointers": standing.pointers,
    });
    if let Some(read) = read {
        value["damaged"] = json!(read.damaged);
        value["unknown"] = json!(read.unknown);
        value["unreadable"] = json!(read.unreadable);
    }
    value
}

/// Files that git has elsewhere.
fn pointers_text(standing: &Standing) -> String {
    match &standing.pointers[..] {
        [] => String::new(),
        [one] => format!("  `{one}` {}\n", file::POINTER),
        [first, others @ ..] => {
            let more = others.len();
            format!("  `{first}` and {more} more are pointers of Git LFS: `git lfs pull` fetches them\n")
        }
    }
}

/// What reading every file found.
fn read_text(told: &Told) -> String {
    let Some(Read { files, bytes, damaged, line_ends, unknown, unreadable }) = &told.read else { return String::new() };
    #[allow(clippy::cast_precision_loss)]
    let as_written = if *files == 1 { "as it was written" } else { "as they were written" };
    let mut text = format!("  {} {as_written} ({:.1} MB)\n", counted(*files, "file"), *bytes as f64 / 1e6);
    for file in damaged {
        let what = if line_ends.contains(file) { index::LINE_ENDS } else { "damaged" };
        text += &format!("  {file}: {what}\n");
    }
    for file in unreadable {
        text += &format!("  {file}: cannot be read\n");
    }
    for file in unknown {
        text += &format!("  {file}: not known what it was; a run tells\n");
    }
    text
}

fn text(told: &Told) -> String {
    let Told { study, standing, uncached, .. } = told;
    let next = |command: &str| format!("next: gearstudy {command} {}", study.path.display());
    if !standing.has_results {
        return format!("{}: no results; {}\n", study.name, next("run"));
    }
    let others: Vec<&StageStanding> =
        standing.stages.iter().filter(|stage| stage.state != Condition::UpToDate).collect();
    let mut parts = Vec::new();
    let is_of_other_run = |stage: &&StageStanding| matches!(stage.state, Condition::OtherRun(_));
    let of_other_run = others.iter().filter(|stage| is_of_other_run(stage)).count();
    if others.len() > of_other_run {
        parts.push(format!("{} of {} stages are not up to date", others.len(), standing.stages.len()));
    }
    let is_changed = !parts.is_empty() || standing.text_changed || !standing.foreign.is_empty();
    let has_other_run = of_other_run > 0 || !standing.other_run.is_empty();
    if has_other_run {
        let files: Vec<String> = standing.other_run.iter().map(|file| format!("`{file}`")).collect();
        let tables = match of_other_run {
            0 => None,
            1 => Some("those of 1 stage".to_owned()),
            many => Some(format!("those of {many} stages")),
        };
        let named = tables.into_iter().chain(files).collect::<Vec<_>>().join(", ");
        parts.push(format!("files of another run lie here ({named})"));
    }
    if !standing.gone.is_empty() {
        parts.push(format!("the results have stages that the study has not: {}", standing.gone.join(", ")));
    }
    if parts.is_empty() && standing.text_changed {
        parts.push("the study's file has changed, but no stage of it".to_owned());
    }
    match &standing.foreign[..] {
        [] => {}
        foreign if foreign == standing.line_ends => {
            let files = if let [one] = foreign { format!("`{one}`") } else { format!("{} files", foreign.len()) };
            parts.push(format!("only the line ends of {files} differ from those of the last run (git's autocrlf)"));
        }
        [one] => parts.push(format!("`{one}` is not as the last run wrote it")),
        [first, ..] => {
            let more = standing.foreign.len() - 1;
            parts.push(format!("`{first}` and {more} more are not as the last run wrote them"));
        }
    }
    if parts.is_empty() {
        return format!("{}: {}\n", study.name, up_to_date(standing, *uncached, next));
    }
    let again = if has_other_run && !is_changed { format!(" {}", again(standing, *uncached)) } else { String::new() };
    let mut text = format!("{}: {}; {}{again}\n", study.name, parts.join("; "), next("run"));
    let width = others.iter().map(|stage| stage.name.chars().count()).max().unwrap_or(0);
    let longest = others.iter().map(|stage| stage.state.word().len()).max().unwrap_or(0).max("missing".len());
    for stage in others {
        text += &format!("  {:width$}  {:longest$}  {}\n", stage.name, stage.state.word(), stage.state.why());
    }
    text
}

/// What a run does about files that are not here, or not its own.
fn again(standing: &Standing, uncached: usize) -> String {
    match uncached {
        0 => "takes them from the cache".to_owned(),
        some => format!("computes {some} of {} stages again", standing.stages.len()),
    }
}

/// Every stage is; what is not here, and what a run would do all the same.
fn up_to_date(standing: &Standing, uncached: usize, next: impl Fn(&str) -> String) -> String {
    let absent: Vec<&str> = standing.absent().into_iter().chain(standing.missing.iter().map(String::as_str)).collect();
    let again = again(standing, uncached);
    // A page is drawn from what is here.
    let needs_run = absent.iter().filter(|file| !is_drawn(file)).count() > 0;
    match (if needs_run { absent.len() } else { 0 }, standing.report, uncached) {
        (0, false, _) => format!("{OTHER_PAGE}; {}", next("report")),
        (0, true, 0) => "up to date".to_owned(),
        (0, true, some) => {
            let all = standing.stages.len();
            format!("up to date; the cache does not have {some} of {all} stages, so a run computes them again")
        }
        (1, ..) => format!("up to date, 1 file not here ({}); {} {again}", absent[0], next("run")),
        (many, ..) => format!("up to date, {many} files not here; {} {again}", next("run")),
    }
}
