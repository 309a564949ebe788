//! The tooth pairs at one mesh position as springs behind gaps.
//!
//! Stiffness in N/m over the common face width. Must not know: where in the mesh cycle the position is.

use super::face::Face;
use super::flattening::Logarithmic;
use crate::numeric::complementarity::{MOST, PerSpring, Springs};

/// Pairs with the linear contact law.
pub struct LinearPairs<'a> {
    pub stiffness: PerSpring,
    pub face: &'a Face<'a>,
}

impl Springs for LinearPairs<'_> {
    #[inline]
    fn response(&self, pair: usize, interference: f64) -> (f64, f64) {
        let (passed, share) = self.face.passed(interference);
        (self.stiffness[pair] * passed, self.stiffness[pair] * share)
    }
}

/// Pairs with the load-dependent contact law. A slice that carries p has the interference b·c·p + p(α − β ln p), c the
/// compliance of both teeth without the contact.
pub struct LogarithmicPairs<'a> {
    pub laws: [Logarithmic; MOST],
    /// b·c \[1/Pa\].
    pub compliance: PerSpring,
    pub width: f64,
    pub face: &'a Face<'a>,
}

impl LogarithmicPairs<'_> {
    /// The interference at which a pair alone carries at least `total`, whatever the shape of the face: by the
    /// convexity of the response, that of a flat face plus the mean deviation.
    #[must_use]
    pub fn above(&self, pair: usize, total: f64) -> f64 {
        let load = total / self.width;
        self.compliance[pair] * load + self.laws[pair].approach(load) + self.face.mean
    }

    /// The load per width of a slice at a local interference > 0.
    #[must_use]
    pub fn line_load(&self, pair: usize, interference: f64) -> (f64, f64) {
        self.laws[pair].load(self.compliance[pair], interference)
    }
}

impl Springs for LogarithmicPairs<'_> {
    fn response(&self, pair: usize, interference: f64) -> (f64, f64) {
        let (load, slope) = self.face.summed(interference, |depth| self.line_load(pair, depth));
        (self.width * load, self.width * slope)
    }
}
