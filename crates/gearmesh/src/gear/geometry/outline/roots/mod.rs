//! The families of roots a full profile may have: the registry, one line each, and what a family gives.
//!
//! Must not know: the tip, how many points are wanted.

pub mod arc;
pub mod base_arc;
pub mod optimised_arc;
pub mod tangent_arc;
pub mod trochoid;

use std::fmt::Debug;

use super::curve::Segment;
use crate::gear::geometry::Gear;
use crate::gear::geometry::error::GeometryError;
use declare::declared::Registrable;
use declare::registry;

/// A root on the right half of a tooth.
#[derive(Clone, Debug)]
pub struct Toe {
    /// Upwards, from the root circle, or from the middle of the space where the root circle is not reached.
    pub segments: Vec<Segment>,
    /// Roll angle \[rad\] at which the flank begins.
    pub form_roll: f64,
}

/// A root with its settings: a declared struct, which anybody can make.
pub trait Root: Debug + Registrable + Send + Sync {
    /// The root of a gear, or why it does not exist, with numbers.
    ///
    /// # Errors
    /// When the gear has no such root.
    fn toe(&self, gear: &Gear) -> Result<Toe, GeometryError>;
}

registry!(
    FAMILIES: Root = trochoid::Trochoid,
    arc::Arc,
    tangent_arc::TangentArc,
    optimised_arc::OptimisedArc,
);
