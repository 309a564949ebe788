//! Contacts that are wide: what resolved contact is off by, and what it says that it may be off by.
//!
//! One pair pressed together as far as its contact is a third of a module to either side. Turn and gaps are a small part of
//! what they are ([`Case::share`]), so that displacements are small and the contact is as wide as it would be.

use super::contact::pair;
use super::press::{Case, Fineness, PENALTY, press_once};
use gearmesh::gear::compliance::finite_element::FiniteElement;
use gearmesh::gear::compliance::{Assumptions, ContactLaw, Method};
use gearmesh::gear::geometry::{GearPair, Side, Specification};
use gearmesh::gear::material::Plane;
use gearmesh::gear::mesh::{Mesh, Settings};
use gearmesh::gear::modification::Design;
use gearmesh::numeric::crossing::bracketed;

/// What the mesh of this fineness is off by.
const MESH: f64 = 2e-3;

/// The force \[N\] under which our pair approaches so far at a path position, and what of the approach is in doubt there.
fn ours(cycle: &Mesh, pair: &GearPair, s: f64, approach: f64) -> [f64; 3] {
    let design = Design::default();
    let position = s - pair.start_of_contact;
    let at = |torque: f64| cycle.loaded(&design, torque).state(position, 1);
    let torque = bracketed(0.1, 1e4, |torque| at(torque).transmission_error() - approach).unwrap();
    let loading = cycle.loaded(&design, torque);
    let doubt = loading.contact_law_error_at(position, 1).unwrap();
    [torque / pair.pinion.base_radius, doubt.size / doubt.approach, doubt.widest[0]]
}

/// How far the force of a pair that is pressed together at a path position is off, and what is said of it, both relative; none
/// without the other program.
fn off(pair: &GearPair, plane: Plane, s: f64, approach: f64) -> Option<[f64; 2]> {
    let design = Design::default();
    let assumptions = Assumptions { contact: ContactLaw::Resolved, ..Assumptions::default() };
    let method = FiniteElement { plane, elements_across: 28 };
    let compliance = method.tabulate(pair, assumptions).unwrap().compliance;
    let cycle = Mesh::new(pair, &compliance, Settings::default()).unwrap();
    let (part, level) = (27.5e-6 / approach, 6);
    let path = [s];
    let case = Case {
        pair,
        design: &design,
        path: &path,
        approach,
        plane,
        slave: Side::Pinion,
        share: (0.25 * part).max(0.06),
    };
    let edge = 0.015 * 4.0 / level as f64 / part.sqrt();
    let found = press_once(&case, Fineness { level, edge, penalty: PENALTY })?;
    // Where loaded teeth tilt, the flanks touch off the line of action: a force turned by ψ has the arms r_b (1 ± ψ u), so that
    // each torque counts by the other gear's roll angle.
    let [one, other] =
        [Side::Pinion, Side::Gear].map(|side| found.torques[side as usize] / pair.side(side).base_radius);
    let [u, v] = [Side::Pinion, Side::Gear].map(|side| pair.roll(side, s));
    let truth = (v * one + u * other) / (u + v) / (1.0 - found.overlap() / approach);
    // Contact that has not converged is one edge under all of the load.
    assert!(found.edges.iter().all(|edges| *edges >= 6), "{:?} edges: CalculiX has found no contact", found.edges);
    let [force, doubt, half] = ours(&cycle, pair, s, approach);
    let off = force / truth - 1.0;
    println!(
        "{:.1} um: half width {:.4} mm, {force:.1} N of {one:.1} and {other:.1}, off by {off:.5}, in doubt {doubt:.5}, {:?} edges",
        approach * 1e6,
        half * 1e3,
        found.edges
    );
    Some([off, doubt])
}

#[test]
fn wide_contacts_are_as_far_off_as_is_said() {
    let pair = pair();
    let s = pair.zone_points().c;
    for approach in [27.5e-6, 75e-6, 150e-6, 300e-6] {
        let Some([off, doubt]) = off(&pair, Plane::Strain, s, approach) else { return };
        // What other meshes, and the pair where nothing is wide, are off by.
        assert!(off.abs() < doubt + MESH && doubt < 3.0 * off.abs(), "{approach}");
    }
}

/// Off and said, where a pair of such gears is pressed together at a share of single contact from B on.
fn of_others((teeth, shifts): ([u32; 2], [f64; 2]), plane: Plane, (share, approach): (f64, f64)) -> Option<[f64; 2]> {
    let [one, two] = [0, 1].map(|side| Specification {
        teeth: teeth[side],
        profile_shift: shifts[side],
        bore_radius: 3e-3 * (0.5 * f64::from(teeth[side]) - 1.25 + shifts[side]) / 1.5,
        ..pair().side([Side::Pinion, Side::Gear][side]).specification
    });
    let pair = GearPair::new(one, two, None).unwrap();
    let zones = pair.zone_points();
    off(&pair, plane, zones.b + share * (zones.d - zones.b), approach)
}

/// Tier: second method; other gears, places and plane states, from the lower to the upper end of single contact. The third is the
/// one that the margin was chosen on; nothing was chosen on the others.
#[test]
fn wide_contacts_of_other_gears_are_no_farther_off_than_is_said() {
    for (gears, plane, place) in [
        (([16, 22], [0.3, 0.0]), Plane::Strain, (0.05, 250e-6)),
        (([16, 22], [0.3, 0.0]), Plane::Stress, (0.5, 100e-6)),
        (([16, 22], [0.3, 0.0]), Plane::Strain, (0.95, 100e-6)),
        (([14, 15], [0.4, 0.4]), Plane::Strain, (0.3, 150e-6)),
    ] {
        let Some([off, doubt]) = of_others(gears, plane, place) else { return };
        assert!(off < 0.0 && -off < doubt + MESH, "{gears:?}, {plane:?}, {place:?}: {off} {doubt}");
    }
}

/// Tier: second method, held out; these were computed once the margin stood: other pairs, both ends of single contact, either
/// plane.
#[test]
fn the_margin_holds_where_nothing_was_chosen() {
    for (gears, plane, place) in [
        (([13, 31], [0.4, 0.1]), Plane::Stress, (0.9, 120e-6)),
        (([19, 26], [0.1, -0.1]), Plane::Strain, (0.1, 180e-6)),
    ] {
        let Some([off, doubt]) = of_others(gears, plane, place) else { return };
        assert!(off < 0.0 && -off < doubt + MESH, "{gears:?}, {plane:?}, {place:?}: {off} {doubt}");
    }
}
