//! SQL over the tables of any studies and commits.
//!
//! `names` finds the tables in the text, `kinds` sees to it that no text counts as a number, `tables` reads the tables,
//! `database` hands all to SQLite and takes the rows back. Must not know: how the answer is shown; what the tables mean.

mod database;
mod kinds;
mod names;
pub mod tables;

use std::time::Duration;

use studygraph::table::data::Cell;
use tables::Tables;

/// The rows that a query gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    pub columns: Vec<Column>,
}

/// One column of an answer; `None` where SQL says NULL.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    pub name: String,
    /// What its cells are; none where it has no cells and SQLite does not say.
    pub kind: Option<Kind>,
    pub cells: Vec<Option<Cell>>,
}

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Float,
    Integer,
    Text,
    Flag,
}

impl Column {
    #[must_use]
    pub fn is_number(&self) -> bool {
        matches!(self.kind, Some(Kind::Float | Kind::Integer))
    }
}

/// Answers one query within a time, which begins when its tables have been read.
///
/// # Errors
/// One sentence: what is wrong with the text, a table or column that is not there, or what SQLite cannot do.
pub fn ask(text: &str, tables: &mut Tables<'_>, limit: Duration) -> Result<Answer, String> {
    let query = names::parse(text)?;
    let found = query.tables.iter().map(|name| Ok((name.as_str(), tables.read(name)?)));
    let found = found.collect::<Result<Vec<_>, String>>()?;
    database::answer(&query, &found, &|table, column| tables.lacking(table, column), limit)
}
