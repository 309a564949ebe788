//! ISO 6336-3:2019, clauses 6 and 7 (method B): nominal root stress of external spur gears.
//!
//! Of a rack the critical section has formulas; of a cutter the same section is found on the curve that it shapes.
//!
//! σ_F0 = F_t/(b m) Y_F Y_S with the load at the outer point of single pair tooth contact. The critical section is where the
//! tangents to the fillets stand at 30° to the tooth's centreline; Y_F is its bending stress, Y_S corrects for the notch. For
//! 1 ≤ q_s < 8 and ε_α < 2; Y_DT and f_ε are then 1, and Y_B is 1 since bores are held by their shafts. Profile shift is the
//! generating one. A grinding notch makes Y_S larger (7.3), wherever it lies above the critical section. Must not know: load
//! sharing, the tooth's elasticity.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, FRAC_PI_4, FRAC_PI_6};

use crate::gear::geometry::error::Plain;
use crate::gear::geometry::trochoid::Trochoid;
use crate::gear::geometry::{GearPair, Rack, Side, Specification};
use crate::numeric::crossing;

/// q_s for which Y_S is given.
const NOTCH: std::ops::Range<f64> = 1.0..8.0;
/// ε_α from which two pairs always share the load.
const DEEP_MESH: f64 = 2.0;
/// √(t_g/ρ_g) below which a grinding notch has a factor.
const SHARPEST_NOTCH: f64 = 2.0;
/// q up to which a curve is searched for its critical section.
const HIGHEST_PARAMETER: f64 = 4.0;
/// Steps of the iteration for θ; five are enough by the standard.
const STEPS: usize = 100;

/// A tooth as the standard needs it, lengths in modules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tooth {
    /// z (the virtual number z_n of a helical gear).
    pub teeth: f64,
    /// α_n \[rad\].
    pub pressure_angle: f64,
    /// x.
    pub profile_shift: f64,
    /// h_fP, ρ_fP and s_pr.
    pub rack: Rack,
    /// t_g/ρ_g: depth of the grinding notch over its radius; 0 without one.
    pub grinding_notch: f64,
    /// d_en/2: where the load acts.
    pub load_radius: f64,
}

/// The critical section and what follows from it, lengths in modules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// s_Fn: chord of the tooth.
    pub chord: f64,
    /// ρ_F: radius of the fillet.
    pub fillet_radius: f64,
    /// h_Fe: lever of the load.
    pub lever: f64,
    /// α_Fen: angle of the load to the normal of the centreline \[rad\].
    pub load_angle: f64,
    /// q_s: s_Fn/(2 ρ_F).
    pub notch: f64,
    /// Y_F.
    pub form_factor: f64,
    /// Y_S, or Y_Sg where there is a grinding notch.
    pub stress_correction_factor: f64,
}

/// Why the standard gives no stress.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Outside {
    /// The fillet has no tangent of 30°, or the load's line passes below the section.
    #[error("no critical section is found")]
    NoSection,
    /// q_s is not what Y_S is given for.
    #[error("the notch parameter q_s is {}, but must be {} to {}", Plain(*.0), Plain(NOTCH.start), Plain(NOTCH.end))]
    Notch(f64),
    /// √(t_g/ρ_g) is not what Y_Sg is given for.
    #[error("the grinding notch has √(t_g/ρ_g) = {}, but must have less than {}: a larger radius", Plain(*.0), Plain(SHARPEST_NOTCH))]
    GrindingNotch(f64),
    /// ε_α is 2 or more.
    #[error("the transverse contact ratio is {}, but must be below {}: no single pair carries all of the load", Plain(*.0), Plain(DEEP_MESH))]
    ContactRatio(f64),
}

/// The critical section of a tooth, Y_F and Y_S.
///
/// # Errors
/// When there is none, or the notch is outside the range of Y_S.
pub fn section(tooth: &Tooth) -> Result<Section, Outside> {
    let Tooth { teeth, pressure_angle, profile_shift, rack, load_radius, .. } = *tooth;
    let (sine, cosine) = libm::sincos(pressure_angle);
    let tangent = sine / cosine;
    let (dedendum, round) = (rack.dedendum, rack.tip_radius);
    let e = FRAC_PI_4 - dedendum * tangent + rack.residual_undercut() / cosine - (1.0 - sine) * round / cosine;
    let g = round - dedendum + profile_shift;
    let h = 2.0 / teeth * (FRAC_PI_2 - e) - FRAC_PI_3;
    let mut theta = FRAC_PI_6;
    for _ in 0..STEPS {
        theta = 2.0 * g / teeth * libm::tan(theta) - h;
    }
    let next = 2.0 * g / teeth * libm::tan(theta) - h;
    let cos_theta = libm::cos(theta);
    if !((next - theta).abs() < 1e-9 && cos_theta > 0.0) {
        return Err(Outside::NoSection);
    }
    let beside = g / cos_theta - round;
    let chord = teeth * libm::sin(FRAC_PI_3 - theta) + 3_f64.sqrt() * beside;
    let fillet_radius = round + 2.0 * g * g / (cos_theta * (teeth * cos_theta * cos_theta - 2.0 * g));
    // The load's angle at its radius, from the centreline's normal.
    let at_load = libm::acos(0.5 * teeth * cosine / load_radius);
    let half_thickness = (FRAC_PI_2 + 2.0 * tangent * profile_shift) / teeth + (tangent - pressure_angle)
        - (libm::tan(at_load) - at_load);
    let load_angle = at_load - half_thickness;
    let along = libm::cos(half_thickness) - libm::sin(half_thickness) * libm::tan(load_angle);
    let lever = 0.5 * (along * 2.0 * load_radius - teeth * libm::cos(FRAC_PI_3 - theta) - beside);
    factors(tooth, chord, fillet_radius, lever, load_angle)
}

/// The angle of the load \[rad\] and how far above the gear's centre it crosses the tooth's centreline \[modules\].
fn load_line(tooth: &Tooth) -> (f64, f64) {
    let Tooth { teeth, pressure_angle, profile_shift, load_radius, .. } = *tooth;
    let at_load = libm::acos(0.5 * teeth * libm::cos(pressure_angle) / load_radius);
    let tangent = libm::tan(pressure_angle);
    let half_thickness = (FRAC_PI_2 + 2.0 * tangent * profile_shift) / teeth + (tangent - pressure_angle)
        - (libm::tan(at_load) - at_load);
    let angle = at_load - half_thickness;
    (angle, 0.5 * teeth * libm::cos(pressure_angle) / libm::cos(angle))
}

/// The critical section of a tooth whose fillet is a curve in metres: of one that a cutter has shaped.
fn section_of_curve(tooth: &Tooth, curve: &Trochoid, module: f64) -> Result<Section, Outside> {
    // Its normal stands at 60° to the centreline. As in the formulas of the rack, it may lie above where an undercut ends the curve.
    let q = crossing::bracketed(0.0, HIGHEST_PARAMETER, |q| curve.rates(q).0 - FRAC_PI_6).ok_or(Outside::NoSection)?;
    let ([half_thickness, height], (_, rate, turning)) = (curve.point_at(q), curve.rates(q));
    let (load_angle, apex) = load_line(tooth);
    factors(tooth, 2.0 * half_thickness / module, rate / turning / module, apex - height / module, load_angle)
}

/// Y_F and Y_S of a critical section.
fn factors(tooth: &Tooth, chord: f64, fillet_radius: f64, lever: f64, load_angle: f64) -> Result<Section, Outside> {
    let Tooth { pressure_angle, grinding_notch, .. } = *tooth;
    let cosine = libm::cos(pressure_angle);
    if !(chord > 0.0 && fillet_radius > 0.0 && lever > 0.0) {
        return Err(Outside::NoSection);
    }
    let notch = chord / (2.0 * fillet_radius);
    if !NOTCH.contains(&notch) {
        return Err(Outside::Notch(notch));
    }
    let sharpness = grinding_notch.sqrt();
    if sharpness >= SHARPEST_NOTCH {
        return Err(Outside::GrindingNotch(sharpness));
    }
    let slenderness = chord / lever;
    Ok(Section {
        chord,
        fillet_radius,
        lever,
        load_angle,
        notch,
        form_factor: 6.0 * lever * libm::cos(load_angle) / (chord * chord * cosine),
        stress_correction_factor: (1.2 + 0.13 * slenderness)
            * libm::pow(notch, 1.0 / (1.21 + 2.3 / slenderness))
            * (1.3 / (1.3 - 0.6 * sharpness)),
    })
}

/// The critical section of a gear of a pair, loaded at its outer point of single pair contact.
///
/// # Errors
/// Outside the ranges of the standard's formulas.
pub fn critical_section(pair: &GearPair, side: Side) -> Result<Section, Outside> {
    if pair.contact_ratio >= DEEP_MESH {
        return Err(Outside::ContactRatio(pair.contact_ratio));
    }
    let gear = pair.side(side);
    let Specification { teeth, module, pressure_angle, rack, .. } = gear.specification;
    let profile_shift = gear.specification.generating_profile_shift();
    // Inside the end of the flank that works, along the line of action, by what is shared with another pair.
    let length = pair.highest_roll(side) * gear.base_radius - pair.base_pitch * (pair.contact_ratio - 1.0);
    let load_radius = libm::hypot(length, gear.base_radius) / module;
    let notch_depth = gear.generated().map_or(0.0, |generated| generated.notch_depth);
    let grinding_notch = if notch_depth > 0.0 { notch_depth / (module * rack.notch_radius) } else { 0.0 };
    let tooth = Tooth { teeth: f64::from(teeth), pressure_angle, profile_shift, rack, grinding_notch, load_radius };
    if gear.specification.cutter.is_some() {
        return section_of_curve(&tooth, &gear.trochoid(), module);
    }
    section(&tooth)
}

/// σ_F0 \[Pa\] of a gear of a pair under a torque on the pinion \[N m\], over the common face width.
///
/// # Errors
/// Outside the ranges of the standard's formulas.
pub fn nominal_root_stress(pair: &GearPair, side: Side, torque: f64) -> Result<f64, Outside> {
    let found = critical_section(pair, side)?;
    let tangential = torque / pair.pinion.reference_radius;
    let module = pair.side(side).specification.module;
    Ok(tangential / (pair.contact_width() * module) * found.form_factor * found.stress_correction_factor)
}

#[cfg(test)]
mod tests;
