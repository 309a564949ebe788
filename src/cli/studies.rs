//! Which studies are meant: files, names of those in the folder `studies`, or all of them.
//!
//! Must not know: what is done with them.

use std::path::{Path, PathBuf};

use super::Ending;
use super::arguments::Changes;
use crate::program;
use declare::error::nearest;
use studygraph::study::{Settings, Study, named};

/// Where studies are looked for by name.
const FOLDER: &str = "studies";

/// The file that a word means: itself, or of a study of this name in the folder `studies`.
///
/// # Errors
/// When it is neither, but nearly a name.
pub(super) fn file(word: &Path) -> Result<PathBuf, Ending> {
    let is_name = word.components().count() == 1 && word.extension().is_none();
    if !is_name || word.symlink_metadata().is_ok() {
        return Ok(word.to_owned());
    }
    let name = word.to_string_lossy();
    let all = all();
    let stem = |path: &PathBuf| path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    // The file is nearly always called as its study.
    let named = |path: &&PathBuf| program::load(path).is_ok_and(|study| study.name == name);
    if let Some(found) = all.iter().find(|path| stem(path) == name).or_else(|| all.iter().find(named)) {
        return Ok(found.clone());
    }
    // Often only the ending is missing.
    let here = word.with_extension("yaml");
    if here.is_file() {
        let here = here.display();
        return Err(Ending::Usage(format!(
            "`{name}` is neither a file nor a study in `{FOLDER}`; did you mean `{here}`?"
        )));
    }
    let stems: Vec<String> = all.iter().map(stem).collect();
    match nearest(&name, stems.iter().map(String::as_str)) {
        Some(near) => {
            Err(Ending::Usage(format!("`{name}` is neither a file nor a study in `{FOLDER}`; did you mean `{near}`?")))
        }
        None => Ok(word.to_owned()),
    }
}

/// The file of this name in the folder `studies`, where it is there.
pub(super) fn called(name: &str) -> Option<PathBuf> {
    Some(Path::new(FOLDER).join(name).with_extension("yaml")).filter(|path| path.is_file())
}

/// A file as a word of a command line that a reader can paste.
pub(super) fn shell_word(file: &Path) -> String {
    let text = file.to_string_lossy();
    shlex::try_quote(&text).map_or_else(|_| text.to_string(), std::borrow::Cow::into_owned)
}

/// The study of this name, from the folder `studies` or from here, where there is a sound one.
pub(super) fn of_name(name: &str) -> Option<Study> {
    let mut files = called(name).into_iter().chain([PathBuf::from(format!("{name}.yaml"))]);
    files.find_map(|file| program::load(&file).ok().filter(|study| study.name == name))
}

/// That a study gives a table, or a column of one, only where somebody asks for it; nothing where that is not so.
pub(super) fn only_on_demand(study: &Study, name: &str) -> Option<String> {
    let is_it = named::on_demand(&study.nodes).iter().any(|(known, _)| known == name);
    let file = shell_word(&study.path);
    is_it.then(|| format!("`{name}` is computed on demand only: gearstudy run {file} --want {name}"))
}

/// The files of the studies that were named, or of all in the folder `studies`.
///
/// # Errors
/// As [`file`]; when there are none.
pub(super) fn named_or_all(named: &[PathBuf]) -> Result<Vec<PathBuf>, Ending> {
    if !named.is_empty() {
        return named.iter().map(|word| file(word)).collect();
    }
    let all = all();
    if all.is_empty() {
        return Err(Ending::Usage(format!("there are no studies in `{FOLDER}` here; name one")));
    }
    Ok(all)
}

/// Reads every study before anything runs, so that a slip in the second one costs nothing.
///
/// # Errors
/// The first that is none; two of one name.
pub(super) fn load_all(words: &[PathBuf], changes: &Changes) -> Result<Vec<Study>, Ending> {
    let settings = settings(changes);
    let mut studies: Vec<Study> = Vec::new();
    for word in words {
        let study = program::load_changed(&file(word)?, &settings).map_err(|error| Ending::Invalid(Box::new(error)))?;
        distinct(&studies, &study)?;
        studies.push(study);
    }
    Ok(studies)
}

pub(super) fn settings(changes: &Changes) -> Settings {
    Settings { set: changes.set.clone(), name: changes.name.clone() }
}

/// # Errors
/// When another study has the same name: their results would overwrite each other.
pub(super) fn distinct(others: &[Study], study: &Study) -> Result<(), Ending> {
    let Some(other) = others.iter().find(|other| other.name == study.name) else { return Ok(()) };
    let (a, b) = (other.path.display(), study.path.display());
    Err(Ending::Usage(format!(
        "{a} and {b} are both called `{}`; their results would overwrite each other",
        study.name
    )))
}

/// The files in the folder `studies`, sorted; what is not a file would be waited for.
pub(super) fn all() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(FOLDER).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut all: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|word| word == "yaml") && path.is_file()).collect();
    all.sort();
    all
}
