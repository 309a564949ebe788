//! Numbers, curves and maps of a load case. Each file is a set of functions of one load case; none keeps anything.
//!
//! Must not know: tables, units other than SI.

mod contact_change;
pub mod contact_law_error;
pub mod corner_stretches;
pub mod curve;
pub mod face_map;
pub mod friction;
pub mod hunting;
pub mod needs;
pub mod neglected_corners;
pub mod pressure;
pub mod quantities;
pub mod root_stress;
pub mod sampling;
pub mod stiffness;
pub(in crate::gear::mesh) mod walk;
