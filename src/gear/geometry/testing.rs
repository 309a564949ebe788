//! Gears that several tests use.

use super::{Pair, Rack, Specification};
use crate::gear::compliance::Material;

/// m 3, α 20°, 1/1.25/0.38, 20 mm wide, bore r_f/1.75, steel.
pub fn specification(teeth: u32, profile_shift: f64) -> Specification {
    let module = 3e-3;
    Specification {
        teeth,
        module,
        pressure_angle: 20_f64.to_radians(),
        profile_shift,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38 },
        tip_radius: None,
        face_width: 0.020,
        bore_radius: module * (0.5 * f64::from(teeth) - 1.25 + profile_shift) / 1.75,
        material: Material { youngs_modulus: 206e9, poisson_ratio: 0.3 },
    }
}

/// The pair of `energy_ga` with ρ_fP = c/(1 − sin α), as in the 40-digit reference.
pub fn pair_19_48(bore_ratio: f64) -> Pair {
    let gear = |teeth: u32, width: f64| {
        let mut gear = specification(teeth, 0.0);
        gear.rack.tip_radius = 0.25 / (1.0 - libm::sin(gear.pressure_angle));
        gear.face_width = width;
        gear.bore_radius *= 1.75 / bore_ratio;
        gear
    };
    Pair::new(gear(19, 0.020), gear(48, 0.018), None).unwrap()
}
