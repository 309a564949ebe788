//! What each stage of a study was last computed from: the memory that lets a run say *why* it computes.
//!
//! Kept in the cache, one file per study, so that it outlives a deleted results folder. Losing it costs explanations,
//! never results. Must not know: how keys are made.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use super::manifest::KeyRecord;
use declare::digest::Digest;

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
    #[serde(default, with = "whole")]
    pub whole: Option<Digest>,
    /// The keys that failed since.
    pub failed: Vec<Failed>,
}

/// A key that failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Failed(#[serde(with = "super::hexadecimal")] pub Digest);

mod whole {
    use declare::digest::Digest;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::Failed;

    #[allow(clippy::ref_option)] // as serde calls it
    pub fn serialize<S: Serializer>(whole: &Option<Digest>, serializer: S) -> Result<S::Ok, S::Error> {
        whole.map(Failed).serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Digest>, D::Error> {
        Ok(Option::<Failed>::deserialize(deserializer)?.map(|Failed(digest)| digest))
    }
}

impl Journal {
    /// The places of all stages, to look many of them up.
    #[must_use]
    pub fn by_name(&self) -> HashMap<String, usize> {
        self.stages.iter().enumerate().map(|(index, stage)| (stage.name.clone(), index)).collect()
    }
}
