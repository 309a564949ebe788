//! Rating of a spur pair after ISO 6336-1, -2 and -3:2019, method B: every factor, and the safety against given strengths.
//!
//! Each file has the factors of one clause or a few; `rate` puts them together. The standard's pinion is the gear with fewer
//! teeth, whichever drives; with equal numbers it is ours. Must not know: load sharing, finite elements.

pub mod bending;
pub mod conditions;
pub mod distribution;
pub mod dynamic;
pub mod life;
pub mod material;
pub mod pitting;
mod rate;
pub mod root;
pub mod running_in;

pub use rate::{GearRating, PairRating, Rating, Refused, rate};

#[cfg(test)]
mod tests;
