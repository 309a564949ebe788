//! `kind: stiffness`: compliances of both gears' teeth by a chosen method, and the mesh stiffness they give.
//!
//! Must not know: how any method works. Stiffness is F/δ along the line of action.

use std::any::Any;
use std::time::Instant;

use crate::stage::common::Teeth;
use crate::stage::compliance as codec;
use crate::stage::{
    Ahead, Context, Demand, Estimate, Inputs, Kind, Omission, Port, RowCount, Saved, Stage, common, pair,
};
use declare::declared::Words;
use declare::error::{Diagnostic, Failure};
use declare::parameter::{Choice, Field, count, joined};
use declare::record::Record;
use declare::units::{RATIO, TORQUE, in_unit};
use declare::work::Work;
use gearmesh::gear::compliance::iso6336::{self, Iso6336};
use gearmesh::gear::compliance::{Assumptions, ContactLaw, MeshFacts, RootStress, Tabulated};
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::transmission_error::cycle::{MeshCycle, Settings};
use gearmesh::gear::transmission_error::stiffness::stiffness;
use gearmesh::gear::work::{CONTACT_SOLVES, MESH_FACTORISATIONS};
use studygraph::table::data::{Row, Table, TableError};
use studygraph::table::schema::{Column, Schema};

pub const KIND: Kind = Kind {
    name: "stiffness",
    version: 1,
    summary: "Compliance of the teeth of both gears, and the mesh stiffness over the mesh cycle.",
    fields: FIELDS,
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

const FIELDS: &[Field] = &joined::<{ count(PARTS) }>(PARTS);

const PARTS: &[&[Field]] = &[&[Field::reference("pair", &["geometry"], "The pair.")], common::TEETH, MESH];

const MESH: &[Field] = &[
    Field::choice("coupling", COUPLINGS, "Whether loaded neighbours deflect each other through the gear bodies.")
        .default("body"),
    Field::quantity(
        "torque",
        TORQUE,
        1e-12,
        1e9,
        "Torque on the pinion for the mesh stiffness; the load-dependent contact needs one.",
    )
    .optional(),
    Field::quantity(
        "accuracy",
        RATIO,
        1e-12,
        0.1,
        "Wanted accuracy of the compliances, relative to a tooth's own; the method takes the cheapest settings that meet it.",
    )
    .optional(),
    Field::integer("positions", 8, 100_000, "Positions per base pitch; the ends of contact come on top.").default("64"),
];

const COUPLINGS: &[Choice] = &[
    Choice { name: "none", summary: "pair stiffnesses are summed" },
    Choice { name: "body", summary: "a load on one tooth moves its neighbours" },
];

/// What finite elements take without a wanted accuracy: for either gear the mesh, and one half as fine for its error.
const USUAL_FACTORISATIONS: f64 = 4.0;

/// The torque that stands for "any" where the contact is linear, so that stiffness does not depend on load.
const ANY_TORQUE: f64 = 1.0;

struct Stiffness {
    pair: String,
    teeth: Teeth,
    torque: f64,
    settings: Settings,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Diagnostic> {
    let mut teeth = common::teeth(record)?;
    let torque = record.maybe_quantity("torque");
    teeth.assumptions = Assumptions { torque, accuracy: record.maybe_quantity("accuracy"), ..teeth.assumptions };
    if teeth.assumptions.contact == ContactLaw::LoadDependent && torque.is_none() {
        return Err(Diagnostic::new("`contact: load_dependent` needs a `torque`: the stiffness depends on the load")
            .at(record.place_of("contact"))
            .help("add for example `torque: 50 N m`"));
    }
    let positions = common::whole(record, "positions");
    Ok(Box::new(Stiffness {
        pair: record.reference("pair").to_owned(),
        teeth,
        torque: torque.unwrap_or(ANY_TORQUE),
        settings: Settings { positions, ..Settings::default() },
    }))
}

fn curve_schema() -> Schema {
    Schema::new(
        "curve",
        "Mesh stiffness over one mesh cycle. Where the number of pairs changes there are two rows, one for each side.",
        vec![
            Column::integer("point", "Counts the positions, from 1.").key(),
            Column::float(
                "cycle_position",
                "mm",
                "Distance from where a pair starts contact, along the line of action.",
            ),
            Column::float("roll_angle", "deg", "The pinion's roll angle at the newest pair."),
            Column::integer("pairs", "Pairs in contact."),
            Column::float("stiffness", "N/m", "Mesh stiffness F/δ of the unmodified pair."),
        ],
    )
}

fn summary_schema() -> Schema {
    let extreme = |name: &str, description: &str| Column::float(name, "N/m", description).allows_nan();
    Schema::new(
        "summary",
        "Extremes of the mesh stiffness; NaN where that many pairs are never in contact.",
        vec![
            extreme("single_min", "Smallest stiffness with one pair in contact."),
            extreme("single_max", "Largest stiffness with one pair in contact."),
            extreme("double_min", "Smallest stiffness with two pairs in contact."),
            extreme("double_max", "Largest stiffness with two pairs in contact."),
            Column::float("mean", "N/m", "Integral mean over the mesh cycle."),
            Column::integer("fewest_pairs", "Pairs in contact where they are fewest."),
            Column::float(
                "error_estimate",
                "%",
                "Estimated numerical error of the compliances, in units of a tooth's own.",
            )
            .tolerance(1e-9, 1e-2),
        ],
    )
}

/// By itself, since a table with measured times differs from run to run.
fn cost_schema() -> Schema {
    let columns = vec![
        Column::float("mean", "N/m", "As in the table `summary`."),
        Column::float("error_estimate", "%", "As in the table `summary`.").tolerance(1e-9, 1e-2),
        Column::float("seconds", "s", "Time for tabulating the compliances.").volatile(),
    ];
    Schema::new("cost", "Error of the compliances against the time they took.", columns).on_demand()
}

fn iso_schema() -> Schema {
    let column = |name: &str, description: &str| Column::float(name, "N/(mm um)", description);
    Schema::new(
        "iso6336",
        "Mesh stiffness per face width by ISO 6336-1; for solid discs unless the method says otherwise.",
        vec![
            column("theoretical", "c′_th: theoretical stiffness of a pair."),
            column("single", "c′: maximum stiffness of a pair."),
            column("mesh", "c_γα: mean stiffness of the mesh."),
        ],
    )
    .on_demand()
}

fn iso_table(pair: &GearPair, method: &Iso6336) -> Result<Table, TableError> {
    let found = iso6336::stiffness(&iso6336::Inputs::of(pair, method));
    let row: Row = [found.theoretical, found.single, found.mesh].map(|value| in_unit(value, "N/(mm um)").into()).into();
    Table::from_rows(iso_schema(), vec![row])
}

fn mesh_schema() -> Schema {
    Schema::new(
        "mesh",
        "The finite-element mesh of each gear; no rows for methods without one.",
        vec![
            Column::text("gear", "Which gear: pinion or gear.").key(),
            Column::integer("elements_across", "Elements across a tooth."),
            Column::integer("elements", "Elements of one tooth and its share of the body."),
            Column::integer("unknowns", "Unknown displacements of one tooth and its share of the body."),
            Column::float(
                "error_estimate",
                "%",
                "Estimated error of the compliances, in units of the tooth's own, from a mesh half as fine.",
            )
            // The difference of two compliances, which move by 1e-12 of themselves: docs/methods.md, "Same bits anywhere".
            .tolerance(1e-7, 1e-9),
        ],
    )
}

fn mesh_table(meshes: &[MeshFacts]) -> Result<Table, TableError> {
    let row = |mesh: &MeshFacts| -> Row {
        vec![
            mesh.side.name().into(),
            mesh.elements_across.into(),
            mesh.elements.into(),
            mesh.unknowns.into(),
            in_unit(mesh.error_estimate, "%").into(),
        ]
    };
    Table::from_rows(mesh_schema(), meshes.iter().map(row).collect())
}

fn root_stress_schema() -> Schema {
    Schema::new(
        "root_stress",
        "The largest stress on the surface of a loaded tooth's root, on the side of the load.",
        vec![
            Column::text("gear", "Which gear: pinion or gear.").key(),
            Column::integer("node", "Chebyshev node, from 1 at the root side.").key(),
            Column::float("roll_angle", "rad", "Roll angle of the loaded point."),
            Column::float("stress", "MPa mm/N", "Largest first principal stress per load per face width."),
            Column::float("radius", "mm", "Radius at which it is."),
        ],
    )
    .on_demand()
}

fn root_stress_table(stresses: &[RootStress]) -> Result<Table, TableError> {
    let mut rows: Vec<Row> = Vec::new();
    let (mut node, mut before) = (0, None);
    for found in stresses {
        node = if before == Some(found.side) { node + 1 } else { 1 };
        before = Some(found.side);
        rows.push(vec![
            found.side.name().into(),
            node.into(),
            found.roll.into(),
            in_unit(found.stress, "MPa mm/N").into(),
            in_unit(found.radius, "mm").into(),
        ]);
    }
    Table::from_rows(root_stress_schema(), rows)
}

impl Stiffness {
    fn root_name(&self) -> &str {
        if self.teeth.method.whole_pair() { "none" } else { self.teeth.assumptions.root.word() }
    }
}

impl Stage for Stiffness {
    fn inputs(&self) -> Vec<Port> {
        vec![Port::tables("pair", &self.pair, &["gears", "pair"])]
    }

    fn outputs(&self) -> Vec<Schema> {
        let mut schemas = vec![
            codec::compliance_schema(),
            codec::neighbours_schema(),
            codec::model_schema(),
            curve_schema(),
            summary_schema(),
            mesh_schema(),
            cost_schema(),
            iso_schema(),
        ];
        if self.teeth.method.root_stresses().is_some() {
            schemas.push(root_stress_schema());
        }
        schemas
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let foreseen = self.teeth.method.foresee(self.teeth.assumptions);
        let curve = common::curve_rows(self.settings, 0);
        let meshed = self.teeth.method.root_stresses().is_some();
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
                "root_stress" => RowCount::about(32),
                _ => RowCount::exact(1),
            };
            estimate = estimate.rows(demand, schema, rows);
        }
        if demand.table("root_stress") {
            let meshes = if self.teeth.assumptions.accuracy.is_some() { 6 } else { 2 };
            estimate = estimate.work(&Work::of(&MESH_FACTORISATIONS, meshes), foreseen.times);
        }
        estimate
    }

    fn left_out(&self, _demand: &Demand) -> Vec<Omission> {
        let mut omissions = Vec::new();
        if self.teeth.method.root_stresses().is_none() {
            let reason = format!("method `{}` needs none", self.teeth.name);
            let saved = Some(Saved::Fixed(&MESH_FACTORISATIONS, USUAL_FACTORISATIONS));
            omissions.push(Omission::new("finite-element mesh and factorisation", reason).saving(saved));
        }
        if self.teeth.method.whole_pair() {
            let why = format!("method `{}` gives the stiffness of a pair as a whole", self.teeth.name);
            for what in ["root curve", "contact law", "influence of neighbouring teeth"] {
                omissions.push(Omission::new(what, &why));
            }
        } else if !self.teeth.assumptions.coupled {
            omissions.push(Omission::new("influence of neighbouring teeth", "coupling is `none`"));
        }
        omissions
    }

    fn saved(&self, _demand: &Demand, table: &str, _column: Option<&str>) -> Option<Saved> {
        (table == "root_stress").then_some(Saved::Fixed(&MESH_FACTORISATIONS, 2.0))
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let pair = pair::read(inputs.table("pair", "gears")?, inputs.table("pair", "pair")?)?;
        let began = Instant::now();
        let Tabulated { compliance, warnings, error_estimate, meshes, work } = self
            .teeth
            .method
            .tabulate(&pair, self.teeth.assumptions)
            .map_err(|error| Failure::new(error.to_string()))?;
        let seconds = began.elapsed().as_secs_f64();
        context.work.add(&work);
        for warning in warnings {
            (context.warn)(warning);
        }
        if let Some(accuracy) = self.teeth.assumptions.accuracy.filter(|accuracy| error_estimate > *accuracy) {
            (context.warn)(format!(
                "the compliances are accurate to {error_estimate:.1e} with the finest settings of the method `{}`, not to \
                 {accuracy:.1e}",
                self.teeth.name
            ));
        }
        let failed = |error: TableError| Failure::new(error.to_string());
        let radii = [pair.pinion.base_radius, pair.gear.base_radius];
        let mut tables =
            Vec::from(codec::write(&compliance, radii, self.teeth.name, self.root_name()).map_err(failed)?);
        context.check_stop()?;

        let cycle = MeshCycle::new(&pair, &compliance, self.settings)?;
        let (points, summary) = stiffness(&cycle, self.torque);
        context.work.add(&cycle.work());
        let rows = points.iter().enumerate().map(|(index, point)| -> Row {
            vec![
                (index + 1).into(),
                in_unit(point.cycle_position, "mm").into(),
                in_unit(point.roll_angle, "deg").into(),
                point.pairs.into(),
                point.secant_stiffness.into(),
            ]
        });
        tables.push(Table::from_rows(curve_schema(), rows.collect()).map_err(failed)?);
        let zone = |pairs: usize| {
            let zones = [Some(summary.fewest), summary.most];
            let found = zones.into_iter().flatten().find(|zone| zone.pairs == pairs);
            found.map_or([f64::NAN; 2], |zone| [zone.least, zone.most])
        };
        let mut row: Row = [zone(1), zone(2)].concat().into_iter().map(Into::into).collect();
        row.extend([summary.mean.into(), summary.fewest.pairs.into(), in_unit(error_estimate, "%").into()]);
        tables.push(Table::from_rows(summary_schema(), vec![row]).map_err(failed)?);
        tables.push(mesh_table(&meshes).map_err(failed)?);
        if context.demand.table("cost") {
            let row: Row = vec![summary.mean.into(), in_unit(error_estimate, "%").into(), seconds.into()];
            tables.push(Table::from_rows(cost_schema(), vec![row]).map_err(failed)?);
        }
        if context.demand.table("iso6336") {
            // The standard's own factors where the method is another one.
            let method = (self.teeth.method.as_ref() as &dyn Any).downcast_ref().cloned().unwrap_or_default();
            tables.push(iso_table(&pair, &method).map_err(failed)?);
        }
        if let Some(method) = self.teeth.method.root_stresses().filter(|_| context.demand.table("root_stress")) {
            let (found, work) =
                method.root_stress(&pair, self.teeth.assumptions).map_err(|error| Failure::new(error.to_string()))?;
            context.work.add(&work);
            tables.push(root_stress_table(&found).map_err(failed)?);
        }
        Ok(tables)
    }
}
