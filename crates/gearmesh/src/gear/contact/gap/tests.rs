//! The least gap against brute force, in the model's own terms and with true points, and its continuity.

mod arcs;
mod crests;
mod outlines;
mod rough;

use std::f64::consts::TAU;
use std::sync::Arc;

use super::*;
use crate::gear::fixtures::{NamedModification, design, pair, swapped};
use crate::gear::modification::flank::Flank;
use crate::gear::modification::{Design, Modification};
use declare::record::Value::{Choice, Number, Quantity};

fn ramp(amount: f64, length: f64, curve: &'static str) -> [(&'static str, declare::record::Value); 3] {
    [("amount", Quantity(amount)), ("length", Quantity(length)), ("curve", Choice(curve))]
}

fn power(amount: f64, length: f64, exponent: f64) -> [(&'static str, declare::record::Value); 4] {
    let [a, b, c] = ramp(amount, length, "power");
    [a, b, c, ("exponent", Number(exponent))]
}

/// Gentle and steep, overlapping and not, bent both ways, and material added.
fn designs(pair: &GearPair) -> Vec<Design> {
    let of = |parts: &[NamedModification]| design(pair, parts).unwrap();
    let crown = [("amount", Quantity(30e-6))];
    let slope = [("amount", Quantity(-12e-6))];
    vec![
        of(&[("tip_relief", "both", &ramp(8e-6, 4e-3, "linear"))]),
        of(&[("tip_relief", "both", &ramp(8e-6, 4e-3, "parabolic"))]),
        of(&[("tip_relief", "both", &ramp(220e-6, 0.8e-3, "linear"))]),
        of(&[("tip_relief", "both", &ramp(150e-6, 2.5e-3, "parabolic"))]),
        of(&[("tip_relief", "pinion", &ramp(90e-6, 9e-3, "linear")), ("tip_relief", "gear", &power(70e-6, 8e-3, 2.0))]),
        of(&[("tip_relief", "both", &power(60e-6, 3e-3, 0.6))]),
        of(&[
            ("root_relief", "pinion", &ramp(60e-6, 3e-3, "linear")),
            ("tip_relief", "pinion", &power(60e-6, 3e-3, 3.0)),
        ]),
        of(&[("profile_crowning", "both", &crown), ("profile_slope", "pinion", &slope)]),
        of(&[("profile_slope", "gear", &slope), ("tip_relief", "gear", &ramp(40e-6, 1.5e-3, "linear"))]),
    ]
}

fn positions(pair: &GearPair, count: u32) -> impl Iterator<Item = f64> {
    let (from, to) = (pair.start_of_contact - 4e-3, pair.end_of_contact + 4e-3);
    (0..=count).map(move |index| from + (to - from) * (f64::from(index) + 0.313) / f64::from(count + 1))
}

/// A point of a flank before the mate's flank: both rolls, and how far the mate is behind without modification \[m\].
struct Opposite {
    point: Side,
    roll: f64,
    touched: f64,
    behind: f64,
}

/// What both flanks of a design here lose together, at one place and another \[m\].
const DEPTHS: [f64; 2] = [-0.1e-3, 0.5e-3];

/// Points of both flanks in small steps, first the gear's before the pinion's flank, then the reverse, as far as one may be
/// the nearest; the separation by polar coordinates. Points are moved along their normals by `moved`.
fn opposite(pair: &GearPair, s: f64, moved: impl Fn(Side, f64) -> f64) -> Vec<Opposite> {
    let length = pair.tangent_length;
    let mut found = Vec::new();
    for (point, flank) in [(Side::Gear, Side::Pinion), (Side::Pinion, Side::Gear)] {
        let (own, other) = (pair.side(point), pair.side(flank));
        let (nominal, start, end) = match point {
            Side::Gear => (s, pair.start_of_contact, pair.end_of_contact),
            Side::Pinion => (length - s, length - pair.end_of_contact, length - pair.start_of_contact),
        };
        let (count, mut first) = (60_000, None);
        for index in 0..=count {
            let position = start + (end - start) * f64::from(index) / f64::from(count);
            let before = position - nominal;
            if before < 0.0 {
                continue;
            }
            let roll = (length - position) / own.base_radius;
            // From the point's own centre: along its normal, then out to the base circle.
            let normal = own.base_radius * roll - moved(point, roll);
            let (sine, cosine) = (-before / own.base_radius).sin_cos();
            let x = length - normal * cosine + own.base_radius * sine;
            let y = own.base_radius + other.base_radius - normal * sine - own.base_radius * cosine;
            let touched = ((x * x + y * y) / (other.base_radius * other.base_radius) - 1.0).sqrt();
            if touched > end / other.base_radius {
                continue;
            }
            let behind = other.base_radius * (x.atan2(y) - touched.atan() + touched) - nominal;
            // The farther before the line of action, the farther behind; of moved points but for the depth itself.
            if behind > *first.get_or_insert(behind) + 2.0 * (DEPTHS[1] - DEPTHS[0]) {
                break;
            }
            found.push(Opposite { point, roll, touched, behind });
        }
    }
    found
}

/// The least gap of points that are where they are without modification: depths are added, as the model says.
fn least(opposite: &[Opposite], design: &Design) -> f64 {
    let gap = |at: &Opposite| {
        let depth = design.depth(at.point, at.roll) + design.depth(at.point.other(), at.touched);
        assert!((DEPTHS[0]..=DEPTHS[1]).contains(&depth), "{depth:e}");
        at.behind + depth
    };
    opposite.iter().map(gap).fold(f64::INFINITY, f64::min)
}

#[test]
fn the_gap_is_the_least_of_a_fine_scan() {
    let pair = pair();
    for s in positions(&pair, 40) {
        let opposite = opposite(&pair, s, |_, _| 0.0);
        for (index, design) in designs(&pair).iter().enumerate() {
            let profiles = design.profiles(0.0);
            let (found, scanned) = (Gaps::new(&pair, &profiles).at(s).unwrap(), least(&opposite, design));
            // The scan's step is 0.24 µm: it is too large by its square over 2ρ, and by a step down a kink.
            let step = 2.5e-7 * 0.3;
            assert!(
                found < scanned + 1e-15 && found > scanned - step * 0.3 - 1e-13,
                "{index} {s}: {found:e} {scanned:e}"
            );
        }
    }
}

/// Tier: second method; the search that needs no convexity, at places as well as among breaks.
#[test]
fn convex_profiles_give_what_the_thorough_search_finds() {
    let pair = pair();
    let window = (pair.start_of_contact - 3e-3, pair.end_of_contact + 3e-3);
    for (index, design) in designs(&pair).iter().enumerate() {
        let profiles = design.profiles(0.0);
        let quick = Gaps::new(&pair, &profiles);
        // A power below 1 bends back.
        assert_eq!(quick.is_convex, index != 5, "{index}");
        let thorough = quick.clone().thorough();
        for s in positions(&pair, 400) {
            let (one, two) = (quick.at(s).unwrap(), thorough.at(s).unwrap());
            assert!((one - two).abs() <= 2e-15 + 1e-9 * two, "{index} {s}: {one:e} {two:e}");
        }
        let (one, two) = (quick.breaks(window), thorough.breaks(window));
        for s in &two {
            let nearest = one.iter().map(|other| (s - other).abs()).fold(f64::INFINITY, f64::min);
            assert!(nearest <= 1e-9, "{index}: {s} is {nearest:e} from the next of {one:?}");
        }
    }
}

/// Waves over the flank, smooth all along it.
#[derive(Debug)]
struct Waves {
    amount: f64,
    number: f64,
    flank: [f64; 2],
}

impl Modification for Waves {
    fn depth(&self, roll: f64) -> f64 {
        let [from, to] = self.flank;
        0.5 * self.amount * (1.0 - libm::cos(TAU * self.number * (roll - from) / (to - from)))
    }

    fn varies_along_profile(&self) -> bool {
        true
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }
}

/// One smooth step across the flank, up or down.
#[derive(Debug)]
struct Step {
    amount: f64,
    /// Where it is and how wide.
    roll: f64,
    width: f64,
}

impl Modification for Step {
    fn depth(&self, roll: f64) -> f64 {
        self.amount / (1.0 + libm::exp((self.roll - roll) / self.width))
    }

    fn varies_along_profile(&self) -> bool {
        true
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }
}

/// A modification of one's own, how large it is, and its largest second derivative along the path.
struct Own {
    modification: Arc<dyn Modification>,
    amount: f64,
    bend: f64,
}

/// Gaps of modifications of one's own against the fine scan.
fn scan(pair: &GearPair, own: impl IntoIterator<Item = Own>) {
    let of = |modification| Design {
        pinion: vec![crate::gear::modification::NamedModification { family: "own", modification }],
        ..Design::default()
    };
    let own: Vec<_> =
        own.into_iter().map(|Own { modification, amount, bend }| (of(modification), amount, bend)).collect();
    for s in positions(pair, 30) {
        let opposite = opposite(pair, s, |_, _| 0.0);
        for (design, amount, bend) in &own {
            let profiles = design.profiles(0.0);
            let (found, scanned) = (Gaps::new(pair, &profiles).at(s).unwrap(), least(&opposite, design));
            let step = 2.5e-7;
            // Slopes are those of parabolas through three points of a piece, so that a minimum is a little beside its place.
            assert!(
                found < scanned + 3e-6 * amount && found > scanned - (60.0 + bend) * step * step - 1e-13,
                "{design:?} {s}: {found:e} {scanned:e}"
            );
        }
    }
}

/// Tier: second method; the fine scan again. A smooth profile may bend back many times without a break.
#[test]
fn the_gap_of_waves_is_the_least_of_a_fine_scan() {
    let pair = pair();
    let flank = Flank::new(&pair, Side::Pinion);
    let own = |(amount, number): (f64, f64)| {
        let modification = Arc::new(Waves { amount, number, flank: [flank.root_roll, flank.tip_roll] });
        // Between two points of the scan a wave turns by its bend times the square of their distance.
        Own { modification, amount, bend: 0.5 * amount * (TAU * number / 10e-3).powi(2) }
    };
    let waves = [(5e-6, 1.0), (5e-6, 4.0), (5e-6, 6.3), (3e-6, 8.0), (10e-6, 16.0), (2e-6, 20.0)];
    scan(&pair, waves.map(own));
}

/// Tier: second method; as before. A step that bends once is not cut, and Newton's steps from its hollow leave its bracket.
#[test]
fn the_gap_of_a_smooth_step_is_the_least_of_a_fine_scan() {
    let pair = pair();
    let flank = Flank::new(&pair, Side::Pinion);
    let across = flank.tip_roll - flank.root_roll;
    let own = |(amount, place, width): (f64, f64, f64)| {
        let (roll, width) = (flank.root_roll + place * across, width * across);
        let along = width * pair.pinion.base_radius;
        // The logistic function bends by at most 1/(6 √3).
        let bend = amount.abs() / (6.0 * f64::sqrt(3.0) * along * along);
        Own { modification: Arc::new(Step { amount, roll, width }), amount: amount.abs(), bend }
    };
    let steps = [
        (20e-6, 0.9, 0.02),
        (-20e-6, 0.9, 0.02),
        (-50e-6, 0.8, 0.01),
        (-50e-6, 0.5, 0.03),
        (-30e-6, 0.95, 0.05),
        (-20e-6, 0.7, 0.004),
        (-80e-6, 0.46, 0.0315),
        (-80e-6, 0.38, 0.0567),
    ];
    scan(&pair, steps.map(own));
}

/// With points moved along their normals the gap differs by its own size times the slope of the reliefs.
#[test]
fn the_gap_is_that_of_true_points_to_first_order() {
    let pair = pair();
    for (index, design) in designs(&pair).iter().enumerate() {
        let profiles = design.profiles(0.0);
        let gaps = Gaps::new(&pair, &profiles);
        for s in positions(&pair, 25) {
            // Moved points lose no depth of their own once more.
            let gap = |at: &Opposite| at.behind + design.depth(at.point.other(), at.touched);
            let exact =
                opposite(&pair, s, |side, roll| design.depth(side, roll)).iter().map(gap).fold(f64::INFINITY, f64::min);
            let found = gaps.at(s).unwrap();
            assert!((found - exact).abs() < 0.12 * found.abs() + 1e-7, "{index} {s}: {found:e} {exact:e}");
        }
    }
}

#[test]
fn without_modification_the_gap_is_the_corner_s_separation() {
    let pair = pair();
    let profiles = [Vec::new(), Vec::new()];
    let gaps = Gaps::new(&pair, &profiles);
    for s in positions(&pair, 200) {
        let corner = |side: Side, before: f64| Facing::new(&pair, side).tip(before).separation;
        let exact = if s < pair.start_of_contact {
            corner(Side::Gear, pair.start_of_contact - s)
        } else if s > pair.end_of_contact {
            corner(Side::Pinion, s - pair.end_of_contact)
        } else {
            0.0
        };
        assert!((gaps.at(s).unwrap() - exact).abs() <= 1e-15 * exact);
    }
    assert!(gaps.at(pair.start_of_contact - 8.5e-3).is_none(), "beyond the other tip");
}

/// Between the breaks that it states the gap is smooth: a polynomial of degree 31 follows it to 0.1 nm. What is missed are
/// stretches of micrometres, where the slope of a relief is the least.
#[test]
fn the_gap_is_continuous_and_smooth_between_its_breaks() {
    let pair = pair();
    let window = (pair.start_of_contact - 3e-3, pair.end_of_contact + 3e-3);
    for (index, design) in designs(&pair).iter().enumerate() {
        let profiles = design.profiles(0.0);
        let gaps = Gaps::new(&pair, &profiles);
        for s in gaps.breaks(window) {
            let jump = gaps.at(s + 1e-13).unwrap() - gaps.at(s - 1e-13).unwrap();
            assert!(jump.abs() < 2e-13, "{index}: {jump:e} at {s}");
        }
        // Powers have no polynomial at their starts.
        if [5, 6].contains(&index) {
            continue;
        }
        for ends in gaps.breaks(window).windows(2).filter(|ends| ends[1] - ends[0] > 1e-6) {
            let (lower, upper) = (ends[0] + 2e-11, ends[1] - 2e-11);
            let series = crate::numeric::chebyshev::Series::fit(lower, upper, 32, |s| gaps.at(s).unwrap());
            for probe in 1..40 {
                let s = lower + (upper - lower) * f64::from(probe) / 40.0;
                let off = series.value(s) - gaps.at(s).unwrap();
                assert!(off.abs() < 1e-10, "{index}: {off:e} at {s} in {ends:?}");
            }
        }
    }
}

/// Turned round, the gap is the same.
#[test]
fn pinion_and_gear_may_change_places() {
    let pair = pair();
    let swapped = swapped(&pair);
    for design in designs(&pair) {
        let [pinion, gear] = design.profiles(0.0);
        let (here, there) = ([pinion.clone(), gear.clone()], [gear, pinion]);
        let (here, there) = (Gaps::new(&pair, &here), Gaps::new(&swapped, &there));
        for s in positions(&pair, 50) {
            let (one, two) = (here.at(s).unwrap(), there.at(pair.tangent_length - s).unwrap());
            assert!((one - two).abs() < 1e-15 + 1e-11 * one.abs(), "{s}: {one:e} {two:e}");
        }
    }
}

/// Another modification of which nobody says what it is.
#[derive(Debug)]
struct Untold(Arc<dyn Modification>);

impl Modification for Untold {
    fn depth(&self, roll: f64) -> f64 {
        self.0.depth(roll)
    }

    fn profile_breaks(&self) -> &[f64] {
        self.0.profile_breaks()
    }

    fn varies_along_profile(&self) -> bool {
        self.0.varies_along_profile()
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        self.0.resolved()
    }
}

/// Tier: second method; depths, slopes and shapes from samples of the same profiles.
#[test]
fn profiles_known_to_be_quadratics_have_the_gaps_of_sampled_ones() {
    let pair = pair();
    let window = (pair.start_of_contact - 3e-3, pair.end_of_contact + 3e-3);
    for (index, design) in designs(&pair).iter().enumerate() {
        let untold = |parts: &[crate::gear::modification::NamedModification]| {
            let hidden = |part: &crate::gear::modification::NamedModification| {
                let modification: Arc<dyn Modification> = Arc::new(Untold(part.modification.clone()));
                crate::gear::modification::NamedModification { modification, ..*part }
            };
            parts.iter().map(hidden).collect()
        };
        let sampled = Design { pinion: untold(&design.pinion), gear: untold(&design.gear), ..design.clone() };
        let (profiles, others) = (design.profiles(0.0), sampled.profiles(0.0));
        let (known, found) = (Gaps::new(&pair, &profiles), Gaps::new(&pair, &others));
        for s in positions(&pair, 400) {
            let (one, two) = (known.at(s).unwrap(), found.at(s).unwrap());
            // A power that hides its derivatives has slopes from differences, whose error is of second order in the gap.
            let relative = if [5, 6].contains(&index) { 1e-10 } else { 2e-12 };
            assert!((one - two).abs() <= 2e-16 + relative * two, "{index} {s}: {one:e} {two:e}");
        }
        let (one, two) = (known.breaks(window), found.breaks(window));
        if [5, 6].contains(&index) {
            // Slopes from differences place breaks less well, and see more of them beside a kink.
            let is_found = |s: &f64| two.iter().any(|other| (s - other).abs() < 1e-8);
            assert!(one.iter().all(is_found), "{index}: {one:?} {two:?}");
            continue;
        }
        assert_eq!(one.len(), two.len(), "{index}: {one:?} {two:?}");
        for (one, two) in one.iter().zip(&two) {
            assert!((one - two).abs() < 2e-11, "{index}: {one} {two}");
        }
    }
}

/// Tier: invariant; a copy is the gap to what is said of it, wherever there is one, which is nearly everywhere.
#[test]
fn quick_copies_are_the_gap() {
    let pair = pair();
    let window = (pair.start_of_contact - 1e-3, pair.end_of_contact + 1e-3);
    let rule = crate::numeric::piecewise::Rule::new();
    for (index, design) in designs(&pair).iter().enumerate() {
        let profiles = design.profiles(0.0);
        let gaps = Gaps::new(&pair, &profiles);
        let breaks = gaps.breaks(window);
        let copy = gaps.copied(&rule, &breaks);
        let largest = breaks.iter().map(|s| gaps.at(*s).unwrap()).fold(0.0, f64::max);
        let (mut missing, mut worst) = (0, 0.0_f64);
        for ends in breaks.windows(2) {
            let places = (0..200).map(|step| ends[0] + (ends[1] - ends[0]) * (f64::from(step) + 0.313) / 200.0);
            let found: Vec<_> = places.map(|s| (gaps.at(s).unwrap(), copy.value(s))).collect();
            let most = found.iter().map(|(gap, _)| *gap).fold(0.0, f64::max) + 0.1 * largest;
            for (gap, copied) in found {
                match copied {
                    Some(copied) => worst = worst.max((copied - gap).abs() / most),
                    None => missing += 1,
                }
            }
        }
        // Between the places that were compared it may be a few times as far off.
        assert!(missing <= 80 && worst < 4e-14, "{index}: {worst:e}, {missing} without a copy");
    }
}
