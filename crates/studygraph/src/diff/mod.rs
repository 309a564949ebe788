//! Two sets of results, from manifests and tables alone: what changed, by how much, and why.
//!
//! `rows` and `columns` compare one table, `curves` one of sampled curves, `why` explains one stage, `verdict` one published number; `compare` puts them
//! together into the `model`, which `pretty`, `markdown` and `html` show. Must not know: how anything was computed, where
//! results lie.

mod columns;
pub mod compare;
pub mod curves;
pub mod html;
mod manifests;
pub mod markdown;
pub mod model;
pub mod pretty;
mod renamed;
mod rows;
mod source;
pub mod table;
#[cfg(test)]
mod tests;
mod verdict;
mod why;
pub mod words;
