//! The mate's tip on its way past a root: against polylines of the path, against what is known of it, and how many points
//! of a root it takes.

use super::outline::{root, shaped};
use super::*;
use crate::gear::geometry::outline::Outline;
use crate::gear::geometry::outline::curve::{Curve, OutlinePart};
use crate::gear::geometry::outline::sample::Density;
use crate::gear::geometry::outline::tip::Tip;
use crate::gear::geometry::tip_path::{Corner, TipPath};

const SIDES: [Side; 2] = [Side::Pinion, Side::Gear];

/// The frame of the mate's tooth as that of the gear's tooth sees it: sine and cosine of the mate's turn and of the gear's.
pub(super) type Turns = [(f64, f64); 2];

/// Both gears turned: the mate by `angle`, with the flanks of the gear's right side touching.
pub(super) fn turns(pair: &GearPair, side: Side, angle: f64) -> Turns {
    let (own, mate) = (pair.side(side), pair.side(side.other()));
    let [z, z_mate] = [own, mate].map(|gear| f64::from(gear.specification.teeth));
    // Backlash: half of it lies on either side of the mate's tooth when both are in the middle.
    let pitch = |gear: &Gear| gear.base_radius / pair.working_pressure_angle.cos();
    let width = |gear: &Gear| gear.half_angle(pitch(gear)) * pitch(gear);
    let slack = (PI / z * pitch(own) - width(own) - width(mate)) / pitch(own);
    // The gear turns along; its tooth is half a pitch to the left of the space.
    [angle.sin_cos(), (-(angle * z_mate / z + PI / z - slack)).sin_cos()]
}

/// Where a point of the mate's tooth is in the frame of the gear's tooth.
pub(super) fn seen(pair: &GearPair, [(sine, cosine), (back_sine, back_cosine)]: Turns, [x, y]: [f64; 2]) -> [f64; 2] {
    // The mate's tooth hangs down from (0, a) and swings to the left, towards the tooth whose right root is meant.
    let [left, down] = [x * cosine + y * sine, y * cosine - x * sine];
    let [x, y] = [-left, pair.centre_distance - down];
    [x * back_cosine - y * back_sine, x * back_sine + y * back_cosine]
}

/// Vertices of a polyline that lie together: those from `first` to `last` are within `radius` of `centre`.
struct Stretch {
    first: usize,
    last: usize,
    centre: [f64; 2],
    radius: f64,
}

impl Stretch {
    fn of(path: &[[f64; 2]]) -> Vec<Self> {
        let step = 48;
        let starts = (0..path.len() - 1).step_by(step);
        let stretch = |first: usize| {
            let last = (first + step).min(path.len() - 1);
            let centre = path[usize::midpoint(first, last)];
            let radius = path[first..=last].iter().map(|&vertex| between(vertex, centre)).fold(0.0, f64::max);
            Self { first, last, centre, radius }
        };
        starts.map(stretch).collect()
    }
}

pub(super) fn between([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    (c - a).hypot(d - b)
}

/// Signed distance of a point from a polyline: positive to the left of its direction. What is surely farther away than the
/// nearest so far is not looked at; `likely` is the stretch to begin with, and then the one that the nearest is on.
fn distance_to(path: &[[f64; 2]], stretches: &[Stretch], likely: &mut usize, [x, y]: [f64; 2]) -> f64 {
    // The square of the distance.
    let (mut nearest, mut sign) = (f64::INFINITY, 0.0_f64);
    for index in std::iter::once(*likely).chain(0..stretches.len()) {
        let stretch = &stretches[index];
        if between([x, y], stretch.centre) - stretch.radius > nearest.sqrt() {
            continue;
        }
        for segment in path[stretch.first..=stretch.last].windows(2) {
            let ([a, b], [c, d]) = (segment[0], segment[1]);
            let (dx, dy) = (c - a, d - b);
            let along = (((x - a) * dx + (y - b) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
            let square = (x - a - along * dx).powi(2) + (y - b - along * dy).powi(2);
            if square < nearest {
                (nearest, sign) = (square, (dx * (y - b) - dy * (x - a)).signum());
                *likely = index;
            }
        }
    }
    sign * nearest.sqrt()
}

/// The least distance of the root's points from the polylines that the tip's points draw, by brute force.
fn brute(pair: &GearPair, side: Side, outline: &Outline, mate: &Outline) -> f64 {
    let fine = Density { points: 600, chord_error: None };
    // With the first point of the flank, where the root ends.
    let points = outline.half(fine);
    let end = points.iter().position(|point| outline.segments[point.segment].part == OutlinePart::Flank).unwrap();
    let root = &points[..=end];
    let on_tip = |part| matches!(part, OutlinePart::TipBreak | OutlinePart::TipLand);
    let tip = mate.half(Density { points: 60, chord_error: None });
    let tip = tip.into_iter().filter(|point| on_tip(mate.segments[point.segment].part));
    let mut tip: Vec<[f64; 2]> = tip.map(|point| point.local.position).collect();
    for segment in &mate.segments {
        if let (OutlinePart::TipBreak, Curve::Arc { centre, radius }) = (segment.part, &segment.curve) {
            // All of the circle: the flank beside a rounding is farther out.
            tip.extend((0..720).map(|step| {
                let (sine, cosine) = (f64::from(step) * PI / 360.0).sin_cos();
                [centre[0] + radius * cosine, centre[1] + radius * sine]
            }));
        }
    }
    let way: Vec<Turns> = (-800..=1600).map(|step| turns(pair, side, f64::from(step) * 5e-4)).collect();
    let mut minimum = f64::INFINITY;
    for point in tip {
        // At its lowest the path runs to the left, so what lies to the left of its direction is outside.
        let path: Vec<_> = way.iter().map(|turns| seen(pair, *turns, point)).collect();
        let (stretches, mut likely) = (Stretch::of(&path), 0);
        for place in root {
            minimum = minimum.min(distance_to(&path, &stretches, &mut likely, place.local.position));
        }
    }
    minimum
}

fn with_tip(gear: &Gear, family: &str, tip: Tip) -> Outline {
    let words = [("rack_tip", "given"), ("formulas", "derived"), ("size", "largest")];
    Outline::new(gear, root(family, &words).toe(gear).unwrap(), tip, None).unwrap()
}

/// Tier: second method; polylines of the path, turned gear by gear, to 20 nm, for every kind of root and tip, with
/// backlash and without.
#[test]
fn the_distance_is_that_of_the_path_s_polyline() {
    for (z1, z2, module, family, tip, apart) in [
        (17, 23, 1.0, "optimised_arc", Tip::Land, 0.0),
        (17, 17, 1.5, "arc", Tip::Land, 0.0),
        (19, 30, 1.0, "arc", Tip::Chamfer(0.1e-3), 0.0),
        (19, 30, 1.0, "optimised_arc", Tip::Rounding(0.15e-3), 0.0),
        (23, 19, 1.0, "tangent_arc", Tip::Land, 0.02e-3),
        (19, 26, 1.0, "trochoid", Tip::Rounding(0.1e-3), 0.0),
    ] {
        let [pinion, gear] = [z1, z2].map(|teeth| specification(teeth, module, 0.0));
        let nearest = GearPair::new(pinion, gear, None).unwrap().centre_distance;
        let pair = GearPair::new(pinion, gear, Some(nearest + apart)).unwrap();
        let outlines = SIDES.map(|side| with_tip(pair.side(side), family, tip));
        for (side, [own, mate]) in SIDES.into_iter().zip([[0, 1], [1, 0]].map(|order| order.map(|at| &outlines[at]))) {
            let found = TipPath::new(&pair, side, Corner::all(mate)).distance(&own.segments);
            let expected = brute(&pair, side, own, mate);
            assert_near(found, expected, 2e-8, &format!("{z1}/{z2} {family} {tip:?} {side:?}"));
        }
    }
}

/// Tier: closed form. Where contact begins the corner is on the flank, so a root that ends there has a distance of 0; a
/// root in one point lower has the distance of that point, which is positive.
#[test]
fn the_corner_is_on_the_flank_where_contact_begins() {
    for shift in [0.0, 0.35] {
        let pair = GearPair::new(specification(25, 3.0, shift), specification(40, 3.0, 0.1), None).unwrap();
        for side in SIDES {
            let path = TipPath::new(&pair, side, vec![Corner::of(pair.side(side.other()))]);
            let outline = shaped(pair.side(side), "trochoid").unwrap();
            let flank = outline.segments.iter().position(|segment| segment.part == OutlinePart::Flank).unwrap();
            let up_to = |roll: f64| {
                let mut segments = outline.segments[..=flank].to_vec();
                (segments[flank].part, segments[flank].to) = (OutlinePart::Root, roll);
                path.distance(&segments)
            };
            let lowest = pair.lowest_roll(side);
            assert!(up_to(lowest).abs() < 1e-15, "{side:?} {:e}", up_to(lowest));
            let lower = up_to(0.5 * (lowest + outline.form_roll));
            assert!(lower > 1e-7, "{side:?} {lower:e}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, max_global_rejects: 30_000, ..ProptestConfig::default() })]

    /// Tier: invariant. A rack that reaches as deep as its clearance leaves room for a mate of any size, and no root lets
    /// the mate's tip farther away than the root circle.
    #[test]
    fn a_generated_root_lets_the_mate_pass(
        z1 in 12_u32..60, z2 in 12_u32..200, x1 in -0.2..0.6_f64, x2 in -0.2..0.6_f64, angle in 14.5..30.0_f64,
        round in 0.0..1.0_f64, apart in 0.0..0.2_f64,
    ) {
        let of = |teeth, shift| {
            let mut given = specification(teeth, 1.0, shift);
            given.pressure_angle = angle * DEGREE;
            given.rack = Rack { addendum: 0.9, dedendum: 1.2, tip_radius: 0.0, ..Rack::ISO_53_A };
            given.rack.tip_radius = round * crate::gear::geometry::trochoid::full_round(&given);
            given
        };
        let distance = 0.5e-3 * (f64::from(z1 + z2) + apart) + 1e-3 * (x1 + x2);
        let Ok(pair) = GearPair::new(of(z1, x1), of(z2, x2), Some(distance)) else { return Err(TestCaseError::reject("no such pair")) };
        for side in SIDES {
            let outlines = SIDES.map(|side| shaped(pair.side(side), "trochoid").unwrap());
            let [own, mate] = if side == Side::Pinion { [&outlines[0], &outlines[1]] } else { [&outlines[1], &outlines[0]] };
            let found = TipPath::new(&pair, side, Corner::all(mate)).distance(&own.segments);
            let clearance = distance - pair.side(side.other()).tip_radius - pair.side(side).root_radius;
            prop_assert!(found > -1e-15 && found <= clearance * (1.0 + 1e-9), "{side:?}: {found:e} of {clearance:e}");
        }
    }
}
