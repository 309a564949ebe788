//! The registry of stage kinds: one line each.

pub mod report;

use super::Kind;

/// Every kind, in the order in which `gearstudy kinds` lists them.
pub const KINDS: &[&Kind] = &[&report::KIND];
