//! Lengths against another program, closed forms, scales, and how many sections they take.

use super::*;
use crate::gear::compliance::weber_banaschek::{Body, WeberBanaschek};
use crate::gear::compliance::{Assumptions, ContactLaw, Method};
use crate::gear::geometry::{GearPair, Rack, Specification};
use crate::gear::material::Material;

const PLAIN: Assumptions =
    Assumptions { root: RootShape::Trochoid, contact: ContactLaw::Linear, coupled: true, torque: None, accuracy: None };

fn gear(teeth: u32, module: f64, ratio: f64) -> Gear {
    Gear::new(&Specification {
        teeth,
        module,
        pressure_angle: 20_f64.to_radians(),
        profile_shift: 0.0,
        thickness_allowance: 0.0,
        cutter: None,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A },
        tip_radius: None,
        face_width: 8.0 * module,
        bore_radius: (0.5 * f64::from(teeth) - 1.25) * module / ratio,
        material: Material { youngs_modulus: 1.0, poisson_ratio: 0.3, ..Material::STEEL },
    })
    .unwrap()
}

/// Tier: second method. Finite elements of whole gears with displacements (u cos κz, v cos κz, w sin κz), three freedoms
/// at a node, in another program on our meshes: ℓ of the layer that has the compliance at the wave number κ = 1/m once
/// wind-up is taken off, E = 1, m = 1; and the compliance at κ = 0 per width.
#[test]
fn lengths_are_near_those_of_waves_along_the_face() {
    for (teeth, ratio, values) in [
        (17, 1.4, [[0.10, 4.9822, 1.58], [0.50, 7.2308, 1.61], [0.90, 10.9272, 1.51]]),
        (19, 1.75, [[0.10, 5.5843, 1.67], [0.50, 7.8777, 1.68], [0.90, 11.6194, 1.55]]),
        (30, 2.0, [[0.10, 5.6670, 1.73], [0.50, 7.9313, 1.69], [0.90, 11.6161, 1.54]]),
        (48, 1.4, [[0.10, 4.7109, 1.66], [0.50, 6.9388, 1.63], [0.90, 10.5953, 1.48]]),
        (48, 4.0, [[0.10, 8.4494, 1.87], [0.50, 10.7074, 1.77], [0.90, 14.3983, 1.57]]),
    ] {
        let gear = gear(teeth, 1.0, ratio);
        let shape = SectionedTooth::new(&gear, 8.0);
        let (wind_up, _) = ring(&gear);
        for [height, compliance, waves] in values {
            let reach = shape.reach(gear.roll_at(0.5 * f64::from(teeth) + height));
            let length = (reach / (compliance - wind_up)).sqrt();
            let bound = if ratio > 3.0 { 0.22 } else { 0.16 };
            assert!((length / waves - 1.0).abs() < bound, "{teeth} {ratio} {height}: {length} for {waves}");
        }
    }
}

/// Tier: closed form. The wind-up is that of the plane table, and its layer is the torsion of a shaft held at its bore.
#[test]
fn the_wind_up_is_that_of_the_plane_and_reaches_as_a_held_shaft() {
    let gear = gear(48, 2e-3, 4.0);
    let body = Body::new(&gear, &gear.root(RootShape::Trochoid).unwrap());
    let (compliance, length) = ring(&gear);
    assert!((compliance / gear.specification.face_width / body.wind_up - 1.0).abs() < 1e-12);
    // Energy over compliance by sums over rings, of which the outer ones are half full.
    let (bore, root, tip) = (gear.specification.bore_radius, gear.root_radius, gear.tip_radius);
    let modulus = shear_modulus(&gear);
    let rotation = |r: f64| gear.base_radius / (4.0 * PI * modulus) * (1.0 / (bore * bore) - 1.0 / (r * r));
    let count = 20_000;
    let mut energy = 0.0;
    for index in 0..count {
        let share = (f64::from(index) + 0.5) / f64::from(count);
        let (r, step) = (bore + (root - bore) * share, (root - bore) / f64::from(count));
        energy += 2.0 * PI * r * step * (rotation(r) * r).powi(2);
        let (r, step) = (root + (tip - root) * share, (tip - root) / f64::from(count));
        energy += PI * r * step * (rotation(root) * r).powi(2);
    }
    assert!((length / (modulus * energy / compliance).sqrt() - 1.0).abs() < 1e-7);
}

/// Lengths belong to the shape: they grow with the module and not with E.
#[test]
fn lengths_scale_with_the_module() {
    let (small, large) = (gear(30, 1.0, 2.0), gear(30, 5.0, 2.0));
    for roll in [0.2, 0.35, 0.5] {
        let ratio = SectionedTooth::new(&large, 40.0).reach(roll) / SectionedTooth::new(&small, 8.0).reach(roll);
        assert!((ratio / 25.0 - 1.0).abs() < 1e-12);
    }
    assert!((ring(&large).1 / ring(&small).1 / 5.0 - 1.0).abs() < 1e-12);
}

/// Twice as many sections change lengths by less than a part in a thousand.
#[test]
fn sections_suffice() {
    let gear = gear(19, 1.0, 1.75);
    let shape = SectionedTooth::new(&gear, 8.0);
    let halved =
        |[height, extent, _]: [f64; 3]| [height - 0.25 * extent, height + 0.25 * extent].map(|y| [y, 0.5 * extent]);
    // Thickness is piecewise linear to second order, so halved sections interpolate it.
    let rows = &shape.sections;
    let thickness = |y: f64| {
        let next = rows.partition_point(|row| row[0] < y).clamp(1, rows.len() - 1);
        let ([a, _, s], [b, _, t]) = (rows[next - 1], rows[next]);
        s + (t - s) * (y - a) / (b - a)
    };
    let sections = rows.iter().flat_map(|&row| halved(row)).map(|[y, extent]| [y, extent, thickness(y)]).collect();
    let fine = SectionedTooth { gear: &gear, sections, clamped: shape.clamped, moved: shape.moved };
    for roll in [0.1, 0.3, 0.5] {
        assert!((fine.reach(roll) / shape.reach(roll) - 1.0).abs() < 2e-3, "{}", fine.reach(roll) / shape.reach(roll));
    }
}

/// Tier: closed form. A tooth as thick everywhere bends and shears as a beam: the rotations are polynomials of the height,
/// and so is what their squares sum up to. How far the root gives way comes from Weber's compliance of a clamped tooth, a
/// square in the arm of the load: by Castigliano its slope is twice the tilt, and what is left of it the shift.
#[test]
fn a_tooth_of_even_thickness_twists_as_a_beam() {
    let gear = gear(19, 1.0, 1.75);
    let (height, chord, thickness, moved) = (8.0, 2.2, 1.7, 0.7);
    // At this roll angle the load is across the tooth.
    let upright = gear.half_base_angle;
    assert!(gear.load_angle(upright).abs() < 1e-15);
    let clamp = |arm: f64| {
        let body = Body { height: gear.base_radius - arm * chord, chord, wind_up: 0.0 };
        body.compliance(&gear, upright) * gear.specification.face_width
    };
    let count = 20_000;
    let extent = 3.0 / f64::from(count);
    let sections =
        (0..count).map(|index| [height + extent * (f64::from(index) + 0.5), extent, thickness]).collect::<Vec<_>>();
    let clamped = Body { height, chord, wind_up: 0.0 };
    let tooth = SectionedTooth { gear: &gear, sections, clamped, moved };
    let (nu, modulus) = (0.3, 1.0 / 2.6);
    for roll in [0.3, 0.5] {
        let cosine = gear.load_angle(roll).cos();
        let length = gear.base_radius / cosine - height;
        assert!(length > 0.5 && length < 3.0, "{length}");
        let arm = length / chord;
        let slope = 0.25 * (clamp(arm + 1.0) - clamp(arm - 1.0));
        let (tilt, shift) = (cosine * slope / chord, cosine * (clamp(arm) - slope * arm));
        let bending = 12.0 * (1.0 - nu * nu) * cosine / thickness.powi(3);
        // Under the load, ω = tilt + γ/2 + k (L s − s²/2); above it what the beam has turned to.
        let first = tilt + 0.5 * 1.2 * cosine / (modulus * thickness);
        let below = first * first * length
            + 2.0 / 3.0 * first * bending * length.powi(3)
            + 2.0 / 15.0 * bending * bending * length.powi(5);
        let above = (tilt + 0.5 * bending * length * length).powi(2) * (3.0 - length);
        let exact = modulus * (thickness.powi(3) / 3.0 * (below + above) + moved * shift * shift);
        let found = tooth.reach(roll);
        assert!((found / exact - 1.0).abs() < 1e-6, "{roll}: {found} for {exact}");
    }
}

/// The body moves down to the bore, and no deeper than the face is wide; the wind-up is that of the plane table.
#[test]
fn the_body_moves_to_the_bore_or_as_deep_as_the_face_is_wide() {
    let specification = |teeth| gear(teeth, 2e-3, 3.0).specification;
    let pair = GearPair::new(specification(19), specification(48), None).unwrap();
    let tables = WeberBanaschek {}.tabulate(&pair, PLAIN).unwrap().compliance;
    for (gear, table) in [(&pair.pinion, &tables.pinion), (&pair.gear, &tables.gear)] {
        let body = Body::new(gear, &gear.root(RootShape::Trochoid).unwrap());
        let deep = gear.root_radius - gear.specification.bore_radius;
        for (face_width, depth) in [(100.0, deep), (deep, deep), (1e-3, 1e-3)] {
            let tooth = SectionedTooth::new(gear, face_width);
            assert!((tooth.moved / (body.chord * depth / 3.0) - 1.0).abs() < 1e-14, "{face_width}: {}", tooth.moved);
        }
        let layers = Layers::new(gear, table, gear.specification.face_width);
        assert!((layers.wind_up / body.wind_up - 1.0).abs() < 1e-12, "{}", layers.wind_up);
        let stiff = table.body.value(gear.tip_roll());
        let most = Layers::new(gear, table, 1e-3 * gear.specification.face_width).wind_up;
        assert!(most > 0.0 && most <= stiff, "no more than the body has: {most} of {stiff}");
    }
}
