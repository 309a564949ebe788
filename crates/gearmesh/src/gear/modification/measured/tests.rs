//! Traces against the families that they are traces of, and what is no trace of a flank.

use std::time::Instant;

use super::*;
use crate::gear::contact::CornerContact;
use crate::gear::fixtures::{constant, pair, varying};
use crate::gear::modification::curve::Curve;
use crate::gear::modification::relief::{Amount, FromTip, Start};
use crate::gear::modification::tip_relief::TipRelief;
use crate::gear::modification::{Design, Gears};
use crate::gear::transmission_error::curve::Wanted;
use crate::gear::transmission_error::cycle::{MeshCycle, Settings};
use crate::gear::transmission_error::load_case::LoadCase;

/// A trace of a profile with so many points, nothing else said.
fn profile(pair: &GearPair, side: Side, count: usize, deviation: impl Fn(f64) -> f64) -> Measured {
    let flank = Flank::new(pair, side);
    let roll = |at: usize| flank.root_roll + (flank.tip_roll - flank.root_roll) * at as f64 / (count - 1) as f64;
    let rolls: Vec<f64> = (0..count).map(roll).collect();
    Measured {
        deviations: rolls.iter().map(|roll| deviation(*roll)).collect(),
        roll_lengths: Some(rolls.iter().map(|roll| roll * flank.base_radius).collect()),
        roll_angles: None,
        diameters: None,
        face_positions: None,
        evaluation_start: None,
        evaluation_end: None,
        smoothing: Smoothing::None,
    }
}

fn relief() -> TipRelief {
    TipRelief {
        amount: Amount::Depth(12e-6),
        start: Start::Fraction(1.0),
        counted_from: FromTip::Tip,
        curve: Curve::Parabolic,
    }
}

#[test]
fn timing() {
    let pair = pair();
    let mut plain = Design::default();
    plain.add(Gears::Both, &relief(), &pair).unwrap();
    let mut design = Design::default();
    for (gears, side) in [(Gears::Pinion, Side::Pinion), (Gears::Gear, Side::Gear)] {
        let trace = profile(&pair, side, 500, |roll| -plain.depth(side, roll));
        design.add(gears, &trace, &pair).unwrap();
    }
    let mut wavy = Design::default();
    for (gears, side) in [(Gears::Pinion, Side::Pinion), (Gears::Gear, Side::Gear)] {
        let trace = profile(&pair, side, 500, |roll| -plain.depth(side, roll) + 0.1e-6 * libm::sin(250.0 * roll));
        wavy.add(gears, &trace, &pair).unwrap();
    }
    for corner in [CornerContact::None, CornerContact::Exact] {
        let settings = Settings { corner_contact: corner, ..Settings::default() };
        let compliance = varying();
        let cycle = MeshCycle::new(&pair, &compliance, settings).unwrap();
        for (name, design) in [("relief", &plain), ("measured", &design), ("wavy", &wavy)] {
            let start = Instant::now();
            let mut sum = 0.0;
            for _ in 0..20 {
                sum += LoadCase::new(&cycle, design, 150.0).peak_to_peak();
            }
            let one = start.elapsed();
            let start = Instant::now();
            for _ in 0..20 {
                let _ = LoadCase::new(&cycle, design, 150.0).curve_and_summary(Wanted::default());
            }
            let profiles = design.profiles(0.0);
            let t0 = Instant::now();
            let gaps = crate::gear::contact::gap::Gaps::new(&pair, &profiles);
            let t1 = t0.elapsed();
            let (from, to) = (pair.start_of_contact, pair.end_of_contact);
            let t0 = Instant::now();
            let mut total = 0.0;
            for i in 0..10000 { total += gaps.at(from + (to - from) * (f64::from(i) + 0.5) / 1e4).unwrap(); }
            let t2 = t0.elapsed() / 10000;
            let t0 = Instant::now();
            let b = gaps.breaks((from - 1e-4, to + 1e-4));
            let t3 = t0.elapsed();
            println!("new {t1:?}, at {t2:?} {total:e}, breaks {} {t3:?}", b.len());
            println!("{name} {corner:?}: ptp {:?} curve {:?}; {:e}", one / 20, start.elapsed() / 20, sum / 20.0);
        }
    }
    let _ = constant(&pair, 1.0);
}
