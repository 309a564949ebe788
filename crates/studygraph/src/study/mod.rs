//! A study: one YAML file, read and checked, then never changed.
//!
//! A file imports from its own layer and from those before it, and no two files import each other:
//!
//! 1. text: `place`, `words`, `characters`, `read` (the file), `document` (its tree), `notation` (texts of numbers);
//! 2. texts added to it: `columns`, `conditions` (CSV), `added`, `files`, `stored`;
//! 3. stages as they are written: `path`, `overrides`, and the messages of `around`, `unknown`;
//! 4. values: `scalar`, `quantity`, `spread`;
//! 5. records by the declared fields: `decode`, with the fields of other stages in `decode/varied`;
//! 6. a study: `assemble`, above its checks in `links`, `intervals`, `cells`;
//! 7. what is set from outside: `changes`.
//!
//! `schema`, `describe` and `cursor` show it to editors. Must not know: execution, the store.

mod added;
mod around;
mod assemble;
mod blame;
mod cells;
mod changes;
mod characters;
mod columns;
mod conditions;
pub mod cursor;
pub mod declared;
mod decode;
pub mod describe;
pub mod described;
mod document;
mod files;
pub mod identity;
mod intervals;
mod links;
pub mod named;
pub mod notation;
mod overrides;
pub mod path;
mod place;
pub mod profile;
mod quantity;
mod read;
mod scalar;
pub mod schema;
pub mod settings;
mod spread;
mod stored;
mod structure;
#[cfg(test)]
mod tests;
mod unknown;
mod whereabouts;
mod words;

use std::fmt;
use std::path::{Path, PathBuf};

pub use changes::{Changes, Refused, Settings};

use crate::program::Program;
use crate::stage::{Kind, Stage};
use crate::table::tolerance::Allowance;
use declare::error::{Diagnostic, Faults, Place};
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
    /// One YAML document of the whole study: the file's text, and with it what was set from outside and the texts of its files.
    pub text: String,
    /// What was set from outside.
    pub changes: Changes,
    /// By how much columns may differ between two runs and still count as the same; no part of any result.
    pub tolerances: Vec<Allowance>,
    /// In the order of the file.
    pub nodes: Vec<Node>,
    /// What is valid and hardly meant: for the user, no part of any result.
    pub notes: Vec<Diagnostic>,
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

/// Mistakes that are told at once, except to somebody who asks for all.
const MOST_TOLD: usize = 10;

/// Why a file is not a study. Shown as `file:line:column: message`, with the help on a line of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadError {
    pub path: PathBuf,
    /// What was read, to show the line; places count in it.
    pub text: String,
    pub diagnostic: Box<Diagnostic>,
    /// What else is wrong, as far as that can be told, in the order of the text.
    pub others: Vec<Diagnostic>,
    /// How many are told at most.
    told: usize,
}

impl Study {
    /// Its notes as sentences, with file, line and column.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.notes.iter().map(|note| {
            let place = note.place.map(|place| format!(":{}:{}", place.line, place.column)).unwrap_or_default();
            let help = note.help.as_ref().map(|help| format!("; {help}")).unwrap_or_default();
            format!("{}{place}: {}{help}", self.path.display(), note.message)
        })
    }

    /// The files that its results depend on: its own, then those that it names.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        [self.path.clone()].into_iter().chain(self.changes.files().map(Path::to_owned)).collect()
    }

    /// What is wrong with it, found after it was read.
    #[must_use]
    pub fn refused(&self, wrong: impl Into<Faults>) -> LoadError {
        self.changes.placed(LoadError::new(&self.path, self.changes.text(&self.text).to_owned(), wrong))
    }
}

impl LoadError {
    /// In the order of the text; what two found is told once.
    fn new(path: &Path, text: String, wrong: impl Into<Faults>) -> Self {
        let Faults { mut first, mut others } = wrong.into();
        let at = |found: &Diagnostic| found.place.map_or(0, |place| place.offset);
        others.sort_by_key(at);
        if let Some(earlier) = others.first_mut().filter(|other| at(other) < at(&first)) {
            std::mem::swap(earlier, first.as_mut());
            others.sort_by_key(at);
        }
        let mut told = vec![(at(&first), first.message.clone())];
        others.retain(|found| {
            let found = (at(found), found.message.clone());
            let is_new = !told.contains(&found);
            if is_new {
                told.push(found);
            }
            is_new
        });
        Self { path: path.to_owned(), text, diagnostic: first, others, told: MOST_TOLD }
    }

    /// For somebody who wants to know of all.
    #[must_use]
    pub fn in_full(self) -> Self {
        Self { told: usize::MAX, ..self }
    }

    /// What is told of it.
    pub fn told(&self) -> impl Iterator<Item = &Diagnostic> {
        self.each().take(self.told)
    }

    /// Says that there is more than is told; nothing where there is not.
    #[must_use]
    pub fn more(&self) -> Option<String> {
        let more = (self.others.len() + 1).saturating_sub(self.told);
        (more > 0).then(|| format!("and {more} more; `gearstudy check` tells all"))
    }

    /// Whether there is no file at all, of which anything could be wrong.
    #[must_use]
    pub fn is_of_no_file(&self) -> bool {
        self.diagnostic.message == read::NOT_THERE
    }

    /// Everything that is wrong.
    pub fn each(&self) -> impl Iterator<Item = &Diagnostic> {
        [self.diagnostic.as_ref()].into_iter().chain(&self.others)
    }
}

impl fmt::Display for LoadError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, found) in self.told().enumerate() {
            let line = if at == 0 { "" } else { "\n" };
            write!(formatter, "{line}{}:", self.path.display())?;
            if let Some(place) = found.place {
                write!(formatter, "{}:{}:", place.line, place.column)?;
            }
            write!(formatter, " {}", found.message)?;
            if let Some(help) = &found.help {
                write!(formatter, "\n  help: {help}")?;
            }
        }
        self.more().map_or(Ok(()), |more| write!(formatter, "\n{}: {more}", self.path.display()))
    }
}

impl std::error::Error for LoadError {}

/// Digest of the text of a study, which is the same whatever its line ends are: git may change them on the way.
#[must_use]
pub fn digest(text: &str) -> String {
    blake3::hash(text.replace("\r\n", "\n").as_bytes()).to_string()
}

/// The files that a study names, as far as that can be told, where they would be.
#[must_use]
pub fn files(text: &str, path: &Path, program: &'static Program, set: &Settings) -> Vec<PathBuf> {
    changes::files(text, path, program, set)
}

/// Reads and checks a study of this program.
///
/// # Errors
/// What is wrong with it: all that can be told of its parts, each by itself.
pub fn load(path: &Path, program: &'static Program) -> Result<Study, LoadError> {
    load_text(&read::read(path)?, path, program)
}

/// The same with something set from outside.
///
/// # Errors
/// As [`load`]; what is wrong with what is set has that for its place.
pub fn load_changed(path: &Path, program: &'static Program, set: &Settings) -> Result<Study, LoadError> {
    examine(path, program, set).map_err(Refused::error)
}

/// The same, with what is sound of a study that is refused: more can be found out about that.
///
/// # Errors
/// As [`load_changed`].
pub fn examine(path: &Path, program: &'static Program, set: &Settings) -> Result<Study, Refused> {
    changes::examine(&read::read(path)?, path, program, set)
}

/// Checks a study whose text was read from `path`.
///
/// # Errors
/// As [`load`].
pub fn load_text(text: &str, path: &Path, program: &'static Program) -> Result<Study, LoadError> {
    examine_text(text, path, program).map_err(Refused::error)
}

/// The same as [`examine`] of a text.
///
/// # Errors
/// As [`load`].
pub fn examine_text(text: &str, path: &Path, program: &'static Program) -> Result<Study, Refused> {
    examine_changed_text(text, path, program, &Settings::default())
}

/// The same with something set from outside.
///
/// # Errors
/// As [`load_changed`].
pub fn examine_changed_text(
    text: &str,
    path: &Path,
    program: &'static Program,
    set: &Settings,
) -> Result<Study, Refused> {
    changes::examine(text, path, program, set)
}
