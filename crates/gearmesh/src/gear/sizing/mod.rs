//! Design problems whose answer is the main dimensions of a pair and of what carries it; and their registry.
//!
//! They need no pair, and may have several objectives. Variables and objectives in SI. Must not know: how anything is
//! searched, tables.

pub mod speed_reducer;

use std::fmt::Debug;

use super::problem::Problem;
use declare::declared::Registrable;
use declare::registry;
use declare::units::Dimension;

/// A number that is to be small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Objective {
    /// As a column of a table has it.
    pub name: &'static str,
    /// Of its values, which are in SI.
    pub dimension: Dimension,
}

/// A problem as it is stated: a declared struct, which anybody can make.
pub trait Sizing: Debug + Registrable + Send + Sync {
    /// What is to be small, in the order in which the problem gives it; at least one, each once.
    fn objectives(&self) -> Vec<Objective>;

    /// The problem, whose constraints are shares of their limits.
    fn problem(&self) -> Box<dyn Problem>;
}

registry!(SIZINGS: Sizing = speed_reducer::SpeedReducer);
