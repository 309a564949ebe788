//! The tables of a fit.
//!
//! Must not know: how anything in them is found.

use super::goal::Goal;
use super::parameters::{Parameter, deviation_name};
use super::search::Solution;
use studygraph::table::columns::Columns;
use studygraph::table::schema::Column;

/// A number that a column shows to about as many digits as a search leaves.
fn loose(column: Column) -> Column {
    column.tolerance(0.0, 1e-5).allows_nan()
}

/// A parameter of the best solution, in its unit.
pub struct ParameterRow<'a> {
    pub parameter: &'a Parameter,
    pub value: f64,
    pub deviation: f64,
    /// Standard deviations to either end of the interval.
    pub reach: f64,
    pub digits: usize,
    pub is_held: bool,
}

impl ParameterRow<'_> {
    fn end(&self, side: f64, bound: f64) -> f64 {
        let end = self.value + side * self.reach * self.deviation;
        if side < 0.0 { end.max(bound) } else { end.min(bound) }
    }

    /// An interval with no ends within the bounds is no interval.
    fn interval(&self, side: f64) -> f64 {
        let bound = self.parameter.shown(if side < 0.0 { self.parameter.bounds.0 } else { self.parameter.bounds.1 });
        if self.deviation.is_finite() { self.end(side, bound) } else { f64::NAN }
    }

    fn bound(&self) -> &'static str {
        let (low, high) = self.parameter.bounds;
        let middle = self.parameter.shown(0.5 * (low + high));
        match (self.is_held, self.value < middle) {
            (false, _) => "",
            (true, true) => "lower",
            (true, false) => "upper",
        }
    }
}

pub fn parameters<'a>() -> Columns<ParameterRow<'a>> {
    let description =
        "The parameters where the sum of squares is least, each in its own unit, and how well they are determined.";
    let deviation = "Standard deviation: of the tolerances as standard deviations of what is met, or of what is left where \
                     that scatters more; NaN where a bound holds the parameter or nothing determines it.";
    let digits =
        "How many digits are determined: half a unit in the last of them is not less than the standard deviation.";
    Columns::new("parameters", description)
        .text("parameter", "Name of the parameter.", |row: &ParameterRow<'a>| row.parameter.name.as_str())
        .key()
        .text("field", "The field that it is.", |row| row.parameter.path.as_str())
        .text("unit", "Unit of value, standard deviation and bounds.", |row| row.parameter.unit.as_str())
        .shown("value", "", "The fitted value.", |row| row.value)
        .but(loose)
        .shown("standard_deviation", "", deviation, |row| finite(row.deviation))
        .but(|column| column.tolerance(0.0, 1e-3).allows_nan())
        .shown("lower", "", "Lower end of the interval of 95 %, cut off at the bound.", |row| row.interval(-1.0))
        .but(loose)
        .shown("upper", "", "Upper end of the interval of 95 %, cut off at the bound.", |row| row.interval(1.0))
        .but(loose)
        .integer("digits", digits, |row| row.digits)
        .shown("from", "", "The least value that was allowed.", |row| row.parameter.shown(row.parameter.bounds.0))
        .shown("to", "", "The largest value that was allowed.", |row| row.parameter.shown(row.parameter.bounds.1))
        .text("at_bound", "Lower or upper, where a bound holds the parameter; empty where none does.", |row| {
            row.bound()
        })
}

/// Two parameters of the best solution.
pub struct Pair<'a> {
    pub first: &'a str,
    pub second: &'a str,
    pub covariance: f64,
    pub correlation: f64,
}

pub fn covariance<'a>() -> Columns<Pair<'a>> {
    let covariance = "Covariance, in the product of both units; NaN where a parameter is held or not determined.";
    Columns::new("covariance", "How the errors of each two parameters go together.")
        .text("first", "Name of a parameter.", |row: &Pair<'a>| row.first)
        .key()
        .text("second", "Name of another one, or the same.", |row| row.second)
        .key()
        .shown("covariance", "", covariance, |row| finite(row.covariance))
        .but(|column| column.tolerance(0.0, 1e-3).allows_nan())
        .shown("correlation", "", "Covariance over both standard deviations.", |row| finite(row.correlation))
        .but(|column| column.tolerance(1e-4, 1e-3).allows_nan())
}

/// A number that is to be met.
pub struct ResidualRow<'a> {
    pub number: usize,
    pub row: usize,
    pub goal: &'a Goal,
    pub found: f64,
}

impl ResidualRow<'_> {
    fn wanted(&self) -> f64 {
        self.goal.targets[self.row - 1].stated.number
    }

    fn tolerance(&self) -> f64 {
        self.goal.targets[self.row - 1].tolerance
    }

    fn in_tolerances(&self) -> f64 {
        (self.found - self.wanted()) / self.tolerance()
    }
}

pub fn residuals<'a>() -> Columns<ResidualRow<'a>> {
    Columns::new("residuals", "What is to be met and what is found at the best solution, each in its own unit.")
        .integer("number", "Counts what is to be met, in the order of the study.", |row: &ResidualRow<'a>| row.number)
        .key()
        .integer("row", "Counts the rows of its cell.", |row| row.row)
        .key()
        .text("label", "What it is, in words.", |row| row.goal.label())
        .text("where", "Where the paper says it.", |row| row.goal.location.as_str())
        .text("cell", "The cell or formula.", |row| row.goal.text())
        .text("unit", "Unit of wanted, found, residual and tolerance.", |row| {
            row.goal.targets[row.row - 1].stated.unit.as_str()
        })
        .shown("wanted", "", "The published value.", ResidualRow::wanted)
        .shown("found", "", "The value at the best solution.", |row| row.found)
        .but(loose)
        .shown("residual", "", "Found − wanted.", |row| row.found - row.wanted())
        .but(|column| column.tolerance(1e-9, 1e-3))
        .shown("tolerance", "", "How far apart counts as equal.", ResidualRow::tolerance)
        .shown("in_tolerances", "", "Residual over tolerance: what is squared and summed.", ResidualRow::in_tolerances)
        .but(|column| column.tolerance(1e-3, 1e-3))
        .flag("within", "Whether the residual is within the tolerance.", |row| row.in_tolerances().abs() <= 1.0 + 1e-9)
}

/// An end of searches.
pub struct SolutionRow<'a> {
    pub number: usize,
    pub solution: &'a Solution,
    /// Of all columns that are varied, those that follow as well, in their units.
    pub values: Vec<f64>,
    /// Of the parameters alone, in their units.
    pub deviations: Vec<f64>,
    /// Why values beyond it are refused; empty where none of them ended the search.
    pub edge: String,
}

/// `columns` are names, units and paths of all that is varied; of which `parameters` have standard deviations.
pub fn solutions<'a>(columns: &[(String, String, String)], parameters: &[Parameter]) -> Columns<SolutionRow<'a>> {
    let description = "Where searches ended, the best first: solutions, and what else is least among its neighbours.";
    let meets = "Whether all residuals are within their tolerances.";
    let settled = "Whether the sum of squares is least among valid values nearby; otherwise the steps ran out, or values that are \
                   refused stopped the search.";
    let edge =
        "Why values beyond it are refused, where it lies at the edge of the valid ones; empty where it does not.";
    let all = Columns::new("solutions", description)
        .integer("solution", "Counts them, from 1.", |row: &SolutionRow<'a>| row.number)
        .key();
    let all = columns.iter().enumerate().fold(all, |all, (at, (name, unit, path))| {
        all.shown(name, unit, &format!("Value of `{path}`."), move |row| row.values[at]).but(loose)
    });
    let all = parameters.iter().enumerate().fold(all, |all, (at, parameter)| {
        let description = format!("Standard deviation of `{}`, as in the table `parameters`.", parameter.name);
        all.shown(&deviation_name(&parameter.name), &parameter.unit, &description, move |row| {
            finite(row.deviations[at])
        })
        .but(|column| column.tolerance(0.0, 1e-3).allows_nan())
    });
    all.shown("sum_of_squares", "", "Sum of the squared residuals, in tolerances.", |row| {
        row.solution.fit.sum_of_squares
    })
    .but(|column| column.tolerance(1e-6, 1e-3))
    .shown("largest", "", "The largest residual, in tolerances.", |row| row.solution.largest())
    .but(|column| column.tolerance(1e-3, 1e-3))
    .flag("meets", meets, |row| row.solution.meets())
    .integer("starts", "How many starts led to it.", |row| row.solution.starts)
    .integer("steps", "Steps from the start that came lowest.", |row| row.solution.fit.steps)
    .flag("settled", settled, |row| row.solution.is_settled())
    .text("edge", edge, |row| row.edge.clone())
}

/// What came of the fit.
pub struct Summary {
    pub said: String,
    pub solutions: usize,
    pub sum_of_squares: f64,
    pub residuals: usize,
    pub free: usize,
    pub freedom: usize,
    pub scatter: f64,
    pub rank: usize,
    pub condition: f64,
    pub flat: String,
    pub starts: usize,
    pub without: usize,
    pub evaluations: usize,
}

pub fn summary() -> Columns<Summary> {
    let scatter = "Root of the sum of squares over the degrees of freedom, in tolerances; NaN without any.";
    let condition = "Of the derivatives, columns scaled to one length: how much of a residual's digits a parameter can lose; NaN \
                     where a direction is not determined.";
    let flat = "A direction in which nothing that is met changes: changes of the parameters that make up for each other; empty \
                where there is none.";
    Columns::new("summary", "What came of the fit.")
        .text("said", "It in words.", |row: &Summary| row.said.clone())
        .integer("solutions", "How many different solutions meet all that is to be met.", |row| row.solutions)
        .shown("sum_of_squares", "", "Least sum of the squared residuals, in tolerances.", |row| row.sum_of_squares)
        .but(|column| column.tolerance(1e-6, 1e-3))
        .integer("residuals", "Numbers that are to be met.", |row| row.residuals)
        .integer("free", "Parameters that no bound holds.", |row| row.free)
        .integer("degrees_of_freedom", "Residuals beyond these.", |row| row.freedom)
        .shown("scatter", "", scatter, |row| row.scatter)
        .but(|column| column.tolerance(1e-6, 1e-3).allows_nan())
        .integer("rank", "Directions of these parameters that the residuals determine.", |row| row.rank)
        .shown("condition", "", condition, |row| finite(row.condition))
        .but(|column| column.tolerance(0.0, 1e-2).allows_nan())
        .text("flat", flat, |row| row.flat.clone())
        .integer("starts", "Points from which was searched.", |row| row.starts)
        .integer("starts_without_numbers", "Those of them at which the stage has no numbers.", |row| row.without)
        .integer("evaluations", "Points at which the stage was asked.", |row| row.evaluations)
}

fn finite(value: f64) -> f64 {
    studygraph::table::columns::finite(value)
}
