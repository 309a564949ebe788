//! A file becomes text, or one message that says why not.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use super::LoadError;
use super::place::place_at;
use crate::presence;
use declare::error::{Diagnostic, Place, nearest};

/// What is said of a file that is not there.
pub const NOT_THERE: &str = "there is no such file";

/// Bytes of a study, the files that it names included. The largest that anybody wrote has a few ten thousand.
pub const LARGEST: u64 = 1 << 20;

/// Reads a whole file of UTF-8.
///
/// # Errors
/// When it cannot be read, is not a file, is too large or is not UTF-8.
pub fn read(path: &Path) -> Result<String, LoadError> {
    let refused = |diagnostic: Diagnostic| LoadError::new(path, String::new(), diagnostic);
    if presence::is_folder(path).map_err(|error| refused(unreadable(path, &error)))? {
        return Err(refused(Diagnostic::new("this is a directory; a study is one YAML file").help(in_folder(path))));
    }
    let bytes = bytes(path).map_err(|error| refused(unreadable(path, &error)))?;
    if bytes.len() as u64 > LARGEST {
        let message = format!("this file is larger than {} KiB, too large for a study", LARGEST >> 10);
        return Err(refused(Diagnostic::new(message).help("a study only describes; its data are computed")));
    }
    String::from_utf8(bytes).map_err(|error| not_utf8(path, error.as_bytes(), error.utf8_error().valid_up_to()))
}

/// Reads a whole file of UTF-8 that the study at `study` calls `shown` at `place` of its `text`.
///
/// # Errors
/// When it cannot be read, is not a file, is too large or is not UTF-8.
pub fn beside(path: &Path, shown: &str, (text, place, study): (&str, Place, &Path)) -> Result<String, LoadError> {
    let refused = |found: Diagnostic| LoadError::new(study, text.to_owned(), found.at(place));
    // What is no file, a pipe for one, might be waited for.
    let cannot = |error: io::Error| refused(Diagnostic::new(format!("`{shown}` cannot be read: {error}")));
    if presence::metadata(path).map_err(cannot)?.is_some_and(|found| !found.is_file()) {
        return Err(refused(Diagnostic::new(format!("`{shown}` is not a file"))));
    }
    let bytes = bytes(path).map_err(|error| {
        if error.kind() != io::ErrorKind::NotFound {
            return cannot(error);
        }
        let found = Diagnostic::new(format!("there is no file `{shown}`"));
        let wanted = path.file_name().unwrap_or_default().to_string_lossy();
        let others = names(folder_of(path), &["csv", "CSV"]).unwrap_or_default();
        refused(match nearest(&wanted, others.iter().map(String::as_str)) {
            Some(near) => {
                let near = Path::new(shown).with_file_name(near).display().to_string();
                found.help(format!("did you mean `{}`?", near.replace('\\', "/")))
            }
            None => found.help("a file is looked for from the folder of the study on"),
        })
    })?;
    if bytes.len() as u64 > LARGEST {
        let message = format!("`{shown}` is larger than {} KiB, too large for a study", LARGEST >> 10);
        return Err(refused(Diagnostic::new(message).help("leave out points, or average them")));
    }
    String::from_utf8(bytes).map_err(|error| not_utf8(path, error.as_bytes(), error.utf8_error().valid_up_to()))
}

fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    // One byte more than is allowed shows that there is more, even where the file has no size of its own.
    File::open(path)?.take(LARGEST + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn unreadable(path: &Path, error: &io::Error) -> Diagnostic {
    if error.kind() != io::ErrorKind::NotFound {
        return Diagnostic::new(format!("this file cannot be read: {error}"));
    }
    let missing = Diagnostic::new(NOT_THERE);
    let folder = folder_of(path);
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    let found = studies(folder).unwrap_or_default();
    match nearest(&wanted, found.iter().map(String::as_str)) {
        Some(near) => missing.help(format!("did you mean `{}`?", path.with_file_name(near).display())),
        None => missing,
    }
}

fn in_folder(folder: &Path) -> String {
    match studies(folder).as_deref() {
        Ok([first, ..]) => format!("name a file in it, for example `{}`", folder.join(first).display()),
        Ok([]) => "there is no YAML file in it".to_owned(),
        Err(error) => format!("it cannot be read: {error}"),
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Names of the YAML files in a folder, sorted.
fn studies(folder: &Path) -> io::Result<Vec<String>> {
    names(folder, &["yaml", "yml"])
}

/// Names of the files in a folder that end so, sorted.
fn names(folder: &Path, endings: &[&str]) -> io::Result<Vec<String>> {
    let entries = presence::entries(folder)?.into_iter().map(|(path, _)| path);
    let wanted = entries.filter(|path| path.extension().is_some_and(|own| endings.iter().any(|ending| own == *ending)));
    Ok(wanted.filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned())).collect())
}

fn not_utf8(path: &Path, bytes: &[u8], valid: usize) -> LoadError {
    // What comes before the wrong byte keeps its place; each wrong byte becomes one mark.
    let text = String::from_utf8_lossy(bytes).into_owned();
    let place = place_at(&text, valid, char::REPLACEMENT_CHARACTER.len_utf8());
    let diagnostic = if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
        Diagnostic::new("this file is UTF-16, not UTF-8")
    } else {
        Diagnostic::new(format!("this file is not UTF-8: the byte 0x{:02X} cannot stand here", bytes[valid]))
    };
    LoadError::new(path, text, diagnostic.at(place).help("save it as UTF-8"))
}
