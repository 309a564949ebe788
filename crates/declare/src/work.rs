//! Work that was done, counted: what shows, and lets a test hold, that nothing is computed that is not needed.
//!
//! Counts follow from configuration and inputs alone, so they are the same with any number of threads. What a unit costs
//! is known only roughly, as a ratio to the others. Must not know: who counts.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};

/// What is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counter {
    /// Roll angles at which the compliance of one tooth was found, on every mesh that was tried.
    ComplianceEvaluations,
    /// Stiffness matrices of a tooth's sector that were factorised.
    MeshFactorisations,
    /// Mesh positions at which the load was shared between the pairs.
    ContactSolves,
    /// The most slices that the face of a pair was cut into; 1 where one is enough.
    Slices,
    /// Mesh positions at which the Hertzian pressure was found.
    ContactPressures,
    /// Whole outlines of teeth that were drawn or checked.
    Outlines,
}

const COUNTERS: [Counter; 6] = [
    Counter::ComplianceEvaluations,
    Counter::MeshFactorisations,
    Counter::ContactSolves,
    Counter::Slices,
    Counter::ContactPressures,
    Counter::Outlines,
];

impl Counter {
    /// Seconds that a unit takes on one thread, as `make bench` has it on a quiet machine; a slice costs as part of its
    /// solve.
    #[must_use]
    pub fn seconds(self) -> f64 {
        match self {
            Self::ComplianceEvaluations => 2e-5,
            Self::MeshFactorisations => 2e-2,
            Self::ContactSolves => 3e-7,
            Self::ContactPressures => 6e-8,
            Self::Outlines => 3e-5,
            Self::Slices => 0.0,
        }
    }

    /// As manifests and pages write it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ComplianceEvaluations => "compliance_evaluations",
            Self::MeshFactorisations => "mesh_factorisations",
            Self::ContactSolves => "contact_solves",
            Self::Slices => "slices",
            Self::ContactPressures => "contact_pressures",
            Self::Outlines => "outlines",
        }
    }

    /// Whether two counts are added; of slices the larger one counts.
    fn adds(self) -> bool {
        self != Self::Slices
    }
}

/// Counts, by counter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work([u64; COUNTERS.len()]);

impl Work {
    pub const NONE: Self = Self([0; COUNTERS.len()]);

    #[must_use]
    pub fn of(counter: Counter, count: usize) -> Self {
        Self::NONE.with(counter, count)
    }

    /// The same with another count of one kind.
    #[must_use]
    pub fn with(mut self, counter: Counter, count: usize) -> Self {
        self.0[counter as usize] = count as u64;
        self
    }

    #[must_use]
    pub fn count(&self, counter: Counter) -> u64 {
        self.0[counter as usize]
    }

    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        for (counter, (mine, theirs)) in COUNTERS.into_iter().zip(self.0.iter_mut().zip(other.0)) {
            *mine = if counter.adds() { *mine + theirs } else { theirs.max(*mine) };
        }
        self
    }

    /// About how many seconds it takes on one thread of a quiet machine.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        COUNTERS.iter().map(|counter| counter.seconds() * self.count(*counter) as f64).sum()
    }

    /// By name, without those that are 0.
    #[must_use]
    pub fn named(&self) -> BTreeMap<String, u64> {
        let counts = COUNTERS.into_iter().map(|counter| (counter.name().to_owned(), self.count(counter)));
        counts.filter(|(_, count)| *count > 0).collect()
    }

    /// From names; those that are not known are left out.
    #[must_use]
    pub fn from_named(counts: &BTreeMap<String, u64>) -> Self {
        let count = |counter: Counter| counts.get(counter.name()).copied().unwrap_or(0);
        Self(COUNTERS.map(count))
    }
}

/// Totals that several threads add to.
#[derive(Debug, Default)]
pub struct Tally([AtomicU64; COUNTERS.len()]);

impl Tally {
    pub fn add(&self, work: &Work) {
        for (counter, (total, count)) in COUNTERS.into_iter().zip(self.0.iter().zip(work.0)) {
            if counter.adds() {
                total.fetch_add(count, Ordering::Relaxed);
            } else {
                total.fetch_max(count, Ordering::Relaxed);
            }
        }
    }

    #[must_use]
    pub fn total(&self) -> Work {
        Work(std::array::from_fn(|index| self.0[index].load(Ordering::Relaxed)))
    }
}
