//! The registry of stage kinds: one line each.

use super::Kind;

/// Every kind, in the order in which `gearstudy kinds` lists them.
pub const KINDS: &[&Kind] = &[];
