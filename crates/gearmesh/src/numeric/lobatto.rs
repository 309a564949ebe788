//! Gauss–Lobatto rules: quadrature and interpolation on nodes that include both ends of the interval.
//!
//! Ends are nodes because a function that jumps at the ends of an interval must be sampled there from inside. `n` nodes
//! integrate polynomials of degree 2n − 3 exactly. Source: Abramowitz and Stegun 25.4.32. Must not know: what is
//! integrated.

use std::f64::consts::PI;

/// Nodes and weights on `0..=1`, ascending.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// The first is 0, the last is 1.
    pub nodes: Vec<f64>,
    /// One per node; they add up to 1.
    pub weights: Vec<f64>,
}

impl Rule {
    /// The rule with `count` nodes, at least two.
    #[must_use]
    pub fn new(count: usize) -> Self {
        let last = count.max(2) - 1;
        let mut nodes = vec![0.0; last + 1];
        let mut weights = vec![0.0; last + 1];
        let share = 1.0 / (last * (last + 1)) as f64;
        for i in 0..=last / 2 {
            let mut x = libm::cos(PI * i as f64 / last as f64);
            if i > 0 {
                // Newton on P'_last; its derivative follows from Legendre's equation.
                for _ in 0..50 {
                    let (value, before) = legendre(last, x);
                    let degree = last as f64;
                    let slope = degree * (before - x * value) / (1.0 - x * x);
                    let bend = (2.0 * x * slope - degree * (degree + 1.0) * value) / (1.0 - x * x);
                    let step = slope / bend;
                    x -= step;
                    if step.abs() < 1e-16 {
                        break;
                    }
                }
            }
            if 2 * i == last {
                x = 0.0;
            }
            let weight = share / (legendre(last, x).0 * legendre(last, x).0);
            (nodes[i], nodes[last - i]) = (0.5 - 0.5 * x, 0.5 + 0.5 * x);
            (weights[i], weights[last - i]) = (weight, weight);
        }
        Self { nodes, weights }
    }

    /// Rows of the matrix that turns values at the nodes into derivatives at the nodes (with respect to `0..=1`).
    #[must_use]
    pub fn differentiation(&self) -> Vec<Vec<f64>> {
        let nodes = &self.nodes;
        let scale: Vec<f64> = nodes
            .iter()
            .enumerate()
            .map(|(i, x)| nodes.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, y)| x - y).product())
            .collect();
        (0..nodes.len())
            .map(|i| {
                let entry = |k: usize| scale[i] / (scale[k] * (nodes[i] - nodes[k]));
                let mut row: Vec<f64> = (0..nodes.len()).map(|k| if k == i { 0.0 } else { entry(k) }).collect();
                row[i] = -row.iter().sum::<f64>();
                row
            })
            .collect()
    }
}

/// Legendre's P_n and P_{n−1} at `x`, for n ≥ 1.
#[must_use]
pub fn legendre(degree: usize, x: f64) -> (f64, f64) {
    let (mut value, mut before) = (x, 1.0);
    for k in 2..=degree {
        let k = k as f64;
        (value, before) = (((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k, value);
    }
    (value, before)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_up_to_degree_2n_minus_3_are_exact_and_the_next_is_not() {
        for count in [2, 3, 5, 8, 33] {
            let rule = Rule::new(count);
            let moment = |degree: usize| -> f64 {
                rule.nodes.iter().zip(&rule.weights).map(|(x, w)| w * libm::pow(*x, degree as f64)).sum()
            };
            for degree in 0..=(2 * count - 3).min(40) {
                assert!((moment(degree) - 1.0 / (degree + 1) as f64).abs() < 4e-16, "{count} nodes, degree {degree}");
            }
            if count < 6 {
                assert!((moment(2 * count - 2) - 1.0 / (2 * count - 1) as f64).abs() > 1e-6);
            }
            assert!(rule.nodes[0] == 0.0 && (rule.nodes[count - 1] - 1.0).abs() < f64::EPSILON);
            assert!(rule.nodes.windows(2).all(|pair| pair[0] < pair[1]));
        }
    }

    #[test]
    fn derivatives_of_polynomials_are_exact() {
        let rule = Rule::new(8);
        let values: Vec<f64> = rule.nodes.iter().map(|x| libm::pow(*x, 7.0) - x * x).collect();
        for (row, x) in rule.differentiation().iter().zip(&rule.nodes) {
            let slope: f64 = row.iter().zip(&values).map(|(d, v)| d * v).sum();
            assert!((slope - (7.0 * libm::pow(*x, 6.0) - 2.0 * x)).abs() < 1e-13);
        }
    }
}
