//! Geometry against independently computed tables, the cutter itself, and the refusals.

use proptest::prelude::*;

use super::involute::point_angle;
use super::root::{Root, RootShape};
use super::testing::{pair_19_48, specification};
use super::trochoid::Trochoid;
use super::*;

/// z 17 is just undercut: its trochoid *ends* at r 11.981107, but has crossed the involute before, at 11.9810873104164 (30
/// digits of arithmetic, bisection on the two curves), so that is where the involute starts.
#[test]
fn a_trace_of_undercut_is_seen() {
    let mut gear = specification(17, 0.0);
    (gear.module, gear.bore_radius) = (1.5e-3, 1e-3);
    let built = Gear::new(Side::Pinion, &gear).unwrap();
    assert!(Trochoid::new(&gear).flank_end() < 0.0);
    assert!((built.form_radius * 1e3 / 11.981_087_310_416_4 - 1.0).abs() < 1e-13, "{}", built.form_radius * 1e3);
}

/// Published values: r_b, r_f, r_a, r_form, ψ at r_form, ψ at the root's end, ψ_b, tip thickness (mm and rad).
#[test]
fn the_table_of_three_gears_comes_out() {
    let rows = [
        (17, 1.5, [11.981_081, 10.875, 14.25, 11.981_087, 0.107_304_2, 0.177_228_2, 0.107_304_2, 1.011_12]),
        (19, 3.0, [26.781_240, 24.75, 31.5, 26.799_034, 0.097_561_7, 0.158_572_6, 0.097_577_9, 2.065_70]),
        (30, 3.0, [42.286_168, 41.25, 48.0, 42.801_185, 0.066_003_9, 0.100_429_3, 0.067_264_3, 2.212_20]),
    ];
    for (teeth, module, expected) in rows {
        let mut gear = specification(teeth, 0.0);
        (gear.module, gear.bore_radius) = (module * 1e-3, 1e-3);
        let gear = Gear::new(Side::Pinion, &gear).unwrap();
        let root = Root::new(&gear, RootShape::Trochoid);
        let found = [
            gear.base_radius * 1e3,
            gear.root_radius * 1e3,
            gear.tip_radius * 1e3,
            gear.form_radius * 1e3,
            point_angle(root.junction_roll, gear.half_base_angle),
            root.half_angle,
            gear.half_base_angle,
            gear.tip_thickness() * 1e3,
        ];
        for (index, (found, expected)) in found.into_iter().zip(expected).enumerate() {
            // Half a unit of the last printed digit.
            let digits = if index == 7 {
                5e-6
            } else if index >= 4 {
                6e-8
            } else {
                6e-7
            };
            assert!((found - expected).abs() <= digits, "z {teeth}, value {index}: {found} and {expected}");
        }
    }
}

/// Published values: points of the trochoid of z 17, m 1.5 at quarters of its parameter.
#[test]
fn points_of_the_trochoid_come_out() {
    let mut gear = specification(17, 0.0);
    gear.module = 1.5e-3;
    let curve = Trochoid::new(&gear);
    let alpha = gear.pressure_angle;
    for (share, radius, angle) in
        [(0.25, 11.042_656, 0.136_908), (0.5, 11.335_804, 0.117_700_7), (0.75, 11.644_985, 0.109_590_1)]
    {
        // The parameter is the rack's travel, proportional to cot γ.
        let point = curve.point(libm::atan2(libm::tan(alpha), share));
        assert!((point.radius() * 1e3 - radius).abs() < 6e-7, "{share}: {}", point.radius() * 1e3);
        assert!((point.angle() - angle).abs() < 6e-7, "{share}: {}", point.angle());
    }
}

/// Published value: z 12, the undercut's junction to 12 digits.
#[test]
fn undercut_is_found_where_the_curves_cross() {
    let mut gear = specification(12, 0.0);
    gear.rack.tip_radius = 0.25 / (1.0 - gear.pressure_angle.sin());
    gear.bore_radius = 5e-3;
    let built = Gear::new(Side::Pinion, &gear).unwrap();
    let (gamma, _) = Trochoid::new(&gear).junction(built.base_radius, built.half_base_angle);
    assert!((gamma / 0.363_316_932_453_313_15 - 1.0).abs() < 1e-10, "{gamma}");
    assert!((built.form_radius * 1e3 / 16.954_060_689_822_32 - 1.0).abs() < 1e-12, "{}", built.form_radius * 1e3);
}

#[test]
fn the_zone_ends_and_shifts_are_iso_21771s() {
    let pair = pair_19_48(1.75);
    assert!((pair.centre_distance - 0.1005).abs() < 1e-15);
    // 17.0967 teeth need no shift; below, the shift grows by sin²α/2 per tooth.
    let slope = 0.5 * 20_f64.to_radians().sin().powi(2);
    let shift = Gear::new(Side::Pinion, &specification(19, 0.0)).unwrap().smallest_shift_without_undercut();
    assert!(((17.0967 - 19.0) * slope - shift).abs() < 1e-5, "{shift}");
    let shifted = Pair::new(specification(15, 0.3), specification(40, 0.2), None).unwrap();
    // Closed form of the second kind: zero backlash means the tooth thicknesses on the working circles fill the pitch.
    let working = |gear: &Gear| gear.base_radius / libm::cos(shifted.working_pressure_angle);
    let thickness = |gear: &Gear| 2.0 * working(gear) * gear.half_angle(working(gear));
    let pitch = 2.0 * std::f64::consts::PI * working(&shifted.pinion) / 15.0;
    assert!((thickness(&shifted.pinion) + thickness(&shifted.gear) - pitch).abs() < 1e-15, "backlash");
}

/// What the message of an interference proposes is the border between what is accepted and what is refused.
#[test]
fn an_interference_names_the_largest_tip_that_meshes() {
    for (pinion, gear) in [(12, 48), (14, 100), (17, 19), (48, 12)] {
        let with_tip = |radius: Option<f64>| {
            let mut specifications = [specification(pinion, 0.0), specification(gear, 0.0)];
            specifications[usize::from(gear > pinion)].tip_radius = radius;
            let [first, second] = specifications;
            Pair::new(first, second, None)
        };
        let Err(error) = with_tip(None) else {
            assert_eq!((pinion, gear), (17, 19));
            continue;
        };
        let message = error.to_string();
        let largest = message.split("a tip radius of ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
        let largest = largest.parse::<f64>().unwrap() * 1e-3;
        assert!(with_tip(Some(largest + 2e-9)).is_err(), "{message}");
        let below = with_tip(Some(largest - 2e-9)).map_err(|error| error.to_string());
        // Where so much of the tip has to go, contact may be too short: that is the next message.
        assert!(below.as_ref().err().is_none_or(|error| error.contains("contact ratio")), "{below:?}");
    }
}

#[test]
fn impossible_gears_and_pairs_are_refused_with_values_and_place() {
    let bored = |teeth: u32, shift: f64| specification(teeth, shift);
    let cases: Vec<(&str, &str, Result<Pair, error::GeometryError>)> = vec![
        ("interference", "pinion.teeth", Pair::new(bored(12, 0.0), bored(48, 0.0), None)),
        ("interference", "pinion.teeth", Pair::new(bored(14, 0.0), bored(100, 0.0), None)),
        ("point", "pinion.profile_shift", Pair::new(bored(8, 0.7), bored(30, 0.0), None)),
        ("point", "pinion.profile_shift", Pair::new(bored(15, 1.0), bored(30, 0.0), None)),
        ("jam", "centre_distance", Pair::new(bored(19, 0.0), bored(48, 0.0), Some(0.1))),
        ("contact ratio", "pinion.teeth", Pair::new(bored(19, 0.0), bored(48, 0.0), Some(0.1035))),
        (
            "bore",
            "gear.bore_radius",
            Pair::new(bored(19, 0.0), Specification { bore_radius: 0.069, ..bored(48, 0.0) }, None),
        ),
        (
            "face width",
            "gear.face_width",
            Pair::new(bored(19, 0.0), Specification { face_width: -0.02, ..bored(48, 0.0) }, None),
        ),
        (
            "full round 0.47",
            "rack.tip_radius",
            Pair::new(
                Specification { rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.48 }, ..bored(19, 0.0) },
                bored(48, 0.0),
                None,
            ),
        ),
        (
            "comes to a point",
            "rack.tip_radius",
            Pair::new(
                Specification {
                    pressure_angle: 0.562,
                    rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.0 },
                    ..bored(40, 0.0)
                },
                bored(48, 0.0),
                None,
            ),
        ),
    ];
    for (word, field, result) in cases {
        let error = result.expect_err(word);
        assert!(error.to_string().contains(word), "{error}");
        assert_eq!(error.field(), field, "{error}");
    }
    // 32.14° is where a 1.25 rack loses its tip land.
    let narrow = |angle: f64| Specification {
        pressure_angle: angle,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.0 },
        ..bored(60, 0.0)
    };
    assert!(Gear::new(Side::Pinion, &narrow(32.13_f64.to_radians())).is_ok());
    assert!(Gear::new(Side::Pinion, &narrow(32.15_f64.to_radians())).is_err());
}

/// Signed distance of a gear point to the rack tooth that cut it, at roll angle φ; positive outside the rack's steel.
fn distance_to_rack(gear: &Specification, point: (f64, f64), phi: f64) -> f64 {
    let (m, rack, alpha) = (gear.module, gear.rack, gear.pressure_angle);
    let r = 0.5 * m * f64::from(gear.teeth);
    // Rotate the gear by φ, shift the rack by rφ; the rack's tooth stands in the space beside the tooth.
    let angle = libm::atan2(point.0, point.1) - std::f64::consts::PI / f64::from(gear.teeth) + phi;
    let radius = libm::hypot(point.0, point.1);
    let across = (radius * libm::sin(angle) - r * phi).abs();
    let deep = r + gear.profile_shift * m - radius * libm::cos(angle);
    let (rho, d) = (rack.tip_radius * m, rack.dedendum * m);
    let centre = (0.25 * std::f64::consts::PI * m - (d - rho) * libm::tan(alpha) - rho / libm::cos(alpha), d - rho);
    let (u, v) = (across - centre.0, deep - centre.1);
    let flank = u * libm::cos(alpha) + v * libm::sin(alpha) - rho;
    if u <= 0.0 {
        v - rho
    } else if v * libm::cos(alpha) > u * libm::sin(alpha) {
        libm::hypot(u, v) - rho
    } else {
        flank
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// The cutter itself is the oracle: it touches every point of root and flank, and cuts none away.
    #[test]
    fn every_profile_point_touches_the_swept_rack(
        teeth in 5_u32..120, shift in -0.6_f64..0.9, degrees in 14.5_f64..28.0, round in 0.0_f64..1.0, share in 0.0_f64..1.0,
    ) {
        let mut gear = specification(teeth, shift);
        gear.pressure_angle = degrees.to_radians();
        gear.bore_radius = 0.0;
        let (sin, cos) = (gear.pressure_angle.sin(), gear.pressure_angle.cos());
        let full_round = (0.25 * std::f64::consts::PI - 1.25 * gear.pressure_angle.tan()) * cos / (1.0 - sin);
        gear.rack.tip_radius = round * full_round;
        let Ok(built) = Gear::new(Side::Pinion, &gear) else { return Ok(()) };
        let root = Root::new(&built, RootShape::Trochoid);
        let mut points = Vec::new();
        root.for_each(|start, end, point| {
            let point = point(start + share * (end - start));
            points.push((point.x, point.y));
        });
        let roll = root.junction_roll + share * (built.roll_at(built.tip_radius) - root.junction_roll);
        let angle = point_angle(roll, built.half_base_angle);
        points.push((built.radius_at(roll) * angle.sin(), built.radius_at(roll) * angle.cos()));
        for point in points {
            // The nearest approach over the whole motion, on a grid and then refined around the best place.
            let distance = |phi: f64| distance_to_rack(&gear, point, phi);
            let reach = 2.5 / f64::from(teeth).sqrt().min(f64::from(teeth) / 3.0);
            let (mut centre, mut width) = (0.0, reach.max(1.2));
            let mut best = f64::INFINITY;
            for _ in 0..14 {
                let mut nearest = centre;
                for step in -60..=60 {
                    let phi = centre + width * f64::from(step) / 60.0;
                    if distance(phi) < best {
                        (best, nearest) = (distance(phi), phi);
                    }
                }
                (centre, width) = (nearest, width / 20.0);
            }
            prop_assert!(best.abs() < 1e-12, "z {teeth} x {shift} α {degrees} ρ {}: {best:e} m", gear.rack.tip_radius);
        }
    }
}
