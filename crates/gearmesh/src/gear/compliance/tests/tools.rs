//! Teeth that other tools cut: their compliance follows the root, and so does the section that the rating takes.

use crate::gear::compliance::energy::Beam;
use crate::gear::compliance::sainsot::Body;
use crate::gear::finite_elements::gear_model::GearModel;
use crate::gear::finite_elements::mesh::Sizing;
use crate::gear::fixtures::standard;
use crate::gear::geometry::pinion_cutter::PinionCutter;
use crate::gear::geometry::root::RootShape;
use crate::gear::geometry::{Gear, GearPair, Rack, Side, Specification};
use crate::gear::material::Plane;
use crate::gear::rating::root::critical_section;

fn tooled(teeth: u32, profile_shift: f64, protuberance: f64, machining_allowance: f64) -> Specification {
    let rack = Rack { dedendum: 1.4, tip_radius: 0.3, protuberance, machining_allowance, ..Rack::ISO_53_A };
    Specification { profile_shift, rack, bore_radius: 1e-3, ..standard(teeth, 3e-3, 2.0) }
}

/// Compliance of the tooth alone under a load at the tip \[m/N\].
fn bending(specification: &Specification) -> f64 {
    let gear = Gear::new(specification).unwrap();
    let parts = Beam::new(&gear, &gear.root(RootShape::Trochoid).unwrap(), 1.2).unwrap().parts(gear.tip_roll());
    parts.bending + parts.shear + parts.axial
}

/// Tier: continuity; as the protuberance comes down to the allowance, the tooth becomes that of the plain rack, in first order.
#[test]
fn a_vanishing_protuberance_leaves_the_plain_tooth() {
    for (teeth, shift) in [(12, 0.0), (12, 0.5), (40, 0.0), (80, -0.3)] {
        let plain = bending(&tooled(teeth, shift, 0.0, 0.0));
        let error =
            |beyond: f64, allowance: f64| bending(&tooled(teeth, shift, allowance + beyond, allowance)) / plain - 1.0;
        for allowance in [0.0, 0.04] {
            assert!(error(0.0, allowance).abs() < 1e-15, "{teeth}: pr = q is the plain tooth");
            let [small, smaller] = [1e-5, 1e-6].map(|beyond| error(beyond, allowance));
            assert!(small > 0.0 && (small / smaller / 10.0 - 1.0).abs() < 0.02, "{teeth}: {small} {smaller}");
            assert!(error(1e-13, allowance).abs() < 1e-12, "{teeth}: {}", error(1e-13, allowance));
        }
    }
}

/// Tier: second way; what a protuberance, a notch or a cutter takes off a tooth changes its compliance under a load at the tip by finite
/// elements as by the beam on its body: in the same direction, and by as much within a seventh of the change.
#[test]
fn finite_elements_follow_the_root() {
    let by_elements = |specification: &Specification| {
        let gear = Gear::new(specification).unwrap();
        let model =
            GearModel::new(&gear, &gear.root(RootShape::Trochoid).unwrap(), Plane::Stress, &Sizing::even(24)).unwrap();
        let width = specification.face_width * specification.material.youngs_modulus;
        let own = model.influences(&[0.98 * gear.tip_roll()], 0).unwrap().own[0];
        assert!(own.is_finite() && own > 0.0);
        own / width
    };
    let on_body = |specification: &Specification| {
        let gear = Gear::new(specification).unwrap();
        let half_angle = gear.root(RootShape::Trochoid).unwrap().half_angle;
        let body = Body::new(half_angle, gear.root_radius / specification.bore_radius);
        bending(specification) + body.compliance(&gear, gear.tip_roll())
    };
    for teeth in [20, 40] {
        let given = |protuberance, allowance| {
            let mut specification = Specification { bore_radius: 10e-3, ..tooled(teeth, 0.1, protuberance, allowance) };
            specification.rack.notch_radius = 0.15;
            specification
        };
        let [plain, undercut, notched] = [given(0.0, 0.0), given(0.06, 0.0), given(0.0, 0.06)];
        let cutter = Some(PinionCutter { teeth: 20, profile_shift: 0.3, addendum: 1.25, tip_radius: 0.1 });
        for other in [undercut, notched, Specification { cutter, ..plain }] {
            let elements = by_elements(&other) - by_elements(&plain);
            let beam = on_body(&other) - on_body(&plain);
            assert!((elements / beam - 1.0).abs() < 0.15, "{teeth} {:?}: {elements:e} for {beam:e}", other.rack);
        }
    }
}

/// Tier: order of convergence; a cutter of more and more teeth leaves the compliance and the critical section of the rack, as 1/z_0.
#[test]
fn many_teeth_make_a_cutter_a_rack() {
    let rack = Rack::ISO_53_A;
    let plain = [20, 33].map(|teeth| Specification { rack, ..standard(teeth, 3e-3, 2.0) });
    let values = |cutter: Option<PinionCutter>| {
        let [pinion, gear] = plain.map(|specification| Specification { cutter, ..specification });
        let pair = GearPair::new(pinion, gear, None).unwrap();
        let section = critical_section(&pair, Side::Pinion).unwrap();
        [bending(&pinion), bending(&gear), section.form_factor, section.stress_correction_factor]
    };
    let exact = values(None);
    let errors = |teeth: u32| {
        let found = values(Some(PinionCutter { teeth, profile_shift: 0.0, addendum: 1.25, tip_radius: 0.38 }));
        [0, 1, 2, 3].map(|at| found[at] / exact[at] - 1.0)
    };
    let (coarse, fine) = (errors(2000), errors(4000));
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!(coarse.abs() < 2e-3 && (coarse / fine - 2.0).abs() < 0.05, "{coarse:e} {fine:e}");
    }
}
