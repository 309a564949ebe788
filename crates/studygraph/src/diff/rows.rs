//! Which row of one table is which row of the other.
//!
//! By key, where both have one; numbers of a key match within 1e-9, as everywhere in this program. Must not know: the
//! values that are compared.

use std::borrow::Cow;
use std::cmp::Ordering;

use crate::table::data::Data;

/// Relative distance within which two numbers of a key are the same.
const SAME: f64 = 1e-9;
/// The same against the largest of the column, for numbers that should be zero.
const NOISE: f64 = 1e-12;

/// Rows that belong together, and those that are in one table only, in the order of the tables.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MatchedRows {
    pub matched: Vec<(usize, usize)>,
    pub removed: Vec<usize>,
    pub added: Vec<usize>,
}

/// One column of the key in both tables, in one unit.
pub struct KeyColumn<'a> {
    before: Cow<'a, Data>,
    after: &'a Data,
    noise: f64,
}

impl<'a> KeyColumn<'a> {
    pub fn new(before: Cow<'a, Data>, after: &'a Data) -> Self {
        let largest = |data: &Data| match data {
            Data::Float(values) => values.iter().fold(0.0, |maximum: f64, value| maximum.max(value.abs())),
            _ => 0.0,
        };
        let noise = NOISE * largest(&before).max(largest(after));
        Self { before, after, noise }
    }

    fn across(&self, a: usize, b: usize) -> Ordering {
        match (self.before.as_ref(), self.after) {
            (Data::Float(before), Data::Float(after)) => {
                let (x, y) = (before[a], after[b]);
                let near = (x - y).abs() <= self.noise + SAME * x.abs().max(y.abs());
                if near || (x.is_nan() && y.is_nan()) { Ordering::Equal } else { x.total_cmp(&y) }
            }
            (Data::Integer(before), Data::Integer(after)) => before[a].cmp(&after[b]),
            (Data::Text(before), Data::Text(after)) => before[a].cmp(&after[b]),
            (Data::Flag(before), Data::Flag(after)) => before[a].cmp(&after[b]),
            _ => unreachable!("columns of a key are of one type"),
        }
    }
}

/// Matches rows by key.
///
/// # Errors
/// A phrase, when the key does not tell the rows of one table apart.
pub fn by_keys(before: usize, after: usize, keys: &[KeyColumn<'_>]) -> Result<MatchedRows, String> {
    let left: Vec<&Data> = keys.iter().map(|key| key.before.as_ref()).collect();
    let right: Vec<&Data> = keys.iter().map(|key| key.after).collect();
    let (left, right) = (order(before, &left)?, order(after, &right)?);
    let mut rows = MatchedRows { matched: Vec::with_capacity(left.len().min(right.len())), ..MatchedRows::default() };
    let (mut a, mut b) = (0, 0);
    while a < left.len() && b < right.len() {
        let order = keys.iter().map(|key| key.across(left.at(a), right.at(b))).find(|order| order.is_ne());
        match order.unwrap_or(Ordering::Equal) {
            Ordering::Equal => {
                rows.matched.push((left.at(a), right.at(b)));
                (a, b) = (a + 1, b + 1);
            }
            Ordering::Less => {
                rows.removed.push(left.at(a));
                a += 1;
            }
            Ordering::Greater => {
                rows.added.push(right.at(b));
                b += 1;
            }
        }
    }
    rows.removed.extend((a..left.len()).map(|a| left.at(a)));
    rows.added.extend((b..right.len()).map(|b| right.at(b)));
    Ok(rows)
}

/// Matches the first row with the first, and so on.
#[must_use]
pub fn by_position(before: usize, after: usize) -> MatchedRows {
    let both = before.min(after);
    MatchedRows {
        matched: (0..both).map(|row| (row, row)).collect(),
        removed: (both..before).collect(),
        added: (both..after).collect(),
    }
}

/// Rows in the order of the key.
enum Order {
    /// As they are.
    Natural(usize),
    Sorted(Vec<usize>),
}

impl Order {
    fn len(&self) -> usize {
        match self {
            Self::Natural(rows) => *rows,
            Self::Sorted(rows) => rows.len(),
        }
    }

    fn at(&self, place: usize) -> usize {
        match self {
            Self::Natural(_) => place,
            Self::Sorted(rows) => rows[place],
        }
    }
}

fn order(rows: usize, keys: &[&Data]) -> Result<Order, String> {
    let compare = |a: usize, b: usize| {
        keys.iter().map(|data| data.compare(a, b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
    };
    if (1..rows).all(|row| compare(row - 1, row).is_lt()) {
        return Ok(Order::Natural(rows));
    }
    let mut sorted: Vec<usize> = (0..rows).collect();
    sorted.sort_by(|&a, &b| compare(a, b));
    match sorted.windows(2).find(|pair| compare(pair[0], pair[1]).is_eq()) {
        Some(_) => Err("the columns of the key that both have do not tell its rows apart".to_owned()),
        None => Ok(Order::Sorted(sorted)),
    }
}
