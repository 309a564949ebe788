//! What a run tells whoever watches it.
//!
//! Events of one stage come in order, from any thread; whoever receives them must be quick. Must not know: bars, lines,
//! terminals.

use super::fault::Fault;

/// Something happened.
#[derive(Debug)]
pub enum Event<'a> {
    /// A stage is up to date; comes for those that could not be planned because their inputs were not known.
    Hit {
        stage: &'a str,
    },
    /// `chunks` of a stage must be computed.
    Started {
        stage: &'a str,
        why: &'a str,
        chunks: usize,
    },
    /// The share of a stage that is computed; 1 when only its tables remain to be stored.
    Progressed {
        stage: &'a str,
        share: f64,
    },
    Warned {
        stage: &'a str,
        message: &'a str,
    },
    /// The warnings of the runs that computed stages whose tables are up to date, by stage.
    Recalled {
        warnings: &'a [(&'a str, &'a [String])],
    },
    /// A file of the results is about to be made and written.
    Publishing {
        file: &'a str,
    },
    Finished {
        stage: &'a str,
        seconds: f64,
    },
    Failed {
        stage: &'a str,
        fault: &'a Fault,
    },
    Skipped {
        stage: &'a str,
        why: &'a str,
    },
    /// At the end: what the run did not need, and the next one may miss.
    Warning {
        message: &'a str,
    },
}

/// Whoever watches a run.
pub trait Observer: Sync {
    fn event(&self, event: &Event<'_>);
}

/// Nobody watches.
pub struct Silent;

impl Observer for Silent {
    fn event(&self, _event: &Event<'_>) {}
}
