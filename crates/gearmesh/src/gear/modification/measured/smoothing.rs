//! Gaussian regression of second order: each point from the parabola that follows its neighbours best, near ones the most.
//!
//! Parabolas pass unchanged up to both ends of a trace, whatever the distances of its points; of a wave whose length is the cutoff half
//! is left. Source: ISO 16610-31, with the Gaussian of ISO 16610-21. Must not know: gears.

use super::Smoothing;
use crate::numeric::elimination::solve;

/// γ of the weight exp(−π(x/γλ)²) \[-\]: the transmission (1 + πγ²) exp(−πγ²) is one half.
const WIDTH: f64 = 0.730_913_428_094_675_9;
/// Where weights end, in cutoffs: they are below 1e-14 there.
const REACH: f64 = 2.4;
/// A point whose nearest neighbour counts less than this stays as it is.
const ALONE: f64 = 1e-6;

impl Smoothing {
    /// The values at ascending places \[m\], smoothed.
    pub(super) fn smoothed(self, places: &[f64], values: &[f64]) -> Vec<f64> {
        match self {
            Self::None => values.to_vec(),
            Self::Gaussian { cutoff } => (0..places.len()).map(|at| regression(places, values, at, cutoff)).collect(),
        }
    }

    /// The same of a grid along both ways: all of `along` for each of `across`.
    pub(super) fn smoothed_grid(self, along: &[f64], across: &[f64], values: &[f64]) -> Vec<f64> {
        if self == Self::None {
            return values.to_vec();
        }
        let mut found: Vec<f64> = values.chunks(along.len()).flat_map(|line| self.smoothed(along, line)).collect();
        for column in 0..along.len() {
            let line: Vec<f64> = found.iter().skip(column).step_by(along.len()).copied().collect();
            for (value, smooth) in found.iter_mut().skip(column).step_by(along.len()).zip(self.smoothed(across, &line))
            {
                *value = smooth;
            }
        }
        found
    }
}

/// The weighted least-squares parabola about a point, at that point.
fn regression(places: &[f64], values: &[f64], at: usize, cutoff: f64) -> f64 {
    let here = places[at];
    let first = places.partition_point(|place| *place < here - REACH * cutoff);
    let last = places.partition_point(|place| *place <= here + REACH * cutoff);
    let mut rows = [[0.0; 4]; 3];
    let mut neighbours = 0;
    for near in first..last {
        let t = (places[near] - here) / cutoff;
        let weight = libm::exp(-std::f64::consts::PI * (t / WIDTH) * (t / WIDTH)) * share(places, near);
        if near != at && weight > ALONE * share(places, at) {
            neighbours += 1;
        }
        let powers = [1.0, t, t * t];
        for (row, power) in rows.iter_mut().zip(powers) {
            for (sum, other) in row.iter_mut().zip([1.0, t, t * t, values[near] - values[at]]) {
                *sum += weight * power * other;
            }
        }
    }
    if neighbours < 2 {
        return values[at];
    }
    solve(&mut rows);
    values[at] + rows[0][3]
}

/// The length that a point stands for: uneven distances must not count as more of the flank.
fn share(places: &[f64], at: usize) -> f64 {
    let [before, after] = [at.saturating_sub(1), (at + 1).min(places.len() - 1)];
    0.5 * (places[after] - places[before])
}
