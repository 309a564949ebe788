//! Closed forms, invariants and traps of the transmission error.

#![allow(clippy::float_cmp)] // where a result must be exact, that is what is asked

mod broken_tips;
mod contact_law_error;
mod corner;
mod exchange;
mod extremes;
mod friction;
mod needs;
mod neglected_corners;
mod plain;
mod pressure;
mod root_stress;
mod sampling;
mod spans;
mod surface;
mod together;
mod work;

use super::answers::curve::Wanted;
use super::answers::stiffness::stiffness;
use super::{Loaded, Mesh, Settings};
use crate::gear::compliance::{ContactLaw, PairCompliance};
use crate::gear::fixtures::{
    BASE_PITCH, constant, coupled, design, inclined, least_gap, pair, pair_with_contact_ratio, swapped, varying,
};
use crate::gear::geometry::GearPair;
use crate::gear::geometry::Side::Pinion;
use crate::gear::modification::Design;
use declare::record::Value::{Choice, Number, Quantity};

const STIFFNESS: f64 = 2.8e8;

fn cycle(pair: &GearPair, compliance: &PairCompliance) -> Mesh {
    Mesh::new(pair, compliance, Settings::default()).unwrap()
}

fn torque(force: f64) -> f64 {
    force * pair().pinion.base_radius
}

fn relief(pair: &GearPair, amount: f64, fraction: f64) -> Design {
    design(pair, &[("tip_relief", "both", &[("amount", Quantity(amount)), ("fraction", Quantity(fraction))])]).unwrap()
}

fn crowned(pair: &GearPair, amount: f64) -> Design {
    design(pair, &[("lead_crowning", "pinion", &[("amount", Quantity(amount))])]).unwrap()
}

fn ga_design(pair: &GearPair, amount: f64, length: f64, crown: f64) -> Design {
    let tip = [("amount", Quantity(amount)), ("length", Quantity(length)), ("curve", Choice("parabolic"))];
    design(pair, &[("tip_relief", "both", &tip), ("lead_crowning", "pinion", &[("amount", Quantity(crown))])]).unwrap()
}

#[track_caller]
fn close(value: f64, exact: f64, relative: f64) {
    assert!((value - exact).abs() <= relative * exact.abs(), "{value:e} is not {exact:e}");
}

/// Harris' relations for constant pair stiffness k: no relief F/2k, long linear relief |F/k − C|/2, short F/2k. They take
/// the gap on the line of action; the least one is nearer by ρ_r C′²/2 with C′ along the flank, of second order in the amount.
#[test]
fn harris_relations_hold() {
    for (ratio, scale, second) in [1.1, 1.35, 1.645_626_2, 1.9]
        .into_iter()
        .flat_map(|ratio| [1e-4, 1e-8].map(|scale| (ratio, scale, 0.3 * scale)))
    {
        let pair = pair_with_contact_ratio(ratio);
        let cycle = cycle(&pair, &constant(&pair, STIFFNESS));
        for force in [1e-6, 10.0, 700.0, 1867.0, 2800.0, 40_000.0].map(|force| force * scale) {
            let run = |design: &Design| cycle.loaded(design, torque(force)).summary(Wanted::default());
            close(run(&Design::default()).peak_to_peak, 0.5 * force / STIFFNESS, 1e-11);
            let amount = 7e-6 * scale;
            let long = run(&relief(&pair, amount, 1.0));
            let exact = 0.5 * (force / STIFFNESS - amount).abs();
            let off = (long.peak_to_peak - exact).abs();
            assert!(off < 1e-9 * (force / STIFFNESS) + second * amount, "long, {force} N, {ratio}: {off:e}");
            close(long.unloaded_peak_to_peak, 0.5 * amount, second);
            if ratio < 1.9 {
                let short = run(&relief(&pair, amount, 0.5));
                let off = (short.peak_to_peak - 0.5 * force / STIFFNESS).abs();
                assert!(off < 1e-9 * (force / STIFFNESS) + second * amount, "short, {force} N, {ratio}: {off:e}");
                assert!(short.unloaded_peak_to_peak < second * amount);
            }
        }
    }
}

/// Two levels, F/2k for a share ε − 1 of the cycle and F/k for the rest: mean, variance and harmonics in closed form.
#[test]
fn moments_and_harmonics_of_unmodified_gears_are_those_of_a_rectangular_wave() {
    let pair = pair();
    let cycle = cycle(&pair, &constant(&pair, STIFFNESS));
    let (force, share) = (1867.0, pair.contact_ratio - 1.0);
    let design = Design::default();
    let summary =
        cycle.loaded(&design, torque(force)).summary(Wanted { harmonics: 8, pressure: false, ..Wanted::default() });
    let (low, high) = (0.5 * force / STIFFNESS, force / STIFFNESS);
    close(summary.mean, low * share + high * (1.0 - share), 1e-13);
    close(summary.variance, (high - low) * (high - low) * share * (1.0 - share), 1e-12);
    close(summary.reciprocal_variance.unwrap() * summary.variance, 1.0, 1e-15);
    for (index, amplitude) in summary.harmonics.iter().enumerate() {
        let angle = std::f64::consts::PI * (index + 1) as f64;
        close(*amplitude, 2.0 * (high - low) * libm::sin(angle * share).abs() / angle, 1e-8);
    }
    close(summary.loaded_contact_ratio, pair.contact_ratio, 1e-12);
    close(summary.largest_load_share, 1.0, 1e-13);
    assert_eq!(summary.unloaded_peak_to_peak, 0.0);
}

#[test]
fn every_contact_ratio_gives_its_levels() {
    for (ratio, fewest, most) in
        [(1.0, 1.0, 1.0), (1.0001, 1.0, 2.0), (2.0, 2.0, 2.0), (2.5, 2.0, 3.0), (3.2, 3.0, 4.0), (3.0, 3.0, 3.0)]
    {
        let pair = pair_with_contact_ratio(ratio);
        let cycle = cycle(&pair, &constant(&pair, STIFFNESS));
        let force = 1000.0;
        let design = Design::default();
        let summary = cycle.loaded(&design, torque(force)).summary(Wanted::default());
        let exact = force / STIFFNESS * (1.0 / fewest - 1.0 / most);
        assert!((summary.peak_to_peak - exact).abs() < 1e-12 * force / STIFFNESS, "{ratio}");
        let (_, stiffness) = stiffness(&cycle, 10.0);
        close(stiffness.fewest_pairs.minimum, fewest * STIFFNESS, 1e-12);
        assert_eq!(stiffness.most_pairs.is_some(), fewest < most);
        close(stiffness.most_pairs.map_or(most * STIFFNESS, |zone| zone.maximum), most * STIFFNESS, 1e-12);
        close(stiffness.mean, ratio * STIFFNESS, 1e-9);
    }
    for ratio in [0.999, 6.001, f64::NAN] {
        let pair = pair_with_contact_ratio(ratio);
        let message = Mesh::new(&pair, &varying(), Settings::default()).unwrap_err().to_string();
        assert!(message.contains("contact ratio"), "{message}");
    }
}

/// Stiffness of varying teeth against a fine grid of the sum of reciprocals, with one-sided ends.
#[test]
fn stiffness_of_varying_teeth_is_the_sum_over_pairs() {
    let pair = pair();
    let compliance = varying();
    let (points, summary) = stiffness(&cycle(&pair, &compliance), 50.0);
    let single = |s: f64| {
        let contact = 4.0 * 0.91 / (std::f64::consts::PI * 206e9 * 18e-3);
        let (u1, u2) = (s / pair.pinion.base_radius, (pair.tangent_length - s) / pair.gear.base_radius);
        1.0 / (compliance.pinion.total(u1) + compliance.gear.total(u2) + contact)
    };
    for point in &points {
        let s = point.path_position;
        let exact = if point.pairs == 2 { single(s) + single(s + BASE_PITCH) } else { single(s) };
        close(point.secant_stiffness, exact, 1e-12);
        close(point.tangent_stiffness, exact, 1e-12);
    }
    let shared = pair.end_of_contact - BASE_PITCH - pair.start_of_contact;
    let grid = |from: f64, to: f64| (0..=20_000).map(move |i| from + (to - from) * f64::from(i) / 20_000.0);
    let a = pair.start_of_contact;
    let singles: Vec<f64> = grid(a + shared, a + BASE_PITCH).map(single).collect();
    let doubles: Vec<f64> = grid(a, a + shared).map(|s| single(s) + single(s + BASE_PITCH)).collect();
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let smallest = |values: &[f64]| values.iter().copied().fold(f64::INFINITY, f64::min);
    let double = summary.most_pairs.unwrap();
    close(summary.fewest_pairs.maximum, largest(&singles), 1e-8);
    close(summary.fewest_pairs.minimum, smallest(&singles), 1e-8);
    close(double.maximum, largest(&doubles), 1e-8);
    close(double.minimum, smallest(&doubles), 1e-8);
}

#[test]
fn peak_to_peak_does_not_depend_on_the_number_of_positions() {
    let pair = pair();
    let logarithmic = PairCompliance { contact: Some(ContactLaw::LoadDependent), ..varying() };
    let resolved = PairCompliance { contact: Some(ContactLaw::Resolved), ..inclined(coupled()) };
    let power =
        [("amount", Quantity(9e-6)), ("length", Quantity(4e-3)), ("curve", Choice("power")), ("exponent", Number(2.5))];
    let root = [("amount", Quantity(5e-6)), ("fraction", Quantity(0.7))];
    let mixed = design(
        &pair,
        &[
            ("tip_relief", "pinion", &power),
            ("root_relief", "pinion", &root),
            ("profile_crowning", "gear", &[("amount", Quantity(4e-6))]),
            ("profile_slope", "pinion", &[("amount", Quantity(-3e-6))]),
            ("lead_crowning", "gear", &[("amount", Quantity(3e-6))]),
        ],
    )
    .unwrap();
    let designs = [
        Design::default(),
        ga_design(&pair, 6.93e-6, 3.41e-3, 5.67e-6),
        ga_design(&pair, 7.81e-6, 5.05e-3, 6.34e-6),
        ga_design(&pair, 20e-6, 5.9e-3, 0.0),
        ga_design(&pair, 3e-6, 8.0e-3, 20e-6),
        mixed,
    ];
    for (which, compliance) in [varying(), coupled(), logarithmic, resolved].iter().enumerate() {
        let run = |positions: usize, design: &Design, torque: f64| {
            let cycle = Mesh::new(&pair, compliance, Settings { positions, slices: 9, ..Settings::default() }).unwrap();
            cycle.loaded(design, torque).peak_to_peak()
        };
        for (index, design) in designs.iter().enumerate() {
            for torque in [1.0, 10.0, 25.0, 50.0, 100.0, 700.0] {
                let fine = run(1000, design, torque);
                for positions in [16, 64] {
                    let coarse = run(positions, design, torque);
                    assert!(
                        (coarse / fine - 1.0).abs() < 1e-9,
                        "{which} {index} {torque} N m, {positions}: {coarse:e} {fine:e} {:e}",
                        coarse / fine - 1.0
                    );
                }
            }
        }
    }
}

/// Brute force: a fine uniform grid with the zones told apart by comparison.
#[test]
fn peak_to_peak_agrees_with_a_brute_grid() {
    let pair = pair();
    let compliance = varying();
    let cycle = cycle(&pair, &compliance);
    let contact = 4.0 * 0.91 / (std::f64::consts::PI * 206e9 * 18e-3);
    for (amount, length) in [(6.93e-6, 3.41e-3), (12e-6, 5.5e-3)] {
        let design = ga_design(&pair, amount, length, 0.0);
        let force = 50.0 / pair.pinion.base_radius;
        let (mut low, mut high, mut sum) = (f64::INFINITY, 0.0_f64, 0.0);
        let count = 100_000;
        for i in 0..count {
            let tau = BASE_PITCH * (f64::from(i) + 0.5) / f64::from(count);
            let mut pairs = Vec::new();
            for s in [tau + pair.start_of_contact, tau + pair.start_of_contact + BASE_PITCH] {
                if s < pair.end_of_contact {
                    let (u1, u2) = (s / pair.pinion.base_radius, (pair.tangent_length - s) / pair.gear.base_radius);
                    pairs.push((
                        least_gap(&pair, &design, s),
                        1.0 / (compliance.pinion.total(u1) + compliance.gear.total(u2) + contact),
                    ));
                }
            }
            // Bisection on the load balance.
            let (mut a, mut b) = (0.0, 1e-3);
            for _ in 0..60 {
                let middle = 0.5 * (a + b);
                let load: f64 = pairs.iter().map(|(gap, k)| k * f64::max(middle - gap, 0.0)).sum();
                if load < force { a = middle } else { b = middle }
            }
            (low, high, sum) = (low.min(b), high.max(b), sum + b);
        }
        let summary = cycle.loaded(&design, 50.0).summary(Wanted::default());
        close(summary.peak_to_peak, high - low, 3e-4);
        assert!(summary.peak_to_peak >= (high - low) * (1.0 - 1e-9), "a grid cannot see more than everything");
        close(summary.mean, sum / f64::from(count), 1e-9);
    }
}

/// Driving and driven gear may change places; the path is then run through backwards.
#[test]
fn swapping_the_gears_changes_nothing() {
    let pair = pair();
    let swapped = swapped(&pair);
    let tip = [("amount", Quantity(8e-6)), ("length", Quantity(4e-3)), ("curve", Choice("parabolic"))];
    let root = [("amount", Quantity(5e-6)), ("fraction", Quantity(0.5))];
    let face = [("amount", Quantity(6e-6)), ("length", Quantity(4e-3))];
    let of = |pair: &GearPair, one: &'static str, two: &'static str| {
        design(pair, &[("tip_relief", one, &tip), ("root_relief", two, &root), ("end_relief", one, &face)]).unwrap()
    };
    for contact in [ContactLaw::Linear, ContactLaw::LoadDependent, ContactLaw::Resolved] {
        for compliance in [varying(), coupled(), inclined(coupled())] {
            let compliance = PairCompliance { contact: Some(contact), ..compliance };
            let mirrored = PairCompliance {
                pinion: compliance.gear.clone(),
                gear: compliance.pinion.clone(),
                ..compliance.clone()
            };
            let (one, two) = (of(&pair, "pinion", "gear"), of(&swapped, "gear", "pinion"));
            let wanted = Wanted { harmonics: 3, pressure: true, ..Wanted::default() };
            let here = cycle(&pair, &compliance).loaded(&one, 50.0).summary(wanted);
            let there = cycle(&swapped, &mirrored);
            let there = there.loaded(&two, 50.0 * 48.0 / 19.0).summary(wanted);
            close(here.peak_to_peak, there.peak_to_peak, 1e-9);
            close(here.mean, there.mean, 1e-10);
            close(here.variance, there.variance, 1e-7);
            close(here.largest_pressure.unwrap().extremum.value, there.largest_pressure.unwrap().extremum.value, 1e-9);
            for (a, b) in here.harmonics.iter().zip(&there.harmonics) {
                assert!((a - b).abs() < 1e-7 * here.peak_to_peak, "{a} {b}");
            }
        }
    }
}
