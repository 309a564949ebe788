//! Rough flanks against a dense scan, with their own splines and the separation of points.

use super::*;
use crate::gear::fixtures::standard;
use crate::gear::geometry::{Rack, Specification};
use crate::gear::modification::Gears;
use crate::gear::modification::curve::Curve;
use crate::gear::modification::measured::Measured;
use crate::gear::modification::relief::{Amount, FromTip, Start};
use crate::gear::modification::tip_relief::TipRelief;
use crate::gear::random::Random;

const POINTS: u32 = 500;
/// How far from the nominal point it is looked \[m\], and in how many steps.
const FAR: f64 = 2.2e-3;
const STEPS: u32 = 11_000;

/// What a trace has beside a relief.
#[derive(Clone, Copy, Debug)]
enum Beside {
    Nothing,
    /// Of an amplitude and a length along the roll length \[m\].
    Waves(f64, f64),
    /// Up to so much to either side from point to point \[m\].
    Noise(f64),
}

impl Beside {
    /// With what a design takes off a flank.
    fn trace(self, pair: &GearPair, side: Side, plain: &Design, random: &mut Random) -> Measured {
        let flank = Flank::new(pair, side);
        let step = (flank.tip_roll - flank.root_roll) / f64::from(POINTS - 1);
        let rolls: Vec<f64> = (0..POINTS).map(|at| flank.root_roll + step * f64::from(at)).collect();
        let turn = random.between(0.0, TAU);
        let mut more = |roll: f64| match self {
            Self::Nothing => 0.0,
            Self::Waves(amplitude, length) => amplitude * libm::sin(turn + TAU * roll * flank.base_radius / length),
            Self::Noise(most) => random.between(-most, most),
        };
        Measured {
            deviations: rolls.iter().map(|roll| more(*roll) - plain.depth(side, *roll)).collect(),
            roll_lengths: Some(rolls.iter().map(|roll| roll * flank.base_radius).collect()),
            ..Measured::default()
        }
    }
}

/// Both gears relieved by 12 µm over 4 mm, with what the traces of pinion and gear have beside.
fn traced(pair: &GearPair, beside: [Beside; 2], random: &mut Random) -> Design {
    let mut plain = Design::default();
    let (amount, start, curve) = (Amount::Depth(12e-6), Start::Length(4e-3), Curve::Power { exponent: 2.0 });
    plain.add(Gears::Both, &TipRelief { amount, start, counted_from: FromTip::Tip, curve }, pair).unwrap();
    let mut design = Design::default();
    for (gears, side, beside) in [(Gears::Pinion, Side::Pinion, beside[0]), (Gears::Gear, Side::Gear, beside[1])] {
        design.add(gears, &beside.trace(pair, side, &plain, random), pair).unwrap();
    }
    design
}

/// The least gap of each of the designs among points of both gears up to so far beside the nominal one \[m\], the end of a flank among them.
fn scanned(pair: &GearPair, designs: &[Design], s: f64, far: f64) -> Vec<f64> {
    let mut least = vec![f64::INFINITY; designs.len()];
    for side in [Side::Gear, Side::Pinion] {
        let facing = Facing::new(pair, side);
        let nominal = facing.turned(side, s);
        let first = (facing.start - nominal).max(0.0);
        for step in 0..=STEPS {
            let before = first + far * f64::from(step) / f64::from(STEPS);
            let touch = facing.touch(nominal + before, before);
            let is_beyond = facing.point_roll(nominal + before) < 0.0;
            if is_beyond || nominal + before > facing.end || touch.curvature > facing.end {
                break;
            }
            let rolls = [facing.point_roll(nominal + before), facing.flank_roll(touch.curvature)];
            for (least, design) in least.iter_mut().zip(designs) {
                let depth = design.depth(side, rolls[0]) + design.depth(side.other(), rolls[1]);
                *least = least.min(touch.separation + depth);
            }
        }
    }
    least
}

/// Tier: second method; both flanks rough, or one, waves and noise, from before A to behind E: no more than 20 pm above the scan, and below it
/// by what its steps of 0.2 µm miss. Next to A they are 1 µm of the pinion, of which waves of 1 µm and 0.1 mm bend by 4 000 1/m: 0.5 nm.
#[test]
fn the_gap_of_rough_flanks_is_the_least_of_a_dense_scan() {
    let (pair, mut random) = (pair(), Random::new(17));
    let kinds = [
        Beside::Waves(2e-6, 4e-3),
        Beside::Waves(0.3e-6, 0.5e-3),
        Beside::Waves(1e-6, 0.3e-3),
        Beside::Waves(1e-6, 0.1e-3),
        Beside::Noise(0.5e-6),
    ];
    let mut sides = Vec::new();
    for (index, kind) in kinds.into_iter().enumerate() {
        sides.extend([[kind, kind], [kind, Beside::Nothing], [Beside::Nothing, kind], [kind, kinds[(index + 1) % 5]]]);
    }
    let designs: Vec<Design> = sides.iter().map(|beside| traced(&pair, *beside, &mut random)).collect();
    let profiles: Vec<_> = designs.iter().map(|design| design.profiles(0.0)).collect();
    let gaps: Vec<Gaps> = profiles.iter().map(|profiles| Gaps::new(&pair, profiles)).collect();
    let mut worst = vec![[0.0_f64; 2]; designs.len()];
    let (from, to) = (pair.start_of_contact - 0.7e-3, pair.end_of_contact + 0.7e-3);
    for place in 0..40 {
        let s = from + (to - from) * (f64::from(place) + random.share()) / 40.0;
        for ((gaps, exact), worst) in gaps.iter().zip(scanned(&pair, &designs, s, FAR)).zip(&mut worst) {
            let found = gaps.at(s).unwrap();
            *worst = [worst[0].max(found - exact), worst[1].max(exact - found)];
        }
    }
    for (sides, worst) in sides.iter().zip(&worst) {
        assert!(worst[0] < 2e-11 && worst[1] < 0.7e-9, "{sides:?}: {worst:?}");
    }
}

/// Tier: second method; traces that end before both ends of their flanks, where they are held, under reliefs that are drawn and start with a
/// kink: no more than 20 pm above the scan, and below it by what its steps miss beside a kink.
#[test]
fn the_gap_of_traces_beside_drawn_reliefs_is_the_least_of_a_dense_scan() {
    let (pair, mut random) = (pair(), Random::new(29));
    let kinds = [
        Beside::Nothing,
        Beside::Waves(2e-6, 4e-3),
        Beside::Waves(0.3e-6, 0.5e-3),
        Beside::Waves(1e-6, 0.3e-3),
        Beside::Noise(0.5e-6),
    ];
    let mut designs = Vec::new();
    for (kind, curve) in kinds.into_iter().flat_map(|kind| [(kind, Curve::Linear), (kind, Curve::Parabolic)]) {
        let mut design = Design::default();
        for (gears, side) in [(Gears::Pinion, Side::Pinion), (Gears::Gear, Side::Gear)] {
            let mut trace = kind.trace(&pair, side, &Design::default(), &mut random);
            let inner = 20..trace.deviations.len() - 15;
            trace.roll_lengths = trace.roll_lengths.map(|lengths| lengths[inner.clone()].to_vec());
            trace.deviations = trace.deviations[inner].to_vec();
            design.add(gears, &trace, &pair).unwrap();
            let (amount, start) =
                (Amount::Depth(random.between(2e-6, 20e-6)), Start::Length(random.between(1e-3, 5e-3)));
            let relief = TipRelief { amount, start, counted_from: FromTip::Tip, curve };
            design.add(gears, &relief, &pair).unwrap();
        }
        designs.push(design);
    }
    let profiles: Vec<_> = designs.iter().map(|design| design.profiles(0.0)).collect();
    let gaps: Vec<Gaps> = profiles.iter().map(|profiles| Gaps::new(&pair, profiles)).collect();
    let (from, to) = (pair.start_of_contact - 0.7e-3, pair.end_of_contact + 0.7e-3);
    for place in 0..60 {
        let s = from + (to - from) * (f64::from(place) + random.share()) / 60.0;
        for (at, (gaps, exact)) in gaps.iter().zip(scanned(&pair, &designs, s, FAR)).enumerate() {
            let off = gaps.at(s).unwrap() - exact;
            assert!(off < 2e-11 && off > -2e-9, "{:?} at {s}: {off:e}", kinds[at / 2]);
        }
    }
}

/// A pair of gears as they are cut, of a random module, tooth numbers and profile shifts; none where they do not run.
fn random_pair(random: &mut Random) -> Option<GearPair> {
    let module = 1e-3 * libm::pow(2.0, random.between(0.0, 3.0));
    let mut gear = |most: f64| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a number of teeth
        let teeth = random.between(12.0, most) as u32;
        let mut specification = standard(teeth, module, 2.0);
        specification.profile_shift = random.between(-0.2, 0.5);
        specification.rack = Rack::ISO_53_A;
        specification
    };
    let [pinion, gear]: [Specification; 2] = [gear(60.0), gear(120.0)];
    GearPair::new(pinion, gear, None).ok()
}

/// Tier: second method; random pairs, with waves of a twentieth of a module and more, or noise, on both gears, from A to E: no more than 0.2 nm
/// above a dense scan of points that neither flank ends at.
#[test]
fn the_gap_of_random_pairs_is_the_least_of_a_dense_scan() {
    let mut random = Random::new(41);
    let pairs: Vec<GearPair> = std::iter::repeat_with(|| random_pair(&mut random)).flatten().take(60).collect();
    for pair in pairs {
        let module = pair.pinion.specification.module;
        let beside = if random.share() < 0.5 {
            Beside::Waves(random.between(0.05e-6, 1.5e-6), random.between(0.05, 2.0) * module)
        } else {
            Beside::Noise(random.between(0.05e-6, 0.3e-6))
        };
        let mut design = Design::default();
        for (gears, side) in [(Gears::Pinion, Side::Pinion), (Gears::Gear, Side::Gear)] {
            design.add(gears, &beside.trace(&pair, side, &Design::default(), &mut random), &pair).unwrap();
        }
        let profiles = design.profiles(0.0);
        let gaps = Gaps::new(&pair, &profiles);
        for place in 0..20 {
            let share = (f64::from(place) + random.share()) / 20.0;
            let s = pair.start_of_contact + (pair.end_of_contact - pair.start_of_contact) * share;
            let exact = scanned(&pair, std::slice::from_ref(&design), s, 0.5 * module)[0];
            let off = gaps.at(s).unwrap() - exact;
            assert!(off < 2e-10, "{beside:?}, module {module}, {} at {s}: {off:e}", pair.pinion.specification.teeth);
        }
    }
}

/// Tier: second method; traces of reliefs that start with a kink, in points so close that the gap hardly bends between two places of a scan, at
/// 2,000 positions each: the lowest place is never lost. What a spline cannot follow is no more than a sixth of the kink times the distance of the points here.
#[test]
fn the_lowest_place_is_found_wherever_blocks_of_places_begin() {
    let pair = pair();
    for (amount, length) in [(24e-6, 5.5e-3), (12e-6, 4.2e-3), (18e-6, 3e-3)] {
        let mut plain = Design::default();
        let (start, curve) = (Start::Length(length), Curve::Parabolic);
        let relief = TipRelief { amount: Amount::Depth(amount), start, counted_from: FromTip::Tip, curve };
        plain.add(Gears::Both, &relief, &pair).unwrap();
        let mut design = Design::default();
        for (gears, side) in [(Gears::Pinion, Side::Pinion), (Gears::Gear, Side::Gear)] {
            let flank = Flank::new(&pair, side);
            let step = (flank.tip_roll - flank.root_roll) / 8000.0;
            let rolls: Vec<f64> = (0..=8000).map(|at| flank.root_roll + step * f64::from(at)).collect();
            let trace = Measured {
                deviations: rolls.iter().map(|roll| -plain.depth(side, *roll)).collect(),
                roll_lengths: Some(rolls.iter().map(|roll| roll * flank.base_radius).collect()),
                ..Measured::default()
            };
            design.add(gears, &trace, &pair).unwrap();
        }
        let profiles = [&design, &plain].map(|design| design.profiles(0.0));
        let [traced, exact] = [0, 1].map(|at| Gaps::new(&pair, &profiles[at]));
        for place in 0..=2000 {
            let s = pair.start_of_contact + (pair.end_of_contact - pair.start_of_contact) * f64::from(place) / 2000.0;
            let off = traced.at(s).unwrap() - exact.at(s).unwrap();
            assert!(off.abs() <= 1.9e-6 * 0.44 * amount / length / 6.0, "{amount} {length} at {s}: {off:e}");
        }
    }
}
