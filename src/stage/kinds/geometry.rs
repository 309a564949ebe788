//! `kind: geometry`: two spur gears and their pairing, checked before anything runs.
//!
//! On demand it gives the full profiles of both gears, their junctions, how far the gears are from what they must not be,
//! and the pair in mesh as curves. Must not know: stiffness. Names after ISO 21771 and ISO 53.

mod article;
mod drawn;
mod meshing;

use crate::base::error::{Diagnostic, Failure};
use crate::base::parameter::{Choice, Field, Shape};
use crate::base::record::Record;
use crate::base::units::{ANGLE, LENGTH, STRESS};
use crate::gear::geometry::error::GeometryError;
use crate::gear::geometry::outline::sample::Density;
use crate::gear::geometry::outline::tip::{self, Tip};
use crate::gear::geometry::outline::{Outline, roots};
use crate::gear::geometry::{Pair, Rack, Side, Specification};
use crate::gear::material::Material;
use crate::gear::modification::template::Template;
use crate::stage::designs;
use crate::stage::pair::{self, gears_schema, pair_schema};
use crate::stage::{Context, Inputs, Kind, Port, Stage};
use crate::table::data::{Row, Table, TableError};
use crate::table::schema::Schema;

use drawn::Drawn;

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
    Field::group(
        "outline",
        OUTLINE,
        "The full profiles, as the tables `outline`, `junctions`, `validity` and `mesh_drawing` have them.",
    )
    .default("{}"),
];

const OUTLINE: &[Field] = &[
    Field::new("root", Shape::Member(roots::members), "Root of the teeth.").default("trochoid"),
    Field::new("tip", Shape::Member(tip::members), "What is done to the corners of the tip.").default("land"),
    Field::new("flank", designs::ELEMENTS, "Modifications of the flanks, one or several.").optional(),
    Field::integer("points", 8, 100_000, "Points per tooth, at least.").default("200"),
    Field::quantity("chord_error", LENGTH, 1e-10, 1e-2, "How far a chord may lie from its curve; adds points.")
        .optional(),
    Field::choice("teeth", TEETH, "How many teeth the table `outline` has.").default("one"),
];

const TEETH: &[Choice] = &[
    Choice { name: "one", summary: "one tooth with half a space on either side" },
    Choice { name: "all", summary: "the whole gear" },
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
    Field::number("tip_shortening", -1.0, 1.0, "Tip shortening k in modules: r_a = m(z/2 + h_aP* + x − k).").optional(),
    Field::new(
        "root",
        Shape::Member(roots::members),
        "Root of this gear's teeth in its outline, when it is not the common one.",
    )
    .optional(),
    Field::group("material", MATERIAL, "Material of this gear, when it is not the common one.").optional(),
];

struct Geometry {
    pair: Pair,
    /// Pinion and gear.
    outlines: [Outline; 2],
    density: Density,
    whole: bool,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Diagnostic> {
    let refused = |error: &GeometryError| {
        let path: Vec<&str> = error.field().split('.').collect();
        let place = match path[..] {
            [group, field] => record.maybe_group(group).map_or(record.place, |group| group.place_of(field)),
            _ => record.place_of(error.field()),
        };
        Diagnostic::new(error.to_string()).at(place)
    };
    for side in ["pinion", "gear"] {
        let gear = record.group(side);
        if gear.entry("tip_radius").is_some() && gear.entry("tip_shortening").is_some() {
            return Err(Diagnostic::new("`tip_radius` and `tip_shortening` both say where the tip is")
                .at(gear.place_of("tip_shortening"))
                .help("give one of them"));
        }
    }
    let pair = Pair::new(
        specification(record, record.group("pinion")),
        specification(record, record.group("gear")),
        record.maybe_quantity("centre_distance"),
    )
    .map_err(|error| refused(&error))?;
    let options = record.group("outline");
    let flank = Template::new(options.maybe_list("flank").unwrap_or_default())?.design(&pair, &[])?;
    let outline = |side: Side| {
        let (name, root) = record.group(side.name()).maybe_member("root").unwrap_or_else(|| options.member("root"));
        // The decoder lets only registered families through.
        let family = roots::family(name).ok_or_else(|| Diagnostic::new(format!("there is no root `{name}`")))?;
        let gear = pair.side(side);
        (family.build)(root, gear)
            .and_then(|toe| Outline::new(gear, toe, Tip::of(options.member("tip")), flank.relief(side)))
            .map_err(|error| refused(&error.on(side)))
    };
    let outlines = [outline(Side::Pinion)?, outline(Side::Gear)?];
    let points = usize::try_from(options.integer("points")).unwrap_or(0);
    let density = Density { points, chord_error: options.maybe_quantity("chord_error") };
    Ok(Box::new(Geometry { pair, outlines, density, whole: options.choice("teeth") == "all" }))
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
        tip_radius: gear.maybe_quantity("tip_radius").or_else(|| {
            let height =
                rack.number("addendum") + gear.number("profile_shift") - gear.maybe_number("tip_shortening")?;
            Some(record.quantity("module") * (0.5 * gear.integer("teeth") as f64 + height))
        }),
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
        let drawn = [drawn::outline_schema(), drawn::junctions_schema(), drawn::validity_schema()];
        let mut schemas = vec![gears_schema(), pair_schema()];
        schemas.extend(drawn);
        schemas.extend([meshing::schema(), article::schema()]);
        schemas
    }

    fn run(&self, context: &Context, _inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let failed = |error: TableError| Failure::new(error.to_string());
        let pair = &self.pair;
        let both = [Side::Pinion, Side::Gear].map(|side| {
            let outline = &self.outlines[usize::from(side == Side::Gear)];
            Drawn { side, pair, outline }
        });
        let mut tables = Vec::from(pair::write(pair).map_err(failed)?);
        let wanted = self.outputs().iter().any(|schema| schema.on_demand && context.demand.table(&schema.name));
        both.iter().filter(|_| wanted).filter_map(Drawn::interference).for_each(|text| (context.warn)(text));
        let teeth = |drawn: &Drawn| if self.whole { drawn.outline.teeth } else { 1 };
        for schema in self.outputs().into_iter().filter(|schema| schema.on_demand) {
            if !context.demand.table(&schema.name) {
                continue;
            }
            let rows: Vec<Row> = match schema.name.as_str() {
                "outline" => both.iter().flat_map(|drawn| drawn.outline_rows(self.density, teeth(drawn))).collect(),
                "junctions" => both.iter().flat_map(Drawn::junction_rows).collect(),
                "validity" => both.iter().map(Drawn::validity_row).collect(),
                "mesh_drawing" => meshing::rows(pair, [&both[0], &both[1]], self.density),
                _ => both.iter().filter_map(|drawn| article::row(drawn, pair.side(drawn.side))).collect(),
            };
            tables.push(Table::from_rows(schema, rows).map_err(failed)?);
        }
        Ok(tables)
    }
}
