//! The flanks of a design, and how they share a load at one position of the mesh cycle.
//!
//! Must not know: which positions are computed, what is done with the values.

pub mod beyond_model;
mod candidate_pairs;
mod coupled_slices;
pub(in crate::gear::mesh) mod flanks;
pub(in crate::gear::mesh) mod individual_pairs;
pub(in crate::gear::mesh) mod load_case;
mod load_sharing;
mod several_positions;
pub mod state;
