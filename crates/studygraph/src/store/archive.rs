//! An archive: a study, everything that came of it, and a description that other programs read, as one zip file.
//!
//! The description is a Workflow Run RO-Crate: `metadata` writes it, [`pack`] the zip, [`open`] reads one that anybody may
//! have made. The same results give the same bytes. Must not know: how results come about, the graph.

pub mod metadata;
pub mod open;
pub mod pack;
#[cfg(test)]
mod tests;

use sha2::{Digest, Sha256};

/// The name that the RO-Crate specification gives to the description.
pub const METADATA: &str = "ro-crate-metadata.json";
/// The schema of the study, for editors.
pub const SCHEMA: &str = "study.schema.json";
pub const CITATION: &str = "CITATION.cff";

/// The folder of the results of a study; unpacked, the archive is a folder in which the program finds its way.
#[must_use]
pub fn results(study: &str) -> String {
    format!("results/{study}/")
}

/// The name of the study's file.
#[must_use]
pub fn study(name: &str) -> String {
    format!("{name}.yaml")
}

/// The digest of a file as the description gives it, in hexadecimal: SHA-256, which every system has a command for.
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(64);
    for byte in sha256_bytes(bytes) {
        text += &format!("{byte:02x}");
    }
    text
}

/// The digest itself.
#[must_use]
pub fn sha256_bytes(bytes: &[u8]) -> [u8; 32] {
    Sha256::digest(bytes).into()
}

/// Why an archive cannot be used. `path` names it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ArchiveError {
    #[error("cannot read `{path}`: {problem}")]
    Unreadable { path: String, problem: String },
    #[error("`{path}` is not an archive: {problem}")]
    NoArchive { path: String, problem: String },
    #[error("`{path}` is damaged: {problem}")]
    Damaged { path: String, problem: String },
    /// It is whole, but made in a way that no honest archive is.
    #[error("`{path}` is refused: {problem}")]
    Refused { path: String, problem: String },
}
