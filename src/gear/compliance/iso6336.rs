//! ISO 6336-1:2019, clause 9 (method B): single stiffness and mesh stiffness per face width, for relief presets.
//!
//! For standard basic rack teeth, x1 ≥ x2, −0.5 ≤ x1 + x2 ≤ 2, specific load ≥ 100 N/mm; steel on steel.
//! Must not know: the tooth's shape beyond teeth numbers and shifts. Results in SI, N/(m·m) = Pa:
//! 1 N/(mm µm) = 1e9 Pa.

/// What clause 9 asks of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inputs {
    /// z1, z2 (virtual numbers of teeth z_n for helical gears).
    pub teeth: [f64; 2],
    /// x1, x2.
    pub profile_shift: [f64; 2],
    /// h_fP \[modules\], of each gear's basic rack.
    pub dedendum: [f64; 2],
    /// α_P \[rad\].
    pub pressure_angle: f64,
    /// β \[rad\], on the reference cylinder.
    pub helix_angle: f64,
    /// ε_α.
    pub contact_ratio: f64,
}

/// The stiffnesses of clause 9 \[Pa\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// c′_th, theoretical single stiffness.
    pub theoretical: f64,
    /// c′, single stiffness: the largest of one pair of teeth.
    pub single: f64,
    /// c_γα, mean over the mesh.
    pub mesh: f64,
}

/// N/(mm µm) in Pa.
const PER_MILLIMETRE_AND_MICROMETRE: f64 = 1e9;
/// C_M: the part of the theoretical stiffness that is measured on solid gears.
const MEASURED_SHARE: f64 = 0.8;

/// Clause 9.3, with C_R = 1 (solid discs).
#[must_use]
pub fn stiffness(inputs: &Inputs) -> Stiffness {
    let [z1, z2] = inputs.teeth;
    let [x1, x2] = inputs.profile_shift;
    let flexibility = 0.047_23 + 0.155_51 / z1 + 0.257_91 / z2
        - 0.006_35 * x1
        - 0.116_54 * x1 / z1
        - 0.001_93 * x2
        - 0.241_88 * x2 / z2
        + 0.005_29 * x1 * x1
        + 0.001_82 * x2 * x2;
    let theoretical = PER_MILLIMETRE_AND_MICROMETRE / flexibility;
    let steepness = 1.0 - 0.02 * (20.0 - inputs.pressure_angle.to_degrees());
    let rack = |dedendum: f64| (1.0 + 0.5 * (1.2 - dedendum)) * steepness;
    let rack = 0.5 * (rack(inputs.dedendum[0]) + rack(inputs.dedendum[1]));
    let single = theoretical * MEASURED_SHARE * rack * libm::cos(inputs.helix_angle);
    Stiffness { theoretical, single, mesh: single * (0.75 * inputs.contact_ratio + 0.25) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: published value, ISO/TR 6336-30:2017, example 1.
    #[test]
    fn example_1_of_iso_tr_6336_30() {
        let helix = 15.8_f64.to_radians();
        // Virtual numbers of teeth, ISO 21771: z_n = z/(cos² β_b cos β).
        let base = libm::asin(libm::sin(helix) * 20f64.to_radians().cos());
        let virtual_teeth = |z: f64| z / (base.cos().powi(2) * helix.cos());
        let transverse = libm::atan(20f64.to_radians().tan() / helix.cos());
        let contact_ratio = contact_ratio(transverse);
        let found = stiffness(&Inputs {
            teeth: [virtual_teeth(17.0), virtual_teeth(103.0)],
            profile_shift: [0.145, 0.0],
            dedendum: [1.4; 2],
            pressure_angle: 20f64.to_radians(),
            helix_angle: helix,
            contact_ratio,
        });
        for (value, printed) in [(found.theoretical, 17.855_84), (found.single, 12.370_47), (found.mesh, 17.464_85)] {
            assert!((value * 1e-9 - printed).abs() < 6e-6, "{} for {printed}", value * 1e-9);
        }
    }

    /// m_n 8, z 17/103, a 500, tip diameters 159.66 and 872.35 of the same example.
    fn contact_ratio(transverse: f64) -> f64 {
        let module = 8.0 / 15.8_f64.to_radians().cos();
        let reference = [17.0, 103.0].map(|z| 0.5 * z * module);
        let tangent = [159.66, 872.35]
            .into_iter()
            .zip(reference)
            .map(|(tip, r): (f64, f64)| ((0.5 * tip).powi(2) - (r * transverse.cos()).powi(2)).sqrt());
        let sum = (reference[0] + reference[1]) * transverse.cos();
        let working = (500f64.powi(2) - sum * sum).sqrt();
        (tangent.sum::<f64>() - working) / (std::f64::consts::PI * module * transverse.cos())
    }
}
