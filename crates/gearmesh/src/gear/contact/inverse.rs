//! The load per width at a penetration, from what is known at another one nearby.
//!
//! Newton's method on the law itself, which has the penetration at a load. The slices of a face, and the steps of a search for
//! an equilibrium, ask one law again and again: each begins where the one before has ended. Must not know: which law it is.

use crate::numeric::logarithm::Known;

/// The last step, over the load: what it leaves is of third order in it, and a little of second where how the law bends
/// follows from two places.
const CLOSE: [f64; 2] = [1e-5, 1e-6];
/// Loads as far apart as this share tell how a law bends at one of them, but for 1e-8 of it.
const APART: f64 = 1e-3;
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
    pub load: f64,
    /// d load/d penetration.
    pub slope: f64,
    /// d² penetration/d load²; 0 where it is not known.
    pub bend: f64,
    /// A load nearby, from which logarithms are found: always of one number, so that roundings do not add up.
    pub known: Known,
}

impl Inverse {
    /// The place of a load with this slope.
    #[must_use]
    pub fn new(penetration: f64, (load, slope): (f64, f64)) -> Self {
        Self { penetration, load, slope, bend: 0.0, known: Known::new(load) }
    }

    /// The place at another penetration > 0. `law`: the penetration at a load per width, its slope and the slope of that, and
    /// whether it is only about that. None where Newton's method does not settle.
    #[must_use]
    #[inline]
    pub fn next(&self, penetration: f64, law: impl Fn(Known) -> ([f64; 3], bool)) -> Option<Self> {
        let ratio = penetration / self.penetration;
        let along = self.slope * (penetration - self.penetration);
        // The tangent, and what the law bends from it.
        let tangent = self.load + along * (1.0 - 0.5 * self.bend * self.slope * along);
        let is_near = ratio > NEAR[0] && ratio < NEAR[1] && tangent > 0.0;
        let (mut load, mut known) = (if is_near { tangent } else { ratio * self.load }, self.known);
        let (mut before, mut apart) = ([self.load, self.penetration, 1.0 / self.slope], self.bend);
        for _ in 0..STEPS {
            let here = known.near(load).unwrap_or_else(|| {
                known = Known::new(load);
                known
            });
            let ([at, rise, about], is_rough) = law(here);
            let width = load - before[0];
            if width.abs() > APART * load {
                // Of the cubic with the values and slopes of both places.
                apart = (2.0 * before[2] + 4.0 * rise - 6.0 * (at - before[1]) / width) / width;
                before = [load, at, rise];
            }
            let bend = if is_rough { apart } else { about };
            let newton = (penetration - at) / rise;
            // Again with what the law bends along the way, where that is little.
            if newton.abs() <= CLOSE[usize::from(is_rough)] * load {
                let step = newton - 0.5 * bend / rise * newton * newton;
                return Some(Self { penetration, load: load + step, slope: 1.0 / (rise + bend * step), bend, known });
            }
            load = (load + newton).max(LEAST * load);
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
        let (rate, plain) = (1e-12, PlainLaw { total: 6e-11, rest: 1e-22, last: 1e12 });
        let rates = [rate, libm::log(rate)];
        let at = |penetration: f64| Inverse::new(penetration, plain.load(rates, penetration).expect("it holds there"));
        for from in [1e-9, 1e-6, 4e-6, 1e-4] {
            for ratio in [1e-12, 1e-3, 0.3, 0.9, 1.0, 1.0 + 1e-9, 1.4, 7.0, 1e3] {
                let exact = at(from * ratio);
                for is_rough in [false, true] {
                    let law = |known: Known| (plain.rates_at(rate, known.number, known.log), is_rough);
                    let found = at(from).next(from * ratio, law).expect("it settles");
                    assert!((found.load / exact.load - 1.0).abs() < 5e-14, "{from} {ratio}");
                    let [back, ..] = plain.rates_at(rate, found.load, libm::log(found.load));
                    assert!((back / (from * ratio) - 1.0).abs() < 2e-15, "{from} {ratio}: {back}");
                    assert!((found.known.log - libm::log(found.known.number)).abs() < 1e-18, "{from} {ratio}");
                    assert!((found.slope / exact.slope - 1.0).abs() < 1e-11, "{from} {ratio}: slope");
                }
            }
        }
        assert!(at(1e-6).next(2e-6, |known| ([known.number, -1.0, 0.0], false)).is_none());
    }
}
