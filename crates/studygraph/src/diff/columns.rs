//! One column of two tables, value by value.
//!
//! NaN equals NaN, −0 equals 0, words and flags are the same or not. Must not know: which rows belong together, or why.

use crate::table::data::Data;
use crate::table::schema::Tolerance;

/// Cells beyond tolerance that a column keeps.
pub const KEPT: usize = 5;

/// Units in the last place that converting a unit may move a value by.
const CONVERSION: f64 = 4.0 * f64::EPSILON;

/// What two columns differ by. Places count in the list of matched rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Differences {
    pub changed: usize,
    pub beyond: usize,
    /// `after − before` and where.
    pub largest_absolute: Option<(f64, usize)>,
    /// Size over the larger of the two, and where.
    pub largest_relative: Option<(f64, usize)>,
    /// Size over what the tolerance allows, infinite for what is not a number, and where.
    pub largest_over: Option<(f64, usize)>,
    /// The furthest apart beyond tolerance: how far, as a share of the column's largest value, and where.
    pub worst: Vec<(f64, usize)>,
}

impl Differences {
    /// Where what stands for all that changed is: values furthest apart, and of words the first.
    pub fn shown(&self) -> Option<usize> {
        self.largest_absolute.or(self.largest_over).map(|(_, place)| place)
    }
}

/// Compares two columns of one type; `converted` when one of them was in another unit.
pub fn compare(
    before: &Data,
    after: &Data,
    matched: &[(usize, usize)],
    tolerance: Tolerance,
    converted: bool,
) -> Differences {
    let slack = if converted { CONVERSION } else { 0.0 };
    match (before, after) {
        (Data::Float(a), Data::Float(b)) => numbers(matched.iter().map(|&(i, j)| (a[i], b[j])), tolerance, slack),
        // Exact below 2^53; a difference of larger ones is still one, since they are compared as they are.
        #[allow(clippy::cast_precision_loss)]
        (Data::Integer(a), Data::Integer(b)) => {
            let mut found = numbers(matched.iter().map(|&(i, j)| (a[i] as f64, b[j] as f64)), tolerance, slack);
            let differ = matched.iter().filter(|&&(i, j)| a[i] != b[j]).count();
            if differ > found.changed {
                let exact = tolerance == Tolerance::default();
                found.beyond += if exact { differ - found.changed } else { 0 };
                found.changed = differ;
            }
            found
        }
        (Data::Text(a), Data::Text(b)) => words(matched.iter().map(|&(i, j)| a[i] == b[j])),
        (Data::Flag(a), Data::Flag(b)) => words(matched.iter().map(|&(i, j)| a[i] == b[j])),
        _ => unreachable!("columns of one type are compared"),
    }
}

fn words(same: impl Iterator<Item = bool>) -> Differences {
    let mut found = Differences::default();
    for (place, _) in same.enumerate().filter(|(_, same)| !same) {
        found.changed += 1;
        found.largest_over.get_or_insert((f64::INFINITY, place));
        if found.worst.len() < KEPT {
            found.worst.push((f64::INFINITY, place));
        }
    }
    found.beyond = found.changed;
    found
}

fn numbers(values: impl Iterator<Item = (f64, f64)>, tolerance: Tolerance, slack: f64) -> Differences {
    let mut found = Differences::default();
    let mut scale = 0.0_f64;
    for (place, (a, b)) in values.enumerate() {
        let largest = a.abs().max(b.abs());
        scale = scale.max(largest);
        #[allow(clippy::float_cmp)] // the same value, not one nearby
        if a == b || (a.is_nan() && b.is_nan()) {
            continue;
        }
        let difference = b - a;
        let size = difference.abs();
        if size <= slack * largest {
            continue;
        }
        found.changed += 1;
        if size.is_nan() {
            // A number that came or went is further away than any other.
            found.beyond += 1;
            over(&mut found, f64::INFINITY, place);
            keep(&mut found.worst, f64::INFINITY, place);
            continue;
        }
        if found.largest_absolute.is_none_or(|(maximum, _)| size > maximum.abs()) {
            found.largest_absolute = Some((difference, place));
        }
        if found.largest_relative.is_none_or(|(maximum, _)| size / largest > maximum) {
            found.largest_relative = Some((size / largest, place));
        }
        let allowed = tolerance.absolute + tolerance.relative * largest;
        over(&mut found, size / allowed, place);
        if size > allowed {
            found.beyond += 1;
            keep(&mut found.worst, size, place);
        }
    }
    for (size, _) in &mut found.worst {
        *size /= scale;
    }
    found
}

/// Keeps the place that is over its tolerance by most, the first of equals.
fn over(found: &mut Differences, share: f64, place: usize) {
    if found.largest_over.is_none_or(|(maximum, _)| share > maximum) {
        found.largest_over = Some((share, place));
    }
}

/// Keeps the furthest apart, the first of equals.
fn keep(worst: &mut Vec<(f64, usize)>, size: f64, place: usize) {
    if worst.len() == KEPT && worst.last().is_some_and(|(minimum, _)| size <= *minimum) {
        return;
    }
    let at = worst.partition_point(|(kept, _)| *kept >= size);
    worst.insert(at, (size, place));
    worst.truncate(KEPT);
}
