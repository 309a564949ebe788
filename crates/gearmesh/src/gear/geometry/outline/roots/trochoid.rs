//! What a tool cuts: the trochoid of its tip round, which is the rack's own round, a sharp corner or a full round, and what lies
//! between that and the flank.
//!
//! Where the rack undercuts, the trochoid ends where it crosses the involute, and the profile has a corner there. Must not
//! know: other roots.

use super::{Root, Toe};
use crate::gear::geometry::error::{GeometryError, Millimetres, Plain, Problem};
use crate::gear::geometry::root::RootShape;
use crate::gear::geometry::{Gear, trochoid};
use crate::numeric::crossing;
use declare::{Declared, Words};

/// The root curve that the rack generates.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "trochoid")]
pub struct Trochoid {
    /// Round of the rack's tip.
    #[declared(default = "given")]
    pub rack_tip: RackTip,
}

/// Round of a rack's tip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum RackTip {
    /// the rack's own tip radius
    Given,
    /// no round at all
    Sharp,
    /// the largest round, which leaves no land
    FullRound,
}

impl Root for Trochoid {
    fn toe(&self, gear: &Gear) -> Result<Toe, GeometryError> {
        let given = gear.specification;
        let tip_radius = match self.rack_tip {
            RackTip::Given => given.tool_tip_radius(),
            RackTip::Sharp => 0.0,
            RackTip::FullRound => trochoid::full_round(&given),
        };
        let other = Gear::new(&given.with_tool_tip_radius(tip_radius))?;
        let root = other.root(RootShape::Trochoid)?;
        let curve = other.trochoid();
        // Deep undercut may leave no neck: where the curve runs straight up, or goes over into what follows, the tooth is
        // thinnest.
        let to = curve.joint_parameter();
        let neck = crossing::bracketed(0.0, to, |q| curve.rates(q).0).unwrap_or(to);
        let [half_thickness, height] = curve.point_at(neck);
        if half_thickness <= 0.0 {
            let minimum = Plain(other.least_shift_without_undercut());
            return Err(Problem::CutOff { height: Millimetres(height), teeth: given.teeth, minimum }.into());
        }
        Ok(Toe::of(&root))
    }
}
