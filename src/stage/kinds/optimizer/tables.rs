//! The tables of a stage of the kind `optimizer`: columns and rows.
//!
//! Must not know: how a design is found.

use super::passes::{Found, Pass};
use super::{EVALUATIONS, Optimizer};
use crate::stage::measures::Measure;
use declare::units::{ANGLE, LENGTH, showing};
use gearmesh::gear::modification::template::Variable;
use gearmesh::optimize::pareto::Member;
use gearmesh::optimize::search::Generation;
use studygraph::table::columns::{Columns, finite};
use studygraph::table::schema::Column;

/// The best design: its largest peak-to-peak in any case, and what its further objectives and limits come to, in SI.
pub struct BestRow<'a> {
    pub name: &'a str,
    pub found: &'a Found,
    pub peak_to_peak: f64,
    pub further: Vec<f64>,
    pub limited: Vec<f64>,
}

/// A design that was tried: which one, from 1, its point and its objective.
pub type Tried<'a> = (usize, &'a [f64], f64);

/// A point of a front: its number, its name, and what its limits come to.
pub struct FrontRow<'a> {
    pub number: usize,
    pub name: &'a str,
    pub member: &'a Member,
    pub limited: Vec<f64>,
}

/// The unit a variable is shown in: amounts in µm, other lengths in mm.
pub fn unit(variable: &Variable) -> &'static str {
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

/// What makes the reciprocal of an objective in a unit; NaN where that is none.
fn fitness_in(unit: &str) -> impl Fn(f64) -> f64 + use<> {
    let shown = showing(unit);
    move |value| {
        let shown = shown(finite(value));
        if shown > 0.0 { 1.0 / shown } else { f64::NAN }
    }
}

/// `1/um`; of `1/um^2` that below, of a plain number none.
fn reciprocal(unit: &str) -> String {
    match unit.strip_prefix("1/") {
        Some(below) => below.to_owned(),
        None if unit.is_empty() => String::new(),
        None => format!("1/{unit}"),
    }
}

/// Names of columns for measures, numbered where one is taken.
fn named<'m>(measures: impl Iterator<Item = &'m Measure>, taken: &[&str]) -> Vec<String> {
    let mut names: Vec<String> = taken.iter().map(|name| (*name).to_owned()).collect();
    for measure in measures {
        let plain = &measure.column;
        let numbered = (2..).map(|number| format!("{plain}_{number}"));
        let free = std::iter::once(plain.clone()).chain(numbered).find(|name| !names.contains(name));
        names.push(free.unwrap_or_else(|| plain.clone()));
    }
    names.split_off(taken.len())
}

impl Optimizer {
    fn objective_unit(&self) -> &'static str {
        self.goal.objectives()[0].unit
    }

    fn limited(&self) -> impl Iterator<Item = &Measure> {
        self.goal.limits.iter().map(|limit| &self.goal.measures[limit.measure])
    }

    pub fn best<'a>(&self) -> Columns<BestRow<'a>> {
        let peak_to_peak = "Peak-to-peak of the transmission error, the largest of all cases.";
        let slices = "Slices that were used on each stretch of the face without a closed form.";
        let error = "Estimated relative error of the objective from positions and slices.";
        let columns = Columns::new("best", "The best design that was found; of a front the balanced one.")
            .text("design", "Name of the design.", |row: &BestRow<'a>| row.name)
            .key()
            .float("objective", self.objective_unit(), "What was made small.", |row| finite(row.found.best.value))
            .but(|column| column.tolerance(1e-9, 1e-6))
            .float("peak_to_peak", "um", peak_to_peak, |row| row.peak_to_peak)
            .but(|column| column.tolerance(1e-9, 1e-6))
            .integer("evaluations", "How often the objective was computed.", |row| row.found.evaluations)
            .integer("generations", "How many batches the search took.", |row| row.found.history.len())
            .text("ended", "Why the search ended.", |row| row.found.ended.as_str())
            .integer("positions", "Positions per base pitch that were used.", |row| row.found.settings.positions)
            .integer("slices", slices, |row| row.found.settings.slices)
            .float("error_estimate", "", error, |row| row.found.error)
            .but(|column| column.tolerance(1e-9, 0.0));
        // On a plateau many designs are as good: values of variables are compared loosely.
        let columns = self.template.variables().iter().enumerate().fold(columns, |columns, (at, variable)| {
            let description = "Value of the variable in the best design.";
            columns
                .float(&column(variable), unit(variable), description, move |row| row.found.best.point[at])
                .but(|column| column.tolerance(0.0, 1e-3))
        });
        let further = &self.goal.objectives()[1..];
        let names = named(further.iter().chain(self.limited()), &["objective", "peak_to_peak", "positions", "slices"]);
        let columns = further.iter().zip(&names).enumerate().fold(columns, |columns, (at, (measure, name))| {
            columns
                .float(name, measure.unit, "What was made small too.", move |row| row.further[at])
                .but(|column| column.tolerance(1e-9, 1e-6))
        });
        self.limited().zip(&names[further.len()..]).enumerate().fold(columns, |columns, (at, (measure, name))| {
            let description = format!("In the case that decides: {}.", self.goal.limits[at].text);
            columns
                .float(name, measure.unit, &description, move |row| row.limited[at])
                .but(|column| column.tolerance(1e-9, 1e-6))
        })
    }

    pub fn front<'a>(&self) -> Columns<FrontRow<'a>> {
        let about =
            "Designs that no other one beats in every objective, evenly spread, from the smallest first objective on.";
        let columns = Columns::new("front", about)
            .integer("point", "Counts the points, from 1.", |row: &FrontRow<'a>| row.number)
            .key()
            .text("design", "Name of the design.", |row| row.name);
        let objectives = self.goal.objectives();
        let names = named(objectives.iter().chain(self.limited()), &["point", "design"]);
        let columns = objectives.iter().zip(&names).enumerate().fold(columns, |columns, (at, (measure, name))| {
            let value = move |row: &FrontRow| row.member.evaluation.objectives().nth(at).unwrap_or(f64::NAN);
            columns.float(name, measure.unit, "What is made small.", value).but(|column| column.tolerance(1e-9, 1e-6))
        });
        let of_limits = self.limited().zip(&names[objectives.len()..]).enumerate();
        let columns = of_limits.fold(columns, |columns, (at, (measure, name))| {
            let description = format!("In the case that decides: {}.", self.goal.limits[at].text);
            columns
                .float(name, measure.unit, &description, move |row| row.limited[at])
                .but(|column| column.tolerance(1e-9, 1e-6))
        });
        self.template.variables().iter().enumerate().fold(columns, |columns, (at, variable)| {
            columns
                .float(&column(variable), unit(variable), "Value of the variable.", move |row| row.member.point[at])
                .but(|column| column.tolerance(0.0, 1e-3))
        })
    }

    pub fn history(&self) -> Columns<(usize, Generation)> {
        let unit = self.objective_unit();
        let (fitness, so_far, reciprocal) = (fitness_in(unit), fitness_in(unit), reciprocal(unit));
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

    /// What each sampling of a search took, and what it brought.
    pub fn passes(&self) -> Columns<(usize, Pass)> {
        let best = "The best objective of the pass, as its own sampling has it.";
        let slices = "Slices that were used on each stretch of the face without a closed form.";
        Columns::new("passes", "The samplings of the search, one after the other: coarse ones first, if it is staged.")
            .integer("pass", "Counts them, from 1.", |row: &(usize, Pass)| row.0)
            .key()
            .text("what", "What was done: search, confirm, or refine.", |row| row.1.what)
            .integer("positions", "Positions per base pitch that were used.", |row| row.1.settings.positions)
            .integer("slices", slices, |row| row.1.settings.slices)
            .integer("evaluations", "How often the objective was computed.", |row| row.1.evaluations)
            .float("best", self.objective_unit(), best, |row| finite(row.1.best))
            .but(|column| column.allows_nan().tolerance(1e-9, 1e-6))
            .text("ended", "Why it ended.", |row| row.1.ended.clone())
    }

    pub fn evaluations<'a>(&self) -> Columns<Tried<'a>> {
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
            .shown("fitness", &reciprocal(unit_of_objective), "1/objective.", move |row| fitness(row.2))
            .but(|column| column.allows_nan().tolerance(0.0, 1e-6))
            .on_demand()
    }
}
