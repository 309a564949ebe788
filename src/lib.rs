//! gearstudy: declarative, reproducible studies of spur-gear tooth modifications.
//!
//! The layers and what may import what are in `ARCHITECTURE.md`; `tests/it/layering.rs` holds them to it.

pub mod base;
pub mod cli;
pub mod diff;
pub mod gear;
pub mod history;
pub mod numeric;
pub mod optimize;
#[cfg(feature = "frames")]
pub mod query;
pub mod report;
pub mod runner;
pub mod stage;
pub mod store;
pub mod study;
pub mod table;
