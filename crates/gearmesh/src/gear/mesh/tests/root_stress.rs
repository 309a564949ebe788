//! Root stress over the cycle, from influences of finite elements: sums of them, and what follows from them.

use super::*;
use crate::gear::compliance::finite_element::FiniteElement;
use crate::gear::compliance::{Assumptions, RootInfluences, RootStresses};
use crate::gear::contact::{CornerContact, SliceCoupling};
use crate::gear::fixtures::standard;
use crate::gear::geometry::Side;
use crate::gear::geometry::Side::Gear;
use crate::gear::material::Plane;
use crate::gear::mesh::answers::curve::Point;
use crate::gear::work::ROOT_STRESSES;

const ROOTS: Wanted = Wanted { harmonics: 0, pressure: false, root_stress: true };

fn meshed(teeth: [u32; 2], contact: ContactLaw) -> (GearPair, PairCompliance, [RootInfluences; 2]) {
    let [pinion, gear] = teeth.map(|teeth| standard(teeth, 3e-3, 1.6));
    let pair = GearPair::new(pinion, gear, None).unwrap();
    // Meshes for point loads have their places at the root in pairs, and so farther apart where they are coarse.
    let elements_across = if contact == ContactLaw::Resolved { 12 } else { 8 };
    let method = FiniteElement { plane: Plane::Strain, elements_across };
    let assumptions = Assumptions { contact, ..Assumptions::default() };
    let (tabulated, roots) = method.tabulate_with_roots(&pair, assumptions).unwrap();
    (pair, tabulated.compliance, roots)
}

fn settings(corner_contact: CornerContact, slice_coupling: SliceCoupling) -> [Settings; 1] {
    [Settings { corner_contact, slice_coupling, ..Settings::default() }]
}

/// The largest stress of a gear at a place, summed series by series, and where it is: the places before and after.
fn summed(cycle: &Mesh, loading: &Loaded, roots: &RootInfluences, side: Side, point: &Point) -> (f64, [f64; 2]) {
    let state = loading.state(point.cycle_position, point.pairs);
    let springs: Vec<usize> = (0..cycle.springs(point.pairs)).filter(|spring| point.loads[*spring] > 0.0).collect();
    let middle = roots.stresses.len() / 2;
    let (mut largest, mut around) = (0.0, [0.0, f64::INFINITY]);
    for &stressed in &springs {
        for place in 0..roots.radii.len() {
            let of = |&loaded: &usize| {
                let s = cycle.path_position(point.cycle_position, loaded);
                let further = if side == Pinion { loaded + middle - stressed } else { stressed + middle - loaded };
                let gear = usize::from(side == Gear);
                let (roll, (sine, cosine)) = (cycle.rolls(s)[gear], cycle.inclinations(s)[gear].sin_cos());
                let normal = roots.stresses[further][place].value(roll);
                // At the corner of a tip loads are along the normal of the other flank, if that is known of.
                let turned = roots.along[further].get(place).map_or(normal, |along| cosine * normal + sine * along);
                loading.line_load(point.cycle_position, &state, loaded) * turned
            };
            let stress: f64 = springs.iter().map(of).sum();
            if stress > largest {
                largest = stress;
                around = [roots.radii[place.saturating_sub(1)], roots.radii[(place + 1).min(roots.radii.len() - 1)]];
            }
        }
    }
    (largest, around)
}

/// Tier: second method; the sum over the pairs of load times influence, by Clenshaw's recurrence, place by place. The top of
/// the parabola lies above the largest of the places, by less than 2 % with 8 elements across, and between its neighbours.
#[test]
fn root_stresses_are_sums_of_load_times_influence() {
    for contact in [ContactLaw::Linear, ContactLaw::LoadDependent, ContactLaw::Resolved] {
        let (pair, compliance, roots) = meshed([19, 48], contact);
        let all = [(CornerContact::None, SliceCoupling::None), (CornerContact::Exact, SliceCoupling::Plate)];
        for settings in all.into_iter().flat_map(|(corner, slices)| settings(corner, slices)) {
            let cycle = Mesh::new(&pair, &compliance, settings).unwrap().with_roots(&roots);
            for design in [Design::default(), ga_design(&pair, 10e-6, 2e-3, 6e-6)] {
                let loading = cycle.loaded(&design, 60.0);
                let mut shared = 0;
                for point in loading.curve(ROOTS).iter().step_by(5) {
                    let state = loading.state(point.cycle_position, point.pairs);
                    let found = loading.root_stress(point.cycle_position, point.pairs, &state).unwrap();
                    for (side, (found, roots)) in [Pinion, Gear].into_iter().zip(found.iter().zip(&roots)) {
                        close(point.root_stress.unwrap()[usize::from(side == Gear)], found.stress, 1e-9);
                        let (largest, [low, high]) = summed(&cycle, &loading, roots, side, point);
                        let excess = found.stress / largest - 1.0;
                        assert!((-1e-12..2e-2).contains(&excess), "{contact:?} {side:?}: {} {largest}", found.stress);
                        assert!(found.radius >= low && found.radius <= high, "{low} {} {high}", found.radius);
                    }
                    shared += usize::from(point.loaded_pairs > 1);
                }
                assert!(shared > 3, "{shared}");
            }
        }
    }
}

/// Tier: invariant. Where the share of a pair does not depend on the load, neither does the stress over the load.
#[test]
fn root_stress_is_proportional_to_the_torque() {
    let (pair, compliance, roots) = meshed([25, 31], ContactLaw::Linear);
    let cycle = cycle(&pair, &compliance).with_roots(&roots);
    let design = Design::default();
    let of = |torque: f64| cycle.loaded(&design, torque).summary(ROOTS).largest_root_stress.unwrap();
    let unit = of(1.0);
    for torque in [1e-3, 50.0, 1e5] {
        for (scaled, unit) in of(torque).iter().zip(&unit) {
            close(scaled.extremum.value, torque * unit.extremum.value, 1e-12);
            close(scaled.radius, unit.radius, 1e-12);
        }
    }
    let none = of(0.0);
    assert!(none.iter().all(|root| root.extremum.value == 0.0 && root.radius.is_nan()), "{none:?}");
}

/// Tier: brute force; no position of a fine grid has more than the summary, and one has it but for the grid.
#[test]
fn the_largest_root_stress_agrees_with_a_brute_grid() {
    let (pair, compliance, roots) = meshed([19, 48], ContactLaw::LoadDependent);
    for (corner, slices) in [(CornerContact::None, SliceCoupling::None), (CornerContact::Exact, SliceCoupling::None)] {
        let [settings] = settings(corner, slices);
        let cycle = Mesh::new(&pair, &compliance, settings).unwrap().with_roots(&roots);
        for design in [Design::default(), relief(&pair, 20e-6, 1.0), ga_design(&pair, 25e-6, 4e-3, 6e-6)] {
            for torque in [20.0, 150.0] {
                let loading = cycle.loaded(&design, torque);
                let found = loading.summary(ROOTS).largest_root_stress.unwrap();
                let mut largest = [(0.0, 0.0); 2];
                for zone in &cycle.zones {
                    for step in 0..=4000 {
                        let position = zone.start + (zone.end - zone.start) * f64::from(step) / 4000.0;
                        let state = loading.state(position, zone.pairs);
                        let stresses = loading.root_stress(position, zone.pairs, &state).unwrap();
                        for (largest, root) in largest.iter_mut().zip(stresses) {
                            if root.stress > largest.0 {
                                *largest = (root.stress, root.radius);
                            }
                        }
                    }
                }
                for (found, (stress, radius)) in found.iter().zip(largest) {
                    let excess = found.extremum.value / stress - 1.0;
                    assert!((-1e-5..2e-4).contains(&excess), "{torque}: {} {stress}", found.extremum.value);
                    assert!((found.radius - radius).abs() < 2e-5, "{} {radius}", found.radius);
                }
            }
        }
    }
}

/// Tier: invariant; which gear drives does not matter, nor which is called the pinion.
#[test]
fn swapped_gears_have_each_other_s_root_stress() {
    for contact in [ContactLaw::LoadDependent, ContactLaw::Resolved] {
        let [one, other] = [[17, 40], [40, 17]].map(|teeth| {
            let (pair, compliance, roots) = meshed(teeth, contact);
            let cycle = cycle(&pair, &compliance).with_roots(&roots);
            let design = relief(&pair, 15e-6, 0.8);
            let torque = 40e3 * pair.pinion.base_radius;
            cycle.loaded(&design, torque).summary(ROOTS).largest_root_stress.unwrap()
        });
        for gear in [0, 1] {
            close(one[gear].extremum.value, other[1 - gear].extremum.value, 1e-9);
            close(one[gear].radius, other[1 - gear].radius, 1e-9);
        }
        assert!((one[0].extremum.value / one[1].extremum.value - 1.0).abs() > 0.02, "they are not alike");
    }
}

/// Nothing is found that is not asked for, and what is asked for leaves the rest as it is.
#[test]
fn root_stresses_are_found_only_when_asked_for() {
    let (pair, compliance, roots) = meshed([19, 48], ContactLaw::LoadDependent);
    let design = relief(&pair, 15e-6, 0.8);
    let run = |cycle: Mesh, wanted: Wanted| {
        let summary = cycle.loaded(&design, 80.0).summary(wanted);
        (summary, cycle.work().count(&ROOT_STRESSES))
    };
    let known = || cycle(&pair, &compliance).with_roots(&roots);
    let (without, none) = run(known(), Wanted::default());
    assert!(none == 0 && without.largest_root_stress.is_none());
    let (unknown, none) = run(cycle(&pair, &compliance), ROOTS);
    assert!(none == 0 && unknown.largest_root_stress.is_none());
    let (with, some) = run(known(), ROOTS);
    assert!(some > 64 && with.largest_root_stress.is_some());
    assert_eq!(with.peak_to_peak, without.peak_to_peak);
    assert_eq!(with.mean, without.mean);
}
