//! Tooth flank modifications: the trait every family has, the registry, and designs made of them.
//!
//! Depths are normal to the flank \[m\], positive where material is removed, and add up per gear. The profile is a
//! function of the gear's roll angle \[rad\], the lead a function of z \[m\], which counts from the middle of the face
//! and points the same way for both gears. Names and signs: ISO 21771-1, ISO 1328-1. Must not know: compliance, load.

pub mod arc;
pub mod curve;
pub mod end_relief;
pub mod flank;
pub mod helix_slope;
pub mod lead_crowning;
pub mod parabola;
pub mod profile;
pub mod profile_crowning;
pub mod profile_slope;
pub mod relief;
pub mod root_relief;
pub mod template;
#[cfg(test)]
mod tests;
pub mod tip_curve;
pub mod tip_relief;

use std::fmt::Debug;
use std::sync::Arc;

use self::flank::Flank;
use super::geometry::{GearPair, Side};
use declare::error::Diagnostic;
use declare::parameter::{Choice, Field, Member};
use declare::record::Record;

/// Every family, in the order in which they are listed to the user.
pub const FAMILIES: &[Family] = &[
    tip_relief::FAMILY,
    root_relief::FAMILY,
    arc::FAMILY,
    parabola::FAMILY,
    profile_crowning::FAMILY,
    profile_slope::FAMILY,
    lead_crowning::FAMILY,
    helix_slope::FAMILY,
    end_relief::FAMILY,
];

/// Builds the modification of one gear.
pub type Build = fn(&Record, &GearPair, Side) -> Result<Arc<dyn Modification>, Diagnostic>;

/// A family as registered.
#[derive(Clone, Copy)]
pub struct Family {
    /// Its name, meaning and fields; one of the fields is [`GEAR`].
    pub member: Member,
    /// Refuses combinations of fields that no declaration can express; values may still be ranges.
    pub check: fn(&Record) -> Result<(), Diagnostic>,
    /// The modification of one gear. The record has passed `check` and holds no ranges.
    pub build: Build,
}

/// One modification of one gear, with everything resolved.
pub trait Modification: Debug + Send + Sync {
    /// Depth at a roll angle; continuous.
    fn depth(&self, _roll: f64) -> f64 {
        0.0
    }

    /// Roll angles at which the depth is not smooth.
    fn profile_breaks(&self) -> [Option<f64>; 2] {
        [None; 2]
    }

    fn varies_along_profile(&self) -> bool {
        false
    }

    /// Deviation at z; continuous.
    fn lead(&self, z: f64) -> f64 {
        let [constant, slope, bend] = self.lead_quadratic(z).unwrap_or_default();
        constant + z * (slope + z * bend)
    }

    /// The polynomial c0 + c1 z + c2 z² that the lead equals between the breaks on either side of `z`; `None` when it
    /// is of another kind there.
    fn lead_quadratic(&self, _z: f64) -> Option<[f64; 3]> {
        Some([0.0; 3])
    }

    /// The z at which the lead is not smooth.
    fn lead_breaks(&self) -> [Option<f64>; 2] {
        [None; 2]
    }

    fn varies_along_face(&self) -> bool {
        false
    }

    /// Whether the lead at −z is that at z.
    fn lead_is_even(&self) -> bool {
        !self.varies_along_face()
    }

    /// Names and values (SI) of what was given and of what follows from it.
    fn resolved(&self) -> Vec<(&'static str, f64)>;
}

/// What both gears of a pair are given.
#[derive(Clone, Debug, Default)]
pub struct Design {
    pub pinion: Vec<NamedModification>,
    pub gear: Vec<NamedModification>,
}

/// One modification and the name of its family.
#[derive(Clone, Debug)]
pub struct NamedModification {
    pub family: &'static str,
    pub modification: Arc<dyn Modification>,
}

impl Design {
    #[must_use]
    pub fn side(&self, side: Side) -> &[NamedModification] {
        match side {
            Side::Pinion => &self.pinion,
            Side::Gear => &self.gear,
        }
    }

    /// Whether what both gears lose across the face is the same on either side of its middle.
    #[must_use]
    pub fn lead_is_even(&self) -> bool {
        self.pinion.iter().chain(&self.gear).all(|part| part.modification.lead_is_even())
    }

    /// Adds a modification, as `family: { fields }` states it, to the gears that its field `gear` names.
    ///
    /// # Errors
    /// When the fields contradict each other or do not fit the pair, or when all modifications of a gear together take
    /// off more than half of its tooth.
    pub fn add(&mut self, family: &'static Family, record: &Record, pair: &GearPair) -> Result<(), Diagnostic> {
        (family.check)(record)?;
        let gear = record.choice(GEAR.name);
        if gear != "gear" {
            let modification = (family.build)(record, pair, Side::Pinion)?;
            self.pinion.push(NamedModification { family: family.member.name, modification });
            self.check_room(Side::Pinion, pair).map_err(|error| error.or_at(record.place))?;
        }
        if gear != "pinion" {
            let modification = (family.build)(record, pair, Side::Gear)?;
            self.gear.push(NamedModification { family: family.member.name, modification });
            self.check_room(Side::Gear, pair).map_err(|error| error.or_at(record.place))?;
        }
        Ok(())
    }

    /// Half of the tooth must be left, since the other flank may be modified the same way: no point of the flank may pass
    /// the tooth's centreline, up to the normal through the middle of the tip land, u_a + ψ_a, where r_b ψ_a is left to take.
    /// Depths nowhere add material to the active flank, so a part that is refused cannot be saved by one that follows.
    fn check_room(&self, side: Side, pair: &GearPair) -> Result<(), Diagnostic> {
        let (gear, flank, parts) = (pair.side(side), Flank::new(pair, side), self.side(side));
        let sum = |of: &dyn Fn(&dyn Modification) -> f64| parts.iter().map(|part| of(&*part.modification)).sum::<f64>();
        let face = (-0.5 * flank.face_width, 0.5 * flank.face_width);
        let edges = parts.iter().flat_map(|part| part.modification.lead_breaks());
        let lead = looks(face, edges).map(|z| sum(&|part| part.lead(z))).fold(0.0, f64::max);
        let breaks = parts.iter().flat_map(|part| part.modification.profile_breaks());
        // The place with the least room; NaN counts as none.
        let mut tightest = (f64::INFINITY, flank.tip_roll, 0.0);
        for roll in looks((flank.root_roll, flank.tip_roll + gear.half_angle_at_roll(flank.tip_roll)), breaks) {
            let depth = sum(&|part| part.depth(roll)) + lead;
            let room = gear.depth_to_centreline(roll) - depth;
            if room.is_nan() || room < tightest.0 {
                tightest = (room, roll, depth);
            }
        }
        let (room, roll, depth) = tightest;
        if room >= 0.0 {
            return Ok(());
        }
        let [diameter, depth, most] =
            [flank.diameter(roll.min(flank.tip_roll)), depth, gear.depth_to_centreline(roll)].map(|m| m * 1e3);
        Err(Diagnostic::new(format!(
            "the {}'s flank would lose {depth:.6} mm, normal to it, at a diameter of {diameter:.6} mm; all its \
             modifications together may take 0 to {most:.6} mm there, which is half of the tooth",
            side.name()
        )))
    }

    /// The sum of the depths of one gear at a roll angle.
    #[must_use]
    pub fn depth(&self, side: Side, roll: f64) -> f64 {
        self.side(side).iter().map(|part| part.modification.depth(roll)).sum()
    }

    /// The sum of the lead deviations of both gears at z.
    #[must_use]
    pub fn lead(&self, z: f64) -> f64 {
        self.pinion.iter().chain(&self.gear).map(|part| part.modification.lead(z)).sum()
    }

    /// Every resolved parameter: gear, family, name, value (SI).
    #[must_use]
    pub fn resolved(&self) -> Vec<(Side, &'static str, &'static str, f64)> {
        let of = |side: Side| {
            self.side(side).iter().flat_map(move |part| {
                let values = part.modification.resolved().into_iter();
                values.map(move |(name, value)| (side, part.family, name, value))
            })
        };
        of(Side::Pinion).chain(of(Side::Gear)).collect()
    }
}

/// The ends of a range, the `breaks` inside it, and equidistant places between.
fn looks((from, to): (f64, f64), breaks: impl Iterator<Item = Option<f64>>) -> impl Iterator<Item = f64> {
    let inside = breaks.flatten().filter(move |place| *place > from && *place < to);
    let between = (1..LOOKS).map(move |look| from + (to - from) * f64::from(look) / f64::from(LOOKS));
    [from, to].into_iter().chain(between).chain(inside)
}

/// The family called `name`.
#[must_use]
pub fn family(name: &str) -> Option<&'static Family> {
    FAMILIES.iter().find(|family| family.member.name == name)
}

/// The families as a user may write them, for [`declare::parameter::Shape::Member`].
#[must_use]
pub fn members() -> &'static [Member] {
    const MEMBERS: [Member; FAMILIES.len()] = {
        let mut members = [FAMILIES[0].member; FAMILIES.len()];
        let mut index = 1;
        while index < FAMILIES.len() {
            members[index] = FAMILIES[index].member;
            index += 1;
        }
        members
    };
    &MEMBERS
}

/// Which gear is modified.
pub const GEAR: Field = Field::choice(
    "gear",
    &[
        Choice { name: "pinion", summary: "the driving gear" },
        Choice { name: "gear", summary: "the driven gear" },
        Choice { name: "both", summary: "each of the two, with the same values" },
    ],
    "Which gear is modified.",
);

/// Into how many parts flank and face are divided to see whether enough of the tooth is left.
const LOOKS: u32 = 16;

/// The largest amount \[m\]: beyond it a relief is no longer small against the tooth.
pub(crate) const MOST_AMOUNT: f64 = 5e-3;

#[allow(clippy::unnecessary_wraps)] // has the type of every family's check
pub(crate) fn no_check(_: &Record) -> Result<(), Diagnostic> {
    Ok(())
}
