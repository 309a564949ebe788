//! A study: one YAML file, read and checked, then never changed.
//!
//! `read` gives text, `document` a tree, `decode` records by the declared fields, `assemble` the study and its stages,
//! `links` checks what they say of each other. Must not know: execution, the store.

mod assemble;
mod changes;
mod characters;
pub mod declared;
mod decode;
pub mod describe;
mod document;
mod links;
mod notation;
mod overrides;
pub mod path;
mod place;
pub mod profile;
mod quantity;
mod read;
pub mod schema;
pub mod settings;
#[cfg(test)]
mod tests;
mod words;

use std::fmt;
use std::path::{Path, PathBuf};

pub use changes::{Changes, Settings};

use crate::program::Program;
use crate::stage::{Kind, Stage};
use crate::table::tolerance::Allowance;
use declare::error::{Diagnostic, Place};
use declare::record::Record;

/// What a study reproduces.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    pub paper: String,
    pub tables: Vec<i64>,
    pub figures: Vec<i64>,
}

/// A whole study, valid.
pub struct Study {
    /// Its name: the folder of its results.
    pub name: String,
    pub title: String,
    pub source: Option<Source>,
    pub seed: u64,
    /// Where it was read from.
    pub path: PathBuf,
    /// The file's text, for messages that show a line of it, and behind it what was set from outside: with it, it is the
    /// text of the same study.
    pub text: String,
    /// What was set from outside.
    pub changes: Changes,
    /// By how much columns may differ between two runs and still count as the same; no part of any result.
    pub tolerances: Vec<Allowance>,
    /// In the order of the file.
    pub nodes: Vec<Node>,
    /// Whose kinds of stages they are.
    pub program: &'static Program,
}

/// One stage of a study.
pub struct Node {
    pub name: String,
    /// Where its name stands.
    pub place: Place,
    pub kind: &'static Kind,
    /// After defaults; chunks of the stage are built from it.
    pub record: Record,
    pub stage: Box<dyn Stage>,
}

/// Why a file is not a study. Shown as `file:line:column: message`, with the help on a line of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadError {
    pub path: PathBuf,
    /// What was read, to show the line; places count in it.
    pub text: String,
    pub diagnostic: Box<Diagnostic>,
}

impl Study {
    /// What is wrong with it, found after it was read.
    #[must_use]
    pub fn refused(&self, wrong: Diagnostic) -> LoadError {
        self.changes.placed(LoadError::new(&self.path, self.text.clone(), wrong))
    }
}

impl LoadError {
    fn new(path: &Path, text: String, diagnostic: Diagnostic) -> Self {
        Self { path: path.to_owned(), text, diagnostic: Box::new(diagnostic) }
    }
}

impl fmt::Display for LoadError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}:", self.path.display())?;
        if let Some(place) = self.diagnostic.place {
            write!(formatter, "{}:{}:", place.line, place.column)?;
        }
        write!(formatter, " {}", self.diagnostic.message)?;
        match &self.diagnostic.help {
            Some(help) => write!(formatter, "\n  help: {help}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for LoadError {}

/// Reads and checks a study of this program.
///
/// # Errors
/// One message for the first thing that is wrong with it.
pub fn load(path: &Path, program: &'static Program) -> Result<Study, LoadError> {
    load_text(&read::read(path)?, path, program)
}

/// The same with something set from outside.
///
/// # Errors
/// As [`load`]; what is wrong with what is set has that for its place.
pub fn load_changed(path: &Path, program: &'static Program, set: &Settings) -> Result<Study, LoadError> {
    changes::load(&read::read(path)?, path, program, set)
}

/// Checks a study whose text was read from `path`.
///
/// # Errors
/// As [`load`].
pub fn load_text(text: &str, path: &Path, program: &'static Program) -> Result<Study, LoadError> {
    changes::load(text, path, program, &Settings::default())
}
