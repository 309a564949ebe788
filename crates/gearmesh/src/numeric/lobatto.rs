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
}
