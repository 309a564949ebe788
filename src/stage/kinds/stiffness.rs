//! `kind: stiffness`: compliances of both gears' teeth by a chosen method, and the mesh stiffness they give.
//!
//! Must not know: how any method works. Stiffness is F/δ along the line of action.

use std::any::Any;
use std::time::Instant;

use crate::stage::common::Teeth;
use crate::stage::compliance as codec;
use crate::stage::{
    Ahead, Context, Curves, Demand, Estimate, Inputs, KeysOf, Kind, Omission, Port, RowCount, Saved, Stage, common,
    names, pair, root_influences,
};
use declare::declared::{Declared, Words};
use declare::error::{Diagnostic, Failure, Faults};
use declare::record::Record;
use declare::units::{RATIO, TORQUE};
use declare::work::Work;
use declare::{Declared, Words};
use gearmesh::gear::compliance::iso6336;
use gearmesh::gear::compliance::{Assumptions, ContactLaw, MeshFacts, RootStress, Tabulated};
use gearmesh::gear::geometry::Side;
use gearmesh::gear::mesh::answers::curve::Point;
use gearmesh::gear::mesh::answers::stiffness::{StiffnessSummary, stiffness};
use gearmesh::gear::mesh::{Mesh, Settings};
use gearmesh::gear::work::{CONTACT_SOLVES, MESH_FACTORISATIONS};
use studygraph::table::columns::Columns;
use studygraph::table::data::{Cell, Table, TableError};
use studygraph::table::schema::{Column, Schema};

/// Tables that are not always there.
const COST: &str = "cost";
const ISO_6336: &str = "iso6336";
const ROOT_STRESS: &str = "root_stress";

pub const KIND: Kind = Kind {
    name: "stiffness",
    version: 1,
    summary: Stiffness::MEMBER.summary,
    fields: Stiffness::MEMBER.fields,
    curves: &[
        Curves { table: "curve", along: "cycle_position", quantity: "stiffness" },
        Curves { table: names::compliance::TABLE, along: names::compliance::ROLL_ANGLE, quantity: "bending" },
        Curves { table: ROOT_STRESS, along: "roll_angle", quantity: "stress" },
    ],
    example: "
kind: stiffness
pair: geometry
method: energy
root: trochoid
contact: linear
coupling: body
",
    build,
};

/// Compliance of the teeth of both gears, and the mesh stiffness over the mesh cycle.
#[derive(Debug, Declared)]
struct Stiffness {
    /// The pair.
    #[declared(kinds = ["geometry"])]
    pub pair: String,
    #[declared(flatten)]
    pub deflection: Deflection,
    /// Positions per base pitch; the ends of contact come on top.
    #[declared(minimum = 8, maximum = 100_000, default = "64")]
    pub positions: usize,
}

/// How a pair deflects, and how accurately that is to be known.
#[derive(Debug, Declared)]
pub struct Deflection {
    #[declared(flatten)]
    pub teeth: Teeth,
    /// Whether loaded neighbours deflect each other through the gear bodies.
    #[declared(default = "body")]
    pub coupling: Coupling,
    /// Torque on the pinion for the mesh stiffness, which all but the linear contact depend on.
    #[declared(minimum = 1e-12, maximum = 1e9, dimension = TORQUE, example = "100 N m")]
    pub torque: Option<f64>,
    /// Wanted accuracy of the compliances, relative to a tooth's own; the method takes the cheapest settings that meet
    /// it.
    #[declared(minimum = 1e-12, maximum = 0.1, dimension = RATIO, example = "0.1 %")]
    pub accuracy: Option<f64>,
}

/// Whether a load on one tooth is felt by others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Coupling {
    /// pair stiffnesses are summed
    None,
    /// a load on one tooth moves its neighbours
    Body,
}

/// What finite elements take without a wanted accuracy: for either gear the mesh, and one half as fine for its error.
const USUAL_FACTORISATIONS: f64 = 4.0;

/// What the stresses at the roots take: for either gear a mesh that is graded to the fillet, and one half as fine.
const MESHES_OF_ROOTS: usize = 4;

/// The torque that stands for "any" where the contact is linear, so that stiffness does not depend on load.
const ANY_TORQUE: f64 = 1.0;

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let stiffness = Stiffness::checked(record)?;
    let Deflection { teeth, torque, .. } = &stiffness.deflection;
    teeth.check(record)?;
    let contact = teeth.contact();
    if contact != ContactLaw::Linear && torque.is_none() {
        let said = if teeth.contact.is_some() { "" } else { ", which goes with the method," };
        return Err(Diagnostic::new(format!(
            "`contact: {}`{said} needs a `torque`: the stiffness depends on the load",
            contact.word()
        ))
        .at(record.place_of(Teeth::NAMES.contact))
        .help("add for example `torque: 50 N m`")
        .into());
    }
    Ok(Box::new(stiffness))
}

/// Where a row of the curve stands, from 1, and what is there.
type CurveRow = (usize, Point);

fn curve() -> Columns<CurveRow> {
    let description =
        "Mesh stiffness over one mesh cycle. Where the number of pairs changes there are two rows, one for each side.";
    let cycle_position = "Distance from where a pair starts contact, along the line of action.";
    Columns::new("curve", description)
        .integer("point", "Counts the positions, from 1.", |row: &CurveRow| row.0)
        .key()
        .float("cycle_position", "mm", cycle_position, |row| row.1.cycle_position)
        .float("roll_angle", "deg", "The pinion's roll angle at the newest pair.", |row| row.1.roll_angle)
        .integer("pairs", "Pairs in contact.", |row| row.1.pairs)
        .float("stiffness", "N/m", "Mesh stiffness F/δ of the unmodified pair.", |row| row.1.secant_stiffness)
}

/// What the curve amounts to, and how far off the compliances may be.
struct SummaryRow {
    summary: StiffnessSummary,
    error_estimate: f64,
    /// Seconds that tabulating took.
    seconds: f64,
}

impl SummaryRow {
    /// Least and largest stiffness with so many pairs in contact.
    fn zone(&self, pairs: usize) -> [f64; 2] {
        let zones = [Some(self.summary.fewest_pairs), self.summary.most_pairs];
        let found = zones.into_iter().flatten().find(|zone| zone.pairs == pairs);
        found.map_or([f64::NAN; 2], |zone| [zone.minimum, zone.maximum])
    }
}

fn summary() -> Columns<SummaryRow> {
    let description = "Extremes of the mesh stiffness; NaN where that many pairs are never in contact.";
    let error = "Estimated numerical error of the compliances, in units of a tooth's own.";
    let extreme = |columns: Columns<SummaryRow>, name, description, pairs, end: usize| {
        columns.float(name, "N/m", description, move |row| row.zone(pairs)[end]).but(Column::allows_nan)
    };
    let columns = Columns::new("summary", description);
    let columns = extreme(columns, "single_min", "Smallest stiffness with one pair in contact.", 1, 0);
    let columns = extreme(columns, "single_max", "Largest stiffness with one pair in contact.", 1, 1);
    let columns = extreme(columns, "double_min", "Smallest stiffness with two pairs in contact.", 2, 0);
    extreme(columns, "double_max", "Largest stiffness with two pairs in contact.", 2, 1)
        .float("mean", "N/m", "Integral mean over the mesh cycle.", |row| row.summary.mean)
        .integer("fewest_pairs", "Pairs in contact where they are fewest.", |row| row.summary.fewest_pairs.pairs)
        .float("error_estimate", "%", error, |row| row.error_estimate)
        .but(|column| column.tolerance(1e-9, 1e-2))
}

/// By itself, since a table with measured times differs from run to run.
fn cost() -> Columns<SummaryRow> {
    Columns::new(COST, "Error of the compliances against the time they took.")
        .float("mean", "N/m", "As in the table `summary`.", |row: &SummaryRow| row.summary.mean)
        .float("error_estimate", "%", "As in the table `summary`.", |row| row.error_estimate)
        .but(|column| column.tolerance(1e-9, 1e-2))
        .float("seconds", "s", "Time for tabulating the compliances.", |row| row.seconds)
        .but(Column::volatile)
        .on_demand()
}

fn iso() -> Columns<iso6336::Stiffness> {
    let description = "Mesh stiffness per face width by ISO 6336-1; for solid discs unless the method says otherwise.";
    let unit = "N/(mm um)";
    Columns::new(ISO_6336, description)
        .float("theoretical", unit, "c′_th: theoretical stiffness of a pair.", |found: &iso6336::Stiffness| {
            found.theoretical
        })
        .float("single", unit, "c′: maximum stiffness of a pair.", |found| found.single)
        .float("mesh", unit, "c_γα: mean stiffness of the mesh.", |found| found.mesh)
        .on_demand()
}

fn mesh() -> Columns<MeshFacts> {
    let error = "Estimated error of the compliances, in units of the tooth's own, from a mesh half as fine.";
    let unknowns = "Unknown displacements of one tooth and its share of the body.";
    Columns::new("mesh", "The finite-element mesh of each gear; no rows for methods without one.")
        .text("gear", "Which gear: pinion or gear.", |mesh: &MeshFacts| mesh.side.name())
        .key()
        .integer("elements_across", "Elements across a tooth.", |mesh| mesh.elements_across)
        .integer("elements", "Elements of one tooth and its share of the body.", |mesh| mesh.elements)
        .integer("unknowns", unknowns, |mesh| mesh.unknowns)
        .float("error_estimate", "%", error, |mesh| mesh.error_estimate)
        // The difference of two compliances, which move by 1e-12 of themselves: docs/methods.md, "Same bits anywhere".
        .but(|column| column.tolerance(1e-7, 1e-9))
}

/// The Chebyshev node of a gear, from 1, and the stress under a load there.
type StressRow = (usize, RootStress);

fn root_stress() -> Columns<StressRow> {
    let stress = "Largest first principal stress per load per face width.";
    Columns::new(ROOT_STRESS, "The largest stress on the surface of a loaded tooth's root, on the side of the load.")
        .text("gear", "Which gear: pinion or gear.", |row: &StressRow| row.1.side.name())
        .key()
        .integer("node", "Chebyshev node, from 1 at the root side.", |row| row.0)
        .key()
        .float("roll_angle", "rad", "Roll angle of the loaded point.", |row| row.1.roll)
        .float("stress", "MPa mm/N", stress, |row| row.1.stress)
        .float("radius", "mm", "Radius at which it is.", |row| row.1.radius)
        .float("error_estimate", "%", root_influences::ERROR_ESTIMATE, |row| row.1.error_estimate)
        // The difference of two stresses.
        .but(|column| column.tolerance(1e-7, 1e-9))
        .on_demand()
}

/// Whether a table is demanded that comes from the meshes of the roots.
fn wants_roots(demand: &Demand) -> bool {
    demand.table(ROOT_STRESS) || demand.table(names::root_influences::TABLE)
}

fn stress_rows(stresses: Vec<RootStress>) -> Vec<StressRow> {
    let (mut node, mut before) = (0, None);
    let numbered = |found: RootStress| {
        node = if before == Some(found.side) { node + 1 } else { 1 };
        before = Some(found.side);
        (node, found)
    };
    stresses.into_iter().map(numbered).collect()
}

impl Deflection {
    /// What the method is to assume.
    #[must_use]
    pub fn assumptions(&self) -> Assumptions {
        let (torque, accuracy) = (self.torque, self.accuracy);
        Assumptions { torque, accuracy, ..self.teeth.assumptions(self.coupling == Coupling::Body) }
    }
}

impl Stiffness {
    fn assumptions(&self) -> Assumptions {
        self.deflection.assumptions()
    }

    fn settings(&self) -> Settings {
        Settings { positions: self.positions, ..Settings::default() }
    }

    fn root_name(&self) -> &str {
        if self.deflection.teeth.method.whole_pair() { "none" } else { self.deflection.teeth.root.word() }
    }
}

impl Stage for Stiffness {
    fn inputs(&self) -> Vec<Port> {
        vec![pair::port(&self.pair)]
    }

    fn keys(&self, table: &str, column: &str, _of: KeysOf) -> Option<Vec<Cell>> {
        let is_of_gears = column == "gear" && ["mesh", ROOT_STRESS].contains(&table);
        is_of_gears.then(|| [Side::Pinion, Side::Gear].map(|side| side.name().into()).to_vec())
    }

    fn outputs(&self) -> Vec<Schema> {
        let mut schemas = Vec::from(codec::schemas());
        schemas.extend([curve().schema(), summary().schema(), mesh().schema(), cost().schema(), iso().schema()]);
        if self.deflection.teeth.method.root_stresses().is_some() {
            schemas.extend([root_stress().schema(), root_influences::schema()]);
        }
        schemas
    }

    fn lacks(&self, table: &str) -> Option<&'static str> {
        let of_roots = table == ROOT_STRESS || table == names::root_influences::TABLE;
        (of_roots && self.deflection.teeth.method.root_stresses().is_none())
            .then_some("its method knows no stress at the root; `method: finite_element` does")
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let foreseen = self.deflection.teeth.method.foresee(self.assumptions());
        let curve = common::curve_rows(self.settings(), 0);
        let meshed = self.deflection.teeth.method.root_stresses().is_some();
        let solves = Work::of(&CONTACT_SOLVES, 2 * curve);
        let mut estimate =
            Estimate::new(false).work(&foreseen.work, foreseen.times).work(&solves, 1.0).holding(foreseen.memory);
        for schema in self.outputs() {
            let rows = match schema.name.as_str() {
                "compliance" => RowCount::about(foreseen.nodes),
                "neighbours" => RowCount::about(foreseen.neighbours),
                // Without reliefs there are few spans.
                "curve" => RowCount::at_most(curve),
                "mesh" => RowCount::exact(if meshed { 2 } else { 0 }),
                ROOT_STRESS => RowCount::about(32),
                names::root_influences::TABLE => {
                    let of_roots = self.deflection.teeth.method.root_stresses();
                    RowCount::about(of_roots.map_or(0, |method| method.foresee_influences(self.assumptions())))
                }
                _ => RowCount::exact(1),
            };
            estimate = estimate.rows(demand, schema, rows);
        }
        if meshed && wants_roots(demand) {
            estimate = estimate.work(&Work::of(&MESH_FACTORISATIONS, MESHES_OF_ROOTS), foreseen.times);
        }
        estimate
    }

    fn left_out(&self, _demand: &Demand) -> Vec<Omission> {
        let mut omissions = Vec::new();
        if self.deflection.teeth.method.root_stresses().is_none() {
            let reason = format!("method `{}` needs none", self.deflection.teeth.method.name());
            let saved = Some(Saved::Fixed(&MESH_FACTORISATIONS, USUAL_FACTORISATIONS));
            omissions.push(Omission::new("finite-element mesh and factorisation", reason).saving(saved));
        }
        if self.deflection.teeth.method.whole_pair() {
            let why =
                format!("method `{}` gives the stiffness of a pair as a whole", self.deflection.teeth.method.name());
            for what in ["root curve", "contact law", "influence of neighbouring teeth"] {
                omissions.push(Omission::new(what, &why));
            }
        } else if self.deflection.coupling == Coupling::None {
            omissions.push(Omission::new("influence of neighbouring teeth", "coupling is `none`"));
        }
        omissions
    }

    fn saved(&self, _demand: &Demand, table: &str, _column: Option<&str>) -> Option<Saved> {
        (table == ROOT_STRESS).then_some(Saved::Fixed(&MESH_FACTORISATIONS, MESHES_OF_ROOTS as f64))
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let pair = pair::of(inputs)?;
        let began = Instant::now();
        let (method, assumptions) = (&self.deflection.teeth.method, self.assumptions());
        let roots = method.root_stresses().filter(|_| wants_roots(context.demand));
        let tabulated = match roots {
            Some(method) => method.tabulate_with_roots(&pair, assumptions).map(|(all, roots)| (all, Some(roots))),
            None => method.tabulate(&pair, assumptions).map(|all| (all, None)),
        };
        let (Tabulated { compliance, warnings, error_estimate, meshes, work }, roots) =
            tabulated.map_err(|error| Failure::new(error.to_string()))?;
        let seconds = began.elapsed().as_secs_f64();
        context.work.add(&work);
        for warning in warnings {
            (context.warn)(warning.into());
        }
        if let Some(accuracy) = self.deflection.accuracy.filter(|accuracy| error_estimate > *accuracy) {
            (context.warn)(format!(
                "the compliances are accurate to {error_estimate:.1e} with the finest settings of the method `{}`, not to \
                 {accuracy:.1e}",
                self.deflection.teeth.method.name()
            ).into());
        }
        let failed = |error: TableError| Failure::new(error.to_string());
        let radii = [pair.pinion.base_radius, pair.gear.base_radius];
        let mut tables = Vec::from(
            codec::write(&compliance, radii, self.deflection.teeth.method.name(), self.root_name()).map_err(failed)?,
        );
        context.check_stop()?;

        let cycle = Mesh::new(&pair, &compliance, self.settings()).map_err(common::no_mesh)?;
        let (points, of_curve) = stiffness(&cycle, self.deflection.torque.unwrap_or(ANY_TORQUE));
        context.work.add(&cycle.work());
        let rows: Vec<CurveRow> = (1..).zip(points).collect();
        tables.push(curve().table(&rows).map_err(failed)?);
        let row = [SummaryRow { summary: of_curve, error_estimate, seconds }];
        tables.push(summary().table(&row).map_err(failed)?);
        tables.push(mesh().table(&meshes).map_err(failed)?);
        if context.demand.table(COST) {
            tables.push(cost().table(&row).map_err(failed)?);
        }
        if context.demand.table(ISO_6336) {
            // The standard's own factors where the method is another one.
            let method =
                (self.deflection.teeth.method.as_ref() as &dyn Any).downcast_ref().cloned().unwrap_or_default();
            let found = iso6336::stiffness(&iso6336::Inputs::of(&pair, &method));
            tables.push(iso().table(&[found]).map_err(failed)?);
        }
        if let Some(roots) = roots {
            if context.demand.table(ROOT_STRESS) {
                let sides = [Side::Pinion, Side::Gear].into_iter().zip(&roots);
                let found = sides.flat_map(|(side, influences)| influences.largest(side)).collect();
                tables.push(root_stress().table(&stress_rows(found)).map_err(failed)?);
            }
            if context.demand.table(names::root_influences::TABLE) {
                tables.push(root_influences::write(&roots).map_err(failed)?);
            }
        }
        Ok(tables)
    }
}
