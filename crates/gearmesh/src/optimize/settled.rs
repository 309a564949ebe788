//! When a search may stop, whatever its method: nothing more than a stated share was gained over a stated number of
//! evaluations.
//!
//! If none of n independent trials succeeds, the chance of success of each is at most 3/n, with 95 % confidence (the rule of
//! three: Hanley and Lippman-Hand, JAMA 249 (1983) 1743; from (1 − p)ⁿ = 0.05). So 300 evaluations without a gain of more
//! than 0.1 % say that no more than one in a hundred further ones of the kind would bring such a gain. Evaluations of a
//! search are not independent: those of a generation share their parents. The rule says when to stop, not that a minimum is
//! global. Must not know: which method runs.

/// When nothing more is expected of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// The share of the best value that counts as a gain.
    pub improvement: f64,
    /// Evaluations without such a gain, all together.
    pub evaluations: usize,
}

/// Watches the best value of a search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watch {
    rule: Settled,
    /// The best value when the last gain was made, and after how many evaluations that was.
    gained: (f64, usize),
}

impl Watch {
    pub(super) fn new(rule: Settled) -> Self {
        Self { rule, gained: (f64::INFINITY, 0) }
    }

    /// Takes the best value after so many evaluations, +∞ while there is none; whether the search has settled.
    pub(super) fn has_settled(&mut self, best: f64, evaluations: usize) -> bool {
        let (before, _) = self.gained;
        // While there is no value at all nothing has settled: from ∞ any number is a gain.
        if best == f64::INFINITY || before - best > self.rule.improvement * before.abs().min(f64::MAX) {
            self.gained = (best, evaluations);
        }
        evaluations - self.gained.1 >= self.rule.evaluations
    }

    /// Counts from here on: the search does something else now.
    pub(super) fn begin_again(&mut self, evaluations: usize) {
        self.gained.1 = evaluations;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_count_together_and_what_is_too_small_does_not() {
        let mut watch = Watch::new(Settled { improvement: 0.01, evaluations: 30 });
        let mut told = |best: f64, evaluations: usize| watch.has_settled(best, evaluations);
        assert!(!told(f64::INFINITY, 100) && !told(f64::INFINITY, 200));
        assert!(!told(10.0, 210) && !told(9.95, 230));
        // Ten and nine tenths of a hundredth together are a gain.
        assert!(!told(9.89, 239) && !told(9.89, 268) && told(9.89, 269));
        let mut watch = Watch::new(Settled { improvement: 0.01, evaluations: 30 });
        assert!(!watch.has_settled(10.0, 10) && !watch.has_settled(9.92, 30) && watch.has_settled(9.91, 40));
    }

    #[test]
    fn values_below_and_at_zero_settle_too() {
        let mut watch = Watch::new(Settled { improvement: 0.01, evaluations: 30 });
        assert!(!watch.has_settled(-10.0, 10) && !watch.has_settled(-10.2, 30) && watch.has_settled(-10.25, 60));
        let mut watch = Watch::new(Settled { improvement: 0.01, evaluations: 30 });
        assert!(!watch.has_settled(0.0, 10) && watch.has_settled(0.0, 40));
    }
}
