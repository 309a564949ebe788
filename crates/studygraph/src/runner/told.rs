//! What is told of a stage by the parts that are known: time, work, warnings.
//!
//! Must not know: how parts are computed, where it is shown.

use super::board::Progress;
use crate::store::entry::OfRun;
use crate::warning::{self, Warning};
use declare::work::{Counter, Work};

impl Progress {
    /// Seconds of computing, whenever that was.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.of_runs().map(|of_run| of_run.seconds).sum()
    }

    /// The work that was counted, of all parts that are known.
    pub fn work(&self, counters: &[&'static Counter]) -> Work {
        self.of_runs().fold(Work::NONE, |work, of_run| work.and(&Work::from_named(&of_run.work, counters)))
    }

    /// What its parts say of their results, as far as it is wanted.
    pub fn warnings(&self, wanted: fn(&Warning) -> bool) -> Vec<String> {
        warning::sentences(self.of_runs().flat_map(|run| &run.warnings).filter(|one| wanted(one)).cloned())
    }

    /// What is told of the parts that are known.
    pub fn of_runs(&self) -> impl Iterator<Item = &OfRun> {
        self.known.iter().filter_map(|known| Some(&known.entry.as_ref()?.of_run))
    }
}
