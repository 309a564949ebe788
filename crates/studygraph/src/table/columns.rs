//! Columns that fill themselves: each is declared once, with what it is and where its values come from.
//!
//! Schema and rows come from one list, so they cannot disagree. Must not know: what any row is.

use super::data::{Cell, Data, Table, TableError};
use super::schema::{Column, Schema};
use declare::units::showing;

/// What stands in a column in the row of a `T`.
type Getter<T> = Box<dyn Fn(&T) -> Cell>;

/// The columns of a table and how to get them from a `T`, one per row.
pub struct Columns<T> {
    schema: Schema,
    getters: Vec<Getter<T>>,
}

impl<T> Columns<T> {
    #[must_use]
    pub fn new(name: &str, description: &str) -> Self {
        Self { schema: Schema::new(name, description, Vec::new()), getters: Vec::new() }
    }

    /// A number, which `get` gives in SI; the column has it in `unit`.
    #[must_use]
    pub fn float(self, name: &str, unit: &str, description: &str, get: impl Fn(&T) -> f64 + 'static) -> Self {
        let shown = showing(unit);
        self.with(Column::float(name, unit, description), move |row| shown(get(row)))
    }

    #[must_use]
    pub fn integer<N: Into<Cell>>(self, name: &str, description: &str, get: impl Fn(&T) -> N + 'static) -> Self {
        self.with(Column::integer(name, description), get)
    }

    #[must_use]
    pub fn text<S: Into<Cell>>(self, name: &str, description: &str, get: impl Fn(&T) -> S + 'static) -> Self {
        self.with(Column::text(name, description), get)
    }

    #[must_use]
    pub fn flag(self, name: &str, description: &str, get: impl Fn(&T) -> bool + 'static) -> Self {
        self.with(Column::flag(name, description), get)
    }

    fn with<C: Into<Cell>>(mut self, column: Column, get: impl Fn(&T) -> C + 'static) -> Self {
        self.schema.columns.push(column);
        self.getters.push(Box::new(move |row| get(row).into()));
        self
    }

    /// Changes the column that was declared last.
    #[must_use]
    pub fn but(mut self, change: impl FnOnce(Column) -> Column) -> Self {
        if let Some(last) = self.schema.columns.pop() {
            self.schema.columns.push(change(last));
        }
        self
    }

    /// The column that was declared last is part of the key.
    #[must_use]
    pub fn key(self) -> Self {
        self.but(Column::key)
    }

    /// The whole table is computed only when somebody asks for it.
    #[must_use]
    pub fn on_demand(mut self) -> Self {
        self.schema.on_demand = true;
        self
    }

    /// Only the columns that this schema has too.
    #[must_use]
    pub fn only(mut self, schema: &Schema) -> Self {
        let all = std::mem::take(&mut self.schema.columns).into_iter().zip(self.getters);
        (self.schema.columns, self.getters) = all.filter(|(column, _)| schema.column(&column.name).is_some()).unzip();
        self
    }

    #[must_use]
    pub fn schema(&self) -> Schema {
        self.schema.clone()
    }

    /// The table of these rows.
    ///
    /// # Errors
    /// As [`Table::from_columns`]; where a getter gives another type than its column has.
    pub fn table(self, rows: &[T]) -> Result<Table, TableError> {
        let mut data = Vec::with_capacity(self.getters.len());
        for (column, get) in self.schema.columns.iter().zip(&self.getters) {
            let mut values = Data::with_room(column.kind, rows.len());
            for row in rows {
                values.push(get(row)).map_err(|cell| TableError::Column {
                    table: self.schema.name.clone(),
                    column: column.name.clone(),
                    problem: format!("`{cell}` is no {}", column.kind.name()),
                })?;
            }
            data.push(values);
        }
        Table::from_columns(self.schema, data)
    }
}

/// NaN, which a column can allow, for what is not finite, which none can.
#[must_use]
pub fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns() -> Columns<(u32, f64)> {
        Columns::new("points", "Some points.")
            .integer("point", "Counts.", |row: &(u32, f64)| row.0)
            .key()
            .float("depth", "um", "Depth.", |row| row.1)
            .but(|column| column.tolerance(1e-3, 0.0))
            .text("side", "Which.", |row| if row.1 < 0.0 { "left" } else { "right" })
            .flag("deep", "Whether.", |row| row.1 > 1e-6)
    }

    #[test]
    fn schema_and_rows_come_from_one_list() {
        let schema = columns().schema();
        let names: Vec<_> = schema.columns.iter().map(|column| (column.name.as_str(), column.key)).collect();
        assert_eq!(names, [("point", true), ("depth", false), ("side", false), ("deep", false)]);
        assert_eq!((schema.columns[1].unit.as_str(), schema.columns[1].tolerance.absolute), ("um", 1e-3));
        let table = columns().table(&[(2, 3e-6), (1, -1e-6)]).unwrap();
        assert_eq!(*table.schema(), schema);
        assert_eq!(
            (table.integers("point"), table.texts("side")),
            (&[1, 2][..], &["left".to_owned(), "right".to_owned()][..])
        );
        assert!(table.floats("depth").iter().zip([-1.0, 3.0]).all(|(found, value)| (found - value).abs() < 1e-15));
    }

    #[test]
    fn columns_that_nobody_wants_take_their_getters_with_them() {
        let mut narrow = columns().schema();
        narrow.columns.retain(|column| column.name != "depth");
        let table = columns().only(&narrow).table(&[(2, 3e-6), (1, -1e-6)]).unwrap();
        assert_eq!(*table.schema(), narrow);
        assert_eq!(table.texts("side"), ["left", "right"]);
    }

    #[test]
    fn what_is_not_finite_becomes_what_a_column_can_allow() {
        let columns = || Columns::new("points", "").float("depth", "um", "", |depth: &f64| finite(*depth));
        assert!(columns().table(&[f64::INFINITY]).is_err());
        let table = columns().but(Column::allows_nan).table(&[f64::INFINITY, 0.0]).unwrap();
        assert!(table.floats("depth")[0].is_nan() && table.floats("depth")[1] == 0.0);
    }

    #[test]
    fn a_getter_of_another_type_is_told() {
        let wrong = Columns::new("points", "").integer("point", "", |_: &u32| "one");
        let error = wrong.table(&[1]).unwrap_err().to_string();
        assert_eq!(error, "table `points`, column `point`: `one` is no integer");
    }
}
