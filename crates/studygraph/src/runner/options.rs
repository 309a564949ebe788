//! What the user may ask of a run besides the study itself.
//!
//! Must not know: how it was asked for.

use std::collections::{BTreeMap, BTreeSet};

use super::limits::Limits;
use crate::stage::Want;

/// How to run a study.
#[derive(Clone, Default)]
pub struct Options {
    /// Threads; 0 for as many as the machine has.
    pub jobs: usize,
    /// After a failure, whether stages that do not depend on it are still run.
    pub keep_going: bool,
    pub force: Force,
    /// Only these stages and what they need; empty for all.
    pub only: Vec<String>,
    /// Tables and columns on demand that the user wants to see.
    pub wanted: Vec<Wanted>,
    /// What is beyond them is refused.
    pub limits: Limits,
    /// Of these stages only these parts; of those that are not named all.
    pub share: Share,
}

/// By stage the parts that are one's own.
pub type Share = BTreeMap<String, BTreeSet<usize>>;

/// What to compute although the cache has it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Force {
    #[default]
    Nothing,
    All,
    Stages(BTreeSet<String>),
}

impl Force {
    #[must_use]
    pub fn applies(&self, stage: &str) -> bool {
        match self {
            Self::Nothing => false,
            Self::All => true,
            Self::Stages(names) => names.contains(stage),
        }
    }
}

/// A table of a stage that the user wants, with columns on demand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wanted {
    pub stage: String,
    pub want: Want,
}

impl Options {
    /// Whether a part of a stage is to be computed here.
    #[must_use]
    pub fn is_own(&self, stage: &str, part: usize) -> bool {
        self.share.get(stage).is_none_or(|own| own.contains(&part))
    }

    /// The number of threads, resolved.
    #[must_use]
    pub fn threads(&self) -> usize {
        if self.jobs > 0 { self.jobs } else { std::thread::available_parallelism().map_or(1, usize::from) }
    }
}
