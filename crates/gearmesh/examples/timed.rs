//! Seconds of the calls that `python/bench` makes from Python too, as JSON: a curve at 64 positions, and 10,000 designs.
//!
//! Run it with `cargo run --release -p gearmesh --example timed`.

use std::hint::black_box;
use std::time::Instant;

use gearmesh::prelude::*;

/// The least of several rounds, since other work on a machine only adds.
fn least(rounds: usize, calls: u32, mut call: impl FnMut()) -> f64 {
    let round = |_| {
        let began = Instant::now();
        (0..calls).for_each(|_| call());
        began.elapsed().as_secs_f64() / f64::from(calls)
    };
    (0..rounds).map(round).fold(f64::INFINITY, f64::min)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gear = |teeth: u32, bore_radius: f64| {
        Specification::spur(teeth, mm(3.0)).face_width(mm(20.0)).bore_radius(bore_radius)
    };
    let pair = GearPair::new(gear(24, 18e-3), gear(36, 28e-3), None)?;
    let assumptions = Assumptions { coupled: false, ..Assumptions::default() };
    let compliance = Energy::default().tabulate(&pair, assumptions)?.compliance;
    let mesh = Mesh::new(&pair, &compliance, Settings::default())?;
    let design = |amount: f64| -> Result<Design, Diagnostic> {
        Design::of(Gears::Both, &TipRelief::linear(amount, Start::Fraction(0.8)), &pair)
    };
    let wanted = Wanted { harmonics: 8, ..Wanted::default() };
    let curve = least(20, 200, || {
        let design = design(14e-6);
        if let Ok(design) = &design {
            black_box(mesh.loaded(design, 150.0).curve_and_summary(wanted));
        }
    });
    let many = least(5, 1, || {
        for index in 0..10_000 {
            if let Ok(design) = design(30e-6 * f64::from(index) / 10_000.0) {
                black_box(mesh.loaded(&design, 150.0).peak_to_peak());
            }
        }
    });
    let from_gears = least(5, 5, || {
        if let Ok(tabulated) = Energy::default().tabulate(&pair, assumptions)
            && let Ok(mesh) = Mesh::new(&pair, &tabulated.compliance, Settings::default())
        {
            black_box(mesh.loaded(&Design::default(), 150.0).curve(Wanted::default()));
        }
    });
    println!("{{\"curve\": {curve}, \"designs\": {many}, \"from_gears\": {from_gears}}}");
    Ok(())
}
