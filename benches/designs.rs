//! Stages over many designs: the time of `ste` must go with their number, that of `optimizer` be the kernel's.

use std::fmt::Write;
use std::hint::black_box;
use std::time::Instant;

use criterion::{Criterion, criterion_group};
use gearmesh::optimize::{self, sobol::Sobol};
use gearmesh::prelude::*;

use crate::accuracy::seconds;
use crate::article::{Stages, cycle};
use crate::brief;

criterion_group!(name = benches; config = brief().sample_size(10); targets = designs);

const FEW: usize = 1_000;
const MANY: usize = 8_000;
/// How much longer many may take than few.
const MOST_RATIO: f64 = 9.0;

/// Designs that the optimiser tries.
const TRIED: u32 = 20_000;
/// Turns of which the fastest counts.
const ROUNDS: usize = 15;
/// Its time per design, in that of the transmission error alone.
const MOST_REST: f64 = 1.34;
/// Processor time on two threads, in that on one.
const MOST_SHARED: f64 = 1.5;

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

/// Crowned and relieved designs in a box.
const OPTIMIZER: &str = "
  plain: { kind: stiffness, pair: pair, coupling: none, root: circular_fillet }
  optimum:
    kind: optimizer
    stiffness: plain
    at: { torque: 100 N m }
    method: { sobol: { points: 20000 } }
    design:
      - tip_relief: { gear: both, amount: [0 um, 30 um], length: [0.5 mm, 5 mm] }
      - lead_crowning: { gear: pinion, amount: [2 um, 10 um] }
";

/// Everything that `ste` reads, with so many tip reliefs of different amounts and lengths.
fn prepared(count: usize) -> Stages {
    let mut text = PAIR.to_owned();
    for index in 0..count {
        let (amount, length) = (1.0 + 9.0 * index as f64 / count as f64, 1.0 + (index % 97) as f64 / 97.0);
        let relief = format!("gear: both, amount: {amount:.6} um, length: {length:.4} mm");
        writeln!(text, "      d{index}: [tip_relief: {{ {relief} }}]").expect("a string takes all");
    }
    stages(&text, "ste")
}

/// A study of which everything is run that this stage reads.
fn stages(text: &str, stage: &str) -> Stages {
    let folder = tempfile::tempdir().expect("there is a place for temporary files");
    let path = folder.path().join("designs.yaml");
    std::fs::write(&path, text).expect("the folder is ours");
    let mut stages = Stages::at(&path);
    stages.prepare(stage);
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

/// What a design costs an optimiser, and what of it the transmission error takes.
pub fn print_optimizer() {
    let text = format!("{PAIR}      none: []\n{OPTIMIZER}");
    let mut stages = stages(&text, "optimum");
    let pools = [1, 2]
        .map(|threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started"));
    let pair = stages.pair();
    let cycle = cycle(&pair, ContactLaw::Linear, false);
    let points = tried();
    let built = || points.iter().map(|point| design(point, &pair).expect("the box has none that is refused"));
    let designs: Vec<Design> = built().collect();
    let error = |design: &Design| cycle.loaded(design, 100.0).peak_to_peak();
    // In turns, since a machine that others share changes its pace within seconds.
    let mut taken = [f64::INFINITY; 4];
    for _ in 0..ROUNDS {
        let once: [&dyn Fn(); 4] = [
            &|| drop(black_box(pools[0].install(|| stages.run("optimum")))),
            &|| drop(black_box(pools[1].install(|| stages.run("optimum")))),
            &|| _ = black_box(designs.iter().map(error).sum::<f64>()),
            &|| built().for_each(|design| drop(black_box(design))),
        ];
        for (taken, once) in taken.iter_mut().zip(once) {
            let began = Instant::now();
            once();
            *taken = taken.min(began.elapsed().as_secs_f64());
        }
    }
    let [one, two, lean, building] = taken.map(|seconds| seconds * 1e6 / f64::from(TRIED));
    let rest = one - lean;
    // Nothing is compared with something else: both find the same design.
    let best = designs.iter().map(error).fold(f64::INFINITY, f64::min);
    let found = stages.run("optimum")[0].floats("objective")[0] * 1e-6;
    assert!((found / best - 1.0).abs() < 1e-9, "the stage found {found} m, the kernel {best} m");
    println!("\nStage optimizer over {TRIED} Sobol points, crowned and relieved, one torque, 64 positions\n");
    println!("{:<46} {:>9}", "µs a design", "");
    println!("{:<46} {one:>9.1}", "the stage, one thread");
    println!("{:<46} {:>9.1}", "the stage, two threads, of both", 2.0 * two);
    println!("{:<46} {lean:>9.1}", "peak-to-peak of the same designs, called alone");
    println!("{:<46} {building:>9.1}", "building them, with a look at their teeth");
    println!("{:<46} {rest:>9.1}", "the rest, one thread");
    for (name, ratio, target) in
        [("one thread / alone", one / lean, MOST_REST), ("two threads / one", 2.0 * two / one, MOST_SHARED)]
    {
        let verdict = if ratio <= target { "met" } else { "MISSED" };
        println!("{name} {ratio:.2}, target {target} at most: {verdict}");
    }
}

/// The points of the stage.
fn tried() -> Vec<Vec<f64>> {
    let bounds = Bounds::new(vec![(0.0, 30e-6), (0.5e-3, 5e-3), (2e-6, 10e-6)]).expect("the bounds are ascending");
    let method = Sobol { points: TRIED as usize };
    let mut search = optimize::search(&method, bounds, Seed::of_stage(0, "optimum")).expect("three variables");
    let mut tried = Vec::new();
    let ended = search.run(|points| -> Result<Vec<f64>, Failure> {
        tried.extend_from_slice(points);
        Ok(vec![0.0; points.len()])
    });
    ended.expect("it cannot fail");
    tried
}

fn design(point: &[f64], pair: &GearPair) -> Result<Design, Diagnostic> {
    let (amount, start) = (Amount::Depth(point[0]), Start::Length(point[1]));
    let relief = TipRelief { amount, start, counted_from: FromTip::Tip, curve: Curve::Linear };
    let mut design = Design::default();
    design.add(Gears::Both, &relief, pair)?;
    design.add(Gears::Pinion, &LeadCrowning { amount: point[2] }, pair)?;
    Ok(design)
}
