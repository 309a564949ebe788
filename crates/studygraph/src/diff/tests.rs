//! Comparisons of tables made for it: what must be found is known beforehand.

mod curves;

use proptest::prelude::*;

use super::model::{Difference, TableDiff, Value};
use super::table::compare;
use crate::table::data::{Cell, Data, Row, Table};
use crate::table::schema::{Column, Schema, Tolerance};

fn schema() -> Schema {
    Schema::new(
        "t",
        "",
        vec![
            Column::text("design", "").key(),
            Column::integer("point", "").key(),
            Column::float("torque", "N m", "").key(),
            Column::float("te", "um", "").tolerance(0.0, 1e-9).allows_nan(),
            Column::integer("pairs", ""),
            Column::text("word", ""),
            Column::flag("inside", ""),
            Column::float("seconds", "s", "").volatile(),
        ],
    )
}

fn table(rows: Vec<Row>) -> Table {
    Table::from_rows(schema(), rows).unwrap()
}

fn diff(before: &Table, after: &Table) -> TableDiff {
    compare("s.t", before, after, None, &|_| None)
}

prop_compose! {
    /// Rows with distinct keys, in any order; NaN, both zeros, words of several alphabets.
    fn rows()(
        keys in prop::collection::btree_set(("[a-cä]{0,2}", -3_i64..4, 0_i32..4), 0..40),
        floats in prop::collection::vec(prop_oneof![Just(f64::NAN), Just(0.0), Just(-0.0), -1e3..1e3], 40),
        seed in any::<u64>(),
    ) -> Vec<Row> {
        let mut rows: Vec<Row> = keys.into_iter().zip(floats).enumerate().map(|(index, ((design, point, torque), te))| {
            let index = i64::try_from(index).unwrap();
            vec![
                design.clone().into(), point.into(), (12.5 * f64::from(torque)).into(), te.into(), (index % 3).into(),
                design.into(), (index % 2 == 0).into(), (index as f64).into(),
            ]
        }).collect();
        let count = rows.len().max(1);
        rows.rotate_left(usize::try_from(seed % count as u64).unwrap());
        rows
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_table_and_itself_in_any_order_are_the_same(rows in rows(), seed in any::<u64>()) {
        let mut other = rows.clone();
        let mut random = seed;
        for at in (1..other.len()).rev() {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            other.swap(at, usize::try_from(random >> 33).unwrap() % (at + 1));
        }
        for row in &mut other {
            // Zeros of either sign are equal; seconds do not count.
            if row[3] == Cell::Float(0.0) { row[3] = Cell::Float(-0.0); }
            row[7] = Cell::Float(99.0);
        }
        let found = diff(&table(rows), &table(other));
        prop_assert_eq!(found.state, Difference::Same, "{:?}", found);
        prop_assert!(found.columns.is_empty() && found.worst.is_empty() && found.schema.is_empty());
    }

    #[test]
    fn one_changed_value_is_found_in_its_row(rows in rows(), pick in any::<prop::sample::Index>(), column in 3_usize..7) {
        prop_assume!(!rows.is_empty());
        let mut other = rows.clone();
        let row = pick.index(rows.len());
        other[row][column] = match &rows[row][column] {
            Cell::Float(value) if value.is_nan() => Cell::Float(1.0),
            Cell::Float(value) => Cell::Float(value + 0.5),
            Cell::Integer(value) => Cell::Integer(value + 1),
            Cell::Text(text) => Cell::Text(format!("{text}!")),
            Cell::Flag(flag) => Cell::Flag(!flag),
        };
        let (before, after) = (rows[row][column].clone(), other[row][column].clone());
        let key: Vec<Value> = rows[row][..3].iter().cloned().map(Value::from).collect();
        let found = diff(&table(rows), &table(other));
        prop_assert_eq!(found.state, Difference::Changed);
        prop_assert_eq!(found.columns.len(), 1);
        prop_assert_eq!((found.columns[0].changed, found.columns[0].beyond), (1, 1));
        prop_assert_eq!(&found.columns[0].name, &schema().columns[column].name);
        let worst = &found.worst[0];
        prop_assert_eq!(worst.key.iter().map(|(_, value)| value.clone()).collect::<Vec<_>>(), key);
        prop_assert_eq!(&worst.after, &Value::from(after));
        if !matches!(before, Cell::Float(value) if value.is_nan()) {
            prop_assert_eq!(&worst.before, &Value::from(before));
        }
    }

    #[test]
    fn rows_that_came_and_went_are_counted(rows in rows(), cut in any::<prop::sample::Index>()) {
        prop_assume!(!rows.is_empty());
        let mut other = rows.clone();
        let gone = other.remove(cut.index(rows.len()));
        let (whole, part) = (table(rows), table(other));
        let key: Vec<Value> = gone[..3].iter().cloned().map(Value::from).collect();
        let values = |key: &[(String, Value)]| key.iter().map(|(_, value)| value.clone()).collect::<Vec<_>>();
        let (removed, added) = (diff(&whole, &part), diff(&part, &whole));
        prop_assert_eq!((removed.rows_removed, removed.rows_added, removed.state), (1, 0, Difference::Changed));
        prop_assert_eq!((added.rows_removed, added.rows_added, added.state), (0, 1, Difference::Changed));
        prop_assert_eq!(values(&removed.removed[0]), key.clone());
        prop_assert_eq!(values(&added.added[0]), key);
        prop_assert!(removed.columns.is_empty() && added.columns.is_empty());
    }
}

/// Two columns of numbers side by side, with the row's number as key.
fn numbers(unit: &str, values: &[f64]) -> Table {
    let columns = vec![Column::integer("row", "").key(), Column::float("x", unit, "").tolerance(0.5, 0.0).allows_nan()];
    let rows = values.iter().enumerate().map(|(row, value)| vec![row.into(), (*value).into()]).collect();
    Table::from_rows(Schema::new("t", "", columns), rows).unwrap()
}

#[test]
fn a_difference_of_the_tolerance_is_within_and_the_next_number_beyond() {
    let at = |after: f64| diff(&numbers("um", &[2.0]), &numbers("um", &[after])).state;
    assert_eq!(at(2.5), Difference::WithinTolerance);
    assert_eq!(at(2.5_f64.next_up()), Difference::Changed);
    assert_eq!(at(1.5), Difference::WithinTolerance);
    assert_eq!(at(1.5_f64.next_down()), Difference::Changed);
    assert_eq!(at(f64::NAN), Difference::Changed);
    // Relative to the larger of the two, whichever that is; 0.25 of 4 is 1.
    let quarter = |_: &Column| Some(Tolerance { absolute: 0.0, relative: 0.25 });
    let relative = |a: f64, b: f64| compare("", &numbers("um", &[a]), &numbers("um", &[b]), None, &quarter).state;
    assert_eq!((relative(3.0, 4.0), relative(4.0, 3.0)), (Difference::WithinTolerance, Difference::WithinTolerance));
    assert_eq!(relative(3.0_f64.next_down(), 4.0), Difference::Changed);
    assert_eq!(relative(0.0, 1e-300), Difference::Changed);
    // An exact column: the last bit counts.
    let exact = |_: &Column| Some(Tolerance::default());
    let last = compare("", &numbers("um", &[1.0]), &numbers("um", &[1.0_f64.next_up()]), None, &exact);
    assert_eq!((last.state, last.columns[0].beyond), (Difference::Changed, 1));
}

#[test]
fn the_largest_differences_are_told_with_their_rows() {
    let (before, after) = (numbers("um", &[1.0, 10.0, 100.0, 0.0]), numbers("um", &[2.0, 14.0, 90.0, 0.0]));
    let found = diff(&before, &after);
    let column = &found.columns[0];
    assert_eq!((column.compared, column.changed, column.beyond), (4, 3, 3));
    let (absolute, relative) = (column.largest_absolute.as_ref().unwrap(), column.largest_relative.as_ref().unwrap());
    assert_eq!((absolute.difference, &absolute.key[0].1), (-10.0, &Value::Integer(2)));
    assert_eq!((relative.difference, &relative.key[0].1), (0.5, &Value::Integer(0)));
    let worst: Vec<_> = found.worst.iter().map(|worst| (worst.key[0].1.clone(), worst.difference)).collect();
    let wanted = [(2, -10.0), (1, 4.0), (0, 1.0)].map(|(row, by)| (Value::Integer(row), Some(by)));
    assert_eq!(worst, wanted);
}

/// What `verify` shows: the value that is over its tolerance by most, or nearest to it, and words that changed.
#[test]
fn the_value_that_is_over_its_tolerance_by_most_is_told() {
    let near = diff(&numbers("um", &[1.0, 2.0, 3.0]), &numbers("um", &[1.125, 2.25, 3.0]));
    let over = near.columns[0].largest_over.as_ref().unwrap();
    assert_eq!((over.difference, &over.key[0].1, near.state), (0.5, &Value::Integer(1), Difference::WithinTolerance));
    // Relative to what is allowed there, not to the largest difference.
    let relative = |_: &Column| Some(Tolerance { absolute: 0.0, relative: 0.5 });
    let found = compare("", &numbers("um", &[1.0, 100.0]), &numbers("um", &[4.0, 110.0]), None, &relative);
    let over = found.columns[0].largest_over.as_ref().unwrap();
    assert_eq!((over.difference, &over.key[0].1), (1.5, &Value::Integer(0)));
    let gone = diff(&numbers("um", &[1.0, 2.0]), &numbers("um", &[9.0, f64::NAN]));
    assert_eq!(gone.columns[0].largest_over.as_ref().unwrap().key[0].1, Value::Integer(1));
    let words = |of: &[&str]| {
        let columns = vec![Column::integer("row", "").key(), Column::text("word", "")];
        let rows = of.iter().enumerate().map(|(row, word)| vec![row.into(), (*word).into()]).collect();
        Table::from_rows(Schema::new("t", "", columns), rows).unwrap()
    };
    let found = diff(&words(&["a", "b", "c"]), &words(&["a", "B", "C"]));
    let shown = found.columns[0].shown().unwrap();
    assert_eq!((super::words::change(shown), &shown.key[0].1), ("b → B".to_owned(), &Value::Integer(1)));
}

#[test]
fn units_that_convert_are_compared_in_the_later_one() {
    let values = [7.81, 0.1, 1.0 / 3.0, f64::NAN, 0.0];
    let metres: Vec<f64> = values.iter().map(|value| value * 1e-6).collect();
    for (before, after) in
        [(numbers("um", &values), numbers("m", &metres)), (numbers("m", &metres), numbers("um", &values))]
    {
        let found = compare("", &before, &after, None, &|_| Some(Tolerance::default()));
        assert!(found.columns.is_empty(), "{:?}", found.columns);
        assert_eq!((found.schema[0].what, found.schema[0].differs, found.state), ("unit", true, Difference::Changed));
    }
    let longer = diff(&numbers("mm", &[0.001]), &numbers("um", &[2.0]));
    let largest = longer.columns[0].largest_absolute.as_ref().unwrap();
    assert_eq!((largest.before.clone(), largest.difference), (Value::Float(1.0), 1.0));
    // A force for a length: nothing to compare. Two spellings of one unit: no difference.
    assert!(diff(&numbers("um", &[1.0]), &numbers("N", &[2.0])).columns.is_empty());
    assert_eq!(diff(&numbers("N m", &[1.0]), &numbers("Nm", &[1.0])).state, Difference::Same);
}

#[test]
fn columns_that_came_went_or_changed_are_told() {
    let one = |columns: Vec<Column>, row: Row| Table::from_rows(Schema::new("t", "", columns), vec![row]).unwrap();
    let before = one(
        vec![Column::text("a", "").key(), Column::integer("b", ""), Column::float("c", "", "")],
        vec!["k".into(), 1_i64.into(), 2.0.into()],
    );
    let after = one(
        vec![Column::text("a", "").key(), Column::float("b", "", ""), Column::flag("d", "")],
        vec!["k".into(), 1.0.into(), true.into()],
    );
    let found = diff(&before, &after);
    let told: Vec<_> = found.schema.iter().map(|change| (change.column.as_str(), change.what)).collect();
    assert_eq!(told, [("b", "type"), ("c", "removed"), ("d", "added")]);
    assert_eq!((found.state, found.columns.len()), (Difference::Changed, 0));
    // A tolerance that was changed is told, but is not a difference; a volatile column is not told at all.
    let loose = one(
        vec![
            Column::text("a", "").key(),
            Column::integer("b", ""),
            Column::float("c", "", "").tolerance(1.0, 0.0),
            Column::float("t", "s", "").volatile(),
        ],
        vec!["k".into(), 1_i64.into(), 2.0.into(), 3.0.into()],
    );
    let found = diff(&before, &loose);
    assert_eq!((found.state, found.schema.len(), found.schema[0].what), (Difference::Same, 1, "tolerance"));
}

#[test]
fn keys_that_changed_match_by_what_is_left_where_that_is_enough() {
    let columns = |more: bool| {
        let point = Column::integer("point", "");
        vec![Column::text("design", "").key(), if more { point.key() } else { point }, Column::float("x", "", "")]
    };
    let rows = |names: [&str; 2], value: f64| -> Vec<Row> {
        names.iter().enumerate().map(|(point, name)| vec![(*name).into(), point.into(), value.into()]).collect()
    };
    let make = |more, rows| Table::from_rows(Schema::new("t", "", columns(more)), rows).unwrap();
    let found = diff(&make(false, rows(["a", "b"], 1.0)), &make(true, rows(["a", "b"], 2.0)));
    assert_eq!((found.columns.len(), found.columns[0].changed, found.schema[0].what), (1, 2, "key"));
    let found = diff(&make(false, rows(["a", "b"], 1.0)), &make(true, rows(["a", "a"], 2.0)));
    assert!(found.note.contains("do not tell its rows apart") && found.state == Difference::Changed, "{found:?}");
    // Without any key rows are counted.
    let plain = |values: Vec<f64>| {
        Table::from_columns(Schema::new("t", "", vec![Column::float("x", "", "")]), vec![Data::Float(values)]).unwrap()
    };
    let found = diff(&plain(vec![1.0, 2.0]), &plain(vec![1.0, 3.0, 4.0]));
    assert_eq!((found.rows_added, found.columns[0].changed), (1, 1));
    assert_eq!(found.columns[0].largest_absolute.as_ref().unwrap().key[0], ("row".to_owned(), Value::Integer(2)));
}

#[test]
fn keys_that_are_numbers_match_across_the_last_bits() {
    let at = |positions: &[f64]| {
        let columns = vec![Column::float("position", "mm", "").key(), Column::integer("x", "")];
        let rows = positions.iter().enumerate().map(|(index, at)| vec![(*at).into(), index.into()]).collect();
        Table::from_rows(Schema::new("t", "", columns), rows).unwrap()
    };
    let found = diff(&at(&[-1e-17, 0.1, 0.2, 0.3]), &at(&[0.0, 0.1_f64.next_up(), 0.2, 0.1 + 0.2]));
    assert_eq!((found.rows_added, found.rows_removed, found.state), (0, 0, Difference::Same));
    let found = diff(&at(&[0.1]), &at(&[0.100_001]));
    assert_eq!((found.rows_added, found.rows_removed), (1, 1));
}

#[test]
fn whole_numbers_are_exact_however_large() {
    let of = |value: i64| {
        let schema = Schema::new("t", "", vec![Column::integer("x", "")]);
        Table::from_columns(schema, vec![Data::Integer(vec![value])]).unwrap()
    };
    assert_eq!(diff(&of(i64::MAX), &of(i64::MAX - 1)).state, Difference::Changed);
    assert_eq!(diff(&of(i64::MIN), &of(i64::MIN)).state, Difference::Same);
}

#[test]
fn a_value_has_the_unit_that_stands_beside_it() {
    let table = |amount: f64, angle: f64| {
        let columns = vec![
            Column::text("parameter", "").key(),
            Column::float("value", "", "").allows_nan(),
            Column::text("unit", ""),
            Column::float("share", "", ""),
        ];
        let rows = vec![
            vec!["amount".into(), amount.into(), "m".into(), 1.0.into()],
            vec!["angle".into(), angle.into(), "rad".into(), 1.0.into()],
            vec!["count".into(), 3.0.into(), "".into(), amount.into()],
        ];
        Table::from_rows(Schema::new("elements", "", columns), rows).unwrap()
    };
    let found = diff(&table(12e-6, 0.5), &table(14e-6, 0.25));
    let units: Vec<_> = found.columns.iter().map(|column| (column.name.as_str(), column.unit.as_str())).collect();
    assert_eq!(units, [("value", "rad"), ("share", "")], "of the row that is furthest apart");
    let worst: Vec<_> = found.worst.iter().map(|worst| (worst.column.as_str(), worst.unit.as_str())).collect();
    assert!(worst.contains(&("value", "rad")) && worst.contains(&("value", "m")), "{worst:?}");
    assert_eq!(diff(&table(12e-6, 0.5), &table(14e-6, 0.5)).columns[0].unit, "m");
}
