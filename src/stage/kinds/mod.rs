//! The registry of stage kinds: one line each.

pub mod accuracy;
pub mod export;
pub mod fit;
pub mod geometry;
pub mod hunting;
pub mod limit;
pub mod modification;
pub mod optimizer;
pub mod rating;
pub mod report;
pub mod root_optimizer;
pub mod scatter;
pub mod sizing;
pub mod stability;
pub mod ste;
pub mod stiffness;
pub mod sweep;

use super::Kind;

/// Every kind, in the order in which `gearstudy kinds` lists them.
pub const KINDS: &[&Kind] = &[
    &geometry::KIND,
    &modification::KIND,
    &stiffness::KIND,
    &optimizer::KIND,
    &root_optimizer::KIND,
    &sizing::KIND,
    &ste::KIND,
    &hunting::KIND,
    &sweep::KIND,
    &scatter::KIND,
    &fit::KIND,
    &limit::KIND,
    &accuracy::KIND,
    &rating::KIND,
    &stability::KIND,
    &export::KIND,
    &report::KIND,
];
