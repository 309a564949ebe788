//! What local searches share: where they start, when they stop, and that they may be asked to begin anew.
//!
//! Lengths are shares of each variable's range. Must not know: how any of them searches.

use super::count;
use super::random::uniform;
use crate::base::error::Diagnostic;
use crate::base::parameter::{Choice, Field};
use crate::base::record::Record;
use crate::base::seed::Seed;

/// A method that searches from one point.
pub trait Local {
    /// Begins anew at a point of the unit cube, because the function has changed; what it has used of its evaluations
    /// stays used.
    fn start_over(&mut self, at: Vec<f64>);
}

pub const START: Field = Field::choice("start", STARTS, "where it starts").default("centre");

const STARTS: &[Choice] = &[
    Choice { name: "centre", summary: "the middle of every range" },
    Choice { name: "random", summary: "a random point, from the seed" },
];

/// From `least` upwards.
pub const fn tolerance(least: f64, summary: &'static str) -> Field {
    Field::number("tolerance", least, 0.1, summary).default("1e-8")
}

pub const fn restarts(summary: &'static str) -> Field {
    Field::integer("restarts", 0, 1000, summary).default("3")
}

pub const EVALUATIONS: Field = Field::integer("evaluations", 10, 10_000_000, "most evaluations").default("5000");

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// The extent at which it has converged, in the maximum norm.
    pub tolerance: f64,
    pub restarts: usize,
    pub evaluations: usize,
}

/// Start and limits, from [`START`], [`tolerance`], [`restarts`] and [`EVALUATIONS`]; `least` evaluations are needed for
/// `what`.
///
/// # Errors
/// With too few evaluations to begin.
pub fn read(
    record: &Record,
    dimension: usize,
    seed: Seed,
    (least, what): (usize, &str),
) -> Result<(Vec<f64>, Limits), Diagnostic> {
    let limits = Limits {
        tolerance: record.number("tolerance"),
        restarts: count(record, "restarts"),
        evaluations: count(record, "evaluations"),
    };
    if limits.evaluations < least {
        let message = format!("{} evaluations are too few for {what} {dimension} variables", limits.evaluations);
        return Err(Diagnostic::new(message).at(record.place_of("evaluations")).help(format!("give at least {least}")));
    }
    let mut generator = seed.generator(0);
    let start = match record.choice("start") {
        "random" => (0..dimension).map(|_| uniform(&mut generator)).collect(),
        _ => vec![0.5; dimension],
    };
    Ok((start, limits))
}

/// Onto the range.
pub fn clip(coordinate: f64) -> f64 {
    coordinate.clamp(0.0, 1.0)
}
