//! Tolerances given by name, on the command line or in a study: `peak_to_peak = 0.01 um`, `ste.summary.mean = 1e-6`.
//!
//! A number alone, or with `%`, is relative to the larger of the two values; with a unit it is absolute, and converted to
//! the column's. `1` is the unit of a column that has none: `1e-6 1` is absolute there. Must not know: where it was
//! written.

use super::schema::{Column, Tolerance, Type};
use declare::units::{Dimension, RATIO, in_unit, parse_quantity, parse_unit, split_quantity};

/// One tolerance and the columns it is meant for.
#[derive(Clone, Debug, PartialEq)]
pub struct Allowance {
    /// `column`, `table.column` or `stage.table.column`.
    pub name: String,
    /// As written: `0.01 um`.
    pub text: String,
    limit: Limit,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Limit {
    Relative(f64),
    /// SI.
    Absolute(f64, Dimension),
}

impl Allowance {
    /// Reads the name and the value.
    ///
    /// # Errors
    /// A sentence that says what was expected.
    pub fn new(name: &str, value: &str) -> Result<Self, String> {
        let (name, text) = (name.trim(), value.trim());
        let parts: Vec<&str> = name.split('.').collect();
        if parts.len() > 3 || parts.iter().any(|part| part.is_empty()) {
            return Err(format!("`{name}` names no column; write `column`, `table.column` or `stage.table.column`"));
        }
        let quantity = parse_quantity(text).map_err(|error| format!("the tolerance of `{name}`: {error}"))?;
        if quantity.value < 0.0 {
            return Err(format!("the tolerance of `{name}` is `{text}`; it must be at least 0"));
        }
        let relative = !quantity.has_unit || split_quantity(text).1 == "%";
        let limit = if relative {
            Limit::Relative(quantity.value)
        } else {
            Limit::Absolute(quantity.value, quantity.dimension)
        };
        Ok(Self { name: name.to_owned(), text: text.to_owned(), limit })
    }

    /// Reads `name=value`.
    ///
    /// # Errors
    /// As [`Allowance::new`].
    pub fn parse(text: &str) -> Result<Self, String> {
        let expected = || format!("`{text}` is not a tolerance; write `column=1e-6` or `stage.table.column=0.01 um`");
        let (name, value) = text.split_once('=').ok_or_else(expected)?;
        Self::new(name, value)
    }

    /// How many parts of the column's full name it says, when it means that column.
    fn precision(&self, stage: &str, table: &str, column: &str) -> Option<usize> {
        let full = [column, table, stage];
        let count = self.name.split('.').count();
        self.name.rsplit('.').zip(full).all(|(part, own)| part == own).then_some(count)
    }

    #[must_use]
    pub fn means(&self, stage: &str, table: &str, column: &str) -> bool {
        self.precision(stage, table, column).is_some()
    }

    /// As a tolerance of this column.
    ///
    /// # Errors
    /// When the column holds no numbers, or numbers in another unit.
    pub fn of(&self, column: &Column) -> Result<Tolerance, String> {
        if !matches!(column.kind, Type::Float | Type::Integer) {
            let Self { name, .. } = self;
            return Err(format!(
                "`{name}` holds {}s, which are the same or not; it has no tolerance",
                column.kind.name()
            ));
        }
        match self.limit {
            Limit::Relative(relative) => Ok(Tolerance { absolute: 0.0, relative }),
            Limit::Absolute(value, dimension) => {
                let own = if column.unit.is_empty() {
                    Ok(RATIO)
                } else {
                    parse_unit(&column.unit).map(|unit| unit.dimension)
                };
                if own != Ok(dimension) {
                    let unit = if column.unit.is_empty() { "numbers without a unit" } else { &column.unit };
                    return Err(format!(
                        "the tolerance `{}` does not fit `{}`, which is in {unit}",
                        self.text, self.name
                    ));
                }
                Ok(Tolerance { absolute: in_unit(value, &column.unit), relative: 0.0 })
            }
        }
    }
}

/// The allowance that says most of this column's name; of equals the last.
#[must_use]
pub fn find<'a>(allowances: &'a [Allowance], stage: &str, table: &str, column: &str) -> Option<&'a Allowance> {
    let meant = allowances.iter().filter_map(|one| Some((one.precision(stage, table, column)?, one)));
    meant.max_by_key(|(precision, _)| *precision).map(|(_, one)| one)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length() -> Column {
        Column::float("peak_to_peak", "um", "")
    }

    #[test]
    fn numbers_are_relative_and_quantities_absolute() {
        let read = |text: &str| Allowance::new("peak_to_peak", text).unwrap().of(&length()).unwrap();
        assert_eq!(read("1e-6"), Tolerance { absolute: 0.0, relative: 1e-6 });
        assert_eq!(read("1 %"), Tolerance { absolute: 0.0, relative: 0.01 });
        assert_eq!(read("0.01 um"), Tolerance { absolute: 0.01, relative: 0.0 });
        assert_eq!(read("0.00001 mm"), Tolerance { absolute: 0.01, relative: 0.0 });
        let ratio = Column::float("contact_ratio", "", "");
        let one = Allowance::new("contact_ratio", "1e-6 1").unwrap();
        assert_eq!(one.of(&ratio).unwrap(), Tolerance { absolute: 1e-6, relative: 0.0 });
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let wrong = |name: &str, text: &str| Allowance::new(name, text).unwrap_err();
        assert!(wrong("a.b.c.d", "1").contains("stage.table.column"));
        assert!(wrong("a", "-1").contains("at least 0"));
        assert!(wrong("a", "much").contains("not a number"));
        assert!(Allowance::parse("a").unwrap_err().contains("`column=1e-6`"));
        let force = Allowance::new("peak_to_peak", "3 N").unwrap();
        assert!(force.of(&length()).unwrap_err().contains("which is in um"));
        assert!(force.of(&Column::text("peak_to_peak", "")).unwrap_err().contains("no tolerance"));
    }

    #[test]
    fn the_longest_name_wins_and_of_equals_the_last() {
        let all: Vec<_> = ["x=1", "ste.sum.x=2", "sum.x=3", "x=4", "other.x=5"]
            .iter()
            .map(|text| Allowance::parse(text).unwrap())
            .collect();
        assert_eq!(find(&all, "ste", "sum", "x").unwrap().text, "2");
        assert_eq!(find(&all, "b", "sum", "x").unwrap().text, "3");
        assert_eq!(find(&all, "b", "c", "x").unwrap().text, "4");
        assert_eq!(find(&all, "b", "c", "y"), None);
    }
}
