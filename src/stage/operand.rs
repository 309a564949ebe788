//! What a name in a formula stands for: quantities as written, or cells of another stage's table.
//!
//! Must not know: verdicts. Everything is SI once it is resolved.

pub mod names;
pub mod rows;

use crate::stage::Inputs;
use crate::stage::quantity::{Number, described, read};
use declare::declared::Placed;
use declare::error::{Diagnostic, Place};
use declare::number::{significant, with_unit};
use declare::units::{UnitError, parse_quantity, split_quantity};
use studygraph::study::notation;
use studygraph::table::data::{Cell, Data, Table};
use studygraph::table::select::{CellName, rows_where, unknown_column, why_none};

/// A quantity or cells, as written.
#[derive(Clone, Debug)]
pub struct Operand {
    pub text: String,
    /// Where it stands.
    pub place: Place,
    /// Where its rows are said: there too, unless it is a column of something that is said once.
    pub rows: Place,
    pub source: Source,
}

#[derive(Clone, Debug)]
pub enum Source {
    /// One, or several of one dimension; with the first one's unit.
    Quantities {
        numbers: Vec<Number>,
        unit: String,
    },
    Cells(CellName),
}

impl Operand {
    /// Reads `50 N m`, or `0.51 mm, 0.49 mm`, or `ste.summary[design=iso].peak_to_peak`.
    ///
    /// # Errors
    /// At its place: what was expected.
    pub fn read(Placed { value, place }: &Placed<String>) -> Result<Self, Diagnostic> {
        let text = value.trim();
        let source = Self::source(text).map_err(|message| Diagnostic::new(message).at(*place))?;
        Ok(Self { text: text.to_owned(), place: *place, rows: *place, source })
    }

    fn source(text: &str) -> Result<Source, String> {
        let first = text.split(',').next().unwrap_or_default();
        match parse_quantity(first) {
            Err(UnitError::NotANumber(_)) => {
                let name = CellName::parse(text).map_err(|_| {
                    format!("`{text}` is neither a quantity (`50 N m`) nor a cell (`stage.table[key=value, …].column`)")
                })?;
                Ok(Source::Cells(name))
            }
            _ => Ok(Source::Quantities { numbers: quantities(text)?, unit: split_quantity(first.trim()).1.to_owned() }),
        }
    }

    /// The same, with its rows said elsewhere.
    #[must_use]
    pub fn with_rows_at(self, rows: Place) -> Self {
        Self { rows, ..self }
    }

    /// What is wrong with it.
    pub fn refused(&self, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(message).at(self.place)
    }

    #[must_use]
    pub fn cell(&self) -> Option<&CellName> {
        match &self.source {
            Source::Cells(name) => Some(name),
            Source::Quantities { .. } => None,
        }
    }

    /// Looks the values up.
    ///
    /// # Errors
    /// When no row meets the conditions, or the column holds no numbers.
    pub fn resolve(&self, inputs: &Inputs) -> Result<Values, Diagnostic> {
        match &self.source {
            Source::Quantities { numbers, unit } => Ok(Values {
                numbers: numbers.clone(),
                unit: unit.clone(),
                keys: Vec::new(),
                rows: vec![Vec::new(); numbers.len()],
            }),
            Source::Cells(name) => {
                let rows = rows(name, inputs).map_err(|problem| {
                    let of = self.text.rsplit_once('.').map_or(self.text.as_str(), |(of, _)| of);
                    Diagnostic::new(format!("`{of}`: {problem}")).at(self.rows)
                })?;
                cells(name, &rows, inputs).map_err(|problem| self.refused(format!("`{}`: {problem}", self.text)))
            }
        }
    }
}

/// Quantities with commas between.
fn quantities(text: &str) -> Result<Vec<Number>, String> {
    let mut numbers: Vec<Number> = Vec::new();
    for item in text.split(',').map(str::trim) {
        let quantity = read(item).map_err(|error| format!("`{item}`: {error}"))?;
        let number = Number { si: quantity.value, dimension: quantity.dimension };
        if let Some(first) = numbers.first().filter(|first| !first.fits(number)) {
            let (a, b) = (described(first.dimension), described(number.dimension));
            let meant = notation::without_commas(text, &|_| 0.0).filter(|_| text.matches(',').count() == 1);
            let comma = meant.map_or_else(String::new, |meant| format!("; with a decimal comma, {meant}"));
            return Err(format!("`{text}` lists {a} and {b}{comma}"));
        }
        numbers.push(number);
    }
    Ok(numbers)
}

/// The values an operand stands for: one, or one per row.
#[derive(Clone, Debug)]
pub struct Values {
    pub numbers: Vec<Number>,
    /// As written, or the column's.
    pub unit: String,
    /// The key columns that tell the rows apart: those that no condition fixes.
    pub keys: Vec<String>,
    /// Their values, for each row.
    pub rows: Vec<Vec<Key>>,
}

impl Values {
    /// The only value.
    ///
    /// # Errors
    /// When there are several rows: names the columns that would tell them apart.
    pub fn single(&self, of: &Operand) -> Result<Number, Diagnostic> {
        match self.numbers.as_slice() {
            [only] => Ok(*only),
            several => {
                let wrong = of.refused(format!("`{}` names {} rows where one is meant", of.text, several.len()));
                Err(if self.keys.is_empty() { wrong } else { wrong.help(format!("add {}", self.keys.join(", "))) })
            }
        }
    }
}

/// One key value of a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    value: Cell,
    unit: String,
}

impl std::fmt::Display for Key {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.value {
            Cell::Float(value) => formatter.write_str(&with_unit(&significant(*value, 6), &self.unit)),
            other => write!(formatter, "{other}"),
        }
    }
}

/// A number of a column in SI; on the decimal text, so that the bits are those of the quantity as a user writes it.
///
/// # Errors
/// When the column's unit is none.
pub fn in_si(value: f64, unit: &str) -> Result<Number, String> {
    let quantity = parse_quantity(&format!("{value:e} {unit}")).map_err(|error| error.to_string())?;
    Ok(Number { si: quantity.value, dimension: quantity.dimension })
}

/// The table a cell is in.
///
/// # Errors
/// When it did not come in.
pub fn table<'a>(stage: &str, table: &str, inputs: &Inputs<'a>) -> Result<&'a Table, String> {
    inputs.table(stage, table).map_err(|failure| failure.to_string())
}

/// The rows that meet the conditions.
fn rows(name: &CellName, inputs: &Inputs) -> Result<Vec<usize>, String> {
    let table = table(&name.stage, &name.table, inputs)?;
    let rows = rows_where(table, &name.conditions)?;
    if rows.is_empty() { Err(why_none(table, &name.conditions)?) } else { Ok(rows) }
}

fn cells(name: &CellName, rows: &[usize], inputs: &Inputs) -> Result<Values, String> {
    let table = table(&name.stage, &name.table, inputs)?;
    let schema = table.schema();
    let index = schema.position(&name.column).ok_or_else(|| unknown_column(schema, &name.column))?;
    let column = &schema.columns[index];
    if column.volatile {
        return Err(format!("column `{}` differs from run to run, so no verdict can stand on it", column.name));
    }
    let value = |row: usize| match &table.columns()[index] {
        Data::Float(values) => Ok(values[row]),
        Data::Integer(values) => Ok(values[row] as f64),
        _ => Err(format!("column `{}` holds {}s, not numbers", column.name, column.kind.name())),
    };
    let number = |row: usize| {
        let value = value(row)?;
        if value.is_finite() { in_si(value, &column.unit) } else { Err(format!("column `{}` is {value}", column.name)) }
    };
    let free: Vec<usize> = schema
        .key_columns()
        .filter(|&key| name.conditions.iter().all(|(condition, _)| *condition != schema.columns[key].name))
        .collect();
    let key =
        |row: usize, key: usize| Key { value: table.columns()[key].cell(row), unit: schema.columns[key].unit.clone() };
    Ok(Values {
        numbers: rows.iter().map(|&row| number(row)).collect::<Result<_, _>>()?,
        unit: column.unit.clone(),
        keys: free.iter().map(|&key| schema.columns[key].name.clone()).collect(),
        rows: rows.iter().map(|&row| free.iter().map(|&column| key(row, column)).collect()).collect(),
    })
}
