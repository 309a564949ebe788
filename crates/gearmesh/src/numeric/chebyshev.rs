//! Chebyshev series on an interval: fit, evaluation, antiderivative.
//!
//! Nodes are those of the first kind, x_k = cos((2k + 1)π/2n), taken in ascending order. Source: Trefethen,
//! Approximation Theory and Approximation Practice, chapters 3 and 19. Must not know: what is interpolated.

use std::f64::consts::PI;

/// A polynomial Σ c_k T_k on `lower..=upper`.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    lower: f64,
    upper: f64,
    coefficients: Vec<f64>,
}

/// The `count` nodes of the interval, ascending.
#[must_use]
pub fn nodes(lower: f64, upper: f64, count: usize) -> Vec<f64> {
    let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
    (0..count).map(|k| middle - half * libm::cos(angle(k, count))).collect()
}

fn angle(k: usize, count: usize) -> f64 {
    PI * (2 * k + 1) as f64 / (2 * count) as f64
}

/// From values at so many [`nodes`] to coefficients; the same for any interval.
pub(super) struct Transform {
    /// Those of the multiples of π/2n: one turn of them serves every order.
    cosines: Vec<f64>,
}

impl Transform {
    pub(super) fn new(count: usize) -> Self {
        Self { cosines: (0..4 * count).map(|j| libm::cos(PI * j as f64 / (2 * count) as f64)).collect() }
    }

    pub(super) fn coefficients(&self, values: &[f64]) -> Vec<f64> {
        let turn = self.cosines.len();
        let coefficient = |order: usize| {
            // Of angle π order (2k + 1)/2n. Ascending nodes are cos(π − θ): the last value belongs to the smallest angle.
            let further =
                |angle: usize| if angle + 2 * order < turn { angle + 2 * order } else { angle + 2 * order - turn };
            let angles = std::iter::successors(Some(order), |angle| Some(further(*angle)));
            let sum: f64 = values.iter().rev().zip(angles).map(|(value, angle)| value * self.cosines[angle]).sum();
            sum * if order == 0 { 1.0 } else { 2.0 } / values.len() as f64
        };
        (0..values.len()).map(coefficient).collect()
    }
}

impl Series {
    /// The polynomial of degree `count` − 1 that equals `function` at the [`nodes`].
    pub fn fit(lower: f64, upper: f64, count: usize, function: impl FnMut(f64) -> f64) -> Self {
        let values: Vec<f64> = nodes(lower, upper, count).into_iter().map(function).collect();
        Self::from_values(lower, upper, &values)
    }

    /// The polynomial through `values` at the [`nodes`].
    #[must_use]
    pub fn from_values(lower: f64, upper: f64, values: &[f64]) -> Self {
        Self { lower, upper, coefficients: Transform::new(values.len()).coefficients(values) }
    }

    /// Several functions of one argument, fitted together with as many nodes as they need: the count is doubled from
    /// 16 until the last eighth of the coefficients is below 1e-14 of the largest, or below 1e-11 and no longer falling:
    /// then they are rounding in the functions themselves. `None` when 512 nodes do not suffice: the functions are not
    /// smooth there.
    pub fn converged<const N: usize>(
        lower: f64,
        upper: f64,
        mut function: impl FnMut(f64) -> [f64; N],
    ) -> Option<[Self; N]> {
        let mut count = 16;
        let mut before = f64::INFINITY;
        while count <= 512 {
            let values: Vec<[f64; N]> = nodes(lower, upper, count).into_iter().map(&mut function).collect();
            let transform = Transform::new(count);
            let series: [Self; N] = std::array::from_fn(|index| {
                let values: Vec<f64> = values.iter().map(|row| row[index]).collect();
                Self { lower, upper, coefficients: transform.coefficients(&values) }
            });
            let tail = series.iter().map(|one| one.tail(count / 8)).fold(0.0, f64::max);
            if tail <= 1e-14 || (tail <= 1e-11 && tail > 0.1 * before) {
                return Some(series.map(Self::trimmed));
            }
            (count, before) = (2 * count, tail);
        }
        None
    }

    /// The sum of series on one interval; `None` when they are on different ones, or there are none.
    #[must_use]
    pub fn sum(series: &[&Self]) -> Option<Self> {
        let first = series.first()?;
        #[allow(clippy::float_cmp)] // the same interval, not a near one
        if series.iter().any(|one| one.lower != first.lower || one.upper != first.upper) {
            return None;
        }
        let count = series.iter().map(|one| one.coefficients.len()).max()?;
        let coefficient = |k: usize| series.iter().filter_map(|one| one.coefficients.get(k)).sum();
        Some(Self { lower: first.lower, upper: first.upper, coefficients: (0..count).map(coefficient).collect() })
    }

    /// The largest of the last `count` coefficients over the largest of all; infinite where one is not finite.
    fn tail(&self, count: usize) -> f64 {
        if self.coefficients.iter().any(|c| !c.is_finite()) {
            return f64::INFINITY;
        }
        let all = largest(&self.coefficients);
        if all > 0.0 { largest(&self.coefficients[self.coefficients.len() - count..]) / all } else { 0.0 }
    }

    /// Without the last coefficients, as far as they are rounding.
    fn trimmed(mut self) -> Self {
        let negligible = 2.0 * f64::EPSILON * largest(&self.coefficients);
        while self.coefficients.len() > 1 && self.coefficients.last().is_some_and(|c| c.abs() <= negligible) {
            self.coefficients.pop();
        }
        self
    }

    /// The lower end of the interval.
    #[must_use]
    pub fn lower(&self) -> f64 {
        self.lower
    }

    /// The upper end of the interval.
    #[must_use]
    pub fn upper(&self) -> f64 {
        self.upper
    }

    /// The coefficients c_0 … c_n, lowest order first.
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// The value at `x` (Clenshaw's recurrence); outside the interval it extrapolates.
    #[must_use]
    pub fn value(&self, x: f64) -> f64 {
        let t = (2.0 * x - self.lower - self.upper) / (self.upper - self.lower);
        let (mut next, mut after) = (0.0, 0.0);
        for &coefficient in self.coefficients.iter().skip(1).rev() {
            (next, after) = (2.0 * t * next - after + coefficient, next);
        }
        t * next - after + self.coefficients.first().copied().unwrap_or(0.0)
    }

    /// The values at the nodes.
    #[must_use]
    pub fn node_values(&self) -> Vec<f64> {
        nodes(self.lower, self.upper, self.coefficients.len()).into_iter().map(|x| self.value(x)).collect()
    }

    /// The derivative: c′_(k−1) = c′_(k+1) + 2k c_k over half the interval.
    #[must_use]
    pub fn derivative(&self) -> Self {
        let count = self.coefficients.len();
        let mut slopes = vec![0.0; count + 1];
        for k in (1..count).rev() {
            slopes[k - 1] = slopes[k + 1] + 2.0 * k as f64 * self.coefficients[k];
        }
        slopes[0] *= 0.5;
        slopes.truncate(count.saturating_sub(1).max(1));
        let per_half = 2.0 / (self.upper - self.lower);
        Self { coefficients: slopes.into_iter().map(|slope| slope * per_half).collect(), ..*self }
    }

    /// The antiderivative that is zero at `lower`.
    #[must_use]
    pub fn integral(&self) -> Self {
        let c = |k: usize| self.coefficients.get(k).copied().unwrap_or(0.0);
        let half = 0.5 * (self.upper - self.lower);
        let count = self.coefficients.len() + 1;
        let mut integral = vec![0.0; count];
        for (k, slot) in integral.iter_mut().enumerate().skip(1) {
            let previous = if k == 1 { 2.0 * c(0) } else { c(k - 1) };
            *slot = half * (previous - c(k + 1)) / (2 * k) as f64;
        }
        // T_k(−1) = (−1)^k.
        integral[0] = -integral.iter().enumerate().skip(1).map(|(k, b)| if k % 2 == 0 { *b } else { -b }).sum::<f64>();
        Self { lower: self.lower, upper: self.upper, coefficients: integral }
    }
}

fn largest(coefficients: &[f64]) -> f64 {
    coefficients.iter().fold(0.0, |maximum: f64, c| maximum.max(c.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_function_is_reproduced_and_integrated() {
        let series = Series::fit(0.5, 3.0, 30, libm::exp);
        assert_eq!([series.lower(), series.upper()].map(f64::to_bits), [0.5, 3.0].map(f64::to_bits));
        let integral = series.integral();
        for x in [0.5, 0.7, 1.9, 3.0] {
            assert!((series.value(x) / libm::exp(x) - 1.0).abs() < 4e-14, "value at {x}");
            let exact = libm::exp(x) - libm::exp(0.5);
            assert!((integral.value(x) - exact).abs() < 4e-14 * libm::exp(3.0), "integral at {x}");
        }
    }

    #[test]
    fn the_derivative_is_that_of_the_polynomial() {
        let series = Series::fit(0.5, 3.0, 30, libm::exp).derivative();
        for x in [0.5, 0.7, 1.9, 3.0] {
            assert!((series.value(x) / libm::exp(x) - 1.0).abs() < 1e-11, "at {x}");
        }
        assert!(Series::from_values(0.0, 1.0, &[3.0]).derivative().value(0.3).abs() < 1e-300, "of a constant");
        let slope = Series::from_values(0.0, 2.0, &[0.0, 2.0]).derivative().value(1.7);
        assert!((slope - 2.0 * 2_f64.sqrt() / 2.0).abs() < 1e-14, "of a straight line: {slope}");
    }

    #[test]
    fn the_count_follows_the_function() {
        let near_pole = |x: f64| 1.0 / (1.05 - x);
        let [smooth, steep] = Series::converged(-1.0, 1.0, |x| [libm::exp(x), near_pole(x)]).unwrap();
        assert!(smooth.coefficients().len() < 20 && steep.coefficients().len() > 60);
        for x in [-1.0, -0.3, 0.99, 1.0] {
            assert!((smooth.value(x) / libm::exp(x) - 1.0).abs() < 1e-14, "exp at {x}");
            assert!((steep.value(x) / near_pole(x) - 1.0).abs() < 1e-12, "pole at {x}");
        }
        assert!(Series::converged(-1.0, 1.0, |x| [x.abs()]).is_none());
        assert!(Series::converged(-1.0, 1.0, |x| [1.0 / (x - 2.0).max(0.0)]).is_none());
        assert_eq!(Series::converged(0.0, 1.0, |_| [0.0]).unwrap()[0].coefficients(), [0.0]);
    }

    #[test]
    fn a_function_s_own_rounding_is_not_chased() {
        // Rounded to eleven digits or so, by cancelling.
        let rough = |x: f64| (libm::exp(x) + 1e4) - 1e4;
        let [series] = Series::converged(-1.0, 1.0, |x| [rough(x)]).unwrap();
        assert!((series.value(0.3) / libm::exp(0.3) - 1.0).abs() < 1e-11);
    }

    #[test]
    fn sums_are_those_of_the_values() {
        let (one, two) = (Series::fit(0.0, 2.0, 20, libm::exp), Series::fit(0.0, 2.0, 5, |x| x * x));
        let sum = Series::sum(&[&one, &two]).unwrap();
        assert!((sum.value(1.3) - libm::exp(1.3) - 1.69).abs() < 1e-13);
        assert!(Series::sum(&[&one, &Series::fit(0.0, 2.5, 5, |x| x)]).is_none() && Series::sum(&[]).is_none());
    }

    #[test]
    fn polynomials_are_exact() {
        let series = Series::fit(-2.0, 1.0, 4, |x| x * x * x - 2.0 * x);
        assert!((series.value(0.3) - (0.027 - 0.6)).abs() < 1e-14);
        assert_eq!(nodes(0.0, 1.0, 3).len(), 3);
        assert!(nodes(0.0, 1.0, 9).windows(2).all(|pair| pair[0] < pair[1]));
    }
}
