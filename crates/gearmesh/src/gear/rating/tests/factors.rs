//! Factors one by one: what others print, closed forms, where curves meet.

use super::*;
use crate::gear::geometry::Side;
use crate::gear::rating::bending::{
    notch_sensitivity_factor, rim_thickness_factor, size_factor, slip_layer, surface_factor,
};
use crate::gear::rating::conditions::Shaft;
use crate::gear::rating::distribution::{
    Transverse, blank_factor, face_load_factor, root_face_load_factor, shaft_deflection, transverse_load_factors,
};
use crate::gear::rating::dynamic::{
    Inertia, Range, Rim, Running, coefficients, dynamic_factor, lower_limit, reduced_mass, resonance_speed,
};
use crate::gear::rating::life::{contact_factor, root_factor};
use crate::gear::rating::pitting::{Film, through_hardened_factor};
use crate::gear::rating::rate;
use crate::gear::rating::running_in::{Deviation, allowance, mean, tip_relief};
use declare::declared::Words;

const ALL: [MaterialClass; 10] = [
    MaterialClass::StructuralSteel,
    MaterialClass::ThroughHardenedSteel,
    MaterialClass::CaseHardenedSteel,
    MaterialClass::SurfaceHardenedSteel,
    MaterialClass::NitridedSteel,
    MaterialClass::NitrocarburizedSteel,
    MaterialClass::GreyCastIron,
    MaterialClass::FerriticNodularIron,
    MaterialClass::PearliticNodularIron,
    MaterialClass::MalleableIron,
];

/// Tier: closed form; Z_B² and Z_D² are the products of both radii of curvature at the pitch point over those at the inner point of
/// single contact, B of the pinion and D of the wheel, where contact is as long as tips let it and where undercut ends it.
#[test]
fn single_contact_factors_are_those_of_the_path_of_contact() {
    for (teeth, is_curtailed) in [([19, 24], false), ([12, 40], true), ([13, 17], true)] {
        let [pinion, wheel] = teeth.map(|teeth| gear(teeth, 3e-3, 0.0, 20e-3, 5e-3));
        let pair = pair(pinion, wheel);
        assert_eq!(pair.is_curtailed(Side::Pinion) || pair.is_curtailed(Side::Gear), is_curtailed);
        let rated = rate(&pair, 50.0, 100.0, &without_load_factors()).unwrap();
        let points = pair.zone_points();
        let product = |s: f64| s * (pair.tangent_length - s);
        for (gear, s) in rated.gears.iter().zip([points.b, points.d]) {
            near(gear.single_contact_factor, (product(points.c) / product(s)).sqrt().max(1.0), 1e-12);
        }
    }
}

/// Tier: second program; `__dynamic_factor_from_range` of a Python port of gfsReboucas/Drivetrain (GitHub) for c′ 14, f_pb,eff 7,
/// f_fα,eff 8 and C_a 20 at 400 N/mm, and others, in every range.
#[test]
fn the_dynamic_factor_of_another_program() {
    let running = |ratio: f64, stiffness: f64, [pitch, profile, relief]: [f64; 3], load: f64, speed: f64| Running {
        resonance_ratio: speed,
        specific_load: 1e3 * load,
        contact_ratio: ratio,
        deviations: [stiffness * pitch / load, stiffness * profile / load, (1.0 - stiffness * relief / load).abs()],
    };
    let off = [7.0, 8.0, 20.0];
    let light = [7.0, 8.0, 2.0];
    let helical = [8.6, 13.0, 70.0];
    for (given, theirs, range) in [
        (running(1.6, 14.0, off, 400.0, 0.3), 1.072_78, Range::Subcritical),
        (running(1.6, 14.0, off, 400.0, 1.0), 1.4436, Range::MainResonance),
        (running(1.6, 14.0, off, 400.0, 1.3), 1.254_714_829_484_188, Range::Intermediate),
        (running(1.6, 14.0, off, 400.0, 2.0), 1.002_867_935_463_105_8, Range::Supercritical),
        (running(1.6, 14.0, light, 60.0, 0.7), 1.896, Range::Subcritical),
        (running(1.6, 14.0, light, 60.0, 0.9), 2.637_333_333_333_333_3, Range::MainResonance),
        (running(2.63, 12.37, helical, 1273.5, 0.04), 1.003_453_529_486_734, Range::Subcritical),
        (running(2.3, 12.37, helical, 500.0, 1.6), 1.145_044_775_725_439_8, Range::Supercritical),
    ] {
        let (found, where_it_runs) = dynamic_factor(&given);
        near(found, theirs, 1e-12);
        assert_eq!(where_it_runs, range);
    }
}

/// Tier: closed form; the ranges meet where table 8 and formula (22) have them meet, N_S at 100 N/mm.
#[test]
fn the_ranges_of_the_dynamic_factor_meet() {
    let at = |resonance_ratio: f64| {
        let deviations = [0.4, 0.3, 0.5];
        dynamic_factor(&Running { resonance_ratio, specific_load: 300e3, contact_ratio: 1.7, deviations }).0
    };
    for corner in [1.15, 1.5] {
        near(at(corner - 1e-9), at(corner + 1e-9), 1e-7);
    }
    near(lower_limit(100e3 * (1.0 - 1e-12)), 0.85, 1e-9);
    near(lower_limit(0.0), 0.5, 0.0);
    // C_v7 rises from 0.75 to 1.
    for (ratio, seventh) in [(1.2, 0.75), (1.5 + 1e-9, 0.75), (2.0, 0.875), (2.5, 1.0), (3.0, 1.0)] {
        near(coefficients(ratio)[6], seventh, 1e-9);
    }
    // What changes its formula at 2 jumps there in the standard, C_v4 by 7 %.
    let [below, above] = [coefficients(2.0), coefficients(2.0 + 1e-12)];
    for (a, b) in below.into_iter().zip(above) {
        assert!((a / b - 1.0).abs() < 0.08, "{a} {b}");
    }
}

/// Tier: closed form; two discs whose sizes are those of their teeth: formula (30) is that of their moments of inertia, and a wheel
/// without end leaves the pinion's mass. And published: a helical pair of FVA's workbench, as tkuhn39/semesterthesis (GitHub) has it,
/// with 0.0074 kg/mm.
#[test]
fn reduced_masses() {
    let rim = |mean_diameter: f64, inner_diameter: f64| Rim { mean_diameter, inner_diameter, density: 7800.0 };
    let disc = |rim: Rim| {
        let [outer, inner] = [rim.mean_diameter, rim.inner_diameter].map(|diameter| diameter.powi(4));
        Inertia::PerWidth(std::f64::consts::PI / 32.0 * rim.density * (outer - inner))
    };
    let (small, large) = (rim(60e-3, 20e-3), rim(150e-3, 50e-3));
    let radii = [28e-3, 70e-3];
    let by_rims = reduced_mass([Inertia::Rim(small), Inertia::Rim(large)], radii);
    near(reduced_mass([disc(small), disc(large)], radii) / by_rims, 1.0, 1e-12);
    near(reduced_mass([Inertia::Rim(small), disc(large)], radii) / by_rims, 1.0, 1e-12);
    near(reduced_mass([disc(small), Inertia::Rim(large)], radii) / by_rims, 1.0, 1e-12);
    let alone = disc(small);
    let Inertia::PerWidth(inertia) = alone else { panic!("it is one") };
    near(reduced_mass([alone, Inertia::PerWidth(1e12)], radii) * radii[0] * radii[0] / inertia, 1.0, 1e-9);
    let helical = [rim(53.628e-3, 0.0), rim(85.277e-3, 0.0)].map(Inertia::Rim);
    near(reduced_mass(helical, [0.5 * 49.617e-3, 0.5 * 79.387e-3]), 7.4, 0.05);
    // One mesh a tooth: z1 n1 in resonance is what the mass swings with on the mesh's stiffness.
    near(resonance_speed(25.0, 17.21e9, 7.4) * 25.0, (17.21e9_f64 / 7.4).sqrt(), 1e-6);
}

/// Tier: closed form; 7, method C: the two formulas meet at 2, where the load just reaches over the whole face, and the tangents too.
#[test]
fn face_load_factors_meet_where_the_face_is_just_covered() {
    let at = |misalignment: f64| face_load_factor(misalignment, 15e9, 300e3);
    near(at(40e-6), 2.0, 1e-12);
    near((at(40e-6 + 1e-12) - at(40e-6)) / (at(40e-6) - at(40e-6 - 1e-12)), 1.0, 1e-3);
    near(at(0.0), 1.0, 0.0);
    // Narrow faces count as three times as wide as their teeth are deep: N_F = 9/13.
    near(root_face_load_factor(1.5, 2.0), 1.5_f64.powf(9.0 / 13.0), 1e-12);
    // A pinion in the middle between its bearings does not lean; one beside it does, by K′ l s/d² (d/d_sh)⁴.
    let shaft = |offset| Shaft { arrangement: 0.48, span: 200e-3, offset, diameter: 40e-3 };
    let of = |shaft: &Shaft| shaft_deflection(300e3, 30e-3, 50e-3, Some(shaft));
    near(of(&shaft(0.0)), shaft_deflection(300e3, 30e-3, 50e-3, None), 1e-20);
    let more = 0.48 * 200.0 * 20.0 / 2500.0 * 1.25_f64.powi(4);
    near(of(&shaft(20e-3)) / of(&shaft(0.0)), 1.0 + more, 1e-12);
}

/// Tier: closed form; at the limits of K_Hα and K_Fα one pair carries all: the stresses are those with Z_ε and Y_ε taken back.
#[test]
fn transverse_load_factors_stay_within_their_limits() {
    let factors = |deviation: f64, contact_ratio: f64, overlap_ratio: f64| {
        transverse_load_factors(&Transverse {
            mesh_stiffness: 20e9,
            deviation,
            specific_load: 200e3,
            contact_ratio,
            overlap_ratio,
            contact_ratio_factor: ((4.0 - contact_ratio) / 3.0_f64).sqrt(),
        })
    };
    assert_eq!(factors(0.0, 1.6, 0.0).map(f64::to_bits), [1.0_f64.to_bits(); 2]);
    let [contact, root] = factors(1e-3, 1.6, 0.0);
    near(contact, 3.0 / (4.0 - 1.6), 1e-12);
    near(root, 1.6 / (0.25 * 1.6 + 0.75), 1e-12);
    // Between: ε_γ/2 (0.9 + 0.4 c_γα f/(F_tH/b)) with 20·10/200 = 1; above ε_γ = 2 the other formula, which meets it there.
    near(factors(10e-6, 1.9, 0.0)[1], (0.95_f64 * 1.3).min(1.9 / 1.225), 1e-12);
    near(factors(10e-6, 1.6, 0.4)[1], 1.3, 1e-12);
    near(factors(10e-6, 1.6, 0.4 + 1e-12)[1], 1.3, 1e-9);
}

/// Tier: closed form; C_R of a web as wide as the face is 1; as figure 14 of the standard has it, 0.74 is the least of thin rims on thin
/// webs, and rims of many modules are as stiff as solid.
#[test]
fn blank_factors() {
    near(blank_factor(1.0, 2.0), 1.0, 0.0);
    near(blank_factor(0.2, 1.0), 1.0 + 0.2_f64.ln() / (5.0 * 0.2_f64.exp()), 1e-15);
    near(blank_factor(0.05, 0.3), blank_factor(0.2, 1.0), 0.0);
    near(blank_factor(0.2, 1.0), 0.74, 5e-3);
    assert!(blank_factor(0.2, 15.0) > 0.98 && blank_factor(5.0, 3.0) <= blank_factor(1.2, 3.0));
}

/// Tier: published; the caps of y_α and y_β that the standard prints: 12 800/σ_Hlim and 6400/σ_Hlim, 25 600 and 12 800, 22 and 11,
/// 45 and 22, 3 and 6 µm.
#[test]
fn running_in_is_capped() {
    let soft = |which, deviation, velocity| {
        1e6 * allowance(which, MaterialClass::ThroughHardenedSteel, Some(800e6), deviation, velocity).unwrap()
    };
    let of = |class, which, velocity| 1e6 * allowance(which, class, None, 900e-6, velocity).unwrap();
    let (transverse, helix) = (Deviation::Transverse, Deviation::Helix);
    for (velocity, caps) in [(4.0, [180.0, 360.0]), (8.0, [16.0, 32.0]), (12.0, [8.0, 16.0])] {
        near(soft(transverse, 900e-6, velocity), caps[0], 1e-9);
        near(soft(helix, 900e-6, velocity), caps[1], 1e-9);
    }
    for (velocity, caps) in [(8.0, [22.0, 45.0]), (12.0, [11.0, 22.0])] {
        near(of(MaterialClass::GreyCastIron, transverse, velocity), caps[0], 1e-9);
        near(of(MaterialClass::GreyCastIron, helix, velocity), caps[1], 1e-9);
    }
    near(of(MaterialClass::NitridedSteel, transverse, 1.0), 3.0, 1e-9);
    near(of(MaterialClass::CaseHardenedSteel, helix, 1.0), 6.0, 1e-9);
    // Nothing runs in by more than it is off, and unlike gears by the mean of both.
    let weak = allowance(helix, MaterialClass::StructuralSteel, Some(200e6), 10e-6, 1.0);
    near(weak.unwrap(), 10e-6, 0.0);
    let both = [(MaterialClass::ThroughHardenedSteel, Some(800e6)), (MaterialClass::CaseHardenedSteel, None)];
    near(mean(transverse, both, 20e-6, 1.0).unwrap() * 1e6, 0.5 * (4.0 + 1.5), 1e-9);
    assert_eq!(allowance(transverse, MaterialClass::MalleableIron, None, 20e-6, 1.0), None);
    // C_ay is least at 97·18.45 N/mm².
    near(tip_relief(97.0 * 18.45e6) * 1e6, 1.5, 1e-9);
    near(tip_relief(1500e6) * 1e6, 1.995_4, 5e-5);
}

/// Tier: second program; the tables of Y_NT in python-gearbox 0.1.2 (PyPI), read from the charts of the standard: to 4 %. And published:
/// Z_NT of a case-hardened pair in a report of KISSsoft 03/2017, 1.008 after 4.5e7 and 0.982 after 9.0e7 load cycles, as
/// hakangunes258/mekanika (GitHub, `Iso6336LifeFactors.cs`) quotes it.
#[test]
fn life_factors_of_other_programs() {
    const CYCLES: [f64; 9] = [1e3, 1e4, 1e5, 1e6, 3e6, 1e7, 1e8, 1e9, 1e10];
    for (class, theirs) in [
        (MaterialClass::ThroughHardenedSteel, [2.5, 2.5, 1.79, 1.2, 1.0, 0.98, 0.94, 0.895, 0.85]),
        (MaterialClass::CaseHardenedSteel, [2.5, 1.97, 1.53, 1.15, 1.0, 0.98, 0.94, 0.895, 0.85]),
        (MaterialClass::NitridedSteel, [1.6, 1.4, 1.21, 1.07, 1.0, 0.98, 0.94, 0.895, 0.85]),
        (MaterialClass::NitrocarburizedSteel, [1.1, 1.07, 1.05, 1.01, 1.0, 0.98, 0.94, 0.895, 0.85]),
    ] {
        for (cycles, theirs) in CYCLES.into_iter().zip(theirs) {
            near(root_factor(class, 0.85, cycles) / theirs, 1.0, 0.04);
        }
        for (cycles, theirs) in [CYCLES[0], 3e6, 1e10].into_iter().zip([theirs[0], 1.0, 0.85]) {
            near(root_factor(class, 0.85, cycles), theirs, 1e-12);
        }
    }
    let hard = |cycles| contact_factor(MaterialClass::CaseHardenedSteel, Pitting::None, 0.85, cycles);
    near(hard(4.5e7), 1.008, 5e-4);
    near(hard(9.0e7), 0.982, 5e-4);
    let pitted = |cycles| contact_factor(MaterialClass::CaseHardenedSteel, Pitting::Limited, 0.85, cycles);
    for (cycles, factor) in [(1e5, 1.6), (6e5, 1.6), (1e7, 1.3), (1e9, 1.0), (1e10, 0.85), (1e12, 0.85)] {
        near(pitted(cycles), factor, 1e-12);
    }
    near(contact_factor(MaterialClass::GreyCastIron, Pitting::Limited, 1.0, 1e9), 1.0, 1e-12);
    near(contact_factor(MaterialClass::GreyCastIron, Pitting::None, 0.85, 1e4), 1.3, 1e-12);
}

/// Tier: published; a helical pair of FVA's workbench, as tkuhn39/semesterthesis (GitHub) has it: Z_L 1.047, Z_V 0.995, Z_R 0.854,
/// Y_RrelT 0.915 for 36 µm and Y_δrelT 0.996 for q_s 2.072.
#[test]
fn strengths_of_a_helical_pair_of_the_workbench() {
    let tangent = 21.173_f64.to_radians().tan();
    let [one, two] = [49.617e-3, 79.387e-3].map(|base: f64| 0.5 * base * tangent);
    let film = Film {
        strength: 1500e6,
        viscosity: 318e-6,
        velocity: 8.33,
        roughness: [18e-6; 2],
        curvature_radius: one * two / (one + two),
    };
    near(film.curvature_radius * 1e3, 5.91, 5e-3);
    near(film.lubricant_factor(), 1.047, 5e-4);
    near(film.velocity_factor(), 0.995, 5e-4);
    near(film.roughness_factor(), 0.854, 5e-4);
    let class = MaterialClass::CaseHardenedSteel;
    near(surface_factor(class, 36e-6).unwrap(), 0.915, 5e-4);
    near(notch_sensitivity_factor(2.072, slip_layer(class, 0.0)), 0.996, 5e-4);
}

/// Tier: closed form; each curve where the standard pins it: test gears have R_z 10 µm and q_s 2.5, sizes count from module 5, and
/// strengths of lubricants meet at 850 and 1200 N/mm².
#[test]
fn factors_are_1_for_the_test_gears() {
    for class in ALL {
        near(surface_factor(class, 10e-6).unwrap(), 1.0, 6e-3);
        near(notch_sensitivity_factor(2.5, slip_layer(class, 300e6)), 1.0, 0.0);
        near(size_factor(class, 5e-3), 1.0, 0.0);
        near(size_factor(class, 5e-3 + 1e-12), 1.0, 1e-9);
        near(size_factor(class, 0.1), size_factor(class, 30e-3), 0.0);
        // The curve for smooth fillets begins where that of rough ones ends, to the digits that the standard has.
        near(surface_factor(class, 1e-6 - 1e-12).unwrap(), surface_factor(class, 1e-6).unwrap(), 0.013);
        assert_eq!(surface_factor(class, 40.001e-6), None, "{}", class.word());
    }
    let [soft, hard, cast] =
        [MaterialClass::StructuralSteel, MaterialClass::NitridedSteel, MaterialClass::GreyCastIron];
    near(size_factor(soft, 30e-3), 0.85, 1e-12);
    near(size_factor(hard, 25e-3), 0.80, 1e-12);
    near(size_factor(cast, 25e-3), 0.70, 1e-12);
    // Table 4, and between two of its rows.
    for (class, strength, layer) in [
        (soft, 300e6, 0.0833),
        (soft, 350e6, 0.0639),
        (soft, 900e6, 0.0445),
        (MaterialClass::ThroughHardenedSteel, 500e6, 0.0281),
        (MaterialClass::PearliticNodularIron, 700e6, 0.0129),
        (MaterialClass::MalleableIron, 1000e6, 0.0014),
        (cast, 150e6, 0.3124),
        (MaterialClass::FerriticNodularIron, 300e6, 0.3095),
        (hard, 0.0, 0.1005),
        (MaterialClass::SurfaceHardenedSteel, 0.0, 0.003),
    ] {
        near(slip_layer(class, strength) * 1e3, layer, 1e-12);
    }
    near(rim_thickness_factor(1.2).unwrap(), 1.0, 0.0);
    near(rim_thickness_factor(1.2 - 1e-9).unwrap(), 1.0, 1e-4);
    near(rim_thickness_factor(0.5 + 1e-12).unwrap(), 1.6 * (2.0_f64 * 2.242).ln(), 1e-9);
    assert_eq!(rim_thickness_factor(0.5), None);
}

/// Tier: closed form; 12 and 13: where C_ZL and C_ZR change their formula they do not jump; the hardness of the wheel counts from 130 to
/// 470 HB, and a pinion as smooth as can be leaves the first factor alone.
#[test]
fn films_and_work_hardening() {
    let film = |strength: f64, viscosity: f64, rough: f64| Film {
        strength,
        viscosity,
        velocity: 10.0,
        roughness: [rough; 2],
        curvature_radius: 10e-3,
    };
    for strength in [850e6, 1200e6] {
        let [below, above] = [strength - 1.0, strength + 1.0].map(|strength| film(strength, 100e-6, 6e-6));
        near(below.lubricant_factor(), above.lubricant_factor(), 1e-4);
        near(below.velocity_factor(), above.velocity_factor(), 1e-4);
        near(below.roughness_factor(), above.roughness_factor(), 1e-4);
    }
    // 1.2 + 134/ν40 = 2 at 167.5 mm²/s, 0.8 + 32/v = 4 at 10 m/s, R_z10 = 3 µm.
    let reference = film(700e6, 167.5e-6, 3e-6);
    near(reference.lubricant_factor(), 1.0, 1e-12);
    near(reference.velocity_factor(), 1.0, 1e-12);
    near(reference.roughness_factor(), 1.0, 1e-12);
    near(reference.work_hardening_factor(130.0), 1.2, 1e-12);
    near(reference.work_hardening_factor(100.0), 1.2, 1e-12);
    near(reference.work_hardening_factor(300.0), 1.1, 1e-12);
    near(reference.work_hardening_factor(600.0), 1.0, 1e-12);
    // R_zH of 6 µm: (6/3)^-0.15.
    let rough = film(700e6, 150e-6, 6e-6);
    near(rough.work_hardening_factor(130.0), 1.2 * 0.5_f64.powf(0.15), 1e-12);
    near(rough.work_hardening_factor(470.0), 1.0, 0.0);
    for (hardness, ratio, factor) in
        [(1.1, 5.0, 1.0), (1.7, 5.0, 1.027_904), (1.7 + 1e-9, 5.0, 1.027_92), (3.0, 50.0, 1.132_62)]
    {
        near(through_hardened_factor(hardness, ratio), factor, 1e-9);
    }
}
