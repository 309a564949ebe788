//! Peak-to-peak over torque of the designs of the article `energy_ga` (its Figure 4): unmodified, by formula, by search.
//!
//! The same as `examples/figure_4.ipynb` draws from Python; `studies/energy_ga.yaml` has the verdicts. Run it with
//! `cargo run --release -p gearmesh --example figure_4`.

use gearmesh::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gear = |teeth: u32, face_width: f64, bore_radius: f64| Specification {
        teeth,
        module: 3e-3,
        pressure_angle: 20_f64.to_radians(),
        profile_shift: 0.0,
        thickness_allowance: 0.0,
        cutter: None,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A },
        tip_radius: None,
        face_width,
        bore_radius,
        material: Material::STEEL,
    };
    // Table 1; the bores are those that the study fits.
    let pair = GearPair::new(gear(19, 20e-3, 14.079e-3), gear(48, 18e-3, 38.823e-3), None)?;
    let assumptions = Assumptions { root: RootShape::CircularFillet, coupled: false, ..Assumptions::default() };
    let compliance = Energy::default().tabulate(&pair, assumptions)?.compliance;
    let cycle = MeshCycle::new(&pair, &compliance, Settings::default())?;
    // Table 2, the length counted from the tip.
    let design = |amount: f64, length: f64, crowning: f64| -> Result<Design, Diagnostic> {
        let (amount, start) = (Amount::Depth(amount), Start::Length(length));
        let relief = TipRelief { amount, start, counted_from: FromTip::Tip, curve: Curve::Parabolic };
        let mut design = Design::default();
        design.add(Gears::Both, &relief, &pair)?;
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
        let each = designs.iter().map(|(_, design)| LoadCase::new(&cycle, design, torque).peak_to_peak() * 1e6);
        let each: Vec<String> = each.map(|value| format!("{value:.4}")).collect();
        println!("{torque} {}", each.join(" "));
    }
    Ok(())
}
