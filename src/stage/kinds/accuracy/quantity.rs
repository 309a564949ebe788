//! What is compared: a column of a table, in the rows that meet the conditions, and how far two of them are apart.
//!
//! Must not know: what ran, or how long.

use crate::stage::Demand;
use declare::error::{Diagnostic, suggest};
use declare::number::counted;
use studygraph::table::data::{Data, Table};
use studygraph::table::schema::{Schema, Type};
use studygraph::table::select::{CellName, check_conditions, rows_where, unknown_column};

/// A column of a stage's table.
pub struct Quantity {
    /// As written.
    pub name: String,
    cell: CellName,
}

/// A row and its number.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// The key, `design=short, torque=50`; empty where the table has none.
    pub row: String,
    pub value: f64,
}

/// How far a variant is off, in the row where it is farthest off relative to the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Distance {
    pub row: String,
    pub value: f64,
    pub reference: f64,
}

impl Distance {
    /// In the column's unit.
    pub fn absolute(&self) -> f64 {
        if self.value.is_nan() && self.reference.is_nan() { 0.0 } else { (self.value - self.reference).abs() }
    }

    /// Over the reference; NaN where that is 0 and the value is not.
    pub fn relative(&self) -> f64 {
        let absolute = self.absolute();
        if absolute == 0.0 {
            0.0
        } else if self.reference == 0.0 {
            f64::NAN
        } else {
            absolute / self.reference.abs()
        }
    }

    /// For ordering: what cannot be said counts as farthest off.
    pub fn rank(&self) -> f64 {
        let relative = self.relative();
        if relative.is_nan() { f64::INFINITY } else { relative }
    }
}

impl Quantity {
    /// # Errors
    /// A sentence that says what was expected.
    pub fn read(text: &str) -> Result<Self, String> {
        let name = text.trim().to_owned();
        let cell = CellName::parse(&format!("stage.{name}"))
            .map_err(|_| format!("`{name}` is not a column; write `table.column` or `table[key=value, …].column`"))?;
        Ok(Self { name, cell })
    }

    fn schema<'a>(&self, outputs: &'a [Schema]) -> Option<&'a Schema> {
        outputs.iter().find(|schema| schema.name == self.cell.table)
    }

    /// # Errors
    /// When there is no such table, column or condition, or the column holds no numbers.
    pub fn check(&self, outputs: &[Schema]) -> Result<(), Diagnostic> {
        let schema = self.schema(outputs).ok_or_else(|| {
            let message = format!("the stage has no table `{}`", self.cell.table);
            Diagnostic::new(message).help(suggest(&self.cell.table, outputs.iter().map(|schema| schema.name.as_str())))
        })?;
        let column = schema.column(&self.cell.column);
        let column = column.ok_or_else(|| Diagnostic::new(unknown_column(schema, &self.cell.column)))?;
        if !matches!(column.kind, Type::Float | Type::Integer) {
            let (name, kind) = (&column.name, column.kind.name());
            return Err(Diagnostic::new(format!("column `{name}` holds {kind}s, not numbers")));
        }
        check_conditions(schema, &self.cell.conditions).map_err(Diagnostic::new)
    }

    /// Adds the table and, where they come only on demand, the columns.
    pub fn ask(&self, outputs: &[Schema], demand: &mut Demand) {
        let columns = demand.tables.entry(self.cell.table.clone()).or_default();
        let named = self.cell.conditions.iter().map(|(column, _)| column).chain([&self.cell.column]);
        let on_demand = |name: &&String| {
            let column = self.schema(outputs).and_then(|schema| schema.column(name));
            column.is_some_and(|column| column.on_demand)
        };
        columns.extend(named.filter(on_demand).cloned());
    }

    /// The column's unit.
    pub fn unit(&self, outputs: &[Schema]) -> String {
        let column = self.schema(outputs).and_then(|schema| schema.column(&self.cell.column));
        column.map_or_else(String::new, |column| column.unit.clone())
    }

    /// The numbers in all rows that meet the conditions, with the rows' keys.
    ///
    /// # Errors
    /// When the table is not there, or no row meets the conditions.
    pub fn take(&self, tables: &[Table]) -> Result<Vec<Value>, String> {
        let table = tables.iter().find(|table| table.name() == self.cell.table);
        let table = table.ok_or_else(|| format!("the stage gave no table `{}`", self.cell.table))?;
        let rows = rows_where(table, &self.cell.conditions)?;
        if rows.is_empty() {
            return Err(format!("no row of table `{}` meets the conditions of `{}`", self.cell.table, self.name));
        }
        let keys: Vec<usize> = table.schema().key_columns().collect();
        let key = |row: usize| {
            let one = |column: &usize| {
                format!("{}={}", table.schema().columns[*column].name, table.columns()[*column].cell(row))
            };
            keys.iter().map(one).collect::<Vec<_>>().join(", ")
        };
        let value = |row: usize| match table.column(&self.cell.column) {
            Some(Data::Float(values)) => values[row],
            Some(Data::Integer(values)) => values[row] as f64,
            _ => f64::NAN,
        };
        Ok(rows.into_iter().map(|row| Value { row: key(row), value: value(row) }).collect())
    }
}

/// The largest distance.
///
/// # Errors
/// When the two have different rows.
pub fn distance(values: &[Value], reference: &[Value]) -> Result<Distance, String> {
    let same = values.len() == reference.len() && values.iter().zip(reference).all(|(one, two)| one.row == two.row);
    if !same {
        let counts = format!("{} against {}", counted(values.len(), "row"), reference.len());
        return Err(format!(
            "the table has other rows than with the reference settings ({counts}), so values cannot be told apart; \
             take a table whose rows do not depend on the settings"
        ));
    }
    let one = |(value, reference): (&Value, &Value)| Distance {
        row: value.row.clone(),
        value: value.value,
        reference: reference.value,
    };
    let distances = values.iter().zip(reference).map(one);
    distances.reduce(|one, two| if two.rank() > one.rank() { two } else { one }).ok_or_else(|| "no rows".to_owned())
}
