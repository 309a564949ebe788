//! A query, asked of polars; the only file that names it.
//!
//! Numbers that do not apply (NaN in a table) are NULL in SQL, so that sums and means leave them out. Must not know:
//! where tables come from.

use std::any::Any;
use std::cmp::Ordering;
use std::panic::{AssertUnwindSafe, catch_unwind};

use polars::prelude::{AnyValue, Column as Series, DataFrame, IntoColumn, IntoLazy, NamedFrom, Series as Values};
use polars::sql::SQLContext;

use super::names::Parsed;
use super::{Answer, Column, memory};
use declare::error::suggest;
use studygraph::table::data::{Cell, Data, Table};

/// Bytes of what polars says; what is longer is a plan, or the query again as it was parsed.
const LONGEST_SENTENCE: usize = 240;
/// Values of an answer; each takes some thirty bytes until it is written.
const MOST_VALUES: usize = 20_000_000;

/// Asks the query of tables under the names it calls them by.
///
/// # Errors
/// One sentence.
pub(super) fn answer(query: &Parsed, tables: &[(&str, Table)]) -> Result<Answer, String> {
    let mut context = SQLContext::new();
    for (name, table) in tables {
        context.register(name, frame(table).map_err(|error| failed(&error.to_string(), tables))?.lazy());
    }
    let text = query.text.clone();
    let ask = move || context.execute(&text).and_then(polars::prelude::LazyFrame::collect);
    // polars has panics for queries that it did not foresee.
    let outcome = memory::within(memory::MOST, || catch_unwind(AssertUnwindSafe(ask)))?;
    let rows = outcome.map_err(|panic| said(&*panic))?.map_err(|error| failed(&error.to_string(), tables))?;
    if rows.height().saturating_mul(rows.width()) > MOST_VALUES {
        let (height, width) = (rows.height(), rows.width());
        return Err(format!(
            "the answer has {height} rows of {width} columns; at most {MOST_VALUES} values are given: choose fewer with \
             WHERE or LIMIT, or sum up with GROUP BY"
        ));
    }
    let mut columns: Vec<Column> = rows.columns().iter().map(column).collect::<Result<_, _>>()?;
    if !query.ordered {
        sort(&mut columns, rows.height());
    }
    Ok(Answer { columns })
}

fn frame(table: &Table) -> polars::prelude::PolarsResult<DataFrame> {
    let column = |(name, data): (&str, &Data)| {
        let values = match data {
            Data::Float(values) => {
                let values: Vec<_> = values.iter().map(|value| (!value.is_nan()).then_some(*value)).collect();
                Values::new(name.into(), values)
            }
            Data::Integer(values) => Values::new(name.into(), values),
            Data::Text(values) => Values::new(name.into(), values),
            Data::Flag(values) => Values::new(name.into(), values),
        };
        values.into_column()
    };
    let names = table.schema().columns.iter().map(|column| column.name.as_str());
    DataFrame::new(table.rows(), names.zip(table.columns()).map(column).collect())
}

fn column(series: &Series) -> Result<Column, String> {
    let cell = |row: usize| {
        let value = series.get(row).map_err(|error| first_sentence(&error.to_string()))?;
        Ok(match value {
            AnyValue::Null => None,
            AnyValue::Boolean(flag) => Some(Cell::Flag(flag)),
            AnyValue::Float32(number) => Some(Cell::Float(f64::from(number))),
            AnyValue::Float64(number) => Some(Cell::Float(number)),
            AnyValue::String(text) => Some(Cell::Text(text.to_owned())),
            AnyValue::StringOwned(text) => Some(Cell::Text(text.to_string())),
            other => Some(match other.extract::<i64>().filter(|_| other.is_integer()) {
                Some(number) => Cell::Integer(number),
                // Dates and lists, which no table has, but SQL can make.
                None => Cell::Text(other.to_string()),
            }),
        })
    };
    let cells = (0..series.len()).map(cell).collect::<Result<Vec<_>, String>>()?;
    Ok(Column { name: series.name().to_string(), is_number: series.dtype().is_numeric(), cells })
}

/// Groups come in no order, another one every time: by their values they come in one.
fn sort(columns: &mut [Column], height: usize) {
    let mut rows: Vec<usize> = (0..height).collect();
    rows.sort_by(|&a, &b| {
        let orders = columns.iter().map(|column| order(column.cells[a].as_ref(), column.cells[b].as_ref()));
        orders.into_iter().find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
    });
    for column in columns {
        column.cells = rows.iter().map(|&row| column.cells[row].clone()).collect();
    }
}

/// NULL behind everything else.
fn order(a: Option<&Cell>, b: Option<&Cell>) -> Ordering {
    match (a, b) {
        (Some(Cell::Float(a)), Some(Cell::Float(b))) => a.total_cmp(b),
        (Some(Cell::Integer(a)), Some(Cell::Integer(b))) => a.cmp(b),
        (Some(Cell::Text(a)), Some(Cell::Text(b))) => a.cmp(b),
        (Some(Cell::Flag(a)), Some(Cell::Flag(b))) => a.cmp(b),
        (a, b) => a.is_none().cmp(&b.is_none()),
    }
}

/// What polars says of a query that it will not do, with the nearest column where it misses one.
fn failed(said: &str, tables: &[(&str, Table)]) -> String {
    let twice = ["duplicate output name '", "the name '"].iter().find_map(|lead| said.split_once(lead));
    if let Some((name, _)) = twice.filter(|_| said.contains("duplicate")).and_then(|(_, rest)| rest.split_once('\'')) {
        return format!("two columns of the answer are called `{name}`; give one another name with AS");
    }
    let missing = ["unable to find column \"", "no column named '", "Column(s) not found: "];
    let missing = missing.iter().find_map(|lead| said.split_once(lead).map(|(_, rest)| rest));
    let Some(rest) = missing else { return first_sentence(said) };
    let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
    let name = &rest[..end];
    let mut known: Vec<&str> =
        tables.iter().flat_map(|(_, table)| &table.schema().columns).map(|column| column.name.as_str()).collect();
    known.sort_unstable();
    known.dedup();
    format!("there is no column `{name}`; {}", suggest(name, known))
}

/// Behind it polars tells of its plan; where it tells how it reads the query inside, of no use to who wrote it.
fn first_sentence(said: &str) -> String {
    let line = said.lines().find(|line| !line.trim().is_empty()).unwrap_or_default().trim();
    if ["big-idx", "bigidx", "2^32"].iter().any(|word| line.contains(word)) {
        return "the query has more than 4294967295 rows on its way: join on more columns".to_owned();
    }
    let inside = ["{", "::", "Some(", "polars", "assertion", "unwrap", "Err value", "dsl", "IR "];
    if line.is_empty() || line.len() > LONGEST_SENTENCE || inside.iter().any(|word| line.contains(word)) {
        return "the query cannot be answered: it has a part that is SQL, but not known here".to_owned();
    }
    format!("the query cannot be answered: {line}")
}

/// What a panic said: polars has some for queries that it did not foresee.
fn said(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    first_sentence(text.unwrap_or_default())
}
