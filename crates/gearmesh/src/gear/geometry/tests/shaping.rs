//! Pinion-type cutters: the cutter itself, rolled by, is the oracle; many teeth make it a rack.

use super::*;
use crate::gear::geometry::outline::Outline;
use crate::gear::geometry::outline::roots::Toe;
use crate::gear::geometry::pinion_cutter::PinionCutter;

fn shaped(teeth: u32, shift: f64, cutter: PinionCutter) -> Specification {
    Specification { bore_radius: 1e-3, cutter: Some(cutter), ..specification(teeth, 3.0, shift) }
}

/// Distance of a point from a tooth of the cutter, whose centreline is the y axis; negative inside. The tooth is a core of involutes and an arc,
/// ρ inside of it, and all that is nearer to it than ρ. Distances from an involute are along its normal, which is tangent to the base circle.
fn distance_to_tooth(specification: &Specification, cutter: &PinionCutter, [x, y]: [f64; 2]) -> f64 {
    let (module, alpha) = (specification.module, specification.pressure_angle);
    let teeth = f64::from(cutter.teeth);
    let base = 0.5 * module * teeth * alpha.cos();
    let round = cutter.tip_radius * module;
    let lands = module * (0.5 * teeth + cutter.profile_shift + cutter.addendum) - round;
    let thickness = PI / 2.0 + 2.0 * cutter.profile_shift * alpha.tan();
    let core = thickness / teeth + alpha.tan() - alpha - round / base;
    let (radius, angle) = (x.hypot(y), x.abs().atan2(y));
    let along = (radius * radius - base * base).max(0.0).sqrt();
    // The foot's length on the same normal.
    let foot = base * ((along / base).atan() - angle + core);
    let end = (lands * lands - base * base).sqrt();
    let corner = core - end / base + (end / base).atan();
    let inside = if angle <= corner && radius > lands {
        radius - lands
    } else if along > foot && foot <= end {
        along - foot
    } else if along <= foot && radius <= lands {
        (along - foot).max(radius - lands)
    } else {
        (x.abs() - lands * corner.sin()).hypot(y - lands * corner.cos())
    };
    inside - round
}

/// Least distance of a point of the gear's tooth to the cutter over the whole roll.
fn distance_to_swept_cutter(gear: &Gear, [x, y]: [f64; 2]) -> f64 {
    let specification = &gear.specification;
    let cutter = specification.cutter.unwrap();
    let (z, z_0) = (f64::from(specification.teeth), f64::from(cutter.teeth));
    let alpha = specification.pressure_angle;
    // a_0 by bisection on the thicknesses of both teeth: together they fill the pitch on the working circles.
    let thickness = |z: f64, shift: f64, working: f64| {
        (PI / 2.0 + 2.0 * shift * alpha.tan()) / z + (alpha.tan() - alpha) - (working.tan() - working)
    };
    let (mut low, mut high) = (1e-3_f64, 1.2_f64);
    for _ in 0..200 {
        let working = 0.5 * (low + high);
        let filled = z * thickness(z, specification.profile_shift, working)
            + z_0 * thickness(z_0, cutter.profile_shift, working);
        *(if filled > PI { &mut low } else { &mut high }) = working;
    }
    let distance = 0.5 * specification.module * alpha.cos() * (z + z_0) / low.cos();
    let pitch = 2.0 * PI / z_0;
    let at = |roll: f64| {
        let (sine, cosine) = roll.sin_cos();
        let (across, up) = (x * cosine + y * sine, distance - (y * cosine - x * sine));
        // About the cutter's centre; its space faces the tooth where nothing has turned.
        let (angle, radius) = (across.atan2(up) - roll * z / z_0 + 0.5 * pitch, across.hypot(up));
        let angle = angle - (angle / pitch).round() * pitch;
        distance_to_tooth(specification, &cutter, [radius * angle.sin(), radius * angle.cos()])
    };
    let reach = (12.0 / z).min(1.2);
    let (steps, centre) = (4000, -x.atan2(y));
    let scan = |k: i32| centre + reach * (2.0 * f64::from(k) / f64::from(steps) - 1.0);
    let values: Vec<f64> = (0..=steps).map(|k| at(scan(k))).collect();
    let mut least = f64::INFINITY;
    // Every valley of the samples: corners make several.
    for (k, window) in (1..).zip(values.windows(3)) {
        if window[1] <= window[0] && window[1] <= window[2] && window[1] < 0.02 * specification.module {
            let (mut lower, mut upper) = (scan(k - 1), scan(k + 1));
            for _ in 0..60 {
                let (left, right) = (lower + 0.381_966 * (upper - lower), upper - 0.381_966 * (upper - lower));
                if at(left) < at(right) { upper = right } else { lower = left }
            }
            least = least.min(at(0.5 * (lower + upper)));
        }
    }
    least
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// Tier: the cutter itself. Every point of root curve and flank touches the swept cutter, which nowhere goes deeper; its tip reaches
    /// the root circle.
    #[test]
    fn the_cutter_touches_every_point_that_it_shapes(
        teeth in 8_u32..80, shift in -0.3..0.7_f64, cutter_teeth in 12_u32..120, cutter_shift in -0.3..0.5_f64,
        angle in 17.0..25.0_f64, round in 0.0..1.0_f64,
    ) {
        let cutter = PinionCutter { teeth: cutter_teeth, profile_shift: cutter_shift, addendum: 1.25, tip_radius: 0.0 };
        let mut specification = shaped(teeth, shift, cutter);
        specification.pressure_angle = angle * DEGREE;
        specification.rack.addendum = 0.8;
        let tip_radius = round * cutter.full_round(&specification);
        specification.cutter = Some(PinionCutter { tip_radius, ..cutter });
        let Ok(gear) = Gear::new(&specification) else { return Err(TestCaseError::reject("no such gear")) };
        let curve = gear.trochoid();
        for k in 0..=6 {
            let part = f64::from(k) / 6.0;
            let point = curve.point_at(part * curve.joint_parameter());
            if k == 0 {
                prop_assert!((point[0].hypot(point[1]) - gear.root_radius).abs() < 1e-14);
            }
            let distance = distance_to_swept_cutter(&gear, point) * 1e3;
            prop_assert!(distance.abs() < 1e-9, "root at {part}: {distance} mm, undercut {}", gear.undercut);
            let flank = gear.flank(gear.form_roll + part * (gear.tip_roll() - gear.form_roll));
            let distance = distance_to_swept_cutter(&gear, [flank.half_thickness, flank.height]) * 1e3;
            prop_assert!(distance.abs() < 1e-9, "flank at {part}: {distance} mm, undercut {}", gear.undercut);
        }
        // Its rates are derivatives.
        let step = 1e-5;
        for q in [0.1, 0.5, 0.9].map(|part| part * curve.joint_parameter()) {
            let [[a, b], [c, d]] = [curve.point_at(q - step), curve.point_at(q + step)];
            let rate = (d - b) / (2.0 * step);
            let section = curve.section(q);
            prop_assert!((section.height_rate - rate).abs() < 1e-8 * gear.base_radius, "{} {rate}", section.height_rate);
            let (tilt, _, _) = curve.rates(q);
            prop_assert!(((c - a) * tilt.cos() + (d - b) * tilt.sin()).abs() < 1e-9 * (c - a).hypot(d - b) + 1e-16);
        }
        if let Ok(outline) = Outline::new(&gear, Toe::of(&gear.root(RootShape::Trochoid).unwrap()), gear.tip, None) {
            for junction in outline.junctions() {
                prop_assert!(junction.position_jump() < 1e-11, "{junction:?}");
            }
        }
    }
}

/// Tier: order of convergence; a cutter of more and more teeth becomes the rack of its addendum and round, as 1/z_0.
#[test]
fn many_teeth_make_it_a_rack() {
    for (teeth, shift) in [(12, 0.2), (20, 0.0), (40, 0.3)] {
        let mut rack = specification(teeth, 3.0, shift);
        rack.bore_radius = 1e-3;
        let gear = Gear::new(&rack).unwrap();
        let curve = gear.trochoid();
        let error = |cutter_teeth: u32| {
            let cutter = PinionCutter { teeth: cutter_teeth, profile_shift: 0.0, addendum: 1.25, tip_radius: 0.38 };
            let shaped = Gear::new(&shaped(teeth, shift, cutter)).unwrap();
            let other = shaped.trochoid();
            let away = |part: f64| {
                let [[a, b], [c, d]] = [&curve, &other].map(|curve| curve.point_at(part * curve.joint_parameter()));
                (c - a).hypot(d - b)
            };
            [away(0.0), away(0.5), away(1.0), (shaped.form_radius - gear.form_radius).abs()]
        };
        for (coarse, fine) in error(1000).into_iter().zip(error(2000)) {
            assert!(coarse < 1e-5 && (coarse < 1e-12 || (coarse / fine - 2.0).abs() < 0.1), "{teeth}: {coarse} {fine}");
        }
        assert!(error(10_000).into_iter().all(|error| error < 2e-6), "{:?}", error(10_000));
    }
}

/// Tier: closed form; just above its least profile shift a gear is not undercut, just below it is; and each refusal names its bound.
#[test]
fn cutters_that_cannot_cut_are_refused_with_numbers() {
    type Case = (PinionCutter, Parameter, &'static str);
    let cutter = PinionCutter { teeth: 25, profile_shift: 0.1, addendum: 1.25, tip_radius: 0.2 };
    let gear = Gear::new(&shaped(14, 0.3, cutter)).unwrap();
    let least = gear.least_shift_without_undercut();
    let is_undercut = |shift: f64| Gear::new(&shaped(14, shift, cutter)).unwrap().undercut;
    assert!(is_undercut(least - 1e-6) && !is_undercut(least + 1e-6), "{least}");
    let cases: [Case; 5] = [
        (PinionCutter { tip_radius: 0.6, ..cutter }, Parameter::CutterTipRadius, "must be 0 to"),
        (PinionCutter { profile_shift: 2.5, ..cutter }, Parameter::CutterProfileShift, "pointed"),
        (
            PinionCutter { teeth: 10, profile_shift: -1.3, tip_radius: 0.0, ..cutter },
            Parameter::CutterProfileShift,
            "no centre distance",
        ),
        (
            PinionCutter { teeth: 8, profile_shift: 0.0, tip_radius: 0.0, ..cutter },
            Parameter::CutterTeeth,
            "no involute",
        ),
        (PinionCutter { teeth: 3, ..cutter }, Parameter::CutterTeeth, "4 to"),
    ];
    for (cutter, parameter, text) in cases {
        let error = Gear::new(&shaped(30, 0.0, cutter)).unwrap_err();
        assert_eq!(error.subject(), Subject::Parameter(parameter), "{error}");
        assert!(error.to_string().contains(text), "{error}");
    }
}
