//! `kind: fit`: what fields of the study must be so that cells of a stage meet published values.
//!
//! Least squares within bounds, from several starts, so that several solutions, none, or directions that nothing determines are
//! found and said. The stage and what it reads are computed anew at each point, as a sweep does it. Must not know: how any
//! stage computes.

mod goal;
mod parameters;
mod search;
mod tables;
mod words;

use self::goal::{Goal, Met, Schemas};
use self::parameters::{Parameter, own_values, parameters};
use self::search::{Found, Solution};
use self::tables::{ParameterRow, ResidualRow, SolutionRow, Summary};
use crate::stage::rows::chain;
use crate::stage::rows::followed::Followed;
use crate::stage::rows::points::{Memory, Points};
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Named, Port, RowCount, Stage};
use declare::Declared;
use declare::declared::Declared;
use declare::error::{Diagnostic, Failure, Faults};
use declare::record::Record;
use declare::record::varied::Varied;
use declare::units::showing;
use gearmesh::optimize::least_squares::Answers;
use gearmesh::optimize::least_squares::uncertainty::{Uncertainty, digits};
use studygraph::table::data::{Table, TableError};
use studygraph::table::schema::Schema;

pub const KIND: Kind = Kind {
    name: "fit",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[],
    example: "
kind: fit
of: stiffness
vary:
  bore: { field: geometry.pinion.bore_radius, from: 8 mm, to: 20 mm }
  bore_of_gear: { field: geometry.gear.bore_radius, follows: 2.75 * bore }
meet:
  - { label: Largest stiffness of one pair, cell: stiffness.summary.single_max, value: 2.738e8 N/m }
",
    build,
};

/// What fields must be so that cells of a stage meet published values: least squares within bounds, and how well it is determined.
#[derive(Debug, Declared)]
struct Stated {
    /// The stage whose cells are met, or those of stages between it and what is varied; all else is as in the study.
    #[declared(kinds = ["geometry", "modification", "stiffness", "ste", "rating"])]
    pub of: String,
    /// Names of parameters, and the fields that they are with their bounds, or so far to either side of the value in the study; a
    /// field can follow from the other parameters.
    #[declared(varies = Stated::NAMES.of)]
    pub vary: Varied,
    /// What is to be met.
    pub meet: Vec<Met>,
    /// From how many points is searched: the values of the study, where they are within the bounds, and others from the seed.
    #[declared(minimum = 1, maximum = 1000, default = "4")]
    pub starts: usize,
    /// Steps from each of them, at most.
    #[declared(minimum = 1, maximum = 10_000, default = "50")]
    pub steps: usize,
}

/// Steps that a start takes, about.
const STEPS_OF_START: usize = 5;

/// A fit.
struct Fitting {
    of: String,
    /// Of the stages that are computed anew.
    names: Vec<String>,
    points: Points,
    followed: Followed,
    parameters: Vec<Parameter>,
    goals: Vec<Goal>,
    /// The values of the study in SI, where they are within the bounds.
    own: Option<Vec<f64>>,
    starts: usize,
    steps: usize,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let stated = Stated::checked(record)?;
    let nothing = |field: &str| Err(Diagnostic::new(format!("`{field}` is empty")).at(record.place_of(field)).into());
    if stated.vary.axes.is_empty() {
        return nothing(Stated::NAMES.vary);
    }
    if stated.meet.is_empty() {
        return nothing(Stated::NAMES.meet);
    }
    let stages = stated.vary.stages.iter();
    let stages: Vec<Schemas> = stages
        .map(|stage| Ok((stage.name.clone(), chain::built(stage)?.outputs())))
        .collect::<Result<_, Diagnostic>>()?;
    let goals = stated.meet.iter().zip(record.each_inside(Stated::NAMES.meet));
    let goals = Faults::collect(goals.map(|(met, record)| Goal::read(met, record, &stages)))?;
    let parameters = parameters(&stated.vary.axes)?;
    let followed = Followed::new(&stated.vary.axes)?;
    let values: usize = goals.iter().map(|goal| goal.targets.len()).sum();
    // Whether intervals hold what meets a value is asked of any number of them.
    let are_intervals = parameters.iter().all(|parameter| parameter.is_interval);
    if values < parameters.len() && !are_intervals {
        let (few, many) = (words::count(values, "value"), words::count(parameters.len(), "parameter"));
        return Err(Diagnostic::new(format!("{few} cannot determine {many}"))
            .at(record.place_of(Stated::NAMES.meet))
            .help("meet more values, or vary fewer fields")
            .into());
    }
    let demand = |stage: &Schemas| {
        let mut demand = Demand::default();
        for goal in &goals {
            goal.ask(stage, &mut demand);
        }
        demand
    };
    let points = Points::new(&stated.vary, stages.iter().map(demand).collect())?;
    let names = stages.into_iter().map(|(name, _)| name).collect();
    let own = own_values(&stated.vary, &parameters);
    let (starts, steps) = (stated.starts, stated.steps);
    Ok(Box::new(Fitting { of: stated.of, names, points, followed, parameters, goals, own, starts, steps }))
}

impl Fitting {
    /// The numbers that are to be met at points of the parameters, in the units of their targets.
    fn found(
        &self,
        points: &[Vec<f64>],
        memory: &mut Memory,
        (context, inputs): (&Context, &Inputs),
    ) -> Result<Vec<Result<Vec<f64>, Diagnostic>>, Failure> {
        let all: Vec<Result<Vec<f64>, String>> = points.iter().map(|point| self.followed.values(point)).collect();
        let there: Vec<Vec<f64>> = all.iter().filter_map(|values| values.as_ref().ok()).cloned().collect();
        let mut tables = self.points.tables(&there, memory, (context, inputs))?.into_iter();
        let one = |values: Result<Vec<f64>, String>| {
            values.map_err(Diagnostic::new)?;
            let found = tables.next().unwrap_or_else(|| Err(String::new())).map_err(Diagnostic::new)?;
            let mut own = Inputs::default();
            for (name, tables) in self.names.iter().zip(&found) {
                own.ports.insert(name.clone(), tables.iter().collect());
            }
            let numbers: Vec<Vec<f64>> = self.goals.iter().map(|goal| goal.found(&own)).collect::<Result<_, _>>()?;
            Ok(numbers.concat())
        };
        Ok(all.into_iter().map(one).collect())
    }

    /// Each in tolerances.
    fn residuals(&self, found: &[f64]) -> Vec<f64> {
        let targets = self.goals.iter().flat_map(|goal| &goal.targets);
        found.iter().zip(targets).map(|(found, target)| (found - target.stated.number) / target.tolerance).collect()
    }

    /// Names, units and paths of all that is varied.
    fn columns(&self) -> Vec<(String, String, String)> {
        self.followed.axes().iter().map(|axis| (axis.name.clone(), axis.unit.clone(), axis.path.clone())).collect()
    }

    fn shown(&self, deviations: Vec<f64>) -> Vec<f64> {
        let shown = self.parameters.iter().zip(deviations);
        shown
            .map(|(parameter, deviation)| if deviation.is_finite() { parameter.shown(deviation) } else { deviation })
            .collect()
    }

    /// By solution, why values beyond it are refused.
    fn edges(&self, found: &Found, given: (&Context, &Inputs)) -> Result<Vec<String>, Failure> {
        let mut memory = Memory::default();
        let one = |solution: &Solution| {
            let Some(beyond) = &solution.fit.beyond else { return Ok(String::new()) };
            let answers = self.found(std::slice::from_ref(beyond), &mut memory, given)?;
            Ok(answers.into_iter().find_map(Result::err).map_or_else(String::new, |refused| refused.message))
        };
        found.solutions.iter().map(one).collect()
    }

    fn solution_row<'a>(&self, number: usize, solution: &'a Solution, edge: &str) -> SolutionRow<'a> {
        let axes = self.followed.axes();
        let values = self.followed.values(&solution.fit.point).unwrap_or_else(|_| vec![f64::NAN; axes.len()]);
        let values = axes.iter().zip(values).map(|(axis, si)| showing(&axis.unit)(si)).collect();
        let deviations = self.shown(solution.deviations(&Uncertainty::of(&solution.fit)));
        SolutionRow { number, solution, values, deviations, edge: edge.to_owned() }
    }

    fn parameter_rows(&self, best: &Solution, uncertainty: &Uncertainty) -> Vec<ParameterRow<'_>> {
        let deviations = self.shown(best.deviations(uncertainty));
        let one = |(at, (parameter, deviation)): (usize, (&'_ Parameter, f64))| {
            let value = parameter.shown(best.fit.point[at]);
            (at, value, deviation, digits(value, deviation))
        };
        let rows = self.parameters.iter().zip(deviations).enumerate().map(one);
        rows.map(|(at, value, deviation, digits)| ParameterRow {
            parameter: &self.parameters[at],
            value,
            deviation,
            reach: best.reach(),
            digits,
            is_held: best.fit.is_held[at],
        })
        .collect()
    }

    fn pairs(&self, best: &Solution, uncertainty: &Uncertainty) -> Vec<tables::Pair<'_>> {
        let spread = best.scatter().max(1.0);
        let count = self.parameters.len();
        let both = (0..count).flat_map(|one| (0..count).map(move |two| (one, two)));
        let pair = |(one, two): (usize, usize)| {
            let scale = |at: usize| self.parameters[at].shown(1.0) - self.parameters[at].shown(0.0);
            let covariance = uncertainty.covariance[one][two] * spread * spread * scale(one) * scale(two);
            let (first, second) = (&*self.parameters[one].name, &*self.parameters[two].name);
            tables::Pair { first, second, covariance, correlation: uncertainty.correlation(one, two) }
        };
        both.map(pair).collect()
    }

    fn residual_rows(&self, best: &Solution) -> Vec<ResidualRow<'_>> {
        let mut residuals = best.fit.residuals.iter();
        let mut rows = Vec::new();
        for (number, goal) in self.goals.iter().enumerate() {
            for (row, target) in goal.targets.iter().enumerate() {
                let residual = residuals.next().copied().unwrap_or(f64::NAN);
                let found = target.stated.number + residual * target.tolerance;
                rows.push(ResidualRow { number: number + 1, row: row + 1, goal, found });
            }
        }
        rows
    }

    fn search(&self, context: &Context, inputs: &Inputs) -> Result<(Found, usize), Failure> {
        let bounds: Vec<(f64, f64)> = self.parameters.iter().map(|parameter| parameter.bounds).collect();
        let starts = search::starts(self.own.clone(), &bounds, self.starts, &context.seed);
        let (mut memory, mut evaluations) = (Memory::default(), 0);
        let mut reason: Option<Diagnostic> = None;
        let mut evaluate = |points: &[Vec<f64>]| -> Result<Answers, Failure> {
            evaluations += points.len();
            let found = self.found(points, &mut memory, (context, inputs))?;
            let one = |found: Result<Vec<f64>, Diagnostic>| match found {
                Ok(found) => Some(self.residuals(&found)),
                Err(wrong) => {
                    reason.get_or_insert(wrong);
                    None
                }
            };
            Ok(found.into_iter().map(one).collect())
        };
        let found = search::from_all((&bounds, self.steps), &starts, &mut evaluate, context.progress)?;
        if found.solutions.is_empty() {
            // A mistake of the study's text has its place; what a stage cannot do has none.
            return Err(match reason {
                Some(wrong) if wrong.place.is_some() => Faults::from(wrong).into(),
                Some(wrong) => {
                    let starts = words::count(self.starts, "start");
                    Failure::new(format!(
                        "`{}` has no numbers at any of {starts}, for example: {}",
                        self.of, wrong.message
                    ))
                }
                None => Failure::new("there is nothing to be met"),
            });
        }
        Ok((found, evaluations))
    }
}

impl Stage for Fitting {
    fn inputs(&self) -> Vec<Port> {
        self.points.ports().to_vec()
    }

    fn named(&self) -> Vec<Named> {
        self.goals.iter().flat_map(Goal::named).collect()
    }

    fn outputs(&self) -> Vec<Schema> {
        vec![
            tables::summary().schema(),
            tables::parameters().schema(),
            tables::covariance().schema(),
            tables::residuals().schema(),
            tables::solutions(&self.columns(), &self.parameters).schema(),
        ]
    }

    fn uses_seed(&self) -> bool {
        self.starts > 1 || self.own.is_none() || self.points.uses_seed()
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let count = self.parameters.len();
        let values: usize = self.goals.iter().map(|goal| goal.targets.len()).sum();
        let each = 2 * count + 1;
        let points = 7 + self.starts * STEPS_OF_START * each;
        Estimate::new(true)
            .taking(points as f64 * self.points.seconds())
            .rows(demand, tables::summary().schema(), RowCount::exact(1))
            .rows(demand, tables::parameters().schema(), RowCount::exact(count))
            .rows(demand, tables::covariance().schema(), RowCount::exact(count * count))
            .rows(demand, tables::residuals().schema(), RowCount::exact(values))
            .rows(demand, tables::solutions(&self.columns(), &self.parameters).schema(), RowCount::at_most(self.starts))
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let (found, evaluations) = self.search(context, inputs)?;
        let best = &found.solutions[0];
        let uncertainty = Uncertainty::of(&best.fit);
        let flat = words::flat(&self.parameters, &uncertainty);
        let rows = self.parameter_rows(best, &uncertainty);
        // More intervals than values are not meant to be determined.
        let is_open = best.fit.residuals.len() < self.parameters.len();
        let edges = self.edges(&found, (context, inputs))?;
        let said = words::said(&found, &rows, if is_open { "" } else { &flat }, &edges[0]);
        if said.is_warning {
            (context.warn)(said.text.clone().into());
        }
        if context.is_heard
            && let Ok(values) = self.followed.values(&best.fit.point)
            && let Some(warning) = self.points.warning_of_corners(&values, (context, inputs))
        {
            (context.warn)(warning);
        }
        let summary = Summary {
            said: said.text,
            solutions: found.meeting(),
            sum_of_squares: best.fit.sum_of_squares,
            residuals: best.fit.residuals.len(),
            free: uncertainty.free,
            freedom: best.fit.freedom(),
            scatter: best.scatter(),
            rank: uncertainty.rank,
            condition: uncertainty.condition,
            flat,
            starts: self.starts,
            without: found.without,
            evaluations,
        };
        let solutions = (1..).zip(found.solutions.iter().zip(&edges));
        let solutions: Vec<SolutionRow> =
            solutions.map(|(number, (solution, edge))| self.solution_row(number, solution, edge)).collect();
        let made: Vec<Result<Table, TableError>> = vec![
            tables::summary().table(&[summary]),
            tables::parameters().table(&rows),
            tables::covariance().table(&self.pairs(best, &uncertainty)),
            tables::residuals().table(&self.residual_rows(best)),
            tables::solutions(&self.columns(), &self.parameters).table(&solutions),
        ];
        let made = made.into_iter().collect::<Result<Vec<_>, _>>().map_err(|error| Failure::new(error.to_string()))?;
        Ok(made.into_iter().filter(|table| context.demand.table(table.name())).collect())
    }
}
