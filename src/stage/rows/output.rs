//! What is asked of every row: a number in a table of the stage.
//!
//! Must not know: how it is found.

use crate::stage::Demand;
use declare::declared::Placed;
use declare::error::{Diagnostic, suggest};
use studygraph::table::data::{Data, Table};
use studygraph::table::schema::{Column, Schema, Type};
use studygraph::table::select::{CellName, check_conditions, rows_where, unknown_column};

/// The table that is meant where none is named.
const USUAL: &str = "summary";

/// A cell of one of the stage's tables.
#[derive(Clone, Debug)]
pub struct Output {
    pub cell: CellName,
    /// As the table of rows has it.
    pub column: Column,
}

impl Output {
    /// # Errors
    /// A column that is not there, or holds no numbers.
    pub fn read(text: &Placed<String>, outputs: &[Schema]) -> Result<Self, Diagnostic> {
        let found = Self::parse(text.value.trim(), outputs);
        found.map_err(|wrong| wrong.at(text.place))
    }

    fn parse(text: &str, outputs: &[Schema]) -> Result<Self, Diagnostic> {
        let whole = if text.contains(['.', '[']) { format!("of.{text}") } else { format!("of.{USUAL}.{text}") };
        let cell = CellName::parse(&whole).map_err(|_| {
            Diagnostic::new(format!("`{text}` is not a column"))
                .help("write `column`, `table.column` or `table[key=value, …].column`")
        })?;
        let schema = outputs.iter().find(|schema| schema.name == cell.table).ok_or_else(|| {
            let names = outputs.iter().map(|schema| schema.name.as_str()).collect::<Vec<_>>();
            Diagnostic::new(format!("the stage has no table `{}`", cell.table)).help(suggest(&cell.table, names))
        })?;
        let column = schema.column(&cell.column);
        let column = column.ok_or_else(|| Diagnostic::new(unknown_column(schema, &cell.column)))?;
        if !matches!(column.kind, Type::Float | Type::Integer) {
            let message = format!("column `{}` holds {}s, not numbers", column.name, column.kind.name());
            return Err(Diagnostic::new(message));
        }
        if column.volatile {
            let message = format!("column `{}` differs from run to run, so no table of rows can keep it", column.name);
            return Err(Diagnostic::new(message));
        }
        check_conditions(schema, &cell.conditions).map_err(Diagnostic::new)?;
        let word = |text: &str| {
            let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
            text.chars().map(plain).collect::<String>()
        };
        let values = cell.conditions.iter().map(|(_, value)| format!("_{}", word(value)));
        let name = format!("{}{}", column.name, values.collect::<String>());
        let kept = Column { name, key: false, on_demand: false, kind: Type::Float, allows_nan: true, ..column.clone() };
        Ok(Self { cell, column: kept })
    }

    /// Adds the table and, where they come only on demand, the columns.
    pub fn ask(&self, outputs: &[Schema], demand: &mut Demand) {
        ask(&self.cell, outputs, demand);
    }

    /// The number in the one row that meets the conditions; `design` is another one, where the table has designs.
    ///
    /// # Errors
    /// When there is no such row, or there are several.
    pub fn take(&self, tables: &[Table], design: Option<&str>) -> Result<f64, String> {
        let table = tables.iter().find(|table| table.name() == self.cell.table);
        let table = table.ok_or_else(|| format!("the stage gave no table `{}`", self.cell.table))?;
        let mut conditions = self.cell.conditions.clone();
        if let Some(design) = design.filter(|_| table.schema().column("design").is_some()) {
            conditions.push(("design".to_owned(), design.to_owned()));
        }
        let rows = rows_where(table, &conditions)?;
        let [row] = rows[..] else {
            let keys: Vec<&str> =
                table.schema().columns.iter().filter(|column| column.key).map(|column| column.name.as_str()).collect();
            return Err(format!(
                "`{}` is found in {} rows of table `{}`; conditions on {} tell them apart",
                self.cell.column,
                rows.len(),
                table.name(),
                keys.join(", ")
            ));
        };
        Ok(match table.column(&self.cell.column) {
            Some(Data::Float(values)) => values[row],
            Some(Data::Integer(values)) => values[row] as f64,
            _ => f64::NAN,
        })
    }
}

/// Adds the table of a cell and, where they come only on demand, its columns.
pub fn ask(cell: &CellName, outputs: &[Schema], demand: &mut Demand) {
    let columns = demand.tables.entry(cell.table.clone()).or_default();
    let schema = outputs.iter().find(|schema| schema.name == cell.table);
    let named = cell.conditions.iter().map(|(column, _)| column).chain([&cell.column]);
    columns.extend(
        named.filter(|name| schema.and_then(|schema| schema.column(name)).is_some_and(|it| it.on_demand)).cloned(),
    );
}
