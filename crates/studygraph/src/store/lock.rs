//! Locks: the kernel's between runs on one computer, a file that names its owner between computers.
//!
//! The kernel's lock (`flock`) is released when its process ends, however it ends. But it says nothing to other
//! computers: on network disks it is often local, and on their folders always, without an error that would tell. So
//! whoever publishes holds both, always: asking whether the kernel's lock reaches further has no answer. The file is made
//! with `O_EXCL` and names computer, boot, process and since when. It is stale when its owner cannot live any more: its
//! computer was started anew; it is of this very kernel, whose lock we hold; or its process is gone. Stale files are
//! taken over without a word. Of another computer nothing is known, so its file is waited for, and then told. Must not
//! know: what is done under a lock.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::error::StoreError;
use super::file;
use super::owner::Owner;
pub use super::owner::boot;

/// The lock file of a folder.
pub const NAME: &str = ".lock";

/// A run on another computer is given so long.
const ELSEWHERE: Duration = Duration::from_secs(10);
/// A run on this one, which may be packing an archive of some gigabytes.
const HERE: Duration = Duration::from_mins(5);
/// After so long a wait is told.
const SILENT: Duration = Duration::from_millis(500);
/// A lock file is written at once when it is made; one that says nothing for so long was cut short.
const UNWRITTEN: Duration = Duration::from_secs(1);

/// Hears why it takes long, and what went wrong that does no harm.
pub type Told = fn(&str);
/// Asked, with the path of what is waited for, whether to wait on: an error ends it.
pub type Waits<'a> = &'a dyn Fn(&str) -> Result<(), StoreError>;

/// A lock that is held until it is dropped.
#[derive(Debug)]
pub struct Lock {
    _kernel: Option<File>,
    file: Option<(PathBuf, Owner)>,
    told: Told,
}

/// One publisher at a time in a folder. Nothing is left behind where folders can be locked.
///
/// # Errors
/// [`StoreError::InUse`] when somebody else has it for too long; when the folder cannot be opened or locked; what `waits` says.
pub fn publisher(folder: &Path, told: Told, waits: Waits<'_>) -> Result<Lock, StoreError> {
    let kernel = locked(folder).map_err(StoreError::io("open", folder))?;
    let path = folder.join(NAME);
    let mut wait = Wait::new(told, folder, waits);
    let held = wait.kernel(&kernel, false, HERE, || read(&path).ok().flatten())?;
    wait.began = Instant::now();
    let file = own(&path, held, &mut wait)?;
    Ok(Lock { _kernel: held.then_some(kernel), file, told })
}

/// What the kernel's lock is on: the folder itself.
#[cfg(unix)]
fn locked(folder: &Path) -> io::Result<File> {
    File::open(folder)
}

/// Windows opens no folders: a file that is there for nothing else, and stays.
#[cfg(not(unix))]
fn locked(folder: &Path) -> io::Result<File> {
    File::options().write(true).create(true).truncate(false).open(folder.join(".lock.kernel"))
}

/// Many at a time hold it shared, or one alone: `lock` is a file for nothing else. Where the kernel knows no locks there
/// is none, and the cache, for which this is made, is none the worse: see `cache.rs`.
///
/// # Errors
/// [`StoreError::InUse`] when it cannot be had for so long; when it cannot be locked.
pub fn hold(lock: &File, path: &Path, shared: bool, patience: Duration) -> Result<(), StoreError> {
    Wait::new(|_| {}, path, &|_| Ok(())).kernel(lock, shared, patience, || None).map(drop)
}

/// Makes the lock file; none where nothing can be made, and so nothing be published either.
fn own(path: &Path, held: bool, wait: &mut Wait<'_>) -> Result<Option<(PathBuf, Owner)>, StoreError> {
    let me = Owner::current();
    let mut unwritten = None;
    loop {
        match make(path, &me) {
            Ok(()) => return Ok(Some((path.to_owned(), me))),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error)
                if matches!(error.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem) =>
            {
                return Ok(None);
            }
            Err(error) => return Err(StoreError::io("write", path)(error)),
        }
        match read(path).map_err(StoreError::io("read", path))? {
            Some(owner) if owner.is_gone(&me, held) => take_away(path, Some(&owner))?,
            Some(owner) => wait.pause(Some(&owner), ELSEWHERE)?,
            None => {
                let age = fs::metadata(path).and_then(|metadata| metadata.modified()).map(|time| time.elapsed());
                let seen = unwritten.get_or_insert_with(Instant::now).elapsed();
                match age {
                    // Clocks of two computers differ by less than this.
                    Ok(Ok(age)) if age > 5 * UNWRITTEN => take_away(path, None)?,
                    Ok(_) if seen > UNWRITTEN => take_away(path, None)?,
                    // It has gone meanwhile, or is not written yet.
                    _ => wait.pause(None, ELSEWHERE)?,
                }
            }
        }
    }
}

/// With its owner's name in it from the first, where the disk knows links: whoever finds a lock without a name cannot tell
/// whether its owner lives, and waits.
fn make(path: &Path, me: &Owner) -> io::Result<()> {
    let text = serde_json::to_string(me).map_err(io::Error::other)? + "\n";
    match file::link(path, text.as_bytes()) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {}
        made => return made,
    }
    let mut file = File::options().write(true).create_new(true).open(path)?;
    file.write_all(text.as_bytes()).inspect_err(|_| {
        // Half a name says nothing; the first error is the one to tell.
        let _ = fs::remove_file(path);
    })
}

/// The owner of a lock file; none when there is none, or when it does not say.
fn read(path: &Path) -> io::Result<Option<Owner>> {
    match file::read(path, 1 << 16) {
        Ok(bytes) => Ok(serde_json::from_slice(&bytes).ok()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

/// Removes a stale file, if it is still the one that was judged. Only the computer of its owner comes here, so what keeps
/// two of its processes from removing one another's new files may be local: a lock on the folder for temporary files.
fn take_away(path: &Path, stale: Option<&Owner>) -> Result<(), StoreError> {
    let folder = std::env::temp_dir();
    let one_by_one = File::open(&folder).ok();
    if let Some(one_by_one) = &one_by_one {
        // Where it cannot be had, two processes would have to come here in the same moment.
        let _ = hold(one_by_one, &folder, false, Duration::from_secs(1));
    }
    if read(path).map_err(StoreError::io("read", path))?.as_ref() == stale {
        gone(fs::remove_file(path)).map_err(StoreError::io("remove", path))?;
    }
    Ok(())
}

fn gone(removed: io::Result<()>) -> io::Result<()> {
    match removed {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        let Some((path, me)) = &self.file else { return };
        // Somebody may have deleted it, and somebody else made another.
        let removed = match read(path) {
            Ok(Some(owner)) if owner == *me => gone(fs::remove_file(path)),
            Ok(_) => Ok(()),
            Err(error) => Err(error),
        };
        if let Err(error) = removed {
            (self.told)(&format!(
                "warning: cannot remove the lock `{}`: {error}; the next run that publishes from this computer does",
                path.display()
            ));
        }
    }
}

/// Waiting, with one message when it takes long.
struct Wait<'a> {
    told: Told,
    folder: &'a Path,
    waits: Waits<'a>,
    began: Instant,
    pause: Duration,
    silent: bool,
}

impl<'a> Wait<'a> {
    fn new(told: Told, folder: &'a Path, waits: Waits<'a>) -> Self {
        Self { told, folder, waits, began: Instant::now(), pause: Duration::from_millis(1), silent: true }
    }

    /// Takes the kernel's lock; false where there is no such thing.
    fn kernel(
        &mut self,
        file: &File,
        shared: bool,
        patience: Duration,
        owner: impl Fn() -> Option<Owner>,
    ) -> Result<bool, StoreError> {
        loop {
            match if shared { file.try_lock_shared() } else { file.try_lock() } {
                Ok(()) => return Ok(true),
                Err(fs::TryLockError::WouldBlock) => self.pause(owner().as_ref(), patience)?,
                Err(fs::TryLockError::Error(error)) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(fs::TryLockError::Error(error)) if knows_no_locks(&error) => return Ok(false),
                Err(fs::TryLockError::Error(error)) => return Err(StoreError::io("lock", self.folder)(error)),
            }
        }
    }

    fn pause(&mut self, owner: Option<&Owner>, patience: Duration) -> Result<(), StoreError> {
        let waited = self.began.elapsed();
        let folder = self.folder.display();
        let who = owner
            .map(|owner| format!("process {} on the computer `{}`, since {}", owner.process, owner.host, owner.since));
        if waited > patience {
            let who = who.map_or_else(
                || "another run".to_owned(),
                |who| {
                    let lock = self.folder.join(NAME);
                    format!(
                        "{who}; wait until it has ended; if it is gone and left its lock, delete `{}`",
                        lock.display()
                    )
                },
            );
            return Err(StoreError::InUse { path: folder.to_string(), who });
        }
        if waited > SILENT && self.silent {
            self.silent = false;
            (self.told)(&format!("waiting for `{folder}`: {}", who.unwrap_or_else(|| "another run has it".to_owned())));
        }
        (self.waits)(&folder.to_string())?;
        std::thread::sleep(self.pause);
        self.pause = (self.pause * 2).min(Duration::from_millis(50));
        Ok(())
    }
}

/// Whether an error of `flock` says that this disk has none: no such call, no server for it (`ENOLCK`), or, where it is
/// made of another kind of lock, a folder that cannot be opened for writing (`EBADF`).
fn knows_no_locks(error: &io::Error) -> bool {
    let no_locks = if cfg!(target_os = "linux") { 37 } else { 77 };
    error.kind() == io::ErrorKind::Unsupported
        || matches!(error.raw_os_error(), Some(code) if code == no_locks || code == 9)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::time::SystemTime;

    use super::*;

    fn owner(change: impl FnOnce(&mut Owner)) -> Owner {
        let mut owner = Owner::current();
        change(&mut owner);
        owner
    }

    #[test]
    fn who_cannot_live_any_more() {
        let me = Owner::current();
        assert!(!me.host.is_empty() && !me.boot.is_empty() && me.started > 0 && !me.space.is_empty(), "{me:?}");
        let dead = |owner: &mut Owner| owner.started += 1;
        let mut ended = std::process::Command::new("true").spawn().unwrap();
        let process = ended.id();
        ended.wait().unwrap();
        for (what, other, without, with) in [
            ("this very process", me.clone(), false, true),
            ("the number was given anew", owner(dead), true, true),
            ("ended", owner(|it| it.process = process), true, true),
            (
                "a process of another container",
                owner(|it| (it.space, it.process) = ("pid:[1]".into(), process)),
                false,
                true,
            ),
            ("before this start", owner(|it| it.boot = "other".into()), true, true),
            ("another computer", owner(|it| (it.host, it.boot) = ("b".into(), "other".into())), false, false),
            ("of the same name", owner(|it| (it.machine, it.boot) = ("b".into(), "other".into())), false, false),
            ("unknown boot", owner(|it| it.boot = String::new()), false, false),
        ] {
            assert_eq!((other.is_gone(&me, false), other.is_gone(&me, true)), (without, with), "{what}");
        }
        let unknown = owner(|it| it.boot = String::new());
        assert!(unknown.is_gone(&unknown, true) && !unknown.is_gone(&unknown, false));
    }

    #[test]
    fn a_lock_names_its_owner_and_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(NAME);
        let lock = publisher(folder.path(), |_| {}, &|_| Ok(())).unwrap();
        assert_eq!(read(&path).unwrap().map(|owner| owner.process), Some(std::process::id()));
        // Another one on this computer finds the kernel's lock.
        let kernel = File::open(folder.path()).unwrap();
        let busy = hold(&kernel, folder.path(), false, Duration::ZERO).unwrap_err();
        assert!(matches!(busy, StoreError::InUse { .. }), "{busy}");
        drop(lock);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        // Not ours any more.
        let lock = publisher(folder.path(), |_| {}, &|_| Ok(())).unwrap();
        let other = serde_json::to_string(&owner(|it| it.host = "b".into())).unwrap();
        fs::write(&path, &other).unwrap();
        drop(lock);
        assert_eq!(fs::read_to_string(&path).unwrap(), other);
    }

    #[test]
    fn what_killed_runs_left_is_taken_over() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(NAME);
        let old = |text: &str| {
            fs::write(&path, text).unwrap();
            let time = SystemTime::now() - Duration::from_mins(1);
            File::options().write(true).open(&path).unwrap().set_modified(time).unwrap();
        };
        let killed = serde_json::to_string(&owner(|it| it.started += 1)).unwrap();
        for text in [killed.as_str(), "", "{ \"host\": ", "\0\0\0\0"] {
            old(text);
            drop(publisher(folder.path(), |message| panic!("{message}"), &|_| Ok(())).unwrap());
            assert!(!path.exists(), "{text}");
        }
    }

    #[test]
    fn another_computer_is_waited_for_and_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(NAME);
        let other = owner(|it| (it.host, it.boot, it.process) = ("elsewhere".into(), "other".into(), 77));
        fs::write(&path, serde_json::to_string(&other).unwrap()).unwrap();
        let mut wait = Wait::new(|_| {}, folder.path(), &|_| Ok(()));
        wait.began = Instant::now().checked_sub(ELSEWHERE).unwrap();
        let message = own(&path, true, &mut wait).unwrap_err().to_string();
        for words in ["process 77 on the computer `elsewhere`", "since 2", "delete `"] {
            assert!(message.contains(words), "{message}");
        }
        assert!(path.exists());
    }
}
