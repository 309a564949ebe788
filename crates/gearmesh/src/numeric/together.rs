//! Several smooth functions of one variable as polynomials on the same panels: their quick copy, looked up once.
//!
//! A panel is halved until a polynomial of degree 11 follows each function, so that panels are short next to where one grows
//! without bound; what is left there has no copy. Must not know: what the functions are.

use super::chebyshev::Series;
use super::panels::powers;

const TERMS: usize = 12;
/// Panels to begin with.
const FIRST: usize = 8;
/// How often one is halved at the most.
const HALVINGS: u32 = 8;
/// Equal parts of the range, each of which knows the panel that it begins on.
const BINS: usize = 256;
const LAST_BIN: u32 = 255;
/// Where polynomials are compared with the functions: between nodes, near both ends and near the middle.
const PROBES: [f64; 5] = [-0.965, -0.61, 0.13, 0.61, 0.965];

/// What is found of several functions at several places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found<const N: usize, const M: usize> {
    /// At each place, of each function.
    pub values: [[f64; N]; M],
    /// A bound that is not copied, but kept as the least over a panel; −∞ where there is no copy.
    pub bounds: [f64; M],
}

/// The copies.
#[derive(Clone, Debug, PartialEq)]
pub struct Together<const N: usize> {
    lower: f64,
    upper: f64,
    per_bin: f64,
    bins: Vec<usize>,
    panels: Vec<Panel<N>>,
}

#[derive(Clone, Debug, PartialEq)]
struct Panel<const N: usize> {
    upper: f64,
    middle: f64,
    per_half: f64,
    /// −∞ where no polynomial follows.
    bound: f64,
    /// Of powers of the distance from the middle, in halves of the panel; of all functions.
    coefficients: [[f64; N]; TERMS],
}

impl<const N: usize> Together<N> {
    /// Copies each function to within its accuracy, over its largest magnitude on a panel.
    pub fn fit([lower, upper]: [f64; 2], accuracies: [f64; N], function: impl Fn(f64) -> ([f64; N], f64)) -> Self {
        let mut panels = Vec::new();
        let place = |index: usize| lower + (upper - lower) * index as f64 / FIRST as f64;
        for index in 0..FIRST {
            let end = if index + 1 == FIRST { upper } else { place(index + 1) };
            add([place(index), end], &accuracies, HALVINGS, &function, &mut panels);
        }
        let width = (upper - lower) / BINS as f64;
        let begins_on =
            |bin: usize| panels.partition_point(|panel: &Panel<N>| panel.upper < lower + width * bin as f64);
        let last = panels.len() - 1;
        // One earlier than it seems, for rounding.
        let bins = (0..BINS).map(|bin| begins_on(bin).saturating_sub(1).min(last)).collect();
        Self { lower, upper, per_bin: if width > 0.0 { 1.0 / width } else { 0.0 }, bins, panels }
    }

    /// What they are at ascending places.
    #[must_use]
    #[inline]
    pub fn at_each<const M: usize>(&self, places: &[f64; M]) -> Found<N, M> {
        let mut found = Found { values: [[0.0; N]; M], bounds: [f64::NEG_INFINITY; M] };
        let mut here: Option<&Panel<N>> = None;
        for (m, &x) in places.iter().enumerate() {
            // Mostly that of the place before.
            here = here.filter(|panel| x <= panel.upper).or_else(|| self.panel(x));
            let Some(panel) = here else { continue };
            (found.values[m], found.bounds[m]) = (panel.at(x), panel.bound);
        }
        found
    }

    #[inline]
    fn panel(&self, x: f64) -> Option<&Panel<N>> {
        if !(x >= self.lower && x <= self.upper) {
            return None;
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // inside the range
        let bin = ((x - self.lower) * self.per_bin) as u32;
        let first = self.bins[bin.min(LAST_BIN) as usize];
        self.panels[first..].iter().find(|panel| x <= panel.upper)
    }
}

impl<const N: usize> Panel<N> {
    #[inline]
    fn at(&self, x: f64) -> [f64; N] {
        let t = (x - self.middle) * self.per_half;
        let (t2, t4) = (t * t, (t * t) * (t * t));
        let t8 = t4 * t4;
        let [c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11] = &self.coefficients;
        std::array::from_fn(|n| {
            // Estrin's order: short chains of dependent operations.
            let low = (c0[n] + c1[n] * t) + (c2[n] + c3[n] * t) * t2;
            let middle = (c4[n] + c5[n] * t) + (c6[n] + c7[n] * t) * t2;
            let high = (c8[n] + c9[n] * t) + (c10[n] + c11[n] * t) * t2;
            (low + middle * t4) + high * t8
        })
    }
}

fn add<const N: usize>(
    [lower, upper]: [f64; 2],
    accuracies: &[f64; N],
    halvings: u32,
    function: &impl Fn(f64) -> ([f64; N], f64),
    panels: &mut Vec<Panel<N>>,
) {
    let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
    let mut least = f64::INFINITY;
    let mut values = [[0.0; TERMS]; N];
    for (index, at) in super::chebyshev::nodes(lower, upper, TERMS).into_iter().enumerate() {
        let (found, bound) = function(at);
        least = least.min(bound);
        for (values, found) in values.iter_mut().zip(found) {
            values[index] = found;
        }
    }
    let mut panel = Panel {
        upper,
        middle,
        per_half: if half > 0.0 { 1.0 / half } else { 0.0 },
        bound: f64::NEG_INFINITY,
        coefficients: [[0.0; N]; TERMS],
    };
    for (n, values) in values.iter().enumerate() {
        let of_powers: [f64; TERMS] = powers(Series::from_values(lower, upper, values).coefficients());
        for (coefficients, of_power) in panel.coefficients.iter_mut().zip(of_powers) {
            coefficients[n] = of_power;
        }
    }
    let sizes = values.map(|values| values.iter().fold(0.0_f64, |size, value| size.max(value.abs())));
    let follows = |t: f64| {
        let (exact, bound) = function(middle + half * t);
        let off = |n: usize| {
            let value = panel.coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * t + coefficient[n]);
            (value - exact[n]).abs()
        };
        ((0..N).all(|n| off(n) <= accuracies[n] * sizes[n])).then_some(bound)
    };
    let bounds: Option<Vec<f64>> = PROBES.into_iter().chain([-1.0, 1.0]).map(follows).collect();
    if let Some(bounds) = bounds {
        panel.bound = bounds.into_iter().fold(least, f64::min);
        panels.push(panel);
    } else if halvings > 0 && middle > lower && middle < upper {
        for ends in [[lower, middle], [middle, upper]] {
            add(ends, accuracies, halvings - 1, function, panels);
        }
    } else {
        panels.push(Panel { coefficients: [[0.0; N]; TERMS], ..panel });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: closed form; up to next to where one of them has no bound, on both sides.
    #[test]
    fn functions_are_followed_up_to_next_to_where_one_has_no_bound() {
        let function = |x: f64| ([libm::log(x) + libm::log(3.0 - x), libm::exp(x)], x * (3.0 - x));
        let copies = Together::fit([0.0, 3.0], [1e-14, 1e-14], function);
        let mut copied = 0;
        for index in 1..30_000 {
            let x = 1e-4 * f64::from(index);
            let (exact, bound) = function(x);
            let Found { values: [[one, other]], bounds: [least] } = copies.at_each(&[x]);
            if least == f64::NEG_INFINITY {
                continue;
            }
            assert!((one - exact[0]).abs() < 2e-14 * exact[0].abs().max(1.0), "{x}");
            assert!((other / exact[1] - 1.0).abs() < 3e-14, "{x}");
            assert!(least <= bound * (1.0 + 1e-14) && least > 0.3 * bound, "{x}: {least} of {bound}");
            // Side by side, on one panel and across the next ones.
            let places = [x, (x + 1e-3).min(3.0), (x + 0.4).min(3.0)];
            let found = copies.at_each(&places);
            for (m, place) in places.into_iter().enumerate() {
                let alone = copies.at_each(&[place]);
                assert_eq!(found.values[m].map(f64::to_bits), alone.values[0].map(f64::to_bits), "{x}");
                assert!(found.bounds[m].to_bits() == alone.bounds[0].to_bits(), "{x}");
            }
            copied += 1;
        }
        assert!(copied > 29_800, "{copied}");
        for outside in [-1e-9, 3.0 + 1e-9, f64::NAN, 0.0, 3.0] {
            let found = copies.at_each(&[outside]);
            assert!(found.bounds[0] == f64::NEG_INFINITY && found.values == [[0.0; 2]], "{outside}");
        }
    }

    #[test]
    fn what_is_smooth_has_copies_from_end_to_end() {
        let copies = Together::fit([1.0, 2.0], [1e-14], |x| ([1.0 / x], 7.0));
        for index in 0..=1000 {
            let x = 1.0 + 1e-3 * f64::from(index);
            let Found { values: [[value]], bounds } = copies.at_each(&[x.min(2.0)]);
            assert!((value * x - 1.0).abs() < 2e-14 && bounds[0].to_bits() == 7_f64.to_bits(), "{x}");
        }
        assert_eq!(copies.panels.len(), FIRST);
    }
}
