//! Gauss–Legendre quadrature.
//!
//! Source: Davis and Rabinowitz, Methods of Numerical Integration, 2nd edition, section 2.7; the nodes are the zeros
//! of the Legendre polynomial P_n, found by Newton's method. Must not know: what is integrated.

use std::f64::consts::PI;

/// Nodes and weights on −1 … 1; exact for polynomials of degree 2n − 1.
#[derive(Clone, Debug, PartialEq)]
pub struct GaussLegendre {
    nodes: Vec<f64>,
    weights: Vec<f64>,
}

impl GaussLegendre {
    /// The rule with `count` nodes.
    #[must_use]
    pub fn new(count: usize) -> Self {
        let (nodes, weights) = (0..count).map(|k| node(k, count)).unzip();
        Self { nodes, weights }
    }

    /// ∫ `function` over `lower..upper`, several integrands at once.
    pub fn integrate<const N: usize>(
        &self,
        lower: f64,
        upper: f64,
        mut function: impl FnMut(f64) -> [f64; N],
    ) -> [f64; N] {
        let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
        let mut sum = [0.0; N];
        for (node, weight) in self.nodes.iter().zip(&self.weights) {
            for (total, value) in sum.iter_mut().zip(function(middle + half * node)) {
                *total += weight * value;
            }
        }
        sum.map(|total| total * half)
    }
}

/// The k-th zero of P_n, ascending, and its weight 2/((1 − x²) P′_n(x)²).
fn node(k: usize, count: usize) -> (f64, f64) {
    // Tricomi's estimate is within Newton's basin for every n.
    let mut x = -libm::cos(PI * (k as f64 + 0.75) / (count as f64 + 0.5));
    for _ in 0..8 {
        let (value, slope) = legendre(count, x);
        x -= value / slope;
    }
    let (_, slope) = legendre(count, x);
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

/// P_n(x) and P′_n(x) by the three-term recurrence.
fn legendre(count: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (0.0, 1.0);
    for order in 1..=count {
        let order = order as f64;
        (before, value) = (value, ((2.0 * order - 1.0) * x * value - (order - 1.0) * before) / order);
    }
    (value, count as f64 * (x * value - before) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_up_to_twice_the_count_are_exact() {
        for count in 1..12_u8 {
            let rule = GaussLegendre::new(count.into());
            let degree = 2 * i32::from(count) - 1;
            let exact = |power: i32| (2f64.powi(power + 1) - (-1f64).powi(power + 1)) / f64::from(power + 1);
            let [odd, even] =
                rule.integrate(-1.0, 2.0, |x| [x.powi(degree), if count > 1 { x.powi(degree - 1) } else { 1.0 }]);
            assert!((odd / exact(degree) - 1.0).abs() < 4e-14, "degree {degree}: {odd}");
            assert!((even / exact(degree - 1) - 1.0).abs() < 4e-14, "degree {}: {even}", degree - 1);
            // The next even degree is not exact: the test can fail.
            let [beyond] = rule.integrate(-1.0, 2.0, |x| [x.powi(degree + 1)]);
            assert!((beyond / exact(degree + 1) - 1.0).abs() > 1e-12, "degree {}", degree + 1);
        }
    }

    #[test]
    fn nodes_ascend_and_weights_add_up() {
        for count in [1, 2, 28, 101] {
            let rule = GaussLegendre::new(count);
            assert!(rule.nodes.windows(2).all(|pair| pair[0] < pair[1]), "{count}");
            assert!((rule.weights.iter().sum::<f64>() - 2.0).abs() < 1e-14, "{count}");
        }
    }
}
