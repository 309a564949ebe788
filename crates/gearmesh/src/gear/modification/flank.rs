//! The active flank of one gear of a pair, measured along the line of action.
//!
//! Roll lengths r_b·u \[m\] equal distances along the line of action, so zones of contact and reliefs have one measure.
//! Must not know: modifications.

use crate::gear::geometry::{GearPair, Side};

/// Where a gear's flank works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flank {
    /// r_b \[m\].
    pub base_radius: f64,
    /// Roll angle where the other gear's tip works, nearest to the root (SAP).
    pub root_roll: f64,
    /// Roll angle where it ends towards its own tip, from which reliefs count.
    pub tip_roll: f64,
    /// p_b \[m\].
    pub base_pitch: f64,
    /// p_b(ε_α − 1): the length of long relief.
    pub long_relief: f64,
    /// From each end of the flank to the nearest zone with the fewest pairs in contact, p_b(ε_α − ⌊ε_α⌋); for
    /// 1 < ε_α < 2 that is the single-contact zone.
    pub outer_zone: f64,
    /// b of this gear.
    pub face_width: f64,
}

impl Flank {
    /// The active flank of the gear on a side of a pair.
    #[must_use]
    pub fn new(pair: &GearPair, side: Side) -> Self {
        let gear = pair.side(side);
        let (root, tip) = match side {
            Side::Pinion => (pair.start_of_contact, pair.end_of_contact),
            Side::Gear => (pair.end_of_contact, pair.start_of_contact),
        };
        Self {
            base_radius: gear.base_radius,
            root_roll: pair.roll(side, root),
            // Beyond where it works, if contact ends at the mate's form circle.
            tip_roll: if pair.is_curtailed(side.other()) { gear.flank_end.roll } else { pair.roll(side, tip) },
            base_pitch: pair.base_pitch,
            long_relief: pair.base_pitch * (pair.contact_ratio - 1.0),
            outer_zone: pair.base_pitch * (pair.contact_ratio - pair.contact_ratio.floor()),
            face_width: gear.specification.face_width,
        }
    }

    /// The roll length of the active flank \[m\].
    #[must_use]
    pub fn length(&self) -> f64 {
        (self.tip_roll - self.root_roll) * self.base_radius
    }

    /// d = 2 r_b √(1 + u²).
    #[must_use]
    pub fn diameter(&self, roll: f64) -> f64 {
        2.0 * self.base_radius * (1.0 + roll * roll).sqrt()
    }

    /// The roll angle at a diameter that is not below the base circle.
    #[must_use]
    pub fn roll_at_diameter(&self, diameter: f64) -> Option<f64> {
        let ratio = 0.5 * diameter / self.base_radius;
        (ratio >= 1.0).then(|| ((ratio - 1.0) * (ratio + 1.0)).sqrt())
    }
}
