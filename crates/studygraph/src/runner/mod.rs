//! Running a study: what must be computed, why, in which order, and doing it.
//!
//! Must not know: gears, what a stage computes, how progress is drawn.

pub mod board;
pub mod chunk;
pub mod events;
pub mod execute;
pub mod fault;
pub mod foresee;
pub mod graph;
pub mod key;
pub mod limits;
pub mod note;
pub mod options;
mod others;
pub mod outcome;
pub mod ownership;
mod pieces;
pub mod plan;
pub mod reach;
pub mod refuse;
pub mod rehearse;
pub mod shard;
pub mod standing;
#[cfg(test)]
mod tests;
mod told;
pub mod verify;
pub mod work;
