//! The finite elements against CalculiX (Dhondt and Wittig), a program of other authors that gets our meshes as decks.
//!
//! What ours takes from one sector, Fourier series and tables of influences, it takes from whole gears in one piece, and
//! contact from pressing flank on flank.

mod across_face;
mod contact;
mod flanks;
mod press;
mod program;
mod recorded;
mod reference;
mod root_stress;
mod tooth;
mod wheel;
mod wide;

use gearmesh::gear::finite_elements::gear_model::GearModel;
use gearmesh::gear::finite_elements::mesh::Sizing;
use gearmesh::gear::finite_elements::sector::NodalForces;
use gearmesh::gear::finite_elements::wheel::Wheel as Ring;
use gearmesh::gear::geometry::root::RootShape;
use gearmesh::gear::geometry::{Gear, Rack, Specification};
use gearmesh::gear::material::Material;
use gearmesh::gear::material::Plane;

/// The standard rack, and the bore of the anchors, r_f/1.4.
fn specification(teeth: u32, profile_shift: f64, module: f64, youngs_modulus: f64) -> Specification {
    Specification {
        teeth,
        module,
        pressure_angle: 20_f64.to_radians(),
        profile_shift,
        thickness_allowance: 0.0,
        cutter: None,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A },
        tip_radius: None,
        face_width: module,
        bore_radius: (0.5 * f64::from(teeth) - 1.25 + profile_shift) * module / 1.4,
        material: Material { youngs_modulus, poisson_ratio: 0.3, ..Material::STEEL },
    }
}

fn model<'a>(gear: &'a Gear, plane: Plane, sizing: &Sizing) -> GearModel<'a> {
    GearModel::new(gear, &gear.root(RootShape::Trochoid).unwrap(), plane, sizing).unwrap()
}

/// Σ force · displacement.
fn work(forces: &NodalForces, displacement: impl Fn(usize) -> [f64; 2]) -> f64 {
    let each = |&(node, [x, y]): &(usize, [f64; 2])| {
        let [u, v] = displacement(node);
        x * u + y * v
    };
    forces.iter().map(each).sum()
}

/// Our displacements of the loaded tooth's nodes, in modules under a load in units of E m.
fn displacements(model: &GearModel, teeth: u32, load: NodalForces) -> Vec<[f64; 2]> {
    let response = model.sector.responses(&[load]).remove(0);
    let ring = Ring { sectors: teeth, stiffness: &model.sector.stiffness() };
    let edges = ring.displacements(&[&response.pressed]).unwrap().remove(0);
    model.sector.displacements(&response, &edges)
}
