//! How unevenly a load spreads: face load factors K_Hβ and K_Fβ (ISO 6336-1:2019, 7, method C), transverse load factors K_Hα
//! and K_Fα (8, method B), and the gear blank factor C_R (9.3).
//!
//! SI: stiffness per face width in Pa, load per face width in N/m. Must not know: where deviations come from.

use super::conditions::Shaft;

/// K_Hβ, formulas (41) to (44): by F_βy \[m\], c_γβ \[Pa\] and F_m/b \[N/m\].
#[must_use]
pub fn face_load_factor(misalignment: f64, mesh_stiffness: f64, mean_load: f64) -> f64 {
    // Half of the gap that the mean load closes.
    let share = 0.5 * misalignment * mesh_stiffness / mean_load;
    // From 2 on, part of the face carries nothing.
    if share < 1.0 { 1.0 + share } else { 2.0 * share.sqrt() }
}

/// f_sh \[m\], formula (57): by F_m/b \[N/m\], b and d1 \[m\] of a pinion of a single mesh; without a shaft it sits in the middle.
#[must_use]
pub fn shaft_deflection(mean_load: f64, width: f64, diameter: f64, shaft: Option<&Shaft>) -> f64 {
    let bending = shaft.map_or(0.0, |shaft| {
        let slim = diameter / shaft.diameter;
        shaft.arrangement * shaft.span * shaft.offset / (diameter * diameter) * slim * slim * slim * slim
    });
    let slender = width / diameter;
    // 0.023 µm mm/N.
    mean_load * 0.023e-9 * ((1.0 + bending - 0.3).abs() + 0.3) * slender * slender
}

/// F_βx \[m\], formula (52) without helix modification: by f_sh and the f_Hβ of both gears \[m\], which add up as f_ma.
#[must_use]
pub fn equivalent_misalignment(shaft_deflection: f64, helix_slopes: [f64; 2], mean_load: f64) -> f64 {
    let [one, two] = helix_slopes;
    let least = (0.005e-9 * mean_load).max(0.5 * one.max(two));
    (1.33 * shaft_deflection + libm::hypot(one, two)).max(least)
}

/// K_Fβ, formulas (39) and (40): by K_Hβ and b/h, face width over tooth depth, the smaller one of both gears.
#[must_use]
pub fn root_face_load_factor(face_load_factor: f64, width_over_depth: f64) -> f64 {
    let ratio = width_over_depth.max(3.0);
    libm::pow(face_load_factor, ratio * ratio / (1.0 + ratio + ratio * ratio))
}

/// What K_Hα and K_Fα follow from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transverse {
    /// c_γα \[Pa\].
    pub mesh_stiffness: f64,
    /// f_pb − y_α \[m\].
    pub deviation: f64,
    /// F_tH/b \[N/m\].
    pub specific_load: f64,
    /// ε_α.
    pub contact_ratio: f64,
    /// ε_β; 0 for spur gears.
    pub overlap_ratio: f64,
    /// Z_ε.
    pub contact_ratio_factor: f64,
}

/// K_Hα and K_Fα, formulas (73) to (76): 1 at least, and no more than where one pair carries all of it.
#[must_use]
pub fn transverse_load_factors(given: &Transverse) -> [f64; 2] {
    let total = given.contact_ratio + given.overlap_ratio;
    let spread = given.mesh_stiffness * given.deviation / given.specific_load;
    let factor = if total <= 2.0 {
        0.5 * total * (0.9 + 0.4 * spread)
    } else {
        0.9 + 0.4 * (2.0 * (total - 1.0) / total).sqrt() * spread
    };
    let limits = [
        total / (given.contact_ratio * given.contact_ratio_factor * given.contact_ratio_factor),
        total / (0.25 * given.contact_ratio + 0.75),
    ];
    limits.map(|limit| factor.min(limit).max(1.0))
}

/// C_R, formula (85): of a rim on a web, by b_s/b, thickness of the web over face width, and s_R/m, that of the rim over module.
#[must_use]
pub fn blank_factor(web_over_width: f64, rim_over_module: f64) -> f64 {
    let (web, rim) = (web_over_width.clamp(0.2, 1.2), rim_over_module.max(1.0));
    1.0 + libm::log(web) / (5.0 * libm::exp(rim / 5.0))
}
