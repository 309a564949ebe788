//! What a stage will take, said before it runs: rows, bytes, memory, time.
//!
//! Rows follow from the configuration and from the rows of what is read; where they depend on more than that they are a
//! bound or a guess, and say so. Memory is a bound from above of what the allocator is asked for; time is counted work times
//! what a unit takes, right to a factor of three. Must not know: limits, the runner.

use std::collections::BTreeMap;

use crate::stage::Demand;
use crate::table::schema::{Schema, Type};
use declare::work::Work;

/// How many rows a table will have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowCount {
    pub count: u64,
    pub certainty: Certainty,
}

/// How much is known of a number, from best to worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Certainty {
    Exact,
    AtMost,
    /// Right to a factor of two.
    About,
}

impl Certainty {
    /// Before a number; nothing where it is exact.
    #[must_use]
    pub fn sign(self) -> &'static str {
        match self {
            Self::Exact => "",
            Self::AtMost => "≤ ",
            Self::About => "~ ",
        }
    }

    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::AtMost => "at most",
            Self::About => "about",
        }
    }
}

impl RowCount {
    pub const NONE: Self = Self::exact(0);

    #[must_use]
    pub const fn exact(count: usize) -> Self {
        Self { count: count as u64, certainty: Certainty::Exact }
    }

    #[must_use]
    pub const fn at_most(count: usize) -> Self {
        Self { count: count as u64, certainty: Certainty::AtMost }
    }

    #[must_use]
    pub const fn about(count: usize) -> Self {
        Self { count: count as u64, certainty: Certainty::About }
    }

    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let certainty = self.certainty.max(other.certainty);
        Self { count: self.count.saturating_add(other.count), certainty }
    }

    /// As many for each of others.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        let certainty = self.certainty.max(other.certainty);
        Self { count: self.count.saturating_mul(other.count), certainty }
    }

    /// As an index; more than any machine can hold where it does not fit.
    #[must_use]
    pub fn index(self) -> usize {
        usize::try_from(self.count).unwrap_or(usize::MAX)
    }
}

/// What is known of what comes in through the ports of a stage: the rows of its tables.
#[derive(Clone, Debug, Default)]
pub struct Ahead {
    rows: BTreeMap<(String, String), RowCount>,
}

impl Ahead {
    pub fn know(&mut self, port: &str, table: &str, rows: RowCount) {
        self.rows.insert((port.to_owned(), table.to_owned()), rows);
    }

    /// None, where nothing is known of it.
    #[must_use]
    pub fn rows(&self, port: &str, table: &str) -> RowCount {
        self.rows.get(&(port.to_owned(), table.to_owned())).copied().unwrap_or(RowCount::about(0))
    }

    /// The same under the names that a port has for somebody else.
    #[must_use]
    pub fn renamed(&self, name: impl Fn(&str) -> Option<String>) -> Self {
        let renamed = self.rows.iter().filter_map(|((port, table), rows)| Some(((name(port)?, table.clone()), *rows)));
        Self { rows: renamed.collect() }
    }
}

/// What a stage will take.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The demanded tables.
    pub tables: Vec<(String, RowCount)>,
    /// Bytes that its tables hold in memory.
    pub held: u64,
    /// The most bytes that it holds at once, tables included, until they are stored.
    pub memory: u64,
    /// Bytes of all its tables as files, at most.
    pub bytes: u64,
    pub work: Work,
    /// On one thread.
    pub seconds: f64,
    /// Whether it uses all threads by itself.
    pub parallel: bool,
}

/// Bytes that a word takes beside its place in the column, in memory and in a file.
const WORD: u64 = 24;
/// Bytes of a file's own for every column: its description and its statistics.
const OF_COLUMN: u64 = 1200;
/// Bytes in memory while a column is written, however short it is.
const WHILE_WRITTEN: u64 = 40_000;
/// Seconds to make a cell, to sort, digest, compress, store and publish it.
const CELL_SECONDS: f64 = 6e-7;
/// How many times as long counted work takes as in a loop of its own on a quiet machine: stages run beside each other, and
/// what they count is not all they do.
const PACE: f64 = 4.0;
/// Seconds that storing an entry takes.
const ENTRY_SECONDS: f64 = 5e-3;

impl Estimate {
    /// Nothing yet; `parallel` says whether the stage uses all threads.
    #[must_use]
    pub fn new(parallel: bool) -> Self {
        Self { parallel, seconds: ENTRY_SECONDS, ..Self::default() }
    }

    /// A table that is made by columns; nothing where nobody asks for it.
    #[must_use]
    pub fn columns(mut self, demand: &Demand, schema: Schema, rows: RowCount) -> Self {
        if !demand.table(&schema.name) {
            return self;
        }
        let schema = demand.narrowed(schema);
        let of_type = |kind: Type| schema.columns.iter().filter(|column| column.kind == kind).count() as u64;
        let numbers = of_type(Type::Float) + of_type(Type::Integer);
        let (words, flags) = (of_type(Type::Text), of_type(Type::Flag));
        let times = |each: u64| rows.count.saturating_mul(each);
        let held = times(8 * numbers + flags + words * (24 + WORD));
        // As Arrow's arrays, as encoded pages, and as the file.
        let written = times(8 * numbers + flags + words * (4 + WORD));
        let columns = schema.columns.len() as u64;
        let writing = columns * WHILE_WRITTEN;
        self.bytes = self.bytes.saturating_add(written + columns * OF_COLUMN);
        self.held = self.held.saturating_add(held);
        self.memory = self.memory.max(writing).saturating_add(held).saturating_add(written.saturating_mul(2));
        self.seconds += rows.count as f64 * columns as f64 * CELL_SECONDS;
        self.tables.push((schema.name, rows));
        self
    }

    /// A table that is made of rows, which are all there before it is.
    #[must_use]
    pub fn rows(mut self, demand: &Demand, schema: Schema, rows: RowCount) -> Self {
        if demand.table(&schema.name) {
            let row = 24 * (schema.columns.len() as u64 + 1);
            self.memory = self.memory.saturating_add(rows.count.saturating_mul(row));
        }
        self.columns(demand, schema, rows)
    }

    /// Bytes that it holds while it computes, beside its tables.
    #[must_use]
    pub fn holding(mut self, bytes: u64) -> Self {
        self.memory = self.memory.saturating_add(bytes);
        self
    }

    /// Work, and how many times as long as usual each unit of it takes here.
    #[must_use]
    pub fn work(mut self, work: &Work, times: f64) -> Self {
        self.work = self.work.and(work);
        self.seconds += PACE * times * work.seconds();
        self
    }

    /// Time for what nobody counts.
    #[must_use]
    pub fn taking(mut self, seconds: f64) -> Self {
        self.seconds += seconds;
        self
    }

    /// Rows of all its tables.
    #[must_use]
    pub fn total(&self) -> RowCount {
        self.tables.iter().fold(RowCount::NONE, |total, (_, rows)| total.and(*rows))
    }

    /// The rows of one table.
    #[must_use]
    pub fn of_table(&self, name: &str) -> Option<RowCount> {
        self.tables.iter().find(|(table, _)| table == name).map(|(_, rows)| *rows)
    }
}
