//! One file for all that a shard computed: entries of a cache, each with a digest of its bytes.
//!
//! ```text
//! "gearstudy shard 1\n" · length of header (u64, little endian) · BLAKE3 of header · header (JSON) · entries …
//! ```
//!
//! The header has the digest of every entry and the file's size follows from it, so a cut, a hole or a flipped bit
//! anywhere is seen. It is written under a temporary name, brought to the disk and renamed: it is there whole or not at
//! all. Two that write the same file write the same tables; whichever comes last stays. Must not know: what a shard is
//! but a number, what plans are but a digest.

use std::fs::{self, File};
use std::io::{BufWriter, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::cache::Cache;
use super::error::StoreError;
use super::file;
use declare::digest::Digest;

const MAGIC: &[u8; 18] = b"gearstudy shard 1\n";
const PREFIX: usize = MAGIC.len() + 8 + 32;
/// A header longer than this is not one of ours.
const LONGEST_HEADER: u64 = 1 << 30;
/// An entry longer than this is not one of ours.
const LONGEST_ENTRY: u64 = 1 << 34;

/// What is in a pack.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// BLAKE3 of the plan that it is part of.
    pub plan: String,
    /// Which shard; none for what was known when it was planned.
    pub shard: Option<usize>,
    pub entries: Vec<Packed>,
}

/// One entry of a pack.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Packed {
    pub stage: String,
    pub part: usize,
    /// In hexadecimal, as the digest.
    pub key: String,
    pub bytes: u64,
    pub digest: String,
}

/// What is to be packed: a part of a stage and its key.
pub type Part = (String, usize, Digest);

/// Writes the entries of `parts` from a cache into `path`, whole or not at all; the bytes written.
///
/// # Errors
/// When an entry is missing or damaged; when the file cannot be written.
pub fn write(path: &Path, plan: &str, shard: Option<usize>, cache: &Cache, parts: &[Part]) -> Result<u64, StoreError> {
    let mut entries = Vec::with_capacity(parts.len());
    for (stage, part, key) in parts {
        let bytes = cache.entry_bytes(*key)?;
        entries.push(Packed {
            stage: stage.clone(),
            part: *part,
            key: key.to_string(),
            bytes: bytes.len() as u64,
            digest: blake3::hash(&bytes).to_string(),
        });
    }
    let header = Header { plan: plan.to_owned(), shard, entries };
    let header = serde_json::to_vec(&header)
        .map_err(|error| StoreError::Format { table: path.display().to_string(), problem: error.to_string() })?;
    file::write_with(path, |file| {
        let mut file = BufWriter::new(file);
        file.write_all(MAGIC)?;
        file.write_all(&(header.len() as u64).to_le_bytes())?;
        file.write_all(blake3::hash(&header).as_bytes())?;
        file.write_all(&header)?;
        let mut size = (PREFIX + header.len()) as u64;
        for (_, _, key) in parts {
            let bytes = cache.entry_bytes(*key).map_err(std::io::Error::other)?;
            file.write_all(&bytes)?;
            size += bytes.len() as u64;
        }
        file.flush()?;
        Ok(size)
    })
}

/// A pack whose header is sound and whose size is right.
#[derive(Debug)]
pub struct Pack {
    pub header: Header,
    path: PathBuf,
    file: File,
    /// Where the entries begin.
    start: u64,
}

/// Opens a pack of a plan; `None` when there is no such file.
///
/// # Errors
/// A sentence that says what is damaged, or that it belongs to another plan or shard.
pub fn open(path: &Path, plan: &str, shard: Option<usize>) -> Result<Option<Pack>, String> {
    let metadata = match fs::metadata(path) {
        Ok(metadata) => metadata,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error.to_string()),
    };
    // A pipe would be waited for.
    if !metadata.is_file() {
        return Err("it is not a regular file".to_owned());
    }
    let mut file = File::open(path).map_err(|error| error.to_string())?;
    // Somebody may have replaced it since.
    let size = file.metadata().map_err(|error| error.to_string())?.len();
    let cut = |_| "it is cut short".to_owned();
    let mut prefix = [0; PREFIX];
    file.read_exact(&mut prefix).map_err(cut)?;
    let (magic, rest) = prefix.split_at(MAGIC.len());
    let (length, expected) = rest.split_at(8);
    if magic != MAGIC {
        return Err("it does not begin as it should".to_owned());
    }
    let length = u64::from_le_bytes(length.try_into().map_err(|_| "it is cut short")?);
    if length > LONGEST_HEADER.min(size) {
        return Err("it is cut short".to_owned());
    }
    let mut header = vec![0; usize::try_from(length).map_err(|error| error.to_string())?];
    file.read_exact(&mut header).map_err(cut)?;
    if blake3::hash(&header).as_bytes() != expected {
        return Err("its header is not what was written".to_owned());
    }
    let header: Header = serde_json::from_slice(&header).map_err(|error| error.to_string())?;
    let start = PREFIX as u64 + length;
    let end = header.entries.iter().try_fold(start, |sum, entry| {
        let sum = sum.checked_add(entry.bytes).filter(|_| entry.bytes <= LONGEST_ENTRY);
        sum.ok_or_else(|| "its header is not what was written".to_owned())
    })?;
    if end != size {
        return Err("it has not the size that was written".to_owned());
    }
    if header.plan != plan {
        return Err("it belongs to another plan".to_owned());
    }
    if header.shard != shard {
        return Err("it belongs to another shard".to_owned());
    }
    Ok(Some(Pack { header, path: path.to_owned(), file, start }))
}

impl Pack {
    /// Reads every entry, checked, in their order.
    ///
    /// # Errors
    /// [`StoreError::Damaged`], and what `take` says.
    pub fn each(&mut self, mut take: impl FnMut(Digest, Vec<u8>) -> Result<(), StoreError>) -> Result<(), StoreError> {
        let path = self.path.display().to_string();
        let damaged = |problem: String| StoreError::Damaged { path: path.clone(), problem };
        self.file.seek(SeekFrom::Start(self.start)).map_err(|error| damaged(error.to_string()))?;
        for entry in &self.header.entries {
            let length = usize::try_from(entry.bytes).map_err(|error| damaged(error.to_string()))?;
            let mut bytes = vec![0; length];
            self.file.read_exact(&mut bytes).map_err(|error| damaged(error.to_string()))?;
            let key = Digest::from_hex(&entry.key).filter(|_| blake3::hash(&bytes).to_string() == entry.digest);
            let name = || format!("part {} of `{}` is not what was written", entry.part, entry.stage);
            take(key.ok_or_else(|| damaged(name()))?, bytes)?;
        }
        Ok(())
    }

    /// Whether every byte is what was written.
    ///
    /// # Errors
    /// [`StoreError::Damaged`].
    pub fn check(&mut self) -> Result<(), StoreError> {
        self.each(|_, _| Ok(()))
    }
}
