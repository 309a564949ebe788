//! Outline against outline: both flanks as polylines, made from points of the involute and of the article's curves, turned
//! until they touch. The model's depths, separations and corners have no part in it.

use super::super::Gaps;
use crate::gear::contact::separation::Facing;
use crate::gear::fixtures::{design, standard};
use crate::gear::geometry::outline::tip::Tip;
use crate::gear::geometry::{Gear, GearPair, Side};
use declare::record::Value::{Number, Quantity};

const POINTS: u32 = 3000;

/// The pair of mei2016: 30/40, module 3 mm.
fn article() -> GearPair {
    GearPair::new(standard(30, 3e-3, 2.0), standard(40, 3e-3, 2.0), None).unwrap()
}

/// What a tip is cut by: the curve, A as a share of the tip thickness and B as a share of the involute.
type Cut = Option<(&'static str, f64, f64)>;

fn shares(base: f64, from: f64, to: f64) -> impl Iterator<Item = [f64; 2]> {
    (0..=POINTS).map(move |index| {
        let roll: f64 = from + (to - from) * f64::from(index) / f64::from(POINTS);
        [base * (roll.cos() + roll * roll.sin()), base * (roll.sin() - roll * roll.cos())]
    })
}

/// Radius and polar angle from where the involute starts, outwards to the tip circle.
fn outline(gear: &Gear, cut: Cut) -> Vec<[f64; 2]> {
    let tip = gear.tip_roll();
    let (start, curve) = cut.map_or((tip, Vec::new()), |(family, tip_share, length_share)| {
        let start = (tip * tip * (1.0 - length_share) + gear.form_roll * gear.form_roll * length_share).sqrt();
        let angle = tip - tip.atan() + tip_share * gear.tip_thickness() / gear.tip_radius;
        let a = [gear.tip_radius * angle.cos(), gear.tip_radius * angle.sin()];
        let b: Vec<[f64; 2]> = shares(gear.base_radius, start, start).take(1).collect();
        (start, if family == "arc" { arc(b[0], a, start) } else { parabola(b[0], a, start) })
    });
    let flank = shares(gear.base_radius, 0.05, start);
    flank.chain(curve).map(|[x, y]| [x.hypot(y), y.atan2(x)]).collect()
}

/// From B along the tangent at the angle t to A.
fn parabola([x_b, y_b]: [f64; 2], [x_a, y_a]: [f64; 2], t: f64) -> Vec<[f64; 2]> {
    let bend = ((y_a - y_b) - t.tan() * (x_a - x_b)) / ((x_a - x_b) * (x_a - x_b));
    let at = |share: f64| {
        let along = (x_a - x_b) * share;
        [x_b + along, y_b + t.tan() * along + bend * along * along]
    };
    (1..=POINTS).map(|index| at(f64::from(index) / f64::from(POINTS))).collect()
}

/// The circle through A that touches the tangent in B, by the angle at its centre: twice that between tangent and chord.
fn arc([x_b, y_b]: [f64; 2], [x_a, y_a]: [f64; 2], t: f64) -> Vec<[f64; 2]> {
    let (chord, half) = ((x_a - x_b).hypot(y_a - y_b), (y_a - y_b).atan2(x_a - x_b) - t);
    let radius = 0.5 * chord / half.sin();
    let at = |share: f64| {
        let turn = half * share;
        let length = 2.0 * radius * turn.sin();
        [x_b + length * (t + turn).cos(), y_b + length * (t + turn).sin()]
    };
    (1..=POINTS).map(|index| at(f64::from(index) / f64::from(POINTS))).collect()
}

/// The value at `x` of a polyline that grows in x; none outside.
fn between(line: &[[f64; 2]], x: f64) -> Option<f64> {
    let next = line.partition_point(|point| point[0] < x);
    let [low, high] = [line.get(next.checked_sub(1)?)?, line.get(next)?];
    Some(low[1] + (high[1] - low[1]) * (x - low[0]) / (high[0] - low[0]))
}

/// By how much the gear of `moving` turns, along its base circle, until its flank touches the other one.
fn turn(pair: &GearPair, outlines: [&[[f64; 2]]; 2], s: f64, moving: Side) -> f64 {
    let (fixed, own, other) = match moving {
        Side::Pinion => (outlines[1], outlines[0], pair.gear.base_radius),
        Side::Gear => (outlines[0], outlines[1], pair.pinion.base_radius),
    };
    let base = pair.side(moving).base_radius;
    let nominal = if moving == Side::Pinion { s } else { pair.tangent_length - s };
    // About the moving gear's centre, angles from its tangent point; its own flank needs only be turned.
    let own: Vec<[f64; 2]> = own.iter().map(|[radius, angle]| [*radius, nominal / base - angle]).collect();
    let mut fixed: Vec<[f64; 2]> = fixed
        .iter()
        .map(|[radius, angle]| {
            let (sine, cosine) = ((pair.tangent_length - nominal) / other - angle).sin_cos();
            let (x, y) = (pair.tangent_length - radius * sine, base + other - radius * cosine);
            [x.hypot(y), x.atan2(y)]
        })
        .collect();
    fixed.sort_by(|one, two| one[0].total_cmp(&two[0]));
    let clear = |points: &[[f64; 2]], line: &[[f64; 2]], sign: f64| {
        let turns = points.iter().filter_map(|[radius, angle]| Some(sign * (angle - between(line, *radius)?)));
        turns.fold(f64::INFINITY, f64::min)
    };
    base * clear(&fixed, &own, 1.0).min(clear(&own, &fixed, -1.0))
}

/// Tier: second method. Before A and after E the gap is that of the true outlines to 1.6 %, and never smaller: depths add to
/// the separation to first order in their slopes, and the tip reaches a little beyond the nominal corner.
#[test]
fn the_gap_is_that_of_turned_outlines() {
    let pair = article();
    let designs: [(f64, f64, [Cut; 2]); 5] = [
        (1e-6, 1e-6, [None, None]),
        (4e-3, 0.016, [Some(("arc", 0.02, 0.05)), Some(("arc", 0.10, 0.20))]),
        (4e-3, 0.016, [Some(("parabola", 0.06, 0.15)), Some(("parabola", 0.06, 0.15))]),
        (4e-3, 0.016, [Some(("parabola", 0.10, 0.25)), None]),
        (4e-3, 0.016, [None, Some(("arc", 0.06, 0.10))]),
    ];
    for (index, (near, far, cuts)) in designs.into_iter().enumerate() {
        let mut parts = Vec::new();
        let values = cuts.map(|cut| cut.map(|(_, a, b)| [("tip_share", Number(a)), ("length_share", Number(b))]));
        for ((cut, values), gear) in cuts.iter().zip(&values).zip(["pinion", "gear"]) {
            if let (Some((family, ..)), Some(values)) = (cut, values) {
                parts.push((*family, gear, &values[..]));
            }
        }
        let design = design(&pair, &parts).unwrap();
        let profiles = design.profiles(0.0);
        let gaps = Gaps::new(&pair, &profiles);
        let outlines = [outline(&pair.pinion, cuts[0]), outline(&pair.gear, cuts[1])];
        for beyond in [-0.3e-3, 0.0, 0.1e-3, 0.3e-3, 0.8e-3, 1.5e-3, 2.5e-3, 3.5e-3] {
            for (s, moving) in
                [(pair.start_of_contact - beyond, Side::Pinion), (pair.end_of_contact + beyond, Side::Gear)]
            {
                let found = gaps.at(s).unwrap();
                let exact = turn(&pair, [&outlines[0], &outlines[1]], s, moving);
                let maximum = if beyond < 0.4e-3 { near } else { far };
                let off = found - exact;
                assert!(off > -1e-9 && off < maximum * exact + 1e-9, "{index}, {beyond}: {found:e} {exact:e}");
            }
        }
    }
}

/// The same with what a linear relief of an amount over a length takes off along normals, and the tip's break: a straight
/// chamfer, or an arc tangent to flank and tip circle.
fn broken(gear: &Gear, [amount, length]: [f64; 2]) -> Vec<[f64; 2]> {
    let end = gear.flank_end.roll;
    let start = end - length / gear.base_radius;
    let relieved = |roll: f64| {
        let [x, y] = shares(gear.base_radius, roll, roll).next().unwrap();
        let depth = amount * ((roll - start) / (end - start)).max(0.0);
        [x - depth * roll.sin(), y + depth * roll.cos()]
    };
    let at = |index: u32| f64::from(index) / f64::from(POINTS);
    let flank = (0..=POINTS).map(|index| relieved(0.05 + (end - 0.05) * at(index)));
    let ([x, y], [p, q]) = (relieved(end), relieved(end - 1e-7));
    let after: Vec<[f64; 2]> = match gear.tip {
        Tip::Land => Vec::new(),
        Tip::Chamfer(size) => {
            let tip = gear.tip_roll();
            let angle = tip - tip.atan() + size / gear.tip_radius;
            let [p, q] = [gear.tip_radius * angle.cos(), gear.tip_radius * angle.sin()];
            (1..=POINTS).map(|index| [x + (p - x) * at(index), y + (q - y) * at(index)]).collect()
        }
        Tip::SemiTopping { angle, .. } => {
            let (base, from) = (gear.reference_radius * angle.cos(), gear.radius_at(end));
            let involute = |radius: f64| {
                let roll = ((radius / base).powi(2) - 1.0).sqrt();
                roll - roll.atan()
            };
            let on = |radius: f64| {
                let angle = end - end.atan() + involute(radius) - involute(from);
                [radius * angle.cos(), radius * angle.sin()]
            };
            (1..=POINTS).map(|index| on(from + (gear.tip_radius - from) * at(index))).collect()
        }
        Tip::Rounding(radius) => {
            let step = (x - p).hypot(y - q);
            let centre = [x - radius * (y - q) / step, y + radius * (x - p) / step];
            let (from, to) = ((y - centre[1]).atan2(x - centre[0]), centre[1].atan2(centre[0]));
            let on = |angle: f64| [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()];
            (1..=POINTS).map(|index| on(from + (to - from) * at(index))).collect()
        }
    };
    flank.chain(after).map(|[x, y]| [x.hypot(y), y.atan2(x)]).collect()
}

/// Tier: second method. A chamfer moves the corner; a rounding's arc touches beyond the end of the flank.
#[test]
fn the_gap_of_broken_tips_is_that_of_turned_outlines() {
    let specifications = [standard(30, 3e-3, 2.0), standard(40, 3e-3, 2.0)];
    let ramp = Tip::SemiTopping { angle: 45_f64.to_radians(), height: 0.2e-3 };
    let tips = [ramp, Tip::Chamfer(0.2e-3), Tip::Rounding(0.15e-3), Tip::Rounding(0.6e-3)];
    let mut earlier = f64::INFINITY;
    for (index, tip) in tips.into_iter().enumerate() {
        let pair = GearPair::with_tips(specifications, [tip; 2], None).unwrap();
        let design = design(&pair, &[]).unwrap();
        let profiles = design.profiles(0.0);
        let gaps = Gaps::new(&pair, &profiles);
        let outlines = [&pair.pinion, &pair.gear].map(|gear| broken(gear, [0.0, 1e-3]));
        for beyond in [0.0, 0.05e-3, 0.1e-3, 0.3e-3, 0.8e-3, 1.5e-3] {
            for (s, moving) in
                [(pair.start_of_contact - beyond, Side::Pinion), (pair.end_of_contact + beyond, Side::Gear)]
            {
                let found = gaps.at(s).unwrap();
                let exact = turn(&pair, [&outlines[0], &outlines[1]], s, moving);
                assert!((found - exact).abs() < 1e-9, "{index}, {beyond}: {found:e} {exact:e}");
            }
        }
        // What follows the end of the flank comes nearer than that end where it is an arc, the more so the larger it is.
        let end = Facing::new(&pair, Side::Gear).flank_end(0.3e-3).separation;
        let share = gaps.at(pair.start_of_contact - 0.3e-3).unwrap() / end;
        let is_corner = index < 2;
        assert!(share <= 1.0 && (is_corner || share < earlier * 0.99), "{index}: {share} {earlier}");
        earlier = share;
    }
}

/// Tier: second method. The rounding of a relieved flank begins with the tangent of the relief: with that of the involute the
/// gap would be up to 2.8 % too small.
#[test]
fn the_gap_of_a_rounding_after_a_relief_is_that_of_turned_outlines() {
    let specifications = [standard(30, 3e-3, 2.0), standard(40, 3e-3, 2.0)];
    let relief = [("amount", Quantity(60e-6)), ("length", Quantity(1.5e-3))];
    for radius in [0.15e-3, 0.6e-3] {
        let pair = GearPair::with_tips(specifications, [Tip::Rounding(radius); 2], None).unwrap();
        let design = design(&pair, &[("tip_relief", "both", &relief)]).unwrap();
        let profiles = design.profiles(0.0);
        let gaps = Gaps::new(&pair, &profiles);
        let outlines = [&pair.pinion, &pair.gear].map(|gear| broken(gear, [60e-6, 1.5e-3]));
        for beyond in [-0.5e-3, -0.2e-3, 0.0, 0.1e-3, 0.3e-3, 0.6e-3, 1e-3, 1.5e-3] {
            for (s, moving) in
                [(pair.start_of_contact - beyond, Side::Pinion), (pair.end_of_contact + beyond, Side::Gear)]
            {
                let found = gaps.at(s).unwrap();
                let exact = turn(&pair, [&outlines[0], &outlines[1]], s, moving);
                assert!((found / exact - 1.0).abs() < 4e-3, "{radius} {beyond}: {found:e} {exact:e}");
            }
        }
    }
}
