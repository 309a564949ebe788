//! Whose results lie in a folder: a run never replaces those of another file whose study has the same name.
//!
//! A study may move, be reached through links, or be another version of itself: only a file that is still there, still states
//! the name and has another text is another study. Must not know: how results are published.

use std::io;
use std::path::Path;

use crate::presence::{self, without_dots};
use crate::store::manifest::StudyFolder;
use crate::store::results::Folder;
use crate::study::Study;
use crate::study::identity::{name_of, namesake};
use declare::error::Diagnostic;

/// What is to be done about two studies of one name.
const REMEDY: &str = "change `study:` in one of the two files, or give this run another name with `--name`";

/// The study's file, where the manifest in the folder must record it anew: it has none, or that one is the study no more.
///
/// # Errors
/// When a run of the study would replace the results of another one; when files cannot be read that tell.
pub fn check(study: &Study, folder: &Folder) -> Result<Option<StudyFolder>, Diagnostic> {
    check_beside(study)?;
    let own = || Ok(Some(recorded(study, folder.path())));
    let Some((file, name)) = folder.study_file().map_err(|error| Diagnostic::new(error.to_string()))? else {
        return own();
    };
    let cannot = |error: io::Error| Diagnostic::new(presence::unread(&file)(error)).help(REMEDY);
    match owner(study, &file, &name).map_err(cannot)? {
        Owner::None => own(),
        Owner::Study => Ok(None),
        Owner::Other => {
            // As its user would write it.
            let here = std::env::current_dir().ok();
            let shown = here.and_then(|here| file.strip_prefix(here).ok()).unwrap_or(&file).display();
            let (folder, study) = (folder.path().display(), study.path.display());
            let message = format!(
                "the results in `{folder}` are those of {shown}, which is still there and another study than {study}; a run \
                 would replace them"
            );
            Err(Diagnostic::new(message).help(REMEDY))
        }
    }
}

/// # Errors
/// When another file beside the study's in a folder `studies` states its name; when that folder cannot be read.
pub fn check_beside(study: &Study) -> Result<(), Diagnostic> {
    let beside = namesake(&study.path, &study.name);
    let cannot = |error: io::Error| Diagnostic::new(presence::unread(&study.path)(error));
    beside.map_err(cannot)?.map_or(Ok(()), |other| {
        let (own, other, name) = (study.path.display(), other.display(), &study.name);
        let message = format!("{own} and {other} are both called `{name}`; their results would overwrite each other");
        Err(Diagnostic::new(message).help(REMEDY))
    })
}

/// Whose results lie in a folder.
enum Owner {
    /// Of no study that is still there.
    None,
    Study,
    Other,
}

/// By the file that a manifest records, and the name that this file stated.
fn owner(study: &Study, file: &Path, name: &str) -> io::Result<Owner> {
    if name_of(file)?.is_none_or(|stated| stated != name) {
        return Ok(Owner::None);
    }
    let own = presence::identity(&study.path)?;
    if own.is_some() && own == presence::identity(file)? {
        return Ok(Owner::Study);
    }
    let theirs = std::fs::read(file)?;
    let is_same = if own.is_some() {
        presence::is_file(&study.path)? && std::fs::read(&study.path)? == theirs
    } else {
        // A text in no file, as Python and shards have it; what is set from outside stands behind it.
        study.text.as_bytes().starts_with(&theirs)
    };
    Ok(if is_same { Owner::Study } else { Owner::Other })
}

/// The study's file and the name that it states, as a manifest in `folder` records them.
#[must_use]
pub fn recorded(study: &Study, folder: &Path) -> StudyFolder {
    let file = path_from(folder, &study.path);
    let name = file.as_ref().and_then(|_| name_of(&study.path).ok()?).filter(|name| *name != study.name);
    StudyFolder { file, name, ..StudyFolder::default() }
}

/// The path of a study's file from a folder on, with `/`; none where it is no file, or on another drive.
fn path_from(folder: &Path, study: &Path) -> Option<String> {
    presence::is_file(study).ok().filter(|is_file| *is_file)?;
    let (study, folder) = (std::path::absolute(study).ok()?, std::path::absolute(folder).ok()?);
    let (study, folder) = (without_dots(&study), without_dots(&folder));
    let common = study.components().zip(folder.components()).take_while(|(one, other)| one == other).count();
    if common == 0 {
        return None;
    }
    let ups = folder.components().skip(common).map(|_| "..".to_owned());
    let downs = study.components().skip(common).map(|part| part.as_os_str().to_string_lossy().into_owned());
    Some(ups.chain(downs).collect::<Vec<_>>().join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_is_recorded_from_the_manifest_on() {
        let folder = tempfile::tempdir().unwrap();
        let study = folder.path().join("studies/q.yaml");
        std::fs::create_dir(folder.path().join("studies")).unwrap();
        std::fs::write(&study, "study: q\n").unwrap();
        let results = folder.path().join("results/q");
        assert_eq!(path_from(&results, &study).as_deref(), Some("../../studies/q.yaml"));
        assert_eq!(
            path_from(&results.join("../q"), &folder.path().join("studies/./q.yaml")).unwrap(),
            "../../studies/q.yaml"
        );
        assert_eq!(path_from(&results, &folder.path().join("none.yaml")), None);
        assert_eq!(without_dots(&results.join("../../studies/q.yaml")), study);
    }
}
