//! Flanks of single teeth against designs of which every tooth has them, pitch deviations, rigid flanks, and closed forms.

use super::{STIFFNESS, case, scattered};
use crate::gear::compliance::{ContactLaw, PairCompliance};
use crate::gear::contact::{CornerContact, SliceCoupling};
use crate::gear::fixtures::{constant, coupled, design, least_gap_of, pair, varying};
use crate::gear::geometry::{GearPair, Side};
use crate::gear::mesh::answers::hunting::{PitchDeviations, Teeth, ToothFlanks};
use crate::gear::mesh::equilibrium::flanks::Flanks;
use crate::gear::mesh::{Mesh, Settings};
use crate::gear::modification::flank::Flank;
use crate::gear::modification::measured::Measured;
use crate::gear::modification::{Design, Gears};
use crate::numeric::spectrum::amplitudes;
use declare::record::Value::{Choice, Quantity};
use std::f64::consts::{PI, TAU};

const SIDES: [Side; 2] = [Side::Pinion, Side::Gear];

fn count(pair: &GearPair, side: Side) -> usize {
    pair.side(side).specification.teeth as usize
}

/// No pitch deviations, and no flanks yet.
fn alike(pair: &GearPair) -> Teeth {
    Teeth { pitch: PitchDeviations::new(pair, [&[], &[]]).unwrap(), flanks: ToothFlanks::default() }
}

/// Deviations by the share of the active flank from root to tip, and by z over half the face.
#[derive(Clone, Copy)]
enum Trace<'a> {
    Profile(&'a dyn Fn(f64) -> f64),
    Lead(&'a dyn Fn(f64) -> f64),
    Grid(&'a dyn Fn(f64, f64) -> f64),
}

fn measured(pair: &GearPair, side: Side, trace: Trace) -> Measured {
    let flank = Flank::new(pair, side);
    let shares: Vec<f64> = (0..=48).map(|index| f64::from(index) / 48.0).collect();
    let rolls = shares.iter().map(|share| flank.root_roll + (flank.tip_roll - flank.root_roll) * share).collect();
    let sides: Vec<f64> = (-6..=6).map(|index| f64::from(index) / 6.0).collect();
    let places = sides.iter().map(|z| 0.5 * flank.face_width * z).collect();
    let (roll_angles, face_positions, deviations): (_, _, Vec<f64>) = match trace {
        Trace::Profile(of) => (Some(rolls), None, shares.iter().map(|share| of(*share)).collect()),
        Trace::Lead(of) => (None, Some(places), sides.iter().map(|z| of(*z)).collect()),
        Trace::Grid(of) => {
            let of = |z: &f64| shares.iter().map(|share| of(*share, *z)).collect::<Vec<_>>();
            (Some(rolls), Some(places), sides.iter().flat_map(of).collect())
        }
    };
    Measured { roll_angles, face_positions, deviations, ..Measured::default() }
}

fn gears(side: Side) -> Gears {
    if side == Side::Pinion { Gears::Pinion } else { Gears::Gear }
}

/// A design with nothing but a trace.
fn own(pair: &GearPair, side: Side, trace: Trace) -> Design {
    let mut design = Design::default();
    design.add(gears(side), &measured(pair, side, trace), pair).unwrap();
    design
}

/// Both flanks of a tooth bent and wavy, deeper at the tip; by a number of its own.
fn wavy(number: usize) -> impl Fn(f64) -> f64 {
    let phase = number as f64;
    move |share: f64| {
        let wave = libm::sin(TAU * (1.5 + 0.1 * phase) * share + phase);
        -1e-6 * (9.0 * share * share * share + 1.3 * wave + libm::cos(2.0 * phase))
    }
}

fn cycle(pair: &GearPair, compliance: &PairCompliance, corner_contact: CornerContact) -> Mesh {
    Mesh::new(pair, compliance, Settings { corner_contact, ..Settings::default() }).unwrap()
}

/// Tier: second method; where every tooth of a gear has the same trace, each base pitch is that of the design with that trace on the
/// gear: laws, coupled teeth, corner contact, reliefs beside it, traces along the profile, across the face and over both.
#[test]
fn the_same_trace_on_every_tooth_is_a_design() {
    let pair = pair();
    let depth = wavy(3);
    let lead = |z: f64| -1e-6 * (3.0 * z * z + 1.5 * z + 0.4 * libm::sin(5.0 * z));
    let grid = |share: f64, z: f64| wavy(2)(share) + lead(z) + 2e-6 * share * z;
    let traces = [Trace::Profile(&depth), Trace::Lead(&lead), Trace::Grid(&grid)];
    let relieved = [
        (
            "tip_relief",
            "both",
            &[("amount", Quantity(12e-6)), ("length", Quantity(3e-3)), ("curve", Choice("parabolic"))][..],
        ),
        ("lead_crowning", "gear", &[("amount", Quantity(4e-6))]),
    ];
    let bases = [Design::default(), design(&pair, &relieved).unwrap()];
    let soft = PairCompliance { contact: Some(ContactLaw::LoadDependent), ..varying() };
    for compliance in [constant(&pair, STIFFNESS), coupled(), soft] {
        for corner_contact in [CornerContact::None, CornerContact::Exact] {
            let cycle = cycle(&pair, &compliance, corner_contact);
            for (side, trace) in SIDES.into_iter().flat_map(|side| traces.map(|trace| (side, trace))) {
                for base in &bases {
                    for force in [0.0, 1867.0] {
                        on_every_tooth(&cycle, base, (side, trace), force);
                    }
                }
            }
        }
    }
}

/// One trace on every tooth of a gear, and on the gear.
fn on_every_tooth(cycle: &Mesh, base: &Design, (side, trace): (Side, Trace), force: f64) {
    let pair = &cycle.pair;
    let (own, mut teeth) = (own(pair, side, trace), alike(pair));
    (0..count(pair, side)).for_each(|tooth| teeth.flanks.give(pair, side, tooth, &own).unwrap());
    let whole = base.with(&own, pair).unwrap();
    let expected = cycle.loaded(&whole, force * pair.pinion.base_radius);
    let found = case(cycle, base, force, &teeth).over_pitches(&teeth, 3..5, 8);
    assert_eq!(found.len(), 16);
    for (index, found) in found.into_iter().enumerate() {
        let position = cycle.period() * (index % 8) as f64 / 8.0;
        let exact = expected.state(position, cycle.pairs_behind(position)).transmission_error();
        assert!((found - exact).abs() < 1e-18, "{side:?}, {force} N, {index}: {found:e} for {exact:e}");
    }
}

/// The same where slices of the face hold each other.
#[test]
fn the_same_trace_on_every_tooth_is_a_design_with_coupled_slices() {
    let pair = pair();
    let lead = |z: f64| -1e-6 * (3.0 * z * z + 1.5 * z);
    let grid = |share: f64, z: f64| wavy(2)(share) + lead(z) + 2e-6 * share * z;
    let settings = Settings { slice_coupling: SliceCoupling::Plate, slices: 5, ..Settings::default() };
    let cycle = Mesh::new(&pair, &constant(&pair, STIFFNESS), settings).unwrap();
    let base = design(&pair, &[("lead_crowning", "gear", &[("amount", Quantity(4e-6))])]).unwrap();
    for trace in [Trace::Profile(&wavy(1)), Trace::Lead(&lead), Trace::Grid(&grid)] {
        on_every_tooth(&cycle, &base, (Side::Gear, trace), 1867.0);
    }
}

/// Tier: closed form; a flank that stands out by d all along is one that is ∓d/cos α off its place: behind of the gear, which is met
/// early, and ahead of the pinion. It touches before A and after E too.
#[test]
fn a_constant_trace_is_a_pitch_deviation() {
    let pair = pair();
    let cosine = libm::cos(pair.pinion.specification.pressure_angle);
    let relief = [("amount", Quantity(12e-6)), ("length", Quantity(3e-3)), ("curve", Choice("linear"))];
    let design = design(&pair, &[("tip_relief", "both", &relief)]).unwrap();
    for corner_contact in [CornerContact::None, CornerContact::Exact] {
        let cycle = cycle(&pair, &coupled(), corner_contact);
        for (side, sign, d) in
            SIDES.iter().zip([-1.0, 1.0]).flat_map(|(side, sign)| [-9e-6, 60e-6].map(|d| (*side, sign, d)))
        {
            let tooth = 4;
            let mut traced = alike(&pair);
            traced.flanks.give(&pair, side, tooth, &own(&pair, side, Trace::Profile(&|_| d))).unwrap();
            assert_eq!(SIDES.map(|side| traced.flanks.count(side)), SIDES.map(|of| usize::from(of == side)));
            let mut cumulative = [vec![], vec![]];
            cumulative[side as usize] = vec![0.0; count(&pair, side)];
            cumulative[side as usize][tooth] = sign * d / cosine;
            let off = super::off(&pair, [&cumulative[0], &cumulative[1]]);
            for force in [0.0, 1867.0] {
                let [found, exact] =
                    [&traced, &off].map(|teeth| case(&cycle, &design, force, teeth).over_pitches(teeth, 0..9, 16));
                let plain = case(&cycle, &design, force, &alike(&pair)).over_pitches(&alike(&pair), 0..9, 16);
                let mut differ = 0;
                for (index, found) in found.iter().enumerate() {
                    differ += usize::from((found - plain[index]).abs() > 1e-7);
                    let off = (found - exact[index]).abs();
                    assert!(off < 1e-17, "{side:?} {d} {force} {index}: {found:e} for {:e}", exact[index]);
                }
                assert!(differ > 5, "it is to be felt: {side:?} {d} {force} {corner_contact:?}: {differ}");
            }
        }
    }
}

/// Tier: second method; under no load, or next to none, the error is the least gap of all pairs, by points of both flanks and thirds.
#[test]
fn the_nearest_of_different_flanks_touches() {
    let pair = pair();
    let cycle = cycle(&pair, &constant(&pair, STIFFNESS), CornerContact::None);
    let base = Design::default();
    // Depths that bend nowhere back, over the share of the active flank: a spline goes through them exactly.
    let coefficients = SIDES.map(|side| {
        let values = scattered(3 * pair.side(side).specification.teeth, 7 + side as u64);
        values.chunks(3).map(|of| [0.3 * of[0], of[1], 1.5 * of[2].abs()]).collect::<Vec<_>>()
    });
    let depth = |[a, b, c]: [f64; 3], share: f64| a + share * (b + share * c);
    let mut teeth = alike(&pair);
    for side in SIDES {
        for (tooth, of) in coefficients[side as usize].iter().enumerate() {
            let trace = own(&pair, side, Trace::Profile(&|share| -depth(*of, share)));
            teeth.flanks.give(&pair, side, tooth, &trace).unwrap();
        }
    }
    let flanks = SIDES.map(|side| Flank::new(&pair, side));
    for force in [0.0, 1e-7] {
        let found = case(&cycle, &base, force, &teeth).over_pitches(&teeth, 17..41, 6);
        let mut bent = 0;
        for (index, found) in found.into_iter().enumerate() {
            let (pitch, position) = (17 + index / 6, cycle.period() * (index % 6) as f64 / 6.0);
            let gap = |number: usize, s: f64| {
                let of = |side: Side, roll: f64| {
                    let flank = &flanks[side as usize];
                    let share = (roll - flank.root_roll) / (flank.tip_roll - flank.root_roll);
                    let of_gear = &coefficients[side as usize];
                    depth(of_gear[number % of_gear.len()], share.clamp(0.0, 1.0))
                };
                let on_line = of(Side::Pinion, pair.roll(Side::Pinion, s)) + of(Side::Gear, pair.roll(Side::Gear, s));
                (least_gap_of(&pair, of, s), on_line)
            };
            let pairs = (0..cycle.pairs_behind(position)).map(|behind| {
                let s = pair.start_of_contact + position + pair.base_pitch * behind as f64;
                gap(pitch - behind, s)
            });
            let (exact, on_line) = pairs.min_by(|one, other| one.0.total_cmp(&other.0)).unwrap();
            bent += usize::from(on_line - exact > 1e-10);
            let under = force / STIFFNESS;
            assert!((found - exact - under).abs() < 2e-15, "{index}, {force} N: {found:e} for {exact:e}");
        }
        assert!(bent > 30, "flanks are to touch off the line of action: {bent}");
    }
}

/// Traces of every third tooth of the pinion and every fifth of the gear, numbered from elsewhere.
fn numbered_from(pair: &GearPair, first: [usize; 2]) -> Teeth {
    let mut teeth = alike(pair);
    for (side, every) in SIDES.into_iter().zip([3, 5]) {
        let count = count(pair, side);
        for tooth in (0..count).filter(|tooth| tooth % every == 0) {
            let trace = own(pair, side, Trace::Profile(&wavy(tooth)));
            teeth.flanks.give(pair, side, (tooth + first[side as usize]) % count, &trace).unwrap();
        }
    }
    teeth
}

/// Tier: invariant, to the last bit; counting from another tooth shifts the period: of both gears by as many pitches, of one by as many
/// as bring its first tooth to the other's. What is asked for in parts is what it is at once.
#[test]
fn other_numbers_shift_the_period() {
    let pair = pair();
    let cycle = cycle(&pair, &coupled(), CornerContact::Exact);
    let base = Design::default();
    let of = |teeth: &Teeth, pitches: std::ops::Range<isize>| {
        case(&cycle, &base, 900.0, teeth).over_pitches(teeth, pitches, 3)
    };
    let teeth = numbered_from(&pair, [0, 0]);
    let whole = of(&teeth, 0..60);
    assert_eq!(of(&numbered_from(&pair, [7, 7]), 7..67), whole);
    // 48 · 2 = 1 + 19 · 5.
    assert_eq!(of(&numbered_from(&pair, [1, 0]), 96..156), whole);
    assert_eq!(of(&teeth, 912..972), whole);
    let parts: Vec<f64> = (0..6).flat_map(|part| of(&teeth, 10 * part..10 * part + 10)).collect();
    assert_eq!(parts, whole);
}

/// Tier: closed form; one tooth of rigid gears that stands out by d is a pulse of d for as long as it touches, once a turn: of N
/// positions w have it, and order n has 2 d/N |sin(π n w/N)/sin(π n/N)|, at whole orders of its gear and nowhere else.
#[test]
fn a_tooth_that_stands_out_is_a_pulse_once_a_turn() {
    let pair = pair();
    let cycle = cycle(&pair, &constant(&pair, STIFFNESS), CornerContact::None);
    let (base, d, positions) = (Design::default(), 6e-6, 8_usize);
    for side in SIDES {
        let mut teeth = alike(&pair);
        teeth.flanks.give(&pair, side, 2, &own(&pair, side, Trace::Profile(&|_| d))).unwrap();
        let found = case(&cycle, &base, 0.0, &teeth).over_pitches(&teeth, 0..912, positions);
        let turn = count(&pair, side) * positions;
        let width = found[..turn].iter().filter(|error| **error < -0.5 * d).count();
        // ε_α base pitches, of which positions see whole parts.
        assert!((width as f64 - pair.contact_ratio * positions as f64).abs() < 1.0, "{width}");
        let turns = 912 / count(&pair, side);
        for (order, found) in (1..).zip(amplitudes(&found, 912 * 2)) {
            let angle = PI * (order / turns) as f64 / turn as f64;
            let exact = 2.0 * d / turn as f64 * (libm::sin(width as f64 * angle) / libm::sin(angle)).abs();
            let exact = if order % turns == 0 { exact } else { 0.0 };
            assert!((found - exact).abs() < 1e-13 * d, "{side:?}, order {order}: {found:e} for {exact:e}");
        }
    }
}

/// Tier: invariant; no gap is nearer or farther than is reckoned with, anywhere that flanks can touch, and none by far.
#[test]
fn gaps_stay_within_what_is_reckoned_with() {
    let pair = pair();
    let cycle = cycle(&pair, &coupled(), CornerContact::Exact);
    let base = Design::default();
    let grid = own(&pair, Side::Gear, Trace::Grid(&|share, z| wavy(2)(share) + 4e-6 * z));
    for is_across in [false, true] {
        let mut teeth = numbered_from(&pair, [0, 0]);
        if is_across {
            teeth.flanks.give(&pair, Side::Gear, 3, &grid).unwrap();
        }
        let [least, most] = teeth.between();
        let plain = Flanks::of(&cycle, &base, is_across, true);
        let (mut nearest, mut farthest, mut seen) = (f64::INFINITY, f64::NEG_INFINITY, 0);
        for number in 0..60 {
            let Some(design) = teeth.flanks.design(&base, number) else { continue };
            let flanks = Flanks::of(&cycle, &design, is_across, true);
            for index in 0..=60 {
                let s = -2e-3 + 22e-3 * f64::from(index) / 60.0;
                let [Some(own), Some(gap)] = [flanks.searched(s), plain.searched(s)] else { continue };
                (nearest, farthest, seen) = (nearest.min(own - gap), farthest.max(own - gap), seen + 1);
            }
        }
        let said = format!("{least:e} {nearest:e} {farthest:e} {most:e}");
        assert!(seen > 1000 && least <= nearest && farthest <= most, "{said}");
        // What is not flat may be met as much deeper.
        let times = if is_across { 9.0 } else { 3.0 };
        assert!(most - least < times * (farthest - nearest), "{said}");
    }
}

#[test]
fn flanks_are_of_teeth_that_there_are() {
    let pair = pair();
    let (trace, mut flanks) = (own(&pair, Side::Gear, Trace::Profile(&|_| 1e-6)), ToothFlanks::default());
    let error = flanks.give(&pair, Side::Gear, 48, &trace).unwrap_err();
    assert_eq!(error.to_string(), "the gear has 48 teeth, and no tooth 49");
    assert_eq!(flanks.count(Side::Gear), 0);
}
