//! Anchors by two unrelated codes.

use std::time::Instant;

use super::element::Plane;
use super::gear_model::GearModel;
use super::mesh::Sizing;
use crate::gear::geometry::root::RootShape;
use crate::gear::geometry::{Gear, Rack, Specification};
use crate::gear::material::Material;

const STEEL: Material = Material { youngs_modulus: 206e9, poisson_ratio: 0.3 };

fn standard(teeth: u32, bore_ratio: f64) -> Specification {
    Specification {
        teeth,
        module: 1.0,
        pressure_angle: 20f64.to_radians(),
        profile_shift: 0.0,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38 },
        tip_radius: None,
        face_width: 1.0,
        bore_radius: (0.5 * f64::from(teeth) - 1.25) / bore_ratio,
        material: STEEL,
    }
}

#[test]
fn anchors() {
    for across in [4, 6, 8, 12, 16, 24, 32] {
        for (teeth, radii, expected) in [(17, [8.0023, 8.5], [0.01626, 0.02226]), (43, [21.5, 22.4434], [0.02085, 0.05411])] {
            let gear = Gear::new(&standard(teeth, 1.4)).unwrap();
            let root = gear.root(RootShape::Trochoid).unwrap();
            let start = Instant::now();
            let model = GearModel::new(&gear, &root, Plane::Strain, &Sizing::even(across)).unwrap();
            let factored = start.elapsed();
            let rolls = radii.map(|radius| gear.roll_at(radius));
            let found = model.influences(&rolls, 1).unwrap();
            let scaled: Vec<f64> = found.own.iter().map(|c| c / 206e9 * 1e9 ).collect();
            println!("{across} z{teeth} elements {} unknowns {} edge {} {:?} {:?} off {:.3}% {:.3}% cross {:?}", model.mesh.elements.len(), model.sector.unknowns(), model.mesh.left.len(), factored, start.elapsed(),
              100.0*(scaled[0]/expected[0]-1.0), 100.0*(scaled[1]/expected[1]-1.0), found.further[0]);
        }
    }
}
