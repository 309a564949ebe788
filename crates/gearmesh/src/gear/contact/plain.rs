//! The law of a pair whose tips are far, with everything added up that no load changes.
//!
//! Of flanks and teeth in series, and of what far tips add, w = p (T − β ln p + R p) is left up to a load per width. Must not
//! know: what lies beyond.

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
}
