//! Files that are there whole or not at all, whenever the program is killed.
//!
//! Written under a temporary name in the same folder and renamed. The folder itself is not fsynced: should a power cut
//! undo the rename, the file is missing, which every reader of these files is ready for. Must not know: contents.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

use super::error::StoreError;
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

/// A new file under a temporary name that anybody may read once it has its own.
fn begin(folder: &Path) -> io::Result<(File, PathBuf)> {
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let mut options = File::options();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o644);
    loop {
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let path = folder.join(format!("{TEMPORARY}{}-{}-{number}", space(), std::process::id()));
        match options.open(&path) {
            // Left behind by a killed process of the same number, or one of another host's.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            opened => return Ok((opened?, path)),
        }
    }
}

/// Names what numbers of processes mean something in: a start of a computer, in it a container. Empty where it is not known.
fn space() -> &'static str {
    static SPACE: OnceLock<String> = OnceLock::new();
    SPACE.get_or_init(|| {
        let boot = fs::read_to_string("/proc/sys/kernel/random/boot_id");
        let (Ok(boot), Ok(container)) = (boot, fs::read_link("/proc/self/ns/pid")) else { return String::new() };
        blake3::hash(format!("{boot}{}", container.display()).as_bytes()).to_hex()[..8].to_owned()
    })
}

/// Bytes of a manifest; the largest known has less than one million.
pub const MOST_MANIFEST: u64 = 64 << 20;
/// Bytes of a table, a page, a figure.
pub const MOST_TABLE: u64 = 4 << 30;

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

/// The same in a folder that others may write to now: removes files of processes of this computer that have ended. A leftover that
/// is not found or cannot be removed does no harm.
pub fn sweep_ended(folder: &Path) {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    for (path, _) in presence::entries(folder).unwrap_or_default() {
        let process = || {
            let (space, rest) = path.file_name()?.to_str()?.strip_prefix(TEMPORARY)?.split_once('-')?;
            let process: u32 = rest.split_once('-')?.0.parse().ok()?;
            (!space.is_empty() && space == self::space()).then_some(process)
        };
        let is_gone = |process: u32| {
            presence::metadata(Path::new(&format!("/proc/{process}"))).is_ok_and(|found| found.is_none())
        };
        if process().is_some_and(is_gone) {
            let _ = fs::remove_file(&path);
        }
    }
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
        for number in 0..1000 {
            let name = format!("{TEMPORARY}{}-{}-{number}", space(), std::process::id());
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
        let mut ended = std::process::Command::new("true").spawn().unwrap();
        ended.wait().unwrap();
        let (own, ended) = (std::process::id(), ended.id());
        let names = [format!("{}-{own}-1", space()), format!("0badc0de-{ended}-1"), format!("{}-{ended}-1", space())];
        for name in &names {
            fs::write(folder.path().join(format!("{TEMPORARY}{name}")), "left").unwrap();
        }
        sweep_ended(folder.path());
        let is_left = names.map(|name| folder.path().join(format!("{TEMPORARY}{name}")).exists());
        assert_eq!(is_left, [true, true, false]);
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
