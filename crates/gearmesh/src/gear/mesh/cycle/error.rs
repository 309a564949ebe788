//! Reasons for which a pair has no mesh.
//!
//! Must not know: studies, stages.

use crate::gear::compliance::ComplianceError;
use crate::gear::geometry::Side;

/// The reason for which a pair has no mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// Contact is lost, or more pairs are in contact than the solver holds.
    #[error("the transverse contact ratio is {ratio:.6}; it must be 1 to {largest}")]
    ContactRatio {
        /// ε_α.
        ratio: f64,
        /// The largest that is solved.
        largest: usize,
    },
    /// The same with the pairs in corner contact.
    #[error("the transverse contact ratio is {ratio:.6}; with corner contact it must be 1 to {largest}")]
    ContactRatioWithCorners {
        /// ε_α.
        ratio: f64,
        /// The largest that is solved.
        largest: usize,
    },
    /// Corner contact at the end of a root form circle is not modelled.
    #[error(
        "{}: contact ends at its root form circle, which its mate's tip passes; what the edge there would touch is not modelled, \
         so that corner contact must be `none`", .0.name()
    )]
    CurtailedContact(Side),
    /// Coupled slices need the compliances of single teeth.
    #[error("`slice_coupling: plate` needs compliances of single teeth; this stiffness is that of pairs as a whole")]
    StiffnessOfPairs,
    /// The method gives no compliance for the pair.
    #[error(transparent)]
    Compliance(#[from] ComplianceError),
}
