//! `kind: sizing`: the main dimensions of a gear pair and of what carries it, by any method of the optimisers.
//!
//! What is free, what is to be small and what must be kept, a registered problem says; with several objectives there is a
//! front. Must not know: how any method searches, what any problem computes.

use crate::stage::quantity::read;
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Port, RowCount, Stage};
use declare::Declared;
use declare::declared::{Declared, Placed};
use declare::error::{Diagnostic, Failure, Faults};
use declare::record::Record;
use declare::seed::Seed;
use declare::units::{Dimension, LENGTH, VOLUME, described};
use gearmesh::gear::problem::{Problem, Variable, Worth};
use gearmesh::gear::sizing::{self, Objective};
use gearmesh::optimize::bounds::Bounds;
use gearmesh::optimize::constraints::{Evaluation, KEPT};
use gearmesh::optimize::hypervolume::hypervolume;
use gearmesh::optimize::pareto::{Member, balanced};
use gearmesh::optimize::search::Reason;
use gearmesh::optimize::{self, Method};
use studygraph::table::columns::Columns;
use studygraph::table::data::{Table, TableError};
use studygraph::table::schema::Schema;

pub const KIND: Kind = Kind {
    name: "sizing",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[],
    example: "
kind: sizing
problem: { speed_reducer: { minimize: [volume, stress] } }
method: { nsga2: { population: 40, generations: 40 } }
reference: [6000 cm^3, 1300]
",
    build,
};

/// Main dimensions of a gear pair and its shafts that make one number or several small, by a search under constraints.
#[derive(Debug, Declared)]
struct Stated {
    /// What is free, what is to be small, what is kept.
    pub problem: Box<dyn sizing::Sizing>,
    /// How to search; several objectives take `nsga2` or a sample.
    #[declared(default = "powell")]
    pub method: Box<dyn Method>,
    /// Points of the front that are kept, with several objectives.
    #[declared(minimum = 2, maximum = 10_000, default = "100")]
    pub front_points: usize,
    /// With several objectives: a value of each, in their order, above which nothing counts for the hypervolume.
    #[declared(example = "[6000 cm^3, 1300]")]
    pub reference: Option<Vec<Placed<String>>>,
}

struct Sizing {
    stated: Stated,
    problem: Box<dyn Problem>,
    objectives: Vec<Objective>,
    /// In SI, one for each objective; empty without.
    reference: Vec<f64>,
}

/// A point of the box that was found.
struct Point {
    objectives: Vec<f64>,
    at: Vec<f64>,
}

/// What a search came to.
struct Found {
    best: Point,
    hypervolume: f64,
    evaluations: usize,
    reason: Reason,
}

/// A name that makes a row its own, or a constraint, and numbers.
type Named<T> = (String, T);

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let stated = Stated::checked(record)?;
    let (problem, objectives) = (stated.problem.problem(), stated.problem.objectives());
    let wrong = |field: &str, message: String| Diagnostic::new(message).at(record.place_of(field));
    let is_new = |at: &usize| !objectives[..*at].contains(&objectives[*at]);
    if objectives.is_empty() || !(0..objectives.len()).all(|at| is_new(&at)) {
        return Err(wrong(Stated::NAMES.problem, "one objective or several are needed, each once".to_owned()).into());
    }
    if objectives.len() > 1 && !stated.method.finds_fronts() {
        let message = format!("`{}` takes one objective, and there are {}", stated.method.name(), objectives.len());
        return Err(wrong(Stated::NAMES.method, message)
            .help("take `nsga2`, or a sample: `grid`, `latin_hypercube` or `sobol`")
            .into());
    }
    let method = record.inside(Stated::NAMES.method);
    stated.method.foresee(problem.variables().len()).map_err(|wrong| method.locate(wrong))?;
    let given = stated.reference.as_deref().unwrap_or_default();
    if stated.reference.is_some() && (objectives.len() == 1 || given.len() != objectives.len()) {
        let message = format!("values: {}, objectives: {}", given.len(), objectives.len());
        return Err(wrong(Stated::NAMES.reference, message)
            .help("a hypervolume is that of a front: give a value for each of several objectives")
            .into());
    }
    let reference =
        given.iter().zip(&objectives).map(|(text, of)| limit(text, *of)).collect::<Result<Vec<f64>, Diagnostic>>()?;
    Ok(Box::new(Sizing { stated, problem, objectives, reference }))
}

fn limit(text: &Placed<String>, objective: Objective) -> Result<f64, Diagnostic> {
    let wrong =
        |why: String| Diagnostic::new(format!("`{}` of `{}`: {why}", text.value, objective.name)).at(text.place);
    let quantity = read(&text.value).map_err(wrong)?;
    if quantity.dimension != objective.dimension || quantity.value <= 0.0 {
        return Err(wrong(format!("it must be {} above 0", described(objective.dimension))));
    }
    Ok(quantity.value)
}

fn unit(dimension: Dimension) -> &'static str {
    match dimension {
        LENGTH => "mm",
        VOLUME => "cm^3",
        _ => "",
    }
}

fn constraints() -> Columns<Named<f64>> {
    Columns::new("constraints", "What the dimensions that were found leave of each constraint.")
        .text("constraint", "What is to be kept.", |row: &Named<f64>| row.0.clone())
        .key()
        .float("reserve", "", "How much is left, in shares of the limit; negative where it is broken.", |row| row.1)
        .but(|column| column.tolerance(1e-6, 1e-3))
        .flag("kept", "Whether it is kept, to within 1e-7.", |row| row.1 >= -KEPT)
}

impl Sizing {
    fn has_front(&self) -> bool {
        self.objectives.len() > 1
    }

    /// A column for each objective after the first few, and one for each variable.
    fn numbers<T>(
        &self,
        columns: Columns<T>,
        skipped: usize,
        point: impl Fn(&T) -> &Point + Copy + 'static,
    ) -> Columns<T> {
        let columns = (skipped..self.objectives.len()).fold(columns, |columns, at| {
            let Objective { name, dimension } = self.objectives[at];
            columns
                .float(name, unit(dimension), "What is made small.", move |row| point(row).objectives[at])
                .but(|column| column.tolerance(1e-9, 1e-6))
        });
        self.problem.variables().into_iter().enumerate().fold(
            columns,
            |columns, (at, Variable { name, dimension, .. })| {
                columns
                    .float(name, unit(dimension), "Value of the variable.", move |row| point(row).at[at])
                    .but(|column| column.tolerance(1e-6, 1e-3))
            },
        )
    }

    fn best(&self) -> Columns<Found> {
        let (first, small) = (unit(self.objectives[0].dimension), "What was made small, the first of several.");
        let columns = Columns::new("best", "How the search ended; of a front its balanced point.")
            .text("design", "Name of what was found.", |_: &Found| "optimum")
            .key()
            .float("objective", first, small, |row| row.best.objectives[0])
            .but(|column| column.tolerance(1e-9, 1e-6))
            .integer("evaluations", "How often the objectives were computed.", |row| row.evaluations)
            .text("ended", "Why the search ended.", |row| row.reason.to_string());
        let columns = self.numbers(columns, 1, |row| &row.best);
        if self.reference.is_empty() {
            return columns;
        }
        let hypervolume = "What the front dominates of the box from 0 to the reference, a share of it.";
        columns.float("hypervolume", "", hypervolume, |row| row.hypervolume).but(|column| column.tolerance(0.0, 1e-6))
    }

    fn front(&self) -> Columns<(usize, Point)> {
        let about =
            "Dimensions that no others beat in every objective, evenly spread, from the smallest first objective on.";
        let columns = Columns::new("front", about)
            .integer("point", "Counts the points, from 1.", |row: &(usize, Point)| row.0)
            .key();
        self.numbers(columns, 0, |row| &row.1)
    }

    fn ends(&self) -> Columns<Named<Vec<f64>>> {
        let columns = Columns::new("ends", "The least and the most of each objective on the front.")
            .text("end", "Ideal: the least of each; nadir: the most.", |row: &Named<Vec<f64>>| row.0.clone())
            .key();
        self.objectives.iter().enumerate().fold(columns, |columns, (at, objective)| {
            columns
                .float(objective.name, unit(objective.dimension), "Of this objective.", move |row| row.1[at])
                .but(|column| column.tolerance(1e-9, 1e-6))
        })
    }

    fn search(&self, seed: Seed) -> Result<optimize::search::Optimizer, Failure> {
        let variables = self.problem.variables();
        let bounds = variables.iter().map(|variable| (variable.minimum, variable.maximum)).collect();
        let search = Bounds::new(bounds).and_then(|bounds| optimize::search(&*self.stated.method, bounds, seed));
        search.map_err(|wrong| Failure::new(wrong.message))
    }

    fn evaluation(&self, point: &[f64]) -> Evaluation {
        let Worth { objective, further, constraints } = self.problem.worth(point);
        Evaluation { value: objective, further, constraints }
    }

    fn point(&self, Member { point, evaluation }: &Member) -> Point {
        Point { objectives: evaluation.objectives().collect(), at: self.problem.resolved(point) }
    }

    fn tables(&self, found: Found, front: &[Member]) -> Result<Vec<Table>, TableError> {
        let reserves = self.problem.worth(&found.best.at).constraints;
        let names = self.problem.constraints().iter().map(|name| (*name).to_owned());
        let mut tables =
            vec![self.best().table(&[found])?, constraints().table(&names.zip(reserves).collect::<Vec<_>>())?];
        if self.has_front() {
            let points: Vec<_> = (1..).zip(front.iter().map(|member| self.point(member))).collect();
            let end = |pick: fn(f64, f64) -> f64| {
                let values = |at| points.iter().map(move |(_, point)| point.objectives[at]).reduce(pick);
                (0..self.objectives.len()).map(|at| values(at).unwrap_or(f64::NAN)).collect()
            };
            let ends = [("ideal".to_owned(), end(f64::min)), ("nadir".to_owned(), end(f64::max))];
            tables.extend([self.front().table(&points)?, self.ends().table(&ends)?]);
        }
        Ok(tables)
    }
}

impl Stage for Sizing {
    fn inputs(&self) -> Vec<Port> {
        Vec::new()
    }

    fn outputs(&self) -> Vec<Schema> {
        let mut schemas = vec![self.best().schema(), constraints().schema()];
        if self.has_front() {
            schemas.extend([self.front().schema(), self.ends().schema()]);
        }
        schemas
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let Ok(foreseen) = self.stated.method.foresee(self.problem.variables().len()) else {
            return Estimate::new(true);
        };
        // A formula takes a microsecond; to compare points on their way to a front takes many.
        let each = if self.has_front() { 1e-4 } else { 1e-5 };
        let estimate = Estimate::new(true)
            .taking(each * foreseen.evaluations as f64)
            .holding(foreseen.memory as u64)
            .rows(demand, self.best().schema(), RowCount::exact(1))
            .rows(demand, constraints().schema(), RowCount::exact(self.problem.constraints().len()));
        if !self.has_front() {
            return estimate;
        }
        estimate.rows(demand, self.front().schema(), RowCount::at_most(self.stated.front_points)).rows(
            demand,
            self.ends().schema(),
            RowCount::exact(2),
        )
    }

    fn uses_seed(&self) -> bool {
        true
    }

    fn run(&self, context: &Context, _inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let mut search = self.search(context.seed)?;
        let (budget, mut evaluations) = (search.budget().max(1) as f64, 0);
        let reason = search.run_constrained(|points| -> Result<Vec<Evaluation>, Failure> {
            context.check_stop()?;
            evaluations += points.len();
            (context.progress)((evaluations as f64 / budget).min(1.0));
            Ok(points.iter().map(|point| self.evaluation(point)).collect())
        })?;
        if let Some(doubt) = search.doubt() {
            (context.warn)(doubt.to_owned().into());
        }
        let best = search.best().ok_or_else(|| Failure::new("no point that was tried has a value"))?;
        if best.violation > 0.0 {
            return Err(Failure::new(format!(
                "no dimensions that were tried keep all constraints; the nearest break them by {:.3e} of their limits in all",
                best.violation
            )));
        }
        let front: Vec<Member> = search.front(self.stated.front_points).into_iter().cloned().collect();
        let at = balanced(&front).map_or(&best.point, |member| &member.point);
        let best = self.point(&Member { point: at.clone(), evaluation: self.evaluation(at) });
        let dominated: Vec<Vec<f64>> = front.iter().map(|member| member.evaluation.objectives().collect()).collect();
        let hypervolume = hypervolume(&dominated, &self.reference) / self.reference.iter().product::<f64>();
        let found = Found { best, hypervolume, evaluations, reason };
        let mut tables = self.tables(found, &front).map_err(|error| Failure::new(error.to_string()))?;
        tables.retain(|table| context.demand.table(table.name()));
        Ok(tables)
    }
}
