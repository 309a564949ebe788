//! Naming cells: `ste.summary[design=iso, torque=50 N m].peak_to_peak`, and the rows that `key=value` pairs pick.
//!
//! Must not know: where tables come from. Values with a unit are converted to the column's; numbers match within 1e-9.

use std::collections::BTreeSet;

use super::data::{Cell, Data, Table};
use super::schema::{Column, Schema, Type};
use declare::error::{nearest, suggest};
use declare::units::{in_unit, parse_quantity, parse_unit};

/// `stage.table[key=value, …].column`; the column is empty when a whole table is meant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CellName {
    pub stage: String,
    pub table: String,
    pub conditions: Vec<(String, String)>,
    pub column: String,
}

impl CellName {
    /// Reads a cell's name.
    ///
    /// # Errors
    /// A sentence that says what was expected.
    pub fn parse(text: &str) -> Result<Self, String> {
        let expected = || format!("`{text}` is not a cell; write `stage.table[key=value, …].column`");
        let (head, conditions, tail) = match text.split_once('[') {
            Some((head, rest)) => {
                let (inside, tail) = rest.split_once(']').ok_or_else(expected)?;
                (head, parse_conditions(inside)?, tail.strip_prefix('.').ok_or_else(expected)?)
            }
            None => {
                let at = text.rfind('.').ok_or_else(expected)?;
                (&text[..at], Vec::new(), &text[at + 1..])
            }
        };
        let (stage, table) = head.split_once('.').ok_or_else(expected)?;
        if [stage, table, tail].iter().any(|part| part.trim().is_empty()) || table.contains('.') {
            return Err(expected());
        }
        Ok(Self {
            stage: stage.trim().to_owned(),
            table: table.trim().to_owned(),
            conditions,
            column: tail.trim().to_owned(),
        })
    }
}

/// Reads `key=value, key=value`.
///
/// # Errors
/// When a part has no `=`.
pub fn parse_conditions(text: &str) -> Result<Vec<(String, String)>, String> {
    text.split(',')
        .filter(|part| !part.trim().is_empty())
        .map(|part| {
            part.split_once('=')
                .map(|(key, value)| (key.trim().to_owned(), value.trim().to_owned()))
                .ok_or_else(|| format!("`{}` is not a condition; write `column=value`", part.trim()))
        })
        .collect()
}

/// A condition made ready for one column.
enum Test {
    Float(f64),
    Integer(i64),
    Text(String),
    Flag(bool),
}

impl Test {
    fn new(column: &Column, value: &str) -> Result<Self, String> {
        let wrong = |expected: &str| format!("column `{}` holds {expected}; `{value}` does not fit", column.name);
        match column.kind {
            Type::Text => Ok(Self::Text(value.to_owned())),
            Type::Flag => value.parse().map(Self::Flag).map_err(|_| wrong("true or false")),
            Type::Integer => value.parse().map(Self::Integer).map_err(|_| wrong("whole numbers")),
            Type::Float => {
                let quantity = parse_quantity(value).map_err(|_| wrong("numbers"))?;
                if !quantity.has_unit {
                    return Ok(Self::Float(quantity.value));
                }
                let unit = parse_unit(&column.unit).map_err(|_| wrong("numbers without a unit"))?;
                if unit.dimension != quantity.dimension {
                    return Err(wrong(&format!("numbers in {}", column.unit)));
                }
                Ok(Self::Float(in_unit(quantity.value, &column.unit)))
            }
        }
    }

    fn is_met(&self, cell: &Cell) -> bool {
        match (self, cell) {
            (Self::Float(wanted), Cell::Float(value)) => is_same(*wanted, *value),
            (Self::Integer(wanted), Cell::Integer(value)) => wanted == value,
            (Self::Text(wanted), Cell::Text(value)) => wanted == value,
            (Self::Flag(wanted), Cell::Flag(value)) => wanted == value,
            _ => false,
        }
    }

    /// The same without making a cell of every row.
    fn holds(&self, data: &Data, row: usize) -> bool {
        match (self, data) {
            (Self::Float(wanted), Data::Float(values)) => is_same(*wanted, values[row]),
            (Self::Integer(wanted), Data::Integer(values)) => values[row] == *wanted,
            (Self::Text(wanted), Data::Text(values)) => values[row] == *wanted,
            (Self::Flag(wanted), Data::Flag(values)) => values[row] == *wanted,
            _ => false,
        }
    }
}

fn is_same(wanted: f64, value: f64) -> bool {
    (wanted - value).abs() <= 1e-9 * wanted.abs().max(value.abs())
}

/// Checks that the conditions fit the columns, without any rows.
///
/// # Errors
/// An unknown column (with the nearest known), or a value that does not fit its type or unit.
pub fn check_conditions(schema: &Schema, conditions: &[(String, String)]) -> Result<(), String> {
    tests(schema, conditions).map(drop)
}

fn tests(schema: &Schema, conditions: &[(String, String)]) -> Result<Vec<(usize, Test)>, String> {
    conditions
        .iter()
        .map(|(name, value)| {
            let index = schema.position(name).ok_or_else(|| unknown_column(schema, name))?;
            Ok((index, Test::new(&schema.columns[index], value)?))
        })
        .collect()
}

/// The message for a column that a table does not have.
#[must_use]
pub fn unknown_column(schema: &Schema, name: &str) -> String {
    let names = schema.columns.iter().map(|column| column.name.as_str());
    format!("table `{}` has no column `{name}`; {}", schema.name, suggest(name, names))
}

/// The rows that meet every condition, in order.
///
/// # Errors
/// As [`check_conditions`].
pub fn rows_where(table: &Table, conditions: &[(String, String)]) -> Result<Vec<usize>, String> {
    let tests = tests(table.schema(), conditions)?;
    let holds = |row: usize| tests.iter().all(|(column, test)| test.holds(&table.columns()[*column], row));
    Ok((0..table.rows()).filter(|&row| holds(row)).collect())
}

/// Values that a message lists.
const MOST_VALUES: usize = 12;

/// Why no row meets the conditions: the first that leaves none, and the values that its column has in the rows until then.
///
/// # Errors
/// As [`check_conditions`].
pub fn why_none(table: &Table, conditions: &[(String, String)]) -> Result<String, String> {
    let mut rows: Vec<usize> = (0..table.rows()).collect();
    for ((name, value), (column, test)) in conditions.iter().zip(tests(table.schema(), conditions)?) {
        let data = &table.columns()[column];
        let kept: Vec<usize> = rows.iter().copied().filter(|&row| test.holds(data, row)).collect();
        if kept.is_empty() {
            let cells = rows.iter().map(|&row| data.cell(row));
            let there = there(&table.schema().columns[column], value, cells);
            return Ok(format!("no row has `{name}={value}`; {there}"));
        }
        rows = kept;
    }
    Ok("the table has no rows".to_owned())
}

/// Which values there are instead, where a condition on a column holds for none of them.
#[must_use]
pub fn unmet(column: &Column, value: &str, values: &[Cell]) -> Option<String> {
    let test = Test::new(column, value).ok()?;
    (!values.iter().any(|cell| test.is_met(cell))).then(|| there(column, value, values.iter().cloned()))
}

/// The condition that a value of a column meets.
#[must_use]
pub fn condition(column: &Column, value: &Cell) -> String {
    format!("{}={}", column.name, written(column, value))
}

/// A value as conditions have it.
fn written(column: &Column, value: &Cell) -> String {
    match value {
        Cell::Float(value) if !column.unit.is_empty() => format!("{value} {}", column.unit),
        value => value.to_string(),
    }
}

/// The values of a column, as conditions have them, in the order in which they come; the nearest first.
fn there(column: &Column, value: &str, cells: impl Iterator<Item = Cell>) -> String {
    let mut seen = BTreeSet::new();
    let texts = cells.map(|cell| written(column, &cell));
    let values: Vec<String> = texts.filter(|text| seen.insert(text.clone())).collect();
    let names = values.iter().map(String::as_str);
    let near = nearest(value, names.clone()).filter(|_| column.kind == Type::Text);
    let more = values.len().saturating_sub(MOST_VALUES);
    let mut listed: Vec<String> = names.take(MOST_VALUES).map(|value| format!("`{value}`")).collect();
    if more > 0 {
        listed.push(format!("and {more} more"));
    }
    let near = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
    format!("{near}there: {}", listed.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let schema = Schema::new(
            "summary",
            "",
            vec![
                Column::text("design", "").key(),
                Column::float("torque", "N m", "").key(),
                Column::float("peak_to_peak", "um", ""),
            ],
        );
        let rows = vec![
            vec!["iso".into(), 50.0.into(), 0.7.into()],
            vec!["iso".into(), 25.0.into(), 0.5.into()],
            vec!["none".into(), 50.0.into(), 2.3.into()],
        ];
        Table::from_rows(schema, rows).unwrap()
    }

    #[test]
    fn cells_are_found_by_key_in_any_unit() {
        let name = CellName::parse("ste.summary[design=iso, torque=50000 N mm].peak_to_peak").unwrap();
        assert_eq!(
            (name.stage.as_str(), name.table.as_str(), name.column.as_str()),
            ("ste", "summary", "peak_to_peak")
        );
        assert_eq!(rows_where(&table(), &name.conditions).unwrap(), vec![1]);
        assert_eq!(CellName::parse("a.b.c").unwrap().conditions, vec![]);
    }

    #[test]
    fn wrong_conditions_say_what_is_known() {
        let error = rows_where(&table(), &[("desing".into(), "iso".into())]).unwrap_err();
        assert!(error.contains("did you mean `design`?"), "{error}");
        assert!(rows_where(&table(), &[("torque".into(), "50 mm".into())]).unwrap_err().contains("N m"));
        assert!(CellName::parse("nonsense").is_err());
        assert!(CellName::parse("a.b[x=1]").is_err());
    }

    #[test]
    fn conditions_that_no_row_meets_say_what_there_is() {
        let why = |conditions: &[(&str, &str)]| {
            let owned: Vec<_> = conditions.iter().map(|(name, value)| ((*name).into(), (*value).into())).collect();
            why_none(&table(), &owned).unwrap()
        };
        assert_eq!(why(&[("design", "isso")]), "no row has `design=isso`; did you mean `iso`? there: `iso`, `none`");
        assert_eq!(why(&[("torque", "55 N m")]), "no row has `torque=55 N m`; there: `25 N m`, `50 N m`");
        // Of the rows that met what came before.
        assert_eq!(why(&[("design", "none"), ("torque", "25")]), "no row has `torque=25`; there: `50 N m`");
    }

    #[test]
    fn rows_are_sorted_by_key_and_keys_are_unique() {
        assert_eq!(table().floats("torque"), [25.0, 50.0, 50.0]);
        let twice = vec![vec!["a".into(), 1.0.into(), 0.0.into()], vec!["a".into(), 1.0.into(), 0.0.into()]];
        assert!(Table::from_rows(table().schema().clone(), twice).is_err());
    }
}
