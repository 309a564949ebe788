//! The slices of the tooth pairs at one mesh position as springs behind gaps.
//!
//! A slice is a strip of the face with the contact of its flanks and what its own load does to the teeth; what loads on
//! other slices do to it is the solver's coupling. Load in N on the slice. Must not know: how slices hold each other.

use super::face::Face;
use super::flattening::InSeries;
use crate::numeric::complementarity::Springs;

/// A slice under the penetration of its highest place.
#[derive(Clone, Copy, Debug)]
pub enum Slice {
    /// Stiffness \[N/m\].
    Linear(f64),
    /// Per width.
    Logarithmic(InSeries),
}

/// Slice by slice, pair by pair.
pub struct Slices<'a> {
    /// All slices of the first pair, then those of the next.
    pub slices: Vec<Slice>,
    /// The deviations within each slice, of one pair that stands for all, or of one pair after the other.
    pub faces: &'a [Face<'a>],
    /// Width of each of these slices \[m\]; the width of two where one stands for both.
    pub widths: &'a [f64],
}

impl Springs for Slices<'_> {
    fn response(&self, spring: usize, penetration: f64) -> (f64, f64) {
        let (face, width) = (&self.faces[spring % self.faces.len()], self.widths[spring % self.widths.len()]);
        match &self.slices[spring] {
            Slice::Linear(stiffness) => {
                let (passed, share) = face.passed(penetration);
                (stiffness * passed, stiffness * share)
            }
            Slice::Logarithmic(law) => {
                let (load, slope) = face.summed(penetration, |depth| law.load(depth));
                (width * load, width * slope)
            }
        }
    }
}
