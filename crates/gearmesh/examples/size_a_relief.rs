//! Sizes the tip relief of a pair for a range of torques: the least of the worst peak-to-peak from 80 to 200 N m.
//!
//! The same as `examples/size_a_relief.ipynb` does from Python. Run it with `cargo run --release -p gearmesh --example size_a_relief`.

use gearmesh::prelude::*;

const TORQUES: [f64; 4] = [80.0, 120.0, 160.0, 200.0];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gear = |teeth: u32, bore_radius: f64| {
        Specification::spur(teeth, mm(3.0)).face_width(mm(20.0)).bore_radius(bore_radius)
    };
    let pair = GearPair::new(gear(24, 18e-3), gear(36, 28e-3), None)?;
    let compliance = Energy::default().tabulate(&pair, Assumptions::default())?.compliance;
    let mesh = Mesh::new(&pair, &compliance, Settings::default())?;
    let design = |point: &[f64]| -> Result<Design, Diagnostic> {
        Design::of(Gears::Both, &TipRelief::linear(point[0], Start::Fraction(point[1])), &pair)
    };
    let worst = |design: &Design| {
        let each = TORQUES.map(|torque| mesh.loaded(design, torque).peak_to_peak());
        each.into_iter().fold(0.0, f64::max)
    };
    let bounds = Bounds::new(vec![(0.0, 40e-6), (0.2, 1.0)])?;
    let mut search = optimizer(&DifferentialEvolution::default(), bounds, Seed::of_stage(1, "differential_evolution"))?;
    // A relief that does not fit is worth nothing.
    let evaluate = |points: &[Vec<f64>]| -> Result<Vec<f64>, Failure> {
        Ok(points.iter().map(|point| design(point).map_or(f64::INFINITY, |design| worst(&design))).collect())
    };
    search.run(evaluate)?;
    let best = search.best().ok_or("nothing fits")?;
    println!("unmodified: {:.4} um", worst(&Design::default()) * 1e6);
    println!("amount {:.3} um, fraction {:.4}: {:.4} um", best.point[0] * 1e6, best.point[1], best.value * 1e6);
    Ok(())
}
