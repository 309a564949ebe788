//! Temporary folders. A folder that a killed run left is removed by the next run that makes one.
//!
//! The kernel's lock on a folder says whether its run lives. Must not know: what they are for.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::{Builder, TempDir};

use super::Ending;
use studygraph::presence;

/// How their names begin.
const PREFIX: &str = "gearstudy-";
/// A file of this name with this text says that a run made the folder: others may have names that begin so.
const MARK: &str = ".made-by-gearstudy";
const MARKED: &str = "A temporary folder of a run of gearstudy. A later run removes it if this one was killed.\n";
/// The folder inside that commands use.
const CONTENT: &str = "content";

/// A temporary folder, removed when it is dropped.
pub(super) struct Scratch {
    content: PathBuf,
    /// Removes all of it when it is dropped.
    _folder: TempDir,
    /// Released after the folder is gone.
    _lock: Option<File>,
}

impl Drop for Scratch {
    /// The content goes before the mark: a run that is killed meanwhile leaves a folder that the next one still knows.
    fn drop(&mut self) {
        // The folder is removed after it, with what is left.
        let _ = fs::remove_dir_all(&self.content);
    }
}

impl Scratch {
    /// # Errors
    /// When there is no place for one.
    pub(super) fn new() -> Result<Self, Ending> {
        let made = made(&std::env::temp_dir());
        made.map_err(|error| Ending::Usage(format!("no temporary folder: {error}")))
    }

    pub(super) fn path(&self) -> &Path {
        &self.content
    }
}

fn made(root: &Path) -> io::Result<Scratch> {
    let marked = |folder: TempDir, lock: Option<File>| {
        fs::write(folder.path().join(MARK), MARKED)?;
        let content = folder.path().join(CONTENT);
        fs::create_dir(&content)?;
        Ok(Scratch { content, _folder: folder, _lock: lock })
    };
    loop {
        let folder = Builder::new().prefix(PREFIX).tempdir_in(root)?;
        let lock = match locked(folder.path()) {
            Ok(lock) => Some(lock),
            // Another run takes it for one that was left, as it is not locked yet, or has removed it already.
            Err(TryLockError::WouldBlock) => continue,
            Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::NotFound => continue,
            // Where there are no locks, nothing is known of other folders either.
            Err(TryLockError::Error(_)) => return marked(folder, None),
        };
        if presence::link_metadata(folder.path())?.is_some() {
            sweep(root, folder.path());
            return marked(folder, lock);
        }
    }
}

/// The kernel's lock on a folder.
#[cfg(unix)]
fn locked(folder: &Path) -> Result<File, TryLockError> {
    let file = File::open(folder).map_err(TryLockError::Error)?;
    file.try_lock().map(|()| file)
}

/// Elsewhere folders cannot be opened.
#[cfg(not(unix))]
fn locked(_folder: &Path) -> Result<File, TryLockError> {
    Err(TryLockError::Error(io::ErrorKind::Unsupported.into()))
}

/// Removes the folders of runs that have ended; of this user, since anybody may write here.
fn sweep(root: &Path, own: &Path) {
    let Some(user) = owner(own) else { return };
    // A folder that is not found or cannot be removed does no harm.
    for (path, _) in presence::entries(root).unwrap_or_default() {
        let is_one = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(PREFIX)) && path != own;
        if is_one
            && owner(&path) == Some(user)
            && let Ok(_lock) = locked(&path)
        {
            let is_ours = fs::read(path.join(MARK)).is_ok_and(|text| text == MARKED.as_bytes());
            if is_ours {
                let _ = fs::remove_dir_all(path.join(CONTENT));
                let _ = fs::remove_file(path.join(MARK));
            }
            // An empty one without the mark was left before it had any content; others are not of a run.
            let _ = fs::remove_dir(&path);
        }
    }
}

/// Who owns a folder; nobody of what is none.
#[cfg(unix)]
fn owner(folder: &Path) -> Option<u32> {
    let facts = presence::link_metadata(folder).ok().flatten().filter(fs::Metadata::is_dir)?;
    Some(std::os::unix::fs::MetadataExt::uid(&facts))
}

#[cfg(not(unix))]
fn owner(_folder: &Path) -> Option<u32> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn folders_of_killed_runs_are_removed_and_those_of_others_stay() {
        let root = tempfile::tempdir().unwrap();
        let living = made(root.path()).unwrap();
        fs::create_dir_all(root.path().join("gearstudy-left/content/below")).unwrap();
        fs::write(root.path().join("gearstudy-left").join(MARK), MARKED).unwrap();
        fs::create_dir(root.path().join("gearstudy-empty")).unwrap();
        for others in ["gearstudy-main", "gearstudy-0.1.0"] {
            fs::create_dir(root.path().join(others)).unwrap();
            fs::write(root.path().join(others).join("thesis.txt"), "work").unwrap();
        }
        fs::write(root.path().join("gearstudy-main").join(MARK), "somebody's").unwrap();
        fs::create_dir(root.path().join("other-left")).unwrap();
        fs::write(root.path().join("gearstudy-file"), "").unwrap();
        std::os::unix::fs::symlink("other-left", root.path().join("gearstudy-link")).unwrap();
        let next = made(root.path()).unwrap();
        let names = |folder: &Path| -> Vec<String> {
            let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
            names.collect()
        };
        let all = names(root.path());
        assert_eq!(all.len(), 7, "{all:?}");
        let is_gone = |name: &str| !all.contains(&name.to_owned());
        assert!(
            is_gone("gearstudy-left") && is_gone("gearstudy-empty") && living.path().is_dir() && next.path().is_dir()
        );
        drop((living, next));
        assert_eq!(names(root.path()).len(), 5);
    }

    /// A folder is new for a moment before it is locked.
    #[cfg(unix)]
    #[test]
    fn runs_that_begin_at_once_leave_each_other_their_folders() {
        let root = tempfile::tempdir().unwrap();
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..2000 {
                        let one = made(root.path()).unwrap();
                        assert!(one.path().is_dir());
                    }
                });
            }
        });
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 0);
    }
}
