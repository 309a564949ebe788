//! What gears are made of. SI.
//!
//! Must not know: gears.

/// Linear elastic, isotropic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// E \[Pa\].
    pub youngs_modulus: f64,
    /// ν.
    pub poisson_ratio: f64,
}

impl Material {
    /// Steel as ISO 6336-1 has it: E = 206 GPa, ν = 0.3.
    pub const STEEL: Self = Self { youngs_modulus: 206e9, poisson_ratio: 0.3 };
}
