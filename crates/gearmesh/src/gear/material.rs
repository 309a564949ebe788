//! What gears are made of. SI.
//!
//! Must not know: gears.

use declare::units::{DENSITY, STRESS};
use declare::{Declared, Words};

/// Linear elastic, isotropic.
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
pub struct Material {
    /// Young's modulus E.
    #[declared(minimum = 1.0, maximum = 1e15, dimension = STRESS, default = "206 GPa")]
    pub youngs_modulus: f64,
    /// Poisson's ratio ν.
    #[declared(minimum = 0.0, maximum = 0.4999, default = "0.3")]
    pub poisson_ratio: f64,
    /// Density ρ.
    #[declared(minimum = 1.0, maximum = 1e5, dimension = DENSITY, default = "7830 kg/m^3")]
    pub density: f64,
}

impl Material {
    /// Steel as ISO 6336-1 has it: E = 206 GPa, ν = 0.3, ρ = 7830 kg/m³.
    pub const STEEL: Self = Self { youngs_modulus: 206e9, poisson_ratio: 0.3, density: 7830.0 };

    /// 1/E′ \[1/Pa\]: strain over stress along a free surface, (1 − ν²)/E in plane strain and 1/E in plane stress.
    #[must_use]
    pub fn plane_compliance(&self, plane: Plane) -> f64 {
        match plane {
            Plane::Strain => (1.0 - self.poisson_ratio * self.poisson_ratio) / self.youngs_modulus,
            Plane::Stress => 1.0 / self.youngs_modulus,
        }
    }

    /// ν′: what stands for ν in formulas of plane stress, ν/(1 − ν) in plane strain and ν in plane stress.
    #[must_use]
    pub fn plane_poisson_ratio(&self, plane: Plane) -> f64 {
        match plane {
            Plane::Strain => self.poisson_ratio / (1.0 - self.poisson_ratio),
            Plane::Stress => self.poisson_ratio,
        }
    }
}

/// Which plane state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum Plane {
    /// no strain along the width: wide faces
    #[default]
    Strain,
    /// no stress along the width: thin discs
    Stress,
}
