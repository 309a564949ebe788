//! The curve of the transmission error of a relieved pair. Run it with `cargo run -p gearmesh --example ex01`.

use gearmesh::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gear = |teeth, bore| Specification::spur(teeth, mm(3.0)).face_width(mm(20.0)).bore_radius(mm(bore));
    let pair = GearPair::new(gear(24, 18.0), gear(36, 28.0), None)?;
    let mesh = Mesh::by(&pair, &Energy::default())?;
    let design = Design::of(Gears::Both, &TipRelief::linear(um(14.0), Start::Fraction(0.8)), &pair)?;
    for point in mesh.loaded(&design, 150.0).curve(Wanted::default()) {
        println!("{:.4} mm: {:.3} um", point.cycle_position * 1e3, point.transmission_error * 1e6);
    }
    Ok(())
}
