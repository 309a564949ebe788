//! Weber and Banaschek: a tooth as a cantilever of varying section in plane strain, clamped in a half plane, on a ring
//! that winds up.
//!
//! Source: Weber and Banaschek, Formänderung und Profilrücknahme bei gerad- und schrägverzahnten Rädern, 1953; also
//! Cornell, Journal of Mechanical Design 103 (1981) 447–459. With γ = α_1 the load angle, y_p the height above the clamped
//! end at which the load line crosses the centreline, s_f the chord of the clamped end:
//!
//! - tooth: cos²γ (1 − ν²)/E · {12 ∫(y_p − y)²/(2x)³ dy + [2.4/(1 − ν) + tan²γ] ∫dy/(2x)}, from the clamped end to y_p;
//! - body: cos²γ (1 − ν²)/E · {18/π (y_p/s_f)² + 2(1 − 2ν)/(1 − ν) y_p/s_f + 4.8/π [1 + (1 − ν)/2.4 tan²γ]};
//! - wind-up of the ring between bore and root circle: r_b²/(4πG)·(1/r_bore² − 1/r_f²).
//!
//! The arm cos γ (y_p − y) is r_b − y cos γ, so the tooth is the beam of `energy` with 1 − ν² on bending and compression
//! (2.4/(1 − ν) is a shear factor of 1.2 already), up to y_p: what lies between there and the flank is in the contact
//! law. Where the load line crosses the centreline below the joint of involute and root curve (low on the teeth of gears
//! with many teeth), or below the clamped end, the last bit is integrated along the involute continued downwards, so that
//! the tables stay smooth. The half plane does not move other teeth; the wind-up is a rotation of the whole gear and moves
//! all alike. Must not know: modification, load.

#[cfg(test)]
mod tests;

use std::f64::consts::PI;

use super::energy::Beam;
use super::{
    Assumptions, ComplianceError, Foreseen, Method, PairCompliance, ROUNDING, Tabulated, ToothCompliance, integrated,
    of_both,
};
use crate::gear::geometry::involute::Section;
use crate::gear::geometry::root::Root;
use crate::gear::geometry::{Gear, GearPair, Side};
use crate::gear::material::Plane;
use crate::gear::work::COMPLIANCE_EVALUATIONS;
use crate::numeric::chebyshev::Series;
use crate::numeric::crossing::bracketed;
use crate::numeric::surface::Surface;
use declare::Declared;
use declare::work::Work;

/// 2.4/(1 − ν) over what makes it a compliance in shear.
const SHEAR_FACTOR: f64 = 1.2;

/// Cantilever of varying section in plane strain, clamped in a half plane, on a ring that winds up.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "weber_banaschek")]
pub struct WeberBanaschek {}

impl Method for WeberBanaschek {
    fn tabulate(&self, pair: &GearPair, assumptions: Assumptions) -> Result<Tabulated, ComplianceError> {
        let mut warnings = Vec::new();
        let mut evaluations = 0;
        let side = |side| tabulate_side(pair, side, assumptions, &mut warnings, &mut evaluations);
        let [pinion, gear] = of_both(pair, side)?;
        let Assumptions { contact, coupled, .. } = assumptions;
        let compliance = PairCompliance { pinion, gear, contact: Some(contact), plane: Plane::Strain, coupled };
        let work = Work::of(&COMPLIANCE_EVALUATIONS, evaluations);
        Ok(Tabulated { compliance, warnings, error_estimate: ROUNDING, meshes: Vec::new(), work })
    }

    fn foresee(&self, assumptions: Assumptions) -> Foreseen {
        // Neighbours turn with the body: one number each.
        Foreseen { neighbours: 12, ..integrated(assumptions) }
    }
}

fn tabulate_side(
    pair: &GearPair,
    side: Side,
    assumptions: Assumptions,
    warnings: &mut Vec<String>,
    evaluations: &mut usize,
) -> Result<ToothCompliance, ComplianceError> {
    let gear = pair.side(side);
    let root = gear.root(assumptions.root).map_err(|error| ComplianceError::Root(error.on(side)))?;
    let (lower, upper) = (root.form_roll, gear.tip_roll());
    let unresolved = || ComplianceError::Unresolved { side, thickness: gear.tip_thickness() };
    // The lowest crossing belongs to the load that is square to the centreline, or to the lowest one.
    let lowest = crossing_roll(gear, lower.max(gear.half_base_angle));
    let beam = Beam::continued(gear, &root, SHEAR_FACTOR, lowest).ok_or_else(unresolved)?;
    let strain = plane_strain(gear);
    let body = Body::new(gear, &root);
    let series = Series::converged(lower, upper, |roll| {
        *evaluations += 1;
        let parts = beam.parts_below(crossing_roll(gear, roll), roll);
        [strain * parts.bending, parts.shear, strain * parts.axial, body.compliance(gear, roll), parts.contact_depth]
    });
    let [bending, shear, axial, own, contact_depth] = series.ok_or_else(unresolved)?;
    let count = if assumptions.coupled { super::neighbours(pair, side) } else { 0 };
    let neighbours =
        (0..count).map(|_| Surface::from_values([lower; 2], [upper; 2], [1, 1], &[body.wind_up])).collect();
    if body.is_shallow(gear) {
        let name = if side == Side::Pinion { "pinion" } else { "gear" };
        let [depth, chord] = [gear.root_radius - gear.specification.bore_radius, body.chord].map(|length| length * 1e3);
        warnings.push(format!(
            "{name}: the gear body under the tooth is taken for a half plane, but it is {depth:.3} mm deep and the tooth \
             {chord:.3} mm thick at its root"
        ));
    }
    Ok(ToothCompliance { bending, shear, axial, body: own, contact_depth, corner: 0.0, inclined: None, neighbours })
}

/// The roll angle of the section, on the involute or its continuation, at which the load line of a roll angle crosses
/// the centreline: height r_b/cos γ. NaN if there were none.
fn crossing_roll(gear: &Gear, roll: f64) -> f64 {
    let height = gear.base_radius / libm::cos(gear.load_angle(roll));
    bracketed(0.0, gear.apex_roll(), |section| gear.flank(section).height - height).unwrap_or(f64::NAN)
}

/// 1 − ν².
fn plane_strain(gear: &Gear) -> f64 {
    let nu = gear.specification.material.poisson_ratio;
    (1.0 - nu) * (1.0 + nu)
}

/// The body that a tooth is clamped in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Height of the clamped end above the gear's centre \[m\]: where the root curve touches the root circle, or, for a
    /// tooth without a root, where the involute begins.
    pub height: f64,
    /// s_f \[m\].
    pub chord: f64,
    /// Deflection along any tooth's load line per load on any tooth \[m/N\].
    pub wind_up: f64,
}

impl Body {
    /// The body of a gear whose teeth have this root, held at its bore.
    #[must_use]
    pub fn new(gear: &Gear, root: &Root) -> Self {
        let Section { half_thickness, height, .. } = root.clamped_end(gear);
        let material = gear.specification.material;
        let shear_modulus = material.youngs_modulus / (2.0 * (1.0 + material.poisson_ratio));
        let (bore, rim) = (gear.base_radius / gear.specification.bore_radius, gear.base_radius / gear.root_radius);
        let wind_up = (bore - rim) * (bore + rim) / (4.0 * PI * shear_modulus * gear.specification.face_width);
        Self { height, chord: 2.0 * half_thickness, wind_up }
    }

    /// Half plane and wind-up under the tooth's own load at a roll angle \[m/N\].
    #[must_use]
    pub fn compliance(&self, gear: &Gear, roll: f64) -> f64 {
        let (sine, cosine) = libm::sincos(gear.load_angle(roll));
        // cos γ y_p/s_f, and the squares of sine and cosine multiplied out: nothing is divided by cos γ.
        let arm = (gear.base_radius - self.height * cosine) / self.chord;
        let nu = gear.specification.material.poisson_ratio;
        let half_plane = 18.0 / PI * arm * arm
            + 2.0 * (1.0 - 2.0 * nu) / (1.0 - nu) * arm * cosine
            + 4.8 / PI * (cosine * cosine + (1.0 - nu) / 2.4 * sine * sine);
        let stretch = gear.specification.material.youngs_modulus * gear.specification.face_width;
        plane_strain(gear) / stretch * half_plane + self.wind_up
    }

    /// Whether the body, down to its bore, is less deep than the tooth is thick.
    fn is_shallow(&self, gear: &Gear) -> bool {
        gear.root_radius - gear.specification.bore_radius < self.chord
    }
}
