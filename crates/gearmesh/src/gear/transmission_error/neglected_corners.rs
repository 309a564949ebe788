//! Tip corners that `corner_contact: none` leaves out: where they would touch under the load, and an estimate of their effect.
//!
//! Before A the tip corner of the gear stands off the pinion's flank by the separation of `contact/separation.rs`, after E that
//! of the pinion off the gear's flank, each with the modifications at the end of contact on top. Where the gears approach
//! by more, the corner carries load that the curve does not know. Lengths in m. Must not know: who reports it, the exact
//! curve with corner contact.

use super::curve::Point;
use super::load_case::LoadCase;
use crate::gear::contact::CornerContact;
use crate::gear::contact::separation::Facing;
use crate::gear::geometry::Side;

/// Where the search for the end of corner contact starts, in base pitches.
const FIRST_GUESS: f64 = 0.05;
/// Steps of that search: the separation is a square with a small cubic part, and three of them leave 1e-3.
const STEPS: usize = 4;

/// Tip corners before A and after E, as far as a load presses them against the mate's flank.
#[derive(Clone, Copy, Debug)]
pub struct NeglectedCorners {
    /// The gear's corner before A, and the pinion's after E.
    facing: [Facing; 2],
    /// What modifications leave between corner and flank at A and at E, with what the whole face has lost.
    clearance: [f64; 2],
    /// How far before A and after E the corners would touch at the largest approach.
    pub lengths: [f64; 2],
    path: [f64; 2],
    period: f64,
}

impl NeglectedCorners {
    /// Length of the path of contact that the corners would add, over the base pitch: the rise of the contact ratio under load.
    #[must_use]
    pub fn added_contact_ratio(&self) -> f64 {
        self.lengths.iter().sum::<f64>() / self.period
    }

    /// Estimated peak-to-peak with the corners in contact. Each pair that touches by a corner is a spring beside those in
    /// contact, as stiff as the softest single pair: to first order, since a corner is a little softer.
    #[must_use]
    pub fn peak_to_peak(&self, points: &[Point], force: f64) -> f64 {
        let softest = points.iter().map(|point| point.secant_stiffness).fold(f64::INFINITY, f64::min);
        let error = |point: &Point| {
            let oldest = point.path_position + point.pairs as f64 * self.period;
            let distances = [self.path[0] - (point.path_position - self.period), oldest - self.path[1]];
            let stiffness = point.secant_stiffness;
            let (mut forces, mut stiffnesses) = (force + stiffness * point.unloaded_transmission_error, stiffness);
            for (corner, distance) in distances.into_iter().enumerate() {
                if (0.0..self.lengths[corner]).contains(&distance) {
                    let gap = self.clearance[corner] + self.facing[corner].tip(distance).separation;
                    if gap < point.transmission_error {
                        forces += softest * gap;
                        stiffnesses += softest;
                    }
                }
            }
            forces / stiffnesses
        };
        let (least, most) = points
            .iter()
            .map(error)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), error| (least.min(error), most.max(error)));
        most - least
    }
}

impl LoadCase<'_> {
    /// The corners that are left out, if the gears approach by `transmission_error` \[m\] at most and that presses any of them
    /// against a flank. None with corner contact, without load, and where contact ends at a form circle.
    #[must_use]
    pub fn neglected_corners(&self, transmission_error: f64) -> Option<NeglectedCorners> {
        let pair = &self.cycle.pair;
        let is_known = self.force > 0.0
            && self.cycle.settings.corner_contact == CornerContact::None
            && ![Side::Pinion, Side::Gear].into_iter().any(|side| pair.is_curtailed(side));
        if !is_known {
            return None;
        }
        let path = [pair.start_of_contact, pair.end_of_contact];
        let facing = [Side::Gear, Side::Pinion].map(|side| Facing::new(pair, side));
        let clearance = path.map(|end| self.gap(end).unwrap_or(f64::INFINITY) + self.flanks.offset());
        let mut lengths = [0.0; 2];
        for corner in 0..2 {
            let approach = transmission_error - clearance[corner];
            if approach > 0.0 {
                lengths[corner] = touching_length(&facing[corner], approach, pair.base_pitch);
            }
        }
        let period = pair.base_pitch;
        lengths.iter().any(|length| *length > 0.0).then_some(NeglectedCorners {
            facing,
            clearance,
            lengths,
            path,
            period,
        })
    }
}

/// How far before its own position a tip corner is as far from the flank as the gears approach; at most `maximum`.
fn touching_length(facing: &Facing, approach: f64, maximum: f64) -> f64 {
    let mut length = FIRST_GUESS * maximum;
    for _ in 0..STEPS {
        let separation = facing.tip(length).separation;
        // Too near for a separation above rounding, or beyond what the mate's flank faces.
        if !(separation > 0.0 && separation.is_finite()) {
            return length;
        }
        length = (length * (approach / separation).sqrt()).min(maximum);
    }
    length
}
