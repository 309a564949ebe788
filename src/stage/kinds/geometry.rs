//! `kind: geometry`: two spur gears and their pairing, or one gear alone, checked before anything runs.
//!
//! On demand it gives the full profiles, their junctions, how far the gears are from what they must not be, and the pair
//! in mesh as curves. Must not know: stiffness. Names after ISO 21771 and ISO 53.

mod article;
mod construction;
mod drawn;
mod meshing;
mod valid;

use crate::stage::designs;
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Port, RowCount, Saved, Stage, pair};
use declare::error::{Diagnostic, Failure};
use declare::parameter::{Choice, Field, Shape};
use declare::record::Record;
use declare::units::{ANGLE, LENGTH, STRESS};
use declare::work::Work;
use drawn::Drawn;
use gearmesh::gear::geometry::error::GeometryError;
use gearmesh::gear::geometry::outline::sample::{Density, Point};
use gearmesh::gear::geometry::outline::tip;
use gearmesh::gear::geometry::outline::{Outline, roots};
use gearmesh::gear::geometry::validity::Mating;
use gearmesh::gear::geometry::{Gear, GearPair, Rack, Side, Specification};
use gearmesh::gear::material::Material;
use gearmesh::gear::modification::Design;
use gearmesh::gear::modification::template::Template;
use gearmesh::gear::work::OUTLINES;
use studygraph::table::data::{Table, TableError};
use studygraph::table::schema::Schema;

pub const KIND: Kind = Kind {
    name: "geometry",
    version: 1,
    summary: "Two involute spur gears on their centre distance, or one alone: radii, contact ratio, full profiles.",
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
    Field::group("gear", GEAR, "The mating gear; without it the pinion is a gear alone, to be drawn.").optional(),
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
    /// None of a gear alone.
    pair: Option<GearPair>,
    /// The pinion, and the gear of a pair.
    gears: Vec<Drawn>,
    density: Density,
    whole: bool,
}

/// The fields that say something of a pair.
const OF_A_PAIR: &[(&str, &str)] = &[
    ("centre_distance", "a gear alone has no centre distance"),
    ("outline.flank", "a modification is laid out on the flank down to where the mate's tip reaches"),
];

fn build(record: &Record) -> Result<Box<dyn Stage>, Diagnostic> {
    let refused = |error: &GeometryError| {
        let path: Vec<&str> = error.field().split('.').collect();
        let place = match path[..] {
            [group, field] => record.maybe_group(group).map_or(record.place, |group| group.place_of(field)),
            _ => record.place_of(error.field()),
        };
        Diagnostic::new(error.to_string()).at(place)
    };
    let stated = [Side::Pinion, Side::Gear].map(|side| record.maybe_group(side.name()).map(|gear| (side, gear)));
    for (_, gear) in stated.iter().flatten() {
        if gear.entry("tip_radius").is_some() && gear.entry("tip_shortening").is_some() {
            return Err(Diagnostic::new("`tip_radius` and `tip_shortening` both say where the tip is")
                .at(gear.place_of("tip_shortening"))
                .help("give one of them"));
        }
    }
    let options = record.group("outline");
    let pinion = specification(record, record.group("pinion"));
    let (pair, design, gears) = if let Some(gear) = record.maybe_group("gear") {
        let pair = GearPair::new(pinion, specification(record, gear), record.maybe_quantity("centre_distance"))
            .map_err(|error| refused(&error))?;
        let design = Template::new(options.maybe_list("flank").unwrap_or_default())?.design(&pair, &[])?;
        let gears = vec![pair.pinion.clone(), pair.gear.clone()];
        (Some(pair), design, gears)
    } else {
        check_alone(record)?;
        let gear = Gear::new(&pinion).map_err(|error| refused(&error.on(Side::Pinion)))?;
        (None, Design::default(), vec![gear])
    };
    let drawn = |((side, stated), gear): ((Side, &Record), Gear)| {
        let (name, root) = stated.maybe_member("root").unwrap_or_else(|| options.member("root"));
        let (root, tip) = (roots::read(name, root)?, options.member("tip"));
        let tip = tip::read(tip.0, tip.1)?.tip();
        let outline = root
            .toe(&gear)
            .and_then(|toe| Outline::new(&gear, toe, tip, design.relief(side)))
            .map_err(|error| refused(&error.on(side)))?;
        Ok(Drawn { side, gear, outline })
    };
    let gears = stated.into_iter().flatten().zip(gears).map(drawn).collect::<Result<_, Diagnostic>>()?;
    let points = usize::try_from(options.integer("points")).unwrap_or(0);
    let density = Density { points, chord_error: options.maybe_quantity("chord_error") };
    Ok(Box::new(Geometry { pair, gears, density, whole: options.choice("teeth") == "all" }))
}

/// Refuses what only a pair can have.
fn check_alone(record: &Record) -> Result<(), Diagnostic> {
    for (path, why) in OF_A_PAIR {
        let (group, field) = match path.split_once('.') {
            Some((group, field)) => (record.group(group), field),
            None => (record, *path),
        };
        if group.entry(field).is_some() {
            return Err(Diagnostic::new(format!("`{field}` needs a mate: {why}"))
                .at(group.place_of(field))
                .help("add the mating gear as `gear`, or leave this out"));
        }
    }
    Ok(())
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

/// Tables that are made by going round whole outlines.
const OF_OUTLINES: [&str; 3] = ["outline", "validity", "mesh_drawing"];

impl Stage for Geometry {
    fn inputs(&self) -> Vec<Port> {
        Vec::new()
    }

    fn outputs(&self) -> Vec<Schema> {
        let paired = self.pair.is_some();
        let mut schemas = vec![pair::gears().schema()];
        schemas.extend(paired.then(|| pair::pair().schema()));
        schemas.extend([drawn::outline_schema(), drawn::junctions().schema(), valid::columns(paired).schema()]);
        schemas.extend(paired.then(|| meshing::columns().schema()));
        schemas.extend([article::columns().schema(), construction::columns().schema()]);
        schemas
    }

    fn lacks(&self, table: &str) -> Option<&'static str> {
        let of_a_pair = [pair::pair().schema(), meshing::columns().schema()].iter().any(|schema| schema.name == table);
        (of_a_pair && self.pair.is_none()).then_some("it has one gear, and this needs two: give it the mate as `gear`")
    }

    fn saved(&self, _demand: &Demand, table: &str, _column: Option<&str>) -> Option<Saved> {
        OF_OUTLINES.contains(&table).then_some(Saved::Fixed(&OUTLINES, self.gears.len() as f64))
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let mut estimate = Estimate::new(false);
        for schema in self.outputs() {
            let name = schema.name.clone();
            // Counting the points of an outline that nobody asks for would cost more than all the rest.
            if !demand.table(&name) {
                continue;
            }
            let halves = || self.gears.iter().map(|drawn| drawn.outline.points_of_half(self.density));
            let rows = match name.as_str() {
                "outline" => {
                    let rows = |drawn: &Drawn| drawn.outline_rows(self.density, self.teeth(drawn));
                    RowCount::exact(self.gears.iter().map(rows).sum())
                }
                "junctions" => RowCount::exact(self.gears.iter().map(|drawn| drawn.outline.junctions().len()).sum()),
                "mesh_drawing" => RowCount::exact(match halves().collect::<Vec<_>>()[..] {
                    [pinion, gear] => meshing::count([pinion, gear]),
                    _ => 0,
                }),
                "root_arc" => RowCount::at_most(self.gears.len()),
                "arc_drawing" => RowCount::at_most(halves().map(construction::maximum).sum()),
                "pair" => RowCount::exact(1),
                _ => RowCount::exact(self.gears.len()),
            };
            estimate = if name == "outline" {
                // The points of one tooth of one gear.
                let points = halves().max().unwrap_or(0) as u64;
                estimate.columns(demand, schema, rows).holding(4 * points * size_of::<Point>() as u64)
            } else {
                estimate.rows(demand, schema, rows)
            };
            if OF_OUTLINES.contains(&name.as_str()) {
                estimate = estimate.work(&Work::of(&OUTLINES, self.gears.len()), 1.0);
            }
        }
        estimate
    }

    fn run(&self, context: &Context, _inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let failed = |error: TableError| Failure::new(error.to_string());
        let gears: Vec<_> = self.gears.iter().map(|drawn| (drawn.side, &drawn.gear)).collect();
        let mut tables = vec![pair::gears().table(&gears).map_err(failed)?];
        if let Some(pair) = &self.pair {
            tables.push(pair::pair().table(&[pair]).map_err(failed)?);
        }
        let schemas =
            self.outputs().into_iter().filter(|schema| schema.on_demand && context.demand.table(&schema.name));
        let schemas: Vec<Schema> = schemas.collect();
        let mated: Vec<valid::Mated> = if schemas.is_empty() {
            Vec::new()
        } else {
            self.gears.iter().map(|drawn| (drawn, self.mating(drawn))).collect()
        };
        for (drawn, mating) in mated.iter().filter_map(|(drawn, mate)| Some((drawn, mate.as_ref()?.1))) {
            for text in valid::warnings(drawn, &mating) {
                (context.warn)(text);
            }
        }
        for schema in schemas {
            if OF_OUTLINES.contains(&schema.name.as_str()) {
                context.work.add(&Work::of(&OUTLINES, self.gears.len()));
            }
            let table = match (schema.name.as_str(), &self.pair) {
                ("outline", _) => {
                    let begin = |share| {
                        (context.progress)(share);
                        context.check_stop()
                    };
                    let columns = drawn::outline_columns(&self.gears, self.density, |drawn| self.teeth(drawn), begin)?;
                    Table::from_columns(schema, columns)
                }
                ("junctions", _) => {
                    let rows: Vec<_> = self.gears.iter().flat_map(Drawn::junction_rows).collect();
                    drawn::junctions().table(&rows)
                }
                ("validity", paired) => {
                    let rows: Vec<_> = mated.iter().map(valid::ValidRow::new).collect();
                    valid::columns(paired.is_some()).table(&rows)
                }
                ("mesh_drawing", Some(pair)) => {
                    meshing::columns().table(&meshing::rows(pair, &self.gears, self.density))
                }
                ("root_arc", _) => {
                    let rows: Vec<_> = self.gears.iter().filter_map(article::row).collect();
                    article::columns().table(&rows)
                }
                _ => {
                    let rows = self.gears.iter().flat_map(|drawn| construction::rows(drawn, self.density));
                    construction::columns().table(&rows.collect::<Vec<_>>())
                }
            };
            tables.push(table.map_err(failed)?);
        }
        Ok(tables)
    }
}

impl Geometry {
    /// How many teeth of it are drawn.
    fn teeth(&self, drawn: &Drawn) -> u32 {
        if self.whole { drawn.outline.teeth } else { 1 }
    }

    fn mating(&self, drawn: &Drawn) -> Option<(&GearPair, Mating)> {
        let pair = self.pair.as_ref()?;
        let mate = self.gears.iter().find(|other| other.side != drawn.side)?;
        Some((pair, Mating::new(pair, drawn.side, &drawn.outline, &mate.outline)))
    }
}
