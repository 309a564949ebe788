//! The gap at a place beside the nominal point of contact, over the length along both flanks, in closed form.
//!
//! Both flanks are curves that leave a common tangent, turning away from each other by ψ = (f − s)/r and ψ′ = (T − s − q)/r′. The point of
//! the flank whose roll length q shrinks stands above a foot on the other one, along the normal there, by the separation S: across the
//! tangent it is ∫sin ψ + ∫sin ψ′ over S cos ψ, and along it the foot is nearer by S ψ − ½(∫ψ² − ∫ψ′²). What turns until it touches has
//! there the roll length of the foot, and S more. To the third order in the angles. Must not know: how places are followed.

use super::super::Way;

/// The sum of the angles \[rad\] up to which the gap is known to a picometre for each half micrometre that the flanks stand apart.
pub(super) const NEAR: f64 = 0.03;

/// Flanks near a path position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near<'a, 'b> {
    pub(super) ways: &'b [Way<'a>; 2],
    pub(super) base_radii: [f64; 2],
    pub(super) nominal: [f64; 2],
}

/// What there is at a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Here {
    /// The gap, its slope and its bend over the length along the flanks.
    pub(super) rates: [f64; 3],
    /// How far the flanks stand apart, and the roll lengths that meet when one turns by that.
    pub(super) apart: f64,
    pub(super) met: [f64; 2],
}

impl Near<'_, '_> {
    /// By how much both flanks together have turned \[rad\].
    #[inline]
    pub(super) fn angle(&self, roll_lengths: [f64; 2]) -> f64 {
        let [pinion, gear] = [0, 1].map(|at| (roll_lengths[at] - self.nominal[at]) / self.base_radii[at]);
        (pinion - gear).abs()
    }

    /// From the roll lengths where both flanks are as long, farther from the root of the pinion than at the nominal point if `is_ahead`.
    #[inline]
    pub(super) fn at(&self, roll_lengths: [f64; 2], is_ahead: bool) -> Here {
        // Of the flank whose roll length grows, and of the other one.
        let order = if is_ahead { [0, 1] } else { [1, 0] };
        let [foot, point] = order.map(|at| {
            let (nominal, per_radius) = (self.nominal[at], 1.0 / self.base_radii[at]);
            let off = roll_lengths[at] - nominal;
            let angle = off * per_radius;
            let square = angle * angle;
            // Integrals of the angle, its square and its third power along the flank.
            [
                angle,
                0.5 * square * (nominal + (2.0 / 3.0) * off),
                square * angle * ((1.0 / 3.0) * nominal + 0.25 * off),
                square * square * (0.25 * nominal + 0.2 * off),
            ]
        });
        let flat = foot[1] + point[1];
        let along = 0.5 * (foot[2] + point[2]);
        let turn = foot[0];
        let apart = flat - turn * (0.5 * flat * turn - along) - (foot[3] + point[3]) * (1.0 / 6.0);
        let angle = turn - point[0];
        let rates = order.map(|at| self.base_radii[at] / roll_lengths[at].max(f64::MIN_POSITIVE));
        let (sign, rise) = (if is_ahead { 1.0 } else { -1.0 }, angle);
        let mut met = roll_lengths;
        met[order[0]] += apart - rates[0] * (apart * turn - along);
        let of_foot = self.ways[order[0]].flank.held_rates(met[order[0]]);
        let of_point = self.ways[order[1]].flank.held_rates(roll_lengths[order[1]]);
        let grows = rates[0] + rise;
        let slope = rise + of_foot[1] * grows - of_point[1] * rates[1];
        let curvature = |at: usize| rates[at] / self.base_radii[order[at]];
        let bend = |of: [f64; 3], at: usize| (of[2] - of[1] * curvature(at)) * rates[at] * rates[at];
        let bend = curvature(0) + curvature(1) + bend(of_foot, 0) + bend(of_point, 1);
        Here { rates: [apart + of_foot[0] + of_point[0], sign * slope, bend], apart, met }
    }
}
