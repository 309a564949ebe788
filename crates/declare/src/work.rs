//! Work that was done, counted: what shows, and lets a test hold, that nothing is computed that is not needed.
//!
//! Counts follow from configuration and inputs alone, so they are the same with any number of threads. What a unit costs
//! is known only roughly, as a ratio to the others. Must not know: what is counted, who counts.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Something that is counted.
#[derive(Debug)]
pub struct Counter {
    /// As manifests and pages write it; no two counters share one.
    pub name: &'static str,
    /// Seconds that a unit takes on one thread of a quiet machine, as a benchmark has it.
    pub seconds: f64,
    /// Whether two counts are added; otherwise the larger one counts.
    pub adds: bool,
}

impl PartialEq for Counter {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// Counts, by counter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Work(Vec<(&'static Counter, u64)>);

impl Work {
    pub const NONE: Self = Self(Vec::new());

    #[must_use]
    pub fn of(counter: &'static Counter, count: usize) -> Self {
        Self::NONE.with(counter, count)
    }

    /// The same with another count of one kind.
    #[must_use]
    pub fn with(mut self, counter: &'static Counter, count: usize) -> Self {
        self.0.retain(|(other, _)| *other != counter);
        self.count_in(counter, count as u64);
        self
    }

    /// In the order of names, without those that are 0: so that equal counts are equal.
    fn count_in(&mut self, counter: &'static Counter, count: u64) {
        if count == 0 {
            return;
        }
        match self.0.binary_search_by(|(other, _)| other.name.cmp(counter.name)) {
            Ok(at) if counter.adds => self.0[at].1 += count,
            Ok(at) => self.0[at].1 = self.0[at].1.max(count),
            Err(at) => self.0.insert(at, (counter, count)),
        }
    }

    pub fn add(&mut self, other: &Self) {
        other.0.iter().for_each(|(counter, count)| self.count_in(counter, *count));
    }

    #[must_use]
    pub fn count(&self, counter: &Counter) -> u64 {
        self.0.iter().find(|(other, _)| *other == counter).map_or(0, |(_, count)| *count)
    }

    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        self.add(other);
        self
    }

    /// About how many seconds it takes on one thread of a quiet machine.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.0.iter().map(|(counter, count)| counter.seconds * *count as f64).sum()
    }

    /// By name, without those that are 0.
    #[must_use]
    pub fn named(&self) -> BTreeMap<String, u64> {
        self.0.iter().map(|(counter, count)| (counter.name.to_owned(), *count)).collect()
    }

    /// From names; those that are not among the counters are left out.
    #[must_use]
    pub fn from_named(counts: &BTreeMap<String, u64>, counters: &[&'static Counter]) -> Self {
        let mut work = Self::NONE;
        for counter in counters {
            work.count_in(counter, counts.get(counter.name).copied().unwrap_or(0));
        }
        work
    }
}

/// Totals that several threads add to.
#[derive(Debug, Default)]
pub struct Tally(Mutex<Work>);

impl Tally {
    pub fn add(&self, work: &Work) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).add(work);
    }

    #[must_use]
    pub fn total(&self) -> Work {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    static SOLVES: Counter = Counter { name: "solves", seconds: 2e-3, adds: true };
    static SLICES: Counter = Counter { name: "slices", seconds: 0.0, adds: false };

    #[test]
    fn counts_are_added_or_the_larger_one_counts() {
        let tally = Tally::default();
        tally.add(&Work::of(&SOLVES, 3).with(&SLICES, 5));
        tally.add(&Work::of(&SLICES, 2).with(&SOLVES, 4));
        let total = tally.total();
        assert_eq!([total.count(&SOLVES), total.count(&SLICES)], [7, 5]);
        assert_eq!(total, Work::of(&SLICES, 5).with(&SOLVES, 9).with(&SOLVES, 7));
        assert!((total.seconds() - 14e-3).abs() < 1e-15);
        let named = total.named();
        assert_eq!(named, BTreeMap::from([("slices".to_owned(), 5), ("solves".to_owned(), 7)]));
        assert_eq!(Work::from_named(&named, &[&SOLVES]), Work::of(&SOLVES, 7));
        assert_eq!(Work::of(&SOLVES, 0), Work::NONE);
    }
}
