//! What gears are made of. SI.
//!
//! Must not know: gears.

use declare::Declared;
use declare::units::STRESS;

/// Linear elastic, isotropic.
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
pub struct Material {
    /// Young's modulus E.
    #[declared(minimum = 1.0, maximum = 1e15, dimension = STRESS, default = "206 GPa")]
    pub youngs_modulus: f64,
    /// Poisson's ratio ν.
    #[declared(minimum = 0.0, maximum = 0.4999, default = "0.3")]
    pub poisson_ratio: f64,
}

impl Material {
    /// Steel as ISO 6336-1 has it: E = 206 GPa, ν = 0.3.
    pub const STEEL: Self = Self { youngs_modulus: 206e9, poisson_ratio: 0.3 };
}
