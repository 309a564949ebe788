//! Pairs of teeth that are not what the design says of all: farther apart, or with flanks of their own.
//!
//! Must not know: which teeth they are, what sets them apart.

use std::sync::Arc;

use super::flanks::Flanks;
use crate::numeric::complementarity::{MOST_SPRINGS, PerSpring};

/// What the pairs of a position have of their own, by their springs.
#[derive(Clone)]
pub(in crate::gear::mesh) struct IndividualPairs<'a> {
    /// How much farther apart each is than its flanks say \[m\].
    pub(in crate::gear::mesh) distances: PerSpring,
    /// Flanks in the place of the design's, of the same kind: a surface if those are one.
    pub(in crate::gear::mesh) flanks: [Option<Arc<Flanks<'a>>>; MOST_SPRINGS],
}
