//! `files.json`: the published files as this folder has them, so that nobody need read them to know that they are whole.
//!
//! As git's index: a file whose size, times and inode are as noted is what it was. Not where it was written in the same
//! moment as the index (its times would not tell), and not after a restart of the machine: a power cut can take data and
//! leave the inode. The index also keeps digests that the manifest does not, since they differ from run to run. Losing it
//! costs reading, never results. Must not know: what the files are.

use std::fs::{self, File, Metadata};
use std::io::{self, Read, Write};
use std::path::Path;
use std::thread;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::error::StoreError;
use super::file::{self, Durability};
use super::owner::boot;

pub const INDEX: &str = "files.json";
const FORMAT: u32 = 1;
/// Bytes that are read at once: enough for BLAKE3 to use all of a processor's lanes.
const PIECE: usize = 1 << 18;
/// Longer than a system's clock stands still for its files: 10 ms at most on Linux, more on a machine that waits for its
/// processor meanwhile.
pub const TICK: Duration = Duration::from_millis(12);
/// How often an index is written at most, until its own stamp is later than those in it.
const MOST_WRITES: usize = 6;
/// Nanoseconds by which a stamp is of another clock: waiting does not help.
const FAR_AHEAD: i64 = 100_000_000;

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Index {
    pub format: u32,
    /// BLAKE3 of the manifest that these files belong to.
    pub manifest: String,
    /// Digest of the sources of the program that drew page and figures.
    #[serde(default)]
    pub drawn_by: String,
    /// Which start of the machine the stamps are of; empty where that is not known.
    #[serde(default)]
    pub boot: String,
    pub files: Vec<Seen>,
}

/// A file as it was last looked at.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Seen {
    pub file: String,
    pub bytes: u64,
    pub digest: String,
    /// None in archives.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stamp: Option<Stamp>,
}

/// What a file system says of a file besides its size. Nanoseconds since 1970.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stamp {
    pub modified: i64,
    pub changed: i64,
    pub inode: u64,
}

/// A phrase that follows the name of a text of which git changed the line ends when it checked it out.
pub const LINE_ENDS: &str = "is as it was written; only its line ends differ (git's autocrlf)";

/// The digest of a manifest as it was written, whatever line ends git gave it: JSON has no other carriage returns.
#[must_use]
pub fn manifest_digest(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) if text.contains("\r\n") => digest(text.replace("\r\n", "\n").as_bytes()),
        _ => digest(bytes),
    }
}

/// Whether bytes have a digest once their line ends are others, as `core.autocrlf` of git makes them.
#[must_use]
pub fn differ_in_line_ends(bytes: &[u8], expected: &str) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    let with_lf = text.replace("\r\n", "\n");
    let is_expected = |text: &str| digest(text.as_bytes()) == expected;
    is_expected(&with_lf) || is_expected(&with_lf.replace('\n', "\r\n"))
}

impl Index {
    /// With the files as they are in this folder now.
    #[must_use]
    pub fn new(manifest: String, drawn_by: String, files: Vec<Seen>) -> Self {
        Self { format: FORMAT, manifest, drawn_by, boot: boot(), files }
    }

    /// The same for a folder elsewhere: digests alone.
    #[must_use]
    pub fn without_stamps(mut self) -> Self {
        self.boot.clear();
        self.files.iter_mut().for_each(|seen| seen.stamp = None);
        self
    }

    /// The index in a folder and the moment in which it was written; none when there is none that can be read.
    #[must_use]
    pub fn read(folder: &Path) -> Option<(Self, i64)> {
        let path = folder.join(INDEX);
        let written = Stamp::of(&fs::metadata(&path).ok()?);
        let index = Self::parse(&file::read(&path, file::MOST_MANIFEST).ok()?)?;
        Some((index, written.earlier()))
    }

    /// None for what is not an index.
    #[must_use]
    pub fn parse(bytes: &[u8]) -> Option<Self> {
        serde_json::from_slice(bytes).ok().filter(|index: &Self| index.format == FORMAT)
    }

    /// # Errors
    /// When it cannot be written as JSON, which cannot be.
    pub fn bytes(&self) -> Result<Vec<u8>, StoreError> {
        let mut bytes = serde_json::to_vec_pretty(self)
            .map_err(|error| StoreError::Format { table: INDEX.to_owned(), problem: error.to_string() })?;
        bytes.push(b'\n');
        Ok(bytes)
    }

    /// Again after a moment, while a file was written in the same moment: its stamp would tell nothing, and a run with
    /// nothing to do would read the file and write the index.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), StoreError> {
        let path = folder.join(INDEX);
        let bytes = self.bytes()?;
        let newest = self.files.iter().filter_map(|seen| seen.stamp).map(|stamp| stamp.later()).max();
        for _ in 1..MOST_WRITES {
            file::write(&path, &bytes, Durability::Lazy)?;
            let moment = fs::metadata(&path).map(|metadata| Stamp::of(&metadata).earlier());
            // Whoever reads it is told what is wrong.
            let (Some(newest), Ok(moment)) = (newest, moment) else { return Ok(()) };
            if newest < moment || newest.saturating_sub(moment) > FAR_AHEAD {
                return Ok(());
            }
            thread::sleep(TICK);
        }
        file::write(&path, &bytes, Durability::Lazy)
    }

    #[must_use]
    pub fn find(&self, file: &str) -> Option<&Seen> {
        self.files.iter().find(|seen| seen.file == file)
    }

    /// Whether stamps of this index say anything: the machine was not started anew since.
    #[must_use]
    pub fn is_of_this_boot(&self) -> bool {
        self.boot == boot()
    }
}

impl Stamp {
    #[must_use]
    pub fn of(metadata: &Metadata) -> Self {
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt;
            let nanoseconds = |seconds: i64, rest: i64| seconds.saturating_mul(1_000_000_000).saturating_add(rest);
            Self {
                modified: nanoseconds(metadata.mtime(), metadata.mtime_nsec()),
                changed: nanoseconds(metadata.ctime(), metadata.ctime_nsec()),
                inode: metadata.ino(),
            }
        }
        #[cfg(not(unix))]
        {
            let since = metadata.modified().ok().and_then(|time| time.duration_since(std::time::UNIX_EPOCH).ok());
            let modified = since.and_then(|since| i64::try_from(since.as_nanos()).ok()).unwrap_or(0);
            Self { modified, changed: modified, inode: 0 }
        }
    }

    /// The earlier of its two times.
    #[must_use]
    pub fn earlier(&self) -> i64 {
        self.modified.min(self.changed)
    }

    /// The later of its two times.
    #[must_use]
    pub fn later(&self) -> i64 {
        self.modified.max(self.changed)
    }

    /// Whether the file was touched before this moment.
    #[must_use]
    pub fn is_before(&self, moment: i64) -> bool {
        self.later() < moment
    }
}

/// BLAKE3 of bytes, in hexadecimal.
#[must_use]
pub fn digest(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_string()
}

/// Hands bytes on, and digests them.
pub struct Digesting<W> {
    writer: W,
    hasher: blake3::Hasher,
}

impl<W: Write> Digesting<W> {
    pub fn new(writer: W) -> Self {
        Self { writer, hasher: blake3::Hasher::new() }
    }

    /// As [`digest`] of all that was written.
    #[must_use]
    pub fn digest(&self) -> String {
        self.hasher.finalize().to_string()
    }
}

impl<W: Write> Write for Digesting<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.writer.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

/// Reads a file and notes what it is now.
///
/// # Errors
/// What the system says; that it is not a regular file.
pub fn look(path: &Path, name: &str) -> io::Result<Seen> {
    // A pipe nobody writes to would be waited for.
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidData, "it is not a regular file"));
    }
    let mut file = File::open(path)?;
    // From before it is read: what is changed meanwhile has another stamp.
    let metadata = file.metadata()?;
    let mut hasher = blake3::Hasher::new();
    let mut piece = vec![0; PIECE.min(usize::try_from(metadata.len()).unwrap_or(PIECE) + 1)];
    let mut bytes = 0;
    loop {
        let read = match file.read(&mut piece) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            read => read?,
        };
        // A device has no end, and a file that grows is not the one that was noted.
        if read == 0 || bytes > metadata.len() {
            break;
        }
        hasher.update(&piece[..read]);
        bytes += read as u64;
    }
    let digest = hasher.finalize().to_string();
    Ok(Seen { file: name.to_owned(), bytes, digest, stamp: Some(Stamp::of(&metadata)) })
}

/// What was just written.
///
/// # Errors
/// When it is not there any more.
pub fn written(path: &Path, name: &str, bytes: &[u8]) -> Result<Seen, StoreError> {
    let metadata = fs::metadata(path).map_err(StoreError::io("read", path))?;
    Ok(Seen {
        file: name.to_owned(),
        bytes: bytes.len() as u64,
        digest: digest(bytes),
        stamp: Some(Stamp::of(&metadata)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_noted_is_read_back_and_other_formats_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, "abc").unwrap();
        let seen = look(&path, "a").unwrap();
        assert_eq!((seen.bytes, seen.digest.as_str()), (3, digest(b"abc").as_str()));
        assert_eq!(seen, written(&path, "a", b"abc").unwrap());
        let index = Index::new("m".to_owned(), "p".to_owned(), vec![seen]);
        index.write(folder.path()).unwrap();
        let (back, moment) = Index::read(folder.path()).unwrap();
        assert_eq!(back, index);
        assert!(back.is_of_this_boot() && !back.clone().without_stamps().is_of_this_boot() || boot().is_empty());
        assert!(!back.files[0].stamp.unwrap().is_before(i64::MIN) && moment > 0);
        fs::write(folder.path().join(INDEX), "{}").unwrap();
        assert!(Index::read(folder.path()).is_none());
        assert!(Index::parse(br#"{"format":2,"manifest":"","files":[]}"#).is_none());
    }

    /// The clock of files stands still for milliseconds: a file that was written while it did is told all the same.
    #[test]
    fn stamps_of_the_same_moment_tell() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, "abc").unwrap();
        let mut seen = look(&path, "a").unwrap();
        // As if it had been touched later than it was: not before an index that is written at once, nor, for the second, before
        // one that is written once more.
        for later in [9_000_000, 20_000_000] {
            seen.stamp.as_mut().unwrap().changed += later;
            Index::new("m".to_owned(), "p".to_owned(), vec![seen.clone()]).write(folder.path()).unwrap();
            let (index, moment) = Index::read(folder.path()).unwrap();
            assert!(index.files[0].stamp.unwrap().is_before(moment), "{index:?} {moment}");
        }
        // By a clock that is an hour ahead: written, and known for what it is.
        seen.stamp.as_mut().unwrap().changed += 3_600_000_000_000;
        Index::new("m".to_owned(), "p".to_owned(), vec![seen]).write(folder.path()).unwrap();
        let (index, moment) = Index::read(folder.path()).unwrap();
        assert!(!index.files[0].stamp.unwrap().is_before(moment), "{index:?} {moment}");
    }

    /// Pieces of a large file give the digest of the whole.
    #[test]
    fn a_large_file_has_the_digest_of_its_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let bytes: Vec<u8> = (0..=250_u8).cycle().take(3 * PIECE + 7).collect();
        fs::write(&path, &bytes).unwrap();
        assert_eq!(look(&path, "a").unwrap().digest, digest(&bytes));
        assert!(look(folder.path(), "a").unwrap_err().to_string().contains("not a regular file"));
    }
}
