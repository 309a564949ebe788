//! What can go wrong on disk.
//!
//! Must not know: what the files were for.

use std::io;
use std::path::Path;

#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    #[error("cannot {action} `{path}`: {source}")]
    Io { action: &'static str, path: String, source: io::Error },
    /// Made by an earlier run, but not readable as such: callers compute it again.
    #[error("`{path}` is damaged: {problem}")]
    Damaged { path: String, problem: String },
    /// Whole, but not to be read here nor replaced: of a newer version, or a pointer to what git has elsewhere.
    #[error("`{path}` {problem}")]
    NotForHere { path: String, problem: String },
    #[error(
        "not deterministic: table `{table}` came out different from the last time although nothing it depends on \
         changed"
    )]
    NotDeterministic { table: String },
    #[error("table `{table}` cannot be stored: {problem}")]
    Format { table: String, problem: String },
    #[error("`{path}` is of another run; `gearstudy run` writes that of this one")]
    OtherRun { path: String },
    #[error("stopped before `{path}`")]
    Stopped { path: String },
    #[error("`{path}` is in use by {who}")]
    InUse { path: String, who: String },
}

impl StoreError {
    /// For `map_err`: names what was being done to which file.
    pub fn io<'a>(action: &'static str, path: &'a Path) -> impl FnOnce(io::Error) -> Self + 'a {
        move |source| Self::Io { action, path: path.display().to_string(), source }
    }
}
