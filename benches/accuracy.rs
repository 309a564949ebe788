//! Error against run time: positions of the mesh cycle, nodes of the compliance tables, slices of the face.

use std::hint::black_box;
use std::time::Instant;

use crate::article::{Stages, TORQUE, cycle};
use gearmesh::gear::compliance::ContactLaw::{Linear, LoadDependent};
use gearmesh::gear::compliance::energy::Beam;
use gearmesh::gear::compliance::sainsot::Body;
use gearmesh::gear::geometry::root::RootShape;
use gearmesh::gear::geometry::{GearPair, Side};
use gearmesh::gear::mesh::answers::curve::Wanted;
use gearmesh::gear::mesh::{Loaded, Mesh, Settings};
use gearmesh::gear::modification::Design;
use gearmesh::numeric::chebyshev::Series;

pub fn print() {
    let mut stages = Stages::new();
    let pair = stages.pair();
    let design = stages.design("ga");
    let cycle_of = |contact| cycle(&pair, contact, false);
    positions(&cycle_of(Linear), &design);
    nodes(&pair);
    slices(&cycle_of(LoadDependent), &design);
    growth(&cycle_of(Linear), &design);
}

/// Seconds that `once` takes: the best of several rounds of 2 ms, because whatever else the machine does only adds.
pub fn seconds<T>(mut once: impl FnMut() -> T) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..9 {
        let (began, mut count) = (Instant::now(), 0_u32);
        while count == 0 || began.elapsed().as_secs_f64() < 2e-3 {
            black_box(once());
            count += 1;
        }
        best = best.min(began.elapsed().as_secs_f64() / f64::from(count));
    }
    best
}

pub fn relative(value: f64, reference: f64) -> f64 {
    (value / reference - 1.0).abs()
}

/// The positions that were asked for, against as many equal steps that know nothing of zones, reliefs or first touches.
fn positions(cycle: &Mesh, design: &Design) {
    let sampled = |positions| cycle.sampled(Settings { positions, ..cycle.settings });
    let converged = sampled(4096);
    let reference = converged.loaded(design, TORQUE).summary(Wanted::default());
    println!(
        "\nPositions: relative error of peak-to-peak and variance, and time per curve (4096 positions: no error)\n"
    );
    println!(
        "{:>9} | {:>12} {:>12} {:>7} {:>10} {:>10} {:>10} | {:>12} {:>12} {:>10}",
        "positions",
        "peak-to-peak",
        "variance",
        "points",
        "lean µs",
        "curve µs",
        "summary µs",
        "equal steps:",
        "variance",
        "µs"
    );
    for positions in [8, 16, 32, 64, 128, 256, 512] {
        let cycle = sampled(positions);
        let loading = || cycle.loaded(design, TORQUE);
        let (points, summary) = loading().curve_and_summary(Wanted::default());
        let lean = seconds(|| loading().peak_to_peak());
        let curve = seconds(|| loading().curve(Wanted::default()));
        let whole = seconds(|| loading().summary(Wanted::default()));
        let (peak_to_peak, variance) = equal_steps(&loading(), positions);
        let plain = seconds(|| equal_steps(&loading(), positions));
        println!(
            "{positions:>9} | {:>12.1e} {:>12.1e} {:>7} {:>10.1} {:>10.1} {:>10.1} | {:>12.1e} {:>12.1e} {:>10.1}",
            relative(summary.peak_to_peak, reference.peak_to_peak),
            relative(summary.variance, reference.variance),
            points.len(),
            lean * 1e6,
            curve * 1e6,
            whole * 1e6,
            relative(peak_to_peak, reference.peak_to_peak),
            relative(variance, reference.variance),
            plain * 1e6,
        );
    }
}

/// Peak-to-peak and variance from positions in equal steps.
fn equal_steps(loading: &Loaded, positions: usize) -> (f64, f64) {
    let cycle = loading.mesh();
    let (mut largest, mut smallest) = (f64::NEG_INFINITY, f64::INFINITY);
    let (mut sum, mut squares) = (0.0, 0.0);
    for index in 0..positions {
        let position = cycle.period() * index as f64 / positions as f64;
        let zone = cycle.zones.iter().find(|zone| position < zone.end).expect("the zones cover the cycle");
        let value = loading.state(position, zone.pairs).transmission_error();
        (largest, smallest) = (largest.max(value), smallest.min(value));
        sum += value;
        squares += value * value;
    }
    let (mean, count) = (sum / positions as f64, positions as f64);
    (largest - smallest, squares / count - mean * mean)
}

/// Chebyshev nodes over the flank, against the energy method itself between them.
fn nodes(pair: &GearPair) {
    println!(
        "\nCompliance tables: largest relative error over both flanks, and time for the pair, by Chebyshev nodes\n"
    );
    println!("{:>9} | {:>12} {:>12}", "nodes", "error", "µs");
    let roots = [Side::Pinion, Side::Gear].map(|side| {
        let gear = pair.side(side);
        (gear, gear.root(RootShape::CircularFillet).expect("the study runs with it"))
    });
    for nodes in [8, 16, 24, 32, 40, 48, 56] {
        let mut error = 0.0_f64;
        let mut tables = |probes: i32| {
            for (gear, root) in &roots {
                let beam = Beam::new(gear, root, 1.2).expect("its teeth are not pointed");
                let body = Body::new(root.half_angle, gear.root_radius / gear.specification.bore_radius);
                let total = |roll: f64| {
                    let parts = beam.parts(roll);
                    parts.bending + parts.shear + parts.axial + body.compliance(gear, roll)
                };
                let (lower, upper) = (root.form_roll, gear.tip_roll());
                let series = black_box(Series::fit(lower, upper, nodes, total));
                for probe in 0..probes {
                    let roll = lower + (upper - lower) * f64::from(probe) / f64::from(probes - 1);
                    error = error.max(relative(series.value(roll), total(roll)));
                }
            }
        };
        tables(998);
        let time = seconds(|| tables(0)) * 1e6;
        println!("{nodes:>9} | {error:>12.1e} {time:>12.1}");
    }
}

/// Slices under the load-dependent contact law, which has no closed form across a crowned face.
fn slices(cycle: &Mesh, design: &Design) {
    println!(
        "\nSlices: relative error of the peak-to-peak under load-dependent contact, and time (1025 slices: no error)\n"
    );
    println!("{:>9} | {:>12} {:>12}", "slices", "peak-to-peak", "lean µs");
    let sampled = |slices| cycle.sampled(Settings { slices, ..cycle.settings });
    let reference = sampled(1025).loaded(design, TORQUE).peak_to_peak();
    for slices in [3, 5, 9, 17, 33, 65, 129] {
        let cycle = sampled(slices);
        let found = || cycle.loaded(design, TORQUE).peak_to_peak();
        println!("{slices:>9} | {:>12.1e} {:>12.1}", relative(found(), reference), seconds(found) * 1e6);
    }
}

/// Torques, and with them designs, on one thread: every curve for itself, whatever is kept between them.
fn growth(cycle: &Mesh, design: &Design) {
    println!("\nGrowth: torques from 25 to 100 N m, curve, summary and 8 harmonics each, one thread\n");
    println!("{:>9} | {:>12} {:>12}", "torques", "ms", "µs each");
    let wanted = Wanted { harmonics: 8, pressure: false, ..Wanted::default() };
    for torques in [1, 4, 16, 64, 256] {
        let time = seconds(|| {
            for index in 0..torques {
                let torque = 25.0 + 75.0 * f64::from(index) / f64::from(torques);
                black_box(cycle.loaded(design, torque).curve_and_summary(wanted));
            }
        });
        println!("{torques:>9} | {:>12.3} {:>12.1}", time * 1e3, time * 1e6 / f64::from(torques));
    }
}
