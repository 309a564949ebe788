//! Finite elements: a whole gear, clamped at its bore, from one meshed sector.
//!
//! `outline` is the exact boundary of half a tooth, `mesh` the sector, `element` the quadrilateral, `sector` its
//! factorised stiffness, `wheel` the ring of sectors, `gear_model` what a load on a tooth does to it and its neighbours,
//! `root_stress` the stress at its root.
//! Lengths in modules, E = 1, forces per width. Must not know: pairs, contact, tables.

pub mod element;
pub mod gear_model;
pub mod mesh;
pub mod outline;
pub mod root_stress;
pub mod sector;
#[cfg(test)]
mod tests;
pub mod wheel;

use super::geometry::error::{GeometryError, Millimetres, Plain};

/// Why a gear cannot be meshed or solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    #[error(transparent)]
    Profile(#[from] GeometryError),
    #[error("its root meets the root circle in a sharp corner, where no stress is finite; it needs a fillet")]
    SharpRoot,
    #[error("element {element} of {elements} of the mesh is folded over; a finer mesh may not be")]
    Folded { element: usize, elements: usize },
    #[error(
        "the load line meets the tooth's centreline at a radius of {height}, inside the bore of {bore}: no point is left that shows the tooth's deflection"
    )]
    Bore { height: Millimetres, bore: Millimetres },
    #[error(
        "too many digits are lost in a body that is so deep for its width: the root radius is {ratio} times the bore radius, but must be below {most} times it for so many teeth"
    )]
    Rounding { ratio: Plain, most: Plain },
    #[error("the stiffness is singular to rounding")]
    Singular,
    #[error("there is not enough memory for the mesh")]
    Memory,
}
