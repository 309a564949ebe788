//! `kind: stability`: what must hold of any pair under any load, checked on a grid of extreme cases and on named traps.
//!
//! The checks and their limits are those of `gear/stability`; here cases are made, shared among threads, and written down.
//! A case that physics or the model excludes is a row that says so. Must not know: how anything is checked.

mod tables;

use rayon::prelude::*;

use crate::stage::common::Teeth;
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Port, RowCount, Stage, common, pair};
use declare::error::{Diagnostic, Failure};
use declare::parameter::{Choice, Field, Shape, count, joined};
use declare::record::Record;
use declare::units::{ANGLE, LENGTH, STRESS, TORQUE, in_unit};
use gearmesh::gear::stability::{self, AXES, Case, Model, Point, Report, Rules};
use gearmesh::optimize::latin_hypercube;
use studygraph::stage::steps::Steps;
use studygraph::table::data::Table;
use studygraph::table::schema::Schema;

pub const KIND: Kind = Kind {
    name: "stability",
    version: 1,
    summary: "Invariants and digits lost of the chain from geometry to transmission error on extreme cases.",
    fields: FIELDS,
    example: "
kind: stability
pair: geometry
torque: 50 N m
relief: 8 um
relief_length: 4 mm
axes:
  torque: [1e-12 N m, 50 N m, 1e9 N m]
  pinion_teeth: [12, 19, 300]
samples: 4
",
    build,
};

const FIELDS: &[Field] = &joined::<{ count(PARTS) }>(PARTS);

const PARTS: &[&[Field]] = &[LOAD, common::TEETH, &[COUPLING], common::CONTACT, &[common::SLICES], CASES];

const LOAD: &[Field] = &[
    Field::reference("pair", &["geometry"], "The pair in the middle of the grid; cases stand without backlash."),
    Field::quantity("torque", TORQUE, 1e-12, 1e9, "Torque on the pinion, where an axis does not say otherwise.")
        .default("50 N m"),
    Field::quantity("relief", LENGTH, 0.0, 5e-3, "Depth of the linear tip relief of both gears.").default("0 um"),
    Field::quantity("relief_length", LENGTH, 0.0, 1.0, "Roll length of the relief from the tip.").default("0 mm"),
    Field::quantity("crowning", LENGTH, 0.0, 5e-3, "Lead crowning of both gears.").default("0 um"),
];

const COUPLING: Field =
    Field::choice("coupling", COUPLINGS, "Whether loaded neighbours deflect each other through the gear bodies.")
        .default("none");

const CASES: &[Field] = &[
    Field::integer(
        "positions",
        8,
        100_000,
        "Positions per base pitch; zone ends, relief starts and touches come on top.",
    )
    .default("64"),
    Field::group("axes", VALUES, "Values of one parameter at a time.").default("{}"),
    Field::new("traps", Shape::Flag, "Whether the named traps are checked.").default("true"),
    Field::integer("samples", 0, 100_000, "Points of a Latin hypercube over the whole box of the axes.").default("0"),
];

const COUPLINGS: &[Choice] = &[
    Choice { name: "none", summary: "pair stiffnesses are summed, as the second evaluation does" },
    Choice { name: "body", summary: "a load on one tooth moves its neighbours" },
];

/// By the names of [`AXES`].
const VALUES: &[Field] = &[
    Field::quantity("torque", TORQUE, 1e-12, 1e9, "Torque on the pinion.").axis(usize::MAX).optional(),
    Field::quantity("youngs_modulus", STRESS, 1.0, 1e15, "E of both gears.").axis(usize::MAX).optional(),
    Field::number("stiffness_ratio", 1e-12, 1e12, "E of the pinion over E of the gear.").axis(usize::MAX).optional(),
    Field::quantity("module", LENGTH, 1e-5, 1.0, "Module, all lengths with it.").axis(usize::MAX).optional(),
    Field::number("pinion_teeth", 4.0, 10_000.0, "Teeth of the pinion.").axis(usize::MAX).optional(),
    Field::number("gear_teeth", 4.0, 10_000.0, "Teeth of the gear.").axis(usize::MAX).optional(),
    Field::number("pinion_shift", -2.0, 3.0, "Profile shift coefficient of the pinion.").axis(usize::MAX).optional(),
    Field::number("gear_shift", -2.0, 3.0, "Profile shift coefficient of the gear.").axis(usize::MAX).optional(),
    Field::quantity("pressure_angle", ANGLE, 0.08, std::f64::consts::FRAC_PI_4, "Pressure angle of the basic rack.")
        .axis(usize::MAX)
        .optional(),
    Field::quantity("face_width", LENGTH, 1e-6, 100.0, "Face width of both gears.").axis(usize::MAX).optional(),
    Field::quantity("relief", LENGTH, 0.0, 5e-3, "Depth of the tip relief.").axis(usize::MAX).optional(),
    Field::quantity("relief_length", LENGTH, 0.0, 1.0, "Roll length of the tip relief.").axis(usize::MAX).optional(),
    Field::quantity("crowning", LENGTH, 0.0, 5e-3, "Lead crowning.").axis(usize::MAX).optional(),
    Field::number("bore", 1e-3, 1.0, "Bore radius over root radius of both gears.").axis(usize::MAX).optional(),
    Field::number("contact_ratio", 0.5, 4.0, "Contact ratio, by the addendum of the rack.").axis(usize::MAX).optional(),
];

/// The named traps, about; what is checked of each case, and the most quantities of one that are computed twice.
const TRAPS: usize = 40;
const CHECKS: usize = 12;
const QUANTITIES: usize = 16;
/// About how long a case takes on one thread.
const CASE_SECONDS: f64 = 0.15;

struct Stability {
    pair: String,
    /// Torque, relief, its length, crowning.
    load: [f64; 4],
    model: Model,
    /// Places in [`AXES`] with their values.
    axes: Vec<(usize, Vec<f64>)>,
    traps: bool,
    samples: usize,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Diagnostic> {
    let Teeth { method, assumptions, .. } = common::teeth(record)?;
    let settings = common::settings(record)?;
    let given = record.group("axes");
    let axes = AXES.iter().enumerate();
    let axes = axes.filter_map(|(index, axis)| given.maybe_axis(axis.name).map(|values| (index, values.to_vec())));
    Ok(Box::new(Stability {
        pair: record.reference("pair").to_owned(),
        load: ["torque", "relief", "relief_length", "crowning"].map(|field| record.quantity(field)),
        model: Model { method: method.into(), assumptions, settings },
        axes: axes.collect(),
        traps: record.flag("traps"),
        samples: common::whole(record, "samples"),
    }))
}

impl Stability {
    fn cases(&self, base: &Point, context: &Context) -> Vec<Case> {
        let mut cases = Vec::new();
        for (index, values) in &self.axes {
            let axis = &AXES[*index];
            for (place, value) in values.iter().enumerate() {
                let mut point = base.clone();
                (axis.set)(&mut point, *value);
                let shown = if axis.unit.is_empty() { *value } else { in_unit(*value, axis.unit) };
                let name = format!("{} {shown} {}", axis.name, axis.unit);
                let share = place as f64 / (values.len() - 1).max(1) as f64;
                cases.push(point.case(name.trim(), axis.name, share, &self.model));
            }
        }
        if self.traps {
            cases.extend(stability::traps(base, &self.model));
        }
        let points = latin_hypercube::points(self.samples, AXES.len(), &mut context.seed.generator(0));
        for (index, coordinates) in points.iter().enumerate() {
            let name = format!("sample {}", index + 1);
            cases.push(stability::sample(base, coordinates).case(name, "sample", 0.0, &self.model));
        }
        cases
    }
}

impl Stage for Stability {
    fn inputs(&self) -> Vec<Port> {
        vec![Port::tables("pair", &self.pair, &["gears", "pair"])]
    }

    fn outputs(&self) -> Vec<Schema> {
        tables::schemas()
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let on_axes: usize = self.axes.iter().map(|(_, values)| values.len()).sum();
        let cases = on_axes + self.samples + if self.traps { TRAPS } else { 0 };
        let mut estimate = Estimate::new(true).taking(CASE_SECONDS * cases as f64);
        for schema in tables::schemas() {
            let rows = match schema.name.as_str() {
                "checks" => RowCount::about(CHECKS * cases),
                "digits" => RowCount::at_most(QUANTITIES * cases),
                "summary" => RowCount::at_most(self.axes.len() + 2),
                _ => RowCount::at_most(QUANTITIES),
            };
            estimate = estimate.rows(demand, schema, rows);
        }
        estimate
    }

    fn uses_seed(&self) -> bool {
        self.samples > 0
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let pair = pair::read(inputs.table("pair", "gears")?, inputs.table("pair", "pair")?)?;
        let mut base = Point::of(&pair);
        [base.torque, base.relief, base.relief_length, base.crowning] = self.load;
        let cases = self.cases(&base, context);
        let rules = Rules::new();
        let steps = Steps::new(context, cases.len());
        let check = |case: &Case| {
            context.check_stop().ok()?;
            let report = stability::check(case, &rules);
            steps.done();
            Some(report)
        };
        let reports: Vec<Option<Report>> = cases.par_iter().map(check).collect();
        context.check_stop()?;
        let reports = reports.into_iter().flatten();
        let mut checked: Vec<(String, &'static str, f64, Report)> = cases
            .iter()
            .zip(reports)
            .map(|(case, report)| (case.name.clone(), case.axis, case.place, report))
            .collect();
        if self.traps {
            for whole in [1.0, 2.0] {
                let found = stability::continuity(&base, &self.model, whole);
                let report = Report { findings: vec![found.finding], digits: Vec::new() };
                checked.push((found.name, "trap", 0.0, report));
            }
        }
        tables::write(&checked).map_err(|error| Failure::new(error.to_string()))
    }
}
