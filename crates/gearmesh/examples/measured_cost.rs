//! Temporary.
use gearmesh::gear::geometry::Side;
use gearmesh::gear::modification::flank::Flank;
use gearmesh::gear::modification::measured::{Measured, Smoothing};
use gearmesh::prelude::*;
use std::hint::black_box;
use std::time::Instant;

fn least(rounds: usize, calls: u32, mut call: impl FnMut()) -> f64 {
    (0..rounds)
        .map(|_| {
            let b = Instant::now();
            (0..calls).for_each(|_| call());
            b.elapsed().as_secs_f64() / f64::from(calls)
        })
        .fold(f64::INFINITY, f64::min)
}

fn trace(pair: &GearPair, side: Side, count: usize, deviation: impl Fn(f64) -> f64) -> Measured {
    let flank = Flank::new(pair, side);
    let rolls: Vec<f64> = (0..count)
        .map(|at| flank.root_roll + (flank.tip_roll - flank.root_roll) * at as f64 / (count - 1) as f64)
        .collect();
    Measured {
        deviations: rolls.iter().map(|roll| deviation(*roll)).collect(),
        roll_lengths: Some(rolls.iter().map(|roll| roll * flank.base_radius).collect()),
        roll_angles: None,
        diameters: None,
        face_positions: None,
        evaluation_start: None,
        evaluation_end: None,
        teeth: None,
        module: None,
        smoothing: Smoothing::None,
    }
}

fn main() {
    let gear = |teeth: u32, bore_radius: f64| Specification {
        teeth,
        module: 3e-3,
        pressure_angle: 20_f64.to_radians(),
        profile_shift: 0.0,
        thickness_allowance: 0.0,
        rack: Rack::ISO_53_A,
        tip_radius: None,
        face_width: 20e-3,
        bore_radius,
        material: Material::STEEL,
    };
    let pair = GearPair::new(gear(24, 18e-3), gear(36, 28e-3), None).unwrap();
    let assumptions = Assumptions { coupled: false, ..Assumptions::default() };
    let compliance = Energy::default().tabulate(&pair, assumptions).unwrap().compliance;
    let mut plain = Design::default();
    plain
        .add(
            Gears::Both,
            &TipRelief {
                amount: Amount::Depth(12e-6),
                start: Start::Length(4e-3),
                counted_from: FromTip::Tip,
                curve: Curve::Power { exponent: 2.0 },
            },
            &pair,
        )
        .unwrap();
    let mut parabolic = Design::default();
    parabolic
        .add(
            Gears::Both,
            &TipRelief {
                amount: Amount::Depth(12e-6),
                start: Start::Length(4e-3),
                counted_from: FromTip::Tip,
                curve: Curve::Parabolic,
            },
            &pair,
        )
        .unwrap();
    let make = |wave: f64, length: f64| {
        let mut design = Design::default();
        for (gears, side) in [(Gears::Pinion, Side::Pinion), (Gears::Gear, Side::Gear)] {
            let turn = std::f64::consts::TAU * pair.side(side).base_radius / length;
            design
                .add(
                    gears,
                    &trace(&pair, side, 500, |roll| wave * (turn * roll).sin() - plain.depth(side, roll)),
                    &pair,
                )
                .unwrap();
        }
        design
    };
    let args: Vec<String> = std::env::args().collect();
    let corner_contact = if args[2] == "exact" { CornerContact::Exact } else { CornerContact::None };
    let cycle = MeshCycle::new(&pair, &compliance, Settings { corner_contact, ..Settings::default() }).unwrap();
    let wanted = Wanted { harmonics: 8, ..Wanted::default() };
    let design = match args[1].as_str() {
        "parabolic" => parabolic,
        "smooth" => make(0.0, 1.0),
        "wavy" => make(2e-6, 4e-3),
        "waves" => make(0.3e-6, 0.5e-3),
        _ => make(1e-6, 0.3e-3),
    };
    let loops: u32 = args[4].parse().unwrap();
    let time = least(if loops == 1 { 1 } else { 400 }, loops, || {
        if args[3] == "curve" {
            black_box(LoadCase::new(&cycle, &design, 150.0).curve_and_summary(wanted));
        } else {
            black_box(LoadCase::new(&cycle, &design, 150.0).peak_to_peak());
        }
    });
    println!("{:.1} us", time * 1e6);
}
