//! What a figure cannot show of its tables: no mistake of the study, but its reader must know.
//!
//! Must not know: how anything is drawn.

use super::{Figure, Logarithmic, MarkRow};
use crate::stage::Inputs;
use studygraph::table::data::{Data, Table};
use studygraph::table::select::rows_where;

impl Figure {
    /// Sentences about it; `marks` are its published points.
    pub fn warned(&self, inputs: &Inputs, marks: &[MarkRow]) -> Vec<String> {
        let has_no_rows = |(stage, table): &&(String, String)| {
            let found = inputs.table(stage, table);
            found.is_ok_and(|found| found.rows() == 0)
        };
        let empty = self.tables.iter().filter(has_no_rows);
        let empty = empty.map(|(stage, table)| format!("table `{stage}.{table}` has no rows"));
        let lost = match self.lost(inputs, marks) {
            0 => None,
            1 => Some("1 point at or below 0 is not drawn: an axis is logarithmic".to_owned()),
            many => Some(format!("{many} points at or below 0 are not drawn: an axis is logarithmic")),
        };
        empty.chain(lost).map(|said| format!("figure `{}`: {said}", self.name)).collect()
    }

    /// How many points a logarithmic axis has no place for.
    fn lost(&self, inputs: &Inputs, marks: &[MarkRow]) -> usize {
        let x_log = matches!(self.log, Logarithmic::X | Logarithmic::Both) && !self.has_words();
        let y_log = matches!(self.log, Logarithmic::Y | Logarithmic::Both);
        if !x_log && !y_log {
            return 0;
        }
        let is_lost = |x: f64, y: f64| (x_log && x <= 0.0) || (y_log && y <= 0.0);
        let in_table = |table: &Table, conditions: &[(String, String)], x: &str, y: &dyn Fn(usize) -> Option<f64>| {
            let rows = rows_where(table, conditions).unwrap_or_default();
            // Words have a place each.
            let x = |row: usize| if self.has_words() { Some(1.0) } else { finite(table, x, row) };
            rows.into_iter().filter(|&row| x(row).zip(y(row)).is_some_and(|(x, y)| is_lost(x, y))).count()
        };
        // Of a line across there is no x.
        let mut lost = marks.iter().filter(|mark| is_lost(mark.x, mark.y)).count();
        // That the reference is at no distance from itself goes without saying.
        let tables = self.tables.iter().filter(|table| Some(*table) != self.reference.as_ref());
        for table in tables.filter_map(|(stage, table)| inputs.table(stage, table).ok()) {
            for name in &self.y {
                let reference = self.reference_of(inputs, name);
                let distance = |y: f64| reference.map_or(y, |reference| (y / reference - 1.0).abs());
                let y = |row: usize| finite(table, name, row).map(distance);
                lost += in_table(table, &self.conditions, &self.x, &y);
            }
        }
        if let Some(table) = self.marked.as_ref().and_then(|(stage, table)| inputs.table(stage, table).ok()) {
            let [x, y] = &self.marked_columns;
            lost += in_table(table, &[], x, &|row| finite(table, y, row));
        }
        lost
    }

    /// What the values of a column are drawn as their distance from.
    fn reference_of(&self, inputs: &Inputs, column: &str) -> Option<f64> {
        let (stage, table) = self.reference.as_ref()?;
        let table = inputs.table(stage, table).ok()?;
        finite(table, column, *rows_where(table, &self.conditions).ok()?.first()?)
    }
}

/// A number of a table, where it is one. One that differs from run to run is none: no key has it.
fn finite(table: &Table, column: &str, row: usize) -> Option<f64> {
    if table.schema().column(column).is_some_and(|column| column.volatile) {
        return None;
    }
    let value = match table.column(column)? {
        Data::Float(values) => values.get(row).copied(),
        Data::Integer(values) => values.get(row).map(|value| *value as f64),
        _ => None,
    };
    value.filter(|value| value.is_finite())
}
