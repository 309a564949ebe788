//! What elements, sectors and wheels must hold whatever the gear; anchors by unrelated codes; extremes.

mod convergence;
mod elements;
mod extremes;
mod inclined;
mod orders;
mod point_load;
mod root_stress;
mod whole_gear;
mod wide_contact;

use super::MeshError;
use super::gear_model::GearModel;
use super::mesh::Sizing;
use crate::gear::geometry::root::{Root, RootShape};
use crate::gear::geometry::{Gear, Rack, Specification};
use crate::gear::material::Material;
use crate::gear::material::Plane;

const STEEL: Material = Material::STEEL;

/// 1.0/1.25/0.38, 20°, module and width 1 m: compliances per width times E are the dimensionless ones.
fn shifted(teeth: u32, profile_shift: f64, bore_ratio: f64) -> Specification {
    Specification {
        teeth,
        module: 1.0,
        pressure_angle: 20f64.to_radians(),
        profile_shift,
        thickness_allowance: 0.0,
        cutter: None,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A },
        tip_radius: None,
        face_width: 1.0,
        bore_radius: (0.5 * f64::from(teeth) - 1.25 + profile_shift) / bore_ratio * (1.0 + 1e-12),
        material: STEEL,
    }
}

fn standard(teeth: u32, bore_ratio: f64) -> Specification {
    shifted(teeth, 0.0, bore_ratio)
}

fn gear(specification: &Specification, shape: RootShape) -> (Gear, Root) {
    let gear = Gear::new(specification).unwrap();
    let root = gear.root(shape).unwrap();
    (gear, root)
}

fn model<'a>(gear: &'a Gear, root: &Root, across: usize) -> Result<GearModel<'a>, MeshError> {
    GearModel::new(gear, root, Plane::Strain, &Sizing::even(across))
}
