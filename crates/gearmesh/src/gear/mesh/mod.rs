//! The mesh of a pair of gears under load: transmission error and mesh stiffness over one base pitch, and what follows from them.
//!
//! The transmission error is the approach δ of the gears along the line of action \[m\], positive where the driven gear lags.
//! A [`Mesh`] holds everything that no modification changes, a [`MeshedDesign`] the gaps of one design's flanks, and
//! [`Loaded`] answers under one torque: three rooms, each of which imports only those before it. `cycle` has the pair, its
//! teeth and the sampling; `equilibrium` flanks and how they share the load at one position; `answers` curves, summaries,
//! pressures, stresses, friction. Must not know: where compliances or modifications come from.

pub mod answers;
pub mod cycle;
pub mod equilibrium;
mod loaded;
#[cfg(test)]
mod tests;
pub mod trace;

pub use cycle::error::MeshError;
pub use cycle::mesh::{Mesh, Settings, Zone};
pub use equilibrium::beyond_model::BeyondModel;
pub use equilibrium::state::Equilibrium;
pub use loaded::{Loaded, MeshedDesign};
