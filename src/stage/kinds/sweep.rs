//! `kind: sweep`: what a stage gives for many designs: any number of the study, of the stage or of one that it reads, with
//! many values.
//!
//! Rows are computed in parts that are kept by themselves; pairs and compliances are found once and used in order. Must not
//! know: how a transmission error is found.

mod chain;
mod counting;
mod effects;
mod layout;
mod method;
mod output;
mod quick;
mod rows;
mod tables;
mod values;

use std::sync::Arc;

use self::chain::Chain;
use self::effects::Tally;
use self::layout::{Class, Column, Layout};
use self::method::Method;
use self::output::Output;
use self::quick::Quick;
use crate::stage::formula::Formula;
use crate::stage::{
    Ahead, Context, Demand, Estimate, Inputs, Kind, Omission, Others, Parts, Port, RowCount, Stage, common,
};
use declare::Declared;
use declare::declared::{Declared, Placed};
use declare::digest::{Digest, Writer};
use declare::error::{Diagnostic, Failure, suggest};
use declare::record::varied::{Slot, Varied};
use declare::record::{Record, Value};
use declare::work::Work;
use gearmesh::gear::transmission_error::cycle::Settings;
use gearmesh::gear::work::CONTACT_SOLVES;
use studygraph::table::data::{Table, TableError};
use studygraph::table::schema::Schema;

pub use self::rows::{ROWS_COMPUTED, ROWS_TAKEN_OVER};

pub const KIND: Kind = Kind {
    name: "sweep",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[],
    example: "
kind: sweep
of: ste
vary:
  amount: { field: \"modification.designs.relieved[0].tip_relief.amount\", from: 0 um, to: 20 um, count: 5 }
  torque: { field: ste.torque, values: [25 N m, 50 N m, 100 N m] }
outputs: [peak_to_peak, mean, \"harmonics[order=1].amplitude\"]
",
    build,
};

/// What a stage gives for very many designs: any fields of it and of what it reads with many values, row by row.
#[derive(Debug, Declared)]
struct Stated {
    /// The stage whose numbers are asked; it and what it reads are as in the study but for what is varied.
    #[declared(kinds = ["ste", "stiffness"])]
    pub of: String,
    /// Which combinations of values are taken.
    #[declared(default = "grid")]
    pub method: Method,
    /// Names of columns, and the fields and values that stand in them.
    #[declared(varies = Stated::NAMES.of)]
    pub vary: Varied,
    /// Which rows are taken: a formula over the names of `vary` that is true there.
    #[declared(name = "where", example = "relief < 20")]
    pub filter: Option<Placed<String>>,
    /// Columns of the stage's tables: `column` of its summary, `table.column` or `table[key=value, …].column`.
    #[declared(example = "peak_to_peak")]
    pub outputs: Vec<Placed<String>>,
    /// The design that is meant, where the stage is given several.
    #[declared(example = "long")]
    pub design: Option<Placed<String>>,
    /// Which of the outputs is to be small: for the table of the best rows; the first one when it is not said.
    #[declared(example = "peak_to_peak")]
    pub minimize: Option<Placed<String>>,
    /// How many rows the table of the best has.
    #[declared(minimum = 1, maximum = 10_000, default = "20")]
    pub best: usize,
}

/// Those of its fields that say which rows there are, and what is made of all of them.
const OF_ROWS: &[&str] =
    &[Stated::NAMES.vary, Stated::NAMES.method, Stated::NAMES.filter, Stated::NAMES.minimize, Stated::NAMES.best];

/// A sweep.
pub struct Sweep {
    chain: Chain,
    layout: Layout,
    outputs: Vec<Output>,
    design: Option<String>,
    quick: Option<Quick>,
    /// Index of the output that is to be small.
    objective: usize,
    best: usize,
    /// Of the rows.
    schema: Schema,
    parts: Arc<Parts>,
    /// Of the asked stage as it is in the study, for what a row takes.
    settings: Option<Settings>,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Diagnostic> {
    let mut stated = Stated::checked(record)?;
    let nothing = |field: &str| Err(Diagnostic::new(format!("`{field}` is empty")).at(record.place_of(field)));
    if stated.vary.axes.is_empty() {
        return nothing(Stated::NAMES.vary);
    }
    if stated.outputs.is_empty() {
        return nothing(Stated::NAMES.outputs);
    }
    let Some(asked) = stated.vary.stages.last() else { return nothing(Stated::NAMES.of) };
    let outputs = chain::built(asked)?.outputs();
    let outputs = read_outputs(&stated, &outputs)?;
    let design = the_design(&stated)?;
    if let Some(design) = &design {
        only(&mut stated.vary, design);
    }
    let last = stated.vary.stages.len() - 1;
    let torque = stated.vary.axes.iter().any(|axis| {
        let stage = &stated.vary.stages[axis.stage];
        quick::class(&stage.filled, axis.stage == last, &axis.slot.0) == Class::Torque
    });
    if let Some(entry) = quick::several_torques(&stated.vary.stages[last].record).filter(|_| !torque) {
        return Err(Diagnostic::new(format!("`{}` has several torques, and a row has one", stated.of))
            .at(entry.place)
            .help(format!(
                "vary them in the sweep: `torque: {{ field: {}.torque, values: [… N m, … N m] }}`",
                stated.of
            )));
    }
    let columns = stated.vary.axes.iter().map(|axis| {
        let stage = &stated.vary.stages[axis.stage];
        Column { axis: axis.clone(), class: quick::class(&stage.filled, axis.stage == last, &axis.slot.0) }
    });
    let layout = Layout::new(columns.collect(), stated.method, filter(&stated)?)?;
    let asked = &stated.vary.stages[last];
    let demand = outputs.iter().fold(Demand::default(), |mut demand, output| {
        output.ask(&chain::built(asked).map(|stage| stage.outputs()).unwrap_or_default(), &mut demand);
        demand
    });
    let chain = Chain::new(&stated.vary, demand)?;
    let quick = Quick::new(&chain, &layout.columns, &outputs, design.as_deref());
    let objective = match &stated.minimize {
        None => 0,
        Some(text) => {
            let names = || outputs.iter().map(|output| output.column.name.as_str());
            names().position(|name| name == text.value).ok_or_else(|| {
                let help = suggest(&text.value, names().collect::<Vec<_>>());
                Diagnostic::new(format!("`{}` is none of the outputs", text.value)).at(text.place).help(help)
            })?
        }
    };
    let settings = quick.as_ref().map(|_| quick::sampling(&asked.record));
    let mut sweep = Sweep {
        chain,
        layout,
        outputs,
        design,
        quick,
        objective,
        best: stated.best,
        schema: Schema::new("", "", Vec::new()),
        parts: Arc::new(Parts { fields: OF_ROWS, shared: Digest([0; 32]), each: Vec::new(), last_is_of_all: true }),
        settings,
    };
    sweep.schema = rows::schema(&sweep);
    sweep.parts = Arc::new(sweep.cut(&stated.vary));
    Ok(Box::new(sweep))
}

fn read_outputs(stated: &Stated, schemas: &[Schema]) -> Result<Vec<Output>, Diagnostic> {
    let mut outputs: Vec<Output> = Vec::new();
    for text in &stated.outputs {
        let output = Output::read(text, schemas)?;
        let name = &output.column.name;
        let taken = outputs.iter().any(|other| other.column.name == *name)
            || stated.vary.axes.iter().any(|axis| axis.name == *name)
            || [rows::NUMBER, rows::REASON].contains(&name.as_str());
        if taken {
            return Err(Diagnostic::new(format!("there are two columns `{name}`")).at(text.place));
        }
        outputs.push(output);
    }
    if let Some(axis) = stated.vary.axes.iter().find(|axis| [rows::NUMBER, rows::REASON].contains(&axis.name.as_str()))
    {
        let message = format!("`{}` is a column of every sweep; take another name", axis.name);
        return Err(Diagnostic::new(message).at(axis.place));
    }
    Ok(outputs)
}

fn filter(stated: &Stated) -> Result<Option<(Formula, declare::error::Place)>, Diagnostic> {
    let Some(text) = &stated.filter else { return Ok(None) };
    let names: Vec<&str> = stated.vary.axes.iter().map(|axis| axis.name.as_str()).collect();
    let formula = Formula::parse(&text.value, &names).map_err(|problem| Diagnostic::new(problem).at(text.place))?;
    if !formula.is_claim() {
        let message = format!("`{}` is a number; `where` is true or false", formula.text);
        return Err(Diagnostic::new(message).at(text.place).help("for example `where: \"amount <= 0.01 * length\"`"));
    }
    Ok(Some((formula, text.place)))
}

/// The design that is meant: the named one, the one that is varied, or the only one.
fn the_design(stated: &Stated) -> Result<Option<String>, Diagnostic> {
    let mut varied: Vec<(&str, &declare::record::varied::Axis)> = Vec::new();
    let mut known: Vec<&str> = Vec::new();
    for (index, stage) in stated.vary.stages.iter().enumerate() {
        known.extend(quick::names(&stage.filled));
        for axis in stated.vary.axes.iter().filter(|axis| axis.stage == index) {
            if quick::class(&stage.filled, index + 1 == stated.vary.stages.len(), &axis.slot.0) != Class::Design {
                continue;
            }
            let name = axis.slot.0.get(1).and_then(|at| quick::names(&stage.filled).get(*at).copied());
            varied.extend(name.map(|name| (name, axis)));
        }
    }
    let named = stated.design.as_ref();
    if let Some((name, axis)) =
        varied.iter().find(|(name, _)| *name != named.map_or(varied[0].0, |named| named.value.as_str()))
    {
        let meant = named.map_or(varied[0].0, |named| named.value.as_str());
        let message = format!("`{}` is of the design `{name}`, but `{meant}` is the one that is looked at", axis.path);
        return Err(Diagnostic::new(message).at(axis.place).help("a row has one design; vary fields of one only"));
    }
    if known.len() > 1 && named.is_none() && varied.is_empty() {
        let names = known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let place = stated.outputs.first().map_or_else(Default::default, |output| output.place);
        return Err(Diagnostic::new("a row has one design, and there are several")
            .at(place)
            .help(format!("say with `design` which one is meant: {names}")));
    }
    let only = if let [only] = known[..] { Some(only) } else { None };
    Ok(named.map(|named| named.value.as_str()).or(varied.first().map(|(name, _)| *name)).or(only).map(str::to_owned))
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

impl Sweep {
    fn cut(&self, varied: &Varied) -> Parts {
        let mut shared = Writer::new("gearstudy 1 sweep rows");
        varied.write_shared(&mut shared);
        shared.flag(self.layout.is_drawn()).count(self.layout.columns.len());
        for column in &self.layout.columns {
            shared.text(&column.axis.name);
        }
        let mut each: Vec<Digest> = (0..self.layout.parts()).map(|part| self.layout.digest(part)).collect();
        let mut all = Writer::new("gearstudy 1 sweep of all");
        all.count(self.objective).count(self.best).count(each.len());
        for digest in &each {
            all.digest(digest);
        }
        each.push(all.finish());
        Parts { fields: OF_ROWS, shared: shared.finish(), each, last_is_of_all: true }
    }

    /// Work of a row.
    fn work(&self, rows: usize) -> (Work, f64) {
        let settings = self.settings.unwrap_or_default();
        let solves = common::curve_rows(settings, 0).saturating_mul(rows);
        (Work::of(&CONTACT_SOLVES, solves), common::solve_times(settings))
    }

    /// What so many rows take, and what is made of all of them.
    fn estimated(&self, demand: &Demand, rows: RowCount, of_all: bool) -> Estimate {
        let mut estimate = Estimate::new(true);
        let (work, times) = self.work(rows.index());
        estimate = estimate.work(&work, times).columns(demand, self.schema.clone(), rows);
        if self.quick.is_none() {
            estimate = estimate.taking(rows.count as f64 * SECONDS_OF_TABLES);
        }
        for (schema, rows) in effects::schemas(self).into_iter().zip(effects::foreseen(self)) {
            estimate = estimate.rows(demand, schema, if of_all { rows } else { RowCount::NONE });
        }
        if of_all { estimate.holding(effects::held(self)) } else { estimate }
    }

    /// The tables of a part without those made of all.
    fn of_part(&self, part: usize, given: (&Context, &Inputs), others: &dyn Others) -> Result<Vec<Table>, Failure> {
        let mut tables = vec![rows::table(self, part, given, others)?];
        tables.extend(effects::empty(self).map_err(|error| Failure::new(error.to_string()))?);
        Ok(tables)
    }

    /// The tables made of all parts, of which `of_part` gives the rows.
    fn of_all(
        &self,
        context: &Context,
        of_part: &mut dyn FnMut(usize) -> Result<Arc<Table>, Failure>,
    ) -> Result<Vec<Table>, Failure> {
        let failed = |error: TableError| Failure::new(error.to_string());
        let mut tally = Tally::new(self);
        for pass in 0..effects::PASSES {
            for part in 0..self.layout.parts() {
                context.check_stop()?;
                let rows = of_part(part)?;
                tally.add(pass, &rows);
            }
        }
        let mut tables = vec![Table::from_rows(self.schema.clone(), Vec::new()).map_err(failed)?];
        if let Some(sentence) = tally.warning() {
            (context.warn)(sentence.into());
        }
        tables.extend(tally.tables().map_err(failed)?);
        Ok(tables)
    }
}

/// Seconds of a row that goes from table to table.
const SECONDS_OF_TABLES: f64 = 2e-3;

impl Stage for Sweep {
    fn inputs(&self) -> Vec<Port> {
        self.chain.outer.clone()
    }

    fn outputs(&self) -> Vec<Schema> {
        let mut schemas = vec![self.schema.clone()];
        schemas.extend(effects::schemas(self));
        schemas
    }

    fn uses_seed(&self) -> bool {
        self.layout.uses_seed() || self.chain.links.iter().any(|link| link.uses_seed)
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let count = self.layout.count();
        let rows = if self.layout.is_filtered() { RowCount::at_most(count) } else { RowCount::exact(count) };
        self.estimated(demand, rows, true)
    }

    fn estimate_part(&self, part: usize, demand: &Demand, _ahead: &Ahead) -> Estimate {
        if part == self.layout.parts() {
            let estimate = self.estimated(demand, RowCount::NONE, true);
            return estimate.taking(self.layout.count() as f64 * effects::SECONDS_OF_ROW);
        }
        let count = self.layout.count_of(part);
        let rows = if self.layout.is_filtered() { RowCount::at_most(count) } else { RowCount::exact(count) };
        self.estimated(demand, rows, false)
    }

    fn left_out(&self, _demand: &Demand) -> Vec<Omission> {
        if self.quick.is_none() {
            return Vec::new();
        }
        vec![Omission::new(
            "points of the curves, and numbers that are not among the `outputs`",
            "a sweep computes what it is asked",
        )]
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let alone = studygraph::stage::parts::Alone;
        let mut parts = Vec::new();
        for part in 0..self.layout.parts() {
            parts.push(Arc::new(rows::table(self, part, (context, inputs), &alone)?));
        }
        let mut tables = self.of_all(context, &mut |part| Ok(Arc::clone(&parts[part])))?;
        let rows = Table::concatenated(parts.into_iter().map(Arc::unwrap_or_clone).collect());
        if let Some(rows) = rows.map_err(|error| Failure::new(error.to_string()))? {
            tables[0] = rows;
        }
        Ok(tables)
    }

    fn parts(&self) -> Option<Parts> {
        Some(Parts::clone(&self.parts))
    }

    fn run_part(
        &self,
        part: usize,
        context: &Context,
        inputs: &Inputs,
        others: &dyn Others,
    ) -> Result<Vec<Table>, Failure> {
        if part < self.layout.parts() {
            return self.of_part(part, (context, inputs), others);
        }
        self.of_all(context, &mut |part| others.of_part(part, rows::TABLE))
    }
}
