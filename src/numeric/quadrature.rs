//! Gauss–Legendre quadrature.
//!
//! Nodes are the roots of the Legendre polynomial by Newton's method from Tricomi's estimate; weights from its
//! derivative. Source: Abramowitz and Stegun 25.4.29, 22.16.6. Must not know: what is integrated.

use std::f64::consts::PI;

/// Nodes (ascending) and weights on −1…1.
#[must_use]
pub fn legendre(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    (0..count)
        .map(|index| {
            let k = (count - index) as f64;
            let mut x = (1.0 - (n - 1.0) / (8.0 * n * n * n)) * libm::cos(PI * (4.0 * k - 1.0) / (4.0 * n + 2.0));
            let mut slope = 1.0;
            for _ in 0..10 {
                let (value, derivative) = polynomial(count, x);
                slope = derivative;
                let step = value / derivative;
                x -= step;
                if step.abs() <= f64::EPSILON {
                    break;
                }
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// P_n and its derivative.
fn polynomial(count: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for k in 2..=count {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
    }
    if count == 0 {
        return (1.0, 0.0);
    }
    (value, count as f64 * (before - x * value) / (1.0 - x * x))
}

/// ∫ `function` over `lower..upper`, with `count` points, for several integrands at once.
pub fn integrate<const N: usize>(
    lower: f64,
    upper: f64,
    count: usize,
    mut function: impl FnMut(f64) -> [f64; N],
) -> [f64; N] {
    let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
    let mut sums = [0.0; N];
    for (x, weight) in legendre(count) {
        for (sum, value) in sums.iter_mut().zip(function(middle + half * x)) {
            *sum += half * weight * value;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_two_n_minus_one_are_exact() {
        for count in [1, 2, 5, 28, 64] {
            let degree = i32::try_from(2 * count - 1).unwrap();
            let [odd, even] = integrate(0.0, 1.0, count, |x| [x.powi(degree), x.powi(degree - 1)]);
            assert!((odd * f64::from(degree + 1) - 1.0).abs() < 1e-13, "{count} points");
            assert!((even * f64::from(degree) - 1.0).abs() < 1e-13, "{count} points");
        }
    }

    #[test]
    fn convergence_is_geometric_for_an_analytic_function() {
        let error = |count| (integrate(0.0, 2.0, count, |x| [1.0 / (1.0 + x * x)])[0] - libm::atan(2.0)).abs();
        assert!(error(6) > 1e-8 && error(12) < 1e-9 && error(28) < 1e-15);
    }
}
