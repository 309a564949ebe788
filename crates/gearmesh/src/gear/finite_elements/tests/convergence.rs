//! Anchors, observed order, and the split into tooth and contact against a resolved Hertzian pressure.

use super::super::mesh::{Focus, Sizing};
use super::super::{gear_model::GearModel, root_stress};
use super::{gear, model, shifted, standard};
use crate::gear::geometry::root::RootShape;
use crate::gear::material::Plane;
use crate::numeric::chebyshev::nodes;

/// Tier: second method; two unrelated codes, within 0.1 % of each other. Compliances \[µm mm/N\] are given to four digits.
#[test]
fn anchors_of_two_other_codes() {
    for (teeth, radii, anchors) in
        [(17, [8.0023, 8.5], [0.016_26, 0.022_26]), (43, [21.5, 22.4434], [0.020_85, 0.054_11])]
    {
        let (gear, root) = gear(&standard(teeth, 1.4), RootShape::Trochoid);
        let found = model(&gear, &root, 16).unwrap().influences(&radii.map(|r| gear.roll_at(r)), 0).unwrap();
        for (value, anchor) in found.own.into_iter().zip(anchors) {
            let compliance = value / 206e9 * 1e9;
            assert!((compliance / anchor - 1.0).abs() < 2e-3, "z {teeth}: {compliance} for {anchor}");
        }
    }
}

/// Tier: order of convergence; the tooth's compliance with the third order or better, over the whole flank.
#[test]
fn compliances_and_stresses_converge() {
    for specification in [standard(17, 1.4), standard(48, 2.5), shifted(30, 1.0, 1.4)] {
        let (gear, root) = gear(&specification, RootShape::Trochoid);
        let rolls = nodes(root.form_roll, gear.tip_roll(), 7);
        let at = |across: usize| {
            let model = model(&gear, &root, across).unwrap();
            let stress: Vec<f64> =
                model.root_stresses(&rolls[2..]).unwrap().iter().map(|s| root_stress::largest(s).unwrap().0).collect();
            (model.influences(&rolls, 0).unwrap().own, stress)
        };
        let fine = at(20);
        let error = |across: usize| {
            let found = at(across);
            let largest = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
            [largest(&found.0, &fine.0), largest(&found.1, &fine.1)]
        };
        let (coarse, middle) = (error(6), error(12));
        let order = [0, 1].map(|k| (coarse[k] / middle[k]).log2());
        assert!(order[0] > 2.2 && order[1] > 1.5, "z {}: {order:?}", specification.teeth);
    }
}

/// Tier: second method; a Hertzian pressure on a mesh that resolves it. What it moves the contact point by, less tooth
/// and Weber's law, does not depend on the width of the contact: the split leaves nothing of the flattening in the tooth
/// and counts nothing twice. What remains is the tooth not being the half plane of the law; it is below 3 %. Resolved contact has no
/// such remainder: a tooth's displacement less that of a half plane is that of a point load.
#[test]
fn tooth_and_contact_law_add_up_to_a_resolved_contact() {
    for radius in [8.25, 8.5] {
        let remainders = [0.04, 0.02, 0.01].map(|half_width| remainder(radius, half_width));
        for [rest, full, resolved] in remainders {
            assert!((rest - remainders[2][0]).abs() < 2e-3 * full, "{remainders:?}");
            assert!(rest.abs() < 0.03 * full, "{remainders:?}");
            assert!((resolved / full - 1.0).abs() < 1e-4, "{remainders:?}");
        }
    }
}

/// Displacement of the contact point under a Hertzian pressure: less tooth and law, as a whole, and by a point load.
fn remainder(radius: f64, half_width: f64) -> [f64; 3] {
    let (gear, root) = gear(&standard(17, 1.4), RootShape::Trochoid);
    let roll = gear.roll_at(radius);
    let centre = gear.flank(roll);
    let depth = centre.half_thickness / gear.load_angle(roll).cos();
    // Four elements on half the contact, growing by a quarter towards the middle.
    let mut corners = vec![0.0];
    let mut size = 0.25 * half_width / (2.0 * centre.half_thickness);
    while corners[corners.len() - 1] + 1.5 * size < 0.5 {
        corners.push(corners[corners.len() - 1] + size);
        size = (1.25 * size).min(1.0 / 16.0);
    }
    corners.push(0.5);
    let mirrored: Vec<f64> = corners.iter().rev().skip(1).map(|at| 1.0 - at).collect();
    corners.extend(mirrored);
    let mut across: Vec<f64> = corners.windows(2).flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1])]).collect();
    across.push(1.0);
    let focus = Focus { height: centre.height, size: 0.25 * half_width, growth: 0.3 };
    let sizing = Sizing { across, focus: Some(focus), ..Sizing::even(16) };
    let model = GearModel::new(&gear, &root, Plane::Strain, &sizing).unwrap();
    // p = 2/(π b) √(1 − (x/b)²) as point loads at x = b sin φ; the flank's length is r_b u²/2.
    let points = 400;
    let direction = model.direction(roll);
    let mut pressure = Vec::new();
    for k in 0..points {
        let angle = std::f64::consts::PI * ((f64::from(k) + 0.5) / f64::from(points) - 0.5);
        let share = 2.0 / f64::from(points) * angle.cos() * angle.cos();
        let at = (roll * roll + 2.0 * half_width * angle.sin() / gear.base_radius).sqrt();
        let own = model.direction(at);
        for (node, force) in model.load(at) {
            let size = force[0] * own[0] + force[1] * own[1];
            pressure.push((node, direction.map(|part| part * size * share)));
        }
    }
    let total: f64 = pressure.iter().map(|(_, force)| force[0] * direction[0] + force[1] * direction[1]).sum();
    assert!((total - 1.0).abs() < 1e-12, "{total}");
    let full = model.work_of(&model.load(roll), &pressure).unwrap();
    let tooth = model.influences(&[roll], 0).unwrap().own[0];
    // What a point load leaves beside the half plane, on a mesh that knows nothing of the contact, and the middle of a
    // Hertzian pressure in a half plane (Johnson, Contact Mechanics, 4.2).
    let rest = super::model(&gear, &root, 24).unwrap().rests(&[roll], 0, 0).unwrap().own[0];
    let resolved = rest + 0.91 / std::f64::consts::PI * (2.0 * (2.0 / half_width).ln() + 1.0);
    let nu = 0.3_f64;
    let logarithm = (2.0 * depth / half_width).ln() - nu / (2.0 * (1.0 - nu));
    [full - tooth - 2.0 * (1.0 - nu * nu) / std::f64::consts::PI * logarithm, full, resolved]
}
