//! `kind: geometry`: two spur gears and their pairing, or one gear alone, checked before anything runs.
//!
//! On demand it gives the full profiles, their junctions, how far the gears are from what they must not be, and the pair
//! in mesh as curves. Must not know: stiffness. Names after ISO 21771 and ISO 53.

mod article;
mod body;
mod construction;
mod drawn;
mod inspected;
mod meshing;
pub mod stated;
mod valid;

use crate::stage::designs::Elements;
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, KeysOf, Kind, Port, RowCount, Saved, Stage, names, pair};
use declare::declared::Declared;
use declare::error::{Diagnostic, Failure, Faults, Place};
use declare::record::Record;
use declare::units::LENGTH;
use declare::work::Work;
use declare::{Declared, Words};
use drawn::Drawn;
use gearmesh::gear::geometry::error::{GeometryError, Subject};
use gearmesh::gear::geometry::outline::Outline;
use gearmesh::gear::geometry::outline::roots::Root;
use gearmesh::gear::geometry::outline::sample::{Density, Point};
use gearmesh::gear::geometry::outline::tip;
use gearmesh::gear::geometry::validity::Mating;
use gearmesh::gear::geometry::{Gear, GearPair, Side};
use gearmesh::gear::modification::Design;
use gearmesh::gear::work::OUTLINES;
use stated::{StatedGear, StatedGears};
use studygraph::table::data::{Cell, Table, TableError};
use studygraph::table::schema::Schema;

pub const KIND: Kind = Kind {
    name: "geometry",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[],
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

/// Two involute spur gears on their centre distance, or one alone: radii, contact ratio, full profiles.
#[derive(Debug, Declared)]
struct Stated {
    #[declared(flatten)]
    pub gears: StatedGears,
    /// The full profiles, as the tables `outline`, `junctions`, `validity` and `mesh_drawing` have them.
    #[declared(default = "{}")]
    pub outline: StatedOutline,
}

/// The full profiles.
#[derive(Debug, Declared)]
struct StatedOutline {
    /// Root of the teeth.
    #[declared(default = "trochoid")]
    pub root: Box<dyn Root>,
    /// What is done to the corners of the tip: the flank, and contact with it, ends there.
    #[declared(default = "land")]
    pub tip: Box<dyn tip::Stated>,
    /// Modifications of the flanks, one or several.
    pub flank: Option<Elements>,
    /// Points per tooth, at least.
    #[declared(minimum = 8, maximum = 100_000, default = "200")]
    pub points: usize,
    /// How far a chord may lie from its curve; adds points.
    #[declared(minimum = 1e-10, maximum = 1e-2, dimension = LENGTH, example = "1 um")]
    pub chord_error: Option<f64>,
    /// How many teeth the table `outline` has.
    #[declared(default = "one")]
    pub teeth: Teeth,
}

/// How many teeth of a gear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
enum Teeth {
    /// one tooth with half a space on either side
    One,
    /// the whole gear
    All,
}

struct Geometry {
    /// None of a gear alone.
    pair: Option<GearPair>,
    /// The pinion, and the gear of a pair.
    gears: Vec<Drawn>,
    /// By how much the centre distance may be smaller, and larger \[m\].
    centre_distance: [f64; 2],
    density: Density,
    teeth: Teeth,
}

/// Where the study states what an error is about.
fn place_of(error: &GeometryError, record: &Record) -> Place {
    let (outline, own) = (record.inside(Stated::NAMES.outline), StatedOutline::NAMES);
    match error.subject() {
        Subject::Root => outline.place_of(own.root),
        Subject::Tip if !StatedGears::says_tip(error, record) => outline.place_of(own.tip),
        Subject::Flank => outline.place_of(own.flank),
        Subject::Parameter(_) | Subject::Tip => StatedGears::place_of(error, record),
    }
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let stated = Stated::checked(record)?;
    let refused = |error: &GeometryError| Diagnostic::new(error.to_string()).at(place_of(error, record));
    let gears = &stated.gears;
    gears.check(record)?;
    let common = stated.outline.tip.tip();
    let (pair, design, built) = if let Some(pair) = gears.pair(common).transpose().map_err(|error| refused(&error))? {
        let flank = stated.outline.flank.as_ref().map(Elements::template).transpose()?;
        let design = flank.map_or(Ok(Design::default()), |flank| flank.on(&pair).design(&[]))?;
        let built = vec![pair.pinion.clone(), pair.gear.clone()];
        (Some(pair), design, built)
    } else {
        stated.check_alone(record)?;
        let gear = gears.alone(common).map_err(|error| refused(&error.on(Side::Pinion)))?;
        (None, Design::default(), vec![gear])
    };
    let options = &stated.outline;
    let drawn = |((side, stated), gear): ((Side, &StatedGear), Gear)| {
        let root = stated.root.as_ref().unwrap_or(&options.root);
        let outline = root
            .toe(&gear)
            .and_then(|toe| Outline::new(&gear, toe, gear.tip, design.relief(side)))
            .map_err(|error| refused(&error.on(side)))?;
        let limits = stated.limits(&gear.specification).map_err(|error| refused(&error.on(side)))?;
        Ok(Drawn { side, gear, outline, limits, measured_with: stated.measured_with() })
    };
    let gears = gears.each().zip(built).map(drawn).collect::<Result<_, Diagnostic>>()?;
    let centre_distance =
        stated.gears.centre_distance_allowance.map_or([0.0; 2], |allowed| [allowed.lower, allowed.upper]);
    let density = Density { points: options.points, chord_error: options.chord_error };
    Ok(Box::new(Geometry { pair, gears, centre_distance, density, teeth: options.teeth }))
}

impl Stated {
    /// Refuses what only a pair can have.
    fn check_alone(&self, record: &Record) -> Result<(), Diagnostic> {
        let refused = |record: &Record, field: &str, why: &str| {
            Err(Diagnostic::new(format!("`{field}` needs a mate: {why}"))
                .at(record.place_of(field))
                .help("add the mating gear as `gear`, or leave this out"))
        };
        if self.gears.centre_distance.is_some() {
            let field = StatedGears::NAMES.centre_distance;
            return refused(record, field, "a gear alone has no centre distance");
        }
        if self.gears.centre_distance_allowance.is_some() {
            let field = StatedGears::NAMES.centre_distance_allowance;
            return refused(record, field, "a gear alone has no centre distance");
        }
        if self.outline.flank.is_some() {
            let why = "a modification is laid out on the flank down to where the mate's tip reaches";
            return refused(record.inside(Self::NAMES.outline), StatedOutline::NAMES.flank, why);
        }
        Ok(())
    }
}

/// Tables that are made by going round whole outlines.
const OF_OUTLINES: [&str; 3] = ["outline", "validity", "mesh_drawing"];

impl Stage for Geometry {
    fn inputs(&self) -> Vec<Port> {
        Vec::new()
    }

    fn keys(&self, table: &str, column: &str, _of: KeysOf) -> Option<Vec<Cell>> {
        let is_of_gears = [(names::gears::TABLE, names::gears::GEAR), (names::outline::TABLE, names::outline::GEAR)];
        is_of_gears
            .contains(&(table, column))
            .then(|| self.gears.iter().map(|drawn| drawn.side.name().into()).collect())
    }

    fn outputs(&self) -> Vec<Schema> {
        let paired = self.pair.is_some();
        let mut schemas = vec![pair::gears().schema()];
        schemas.extend(paired.then(|| pair::pair().schema()));
        schemas.extend([drawn::outline_schema(), drawn::junctions().schema(), valid::columns(paired).schema()]);
        schemas.extend(paired.then(|| meshing::columns().schema()));
        schemas.extend([article::columns().schema(), construction::columns().schema()]);
        schemas.extend([inspected::inspection().schema(), body::columns().schema()]);
        if paired {
            schemas.extend([inspected::path_points().schema(), inspected::working().schema()]);
        }
        schemas
    }

    fn lacks(&self, table: &str) -> Option<&'static str> {
        let of_a_pair = [
            pair::pair().schema(),
            meshing::columns().schema(),
            inspected::path_points().schema(),
            inspected::working().schema(),
        ];
        let of_a_pair = of_a_pair.iter().any(|schema| schema.name == table);
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
                "path_points" => RowCount::exact(2 * inspected::POINTS),
                "pair" | "working" => RowCount::exact(1),
                "inspection" => RowCount::exact(self.gears.iter().map(inspected::count).sum()),
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
        for text in self.pair.iter().flat_map(valid::curtailed) {
            (context.warn)(text.into());
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
                (context.warn)(text.into());
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
                ("inspection", _) => {
                    let rows = self.gears.iter().map(inspected::rows).collect::<Result<Vec<_>, _>>();
                    let rows = rows.map_err(|error| Failure::new(error.to_string()))?.concat();
                    inspected::inspection().table(&rows)
                }
                ("body", _) => {
                    let rows: Vec<_> = self.gears.iter().map(body::BodyRow::new).collect();
                    body::columns().table(&rows)
                }
                ("path_points", Some(pair)) => inspected::path_points().table(&inspected::points(pair)),
                ("working", Some(pair)) => {
                    let limits = [0, 1].map(|gear| self.gears.get(gear).and_then(|drawn| drawn.limits));
                    let row = inspected::WorkingRow::new(pair, limits, self.centre_distance);
                    inspected::working().table(&[row.map_err(|error| Failure::new(error.to_string()))?])
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
        match self.teeth {
            Teeth::One => 1,
            Teeth::All => drawn.outline.teeth,
        }
    }

    fn mating(&self, drawn: &Drawn) -> Option<(&GearPair, Mating)> {
        let pair = self.pair.as_ref()?;
        let mate = self.gears.iter().find(|other| other.side != drawn.side)?;
        Some((pair, Mating::new(pair, drawn.side, &drawn.outline, &mate.outline)))
    }
}
