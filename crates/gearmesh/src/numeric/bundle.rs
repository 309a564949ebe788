//! Chebyshev series of several functions on one interval, evaluated together.
//!
//! Must not know: what the functions are.

use super::chebyshev::Series;

/// N series of as many terms.
#[derive(Clone, Debug, PartialEq)]
pub struct Bundle<const N: usize, const TERMS: usize> {
    lower: f64,
    upper: f64,
    /// Of one polynomial after the other, of all functions.
    rows: [[f64; N]; TERMS],
}

impl<const N: usize, const TERMS: usize> Bundle<N, TERMS> {
    /// Of series on the interval of the first one, of which each has at most so many terms.
    #[must_use]
    pub fn of(series: [&Series; N]) -> Self {
        let term = |of: &Series, order: usize| of.coefficients().get(order).copied().unwrap_or(0.0);
        let rows = std::array::from_fn(|order| series.map(|of| term(of, order)));
        Self { lower: series[0].lower(), upper: series[0].upper(), rows }
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

    /// All values at `x`, by Clenshaw's recurrence.
    #[must_use]
    #[inline]
    pub fn values(&self, x: f64) -> [f64; N] {
        let t = (2.0 * x - self.lower - self.upper) / (self.upper - self.lower);
        let (twice, mut next, mut after) = (2.0 * t, [0.0; N], [0.0; N]);
        for row in self.rows[1..].iter().rev() {
            let here: [f64; N] = std::array::from_fn(|n| twice * next[n] - after[n] + row[n]);
            (next, after) = (here, next);
        }
        std::array::from_fn(|n| t * next[n] - after[n] + self.rows[0][n])
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
            assert!((value - one.value(x)).abs() < 1e-15 && (rate - slope.value(x)).abs() < 1e-15, "{x}");
        }
        assert!(bundle.lower().total_cmp(&-0.5).is_eq() && bundle.upper().total_cmp(&2.0).is_eq());
    }
}
