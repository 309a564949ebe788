//! Small design problems on one gear of a pair: variables in a box, an objective, constraints; and their registry.
//!
//! An optimiser needs nothing else of them. Values in SI. Must not know: how anything is searched, tables.

pub mod fillet;
pub mod root_arc;

use std::fmt::Debug;

use super::geometry::error::GeometryError;
use super::geometry::{GearPair, Side};
use declare::declared::Registrable;
use declare::registry;
use declare::units::Dimension;

/// A length that is free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variable {
    /// Its symbol in the source, such as `r_c`.
    pub name: &'static str,
    /// \[m\].
    pub minimum: f64,
    /// \[m\].
    pub maximum: f64,
}

/// What a point of the box is worth.
#[derive(Clone, Debug, PartialEq)]
pub struct Worth {
    /// To be made small.
    pub objective: f64,
    /// Lengths \[m\]; each must not be negative.
    pub constraints: Vec<f64>,
}

/// A problem with everything but its variables fixed.
pub trait Problem: Send + Sync {
    /// What is free, in the order of the coordinates of a point.
    fn variables(&self) -> Vec<Variable>;

    /// What the constraints are called, in their order.
    fn constraints(&self) -> &'static [&'static str];

    /// Objective and constraints at a point, one length \[m\] per variable; +∞ or NaN where there is nothing to judge.
    fn worth(&self, point: &[f64]) -> Worth;
}

/// A problem as it is stated: a declared struct, which anybody can make.
pub trait Stated: Debug + Registrable + Send + Sync {
    /// The dimension of the objective.
    fn dimension(&self) -> Dimension;

    /// The most variables that are free, and the most constraints.
    fn maximum(&self) -> [usize; 2];

    /// About how many seconds a point of the box takes.
    fn seconds(&self) -> f64;

    /// The problem of a gear of a pair.
    ///
    /// # Errors
    /// Why there is none.
    fn on(&self, pair: &GearPair, side: Side) -> Result<Box<dyn Problem>, GeometryError>;
}

registry!(PROBLEMS: Stated = root_arc::RootArcProblem, fillet::FilletProblem);
