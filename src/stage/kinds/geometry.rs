//! `kind: geometry`: two spur gears and their pairing, checked before anything runs.
//!
//! Must not know: stiffness, modification. Names after ISO 21771 and ISO 53.

use crate::base::error::{Diagnostic, Failure};
use crate::base::parameter::Field;
use crate::base::record::Record;
use crate::base::units::{ANGLE, LENGTH, STRESS};
use crate::gear::geometry::{Pair, Rack, Specification};
use crate::gear::material::Material;
use crate::stage::pair::{self, gears_schema, pair_schema};
use crate::stage::{Context, Inputs, Kind, Port, Stage};
use crate::table::data::Table;
use crate::table::schema::Schema;

pub const KIND: Kind = Kind {
    name: "geometry",
    version: 1,
    summary: "Two involute spur gears on their centre distance: radii, path of contact, contact ratio.",
    fields: FIELDS,
    example: "
kind: geometry
module: 3 mm
pressure_angle: 20 deg
rack: { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38 }
material: { youngs_modulus: 206 GPa, poisson_ratio: 0.3 }
pinion: { teeth: 19, face_width: 20 mm, bore_radius: 14.079 mm }
gear: { teeth: 48, face_width: 18 mm, bore_radius: 38.823 mm }
",
    build,
};

const FIELDS: &[Field] = &[
    Field::quantity("module", LENGTH, 1e-5, 1.0, "Module m."),
    Field::quantity("pressure_angle", ANGLE, 0.08, std::f64::consts::FRAC_PI_4, "Pressure angle α of the basic rack.")
        .default("20 deg"),
    Field::group("rack", RACK, "Basic rack that cuts both gears, in modules (ISO 53).").default("{}"),
    Field::group("material", MATERIAL, "Material of both gears.").default("{}"),
    Field::group("pinion", GEAR, "The gear the torque is given on."),
    Field::group("gear", GEAR, "The mating gear."),
    Field::quantity("centre_distance", LENGTH, 1e-6, 1e3, "Centre distance a_w; zero backlash when it is not given.")
        .optional(),
];

const RACK: &[Field] = &[
    Field::number("addendum", 0.1, 3.0, "Addendum coefficient h_aP*.").default("1.0"),
    Field::number("dedendum", 0.1, 4.0, "Dedendum coefficient h_fP*.").default("1.25"),
    Field::number("tip_radius", 0.0, 2.0, "Tip radius coefficient ρ_fP*.").default("0.38"),
];

const MATERIAL: &[Field] = &[
    Field::quantity("youngs_modulus", STRESS, 1.0, 1e15, "Young's modulus E.").default("206 GPa"),
    Field::number("poisson_ratio", 0.0, 0.4999, "Poisson's ratio ν.").default("0.3"),
];

const GEAR: &[Field] = &[
    Field::integer("teeth", 4, 10_000, "Number of teeth z."),
    Field::quantity("face_width", LENGTH, 1e-6, 100.0, "Face width b."),
    Field::quantity("bore_radius", LENGTH, 0.0, 1e4, "Radius of the bore, where the body is clamped."),
    Field::number("profile_shift", -2.0, 3.0, "Profile shift coefficient x.").default("0.0"),
    Field::quantity("tip_radius", LENGTH, 1e-6, 1e4, "Tip radius r_a, when it is not m(z/2 + h_aP* + x).").optional(),
    Field::group("material", MATERIAL, "Material of this gear, when it is not the common one.").optional(),
];

struct Geometry(Pair);

fn build(record: &Record) -> Result<Box<dyn Stage>, Diagnostic> {
    let pair = Pair::new(
        specification(record, record.group("pinion")),
        specification(record, record.group("gear")),
        record.maybe_quantity("centre_distance"),
    )
    .map_err(|error| {
        let place = match error.field().split_once('.') {
            Some((group, field)) => record.maybe_group(group).map_or(record.place, |group| group.place_of(field)),
            None => record.place_of(error.field()),
        };
        Diagnostic::new(error.to_string()).at(place)
    })?;
    Ok(Box::new(Geometry(pair)))
}

fn specification(record: &Record, gear: &Record) -> Specification {
    let rack = record.group("rack");
    let material = gear.maybe_group("material").unwrap_or_else(|| record.group("material"));
    Specification {
        // The declared range keeps it inside u32.
        teeth: u32::try_from(gear.integer("teeth")).unwrap_or(u32::MAX),
        module: record.quantity("module"),
        pressure_angle: record.quantity("pressure_angle"),
        profile_shift: gear.number("profile_shift"),
        rack: Rack {
            addendum: rack.number("addendum"),
            dedendum: rack.number("dedendum"),
            tip_radius: rack.number("tip_radius"),
        },
        tip_radius: gear.maybe_quantity("tip_radius"),
        face_width: gear.quantity("face_width"),
        bore_radius: gear.quantity("bore_radius"),
        material: Material {
            youngs_modulus: material.quantity("youngs_modulus"),
            poisson_ratio: material.number("poisson_ratio"),
        },
    }
}

impl Stage for Geometry {
    fn inputs(&self) -> Vec<Port> {
        Vec::new()
    }

    fn outputs(&self) -> Vec<Schema> {
        vec![gears_schema(), pair_schema()]
    }

    fn run(&self, _context: &Context, _inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        pair::write(&self.0).map(Vec::from).map_err(|error| Failure::new(error.to_string()))
    }
}
