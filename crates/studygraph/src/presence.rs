//! Presence of files and folders. "Not there" is an answer; any other failure of the system is an error.
//!
//! The standard library's `Path::exists`, `is_file` and `is_dir` answer "no" when a folder cannot be read, and entries of
//! `read_dir` are easily flattened; `clippy.toml` forbids them. Must not know: what the files are.

use std::fs::{self, FileType, Metadata};
use std::hash::Hash;
use std::io::{self, ErrorKind};
use std::path::{Component, Path, PathBuf};

/// The metadata of a path, through links; none where there is nothing.
///
/// # Errors
/// When the system cannot say whether it is there; when a link on the way leads nowhere, as one to a disk that is not mounted does.
pub fn metadata(path: &Path) -> io::Result<Option<Metadata>> {
    let found = found(fs::metadata(path))?;
    if found.is_none() {
        check_links(path)?;
    }
    Ok(found)
}

/// # Errors
/// When the nearest part of a path that is there is a link that leads nowhere.
fn check_links(path: &Path) -> io::Result<()> {
    for part in path.ancestors().filter(|part| !part.as_os_str().is_empty()) {
        if let Some(own) = found(fs::symlink_metadata(part))? {
            if own.is_symlink() && found(fs::metadata(part))?.is_none() {
                return Err(io::Error::other(format!("the link `{}` leads nowhere", part.display())));
            }
            break;
        }
    }
    Ok(())
}

/// The same of a link itself.
///
/// # Errors
/// As [`metadata`].
pub fn link_metadata(path: &Path) -> io::Result<Option<Metadata>> {
    found(fs::symlink_metadata(path))
}

/// # Errors
/// As [`metadata`].
pub fn exists(path: &Path) -> io::Result<bool> {
    Ok(metadata(path)?.is_some())
}

/// # Errors
/// As [`metadata`].
pub fn is_file(path: &Path) -> io::Result<bool> {
    Ok(metadata(path)?.is_some_and(|found| found.is_file()))
}

/// # Errors
/// As [`metadata`].
pub fn is_folder(path: &Path) -> io::Result<bool> {
    Ok(metadata(path)?.is_some_and(|found| found.is_dir()))
}

/// A value that all paths to one file have in common, through links of both kinds, and no path to another; none where there is
/// nothing.
///
/// # Errors
/// As [`metadata`].
#[cfg(unix)]
pub fn identity(path: &Path) -> io::Result<Option<impl Eq + Hash + use<>>> {
    use std::os::unix::fs::MetadataExt;
    Ok(metadata(path)?.map(|found| (found.dev(), found.ino())))
}

/// A value that all paths to one file have in common through symbolic links, and no path to another; none where there is nothing.
///
/// # Errors
/// As [`metadata`].
#[cfg(not(unix))]
pub fn identity(path: &Path) -> io::Result<Option<impl Eq + Hash + use<>>> {
    real_path(path)
}

/// The path without links and `..`; none where there is nothing.
///
/// # Errors
/// As [`metadata`].
pub fn real_path(path: &Path) -> io::Result<Option<PathBuf>> {
    found(path.canonicalize())
}

/// The entries of a folder by path, sorted, each with its kind; none where there is no such folder.
///
/// # Errors
/// The first, of the folder or of an entry: a part of a folder is never taken for all of it.
#[allow(clippy::disallowed_methods, reason = "the one place that reads folders, with every error")]
pub fn entries(folder: &Path) -> io::Result<Vec<(PathBuf, FileType)>> {
    let mut entries = Vec::new();
    let read = match fs::read_dir(folder) {
        // A file in its place, not a path below a file.
        Err(error) if error.kind() == ErrorKind::NotADirectory && exists(folder)? => return Err(error),
        read => found(read)?,
    };
    if read.is_none() {
        check_links(folder)?;
    }
    for entry in read.into_iter().flatten() {
        let entry = entry?;
        // None: removed since the folder was read.
        entries.extend(found(entry.file_type())?.map(|kind| (entry.path(), kind)));
    }
    entries.sort_by(|(a, _), (b, _)| a.cmp(b));
    Ok(entries)
}

/// A path without `.` and `..`, by its words alone: of a folder that is a link, what lies beside the link.
#[must_use]
pub fn without_dots(path: &Path) -> PathBuf {
    let mut parts = Vec::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => drop(parts.pop_if(|last| matches!(last, Component::Normal(_)))),
            part => parts.push(part),
        }
    }
    parts.into_iter().collect()
}

/// An error of the functions above as a sentence.
pub fn unread(path: &Path) -> impl Fn(io::Error) -> String + '_ {
    move |error| format!("cannot read `{}`: {error}", path.display())
}

/// Nothing has a name below a file, or one that is too long.
fn found<T>(result: io::Result<T>) -> io::Result<Option<T>> {
    match result {
        Err(error)
            if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory | ErrorKind::InvalidFilename) =>
        {
            Ok(None)
        }
        other => other.map(Some),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_there_is_an_answer() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "").unwrap();
        let none = [folder.path().join("none"), file.join("below"), folder.path().join("x".repeat(300))];
        for path in none {
            assert!(!exists(&path).unwrap() && link_metadata(&path).unwrap().is_none(), "{}", path.display());
            assert!(real_path(&path).unwrap().is_none());
        }
        assert!(exists(&file).unwrap() && is_file(&file).unwrap() && !is_folder(&file).unwrap());
        assert!(is_folder(folder.path()).unwrap() && !is_file(folder.path()).unwrap());
        assert!(entries(&folder.path().join("none")).unwrap().is_empty());
        assert!(entries(&file.join("below")).unwrap().is_empty() && entries(&file).is_err());
        let names: Vec<PathBuf> = entries(folder.path()).unwrap().into_iter().map(|(path, _)| path).collect();
        assert_eq!(names, [file]);
    }

    /// A disk that is not mounted does not make the results on it vanish.
    #[cfg(unix)]
    #[test]
    fn a_link_that_leads_nowhere_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("link");
        std::os::unix::fs::symlink(folder.path().join("gone"), &link).unwrap();
        for path in [link.clone(), link.join("below"), link.join("far/below")] {
            assert!(exists(&path).unwrap_err().to_string().contains("leads nowhere"), "{}", path.display());
            assert!(entries(&path).is_err());
        }
        assert!(link_metadata(&link).unwrap().is_some());
    }

    /// A link to itself: an error for every user, root included.
    #[cfg(unix)]
    #[test]
    fn what_cannot_be_read_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let around = folder.path().join("around");
        std::os::unix::fs::symlink(&around, &around).unwrap();
        for path in [around.clone(), around.join("below")] {
            assert!(exists(&path).is_err() && is_file(&path).is_err() && is_folder(&path).is_err());
            assert!(real_path(&path).is_err());
        }
        assert!(link_metadata(&around).unwrap().is_some());
        assert!(entries(&around).is_err());
        assert_eq!(entries(folder.path()).unwrap().len(), 1);
        let said = unread(&around)(exists(&around).unwrap_err());
        assert!(said.starts_with("cannot read `") && said.contains("around`: "), "{said}");
    }
}
