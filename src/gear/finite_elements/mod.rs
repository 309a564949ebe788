//! Finite elements: a whole gear, clamped at its bore, from one meshed sector.
//!
//! `outline` is the exact boundary of half a tooth, `mesh` the sector, `element` the quadrilateral, `sector` its
//! factorised stiffness, `wheel` the ring of sectors, `gear_model` what a load on a tooth does to it and its neighbours.
//! Lengths in modules, E = 1, forces per width. Must not know: pairs, contact, tables.

pub mod element;
pub mod gear_model;
pub mod mesh;
pub mod outline;
pub mod sector;
#[cfg(test)]
mod tests;
pub mod wheel;

/// Why a gear cannot be meshed or solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    #[error("its root meets the root circle in a sharp corner, where no stress is finite; it needs a fillet")]
    SharpRoot,
    #[error("element {element} of {elements} is folded over")]
    Folded { element: usize, elements: usize },
    #[error("the load line meets the tooth's centreline inside the bore")]
    Bore,
    #[error("the stiffness is singular to rounding")]
    Singular,
    #[error("there is not enough memory for the mesh")]
    Memory,
}
