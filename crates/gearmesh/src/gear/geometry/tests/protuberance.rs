//! Racks with protuberance, and teeth that are ground: the rack itself is the oracle, as in `cutter.rs`.

use super::cutter::{distance_to_swept, distance_to_trapezoid};
use super::*;
use crate::gear::geometry::outline::Outline;
use crate::gear::geometry::outline::roots::Toe;
use crate::gear::geometry::root_piece::Piece;
use crate::gear::geometry::trochoid::full_round;

/// One tooth of the rack against the finished tooth: the union of the rounded tip with the straight sides of the protuberance, and
/// of the trapezoid of the finished flanks down to where both cross. Both are convex, so the smaller distance is that of the union.
fn distance_to_tool_tooth(specification: &Specification, [x, y]: [f64; 2]) -> f64 {
    let (module, rack) = (specification.module, &specification.rack);
    let (alpha, side) = (specification.pressure_angle, rack.protuberance_angle);
    let round = rack.tip_radius * module;
    let beyond = (rack.protuberance - rack.machining_allowance) * module;
    let y = y + specification.profile_shift * module;
    let depth = rack.dedendum * module - round;
    // Half the width of the finished flanks' trapezoid at a depth.
    let finished = |depth: f64| module * PI / 4.0 - depth * alpha.tan();
    let core = finished(depth) + (beyond - round) / alpha.cos();
    if beyond <= 0.0 {
        return distance_to_trapezoid([core, depth], alpha, round, [x, y]);
    }
    let tip = distance_to_trapezoid([core, depth], side, round, [x, y]);
    // The side at the depth of the round's centre is ρ/cos α_prP outside of it.
    let crossing = depth - (core + round / side.cos() - finished(depth)) / (alpha.tan() - side.tan());
    tip.min(distance_to_trapezoid([finished(crossing), crossing], alpha, 0.0, [x, y]))
}

fn distance(gear: &Gear, [x, y]: [f64; 2]) -> f64 {
    distance_to_swept(gear, x, y, |x, y| distance_to_tool_tooth(&gear.specification, [x, y]))
}

fn tooled(teeth: u32, shift: f64, protuberance: f64, allowance: f64) -> Specification {
    let mut specification = specification(teeth, 3.0, shift);
    specification.rack = Rack {
        dedendum: 1.4,
        tip_radius: 0.3,
        protuberance,
        machining_allowance: allowance,
        notch_radius: 0.15,
        ..Rack::ISO_53_A
    };
    specification.bore_radius = 1e-3;
    specification
}

/// Points of the root, `count` on each piece, and which piece.
fn points(root: &Root, count: u32) -> Vec<(usize, [f64; 2])> {
    let of = |(index, piece): (usize, &Piece)| {
        let (from, to) = piece.range();
        let piece = *piece;
        (0..=count).map(move |k| {
            let section = piece.section(from + f64::from(k) / f64::from(count) * (to - from));
            (index, [section.half_thickness, section.height])
        })
    };
    root.pieces.iter().enumerate().flat_map(of).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    /// Tier: the cutter itself. Every point of root curve, protuberance and flank touches the swept tool, which nowhere goes
    /// deeper; the pieces of the root meet.
    #[test]
    fn the_tool_touches_every_point(
        teeth in 7_u32..90, shift in -0.4..0.9_f64, angle in 14.5..28.0_f64, side in 0.2..0.95_f64, round in 0.0..1.0_f64,
        protuberance in 0.0..0.08_f64, share in 0.0..1.0_f64,
    ) {
        let mut specification = tooled(teeth, shift, protuberance, share * protuberance);
        specification.pressure_angle = angle * DEGREE;
        specification.rack.protuberance_angle = side * angle * DEGREE;
        specification.rack.addendum = 0.8;
        specification.rack.tip_radius = round * full_round(&specification);
        let Ok(gear) = Gear::new(&specification) else { return Err(TestCaseError::reject("no such gear")) };
        let root = gear.root(RootShape::Trochoid).unwrap();
        let points = points(&root, 6);
        for (piece, point) in &points {
            let distance = distance(&gear, *point) * 1e3;
            prop_assert!(distance.abs() < 1e-9, "piece {piece} of {}: {distance} mm", root.pieces.len());
        }
        for pair in points.windows(2).filter(|pair| pair[0].0 != pair[1].0) {
            let [[a, b], [c, d]] = [pair[0].1, pair[1].1];
            prop_assert!((c - a).hypot(d - b) < 1e-12, "pieces do not meet");
        }
        for k in 0..=6 {
            let flank = gear.flank(gear.form_roll + f64::from(k) / 6.0 * (gear.tip_roll() - gear.form_roll));
            let point = [flank.half_thickness, flank.height];
            let distance = distance(&gear, point) * 1e3;
            prop_assert!(distance.abs() < 1e-9, "flank at {k}: {distance} mm");
            if k == 0 {
                let [x, y] = points[points.len() - 1].1;
                prop_assert!((x - point[0]).hypot(y - point[1]) < 1e-11, "the root does not reach the flank");
            }
        }
    }

    /// Tier: the cutter itself, and a circle. Where stock is left the tool touches every point of the root curve; the notch is a
    /// circle inside what the tool has left, tangent to the flank where it begins.
    #[test]
    fn grinding_leaves_a_notch(
        teeth in 12_u32..90, shift in -0.2..0.7_f64, protuberance in 0.0..0.04_f64, stock in 0.005..0.05_f64,
    ) {
        let specification = tooled(teeth, shift, protuberance, protuberance + stock);
        let Ok(gear) = Gear::new(&specification) else { return Err(TestCaseError::reject("no such gear")) };
        let root = gear.root(RootShape::Trochoid).unwrap();
        let generated = gear.generated().unwrap();
        if generated.joint.undercut { return Err(TestCaseError::reject("undercut takes the stock away")) }
        if straight_end(&specification) > stock {
            prop_assert!((generated.notch_depth / 3e-3 - stock).abs() < 1e-12, "{}", generated.notch_depth);
        }
        let flank = gear.flank(gear.form_roll);
        let [sine, cosine] = [gear.load_angle(gear.form_roll).sin(), gear.load_angle(gear.form_roll).cos()];
        let radius = 0.15 * 3e-3;
        let centre = [flank.half_thickness + radius * cosine, flank.height + radius * sine];
        for (piece, [x, y]) in points(&root, 6) {
            let distance = distance(&gear, [x, y]) * 1e3;
            if piece == 0 {
                prop_assert!(distance.abs() < 1e-9, "root: {distance} mm");
                let outside = (x - centre[0]).hypot(y - centre[1]) / radius - 1.0;
                prop_assert!(outside > -1e-9, "root: {outside} inside the notch");
            } else {
                prop_assert!(distance > -1e-9, "notch: {distance} mm");
                prop_assert!(((x - centre[0]).hypot(y - centre[1]) / radius - 1.0).abs() < 1e-9);
            }
        }
        let toe = Outline::new(&gear, Toe::of(&root), gear.tip, None).unwrap();
        for junction in toe.junctions() {
            prop_assert!(junction.position_jump() < 1e-12, "{junction:?}");
        }
    }
}

/// Where the rack's flank ends on the path of contact \[modules\]; below 0 it undercuts.
fn straight_end(specification: &Specification) -> f64 {
    let (sine, rack) = (specification.pressure_angle.sin(), &specification.rack);
    let depth = rack.dedendum - specification.profile_shift - rack.tip_radius * (1.0 - sine);
    0.5 * f64::from(specification.teeth) * sine - depth / sine
}

/// Tier: closed form; each refusal names the bound: the land of the tool, π/4 cos α − h_fP sin α without protuberance.
#[test]
fn what_cannot_cut_is_refused_with_numbers() {
    type Case = (fn(&mut Rack), Parameter, &'static str);
    let refused = |rack: fn(&mut Rack)| {
        let mut specification = tooled(20, 0.0, 0.0, 0.0);
        rack(&mut specification.rack);
        Gear::new(&specification).unwrap_err()
    };
    let cases: [Case; 5] = [
        (|rack| rack.protuberance = -0.1, Parameter::Protuberance, "0 to 1 modules"),
        (
            |rack| (rack.protuberance, rack.protuberance_angle) = (0.05, 20.0 * DEGREE),
            Parameter::ProtuberanceAngle,
            "below the pressure angle, 20 deg",
        ),
        (|rack| rack.machining_allowance = 0.4, Parameter::MachiningAllowance, "must be below 0.2592"),
        (
            |rack| (rack.protuberance, rack.protuberance_angle) = (0.4, 19.0 * DEGREE),
            Parameter::Protuberance,
            "cuts the flank away",
        ),
        (
            |rack| (rack.machining_allowance, rack.notch_radius) = (0.03, 0.0),
            Parameter::NotchRadius,
            "must be above 0.0299984 and at most",
        ),
    ];
    for (rack, parameter, text) in cases {
        let error = refused(rack);
        assert_eq!(error.subject(), Subject::Parameter(parameter), "{error}");
        assert!(error.to_string().contains(text), "{error}");
    }
}
