//! Loads at the corner of a tip that are not normal to the flank, where contact is resolved.
//!
//! What a load does along itself is a quadratic form of its direction: the loads along the normal and turned to either side
//! of it give all of it. They stand where the load of the tables is that is nearest to the corner, since mesh and half plane
//! meet their limits at the corner itself. E = 1, lengths in modules. Must not know: pairs, how it is solved.

use std::f64::consts::PI;

use super::super::inclined::Inclined;
use crate::gear::finite_elements::gear_model::{FlankLoad, Influences};

/// By how much the loads are turned \[rad\].
const TURN: f64 = 0.5;
/// By how much the loads of corners are, or less, for the error of the mesh \[rad\].
const USUAL: f64 = 0.2;

/// What they do, beside B.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AtTip {
    /// Along the flank by a load normal to it, and by one along it less by one normal to it.
    pub own: [f64; 2],
    /// At teeth 1, 2, … pitches back, by a load along the flank; by the affected place.
    pub neighbours: Vec<Vec<f64>>,
}

/// The loads that [`AtTip::new`] needs besides the normal one there.
pub(super) fn loads(roll: f64) -> [FlankLoad; 2] {
    [TURN, -TURN].map(|inclination| FlankLoad { inclination, ..FlankLoad::normal(roll) })
}

/// What a load along the flank does that one normal to it and one of [`loads`], the first, do as a sum of both, value by
/// value.
pub(super) fn along<'a>(turned: &'a [f64], normal: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    let (sine, cosine) = libm::sincos(TURN);
    turned.iter().zip(normal).map(move |(turned, normal)| (turned - cosine * normal) / sine)
}

impl AtTip {
    /// From the influences of loads of which the first `count` are those of the tables, the one that is nearest to the tip
    /// the last of them, and those of [`loads`] are `at` and the next. `apart`: ln c there, and what B has.
    pub(super) fn new(
        found: &Influences,
        [count, at]: [usize; 2],
        (apart, corner): (f64, [f64; 2]),
        [compliance, poisson_ratio]: [f64; 2],
    ) -> Self {
        let (sine, cosine) = libm::sincos(TURN);
        let [normal, one, other] = [count - 1, at, at + 1].map(|load| found.own[load]);
        let cross = (one - other) / (4.0 * sine * cosine);
        // The surface of a half plane yields along an inclined load by (1 + ν′)/(π E′) sin² of its angle more.
        let surface = (1.0 + poisson_ratio) / PI * compliance;
        let along = (one + other - 2.0 * normal) / (2.0 * sine * sine) + surface;
        let back = |rows: &Vec<Vec<f64>>| {
            // By the first tooth's place, on the further one's: reciprocal.
            (0..count).map(|on| (rows[on][at] - rows[on][at + 1]) / (2.0 * sine)).collect()
        };
        Self {
            own: [cross + corner[0] * apart, along + corner[1] * apart],
            neighbours: found.further.iter().map(back).collect(),
        }
    }

    /// The largest difference of what inclined loads do from that of another mesh.
    pub(super) fn difference(&self, other: &Self) -> f64 {
        let (sine, cosine) = libm::sincos(USUAL);
        let [cross, along] = [0, 1].map(|k| (self.own[k] - other.own[k]).abs());
        let own = sine * (2.0 * cosine * cross + sine * along);
        let pairs = self.neighbours.iter().flatten().zip(other.neighbours.iter().flatten());
        pairs.map(|(a, b)| sine * (a - b).abs()).fold(own, f64::max)
    }

    /// Whether a load that is turned as those of corners are moves itself by less than nothing, where one along the normal
    /// does by `normal`.
    pub(super) fn is_stiff(&self, normal: f64) -> bool {
        normal + Inclined::added(self.own, USUAL) <= 0.0
    }
}
