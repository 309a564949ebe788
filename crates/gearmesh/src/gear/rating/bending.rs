//! Tooth bending strength beyond form and notch: ISO 6336-3:2019, method B.
//!
//! σ_F0 = F_t/(b m) Y_F Y_S Y_β Y_B Y_DT and σ_FG = σ_Flim Y_ST Y_NT Y_δrelT Y_RrelT Y_X. Y_β and Y_DT are 1 for spur gears
//! with ε_α up to 2.05. Lengths in m, stresses in Pa. The same formulas stand in IACS UR M56 (Rev.4 Corr.3, 2025), without
//! those for cast iron. Must not know: load factors.

use super::material::{MaterialClass, Surface};

const MICROMETRE: f64 = 1e-6;
/// q_s of the test gears whose strength σ_Flim is.
const TEST_NOTCH: f64 = 2.5;
/// Rim thickness over tooth depth below which there is no Y_B.
pub const THINNEST_RIM: f64 = 0.5;
/// R_z \[m\] for which Y_RrelT is given.
pub const ROUGHEST_ROOT: f64 = 40e-6;

/// Y_B, 9: of an external gear by s_R/h, rim thickness over tooth depth; none at 0.5 and below.
#[must_use]
pub fn rim_thickness_factor(rim_over_depth: f64) -> Option<f64> {
    if rim_over_depth >= 1.2 {
        Some(1.0)
    } else {
        (rim_over_depth > THINNEST_RIM).then(|| 1.6 * libm::log(2.242 / rim_over_depth))
    }
}

/// Strengths \[Pa\] and slip layers \[m\] of table 4, for those materials of which it depends on strength.
const STRUCTURAL: [(f64, f64); 2] = [(300e6, 0.0833e-3), (400e6, 0.0445e-3)];
const THROUGH_HARDENED: [(f64, f64); 4] =
    [(500e6, 0.0281e-3), (600e6, 0.0194e-3), (800e6, 0.0064e-3), (1000e6, 0.0014e-3)];
const CAST_IRON: [(f64, f64); 2] = [(150e6, 0.3124e-3), (300e6, 0.3095e-3)];

/// Which strength the slip layer of a material follows from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follows {
    /// None.
    Nothing,
    /// σ_S or σ_0.2.
    YieldStrength,
    /// σ_B.
    TensileStrength,
}

/// What [`slip_layer`] needs to know.
#[must_use]
pub const fn slip_layer_follows(class: MaterialClass) -> Follows {
    match class.surface() {
        Surface::Hard => Follows::Nothing,
        Surface::CastIron => Follows::TensileStrength,
        Surface::Soft => Follows::YieldStrength,
    }
}

/// ρ′ \[m\], table 4, by the strength that it follows from \[Pa\]; between values it is linear, beyond them the nearest one.
#[must_use]
pub fn slip_layer(class: MaterialClass, strength: f64) -> f64 {
    let among = |points: &[(f64, f64)]| {
        let (first, last) = (points[0], points[points.len() - 1]);
        let held = strength.clamp(first.0, last.0);
        let between = points.windows(2).find(|pair| held <= pair[1].0);
        between.map_or(last.1, |pair| {
            let share = (held - pair[0].0) / (pair[1].0 - pair[0].0);
            pair[0].1 + share * (pair[1].1 - pair[0].1)
        })
    };
    match class {
        MaterialClass::StructuralSteel => among(&STRUCTURAL),
        MaterialClass::ThroughHardenedSteel | MaterialClass::PearliticNodularIron | MaterialClass::MalleableIron => {
            among(&THROUGH_HARDENED)
        }
        MaterialClass::CaseHardenedSteel | MaterialClass::SurfaceHardenedSteel => 0.003e-3,
        MaterialClass::NitridedSteel | MaterialClass::NitrocarburizedSteel => 0.1005e-3,
        MaterialClass::GreyCastIron | MaterialClass::FerriticNodularIron => among(&CAST_IRON),
    }
}

/// Y_δrelT, 13: by q_s and ρ′ \[m\].
#[must_use]
pub fn notch_sensitivity_factor(notch: f64, slip_layer: f64) -> f64 {
    // Relative stress gradients χ* are in 1/mm.
    let effect = |notch: f64| 1.0 + (slip_layer * 1e3 * (1.0 + 2.0 * notch) / 5.0).sqrt();
    effect(notch) / effect(TEST_NOTCH)
}

/// Y_RrelT, 14: by R_z of the fillet \[m\]; none above 40 µm.
#[must_use]
pub fn surface_factor(class: MaterialClass, roughness: f64) -> Option<f64> {
    let rough = roughness / MICROMETRE;
    let smooth = rough < 1.0;
    let power = |exponent: f64| libm::pow(rough + 1.0, exponent);
    (roughness <= ROUGHEST_ROOT).then(|| match class {
        MaterialClass::StructuralSteel if smooth => 1.07,
        MaterialClass::StructuralSteel => 5.306 - 4.203 * power(0.01),
        MaterialClass::GreyCastIron
        | MaterialClass::FerriticNodularIron
        | MaterialClass::NitridedSteel
        | MaterialClass::NitrocarburizedSteel => {
            if smooth {
                1.025
            } else {
                4.299 - 3.259 * power(0.0058)
            }
        }
        _ if smooth => 1.12,
        _ => 1.674 - 0.529 * power(0.1),
    })
}

/// Y_X, 15: by the module \[m\].
#[must_use]
pub fn size_factor(class: MaterialClass, module: f64) -> f64 {
    let module = 1e3 * module;
    let (most, at_one, slope) = match class.surface() {
        Surface::Soft => (30.0, 1.03, 0.006),
        Surface::Hard => (25.0, 1.05, 0.01),
        Surface::CastIron => (25.0, 1.075, 0.015),
    };
    if module <= 5.0 { 1.0 } else { at_one - slope * module.min(most) }
}
