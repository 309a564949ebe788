//! Whether two tables agree: the same bits, within the tolerances of their columns, or not; and where they differ most.
//!
//! Rows are paired in order, which is the order of their keys. Must not know: where the tables come from.

use crate::table::data::{Cell, Data, Table};
use crate::table::schema::Column;

/// How two tables compare.
#[derive(Clone, Debug, PartialEq)]
pub enum Agreement {
    /// The same content hash.
    Identical,
    /// Every value within the tolerance of its column; the one that is nearest to leaving it.
    Within(Worst),
    /// The value that is farthest outside its tolerance.
    Different(Worst),
    /// They cannot be compared value by value: one sentence says why.
    Incomparable(String),
}

/// The worst value of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    pub column: String,
    pub unit: String,
    /// From 0.
    pub row: usize,
    /// The names and values of the row's key; empty for a table without one.
    pub key: Vec<(String, Cell)>,
    pub recorded: Cell,
    pub computed: Cell,
    /// `|a − b|` in the column's unit; infinite for what is no number.
    pub absolute: f64,
    /// `|a − b|/max(|a|, |b|)`.
    pub relative: f64,
    /// Over the allowed difference; within tolerance up to 1.
    pub excess: f64,
}

/// Compares a table that was kept with one that was computed; tolerances are those of `computed`.
#[must_use]
pub fn compare(recorded: &Table, computed: &Table) -> Agreement {
    if recorded.content_hash() == computed.content_hash() {
        return Agreement::Identical;
    }
    if let Some(problem) = other_shape(recorded, computed) {
        return Agreement::Incomparable(problem);
    }
    let mut worst: Option<Worst> = None;
    for column in computed.schema().columns.iter().filter(|column| !column.volatile) {
        let (Some(a), Some(b)) = (recorded.column(&column.name), computed.column(&column.name)) else { continue };
        for row in 0..computed.rows() {
            let (absolute, relative, excess) = difference(column, a, b, row);
            if excess > worst.as_ref().map_or(0.0, |worst| worst.excess) {
                let keys = computed.schema().columns.iter().zip(recorded.columns()).filter(|(column, _)| column.key);
                let key = keys.map(|(column, data)| (column.name.clone(), data.cell(row))).collect();
                let (recorded, computed) = (a.cell(row), b.cell(row));
                let (column, unit) = (column.name.clone(), column.unit.clone());
                worst = Some(Worst { column, unit, row, key, recorded, computed, absolute, relative, excess });
            }
        }
    }
    match worst {
        // Another hash of equal values: what differs is not a value.
        None => Agreement::Incomparable("the values are equal, but not what the columns are".to_owned()),
        Some(worst) if worst.excess <= 1.0 => Agreement::Within(worst),
        Some(worst) => Agreement::Different(worst),
    }
}

/// Why rows cannot be paired, if they cannot.
fn other_shape(recorded: &Table, computed: &Table) -> Option<String> {
    let names = |table: &Table| -> Vec<(String, &'static str, String, bool)> {
        let kept = table.schema().columns.iter().filter(|column| !column.volatile);
        kept.map(|column| (column.name.clone(), column.kind.name(), column.unit.clone(), column.key)).collect()
    };
    let (was, is) = (names(recorded), names(computed));
    let list = |these: &[(String, &str, String, bool)], others: &[(String, &str, String, bool)]| {
        let only: Vec<_> =
            these.iter().filter(|column| !others.contains(column)).map(|(name, ..)| name.as_str()).collect();
        if only.is_empty() { "none".to_owned() } else { only.join(", ") }
    };
    if was != is {
        return Some(format!("other columns: recorded only: {}; computed only: {}", list(&was, &is), list(&is, &was)));
    }
    (recorded.rows() != computed.rows())
        .then(|| format!("{} rows recorded, {} computed", recorded.rows(), computed.rows()))
}

/// Absolute, relative, and over what is allowed.
fn difference(column: &Column, a: &Data, b: &Data, row: usize) -> (f64, f64, f64) {
    const NOTHING: (f64, f64, f64) = (0.0, 0.0, 0.0);
    const EVERYTHING: (f64, f64, f64) = (f64::INFINITY, f64::INFINITY, f64::INFINITY);
    let (Data::Float(a), Data::Float(b)) = (a, b) else {
        return if a.cell(row) == b.cell(row) { NOTHING } else { EVERYTHING };
    };
    let (a, b) = (a[row], b[row]);
    let (absolute, size) = ((a - b).abs(), a.abs().max(b.abs()));
    if absolute == 0.0 || (a.is_nan() && b.is_nan()) {
        return NOTHING;
    }
    if !absolute.is_finite() {
        return EVERYTHING;
    }
    (absolute, absolute / size, absolute / (column.tolerance.absolute + column.tolerance.relative * size))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::schema::Schema;

    fn table(values: &[f64], word: &str) -> Table {
        let columns = vec![
            Column::integer("position", "Count.").key(),
            Column::float("error", "um", "Error.").tolerance(0.5, 0.0).allows_nan(),
            Column::float("force", "N", "Force."),
            Column::text("word", "A word."),
            Column::float("seconds", "s", "Time.").volatile(),
        ];
        let row = |(index, value): (usize, &f64)| -> Vec<Cell> {
            vec![index.into(), (*value).into(), 7.0.into(), word.into(), (index as f64 + value.abs().min(1.0)).into()]
        };
        let values = values.iter().enumerate().map(row).map(|mut row| {
            if let Cell::Float(seconds) = &mut row[4]
                && seconds.is_nan()
            {
                *seconds = 0.0;
            }
            row
        });
        Table::from_rows(Schema::new("t", "", columns), values.collect()).unwrap()
    }

    #[test]
    fn the_same_values_are_identical_and_times_do_not_count() {
        let (a, b) = (table(&[1.0, f64::NAN], "x"), table(&[1.0, f64::NAN], "x"));
        assert_eq!(compare(&a, &b), Agreement::Identical);
    }

    #[test]
    fn a_difference_within_the_tolerance_is_told_with_its_place() {
        let Agreement::Within(worst) = compare(&table(&[1.0, 2.0, 3.0], "x"), &table(&[1.1, 2.25, 3.0], "x")) else {
            panic!("within tolerance")
        };
        assert_eq!((worst.column.as_str(), worst.row, worst.unit.as_str()), ("error", 1, "um"));
        assert_eq!(worst.key, [("position".to_owned(), Cell::Integer(1))]);
        assert_eq!((worst.absolute, worst.excess, worst.relative), (0.25, 0.5, 0.25 / 2.25));
        // Exactly the tolerance is still within it, the next number is not.
        let limit = |value| compare(&table(&[1.0], "x"), &table(&[value], "x"));
        assert!(matches!(limit(1.5), Agreement::Within(_)));
        assert!(matches!(limit(1.5_f64.next_up()), Agreement::Different(_)));
    }

    #[test]
    fn what_is_no_number_must_be_equal() {
        let Agreement::Different(worst) = compare(&table(&[1.0], "x"), &table(&[1.0], "y")) else { panic!() };
        assert_eq!((worst.column.as_str(), worst.excess), ("word", f64::INFINITY));
        let Agreement::Different(worst) = compare(&table(&[1.0, f64::NAN], "x"), &table(&[1.0, 2.0], "x")) else {
            panic!()
        };
        assert_eq!((worst.column.as_str(), worst.row), ("error", 1));
    }

    #[test]
    fn other_rows_or_columns_cannot_be_paired() {
        let Agreement::Incomparable(why) = compare(&table(&[1.0], "x"), &table(&[1.0, 2.0], "x")) else { panic!() };
        assert_eq!(why, "1 rows recorded, 2 computed");
        let schema =
            Schema::new("t", "", vec![Column::integer("position", "Count.").key(), Column::flag("new", "New.")]);
        let other = Table::from_rows(schema, vec![]).unwrap();
        let Agreement::Incomparable(why) = compare(&table(&[], "x"), &other) else { panic!() };
        assert_eq!(why, "other columns: recorded only: error, force, word; computed only: new");
    }
}
