//! Stage kinds: the trait that every kind has, and what it is given and gives.
//!
//! A stage is pure: the same configuration, inputs and seed give the same tables, bit for bit, whatever the number of
//! threads. Must not know: the store, the runner, other stages (it sees their tables, never their code).

pub mod estimate;
pub mod memory;
pub mod omission;
pub mod parts;
pub mod steps;

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::table::data::{Cell, Table};
use crate::table::schema::Schema;
use crate::table::select::CellName;
use crate::warning::Warning;
use declare::error::{Diagnostic, Failure, Faults, Place};
use declare::parameter::Field;
use declare::record::Record;
use declare::seed::Seed;
use declare::units::Dimension;
use declare::work::Tally;

pub use self::estimate::{Ahead, Estimate, RowCount};
pub use self::omission::{Omission, Saved};
pub use self::parts::{Others, Parts};

/// A kind of stage as registered.
pub struct Kind {
    /// As written after `kind:`; also the name of the file in `stage/kinds/`.
    pub name: &'static str,
    /// Part of every cache key; raised when the meaning of the tables changes.
    pub version: u32,
    pub summary: &'static str,
    pub fields: &'static [Field],
    /// Its tables that hold sampled curves.
    pub curves: &'static [Curves],
    /// A complete stage of this kind, as YAML, with the stages it refers to named after their kinds.
    pub example: &'static str,
    /// Builds a stage from a checked record; refuses what no declaration can express (interference, an empty range).
    pub build: fn(&Record) -> Result<Box<dyn Stage>, Faults>,
}

/// A table whose rows are points of curves. Its last key counts the points of a curve, unless that is the column over which
/// they are sampled; the others tell the curves apart.
#[derive(Clone, Copy, Debug)]
pub struct Curves {
    pub table: &'static str,
    /// The column over which they are sampled, in whose order the points are.
    pub along: &'static str,
    /// What they are curves of.
    pub quantity: &'static str,
}

/// The dimension of the numbers of a cell, where its column is going to be there and holds numbers.
pub type DimensionOf<'a> = &'a dyn Fn(&CellName) -> Option<Dimension>;

/// Gives the values of a key column of (stage, table, column), where they are known before anything runs.
pub type KeysOf<'a> = &'a dyn Fn(&str, &str, &str) -> Option<Vec<Cell>>;

/// A stage of a study, ready to run.
pub trait Stage: Send + Sync {
    /// What it reads from other stages, in a fixed order.
    fn inputs(&self) -> Vec<Port>;

    /// The tables it can give; a table or column marked on demand is computed only when asked for.
    fn outputs(&self) -> Vec<Schema>;

    /// Whether every stage of its kind can give the same: of very many they are asked for once.
    fn gives_what_its_kind_does(&self) -> bool {
        false
    }

    /// Why it cannot give a table that other stages of its kind give.
    fn lacks(&self, _table: &str) -> Option<&'static str> {
        None
    }

    /// Whether it draws random numbers. The seed is part of the key of those that do; the others are given a seed that
    /// never changes, so one that says nothing and draws all the same still has tables that fit their key.
    fn uses_seed(&self) -> bool {
        false
    }

    /// Whether nothing else may run beside it, because it measures time or memory.
    fn runs_alone(&self) -> bool {
        false
    }

    /// What is wrong with parts of it that it does without, so that what is wrong with the others can be found too. A study
    /// with any is refused.
    fn wrong(&self) -> &[Diagnostic] {
        &[]
    }

    /// What it names of other stages' tables: cells, or rows.
    fn named(&self) -> Vec<Named> {
        Vec::new()
    }

    /// What it sets against each other, of cells and quantities, that does not go together.
    fn at_odds(&self, _of: DimensionOf) -> Vec<Diagnostic> {
        Vec::new()
    }

    /// The values that a key column of a table is going to have, where they follow from what the study says; `of` asks a
    /// stage that it reads.
    fn keys(&self, _table: &str, _column: &str, _of: KeysOf) -> Option<Vec<Cell>> {
        None
    }

    /// Whether a table has rows for every combination of the values that its key columns are known to have.
    fn combines(&self, _table: &str) -> bool {
        false
    }

    /// What it will take, as far as that is known before it runs.
    fn estimate(&self, demand: &Demand, ahead: &Ahead) -> Estimate;

    /// What it does not compute for this demand, and why.
    fn left_out(&self, _demand: &Demand) -> Vec<Omission> {
        Vec::new()
    }

    /// What a table or column on demand would take that nobody asks for.
    fn saved(&self, _demand: &Demand, _table: &str, _column: Option<&str>) -> Option<Saved> {
        None
    }

    /// What is wrong with the tables that come in, as far as a look at them tells; some of the ports may not be there yet.
    ///
    /// # Errors
    /// As [`Stage::run`] with the same tables.
    fn refuses(&self, _inputs: &Inputs) -> Result<(), Failure> {
        Ok(())
    }

    /// Computes the demanded tables.
    ///
    /// # Errors
    /// When the values make no sense together, or the user asked to stop.
    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure>;

    /// The parts into which it cuts itself; none where it is one, or is cut along an axis of its record. The tables of all
    /// parts are the rows of each after those of the one before.
    fn parts(&self) -> Option<Parts> {
        None
    }

    /// Computes the demanded tables of one of its parts.
    ///
    /// # Errors
    /// As [`Stage::run`].
    fn run_part(
        &self,
        _part: usize,
        context: &Context,
        inputs: &Inputs,
        _others: &dyn Others,
    ) -> Result<Vec<Table>, Failure> {
        self.run(context, inputs)
    }

    /// What one of its parts will take.
    fn estimate_part(&self, _part: usize, demand: &Demand, ahead: &Ahead) -> Estimate {
        self.estimate(demand, ahead)
    }
}

/// Rows of another stage's table that a stage needs some of, or a cell in each of them.
pub struct Named {
    /// Its column is empty where only rows are meant.
    pub cell: CellName,
    /// Where the study names it.
    pub place: Place,
    /// Where it says which rows: mostly the same.
    pub rows: Place,
    /// Whether it must be one row.
    pub is_one: bool,
    /// The dimension of what the cell is compared with, how that is written, and where.
    pub beside: Option<(Dimension, String, Place)>,
}

/// One thing a stage reads: tables of another stage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// The name under which the stage finds the tables; enters the cache key with the tables' content.
    pub name: String,
    /// The stage as named in the study.
    pub stage: String,
    /// Read not from that stage itself but from what *it* reads through its port of this name.
    pub through: Option<&'static str>,
    pub wants: Vec<Want>,
    /// Columns on demand of the stage's own tables for which alone it is read, as (table, column); none: always.
    pub only_for: &'static [(&'static str, &'static str)],
}

impl Port {
    /// Wants whole tables (all columns that are not on demand).
    #[must_use]
    pub fn tables(name: impl Into<String>, stage: impl Into<String>, tables: &[&str]) -> Self {
        let wants = tables.iter().map(|table| Want { table: (*table).to_owned(), columns: Vec::new() }).collect();
        Self { name: name.into(), stage: stage.into(), through: None, wants, only_for: &[] }
    }

    /// Read only where one of these columns on demand of the stage's own tables is wanted.
    #[must_use]
    pub fn only_for(mut self, columns: &'static [(&'static str, &'static str)]) -> Self {
        self.only_for = columns;
        self
    }

    /// Whether it is read, of what is demanded of the stage.
    #[must_use]
    pub fn is_wanted(&self, demand: &Demand) -> bool {
        self.only_for.is_empty() || self.only_for.iter().any(|(table, column)| demand.column(table, column))
    }

    #[must_use]
    pub fn through(mut self, port: &'static str) -> Self {
        self.through = Some(port);
        self
    }
}

/// A table that is wanted, and which of its on-demand columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Want {
    pub table: String,
    /// Columns wanted by name; the columns that are not on demand come in any case.
    pub columns: Vec<String>,
}

/// What downstream stages and the user ask of a stage: per table the on-demand columns that are wanted.
///
/// Every table that is not on demand is in it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Demand {
    pub tables: BTreeMap<String, std::collections::BTreeSet<String>>,
}

impl Demand {
    #[must_use]
    pub fn table(&self, table: &str) -> bool {
        self.tables.contains_key(table)
    }

    /// Whether an on-demand column is wanted.
    #[must_use]
    pub fn column(&self, table: &str, column: &str) -> bool {
        self.tables.get(table).is_some_and(|columns| columns.contains(column))
    }

    /// The schema of a table with the on-demand columns that nobody wants taken out.
    #[must_use]
    pub fn narrowed(&self, mut schema: Schema) -> Schema {
        schema.columns.retain(|column| !column.on_demand || self.column(&schema.name, &column.name));
        schema
    }
}

/// What a stage is given besides its inputs.
pub struct Context<'a> {
    pub seed: Seed,
    pub demand: &'a Demand,
    pub stop: &'a AtomicBool,
    /// Called with the share of the work that is done, 0 to 1.
    pub progress: &'a (dyn Fn(f64) + Sync),
    /// Called with something the user should know about the result (a formula outside its range, say).
    pub warn: &'a (dyn Fn(Warning) + Sync),
    /// False where warnings go nowhere: what only a warning needs is then left out.
    pub is_heard: bool,
    /// Where the work that is done is counted.
    pub work: &'a Tally,
}

impl Context<'_> {
    /// # Errors
    /// [`Failure::Stopped`] once the user asked to stop; long loops call it.
    pub fn check_stop(&self) -> Result<(), Failure> {
        if self.stop.load(Ordering::Relaxed) { Err(Failure::Stopped) } else { Ok(()) }
    }
}

/// The tables a stage reads, by port.
#[derive(Default)]
pub struct Inputs<'a> {
    pub ports: BTreeMap<String, Vec<&'a Table>>,
}

impl<'a> Inputs<'a> {
    /// # Errors
    /// When the port or the table is not there: a mistake of this program, kept from being a panic.
    pub fn table(&self, port: &str, table: &str) -> Result<&'a Table, Failure> {
        let tables = self.ports.get(port).ok_or_else(|| Failure::new(format!("nothing came in through `{port}`")))?;
        let found = tables.iter().find(|candidate| candidate.name() == table).copied();
        found.ok_or_else(|| Failure::new(format!("no table `{table}` came in through `{port}`")))
    }
}
