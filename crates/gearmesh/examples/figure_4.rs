//! Peak-to-peak over torque of the designs of the article `energy_ga` (its Figure 4): unmodified, by formula, by search.
//!
//! The same as `examples/figure_4.ipynb` draws from Python; `studies/energy_ga.yaml` has the verdicts. Run it with
//! `cargo run --release -p gearmesh --example figure_4`.

use gearmesh::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gear = |teeth: u32, face_width: f64, bore_radius: f64| Specification {
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A },
        face_width,
        bore_radius,
        ..Specification::spur(teeth, mm(3.0))
    };
    // Table 1; the bores are those that the study fits.
    let pair = GearPair::new(gear(19, 20e-3, 14.079e-3), gear(48, 18e-3, 38.823e-3), None)?;
    let assumptions = Assumptions { root: RootShape::CircularFillet, coupled: false, ..Assumptions::default() };
    let compliance = Energy::default().tabulate(&pair, assumptions)?.compliance;
    let mesh = Mesh::new(&pair, &compliance, Settings::default())?;
    // Table 2, the length counted from the tip.
    let design = |amount: f64, length: f64, crowning: f64| -> Result<Design, Diagnostic> {
        let mut design =
            Design::of(Gears::Both, &TipRelief::new(amount, Start::Length(length), Curve::Parabolic), &pair)?;
        design.add(Gears::Pinion, &LeadCrowning { amount: crowning }, &pair)?;
        Ok(design)
    };
    let designs = [
        ("unmodified", Design::default()),
        ("iso", design(7.81e-6, 5.05e-3, 6.34e-6)?),
        ("ga", design(6.93e-6, 3.41e-3, 5.67e-6)?),
    ];
    println!("torque unmodified iso ga");
    for torque in [25.0, 40.0, 50.0, 60.0, 80.0, 100.0] {
        let each = designs.iter().map(|(_, design)| mesh.loaded(design, torque).peak_to_peak() * 1e6);
        let each: Vec<String> = each.map(|value| format!("{value:.4}")).collect();
        println!("{torque} {}", each.join(" "));
    }
    Ok(())
}
