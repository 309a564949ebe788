//! A stage of rows: its rows are computed part by part, and the last part is made of the rows of all others.
//!
//! What sweeps and scatters have in common as stages. Must not know: which rows there are, what is made of them.

use std::sync::Arc;

use super::Asked;
use super::computed::{self, TABLE};
use super::values::RowSet;
use crate::stage::{Context, Demand, Estimate, Inputs, Others, Parts, RowCount};
use declare::digest::{Digest, Writer};
use declare::error::Failure;
use declare::seed::Seed;
use studygraph::stage::parts::Alone;
use studygraph::table::data::{Table, TableError};
use studygraph::table::schema::Schema;

/// Which rows there are.
pub trait RowParts {
    /// How many parts they come in.
    fn parts(&self) -> usize;

    /// What is in a part.
    fn digest(&self, part: usize) -> Digest;

    /// # Errors
    /// What cannot be drawn.
    fn rows(&self, part: usize, seed: &Seed) -> Result<RowSet, Failure>;

    /// How many rows a part has, or all of them.
    fn row_count(&self, part: Option<usize>) -> RowCount;
}

/// What is found of all rows.
pub trait Tally {
    /// Takes the rows of the next part; all parts come in each pass, in their order.
    fn add(&mut self, pass: usize, rows: &Table);

    /// What there is to be warned of.
    fn warning(&self) -> Option<String>;

    /// # Errors
    /// A table that contradicts its schema.
    fn tables(self: Box<Self>) -> Result<Vec<Table>, TableError>;
}

/// A stage that asks for rows and makes tables of all of them.
pub trait Gathered {
    /// Of a row, when tables are made of all.
    const SECONDS_OF_ROW: f64;
    /// How often all rows are looked at.
    const PASSES: usize;

    fn asked(&self) -> &Asked;

    fn layout(&self) -> &impl RowParts;

    /// The tables that are made of all rows.
    fn schemas(&self) -> Vec<Schema>;

    /// How many rows they have.
    fn foreseen(&self) -> Vec<RowCount>;

    /// What is held in memory while they are made \[bytes\].
    fn held(&self) -> u64;

    fn tally(&self) -> Box<dyn Tally + '_>;
}

/// How a stage of rows cuts itself: `fields` say which rows there are, `shared` is what every row depends on besides, `all` what
/// the last part depends on besides the others.
pub fn parts(rows: &impl RowParts, fields: &'static [&'static str], shared: &Writer, mut all: Writer) -> Parts {
    let mut each: Vec<Digest> = (0..rows.parts()).map(|part| rows.digest(part)).collect();
    all.count(each.len());
    for digest in &each {
        all.digest(digest);
    }
    each.push(all.finish());
    Parts { fields, shared: shared.finish(), each, last_is_of_all: true }
}

/// All its tables, the rows first.
pub fn outputs(stage: &impl Gathered) -> Vec<Schema> {
    let mut schemas = vec![stage.asked().schema.clone()];
    schemas.extend(stage.schemas());
    schemas
}

/// What all of it takes.
pub fn estimate(stage: &impl Gathered, demand: &Demand) -> Estimate {
    of_all_rows(stage, stage.asked().estimate(demand, stage.layout().row_count(None)), demand)
}

/// What a part takes.
pub fn estimate_part<S: Gathered>(stage: &S, part: usize, demand: &Demand) -> Estimate {
    if part < stage.layout().parts() {
        let estimate = stage.asked().estimate(demand, stage.layout().row_count(Some(part)));
        let none = stage.schemas().into_iter();
        return none.fold(estimate, |estimate, schema| estimate.rows(demand, schema, RowCount::NONE));
    }
    let estimate = of_all_rows(stage, stage.asked().estimate(demand, RowCount::NONE), demand);
    estimate.taking(stage.layout().row_count(None).count as f64 * S::SECONDS_OF_ROW)
}

fn of_all_rows(stage: &impl Gathered, estimate: Estimate, demand: &Demand) -> Estimate {
    let made = stage.schemas().into_iter().zip(stage.foreseen());
    made.fold(estimate, |estimate, (schema, rows)| estimate.rows(demand, schema, rows)).holding(stage.held())
}

/// # Errors
/// When the user stopped, or the stage cannot go on at all.
pub fn run(stage: &impl Gathered, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
    let parts = (0..stage.layout().parts()).map(|part| Ok(Arc::new(rows(stage, part, (context, inputs), &Alone)?)));
    let parts = parts.collect::<Result<Vec<_>, Failure>>()?;
    let mut tables = of_all(stage, context, &|part| Ok(Arc::clone(&parts[part])))?;
    if let Some(rows) = Table::concatenated(parts.into_iter().map(Arc::unwrap_or_clone).collect()).map_err(failed)? {
        tables[0] = rows;
    }
    Ok(tables)
}

/// # Errors
/// As [`run`].
pub fn run_part(
    stage: &impl Gathered,
    part: usize,
    given: (&Context, &Inputs),
    others: &dyn Others,
) -> Result<Vec<Table>, Failure> {
    if part == stage.layout().parts() {
        return of_all(stage, given.0, &|part| others.of_part(part, TABLE));
    }
    let mut tables = vec![rows(stage, part, given, others)?];
    for schema in stage.schemas() {
        tables.push(Table::from_rows(schema, Vec::new()).map_err(failed)?);
    }
    Ok(tables)
}

fn rows(stage: &impl Gathered, part: usize, given: (&Context, &Inputs), others: &dyn Others) -> Result<Table, Failure> {
    computed::table(stage.asked(), &stage.layout().rows(part, &given.0.seed)?, given, others)
}

/// The tables made of all parts, of which `of_part` gives the rows; the rows themselves stay with their parts.
fn of_all<S: Gathered>(
    stage: &S,
    context: &Context,
    of_part: &dyn Fn(usize) -> Result<Arc<Table>, Failure>,
) -> Result<Vec<Table>, Failure> {
    let mut tally = stage.tally();
    for pass in 0..S::PASSES {
        for part in 0..stage.layout().parts() {
            context.check_stop()?;
            tally.add(pass, &*of_part(part)?);
        }
    }
    if let Some(sentence) = tally.warning() {
        (context.warn)(sentence.into());
    }
    let mut tables = vec![Table::from_rows(stage.asked().schema.clone(), Vec::new()).map_err(failed)?];
    tables.extend(tally.tables().map_err(failed)?);
    Ok(tables)
}

#[allow(clippy::needless_pass_by_value)] // as `map_err` gives it
fn failed(error: TableError) -> Failure {
    Failure::new(error.to_string())
}
