//! The command `diff`: finds out which words are revisions, folders and studies, compares, and prints.
//!
//! Must not know: what is compared.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::arguments::{Differences, Places, Shown};
use super::pages::terminal_width;
use super::progress::out;
use super::{Ending, studies};
use crate::program;
use crate::stage::kind;
use declare::error::nearest;
use studygraph::diff::compare::{Options, compare};
use studygraph::diff::model::{Comparison, Stale};
use studygraph::diff::{html, markdown, pretty};
use studygraph::history::git::Repository;
use studygraph::history::side::Side;
use studygraph::presence;
use studygraph::runner::standing::{Condition, StageStanding, standing_of};
use studygraph::store::cache::Cache;
use studygraph::store::lock::Lock;
use studygraph::store::results::{Folder, MANIFEST};
use studygraph::table::tolerance::Allowance;

/// What is compared with what: a revision or a folder each.
struct Asked {
    sides: Vec<Side>,
    studies: Vec<String>,
}

pub(super) fn diff(asked: &Differences, places: &Places, quiet: bool) -> Result<(), Ending> {
    let tolerances: Vec<Allowance> =
        asked.tolerances.iter().map(|text| Allowance::parse(text)).collect::<Result<_, _>>().map_err(Ending::Usage)?;
    // A results folder that is a link, or lies in another repository than the current folder, is found from itself.
    let repository = Repository::around(&places.results);
    let Asked { mut sides, studies } = read_words(asked, places, &repository).map_err(Ending::Usage)?;
    let is_ours = sides.len() < 2;
    if is_ours && repository.as_ref().is_ok_and(Repository::is_bare) {
        let message = "a bare repository has no results folder: name two revisions, `gearstudy diff OLD NEW`";
        return Err(Ending::Usage(message.to_owned()));
    }
    let after = if is_ours { working_tree(places)? } else { sides.remove(1) };
    let before = match sides.pop() {
        Some(before) => before,
        None => of_revision("HEAD", places, &repository).map_err(Ending::Usage)?,
    };
    let cache = Cache::open_if_there(&places.cache).map_err(|error| Ending::Usage(error.to_string()))?;
    let ignored = |study: &str| {
        let (Ok(repository), Some(folder), None) = (&repository, after.path(), before.path()) else { return Ok(false) };
        repository.leaves_out(&folder.join(study).join(MANIFEST))
    };
    // Outside of a repository every file counts.
    let not_kept = |file: &Path| Repository::around(file).map_or(Ok(false), |repository| repository.leaves_out(file));
    let options = Options {
        studies: &studies,
        tolerances: &tolerances,
        cache: cache.as_ref(),
        leaves_out: Some(&ignored),
        curves: Some(&curves),
        not_kept: Some(&not_kept),
    };
    let mut comparison = compare(&before, &after, &options).map_err(Ending::Usage)?;
    if !comparison.damaged.is_empty() || !comparison.problems.is_empty() {
        // While a run publishes, its files and its manifest do not belong together: once more when none does.
        let _locks = locks(&[&before, &after]);
        comparison = compare(&before, &after, &options).map_err(Ending::Usage)?;
    }
    if is_ours {
        comparison.stale = stale(&comparison, places);
        let sentence =
            |stale: &Stale| format!("{}: the results are not those of the study now: {}", stale.study, stale.problem);
        comparison.remarks.extend(comparison.stale.iter().map(sentence));
    }
    if !quiet {
        out(&shown(&comparison, asked.format)?);
    }
    if !comparison.problems.is_empty() {
        return Err(Ending::Usage(comparison.problems.join("; ")));
    }
    if comparison.state.differs() || !comparison.stale.is_empty() {
        Err(Ending::Differs(String::new()))
    } else {
        Ok(())
    }
}

/// Which tables of a kind hold sampled curves, as a comparison asks for them.
pub(super) fn curves(of: &str, table: &str) -> Option<(&'static str, &'static str)> {
    let all = kind(of).map_or(&[][..], |kind| kind.curves);
    all.iter().find(|curves| curves.table == table).map(|curves| (curves.along, curves.quantity))
}

/// What a run would have to renew of those studies that lie in the folder of studies, where what is compared would be
/// other results.
fn stale(comparison: &Comparison, places: &Places) -> Vec<Stale> {
    let of_study = |name: &String| {
        let study = program::load(&studies::called(name)?).ok().filter(|study| study.name == *name)?;
        let known = Folder::new(&places.results, name).known().ok()??;
        let standing = standing_of(&study, Some(&known)).ok()?;
        let is_stale = |stage: &StageStanding| matches!(stage.state, Condition::Stale(_) | Condition::Missing(_));
        let problem = standing.problem().filter(|_| standing.stages.iter().any(is_stale))?;
        Some(Stale {
            study: name.clone(),
            problem: format!("{problem}; first: gearstudy run {}", studies::shell_word(&study.path)),
        })
    };
    comparison.studies.iter().filter_map(|study| of_study(&study.name)).collect()
}

/// Keeps runs from publishing; in one order, so that two comparisons never wait for each other.
fn locks(sides: &[&Side]) -> Vec<Lock> {
    let folders = |side: &&Side| -> Vec<PathBuf> {
        let Some(path) = side.path() else { return Vec::new() };
        let studies = side.studies().unwrap_or_default();
        // One that cannot be locked is compared without; its faults are reported then.
        studies.iter().filter_map(|study| presence::real_path(&path.join(study)).ok()?).collect()
    };
    let all: BTreeSet<PathBuf> = sides.iter().flat_map(folders).collect();
    all.iter().filter_map(|path| Folder::at(path)?.lock().ok()).collect()
}

fn shown(comparison: &Comparison, format: Shown) -> Result<String, Ending> {
    match format {
        Shown::Pretty => Ok(pretty::text(comparison, terminal_width())),
        Shown::Markdown => Ok(markdown::text(comparison)),
        Shown::Html => html::page(comparison).map_err(Ending::Usage),
        Shown::Json => serde_json::to_string_pretty(comparison)
            .map(|text| text + "\n")
            .map_err(|error| Ending::Usage(format!("the comparison cannot be written: {error}"))),
    }
}

pub(super) fn working_tree(places: &Places) -> Result<Side, Ending> {
    let results = &places.results;
    if presence::is_folder(results).map_err(|error| Ending::Usage(presence::unread(results)(error)))? {
        return Side::folder(results, results.display().to_string()).map_err(Ending::Usage);
    }
    let (path, help) = (places.results.display(), "`gearstudy run STUDY` makes one");
    Err(Ending::Usage(format!("there is no results folder `{path}`; {help}, `--results` names another")))
}

/// The first two words may say what to compare; the others are studies.
fn read_words(asked: &Differences, places: &Places, repository: &Result<Repository, String>) -> Result<Asked, String> {
    let (mut sides, mut studies) = (Vec::new(), Vec::new());
    for word in &asked.words {
        let side = if studies.is_empty() && sides.len() < 2 { side(word, places, repository)? } else { None };
        if side.is_none() && studies.is_empty() && sides.is_empty() {
            sides = range(word, places, repository)?;
            if !sides.is_empty() {
                continue;
            }
        }
        match side {
            Some(side) => sides.push(side),
            None => studies.push(named(word, &sides, places, repository)?),
        }
    }
    for word in &asked.studies {
        studies.push(study_name(word));
    }
    Ok(Asked { sides, studies })
}

/// What a word means that may be a folder or a revision.
pub(super) fn side(
    word: &str,
    places: &Places,
    repository: &Result<Repository, String>,
) -> Result<Option<Side>, String> {
    let path = Path::new(word);
    let mut unread = None;
    if presence::is_folder(path).map_err(presence::unread(path))? {
        let side = Side::folder(path, word)?;
        match side.studies() {
            _ if word.contains(['/', '\\', '.']) => return Ok(Some(side)),
            Ok(all) if !all.is_empty() => return Ok(Some(side)),
            Ok(_) => {}
            Err(problem) => unread = Some(problem),
        }
    }
    match repository {
        Ok(found) if found.commit(word).is_ok() => of_revision(word, places, repository).map(Some),
        _ => unread.map_or(Ok(None), Err),
    }
}

/// Both sides of a range of revisions, `A..B` or `A...B`; none for another word.
fn range(word: &str, places: &Places, repository: &Result<Repository, String>) -> Result<Vec<Side>, String> {
    let Ok(repository) = repository else { return Ok(Vec::new()) };
    let commits = repository.range(word)?.map_or_else(Vec::new, Vec::from);
    let inside = if commits.is_empty() { PathBuf::new() } else { repository.inside(&places.results)? };
    commits.iter().map(|commit| Side::commit(repository, commit, &inside)).collect()
}

fn of_revision(word: &str, places: &Places, repository: &Result<Repository, String>) -> Result<Side, String> {
    let without = |problem: &String| {
        format!("{problem}; two folders of results can be compared anywhere: gearstudy diff OLD NEW")
    };
    let repository = repository.as_ref().map_err(without)?;
    let commit = repository.commit(word)?;
    Side::commit(repository, &commit, &repository.inside(&places.results)?)
}

/// The study that a word means which is neither a revision nor a folder.
fn named(
    word: &str,
    sides: &[Side],
    places: &Places,
    repository: &Result<Repository, String>,
) -> Result<String, String> {
    let name = study_name(word);
    let mut known = Side::folder(&places.results, "")?.studies()?;
    for side in sides {
        known.extend(side.studies()?);
    }
    if let (true, Ok(head)) = (sides.len() < 2, of_revision("HEAD", places, repository)) {
        known.extend(head.studies()?);
    }
    if known.contains(&name) || sides.iter().any(Side::is_single) {
        return Ok(name);
    }
    let mut names = known;
    if sides.len() < 2 {
        names.extend(results_beside(word));
    }
    let what = if sides.len() < 2 {
        "neither a revision nor a folder nor a study with results"
    } else {
        "no study with results"
    };
    let help = match repository {
        Ok(repository) if sides.len() < 2 => repository.help(word, &name, &names),
        _ => nearest(&name, names.iter().map(String::as_str))
            .map_or_else(String::new, |near| format!("; did you mean `{near}`?")),
    };
    let outside = repository.as_ref().err().filter(|_| sides.len() < 2 && help.is_empty());
    let outside = outside.map_or_else(String::new, |problem| format!("; {problem}"));
    Err(format!("`{word}` is {what}{help}{outside}"))
}

/// Folders with results that lie where a word would name one.
fn results_beside(word: &str) -> Vec<String> {
    let parent = Path::new(word).parent().unwrap_or(Path::new(""));
    let here = if parent.as_os_str().is_empty() { Path::new(".") } else { parent };
    // Only names to suggest: a folder that cannot be read has none.
    let entries = presence::entries(here).unwrap_or_default().into_iter().map(|(path, _)| path);
    let studies = |path: &PathBuf| Side::folder(path, "").and_then(|side| side.studies());
    let with_results = entries.filter(|path| studies(path).is_ok_and(|all| !all.is_empty()));
    with_results.filter_map(|path| Some(parent.join(path.file_name()?).to_string_lossy().into_owned())).collect()
}

/// The name in a study's file; other words are names.
pub(super) fn study_name(word: &str) -> String {
    let path = PathBuf::from(word);
    if !path.extension().is_some_and(|extension| extension == "yaml" || extension == "yml") {
        return word.to_owned();
    }
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    // A study that is no longer valid still has results.
    program::load(&path).map_or(stem, |study| study.name)
}
