//! gearstudy: declarative, reproducible studies of spur-gear tooth modifications.
//!
//! The layers and what may import what are in `ARCHITECTURE.md`; `tests/it/layering.rs` holds them to it.

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "a test that cannot read a file fails by what it expects of it")
)]

pub mod cli;
pub mod program;
pub mod query;
pub mod report;
pub mod rexs;
pub mod stage;
