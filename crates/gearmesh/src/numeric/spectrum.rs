//! The spectrum of equidistant samples of a period.
//!
//! Cooley and Tukey's transform, a prime factor at a time: a hunting period is a product of tooth numbers, seldom a power of two.
//! By own code, since those of libraries (rustfft 6) take the sines of whatever library the machine has, and then add up in an
//! order of its processor's. Must not know: what was sampled.

use std::f64::consts::TAU;

/// Real and imaginary part.
type Complex = [f64; 2];

/// Amplitudes of the orders 1 to `orders` of the period that `samples` are equidistant values of: of the cosine of each, in the
/// samples' own unit. Orders that so many samples do not tell are 0.
#[must_use]
pub fn amplitudes(samples: &[f64], orders: usize) -> Vec<f64> {
    let count = samples.len();
    let root = |index: usize| {
        let (sine, cosine) = libm::sincos(TAU * index as f64 / count as f64);
        [cosine, -sine]
    };
    let roots: Vec<Complex> = (0..count).map(root).collect();
    let values = if count == 0 { Vec::new() } else { transform(samples, 1, count, &roots) };
    let amplitude = |order: usize| {
        let [real, imaginary] = if 2 * order <= count { values[order] } else { [0.0; 2] };
        // The highest order is its own mirror image.
        let times = if 2 * order == count { 1.0 } else { 2.0 };
        times * libm::hypot(real, imaginary) / count.max(1) as f64
    };
    (1..=orders).map(amplitude).collect()
}

/// Σ x_j w^(jk) for k below `count`, of every `step`-th sample, `count` of them; w is the root of unity of that order.
fn transform(samples: &[f64], step: usize, count: usize, roots: &[Complex]) -> Vec<Complex> {
    if count == 1 {
        return vec![[samples[0], 0.0]];
    }
    let factor = (2..=count.isqrt()).find(|factor| count.is_multiple_of(*factor)).unwrap_or(count);
    let length = count / factor;
    let parts: Vec<_> =
        (0..factor).map(|part| transform(&samples[part * step..], step * factor, length, roots)).collect();
    let value = |index: usize| {
        let mut sum = [0.0; 2];
        for (part, values) in parts.iter().enumerate() {
            let ([real, imaginary], [cosine, sine]) =
                (values[index % length], roots[part * index % count * (roots.len() / count)]);
            sum = [sum[0] + real * cosine - imaginary * sine, sum[1] + real * sine + imaginary * cosine];
        }
        sum
    };
    (0..count).map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::amplitudes;

    /// Tier: closed form; sums of cosines, of lengths that are prime, odd, powers of two and products.
    #[test]
    fn cosines_have_their_amplitudes() {
        for count in [16_u32, 101, 912, 10_403, 1023] {
            let sample = |index: u32| {
                let turn = std::f64::consts::TAU * f64::from(index) / f64::from(count);
                3.0 + 1.5 * (turn * 2.0 + 0.3).cos() + 0.25 * (5.0 * turn - 1.0).sin()
            };
            let samples: Vec<f64> = (0..count).map(sample).collect();
            for (order, found) in (1..).zip(amplitudes(&samples, 7)) {
                let exact = [0.0, 1.5, 0.0, 0.0, 0.25, 0.0, 0.0][order - 1];
                assert!((found - exact).abs() < 1e-13, "order {order} of {count}: {found}");
            }
        }
    }

    /// Tier: invariant; mean square less squared mean is half of the sum of squared amplitudes.
    #[test]
    fn amplitudes_hold_the_variance() {
        let samples: Vec<f64> = (0..997_u32).map(|index| f64::from(index * index % 83)).collect();
        let count = samples.len() as f64;
        let mean = samples.iter().sum::<f64>() / count;
        let variance = samples.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
        let sum: f64 = amplitudes(&samples, 498).iter().map(|amplitude| 0.5 * amplitude * amplitude).sum();
        assert!((sum / variance - 1.0).abs() < 1e-12, "{sum} for {variance}");
    }

    #[test]
    fn orders_that_samples_do_not_tell_are_none() {
        assert!(amplitudes(&[1.0, 2.0], 3)[1..].iter().all(|amplitude| *amplitude < 1e-300));
        assert!(amplitudes(&[], 3).iter().all(|amplitude| *amplitude < 1e-300));
        assert!((amplitudes(&[1.0, -1.0], 1)[0] - 1.0).abs() < 1e-15);
    }
}
