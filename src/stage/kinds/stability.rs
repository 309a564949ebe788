//! `kind: stability`: what must hold of any pair under any load, checked on a grid of extreme cases and on named traps.
//!
//! The checks and their limits are those of `gear/stability`; here cases are made, shared among threads, and written down.
//! A case that physics or the model excludes is a row that says so. Must not know: how anything is checked.

mod tables;

use std::f64::consts::FRAC_PI_4;

use rayon::prelude::*;

use crate::stage::common::{Contact, Slices, Teeth};
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Port, RowCount, Stage, common, pair};
use declare::declared::Declared;
use declare::error::{Failure, Faults};
use declare::record::Record;
use declare::units::{ANGLE, LENGTH, STRESS, TORQUE, in_unit};
use declare::{Declared, Words};
use gearmesh::gear::geometry::{Rack, Side, Specification};
use gearmesh::gear::stability::{self, AXES, Case, Model, Point, Report, Rules};
use gearmesh::optimize::latin_hypercube;
use studygraph::stage::steps::Steps;
use studygraph::table::data::Table;
use studygraph::table::schema::Schema;

pub const KIND: Kind = Kind {
    name: "stability",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[],
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

/// Invariants and digits lost of the chain from geometry to transmission error on extreme cases.
#[derive(Debug, Declared)]
struct Stated {
    /// The pair in the middle of the grid; cases stand without backlash.
    #[declared(kinds = ["geometry"])]
    pub pair: String,
    /// Torque on the pinion, where an axis does not say otherwise.
    #[declared(minimum = 1e-12, maximum = 1e9, dimension = TORQUE, default = "50 N m")]
    pub torque: f64,
    /// Depth of the linear tip relief of both gears.
    #[declared(minimum = 0.0, maximum = 5e-3, dimension = LENGTH, default = "0 um")]
    pub relief: f64,
    /// Roll length of the relief from the tip.
    #[declared(minimum = 0.0, maximum = 1.0, dimension = LENGTH, default = "0 mm")]
    pub relief_length: f64,
    /// Lead crowning of both gears.
    #[declared(minimum = 0.0, maximum = 5e-3, dimension = LENGTH, default = "0 um")]
    pub crowning: f64,
    #[declared(flatten)]
    pub teeth: Teeth,
    /// Whether loaded neighbours deflect each other through the gear bodies.
    #[declared(default = "none")]
    pub coupling: Coupling,
    #[declared(flatten)]
    pub contact: Contact,
    #[declared(flatten)]
    pub slices: Slices,
    /// Positions per base pitch; zone ends, relief starts and touches come on top.
    #[declared(minimum = 8, maximum = 100_000, default = "64")]
    pub positions: usize,
    /// Values of one parameter at a time.
    #[declared(default = "{}")]
    pub axes: Values,
    /// Whether the named traps are checked.
    #[declared(default = "true")]
    pub traps: bool,
    /// Points of a Latin hypercube over the whole box of the axes.
    #[declared(minimum = 0, maximum = 100_000, default = "0")]
    pub samples: usize,
}

/// Whether a load on one tooth is felt by others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
enum Coupling {
    /// pair stiffnesses are summed, as the second evaluation does
    None,
    /// a load on one tooth moves its neighbours
    Body,
}

/// By the names of [`AXES`].
#[derive(Debug, Declared)]
struct Values {
    /// Torque on the pinion.
    #[declared(minimum = 1e-12, maximum = 1e9, dimension = TORQUE, axis = usize::MAX, example = "50 N m")]
    pub torque: Option<Vec<f64>>,
    /// E of both gears.
    #[declared(minimum = 1.0, maximum = 1e15, dimension = STRESS, axis = usize::MAX, example = "206 GPa")]
    pub youngs_modulus: Option<Vec<f64>>,
    /// E of the pinion over E of the gear.
    #[declared(minimum = 1e-12, maximum = 1e12, axis = usize::MAX, example = "1")]
    pub stiffness_ratio: Option<Vec<f64>>,
    /// Module, all lengths with it.
    #[declared(minimum = 1e-5, maximum = 1.0, dimension = LENGTH, axis = usize::MAX, example = "3 mm")]
    pub module: Option<Vec<f64>>,
    /// Teeth of the pinion.
    #[declared(minimum = 4.0, maximum = 10_000.0, axis = usize::MAX, example = "24")]
    pub pinion_teeth: Option<Vec<f64>>,
    /// Teeth of the gear.
    #[declared(minimum = 4.0, maximum = 10_000.0, axis = usize::MAX, example = "36")]
    pub gear_teeth: Option<Vec<f64>>,
    /// Profile shift coefficient of the pinion.
    #[declared(minimum = -2.0, maximum = 3.0, axis = usize::MAX, example = "0.2", counts_in = "module")]
    pub pinion_shift: Option<Vec<f64>>,
    /// Profile shift coefficient of the gear.
    #[declared(minimum = -2.0, maximum = 3.0, axis = usize::MAX, example = "0.2", counts_in = "module")]
    pub gear_shift: Option<Vec<f64>>,
    /// Pressure angle of the basic rack.
    #[declared(minimum = 0.08, maximum = FRAC_PI_4, dimension = ANGLE, axis = usize::MAX, example = "20 deg")]
    pub pressure_angle: Option<Vec<f64>>,
    /// Face width of both gears.
    #[declared(minimum = 1e-6, maximum = 100.0, dimension = LENGTH, axis = usize::MAX, example = "20 mm")]
    pub face_width: Option<Vec<f64>>,
    /// Depth of the tip relief.
    #[declared(minimum = 0.0, maximum = 5e-3, dimension = LENGTH, axis = usize::MAX, example = "12 um")]
    pub relief: Option<Vec<f64>>,
    /// Roll length of the tip relief.
    #[declared(minimum = 0.0, maximum = 1.0, dimension = LENGTH, axis = usize::MAX, example = "4 mm")]
    pub relief_length: Option<Vec<f64>>,
    /// Lead crowning.
    #[declared(minimum = 0.0, maximum = 5e-3, dimension = LENGTH, axis = usize::MAX, example = "4 um")]
    pub crowning: Option<Vec<f64>>,
    /// Bore radius over root radius of both gears.
    #[declared(minimum = 1e-3, maximum = 1.0, axis = usize::MAX, example = "0.5")]
    pub bore: Option<Vec<f64>>,
    /// Contact ratio, by the addendum of the rack.
    #[declared(minimum = 0.5, maximum = 4.0, axis = usize::MAX, example = "1.6")]
    pub contact_ratio: Option<Vec<f64>>,
}

impl Values {
    /// In the order of [`AXES`].
    const fn all(&self) -> [&Option<Vec<f64>>; AXES.len()] {
        [
            &self.torque,
            &self.youngs_modulus,
            &self.stiffness_ratio,
            &self.module,
            &self.pinion_teeth,
            &self.gear_teeth,
            &self.pinion_shift,
            &self.gear_shift,
            &self.pressure_angle,
            &self.face_width,
            &self.relief,
            &self.relief_length,
            &self.crowning,
            &self.bore,
            &self.contact_ratio,
        ]
    }

    /// Places in [`AXES`] with their values.
    fn given(&self) -> impl Iterator<Item = (usize, &[f64])> {
        self.all().into_iter().enumerate().filter_map(|(index, values)| Some((index, values.as_deref()?)))
    }
}

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
    axes: Values,
    traps: bool,
    samples: usize,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let stated = Stated::checked(record)?;
    stated.teeth.check(record)?;
    let assumptions = stated.teeth.assumptions(stated.coupling == Coupling::Body);
    let settings = common::settings(stated.positions, stated.slices, stated.contact);
    common::check_slices(settings, record)?;
    let Stated { pair, torque, relief, relief_length, crowning, teeth, axes, traps, samples, .. } = stated;
    let model = Model { method: teeth.method.into(), assumptions, settings };
    Ok(Box::new(Stability { pair, load: [torque, relief, relief_length, crowning], model, axes, traps, samples }))
}

impl Stability {
    fn cases(&self, base: &Point, context: &Context) -> Vec<Case> {
        let mut cases = Vec::new();
        for (index, values) in self.axes.given() {
            let axis = &AXES[index];
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
        vec![pair::port(&self.pair)]
    }

    fn outputs(&self) -> Vec<Schema> {
        tables::schemas()
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let on_axes: usize = self.axes.given().map(|(_, values)| values.len()).sum();
        let cases = on_axes + self.samples + if self.traps { TRAPS } else { 0 };
        let mut estimate = Estimate::new(true).taking(CASE_SECONDS * cases as f64);
        for schema in tables::schemas() {
            let rows = match schema.name.as_str() {
                "checks" => RowCount::about(CHECKS * cases),
                "digits" => RowCount::at_most(QUANTITIES * cases),
                "summary" => RowCount::at_most(self.axes.given().count() + 2),
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
        let pair = pair::of(inputs)?;
        // Of the rack of a shaped gear its addendum counts alone.
        let counts = |side| {
            let Specification { rack, cutter, .. } = pair.side(side).specification;
            (rack.addendum, cutter.is_none().then_some(rack))
        };
        let [(pinion, cuts_pinion), (gear, cuts_gear)] = [Side::Pinion, Side::Gear].map(counts);
        let cutting: Vec<Rack> = [cuts_pinion, cuts_gear].into_iter().flatten().collect();
        if pinion.to_bits() != gear.to_bits() || cutting.windows(2).any(|racks| racks[0] != racks[1]) {
            return Err(Failure::new(
                "pinion and gear have racks of their own; cases have one for both: check a geometry with one `rack`",
            ));
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use declare::declared::record_of;
    use declare::record::Value;

    #[test]
    fn values_are_in_the_order_of_the_axes() {
        for (index, axis) in AXES.iter().enumerate() {
            let record = record_of(Values::MEMBER.fields, &[(axis.name, Value::Axis(vec![1.0]))]);
            let values = Values::read(&record);
            assert_eq!(values.given().map(|(index, _)| index).collect::<Vec<_>>(), [index], "{}", axis.name);
        }
    }
}
