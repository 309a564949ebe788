//! What is found of a figure when the tables are there: columns, units, rows.
//!
//! Must not know: how it was stated.

use super::{DESIGN, Figure, How, MarkRow, Place, StatedFigure, StatedFigureNames};
use crate::stage::Inputs;
use crate::stage::operand::{in_si, table};
use crate::stage::quantity::{described, same_dimension};
use declare::error::Diagnostic;
use declare::units::{in_unit, parse_quantity, parse_unit, split_quantity};
use studygraph::table::data::{Data, Table};
use studygraph::table::schema::{Column, Type};
use studygraph::table::select::{rows_where, unknown_column, why_none};

impl Figure {
    /// Checks it against the tables; gives its rows of the table `figure_published`.
    ///
    /// # Errors
    /// When a column is missing, holds no numbers, or no row of those that there are meets the conditions.
    pub fn marked(&self, inputs: &Inputs) -> Result<Vec<MarkRow<'_>>, Diagnostic> {
        let named = |found: Diagnostic| {
            let message = format!("figure `{}`: {}", self.name, found.message);
            self.record.locate(Diagnostic { message, ..found })
        };
        self.resolve(inputs).map_err(named)
    }

    fn resolve(&self, inputs: &Inputs) -> Result<Vec<MarkRow<'_>>, Diagnostic> {
        const NAMES: StatedFigureNames = StatedFigure::NAMES;
        let mut units: Option<(String, String)> = None;
        for (stage, name) in &self.tables {
            let table = table(stage, name, inputs).map_err(of(NAMES.table))?;
            let found = self.check(table)?;
            match &units {
                None => units = Some(found),
                Some(first) if *first == found => {}
                Some(first) => {
                    let message = "the tables have different units on an axis";
                    let message = format!("{message}: {} and {}, {} and {}", first.0, found.0, first.1, found.1);
                    return Err(Diagnostic::new(message).of(NAMES.table));
                }
            }
        }
        let (x_unit, mut y_unit) = units.unwrap_or_default();
        if let Some((stage, name)) = &self.reference {
            let table = table(stage, name, inputs).map_err(of(NAMES.reference))?;
            self.check_reference(table, &y_unit).map_err(of(NAMES.reference))?;
            y_unit.clear();
        }
        if let Some((stage, name)) = &self.marked {
            let table = table(stage, name, inputs).map_err(of(NAMES.marked))?;
            self.check_marked(table, [&x_unit, &y_unit]).map_err(of(NAMES.marked))?;
        }
        let mut marks = Vec::new();
        for (number, mark) in (1..).zip(&self.published) {
            let along =
                |place: &Option<Place>, unit: &str| place.as_ref().map_or(Ok(f64::NAN), |place| place.along(unit));
            let along = |place, unit| along(place, unit).map_err(of(NAMES.published));
            let (x, y) = (along(&mark.x, &x_unit)?, along(&mark.y, &y_unit)?);
            marks.push(MarkRow { figure: self.number, number, label: &mark.label, x, y });
        }
        Ok(marks)
    }

    /// Whether the named points have numbers in the units of the axes.
    fn check_marked(&self, table: &Table, units: [&String; 2]) -> Result<(), String> {
        let schema = table.schema();
        schema.column(DESIGN).ok_or_else(|| unknown_column(schema, DESIGN))?;
        for (name, unit) in self.marked_columns.iter().zip(units) {
            let column = schema.column(name).ok_or_else(|| unknown_column(schema, name))?;
            numbers(column)?;
            if column.unit != *unit {
                return Err(format!("`{name}` of the named points is in `{}`, the axis in `{unit}`", column.unit));
            }
        }
        Ok(())
    }

    /// Whether the reference has one value for each column of the y axis, in its unit, by which can be divided.
    fn check_reference(&self, table: &Table, unit: &str) -> Result<(), String> {
        let schema = table.schema();
        let rows = rows_where(table, &self.conditions)?;
        let [row] = rows[..] else {
            return Err(format!("the reference must be one row; table `{}` has {}", table.name(), rows.len()));
        };
        for name in &self.y {
            let column = schema.column(name).ok_or_else(|| unknown_column(schema, name))?;
            numbers(column)?;
            if column.unit != unit {
                return Err(format!("the reference is in {}, but the axis in {unit}", column.unit));
            }
            let value = match table.column(name) {
                Some(Data::Float(values)) => values[row],
                Some(Data::Integer(values)) => values[row] as f64,
                _ => f64::NAN,
            };
            if !value.is_finite() || value == 0.0 {
                return Err(format!("the reference `{name}` is {value}"));
            }
        }
        Ok(())
    }

    /// Checks the columns; gives the units of the two axes.
    fn check(&self, table: &Table) -> Result<(String, String), Diagnostic> {
        const NAMES: StatedFigureNames = StatedFigure::NAMES;
        let schema = table.schema();
        let column = |field, name: &str| schema.column(name).ok_or_else(|| of(field)(unknown_column(schema, name)));
        let rows = rows_where(table, &self.conditions).map_err(of(NAMES.conditions))?;
        // A table without any rows is what its stage found: the figure says so, and the others stand.
        if rows.is_empty() && table.rows() > 0 {
            return Err(of(NAMES.conditions)(why_none(table, &self.conditions).unwrap_or_else(|message| message)));
        }
        let x = column(NAMES.x, &self.x)?;
        if !self.has_words() {
            numbers(x).map_err(of(NAMES.x))?;
        }
        let mut unit: Option<&str> = None;
        for name in &self.y {
            let y = column(NAMES.y, name)?;
            numbers(y).map_err(of(NAMES.y))?;
            if unit.is_some_and(|unit| unit != y.unit) {
                return Err(of(NAMES.y)(format!("the columns {} have different units", self.y.join(", "))));
            }
            unit = Some(&y.unit);
        }
        for (field, name) in [(NAMES.series, &self.series), (NAMES.segments, &self.segments)] {
            if !name.is_empty() {
                column(field, name)?;
            }
        }
        for (field, name) in [(NAMES.value, &self.value), (NAMES.length, &self.length)] {
            if !name.is_empty() {
                numbers(column(field, name)?).map_err(of(field))?;
            }
        }
        if self.kind == How::Drawing && unit != Some(&x.unit) {
            return Err(of(NAMES.y)(format!(
                "a drawing needs one unit on both axes, not {} and {}",
                x.unit,
                unit.unwrap_or_default()
            )));
        }
        Ok((x.unit.clone(), unit.unwrap_or_default().to_owned()))
    }
}

/// Makes of a sentence a diagnostic about a field.
fn of(field: &'static str) -> impl Fn(String) -> Diagnostic {
    move |message| Diagnostic::new(message).of(field)
}

fn numbers(column: &Column) -> Result<(), String> {
    match column.kind {
        Type::Float | Type::Integer => Ok(()),
        _ => Err(format!("column `{}` holds {}s, not numbers", column.name, column.kind.name())),
    }
}

impl Place {
    /// In the unit of an axis.
    fn along(&self, unit: &str) -> Result<f64, String> {
        let axis = in_si(1.0, unit)?;
        if !same_dimension(axis.dimension, self.dimension) {
            let (found, wanted) = (described(self.dimension), described(axis.dimension));
            return Err(format!("`{}` is {found}, but the axis shows {wanted}", self.text));
        }
        let (number, written) = split_quantity(&self.text);
        if parse_unit(written).ok() == parse_unit(unit).ok() {
            return number.parse().map_err(|_| format!("`{}` is not a number", self.text));
        }
        let si = parse_quantity(&self.text).map_err(|error| error.to_string())?.value;
        Ok(in_unit(si, unit))
    }
}
