//! A stage of rows: its rows are computed part by part, and the last part is made of the rows of all others.
//!
//! What sweeps and scatters have in common as stages. Must not know: which rows there are, what is made of them.

use std::sync::Arc;

use super::Asked;
use super::computed::{self, TABLE};
use super::values::RowSet;
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Omission, Others, Parts, Port, RowCount, Stage};
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

/// What asks for rows and makes tables of all of them; [`Rows`] is the stage.
pub trait Gathered: Send + Sync {
    /// Of a row, when tables are made of all.
    const SECONDS_OF_ROW: f64;
    /// How often all rows are looked at.
    const PASSES: usize;

    fn asked(&self) -> &Asked;

    fn layout(&self) -> &impl RowParts;

    /// Whether its own rows are drawn at random.
    fn is_random(&self) -> bool;

    /// The tables that are made of all rows.
    fn schemas(&self) -> Vec<Schema>;

    /// How many rows they have.
    fn foreseen(&self) -> Vec<RowCount>;

    /// What is held in memory while they are made \[bytes\].
    fn held(&self) -> u64;

    /// What of them was asked for and is not made, beside what [`Asked`] leaves out.
    fn not_made(&self) -> Option<Omission> {
        None
    }

    fn tally(&self) -> Box<dyn Tally + '_>;
}

/// The stage of what is gathered.
pub struct Rows<S> {
    gathered: S,
    parts: Parts,
}

impl<S: Gathered> Rows<S> {
    /// `fields` say which rows there are, `shared` is what every row depends on besides, `all` what the last part depends on
    /// besides the others.
    pub fn new(gathered: S, fields: &'static [&'static str], mut shared: Writer, mut all: Writer) -> Self {
        gathered.asked().write(&mut shared);
        // Tables that are made of all rows name the fields.
        for column in &gathered.asked().columns {
            all.text(&column.axis.path);
        }
        let layout = gathered.layout();
        let mut each: Vec<Digest> = (0..layout.parts()).map(|part| layout.digest(part)).collect();
        all.count(each.len());
        for digest in &each {
            all.digest(digest);
        }
        each.push(all.finish());
        let parts = Parts { fields, shared: shared.finish(), each, last_is_of_all: true };
        Self { gathered, parts }
    }

    /// What so many rows take, without what is made of all.
    fn of_rows(&self, demand: &Demand, rows: RowCount) -> Estimate {
        self.gathered.asked().estimate(demand, rows)
    }

    fn of_all_rows(&self, estimate: Estimate, demand: &Demand) -> Estimate {
        let made = self.gathered.schemas().into_iter().zip(self.gathered.foreseen());
        made.fold(estimate, |estimate, (schema, rows)| estimate.rows(demand, schema, rows))
            .holding(self.gathered.held())
    }

    fn rows(&self, part: usize, given: (&Context, &Inputs), others: &dyn Others) -> Result<Table, Failure> {
        computed::table(self.gathered.asked(), &self.gathered.layout().rows(part, &given.0.seed)?, given, others)
    }

    /// The tables made of all parts, of which `of_part` gives the rows; the rows themselves stay with their parts.
    fn of_all(
        &self,
        context: &Context,
        of_part: &dyn Fn(usize) -> Result<Arc<Table>, Failure>,
    ) -> Result<Vec<Table>, Failure> {
        let mut tally = self.gathered.tally();
        for pass in 0..S::PASSES {
            for part in 0..self.gathered.layout().parts() {
                context.check_stop()?;
                tally.add(pass, &*of_part(part)?);
            }
        }
        if let Some(sentence) = tally.warning() {
            (context.warn)(sentence.into());
        }
        let mut tables = vec![Table::from_rows(self.gathered.asked().schema.clone(), Vec::new()).map_err(failed)?];
        tables.extend(tally.tables().map_err(failed)?);
        Ok(tables)
    }
}

impl<S: Gathered> Stage for Rows<S> {
    fn inputs(&self) -> Vec<Port> {
        self.gathered.asked().ports().to_vec()
    }

    /// The rows first.
    fn outputs(&self) -> Vec<Schema> {
        let mut schemas = vec![self.gathered.asked().schema.clone()];
        schemas.extend(self.gathered.schemas());
        schemas
    }

    fn uses_seed(&self) -> bool {
        self.gathered.is_random() || self.gathered.asked().uses_seed()
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        self.of_all_rows(self.of_rows(demand, self.gathered.layout().row_count(None)), demand)
    }

    fn estimate_part(&self, part: usize, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let layout = self.gathered.layout();
        if part < layout.parts() {
            let estimate = self.of_rows(demand, layout.row_count(Some(part)));
            let none = self.gathered.schemas().into_iter();
            return none.fold(estimate, |estimate, schema| estimate.rows(demand, schema, RowCount::NONE));
        }
        let estimate = self.of_all_rows(self.of_rows(demand, RowCount::NONE), demand);
        estimate.taking(layout.row_count(None).count as f64 * S::SECONDS_OF_ROW)
    }

    fn left_out(&self, _demand: &Demand) -> Vec<Omission> {
        self.gathered.asked().left_out().into_iter().chain(self.gathered.not_made()).collect()
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let parts = 0..self.gathered.layout().parts();
        let parts = parts.map(|part| Ok(Arc::new(self.rows(part, (context, inputs), &Alone)?)));
        let parts = parts.collect::<Result<Vec<_>, Failure>>()?;
        let mut tables = self.of_all(context, &|part| Ok(Arc::clone(&parts[part])))?;
        if let Some(rows) =
            Table::concatenated(parts.into_iter().map(Arc::unwrap_or_clone).collect()).map_err(failed)?
        {
            tables[0] = rows;
        }
        Ok(tables)
    }

    fn parts(&self) -> Option<Parts> {
        Some(self.parts.clone())
    }

    fn run_part(
        &self,
        part: usize,
        context: &Context,
        inputs: &Inputs,
        others: &dyn Others,
    ) -> Result<Vec<Table>, Failure> {
        if part == self.gathered.layout().parts() {
            return self.of_all(context, &|part| others.of_part(part, TABLE));
        }
        let mut tables = vec![self.rows(part, (context, inputs), others)?];
        for schema in self.gathered.schemas() {
            tables.push(Table::from_rows(schema, Vec::new()).map_err(failed)?);
        }
        Ok(tables)
    }
}

#[allow(clippy::needless_pass_by_value)] // as `map_err` gives it
fn failed(error: TableError) -> Failure {
    Failure::new(error.to_string())
}
