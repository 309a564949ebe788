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

impl Series {
    /// The polynomial of degree `count` − 1 that equals `function` at the [`nodes`].
    pub fn fit(lower: f64, upper: f64, count: usize, function: impl FnMut(f64) -> f64) -> Self {
        let values: Vec<f64> = nodes(lower, upper, count).into_iter().map(function).collect();
        Self::from_values(lower, upper, &values)
    }

    /// The polynomial through `values` at the [`nodes`].
    #[must_use]
    pub fn from_values(lower: f64, upper: f64, values: &[f64]) -> Self {
        let count = values.len();
        let coefficients = (0..count)
            .map(|order| {
                let sum: f64 = values
                    .iter()
                    .enumerate()
                    // Ascending nodes are cos(π − θ), which flips the sign of the odd orders.
                    .map(|(k, value)| value * libm::cos(order as f64 * (PI - angle(k, count))))
                    .sum();
                sum * if order == 0 { 1.0 } else { 2.0 } / count as f64
            })
            .collect();
        Self { lower, upper, coefficients }
    }

    #[must_use]
    pub fn lower(&self) -> f64 {
        self.lower
    }

    #[must_use]
    pub fn upper(&self) -> f64 {
        self.upper
    }

    /// Highest order first dropped last: the coefficients c_0 … c_n.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_function_is_reproduced_and_integrated() {
        let series = Series::fit(0.5, 3.0, 30, libm::exp);
        let integral = series.integral();
        for x in [0.5, 0.7, 1.9, 3.0] {
            assert!((series.value(x) / libm::exp(x) - 1.0).abs() < 4e-14, "value at {x}");
            let exact = libm::exp(x) - libm::exp(0.5);
            assert!((integral.value(x) - exact).abs() < 4e-14 * libm::exp(3.0), "integral at {x}");
        }
    }

    #[test]
    fn polynomials_are_exact() {
        let series = Series::fit(-2.0, 1.0, 4, |x| x * x * x - 2.0 * x);
        assert!((series.value(0.3) - (0.027 - 0.6)).abs() < 1e-14);
        assert_eq!(nodes(0.0, 1.0, 3).len(), 3);
        assert!(nodes(0.0, 1.0, 9).windows(2).all(|pair| pair[0] < pair[1]));
    }
}
