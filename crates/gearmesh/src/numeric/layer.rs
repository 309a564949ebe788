//! A shear layer on springs, on a strip with free ends: w − λ² w″ = c q on 0..=1 with w′ = 0 at both ends.
//!
//! Its Green's function is cosh(x/λ) cosh((1 − x′)/λ)/(λ sinh(1/λ)) for x ≤ x′. Here it stands averaged over equal
//! slices, in closed form and without a growing exponential. Source: Selvadurai, Elastic Analysis of Soil-Foundation
//! Interaction, 1979, chapter 2 (Pasternak's foundation). Must not know: what is elastic.

/// Adds `scale` times the layer's influences to a square matrix of `count` slices, by rows of `stride`.
///
/// An influence is the mean deflection of one slice by a load on another, over what the same load gives when it is
/// spread over the whole strip: symmetric, positive definite, every row with the sum `count`. `length` is λ ≥ 0 over the
/// length of the strip; at 0 slices are independent, at infinity they move as one.
pub fn add_influences(length: f64, scale: f64, count: usize, stride: usize, matrix: &mut [f64]) {
    let slices = count as f64;
    if length.is_infinite() || count == 1 {
        for row in matrix.chunks_mut(stride).take(count) {
            for entry in &mut row[..count] {
                *entry += scale;
            }
        }
        return;
    }
    let width = 1.0 / (slices * length);
    let decay = libm::exp(-width);
    let powers: Vec<f64> = std::iter::successors(Some(1.0), |power| Some(power * decay)).take(2 * count).collect();
    let fall = -libm::expm1(-width);
    let factor = 0.5 * length * slices * slices * fall * fall / -libm::expm1(-2.0 / length);
    let mut rows = vec![slices; count];
    for first in 0..count {
        // Half a slice from its middle to either side; twice that to its mirror image beyond the free end.
        let below = factor * (1.0 + powers[2 * first + 1]);
        for second in first + 1..count {
            let above = 1.0 + powers[2 * (count - second) - 1];
            let influence = if length > 0.0 { below * above * powers[second - first - 1] } else { 0.0 };
            matrix[first * stride + second] += scale * influence;
            matrix[second * stride + first] += scale * influence;
            rows[first] -= influence;
            rows[second] -= influence;
        }
    }
    for (slice, own) in rows.into_iter().enumerate() {
        matrix[slice * stride + slice] += scale * own;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::quadrature::GaussLegendre;

    fn influences(length: f64, count: usize) -> Vec<f64> {
        let mut matrix = vec![0.0; count * count];
        add_influences(length, 1.0, count, count, &mut matrix);
        matrix
    }

    /// Tier: second method. The layer by cosines, which have free ends: w_n = q_n/(1 + (nπλ)²).
    #[test]
    fn influences_are_those_of_a_cosine_series() {
        for (length, count) in [(0.03, 7), (0.2, 5), (0.21, 12), (3.0, 4)] {
            let found = influences(length, count);
            let width = 1.0 / count as f64;
            // Σ over n of the squares of slice means falls as n⁻⁴ with the 1/n² of the layer.
            let mut exact = vec![1.0; count * count];
            for n in 1..40_000 {
                let k = std::f64::consts::PI * f64::from(n);
                let half = 0.5 * k * width;
                let size = libm::sin(half) / half;
                let means: Vec<f64> =
                    (0..count).map(|slice| size * libm::cos(k * width * (slice as f64 + 0.5))).collect();
                for (index, exact) in exact.iter_mut().enumerate() {
                    *exact += 2.0 * means[index / count] * means[index % count] / (1.0 + k * k * length * length);
                }
            }
            for s in 0..count {
                for t in 0..count {
                    let exact = exact[s * count + t];
                    let entry = found[s * count + t];
                    assert!((entry - exact).abs() < 1e-8 * exact.abs().max(1.0), "{length} {s} {t}: {entry} {exact}");
                }
            }
        }
    }

    /// Tier: closed form. The Green's function, integrated over both slices.
    #[test]
    fn an_influence_is_the_greens_function_integrated() {
        let (length, count) = (0.3, 6);
        let green = |x: f64, y: f64| {
            let (low, high) = (x.min(y), x.max(y));
            libm::cosh(low / length) * libm::cosh((1.0 - high) / length) / (length * libm::sinh(1.0 / length))
        };
        let rule = GaussLegendre::new(12);
        let found = influences(length, count);
        let of = |slice: usize| (slice as f64 / 6.0, (slice as f64 + 1.0) / 6.0);
        for (s, t) in [(0, 1), (0, 5), (2, 4), (4, 5)] {
            let ((a, b), (c, d)) = (of(s), of(t));
            let [exact] = rule.integrate(a, b, |x| rule.integrate(c, d, |y| [36.0 * green(x, y)]));
            assert!((found[s * count + t] / exact - 1.0).abs() < 1e-12);
        }
        // The own one has a kink on its diagonal.
        let [exact] = rule.integrate(0.5, 4.0 / 6.0, |x| {
            let [below] = rule.integrate(0.5, x, |y| [green(x, y)]);
            let [above] = rule.integrate(x, 4.0 / 6.0, |y| [green(x, y)]);
            [36.0 * (below + above)]
        });
        assert!((found[3 * count + 3] / exact - 1.0).abs() < 1e-12);
    }

    #[test]
    fn rows_add_up_and_the_limits_are_springs_and_a_rigid_strip() {
        for length in [0.0, 1e-300, 1e-9, 1e-3, 0.05, 0.7, 40.0, 1e9, f64::INFINITY] {
            for count in [1, 2, 9, 41] {
                let found = influences(length, count);
                for (s, row) in found.chunks(count).enumerate() {
                    let sum: f64 = row.iter().sum();
                    assert!((sum / count as f64 - 1.0).abs() < 1e-14, "{length} {count}");
                    for (t, entry) in row.iter().enumerate() {
                        assert_eq!(entry.to_bits(), found[t * count + s].to_bits(), "symmetric");
                        assert!(*entry >= 0.0);
                        if length < 1e-8 {
                            let exact = if s == t { count as f64 } else { 0.0 };
                            assert!((entry - exact).abs() < 1e-6 * count as f64);
                        } else if length > 1e8 {
                            assert!((entry - 1.0).abs() < 1e-12);
                        }
                    }
                }
            }
        }
    }
}
