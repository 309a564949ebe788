//! Loaded contact at one position: how the tooth pairs in contact share the load.
//!
//! Must not know: the mesh cycle.

pub mod face;
pub mod flattening;
pub mod gap;
pub mod inverse;
pub mod patch;
pub mod plain;
pub mod rounding;
pub mod separation;
pub mod slices;
pub mod springs;
pub mod tip;
pub mod uneven;
pub mod wedge;

use declare::Words;

/// Where flanks can touch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum CornerContact {
    /// flanks touch from A to E only, where they come nearest to each other
    #[default]
    None,
    /// tip corners touch too, before A and after E
    Exact,
}

/// Whether the slices of a face hold each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum SliceCoupling {
    /// every slice of the face is a spring of its own
    #[default]
    None,
    /// teeth bend and twist as plates, so that a loaded slice takes its neighbours along
    Plate,
}

/// The most slices that may hold each other: the time for a curve grows with their cube.
pub const MOST_COUPLED_SLICES: usize = 200;
