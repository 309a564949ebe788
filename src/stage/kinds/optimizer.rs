//! `kind: optimizer`: the modification that makes the transmission error smallest, by a chosen method, in a box.
//!
//! Every value of the designs that is given as `[least, most]` is a variable. Must not know: how any method searches.

mod ahead;
mod sampling;

use rayon::prelude::*;

use crate::stage::cases::{Cases, Loads};
use crate::stage::common::{Contact, Slices};
use crate::stage::designs::{self, Element, Elements, NamedDesign};
use crate::stage::doubts::Doubted;
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, KeysOf, Kind, Omission, Port, Stage, common, names};
use declare::declared::Declared;
use declare::error::{Diagnostic, Failure};
use declare::record::{Record, Value};
use declare::units::{ANGLE, LENGTH, RATIO, showing};
use declare::{Declared, Words};
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::modification::template::{Template, Variable};
use gearmesh::gear::modification::{self, Design};
use gearmesh::gear::transmission_error::cycle::{MeshCycle, Settings};
use gearmesh::gear::transmission_error::load_case::LoadCase;
use gearmesh::optimize::bounds::Bounds;
use gearmesh::optimize::search::{Candidate, Generation, Optimizer as Search, Reason};
use gearmesh::optimize::{self, Method};
use studygraph::table::columns::{Columns, finite};
use studygraph::table::data::{Cell, Table, TableError};
use studygraph::table::schema::{Column, Schema};
use studygraph::warning::Warning;

const EVALUATIONS: &str = "evaluations";

pub const KIND: Kind = Kind {
    name: "optimizer",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[],
    example: "
kind: optimizer
stiffness: stiffness
method: { genetic: { population: 100, generations: 100 } }
minimize: peak_to_peak
at: { torque: 50 N m }
design:
  - tip_relief: { gear: both, amount: [0 um, 8 um], length: [0 mm, 6 mm], curve: parabolic }
  - lead_crowning: { gear: pinion, amount: [0 um, 8 um] }
",
    build,
};

/// Modifications that make the transmission error smallest, by a seeded search in a box.
#[derive(Debug, Declared)]
struct Stated {
    /// The pair's compliances.
    #[declared(kinds = ["stiffness"])]
    pub stiffness: String,
    /// How to search.
    #[declared(default = "differential_evolution")]
    pub method: Box<dyn Method>,
    /// What is to be small.
    #[declared(default = "peak_to_peak")]
    pub minimize: Objective,
    /// The loads it is to be small at.
    pub at: Loads,
    /// The modifications; a value given as [least, most] is a variable.
    #[declared(chooses)]
    pub design: Elements,
    /// Name of the design that is found.
    #[declared(default = "optimum")]
    pub name: String,
    /// Positions per base pitch; zone ends, relief starts, first touches and extrema come on top.
    #[declared(minimum = 8, maximum = 10_000, default = "64")]
    pub positions: usize,
    #[declared(flatten)]
    pub slices: Slices,
    /// Wanted relative accuracy of the objective at the design that is found; sets positions and slices.
    #[declared(minimum = 1e-9, maximum = 0.1, dimension = RATIO, example = "0.1 %")]
    pub accuracy: Option<f64>,
    #[declared(flatten)]
    pub contact: Contact,
}

/// What is made small.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
enum Objective {
    /// largest less smallest transmission error
    PeakToPeak,
    /// integral mean of the squared deviation of the transmission error
    Variance,
}

struct Optimizer {
    stated: Stated,
    cases: Cases,
    template: Template,
    settings: Settings,
}

/// What a search came to.
struct Found {
    search: Search,
    reason: Reason,
    /// Every design and its objective, if asked for.
    tried: Vec<(Vec<f64>, f64)>,
    settings: Settings,
    /// Estimated relative error of the objective at the best design.
    error: f64,
}

/// The best design: its point, and its largest peak-to-peak under any load.
struct BestRow<'a> {
    name: &'a str,
    found: &'a Found,
    best: &'a Candidate,
    peak_to_peak: f64,
}

/// Searches at most, each with a finer sampling, until the objective is as accurate as wanted.
const ROUNDS: usize = 4;

fn build(record: &Record) -> Result<Box<dyn Stage>, Diagnostic> {
    let stated = Stated::checked(record)?;
    let template = stated.design.template()?;
    if template.variables().is_empty() {
        return Err(Diagnostic::new("nothing is left open for the search")
            .at(record.place_of(Stated::NAMES.design))
            .help("give at least one value as a range, for example `amount: [0 um, 8 um]`"));
    }
    let name = &stated.name;
    if name.is_empty() || name.chars().count() > 64 || !name.chars().all(|c| c.is_alphanumeric() || "-_.".contains(c)) {
        return Err(Diagnostic::new(format!("`{}` cannot be the name of a design", name.escape_debug()))
            .at(record.place_of(Stated::NAMES.name))
            .help("letters, digits, `-`, `_` and `.` make a name, at most 64 of them"));
    }
    let settings = common::settings(stated.positions, stated.slices, stated.contact);
    common::check_slices(settings, record)?;
    let cases = stated.at.cases(record.inside(Stated::NAMES.at))?;
    let optimizer = Optimizer { stated, cases, template, settings };
    // The method may refuse its parameters, or the number of variables: that is the study's mistake, not the run's. Its
    // points are drawn when the stage runs.
    optimizer.bounds()?;
    let foreseen = optimizer.stated.method.foresee(optimizer.template.variables().len());
    foreseen.map_err(|wrong| record.inside(Stated::NAMES.method).locate(wrong))?;
    Ok(Box::new(optimizer))
}

/// The unit a variable is shown in: amounts in µm, other lengths in mm.
fn unit(variable: &Variable) -> &'static str {
    match variable.dimension {
        LENGTH if variable.name.contains("amount") => "um",
        LENGTH => "mm",
        ANGLE => "deg",
        _ => "",
    }
}

fn column(variable: &Variable) -> String {
    variable.name.replace('.', "_")
}

/// A design that was tried: which one, from 1, its point and its objective.
type Tried<'a> = (usize, &'a [f64], f64);

/// What makes the reciprocal of an objective in a unit; NaN where that is none.
fn fitness_in(unit: &str) -> impl Fn(f64) -> f64 + use<> {
    let shown = showing(unit);
    move |value| {
        let shown = shown(finite(value));
        if shown > 0.0 { 1.0 / shown } else { f64::NAN }
    }
}

impl Optimizer {
    fn bounds(&self) -> Result<Bounds, Diagnostic> {
        Bounds::new(self.template.variables().iter().map(|variable| (variable.minimum, variable.maximum)).collect())
    }

    fn search(&self, seed: declare::seed::Seed) -> Result<Search, Diagnostic> {
        optimize::search(&*self.stated.method, self.bounds()?, seed)
    }

    fn objective_unit(&self) -> &'static str {
        match self.stated.minimize {
            Objective::PeakToPeak => "um",
            Objective::Variance => "um^2",
        }
    }

    fn best<'a>(&self) -> Columns<BestRow<'a>> {
        let peak_to_peak = "Peak-to-peak of the transmission error, the largest of all cases.";
        let slices = "Slices that were used on each stretch of the face without a closed form.";
        let error = "Estimated relative error of the objective from positions and slices.";
        let columns = Columns::new("best", "The best design that was found.")
            .text("design", "Name of the design.", |row: &BestRow<'a>| row.name)
            .key()
            .float("objective", self.objective_unit(), "What was made small.", |row| finite(row.best.value))
            .but(|column| column.tolerance(1e-9, 1e-6))
            .float("peak_to_peak", "um", peak_to_peak, |row| row.peak_to_peak)
            .but(|column| column.tolerance(1e-9, 1e-6))
            .integer("evaluations", "How often the objective was computed.", |row| row.found.search.evaluations())
            .integer("generations", "How many batches the search took.", |row| row.found.search.history().len())
            .text("ended", "Why the search ended.", |row| row.found.reason.to_string())
            .integer("positions", "Positions per base pitch that were used.", |row| row.found.settings.positions)
            .integer("slices", slices, |row| row.found.settings.slices)
            .float("error_estimate", "", error, |row| row.found.error)
            .but(|column| column.tolerance(1e-9, 0.0));
        // On a plateau many designs are as good: values of variables are compared loosely.
        self.template.variables().iter().enumerate().fold(columns, |columns, (at, variable)| {
            let description = "Value of the variable in the best design.";
            columns
                .float(&column(variable), unit(variable), description, move |row| row.best.point[at])
                .but(|column| column.tolerance(0.0, 1e-3))
        })
    }

    fn history(&self) -> Columns<(usize, Generation)> {
        let unit = self.objective_unit();
        let (fitness, so_far, reciprocal) = (fitness_in(unit), fitness_in(unit), format!("1/{unit}"));
        Columns::new("history", "The search, batch by batch (generation by generation).")
            .integer("generation", "Counts the batches, from 1.", |row: &(usize, Generation)| row.0)
            .key()
            .integer("evaluations", "Evaluations so far.", |row| row.1.evaluations)
            .float("best", unit, "Lowest objective in the batch.", |row| finite(row.1.best))
            .but(Column::allows_nan)
            .float("best_so_far", unit, "Lowest objective so far.", |row| finite(row.1.best_so_far))
            .but(Column::allows_nan)
            .float("mean", unit, "Mean objective of the batch.", |row| finite(row.1.mean))
            .but(Column::allows_nan)
            .shown("best_fitness", &reciprocal, "1/best: fitness of the best of the batch.", move |row| {
                fitness(row.1.best)
            })
            .but(Column::allows_nan)
            .shown("best_fitness_so_far", &reciprocal, "1/best so far.", move |row| so_far(row.1.best_so_far))
            .but(Column::allows_nan)
    }

    fn evaluations<'a>(&self) -> Columns<Tried<'a>> {
        let unit_of_objective = self.objective_unit();
        let fitness = fitness_in(unit_of_objective);
        let counts = "Counts the designs in the order of the search, from 1.";
        let columns = Columns::new(EVALUATIONS, "Every design that was tried.")
            .integer("evaluation", counts, |row: &Tried| row.0)
            .key();
        let columns = self.template.variables().iter().enumerate().fold(columns, |columns, (at, variable)| {
            columns.float(&column(variable), unit(variable), "Value of the variable.", move |row: &Tried| row.1[at])
        });
        columns
            .float("objective", unit_of_objective, "What is made small; NaN where no design can be built.", |row| {
                finite(row.2)
            })
            .but(|column| column.allows_nan().tolerance(1e-9, 1e-6))
            .shown("fitness", &format!("1/{unit_of_objective}"), "1/objective.", move |row| fitness(row.2))
            .but(|column| column.allows_nan().tolerance(0.0, 1e-6))
            .on_demand()
    }

    /// The objective \[m or m²\]; infinite where the design cannot be built.
    fn value(&self, cycle: &MeshCycle, pair: &GearPair, point: &[f64]) -> f64 {
        let Ok(design) = self.template.design(pair, point) else { return f64::INFINITY };
        let values = self.of_cases(pair, &design, |design, torque| {
            let loading = LoadCase::new(cycle, design, torque);
            match self.stated.minimize {
                Objective::PeakToPeak => loading.peak_to_peak(),
                Objective::Variance => loading.variance(),
            }
        });
        values.map_or(f64::INFINITY, |values| self.cases.combined(&values))
    }

    /// A value of each case; none where a design is no design any more with what is off.
    fn of_cases<T: Default + Clone>(
        &self,
        pair: &GearPair,
        design: &Design,
        mut value: impl FnMut(&Design, f64) -> T,
    ) -> Option<Vec<T>> {
        let mut values = vec![T::default(); self.cases.all.len()];
        for off in self.cases.designs(design, pair).ok()? {
            for (place, torque) in &off.cases {
                values[*place] = value(&off.design, *torque);
            }
        }
        Some(values)
    }

    /// The search with one sampling.
    fn found(
        &self,
        context: &Context,
        base: &MeshCycle,
        pair: &GearPair,
        settings: Settings,
    ) -> Result<Found, Failure> {
        let cycle = base.sampled(settings);
        let mut search = self.search(context.seed).map_err(|error| Failure::new(error.message))?;
        let budget = search.budget().max(1) as f64;
        let wanted = context.demand.table(EVALUATIONS);
        let mut tried: Vec<(Vec<f64>, f64)> = Vec::new();
        let mut done = 0_usize;
        let reason = search.run(|points| -> Result<Vec<f64>, Failure> {
            context.check_stop()?;
            let values: Vec<f64> = points.par_iter().map(|point| self.value(&cycle, pair, point)).collect();
            if wanted {
                tried.extend(points.iter().cloned().zip(values.iter().copied()));
            }
            done += points.len();
            (context.progress)(done as f64 / budget);
            Ok(values)
        })?;
        let error = search.best().map_or(1.0, |best| self.error(base, pair, &best.point, settings));
        Ok(Found { search, reason, tried, settings, error })
    }

    /// Why a search found no design at all, by the one in the middle of the box.
    fn nothing_built(&self, pair: &GearPair) -> Failure {
        let variables = self.template.variables();
        let middle: Vec<f64> = variables.iter().map(|variable| 0.5 * (variable.minimum + variable.maximum)).collect();
        let reason =
            self.template.design(pair, &middle).err().map(|error| format!("; in the middle: {}", error.message));
        Failure::new(format!(
            "none of the designs that were tried in the box can be built on this pair{}",
            reason.unwrap_or_default()
        ))
    }

    /// The elements with the values of the best point in the place of the ranges.
    fn best_elements(&self, point: &[f64]) -> Vec<Element> {
        let mut values = point.iter();
        let mut elements = self.stated.design.elements();
        for element in &mut elements {
            for (_, entry) in &mut element.record.fields {
                if matches!(entry.value, Value::Range(..)) {
                    entry.value = Value::Quantity(values.next().copied().unwrap_or(f64::NAN));
                }
            }
        }
        elements
    }

    /// Says what the law of contact may be off by at the design that was found.
    fn warn(&self, context: &Context, design: &Design, (pair, cycle): (&GearPair, &MeshCycle)) {
        let told = self.of_cases(pair, design, |design, torque| {
            let loading = LoadCase::new(cycle, design, torque);
            let doubt = loading.contact_doubt()?;
            let peak_to_peak = loading.peak_to_peak();
            Doubted { design: &self.stated.name, torque, doubt, peak_to_peak }.told()
        });
        told.into_iter().flatten().flatten().for_each(|case| (context.warn)(Warning::Cases(case)));
    }

    fn tables(
        &self,
        context: &Context,
        found: &Found,
        pair: &GearPair,
        cycle: &MeshCycle,
    ) -> Result<Vec<Table>, Failure> {
        let search = &found.search;
        let best = search.best().ok_or_else(|| self.nothing_built(pair))?;
        let failed = |error: TableError| Failure::new(error.to_string());
        let design = self.template.design(pair, &best.point).map_err(|error| Failure::new(error.message))?;
        let of_cases =
            self.of_cases(pair, &design, |design, torque| LoadCase::new(cycle, design, torque).peak_to_peak());
        let peak_to_peak = of_cases.into_iter().flatten().fold(0.0, f64::max);
        let row = BestRow { name: &self.stated.name, found, best, peak_to_peak };
        self.warn(context, &design, (pair, cycle));
        let design = NamedDesign { name: self.stated.name.clone(), elements: self.best_elements(&best.point) };
        let mut tables = vec![
            self.best().table(&[row]).map_err(failed)?,
            self.history().table_of(&(1..).zip(search.history().iter().copied())).map_err(failed)?,
        ];
        tables.extend(designs::write(&[design], modification::members()).map_err(failed)?);
        Ok(tables)
    }
}

impl Stage for Optimizer {
    fn inputs(&self) -> Vec<Port> {
        common::mesh_cycle_ports(&self.stated.stiffness)
    }

    fn keys(&self, _table: &str, column: &str, _of: KeysOf) -> Option<Vec<Cell>> {
        (column == names::designs::DESIGN).then(|| vec![Cell::Text(self.stated.name.clone())])
    }

    fn outputs(&self) -> Vec<Schema> {
        let [designs, elements] = designs::schemas();
        vec![self.best().schema(), self.history().schema(), designs, elements, self.evaluations().schema()]
    }

    fn estimate(&self, demand: &Demand, ahead: &Ahead) -> Estimate {
        self.ahead(demand, ahead)
    }

    fn left_out(&self, _demand: &Demand) -> Vec<Omission> {
        common::corner_contact_left_out(self.settings).into_iter().collect()
    }

    fn uses_seed(&self) -> bool {
        true
    }

    fn refuses(&self, inputs: &Inputs) -> Result<(), Failure> {
        common::refused_cycle(inputs, &self.stated.stiffness, self.settings)
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let (pair, base) = common::mesh_cycle(inputs, self.settings)?;
        let mut settings = self.first_settings(&base, &pair);
        let mut round = 1;
        let mut found = loop {
            let found = self.found(context, &base, &pair, settings)?;
            let (Some(accuracy), Some(best)) = (self.stated.accuracy, found.search.best()) else { break found };
            if found.error <= accuracy {
                break found;
            }
            let next = sampling::finer(settings, self.settings_for(&base, &pair, &best.point, accuracy));
            if round == ROUNDS || next == settings {
                let reached = found.error;
                (context.warn)(format!("the objective is accurate to {reached:.1e}, not to {accuracy:.1e}").into());
                break found;
            }
            (settings, round) = (next, round + 1);
        };
        if let Some(doubt) = found.search.doubt() {
            (context.warn)(doubt.to_owned().into());
        }
        let mut tables = self.tables(context, &found, &pair, &base.sampled(found.settings))?;
        if context.demand.table(EVALUATIONS) {
            let tried = (1..).zip(&found.tried).map(|(index, (point, value))| (index, point.as_slice(), *value));
            tables.push(
                self.evaluations().table_of(&tried).map_err(|error: TableError| Failure::new(error.to_string()))?,
            );
        }
        context.work.add(&base.work());
        Ok(tables)
    }
}
