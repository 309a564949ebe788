//! Files in the place of a manifest that are none, or not for this version.
//!
//! Must not know: what a manifest says.

use serde::Deserialize;

use super::{AGAIN, FORMAT};
use crate::store::file;

/// Why a file gives no manifest: a phrase that follows its name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unread {
    #[error("is damaged: {0}; {AGAIN}")]
    Damaged(String),
    /// Of a format that is not known yet; a run must not replace it.
    #[error(
        "was written by a newer version of gearstudy: it has format {0}, and this version reads formats 1 to {FORMAT}; use that version"
    )]
    Newer(u64),
    #[error("{}", file::POINTER)]
    Pointer,
}

/// # Errors
/// When the file is a pointer of Git LFS, or of a newer version, whatever else that writes.
pub fn check_version(bytes: &[u8]) -> Result<(), Unread> {
    #[derive(Deserialize)]
    struct Versioned {
        format: u64,
    }
    if file::is_pointer(bytes) {
        return Err(Unread::Pointer);
    }
    match serde_json::from_slice(bytes) {
        Ok(Versioned { format }) if format > u64::from(FORMAT) => Err(Unread::Newer(format)),
        _ => Ok(()),
    }
}
