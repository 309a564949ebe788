//! What a rack cuts: the trochoid of its tip round, which is the rack's own round, a sharp corner or a full round.
//!
//! Where the rack undercuts, the trochoid ends where it crosses the involute, and the profile has a corner there. Must not
//! know: other roots.

use super::super::curve::{Curve, Part, Segment};
use super::{Family, Toe};
use crate::gear::geometry::error::{GeometryError, Millimetres, Plain, Problem};
use crate::gear::geometry::{Gear, Rack, Specification, trochoid};
use crate::numeric::crossing;
use declare::parameter::{Choice, Field, Member};
use declare::record::Record;

pub const FAMILY: Family = Family {
    member: Member { name: "trochoid", summary: "The root curve that the rack generates.", fields: FIELDS },
    build,
};

const FIELDS: &[Field] = &[Field::choice(
    "rack_tip",
    &[
        Choice { name: "given", summary: "the rack's own tip radius" },
        Choice { name: "sharp", summary: "no round at all" },
        Choice { name: "full_round", summary: "the largest round, which leaves no land" },
    ],
    "Round of the rack's tip.",
)
.default("given")];

fn build(record: &Record, gear: &Gear) -> Result<Toe, GeometryError> {
    let given = gear.specification;
    let tip_radius = match record.choice("rack_tip") {
        "sharp" => 0.0,
        "full_round" => trochoid::full_round(&given),
        _ => given.rack.tip_radius,
    };
    let other = Gear::new(&Specification { rack: Rack { tip_radius, ..given.rack }, ..given })?;
    let curve = other.trochoid();
    // Deep undercut may leave no neck: where the curve runs straight up, the tooth is thinnest.
    let to = curve.joint_parameter();
    if let Some(neck) = crossing::bracketed(0.0, to, |q| curve.rates(q).0) {
        let [half_thickness, height] = curve.point_at(neck);
        if half_thickness <= 0.0 {
            let least = Plain(gear.least_shift_without_undercut());
            return Err(Problem::CutOff { height: Millimetres(height), teeth: given.teeth, least }.into());
        }
    }
    let root = Segment { part: Part::Root, curve: Curve::Trochoid(curve), from: 0.0, to };
    Ok(Toe { segments: vec![root], form_roll: other.form_roll })
}
