//! Published factors, other programs, limits.

use super::*;
use crate::gear::fixtures::standard;
use crate::gear::geometry::Gear;

fn tooth(teeth: f64, profile_shift: f64, tip_radius: f64, load_radius: f64) -> Tooth {
    let rack = Rack { addendum: 1.0, dedendum: 1.25, tip_radius, ..Rack::ISO_53_A };
    Tooth { teeth, pressure_angle: 20_f64.to_radians(), profile_shift, rack, grinding_notch: 0.0, load_radius }
}

/// Tier: published; the table of Y_Fa and Y_Sa, load at the tip, that Chinese textbooks print after GB/T 3480 (= ISO 6336-3)
/// for 20°, 1.25 and 0.38 (Pu and others, Mechanical Design, table 10-5). It was read from charts, so that it has steps: to
/// 0.018 and 0.01; its last column, the rack, to what is printed.
#[test]
fn factors_of_the_textbook_s_table() {
    const PRINTED: [(f64, f64, f64); 25] = [
        (17.0, 2.97, 1.52),
        (18.0, 2.91, 1.53),
        (19.0, 2.85, 1.54),
        (20.0, 2.80, 1.55),
        (21.0, 2.76, 1.56),
        (22.0, 2.72, 1.57),
        (23.0, 2.69, 1.575),
        (24.0, 2.65, 1.58),
        (25.0, 2.62, 1.59),
        (26.0, 2.60, 1.595),
        (27.0, 2.57, 1.60),
        (28.0, 2.55, 1.61),
        (29.0, 2.53, 1.62),
        (30.0, 2.52, 1.625),
        (35.0, 2.45, 1.65),
        (40.0, 2.40, 1.67),
        (45.0, 2.35, 1.68),
        (50.0, 2.32, 1.70),
        (60.0, 2.28, 1.73),
        (70.0, 2.24, 1.75),
        (80.0, 2.22, 1.77),
        (90.0, 2.20, 1.78),
        (100.0, 2.18, 1.79),
        (150.0, 2.14, 1.83),
        (200.0, 2.12, 1.865),
    ];
    for (teeth, form, correction) in PRINTED {
        let found = section(&tooth(teeth, 0.0, 0.38, 0.5 * teeth + 1.0)).unwrap();
        assert!((found.form_factor - form).abs() < 0.018, "z {teeth}: Y_Fa {}", found.form_factor);
        let ours = found.stress_correction_factor;
        assert!((ours - correction).abs() < 0.01, "z {teeth}: Y_Sa {ours}");
    }
    let rack = section(&tooth(1e7, 0.0, 0.38, 0.5e7 + 1.0)).unwrap();
    assert!((rack.form_factor - 2.06).abs() < 5e-3 && (rack.stress_correction_factor - 1.97).abs() < 5e-3, "{rack:?}");
}

/// Tier: second program; din3990 (hanslhansl, GitHub), its test 1: z 19/104, x 0.5/0.15, 20°, 1.25, 0.25, load at the tip. It
/// stops the iteration for θ at 1e-4.
#[test]
fn values_of_another_program() {
    for (teeth, shift, tip, [chord, lever, radius, form, correction, notch]) in [
        (
            19.0,
            0.5,
            11.0,
            [
                8.748_743_355_951_145,
                8.174_657_642_839_318,
                1.316_147_757_704_942_3,
                2.246_336_378_902_072,
                1.914_726_256_594_728_7,
                3.323_617_467_998_78,
            ],
        ),
        (
            104.0,
            0.15,
            53.15,
            [
                9.239_504_610_725_831,
                7.834_245_947_926_714,
                1.325_999_192_893_118,
                2.161_656_679_805_851_4,
                2.008_781_657_562_889,
                3.483_978_218_179_27,
            ],
        ),
    ] {
        let found = section(&tooth(teeth, shift, 0.25, tip)).unwrap();
        let near = |ours: f64, theirs: f64| assert!((ours / theirs - 1.0).abs() < 2e-4, "z {teeth}: {ours}, {theirs}");
        near(found.chord, chord / 4.0);
        near(found.lever, lever / 4.0);
        near(found.fillet_radius, radius / 4.0);
        near(found.form_factor, form);
        near(found.stress_correction_factor, correction);
        near(found.notch, notch);
    }
}

/// Tier: second program; din3990 (hanslhansl, GitHub), its `AbschnittD_5`, with the protuberance profile of DIN 3990-11 (1.4, 0.4, s_pr
/// 0.02) and a larger one, load at the tip; θ iterated to the end.
#[test]
fn another_program_s_values_with_protuberance() {
    const VALUES: [(f64, f64, f64, [f64; 5]); 3] = [
        (
            23.0,
            0.313,
            0.02,
            [
                2.138_360_302_904_881_7,
                2.081_358_199_681_826,
                0.523_519_253_677_418_6,
                2.486_901_312_008_319,
                1.640_348_670_352_033_4,
            ],
        ),
        (
            19.0,
            0.5,
            0.02,
            [
                2.188_157_079_138_561,
                2.139_678_530_408_195_6,
                0.475_931_841_023_09,
                2.349_784_951_002_340_5,
                1.695_594_888_637_922_2,
            ],
        ),
        (
            40.0,
            0.0,
            0.05,
            [
                2.078_434_055_366_314,
                2.022_962_664_753_851_7,
                0.589_018_043_264_554_9,
                2.699_667_537_901_002_2,
                1.572_224_568_113_962_6,
            ],
        ),
    ];
    for (teeth, profile_shift, residual, [chord, lever, radius, form, correction]) in VALUES {
        let rack = Rack {
            dedendum: 1.4,
            tip_radius: 0.4,
            protuberance: residual + 0.1,
            machining_allowance: 0.1,
            ..Rack::ISO_53_A
        };
        let load_radius = 0.5 * teeth + 1.0 + profile_shift;
        let found = section(&Tooth { rack, ..tooth(teeth, profile_shift, 0.4, load_radius) }).unwrap();
        let near = |ours: f64, theirs: f64| assert!((ours / theirs - 1.0).abs() < 1e-12, "z {teeth}: {ours}, {theirs}");
        near(found.chord, chord);
        near(found.lever, lever);
        near(found.fillet_radius, radius);
        near(found.form_factor, form);
        near(found.stress_correction_factor, correction);
    }
}

/// Tier: second way; chord, height and radius of the fillet are those of the generated curve where its tangent stands at 30°, whatever
/// its protuberance or stock.
#[test]
fn the_critical_section_is_on_the_generated_curve() {
    for (residual, teeth) in [(0.0, 19), (0.03, 19), (0.05, 60), (-0.03, 30)] {
        let rack = Rack {
            dedendum: 1.4,
            tip_radius: 0.3,
            protuberance: 0.05 + residual,
            machining_allowance: 0.05,
            notch_radius: 0.1,
            ..Rack::ISO_53_A
        };
        let specification = Specification { rack, ..standard(teeth, 1.0, 2.0) };
        let curve = Gear::new(&specification).unwrap().trochoid();
        let q = crate::numeric::crossing::bracketed(0.0, curve.joint_parameter(), |q| curve.rates(q).0 - FRAC_PI_6);
        let q = q.or_else(|| {
            // Above what is left of the curve.
            crate::numeric::crossing::bracketed(0.0, 3.0, |q| curve.rates(q).0 - FRAC_PI_6)
        });
        let ([x, y], (_, rate, turning)) = (curve.point_at(q.unwrap()), curve.rates(q.unwrap()));
        let load_radius = 0.5 * f64::from(teeth) + 1.0;
        let found = section(&Tooth { rack, ..tooth(f64::from(teeth), 0.0, 0.3, load_radius) }).unwrap();
        let by_curve = section_of_curve(&Tooth { rack, ..tooth(f64::from(teeth), 0.0, 0.3, load_radius) }, &curve, 1.0);
        let differs = by_curve.unwrap().form_factor / found.form_factor - 1.0;
        assert!(differs.abs() < 1e-11, "{residual}: {differs:e}");
        assert!((found.chord / (2.0 * x) - 1.0).abs() < 1e-12, "{residual}: {} {x}", found.chord);
        assert!((found.fillet_radius / (rate / turning) - 1.0).abs() < 1e-12, "{residual}");
        let apex = 0.5 * f64::from(teeth) * 20_f64.to_radians().cos() / found.load_angle.cos();
        assert!((found.lever - (apex - y)).abs() < 1e-11, "{residual}: {} {}", found.lever, apex - y);
    }
}

/// Tier: closed form; Y_Sg/Y_S = 1.3/(1.3 − 0.6 √(t_g/ρ_g)), 1.3 at t_g = ρ_g/4; none from √(t_g/ρ_g) = 2 on.
#[test]
fn a_grinding_notch_raises_the_stress() {
    let plain = tooth(19.0, 0.0, 0.38, 10.5);
    let of = |grinding_notch: f64| section(&Tooth { grinding_notch, ..plain });
    let ratio = of(0.25).unwrap().stress_correction_factor / of(0.0).unwrap().stress_correction_factor;
    assert!((ratio - 1.3).abs() < 1e-14, "{ratio}");
    assert!(of(3.99).is_ok() && matches!(of(4.0), Err(Outside::GrindingNotch(_))));
    // Of a pair, from its racks: t_g is the stock that the protuberance leaves.
    let rack = |allowance: f64| Rack {
        protuberance: 0.01,
        machining_allowance: allowance,
        notch_radius: 0.12,
        dedendum: 1.4,
        tip_radius: 0.3,
        ..Rack::ISO_53_A
    };
    let of = |allowance: f64| {
        let pair = pair([30, 48], rack(allowance));
        let gear = pair.pinion.specification;
        let found = critical_section(&pair, Side::Pinion).unwrap();
        let length =
            pair.pinion.flank_end.roll * pair.pinion.base_radius - pair.base_pitch * (pair.contact_ratio - 1.0);
        let load_radius = libm::hypot(length, pair.pinion.base_radius) / gear.module;
        let teeth = f64::from(gear.teeth);
        let bare = Tooth { rack: gear.rack, ..tooth(teeth, 0.0, 0.3, load_radius) };
        found.stress_correction_factor / section(&bare).unwrap().stress_correction_factor
    };
    assert!((of(0.04) - 1.3).abs() < 1e-6, "{}", of(0.04));
    assert!((of(0.01) - 1.0).abs() < 1e-15);
}

fn pair(teeth: [u32; 2], rack: Rack) -> GearPair {
    let [pinion, gear] = teeth.map(|teeth| Specification { rack, ..standard(teeth, 2e-3, 1.6) });
    GearPair::new(pinion, gear, None).unwrap()
}

/// Tier: closed form; the load stands where the path of contact has the outer point of single contact, D on the pinion and B on
/// the gear, and F_t is the torque over the reference radius, whichever gear it is. Of the second pair undercut ends the contact before
/// the gear's tip.
#[test]
fn the_load_stands_at_the_outer_point_of_single_contact() {
    let pairs = [[19, 48], [12, 40]].map(|teeth| pair(teeth, Rack::ISO_53_A));
    assert_eq!(pairs.each_ref().map(|pair| pair.is_curtailed(Side::Pinion)), [false, true]);
    let points = pairs.iter().flat_map(|pair| {
        let (b, d) = (pair.end_of_contact - pair.base_pitch, pair.start_of_contact + pair.base_pitch);
        [(pair, Side::Pinion, d), (pair, Side::Gear, b)]
    });
    for (pair, side, s) in points {
        let Gear { specification, base_radius, .. } = *pair.side(side);
        let load_radius = base_radius * (1.0 + pair.roll(side, s).powi(2)).sqrt() / specification.module;
        let Specification { teeth, module, face_width, .. } = specification;
        let found = section(&tooth(f64::from(teeth), 0.0, 0.38, load_radius)).unwrap();
        let per_load = found.form_factor * found.stress_correction_factor / (face_width * module);
        let exact = 30.0 / pair.pinion.reference_radius * per_load;
        let stress = nominal_root_stress(pair, side, 30.0).unwrap();
        assert!((stress / exact - 1.0).abs() < 1e-12, "{side:?}: {stress:e} for {exact:e}");
    }
}

#[test]
fn what_the_standard_does_not_hold_for_is_refused() {
    let long = Rack { addendum: 1.2, dedendum: 1.45, tip_radius: 0.3, ..Rack::ISO_53_A };
    let deep = nominal_root_stress(&pair([100, 120], long), Side::Gear, 10.0).unwrap_err();
    assert!(matches!(deep, Outside::ContactRatio(ratio) if ratio > 2.0), "{deep}");
    // A sharp rack leaves a sharp notch where there are many teeth.
    let of = |tip_radius: f64| section(&tooth(1000.0, 0.0, tip_radius, 501.0));
    let [sharp, round] = [of(0.1), of(0.2)];
    assert!(matches!(sharp, Err(Outside::Notch(notch)) if notch > 8.0), "{sharp:?}");
    assert!(sharp.unwrap_err().to_string().contains("must be 1 to 8"));
    assert!(round.is_ok_and(|found| found.notch < 8.0));
    // The rack would have to turn back.
    let none = section(&tooth(6.0, -1.5, 0.0, 4.0));
    assert!(none.is_err(), "{none:?}");
}
