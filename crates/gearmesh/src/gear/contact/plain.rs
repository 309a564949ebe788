//! The law of a pair whose tips are far, with everything added up that no load changes.
//!
//! Of flanks and teeth in series, and of what far tips add, w = p (T − β ln p + R p) is left up to a load per width. Must not
//! know: what lies beyond.

pub mod shared;

use crate::numeric::lambert::larger_root;
use crate::numeric::logarithm::Known;

/// T and R at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlainLaw {
    /// T \[1/Pa\].
    pub total: f64,
    /// R, per load.
    pub rest: f64,
    /// The load per width up to which there is no more to it; below 0 where that is not known.
    pub last: f64,
}

/// The same at several places, side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlainLaws<const M: usize> {
    /// T of each \[1/Pa\].
    pub totals: [f64; M],
    /// R of each, per load.
    pub rests: [f64; M],
    /// The load per width up to which each holds; below 0 where that is not known.
    pub lasts: [f64; M],
}

impl<const M: usize> PlainLaws<M> {
    /// Of places of which nothing is known.
    pub const NONE: Self = Self { totals: [0.0; M], rests: [0.0; M], lasts: [-1.0; M] };

    /// That of one of the places.
    #[must_use]
    #[inline]
    pub fn at(&self, m: usize) -> PlainLaw {
        PlainLaw { total: self.totals[m], rest: self.rests[m], last: self.lasts[m] }
    }
}

impl From<PlainLaw> for PlainLaws<1> {
    #[inline]
    fn from(law: PlainLaw) -> Self {
        Self { totals: [law.total], rests: [law.rest], lasts: [law.last] }
    }
}

impl PlainLaw {
    /// Of a place of which nothing is known.
    pub const NONE: Self = Self { total: 0.0, rest: 0.0, last: -1.0 };

    /// Whether it holds at a load per width.
    #[must_use]
    #[inline]
    pub fn holds(&self, load: f64) -> bool {
        load < self.last
    }

    /// The penetration at a load per width p > 0 with the logarithm `log`, dw/dp and d²w/dp²; `rate`: β.
    #[must_use]
    #[inline]
    pub fn rates_at(&self, rate: f64, load: f64, log: f64) -> [f64; 3] {
        let rest = self.rest * load;
        let total = (self.total - rate * log) + rest;
        [load * total, (total - rate) + rest, (2.0 * rest - rate) / load]
    }

    /// The same as if it went on beyond its last load, but for what tips add then; none where nothing is known.
    #[must_use]
    #[inline]
    pub fn about(&self, rate: f64, load: f64, log: f64) -> Option<[f64; 3]> {
        let total = (self.total - rate * log) + self.rest * load.min(self.last);
        (self.last > 0.0 && total > 2.0 * rate).then(|| [load * total, total - rate, -rate / load])
    }

    /// Load per width p and dp/dw at the penetration w > 0, if it holds there; `rate`: β, and ln β.
    #[must_use]
    pub fn load(&self, [rate, log_rate]: [f64; 2], penetration: f64) -> Option<(f64, f64)> {
        // w = p (T − β ln p) in u = w / (β p): u − ln u = T / β + ln β − ln w.
        let total = rate * larger_root(self.total / rate + log_rate - 1.0 - libm::log(penetration));
        let start = penetration / total;
        if start >= self.last {
            return None;
        }
        // What grows with the load is small: two steps of Newton's method.
        let (mut load, known) = (start, Known { number: start, log: 0.0 });
        if self.rest != 0.0 {
            for _ in 0..2 {
                let here = total - rate * known.next(load).log + self.rest * load;
                load += (penetration - load * here) / (here - rate + self.rest * load);
            }
        }
        self.holds(load).then(|| (load, 1.0 / (penetration / load - rate + self.rest * load)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::contact::flattening::Logarithmic;
    use crate::gear::fixtures::STEELS;

    /// Tier: second method; flanks and teeth in series without tips, and with a rest the law's own inverse.
    #[test]
    fn the_law_is_that_of_flanks_and_teeth_and_inverts() {
        let law = Logarithmic::half_planes(&STEELS, 7e-3, [0.75e-3; 2]);
        let series = law.in_series(5e-11);
        let plain = PlainLaw { total: 5e-11 + law.constant, rest: 0.0, last: law.last() };
        let bent = PlainLaw { rest: 1e-3 * plain.total / 1e6, last: 1e7, ..plain };
        for exponent in -20..28 {
            let load = libm::pow(10.0, f64::from(exponent) * 0.25);
            let log = libm::log(load);
            let ([penetration, slope], [w, rate, bend]) =
                (series.at_known_load(load, log).into(), plain.rates_at(law.rate, load, log));
            assert!((w / penetration - 1.0).abs() < 1e-14 && (rate / slope - 1.0).abs() < 1e-14, "{load}");
            assert_eq!(plain.about(law.rate, load, log), Some([w, rate, bend]));
            for of in [plain, bent] {
                let [w, slope, bend] = of.rates_at(law.rate, load, log);
                let (found, rate) = of.load([law.rate, law.log_rate], w).expect("it holds there");
                assert!((found / load - 1.0).abs() < 5e-14 && (rate * slope - 1.0).abs() < 1e-12, "{load}: {found}");
                let step = 1e-4 * load;
                let [low, high] =
                    [-step, step].map(|step| of.rates_at(law.rate, load + step, libm::log(load + step))[1]);
                assert!(((high - low) / (2.0 * step) / bend - 1.0).abs() < 1e-5, "{load}: bend");
            }
        }
        assert!(bent.load([law.rate, law.log_rate], 1.0).is_none() && !bent.holds(1e7));
        assert!(PlainLaw::NONE.load([law.rate, law.log_rate], 1e-9).is_none() && !PlainLaw::NONE.holds(0.0));
        assert!(PlainLaw::NONE.about(law.rate, 1.0, 0.0).is_none());
    }
}
