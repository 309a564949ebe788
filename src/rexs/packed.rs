//! The zipped form of REXS (`.rexsz`, `.rexs.zip`): an archive with one model. Must not know: what is in the model.

use std::io::{Cursor, Read};

use zip::ZipArchive;

use super::{MOST_BYTES, Refusal, too_large};

/// The text of a file of REXS, which may be an archive of one.
///
/// # Errors
/// When it is no text, or an archive without exactly one model.
pub fn text_of(bytes: Vec<u8>) -> Result<String, Refusal> {
    let bytes = if bytes.starts_with(b"PK\x03\x04") { unpacked(bytes)? } else { bytes };
    if bytes.len() > MOST_BYTES {
        return Err(too_large());
    }
    String::from_utf8(bytes).map_err(|_| Refusal::new("it is not UTF-8; save it as UTF-8"))
}

fn unpacked(bytes: Vec<u8>) -> Result<Vec<u8>, Refusal> {
    let refused = |error: &dyn std::fmt::Display| Refusal::new(format!("it is a damaged archive: {error}"));
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| refused(&error))?;
    let mut models = Vec::new();
    for index in 0..archive.len() {
        let entry = archive.by_index(index).map_err(|error| refused(&error))?;
        let name = String::from_utf8_lossy(entry.name_raw()).to_ascii_lowercase();
        if [".rexs", ".rexsj", ".xml", ".json"].iter().any(|ending| name.ends_with(ending)) {
            models.push(index);
        }
    }
    let [model] = models[..] else {
        let message = format!("the archive has {} models; take out the one that is meant", models.len());
        return Err(Refusal::new(message));
    };
    let file = archive.by_index(model).map_err(|error| refused(&error))?;
    let mut text = Vec::new();
    // A small archive may hold a large file.
    file.take(MOST_BYTES as u64 + 1).read_to_end(&mut text).map_err(|error| refused(&error))?;
    Ok(text)
}
