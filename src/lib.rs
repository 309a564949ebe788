//! gearstudy: declarative, reproducible studies of spur-gear tooth modifications.
//!
//! The layers and what may import what are in `ARCHITECTURE.md`; `tests/it/layering.rs` holds them to it.

pub mod cli;
pub mod program;
pub mod query;
pub mod report;
pub mod rexs;
pub mod stage;
