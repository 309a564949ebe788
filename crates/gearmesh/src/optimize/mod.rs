//! Minimisation over a box: the registry of methods, one line each, and the trait every method has.
//!
//! The caller asks for a batch of points, evaluates them in any order on any number of threads, and tells the values in
//! the order of the points ([`search::Optimizer`]). A method works in the unit cube and sees only numbers and +∞, so
//! bounds, scaling, inadmissible points and the history are kept in one place.
//!
//! The methods are written here rather than taken from `basin` 3.2, which has most of them: its solvers call the
//! objective themselves, one point at a time or in a thread pool of their own, where ours must hand out whole batches
//! that share the stage's threads and its stop flag; its CMA-ES takes `ln` and `exp` from the C library, which differ
//! between CPUs; and its trajectories may change with a release, which the cached results of a study must not.
//! Ours were checked against `SciPy`'s (see `tests/reference/optimize.py`).
//!
//! None of the crates looked at in 2026 has Powell's direction set; [`powell`] is ours for that reason too.
//!
//! Must not know: gears, units, files, clocks, threads.

pub mod bounds;
pub mod by_number;
pub mod constraints;
pub mod differential_evolution;
pub mod genetic;
pub mod grid;
pub mod hypervolume;
mod kink;
pub mod latin_hypercube;
pub mod leaders;
pub mod least_squares;
mod line;
mod local;
pub mod nelder_mead;
pub mod nsga2;
pub mod pareto;
pub mod powell;
pub mod random;
mod restarts;
pub mod sampling;
pub mod scrambled;
pub mod search;
pub mod settled;
pub mod sobol;

use std::fmt::Debug;

use bounds::Bounds;
use constraints::Evaluation;
use declare::declared::{Declared, Registrable};
use declare::error::Diagnostic;
use declare::registry;
use declare::seed::Seed;
use search::{Optimizer, Reason};

/// What a method will ask for, known from its parameters and the number of variables, before a point is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Foreseen {
    /// The most evaluations.
    pub evaluations: usize,
    /// The most batches.
    pub batches: usize,
    /// Whether it asks for exactly as many, or may converge before.
    pub exact: bool,
    /// Bytes that it holds at once, at most.
    pub memory: usize,
}

/// A method of minimisation with its settings: a declared struct, which anybody can make.
pub trait Method: Debug + Registrable + Send + Sync {
    /// What it will ask for with `dimension` variables, before a point is drawn.
    ///
    /// # Errors
    /// Settings that make no sense together, or for this number of variables, which no range can express.
    fn foresee(&self, dimension: usize) -> Result<Foreseen, Diagnostic>;

    /// Whether where it looks follows from what it found; a sample was laid out before.
    fn learns(&self) -> bool {
        true
    }

    /// The same without a local search at its end, for somebody who goes on from what it finds by other means; none where
    /// it has none.
    fn unpolished(&self) -> Option<Box<dyn Method>> {
        None
    }

    /// Whether it finds fronts of several objectives. A sample does: nothing that it looks at follows from any of them.
    fn finds_fronts(&self) -> bool {
        !self.learns()
    }

    /// Sets itself up for a number of variables. Never called with what [`Method::foresee`] refuses.
    fn strategy(&self, dimension: usize, seed: Seed) -> Box<dyn Strategy>;
}

registry!(
    METHODS: Method = genetic::Genetic,
    differential_evolution::DifferentialEvolution,
    nelder_mead::NelderMead,
    powell::Powell,
    nsga2::Nsga2,
    grid::Grid,
    latin_hypercube::LatinHypercube,
    sobol::Sobol,
);

/// What a method does: proposes points of the unit cube and learns their values. Deterministic: the same values give
/// the same points.
pub trait Strategy: Send {
    /// The points to evaluate next, each coordinate in 0..=1; not empty before the method has finished.
    fn batch(&self) -> &[Vec<f64>];

    /// Takes the values of the batch, in its order: numbers, or +∞ for an inadmissible point. Never called after the
    /// method has finished.
    ///
    /// # Errors
    /// When the method cannot work with such values; the message says why.
    fn learn(&mut self, values: &[f64]) -> Result<(), String>;

    /// Why it has ended; `None` while it has another batch.
    fn finished(&self) -> Option<Reason>;

    /// The most evaluations it will ask for.
    fn budget(&self) -> usize;

    /// The method as a local search, if it is one: see [`constraints`] for what it is asked then.
    fn local(&mut self) -> Option<&mut dyn Local> {
        None
    }

    /// The method as one that ranks points by all that is known of them, if it does.
    fn fronts(&mut self) -> Option<&mut dyn Fronts> {
        None
    }

    /// Nothing more is gained by what it does: begins what comes last, if there is such a thing. Whether there is.
    fn goes_on(&mut self) -> bool {
        false
    }
}

/// A method that keeps constraints and finds fronts by itself.
pub trait Fronts {
    /// As [`Strategy::learn`], and in its place.
    fn learn_all(&mut self, evaluations: &[Evaluation]);
}

/// A method that searches from one point.
pub trait Local {
    /// Begins anew at a point of the unit cube, because the function has changed; what it has used of its evaluations
    /// stays used.
    fn start_over(&mut self, at: Vec<f64>);
}

/// A search of `bounds` by a method whose settings were read from a study, where their ranges were checked.
///
/// # Errors
/// As [`Method::foresee`].
pub fn search(method: &dyn Method, bounds: Bounds, seed: Seed) -> Result<Optimizer, Diagnostic> {
    method.foresee(bounds.dimension())?;
    Ok(Optimizer::new(method.strategy(bounds.dimension(), seed), bounds))
}

/// A search of `bounds` by a method with any settings.
///
/// # Errors
/// A setting outside its range; as [`Method::foresee`].
pub fn optimizer<M: Declared + Method + Clone>(
    method: &M,
    bounds: Bounds,
    seed: Seed,
) -> Result<Optimizer, Diagnostic> {
    method.in_range()?;
    search(method, bounds, seed)
}

/// A local search of `bounds` around a point of it, by a simplex whose first edges are `edge`, a share of each range: for what
/// another search has found. It keeps constraints by [`constraints`]' order, so it never leaves a point that keeps them for
/// one that does not.
#[must_use]
pub fn refinement(bounds: Bounds, from: &[f64], edge: f64, evaluations: usize) -> Optimizer {
    Optimizer::new(Box::new(nelder_mead::Refinement::new(bounds.unit(from), edge, evaluations)), bounds)
}

/// Bytes of so many points as vectors of coordinates, with what the allocator keeps of each.
fn points_held(count: usize, dimension: usize) -> usize {
    count.saturating_mul(8 * dimension + 40)
}

#[cfg(test)]
mod tests;
