//! The kernels' error estimates against the truth, over populations of random pairs, loads and designs.
//!
//! They ask what anybody may ask, and take as long as all of the kernels' own tests.

mod compliances;
#[path = "../../crates/gearmesh/src/gear/random.rs"]
pub mod random;
mod samplings;
