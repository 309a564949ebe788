//! The full outline: the cutter touches it everywhere and its neighbours nowhere deeper, segments join, rates are rates.

use std::sync::Arc as Shared;

use super::cutter::distance_to_swept_rack;
use super::*;
use crate::gear::geometry::outline::curve::{Curve, OutlinePart, Relief, Segment};
use crate::gear::geometry::outline::junction::Place as Where;
use crate::gear::geometry::outline::roots::Root;
use crate::gear::geometry::outline::roots::base_arc::Base;
use crate::gear::geometry::outline::sample::{Density, Point};
use crate::gear::geometry::outline::tip::Tip;
use crate::gear::geometry::outline::{Outline, roots};
use declare::declared::record_of;
use declare::record::Value;

const MICROMETRE: f64 = 1e-6;

/// A root of a family with those of the words that it has a field for.
pub(super) fn root(family: &str, words: &[(&str, &'static str)]) -> Box<dyn Root> {
    let member = roots::members().iter().find(|member| member.name == family).unwrap();
    let has = |name: &str| member.fields.iter().any(|field| field.name == name);
    let words = words.iter().filter(|(name, _)| has(name));
    let words: Vec<_> = words.map(|(name, word)| (*name, Value::Choice(word))).collect();
    roots::read(family, &record_of(member.fields, &words)).unwrap()
}

/// The outline of a gear with a root of a family and its one option that is a word.
pub(super) fn outlined(
    gear: &Gear,
    family: &str,
    option: (&'static str, &'static str),
) -> Result<Outline, GeometryError> {
    let toe = root(family, &[option]).toe(gear)?;
    Outline::new(gear, toe, Tip::Land, None)
}

fn rack_cut(gear: &Gear) -> Result<Outline, GeometryError> {
    outlined(gear, "trochoid", ("rack_tip", "given"))
}

pub(super) fn shaped(gear: &Gear, family: &str) -> Result<Outline, GeometryError> {
    let option = match family {
        "trochoid" => ("rack_tip", "given"),
        "arc" => ("formulas", "derived"),
        _ => ("size", "base_circle"),
    };
    outlined(gear, family, option)
}

fn refusal(gear: &Gear, family: &str) -> String {
    let error = shaped(gear, family).unwrap_err();
    assert_eq!(error.subject(), Subject::Root);
    error.to_string()
}

/// How deep in the rack a point lies that is 1 outside of the profile. Its depth is its distance from the nearest side of
/// the rack's tooth; on a root that a sharp corner cuts the corner passes over it, at its deepest with the point on the
/// bisector, β = 45° + α/2 from either side. With the corner's path at the angle γ that is sin β/cos(γ − β): 1 at both ends
/// of the root, γ = 90° and α, and at least sin β between, 0.79 for 14.5°.
fn depth_in_a_corner(segment: &Segment, parameter: f64, specification: &Specification) -> f64 {
    if !matches!(segment.curve, Curve::Trochoid(_)) || specification.rack.tip_radius > 0.0 {
        return 1.0;
    }
    let bisector = 0.5 * (0.5 * PI + specification.pressure_angle);
    bisector.sin() / (0.5 * PI - parameter.sinh().atan() - bisector).cos()
}

const SPARSE: Density = Density { points: 24, chord_error: None };

/// Tier: the cutter itself; of a tooth that a sharp corner leaves a neck of 2 µm, both sides are touched there.
#[test]
fn a_neck_of_micrometres_is_touched_on_both_sides() {
    let mut specification = specification(5, 1.0, -0.491_942_831_838_526_5);
    specification.pressure_angle = 20.190_466_112_596_017 * DEGREE;
    specification.rack = Rack { addendum: 0.7, dedendum: 1.180_945_443_738_292, tip_radius: 0.0, ..Rack::ISO_53_A };
    specification.bore_radius = 1e-4;
    let gear = Gear::new(&specification).unwrap();
    let outline = rack_cut(&gear).unwrap();
    let mut thinnest = f64::INFINITY;
    for point in outline.tooth(SPARSE) {
        let ([x, y], part) = (point.local.position, outline.segments[point.segment].part);
        if part != OutlinePart::TipLand {
            thinnest = thinnest.min(2.0 * x.abs());
            let distance = distance_to_swept_rack(&gear, x, y);
            assert!(distance.abs() < 1e-12, "{part:?} at {x}, {y}: {distance}");
        }
    }
    assert!(thinnest < 2.5e-6, "{thinnest}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, max_global_rejects: 100_000, ..ProptestConfig::default() })]

    /// Tier: the cutter itself; the rolling rack, all its teeth, touches root land, root and flank of three neighbouring
    /// teeth to 1e-9 mm, goes nowhere deeper, and leaves the tip alone.
    #[test]
    fn the_cutter_touches_the_whole_outline(
        teeth in 5_u32..200, shift in -0.6..1.2_f64, angle in 14.5..30.0_f64, dedendum in 1.0..1.5_f64,
        round in 0.0..1.0_f64, sharp in any::<bool>(), full in any::<bool>(), neighbour in -1..=1_i32,
    ) {
        let mut specification = specification(teeth, 1.0, shift);
        specification.pressure_angle = angle * DEGREE;
        specification.rack = Rack { addendum: 0.7, dedendum, tip_radius: 0.0, ..Rack::ISO_53_A };
        let largest = crate::gear::geometry::trochoid::full_round(&specification).max(0.0);
        specification.rack.tip_radius = largest * match (sharp, full) { (true, _) => 0.0, (_, true) => 1.0, _ => round };
        specification.bore_radius = 1e-4;
        let Ok(gear) = Gear::new(&specification) else { return Err(TestCaseError::reject("no such gear")) };
        let Ok(outline) = rack_cut(&gear) else { return Err(TestCaseError::reject("cut off")) };
        let (sine, cosine) = (2.0 * PI * f64::from(neighbour) / f64::from(teeth)).sin_cos();
        for point in outline.tooth(SPARSE) {
            // Also 1e-8 mm outside the tooth, where the oracle must see that much.
            let [x, y] = point.local.position;
            let [along, up] = point.local.tangent;
            let [distance, outside] = [0.0, 1e-11].map(|out| {
                let (x, y) = (x + out * up, y - out * along);
                distance_to_swept_rack(&gear, cosine * x - sine * y, sine * x + cosine * y) * 1e3
            });
            let part = outline.segments[point.segment].part;
            if part == OutlinePart::TipLand {
                prop_assert!(distance > -1e-9, "{part:?}: {distance} mm");
                continue;
            }
            prop_assert!(distance.abs() < 1e-9, "{part:?}: {distance} mm, undercut {}", gear.undercut);
            // Where the rack's corner rolls on the pitch line itself it leaves a root of nanometres, ρ + e²/(r + e), against
            // which 1e-8 mm are not small.
            let depth = 1e-3 * (dedendum - specification.rack.tip_radius - shift);
            let root = 1e-3 * specification.rack.tip_radius + depth * depth / (gear.reference_radius + depth);
            // The corner that undercut leaves: there the oracle finds one of two curves, and sees the other's direction.
            let corner = gear.undercut && (x.hypot(y) - gear.form_radius).abs() < 1e-9;
            if corner || root < 1e-9 && part != OutlinePart::RootLand {
                continue;
            }
            let share = depth_in_a_corner(&outline.segments[point.segment], point.parameter, &specification);
            prop_assert!((outside + share * 1e-8).abs() < 1e-9, "{part:?}: {outside} mm outside, {share}, undercut {}", gear.undercut);
        }
    }

    /// Tier: invariant; every segment begins where the one before ended, whatever the root and the tip.
    #[test]
    fn outlines_have_no_gaps(
        teeth in 5_u32..120, shift in -0.3..0.8_f64, angle in 14.5..30.0_f64, dedendum in 1.0..1.5_f64, module in 0.05..50.0_f64,
        tip in 0_u8..3, size in 0.001..0.2_f64, depth in 0.0..30.0_f64,
    ) {
        let mut specification = specification(teeth, module, shift);
        specification.pressure_angle = angle * DEGREE;
        specification.rack = Rack { addendum: 0.9, dedendum, tip_radius: 0.2, ..Rack::ISO_53_A };
        let Ok(gear) = Gear::new(&specification) else { return Err(TestCaseError::reject("no such gear")) };
        let size = size * gear.specification.module;
        let tip = [Tip::Land, Tip::Chamfer(size), Tip::Rounding(size)][usize::from(tip)];
        let relief: Shared<dyn Relief> = Shared::new(Linear { start: 0.6 * gear.tip_roll(), slope: depth * 1e-3 * gear.specification.module });
        for family in roots::FAMILIES {
            let words = [("rack_tip", "given"), ("formulas", "derived"), ("size", "largest")];
            let Ok(toe) = root(family.member.name, &words).toe(&gear) else { continue };
            for relief in [None, Some(Shared::clone(&relief))] {
                let Ok(outline) = Outline::new(&gear, toe.clone(), tip, relief) else { continue };
                let r = gear.tip_radius;
                for junction in outline.junctions() {
                    prop_assert!(junction.position_jump() < 1e-12 * r, "{} at {:?}: {:e} m", family.member.name, junction.place, junction.position_jump());
                }
                check_curves(&outline, r).map_err(TestCaseError::fail)?;
                let last = outline.segments.last().unwrap();
                prop_assert!(last.end()[0].abs() < 1e-15 * r.max(1.0));
                for segment in &outline.segments {
                    check_rates(segment, r).map_err(TestCaseError::fail)?;
                }
            }
        }
    }
}

/// That the curves of a tooth, one after the other, are the tooth, of as many points as foreseen.
fn check_curves(outline: &Outline, r: f64) -> Result<(), String> {
    let (curves, tooth) = (outline.tooth_by_curves(SPARSE), outline.tooth(SPARSE));
    let numbers = [curves.len(), curves.iter().map(Vec::len).sum(), outline.half(SPARSE).len()];
    let foreseen = [2 * outline.segments.len() - 1, outline.points_by_curves(SPARSE), outline.points_of_half(SPARSE)];
    let joined = curves.iter().enumerate().flat_map(|(index, curve)| &curve[usize::from(index > 0)..]);
    let apart = joined.zip(&tooth).map(|(a, b)| {
        let ([x, y], [across, up]) = (a.local.position, b.local.position);
        (x - across).hypot(y - up)
    });
    let (count, farthest) = apart.fold((0, 0.0_f64), |(count, farthest), apart| (count + 1, farthest.max(apart)));
    if numbers == foreseen && count == tooth.len() && farthest < 1e-12 * r {
        Ok(())
    } else {
        Err(format!("{numbers:?} for {foreseen:?}, {count} for {} points, {farthest:e} m apart", tooth.len()))
    }
}

/// Relief that grows linearly with the roll angle from its start.
#[derive(Debug)]
struct Linear {
    start: f64,
    slope: f64,
}

impl Relief for Linear {
    fn depth(&self, roll: f64) -> f64 {
        self.slope * (roll - self.start).max(0.0)
    }

    fn breaks(&self) -> Vec<f64> {
        vec![self.start]
    }
}

/// Tangents are directions of differences of points, curvatures differences of tangents.
fn check_rates(segment: &Segment, size: f64) -> Result<(), String> {
    let at = |share: f64| segment.local(segment.parameter(share));
    let (low, middle, high) = (at(0.45), at(0.5), at(0.55));
    let chord = [0, 1].map(|axis| high.position[axis] - low.position[axis]);
    let length = chord[0].hypot(chord[1]);
    if length < 1e-6 * size {
        return Ok(());
    }
    let what = format!("{:?} {}", segment.part, segment.curve.name());
    // Five-point differences over the parameter would need the curve itself; a chord's direction is that of the tangent
    // in its middle up to the change of curvature along it.
    let off = (middle.tangent[0] * chord[1] - middle.tangent[1] * chord[0]) / length;
    if off.abs() > 2e-2 || middle.tangent[0] * chord[0] + middle.tangent[1] * chord[1] < 0.0 {
        return Err(format!("{what}: tangent {:?} along {chord:?}", middle.tangent));
    }
    let turned = (low.tangent[0] * high.tangent[1] - low.tangent[1] * high.tangent[0]).asin();
    let mean = (low.curvature + 4.0 * middle.curvature + high.curvature) / 6.0;
    if (turned - mean * length).abs() > 2e-2 * turned.abs() + 1e-7 {
        return Err(format!("{what}: turned {turned}, curvature gives {}", mean * length));
    }
    Ok(())
}

/// The rates of each kind of curve, by central differences of the curve itself: 1e-7.
#[test]
fn tangents_and_curvatures_are_rates() {
    let gear = gear(23, 3.0, 0.2);
    let relief: Shared<dyn Relief> = Shared::new(Linear { start: 0.0, slope: 2e-4 });
    let toe = |family| root(family, &[("rack_tip", "given")]).toe(&gear);
    let plain = Outline::new(&gear, toe("trochoid").unwrap(), Tip::Rounding(2e-4), None).unwrap();
    let modified = Outline::new(&gear, toe("trochoid").unwrap(), Tip::Chamfer(2e-4), Some(relief)).unwrap();
    let mut seen = std::collections::BTreeSet::new();
    for segment in plain.segments.iter().chain(&modified.segments) {
        seen.insert(segment.curve.name());
        let middle = 0.5 * (segment.from + segment.to);
        let whole = segment.to - segment.from;
        let near = |step: f64| [-step, 0.0, step].map(|by| segment.curve.point(middle + by));
        let (step, [before, _, after]) = (1e-4 * whole, near(1e-4 * whole));
        let rate = [0, 1].map(|axis| (after[axis] - before[axis]) / (2.0 * step));
        let (step, [before, at, after]) = (4e-3 * whole, near(4e-3 * whole));
        let second = [0, 1].map(|axis| (after[axis] - 2.0 * at[axis] + before[axis]) / (step * step));
        let speed = rate[0].hypot(rate[1]);
        let local = segment.local(middle);
        let forward = step.signum();
        for axis in [0, 1] {
            assert_near(local.tangent[axis], forward * rate[axis] / speed, 1e-7, segment.curve.name());
        }
        let curvature = forward * (rate[0] * second[1] - rate[1] * second[0]) / speed.powi(3);
        assert_near(local.curvature, curvature, 1e-4 * curvature.abs().max(100.0), segment.curve.name());
    }
    assert_eq!(seen.len(), 5, "{seen:?}");
}

/// Continuity as numbers: which junctions are smooth and by how much the others turn.
#[test]
fn junctions_are_smooth_where_they_must_be() {
    for (teeth, shift, family) in [
        (30, 0.0, "trochoid"),
        (48, 0.3, "trochoid"),
        (19, 0.0, "trochoid"),
        (28, 0.0, "tangent_arc"),
        (28, 0.0, "optimised_arc"),
        (17, 0.0, "optimised_arc"),
    ] {
        let gear = gear(teeth, 3.0, shift);
        let outline = shaped(&gear, family).unwrap();
        for junction in outline.junctions() {
            let corner =
                matches!(junction.place, Where::Behind(at) if outline.segments[at + 1].part == OutlinePart::TipLand);
            assert!(junction.position_jump() < 1e-16, "{family} {teeth} {junction:?}");
            assert_eq!(
                junction.is_smooth(1e-16, 3e-8),
                !corner,
                "{family} {teeth} {:?}: {}",
                junction.place,
                junction.tangent_jump()
            );
            if corner {
                // The flank meets the tip circle at the pressure angle there.
                let expected = 0.5 * PI - gear.tip_roll().atan();
                assert_near(junction.tangent_jump(), expected, 1e-14, "tip corner");
            }
        }
    }
    // Tier: closed form; the trochoid's radius of curvature on the root circle is ρ + e²/(r + e).
    let outline = rack_cut(&gear(30, 3.0, 0.0)).unwrap();
    let root = outline.segments.iter().find(|segment| segment.part == OutlinePart::Root).unwrap();
    let (round, depth, reference) = (0.38 * 3e-3, 0.87 * 3e-3, 45e-3);
    assert_near(-1.0 / root.local(root.from).curvature, round + depth * depth / (reference + depth), 1e-17, "radius");
    // Undercut is a corner that sticks out: the profile turns left when one goes up.
    let outline = rack_cut(&gear(12, 3.0, 0.0)).unwrap();
    let joint = outline.junctions().into_iter().find(|junction| junction.place == Where::Behind(1)).unwrap();
    assert!(joint.position_jump() < 1e-16 && joint.tangent_jump() > 0.1, "{joint:?}");
}

/// Tier: published value; the arc of zhai2020 for z 17, m 1.5 mm is its equation 31, to every printed digit.
#[test]
fn the_article_s_arc_is_the_one_it_prints() {
    let gear = gear(17, 1.5, 0.0);
    let base = Base::new(&gear, "an arc").unwrap();
    let circle = base.article_circle();
    for (found, printed) in
        [(circle.centre[0], 2.276_488_9), (circle.centre[1], 11.805_171), (circle.radius, 0.999_081_0)]
    {
        let digits = if printed > 10.0 { 5e-7 } else { 5e-8 };
        assert_near(found * 1e3, printed, digits, "equation 31");
    }
    // It misses the root circle by 0.149 mm, and the neighbouring arc cuts it off in the middle of the space.
    assert_near(base.gap(circle) * 1e3, 0.149, 5e-4, "gap");
    let outline = shaped(&gear, "arc").unwrap();
    let junctions = outline.junctions();
    assert!(junctions[0].place == Where::Space && junctions[0].tangent_jump() < -0.1, "{:?}", junctions[0]);
    assert!(junctions[1].is_smooth(1e-16, 1e-12), "on the base circle: {:?}", junctions[1]);
    // As printed, the flank has a corner of 2θ on the base circle.
    let printed = outlined(&gear, "arc", ("formulas", "printed")).unwrap();
    assert_near(
        printed.junctions()[1].tangent_jump().abs(),
        2.0 * base.angle,
        1e-12,
        "corner of equation 20 as printed",
    );
    // With 23 teeth and a deeper rack the arc ends above the root circle: a step.
    let mut deep = specification(23, 0.5, 0.0);
    deep.rack = Rack { addendum: 1.0, dedendum: 1.5, tip_radius: 0.3, ..Rack::ISO_53_A };
    let outline = shaped(&Gear::new(&deep).unwrap(), "arc").unwrap();
    let parts: Vec<_> = outline.segments.iter().map(|segment| segment.part).collect();
    assert_eq!(parts[parts.len() - 3..], [OutlinePart::Root, OutlinePart::Flank, OutlinePart::TipLand], "{parts:?}");
}

/// Tier: closed form; r_c = (r_b² − r_f²)/(2 r_f) touches the root circle, and constructions that do not exist say so.
#[test]
fn arcs_that_do_not_exist_are_refused_with_numbers() {
    let touching = shaped(&gear(28, 3.0, 0.0), "tangent_arc").unwrap();
    let base = Base::new(&gear(28, 3.0, 0.0), "an arc").unwrap();
    assert!(base.gap(base.tangent_circle(base.touching_radius())).abs() < 1e-17);
    let root = touching.segments.iter().find(|segment| segment.part == OutlinePart::Root).unwrap();
    assert_near(1.0 / root.local(root.from).curvature, -base.touching_radius(), 1e-17, "radius");

    for family in ["arc", "tangent_arc", "optimised_arc"] {
        assert!(shaped(&gear(41, 3.0, 0.0), family).is_ok(), "{family}");
        let message = refusal(&gear(42, 3.0, 0.0), family);
        assert!(message.contains("so the root radius 59.25 mm must be below the base radius 59.2006 mm"), "{message}");
        assert!(message.contains("below 41.4543 teeth, and there are 42"), "{message}");
    }
    let message = refusal(&gear(17, 1.5, 0.0), "tangent_arc");
    assert!(message.contains("would overlap by 0.41") && message.contains("at most 0.91"), "{message}");
    let largest = outlined(&gear(17, 1.5, 0.0), "tangent_arc", ("size", "largest")).unwrap();
    assert!(largest.junctions()[0].is_smooth(1e-15, 1e-7), "{:?}", largest.junctions()[0]);
    assert_eq!(largest.segments[0].part, OutlinePart::Root);
}

/// The tip's break is as large as asked for, and is refused with the largest where it does not fit.
#[test]
fn tips_are_broken_as_asked() {
    let gear = gear(19, 3.0, 0.0);
    let with = |tip| {
        let toe = root("trochoid", &[("rack_tip", "given")]).toe(&gear);
        Outline::new(&gear, toe.unwrap(), tip, None)
    };
    let chamfered = with(Tip::Chamfer(0.3e-3)).unwrap();
    assert_near(gear.radius_at(chamfered.end_roll), gear.tip_radius - 0.3e-3, 1e-16, "start of the chamfer");
    let land = chamfered.segments.last().unwrap().start();
    let corner = gear.half_angle_at_roll(gear.tip_roll());
    assert_near((corner - land[0].atan2(land[1])) * gear.tip_radius, 0.3e-3, 1e-16, "end of the chamfer");
    let rounded = with(Tip::Rounding(0.3e-3)).unwrap();
    for junction in rounded.junctions() {
        assert!(junction.is_smooth(1e-16, 1e-8), "{junction:?}");
    }
    for tip in [Tip::Chamfer as fn(f64) -> Tip, Tip::Rounding] {
        let error = with(tip(5e-3)).unwrap_err();
        assert_eq!(error.subject(), Subject::Tip);
        let Problem::TipBreakTooLarge { largest, .. } = error.problem else { panic!("{error}") };
        assert!(with(tip(largest.0 * (1.0 - 1e-6))).is_ok() && with(tip(largest.0 * (1.0 + 1e-6))).is_err(), "{error}");
    }
}

/// As many points are given as asked for, and a chord error asked for is met, by a finer check of every chord.
#[test]
fn points_are_as_many_and_chords_as_near_as_asked() {
    let gear = gear(19, 3.0, 0.0);
    let outline = rack_cut(&gear).unwrap();
    for points in [10, 24, 200, 201] {
        let density = Density { points, chord_error: None };
        assert_eq!(outline.tooth(density).len(), 2 * points.div_ceil(2) + 1, "{points}");
        assert_eq!(outline.whole(density).len(), 19 * 2 * points.div_ceil(2));
    }
    for error in [10.0, 1.0, 0.1] {
        let coarse = outline.half(Density { points: 8, chord_error: Some(error * MICROMETRE) });
        let fine = outline.half(Density { points: 20_000, chord_error: None });
        let distance = |p: [f64; 2]| {
            let near = |pair: &[Point]| segment_distance(p, pair[0].local.position, pair[1].local.position);
            coarse.windows(2).map(near).fold(f64::INFINITY, f64::min)
        };
        let farthest = fine.iter().step_by(7).map(|point| distance(point.local.position)).fold(0.0, f64::max);
        assert!(farthest <= 1.02 * error * MICROMETRE, "{farthest} for {error} um");
        assert!(farthest > 0.1 * error * MICROMETRE, "{farthest} for {error} um: too many points");
    }
    // The polygon goes round once, its area between that of the root circle and that of the tip circle.
    let whole = outline.whole(Density { points: 400, chord_error: None });
    let area: f64 = (0..whole.len())
        .map(|k| {
            let ([a, b], [c, d]) = (whole[k], whole[(k + 1) % whole.len()]);
            0.5 * (a * d - b * c)
        })
        .sum();
    assert!(area > PI * gear.root_radius.powi(2) && area < PI * gear.tip_radius.powi(2), "{area}");
    // Turned by a pitch it is itself, the last tooth's neighbour being the first.
    let (tooth, (sine, cosine)) = (whole.len() / 19, (2.0 * PI / 19.0).sin_cos());
    for (at, [x, y]) in whole.iter().enumerate() {
        let next = whole[(at + tooth) % whole.len()];
        let away = (next[0] - (cosine * x - sine * y)).hypot(next[1] - (sine * x + cosine * y));
        assert!(away < 1e-15, "{at}: {away}");
    }
}

fn segment_distance([x, y]: [f64; 2], [a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    let (dx, dy) = (c - a, d - b);
    let along = (((x - a) * dx + (y - b) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
    (x - a - along * dx).hypot(y - b - along * dy)
}

/// Tier: invariant; an arc that crosses the root circle ends on it, one that stays outside goes on to it in a straight step.
#[test]
fn arcs_reach_from_the_root_circle_to_the_base_circle() {
    let base = Base::new(&gear(30, 3.0, 0.0), "an arc").unwrap();
    assert!(1.3 * base.touching_radius() < base.middle_radius());
    for (share, pieces) in [(0.6, 2), (0.95, 2), (1.05, 1), (1.3, 1)] {
        let circle = base.tangent_circle(share * base.touching_radius());
        let lowest = circle.centre[1].atan2(circle.centre[0]) + PI;
        let segments = base.segments(circle, lowest);
        assert_eq!(segments.len(), pieces, "{share}");
        let [x, y] = segments[0].start();
        assert_near(x.hypot(y), base.root_radius, 1e-15, "the root circle");
        let [x, y] = segments[pieces - 1].end();
        assert_near((x - base.a[0]).hypot(y - base.a[1]), 0.0, 1e-15, "the base circle");
    }
}
