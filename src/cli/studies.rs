//! Which studies are meant: files, names of those in the folder `studies`, or all of them.
//!
//! Must not know: what is done with them.

use std::path::{Path, PathBuf};

use super::Ending;
use super::arguments::Changes;
use crate::program;
use declare::error::nearest;
use studygraph::presence;
use studygraph::runner::ownership::check_beside;
use studygraph::study::identity::{self, FOLDER, name_of};
use studygraph::study::{Settings, Study, named};

/// The file that a word means: in the folder `studies` that of the study of this name, itself, or there the file of this name.
/// A word with an ending or a folder is a path.
///
/// # Errors
/// When it is none of them, but nearly a name; when two studies have this name; when files cannot be read.
pub(super) fn file(word: &Path) -> Result<PathBuf, Ending> {
    let is_name = word.components().count() == 1 && word.extension().is_none();
    let unread = |problem: std::io::Error| Ending::Usage(presence::unread(word)(problem));
    if !is_name {
        return Ok(word.to_owned());
    }
    // A folder of this name, often one beside `studies`, is no study.
    let is_here = presence::link_metadata(word).map_err(unread)?.is_some_and(|found| !found.is_dir());
    let here = is_here.then(|| word.to_owned());
    let name = word.to_string_lossy();
    let all = all()?;
    if let Some(found) = owner(all.iter().chain(&here), &name)?.or(here) {
        return Ok(found);
    }
    let stem = |path: &PathBuf| path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    if let Some(found) = all.iter().find(|path| stem(path) == name) {
        return Ok(found.clone());
    }
    // Often only the ending is missing.
    let here = word.with_extension("yaml");
    if presence::is_file(&here).map_err(unread)? {
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

/// The one of these files whose study states this name; a study keeps its name in whatever file it lies.
///
/// # Errors
/// When two do: their results would overwrite each other.
fn owner<'a>(files: impl IntoIterator<Item = &'a PathBuf>, name: &str) -> Result<Option<PathBuf>, Ending> {
    // A file that cannot be read has no name that is known; it can still be meant by its own.
    let is_owner = |file: &&PathBuf| name_of(file).is_ok_and(|stated| stated.is_some_and(|stated| stated == name));
    let owners = identity::one_path_each(files.into_iter().filter(is_owner).cloned());
    match &owners[..] {
        [one, other, ..] => Err(clash(one, other, name)),
        owners => Ok(owners.first().cloned()),
    }
}

/// The file in the folder `studies` whose study has this name.
pub(super) fn called(name: &str) -> Option<PathBuf> {
    owner(&all().ok()?, name).ok()?
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

/// The files of the studies that were named, or of all in the folder `studies`, each once.
///
/// # Errors
/// As [`file`]; when there are none, or the folder cannot be read.
pub(super) fn named_or_all(named: &[PathBuf]) -> Result<Vec<PathBuf>, Ending> {
    if !named.is_empty() {
        let files = named.iter().map(|word| file(word)).collect::<Result<Vec<_>, _>>()?;
        return Ok(identity::one_path_each(files));
    }
    let all = identity::one_path_each(all()?);
    if all.is_empty() {
        return Err(Ending::Usage(format!("there are no studies in `{FOLDER}` here; name one")));
    }
    Ok(all)
}

/// Reads every study before anything runs, so that a slip in the second one costs nothing.
///
/// # Errors
/// The first that is none; two of one name, be it that only one of them is named here.
pub(super) fn load_all(words: &[PathBuf], changes: &Changes) -> Result<Vec<Study>, Ending> {
    let settings = settings(changes);
    let mut studies: Vec<Study> = Vec::new();
    let files = words.iter().map(|word| file(word)).collect::<Result<Vec<_>, _>>()?;
    for file in identity::one_path_each(files) {
        let study = program::load_changed(&file, &settings).map_err(|error| Ending::Invalid(Box::new(error)))?;
        distinct(&studies, &study)?;
        check_beside(&study).map_err(|error| Ending::without_place(&error))?;
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
    let other = others.iter().find(|other| other.name == study.name);
    other.map_or(Ok(()), |other| Err(clash(&other.path, &study.path, &study.name)))
}

fn clash(one: &Path, other: &Path, name: &str) -> Ending {
    let (one, other) = (one.display(), other.display());
    Ending::Usage(format!(
        "{one} and {other} are both called `{name}`; their results would overwrite each other: change `study:` in one of \
         them, or give the run another name with `--name`"
    ))
}

/// The files in the folder `studies`, sorted.
///
/// # Errors
/// When it cannot be read.
pub(super) fn all() -> Result<Vec<PathBuf>, Ending> {
    let folder = Path::new(FOLDER);
    identity::files_in(folder).map_err(|problem| Ending::Usage(presence::unread(folder)(problem)))
}
