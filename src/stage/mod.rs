//! The stage kinds of this program, and what several of them share.
//!
//! A stage is pure: the same configuration, inputs and seed give the same tables, bit for bit, whatever the number of
//! threads. Must not know: the store, the runner, other stages (it sees their tables, never their code).

pub mod cases;
pub mod common;
pub mod compliance;
pub mod contact_law_error;
pub mod designs;
pub mod evaluated;
pub mod foreign;
pub mod formula;
pub mod kinds;
pub mod limit;
pub mod measures;
pub mod names;
pub mod neglected_corners;
pub mod operand;
pub mod pair;
pub mod quantity;
pub mod root_influences;
pub mod rows;
pub mod simpler;
pub mod target;

pub use studygraph::stage::{
    Ahead, Context, Curves, Demand, DimensionOf, Estimate, Inputs, KeysOf, Kind, Named, Omission, Others, Parts, Port,
    RowCount, Saved, Stage, Want, omission,
};

/// The kind called `name`.
#[must_use]
pub fn kind(name: &str) -> Option<&'static Kind> {
    kinds::KINDS.iter().copied().find(|kind| kind.name == name)
}
