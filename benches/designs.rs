//! The stage `ste` over many designs: its time must go with their number.

use std::fmt::Write;

use criterion::{Criterion, criterion_group};

use crate::accuracy::seconds;
use crate::article::Stages;
use crate::brief;

criterion_group!(name = benches; config = brief().sample_size(10); targets = designs);

const FEW: usize = 1_000;
const MANY: usize = 8_000;
/// How much longer many may take than few.
const MOST_RATIO: f64 = 9.0;

const PAIR: &str = "\
study: designs
stages:
  pair:
    kind: geometry
    module: 3 mm
    pressure_angle: 20 deg
    pinion: { teeth: 24, face_width: 20 mm, bore_radius: 15 mm }
    gear: { teeth: 36, face_width: 20 mm, bore_radius: 15 mm }
  stiffness: { kind: stiffness, pair: pair }
  ste: { kind: ste, stiffness: stiffness, designs: designs, torque: 50 N m, positions: 64 }
  designs:
    kind: modification
    pair: pair
    designs:
";

/// Everything that `ste` reads, with so many tip reliefs of different amounts and lengths.
fn prepared(count: usize) -> Stages {
    let mut text = PAIR.to_owned();
    for index in 0..count {
        let (amount, length) = (1.0 + 9.0 * index as f64 / count as f64, 1.0 + (index % 97) as f64 / 97.0);
        let relief = format!("gear: both, amount: {amount:.6} um, length: {length:.4} mm");
        writeln!(text, "      d{index}: [tip_relief: {{ {relief} }}]").expect("a string takes all");
    }
    let folder = tempfile::tempdir().expect("there is a place for temporary files");
    let path = folder.path().join("designs.yaml");
    std::fs::write(&path, text).expect("the folder is ours");
    let mut stages = Stages::at(&path);
    stages.prepare("ste");
    stages
}

fn designs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("designs");
    let stages = prepared(MANY);
    group.bench_function("ste of 8,000", |bencher| bencher.iter(|| stages.run("ste")));
}

pub fn print() {
    let taken = [FEW, MANY].map(|count| {
        let stages = prepared(count);
        seconds(|| stages.run("ste"))
    });
    println!("\nStage ste over designs, one torque, 64 positions, all threads\n");
    println!("{:>9} {:>9} {:>12}", "designs", "ms", "µs a design");
    for (count, taken) in [FEW, MANY].into_iter().zip(taken) {
        println!("{count:>9} {:>9.1} {:>12.1}", taken * 1e3, taken * 1e6 / count as f64);
    }
    let ratio = taken[1] / taken[0];
    let verdict = if ratio <= MOST_RATIO { "met" } else { "MISSED" };
    println!("ratio {ratio:.2}, target {MOST_RATIO} at most: {verdict}");
}
