//! The root of a continuous function inside a bracket: Brent's zeroin.
//!
//! Source: Brent, Algorithms for Minimization without Derivatives, chapter 4. Must not know: what crosses zero.

/// The zero of `function` between `a` and `b`, to the last bits of the argument; `None` unless the signs at the ends
/// differ (a zero at an end counts).
pub fn bracketed(a: f64, b: f64, mut function: impl FnMut(f64) -> f64) -> Option<f64> {
    let (at_a, at_b) = (function(a), function(b));
    if !at_a.is_finite() || !at_b.is_finite() || (at_a > 0.0 && at_b > 0.0) || (at_a < 0.0 && at_b < 0.0) {
        return None;
    }
    if at_a == 0.0 {
        return Some(a);
    }
    Some(crossing(function, (a, at_a), (b, at_b), 0.0))
}

/// Where `function` is zero between `a` and `b`, at which it has the values `value_a` and `value_b` of unlike signs; to
/// within `tolerance` in the argument.
#[allow(clippy::float_cmp)] // asks whether two points are the same one, not whether numbers agree
pub fn crossing(
    mut function: impl FnMut(f64) -> f64,
    (mut a, mut value_a): (f64, f64),
    (mut b, mut value_b): (f64, f64),
    tolerance: f64,
) -> f64 {
    let (mut c, mut value_c) = (a, value_a);
    let (mut step, mut previous) = (b - a, b - a);
    for _ in 0..200 {
        if (value_b > 0.0) == (value_c > 0.0) {
            (c, value_c) = (a, value_a);
            (step, previous) = (b - a, b - a);
        }
        if value_c.abs() < value_b.abs() {
            (a, b, c) = (b, c, b);
            (value_a, value_b, value_c) = (value_b, value_c, value_b);
        }
        let near = 2.0 * f64::EPSILON * b.abs() + 0.5 * tolerance;
        let half = 0.5 * (c - b);
        if half.abs() <= near || value_b == 0.0 {
            break;
        }
        if previous.abs() < near || value_a.abs() <= value_b.abs() {
            (step, previous) = (half, half);
        } else {
            let (mut p, mut q) = interpolated(value_a, value_b, value_c, a == c, (half, a, b));
            if p > 0.0 {
                q = -q;
            } else {
                p = -p;
            }
            if 2.0 * p < (3.0 * half * q - (near * q).abs()).min((previous * q).abs()) {
                (step, previous) = (p / q, step);
            } else {
                (step, previous) = (half, half);
            }
        }
        (a, value_a) = (b, value_b);
        b += if step.abs() > near { step } else { near.copysign(half) };
        value_b = function(b);
    }
    b
}

/// Numerator and denominator of the step: secant with two points, inverse quadratic with three.
fn interpolated(fa: f64, fb: f64, fc: f64, two_points: bool, (half, a, b): (f64, f64, f64)) -> (f64, f64) {
    let s = fb / fa;
    if two_points {
        return (2.0 * half * s, 1.0 - s);
    }
    let (q, r) = (fa / fc, fb / fc);
    (s * (2.0 * half * q * (q - r) - (b - a) * (r - 1.0)), (q - 1.0) * (r - 1.0) * (s - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_smooth_and_kinked_functions() {
        let mut calls = 0;
        let root = crossing(
            |x| {
                calls += 1;
                libm::cos(x) - x
            },
            (0.0, 1.0),
            (1.0, libm::cos(1.0) - 1.0),
            1e-14,
        );
        assert!((root - 0.739_085_133_215_160_6).abs() < 1e-14);
        assert!(calls < 12, "{calls} calls");
        // Slopes that differ a millionfold on the two sides, and a jump.
        let kink = |x: f64| if x < 0.3 { x - 0.3 } else { 1e6 * (x - 0.3) };
        assert!((crossing(kink, (0.0, kink(0.0)), (1.0, kink(1.0)), 1e-13) - 0.3).abs() < 1e-13);
        let jump = |x: f64| if x < 0.7 { -1.0 } else { 1e-9 };
        assert!((crossing(jump, (0.0, -1.0), (1.0, 1e-9), 1e-12) - 0.7).abs() < 1e-12);
    }

    #[test]
    fn known_zeros_are_found_to_the_last_bits() {
        let mut calls = 0;
        let zero = bracketed(0.0, 4.0, |x| {
            calls += 1;
            x * x - 2.0
        });
        assert!((zero.unwrap() - 2f64.sqrt()).abs() <= 2.0 * f64::EPSILON);
        assert!(calls < 20, "{calls} evaluations");
        let zero = bracketed(3.0, 0.0, |x| libm::cos(x) - x).unwrap();
        assert!((zero - 0.739_085_133_215_160_6).abs() <= 2.0 * f64::EPSILON);
        // A triple zero, where interpolation is of no help.
        assert!(bracketed(-1.0, 1.5, |x| x * x * x).unwrap().abs() < 1e-15);
    }

    #[test]
    fn ends_count_and_a_missing_change_of_sign_is_told() {
        assert!(bracketed(1.0, 2.0, |x| x - 1.0).unwrap() <= 1.0);
        assert!(bracketed(1.0, 2.0, |x| 2.0 - x).unwrap() >= 2.0);
        assert_eq!(bracketed(1.0, 2.0, |x| x), None);
        assert_eq!(bracketed(1.0, 2.0, |_| f64::NAN), None);
    }
}
