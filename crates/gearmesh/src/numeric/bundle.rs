//! Polynomials of several functions on one interval, evaluated together.
//!
//! In powers of the distance from the middle: as few terms as these lose no digits by it. Must not know: what the functions
//! are.

use super::chebyshev::Series;
use super::panels::powers;

/// N polynomials of as many terms.
#[derive(Clone, Debug, PartialEq)]
pub struct Bundle<const N: usize, const TERMS: usize> {
    lower: f64,
    upper: f64,
    middle: f64,
    per_half: f64,
    /// Of one power after the other, in halves of the interval; of all functions.
    rows: [[f64; N]; TERMS],
}

impl<const N: usize, const TERMS: usize> Bundle<N, TERMS> {
    /// Of series on the interval of the first one, of which each has at most so many terms.
    #[must_use]
    pub fn of(series: [&Series; N]) -> Self {
        let of_powers: [[f64; TERMS]; N] = series.map(|of| powers(of.coefficients()));
        let rows = std::array::from_fn(|power| std::array::from_fn(|n| of_powers[n][power]));
        let (lower, upper) = (series[0].lower(), series[0].upper());
        Self { lower, upper, middle: 0.5 * (lower + upper), per_half: 2.0 / (upper - lower), rows }
    }

    /// The upper end of the interval.
    #[must_use]
    pub const fn upper(&self) -> f64 {
        self.upper
    }

    /// The lower end of the interval.
    #[must_use]
    pub const fn lower(&self) -> f64 {
        self.lower
    }

    /// All values at `x`.
    #[must_use]
    #[inline]
    pub fn values(&self, x: f64) -> [f64; N] {
        let t = (x - self.middle) * self.per_half;
        let mut sums = self.rows[TERMS - 1];
        for row in self.rows[..TERMS - 1].iter().rev() {
            for (sum, coefficient) in sums.iter_mut().zip(row) {
                *sum = *sum * t + coefficient;
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: second method; each series by itself.
    #[test]
    fn all_values_are_those_of_the_series() {
        let one = Series::fit(-0.5, 2.0, 12, libm::exp);
        let slope = one.derivative();
        let bundle = Bundle::<2, 12>::of([&one, &slope]);
        for index in 0..=50 {
            let x = -0.5 + 0.05 * f64::from(index);
            let [value, rate] = bundle.values(x);
            assert!((value - one.value(x)).abs() < 4e-15 && (rate - slope.value(x)).abs() < 4e-15, "{x}");
        }
        assert!(bundle.lower().total_cmp(&-0.5).is_eq() && bundle.upper().total_cmp(&2.0).is_eq());
    }
}
