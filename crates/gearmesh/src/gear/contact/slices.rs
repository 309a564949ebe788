//! The slices of the tooth pairs at one mesh position as springs behind gaps.
//!
//! A slice is a strip of the face with the contact of its flanks and what its own load does to the teeth; what loads on
//! other slices do to it is the solver's coupling. Load in N on the slice. Must not know: how slices hold each other.

use super::face::Face;
use super::flattening::InSeries;
use crate::numeric::complementarity::Springs;

/// A slice under the penetration of its highest place.
#[allow(clippy::large_enum_variant)] // all slices of a face are of one variant, and the linear law has one
#[derive(Clone, Debug)]
pub enum Slice<'a> {
    /// Stiffness \[N/m\].
    Linear(f64),
    /// Per width.
    Logarithmic(InSeries<'a>),
}

/// Slice by slice, pair by pair.
pub struct Slices<'a> {
    /// All slices of the first pair, then those of the next.
    pub slices: Vec<Slice<'a>>,
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
                let (load, slope) = face.summed(penetration, |_, depth| law.load(depth));
                (width * load, width * slope)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::gear::contact::flattening::Logarithmic;
    use crate::gear::fixtures::{STEELS, design, pair};
    use crate::numeric::lobatto::Rule;
    use declare::record::Value::Quantity;

    /// Tier: invariant; the slope is that of the load, by central differences, whichever law holds.
    #[test]
    fn the_slope_of_a_slice_is_that_of_its_load() {
        let (rule, width) = (Rule::new(9), 4e-3);
        let crowned = design(&pair(), &[("lead_crowning", "pinion", &[("amount", Quantity(8e-6))])]).unwrap();
        let faces = [Face::new(&crowned, width, &rule)];
        let law = Logarithmic::weber(&STEELS, 7e-3, [2.5e-3, 3e-3]).in_series(4e-11);
        let slices = [Slice::Linear(3e8), Slice::Logarithmic(law)].to_vec();
        let springs = Slices { slices, faces: &faces, widths: &[width] };
        for (spring, penetration) in [(0, 1e-7), (0, 5e-6), (0, 3e-5), (1, 1e-7), (1, 5e-6), (1, 3e-5)] {
            let step = 1e-5 * penetration;
            let [below, above] = [-step, step].map(|step| springs.response(spring, penetration + step).0);
            let ratio = springs.response(spring, penetration).1 * 2.0 * step / (above - below);
            assert!((ratio - 1.0).abs() < 1e-8, "spring {spring} at {penetration}: {ratio}");
        }
    }
}
