//! What local searches share: what they are asked, where they start and when they stop.
//!
//! Lengths are shares of each variable's range. Must not know: how any of them searches.

use super::random::uniform;
use super::{Foreseen, points_held};
use declare::Words;
use declare::error::Diagnostic;
use declare::seed::Seed;

/// A search from one point until it has converged by its own measure; what then becomes of it, `restarts.rs` says.
pub(super) trait Search: Send {
    /// As [`super::Strategy::batch`].
    fn batch(&self) -> &[Vec<f64>];

    /// As [`super::Strategy::learn`].
    ///
    /// # Errors
    /// When the batch has not as many values as it must have.
    fn learn(&mut self, values: &[f64]) -> Result<(), String>;

    fn converged(&self) -> bool;

    /// The lowest point and its value.
    fn best(&self) -> (&[f64], f64);

    /// Begins anew at a point, with the first steps of the study; `value` is the function's there, if it is known, and
    /// `down` a direction in which it falls.
    fn begin(&mut self, at: Vec<f64>, value: Option<f64>, down: Option<Vec<f64>>);
}

/// Where a local search starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Start {
    /// the middle of every range
    Centre,
    /// a random point, from the seed
    Random,
}

impl Start {
    /// The point of the unit cube.
    pub(super) fn point(self, dimension: usize, seed: Seed) -> Vec<f64> {
        let mut generator = seed.generator(0);
        match self {
            Self::Centre => vec![0.5; dimension],
            Self::Random => (0..dimension).map(|_| uniform(&mut generator)).collect(),
        }
    }
}

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// The extent at which it has converged, in the maximum norm.
    pub tolerance: f64,
    pub restarts: usize,
    pub evaluations: usize,
}

/// What a local search will ask for; `minimum` evaluations are needed for `what`.
///
/// # Errors
/// With too few evaluations to begin.
pub(super) fn foresee(
    evaluations: usize,
    dimension: usize,
    (minimum, what): (usize, &str),
) -> Result<Foreseen, Diagnostic> {
    if evaluations < minimum {
        let message = format!("{evaluations} evaluations are too few for {what} {dimension} variables");
        return Err(Diagnostic::new(message).help(format!("give at least {minimum}")));
    }
    // Simplex or directions, and the gradients of all looks at a kink.
    let memory = points_held(MOST_HELD * (dimension + 1), dimension);
    Ok(Foreseen { evaluations, batches: evaluations, exact: false, memory })
}

/// Points that a local search keeps for each variable, at most.
const MOST_HELD: usize = 64;

/// Onto the range.
pub(super) fn clip(coordinate: f64) -> f64 {
    coordinate.clamp(0.0, 1.0)
}

/// The stretch of a line on which at least one variable is off its bounds.
pub(super) fn ends(at: &[f64], along: &[f64]) -> (f64, f64) {
    let (mut minimum, mut maximum) = (0.0_f64, 0.0_f64);
    for (at, along) in at.iter().zip(along) {
        if *along != 0.0 {
            let (zero, one) = (-at / along, (1.0 - at) / along);
            minimum = minimum.min(zero.min(one));
            maximum = maximum.max(zero.max(one));
        }
    }
    (minimum, maximum)
}

/// A variable that has met a bound stays there while the others go on.
pub(super) fn moved(at: &[f64], along: &[f64], place: f64) -> Vec<f64> {
    at.iter().zip(along).map(|(at, along)| clip(at + place * along)).collect()
}
