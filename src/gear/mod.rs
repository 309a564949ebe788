//! Gear mechanics on `f64` in SI: geometry, modification, compliance, contact, transmission error.
//!
//! Must not know: files, clocks, threads, printing, YAML, global state.

pub mod compliance;
pub mod geometry;
