//! Published and independently computed values, the cutter as an oracle, and inputs that must be refused.

mod annex;
mod cutter;
mod meshing;
mod outline;
mod passing;
mod protuberance;
mod refusals;
mod section;
mod semi_topping;
mod shaping;
mod usable;

use std::f64::consts::PI;

use proptest::prelude::*;

use super::error::{GeometryError, Parameter, Problem, Subject};
use super::root::{Root, RootShape};
use super::{Gear, GearPair, Rack, Side, Specification};
use crate::gear::material::Material;
use crate::numeric::crossing::bracketed;

const DEGREE: f64 = PI / 180.0;

fn specification(teeth: u32, module_mm: f64, profile_shift: f64) -> Specification {
    Specification {
        teeth,
        module: module_mm * 1e-3,
        pressure_angle: 20.0 * DEGREE,
        profile_shift,
        thickness_allowance: 0.0,
        cutter: None,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A },
        tip_radius: None,
        face_width: 0.02,
        bore_radius: 1e-3 * module_mm,
        material: Material::STEEL,
    }
}

#[test]
fn what_a_study_leaves_out_is_the_rack_of_the_standard_and_steel() {
    assert_eq!(Rack::default(), Rack::ISO_53_A);
    assert_eq!(Material::default(), Material::STEEL);
}

fn gear(teeth: u32, module_mm: f64, profile_shift: f64) -> Gear {
    Gear::new(&specification(teeth, module_mm, profile_shift)).unwrap()
}

fn refused(specification: &Specification) -> GeometryError {
    Gear::new(specification).unwrap_err()
}

fn about(error: &GeometryError) -> (Subject, Option<Side>) {
    (error.subject(), error.side)
}

fn pair(pinion: u32, gear: u32) -> Result<GearPair, GeometryError> {
    GearPair::new(specification(pinion, 3.0, 0.0), specification(gear, 3.0, 0.0), None)
}

fn assert_near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance, "{what}: {found} for {expected}");
}

/// Tier: published; ISO 53:1998, table 2, rack A; ISO 6336-1 and -2: E 206 000 N/mm² and ν 0.3 of steel.
#[test]
fn rack_and_steel_are_the_standards() {
    assert_eq!(Rack::ISO_53_A, Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A });
    assert_eq!(Material::STEEL, Material { youngs_modulus: 206e9, poisson_ratio: 0.3, density: 7830.0 });
}

/// Tier: values computed independently, to every digit given (lengths in mm).
#[test]
fn radii_and_angles_of_three_gears() {
    // z, m, r_b, r_f, r_a, r_form, ψ at r_form, ψ at the root's end, ψ_b, tip thickness.
    let rows = [
        (17, 1.5, [11.981_081, 10.875, 14.25, 11.981_087], [0.107_304_2, 0.177_228_2, 0.107_304_2], 1.011_12),
        (19, 3.0, [26.781_240, 24.75, 31.5, 26.799_034], [0.097_561_7, 0.158_572_6, 0.097_577_9], 2.065_70),
        (30, 3.0, [42.286_168, 41.25, 48.0, 42.801_185], [0.066_003_9, 0.100_429_3, 0.067_264_3], 2.212_20),
    ];
    for (teeth, module, radii, angles, thickness) in rows {
        let gear = gear(teeth, module, 0.0);
        let found = [gear.base_radius, gear.root_radius, gear.tip_radius, gear.form_radius].map(|radius| radius * 1e3);
        for (found, expected) in found.into_iter().zip(radii) {
            assert_near(found, expected, 5.1e-7, &format!("radius of z {teeth}"));
        }
        let found = [
            gear.half_angle(gear.form_radius),
            gear.root(RootShape::Trochoid).unwrap().half_angle,
            gear.half_base_angle,
        ];
        for (found, expected) in found.into_iter().zip(angles) {
            assert_near(found, expected, 5.1e-8, &format!("half angle of z {teeth}"));
        }
        assert_near(gear.tip_thickness() * 1e3, thickness, 5.1e-6, &format!("tip thickness of z {teeth}"));
        assert_eq!(gear.undercut, teeth == 17);
    }
}

/// Tier: values computed independently.
#[test]
fn the_root_curve_of_seventeen_teeth() {
    let curve = gear(17, 1.5, 0.0).trochoid();
    let rows = [(0.25, 11.042_656, 0.136_908), (0.5, 11.335_804, 0.117_700_7), (0.75, 11.644_985, 0.109_590_1)];
    for (part, radius, half_angle) in rows {
        // Parts of the rack's travel, which goes with cot γ.
        let (x, y) = curve.point(libm::atan((20.0 * DEGREE).tan() / part));
        assert_near(libm::hypot(x, y) * 1e3, radius, 1e-6, "radius");
        assert_near(libm::atan2(x, y), half_angle, 1e-6, "half angle");
    }
}

/// Tier: closed form; the threshold of undercut is z_min = 17.0967, full round is 0.47191, the land ends at 32.14°.
#[test]
fn thresholds_of_the_rack() {
    assert!(gear(17, 3.0, 0.0).undercut && !gear(18, 3.0, 0.0).undercut);
    let minimum = gear(17, 3.0, 0.0).least_shift_without_undercut();
    assert_near(minimum, 0.5 * (17.0967 - 17.0) * (20.0 * DEGREE).sin().powi(2), 1e-5, "least shift");
    assert!(gear(17, 3.0, minimum - 1e-9).undercut && !gear(17, 3.0, minimum + 1e-9).undercut);
    // The two formulas of the form radius meet at the threshold.
    let (below, above) =
        (gear(12, 3.0, 0.25), gear(12, 3.0, gear(12, 3.0, 0.25).least_shift_without_undercut() + 1e-6));
    assert!(below.undercut && !above.undercut && below.form_radius > above.form_radius);

    let mut round = specification(30, 3.0, 0.0);
    round.rack.tip_radius = 0.471_91;
    assert!(Gear::new(&round).is_ok());
    round.rack.tip_radius = 0.472;
    let error = refused(&round);
    assert_eq!(error.subject(), Subject::Parameter(Parameter::RackTipRadius));
    assert_eq!(error.to_string(), "the rack's tip radius is 0.472 modules, but must be 0 to 0.471911 (full round)");
    let mut steep = specification(30, 3.0, 0.0);
    steep.rack.tip_radius = 0.0;
    steep.pressure_angle = 32.14 * DEGREE;
    assert!(Gear::new(&steep).is_ok());
    steep.pressure_angle = 32.15 * DEGREE;
    assert_eq!(refused(&steep).subject(), Subject::Parameter(Parameter::PressureAngle));
}

#[test]
fn gears_that_cannot_be_are_refused_with_the_range() {
    for (teeth, shift) in [(15, 1.0), (8, 0.7)] {
        let error = refused(&specification(teeth, 3.0, shift));
        assert!(matches!(error.problem, Problem::Pointed { .. }), "z {teeth} x {shift}: {error}");
        assert_eq!(error.subject(), Subject::Parameter(Parameter::ProfileShift));
        // The radius the message names is admissible, just.
        let Problem::Pointed { apex, .. } = error.problem else { unreachable!() };
        for (tip, pointed) in [(apex.0 * (1.0 - 1e-9), false), (apex.0 * (1.0 + 1e-9), true)] {
            let given = Specification { tip_radius: Some(tip), ..specification(teeth, 3.0, shift) };
            assert_eq!(Gear::new(&given).is_err(), pointed, "z {teeth} with tip radius {tip}");
            assert!(!pointed || refused(&given).subject() == Subject::Parameter(Parameter::TipRadius));
        }
    }
    let base = specification(19, 3.0, 0.0);
    let rows = [
        (Specification { bore_radius: 0.024_75, ..base }, Parameter::BoreRadius),
        (Specification { bore_radius: 0.0, ..base }, Parameter::BoreRadius),
        (Specification { bore_radius: f64::NAN, ..base }, Parameter::BoreRadius),
        (Specification { face_width: -0.02, ..base }, Parameter::FaceWidth),
        (Specification { face_width: f64::NAN, ..base }, Parameter::FaceWidth),
        (Specification { teeth: 3, ..base }, Parameter::Teeth),
        (Specification { module: 0.0, ..base }, Parameter::Module),
        (Specification { pressure_angle: 1.5, ..base }, Parameter::PressureAngle),
        (Specification { profile_shift: f64::INFINITY, ..base }, Parameter::ProfileShift),
        (Specification { rack: Rack { dedendum: 0.0, ..base.rack }, ..base }, Parameter::RackDedendum),
        (Specification { rack: Rack { addendum: -1.0, ..base.rack }, ..base }, Parameter::RackAddendum),
        (Specification { rack: Rack { tip_radius: -0.1, ..base.rack }, ..base }, Parameter::RackTipRadius),
        (Specification { tip_radius: Some(0.0267), ..base }, Parameter::Teeth),
        (Specification { tip_radius: Some(f64::NAN), ..base }, Parameter::Teeth),
        (
            Specification { material: Material { youngs_modulus: 0.0, ..base.material }, ..base },
            Parameter::YoungsModulus,
        ),
        (Specification { material: Material { poisson_ratio: 0.6, ..base.material }, ..base }, Parameter::PoissonRatio),
        (Specification { teeth: 4, profile_shift: -1.0, ..base }, Parameter::RackDedendum),
    ];
    for (specification, parameter) in rows {
        let error = refused(&specification);
        assert_eq!(error.subject(), Subject::Parameter(parameter), "{error}");
    }
    assert_eq!(
        refused(&Specification { face_width: -0.02, ..base }).to_string(),
        "the face width is -20 mm, but must be 0.001 mm to 100000 mm"
    );
    assert_eq!(
        refused(&Specification { bore_radius: 0.025, ..base }).to_string(),
        "the bore radius is 25 mm, but must be at least 0.02475 mm and below the root radius 24.75 mm"
    );
}

#[test]
fn pairs_that_cannot_run_are_refused() {
    for (pinion, gear, inside) in [(12, 48, true), (14, 100, true)] {
        // They run on what is left of the path, unless that is not wanted.
        let error = pair(pinion, gear).unwrap().refuse_interference().unwrap_err();
        assert_eq!(about(&error), (Subject::Parameter(Parameter::Teeth), Some(Side::Pinion)), "{error}");
        assert!(matches!(error.problem, Problem::Interference { .. }), "{error}");
        assert_eq!(error.to_string().contains("beyond the tangent point"), inside, "{error}");
        // The mate's tip radius that the message names runs.
        let Problem::Interference { largest, .. } = error.problem else { unreachable!() };
        let mate = |tip| Specification { tip_radius: Some(tip), ..specification(gear, 3.0, 0.0) };
        let curtailed = |tip: f64| {
            GearPair::new(specification(pinion, 3.0, 0.0), mate(tip), None).unwrap().is_curtailed(Side::Pinion)
        };
        assert!(!curtailed(largest.0 * (1.0 - 1e-9)) && curtailed(largest.0 * (1.0 + 1e-9)));
    }
    // The same the other way round is the gear's trouble.
    assert_eq!(
        about(&pair(48, 12).unwrap().refuse_interference().unwrap_err()),
        (Subject::Parameter(Parameter::Teeth), Some(Side::Gear))
    );

    let short = |teeth| Specification {
        rack: Rack { addendum: 0.5, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A },
        ..specification(teeth, 3.0, 0.0)
    };
    let error = GearPair::new(short(19), short(48), None).unwrap_err();
    assert!(matches!(error.problem, Problem::ContactRatio { .. }), "{error}");
    assert!(error.to_string().starts_with("the contact ratio is 0.8"), "{error}");

    let far = |distance| GearPair::new(specification(19, 3.0, 0.0), specification(48, 3.0, 0.0), Some(distance));
    assert_eq!(far(0.1).unwrap_err().subject(), Subject::Parameter(Parameter::CentreDistance));
    assert_eq!(far(0.05).unwrap_err().subject(), Subject::Parameter(Parameter::CentreDistance));
    assert_eq!(far(f64::NAN).unwrap_err().subject(), Subject::Parameter(Parameter::CentreDistance));
    assert!(matches!(far(0.2).unwrap_err().problem, Problem::ContactRatio { .. }));
    assert!(far(0.1005).is_ok() && far(0.1008).is_ok());

    let error = GearPair::new(specification(19, 3.0, 0.0), specification(48, 3.5, 0.0), None).unwrap_err();
    assert_eq!(error.to_string(), "the module differs: 3 mm on the pinion, 3.5 mm on the gear");
    let long = Specification { tip_radius: Some(0.0325), ..specification(19, 3.0, 0.0) };
    assert_eq!(
        about(&GearPair::new(long, specification(48, 3.0, 0.0), None).unwrap_err()),
        (Subject::Parameter(Parameter::TipRadius), Some(Side::Pinion))
    );
    let deep = |teeth| specification(teeth, 3.0, -1.5);
    assert_eq!(
        GearPair::new(deep(40), deep(48), None).unwrap_err().subject(),
        Subject::Parameter(Parameter::ProfileShift)
    );
}

/// A tooth as deep as the space that is cut for it leaves a clearance of 0, whatever rounding makes of it.
#[test]
fn a_clearance_of_exactly_nothing_is_kept() {
    let (mut below, mut tried) = (0, 0);
    for module in [0.05, 0.3, 1.0, 3.0, 7.0, 50.0] {
        for (pinion, gear) in [(30, 41), (37, 53), (61, 97), (33, 400)] {
            for (depth, shift) in [(1.0, 0.0), (1.1, 0.1), (1.157, 0.3), (1.07, -0.05)] {
                let cut = |teeth, shift, longer: f64| Specification {
                    rack: Rack { addendum: depth, dedendum: depth, tip_radius: 0.0, ..Rack::ISO_53_A },
                    tip_radius: Some(module * 1e-3 * (0.5 * f64::from(teeth) + depth + shift) + longer),
                    ..specification(teeth, module, shift)
                };
                let with = |longer| GearPair::new(cut(pinion, shift, longer), cut(gear, -shift, 0.0), None);
                let refused = |pair: &Result<GearPair, GeometryError>| {
                    pair.as_ref().is_err_and(|error| matches!(error.problem, Problem::NoClearance { .. }))
                };
                let exact = with(0.0);
                assert!(!refused(&exact), "{module} {pinion} {gear} {depth} {shift}: {exact:?}");
                assert!(refused(&with(1e-9)), "{module} {pinion} {gear} {depth} {shift}");
                tried += 1;
                below += i32::from(
                    exact.is_ok_and(|pair| pair.centre_distance - pair.pinion.tip_radius - pair.gear.root_radius < 0.0),
                );
            }
        }
    }
    // Else nothing was tried that rounding would refuse.
    assert!(below > 5, "{below} of {tried}");
}

/// Tier: a second way to the same length; with three pairs in contact too.
#[test]
fn the_path_of_contact() {
    let pair = pair(19, 48).unwrap();
    assert_near(pair.centre_distance, 0.1005, 1e-17, "centre distance");
    let points = pair.zone_points();
    assert_near(points.e - points.b, pair.base_pitch, 1e-17, "B to E");
    assert_near(points.d - points.a, pair.base_pitch, 1e-17, "A to D");
    assert!(points.a < points.b && points.b < points.c && points.c < points.d && points.d < points.e);
    // At the pitch point the radii are those of the pitch circles.
    assert_near(pair.pinion.radius_at(pair.roll(Side::Pinion, points.c)), 0.0285, 1e-16, "pitch radius");
    assert_near(pair.gear.radius_at(pair.roll(Side::Gear, points.c)), 0.072, 1e-16, "pitch radius");
    for side in [Side::Pinion, Side::Gear] {
        assert_near(pair.path_position(side, pair.roll(side, 0.005)), 0.005, 1e-16, "path position");
    }

    let high = |teeth| Specification {
        rack: Rack { addendum: 1.4, dedendum: 1.6, tip_radius: 0.2, ..Rack::ISO_53_A },
        ..specification(teeth, 3.0, 0.0)
    };
    let pair = GearPair::new(high(50), high(60), None).unwrap();
    assert!(pair.contact_ratio > 2.0 && pair.contact_ratio < 3.0, "{}", pair.contact_ratio);
}

/// Tier: invariant; without backlash the two teeth fill the pitch circle: s1 + s2 = p_w.
#[test]
fn shifted_gears_have_no_backlash() {
    for (x1, x2) in [(0.3, 0.2), (0.5, -0.5), (-0.1, -0.15), (0.6, 0.6)] {
        let pair = GearPair::new(specification(25, 2.0, x1), specification(40, 2.0, x2), None).unwrap();
        let share = pair.centre_distance / f64::from(25 + 40);
        let thickness = |gear: &Gear| {
            let radius = share * f64::from(gear.specification.teeth);
            2.0 * radius * gear.half_angle(radius)
        };
        let pitch = 2.0 * PI * share;
        assert_near(thickness(&pair.pinion) + thickness(&pair.gear), pitch, 1e-15, "tooth thicknesses");
        let exact = 1e-3 * f64::from(25 + 40) * (20.0 * DEGREE).cos() / pair.working_pressure_angle.cos();
        assert_near(pair.centre_distance, exact, 1e-15, "centre distance");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    /// Tier: invariant; whatever the rack, no other root reaches above the one it generates, so contact is on the flank.
    #[test]
    fn no_root_reaches_above_the_generated_one(
        teeth in 4_u32..300, shift in -0.5..1.5_f64, angle in 10.0..30.0_f64, dedendum in 0.9..1.5_f64, round in 0.0..1.0_f64,
    ) {
        let mut specification = specification(teeth, 3.0, shift);
        specification.pressure_angle = angle * DEGREE;
        specification.rack = Rack { addendum: 0.5, dedendum, tip_radius: 0.0, ..Rack::ISO_53_A };
        specification.rack.tip_radius = round * super::trochoid::full_round(&specification).max(0.0);
        let Ok(gear) = Gear::new(&specification) else { return Err(TestCaseError::reject("no such gear")) };
        for shape in [RootShape::CircularFillet, RootShape::BaseCircle] {
            if let Ok(root) = gear.root(shape) {
                prop_assert!(root.form_roll <= gear.form_roll + 1e-12, "{shape:?}: {} above {}", root.form_roll, gear.form_roll);
                prop_assert!(root.half_angle > 0.0);
            }
        }
    }

    /// Tier: invariant; a gear k times as large has k times the lengths.
    #[test]
    fn lengths_scale_with_the_module(teeth in 8_u32..200, shift in 0.0..0.4_f64, factor in 1e-2..1e2_f64) {
        let one = gear(teeth, 3.0, shift);
        let many = gear(teeth, 3.0 * factor, shift);
        for (small, large) in [
            (one.form_radius, many.form_radius), (one.tip_radius, many.tip_radius), (one.tip_thickness(), many.tip_thickness()),
        ] {
            prop_assert!((large / (factor * small) - 1.0).abs() < 1e-11, "{large} for {factor} times {small}");
        }
    }
}

/// Tier: a second method; dy of every section against differences of y, and pieces that join without a step.
#[test]
fn sections_join_and_their_rates_are_derivatives() {
    for (teeth, shift) in [(12, 0.0), (17, 0.0), (19, 0.0), (48, 0.0), (30, 1.4), (19, 0.5)] {
        let gear = gear(teeth, 3.0, shift);
        for shape in [RootShape::Trochoid, RootShape::CircularFillet, RootShape::BaseCircle] {
            let root = gear.root(shape).unwrap();
            let mut end = None;
            for piece in &root.pieces {
                let (lower, upper) = piece.range();
                let middle = 0.3 * lower + 0.7 * upper;
                let step = 1e-4 * (upper - lower);
                let slope = (piece.section(middle + step).height - piece.section(middle - step).height) / (2.0 * step);
                assert_near(slope / piece.section(middle).height_rate, 1.0, 1e-6, &format!("{shape:?} of z {teeth}"));
                let start = piece.section(lower);
                let (x, y) = end.unwrap_or_else(|| {
                    let (sine, cosine) = root.half_angle.sin_cos();
                    (gear.root_radius * sine, gear.root_radius * cosine)
                });
                assert_near(start.half_thickness, x, 1e-15, "x where pieces join");
                assert_near(start.height, y, 1e-15, "y where pieces join");
                let last = piece.section(upper);
                end = Some((last.half_thickness, last.height));
            }
            let flank = gear.flank(root.form_roll);
            if let Some((x, y)) = end {
                assert_near(flank.half_thickness, x, 1e-15, &format!("{shape:?} of z {teeth}: x at the flank"));
                assert_near(flank.height, y, 1e-15, &format!("{shape:?} of z {teeth}: y at the flank"));
            } else {
                let radius = libm::hypot(flank.half_thickness, flank.height);
                assert_near(radius, gear.base_radius.max(gear.root_radius), 1e-15, "clamped radius");
            }
        }
    }
}

/// An arc tangent to the flank and to the root circle: tangency by its own definition, not by the construction.
#[test]
fn the_circular_fillet_is_tangent() {
    use super::root_piece::Piece;
    for teeth in [19, 48, 100] {
        let gear = gear(teeth, 3.0, 0.0);
        let root = gear.root(RootShape::CircularFillet).unwrap();
        let Piece::Arc { centre_radius, centre_angle, radius, .. } = root.pieces[0] else { panic!("no arc") };
        assert_near(radius, 0.38 * 3e-3, 1e-18, "radius");
        assert_near(centre_radius - radius, gear.root_radius, 1e-17, "distance to the root circle");
        // The nearest point of the flank (involute, radial line below) is one radius away.
        let (x, y) = (centre_radius * centre_angle.sin(), centre_radius * centre_angle.cos());
        let distance = |k: i32| {
            let part = f64::from(k) / 20_000.0;
            let (px, py) = if part < 0.2 {
                let radius = gear.root_radius + part / 0.2 * (gear.base_radius - gear.root_radius);
                (radius * gear.half_base_angle.sin(), radius * gear.half_base_angle.cos())
            } else {
                let flank = gear.flank((part - 0.2) / 0.8 * gear.tip_roll());
                (flank.half_thickness, flank.height)
            };
            (x - px).hypot(y - py)
        };
        let minimum = (0..=20_000).map(distance).fold(f64::INFINITY, f64::min);
        assert_near(minimum * 1e3, radius * 1e3, 1e-6, &format!("distance to the flank of z {teeth}"));
        assert_eq!(root.pieces.len(), if teeth == 19 { 2 } else { 1 });
    }
    // Four teeth are too near for this arc.
    let rack = Rack { addendum: 0.5, dedendum: 0.9, tip_radius: 0.65, ..Rack::ISO_53_A };
    let crowded = Gear::new(&Specification { rack, bore_radius: 1e-3, ..specification(4, 3.0, -0.2) }).unwrap();
    let error = crowded.root(RootShape::CircularFillet).unwrap_err();
    assert_eq!(error.subject(), Subject::Parameter(Parameter::RackTipRadius));
    assert!(error.to_string().contains("would overlap by 0.1"), "{error}");
}

/// Tier: closed form; an arc with the centre at r_f + ρ touches the involute itself from (r_f + ρ)² − r_b² = ρ² on. Its
/// centre is outside the base circle before that, from ρ = r_b − r_f on.
#[test]
fn a_fillet_leaves_the_involute_whole_until_it_touches_it() {
    let gear = gear(30, 3.0, 0.0);
    let (base, root) = (gear.base_radius, gear.root_radius);
    let touching = (base - root) * (base + root) / (2.0 * root);
    assert!(base - root < 0.995 * touching);
    for share in [0.5, 0.995, 0.9999, 1.001, 1.1] {
        let Root { form_roll, pieces, .. } = gear.fillet(share * touching).unwrap();
        assert_eq!(
            (form_roll > 0.0, form_roll >= 0.0, pieces.len()),
            if share > 1.0 { (true, true, 1) } else { (false, true, 2) }
        );
    }
}

/// The apex is where the thickness vanishes, found here by bisection.
#[test]
fn flanks_meet_at_the_apex() {
    for (teeth, shift) in [(12, 0.5), (19, 0.0), (300, 0.0)] {
        let gear = gear(teeth, 3.0, shift);
        let apex = bracketed(0.0, 4.0, |roll| gear.half_angle_at_roll(roll)).unwrap();
        assert_near(gear.apex_roll(), apex, 1e-13, "apex");
        assert!(gear.flank(apex).half_thickness.abs() < 1e-15 * gear.base_radius / 1e-3);
    }
}
