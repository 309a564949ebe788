//! Finite elements: a whole gear, clamped at its bore, from one meshed sector.
//!
//! `outline` is the exact boundary of half a tooth, `mesh` the sector, `tooth_rows` the nodes of its tooth, `grading` sizes of
//! elements that grow with the distance, `element` the quadrilateral, `sector` its factorised stiffness, `wheel` the ring of
//! sectors, `point_load` a load less its own field, `gear_model` what a load on a tooth does to it and its neighbours,
//! `root_stress` the stress at its root.
//! Lengths in modules, E = 1, forces per width. Must not know: pairs, contact, tables.

pub mod element;
pub mod gear_model;
mod grading;
pub mod mesh;
pub mod outline;
pub mod point_load;
pub mod root_stress;
pub mod sector;
#[cfg(test)]
mod tests;
mod tooth_rows;
pub mod wheel;

use super::geometry::error::{GeometryError, Millimetres, Plain};

/// Why a gear cannot be meshed or solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// The gear has no full profile to be meshed.
    #[error(transparent)]
    Profile(#[from] GeometryError),
    /// The root meets the root circle in a corner: `base_circle`, or a fillet without radius.
    #[error("its root meets the root circle in a sharp corner, where no stress is finite; it needs a fillet")]
    SharpRoot,
    /// The Jacobian of an element is not positive at one of its Gauss points.
    #[error("element {element} of {elements} of the mesh is folded over; a finer mesh may not be")]
    Folded {
        /// The first such element, counted from 1.
        element: usize,
        /// How many elements the sector has.
        elements: usize,
    },
    /// The point Q, where the load line crosses the tooth's centreline, lies inside the bore.
    #[error(
        "the load line meets the tooth's centreline at a radius of {height}, inside the bore of {bore}: no point is left that shows the tooth's deflection"
    )]
    Bore {
        /// Radius of Q, r_b over the cosine of the load angle \[m\].
        height: Millimetres,
        /// Radius of the bore \[m\].
        bore: Millimetres,
    },
    /// The body is so deep for its width that rounding may change the compliances by more than 1 %.
    #[error(
        "too many digits are lost in a body that is so deep for its width: the root radius is {ratio} times the bore radius, but must be below {maximum} times it for so many teeth"
    )]
    Rounding {
        /// r_f over the radius of the bore.
        ratio: Plain,
        /// The largest ratio for this number of teeth.
        maximum: Plain,
    },
    /// A stiffness matrix is not positive definite to rounding, so that it has no Cholesky factors.
    #[error("the stiffness is singular to rounding")]
    Singular,
    /// The matrices of a sector do not fit into memory.
    #[error("there is not enough memory for the mesh")]
    Memory,
}
