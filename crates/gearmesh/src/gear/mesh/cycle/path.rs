//! Where along the path a pair can touch, at which points of its flanks, and quick copies of functions of the path.
//!
//! From A to E unmodified flanks touch on the line of action. Corner contact adds a stretch before A, where the gear's tip
//! corner touches the pinion's flank, and one after E with the roles exchanged; there the roll angles are those of
//! the corner and of the flank point before it. Reliefs shift the contact a little along the flanks; compliances do not
//! follow that, so that they belong to the pair and not to the design. Must not know: modification, load.

use crate::gear::contact::CornerContact;
use crate::gear::contact::flattening::combined_radius;
use crate::gear::contact::separation::{Facing, Touch};
use crate::gear::geometry::{GearPair, Side};
use crate::numeric::graded::Graded;

/// Relative accuracy of the quick copies.
const ACCURACY: f64 = 1e-14;
/// Relative accuracy where a corner is in contact: square roots near the base circle would take ever more panels.
const CORNER_ACCURACY: f64 = 1e-12;

/// Places closer than this share of the base pitch are one.
pub(in crate::gear::mesh) const CLOSEST: f64 = 1e-10;

/// The path of contact with what corner contact adds to it.
#[derive(Clone, Debug)]
pub(in crate::gear::mesh) struct Path {
    start: f64,
    end: f64,
    /// Where the flanks of gear and pinion end towards their tips; beyond `start` and `end` where contact ends at a form circle.
    tips: [f64; 2],
    tangent_length: f64,
    base_radii: [f64; 2],
    /// How far before A and after E; none without corner contact.
    corners: Option<[(Facing, f64); 2]>,
}

impl Path {
    pub(in crate::gear::mesh) fn new(pair: &GearPair, corner_contact: CornerContact) -> Self {
        let corner = |side: Side| {
            let facing = Facing::new(pair, side);
            (facing, facing.reach(pair.base_pitch))
        };
        let exact = corner_contact == CornerContact::Exact;
        Self {
            start: pair.start_of_contact,
            end: pair.end_of_contact,
            tips: pair.flank_ends(),
            tangent_length: pair.tangent_length,
            base_radii: [pair.pinion.base_radius, pair.gear.base_radius],
            corners: exact.then(|| [corner(Side::Gear), corner(Side::Pinion)]),
        }
    }

    /// The first and the last path position at which flanks can touch.
    pub(in crate::gear::mesh) fn window(&self) -> (f64, f64) {
        let [before, after] = self.corners.map_or([0.0; 2], |corners| corners.map(|(_, reach)| reach));
        (self.start - before, self.end + after)
    }

    /// Between these path positions unmodified flanks touch on the line of action: from A to E.
    pub(in crate::gear::mesh) fn inside(&self) -> [f64; 2] {
        [self.start, self.end]
    }

    /// T1 T2 \[m\].
    pub(in crate::gear::mesh) fn tangent_length(&self) -> f64 {
        self.tangent_length
    }

    /// The radius of curvature of this gear's flank where it ends, and its base radius \[m\].
    pub(in crate::gear::mesh) fn flank_end(&self, side: Side) -> (f64, f64) {
        let end = if side == Side::Pinion { self.tips[1] } else { self.tangent_length - self.tips[0] };
        (end, self.base_radii[side as usize])
    }

    /// The flanks' radii of curvature where they touch, pinion and gear.
    pub(in crate::gear::mesh) fn radii(&self, s: f64) -> [f64; 2] {
        match &self.corners {
            Some([(facing, _), _]) if s < self.start => {
                [facing.tip(self.start - s).curvature, self.tangent_length - self.start]
            }
            Some([_, (facing, _)]) if s > self.end => [self.end, facing.tip(s - self.end).curvature],
            _ => [s, self.tangent_length - s],
        }
    }

    /// How far from the corner of this gear's tip a pair touches, along the flank \[m\]. Negative beyond it: there flanks
    /// that went on would touch, a parabola that stands as far off the corner as they do.
    pub(in crate::gear::mesh) fn corner_distance(&self, side: Side, s: f64) -> f64 {
        let [pinion, gear] = self.radii(s);
        let beyond = |corner: Touch| -(2.0 * corner.separation * combined_radius([pinion, gear])).sqrt();
        let along = |tip: f64, here: f64, base: f64| 0.5 * (tip - here) * (tip + here) / base;
        match (side, &self.corners) {
            (Side::Pinion, Some([_, (facing, _)])) if s > self.end => beyond(facing.flank_end(s - self.end)),
            (Side::Gear, Some([(facing, _), _])) if s < self.start => beyond(facing.flank_end(self.start - s)),
            (Side::Pinion, _) => along(self.tips[1], pinion, self.base_radii[0]),
            (Side::Gear, _) => along(self.tangent_length - self.tips[0], gear, self.base_radii[1]),
        }
    }

    /// By how much the load on a gear is turned from the normal of its flank towards the root \[rad\]: at the corner of its
    /// tip it is along the normal of the other flank. 0 from A to E.
    pub(in crate::gear::mesh) fn inclination(&self, side: Side, s: f64) -> f64 {
        match (side, &self.corners) {
            (Side::Pinion, Some([_, (facing, _)])) if s > self.end => facing.inclination(s - self.end),
            (Side::Gear, Some([(facing, _), _])) if s < self.start => facing.inclination(self.start - s),
            _ => 0.0,
        }
    }

    /// The roll angles of the points that touch, pinion and gear.
    pub(in crate::gear::mesh) fn rolls(&self, s: f64) -> (f64, f64) {
        let [pinion, gear] = self.radii(s);
        (pinion / self.base_radii[0], gear / self.base_radii[1])
    }

    /// A quick copy of a function of the path position of a pair and of the one that is `ahead` of it; none when two such
    /// pairs never touch at the same time.
    pub(in crate::gear::mesh) fn fit(&self, ahead: f64, function: &dyn Fn(f64) -> f64) -> Option<Graded> {
        let window = self.window();
        let (lower, upper) = (window.0, window.1 - ahead);
        if upper <= lower {
            return None;
        }
        let mut graded = Graded::default();
        if self.corners.is_none() {
            graded.push((lower, upper), [false; 2], ACCURACY, function);
            return Some(graded);
        }
        // Rolls of the flank before a corner start like a root where that flank starts near its base circle.
        let mut joints = vec![(self.start, [true, false]), (self.end - ahead, [false, true])];
        if ahead > 0.0 {
            joints.push((self.end, [false, true]));
        }
        joints.retain(|joint| joint.0 > lower && joint.0 < upper);
        joints.sort_by(|one, two| one.0.total_cmp(&two.0));
        joints.push((upper, [false; 2]));
        let mut from = (lower, false);
        for (at, [below, above]) in joints {
            if at > from.0 {
                let roots = [from.1, below];
                let accuracy = if roots == [false; 2] { ACCURACY } else { CORNER_ACCURACY };
                graded.push((from.0, at), roots, accuracy, function);
            }
            from = (at, above);
        }
        Some(graded)
    }
}
