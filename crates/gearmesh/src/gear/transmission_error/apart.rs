//! Pairs of teeth that are not what the design says of all: farther apart, or with flanks of their own.
//!
//! Must not know: which teeth they are, what sets them apart.

use std::sync::Arc;

use super::flanks::Flanks;
use super::load_case::LoadCase;
use super::within_reach::WithinReach;
use crate::gear::contact::flattening::InSeries;
use crate::numeric::complementarity::{MOST_SPRINGS, PerSpring};

/// What the pairs of a position have of their own, by their springs.
#[derive(Clone)]
pub(super) struct Apart<'a> {
    /// How much farther apart each is than its flanks say \[m\].
    pub(super) distances: PerSpring,
    /// Flanks in the place of the design's, of the same kind: a surface if those are one.
    pub(super) flanks: [Option<Arc<Flanks<'a>>>; MOST_SPRINGS],
}

impl<'a> LoadCase<'a> {
    /// Whether every pair is what the design says of all.
    #[inline]
    pub(super) fn is_evenly_spaced(&self) -> bool {
        self.apart.is_none()
    }

    /// The flanks of the pair that is this spring.
    #[inline]
    pub(super) fn flanks_of(&self, spring: usize) -> &Flanks<'a> {
        let own = self.apart.as_ref().and_then(|apart| apart.flanks[spring].as_deref());
        own.unwrap_or(&self.flanks)
    }

    /// The gap of the pair that is this spring.
    #[inline]
    pub(super) fn gap_of(&self, spring: usize, s: f64) -> Option<f64> {
        match &self.apart {
            None => self.gap(s),
            Some(apart) => Some(self.gap_between(self.flanks_of(spring), s)? + apart.distances[spring]),
        }
    }

    /// An approach that no equilibrium of the pairs within reach exceeds, from the smallest gap on; as [`LoadCase::alone`] of the
    /// nearest of them.
    #[inline]
    pub(super) fn above(&self, reach: &WithinReach, law: &mut Option<InSeries<'a>>) -> f64 {
        self.alone(reach.nearest_position(), self.flanks_of(reach.nearest_spring()), law)
    }
}
