//! A smooth function as a row of short polynomials: the quick copy of a function that is evaluated very often.
//!
//! Equal panels, one polynomial of degree 9 each, as many panels as the wanted accuracy needs. Must not know: what the
//! function is.

use super::chebyshev::Series;

const TERMS: usize = 10;
/// More panels than this would mean that the function is not smooth.
const MOST_PANELS: usize = 512;

/// A piecewise polynomial on `lower..=upper`.
#[derive(Clone, Debug, PartialEq)]
pub struct Panels {
    lower: f64,
    per_length: f64,
    last: f64,
    /// Powers of the distance from the panel's middle, in half panels.
    coefficients: Vec<[f64; TERMS]>,
}

impl Panels {
    /// Follows `function` to within `tolerance` of its largest magnitude, as far as panels can.
    pub fn fit(lower: f64, upper: f64, tolerance: f64, function: impl Fn(f64) -> f64) -> Self {
        let mut count = 4;
        loop {
            let panels = Self::with_panels(lower, upper, count, &function);
            let (mut error, mut size) = (0.0_f64, 0.0_f64);
            for probe in 0..count * 8 {
                let x = lower + (upper - lower) * (probe as f64 + 0.37) / (count * 8) as f64;
                let exact = function(x);
                error = error.max((panels.value(x) - exact).abs());
                size = size.max(exact.abs());
            }
            if error <= tolerance * size || count >= MOST_PANELS {
                return panels;
            }
            count *= 2;
        }
    }

    fn with_panels(lower: f64, upper: f64, count: usize, function: &impl Fn(f64) -> f64) -> Self {
        let width = (upper - lower) / count as f64;
        let coefficients = (0..count)
            .map(|panel| {
                let start = lower + width * panel as f64;
                powers(Series::fit(start, start + width, TERMS, function).coefficients())
            })
            .collect();
        let per_length = if width > 0.0 { 1.0 / width } else { 0.0 };
        Self { lower, per_length, last: (count - 1) as f64, coefficients }
    }

    /// The value at `x`; outside the interval the outermost polynomial goes on.
    #[must_use]
    #[inline]
    pub fn value(&self, x: f64) -> f64 {
        let place = (x - self.lower) * self.per_length;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped to the panels
        let panel = place.clamp(0.0, self.last) as u32;
        let t = 2.0 * (place - f64::from(panel)) - 1.0;
        let [c0, c1, c2, c3, c4, c5, c6, c7, c8, c9] = &self.coefficients[panel as usize];
        // Estrin's order: short chains of dependent operations.
        let (t2, t4) = (t * t, (t * t) * (t * t));
        let low = (c0 + c1 * t) + (c2 + c3 * t) * t2;
        let high = (c4 + c5 * t) + (c6 + c7 * t) * t2;
        low + high * t4 + (c8 + c9 * t) * (t4 * t4)
    }
}

/// Σ c_k T_k(t) in powers of t.
pub(super) fn powers<const N: usize>(chebyshev: &[f64]) -> [f64; N] {
    let mut sum = [0.0; N];
    let (mut current, mut next) = ([0.0; N], [0.0; N]);
    (current[0], next[1]) = (1.0, 1.0);
    for coefficient in chebyshev {
        for (slot, power) in sum.iter_mut().zip(&current) {
            *slot += coefficient * power;
        }
        let mut after = [0.0; N];
        for k in 0..N {
            after[k] = if k > 0 { 2.0 * next[k - 1] } else { 0.0 } - current[k];
        }
        (current, next) = (next, after);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_function_is_followed_to_the_wanted_accuracy() {
        let function = |x: f64| 1.0 / (1.0 + 25.0 * x * x);
        let panels = Panels::fit(-1.0, 2.0, 1e-14, function);
        for i in 0..=3000 {
            let x = -1.0 + f64::from(i) * 1e-3;
            assert!((panels.value(x) - function(x)).abs() < 3e-14, "{x}");
        }
        assert!(Panels::fit(0.0, 1.0, 1e-14, f64::sqrt).coefficients.len() == MOST_PANELS);
        assert!((Panels::fit(1.0, 1.0, 1e-14, |_| 7.0).value(1.0) - 7.0).abs() < 1e-14);
    }
}
