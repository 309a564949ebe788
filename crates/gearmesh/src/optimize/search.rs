//! A running search: hands out batches of points, takes their values, keeps the best point and the history.
//!
//! An objective may be NaN or +∞ where a point is inadmissible: such a point ranks behind every number and is never the
//! best. −∞ is refused: nothing could be better, so it is a mistake of the objective. An objective with constraints gives
//! an [`Evaluation`] per point; by what rule a method keeps them, [`super::constraints`] says. With several objectives the
//! points that no other one dominates are kept beside the best, which is that of the first objective. Must not know: which
//! method runs.

use std::fmt;

use super::Strategy;
use super::bounds::Bounds;
use super::constraints::{Evaluation, Multipliers, feasible_first};
use super::hypervolume::hypervolume;
use super::pareto::{Archive, Member};
use super::settled::{Settled, Watch};
use declare::error::Failure;

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// All generations were done.
    Generations,
    /// The method's own criterion was met.
    Converged,
    /// It found no way further down, though the slopes around say that there is one, or its restarts were used up.
    Stalled,
    /// Points beside the best one are not admissible: steps across that edge were refused.
    Edge,
    /// The next step would have taken more evaluations than allowed.
    Evaluations,
    /// All points of a sample were evaluated.
    Complete,
    /// Nothing more was gained, by the rule that was asked for.
    Settled,
}

impl Reason {
    /// What a local search that ended so has to say against its point.
    fn doubt(self) -> Option<&'static str> {
        match self {
            Self::Stalled => Some(
                "the search stalled: slopes around the design that it found say that one nearby is better, but no line leads \
                 there, or its `restarts` were used up; start it elsewhere (`start: random` and another `seed`), or take \
                 `differential_evolution`",
            ),
            Self::Edge => Some(
                "the search stopped at the edge of the valid designs: designs next to the one that it found are refused, and \
                 whether a design along the edge is better is not known; start it elsewhere (`start: random` and another `seed`), \
                 or take `differential_evolution`",
            ),
            Self::Evaluations => Some("the search has used up its `evaluations` and has not converged; give it more"),
            Self::Generations | Self::Converged | Self::Complete | Self::Settled => None,
        }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Generations => "all generations done",
            Self::Converged => "converged",
            Self::Stalled => "stalled",
            Self::Edge => "stopped at the edge of the valid designs",
            Self::Evaluations => "evaluations used up",
            Self::Complete => "all points evaluated",
            Self::Settled => "settled",
        })
    }
}

/// A point of the box and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// One value per variable, within its bounds.
    pub point: Vec<f64>,
    /// The objective there.
    pub value: f64,
    /// The sum of what is broken of the constraints; 0 where all are kept.
    pub violation: f64,
}

/// What one batch brought. A value is +∞ when no point it is about was admissible and kept the constraints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Generation {
    /// Lowest value in the batch.
    pub best: f64,
    /// Lowest value so far.
    pub best_so_far: f64,
    /// Mean over the batch's admissible points that keep the constraints.
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
    /// For a local search with constraints: what it minimises in this round, and the round's minimum.
    multipliers: Option<Multipliers>,
    lowest: Option<Lowest>,
    /// With several objectives: what no other point dominates, and beyond the worst of the first admissible batch.
    archive: Archive,
    reference: Vec<f64>,
    watch: Option<Watch>,
    has_settled: bool,
    /// How many further objectives and constraints an evaluation has; known from the first batch on.
    counts: Option<[usize; 2]>,
}

/// Of a front with more than two objectives as many points tell how far it has come: the hypervolume of all takes too long.
const TELLING: usize = 100;

/// The minimum of a round, in the unit cube.
struct Lowest {
    merit: f64,
    at: Vec<f64>,
    evaluation: Evaluation,
}

impl Optimizer {
    /// `strategy` was built for as many variables as `bounds` has.
    #[must_use]
    pub fn new(strategy: Box<dyn Strategy>, bounds: Bounds) -> Self {
        let mut optimizer = Self {
            strategy,
            bounds,
            batch: Vec::new(),
            best: None,
            history: Vec::new(),
            evaluations: 0,
            multipliers: None,
            lowest: None,
            archive: Archive::default(),
            reference: Vec::new(),
            watch: None,
            has_settled: false,
            counts: None,
        };
        optimizer.take_batch();
        optimizer
    }

    /// The same, ended as soon as nothing more is gained: of a front, of the hypervolume below the worst that the first
    /// batch had of each objective.
    #[must_use]
    pub fn until_settled(mut self, rule: Settled) -> Self {
        self.watch = Some(Watch::new(rule));
        self
    }

    fn take_batch(&mut self) {
        self.batch = match self.finished() {
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
        self.tell_constrained(values.iter().copied().map(Evaluation::from).collect())
    }

    /// Values and constraints of the points asked for, in their order.
    ///
    /// # Errors
    /// As [`Optimizer::tell`].
    pub fn tell_constrained(&mut self, mut evaluations: Vec<Evaluation>) -> Result<(), Failure> {
        if self.batch.is_empty() {
            return Err(Failure::new("the search has ended and takes no more values"));
        }
        if evaluations.len() != self.batch.len() {
            return Err(Failure::new(format!(
                "{} values were told for {} points",
                evaluations.len(),
                self.batch.len()
            )));
        }
        if let Some(at) = evaluations.iter().position(|evaluation| evaluation.value == f64::NEG_INFINITY) {
            return Err(Failure::new(format!("the objective is minus infinity at {:?}", self.batch[at])));
        }
        self.check_counts(&evaluations)?;
        for evaluation in evaluations.iter_mut().filter(|evaluation| !evaluation.admissible()) {
            *evaluation = Evaluation::from(f64::INFINITY);
        }
        let merits = self.merits(&evaluations);
        let lowest = self.lowest_with(&merits, &evaluations);
        match self.strategy.fronts() {
            Some(fronts) => fronts.learn_all(&evaluations),
            None => self.strategy.learn(&merits).map_err(Failure::new)?,
        }
        self.lowest = lowest;
        self.note(&evaluations);
        self.refer(&evaluations);
        self.next_round();
        self.settle();
        self.take_batch();
        Ok(())
    }

    /// Every point of a search that has values at all has as many objectives and constraints.
    fn check_counts(&mut self, evaluations: &[Evaluation]) -> Result<(), Failure> {
        let mut known = self.counts;
        for evaluation in evaluations.iter().filter(|evaluation| evaluation.admissible()) {
            let counts = [evaluation.further.len(), evaluation.constraints.len()];
            let [further, constraints] = *known.get_or_insert(counts);
            if counts != [further, constraints] {
                let (objectives, own) = (further + 1, counts[0] + 1);
                return Err(Failure::new(format!(
                    "a point has {own} objectives and {} constraints, and others of this search have {objectives} and {constraints}",
                    counts[1]
                )));
            }
        }
        self.counts = known;
        Ok(())
    }

    /// Whether the rule that was asked for says that nothing more is gained; then what comes last in the method begins, or
    /// the search ends.
    fn settle(&mut self) {
        let (best, evaluations) = (self.progress(), self.evaluations);
        if let Some(watch) = &mut self.watch
            && self.strategy.finished().is_none()
            && watch.has_settled(best, evaluations)
        {
            watch.begin_again(evaluations);
            self.has_settled = !self.strategy.goes_on();
        }
    }

    /// What falls as the search gets on; +∞ while nothing keeps the constraints.
    fn progress(&self) -> f64 {
        if self.watch.is_none() || self.reference.is_empty() {
            return self.history.last().map_or(f64::INFINITY, |generation| generation.best_so_far);
        }
        let count = if self.reference.len() > 2 { TELLING } else { usize::MAX };
        -hypervolume(&self.archive.objectives(count), &self.reference)
    }

    /// What the method sees: values, where there are no constraints.
    fn merits(&mut self, evaluations: &[Evaluation]) -> Vec<f64> {
        let constrained = evaluations.iter().find(|evaluation| !evaluation.constraints.is_empty());
        if let Some(first) = constrained
            && self.multipliers.is_none()
            && self.strategy.local().is_some()
        {
            self.multipliers = Some(Multipliers::new(first));
        }
        let merit = |evaluation: &Evaluation| match &self.multipliers {
            _ if evaluation.value == f64::INFINITY => f64::INFINITY,
            Some(multipliers) => multipliers.merit(evaluation),
            None => feasible_first(evaluation),
        };
        evaluations.iter().map(merit).collect()
    }

    fn lowest_with(&mut self, merits: &[f64], evaluations: &[Evaluation]) -> Option<Lowest> {
        let mut lowest = self.lowest.take();
        if self.multipliers.is_some() {
            for ((at, &merit), evaluation) in self.strategy.batch().iter().zip(merits).zip(evaluations) {
                if merit < lowest.as_ref().map_or(f64::INFINITY, |lowest| lowest.merit) {
                    lowest = Some(Lowest { merit, at: at.clone(), evaluation: evaluation.clone() });
                }
            }
        }
        lowest
    }

    /// Once a local search has converged: does the point it found keep the constraints? If not, on from there.
    fn next_round(&mut self) {
        if !matches!(self.strategy.finished(), Some(Reason::Converged | Reason::Stalled | Reason::Edge)) {
            return;
        }
        if let (Some(multipliers), Some(lowest)) = (&mut self.multipliers, self.lowest.take())
            && multipliers.improve(&lowest.evaluation)
            && let Some(search) = self.strategy.local()
        {
            search.start_over(lowest.at);
        }
    }

    fn note(&mut self, evaluations: &[Evaluation]) {
        self.evaluations += evaluations.len();
        for (point, evaluation) in self.batch.iter().zip(evaluations) {
            let (value, violation) = (evaluation.value, evaluation.violation());
            let better = |best: &Candidate| (violation, value) < (best.violation, best.value);
            if value < f64::INFINITY && self.best.as_ref().is_none_or(better) {
                self.best = Some(Candidate { point: point.clone(), value, violation });
            }
            if !evaluation.further.is_empty() {
                self.archive.add(point, evaluation);
            }
        }
        let kept =
            evaluations.iter().filter(|evaluation| evaluation.violation() == 0.0 && evaluation.value.is_finite());
        let (sum, best, count) = kept.fold((0.0, f64::INFINITY, 0_usize), |(sum, best, count), evaluation| {
            (sum + evaluation.value, evaluation.value.min(best), count + 1)
        });
        self.history.push(Generation {
            best,
            best_so_far: self.best().filter(|best| best.violation == 0.0).map_or(f64::INFINITY, |best| best.value),
            mean: if count == 0 { f64::INFINITY } else { sum / count as f64 },
            evaluations: self.evaluations,
        });
    }

    /// Beyond the worst of each objective among the first points that keep the constraints, by a tenth of what they span: the
    /// ends of a front count too.
    fn refer(&mut self, evaluations: &[Evaluation]) {
        let kept = || evaluations.iter().filter(|it| it.admissible() && it.violation() == 0.0);
        let Some(first) = kept().next().filter(|first| self.reference.is_empty() && !first.further.is_empty()) else {
            return;
        };
        let beyond = |axis: usize| {
            let values = kept().filter_map(|it| it.objectives().nth(axis));
            let (low, high) =
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
            let span = if high > low { high - low } else { high.abs().max(f64::MIN_POSITIVE) };
            high + 0.1 * span
        };
        self.reference = (0..first.objectives().count()).map(beyond).collect();
    }

    /// Why the search has ended; `None` while it goes on.
    #[must_use]
    pub fn finished(&self) -> Option<Reason> {
        if self.has_settled { Some(Reason::Settled) } else { self.strategy.finished() }
    }

    /// With several objectives: the points that keep all constraints and that no other one dominates, at most `count` that
    /// lie evenly, from the smallest first objective on.
    #[must_use]
    pub fn front(&self, count: usize) -> Vec<&Member> {
        self.archive.even(count)
    }

    /// Why the point that was found may not be a minimum, where a local search says so of itself; a population has looked
    /// elsewhere already, whatever becomes of its polish.
    pub fn doubt(&mut self) -> Option<&'static str> {
        let reason = self.finished()?;
        self.strategy.local().and_then(|_| reason.doubt())
    }

    /// The first point with the lowest value of those that keep the constraints, or while none does the one that breaks
    /// least of them; `None` while no admissible point was met.
    #[must_use]
    pub fn best(&self) -> Option<&Candidate> {
        self.best.as_ref()
    }

    /// One row per batch.
    #[must_use]
    pub fn history(&self) -> &[Generation] {
        &self.history
    }

    /// How many points were evaluated so far.
    #[must_use]
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// The most evaluations the search may take.
    #[must_use]
    pub fn budget(&self) -> usize {
        self.strategy.budget()
    }

    /// The box that is searched.
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
        self.run_constrained(|points| Ok(evaluate(points)?.into_iter().map(Evaluation::from).collect()))
    }

    /// As [`Optimizer::run`], for an objective with constraints.
    ///
    /// # Errors
    /// Those of `evaluate`, and of [`Optimizer::tell_constrained`].
    pub fn run_constrained<E: From<Failure>>(
        &mut self,
        mut evaluate: impl FnMut(&[Vec<f64>]) -> Result<Vec<Evaluation>, E>,
    ) -> Result<Reason, E> {
        loop {
            if let Some(reason) = self.finished() {
                return Ok(reason);
            }
            let evaluations = evaluate(&self.batch)?;
            self.tell_constrained(evaluations)?;
        }
    }
}
