//! Loaded contact at one position: how the tooth pairs in contact share the load.
//!
//! Must not know: the mesh cycle.

pub mod face;
pub mod flattening;
pub mod gap;
pub mod separation;
pub mod slices;
pub mod springs;

use declare::parameter::Choice;

/// Where flanks can touch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CornerContact {
    /// On the line of action, from A to E.
    #[default]
    None,
    /// Wherever they come nearest to each other, tip corners before A and after E included.
    Exact,
}

/// The kinds of corner contact as a study names them.
pub const CORNER_CONTACTS: &[Choice] = &[
    Choice { name: "none", summary: "flanks touch on the line of action only, from A to E" },
    Choice {
        name: "exact",
        summary: "they touch where they come nearest to each other, tip corners before A and after E included",
    },
];

impl CornerContact {
    /// The kind called `name` in [`CORNER_CONTACTS`].
    #[must_use]
    pub fn named(name: &str) -> Self {
        if name == "exact" { Self::Exact } else { Self::None }
    }
}

/// Whether the slices of a face hold each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SliceCoupling {
    /// Every slice is a spring of its own.
    #[default]
    None,
    /// Teeth bend and twist as plates: a loaded slice takes its neighbours along.
    Plate,
}

/// The kinds of coupling across the face as a study names them.
pub const SLICE_COUPLINGS: &[Choice] = &[
    Choice { name: "none", summary: "every slice of the face is a spring of its own" },
    Choice {
        name: "plate",
        summary: "teeth bend and twist as plates, so that a loaded slice takes its neighbours along",
    },
];

/// The most slices that may hold each other: the time for a curve grows with their cube.
pub const MOST_COUPLED_SLICES: usize = 200;

impl SliceCoupling {
    /// The kind called `name` in [`SLICE_COUPLINGS`].
    #[must_use]
    pub fn named(name: &str) -> Self {
        if name == "plate" { Self::Plate } else { Self::None }
    }
}
