//! Loaded contact at one position: how the tooth pairs in contact share the load.
//!
//! Must not know: which modifications made the gaps, the mesh cycle.

pub mod face;
pub mod flattening;
pub mod springs;
