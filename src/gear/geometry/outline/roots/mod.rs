//! The families of roots a full profile may have: the registry, one line each, and what a family gives.
//!
//! Must not know: the tip, how many points are wanted.

pub mod arc;
pub mod base_arc;
pub mod optimised_arc;
pub mod tangent_arc;
pub mod trochoid;

use super::curve::Segment;
use crate::base::parameter::Member;
use crate::base::record::Record;
use crate::gear::geometry::Gear;
use crate::gear::geometry::error::GeometryError;

/// A root on the right half of a tooth.
#[derive(Clone, Debug)]
pub struct Toe {
    /// Upwards, from the root circle, or from the middle of the space where the root circle is not reached.
    pub segments: Vec<Segment>,
    /// Roll angle \[rad\] at which the flank begins.
    pub form_roll: f64,
}

/// A family as registered.
pub struct Family {
    pub member: Member,
    /// The root of a gear, or why there is none, with numbers.
    pub build: fn(&Record, &Gear) -> Result<Toe, GeometryError>,
}

/// Every family, in the order in which they are listed to the user.
pub const FAMILIES: &[&Family] = &[&trochoid::FAMILY, &arc::FAMILY, &tangent_arc::FAMILY, &optimised_arc::FAMILY];

/// The family called `name`.
#[must_use]
pub fn family(name: &str) -> Option<&'static Family> {
    FAMILIES.iter().copied().find(|family| family.member.name == name)
}

/// The families as a user may write them, for [`crate::base::parameter::Shape::Member`].
#[must_use]
pub fn members() -> &'static [Member] {
    const MEMBERS: [Member; FAMILIES.len()] = {
        let mut members = [FAMILIES[0].member; FAMILIES.len()];
        let mut at = 0;
        while at < FAMILIES.len() {
            members[at] = FAMILIES[at].member;
            at += 1;
        }
        members
    };
    &MEMBERS
}
