//! Columns that fill themselves: each is declared once, with what it is and where its values come from.
//!
//! Schema and rows come from one list, so they cannot disagree. Must not know: what any row is.

use std::borrow::Borrow;

use super::data::{Data, Table, TableError};
use super::schema::{Column, Schema};
use declare::units::showing;

/// Where the values of a column come from: what stands in it in the row of a `T`.
enum Getter<T> {
    Float(Box<dyn Fn(&T) -> f64>),
    Integer(Box<dyn Fn(&T) -> i64>),
    Text(Box<dyn Fn(&T) -> String>),
    Flag(Box<dyn Fn(&T) -> bool>),
}

impl<T> Getter<T> {
    fn values<B: Borrow<T>>(&self, rows: impl Iterator<Item = B>, count: usize) -> Data {
        fn all<V>(values: impl Iterator<Item = V>, count: usize) -> Vec<V> {
            let mut all = Vec::with_capacity(count);
            all.extend(values);
            all
        }
        match self {
            Self::Float(get) => Data::Float(all(rows.map(|row| get(row.borrow())), count)),
            Self::Integer(get) => Data::Integer(all(rows.map(|row| get(row.borrow())), count)),
            Self::Text(get) => Data::Text(all(rows.map(|row| get(row.borrow())), count)),
            Self::Flag(get) => Data::Flag(all(rows.map(|row| get(row.borrow())), count)),
        }
    }
}

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
        self.shown(name, unit, description, move |row| shown(get(row)))
    }

    /// A number, which `get` gives in the unit of the column: for what SI would round once more.
    #[must_use]
    pub fn shown(self, name: &str, unit: &str, description: &str, get: impl Fn(&T) -> f64 + 'static) -> Self {
        self.with(Column::float(name, unit, description), Getter::Float(Box::new(get)))
    }

    /// A whole number; what no column holds is the largest that one does.
    #[must_use]
    pub fn integer<N: TryInto<i64>>(self, name: &str, description: &str, get: impl Fn(&T) -> N + 'static) -> Self {
        let whole = move |row: &T| get(row).try_into().unwrap_or(i64::MAX);
        self.with(Column::integer(name, description), Getter::Integer(Box::new(whole)))
    }

    #[must_use]
    pub fn text<S: Into<String>>(self, name: &str, description: &str, get: impl Fn(&T) -> S + 'static) -> Self {
        self.with(Column::text(name, description), Getter::Text(Box::new(move |row| get(row).into())))
    }

    #[must_use]
    pub fn flag(self, name: &str, description: &str, get: impl Fn(&T) -> bool + 'static) -> Self {
        self.with(Column::flag(name, description), Getter::Flag(Box::new(get)))
    }

    fn with(mut self, column: Column, getter: Getter<T>) -> Self {
        self.schema.columns.push(column);
        self.getters.push(getter);
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
    /// As [`Table::from_columns`].
    pub fn table(self, rows: &[T]) -> Result<Table, TableError> {
        self.filled(&rows.iter())
    }

    /// The same for rows that are too many to be held: they are made anew for every column.
    ///
    /// # Errors
    /// As [`Table::from_columns`].
    pub fn table_of(self, rows: &(impl Iterator<Item = T> + Clone)) -> Result<Table, TableError> {
        self.filled(rows)
    }

    fn filled<B: Borrow<T>>(self, rows: &(impl Iterator<Item = B> + Clone)) -> Result<Table, TableError> {
        let count = rows.clone().count();
        let data = self.getters.iter().map(|getter| getter.values(rows.clone(), count)).collect();
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
}
