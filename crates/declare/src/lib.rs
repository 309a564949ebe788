//! What every other layer stands on: errors with a place, texts, units, declared parameters, canonical digests, seeds,
//! counts of work.
//!
//! Must not know: gears, graphs, files, YAML.

pub mod declared;
pub mod digest;
pub mod error;
pub mod number;
pub mod parameter;
pub mod record;
pub mod registry;
pub mod seed;
pub mod text;
pub mod units;
pub mod work;

pub use declare_derive::{Alternatives, Declared, Tagged, Words};
