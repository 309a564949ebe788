//! What is promised when a disk is full, read-only or broken, when the power fails, and when two computers share a folder.
//!
//! `docs/reliability.md` has the promises, each with the test that holds it.

mod cache;
mod cleaning;
#[cfg(target_os = "linux")]
pub mod disk;
#[cfg(target_os = "linux")]
mod faults;
#[cfg(target_os = "linux")]
mod hosts;
#[cfg(target_os = "linux")]
mod kills;
mod notes;
#[cfg(target_os = "linux")]
mod power;
#[cfg(target_os = "linux")]
pub mod published;
#[cfg(target_os = "linux")]
mod threads;
