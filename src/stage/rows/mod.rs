//! Rows of many designs: a stage, fields of it and of what it reads with other values in every row, and the numbers that are
//! asked of each.
//!
//! What sweeps and scatters have in common. Must not know: which rows there are, what is made of all of them.

pub mod chain;
pub mod computed;
pub(crate) mod counting;
pub mod followed;
pub mod gathered;
pub mod invalid;
mod numbers;
pub mod output;
pub mod points;
mod quick;
pub(crate) mod values;

use self::chain::Chain;
use self::output::Output;
use self::quick::Quick;
use crate::stage::{Demand, Estimate, Omission, RowCount, common};
use declare::declared::Placed;
use declare::digest::Writer;
use declare::error::Diagnostic;
use declare::record::Value;
use declare::record::varied::{Axis, Slot, Varied};
use declare::work::Work;
use gearmesh::gear::mesh::Settings;
use gearmesh::gear::work::CONTACT_SOLVES;
use studygraph::table::schema::{self, Schema};

/// How long it takes to go on to another value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// The pair, or what its teeth yield.
    Upstream,
    /// How a curve is sampled.
    Sampling,
    Design,
    /// By how much the pair is off as it is made and mounted.
    Deviation,
    Torque,
}

/// A varied field as a column.
#[derive(Clone, Debug)]
pub struct Column {
    pub axis: Axis,
    pub class: Class,
}

/// What is asked of every row, and how it is found.
pub struct Asked {
    chain: Chain,
    /// In the order of the table.
    pub columns: Vec<Column>,
    /// Which of them tell rows apart.
    is_key: Vec<bool>,
    /// Numbers ahead of them that do.
    leading: Vec<schema::Column>,
    pub outputs: Vec<Output>,
    design: Option<String>,
    quick: Option<Quick>,
    /// Of the rows.
    pub schema: Schema,
    /// Of the asked stage as it is in the study, for what a row takes.
    settings: Option<Settings>,
}

/// As a study states it.
pub struct Question<'a> {
    /// The stage that is asked.
    pub of: &'a str,
    pub varied: Varied,
    pub outputs: &'a [Placed<String>],
    pub design: Option<&'a Placed<String>>,
    /// Names that no column of a field or an output may have.
    pub reserved: &'a [&'a str],
}

/// A question that holds.
pub struct Prepared {
    pub varied: Varied,
    /// What takes longest to change first.
    pub columns: Vec<Column>,
    pub outputs: Vec<Output>,
    design: Option<String>,
}

impl Question<'_> {
    /// # Errors
    /// A column that is not there, two of one name, a design that is not meant, or a stage that has several values of what a
    /// row has one of.
    pub fn prepared(mut self) -> Result<Prepared, Diagnostic> {
        let asked = self.varied.stages.last();
        let outputs = asked.map(|asked| Ok(chain::built(asked)?.outputs())).transpose()?.unwrap_or_default();
        let outputs = self.read_outputs(&outputs)?;
        let design = self.the_design()?;
        if let Some(design) = &design {
            only(&mut self.varied, design);
        }
        let last = self.varied.stages.len().saturating_sub(1);
        let class =
            |axis: &Axis| quick::class(&self.varied.stages[axis.stage].filled, axis.stage == last, &axis.slot.0);
        let mut columns: Vec<Column> =
            self.varied.axes.iter().map(|axis| Column { axis: axis.clone(), class: class(axis) }).collect();
        if let Some(asked) = self.varied.stages.last() {
            let is_varied = |field: &str| columns.iter().any(|column| quick::is_at(column, last, &asked.filled, field));
            if let Some((field, entry)) = quick::several(&asked.filled, is_varied) {
                return Err(Diagnostic::new(format!(
                    "`{}` has several values of `{field}`, and a row has one",
                    self.of
                ))
                .at(entry.place)
                .help(format!("vary them here: `{field}: {{ field: {}.{field}, values: […] }}`", self.of)));
            }
        }
        columns.sort_by_key(|column| column.class);
        Ok(Prepared { varied: self.varied, columns, outputs, design })
    }

    fn read_outputs(&self, schemas: &[Schema]) -> Result<Vec<Output>, Diagnostic> {
        let mut outputs: Vec<Output> = Vec::new();
        let axes = &self.varied.axes;
        for text in self.outputs {
            let output = Output::read(text, schemas)?;
            let name = &output.column.name;
            let taken = outputs.iter().any(|other| other.column.name == *name)
                || axes.iter().any(|axis| axis.name == *name)
                || self.reserved.contains(&name.as_str());
            if taken {
                return Err(Diagnostic::new(format!("there are two columns `{name}`")).at(text.place));
            }
            outputs.push(output);
        }
        if let Some(axis) = axes.iter().find(|axis| self.reserved.contains(&axis.name.as_str())) {
            let message = format!("`{}` is a column of every table of rows; take another name", axis.name);
            return Err(Diagnostic::new(message).at(axis.place));
        }
        Ok(outputs)
    }

    /// The design that is meant: the named one, the one that is varied, or the only one.
    fn the_design(&self) -> Result<Option<String>, Diagnostic> {
        let mut varied: Vec<(&str, &Axis)> = Vec::new();
        let mut known: Vec<&str> = Vec::new();
        let stages = &self.varied.stages;
        for (index, stage) in stages.iter().enumerate() {
            known.extend(quick::names(&stage.filled));
            for axis in self.varied.axes.iter().filter(|axis| axis.stage == index) {
                if quick::class(&stage.filled, index + 1 == stages.len(), &axis.slot.0) != Class::Design {
                    continue;
                }
                let name = axis.slot.0.get(1).and_then(|at| quick::names(&stage.filled).get(*at).copied());
                varied.extend(name.map(|name| (name, axis)));
            }
        }
        let named = self.design;
        if let Some((name, axis)) =
            varied.iter().find(|(name, _)| *name != named.map_or(varied[0].0, |named| named.value.as_str()))
        {
            let meant = named.map_or(varied[0].0, |named| named.value.as_str());
            let message =
                format!("`{}` is of the design `{name}`, but `{meant}` is the one that is looked at", axis.path);
            return Err(Diagnostic::new(message).at(axis.place).help("a row has one design; vary fields of one only"));
        }
        if known.len() > 1 && named.is_none() && varied.is_empty() {
            let names = known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
            let place = self.outputs.first().map_or_else(Default::default, |output| output.place);
            return Err(Diagnostic::new("a row has one design, and there are several")
                .at(place)
                .help(format!("say with `design` which one is meant: {names}")));
        }
        let only = if let [only] = known[..] { Some(only) } else { None };
        Ok(named
            .map(|named| named.value.as_str())
            .or(varied.first().map(|(name, _)| *name))
            .or(only)
            .map(str::to_owned))
    }
}

/// Rows have values of their own in every column.
pub fn follows_nothing(column: &Column) -> Diagnostic {
    let message = "follows from other columns, which `kind: fit` and `kind: limit` alone can have";
    Diagnostic::new(format!("`{}` {message}", column.axis.name))
        .at(column.axis.values_place)
        .help("write its `values`, or `from` and `to`")
}

/// Takes the other designs away: nobody looks at them.
fn only(varied: &mut Varied, design: &str) {
    for (index, stage) in varied.stages.iter_mut().enumerate() {
        let Some(at) = quick::names(&stage.filled).iter().position(|name| *name == design) else { continue };
        for (_, entry) in &mut stage.filled.fields {
            if let Value::Map(entries) = &mut entry.value
                && entries.get(at).is_some_and(|(name, _)| name == design)
            {
                *entries = vec![entries.swap_remove(at)];
            }
        }
        for axis in varied.axes.iter_mut().filter(|axis| axis.stage == index) {
            if let Slot(steps) = &mut axis.slot
                && steps.len() > 1
            {
                steps[1] = 0;
            }
        }
    }
}

impl Prepared {
    /// `leading` are numbers that tell rows apart, and so does each column for which `is_key` is true.
    ///
    /// # Errors
    /// What a kind refuses of the study as it is.
    pub fn asked(
        self,
        leading: Vec<schema::Column>,
        is_key: impl Fn(&Column) -> bool,
    ) -> Result<(Asked, Varied), Diagnostic> {
        let Self { varied, columns, outputs, design } = self;
        let schemas = match varied.stages.last() {
            Some(asked) => chain::built(asked)?.outputs(),
            None => Vec::new(),
        };
        let demand = outputs.iter().fold(Demand::default(), |mut demand, output| {
            output.ask(&schemas, &mut demand);
            demand
        });
        let mut demands = vec![Demand::default(); varied.stages.len().saturating_sub(1)];
        demands.push(demand);
        let chain = Chain::new(&varied, demands)?;
        let quick = Quick::new(&chain, &columns, &outputs, design.as_deref());
        let settings = quick.as_ref().and(varied.stages.last()).map(|asked| quick::sampling(&asked.filled));
        let is_key = columns.iter().map(is_key).collect();
        let schema = Schema::new("", "", Vec::new());
        let mut asked = Asked { chain, columns, is_key, leading, outputs, design, quick, schema, settings };
        asked.schema = computed::schema(&asked);
        Ok((asked, varied))
    }
}

/// Rows of a part, on average; from [`MOST_PARTS`] parts on twice as many, four times as many and so on.
const ROWS: usize = 1 << 13;
const MOST_ROWS: usize = 1 << 16;
const MOST_PARTS: usize = 128;

/// Rows that a part holds on average, of so many in all.
pub fn rows_of_part(count: usize) -> usize {
    let times = count.div_ceil(ROWS).div_ceil(MOST_PARTS).max(1).next_power_of_two();
    ROWS.saturating_mul(times).min(MOST_ROWS)
}

/// Seconds of a row that goes from table to table.
const SECONDS_OF_TABLES: f64 = 2e-3;

impl Asked {
    /// What the stages that are computed anew read of the study.
    pub fn ports(&self) -> &[crate::stage::Port] {
        &self.chain.outer
    }

    /// Whether any of them draws random numbers.
    pub fn uses_seed(&self) -> bool {
        self.chain.links.iter().any(|link| link.uses_seed)
    }

    /// Digest of what was learned from the study's own fields, whose varied values are in no part's key: the stages' ports and
    /// tables, and the columns that are asked for.
    pub fn write(&self, writer: &mut Writer) {
        self.chain.write(writer);
        writer.text(self.design.as_deref().unwrap_or_default()).flag(self.quick.is_some());
        self.schema.write(writer);
    }

    /// What so many rows take.
    pub fn estimate(&self, demand: &Demand, rows: RowCount) -> Estimate {
        let settings = self.settings.unwrap_or_default();
        let solves = common::curve_rows(settings, 0).saturating_mul(rows.index());
        let work = Work::of(&CONTACT_SOLVES, solves);
        let estimate = Estimate::new(true).work(&work, common::solve_times(settings));
        let estimate = estimate.columns(demand, self.schema.clone(), rows);
        if self.quick.is_none() { estimate.taking(rows.count as f64 * SECONDS_OF_TABLES) } else { estimate }
    }

    pub fn left_out(&self) -> Option<Omission> {
        self.quick.as_ref().map(|_| {
            Omission::new(
                "points of the curves, and numbers that are not among the `outputs`",
                "rows have what they are asked",
            )
        })
    }
}
