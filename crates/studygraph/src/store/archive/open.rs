//! Reading an archive that anybody may have made: everything is checked before anything is used.
//!
//! It is a zip file, or a folder into which one was unpacked; the crate may be in a folder inside. Nothing is ever written
//! under a name from the archive; names only find entries. Must not know: what the entries mean.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufReader, Read, Seek, Write};
use std::path::{Path, PathBuf};

use serde_json::Value;
use zip::read::Config;
use zip::result::ZipError;
use zip::unstable::read::ZipIterable;
use zip::{CompressionMethod, ZipArchive};

use super::{ArchiveError, METADATA, sha256};
use crate::presence;
use crate::store::file;

/// An archive has a few dozen entries.
pub const MOST_ENTRIES: usize = 10_000;
/// Bytes of all entries together, unpacked.
pub const MOST_BYTES: u64 = 1 << 30;
/// Bytes of the description.
const LARGEST_METADATA: u64 = 1 << 24;
const LONGEST_NAME: usize = 255;
/// Files with something wrong that are named; of more only their number is said.
const MOST_TOLD: usize = 20;

/// What `st_mode` says of the type of a file.
const TYPE_OF_FILE: u32 = 0o170_000;
const REGULAR: u32 = 0o100_000;
const FOLDER: u32 = 0o040_000;

/// An archive that was read through once: names, sizes and checksums are as they should be.
pub struct Archive<R> {
    /// For messages.
    path: String,
    files: Files<R>,
    /// Files of the crate by name; folders are left out.
    entries: BTreeMap<String, usize>,
}

/// Where the bytes of entries are.
enum Files<R> {
    Zip(ZipArchive<R>),
    Folder(Vec<PathBuf>),
}

/// Opens and checks a zip file, the folder of an unpacked one, or the description in that folder.
///
/// # Errors
/// [`ArchiveError`]: what is wrong with it.
pub fn open(path: &Path) -> Result<Archive<BufReader<File>>, ArchiveError> {
    let name = path.display().to_string();
    let unreadable = |error: io::Error| ArchiveError::Unreadable { path: name.clone(), problem: error.to_string() };
    let facts = fs::metadata(path).map_err(unreadable)?;
    if facts.is_dir() {
        return Archive::of_folder(path, &name);
    }
    // Not opened yet: a pipe nobody writes to would be waited for.
    if !facts.is_file() {
        return Err(ArchiveError::NoArchive { path: name, problem: "it is neither a file nor a folder".to_owned() });
    }
    if path.file_name().is_some_and(|own| own == METADATA) {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        return Archive::of_folder(folder, &name);
    }
    Archive::check(BufReader::new(File::open(path).map_err(unreadable)?), &name)
}

impl<R: Read + Seek> Archive<R> {
    /// Reads everything once; `name` is for messages.
    ///
    /// # Errors
    /// As [`open`].
    pub fn check(mut reader: R, name: &str) -> Result<Self, ArchiveError> {
        let path = name.to_owned();
        let refused = |problem: String| ArchiveError::Refused { path: path.clone(), problem };
        let mut names = BTreeMap::new();
        let mut bytes: u64 = 0;
        {
            // By hand first: the usual reader keeps one of several entries of the same name.
            let mut listed =
                ZipIterable::try_new(&mut reader, Config::default()).map_err(|error| no_archive(&path, &error))?;
            if listed.len() > MOST_ENTRIES {
                return Err(refused(format!("it has {} entries, more than {MOST_ENTRIES}", listed.len())));
            }
            for entry in listed.files().map_err(|error| damaged(&path, &error))? {
                let entry = entry.map_err(|error| damaged(&path, &error))?;
                let name = std::str::from_utf8(entry.name_raw())
                    .map_err(|_| refused(format!("the name `{}` is not UTF-8", entry.name_raw().escape_ascii())))?;
                safe(name).map_err(|problem| refused(format!("the entry `{}` {problem}", name.escape_debug())))?;
                let kind = entry.unix_mode().unwrap_or(0) & TYPE_OF_FILE;
                let problem = if entry.is_symlink() {
                    Some("is a symbolic link")
                } else if ![0, REGULAR, FOLDER].contains(&kind) {
                    Some("is neither a file nor a folder")
                } else if entry.encrypted() {
                    Some("is encrypted")
                } else if ![CompressionMethod::Stored, CompressionMethod::Deflated].contains(&entry.compression()) {
                    Some("is compressed in another way than archives are")
                } else {
                    None
                };
                if let Some(problem) = problem {
                    return Err(refused(format!("the entry `{name}` {problem}")));
                }
                bytes = bytes.saturating_add(entry.size());
                if bytes > MOST_BYTES {
                    return Err(refused(format!("unpacked it is larger than {} MiB", MOST_BYTES >> 20)));
                }
                if names.insert(name.to_owned(), entry.size()).is_some() {
                    return Err(refused(format!("it has two entries `{name}`")));
                }
            }
        }
        let mut zip = ZipArchive::new(reader).map_err(|error| no_archive(&path, &error))?;
        // Two readers must see the same: names in both directories, no entry inside another, none that is not listed.
        zip.validate_header_consistency().map_err(|error| damaged(&path, &error))?;
        let mut entries = BTreeMap::new();
        for index in 0..zip.len() {
            let mut entry = zip.by_index(index).map_err(|error| damaged(&path, &error))?;
            let name = String::from_utf8_lossy(entry.name_raw()).into_owned();
            let size = entry.size();
            copy(&mut entry, size, &mut std::io::sink()).map_err(|problem| ArchiveError::Damaged {
                path: path.clone(),
                problem: format!("`{name}`: {problem}"),
            })?;
            if !name.ends_with('/') {
                entries.insert(name, index);
            }
        }
        if entries.len() != names.keys().filter(|name| !name.ends_with('/')).count() {
            return Err(refused("its two directories differ".to_owned()));
        }
        Self::of_entries(path.clone(), Files::Zip(zip), entries)
    }

    /// The crate among files that were checked.
    fn of_entries(path: String, files: Files<R>, mut entries: BTreeMap<String, usize>) -> Result<Self, ArchiveError> {
        entries.retain(|name, _| !is_of_a_system(name));
        let folders =
            entries.keys().filter_map(|name| name.strip_suffix(METADATA).filter(|folder| folder.ends_with('/')));
        let mut folders: Vec<String> = folders.map(str::to_owned).collect();
        if entries.contains_key(METADATA) {
            folders.clear();
        }
        if let [all @ .., last] = &folders[..]
            && !all.is_empty()
        {
            let named: Vec<String> = all.iter().take(MOST_TOLD).map(|folder| format!("`{folder}`")).collect();
            let how =
                if matches!(files, Files::Zip(_)) { "unpack it, and name one of them" } else { "name one of them" };
            let (number, named) = (folders.len(), named.join(", "));
            let problem = format!("it has {number} crates, in {named} and `{last}`: {how}");
            return Err(ArchiveError::NoArchive { path, problem });
        }
        if let Some(folder) = folders.pop() {
            // Files beside it, as a note on how to use it, are none of the crate's.
            let inside = |(name, index): (String, usize)| Some((name.strip_prefix(&folder)?.to_owned(), index));
            entries = entries.into_iter().filter_map(inside).collect();
        }
        let mut archive = Self { path, files, entries };
        archive.described()?;
        Ok(archive)
    }

    /// Lists everything in a folder; `name` is for messages.
    fn of_folder(folder: &Path, name: &str) -> Result<Self, ArchiveError> {
        let refused = |problem: String| ArchiveError::Refused { path: name.to_owned(), problem };
        let unreadable = |path: &Path, error: io::Error| ArchiveError::Unreadable {
            path: path.display().to_string(),
            problem: error.to_string(),
        };
        let (mut files, mut entries, mut bytes) = (Vec::new(), BTreeMap::new(), 0_u64);
        let mut folders = vec![(folder.to_owned(), String::new())];
        while let Some((folder, inside)) = folders.pop() {
            for (path, _) in presence::entries(&folder).map_err(|error| unreadable(&folder, error))? {
                let own = path.file_name().unwrap_or_default();
                let own = own.to_str().ok_or_else(|| refused(format!("the name `{}` is not UTF-8", own.display())))?;
                let inside = format!("{inside}{own}");
                if is_of_a_system(&inside) {
                    continue;
                }
                let facts = fs::symlink_metadata(&path).map_err(|error| unreadable(&path, error))?;
                let problem = match safe(&inside) {
                    Err(problem) => Some(problem),
                    Ok(()) if facts.is_symlink() => Some("is a symbolic link"),
                    Ok(()) if !facts.is_file() && !facts.is_dir() => Some("is neither a file nor a folder"),
                    Ok(()) => None,
                };
                if let Some(problem) = problem {
                    return Err(refused(format!("the entry `{}` {problem}", inside.escape_debug())));
                }
                if facts.is_dir() {
                    folders.push((path, inside + "/"));
                    continue;
                }
                bytes = bytes.saturating_add(facts.len());
                entries.insert(inside, files.len());
                files.push(path);
                if files.len() > MOST_ENTRIES {
                    return Err(refused(format!("it has more than {MOST_ENTRIES} entries")));
                }
                if bytes > MOST_BYTES {
                    return Err(refused(format!("it is larger than {} MiB", MOST_BYTES >> 20)));
                }
            }
        }
        Self::of_entries(name.to_owned(), Files::Folder(files), entries)
    }

    /// The names of its files, sorted.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.keys().map(String::as_str)
    }

    /// The bytes of an entry.
    ///
    /// # Errors
    /// When there is none of this name, or the file has changed since it was checked.
    pub fn bytes(&mut self, name: &str) -> Result<Vec<u8>, ArchiveError> {
        let path = self.path.clone();
        let Some(&index) = self.entries.get(name) else {
            let problem = format!("it has no `{name}`");
            return Err(ArchiveError::NoArchive { path, problem });
        };
        let zip = match &mut self.files {
            Files::Zip(zip) => zip,
            Files::Folder(files) => {
                let unreadable = |error: io::Error| ArchiveError::Unreadable {
                    path: files[index].display().to_string(),
                    problem: error.to_string(),
                };
                return file::read(&files[index], MOST_BYTES).map_err(unreadable);
            }
        };
        let mut entry = zip.by_index(index).map_err(|error| damaged(&path, &error))?;
        let size = entry.size();
        let mut bytes = Vec::new();
        copy(&mut entry, size, &mut bytes)
            .map_err(|problem| ArchiveError::Damaged { path, problem: format!("`{name}`: {problem}") })?;
        Ok(bytes)
    }

    /// For `map_err`: what is wrong with an entry.
    pub fn damaged(&self, name: &str, problem: &str) -> ArchiveError {
        ArchiveError::Damaged { path: self.path.clone(), problem: format!("`{name}`: {problem}") }
    }

    /// For `map_err`: why an entry, though whole, is not read.
    pub fn refused(&self, name: &str, problem: &str) -> ArchiveError {
        ArchiveError::Refused { path: self.path.clone(), problem: format!("`{name}` {problem}") }
    }

    /// The study's file, by the description.
    ///
    /// # Errors
    /// When there is no description, it is none, or it names what is not there.
    pub fn described(&mut self) -> Result<String, ArchiveError> {
        let path = self.path.clone();
        let no = |problem: &str| ArchiveError::NoArchive { path: path.clone(), problem: problem.to_owned() };
        let value = self.description()?;
        let graph = value["@graph"].as_array().map_or(&[][..], Vec::as_slice);
        let entity = |id: &str| graph.iter().find(|entity| entity["@id"] == id);
        let root = entity(METADATA).and_then(|metadata| entity(metadata["about"]["@id"].as_str()?));
        let root = root.ok_or_else(|| no(&format!("`{METADATA}` describes no data set")))?;
        let parts = root["hasPart"].as_array().map_or(&[][..], Vec::as_slice);
        for id in parts.iter().filter_map(|part| part["@id"].as_str()) {
            if !elsewhere(id) && !self.entries.contains_key(id) {
                let problem = format!("`{METADATA}` names `{}`, which is not in it", id.escape_debug());
                return Err(ArchiveError::Refused { path, problem });
            }
        }
        let study = root["mainEntity"]["@id"].as_str().filter(|id| self.entries.contains_key(*id));
        study.map(str::to_owned).ok_or_else(|| no(&format!("`{METADATA}` names no study that is in it")))
    }

    fn description(&mut self) -> Result<Value, ArchiveError> {
        let no = |problem: String| ArchiveError::NoArchive { path: self.path.clone(), problem };
        let Some(&index) = self.entries.get(METADATA) else {
            return Err(no(format!("it has no `{METADATA}`, which says what is in it")));
        };
        let size = match &mut self.files {
            Files::Zip(zip) => zip.by_index(index).map_or(0, |entry| entry.size()),
            Files::Folder(files) => fs::metadata(&files[index]).map_or(0, |facts| facts.len()),
        };
        if size > LARGEST_METADATA {
            return Err(no(format!("`{METADATA}` is larger than {} MiB", LARGEST_METADATA >> 20)));
        }
        let bytes = self.bytes(METADATA)?;
        serde_json::from_slice(&bytes).map_err(|error| self.damaged(METADATA, &error.to_string()))
    }

    /// Compares every file with the digest that the description gives of it.
    ///
    /// # Errors
    /// All at once: files with other contents, without a digest, missing, and added.
    pub fn intact(&mut self) -> Result<(), ArchiveError> {
        let value = self.description()?;
        let graph = value["@graph"].as_array().map_or(&[][..], Vec::as_slice);
        let is_file = |entity: &Value| match &entity["@type"] {
            Value::Array(types) => types.iter().any(|one| one == "File"),
            one => one == "File",
        };
        let files = graph.iter().filter(|entity| is_file(entity));
        let listed: BTreeMap<&str, Option<&str>> =
            files.filter_map(|entity| Some((entity["@id"].as_str()?, entity["sha256"].as_str()))).collect();
        let names: Vec<String> = self.entries.keys().filter(|name| *name != METADATA).cloned().collect();
        let mut wrong = Vec::new();
        for name in &names {
            match listed.get(name.as_str()) {
                None if is_preview(name) => {}
                None => wrong.push(format!("`{name}` was added")),
                Some(None) => wrong.push(format!("`{name}` has no digest")),
                Some(Some(digest)) if sha256(&self.bytes(name)?) != digest.to_ascii_lowercase() => {
                    wrong.push(format!("`{name}` has other contents"));
                }
                Some(Some(_)) => {}
            }
        }
        let missing = listed.keys().filter(|name| !elsewhere(name) && !self.entries.contains_key(**name));
        wrong.extend(missing.map(|name| format!("`{}` is missing", name.escape_debug())));
        if wrong.is_empty() {
            return Ok(());
        }
        let more = wrong.len().saturating_sub(MOST_TOLD);
        wrong.truncate(MOST_TOLD);
        if more > 0 {
            wrong.push(format!("and {more} more"));
        }
        let problem = format!("it is not what `{METADATA}` says: {}", wrong.join(", "));
        Err(ArchiveError::Damaged { path: self.path.clone(), problem })
    }
}

/// Whether an identifier is none of a file in the archive.
fn elsewhere(id: &str) -> bool {
    ["http://", "https://", "#"].iter().any(|start| id.starts_with(start))
}

/// Whether a file is one that systems add to folders of others, or hide.
fn is_of_a_system(name: &str) -> bool {
    let is_one = |part: &str| part.starts_with('.') || ["__MACOSX", "Thumbs.db", "desktop.ini"].contains(&part);
    // `..` is refused by its name.
    name.split('/').any(|part| is_one(part) && part != "..")
}

/// Whether a file belongs to the page that RO-Crate lets anybody add to a crate.
fn is_preview(name: &str) -> bool {
    name == "ro-crate-preview.html" || name.starts_with("ro-crate-preview_files/")
}

/// What is wrong with a name.
fn safe(name: &str) -> Result<(), &'static str> {
    let parts = || name.strip_suffix('/').unwrap_or(name).split('/');
    if name.len() > LONGEST_NAME {
        Err("has too long a name")
    } else if name.chars().any(|c| c.is_control() || c == '\\') {
        Err("has a name with control characters or backslashes")
    } else if name.starts_with('/') || name.get(1..2) == Some(":") {
        Err("has an absolute path")
    } else if parts().any(|part| part == "..") {
        Err("points outside the archive")
    } else if parts().any(|part| part.is_empty() || part == ".") {
        Err("has a path with empty parts")
    } else {
        Ok(())
    }
}

/// Copies an entry that says it has `size` bytes; at its end the reader compares the checksum.
fn copy(entry: &mut impl Read, size: u64, into: &mut impl Write) -> Result<(), String> {
    let copied = std::io::copy(&mut entry.take(size + 1), into).map_err(|error| error.to_string())?;
    match copied {
        copied if copied > size => Err(format!("it says it has {size} bytes, but has more")),
        copied if copied < size => Err(format!("it says it has {size} bytes, but has {copied}")),
        _ => Ok(()),
    }
}

fn no_archive(path: &str, error: &ZipError) -> ArchiveError {
    ArchiveError::NoArchive { path: path.to_owned(), problem: format!("it is not a zip file, or cut off ({error})") }
}

fn damaged(path: &str, error: &ZipError) -> ArchiveError {
    ArchiveError::Damaged { path: path.to_owned(), problem: error.to_string() }
}
