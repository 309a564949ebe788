//! A study: one YAML file, read and checked, then never changed.
//!
//! Must not know: execution, the store.

use std::path::PathBuf;

use crate::base::error::Place;
use crate::base::record::Record;
use crate::stage::{Kind, Stage};

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
    /// The file's text, for messages that show a line of it.
    pub text: String,
    /// In the order of the file.
    pub nodes: Vec<Node>,
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
