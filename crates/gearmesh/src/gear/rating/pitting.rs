//! Surface durability: ISO 6336-2:2019, method B.
//!
//! σ_H0 = Z_H Z_E Z_ε Z_β √(F_t/(d1 b) (u + 1)/u) at the pitch point; Z_B and Z_D take it to the inner points of single pair
//! contact of pinion and wheel. Formulas that hold for helical gears are given so; lengths in m, stresses in Pa, angles in
//! rad. The same formulas stand in IACS UR M56 (Rev.4 Corr.3, 2025). Must not know: load factors.

use std::f64::consts::{PI, TAU};

use crate::gear::material::Material;

const MICROMETRE: f64 = 1e-6;
const MEGAPASCAL: f64 = 1e6;
/// σ_Hlim \[Pa\] between which C_ZL and C_ZR change.
const STRENGTHS: [f64; 2] = [850e6, 1200e6];

/// Z_H, 6.1: by α_wt, α_t and β_b.
#[must_use]
pub fn zone_factor(working_angle: f64, transverse_angle: f64, base_helix_angle: f64) -> f64 {
    let cosine = libm::cos(transverse_angle);
    (2.0 * libm::cos(base_helix_angle) / (cosine * cosine * libm::tan(working_angle))).sqrt()
}

/// What Z_B and Z_D follow from: the usable flanks of pinion and wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingleContact {
    /// z1, z2.
    pub teeth: [f64; 2],
    /// √(d_Na²/d_b² − 1): roll angle up to which the flank works, that of its tip usable circle.
    pub tip_roll: [f64; 2],
    /// α_wt.
    pub working_angle: f64,
    /// ε_α, above 1 and below 2.
    pub contact_ratio: f64,
    /// ε_β.
    pub overlap_ratio: f64,
}

/// Z_B and Z_D, 6.2: 1 at least.
#[must_use]
pub fn single_contact_factors(given: &SingleContact) -> [f64; 2] {
    let [first, second] = given.teeth.map(|teeth| TAU / teeth);
    let [pinion, wheel] = given.tip_roll;
    let beyond = given.contact_ratio - 1.0;
    let tangent = libm::tan(given.working_angle);
    let inner = [
        tangent / ((pinion - first) * (wheel - beyond * second)).sqrt(),
        tangent / ((wheel - second) * (pinion - beyond * first)).sqrt(),
    ];
    let overlap = given.overlap_ratio.min(1.0);
    inner.map(|factor| if factor > 1.0 { factor - overlap * (factor - 1.0) } else { 1.0 })
}

/// Z_E \[√Pa\], 7.
#[must_use]
pub fn elasticity_factor(materials: [&Material; 2]) -> f64 {
    let give = |material: &Material| (1.0 - material.poisson_ratio * material.poisson_ratio) / material.youngs_modulus;
    (1.0 / (PI * (give(materials[0]) + give(materials[1])))).sqrt()
}

/// Z_ε, 8.
#[must_use]
pub fn contact_ratio_factor(contact_ratio: f64, overlap_ratio: f64) -> f64 {
    let overlap = overlap_ratio.min(1.0);
    ((4.0 - contact_ratio) / 3.0 * (1.0 - overlap) + overlap / contact_ratio).sqrt()
}

/// Z_β, 9: by β.
#[must_use]
pub fn helix_angle_factor(helix_angle: f64) -> f64 {
    1.0 / libm::cos(helix_angle).sqrt()
}

/// σ_H0 \[Pa\], 5, over the four factors Z: by F_t \[N\], d1 and b \[m\], and u.
#[must_use]
pub fn contact_load(tangential: f64, diameter: f64, width: f64, ratio: f64) -> f64 {
    (tangential / (diameter * width) * (ratio + 1.0) / ratio).sqrt()
}

/// The lubricant film, 12: what its three factors follow from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// σ_Hlim of the softer gear \[Pa\].
    pub strength: f64,
    /// ν40 \[m²/s\].
    pub viscosity: f64,
    /// v \[m/s\].
    pub velocity: f64,
    /// R_z of both flanks \[m\].
    pub roughness: [f64; 2],
    /// ρ_red \[m\] at the pitch point.
    pub curvature_radius: f64,
}

impl Film {
    fn between(&self, soft: f64, hard: f64, of: impl Fn(f64) -> f64) -> f64 {
        if self.strength < STRENGTHS[0] {
            soft
        } else if self.strength > STRENGTHS[1] {
            hard
        } else {
            of(self.strength / MEGAPASCAL)
        }
    }

    fn lubricant(&self) -> f64 {
        self.between(0.83, 0.91, |strength| strength / 4375.0 + 0.6357)
    }

    /// Z_L.
    #[must_use]
    pub fn lubricant_factor(&self) -> f64 {
        let (least, thin) = (self.lubricant(), 1.2 + 134.0 * MICROMETRE / self.viscosity);
        least + 4.0 * (1.0 - least) / (thin * thin)
    }

    /// Z_V.
    #[must_use]
    pub fn velocity_factor(&self) -> f64 {
        let least = self.lubricant() + 0.02;
        least + 2.0 * (1.0 - least) / (0.8 + 32.0 / self.velocity).sqrt()
    }

    /// Z_R.
    #[must_use]
    pub fn roughness_factor(&self) -> f64 {
        let mean = 0.5 * (self.roughness[0] + self.roughness[1]) / MICROMETRE;
        let relative = mean * libm::cbrt(10e-3 / self.curvature_radius);
        libm::pow(3.0 / relative, self.between(0.15, 0.08, |strength| 0.32 - 0.0002 * strength))
    }

    /// Z_W, 13, of a wheel of structural or through-hardened steel or nodular iron with hardness HB that runs with a surface-hardened
    /// pinion; roughness is that of pinion and wheel, in this order. Not below 1, as UR M56 has it.
    #[must_use]
    pub fn work_hardening_factor(&self, hardness: f64) -> f64 {
        let [pinion, wheel] = self.roughness;
        let polished = libm::pow(10e-3 / self.curvature_radius, 0.33) * libm::pow(pinion / wheel, 0.66)
            / libm::pow(self.viscosity / MICROMETRE * self.velocity / 1500.0, 0.33);
        let rough = (pinion / MICROMETRE * polished).clamp(3.0, 16.0);
        let harder = 1.2 - (hardness.clamp(130.0, 470.0) - 130.0) / 1700.0;
        (harder * libm::pow(3.0 / rough, 0.15)).max(1.0)
    }
}

/// Z_W, 13, of the wheel where both are through-hardened: by HB1/HB2 and u.
#[must_use]
pub fn through_hardened_factor(hardness_ratio: f64, ratio: f64) -> f64 {
    let ratio = ratio.min(20.0);
    if hardness_ratio < 1.2 {
        1.0
    } else if hardness_ratio <= 1.7 {
        1.0 + (0.008_98 * hardness_ratio - 0.008_29) * (ratio - 1.0)
    } else {
        1.0 + 0.006_98 * (ratio - 1.0)
    }
}
