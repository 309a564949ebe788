//! Internal dynamic factor K_V: ISO 6336-1:2019, 6.5 (method B).
//!
//! The pair is a mass on the mean stiffness of the mesh; where its resonance is says how much deviations add to the load.
//! SI: stiffness per face width in Pa, mass per face width in kg/m. Must not know: where deviations and stiffness come from.

use std::f64::consts::{FRAC_PI_8, PI};

/// A disc or rim as table and formula (30) have it: of one density between the inner diameter and the mean of tip and root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rim {
    /// d_m \[m\]: mean of tip and root diameter.
    pub mean_diameter: f64,
    /// d_i \[m\].
    pub inner_diameter: f64,
    /// ρ \[kg/m³\].
    pub density: f64,
}

/// What of a gear is accelerated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Inertia {
    /// The rim alone; web and hub are nothing beside it.
    Rim(Rim),
    /// J* \[kg m²/m\]: moment of inertia per face width.
    PerWidth(f64),
}

/// m_red \[kg/m\], formulas (7), (8) and (30): reduced mass on the line of action, by pinion and wheel with their base radii \[m\].
///
/// Of a wheel's rim formula (30) takes u times the mean diameter of the pinion for its own.
#[must_use]
pub fn reduced_mass([pinion, wheel]: [Inertia; 2], base_radius: [f64; 2]) -> f64 {
    let ratio = base_radius[1] / base_radius[0];
    let of_rim = |rim: Rim, mean_diameter: f64, base_radius: f64| {
        let hollow = rim.inner_diameter / rim.mean_diameter;
        let mean_over_base = mean_diameter / (2.0 * base_radius);
        FRAC_PI_8
            * mean_over_base
            * mean_over_base
            * mean_diameter
            * mean_diameter
            * rim.density
            * (1.0 - hollow * hollow * hollow * hollow)
    };
    let own = match pinion {
        Inertia::Rim(rim) => of_rim(rim, rim.mean_diameter, base_radius[0]),
        Inertia::PerWidth(inertia) => inertia / (base_radius[0] * base_radius[0]),
    };
    let mates = match (wheel, pinion) {
        (Inertia::Rim(rim), Inertia::Rim(of_pinion)) => of_rim(rim, ratio * of_pinion.mean_diameter, base_radius[1]),
        (Inertia::Rim(rim), Inertia::PerWidth(_)) => of_rim(rim, rim.mean_diameter, base_radius[1]),
        (Inertia::PerWidth(inertia), _) => inertia / (base_radius[1] * base_radius[1]),
    };
    own * mates / (own + mates)
}

/// n_E1 \[rad/s\], formula (6): speed of the pinion of z1 teeth in resonance, by c_γα \[Pa\] and m_red \[kg/m\].
#[must_use]
pub fn resonance_speed(teeth: f64, mesh_stiffness: f64, reduced_mass: f64) -> f64 {
    (mesh_stiffness / reduced_mass).sqrt() / teeth
}

/// Where a pair runs, by N.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// N up to N_S.
    Subcritical,
    /// Up to 1.15.
    MainResonance,
    /// Up to 1.5.
    Intermediate,
    /// Above.
    Supercritical,
}

impl Range {
    /// As a word.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Subcritical => "subcritical",
            Self::MainResonance => "main resonance",
            Self::Intermediate => "intermediate",
            Self::Supercritical => "supercritical",
        }
    }
}

/// What K_V follows from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Running {
    /// N: speed over that of resonance.
    pub resonance_ratio: f64,
    /// F_t K_A/b \[N/m\].
    pub specific_load: f64,
    /// ε_γ.
    pub contact_ratio: f64,
    /// B_p, B_f, B_k: deviations of pitch and profile, and what relief leaves, over the deflection under the load.
    pub deviations: [f64; 3],
}

/// F_t K_A/b \[N/m\] below which the main resonance widens.
pub const LIGHT_LOAD: f64 = 100e3;
const MAIN_RESONANCE: f64 = 1.15;
const SUPERCRITICAL: f64 = 1.5;

/// N_S, formulas (11) and (12): the lower end of the main resonance.
#[must_use]
pub fn lower_limit(specific_load: f64) -> f64 {
    if specific_load < LIGHT_LOAD { 0.5 + 0.35 * (specific_load / LIGHT_LOAD).sqrt() } else { 0.85 }
}

/// C_v1 to C_v7, table 8.
#[must_use]
pub fn coefficients(contact_ratio: f64) -> [f64; 7] {
    let ratio = contact_ratio;
    let [second, third, fourth, sixth] = if ratio <= 2.0 {
        [0.34, 0.23, 0.90, 0.47]
    } else {
        [0.57 / (ratio - 0.3), 0.096 / (ratio - 1.56), (0.57 - 0.05 * ratio) / (ratio - 1.44), 0.12 / (ratio - 1.74)]
    };
    let seventh = if ratio <= 1.5 {
        0.75
    } else if ratio <= 2.5 {
        0.125 * libm::sin(PI * (ratio - 2.0)) + 0.875
    } else {
        1.0
    };
    [0.32, second, third, fourth, 0.47, sixth, seventh]
}

/// K_V, formulas (13) to (22), and where the pair runs.
#[must_use]
pub fn dynamic_factor(running: &Running) -> (f64, Range) {
    let [c1, c2, c3, c4, c5, c6, c7] = coefficients(running.contact_ratio);
    let [pitch, profile, relief] = running.deviations;
    let resonant = c1 * pitch + c2 * profile + c4 * relief + 1.0;
    let supercritical = c5 * pitch + c6 * profile + c7;
    let ratio = running.resonance_ratio;
    if ratio <= lower_limit(running.specific_load) {
        (ratio * (c1 * pitch + c2 * profile + c3 * relief) + 1.0, Range::Subcritical)
    } else if ratio <= MAIN_RESONANCE {
        (resonant, Range::MainResonance)
    } else if ratio < SUPERCRITICAL {
        let left = (SUPERCRITICAL - ratio) / (SUPERCRITICAL - MAIN_RESONANCE);
        (supercritical + (resonant - supercritical) * left, Range::Intermediate)
    } else {
        (supercritical, Range::Supercritical)
    }
}
