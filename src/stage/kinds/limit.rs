//! `kind: limit`: how far fields of the study can go before a stage refuses them, and why not further.
//!
//! A report reads it as a number of its own: the largest profile shift, the longest relief. The stage and what it reads are
//! computed anew at each value, as a sweep does it. Must not know: how any stage computes, what its reasons mean.

mod search;
mod tables;
#[cfg(test)]
mod tests;

use self::search::{End, Parameter};
use self::tables::{AdmittedRow, LimitRow};
use crate::stage::rows::chain;
use crate::stage::rows::followed::Followed;
use crate::stage::rows::points::{Memory, Points};
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Port, RowCount, Stage};
use declare::Declared;
use declare::declared::Declared;
use declare::error::{Diagnostic, Failure, Faults};
use declare::record::Record;
use declare::record::varied::{Axis, Values, Varied};
use studygraph::table::data::Table;
use studygraph::table::schema::Schema;

pub const KIND: Kind = Kind {
    name: "limit",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[],
    example: "
kind: limit
of: geometry
vary:
  shift: { field: geometry.pinion.profile_shift, from: -1, to: 2 }
  bore: { field: geometry.pinion.bore_radius, from: 1 mm, to: 40 mm }
",
    build,
};

/// How far fields of the study can go before a stage refuses them, each by itself, and why not further.
#[derive(Debug, Declared)]
struct Stated {
    /// The stage that may refuse; so may those between it and what is varied. All else is as in the study.
    #[declared(kinds = ["geometry", "modification", "stiffness", "ste", "rating"])]
    pub of: String,
    /// Names of parameters, and the fields that they are with the bounds up to which they are tried; a field can follow from
    /// the other parameters.
    #[declared(varies = Stated::NAMES.of)]
    pub vary: Varied,
    /// Steps that are tried from the value of a parameter to each of its bounds; what is refused between two of them alone is
    /// not seen.
    #[declared(minimum = 1, maximum = 100_000, default = "32")]
    pub probes: usize,
}

/// Values of an end that bisection tries, about: from a step to 1e-12 of the interval.
const HALVINGS: usize = 36;
/// Points whose tables are held at once.
const AT_ONCE: usize = 64;

/// Fields that are tried one by one.
struct Limits {
    of: String,
    points: Points,
    followed: Followed,
    parameters: Vec<Parameter>,
    probes: usize,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let Stated { of, vary, probes } = Stated::checked(record)?;
    if vary.axes.is_empty() {
        let field = Stated::NAMES.vary;
        return Err(Diagnostic::new(format!("`{field}` is empty")).at(record.place_of(field)).into());
    }
    let parameters = parameters(&vary)?;
    let followed = Followed::new(&vary.axes)?;
    // Of the stage what a study always has of it, of the others what is read.
    let mut demands = vec![Demand::default(); vary.stages.len().saturating_sub(1)];
    if let Some(asked) = vary.stages.last() {
        let usual = chain::built(asked)?.outputs().into_iter().filter(|schema| !schema.on_demand);
        demands.push(Demand { tables: usual.map(|schema| (schema.name, [].into())).collect() });
    }
    let points = Points::new(&vary, demands)?;
    Ok(Box::new(Limits { of, points, followed, parameters, probes }))
}

/// The fields that follow from nothing.
fn parameters(vary: &Varied) -> Result<Vec<Parameter>, Diagnostic> {
    let free: Vec<&Axis> = vary.axes.iter().filter(|axis| !matches!(axis.values, Values::Follows(_))).collect();
    let parameter = |axis: &Axis| {
        if axis.name == tables::SIDE {
            let message = format!("`{}` is a column of the table `admitted`; take another name", axis.name);
            return Err(Diagnostic::new(message).at(axis.place));
        }
        let Values::Between(low, high) = axis.values else {
            return Err(Diagnostic::new(format!("`{}` has no bounds up to which it is tried", axis.name))
                .at(axis.values_place)
                .help("write `from` and `to`, without a `count`"));
        };
        let own = vary.own(axis);
        if own.is_none() && free.len() > 1 {
            let message =
                format!("the study has no value of `{}`, or several: the others are tried with one", axis.path);
            return Err(Diagnostic::new(message)
                .at(axis.place)
                .help("write one in its stage, or try this field in a stage of its own"));
        }
        let (name, path, unit) = (axis.name.clone(), axis.path.clone(), axis.unit.clone());
        let multiple = axis.multiple.map(|multiple| multiple as f64);
        Ok(Parameter { name, path, unit, bounds: [low, high], multiple, own })
    };
    free.iter().map(|axis| parameter(axis)).collect()
}

impl Limits {
    /// Why each value of a parameter is refused, the others being as in the study; none where it is not.
    fn reasons(
        &self,
        asked: &[(usize, f64)],
        memory: &mut Memory,
        (context, inputs): (&Context, &Inputs),
    ) -> Result<Vec<Option<String>>, Failure> {
        let values = |(parameter, value): &(usize, f64)| {
            // One without a value in the study is the only one.
            let mut free: Vec<f64> = self.parameters.iter().map(|other| other.own.unwrap_or(*value)).collect();
            free[*parameter] = *value;
            self.followed.values(&free)
        };
        let mut reasons = Vec::with_capacity(asked.len());
        for asked in asked.chunks(AT_ONCE) {
            let all: Vec<Result<Vec<f64>, String>> = asked.iter().map(values).collect();
            let there: Vec<Vec<f64>> = all.iter().filter_map(|values| values.as_ref().ok()).cloned().collect();
            let mut found = self.points.tables(&there, memory, (context, inputs))?.into_iter();
            reasons.extend(all.into_iter().map(|values| match values {
                Ok(_) => found.next().and_then(Result::err),
                Err(reason) => Some(reason),
            }));
        }
        Ok(reasons)
    }

    fn ends(&self, context: &Context, inputs: &Inputs) -> Result<Vec<End>, Failure> {
        let (mut memory, mut rounds) = (Memory::default(), 0_usize);
        let mut ask = |asked: &[(usize, f64)]| {
            rounds += 1;
            (context.progress)((rounds as f64 / (HALVINGS + 3) as f64).min(1.0));
            self.reasons(asked, &mut memory, (context, inputs))
        };
        search::ends((&self.of, &self.parameters), self.probes, &mut ask)
    }
}

impl Stage for Limits {
    fn inputs(&self) -> Vec<Port> {
        self.points.ports().to_vec()
    }

    fn outputs(&self) -> Vec<Schema> {
        vec![tables::limits().schema(), tables::admitted(&self.parameters).schema()]
    }

    fn uses_seed(&self) -> bool {
        self.points.uses_seed()
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let count = self.parameters.len();
        let points = count * (1 + 2 * (self.probes + HALVINGS));
        Estimate::new(true)
            .taking(points as f64 * self.points.seconds())
            .rows(demand, tables::limits().schema(), RowCount::exact(2 * count))
            .rows(demand, tables::admitted(&self.parameters).schema(), RowCount::exact(2))
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let ends = self.ends(context, inputs)?;
        let rows: Vec<LimitRow> =
            ends.iter().map(|end| LimitRow { parameter: &self.parameters[end.parameter], end }).collect();
        let admitted = AdmittedRow::both(&rows);
        let made = [tables::limits().table(&rows), tables::admitted(&self.parameters).table(&admitted)];
        let made: Vec<Table> =
            made.into_iter().collect::<Result<_, _>>().map_err(|error| Failure::new(error.to_string()))?;
        Ok(made.into_iter().filter(|table| context.demand.table(table.name())).collect())
    }
}
