//! Crests of piecewise flanks, the ends of traces among them, against a dense scan of involutes turned against each other.
//!
//! The scan places each point of one gear by polar coordinates about the centre of the other one, exactly, and turns the other flank until it
//! touches. Depths count at the points that touch without them, along the line of action: to the first order in the depths, as in the kernel.

use super::*;
use crate::gear::fixtures::standard;
use crate::gear::fixtures::uneven::{Traces, uneven};
use crate::gear::modification::Gears;
use crate::gear::modification::measured::Measured;
use crate::gear::random::Random;

/// Lowest places of the scan that lie no higher above the lowest one are looked at closely \[m\].
const NEARLY_LOWEST: f64 = 50e-9;

/// The least gap among so many places up to a base pitch from the nominal point, and between the lowest of them and those beside by thirds.
fn dense_scan(pair: &GearPair, depth: impl Fn(Side, f64) -> f64, s: f64, count: u32) -> f64 {
    let length = pair.tangent_length;
    let mut least = f64::INFINITY;
    for (point, nominal, start, end) in [
        (Side::Gear, s, pair.start_of_contact, pair.end_of_contact),
        (Side::Pinion, length - s, length - pair.end_of_contact, length - pair.start_of_contact),
    ] {
        let (own, other) = (pair.side(point), pair.side(point.other()));
        let gap = |before: f64| {
            let arc = length - nominal - before;
            let (sine, cosine) = libm::sincos(before / own.base_radius);
            let x = length - arc * cosine - own.base_radius * sine;
            let y = own.base_radius + other.base_radius + arc * sine - own.base_radius * cosine;
            let square = (x * x + y * y) / (other.base_radius * other.base_radius) - 1.0;
            let roll = square.max(0.0).sqrt();
            if arc < 0.0 || roll * other.base_radius > end * (1.0 + f64::EPSILON) {
                return f64::INFINITY;
            }
            let behind = other.base_radius * (libm::atan2(x, y) - libm::atan(roll) + roll) - nominal;
            behind + depth(point, arc / own.base_radius) + depth(point.other(), roll)
        };
        let from = (start - nominal).max(0.0);
        let to = (end - nominal).min(from + 0.6 * pair.base_pitch);
        if to <= from {
            continue;
        }
        let at = |index: u32| from + (to - from) * f64::from(index) / f64::from(count);
        let values: Vec<f64> = (0..=count).map(|index| gap(at(index))).collect();
        least = values.iter().copied().fold(least, f64::min);
        for index in 0..=count {
            let [before, after] = [index.saturating_sub(1), (index + 1).min(count)];
            let [low, here, high] = [before, index, after].map(|index| values[index as usize]);
            if here <= low && here <= high && here < least + NEARLY_LOWEST {
                let [mut low, mut high] = [at(before), at(after)];
                for _ in 0..60 {
                    let [one, two] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
                    if gap(one) < gap(two) { high = two } else { low = one }
                }
                least = least.min(gap(low)).min(gap(high));
            }
        }
    }
    least
}

fn pair_of(teeth: [u32; 2], module: f64) -> GearPair {
    let [pinion, gear] = teeth.map(|teeth| standard(teeth, module, 2.0));
    GearPair::new(pinion, gear, None).unwrap()
}

/// Tier: second method; a trace of nine points that begins 0.1 mm inside the flank: both pairs in contact at distances from A, and by how much their gaps
/// differ, in micrometres, as another program's scan of 60,000 places has it.
#[test]
fn gaps_beside_the_end_of_a_trace_are_those_of_a_dense_scan() {
    let pair = pair_of([59, 85], 2e-3);
    let lengths = [14.873, 16.181, 17.488, 18.796, 20.103, 21.411, 22.718, 24.026, 25.333];
    let deviations = [-0.68, -2.347, 1.133, 0.3205, 1.292, -0.7559, 2.321, -1.724, -1.167];
    let trace = Measured {
        deviations: deviations.map(|deviation| deviation * 1e-6).to_vec(),
        roll_lengths: Some(lengths.map(|length| length * 1e-3).to_vec()),
        ..Measured::default()
    };
    let mut design = Design::default();
    design.add(Gears::Pinion, &trace, &pair).unwrap();
    let profiles = design.profiles(0.0);
    let gaps = Gaps::new(&pair, &profiles);
    let exchanged = swapped(&pair);
    let [pinion, gear] = design.profiles(0.0);
    let mirrored = [gear, pinion];
    let mirrored = Gaps::new(&exchanged, &mirrored);
    for (x, difference) in
        [(0.1, None), (0.3, Some(0.556)), (0.6, Some(0.767)), (0.8, Some(1.823)), (2.0, None), (3.0, None), (4.0, None)]
    {
        let newest = pair.start_of_contact + x * 1e-3;
        let found = [newest, newest + pair.base_pitch].map(|s| {
            let found = gaps.at(s).unwrap();
            let exact = dense_scan(&pair, |side, roll| design.depth(side, roll), s, 60_000);
            assert!((found - exact).abs() < 1e-15, "{x} mm: {found:e} {exact:e}");
            let other = mirrored.at(pair.tangent_length - s).unwrap();
            assert!((found - other).abs() < 1e-16, "{x} mm: {found:e} {other:e}");
            found
        });
        if let Some(difference) = difference {
            let off = (found[0] - found[1]).abs() * 1e6 - difference;
            assert!(off.abs() < 2e-3, "{x} mm: {off} um");
        }
    }
}

/// Tier: second method; random designs of every kind, from before A to behind E, each pair of teeth by itself: the gap is that of the scan to 1e-15 m, which is
/// to rounding of it.
#[test]
fn gaps_of_uneven_flanks_are_those_of_a_dense_scan() {
    let mut random = Random::new(53);
    let teeth = [[59, 85], [19, 48], [24, 36], [30, 115], [17, 23], [40, 40]];
    for (traces, drawn, designs) in [
        (Traces::Sparse, 0, 60),
        (Traces::Dense, 0, 20),
        (Traces::Sparse, 3, 40),
        (Traces::Grid, 0, 20),
        (Traces::Grid, 2, 10),
        (Traces::None, 1, 20),
        (Traces::None, 4, 20),
    ] {
        for number in 0..designs {
            let pair = pair_of(teeth[number % teeth.len()], [2e-3, 3e-3, 1e-3, 5e-3][number % 4]);
            let design = uneven(&pair, traces, drawn, 1.0, &mut random);
            let z = 0.3 * random.share() * pair.pinion.specification.face_width;
            let profiles = design.profiles(z);
            let gaps = Gaps::new(&pair, &profiles);
            let depth = |side: Side, roll: f64| {
                profiles[usize::from(side == Side::Gear)].iter().map(|part| part.depth(roll)).sum()
            };
            let count = if traces == Traces::Dense { 12_000 } else { 6_000 };
            let (from, to) =
                (pair.start_of_contact - 0.05 * pair.base_pitch, pair.end_of_contact + 0.05 * pair.base_pitch);
            for place in 0..16 {
                let s = from + (to - from) * (f64::from(place) + random.share()) / 16.0;
                let exact = dense_scan(&pair, depth, s, count);
                let off = gaps.at(s).unwrap() - exact;
                assert!(off.abs() < 1e-15, "{traces:?} {number} at {s}: {off:e} of {exact:e}");
            }
        }
    }
}

/// Tier: invariant; what the bounds of the search take for granted: the curvature of the separation and the rate of the other flank's roll length are between
/// their values at both ends of a stretch, and the slope of that rate is nearly so, for pairs of all sizes up to where their flanks end.
#[test]
fn the_separation_stays_within_its_bounds() {
    let mut random = Random::new(7);
    let mut compared = 0;
    while compared < 300 {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a number of teeth
        let teeth = [random.between(12.0, 60.0) as u32, random.between(12.0, 150.0) as u32];
        let mut gear = |teeth: u32| {
            let mut gear = standard(teeth, 3e-3, 2.0);
            gear.profile_shift = random.between(-0.2, 0.6);
            gear
        };
        let (one, other) = (gear(teeth[0]), gear(teeth[1]));
        let Ok(pair) = GearPair::new(one, other, None) else { continue };
        for side in [Side::Gear, Side::Pinion] {
            let facing = Facing::new(&pair, side);
            let nominal = facing.start.max(0.0) + (facing.end - facing.start.max(0.0)) * random.between(0.001, 0.95);
            let touches: Vec<_> = (0..=400)
                .map(|at| (facing.end - nominal) * f64::from(at) / 400.0)
                .take_while(|before| facing.point_roll(nominal + before) >= 0.0)
                .map(|before| facing.touch(nominal + before, before))
                .take_while(|touch| touch.curvature <= facing.end)
                .collect();
            // A tip may reach beyond the base circle of the other gear.
            if touches.is_empty() {
                continue;
            }
            for _ in 0..20 {
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a number of places
                let [mut from, mut to] = [0, 1].map(|_| (random.share() * touches.len() as f64) as usize);
                if from > to {
                    (from, to) = (to, from);
                }
                let [first, last] = [&touches[from], &touches[to]];
                let share = 1.0 - first.rate.min(last.rate) / first.rate.max(last.rate);
                let least = first.rate_slope.abs().min(last.rate_slope.abs());
                let more = branch_and_bound::RATE_SLOPE_MARGIN * share * share * least + 1e-9 * least;
                for touch in &touches[from..=to] {
                    let is_within = touch.separation >= first.separation
                        && touch.bend >= first.bend.min(last.bend) - 1e-12 * first.bend.abs()
                        && touch.rate <= first.rate.max(last.rate) * (1.0 + 1e-12)
                        && touch.rate >= first.rate.min(last.rate) * (1.0 - 1e-12)
                        && touch.rate_slope >= first.rate_slope.min(last.rate_slope) - more
                        && touch.rate_slope <= first.rate_slope.max(last.rate_slope) + more;
                    assert!(is_within, "{teeth:?} {side:?} {nominal}: {touch:?} between {first:?} and {last:?}");
                }
            }
        }
        compared += 1;
    }
}
