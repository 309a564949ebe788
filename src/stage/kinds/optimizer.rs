//! `kind: optimizer`: the modification that makes numbers of the transmission error smallest, by a chosen method, in a box.
//!
//! Every value of the designs that is given as `[least, most]` is a variable. Must not know: how any method searches.

mod ahead;
mod corners;
mod goal;
mod passes;
mod sampling;
mod simpler;
mod tables;

use self::goal::{Goal, Worth};
use self::passes::{Found, Run};
use self::tables::{BestRow, FrontRow};
use crate::stage::cases::{Cases, Loads};
use crate::stage::common::{Contact, Slices};
use crate::stage::contact_law_error::ReportedContactLawError;
use crate::stage::designs::{self, Element, Elements, NamedDesign};
use crate::stage::{
    Ahead, Context, Demand, Estimate, Inputs, KeysOf, Kind, Omission, Port, Stage, common, names, root_influences,
};
use declare::declared::{Declared, Placed};
use declare::error::{Diagnostic, Failure, Faults};
use declare::record::{Record, Value};
use declare::units::RATIO;
use declare::{Declared, Words};
use gearmesh::gear::mesh::{Loaded, Mesh, Settings};
use gearmesh::gear::modification::template::{Fitted, Template};
use gearmesh::gear::modification::{self, Design};
use gearmesh::optimize::bounds::Bounds;
use gearmesh::optimize::search::Optimizer as Search;
use gearmesh::optimize::settled::Settled;
use gearmesh::optimize::{self, Foreseen, Method};
use studygraph::table::data::{Cell, Table, TableError};
use studygraph::table::schema::Schema;
use studygraph::warning::Warning;

const EVALUATIONS: &str = "evaluations";

pub const KIND: Kind = Kind {
    name: "optimizer",
    version: 2,
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

/// Modifications that make numbers of the transmission error smallest, by a seeded search in a box.
#[derive(Debug, Declared)]
struct Stated {
    /// The pair's compliances.
    #[declared(kinds = ["stiffness"])]
    pub stiffness: String,
    /// How to search; several objectives take `nsga2` or a sample.
    #[declared(default = "differential_evolution")]
    pub method: Box<dyn Method>,
    /// What is to be small, one or several: a column of `summary` of `ste`, or `harmonics[order=1].amplitude`.
    #[declared(default = "peak_to_peak")]
    pub minimize: Vec<Placed<String>>,
    /// What every design must keep: `column <= limit` or `column >= limit`.
    #[declared(example = "largest_pressure <= 1400 MPa")]
    pub subject_to: Option<Vec<Placed<String>>>,
    /// The loads it is to be small at.
    pub at: Loads,
    /// The modifications; a value given as [least, most] is a variable.
    #[declared(chooses)]
    pub design: Elements,
    /// Name of the design that is found.
    #[declared(default = "optimum")]
    pub name: String,
    /// How closely designs are looked at on the way.
    #[declared(default = "staged")]
    pub search: How,
    /// When the search has settled; a staged one does unless it is said, by the defaults.
    pub settled: Option<Rule>,
    /// Points of the front that are kept, with several objectives.
    #[declared(minimum = 2, maximum = 10_000, default = "50")]
    pub front_points: usize,
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

/// How closely designs are looked at on the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
enum How {
    /// with coarse samplings until nothing more is gained, the best of them and what is near as asked for; samples as `plain`
    Staged,
    /// every design as asked for, until the method ends
    Plain,
}

/// When a search has settled: nothing more was gained for a while.
#[derive(Clone, Copy, Debug, Declared)]
struct Rule {
    /// Share of the best objective that counts as a gain; of a front, of what it dominates.
    #[declared(minimum = 0.0, maximum = 0.5, dimension = RATIO, default = "0.1 %")]
    pub improvement: f64,
    /// Evaluations without a gain after which it ends; 300 unless it is said, of a front 1000: then at most one in a hundred
    /// would have brought a gain.
    #[declared(minimum = 1, maximum = 1_000_000_000, example = "300")]
    pub evaluations: Option<usize>,
}

/// What counts as a gain, and evaluations without one: the rule of three gives a hundredth. A front moves as a whole.
const GAIN: f64 = 1e-3;
const OF_ONE: usize = 300;
const OF_A_FRONT: usize = 1000;

impl Rule {
    fn rule(self, evaluations: usize) -> Settled {
        Settled { improvement: self.improvement, evaluations: self.evaluations.unwrap_or(evaluations) }
    }
}

struct Optimizer {
    stated: Stated,
    cases: Cases,
    goal: Goal,
    template: Template,
    settings: Settings,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let stated = Stated::checked(record)?;
    let template = stated.design.template()?;
    if template.variables().is_empty() {
        return Err(Diagnostic::new("nothing is left open for the search")
            .at(record.place_of(Stated::NAMES.design))
            .help("give at least one value as a range, for example `amount: [0 um, 8 um]`")
            .into());
    }
    let name = &stated.name;
    if name.is_empty() || name.chars().count() > 64 || !name.chars().all(|c| c.is_alphanumeric() || "-_.".contains(c)) {
        return Err(Diagnostic::new(format!("`{}` cannot be the name of a design", name.escape_debug()))
            .at(record.place_of(Stated::NAMES.name))
            .help("letters, digits, `-`, `_` and `.` make a name, at most 64 of them")
            .into());
    }
    if stated.minimize.is_empty() {
        let place = record.place_of(Stated::NAMES.minimize);
        return Err(Diagnostic::new("nothing is to be small")
            .at(place)
            .help("for example `minimize: peak_to_peak`")
            .into());
    }
    let goal = Goal::read(&stated.minimize, stated.subject_to.as_deref().unwrap_or_default())?;
    if goal.has_front() && !stated.method.finds_fronts() {
        let message =
            format!("`{}` takes one objective, and there are {}", stated.method.name(), goal.objectives().len());
        return Err(Diagnostic::new(message)
            .at(record.place_of(Stated::NAMES.method))
            .help("take `nsga2`, or a sample: `grid`, `latin_hypercube` or `sobol`")
            .into());
    }
    let settings = common::settings(stated.positions, stated.slices, stated.contact);
    common::check_slices(settings, record)?;
    let cases = stated.at.cases(record.inside(Stated::NAMES.at))?;
    let optimizer = Optimizer { stated, cases, goal, template, settings };
    // The method may refuse its parameters, or the number of variables: that is the study's mistake, not the run's. Its
    // points are drawn when the stage runs.
    optimizer.bounds()?;
    optimizer.foresee().map_err(|wrong| record.inside(Stated::NAMES.method).locate(wrong))?;
    Ok(Box::new(optimizer))
}

impl Optimizer {
    fn bounds(&self) -> Result<Bounds, Diagnostic> {
        Bounds::new(self.template.variables().iter().map(|variable| (variable.minimum, variable.maximum)).collect())
    }

    /// A staged search goes down by itself from what its method found.
    fn search(&self, seed: declare::seed::Seed) -> Result<Search, Diagnostic> {
        let unpolished = if self.is_staged() { self.stated.method.unpolished() } else { None };
        optimize::search(unpolished.as_deref().unwrap_or(&*self.stated.method), self.bounds()?, seed)
    }

    /// A sample is looked at as a whole, and as asked for.
    fn is_staged(&self) -> bool {
        self.stated.search == How::Staged && self.stated.method.learns()
    }

    fn rule(&self) -> Settled {
        let evaluations = if self.goal.has_front() { OF_A_FRONT } else { OF_ONE };
        self.stated.settled.unwrap_or(Rule { improvement: GAIN, evaluations: Some(evaluations) }).rule(evaluations)
    }

    fn foresee(&self) -> Result<Foreseen, Diagnostic> {
        let dimension = self.template.variables().len();
        let foreseen = self.stated.method.foresee(dimension)?;
        Ok(if self.is_staged() {
            passes::on_top(foreseen, dimension)
        } else {
            Foreseen { exact: foreseen.exact && self.stated.settled.is_none(), ..foreseen }
        })
    }

    /// What a point is worth; nothing where the design cannot be built.
    fn worth(&self, cycle: &Mesh, fitted: &Fitted, point: &[f64]) -> Worth {
        let design = fitted.design(point).ok();
        let values = design.and_then(|design| self.measured(cycle, fitted, &design));
        self.goal.worth(&self.cases, &values.unwrap_or_else(|| vec![None]))
    }

    /// All measures of each case.
    fn measured(&self, cycle: &Mesh, fitted: &Fitted, design: &Design) -> Option<Vec<Option<Vec<f64>>>> {
        self.of_cases((fitted, cycle), design, |loading, _| self.goal.of_case(loading))
    }

    /// A value of each case; none where a design is no design any more with what is off.
    fn of_cases<T: Default + Clone>(
        &self,
        (fitted, cycle): (&Fitted, &Mesh),
        design: &Design,
        mut value: impl FnMut(&Loaded, f64) -> T,
    ) -> Option<Vec<T>> {
        let mut values = vec![T::default(); self.cases.all.len()];
        for off in self.cases.designs(design, fitted.pair()).ok()? {
            let mut meshed = cycle.design(&off.design);
            for (place, torque) in &off.cases {
                values[*place] = value(&meshed.under(*torque), *torque);
            }
        }
        Some(values)
    }

    /// Why a search found no design at all, by the one in the middle of the box.
    fn nothing_built(&self, fitted: &Fitted) -> Failure {
        let variables = self.template.variables();
        let middle: Vec<f64> = variables.iter().map(|variable| 0.5 * (variable.minimum + variable.maximum)).collect();
        let reason = fitted.design(&middle).err().map(|error| format!("; in the middle: {}", error.message));
        Failure::new(format!(
            "none of the designs that were tried in the box can be built on this pair{}",
            reason.unwrap_or_default()
        ))
    }

    /// The elements with the values of a point in the place of the ranges.
    fn elements_at(&self, point: &[f64]) -> Vec<Element> {
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
    fn warn(&self, context: &Context, design: &Design, (fitted, cycle): (&Fitted, &Mesh)) {
        let told = self.of_cases((fitted, cycle), design, |loading, torque| {
            let doubt = loading.contact_law_error()?;
            let peak_to_peak = loading.peak_to_peak();
            ReportedContactLawError { design: &self.stated.name, torque, doubt, peak_to_peak }.told()
        });
        told.into_iter().flatten().flatten().for_each(|case| (context.warn)(Warning::Cases(case)));
    }

    fn tables(
        &self,
        context: &Context,
        found: &Found,
        (fitted, cycle): (&Fitted, &Mesh),
    ) -> Result<Vec<Table>, Failure> {
        let best = &found.best;
        let failed = |error: TableError| Failure::new(error.to_string());
        let design = fitted.design(&best.point).map_err(|error| Failure::new(error.message))?;
        let of_cases = self.of_cases((fitted, cycle), &design, |loading, _| loading.peak_to_peak());
        let peak_to_peak = of_cases.into_iter().flatten().fold(0.0, f64::max);
        let limited = |point: &[f64]| {
            if self.goal.limits.is_empty() { Vec::new() } else { self.worth(cycle, fitted, point).limited }
        };
        let balanced = found.front.iter().find(|member| member.point == best.point);
        let further = balanced.map(|member| member.evaluation.further.clone()).unwrap_or_default();
        let name = self.stated.name.as_str();
        let row = BestRow { name, found, peak_to_peak, further, limited: limited(&best.point) };
        self.warn(context, &design, (fitted, cycle));
        let named = |name: String, point: &[f64]| NamedDesign { name, elements: self.elements_at(point) };
        let mut designs = vec![named(name.to_owned(), &best.point)];
        designs.extend((1..).zip(&found.front).map(|(number, member)| named(self.name_of(number), &member.point)));
        let mut tables = vec![
            self.best().table(&[row]).map_err(failed)?,
            self.history().table_of(&(1..).zip(found.history.iter().copied())).map_err(failed)?,
            self.passes().table_of(&(1..).zip(found.passes.iter().cloned())).map_err(failed)?,
        ];
        if self.goal.has_front() {
            let points = || designs[1..].iter().zip(&found.front);
            let rows: Vec<FrontRow> = (1..)
                .zip(points())
                .map(|(number, (design, member))| FrontRow {
                    number,
                    name: &design.name,
                    member,
                    limited: limited(&member.point),
                })
                .collect();
            tables.push(self.front().table(&rows).map_err(failed)?);
        }
        tables.extend(designs::write(&designs, modification::members()).map_err(failed)?);
        Ok(tables)
    }

    /// The design of a point of the front.
    fn name_of(&self, number: usize) -> String {
        format!("{}_{number}", self.stated.name)
    }
}

impl Stage for Optimizer {
    fn inputs(&self) -> Vec<Port> {
        let mut ports = common::mesh_cycle_ports(&self.stated.stiffness);
        if self.goal.needs_roots() {
            ports.push(Port { only_for: &[], ..root_influences::port(&self.stated.stiffness) });
        }
        ports
    }

    fn keys(&self, _table: &str, column: &str, _of: KeysOf) -> Option<Vec<Cell>> {
        // How many points a front has nobody knows before.
        let is_known = column == names::designs::DESIGN && !self.goal.has_front();
        is_known.then(|| vec![Cell::Text(self.stated.name.clone())])
    }

    fn outputs(&self) -> Vec<Schema> {
        let [designs, elements] = designs::schemas();
        let mut schemas = vec![self.best().schema(), self.history().schema(), self.passes().schema()];
        if self.goal.has_front() {
            schemas.push(self.front().schema());
        }
        schemas.extend([designs, elements, self.evaluations().schema()]);
        schemas
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
        let base = if self.goal.needs_roots() { base.with_roots(&root_influences::of(inputs)?) } else { base };
        let fitted = self.template.on(&pair);
        let found = Run::new(self, context, (&base, &fitted))?.found()?;
        let cycle = base.sampled(found.settings);
        let mut tables = self.tables(context, &found, (&fitted, &cycle))?;
        if context.demand.table(EVALUATIONS) {
            let tried = (1..).zip(&found.tried).map(|(index, (point, value))| (index, point.as_slice(), *value));
            tables.push(
                self.evaluations().table_of(&tried).map_err(|error: TableError| Failure::new(error.to_string()))?,
            );
        }
        self.warn_of_corners((context, inputs), &found, (&fitted, &cycle));
        self.tell_if_simpler_does(context, &found, (&fitted, &cycle));
        context.work.add(&base.work());
        Ok(tables)
    }
}
