//! `kind: root_optimizer`: the root of one gear of a pair, found by any method of the optimisers under constraints.
//!
//! What is free, what is to be small and what must be kept, a registered problem says. Constraints are given to the
//! method in modules. Must not know: how any method searches, what any problem computes.

use rayon::prelude::*;

use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Port, RowCount, Stage, pair};
use declare::error::{Diagnostic, Failure};
use declare::parameter::{Choice, Field, Shape};
use declare::record::Record;
use declare::seed::Seed;
use declare::units::{LENGTH, in_unit};
use gearmesh::gear::geometry::{Gear, Side};
use gearmesh::gear::problem::{self, Problem, Stated, Variable, Worth};
use gearmesh::optimize::bounds::Bounds;
use gearmesh::optimize::constraints::{Evaluation, KEPT};
use gearmesh::optimize::search::{Candidate, Reason};
use gearmesh::optimize::{self, Method};
use studygraph::table::data::{Row, Table, TableError};
use studygraph::table::schema::{Column, Schema};

pub const KIND: Kind = Kind {
    name: "root_optimizer",
    version: 1,
    summary: "The root of one gear that is best by some measure, by a search under constraints.",
    fields: FIELDS,
    example: "
kind: root_optimizer
pair: geometry
gear: pinion
problem: { fillet: { root: arc, minimize: stress, elements_across: 6 } }
method: { powell: { tolerance: 1e-2, evaluations: 40 } }
",
    build,
};

const FIELDS: &[Field] = &[
    Field::reference("pair", &["geometry"], "The pair."),
    Field::choice("gear", GEARS, "Whose root it is.").default("pinion"),
    Field::new("problem", Shape::Member(problem::members), "What is free, what is to be small, what is kept."),
    Field::new("method", Shape::Member(optimize::members), "How to search.").default("powell"),
];

const GEARS: &[Choice] =
    &[Choice { name: "pinion", summary: "the pinion" }, Choice { name: "gear", summary: "the mating gear" }];

struct RootOptimizer {
    pair: String,
    side: Side,
    problem: Box<dyn Stated>,
    method: Box<dyn Method>,
    /// Where its settings stand.
    how: Record,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Diagnostic> {
    let (name, options) = record.member("problem");
    // The decoder lets only registered problems through.
    let (method, how) = record.member("method");
    Ok(Box::new(RootOptimizer {
        pair: record.reference("pair").to_owned(),
        side: if record.choice("gear") == "gear" { Side::Gear } else { Side::Pinion },
        problem: problem::read(name, options)?,
        method: optimize::read(method, how)?,
        how: how.clone(),
    }))
}

fn constraints_schema() -> Schema {
    Schema::new(
        "constraints",
        "What the root that was found leaves of each constraint.",
        vec![
            Column::text("constraint", "What is to be kept.").key(),
            Column::float("reserve", "mm", "How much is left; negative where it is broken.").tolerance(1e-6, 1e-3),
            Column::flag("kept", "Whether it is kept, to within 1e-7 modules."),
        ],
    )
}

fn variables_schema() -> Schema {
    Schema::new(
        "variables",
        "The root that was found.",
        vec![
            Column::text("variable", "What was free.").key(),
            Column::float("value", "mm", "Its value.").tolerance(1e-6, 1e-3),
            Column::float("least", "mm", "The least that was allowed."),
            Column::float("most", "mm", "The most that was allowed."),
        ],
    )
}

impl RootOptimizer {
    fn unit(&self) -> &'static str {
        if self.problem.dimension() == LENGTH { "mm" } else { "" }
    }

    fn best_schema(&self) -> Schema {
        Schema::new(
            "best",
            "How the search ended.",
            vec![
                Column::text("gear", "Whose root it is.").key(),
                Column::float("objective", self.unit(), "What was made small.").tolerance(1e-6, 1e-3),
                Column::float(
                    "violation",
                    "",
                    "Sum of what is broken of the constraints, in modules; 0 where all are kept.",
                )
                .tolerance(1e-6, 1e-3),
                Column::integer("evaluations", "How often the objective was computed."),
                Column::text("ended", "Why the search ended."),
            ],
        )
    }

    fn evaluations_schema(&self) -> Schema {
        Schema::new(
            "evaluations",
            "Every root that was tried, in the order of the search.",
            vec![
                Column::integer("evaluation", "Number, from 1.").key(),
                Column::text("variable", "What was free.").key(),
                Column::float("value", "mm", "Its value."),
                Column::float("objective", self.unit(), "What is made small; NaN where there is no such root.")
                    .allows_nan()
                    .tolerance(1e-9, 1e-6),
                Column::float(
                    "least_reserve",
                    "mm",
                    "The least that a constraint leaves; NaN where there is no such root.",
                )
                .allows_nan()
                .tolerance(1e-9, 1e-6),
            ],
        )
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
        let variables = problem.variables();
        let shown = |value: f64| if self.unit().is_empty() { value } else { in_unit(value, self.unit()) };
        let worth = problem.worth(&best.point);
        let summary: Row = vec![
            self.side.name().into(),
            shown(best.value).into(),
            best.violation.into(),
            tried.len().into(),
            reason.to_string().into(),
        ];
        let kept = |reserve: f64| reserve >= -KEPT * gear.specification.module;
        let constraints = problem.constraints().iter().zip(&worth.constraints);
        let constraints = constraints.map(|(name, reserve)| -> Row {
            vec![(*name).into(), in_unit(*reserve, "mm").into(), kept(*reserve).into()]
        });
        let found = variables.iter().zip(&best.point).map(|(variable, value)| -> Row {
            let lengths = [*value, variable.least, variable.most].map(|length| in_unit(length, "mm").into());
            [variable.name.into()].into_iter().chain(lengths).collect()
        });
        Ok(vec![
            Table::from_rows(self.best_schema(), vec![summary])?,
            Table::from_rows(variables_schema(), found.collect())?,
            Table::from_rows(constraints_schema(), constraints.collect())?,
            Table::from_rows(self.evaluations_schema(), self.tried_rows(&variables, tried))?,
        ])
    }

    fn tried_rows(&self, variables: &[Variable], tried: &[(Vec<f64>, Worth)]) -> Vec<Row> {
        let shown = |value: f64, unit: &str| match unit {
            _ if !value.is_finite() => f64::NAN,
            "" => value,
            unit => in_unit(value, unit),
        };
        let row = |index: usize, variable: &Variable, value: f64, worth: &Worth| -> Row {
            let least = worth.constraints.iter().copied().fold(f64::INFINITY, f64::min);
            vec![
                (index + 1).into(),
                variable.name.into(),
                in_unit(value, "mm").into(),
                shown(worth.objective, self.unit()).into(),
                shown(least, "mm").into(),
            ]
        };
        let of_one = |(index, (point, worth)): (usize, &(Vec<f64>, Worth))| {
            variables.iter().zip(point).map(|(variable, value)| row(index, variable, *value, worth)).collect::<Vec<_>>()
        };
        tried.iter().enumerate().flat_map(of_one).collect()
    }

    fn search(&self, variables: &[Variable], seed: Seed) -> Result<optimize::search::Optimizer, Diagnostic> {
        let bounds = variables.iter().map(|variable| (variable.least, variable.most)).collect();
        optimize::search(&*self.method, Bounds::new(bounds)?, seed).map_err(|wrong| self.how.locate(wrong))
    }
}

impl Stage for RootOptimizer {
    fn inputs(&self) -> Vec<Port> {
        vec![Port::tables("pair", &self.pair, &["gears", "pair"])]
    }

    fn outputs(&self) -> Vec<Schema> {
        vec![self.best_schema(), variables_schema(), constraints_schema(), self.evaluations_schema()]
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let [variables, constraints] = self.problem.most();
        let Ok(foreseen) = self.method.foresee(variables) else {
            return Estimate::new(true);
        };
        let kept = (foreseen.evaluations as u64).saturating_mul(120);
        let tried = RowCount::at_most(foreseen.evaluations.saturating_mul(variables));
        Estimate::new(true)
            .taking(self.problem.seconds() * foreseen.evaluations as f64)
            .holding((foreseen.memory as u64).saturating_add(kept))
            .rows(demand, self.best_schema(), RowCount::exact(1))
            .rows(demand, variables_schema(), RowCount::at_most(variables))
            .rows(demand, constraints_schema(), RowCount::at_most(constraints))
            .rows(demand, self.evaluations_schema(), tried)
    }

    fn uses_seed(&self) -> bool {
        true
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let pair = pair::read(inputs.table("pair", "gears")?, inputs.table("pair", "pair")?)?;
        let problem = self.problem.on(&pair, self.side).map_err(|error| Failure::new(error.to_string()))?;
        let module = pair.side(self.side).specification.module;
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
            });
            let told = told.collect();
            tried.extend(points.iter().cloned().zip(worths));
            (context.progress)(tried.len() as f64 / budget);
            Ok(told)
        })?;
        if let Some(doubt) = search.doubt() {
            (context.warn)(doubt.to_owned());
        }
        let best = search.best().ok_or_else(|| Failure::new("none of the roots that were tried can be built"))?;
        if best.violation > 0.0 {
            (context.warn)(format!(
                "no root that was tried keeps the constraints; the one given breaks them by {:.3e} modules in all",
                best.violation
            ));
        }
        let mut tables = self
            .tables(problem.as_ref(), best, reason, &tried, pair.side(self.side))
            .map_err(|error: TableError| Failure::new(error.to_string()))?;
        tables.retain(|table| context.demand.table(table.name()));
        Ok(tables)
    }
}
