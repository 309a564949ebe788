//! Flanks as measured against the parabolic relief that they are traces of: 500 points for each gear, 64 positions.

use std::hint::black_box;

use criterion::{Criterion, criterion_group};

use crate::article::{Stages, TORQUE, cycle_of};
use crate::brief;
use gearmesh::gear::compliance::ContactLaw::Linear;
use gearmesh::gear::contact::CornerContact;
use gearmesh::gear::geometry::{GearPair, Side};
use gearmesh::gear::mesh::Settings;
use gearmesh::gear::mesh::answers::curve::Wanted;
use gearmesh::gear::modification::curve::Curve;
use gearmesh::gear::modification::flank::Flank;
use gearmesh::gear::modification::measured::Measured;
use gearmesh::gear::modification::relief::{Amount, FromTip, Start};
use gearmesh::gear::modification::tip_relief::TipRelief;
use gearmesh::gear::modification::{Design, Gears};

criterion_group!(name = benches; config = brief(); targets = traces);

const POINTS: u32 = 500;
/// What the others are compared with.
pub const BASE: &str = "parabolic relief";

/// A parabolic relief, and traces of one that starts without a kink: as it is, and rough, with waves or noise.
fn traces(criterion: &mut Criterion) {
    let pair = Stages::new().pair();
    let mut group = criterion.benchmark_group("measured");
    let designs = [
        (BASE, relieved(&pair, Curve::Parabolic)),
        ("trace", traced(&pair, waves(0.0, 1.0))),
        ("trace with waves of 4 mm", traced(&pair, waves(2e-6, 4e-3))),
        ("trace with waves of 0.5 mm", traced(&pair, waves(0.3e-6, 0.5e-3))),
        ("trace with waves of 0.3 mm", traced(&pair, waves(1e-6, 0.3e-3))),
        ("trace with waves of 0.1 mm", traced(&pair, waves(1e-6, 0.1e-3))),
        ("trace with noise", traced(&pair, noise(0.5e-6))),
    ];
    for (corner, corner_contact) in [("", CornerContact::None), (", corner contact", CornerContact::Exact)] {
        let cycle = cycle_of(&pair, Linear, false, Settings { corner_contact, ..Settings::default() });
        for (name, design) in &designs {
            group.bench_function(format!("curve, {name}{corner}"), |bencher| {
                bencher.iter(|| black_box(&cycle).loaded(design, TORQUE).curve(Wanted::default()));
            });
            group.bench_function(format!("curve and summary, {name}{corner}"), |bencher| {
                bencher.iter(|| black_box(&cycle).loaded(design, TORQUE).curve_and_summary(Wanted::default()));
            });
            group.bench_function(format!("peak-to-peak, {name}{corner}"), |bencher| {
                bencher.iter(|| black_box(&cycle).loaded(design, TORQUE).peak_to_peak());
            });
        }
    }
}

fn relieved(pair: &GearPair, curve: Curve) -> Design {
    let (amount, start) = (Amount::Depth(12e-6), Start::Length(4e-3));
    let mut design = Design::default();
    let relief = TipRelief { amount, start, counted_from: FromTip::Tip, curve };
    design.add(Gears::Both, &relief, pair).expect("it fits the flanks");
    design
}

/// Waves of an amplitude and a length \[m\] over the roll length.
fn waves(amplitude: f64, length: f64) -> impl FnMut(f64) -> f64 {
    move |place| amplitude * (std::f64::consts::TAU * place / length).sin()
}

/// Up to so much to either side from point to point \[m\], the same each time.
fn noise(most: f64) -> impl FnMut(f64) -> f64 {
    let mut state = 12345_u64;
    move |_| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        most * ((state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0)
    }
}

fn traced(pair: &GearPair, mut beside: impl FnMut(f64) -> f64) -> Design {
    let plain = relieved(pair, Curve::Power { exponent: 2.0 });
    let mut design = Design::default();
    for (gears, side) in [(Gears::Pinion, Side::Pinion), (Gears::Gear, Side::Gear)] {
        let flank = Flank::new(pair, side);
        let part = |at: u32| f64::from(at) / f64::from(POINTS - 1);
        let rolls = (0..POINTS).map(|at| flank.root_roll + (flank.tip_roll - flank.root_roll) * part(at));
        let trace = Measured {
            deviations: rolls.clone().map(|roll| beside(roll * flank.base_radius) - plain.depth(side, roll)).collect(),
            roll_lengths: Some(rolls.map(|roll| roll * flank.base_radius).collect()),
            ..Measured::default()
        };
        design.add(gears, &trace, pair).expect("it is of these flanks");
    }
    design
}
