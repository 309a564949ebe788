//! Chebyshev polynomials of two arguments on a rectangle: fit and evaluation.
//!
//! Nodes are the products of those of `chebyshev`. Must not know: what is interpolated.

use super::chebyshev::{Transform, nodes};

/// A polynomial Σ c_jk T_j T_k on `lower[0]..=upper[0]` × `lower[1]..=upper[1]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    lower: [f64; 2],
    upper: [f64; 2],
    counts: [usize; 2],
    /// By the order in the first argument, then in the second.
    coefficients: Vec<f64>,
}

impl Surface {
    /// The polynomial of degrees `counts` − 1 that equals `function` at the nodes.
    pub fn fit(
        lower: [f64; 2],
        upper: [f64; 2],
        counts: [usize; 2],
        mut function: impl FnMut(f64, f64) -> f64,
    ) -> Self {
        let others = nodes(lower[1], upper[1], counts[1]);
        let mut values = Vec::with_capacity(counts[0] * counts[1]);
        for x in nodes(lower[0], upper[0], counts[0]) {
            values.extend(others.iter().map(|&y| function(x, y)));
        }
        Self::from_values(lower, upper, counts, &values)
    }

    /// The polynomial through `values`, which run over the nodes of the second argument for each of the first.
    #[must_use]
    pub fn from_values(lower: [f64; 2], upper: [f64; 2], counts: [usize; 2], values: &[f64]) -> Self {
        let [rows, columns] = counts;
        let [across, along] = counts.map(Transform::new);
        let along: Vec<Vec<f64>> = values.chunks(columns).map(|row| along.coefficients(row)).collect();
        let mut coefficients = vec![0.0; rows * columns];
        for order in 0..columns {
            let column: Vec<f64> = along.iter().map(|row| row[order]).collect();
            for (row, coefficient) in across.coefficients(&column).into_iter().enumerate() {
                coefficients[row * columns + order] = coefficient;
            }
        }
        Self { lower, upper, counts, coefficients }
    }

    /// The lower ends of both intervals.
    #[must_use]
    pub fn lower(&self) -> [f64; 2] {
        self.lower
    }

    /// The upper ends of both intervals.
    #[must_use]
    pub fn upper(&self) -> [f64; 2] {
        self.upper
    }

    /// How many nodes there are in each argument.
    #[must_use]
    pub fn counts(&self) -> [usize; 2] {
        self.counts
    }

    /// The value at (x, y); outside the rectangle it extrapolates.
    #[must_use]
    pub fn value(&self, x: f64, y: f64) -> f64 {
        let unit = |axis: usize, x: f64| {
            (2.0 * x - self.lower[axis] - self.upper[axis]) / (self.upper[axis] - self.lower[axis])
        };
        let (s, t) = (unit(0, x), unit(1, y));
        let rows = self.coefficients.chunks(self.counts[1]).map(|row| clenshaw(row.iter().copied(), t));
        clenshaw(rows, s)
    }

    /// The values at the nodes, as [`Surface::from_values`] takes them.
    #[must_use]
    pub fn node_values(&self) -> Vec<f64> {
        let axis = |axis: usize| nodes(self.lower[axis], self.upper[axis], self.counts[axis]);
        let others = axis(1);
        axis(0).into_iter().flat_map(|x| others.iter().map(move |&y| (x, y))).map(|(x, y)| self.value(x, y)).collect()
    }
}

/// Σ c_k T_k(t).
fn clenshaw(coefficients: impl DoubleEndedIterator<Item = f64>, t: f64) -> f64 {
    let (mut current, mut next) = (0.0, 0.0);
    for coefficient in coefficients.rev() {
        (current, next) = (2.0 * t * current - next + coefficient, current);
    }
    // The last step counted t twice.
    current - t * next
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_function_is_reproduced() {
        let function = |x: f64, y: f64| libm::exp(0.4 * x) * libm::cos(y) + x * y * y;
        let surface = Surface::fit([0.1, -1.0], [0.9, 1.5], [14, 18], function);
        for (x, y) in [(0.1, -1.0), (0.33, 0.2), (0.9, 1.5), (0.5, -0.77)] {
            assert!((surface.value(x, y) - function(x, y)).abs() < 1e-14, "{x} {y}");
        }
        let again = Surface::from_values([0.1, -1.0], [0.9, 1.5], [14, 18], &surface.node_values());
        assert!((again.value(0.4, 0.4) - function(0.4, 0.4)).abs() < 1e-14);
    }

    #[test]
    fn polynomials_are_exact_and_go_on_outside() {
        let surface = Surface::fit([0.0, 0.0], [1.0, 2.0], [2, 3], |x, y| (1.0 + x) * (y * y - y));
        for (x, y) in [(0.3, 0.7), (-1.0, 3.0), (1.5, -0.5)] {
            assert!((surface.value(x, y) - (1.0 + x) * (y * y - y)).abs() < 1e-13);
        }
        let constant = Surface::from_values([0.0, 0.0], [1.0, 1.0], [1, 1], &[7.0]);
        assert!((constant.value(0.2, 0.9) - 7.0).abs() < 1e-15);
    }
}
