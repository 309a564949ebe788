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
