//! What the pages of results and of comparisons look alike in.

/// The style of every page; a page adds its own.
pub const STYLE: &str = include_str!("page.css");
