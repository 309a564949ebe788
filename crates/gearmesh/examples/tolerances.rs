//! What tolerances leave of a relief: amounts and a helix slope that scatter evenly, and how many pairs stay below a limit.
//!
//! The same as `examples/tolerances.ipynb` does from Python. Run it with `cargo run --release -p gearmesh --example tolerances`.

use gearmesh::prelude::*;

const SAMPLES: u32 = 1000;
const LIMIT: f64 = 0.9e-6;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gear = |teeth: u32, bore_radius: f64| {
        Specification::spur(teeth, mm(3.0)).face_width(mm(20.0)).bore_radius(bore_radius)
    };
    let pair = GearPair::new(gear(24, 18e-3), gear(36, 28e-3), None)?;
    let compliance = Energy::default().tabulate(&pair, Assumptions::default())?.compliance;
    let mesh = Mesh::new(&pair, &compliance, Settings::default())?;
    let mut errors = Vec::new();
    for sample in 0..SAMPLES {
        // Points of Kronecker's lattice: as even as random ones are not, and the same in any language.
        let share = |root: f64| (f64::from(sample) * root).fract();
        let amount = 14e-6 + 4e-6 * (share(std::f64::consts::SQRT_2) - 0.5);
        let slope = 16e-6 * (share(3_f64.sqrt()) - 0.5);
        let mut design = Design::of(Gears::Both, &TipRelief::linear(amount, Start::Fraction(0.8)), &pair)?;
        design.add(Gears::Pinion, &HelixSlope { amount: slope }, &pair)?;
        errors.push(mesh.loaded(&design, 150.0).peak_to_peak());
    }
    let below = errors.iter().filter(|error| **error <= LIMIT).count();
    errors.sort_by(f64::total_cmp);
    let mean = errors.iter().sum::<f64>() / f64::from(SAMPLES);
    println!("mean {:.4} um, median {:.4} um, largest {:.4} um", mean * 1e6, errors[500] * 1e6, errors[999] * 1e6);
    println!("yield {:.1} %", 100.0 * below as f64 / f64::from(SAMPLES));
    Ok(())
}
