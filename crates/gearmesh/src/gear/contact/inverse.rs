//! The load per width at a penetration, from what is known at another one nearby.
//!
//! Newton's method on the law itself, which has the penetration at a load. The slices of a face, and the steps of a search for
//! an equilibrium, ask one law again and again: each begins where the one before has ended. Must not know: which law it is.

use crate::numeric::logarithm::Known;

/// The last step, over the load: what it leaves is of third order in it, and of second where it is only about known how the
/// law bends.
const CLOSE: [f64; 2] = [1e-5, 1e-8];
/// Its most steps; one or two are taken.
const STEPS: usize = 12;
/// Penetrations whose ratio is between these are near: the tangent leads from one to the other.
const NEAR: [f64; 2] = [0.5, 2.0];
/// A step takes no more than nine tenths of a load away.
const LEAST: f64 = 0.1;

/// A place on a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inverse {
    /// > 0 \[m\].
    pub penetration: f64,
    /// Per width \[N/m\].
    pub load: Known,
    /// d load/d penetration.
    pub slope: f64,
}

impl Inverse {
    /// The place at another penetration > 0. `law`: the penetration at a load per width, its slope and the slope of that, and
    /// whether it is only about that. None where Newton's method does not settle.
    #[must_use]
    #[inline]
    pub fn next(&self, penetration: f64, law: impl Fn(Known) -> ([f64; 3], bool)) -> Option<Self> {
        let ratio = penetration / self.penetration;
        let tangent = self.load.number + self.slope * (penetration - self.penetration);
        let is_near = ratio > NEAR[0] && ratio < NEAR[1] && tangent > 0.0;
        let mut load = self.load.next(if is_near { tangent } else { ratio * self.load.number });
        for _ in 0..STEPS {
            let ([here, rise, bend], is_rough) = law(load);
            let newton = (penetration - here) / rise;
            // Again with what the law bends along the way, where that is little.
            let close = newton.abs() <= CLOSE[usize::from(is_rough)] * load.number;
            let step = if close { newton - 0.5 * bend / rise * newton * newton } else { newton };
            let next = load.next((load.number + step).max(LEAST * load.number));
            if close {
                return Some(Self { penetration, load: next, slope: 1.0 / (rise + bend * step) });
            }
            load = next;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::contact::plain::PlainLaw;

    /// Tier: second method; the law's own inverse, from penetrations near and far.
    #[test]
    fn a_place_is_found_from_any_other_one() {
        let (rate, plain) = (1e-12, PlainLaw { total: 6e-11, rest: 1e-18, last: 1e8 });
        let rates = [rate, libm::log(rate)];
        let at = |penetration: f64| {
            let (load, slope) = plain.load(rates, penetration).expect("it holds there");
            Inverse { penetration, load: Known::new(load), slope }
        };
        for from in [1e-9, 1e-6, 4e-6, 1e-4] {
            for ratio in [1e-12, 1e-3, 0.3, 0.9, 1.0, 1.0 + 1e-9, 1.4, 7.0, 1e3] {
                let exact = at(from * ratio);
                for is_rough in [false, true] {
                    let law = |known: Known| (plain.rates_at(rate, known.number, known.log), is_rough);
                    let found = at(from).next(from * ratio, law).expect("it settles");
                    assert!((found.load.number / exact.load.number - 1.0).abs() < 5e-15, "{from} {ratio}");
                    assert!((found.load.log - exact.load.log).abs() < 2e-14, "{from} {ratio}: logarithm");
                    assert!((found.slope / exact.slope - 1.0).abs() < 1e-11, "{from} {ratio}: slope");
                }
            }
        }
        assert!(at(1e-6).next(2e-6, |known| ([known.number, -1.0, 0.0], false)).is_none());
    }
}
