//! Gears at the ends of what can be built: a right answer or a clear refusal.

use super::super::MeshError;
use super::{gear, model, shifted, standard};
use crate::gear::geometry::root::RootShape;
use crate::gear::geometry::{Gear, Rack, Specification};
use crate::numeric::chebyshev::nodes;

/// Tier: order of convergence; whatever the teeth, the bore and the shift, two meshes agree.
#[test]
fn every_gear_is_meshed_and_two_meshes_agree() {
    let mut cases = Vec::new();
    for bore_ratio in [1.01, 1000.0] {
        for (teeth, shift) in [(8, 0.5), (10, 0.0), (12, 0.8), (30, -0.5), (30, 1.0)] {
            cases.push(shifted(teeth, shift, bore_ratio));
        }
        for teeth in [5, 6] {
            let mut few = shifted(teeth, 0.4, bore_ratio);
            few.tip_radius = Some(0.5 * f64::from(teeth) + 1.0);
            cases.push(few);
        }
    }
    cases.push(standard(200, 1.4));
    for specification in cases {
        let (teeth, bore) = (specification.teeth, specification.bore_radius);
        let (gear, root) = gear(&specification, RootShape::Trochoid);
        let rolls = nodes(root.form_roll, gear.tip_roll(), 6);
        let at = |across: usize| model(&gear, &root, across).unwrap().influences(&rolls, 1).unwrap();
        let (coarse, fine) = (at(8), at(12));
        for (a, b) in coarse.own.iter().zip(&fine.own) {
            assert!((a / b - 1.0).abs() < 0.008, "z {teeth}, bore {bore}: {a} {b}");
        }
    }
}

/// Tier: closed form; with a very small bore nearly all is the body's wind-up, r_b²/(4πG)(1/r_bore² − 1/r²). There the
/// sector's stiffness loses digits; the model's own bound on that is kept.
#[test]
fn a_small_bore_is_wound_up_as_far_as_digits_go() {
    for (teeth, discretisation) in [(17, 4e-4), (200, 4e-4), (1000, 4e-4)] {
        let (gear, root) = gear(&standard(teeth, 999.0), RootShape::Trochoid);
        let rolls = [gear.roll_at(0.5 * f64::from(teeth))];
        let bore = gear.specification.bore_radius;
        let wound = gear.base_radius.powi(2) * 2.6 / (4.0 * std::f64::consts::PI) / (bore * bore);
        let model = model(&gear, &root, 8).unwrap();
        let found = model.influences(&rolls, 0).unwrap().own[0];
        assert!((found / wound - 1.0).abs() < discretisation + model.rounding(), "z {teeth}: {found} for {wound}");
        assert!(model.rounding() < 1e-2);
    }
    let (gear, root) = gear(&standard(5000, 999.0), RootShape::Trochoid);
    assert!(matches!(model(&gear, &root, 8), Err(MeshError::Rounding { .. })));
}

#[test]
fn sharp_roots_and_bores_beyond_the_load_line_are_refused() {
    let gear = Gear::new(&standard(43, 1.4)).unwrap();
    let root = gear.root(RootShape::BaseCircle).unwrap();
    assert_eq!(model(&gear, &root, 8).err(), Some(MeshError::SharpRoot));
    let rack = Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.0, ..Rack::ISO_53_A };
    let sharp = Gear::new(&Specification { rack, ..standard(17, 1.4) }).unwrap();
    assert_eq!(model(&sharp, &sharp.root(RootShape::CircularFillet).unwrap(), 8).err(), Some(MeshError::SharpRoot));

    let gear = Gear::new(&standard(200, 1.0002)).unwrap();
    let root = gear.root(RootShape::Trochoid).unwrap();
    let refused = model(&gear, &root, 8).and_then(|model| model.influences(&[root.form_roll], 0));
    assert!(matches!(refused, Err(MeshError::Bore { .. })), "{refused:?}");
}
