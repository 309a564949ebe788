//! Why a stage gave no tables.
//!
//! Must not know: what becomes of the others.

use crate::store::error::StoreError;
use declare::error::Faults;

/// Why a stage gave no tables.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// The stage's own finding.
    #[error("{0}")]
    Failed(String),
    /// The same about a place in the study.
    #[error("{0}")]
    Study(Faults),
    /// A mistake of this program.
    #[error("this is a bug: {0}")]
    Bug(String),
    #[error("{0}")]
    NotDeterministic(String),
    #[error("{0}")]
    Store(String),
}

impl From<StoreError> for Fault {
    fn from(error: StoreError) -> Self {
        let message = error.to_string();
        match error {
            StoreError::NotDeterministic { .. } => Self::NotDeterministic(message),
            StoreError::Format { .. } => Self::Bug(message),
            StoreError::Io { .. }
            | StoreError::Damaged { .. }
            | StoreError::NotForHere { .. }
            | StoreError::OtherRun { .. }
            | StoreError::Stopped { .. }
            | StoreError::InUse { .. } => Self::Store(message),
        }
    }
}

/// Why a part gave no tables.
pub(super) enum Ended {
    GivenUp,
    Fault(Fault),
}

impl From<StoreError> for Ended {
    fn from(error: StoreError) -> Self {
        Self::Fault(error.into())
    }
}
