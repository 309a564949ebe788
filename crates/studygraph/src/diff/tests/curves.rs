//! Sampled curves made for it: how far apart they are is known beforehand, or found by looking everywhere.

use proptest::prelude::*;

use crate::diff::curves::told;
use crate::diff::model::{CurvesDiff, Difference, TableDiff, Value};
use crate::diff::table::compare;
use crate::diff::words;
use crate::table::data::{Row, Table};
use crate::table::schema::{Column, Schema};

/// Curves by name: places and values.
type Curves<'a> = &'a [(&'a str, &'a [(f64, f64)])];

fn table(curves: Curves) -> Table {
    let columns = vec![
        Column::text("design", "").key(),
        Column::integer("point", "").key(),
        Column::float("x", "mm", ""),
        Column::float("y", "um", "").tolerance(1e-3, 1e-9).allows_nan(),
        Column::integer("pairs", ""),
    ];
    let mut rows: Vec<Row> = Vec::new();
    for (name, points) in curves {
        for (point, (x, y)) in (1_i64..).zip(points.iter()) {
            rows.push(vec![(*name).into(), point.into(), (*x).into(), (*y).into(), 1_i64.into()]);
        }
    }
    Table::from_rows(Schema::new("t", "", columns), rows).unwrap()
}

fn diff(before: &Table, after: &Table) -> TableDiff {
    let mut diff = compare("s.t", before, after, None, &|_| None);
    told(&mut diff, (before, after), ("x", "y"), &|_| None);
    diff
}

fn curves(diff: &TableDiff) -> &CurvesDiff {
    diff.curves.as_ref().expect("it holds curves")
}

const RAMP: &[(f64, f64)] = &[(0.0, 0.0), (1.0, 1.0), (1.0, 3.0), (2.0, 2.0)];

#[test]
fn a_curve_that_is_sampled_in_other_places_is_the_same_curve() {
    let finer = [(0.0, 0.0), (0.25, 0.25), (1.0, 1.0), (1.0, 3.0), (1.5, 2.5), (2.0, 2.0)];
    let found = diff(&table(&[("a", RAMP)]), &table(&[("a", &finer)]));
    assert_eq!((found.state, found.rows_before, found.rows_after), (Difference::WithinTolerance, 4, 6));
    assert!(found.columns.is_empty() && found.worst.is_empty() && found.added.is_empty(), "{found:?}");
    let found = curves(&found);
    assert_eq!((found.compared, found.changed, found.beyond, found.resampled), (1, 1, 0, 1));
    assert!(found.columns.is_empty(), "{found:?}");
}

#[test]
fn the_largest_vertical_distance_may_lie_between_the_points_of_the_other_curve() {
    // At 1.5 the ramp is 2.5 high; both sides of the jump stay.
    let bent = [(0.0, 0.0), (1.0, 1.0), (1.0, 3.0), (1.5, 2.0), (2.0, 2.0)];
    let same: &[(f64, f64)] = &[(0.0, 7.0), (2.0, 7.0)];
    let found = diff(&table(&[("a", RAMP), ("b", same)]), &table(&[("a", &bent), ("b", same)]));
    assert_eq!(found.state, Difference::Changed);
    let line = words::curves(&found).unwrap();
    assert_eq!(
        line,
        "1 of 2 curves changed; largest vertical distance: y −0.5\u{202f}µm (2.5 → 2) at x=1.5\u{202f}mm, design=a; \
         1 sampled in other places"
    );
    let found = curves(&found);
    assert_eq!((found.compared, found.changed, found.beyond, found.moved_ends), (2, 1, 1, 0));
    let largest = found.columns[0].largest.as_ref().unwrap();
    assert_eq!((largest.difference, largest.at), (-0.5, 1.5));
    assert_eq!(largest.key, [("design".to_owned(), Value::Text("a".to_owned()))]);
}

#[test]
fn a_jump_has_two_sides_and_one_that_moves_is_as_far_apart_as_it_is_high() {
    let lower = [(0.0, 0.0), (1.0, 1.0), (1.0, 2.0), (2.0, 2.0)];
    let found = diff(&table(&[("a", RAMP)]), &table(&[("a", &lower)]));
    let largest = curves(&found).columns[0].largest.clone().unwrap();
    assert_eq!((largest.before, largest.after, largest.at), (3.0, 2.0, 1.0));
    let steps = |at: f64| [(0.0, 1.0), (at, 1.0), (at, 5.0), (2.0, 5.0)];
    let moved = diff(&table(&[("a", &steps(1.0))]), &table(&[("a", &steps(1.25))]));
    assert_eq!(curves(&moved).columns[0].largest.as_ref().map(|largest| largest.difference), Some(-4.0));
    // By less than places are told apart.
    let near = diff(&table(&[("a", &steps(1.0))]), &table(&[("a", &steps(1.0 + 1e-10))]));
    assert_eq!(near.state, Difference::WithinTolerance, "{near:?}");
}

#[test]
fn curves_that_came_went_or_end_elsewhere_are_told() {
    let short = &RAMP[..2];
    let found = diff(&table(&[("a", RAMP), ("b", RAMP)]), &table(&[("a", short), ("c", RAMP)]));
    assert_eq!(found.state, Difference::Changed);
    let line = words::curves(&found).unwrap();
    assert!(line.ends_with("1 with other ends; added: design=c; removed: design=b"), "{line}");
    let found = curves(&found);
    assert_eq!((found.compared, found.moved_ends), (1, 1));
    // A number that went is as far away as can be.
    let holed = [(0.0, 0.0), (1.0, f64::NAN), (1.0, 3.0), (2.0, 2.0)];
    let found = diff(&table(&[("a", RAMP)]), &table(&[("a", &holed)]));
    assert_eq!((found.state, curves(&found).beyond), (Difference::Changed, 1));
    // Nobody knows what lies between points that are not in the order of their places.
    let mixed = [(1.0, 0.0), (0.0, 1.0)];
    assert!(diff(&table(&[("a", RAMP)]), &table(&[("a", &mixed)])).curves.is_none());
}

/// A curve without jumps, looked up by hand.
fn height(curve: &[(f64, f64)], x: f64) -> f64 {
    let after = curve.iter().position(|(place, _)| *place >= x).unwrap_or(curve.len() - 1).max(1);
    let ((x0, y0), (x1, y1)) = (curve[after - 1], curve[after]);
    y0 + (y1 - y0) * (x - x0) / (x1 - x0)
}

prop_compose! {
    fn curve()(inner in prop::collection::btree_set(1_u32..999, 0..12), heights in prop::collection::vec(-5.0_f64..5.0, 14)) -> Vec<(f64, f64)> {
        let places = [0].into_iter().chain(inner).chain([1000]);
        places.zip(heights).map(|(place, height)| (f64::from(place) / 1000.0, height)).collect()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn nowhere_are_two_curves_further_apart(one in curve(), other in curve()) {
        let found = diff(&table(&[("a", &one)]), &table(&[("a", &other)]));
        let told = curves(&found).columns[0].largest.clone().unwrap();
        // Every place where either bends is among these.
        let looked = (0..=1000).map(|step| f64::from(step) / 1000.0).map(|x| (height(&other, x) - height(&one, x)).abs());
        let largest = looked.fold(0.0, f64::max);
        prop_assert!((told.difference.abs() - largest).abs() < 1e-12, "{told:?} against {largest}");
        prop_assert!((height(&one, told.at) - told.before).abs() < 1e-12);
        prop_assert!((height(&other, told.at) - told.after).abs() < 1e-12);
    }
}
