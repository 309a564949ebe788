//! Mesh stiffness by ISO 6336-1: c′_th, c′, c_γα. SI: N/m per m of face width; 1 N/(mm µm) = 1e9 N/m².
//!
//! Must not know: tooth sections.

/// What the formulas need of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input {
    /// z_n1, z_n2: teeth of the equivalent spur gears.
    pub teeth: [f64; 2],
    pub profile_shifts: [f64; 2],
    /// β \[rad\].
    pub helix_angle: f64,
    /// h_fP/m of the basic rack, the mean of both gears.
    pub dedendum: f64,
    /// α_Pn \[rad\].
    pub pressure_angle: f64,
    pub contact_ratio: f64,
}

/// Stiffnesses per face width \[N/m²\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// c′_th.
    pub theoretical: f64,
    /// c′: of one pair.
    pub single: f64,
    /// c_γα: mean of the mesh.
    pub mesh: f64,
}

/// Solid discs (C_R = 1) of steel.
#[must_use]
pub fn stiffness(input: &Input) -> Stiffness {
    let [z1, z2] = input.teeth;
    let [x1, x2] = input.profile_shifts;
    let compliance =
        0.04723 + 0.15551 / z1 + 0.25791 / z2 - 0.00635 * x1 - 0.11654 * x1 / z1 - 0.00193 * x2 - 0.24188 * x2 / z2
            + 0.00529 * x1 * x1
            + 0.00182 * x2 * x2;
    let theoretical = 1e9 / compliance;
    let degrees = input.pressure_angle.to_degrees();
    // C_B: basic rack factor; C_M = 0.8 corrects theory to measurement.
    let rack = (1.0 + 0.5 * (1.2 - input.dedendum)) * (1.0 - 0.02 * (20.0 - degrees));
    let single = theoretical * 0.8 * rack * libm::cos(input.helix_angle);
    Stiffness { theoretical, single, mesh: single * (0.75 * input.contact_ratio + 0.25) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published value: ISO/TR 6336-30 example 1 (m_n 8, z 17/103, x 0.145/0, β 15.8°, h_fP 1.4).
    #[test]
    fn the_standards_own_example_comes_out() {
        let beta = 15.8_f64.to_radians();
        let alpha = 20.0_f64.to_radians();
        // z_n = z/(cos² β_b cos β).
        let base = libm::asin(libm::sin(beta) * libm::cos(alpha));
        let equivalent = |z: f64| z / (libm::cos(base) * libm::cos(base) * libm::cos(beta));
        let with = |contact_ratio| {
            stiffness(&Input {
                teeth: [equivalent(17.0), equivalent(103.0)],
                profile_shifts: [0.145, 0.0],
                helix_angle: beta,
                dedendum: 1.4,
                pressure_angle: alpha,
                contact_ratio,
            })
        };
        let found = with(1.0);
        assert!((found.theoretical / 1e9 - 17.855_84).abs() < 5e-6, "{}", found.theoretical / 1e9);
        assert!((found.single / 1e9 - 12.370_47).abs() < 5e-6, "{}", found.single / 1e9);
        assert!((found.mesh - found.single).abs() < 1e-3);
        // 17.46485 is c_γα with the example's own contact ratio, (17.46485/12.37047 − 0.25)/0.75 = 1.54909.
        assert!((with(1.549_09).mesh / 1e9 - 17.464_85).abs() < 1e-4);
    }
}
