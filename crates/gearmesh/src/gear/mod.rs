//! Gear mechanics on `f64` in SI: geometry, modification, compliance, contact, transmission error, rating.
//!
//! Must not know: files, clocks, threads, printing, YAML, global state.

pub mod compliance;
pub mod contact;
pub mod finite_elements;
#[cfg(test)]
pub(crate) mod fixtures;
pub mod friction;
pub mod geometry;
pub mod iso1328;
pub mod lengths;
pub mod material;
pub mod mesh;
pub mod misalignment;
pub mod modification;
pub mod problem;
#[cfg(test)]
pub(crate) mod random;
pub mod rating;
pub mod sizing;
pub mod stability;
pub mod work;
