//! The numbers that the program of Dias, Silva and Chui (Journal of the Brazilian Society of Mechanical Sciences and
//! Engineering 46 (2024) 10) prints for its pair, 27/35 with m 3 mm: teeth that end at the base circle, a body whose arm
//! counts from there, pairs that are summed. It prints the least or the mean of samples over one revolution, both ends of
//! it counted.

use super::super::energy::{Arm, Energy};
use super::{Assumptions, Method, SUMMED, mesh_stiffness};
use crate::gear::fixtures::STEEL;
use crate::gear::geometry::root::RootShape;
use crate::gear::geometry::{GearPair, Rack, Specification};

const TEETH: [u32; 2] = [27, 35];

/// Root radius m(z − 2.334)/2, a fifth of it as the bore.
fn pair() -> GearPair {
    let [pinion, gear] = TEETH.map(|teeth| Specification {
        teeth,
        module: 3e-3,
        pressure_angle: 20_f64.to_radians(),
        profile_shift: 0.0,
        thickness_allowance: 0.0,
        cutter: None,
        rack: Rack { addendum: 1.0, dedendum: 1.167, tip_radius: 0.2, ..Rack::ISO_53_A },
        tip_radius: None,
        face_width: 25e-3,
        bore_radius: 0.2 * 1.5e-3 * (f64::from(teeth) - 2.334),
        material: STEEL,
    });
    GearPair::new(pinion, gear, None).unwrap()
}

/// Mesh stiffness \[N/m\] at so many equidistant positions of the pinion, the first and the last one revolution apart.
fn sampled(arm: Arm, count: u32) -> Vec<f64> {
    let pair = pair();
    let assumptions = Assumptions { root: RootShape::BaseCircle, ..SUMMED };
    let tabulated = Energy { arm, ..Energy::default() }.tabulate(&pair, assumptions).unwrap();
    let steps = count - 1;
    let place = |step: u32| f64::from(step * TEETH[0] % steps) / f64::from(steps);
    (0..count)
        .map(|step| mesh_stiffness(&pair, &tabulated, pair.start_of_contact + place(step) * pair.base_pitch))
        .collect()
}

/// Tier: published values, every printed digit; 80 kW at 2000 rpm.
#[test]
fn samples_of_the_program_of_dias_have_its_least_and_mean_stiffness() {
    let load = 80e3 / (2000.0 * std::f64::consts::TAU / 60.0) / pair().pinion.base_radius;
    let of_1000 = sampled(Arm::ClampedEnd, 1000);
    let deflection = load / of_1000.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((deflection - 43.881e-6).abs() < 0.5e-9, "{deflection}");
    let of_400 = sampled(Arm::ClampedEnd, 400);
    let mean = of_400.iter().sum::<f64>() / 400.0;
    assert!((mean - 3.5405e8).abs() < 0.5e4, "{mean}");
    // The arm from the root circle, as the source of the formula has it, is longer: the body yields more.
    let from_root = sampled(Arm::RootCircle, 400).iter().sum::<f64>() / 400.0;
    assert!((from_root / mean - 0.9375).abs() < 0.002, "{from_root}");
}
