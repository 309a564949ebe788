//! Results where they lie: in a folder, or in the commits of a git repository, read without a checkout.
//!
//! Must not know: what is done with them. Nothing is run.

pub mod git;
pub mod side;
