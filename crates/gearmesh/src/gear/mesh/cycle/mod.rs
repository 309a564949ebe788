//! Everything that no modification and no load changes: the pair, its teeth, and how one base pitch of mesh is sampled.
//!
//! Must not know: modification, load.

pub(in crate::gear::mesh) mod across;
mod closed;
pub(in crate::gear::mesh) mod count;
mod ends;
pub mod error;
pub mod flank_friction;
pub mod mesh;
pub(in crate::gear::mesh) mod path;
pub(in crate::gear::mesh) mod roots;
