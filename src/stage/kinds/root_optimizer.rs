//! `kind: root_optimizer`: the root of one gear of a pair, found by any method of the optimisers under constraints.
//!
//! What is free, what is to be small and what must be kept, a registered problem says. Constraints are given to the
//! method in modules. Must not know: how any method searches, what any problem computes.

use rayon::prelude::*;

use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Port, RowCount, Stage, pair};
use declare::declared::Declared;
use declare::error::{Diagnostic, Failure, Faults};
use declare::record::Record;
use declare::seed::Seed;
use declare::units::LENGTH;
use declare::{Declared, Words};
use gearmesh::gear::geometry::{Gear, Side};
use gearmesh::gear::problem::{self, Problem, Variable, Worth};
use gearmesh::optimize::bounds::Bounds;
use gearmesh::optimize::constraints::{Evaluation, KEPT};
use gearmesh::optimize::search::{Candidate, Reason};
use gearmesh::optimize::{self, Method};
use studygraph::table::columns::{Columns, finite};
use studygraph::table::data::{Table, TableError};
use studygraph::table::schema::Schema;

pub const KIND: Kind = Kind {
    name: "root_optimizer",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[],
    example: "
kind: root_optimizer
pair: geometry
gear: pinion
problem: { fillet: { root: arc, minimize: stress, elements_across: 6 } }
method: { powell: { tolerance: 1e-2, evaluations: 40 } }
",
    build,
};

/// The root of one gear that is best by some measure, by a search under constraints.
#[derive(Debug, Declared)]
struct Stated {
    /// The pair.
    #[declared(kinds = ["geometry"])]
    pub pair: String,
    /// Whose root it is.
    #[declared(default = "pinion")]
    pub gear: Which,
    /// What is free, what is to be small, what is kept.
    pub problem: Box<dyn problem::Stated>,
    /// How to search.
    #[declared(default = "powell")]
    pub method: Box<dyn Method>,
}

/// Which of the two gears.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
enum Which {
    /// the pinion
    Pinion,
    /// the mating gear
    Gear,
}

struct RootOptimizer {
    stated: Stated,
    /// Where the settings of the method stand.
    how: Record,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let how = record.inside(Stated::NAMES.method).clone();
    Ok(Box::new(RootOptimizer { stated: Stated::checked(record)?, how }))
}

/// A constraint, what is left of it, and whether it is kept.
type ConstraintRow<'a> = (&'a str, f64, bool);

fn constraints<'a>() -> Columns<ConstraintRow<'a>> {
    Columns::new("constraints", "What the root that was found leaves of each constraint.")
        .text("constraint", "What is to be kept.", |row: &ConstraintRow<'a>| row.0)
        .key()
        .float("reserve", "mm", "How much is left; negative where it is broken.", |row| row.1)
        .but(|column| column.tolerance(1e-6, 1e-3))
        .flag("kept", "Whether it is kept, to within 1e-7 modules.", |row| row.2)
}

/// What was free, and its value.
type VariableRow<'a> = (&'a Variable, f64);

fn variables<'a>() -> Columns<VariableRow<'a>> {
    Columns::new("variables", "The root that was found.")
        .text("variable", "What was free.", |row: &VariableRow| row.0.name)
        .key()
        .float("value", "mm", "Its value.", |row| row.1)
        .but(|column| column.tolerance(1e-6, 1e-3))
        .float("least", "mm", "The least that was allowed.", |row| row.0.minimum)
        .float("most", "mm", "The most that was allowed.", |row| row.0.maximum)
}

/// How a search ended.
struct BestRow<'a> {
    side: Side,
    best: &'a Candidate,
    evaluations: usize,
    reason: Reason,
}

/// A free value of a root that was tried, and what that root is worth.
struct TriedRow<'a> {
    /// Of the root, from 1.
    number: usize,
    variable: &'static str,
    value: f64,
    worth: &'a Worth,
}

impl TriedRow<'_> {
    fn least_reserve(&self) -> f64 {
        self.worth.constraints.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

impl RootOptimizer {
    fn side(&self) -> Side {
        match self.stated.gear {
            Which::Pinion => Side::Pinion,
            Which::Gear => Side::Gear,
        }
    }

    fn unit(&self) -> &'static str {
        if self.stated.problem.dimension() == LENGTH { "mm" } else { "" }
    }

    fn best<'a>(&self) -> Columns<BestRow<'a>> {
        let violation = "Sum of what is broken of the constraints, in modules; 0 where all are kept.";
        Columns::new("best", "How the search ended.")
            .text("gear", "Whose root it is.", |row: &BestRow| row.side.name())
            .key()
            .float("objective", self.unit(), "What was made small.", |row| row.best.value)
            .but(|column| column.tolerance(1e-6, 1e-3))
            .float("violation", "", violation, |row| row.best.violation)
            .but(|column| column.tolerance(1e-6, 1e-3))
            .integer("evaluations", "How often the objective was computed.", |row| row.evaluations)
            .text("ended", "Why the search ended.", |row| row.reason.to_string())
    }

    fn evaluations<'a>(&self) -> Columns<TriedRow<'a>> {
        let objective = "What is made small; NaN where there is no such root.";
        let reserve = "The least that a constraint leaves; NaN where there is no such root.";
        Columns::new("evaluations", "Every root that was tried, in the order of the search.")
            .integer("evaluation", "Number, from 1.", |row: &TriedRow| row.number)
            .key()
            .text("variable", "What was free.", |row| row.variable)
            .key()
            .float("value", "mm", "Its value.", |row| row.value)
            .float("objective", self.unit(), objective, |row| finite(row.worth.objective))
            .but(|column| column.allows_nan().tolerance(1e-9, 1e-6))
            .float("least_reserve", "mm", reserve, |row| finite(row.least_reserve()))
            .but(|column| column.allows_nan().tolerance(1e-9, 1e-6))
            .on_demand()
    }

    fn tables(
        &self,
        problem: &dyn Problem,
        best: &Candidate,
        reason: Reason,
        tried: &[(Vec<f64>, Worth)],
        gear: &Gear,
    ) -> Result<Vec<Table>, TableError> {
        let free = problem.variables();
        let worth = problem.worth(&best.point);
        let kept = |reserve: f64| reserve >= -KEPT * gear.specification.module;
        let names = problem.constraints();
        let reserves = names.iter().zip(&worth.constraints);
        let reserves: Vec<_> = reserves.map(|(name, reserve)| (*name, *reserve, kept(*reserve))).collect();
        let found: Vec<_> = free.iter().zip(best.point.iter().copied()).collect();
        let mut roots = Vec::new();
        for (number, (point, worth)) in (1..).zip(tried) {
            let values = free.iter().zip(point);
            roots.extend(values.map(|(variable, &value)| TriedRow { number, variable: variable.name, value, worth }));
        }
        Ok(vec![
            self.best().table(&[BestRow { side: self.side(), best, evaluations: tried.len(), reason }])?,
            variables().table(&found)?,
            constraints().table(&reserves)?,
            self.evaluations().table(&roots)?,
        ])
    }

    fn search(&self, variables: &[Variable], seed: Seed) -> Result<optimize::search::Optimizer, Diagnostic> {
        let bounds = variables.iter().map(|variable| (variable.minimum, variable.maximum)).collect();
        optimize::search(&*self.stated.method, Bounds::new(bounds)?, seed).map_err(|wrong| self.how.locate(wrong))
    }
}

impl Stage for RootOptimizer {
    fn inputs(&self) -> Vec<Port> {
        vec![pair::port(&self.stated.pair)]
    }

    fn outputs(&self) -> Vec<Schema> {
        vec![self.best().schema(), variables().schema(), constraints().schema(), self.evaluations().schema()]
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let [free, kept] = self.stated.problem.maximum();
        let Ok(foreseen) = self.stated.method.foresee(free) else {
            return Estimate::new(true);
        };
        let held = (foreseen.evaluations as u64).saturating_mul(120);
        let tried = RowCount::at_most(foreseen.evaluations.saturating_mul(free));
        Estimate::new(true)
            .taking(self.stated.problem.seconds() * foreseen.evaluations as f64)
            .holding((foreseen.memory as u64).saturating_add(held))
            .rows(demand, self.best().schema(), RowCount::exact(1))
            .rows(demand, variables().schema(), RowCount::at_most(free))
            .rows(demand, constraints().schema(), RowCount::at_most(kept))
            .rows(demand, self.evaluations().schema(), tried)
    }

    fn uses_seed(&self) -> bool {
        true
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let pair = pair::of(inputs)?;
        let problem = self.stated.problem.on(&pair, self.side()).map_err(|error| Failure::new(error.to_string()))?;
        let module = pair.side(self.side()).specification.module;
        let mut search =
            self.search(&problem.variables(), context.seed).map_err(|error| Failure::new(error.message))?;
        let budget = search.budget().max(1) as f64;
        let mut tried: Vec<(Vec<f64>, Worth)> = Vec::new();
        let reason = search.run_constrained(|points| -> Result<Vec<Evaluation>, Failure> {
            context.check_stop()?;
            let worths: Vec<Worth> = points.par_iter().map(|point| problem.worth(point)).collect();
            let told = worths.iter().map(|worth| Evaluation {
                value: worth.objective,
                constraints: worth.constraints.iter().map(|reserve| reserve / module).collect(),
                ..Evaluation::default()
            });
            let told = told.collect();
            tried.extend(points.iter().cloned().zip(worths));
            (context.progress)(tried.len() as f64 / budget);
            Ok(told)
        })?;
        if let Some(doubt) = search.doubt() {
            (context.warn)(doubt.to_owned().into());
        }
        let best = search.best().ok_or_else(|| Failure::new("none of the roots that were tried can be built"))?;
        if best.violation > 0.0 {
            (context.warn)(
                format!(
                    "no root that was tried keeps the constraints; the one given breaks them by {:.3e} modules in all",
                    best.violation
                )
                .into(),
            );
        }
        let mut tables = self
            .tables(problem.as_ref(), best, reason, &tried, pair.side(self.side()))
            .map_err(|error: TableError| Failure::new(error.to_string()))?;
        tables.retain(|table| context.demand.table(table.name()));
        Ok(tables)
    }
}
