//! A running search: hands out batches of points, takes their values, keeps the best point and the history.
//!
//! An objective may be NaN or +∞ where a point is inadmissible: such a point ranks behind every number and is never the
//! best. −∞ is refused: nothing could be better, so it is a mistake of the objective. Must not know: which method runs.

use std::fmt;

use super::Strategy;
use super::bounds::Bounds;
use crate::base::error::Failure;

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// All generations were done.
    Generations,
    /// The method's own criterion was met.
    Converged,
    /// The next step would have taken more evaluations than allowed.
    Evaluations,
    /// All points of a sample were evaluated.
    Complete,
}

impl fmt::Display for Reason {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Generations => "all generations done",
            Self::Converged => "converged",
            Self::Evaluations => "evaluations used up",
            Self::Complete => "all points evaluated",
        })
    }
}

/// A point of the box and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    pub point: Vec<f64>,
    pub value: f64,
}

/// What one batch brought. A value is +∞ when no point it is about was admissible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Generation {
    /// Lowest value in the batch.
    pub best: f64,
    /// Lowest value so far.
    pub best_so_far: f64,
    /// Mean over the batch's admissible points.
    pub mean: f64,
    /// Evaluations so far.
    pub evaluations: usize,
}

/// A method at work on a box.
pub struct Optimizer {
    strategy: Box<dyn Strategy>,
    bounds: Bounds,
    batch: Vec<Vec<f64>>,
    best: Option<Candidate>,
    history: Vec<Generation>,
    evaluations: usize,
}

impl Optimizer {
    /// `strategy` was built for as many variables as `bounds` has.
    #[must_use]
    pub fn new(strategy: Box<dyn Strategy>, bounds: Bounds) -> Self {
        let mut optimizer =
            Self { strategy, bounds, batch: Vec::new(), best: None, history: Vec::new(), evaluations: 0 };
        optimizer.take_batch();
        optimizer
    }

    fn take_batch(&mut self) {
        self.batch = match self.strategy.finished() {
            None => self.strategy.batch().iter().map(|unit| self.bounds.point(unit)).collect(),
            Some(_) => Vec::new(),
        };
    }

    /// The points to evaluate, the same until their values are told; empty once the search has ended. Equal points are
    /// equal bit for bit, so the caller may keep the values of those it has met.
    #[must_use]
    pub fn ask(&self) -> &[Vec<f64>] {
        &self.batch
    }

    /// The values of the points asked for, in their order.
    ///
    /// # Errors
    /// When their number is wrong, one is −∞, or the method cannot work with one of them.
    pub fn tell(&mut self, values: &[f64]) -> Result<(), Failure> {
        if self.batch.is_empty() {
            return Err(Failure::new("the search has ended and takes no more values"));
        }
        if values.len() != self.batch.len() {
            return Err(Failure::new(format!("{} values were told for {} points", values.len(), self.batch.len())));
        }
        if let Some(at) = values.iter().position(|value| *value == f64::NEG_INFINITY) {
            return Err(Failure::new(format!("the objective is minus infinity at {:?}", self.batch[at])));
        }
        let values: Vec<f64> = values.iter().map(|value| if value.is_nan() { f64::INFINITY } else { *value }).collect();
        self.strategy.learn(&values).map_err(Failure::new)?;
        self.note(&values);
        self.take_batch();
        Ok(())
    }

    fn note(&mut self, values: &[f64]) {
        self.evaluations += values.len();
        for (point, &value) in self.batch.iter().zip(values) {
            if value < self.best_value() {
                self.best = Some(Candidate { point: point.clone(), value });
            }
        }
        let (sum, admissible) = values
            .iter()
            .filter(|value| value.is_finite())
            .fold((0.0, 0_usize), |(sum, admissible), value| (sum + value, admissible + 1));
        self.history.push(Generation {
            best: values.iter().copied().fold(f64::INFINITY, f64::min),
            best_so_far: self.best_value(),
            mean: if admissible == 0 { f64::INFINITY } else { sum / admissible as f64 },
            evaluations: self.evaluations,
        });
    }

    fn best_value(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |best| best.value)
    }

    #[must_use]
    pub fn finished(&self) -> Option<Reason> {
        self.strategy.finished()
    }

    /// The first point with the lowest value; `None` while no admissible point was met.
    #[must_use]
    pub fn best(&self) -> Option<&Candidate> {
        self.best.as_ref()
    }

    /// One row per batch.
    #[must_use]
    pub fn history(&self) -> &[Generation] {
        &self.history
    }

    #[must_use]
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// The most evaluations the search may take.
    #[must_use]
    pub fn budget(&self) -> usize {
        self.strategy.budget()
    }

    #[must_use]
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// Asks and tells until the search has ended. `evaluate` may use threads, and may end the search with an error.
    ///
    /// # Errors
    /// Those of `evaluate`, and of [`Optimizer::tell`].
    pub fn run<E: From<Failure>>(
        &mut self,
        mut evaluate: impl FnMut(&[Vec<f64>]) -> Result<Vec<f64>, E>,
    ) -> Result<Reason, E> {
        loop {
            if let Some(reason) = self.finished() {
                return Ok(reason);
            }
            let values = evaluate(&self.batch)?;
            self.tell(&values)?;
        }
    }
}
