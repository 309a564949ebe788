//! A table's rows: built once, checked against the schema, sorted by key, hashed by content.

use std::cmp::Ordering;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::derived::Derived;
use super::schema::{Column, Schema, Type};

/// The values of one column.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Data {
    Float(Vec<f64>),
    Integer(Vec<i64>),
    Text(Vec<String>),
    Flag(Vec<bool>),
}

impl Data {
    #[must_use]
    pub fn empty(kind: Type) -> Self {
        match kind {
            Type::Float => Self::Float(Vec::new()),
            Type::Integer => Self::Integer(Vec::new()),
            Type::Text => Self::Text(Vec::new()),
            Type::Flag => Self::Flag(Vec::new()),
        }
    }

    /// Empty, with room for so many values.
    #[must_use]
    pub fn with_room(kind: Type, rows: usize) -> Self {
        match kind {
            Type::Float => Self::Float(Vec::with_capacity(rows)),
            Type::Integer => Self::Integer(Vec::with_capacity(rows)),
            Type::Text => Self::Text(Vec::with_capacity(rows)),
            Type::Flag => Self::Flag(Vec::with_capacity(rows)),
        }
    }

    #[must_use]
    pub fn kind(&self) -> Type {
        match self {
            Self::Float(_) => Type::Float,
            Self::Integer(_) => Type::Integer,
            Self::Text(_) => Type::Text,
            Self::Flag(_) => Type::Flag,
        }
    }

    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Float(values) => values.len(),
            Self::Integer(values) => values.len(),
            Self::Text(values) => values.len(),
            Self::Flag(values) => values.len(),
        }
    }

    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One cell.
    ///
    /// # Panics
    /// When `row` is out of range.
    #[must_use]
    pub fn cell(&self, row: usize) -> Cell {
        match self {
            Self::Float(values) => Cell::Float(values[row]),
            Self::Integer(values) => Cell::Integer(values[row]),
            Self::Text(values) => Cell::Text(values[row].clone()),
            Self::Flag(values) => Cell::Flag(values[row]),
        }
    }

    /// # Errors
    /// The cell again, when it is of another type.
    pub fn push(&mut self, cell: Cell) -> Result<(), Cell> {
        match (self, cell) {
            (Self::Float(values), Cell::Float(value)) => values.push(value),
            (Self::Integer(values), Cell::Integer(value)) => values.push(value),
            (Self::Text(values), Cell::Text(value)) => values.push(value),
            (Self::Flag(values), Cell::Flag(value)) => values.push(value),
            (_, cell) => return Err(cell),
        }
        Ok(())
    }

    /// Moves all values of the other to the end of these.
    ///
    /// # Panics
    /// When they are of another type.
    pub fn append(&mut self, other: &mut Self) {
        match (self, other) {
            (Self::Float(values), Self::Float(more)) => values.append(more),
            (Self::Integer(values), Self::Integer(more)) => values.append(more),
            (Self::Text(values), Self::Text(more)) => values.append(more),
            (Self::Flag(values), Self::Flag(more)) => values.append(more),
            _ => unreachable!("tables of one schema have columns of one type"),
        }
    }

    /// The order of two rows, numbers by `total_cmp`.
    ///
    /// # Panics
    /// When a row is out of range.
    #[must_use]
    pub fn compare(&self, a: usize, b: usize) -> Ordering {
        match self {
            Self::Float(values) => values[a].total_cmp(&values[b]),
            Self::Integer(values) => values[a].cmp(&values[b]),
            Self::Text(values) => values[a].cmp(&values[b]),
            Self::Flag(values) => values[a].cmp(&values[b]),
        }
    }

    /// Some of the rows.
    ///
    /// # Panics
    /// When there are no such rows.
    #[must_use]
    pub fn slice(&self, rows: std::ops::Range<usize>) -> Self {
        match self {
            Self::Float(values) => Self::Float(values[rows].to_vec()),
            Self::Integer(values) => Self::Integer(values[rows].to_vec()),
            Self::Text(values) => Self::Text(values[rows].to_vec()),
            Self::Flag(values) => Self::Flag(values[rows].to_vec()),
        }
    }

    fn reordered(&self, order: &[usize]) -> Self {
        match self {
            Self::Float(values) => Self::Float(order.iter().map(|&row| values[row]).collect()),
            Self::Integer(values) => Self::Integer(order.iter().map(|&row| values[row]).collect()),
            Self::Text(values) => Self::Text(order.iter().map(|&row| values[row].clone()).collect()),
            Self::Flag(values) => Self::Flag(order.iter().map(|&row| values[row]).collect()),
        }
    }
}

/// One value of a row.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    Float(f64),
    Integer(i64),
    Text(String),
    Flag(bool),
}

macro_rules! cell_from {
    ($($type:ty => $variant:ident),*) => {$(
        impl From<$type> for Cell {
            fn from(value: $type) -> Self {
                Self::$variant(value.into())
            }
        }
    )*};
}
cell_from!(f64 => Float, i64 => Integer, u32 => Integer, i32 => Integer, &str => Text, String => Text, bool => Flag);

impl From<usize> for Cell {
    fn from(value: usize) -> Self {
        Self::Integer(i64::try_from(value).unwrap_or(i64::MAX))
    }
}

impl std::fmt::Display for Cell {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Float(value) => write!(formatter, "{value}"),
            Self::Integer(value) => write!(formatter, "{value}"),
            Self::Text(value) => write!(formatter, "{value}"),
            Self::Flag(value) => write!(formatter, "{value}"),
        }
    }
}

/// What is wrong with rows that should have become a table.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    #[error("table `{table}`: a row has {found} cells instead of {expected}")]
    Width { table: String, found: usize, expected: usize },
    #[error("table `{table}`, column `{column}`: {problem}")]
    Column { table: String, column: String, problem: String },
    #[error("table `{table}`: two rows have the key {key}")]
    RepeatedKey { table: String, key: String },
}

/// Rows of a schema, sorted by key, keys unique, finite (or NaN where the schema allows it).
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    schema: Arc<Schema>,
    columns: Vec<Data>,
    rows: usize,
    derived: Derived,
}

/// A row for [`Table::from_rows`]: cells in the order of the columns.
pub type Row = Vec<Cell>;

impl Table {
    /// Objects that readers derived from it.
    #[must_use]
    pub fn derived(&self) -> &Derived {
        &self.derived
    }

    /// # Errors
    /// When a row does not fit the schema, a number is not finite where it must be, or a key repeats.
    pub fn from_rows(schema: Schema, rows: Vec<Row>) -> Result<Self, TableError> {
        let room = |column: &Column| Data::with_room(column.kind, rows.len());
        let mut columns: Vec<Data> = schema.columns.iter().map(room).collect();
        for row in rows {
            if row.len() != columns.len() {
                return Err(TableError::Width { table: schema.name, found: row.len(), expected: columns.len() });
            }
            for (index, cell) in row.into_iter().enumerate() {
                if let Err(cell) = columns[index].push(cell) {
                    let problem = format!("`{cell}` is no {}", schema.columns[index].kind.name());
                    return Err(TableError::Column {
                        column: schema.columns[index].name.clone(),
                        table: schema.name,
                        problem,
                    });
                }
            }
        }
        Self::from_columns(schema, columns)
    }

    /// # Errors
    /// As [`Table::from_rows`].
    pub fn from_columns(schema: impl Into<Arc<Schema>>, columns: Vec<Data>) -> Result<Self, TableError> {
        let schema = schema.into();
        let rows = columns.first().map_or(0, Data::len);
        if columns.len() != schema.columns.len() {
            let (found, expected) = (columns.len(), schema.columns.len());
            return Err(TableError::Width { table: schema.name.clone(), found, expected });
        }
        for (column, data) in schema.columns.iter().zip(&columns) {
            let problem = if data.kind() != column.kind {
                Some(format!("holds {} instead of {}", data.kind().name(), column.kind.name()))
            } else if data.len() != rows {
                Some(format!("has {} rows instead of {rows}", data.len()))
            } else if let Data::Float(values) = data {
                let allowed = |value: &f64| value.is_finite() || (column.allows_nan && value.is_nan());
                values.iter().position(|value| !allowed(value)).map(|row| format!("row {row} is {}", values[row]))
            } else {
                None
            };
            if let Some(problem) = problem {
                return Err(TableError::Column { column: column.name.clone(), table: schema.name.clone(), problem });
            }
        }
        Self { schema, columns, rows, derived: Derived::default() }.sorted(1..rows)
    }

    /// By key; `unsure` are the rows that may not come after the one before.
    fn sorted(mut self, mut unsure: impl Iterator<Item = usize>) -> Result<Self, TableError> {
        let keys: Vec<usize> = self.schema.key_columns().collect();
        let compare = |a: usize, b: usize| {
            keys.iter()
                .map(|&key| self.columns[key].compare(a, b))
                .find(|order| order.is_ne())
                .unwrap_or(Ordering::Equal)
        };
        if !keys.is_empty() && !unsure.all(|row| compare(row - 1, row).is_lt()) {
            let mut order: Vec<usize> = (0..self.rows).collect();
            order.sort_by(|&a, &b| compare(a, b));
            if let Some(pair) = order.windows(2).find(|pair| compare(pair[0], pair[1]).is_eq()) {
                let key: Vec<String> = keys.iter().map(|&key| self.columns[key].cell(pair[0]).to_string()).collect();
                return Err(TableError::RepeatedKey { table: self.schema.name.clone(), key: key.join(", ") });
            }
            // One after the other: two of a column are held, not two of the table.
            for column in &mut self.columns {
                *column = column.reordered(&order);
            }
        }
        Ok(self)
    }

    /// The rows of several tables of one schema as one table: the chunks of a stage put together.
    ///
    /// # Errors
    /// When the schemas differ, or a key repeats.
    pub fn concatenated(mut parts: Vec<Self>) -> Result<Option<Self>, TableError> {
        if parts.len() < 2 {
            return Ok(parts.pop());
        }
        let schema = Arc::clone(&parts[0].schema);
        if parts.iter().any(|part| part.schema != schema) {
            return Err(TableError::Column {
                table: schema.name.clone(),
                column: String::new(),
                problem: "two chunks have different columns".to_owned(),
            });
        }
        let rows = parts.iter().map(|part| part.rows).sum();
        // Only where two parts meet can rows be out of order.
        let starts = parts.iter().scan(0, |end, part| Some(std::mem::replace(end, *end + part.rows)));
        let borders: Vec<usize> = starts.filter(|&row| row > 0 && row < rows).collect();
        let columns = Self::chained(parts)?;
        Self { schema, columns, rows, derived: Derived::default() }.sorted(borders.into_iter()).map(Some)
    }

    /// The columns of several tables of one schema, one table after the other.
    ///
    /// # Errors
    /// When the schemas differ.
    pub fn chained(mut parts: Vec<Self>) -> Result<Vec<Data>, TableError> {
        let Some(first) = parts.first() else { return Ok(Vec::new()) };
        let schema = Arc::clone(&first.schema);
        if parts.iter().any(|part| !Arc::ptr_eq(&part.schema, &schema) && part.schema != schema) {
            return Err(TableError::Column {
                table: schema.name.clone(),
                column: String::new(),
                problem: "two parts have different columns".to_owned(),
            });
        }
        let rows = parts.iter().map(|part| part.rows).sum();
        // One after the other: what is held twice is a column, not the table.
        let mut columns = Vec::with_capacity(schema.columns.len());
        for (index, column) in schema.columns.iter().enumerate() {
            let mut whole = Data::with_room(column.kind, rows);
            for part in &mut parts {
                whole.append(&mut std::mem::replace(&mut part.columns[index], Data::empty(column.kind)));
            }
            columns.push(whole);
        }
        Ok(columns)
    }

    #[must_use]
    pub fn schema(&self) -> &Schema {
        &self.schema
    }

    /// The same, for those who keep it.
    #[must_use]
    pub fn shared_schema(&self) -> &Arc<Schema> {
        &self.schema
    }

    #[must_use]
    pub fn name(&self) -> &str {
        &self.schema.name
    }

    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    #[must_use]
    pub fn columns(&self) -> &[Data] {
        &self.columns
    }

    #[must_use]
    pub fn column(&self, name: &str) -> Option<&Data> {
        self.schema.position(name).map(|index| &self.columns[index])
    }

    /// # Panics
    /// When there is no such column of numbers: names of columns are literals of this program.
    #[must_use]
    pub fn floats(&self, name: &str) -> &[f64] {
        match self.column(name) {
            Some(Data::Float(values)) => values,
            _ => panic!("table `{}` has no column of numbers `{name}`", self.schema.name),
        }
    }

    /// # Panics
    /// As [`Table::floats`].
    #[must_use]
    pub fn integers(&self, name: &str) -> &[i64] {
        match self.column(name) {
            Some(Data::Integer(values)) => values,
            _ => panic!("table `{}` has no column of integers `{name}`", self.schema.name),
        }
    }

    /// # Panics
    /// As [`Table::floats`].
    #[must_use]
    pub fn texts(&self, name: &str) -> &[String] {
        match self.column(name) {
            Some(Data::Text(values)) => values,
            _ => panic!("table `{}` has no column of words `{name}`", self.schema.name),
        }
    }
}

#[cfg(test)]
mod tests;
