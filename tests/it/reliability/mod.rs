//! What is promised when a disk is full, read-only or broken, when the power fails, and when two computers share a folder.
//!
//! `docs/reliability.md` has the promises, each with the test that holds it.

mod cache;
mod cleaning;
