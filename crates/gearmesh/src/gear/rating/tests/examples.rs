//! Whole examples: what others print or answer for one pair.

use super::*;
use crate::gear::geometry::Side;
use crate::gear::geometry::outline::tip::Tip;
use crate::gear::material::Material;
use crate::gear::rating::distribution::{
    equivalent_misalignment, face_load_factor, root_face_load_factor, shaft_deflection,
};
use crate::gear::rating::dynamic::Range;
use crate::gear::rating::life;
use crate::gear::rating::pitting::{
    Film, contact_load, contact_ratio_factor, elasticity_factor, helix_angle_factor, zone_factor,
};
use crate::gear::rating::{GearRating, PairRating, Rating, rate};

const RPM: f64 = std::f64::consts::PI / 30.0;

/// Tier: published; example 1 of ISO/TR 6336-30:2017, annex A, z 17/103, m_n 8, β 15.8°, a 500, b 100, T1 9 kN m at 360/min, both
/// case-hardened; its printed results of the flank as gfsReboucas/Drivetrain (GitHub, `MATISO_6336.m`) has them. It is helical, so its
/// factors are compared one by one; its ε_α is printed as 1.549 09, which its c_γα/c′ is of too. f_Hβ are those of grade 5 of ISO 1328-1:1995, 8.5 and 9.5 µm.
#[test]
fn flank_of_the_example_of_the_standard() {
    let (angle, helix) = (20_f64.to_radians(), 15.8_f64.to_radians());
    let transverse = (angle.tan() / helix.cos()).atan();
    let base_helix = (helix.sin() * angle.cos()).asin();
    let diameters = [17.0, 103.0].map(|teeth| 8e-3 * teeth / helix.cos());
    let base = diameters.map(|diameter| 0.5 * diameter * transverse.cos());
    let working = ((base[0] + base[1]) / 0.5).acos();
    let (ratio, width) = (103.0 / 17.0, 0.1);
    let load = 2.0 * 9000.0 / diameters[0];
    near(load, 127_352.0, 0.5);
    let speed = 360.0 * RPM * 0.5 * diameters[0];
    near(speed, 2.664, 5e-4);

    let zone = zone_factor(working, transverse, base_helix);
    near(zone, 2.395_33, 5e-6);
    let steel = Material::STEEL;
    let elasticity = elasticity_factor([&steel, &steel]);
    near(elasticity * 1e-3, 189.811_70, 5e-6);
    let contact_ratio = 1.549_09;
    near((17.464_85 / 12.370_47 - 0.25) / 0.75, contact_ratio, 1e-5);
    let overlap = width * helix.sin() / (std::f64::consts::PI * 8e-3);
    let of_ratio = contact_ratio_factor(contact_ratio, overlap);
    near(of_ratio, 0.803, 5e-4);
    near(helix_angle_factor(helix), 1.019_44, 5e-6);
    let nominal =
        zone * elasticity * of_ratio * helix_angle_factor(helix) * contact_load(load, diameters[0], width, ratio);
    near(nominal * 1e-6, 1_206.582_07, 5e-3);

    // K_V and K_Hβ are printed to 1.003 and 1.16; their product follows from the stresses, K_Hβ from K_Fβ.
    let product = (1_301.353_43_f64 / 1_206.582_07).powi(2);
    let of_face = {
        let dynamic = 1.003;
        let mean_load = load / width * dynamic;
        let slopes = [8.5e-6, 9.5e-6];
        let given = equivalent_misalignment(shaft_deflection(mean_load, width, diameters[0], None), slopes, mean_load);
        // Hard gears run in by 15 %.
        face_load_factor(0.85 * given, 14.845_12e9, mean_load)
    };
    near(of_face, 1.16, 5e-3);
    near(product / of_face, 1.003, 5e-4);
    let root = 0.5 * diameters[0] + 8e-3 * (0.145_22 - 1.4);
    near(root_face_load_factor(of_face, width / (0.5 * 0.159_66 - root)), 1.128_03, 5e-5);

    let tangent = working.tan();
    let film = Film {
        strength: 1500e6,
        viscosity: 320e-6,
        velocity: speed,
        roughness: [6e-6; 2],
        curvature_radius: base[0] * base[1] * tangent / (base[0] + base[1]),
    };
    near(film.lubricant_factor(), 1.047_39, 5e-6);
    near(film.velocity_factor(), 0.969_11, 5e-6);
    near(film.roughness_factor(), 0.965_99, 5e-6);
    let class = MaterialClass::CaseHardenedSteel;
    let cycles = [1.08e9, 1.08e9 / ratio];
    let lives = cycles.map(|cycles| life::contact_factor(class, Pitting::None, 0.85, cycles));
    near(lives[0], 0.91, 5e-4);
    near(lives[1], 0.962, 5e-4);
    let of_film = film.lubricant_factor() * film.velocity_factor() * film.roughness_factor();
    let limits = lives.map(|life| 1500.0 * life * of_film);
    near(limits[0], 1_338.480_50, 5e-3);
    near(limits[1], 1_414.525_51, 5e-3);
    near(limits[0] / 1_301.353_43, 1.028_53, 5e-6);
    near(limits[1] / 1_301.353_43, 1.086_96, 5e-6);
}

/// The pair of the next test: the profile shifts that its span measurements leave, each gear with the rack that cut it, and the
/// chamfer that the edge of the wheel's tool leaves, printed as 0.117 mm.
fn steel_on_plastic() -> (GearPair, Conditions) {
    let own = |teeth: u32, shift: f64, dedendum: f64, tip: f64, width: f64, material: Material| Specification {
        profile_shift: shift,
        thickness_allowance: 0.0,
        cutter: None,
        rack: Rack { addendum: 1.0, dedendum, tip_radius: 0.2, ..Rack::ISO_53_A },
        tip_radius: Some(0.5 * tip),
        face_width: width,
        bore_radius: 10e-3,
        material,
        ..standard(teeth, 1e-3, 2.0)
    };
    let left = |shift: f64, span: f64| shift + span / (2.0 * 20_f64.to_radians().sin());
    let steel = Material { youngs_modulus: 210e9, poisson_ratio: 0.3, ..Material::STEEL };
    let plastic = Material { youngs_modulus: 2.3e9, poisson_ratio: 0.4999, ..Material::STEEL };
    let gears = [
        own(51, left(0.2034, -0.278), 1.1, 52.894e-3, 17e-3, steel),
        own(52, left(0.3143, -0.207), 1.25, 54.022e-3, 15e-3, plastic),
    ];
    let pair = GearPair::with_tips(gears, [Tip::Land, Tip::Chamfer(0.117_18e-3)], Some(52e-3)).unwrap();
    let stated = without_load_factors();
    let factors = PairFactors {
        dynamic_factor: Some(1.56),
        face_load_factor_contact: Some(1.19),
        face_load_factor_root: Some(1.16),
        ..stated.factors
    };
    let mut conditions = Conditions { factors, ..stated };
    conditions.pinion.bending_strength = Some(430e6);
    conditions.pinion.root_roughness = Some(20e-6);
    (pair, conditions)
}

/// Tier: published; what STplus (FZG and FVA, the reference program of DIN 3990) prints of a spur pair of steel on PA66, z 51/52, m 1,
/// b 17/15, a 52, F_t 384.6 N at 1000/min, as tkuhn39/semesterthesis (GitHub, tests of `capacity` and `geometry`, at c747606) has it.
/// DIN 3990:1987, method B, has the formulas of ISO 6336 here.
#[test]
fn a_spur_pair_of_stplus() {
    let (pair, conditions) = steel_on_plastic();
    near(2e3 * pair.gear.radius_at(pair.gear.flank_end.roll), 53.788, 5e-4);
    near(pair.contact_ratio, 1.154, 5e-4);
    let Rating { pair: of_pair, gears: [pinion, wheel] } =
        rate(&pair, 384.6 * pair.pinion.reference_radius, 1000.0 * RPM, &conditions).unwrap();
    near(of_pair.elasticity_factor * 1e-3, 31.0, 0.05);
    near(of_pair.zone_factor, 2.400, 5e-4);
    near(pinion.single_contact_factor, 1.009, 5e-4);
    near(wheel.single_contact_factor, 1.008, 5e-4);
    let [first, second] = [pinion.section.unwrap(), wheel.section.unwrap()];
    near(first.chord, 2.068, 5e-4);
    near(first.fillet_radius, 0.404, 5e-4);
    near(first.load_angle.to_degrees(), 23.222, 5e-4);
    near(first.lever, 1.762, 5e-4);
    near(first.form_factor, 2.417, 5e-4);
    near(first.stress_correction_factor, 1.819, 1e-3);
    near(second.chord, 2.197, 5e-4);
    near(second.fillet_radius, 0.381, 5e-4);
    near(second.load_angle.to_degrees(), 22.702, 5e-4);
    near(second.lever, 1.614, 5e-4);
    near(second.form_factor, 1.970, 5e-4);
    near(second.stress_correction_factor, 1.984, 5e-4);
    near(second.notch, 2.88, 5e-3);
    // The wider pinion carries by one module more at each end.
    near(pinion.root_width, 17e-3, 1e-12);
    near(pinion.nominal_root_stress * 1e-6, 99.5, 0.05);
    near(wheel.nominal_root_stress * 1e-6, 100.2, 0.05);
    // K_V, K_Hβ and K_Fβ are known to two digits behind the point, which is to 0.5 %.
    near(pinion.root_stress * 1e-6, 180.1, 0.15);
    near(wheel.root_stress * 1e-6, 181.4, 0.15);
    near(pinion.contact_stress * 1e-6, 99.6, 0.1);
    near(wheel.contact_stress * 1e-6, 99.5, 0.05);
    near(pinion.surface_factor, 0.957, 5e-4);
    near(pinion.notch_sensitivity_factor, 1.001, 5e-4);
    near(pinion.root_safety, 4.571, 5e-3);
}

/// Tier: second program; hanslhansl/din3990 (GitHub, `tests/test_1.py` at 22b8478): z 19/104, m 4, x 0.5/0.15, b 48.64, 55 kW at
/// 980/min, by DIN 3990-11. What that standard has in common with ISO 6336 method B; Z_E is its 189.8.
#[test]
fn a_spur_pair_of_din3990() {
    let own = |teeth, shift| Specification {
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.25, ..Rack::ISO_53_A },
        ..gear(teeth, 4e-3, shift, 48.64e-3, 20e-3)
    };
    let pair = pair(own(19, 0.5), own(104, 0.15));
    let mut conditions = without_load_factors();
    conditions.factors.elasticity_factor = Some(189.8);
    conditions.factors.face_load_factor_contact = Some(1.106_427_286_329_508_2);
    conditions.factors.face_load_factor_root = None;
    let Rating { pair: found, gears } = rate(&pair, 535.929_910_411_484_3, 980.0 * RPM, &conditions).unwrap();
    near(found.tangential_load, 14_103.418_695_039_06, 1e-6);
    near(found.velocity, 3.899_763_680_656_13, 1e-12);
    near(found.contact_ratio_factor, 0.906_214_912_960_638, 1e-9);
    near(found.zone_factor, 2.395_940_667_089_993_4, 1e-9);
    near(gears[0].single_contact_factor, 1.005_547_045_498_64, 1e-9);
    near(gears[1].single_contact_factor, 1.0, 0.0);
    near(found.nominal_contact_stress * 1e-6, 875.382_737_898_815_3, 1e-6);
    near(found.face_load_factor_root, 1.086_485_443_348_798_7, 1e-9);
}

/// What `compute_dynamic_factors` of tkuhn39/semesterthesis (GitHub, at c747606) answers for spur pairs of profile shifts that cancel.
struct Theirs {
    gears: [Specification; 2],
    /// F_t \[N\] and K_A, n1 \[1/min\], f_pb, f_fα and F_βx \[µm\], σ_Hlim \[MPa\], C_a \[µm\].
    given: ([f64; 2], f64, [f64; 3], f64, Option<f64>),
    material: MaterialClass,
    range: Range,
    /// K_V, K_Hα, K_Fα, K_Hβ, K_Fβ.
    factors: [f64; 5],
    /// c_γα \[N/(mm µm)\], m_red \[kg/mm\], n_E1 \[1/min\].
    resonance: [f64; 3],
}

/// Tier: second program; see [`Theirs`]. It has other clauses for tip relief of both gears together, which equal reliefs do not show,
/// and the velocity of the mean diameters, which no limit of running in stands between here.
#[test]
fn load_factors_of_another_program() {
    let small = [gear(19, 3e-3, 0.2, 20e-3, 15e-3), gear(48, 3e-3, -0.2, 20e-3, 30e-3)];
    let large = [gear(25, 4e-3, 0.1, 40e-3, 20e-3), gear(70, 4e-3, -0.1, 40e-3, 50e-3)];
    let slow = ([9000.0, 1.1], 300.0);
    let resonance = [20.934_839_930_734_88, 0.029_876_998_913_520_45, 10_111.083_804_510_77];
    let all = [
        Theirs {
            gears: small,
            given: ([4000.0, 1.25], 1000.0, [7.0, 9.0, 12.0], 1500.0, None),
            material: MaterialClass::CaseHardenedSteel,
            range: Range::Subcritical,
            factors: [1.020_424_312_860_462, 1.0, 1.0, 1.322_378_444_060_163_8, 1.213_432_232_635_750_3],
            resonance: [18.971_326_543_317_037, 0.009_398_981_597_204_753, 22_580.119_246_793_14],
        },
        Theirs {
            gears: large,
            given: (slow.0, slow.1, [12.0, 14.0, 30.0], 800.0, None),
            material: MaterialClass::ThroughHardenedSteel,
            range: Range::Subcritical,
            factors: [1.015_416_486_567_524_8, 1.0, 1.0, 1.637_252_673_308_176, 1.471_809_522_992_959],
            resonance,
        },
        Theirs {
            gears: large,
            given: ([14_000.0, 1.0], 18_000.0, [12.0, 14.0, 30.0], 500.0, Some(25.0)),
            material: MaterialClass::FerriticNodularIron,
            range: Range::Supercritical,
            factors: [1.121_007_885_617_513_2, 1.0, 1.0, 1.306_136_865_490_535_4, 1.232_897_430_852_063_7],
            resonance,
        },
        Theirs {
            gears: large,
            given: (slow.0, slow.1, [60.0, 50.0, 30.0], 800.0, None),
            material: MaterialClass::ThroughHardenedSteel,
            range: Range::Subcritical,
            factors: [
                1.051_866_137_910_258_3,
                1.300_788_815_589_035_3,
                1.443_385_425_402_092,
                1.615_170_359_863_373_8,
                1.456_225_008_165_008_8,
            ],
            resonance,
        },
    ];
    for theirs in all {
        let ([load, application_factor], speed, [pitch, profile, helix], strength, relief) = theirs.given;
        let [pinion, wheel] = theirs.gears;
        let pair = pair(pinion, wheel);
        let mut own = GearConditions { contact_strength: Some(1e6 * strength), ..made_of(theirs.material) };
        own.factors.work_hardening_factor = Some(1.0);
        // Strengths are there for running in: no lubricant is.
        let one = Some(1.0);
        let factors =
            PairFactors { lubricant_factor: one, velocity_factor: one, roughness_factor: one, ..bare().factors };
        let conditions = Conditions {
            application_factor,
            base_pitch_deviation: Some(1e-6 * pitch),
            profile_form_deviation: Some(1e-6 * profile),
            equivalent_misalignment: Some(1e-6 * helix),
            tip_relief: relief.map(|relief| 1e-6 * relief),
            pinion: own.clone(),
            gear: own,
            factors,
            ..bare()
        };
        let torque = load * pair.pinion.reference_radius;
        let found = rate(&pair, torque, speed * RPM, &conditions).unwrap().pair;
        assert_eq!(found.range, Some(theirs.range));
        let ours = [
            found.dynamic_factor,
            found.transverse_load_factor_contact,
            found.transverse_load_factor_root,
            found.face_load_factor_contact,
            found.face_load_factor_root,
        ];
        for (ours, theirs) in ours.into_iter().zip(theirs.factors) {
            near(ours, theirs, 1e-12);
        }
        let [stiffness, mass, speed] = theirs.resonance;
        near(found.mesh_stiffness * 1e-9, stiffness, 1e-11);
        near(found.reduced_mass * 1e-3, mass, 1e-14);
        near(found.resonance_speed / RPM, speed, 1e-8);
    }
}

/// Tier: invariant; the standard's pinion is the gear with fewer teeth: a pair the other way round, under the same forces at the same
/// speed, has the same factors.
#[test]
fn the_pinion_is_the_gear_with_fewer_teeth() {
    let [pinion, wheel] = [gear(19, 3e-3, 0.2, 22e-3, 15e-3), gear(48, 3e-3, -0.1, 20e-3, 30e-3)];
    let conditions = Conditions {
        base_pitch_deviation: Some(20e-6),
        profile_form_deviation: Some(15e-6),
        equivalent_misalignment: Some(12e-6),
        viscosity: Some(220e-6),
        ..bare()
    };
    let hard = GearConditions {
        contact_strength: Some(1500e6),
        bending_strength: Some(430e6),
        flank_roughness: Some(3e-6),
        root_roughness: Some(12e-6),
        cycles: Some(1e8),
        rim_thickness: Some(9e-3),
        ..made_of(MaterialClass::CaseHardenedSteel)
    };
    let soft = GearConditions {
        contact_strength: Some(700e6),
        bending_strength: Some(280e6),
        flank_roughness: Some(5e-6),
        root_roughness: Some(20e-6),
        yield_strength: Some(700e6),
        hardness: Some(230.0),
        cycles: Some(4e7),
        rim_thickness: Some(8e-3),
        web_thickness: Some(6e-3),
        ..made_of(MaterialClass::ThroughHardenedSteel)
    };
    let forward = Conditions { pinion: hard.clone(), gear: soft.clone(), ..conditions.clone() };
    let backward = Conditions { pinion: soft, gear: hard, ..conditions };
    let ratio = 48.0 / 19.0;
    let one = rate(&pair(pinion, wheel), 100.0, 150.0, &forward).unwrap();
    let two = rate(&pair(wheel, pinion), 100.0 * ratio, 150.0 / ratio, &backward).unwrap();
    assert_eq!((one.pair.pinion, two.pair.pinion), (Side::Pinion, Side::Gear));
    // Z_W, C_R and Y_B are at work.
    assert!(one.gears[1].work_hardening_factor > 1.0 && one.pair.blank_factor < 1.0);
    let of_pair = |pair: &PairRating| {
        [
            pair.dynamic_factor,
            pair.resonance_ratio,
            pair.face_load_factor_contact,
            pair.transverse_load_factor_contact,
            pair.face_load_factor_root,
            pair.nominal_contact_stress,
            pair.lubricant_factor,
            pair.roughness_factor,
        ]
    };
    let of_gear = |gear: &GearRating| {
        [
            gear.single_contact_factor,
            gear.contact_stress,
            gear.contact_safety,
            gear.form_factor,
            gear.root_stress,
            gear.root_safety,
            gear.work_hardening_factor,
        ]
    };
    for (a, b) in of_pair(&one.pair).into_iter().zip(of_pair(&two.pair)) {
        near(a / b, 1.0, 1e-12);
    }
    for (a, b) in [(0, 1), (1, 0)] {
        for (a, b) in of_gear(&one.gears[a]).into_iter().zip(of_gear(&two.gears[b])) {
            near(a / b, 1.0, 1e-12);
        }
    }
}

/// Tier: invariant; a tolerance class says what its tolerances say, and B_k is 1 from class 6 on; f_Hβ and a shaft say what F_βx says.
#[test]
fn a_tolerance_class_stands_for_its_deviations() {
    let pair = pair(gear(19, 3e-3, 0.0, 20e-3, 15e-3), gear(48, 3e-3, 0.0, 18e-3, 30e-3));
    let rated = |conditions: &Conditions| rate(&pair, 150.0, 150.0, conditions).unwrap().pair;
    let by_class = |tolerance_class| rated(&Conditions { tolerance_class, tip_relief: Some(20e-6), ..bare() });
    // Of the pinion 9.0 and 9.5 µm in class 6, of both gears' helices 8.5; in class 5 6.5, 6.5, and 6.0.
    let stated = |pitch: f64, form: f64, slopes: f64, relief_parameter| {
        let mut conditions = Conditions {
            base_pitch_deviation: Some(1e-6 * pitch * 20_f64.to_radians().cos()),
            profile_form_deviation: Some(1e-6 * form),
            tip_relief: Some(20e-6),
            ..bare()
        };
        conditions.factors.relief_parameter = relief_parameter;
        for gear in [&mut conditions.pinion, &mut conditions.gear] {
            gear.helix_slope_deviation = Some(1e-6 * slopes);
        }
        conditions
    };
    for (class, stated) in [(5, stated(6.5, 6.5, 6.0, None)), (6, stated(9.0, 9.5, 8.5, Some(1.0)))] {
        let (one, two) = (by_class(Some(class)), rated(&stated));
        near(one.dynamic_factor, two.dynamic_factor, 1e-12);
        near(one.transverse_load_factor_contact, two.transverse_load_factor_contact, 1e-12);
        near(one.face_load_factor_contact, two.face_load_factor_contact, 1e-12);
        let slopes = [stated.pinion.helix_slope_deviation.unwrap(); 2];
        let mean_load = two.tangential_load / 18e-3 * two.dynamic_factor;
        let bent = shaft_deflection(mean_load, 18e-3, 57e-3, None);
        near(two.equivalent_misalignment, equivalent_misalignment(bent, slopes, mean_load), 1e-18);
        let given = Conditions { equivalent_misalignment: Some(two.equivalent_misalignment), ..stated };
        near(rated(&given).face_load_factor_contact, two.face_load_factor_contact, 1e-12);
    }
    // F_βx is no less than half of the larger slope, and no less than 0.005 µm mm/N of the load.
    near(equivalent_misalignment(0.0, [8e-6, 0.0], 1e3), 8e-6, 1e-18);
    near(equivalent_misalignment(0.0, [0.0; 2], 400e3), 2e-6, 1e-18);
}
