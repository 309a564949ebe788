//! Studies as graphs of stages: read from YAML, run with a cache, published, compared. Which stages there are, whoever
//! uses it says ([`program::Program`]).
//!
//! Must not know: gears.

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "a test that cannot read a file fails by what it expects of it")
)]

pub mod about;
pub mod diff;
pub mod git;
pub mod history;
pub mod page;
pub mod presence;
pub mod program;
pub mod runner;
pub mod stage;
pub mod store;
pub mod study;
pub mod table;
pub mod threads;
pub mod warning;
