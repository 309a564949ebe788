//! A query, asked of SQLite; the only file that names it.
//!
//! The tables are copied into a database in memory, in which numbers that do not apply (NaN in a table) are NULL, so that
//! sums and means leave them out. Must not know: where tables come from.

use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::{Duration, Instant};

use rusqlite::config::DbConfig;
use rusqlite::functions::{Aggregate, Context, FunctionFlags};
use rusqlite::limits::Limit;
use rusqlite::types::ValueRef;
use rusqlite::{Connection, Error, ErrorCode, params_from_iter};

use super::kinds::{COMPARED, IS_AMONG, IS_BETWEEN, IS_NUMBER};
use super::names::Parsed;
use super::{Answer, Column, Kind};
use declare::error::suggest;
use declare::number::counted;
use studygraph::table::data::{Cell, Data, Table};

/// Bytes that SQLite may hold, that an answer may, and that medians may: joins of large tables have more rows than any
/// machine can.
const MOST_MEMORY: usize = 2 << 30;
/// Values of an answer; each takes some thirty bytes until it is written.
const MOST_VALUES: usize = 20_000_000;
/// Bytes of one text.
const LONGEST_TEXT: i32 = 16 << 20;
/// Bytes of what SQLite says; what is longer repeats the query.
const LONGEST_SENTENCE: usize = 240;
/// Steps of SQLite's machine after which the time is compared with the limit.
const STEPS: i32 = 10_000;
/// How the sentences of our own functions begin, among those of SQLite.
const OURS: &str = "gearstudy: ";
/// Characters of a text that is shown.
const SHOWN: usize = 40;
/// How the type of a flag is called; SQLite has none of its own and keeps 0 and 1.
const FLAG: &str = "BOOLEAN";

/// What is to be done about a column that a table does not have; nothing where nobody has it.
type Lacking<'a> = &'a dyn Fn(&str, &str) -> Option<String>;

/// Asks the query of tables under the names it calls them by.
///
/// # Errors
/// One sentence.
pub(super) fn answer(
    query: &Parsed,
    tables: &[(&str, Table)],
    lacking: Lacking,
    limit: Duration,
) -> Result<Answer, String> {
    let failed = |error: Error| match error.sqlite_error_code() {
        Some(ErrorCode::OperationInterrupted) => too_long(limit),
        _ => failed(&error, tables, lacking),
    };
    let mut database = filled(tables).map_err(failed)?;
    let began = Instant::now();
    database.progress_handler(STEPS, Some(move || began.elapsed() > limit)).map_err(failed)?;
    let mut statement = database.prepare(&query.text).map_err(failed)?;
    let mut columns = Vec::new();
    for column in statement.columns() {
        let kind = match column.decl_type().unwrap_or_default() {
            "REAL" => Some(Kind::Float),
            "INTEGER" => Some(Kind::Integer),
            "TEXT" => Some(Kind::Text),
            FLAG => Some(Kind::Flag),
            _ => None,
        };
        columns.push(Column { name: column.name().to_owned(), kind, cells: Vec::new() });
    }
    let mut names = BTreeSet::new();
    if let Some(twice) = columns.iter().find(|column| !names.insert(&column.name)) {
        return Err(format!("two columns of the answer are called `{}`; give one another name with AS", twice.name));
    }
    let mut rows = statement.query([]).map_err(failed)?;
    let (mut height, width, mut held) = (0, columns.len(), 0);
    while let Some(row) = rows.next().map_err(failed)? {
        height += 1;
        if height * width > MOST_VALUES {
            return Err(format!(
                "the answer has more than {MOST_VALUES} values, in rows of {}: choose fewer with WHERE or LIMIT, or sum up \
                 with GROUP BY",
                counted(width, "column")
            ));
        }
        for (at, column) in columns.iter_mut().enumerate() {
            let cell = cell(row.get_ref(at).map_err(failed)?, column.kind == Some(Kind::Flag));
            held += if let Some(Cell::Text(text)) = &cell { text.len() } else { 0 };
            column.cells.push(cell);
        }
        if held > MOST_MEMORY {
            return Err(too_large("the answer"));
        }
    }
    let mut columns: Vec<Column> = columns.into_iter().map(of_one_kind).collect();
    if !query.ordered {
        sort(&mut columns, height);
    }
    Ok(Answer { columns })
}

fn filled(tables: &[(&str, Table)]) -> Result<Connection, Error> {
    let mut database = Connection::open_in_memory()?;
    // A name in quotes is a name: SQLite would take one that it does not know for a text.
    database.set_db_config(DbConfig::SQLITE_DBCONFIG_DQS_DML, false)?;
    database.query_row(&format!("PRAGMA hard_heap_limit = {MOST_MEMORY}"), [], |_| Ok(()))?;
    database.execute_batch("PRAGMA temp_store = MEMORY")?;
    database.set_limit(Limit::SQLITE_LIMIT_LENGTH, LONGEST_TEXT)?;
    add_functions(&database)?;
    let filling = database.transaction()?;
    for (name, table) in tables {
        let columns = table.columns();
        let kind = |data: &Data| match data {
            Data::Float(_) => "REAL",
            Data::Integer(_) => "INTEGER",
            Data::Text(_) => "TEXT",
            Data::Flag(_) => FLAG,
        };
        let names = table.schema().columns.iter().zip(columns);
        let declared: Vec<String> =
            names.map(|(column, data)| format!("{} {}", quoted(&column.name), kind(data))).collect();
        filling.execute_batch(&format!("CREATE TABLE {} ({})", quoted(name), declared.join(", ")))?;
        let places = vec!["?"; columns.len()].join(", ");
        let mut insert = filling.prepare(&format!("INSERT INTO {} VALUES ({places})", quoted(name)))?;
        for row in 0..table.rows() {
            insert.execute(params_from_iter(columns.iter().map(|data| stored(data, row))))?;
        }
    }
    filling.commit()?;
    Ok(database)
}

fn quoted(name: &str) -> String {
    format!("\"{}\"", name.replace('"', "\"\""))
}

fn stored(data: &Data, row: usize) -> rusqlite::types::ToSqlOutput<'_> {
    match data {
        // SQLite takes NaN for NULL.
        Data::Float(values) => values[row].into(),
        Data::Integer(values) => values[row].into(),
        Data::Text(values) => values[row].as_str().into(),
        Data::Flag(values) => values[row].into(),
    }
}

/// What the tables of numbers are asked for beside SQLite's own functions.
fn add_functions(database: &Connection) -> Result<(), Error> {
    type Of = fn(f64) -> f64;
    type OfTwo = fn(f64, f64) -> f64;
    let flags = FunctionFlags::SQLITE_UTF8 | FunctionFlags::SQLITE_DETERMINISTIC;
    let of_one: [(&str, Of); 16] = [
        ("acos", libm::acos),
        ("asin", libm::asin),
        ("atan", libm::atan),
        ("ceil", libm::ceil),
        ("cos", libm::cos),
        ("degrees", f64::to_degrees),
        ("exp", libm::exp),
        ("floor", libm::floor),
        ("ln", libm::log),
        ("log10", libm::log10),
        ("log2", libm::log2),
        ("radians", f64::to_radians),
        ("sin", libm::sin),
        ("sqrt", f64::sqrt),
        ("tan", libm::tan),
        ("trunc", libm::trunc),
    ];
    let of_two: [(&str, OfTwo); 4] =
        [("atan2", libm::atan2), ("mod", libm::fmod), ("pow", libm::pow), ("power", libm::pow)];
    for (name, function) in of_one {
        database.create_scalar_function(name, 1, flags, move |given| Ok(number(given, 0)?.map(function)))?;
    }
    for (name, function) in of_two {
        database.create_scalar_function(name, 2, flags, move |given| {
            Ok(number(given, 0)?.zip(number(given, 1)?).map(|(a, b)| function(a, b)))
        })?;
    }
    let of_many: [(&str, OfMany); 3] =
        [("median", median), ("stddev", |values| variance(values).map(f64::sqrt)), ("variance", variance)];
    let kept = Arc::new(AtomicUsize::new(0));
    for (name, of) in of_many {
        database.create_aggregate_function(name, 1, flags, Sample { of, kept: Arc::clone(&kept) })?;
    }
    database.create_scalar_function(IS_NUMBER, 2, flags, |given| match given.get_raw(0) {
        value @ (ValueRef::Text(_) | ValueRef::Blob(_)) => Err(no_number(value, given.get_raw(1))),
        value => Ok(rusqlite::types::Value::try_from(value)?),
    })?;
    database
        .create_scalar_function(COMPARED, 4, flags, |given| Ok(compared(given, [0, 1])?.map(|order| order as i64)))?;
    database.create_scalar_function(IS_BETWEEN, 6, flags, |given| {
        let low = compared(given, [0, 1])?.map(Ordering::is_ge);
        let high = compared(given, [0, 2])?.map(Ordering::is_le);
        // One that is missed decides, whatever is NULL.
        Ok(if [low, high].contains(&Some(false)) { Some(false) } else { low.and(high) })
    })?;
    database.create_scalar_function(IS_AMONG, -1, flags, |given| {
        let mut found = Some(false);
        for at in 1..given.len() / 2 {
            // One that is met decides, whatever is NULL.
            found = match compared(given, [0, at])? {
                Some(Ordering::Equal) => Some(true),
                None if found == Some(false) => None,
                _ => found,
            };
        }
        Ok(found)
    })?;
    Ok(())
}

fn ours(sentence: &str) -> Error {
    Error::UserFunctionError((OURS.to_owned() + sentence).into())
}

/// A value, behind the name of its column if it has one.
fn shown(value: ValueRef<'_>, name: ValueRef<'_>) -> String {
    let value = match cell(value, false) {
        Some(Cell::Text(text)) if text.chars().count() > SHOWN => text.chars().take(SHOWN).collect::<String>() + "…",
        Some(cell) => cell.to_string(),
        None => String::new(),
    };
    match name.as_str() {
        Ok(name) if !name.is_empty() => format!("`{name}` (`{value}`)"),
        _ => format!("`{value}`"),
    }
}

fn no_number(value: ValueRef<'_>, name: ValueRef<'_>) -> Error {
    ours(&format!("{} is text, and the query takes it for a number", shown(value, name)))
}

/// How two values stand to each other; the names of all follow in the second half. NULL stands to nothing.
fn compared(given: &Context<'_>, [one, two]: [usize; 2]) -> Result<Option<Ordering>, Error> {
    let (a, b) = (given.get_raw(one), given.get_raw(two));
    Ok(match (a, b) {
        (ValueRef::Null, _) | (_, ValueRef::Null) => None,
        (ValueRef::Integer(a), ValueRef::Integer(b)) => Some(a.cmp(&b)),
        (ValueRef::Text(a), ValueRef::Text(b)) | (ValueRef::Blob(a), ValueRef::Blob(b)) => Some(a.cmp(b)),
        (ValueRef::Text(_) | ValueRef::Blob(_), _) | (_, ValueRef::Text(_) | ValueRef::Blob(_)) => {
            let [a, b] = [one, two].map(|at| shown(given.get_raw(at), given.get_raw(at + given.len() / 2)));
            let is_text = matches!(given.get_raw(one), ValueRef::Text(_) | ValueRef::Blob(_));
            let (text, number) = if is_text { (a, b) } else { (b, a) };
            return Err(ours(&format!("{text} is text and {number} a number: they cannot be compared")));
        }
        _ => number(given, one)?.zip(number(given, two)?).map(|(a, b)| a.total_cmp(&b)),
    })
}

/// NULL stays NULL.
fn number(given: &Context<'_>, at: usize) -> Result<Option<f64>, Error> {
    Ok(match given.get_raw(at) {
        ValueRef::Null => None,
        #[allow(clippy::cast_precision_loss)]
        ValueRef::Integer(value) => Some(value as f64),
        ValueRef::Real(value) => Some(value),
        value => return Err(no_number(value, ValueRef::Null)),
    })
}

/// NULL where it is not defined.
type OfMany = fn(&mut [f64]) -> Option<f64>;

/// A function of all values of a group that are there.
struct Sample {
    of: OfMany,
    /// How many values all groups of all such functions keep.
    kept: Arc<AtomicUsize>,
}

impl Aggregate<Vec<f64>, Option<f64>> for Sample {
    fn init(&self, _: &mut Context<'_>) -> Result<Vec<f64>, Error> {
        Ok(Vec::new())
    }

    fn step(&self, given: &mut Context<'_>, values: &mut Vec<f64>) -> Result<(), Error> {
        values.extend(number(given, 0)?);
        if self.kept.fetch_add(1, Relaxed) > MOST_MEMORY / size_of::<f64>() {
            return Err(ours(&too_large("a median or variance")));
        }
        Ok(())
    }

    fn finalize(&self, _: &mut Context<'_>, values: Option<Vec<f64>>) -> Result<Option<f64>, Error> {
        Ok(values.and_then(|mut values| (self.of)(&mut values)))
    }
}

fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let (low, high) = (values.get(values.len().checked_sub(1)? / 2)?, values.get(values.len() / 2)?);
    Some(0.5 * low + 0.5 * high)
}

/// Of a sample: the sum of squares from the mean over one less than their number.
fn variance(values: &mut [f64]) -> Option<f64> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.len() > 1).then(|| values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0))
}

fn cell(value: ValueRef<'_>, is_flag: bool) -> Option<Cell> {
    match value {
        ValueRef::Null => None,
        ValueRef::Integer(number @ 0..=1) if is_flag => Some(Cell::Flag(number == 1)),
        ValueRef::Integer(number) => Some(Cell::Integer(number)),
        ValueRef::Real(number) => Some(Cell::Float(number)),
        ValueRef::Text(text) => Some(Cell::Text(String::from_utf8_lossy(text).into_owned())),
        ValueRef::Blob(bytes) => Some(Cell::Text(format!("{bytes:02X?}"))),
    }
}

/// SQLite has a kind for each value, a table one for each column.
fn of_one_kind(mut column: Column) -> Column {
    let kinds = column.cells.iter().flatten();
    let (mut whole, mut others) = (false, [false; 3]);
    for cell in kinds {
        match cell {
            Cell::Integer(_) => whole = true,
            Cell::Float(_) => others[0] = true,
            Cell::Text(_) => others[1] = true,
            Cell::Flag(_) => others[2] = true,
        }
    }
    let [float, text, flag] = others;
    if text && (whole || float || flag) || flag && (whole || float) {
        column.cells.iter_mut().flatten().for_each(|cell| *cell = Cell::Text(cell.to_string()));
    } else if whole && float {
        for cell in column.cells.iter_mut().flatten() {
            if let Cell::Integer(number) = cell {
                *cell = Cell::Float(*number as f64);
            }
        }
    }
    column.kind = match (text, flag, float, whole) {
        (true, ..) => Some(Kind::Text),
        (_, true, ..) => Some(if whole || float { Kind::Text } else { Kind::Flag }),
        (_, _, true, _) => Some(Kind::Float),
        (_, _, _, true) => Some(Kind::Integer),
        _ => column.kind,
    };
    column
}

/// Groups come in no order: by their values they come in one.
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

/// What SQLite says of a query that it will not do, with the nearest column where it misses one.
fn failed(error: &Error, tables: &[(&str, Table)], lacking: Lacking) -> String {
    if error.sqlite_error_code() == Some(ErrorCode::OutOfMemory) {
        return too_large("the query");
    }
    let said = match error {
        Error::SqlInputError { msg, .. } | Error::SqliteFailure(_, Some(msg)) => msg.clone(),
        other => other.to_string(),
    };
    if let Some((_, sentence)) = said.split_once(OURS) {
        return sentence.to_owned();
    }
    if let Some(name) = said.strip_prefix("no such column: ") {
        // Behind the table's name, which may have points too; of one in quotes SQLite asks whether it should be a text.
        let name = name.split(" - should").next().unwrap_or(name).trim_matches('"');
        let columns = tables.iter().flat_map(|(_, table)| &table.schema().columns);
        let known: BTreeSet<&str> = columns.map(|column| column.name.as_str()).collect();
        return match name.rsplit_once('.') {
            Some((table, column)) if known.contains(column) => {
                let help = suggest(table, tables.iter().map(|(name, _)| *name));
                format!("`{table}` is not a table of this query that has a column `{column}`; {help}")
            }
            of_table => {
                let name = of_table.map_or(name, |(_, column)| column);
                let to_be_had = tables.iter().find_map(|(table, _)| lacking(table, name));
                to_be_had.unwrap_or_else(|| format!("there is no column `{name}`; {}", suggest(name, known)))
            }
        };
    }
    let line = said.lines().find(|line| !line.trim().is_empty()).unwrap_or_default().trim();
    if line.is_empty() || line.len() > LONGEST_SENTENCE {
        return "the query cannot be answered: it has a part that is SQL, but not known here".to_owned();
    }
    format!("the query cannot be answered: {line}")
}

fn too_long(limit: Duration) -> String {
    format!(
        "the query takes more than {} s: join on more columns, choose fewer rows with WHERE, or give it longer with \
         --timeout",
        limit.as_secs()
    )
}

fn too_large(what: &str) -> String {
    let size = MOST_MEMORY >> 20;
    format!("{what} takes more than {size} MiB of memory: join on more columns, or choose fewer rows with WHERE")
}
