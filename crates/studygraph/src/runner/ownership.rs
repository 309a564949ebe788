//! Whose results lie in a folder: a run never replaces those of another file whose study has the same name.
//!
//! A study may move, be reached through links, or be another version of itself: only a file that is still there, still states
//! the name and has another text is another study. Must not know: how results are published.

use std::io;
use std::path::Path;

use crate::presence::{self, without_dots};
use crate::store::results::Folder;
use crate::study::Study;
use crate::study::identity::{name_of, namesake};
use declare::error::Diagnostic;

/// What is to be done about two studies of one name.
const REMEDY: &str = "change `study:` in one of the two files, or give this run another name with `--name`";

/// # Errors
/// When a run of the study would replace the results of another one; when files cannot be read that tell.
pub fn check(study: &Study, folder: &Folder) -> Result<(), Diagnostic> {
    check_beside(study)?;
    let path = folder.path();
    let Some(recorded) = folder.study_file().map_err(|error| Diagnostic::new(error.to_string()))? else {
        return Ok(());
    };
    let cannot = |error: io::Error| Diagnostic::new(presence::unread(&recorded)(error)).help(REMEDY);
    let is_other = is_other(study, &recorded).map_err(cannot)?;
    if !is_other {
        return Ok(());
    }
    // As its user would write it.
    let here = std::env::current_dir().ok();
    let shown = here.and_then(|here| recorded.strip_prefix(here).ok()).unwrap_or(&recorded);
    let (folder, other, name) = (path.display(), shown.display(), &study.name);
    let message = format!(
        "the results in `{folder}` are those of {other}, which is still there and called `{name}` as {} is; a run would \
         replace them",
        study.path.display()
    );
    Err(Diagnostic::new(message).help(REMEDY))
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

/// Whether the recorded file has another study of the same name.
fn is_other(study: &Study, recorded: &Path) -> io::Result<bool> {
    if name_of(recorded)?.is_none_or(|name| name != study.name) {
        return Ok(false);
    }
    let own = presence::real_path(&study.path)?;
    if own.is_some() && own == presence::real_path(recorded)? {
        return Ok(false);
    }
    let theirs = std::fs::read(recorded)?;
    Ok(match own {
        Some(own) => !presence::is_file(&own)? || std::fs::read(own)? != theirs,
        // A text in no file, as Python and shards have it; what is set from outside stands behind it.
        None => !study.text.as_bytes().starts_with(&theirs),
    })
}

/// The study's file as a manifest in `folder` records it; none where it is no file, or on another drive.
#[must_use]
pub fn recorded(study: &Path, folder: &Path) -> Option<String> {
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
        assert_eq!(recorded(&study, &results).as_deref(), Some("../../studies/q.yaml"));
        assert_eq!(
            recorded(&folder.path().join("studies/./q.yaml"), &results.join("../q")).unwrap(),
            "../../studies/q.yaml"
        );
        assert_eq!(recorded(&folder.path().join("none.yaml"), &results), None);
        assert_eq!(without_dots(&results.join("../../studies/q.yaml")), study);
    }
}
