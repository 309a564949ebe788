//! What each stage of a study was last computed from: the memory that lets a run say *why* it computes.
//!
//! Kept in the cache, one file per study, so that it outlives a deleted results folder. Losing it costs explanations,
//! never results. Must not know: how keys are made.

use serde::{Deserialize, Serialize};

use super::manifest::KeyRecord;

/// The last state of a study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Journal {
    pub stages: Vec<JournalStage>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JournalStage {
    pub name: String,
    /// Of the last success, one per chunk.
    pub keys: Vec<KeyRecord>,
    /// The key under which the chunks are put together, where there are several.
    pub whole: Option<String>,
    /// The keys that failed since.
    pub failed: Vec<String>,
}

impl Journal {
    #[must_use]
    pub fn stage(&self, name: &str) -> Option<&JournalStage> {
        self.stages.iter().find(|stage| stage.name == name)
    }
}
