//! The maximum of a function inside an interval that is known to hold one.
//!
//! Brent's minimisation (golden section with parabolic steps) from a good first guess. Source: Brent, Algorithms for
//! Minimization without Derivatives, chapter 5. Must not know: what is sought.

/// 2 − golden ratio.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Argument and value of the maximum of `function` in `lower..=upper`; the argument to within `tolerance`, so that the
/// error of the value is of second order in it.
#[allow(clippy::float_cmp)] // asks whether two points are the same one, not whether numbers agree
pub fn maximum(mut function: impl FnMut(f64) -> f64, lower: f64, guess: f64, upper: f64, tolerance: f64) -> (f64, f64) {
    let (mut a, mut b) = (lower, upper);
    let mut best = (guess, function(guess));
    let (mut second, mut third) = (best, best);
    let (mut step, mut previous) = (0.0_f64, 0.0_f64);
    for round in 0..100 {
        let middle = 0.5 * (a + b);
        let near = tolerance + 1e-15 * best.0.abs();
        if (best.0 - middle).abs() <= 2.0 * near - 0.5 * (b - a) {
            break;
        }
        let mut golden = true;
        if previous.abs() > near {
            let r = (best.0 - second.0) * (best.1 - third.1);
            let q = (best.0 - third.0) * (best.1 - second.1);
            let (mut p, mut q) = ((best.0 - third.0) * q - (best.0 - second.0) * r, 2.0 * (q - r));
            if q > 0.0 {
                p = -p;
            }
            q = q.abs();
            let before = previous;
            previous = step;
            if p.abs() < (0.5 * q * before).abs() && p > q * (a - best.0) && p < q * (b - best.0) {
                step = p / q;
                let at = best.0 + step;
                if at - a < 2.0 * near || b - at < 2.0 * near {
                    step = near.copysign(middle - best.0);
                }
                golden = false;
            }
        }
        if golden {
            previous = if best.0 < middle { b - best.0 } else { a - best.0 };
            // The guess comes from an interpolant: the answer is near it, not a golden cut away.
            step = if round < 2 { 0.02 * previous } else { GOLDEN * previous };
        }
        let at = best.0 + if step.abs() >= near { step } else { near.copysign(step) };
        let value = function(at);
        if value >= best.1 {
            if at < best.0 {
                b = best.0;
            } else {
                a = best.0;
            }
            (third, second, best) = (second, best, (at, value));
        } else {
            if at < best.0 {
                a = at;
            } else {
                b = at;
            }
            if value >= second.1 || second.0 == best.0 {
                (third, second) = (second, (at, value));
            } else if value >= third.1 || third.0 == best.0 || third.0 == second.0 {
                third = (at, value);
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_maxima_take_few_calls_and_kinks_are_found() {
        let mut calls = 0;
        let count = |x: f64| {
            calls += 1;
            libm::sin(x)
        };
        let (at, value) = maximum(count, 1.0, 1.5, 2.0, 1e-5);
        assert!((at - std::f64::consts::FRAC_PI_2).abs() < 2e-5 && (1.0 - value).abs() < 1e-10);
        assert!(calls <= 8, "{calls} calls");
        let (at, _) = maximum(|x| -(x - 0.3).abs(), 0.0, 0.9, 1.0, 1e-9);
        assert!((at - 0.3).abs() < 1e-8);
        // At an end.
        let (at, _) = maximum(|x| x, 0.0, 0.5, 1.0, 1e-9);
        assert!(at > 1.0 - 1e-7);
    }
}
