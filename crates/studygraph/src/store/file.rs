//! Files that are there whole or not at all, whenever the program is killed.
//!
//! Written under a temporary name in the same folder and renamed. The folder itself is not fsynced: should a power cut
//! undo the rename, the file is missing, which every reader of these files is ready for. Must not know: contents.

use std::fs::{self, File, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

use super::error::StoreError;
use super::owner::{self, Owner};
use crate::presence;

/// How temporary files begin; whatever is left of a killed run is told by it.
pub const TEMPORARY: &str = ".partial-";

/// Whether the bytes must have reached the disk before the name does.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Durability {
    /// After a power cut the file is either absent or whole.
    Synced,
    /// For what can be made again from synced files.
    Lazy,
}

/// Writes a whole file.
///
/// Every step is a call of the standard library, so that tests can make the n-th one fail.
///
/// # Errors
/// When a step fails; what was at `path` before is still there, and nothing beside it.
pub fn write(path: &Path, bytes: &[u8], durability: Durability) -> Result<(), StoreError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (mut file, partial) = begin(folder).map_err(StoreError::io("write into", folder))?;
    let written = file
        .write_all(bytes)
        .and_then(|()| if durability == Durability::Synced { file.sync_all() } else { Ok(()) })
        .and_then(|()| fs::rename(&partial, path));
    if written.is_err() {
        // A leftover that cannot be removed does no harm.
        let _ = fs::remove_file(&partial);
    }
    written.map_err(StoreError::io("write", path))
}

/// Writes a whole file piece by piece: `fill` writes, and what it gives is given back.
///
/// # Errors
/// As [`write`]; what `fill` says.
pub fn write_by<T>(
    path: &Path,
    durability: Durability,
    fill: impl FnOnce(&mut File) -> Result<T, StoreError>,
) -> Result<T, StoreError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (mut file, partial) = begin(folder).map_err(StoreError::io("write into", folder))?;
    let written = fill(&mut file).and_then(|given| {
        let synced = if durability == Durability::Synced { file.sync_all() } else { Ok(()) };
        synced.and_then(|()| fs::rename(&partial, path)).map_err(StoreError::io("write", path))?;
        Ok(given)
    });
    if written.is_err() {
        // A leftover that cannot be removed does no harm.
        let _ = fs::remove_file(&partial);
    }
    written
}

/// The same for a synced file that only the system can refuse.
///
/// # Errors
/// As [`write`]; what `fill` says.
pub fn write_with<T>(path: &Path, fill: impl FnOnce(&mut File) -> io::Result<T>) -> Result<T, StoreError> {
    write_by(path, Durability::Synced, |file| fill(file).map_err(StoreError::io("write", path)))
}

/// Gives a name to a file with these bytes, unless it is taken: the file is there whole, or not at all.
///
/// # Errors
/// That the name is taken; what the system says, not all of which know links.
pub fn link(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let (mut file, partial) = begin(path.parent().unwrap_or(Path::new("")))?;
    let linked = file.write_all(bytes).and_then(|()| fs::hard_link(&partial, path));
    // A leftover that cannot be removed does no harm.
    let _ = fs::remove_file(&partial);
    linked
}

/// A new file under a temporary name that anybody may read once it has its own. It is locked while it is written, where files
/// can be locked, and its name says where: [`sweep_ended`] knows by both what a killed process left.
fn begin(folder: &Path) -> io::Result<(File, PathBuf)> {
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let mut options = File::options();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o644);
    let Origin { space, boot, computer } = origin();
    loop {
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let name = format!("{TEMPORARY}{space}-{}-{number}-{boot}-{computer}", std::process::id());
        let path = folder.join(name);
        let file = match options.open(&path) {
            // Left behind by a killed process of the same number, or one of another host's.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
            opened => opened?,
        };
        // Another process takes it for one that was left, as it is not locked yet, or has removed it already.
        let is_taken = matches!(file.try_lock(), Err(TryLockError::WouldBlock));
        if !is_taken && !matches!(presence::link_metadata(&path), Ok(None)) {
            return Ok((file, path));
        }
    }
}

/// Digests of the places that a process has its number in; empty where one is not known.
struct Origin {
    /// A container in a start of a computer: numbers of processes mean something in it.
    space: String,
    boot: String,
    /// Of one name, and of an installation that has an identifier.
    computer: String,
}

fn origin() -> &'static Origin {
    static ORIGIN: OnceLock<Origin> = OnceLock::new();
    ORIGIN.get_or_init(|| {
        let digest = |parts: &[&str]| match parts {
            parts if parts.iter().any(|part| part.is_empty()) => String::new(),
            parts => blake3::hash(parts.concat().as_bytes()).to_hex()[..8].to_owned(),
        };
        let owner = Owner::current();
        Origin {
            space: digest(&[&owner.boot, "\n", &owner.space]),
            boot: digest(&[&owner.boot]),
            computer: digest(&[&owner.host, &owner.machine]),
        }
    })
}

/// Bytes of a manifest; the largest known has less than one million.
pub const MOST_MANIFEST: u64 = 64 << 20;
/// Bytes of a table, a page, a figure.
pub const MOST_TABLE: u64 = 4 << 30;
/// Bytes of a pointer of Git LFS, by its specification.
pub const MOST_POINTER: u64 = 1024;

/// A phrase that follows the name of a file of Git LFS of which the contents were not fetched.
pub const POINTER: &str = "is a pointer of Git LFS: `git lfs pull` fetches it";

/// Whether a file of Git LFS has these bytes before its contents are fetched.
#[must_use]
pub fn is_pointer(bytes: &[u8]) -> bool {
    bytes.starts_with(b"version https://git-lfs.github.com/spec/")
}

/// Reads a whole file of at most `maximum` bytes.
///
/// A pipe nobody writes to would be waited for and a device has no end, so what is not a file is not opened.
///
/// # Errors
/// What the system says; that a link on the way leads nowhere; that it is not a regular file; that it is larger.
pub fn read(path: &Path, maximum: u64) -> io::Result<Vec<u8>> {
    let wrong = |problem: String| Err(io::Error::new(io::ErrorKind::InvalidData, problem));
    let metadata = match fs::metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            // A link that leads nowhere, as one to a disk that is not mounted, is not the absence of a file.
            presence::metadata(path)?;
            return Err(error);
        }
        read => read?,
    };
    if !metadata.is_file() {
        return wrong("it is not a regular file".to_owned());
    }
    if metadata.len() > maximum {
        return wrong(format!("it has {} bytes, more than {} MiB", metadata.len(), maximum >> 20));
    }
    // One byte more than it says, so that its end is met without asking for more room. A file of the system may say that it
    // has no bytes, and another may grow meanwhile.
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0) + 1);
    File::open(path)?.take(maximum + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > maximum { wrong(format!("it has more than {} MiB", maximum >> 20)) } else { Ok(bytes) }
}

/// Removes what killed runs left in a folder that nobody else writes to now.
pub fn sweep(folder: &Path) {
    // A leftover that is not found or cannot be removed does no harm.
    for (path, _) in presence::entries(folder).unwrap_or_default() {
        if path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(TEMPORARY)) {
            let _ = fs::remove_file(path);
        }
    }
}

/// The same in a folder that others may write to now: removes files of processes that have ended. A leftover that is not found
/// or cannot be removed does no harm.
pub fn sweep_ended(folder: &Path) {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    for (path, kind) in presence::entries(folder).unwrap_or_default() {
        let name = path.file_name().and_then(|name| name.to_str()).and_then(|name| name.strip_prefix(TEMPORARY));
        if let Some(name) = name.filter(|_| kind.is_file()) {
            remove_ended(&path, name);
        }
    }
}

/// None where the process that wrote the file may live.
fn remove_ended(path: &Path, name: &str) -> Option<()> {
    let mut parts = name.split('-');
    let (space, process) = (parts.next()?, parts.next()?.parse().ok()?);
    let (boot, computer) = (parts.nth(1).unwrap_or_default(), parts.next().unwrap_or_default());
    let own = origin();
    let is = |one: &str, other: &str| !one.is_empty() && one == other;
    let (same_space, same_boot) = (is(space, &own.space), is(boot, &own.boot));
    let mut lock = None;
    if same_space || same_boot {
        if same_space && owner::lives(process) {
            return None;
        }
        // A process of another user may be hidden, and its files are not opened.
        let file = File::options().read(true).write(true).open(path).ok()?;
        match file.try_lock() {
            Ok(()) => lock = Some(file),
            // Files cannot be locked here.
            Err(TryLockError::Error(_)) if same_space => {}
            Err(_) => return None,
        }
    } else if !is(computer, &own.computer) || boot.is_empty() || own.boot.is_empty() {
        // Of another computer nothing is known; this one was started anew.
        return None;
    }
    let removed = fs::remove_file(path).ok();
    drop(lock);
    removed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_whole_readable_by_all_and_leave_nothing_beside_them() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write(&path, b"one", Durability::Synced).unwrap();
        write(&path, b"two", Durability::Lazy).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        #[cfg(unix)]
        {
            let mode = std::os::unix::fs::PermissionsExt::mode(&std::fs::metadata(&path).unwrap().permissions());
            assert_eq!(mode & 0o777, 0o644);
        }
        // A folder cannot be replaced by a file: the last step fails, and nothing is left of those before it.
        fs::create_dir_all(folder.path().join("b/c")).unwrap();
        let refused = write(&folder.path().join("b"), b"", Durability::Lazy).unwrap_err().to_string();
        assert!(refused.contains("cannot write `") && refused.contains("b`"), "{refused}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
        // What another process of the same number left behind is passed over.
        let Origin { space, boot, computer } = origin();
        for number in 0..1000 {
            let name = format!("{TEMPORARY}{space}-{}-{number}-{boot}-{computer}", std::process::id());
            fs::write(folder.path().join(name), "left").unwrap();
        }
        write(&path, b"three", Durability::Lazy).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"three");
        let missing = write(&folder.path().join("no/such"), b"", Durability::Lazy).unwrap_err().to_string();
        assert!(missing.contains("no"), "{missing}");
    }

    /// Those of a process that lives stay, and those of other computers, of which nothing is known.
    #[cfg(target_os = "linux")]
    #[test]
    fn what_ended_processes_left_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let mut zombie = std::process::Command::new("true").spawn().unwrap();
        let ended = zombie.id();
        while owner::lives(ended) {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        let (living, Origin { space, boot, computer }) = (std::process::id(), origin());
        let other = "0badc0de";
        let cases = [
            (format!("{space}-{living}-1"), true),
            (format!("{space}-{ended}-1"), false),
            (format!("{space}-{ended}-2-{boot}-{computer}"), false),
            // Of a container that is gone, and of one with a process that writes.
            (format!("{other}-{living}-1-{boot}-{computer}"), false),
            (format!("{other}-{living}-2-{boot}-{computer}"), true),
            // Of another computer, of one that is not known, and of this one before it was started anew.
            (format!("{other}-{ended}-1"), true),
            (format!("{other}-{ended}-1-{other}-{other}"), true),
            (format!("{other}-{ended}-1-{other}-"), true),
            (format!("{other}-{living}-1-{other}-{computer}"), computer.is_empty()),
            ("x".to_owned(), true),
        ];
        let path = |name: &str| folder.path().join(format!("{TEMPORARY}{name}"));
        for (name, _) in &cases {
            fs::write(path(name), "left").unwrap();
        }
        let writing = File::open(path(&cases[4].0)).unwrap();
        writing.lock().unwrap();
        sweep_ended(folder.path());
        for (name, stays) in &cases {
            assert_eq!(path(name).exists(), *stays, "{name}");
        }
        zombie.wait().unwrap();
    }

    /// A file is new for a moment before it is locked.
    #[cfg(target_os = "linux")]
    #[test]
    fn what_is_written_while_others_sweep_stays() {
        let folder = tempfile::tempdir().unwrap();
        let (file, path) = begin(folder.path()).unwrap();
        // As a process of another container sees it.
        let name = path.file_name().unwrap().to_str().unwrap().replacen(&origin().space, "0badc0de", 1);
        let seen = folder.path().join(name);
        fs::rename(&path, &seen).unwrap();
        sweep_ended(folder.path());
        assert!(seen.exists());
        drop(file);
        sweep_ended(folder.path());
        assert!(!seen.exists());
    }

    /// Neither is opened: a pipe would be waited for, a device has no end.
    #[cfg(unix)]
    #[test]
    fn only_regular_files_of_a_sensible_size_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let said = |path: &Path, maximum| read(path, maximum).unwrap_err().to_string();
        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        for path in [&pipe, Path::new("/dev/zero"), folder.path()] {
            assert_eq!(said(path, 1), "it is not a regular file");
        }
        let large = folder.path().join("large");
        File::create(&large).unwrap().set_len(MOST_MANIFEST + 1).unwrap();
        assert_eq!(said(&large, MOST_MANIFEST), "it has 67108865 bytes, more than 64 MiB");
        // Its size is said to be 0.
        assert_eq!(said(Path::new("/proc/self/environ"), 1), "it has more than 0 MiB");
        fs::write(folder.path().join("a"), "abc").unwrap();
        assert_eq!(read(&folder.path().join("a"), 3).unwrap(), b"abc");
    }
}
