//! Mean, variance and harmonics of a periodic function known at quadrature nodes.
//!
//! Integrals over the period, not sums over samples, so jumps and kinks at the ends of the pieces cost nothing. Must
//! not know: what the function is.

use std::f64::consts::TAU;

/// One node: position in the period, quadrature weight (length), value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Distance from the start of the period.
    pub position: f64,
    /// Quadrature weight, a length; all add up to the period.
    pub weight: f64,
    /// The function there; at a jump, its limit from inside the piece.
    pub value: f64,
}

/// Mean and variance: 1/P ∫f and 1/P ∫(f − mean)².
#[must_use]
pub fn mean_and_variance(period: f64, nodes: &[Node]) -> (f64, f64) {
    // Measured from one of the values, so that a small variation on a large mean keeps its digits.
    let origin = nodes.first().map_or(0.0, |node| node.value);
    let offset = nodes.iter().map(|node| node.weight * (node.value - origin)).sum::<f64>() / period;
    let spread = |node: &Node| node.weight * (node.value - origin - offset) * (node.value - origin - offset);
    (origin + offset, nodes.iter().map(spread).sum::<f64>() / period)
}

/// The amplitudes of the harmonics 1 to `count` (cycles per period): |2/P ∫ f e^{−2πi·order·t/P}|.
#[must_use]
pub fn amplitudes(period: f64, nodes: &[Node], count: usize) -> Vec<f64> {
    let origin = nodes.first().map_or(0.0, |node| node.value);
    let mut sums = vec![(0.0, 0.0); count];
    for node in nodes {
        let (sine, cosine) = libm::sincos(TAU * (node.position / period));
        let part = node.weight * (node.value - origin);
        // e^{iθ·order} by turning on: the error grows by one rounding per order, far below that of the quadrature.
        let (mut x, mut y) = (part, 0.0);
        for sum in &mut sums {
            (x, y) = (x * cosine - y * sine, x * sine + y * cosine);
            *sum = (sum.0 + x, sum.1 + y);
        }
    }
    sums.into_iter().map(|(cosine, sine)| 2.0 / period * libm::hypot(cosine, sine)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::lobatto::Rule;

    /// A rectangular wave: `high` on the first `share` of the period 3, `low` after it; each part in `cuts` panels.
    fn wave(high: f64, low: f64, share: f64, cuts: u32) -> Vec<Node> {
        let rule = Rule::new(8);
        let mut nodes = Vec::new();
        for (start, length, value) in [(0.0, 3.0 * share, high), (3.0 * share, 3.0 * (1.0 - share), low)] {
            let width = length / f64::from(cuts);
            for cut in 0..cuts {
                for (x, w) in rule.nodes.iter().zip(&rule.weights) {
                    let position = start + width * (f64::from(cut) + x);
                    nodes.push(Node { position, weight: w * width, value });
                }
            }
        }
        nodes
    }

    #[test]
    fn a_rectangular_wave_has_its_closed_forms() {
        let (high, low, share) = (7e-6, 4e-6, 0.354);
        let nodes = wave(high, low, share, 6);
        let (mean, variance) = mean_and_variance(3.0, &nodes);
        assert!((mean - (high * share + low * (1.0 - share))).abs() < 1e-20);
        let exact = (high - low) * (high - low) * share * (1.0 - share);
        assert!((variance / exact - 1.0).abs() < 1e-14);
        assert_eq!(amplitudes(3.0, &nodes, 5).len(), 5);
        for (order, amplitude) in (1..).zip(amplitudes(3.0, &nodes, 5)) {
            let angle = std::f64::consts::PI * f64::from(order) * share;
            let exact = 2.0 * (high - low) * libm::sin(angle).abs() / (std::f64::consts::PI * f64::from(order));
            assert!((amplitude / exact - 1.0).abs() < 1e-9, "{order}");
        }
    }

    /// On a mean a billion times as large: what rounding of the values leaves, and no more is lost.
    #[test]
    fn a_small_variation_on_a_large_mean_keeps_its_digits() {
        let (high, low, share) = (1.0 + f64::powi(2.0, -30), 1.0, 0.354);
        let (mean, variance) = mean_and_variance(3.0, &wave(high, low, share, 6));
        assert!((mean - (low + share * (high - low))).abs() < 1e-15);
        let exact = (high - low) * (high - low) * share * (1.0 - share);
        assert!((variance / exact - 1.0).abs() < 1e-13, "{variance:e} for {exact:e}");
    }

    /// Turning from order to order against the angle of each order by itself.
    #[test]
    fn two_hundred_harmonics_keep_their_digits() {
        let nodes = wave(7e-6, 4e-6, 0.354, 60);
        for (order, amplitude) in (1..).zip(amplitudes(3.0, &nodes, 200)) {
            let part = |wave: fn(f64) -> f64| -> f64 {
                let angle = |node: &Node| TAU * f64::from(order) * (node.position / 3.0);
                nodes.iter().map(|node| node.weight * (node.value - 7e-6) * wave(angle(node))).sum()
            };
            let plain = 2.0 / 3.0 * libm::hypot(part(libm::cos), part(libm::sin));
            assert!((amplitude - plain).abs() < 1e-13 * 7e-6, "{order}: {amplitude} {plain}");
        }
    }
}
