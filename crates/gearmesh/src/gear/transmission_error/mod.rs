//! Transmission error and mesh stiffness over one base pitch of mesh.
//!
//! The transmission error is the approach δ of the gears along the line of action \[m\], positive where the driven gear
//! lags. [`cycle::MeshCycle`] holds what no modification changes, [`load_case::LoadCase`] one design under one torque;
//! curves, summaries and objectives come from it. Must not know: where compliances or modifications come from.

mod across;
mod apart;
pub mod beyond_model;
mod change;
mod closed;
mod count;
pub mod curve;
pub mod cycle;
pub mod doubt;
mod ends;
pub mod face_map;
mod flanks;
pub mod friction;
pub mod hunting;
pub mod load_case;
pub mod needs;
pub mod neglected_corners;
mod path;
mod plain_pairs;
pub mod pressure;
pub mod quantities;
pub mod root_stress;
pub mod sampling;
mod sharing;
mod sliced;
pub mod stiffness;
#[cfg(test)]
mod tests;
mod together;
pub mod trace;
mod walk;
mod within_reach;
