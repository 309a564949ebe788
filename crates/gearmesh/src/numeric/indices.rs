//! Sobol' indices: how much of a variance each independent field explains by itself, and with all others.
//!
//! From pairs of points A and B, and for each field the point A with the field of B: first order by Saltelli et al., total by
//! Jansen (Saltelli, Annoni, Azzini, Campolongo, Ratto, Tarantola, Comput. Phys. Commun. 181 (2010) 259, table 2, (b) and (f)).
//! Must not know: how points are drawn, what a field is.

use super::replicates::{Estimate, REPLICATES};

/// What was found at a pair of points.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a> {
    /// At A and at B.
    pub both: [f64; 2],
    /// At A with the field of B, field by field.
    pub replaced: &'a [f64],
}

/// First order and total of one field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Indices {
    /// Share of the variance that the field explains by itself.
    pub first: Estimate,
    /// The same together with all others.
    pub total: Estimate,
}

/// Sums over pairs.
#[derive(Clone, Default)]
struct Sums {
    count: f64,
    values: f64,
    squares: f64,
    /// By field: of f(B) (f(AB) − f(A)), and of (f(A) − f(AB))².
    of_fields: Vec<[f64; 2]>,
}

impl Sums {
    fn add(&mut self, pair: Pair, origin: f64) {
        let [at_a, at_b] = pair.both.map(|value| value - origin);
        self.count += 1.0;
        self.values += at_a + at_b;
        self.squares += at_a * at_a + at_b * at_b;
        self.of_fields.resize(pair.replaced.len(), [0.0; 2]);
        for (sums, replaced) in self.of_fields.iter_mut().zip(pair.replaced) {
            let change = replaced - origin - at_a;
            sums[0] += at_b * change;
            sums[1] += change * change;
        }
    }

    fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.values += other.values;
        self.squares += other.squares;
        self.of_fields.resize(other.of_fields.len().max(self.of_fields.len()), [0.0; 2]);
        for (sums, others) in self.of_fields.iter_mut().zip(&other.of_fields) {
            sums[0] += others[0];
            sums[1] += others[1];
        }
    }

    /// First order and total of a field; NaN where nothing varies.
    fn indices(&self, field: usize) -> [f64; 2] {
        let Some([first, total]) = self.of_fields.get(field) else { return [f64::NAN; 2] };
        let mean = self.values / (2.0 * self.count);
        let variance = self.squares / (2.0 * self.count) - mean * mean;
        // Rounding of the squares is no variance.
        if variance <= 1e-14 * self.squares / self.count {
            return [f64::NAN; 2];
        }
        [first / self.count / variance, total / (2.0 * self.count) / variance]
    }
}

/// The indices of each of so many fields; pairs in the order in which they were drawn, one from each replicate in turn. A
/// pair of which any value is NaN does not count; how many do is the second.
pub fn indices<'a>(pairs: impl Iterator<Item = Pair<'a>> + Clone, fields: usize) -> (Vec<Indices>, usize) {
    let holds = |pair: &Pair| pair.both.iter().chain(pair.replaced).all(|value| value.is_finite());
    // About the mean, f(B) varies least, and with it the first order.
    let (sum, count) = pairs
        .clone()
        .filter(holds)
        .fold((0.0, 0_usize), |(sum, count), pair| (sum + pair.both[0] + pair.both[1], count + 1));
    let origin = sum / (2 * count.max(1)) as f64;
    let mut replicates = vec![Sums::default(); REPLICATES];
    for (number, pair) in pairs.enumerate().filter(|(_, pair)| holds(pair)) {
        replicates[number % REPLICATES].add(pair, origin);
    }
    let mut all = Sums::default();
    for sums in &replicates {
        all.merge(sums);
    }
    let of_field = |field: usize| {
        let whole = all.indices(field);
        let own: Vec<[f64; 2]> =
            replicates.iter().filter(|sums| sums.count > 0.0).map(|sums| sums.indices(field)).collect();
        let [first, total] = [0, 1].map(|at| Estimate::new(whole[at], own.iter().map(|indices| indices[at])));
        Indices { first, total }
    };
    ((0..fields).map(of_field).collect(), count)
}
