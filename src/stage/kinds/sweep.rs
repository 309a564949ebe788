//! `kind: sweep`: what a stage gives for many designs: any number of the study, of the stage or of one that it reads, with
//! many values.
//!
//! Rows are computed in parts that are kept by themselves; pairs and compliances are found once and used in order. Must not
//! know: how a transmission error is found.

mod draw;
mod effects;
mod layout;
mod method;
mod tables;

use std::sync::Arc;

use self::effects::Tally;
use self::layout::Layout;
use self::method::Method;
use crate::stage::formula::Formula;
use crate::stage::rows::computed::{self, REASON, TABLE};
use crate::stage::rows::{Asked, Question};
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Omission, Others, Parts, Port, RowCount, Stage};
use declare::Declared;
use declare::declared::{Declared, Placed};
use declare::digest::{Digest, Writer};
use declare::error::{Diagnostic, Failure, suggest};
use declare::record::Record;
use declare::record::varied::Varied;
use studygraph::table::data::{Table, TableError};
use studygraph::table::schema::{Column, Schema};

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

/// The column of a drawn row's number.
const NUMBER: &str = "sample";

/// A sweep.
pub struct Sweep {
    asked: Asked,
    layout: Layout,
    /// Index of the output that is to be small.
    objective: usize,
    best: usize,
    parts: Arc<Parts>,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Diagnostic> {
    let stated = Stated::checked(record)?;
    let nothing = |field: &str| Err(Diagnostic::new(format!("`{field}` is empty")).at(record.place_of(field)));
    if stated.vary.axes.is_empty() {
        return nothing(Stated::NAMES.vary);
    }
    if stated.outputs.is_empty() {
        return nothing(Stated::NAMES.outputs);
    }
    let question = Question {
        of: &stated.of,
        varied: stated.vary.clone(),
        outputs: &stated.outputs,
        design: stated.design.as_ref(),
        reserved: &[NUMBER, REASON],
    };
    let prepared = question.prepared()?;
    let layout = Layout::new(prepared.columns.clone(), stated.method, filter(&stated)?)?;
    let drawn = layout.is_drawn();
    let number = Column::integer(NUMBER, "Counts the designs in the order in which they are drawn, from 1.").key();
    let leading = if drawn { vec![number] } else { Vec::new() };
    let (asked, varied) = prepared.asked(leading, |_| !drawn)?;
    let objective = match &stated.minimize {
        None => 0,
        Some(text) => {
            let names = || asked.outputs.iter().map(|output| output.column.name.as_str());
            names().position(|name| name == text.value).ok_or_else(|| {
                let help = suggest(&text.value, names().collect::<Vec<_>>());
                Diagnostic::new(format!("`{}` is none of the outputs", text.value)).at(text.place).help(help)
            })?
        }
    };
    let parts = Parts { fields: OF_ROWS, shared: Digest([0; 32]), each: Vec::new(), last_is_of_all: true };
    let mut sweep = Sweep { asked, layout, objective, best: stated.best, parts: Arc::new(parts) };
    sweep.parts = Arc::new(sweep.cut(&varied));
    Ok(Box::new(sweep))
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

    /// What so many rows take, and what is made of all of them.
    fn estimated(&self, demand: &Demand, rows: RowCount, of_all: bool) -> Estimate {
        let mut estimate = self.asked.estimate(demand, rows);
        for (schema, rows) in effects::schemas(self).into_iter().zip(effects::foreseen(self)) {
            estimate = estimate.rows(demand, schema, if of_all { rows } else { RowCount::NONE });
        }
        if of_all { estimate.holding(effects::held(self)) } else { estimate }
    }

    /// The rows of a part.
    fn rows(&self, part: usize, (context, inputs): (&Context, &Inputs), others: &dyn Others) -> Result<Table, Failure> {
        let rows = self.layout.rows(part, &context.seed)?;
        computed::table(&self.asked, &rows, (context, inputs), others)
    }

    /// The tables of a part without those made of all.
    fn of_part(&self, part: usize, given: (&Context, &Inputs), others: &dyn Others) -> Result<Vec<Table>, Failure> {
        let mut tables = vec![self.rows(part, given, others)?];
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
        let mut tables = vec![Table::from_rows(self.asked.schema.clone(), Vec::new()).map_err(failed)?];
        if let Some(sentence) = tally.warning() {
            (context.warn)(sentence.into());
        }
        tables.extend(tally.tables().map_err(failed)?);
        Ok(tables)
    }
}

impl Stage for Sweep {
    fn inputs(&self) -> Vec<Port> {
        self.asked.ports().to_vec()
    }

    fn outputs(&self) -> Vec<Schema> {
        let mut schemas = vec![self.asked.schema.clone()];
        schemas.extend(effects::schemas(self));
        schemas
    }

    fn uses_seed(&self) -> bool {
        self.layout.uses_seed() || self.asked.uses_seed()
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
        self.asked.left_out().into_iter().collect()
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let alone = studygraph::stage::parts::Alone;
        let mut parts = Vec::new();
        for part in 0..self.layout.parts() {
            parts.push(Arc::new(self.rows(part, (context, inputs), &alone)?));
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
        self.of_all(context, &mut |part| others.of_part(part, TABLE))
    }
}
