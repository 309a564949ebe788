//! Tip corners that `corner_contact: none` leaves out: where they would touch under the load, and an estimate of their effect.
//!
//! Before A the tip corner of the gear stands off the pinion's flank by the separation of `contact/separation.rs`, after E that
//! of the pinion off the gear's flank, each with the modifications at the end of contact on top. Where the gears approach
//! by more, the corner carries load that the curve does not know. Lengths in m. Must not know: who reports it, the exact
//! curve with corner contact.

use super::curve::Point;
use crate::gear::contact::CornerContact;
use crate::gear::contact::separation::Facing;
use crate::gear::geometry::Side;
use crate::gear::mesh::equilibrium::load_case::LoadCase;
use crate::numeric::complementarity::PerSpring;
use std::array;

/// Where the search for the end of corner contact starts, in base pitches.
const FIRST_GUESS: f64 = 0.05;
/// Parts of a stretch between two points of the curve near a corner.
const BETWEEN: u32 = 8;
/// Points of a curve are no farther apart than this share of the base pitch.
const NEAR: f64 = 0.125;
/// Steps of that search: the separation is a square with a small cubic part, and three of them leave 1e-3.
const STEPS: usize = 4;

/// Tip corners before A and after E, as far as a load presses them against the mate's flank.
#[derive(Clone, Copy, Debug)]
pub struct NeglectedCorners {
    /// The gear's corner before A, and the pinion's after E.
    facing: [Facing; 2],
    /// What modifications leave between corner and flank at A and at E, with what the whole face has lost.
    clearance: [f64; 2],
    /// Penetration that the load on the pair one, two … base pitches inside the path causes at the pair of the corner,
    /// per load \[m/N\]; 0 where pairs are uncoupled.
    coupling: [PerSpring; 2],
    /// Approach of the pair at A and at E, over the load, if it carried the whole load alone \[m/N\].
    compliance: [f64; 2],
    /// How far before A and after E the corners would touch at the largest approach, if the pair next to them carried the whole load.
    pub lengths: [f64; 2],
    /// The same without coupling: no corner touches farther out.
    farthest: [f64; 2],
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
    /// contact, as stiff as a pair at A or E: to first order, since a corner is a little softer. Loads on coupled pairs move the
    /// corner away from its mate. Where corners first touch there is no point of the curve: values between two points are interpolated.
    #[must_use]
    pub fn peak_to_peak(&self, points: &[Point], force: f64) -> f64 {
        let mut range = (f64::INFINITY, f64::NEG_INFINITY);
        let mut take = |point: &Point| {
            let error = self.transmission_error(point, force);
            range = (range.0.min(error), range.1.max(error));
        };
        for two in points.windows(2) {
            take(&two[0]);
            if two[0].pairs == two[1].pairs && self.is_near(&two[0]) {
                (1..BETWEEN).for_each(|step| take(&between(two, f64::from(step) / f64::from(BETWEEN))));
            }
        }
        points.last().into_iter().for_each(take);
        range.1 - range.0
    }

    /// How far the pair behind A and the one ahead of E have to go, or have gone, to the path of contact.
    fn distances(&self, point: &Point) -> [f64; 2] {
        let oldest = point.path_position + point.pairs as f64 * self.period;
        [self.path[0] - (point.path_position - self.period), oldest - self.path[1]]
    }

    /// Whether a corner may touch at this point or before the next one.
    fn is_near(&self, point: &Point) -> bool {
        self.distances(point)
            .iter()
            .zip(&self.farthest)
            .any(|(distance, farthest)| *distance < farthest + self.period * NEAR)
    }

    /// Estimated transmission error with the corners in contact. With λ the load of a corner, w its compliance, c its coupling with
    /// the pairs in contact in their shares of the load, k their secant stiffness, and 1, 2 the corners:
    /// δ = δ₀ − Σ λ (1/k − c) and λ₁ (w + 1/k − 2 c₁) + λ₂ (1/k − c₁ − c₂) = δ₀ − gap₁ − c₁ F, the same for 2.
    fn transmission_error(&self, point: &Point, force: f64) -> f64 {
        let distances = self.distances(point);
        let (load, others) = (point.load(), 1.0 / point.secant_stiffness);
        let mut coupling = [0.0; 2];
        let mut pressed = [0.0; 2];
        for (corner, distance) in distances.into_iter().enumerate() {
            let pitches = |pair: usize| if corner == 0 { pair } else { point.pairs - 1 - pair };
            let of_pair = |(pair, share): (usize, &f64)| share * self.coupling[corner][pitches(pair)];
            coupling[corner] = point.loads.iter().take(point.pairs).enumerate().map(of_pair).sum::<f64>() / load;
            if (0.0..self.farthest[corner]).contains(&distance) {
                let gap = self.clearance[corner] + self.facing[corner].tip(distance).separation;
                pressed[corner] = (point.transmission_error - gap - coupling[corner] * force).max(0.0);
            }
        }
        let own = [0, 1].map(|corner| self.compliance[corner] + others - 2.0 * coupling[corner]);
        let cross = others - coupling[0] - coupling[1];
        let determinant = own[0] * own[1] - cross * cross;
        let both = [own[1] * pressed[0] - cross * pressed[1], own[0] * pressed[1] - cross * pressed[0]];
        let loads = if both.iter().all(|load| *load > 0.0) && determinant > 0.0 {
            both.map(|load| load / determinant)
        } else {
            // One holds the other off, or none touches.
            let alone = [pressed[0] / own[0], pressed[1] / own[1]];
            if alone[0] > alone[1] { [alone[0], 0.0] } else { [0.0, alone[1]] }
        };
        point.transmission_error
            - loads.iter().zip(coupling).map(|(load, coupling)| load * (others - coupling)).sum::<f64>()
    }
}

/// The corners that are left out, if the gears approach by `transmission_error` \[m\] at most and that presses any of them
/// against a flank. None with corner contact, without load, and where contact ends at a form circle.
#[must_use]
pub(in crate::gear::mesh) fn neglected_corners(case: &LoadCase, transmission_error: f64) -> Option<NeglectedCorners> {
    let pair = &case.cycle.pair;
    let is_known = case.force > 0.0
        && case.cycle.settings.corner_contact == CornerContact::None
        && ![Side::Pinion, Side::Gear].into_iter().any(|side| pair.is_curtailed(side));
    if !is_known {
        return None;
    }
    let path = [pair.start_of_contact, pair.end_of_contact];
    let facing = [Side::Gear, Side::Pinion].map(|side| Facing::new(pair, side));
    let clearance = path.map(|end| case.gap(end).unwrap_or(f64::INFINITY) + case.flanks.offset());
    let period = pair.base_pitch;
    let ahead: PerSpring = array::from_fn(|index| case.cycle.coupling(path[0], index + 1));
    let behind: PerSpring = array::from_fn(|index| {
        let pitches = index + 1;
        case.cycle.coupling(path[1] - pitches as f64 * period, pitches)
    });
    let coupling = [ahead, behind];
    let compliance = path.map(|end| 0.5 * case.alone(end, &case.flanks, &mut None) / case.force);
    let touching = |corner: usize, pressed_off: f64| {
        let approach = transmission_error - clearance[corner] - pressed_off;
        if approach > 0.0 { touching_length(&facing[corner], approach, period) } else { 0.0 }
    };
    let lengths = [0, 1].map(|corner| touching(corner, coupling[corner][0] * case.force));
    let farthest = [0, 1].map(|corner| touching(corner, 0.0));
    farthest.iter().any(|length| *length > 0.0).then_some(NeglectedCorners {
        facing,
        clearance,
        coupling,
        compliance,
        lengths,
        farthest,
        path,
        period,
    })
}

/// The point at this share of the way from the first of two to the second: values of both in proportion.
fn between(two: &[Point], share: f64) -> Point {
    let of = |value: fn(&Point) -> f64| value(&two[0]) + share * (value(&two[1]) - value(&two[0]));
    let mut loads = two[0].loads;
    loads.iter_mut().zip(&two[1].loads).for_each(|(load, other)| *load += share * (other - *load));
    Point {
        path_position: of(|point| point.path_position),
        transmission_error: of(|point| point.transmission_error),
        secant_stiffness: of(|point| point.secant_stiffness),
        loads,
        ..two[0]
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
