//! Tables: typed columns with unit, description, tolerance; rows sorted by key; a content hash; cell selection.
//!
//! Must not know: files, stages, gears.

pub mod columns;
pub mod content;
pub mod data;
mod derived;
pub mod schema;
pub mod select;
pub mod tolerance;
