//! The error of an approach beyond the range of the model of corner contact.
//!
//! Must not know: designs, torques.

use crate::gear::geometry::error::Millimetres;
use crate::gear::geometry::error::shown::beside;

/// The gears approach by more than the model of corner contact holds for.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the gears approach by {}, but `corner_contact: exact` holds up to {} only; beyond that a tip passes the other one, or a \
     pair farther out would touch",
    beside(.approach, .largest),
    beside(.largest, .approach)
)]
pub struct BeyondModel {
    /// δ \[m\].
    pub approach: Millimetres,
    /// The largest δ that is modelled \[m\].
    pub largest: Millimetres,
}
