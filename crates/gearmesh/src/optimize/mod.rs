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
pub mod constraints;
pub mod differential_evolution;
pub mod genetic;
pub mod grid;
mod kink;
pub mod latin_hypercube;
mod line;
mod local;
pub mod nelder_mead;
pub mod powell;
pub mod random;
mod restarts;
pub mod sampling;
pub mod search;
pub mod sobol;

use bounds::Bounds;
use declare::error::{Diagnostic, suggest};
use declare::parameter::Member;
use declare::record::Record;
use declare::seed::Seed;
use search::{Optimizer, Reason};

/// Sets a method up for a number of variables.
pub type Build = fn(&Record, usize, Seed) -> Box<dyn Strategy>;

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

/// Looks ahead; refuses what no declaration can express.
pub type Foresee = fn(&Record, usize) -> Result<Foreseen, Diagnostic>;

/// A method as registered.
pub struct Method {
    pub member: Member,
    pub foresee: Foresee,
    /// Never called with what [`Method::foresee`] refuses.
    pub build: Build,
}

/// Every method, in the order in which `gearstudy kinds` lists them.
pub const METHODS: &[&Method] = &[
    &genetic::METHOD,
    &differential_evolution::METHOD,
    &nelder_mead::METHOD,
    &powell::METHOD,
    &grid::METHOD,
    &latin_hypercube::METHOD,
    &sobol::METHOD,
];

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

    fn finished(&self) -> Option<Reason>;

    /// The most evaluations it will ask for.
    fn budget(&self) -> usize;

    /// The method as a local search, if it is one: see [`constraints`] for what it is asked then.
    fn local(&mut self) -> Option<&mut dyn Local> {
        None
    }
}

/// A method that searches from one point.
pub trait Local {
    /// Begins anew at a point of the unit cube, because the function has changed; what it has used of its evaluations
    /// stays used.
    fn start_over(&mut self, at: Vec<f64>);
}

/// The methods as a user sees them, for [`declare::parameter::Shape::Member`].
#[must_use]
pub fn members() -> &'static [Member] {
    const MEMBERS: [Member; METHODS.len()] = {
        let mut members = [METHODS[0].member; METHODS.len()];
        let mut at = 0;
        while at < METHODS.len() {
            members[at] = METHODS[at].member;
            at += 1;
        }
        members
    };
    &MEMBERS
}

/// What the method `name`, set up as `record` says, will ask for with `dimension` variables.
///
/// # Errors
/// When there is no such method, or its parameters make no sense together or for this number of variables.
pub fn foreseen(name: &str, record: &Record, dimension: usize) -> Result<Foreseen, Diagnostic> {
    (method(name, record)?.foresee)(record, dimension).map_err(|wrong| wrong.or_at(record.place))
}

/// The method `name`, set up as `record` says, ready to search `bounds`.
///
/// # Errors
/// As [`foreseen`].
pub fn optimizer(name: &str, record: &Record, bounds: Bounds, seed: Seed) -> Result<Optimizer, Diagnostic> {
    foreseen(name, record, bounds.dimension())?;
    let strategy = (method(name, record)?.build)(record, bounds.dimension(), seed);
    Ok(Optimizer::new(strategy, bounds))
}

fn method(name: &str, record: &Record) -> Result<&'static Method, Diagnostic> {
    METHODS.iter().copied().find(|method| method.member.name == name).ok_or_else(|| {
        let known = METHODS.iter().map(|method| method.member.name);
        Diagnostic::new(format!("there is no optimisation method `{name}`")).at(record.place).help(suggest(name, known))
    })
}

/// Bytes of so many points as vectors of coordinates, with what the allocator keeps of each.
fn points_held(count: usize, dimension: usize) -> usize {
    count.saturating_mul(8 * dimension + 40)
}

/// A field declared as an integer from zero or one upwards.
fn count(record: &Record, name: &str) -> usize {
    usize::try_from(record.integer(name)).expect("the declared range of a count is not negative")
}
