//! Pitch deviations against springs behind steps, turned gears, and rigid flanks.

#![allow(clippy::float_cmp)] // where a result must be exact, that is what is asked

mod traces;

use super::{PitchDeviations, Teeth, ToothFlanks, hunting_period};
use crate::gear::contact::CornerContact;
use crate::gear::fixtures::{constant, coupled, pair};
use crate::gear::geometry::GearPair;
use crate::gear::mesh::{Loaded, Mesh, Settings};
use crate::gear::modification::Design;

const STIFFNESS: f64 = 2.8e8;

/// Deviations without any order, within ± 10 µm.
fn scattered(count: u32, seed: u64) -> Vec<f64> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 40) as f64 / f64::from(1_u32 << 24) - 0.5) * 20e-6
    };
    (0..count).map(|_| next()).collect()
}

fn of_both(pair: &GearPair) -> [Vec<f64>; 2] {
    [scattered(pair.pinion.specification.teeth, 1), scattered(pair.gear.specification.teeth, 2)]
}

/// Teeth that are off their places, and alike.
fn off(pair: &GearPair, cumulative: [&[f64]; 2]) -> Teeth {
    Teeth { pitch: PitchDeviations::new(pair, cumulative).unwrap(), flanks: ToothFlanks::default() }
}

fn case<'a>(cycle: &'a Mesh, design: &'a Design, force: f64, teeth: &Teeth) -> Loaded<'a> {
    cycle.loaded(design, force * cycle.pair.pinion.base_radius).with_teeth(teeth)
}

/// Tier: closed form; springs of one stiffness behind steps: of two pairs δ = (F/k + e + e')/2, or F/k + the smaller one where
/// the other does not reach; of one F/k + e. All pairs of teeth over the whole period, loads that close all gaps and none.
#[test]
fn springs_behind_steps_share_the_load() {
    let pair = pair();
    let (cycle, design) =
        (Mesh::new(&pair, &constant(&pair, STIFFNESS), Settings::default()).unwrap(), Design::default());
    let [pinion, gear] = of_both(&pair);
    let off = off(&pair, [&pinion, &gear]);
    let cosine = pair.pinion.specification.pressure_angle.cos();
    let teeth = [pinion.len(), gear.len()];
    let period = hunting_period([pair.pinion.specification.teeth, pair.gear.specification.teeth]);
    let (mut shared, mut alone) = (0, 0);
    for force in [200.0, 1867.0, 20_000.0] {
        let loading = case(&cycle, &design, force, &off);
        for pitch in 0..period {
            let apart = |number: usize| cosine * (pinion[number % teeth[0]] - gear[number % teeth[1]]);
            // The pair before: at the beginning of the period it is the last one of it.
            let (newest, older) = (apart(pitch), apart(pitch + period - 1));
            let at = pitch.cast_signed();
            for (index, found) in loading.over_pitches(&off, at..at + 1, 8).into_iter().enumerate() {
                let single = cycle.pairs_behind(cycle.period() * index as f64 / 8.0) == 1;
                let both = 0.5 * (force / STIFFNESS + newest + older);
                let one = force / STIFFNESS + newest.min(older);
                let exact = match single {
                    true => force / STIFFNESS + newest,
                    false if both > newest.max(older) => both,
                    false => one,
                };
                if !single {
                    *(if both > newest.max(older) { &mut shared } else { &mut alone }) += 1;
                }
                assert!((found - exact).abs() < 1e-15, "pitch {pitch}, {index}, {force} N: {found:e} for {exact:e}");
            }
        }
    }
    assert!(shared > 1000 && alone > 1000, "{shared} shared, {alone} alone");
}

/// Tier: invariant; all teeth off by the same turn one gear: by c of the pinion the error is c cos α larger, by as much of both it
/// is what it was. Coupled pairs and corner contact too, and without load.
#[test]
fn a_gear_that_is_turned_shifts_the_error() {
    let pair = pair();
    let design = Design::default();
    let c = 12e-6;
    let turned = [vec![c; pair.pinion.specification.teeth as usize], vec![c; pair.gear.specification.teeth as usize]];
    let cosine = pair.pinion.specification.pressure_angle.cos();
    for corner_contact in [CornerContact::None, CornerContact::Exact] {
        let settings = Settings { corner_contact, ..Settings::default() };
        let cycle = Mesh::new(&pair, &coupled(), settings).unwrap();
        for force in [0.0, 1867.0] {
            let of = |cumulative: [&[f64]; 2], pitch: isize| {
                let off = off(&pair, cumulative);
                case(&cycle, &design, force, &off).over_pitches(&off, pitch..pitch + 1, 16)
            };
            let plain = of([&[], &[]], 0);
            let own = cycle.loaded(&design, force * pair.pinion.base_radius);
            let states: Vec<f64> = (0..16)
                .map(|index| cycle.period() * f64::from(index) / 16.0)
                .map(|position| own.state(position, cycle.pairs_behind(position)).transmission_error())
                .collect();
            assert_eq!(plain.len(), states.len());
            for (index, plain) in plain.iter().enumerate() {
                let near = |found: f64, exact: f64, what: &str| {
                    assert!(
                        (found - exact).abs() < 1e-14,
                        "{what}, {corner_contact:?}, {force} N: {found:e}, {exact:e}"
                    );
                };
                near(*plain, states[index], "nothing off");
                near(of([&turned[0], &[]], 3)[index], plain + c * cosine, "the pinion");
                near(of([&[], &turned[1]], 5)[index], plain - c * cosine, "the gear");
                near(of([&turned[0], &turned[1]], 7)[index], *plain, "both");
            }
        }
    }
}

/// Tier: second method; rigid flanks touch where gap and step together are least.
#[test]
fn without_load_the_nearest_pair_touches() {
    let pair = pair();
    let settings = Settings { corner_contact: CornerContact::Exact, ..Settings::default() };
    let (cycle, design) = (Mesh::new(&pair, &constant(&pair, STIFFNESS), settings).unwrap(), Design::default());
    let [pinion, gear] = of_both(&pair).map(|of| of.into_iter().map(|value| 5.0 * value).collect::<Vec<_>>());
    let off = off(&pair, [&pinion, &gear]);
    let loading = case(&cycle, &design, 0.0, &off);
    let mut outside = 0;
    for pitch in 0..60 {
        for (index, found) in loading.over_pitches(&off, pitch..pitch + 1, 32).into_iter().enumerate() {
            let position = cycle.period() * index as f64 / 32.0;
            let at = |ahead: isize| {
                let s = cycle.path_position(position, (ahead + 1).cast_unsigned());
                Some((loading.gap(s)? + off.pitch.of_pair(pitch - ahead), s))
            };
            let (exact, s) = (-1..3).filter_map(at).min_by(|one, two| one.0.total_cmp(&two.0)).unwrap();
            outside += usize::from(s < pair.start_of_contact || s > pair.end_of_contact);
            assert!((found - exact).abs() < 1e-18, "pitch {pitch}, {index}: {found:e} for {exact:e}");
        }
    }
    assert!(outside > 20, "corners are to touch: {outside}");
}

/// Tier: arithmetic; the least common multiple.
#[test]
fn teeth_meet_again_after_their_least_common_multiple() {
    for (teeth, period) in [([19, 48], 912), ([20, 40], 40), ([24, 36], 72), ([101, 103], 10_403), ([7, 7], 7)] {
        assert_eq!(hunting_period(teeth), period);
    }
}

#[test]
fn deviations_are_of_each_tooth() {
    let error = PitchDeviations::new(&pair(), [&[], &[0.0; 3]]).unwrap_err();
    assert!(error.to_string().ends_with("teeth, but 3 pitch deviations are stated"), "{error}");
    assert!(error.to_string().starts_with("the gear has "), "{error}");
}
