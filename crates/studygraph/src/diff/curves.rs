//! Sampled curves of two tables: how far apart they are at most, wherever either is sampled.
//!
//! Between its points a curve is a straight line; two rows in one place are its two sides. Must not know: which tables hold
//! curves, which is declared.

use std::borrow::Cow;
use std::cmp::Ordering;

use super::model::{CurveColumn, CurvesDiff, Difference, Key, TableDiff, Vertical};
use super::rows::{KeyColumn, MatchedRows, by_keys};
use super::table::{Shared, Tolerances, key_of, shared};
use crate::table::data::{Data, Table};
use crate::table::schema::{Column, Tolerance};

/// Places that are as near as this share of where a curve lies are the same place.
const SAME_PLACE: f64 = 1e-12;

/// Says of a table that differs, and that holds curves over the column `along`, how far they are apart. Left as it is where
/// the tables have no such column, or are not in its order.
/// `quantity` is the column that is told first.
pub fn told(
    diff: &mut TableDiff,
    (before, after): (&Table, &Table),
    (along, quantity): (&str, &str),
    tolerances: Tolerances<'_>,
) {
    if diff.state != Difference::Same
        && let Some(mut found) = compared(before, after, along, tolerances)
    {
        // The sort is stable: the others stay in the order of the table.
        found.columns.sort_by_key(|column| column.name != quantity);
        judge(diff, found);
    }
}

/// Rows of one curve, one after the other.
struct Groups {
    /// Where each begins, and the end of the last.
    starts: Vec<usize>,
}

impl Groups {
    fn of(rows: usize, keys: &[&Data]) -> Self {
        let new = |row: &usize| *row == 0 || keys.iter().any(|key| key.compare(row - 1, *row) != Ordering::Equal);
        Self { starts: (0..rows).filter(new).chain([rows]).collect() }
    }

    fn len(&self) -> usize {
        self.starts.len() - 1
    }

    fn rows(&self, group: usize) -> std::ops::Range<usize> {
        self.starts[group]..self.starts[group + 1]
    }

    /// What the key is of each curve.
    fn firsts(&self, data: &Data) -> Data {
        let firsts = &self.starts[..self.len()];
        match data {
            Data::Float(values) => Data::Float(firsts.iter().map(|&row| values[row]).collect()),
            Data::Integer(values) => Data::Integer(firsts.iter().map(|&row| values[row]).collect()),
            Data::Text(values) => Data::Text(firsts.iter().map(|&row| values[row].clone()).collect()),
            Data::Flag(values) => Data::Flag(firsts.iter().map(|&row| values[row]).collect()),
        }
    }
}

fn compared(before: &Table, after: &Table, along: &str, tolerances: Tolerances<'_>) -> Option<CurvesDiff> {
    let shared = shared(before, after);
    let place = shared.iter().find(|shared| shared.column.name == along)?;
    let (Data::Float(old), Data::Float(new)) = (&*place.before, place.after) else { return None };
    let is_key = |column: &Column| column.key;
    let mut keys: Vec<&Shared> = shared.iter().filter(|shared| is_key(shared.column)).collect();
    // What tells the points of a curve apart, which is declared last.
    let last = keys.len().checked_sub(1);
    if let Some(at) = keys.iter().position(|key| key.column.name == along).or(last) {
        keys.remove(at);
    }
    let of = |data: Vec<&Data>, rows: usize| Groups::of(rows, &data);
    let groups = [
        of(keys.iter().map(|key| &*key.before).collect(), before.rows()),
        of(keys.iter().map(|key| key.after).collect(), after.rows()),
    ];
    let curves = matched(&keys, &groups)?;
    let in_order = |values: &[f64], groups: &Groups| {
        let sorted = |group| values[groups.rows(group)].is_sorted() && !values[groups.rows(group)][0].is_nan();
        (0..groups.len()).all(sorted)
    };
    if !in_order(old, &groups[0]) || !in_order(new, &groups[1]) {
        return None;
    }
    let tolerance = tolerances(place.column).unwrap_or(place.column.tolerance);
    let names = |table: &Table, numbers: &[usize], groups: &Groups| {
        numbers.iter().map(|&group| key(&keys, table, groups.starts[group])).collect()
    };
    let mut found = CurvesDiff {
        along: place.column.name.clone(),
        along_unit: place.column.unit.clone(),
        compared: curves.matched.len(),
        changed: 0,
        beyond: 0,
        resampled: 0,
        moved_ends: 0,
        added: names(after, &curves.added, &groups[1]),
        removed: names(before, &curves.removed, &groups[0]),
        columns: Vec::new(),
    };
    let mut states = vec![Difference::Same; curves.matched.len()];
    for (state, &(a, b)) in states.iter_mut().zip(&curves.matched) {
        let (a, b) = (&old[groups[0].rows(a)], &new[groups[1].rows(b)]);
        let apart = |x: &f64, y: &f64| (x - y).abs() > near(*x, *y, tolerance);
        if a.len() != b.len() || a.iter().zip(b).any(|(x, y)| apart(x, y)) {
            found.resampled += 1;
            *state = Difference::WithinTolerance;
        }
        if apart(&a[0], &b[0]) || a.last().zip(b.last()).is_some_and(|(x, y)| apart(x, y)) {
            found.moved_ends += 1;
            *state = Difference::Changed;
        }
    }
    for column in shared.iter().filter(|one| !is_key(one.column) && one.column.name != along) {
        let (Some(old_values), Some(new_values)) = (numbers(&column.before), numbers(column.after)) else { continue };
        let allowed = tolerances(column.column).unwrap_or(column.column.tolerance);
        let mut of_column = CurveColumn {
            name: column.column.name.clone(),
            unit: column.column.unit.clone(),
            changed: 0,
            beyond: 0,
            largest: None,
        };
        for (state, &(a, b)) in states.iter_mut().zip(&curves.matched) {
            let (a_rows, b_rows) = (groups[0].rows(a), groups[1].rows(b));
            let one = Curve { x: &old[a_rows.clone()], y: &old_values[a_rows] };
            let other = Curve { x: &new[b_rows.clone()], y: &new_values[b_rows.clone()] };
            let slack = if column.converted { 4.0 * f64::EPSILON } else { 0.0 };
            let Some(apart) = farthest(&one, &other, tolerance, allowed, slack) else { continue };
            of_column.changed += 1;
            *state = (*state).max(Difference::WithinTolerance);
            if apart.over > 1.0 {
                of_column.beyond += 1;
                *state = Difference::Changed;
            }
            if of_column.largest.as_ref().is_none_or(|largest| apart.size() > largest.difference.abs()) {
                let key = key(&keys, after, b_rows.start);
                let Apart { before, after, at, .. } = apart;
                of_column.largest = Some(Vertical { difference: after - before, before, after, at, key });
            }
        }
        if of_column.changed > 0 {
            found.columns.push(of_column);
        }
    }
    found.changed = states.iter().filter(|state| **state != Difference::Same).count();
    found.beyond = states.iter().filter(|state| state.differs()).count();
    Some(found)
}

/// What tells the curve of a row from the others.
fn key(keys: &[&Shared], table: &Table, row: usize) -> Key {
    let mut key = key_of(table, row, &|column| column.key);
    key.retain(|(name, _)| keys.iter().any(|key| name.split(" [").next() == Some(&key.column.name)));
    key
}

/// Which curve is which.
fn matched(keys: &[&Shared], groups: &[Groups; 2]) -> Option<MatchedRows> {
    let [old, new] = groups;
    if keys.is_empty() {
        let both = old.len().min(new.len());
        return Some(MatchedRows { matched: (0..both).map(|at| (at, at)).collect(), ..MatchedRows::default() });
    }
    let firsts: Vec<(Data, Data)> = keys.iter().map(|key| (old.firsts(&key.before), new.firsts(key.after))).collect();
    let keys: Vec<KeyColumn> = firsts.iter().map(|(old, new)| KeyColumn::new(Cow::Borrowed(old), new)).collect();
    by_keys(old.len(), new.len(), &keys).ok()
}

/// Counts are steps, which two rows in one place make.
fn numbers(data: &Data) -> Option<Cow<'_, [f64]>> {
    match data {
        Data::Float(values) => Some(Cow::Borrowed(values)),
        #[allow(clippy::cast_precision_loss)]
        Data::Integer(values) => Some(Cow::Owned(values.iter().map(|&value| value as f64).collect())),
        Data::Text(_) | Data::Flag(_) => None,
    }
}

fn near(x: f64, y: f64, tolerance: Tolerance) -> f64 {
    let largest = x.abs().max(y.abs());
    tolerance.absolute + tolerance.relative.max(SAME_PLACE) * largest
}

struct Curve<'a> {
    x: &'a [f64],
    y: &'a [f64],
}

impl Curve<'_> {
    /// What it is to the left and to the right of a place within its range.
    fn sides(&self, x: f64, tolerance: Tolerance) -> [f64; 2] {
        let slack = near(x, x, tolerance);
        let first = self.x.partition_point(|place| *place < x - slack);
        let end = self.x.partition_point(|place| *place <= x + slack);
        if first < end {
            return [self.y[first], self.y[end - 1]];
        }
        let (left, right) = (first.saturating_sub(1), first.min(self.x.len() - 1));
        let width = self.x[right] - self.x[left];
        let share = if width > 0.0 { (x - self.x[left]) / width } else { 0.0 };
        let between = self.y[left] + share * (self.y[right] - self.y[left]);
        [between, between]
    }
}

/// Two curves in the place where they are furthest apart.
struct Apart {
    before: f64,
    after: f64,
    at: f64,
    /// As a multiple of what is allowed, the most of all places.
    over: f64,
}

impl Apart {
    fn size(&self) -> f64 {
        let size = (self.after - self.before).abs();
        if size.is_nan() { f64::INFINITY } else { size }
    }
}

/// Both are straight between the places of either, so they are furthest apart in one of these. A number that came or went
/// is further away than any other, where both are sampled alike; else it is nothing to go by.
fn farthest(a: &Curve, b: &Curve, places: Tolerance, allowed: Tolerance, slack: f64) -> Option<Apart> {
    let from = a.x[0].max(b.x[0]);
    let to = a.x[a.x.len() - 1].min(b.x[b.x.len() - 1]);
    let margin = near(from, to, places);
    let alike = a.x.len() == b.x.len();
    let mut found: Option<Apart> = None;
    let (mut over, mut last) = (0.0_f64, f64::NAN);
    let inside = |x: &&f64| (from - margin..=to + margin).contains(*x);
    for &x in a.x.iter().chain(b.x).filter(inside) {
        if x.to_bits() == last.to_bits() {
            continue;
        }
        last = x;
        for (before, after) in a.sides(x, places).into_iter().zip(b.sides(x, places)) {
            let largest = before.abs().max(after.abs());
            let size = (after - before).abs();
            #[allow(clippy::float_cmp)] // the same value, not one nearby
            let same = before == after || (before.is_nan() && after.is_nan()) || size <= slack * largest;
            if same || (size.is_nan() && !alike) {
                continue;
            }
            let apart = Apart { before, after, at: x, over: 0.0 };
            let limit = allowed.absolute + allowed.relative * largest;
            over = over.max(if size.is_nan() { f64::INFINITY } else { size / limit });
            if found.as_ref().is_none_or(|found| apart.size() > found.size()) {
                found = Some(apart);
            }
        }
    }
    found.map(|found| Apart { over, ..found })
}

/// What the curves say stands for what their points said one by one, where these are not the same points.
fn judge(diff: &mut TableDiff, found: CurvesDiff) {
    let structure = diff.schema.iter().any(|change| change.differs);
    let alike = found.resampled == 0 && found.added.is_empty() && found.removed.is_empty();
    // Words of points that are in both.
    let others = alike && diff.columns.iter().any(|column| column.beyond > 0);
    let curves = found.beyond > 0 || !found.added.is_empty() || !found.removed.is_empty();
    diff.state = if structure || others || curves { Difference::Changed } else { Difference::WithinTolerance };
    if !alike {
        diff.columns.clear();
        diff.worst.clear();
        (diff.rows_added, diff.rows_removed) = (0, 0);
        diff.added.clear();
        diff.removed.clear();
        diff.note.clear();
    }
    diff.curves = Some(found);
}
