//! Small design problems: variables in a box, objectives, constraints; and the registry of those on one gear of a pair.
//!
//! An optimiser needs nothing else of them. Problems without a pair are in `gear/sizing`. Values in SI. Must not know: how
//! anything is searched, tables.

pub mod fillet;
pub mod root_arc;

use std::fmt::Debug;

use super::geometry::error::GeometryError;
use super::geometry::{GearPair, Side};
use declare::declared::Registrable;
use declare::registry;
use declare::units::Dimension;

/// A number that is free; on a gear of a pair it is a length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variable {
    /// Its symbol in the source, such as `r_c`, or its name.
    pub name: &'static str,
    /// Of its values, which are in SI.
    pub dimension: Dimension,
    /// The least that it may be.
    pub minimum: f64,
    /// The most that it may be.
    pub maximum: f64,
}

/// What a point of the box is worth.
#[derive(Clone, Debug, PartialEq)]
pub struct Worth {
    /// To be made small.
    pub objective: f64,
    /// What else is to be small, where there are several objectives; as many for every point.
    pub further: Vec<f64>,
    /// Each must not be negative; on a gear of a pair lengths \[m\], else shares of a limit.
    pub constraints: Vec<f64>,
}

/// A problem with everything but its variables fixed.
pub trait Problem: Send + Sync {
    /// What is free, in the order of the coordinates of a point.
    fn variables(&self) -> Vec<Variable>;

    /// What the constraints are called, in their order.
    fn constraints(&self) -> &'static [&'static str];

    /// Objectives and constraints at a point, one number per variable; +∞ or NaN where there is nothing to judge.
    fn worth(&self, point: &[f64]) -> Worth;

    /// The point that was judged, where a variable takes only some of the values of the box.
    fn resolved(&self, point: &[f64]) -> Vec<f64> {
        point.to_vec()
    }
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
