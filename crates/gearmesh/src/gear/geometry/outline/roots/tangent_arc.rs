//! An arc tangent to the root circle and to the flank: of the radius that makes it begin on the base circle, of a given
//! radius, or of the largest that two neighbours leave room for.
//!
//! Below the base circle the flank is the radial line at ψ_b. From the base circle, r_c = (r_b² − r_f²)/(2 r_f). Must not
//! know: other roots.

use super::base_arc::Base;
use super::{Family, Toe};
use crate::gear::geometry::Gear;
use crate::gear::geometry::error::GeometryError;
use declare::parameter::{Choice, Field, Member};
use declare::record::Record;
use declare::units::LENGTH;

pub const FAMILY: Family = Family {
    member: Member {
        name: "tangent_arc",
        summary: "Arc tangent to the root circle and to the flank (or the radial line below the base circle).",
        fields: FIELDS,
    },
    build,
};

const FIELDS: &[Field] = &[
    Field::choice(
        "size",
        &[
            Choice { name: "base_circle", summary: "the arc begins on the base circle" },
            Choice { name: "largest", summary: "neighbouring arcs meet in the middle of the space" },
        ],
        "How large the arc is, where no radius is given.",
    )
    .default("base_circle"),
    Field::quantity("radius", LENGTH, 0.0, 100.0, "Radius of the arc.").optional(),
];

fn build(record: &Record, gear: &Gear) -> Result<Toe, GeometryError> {
    let radius = match (record.maybe_quantity("radius"), record.choice("size")) {
        (Some(radius), _) => radius,
        (None, "largest") => gear.largest_fillet(),
        (None, _) => Base::new(gear, "a tangent arc from the base circle")?.touching_radius(),
    };
    Ok(Toe::of(&gear.fillet(radius)?))
}
