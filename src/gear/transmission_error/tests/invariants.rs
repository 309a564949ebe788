//! What may not change anything, what must grow in proportion, and what must balance.

use super::*;

/// Driving and driven gear may change places: the path is then run through backwards.
#[test]
fn swapping_the_gears_changes_nothing() {
    let pair = pair();
    let swapped = Pair {
        pinion: pair.gear.clone(),
        gear: pair.pinion.clone(),
        start_of_contact: pair.tangent_length - pair.end_of_contact,
        end_of_contact: pair.tangent_length - pair.start_of_contact,
        ..pair.clone()
    };
    let tip = [("amount", Quantity(8e-6)), ("length", Quantity(4e-3)), ("curve", Choice("parabolic"))];
    let root = [("amount", Quantity(5e-6)), ("fraction", Number(0.5))];
    let face = [("amount", Quantity(6e-6)), ("length", Quantity(4e-3))];
    let of = |pair: &Pair, one: &'static str, two: &'static str| {
        design(pair, &[("tip_relief", one, &tip), ("root_relief", two, &root), ("end_relief", one, &face)]).unwrap()
    };
    for contact in [ContactLaw::Linear, ContactLaw::LoadDependent] {
        for compliance in [varying(), coupled()] {
            let compliance = PairCompliance { contact, ..compliance };
            let mirrored = PairCompliance {
                pinion: compliance.gear.clone(),
                gear: compliance.pinion.clone(),
                ..compliance.clone()
            };
            let (one, two) = (of(&pair, "pinion", "gear"), of(&swapped, "gear", "pinion"));
            let wanted = Wanted { harmonics: 3, pressure: true };
            let here = Loading::new(&cycle(&pair, &compliance), &one, 50.0).summary(wanted);
            let there = cycle(&swapped, &mirrored);
            let there = Loading::new(&there, &two, 50.0 * 48.0 / 19.0).summary(wanted);
            close(here.peak_to_peak, there.peak_to_peak, 1e-9);
            close(here.mean, there.mean, 1e-10);
            close(here.variance, there.variance, 1e-7);
            close(here.largest_pressure.unwrap().value, there.largest_pressure.unwrap().value, 1e-9);
            for (a, b) in here.harmonics.iter().zip(&there.harmonics) {
                assert!((a - b).abs() < 1e-7 * here.peak_to_peak, "{a} {b}");
            }
        }
    }
}

/// Without gaps everything is proportional to the torque, from 1e-12 to 1e9 N·m.
#[test]
fn without_gaps_everything_is_proportional_to_the_torque() {
    let pair = pair();
    for compliance in [varying(), coupled()] {
        let cycle = cycle(&pair, &compliance);
        let design = Design::default();
        let unit = Loading::new(&cycle, &design, 1.0).summary(Wanted::default());
        for torque in [1e-12, 1e-3, 50.0, 1e6, 1e9] {
            let scaled = Loading::new(&cycle, &design, torque).summary(Wanted::default());
            close(scaled.peak_to_peak, torque * unit.peak_to_peak, 1e-12);
            close(scaled.mean, torque * unit.mean, 1e-13);
        }
    }
}

/// Loads are never negative and add up to the force, in every model.
#[test]
fn loads_balance_the_torque() {
    let pair = pair_with_contact_ratio(2.3);
    for contact in [ContactLaw::Linear, ContactLaw::LoadDependent] {
        for compliance in [varying(), coupled()] {
            let compliance = PairCompliance { contact, ..compliance };
            let cycle = cycle(&pair, &compliance);
            for crown in [0.0, 20e-6] {
                for torque in [1e-12, 1.0, 50.0, 1e9] {
                    let design = ga_design(&pair, 15e-6, 5e-3, crown);
                    for point in Loading::new(&cycle, &design, torque).curve(Wanted::default()) {
                        assert!(point.loads.iter().all(|load| *load >= 0.0));
                        close(point.loads.iter().sum(), torque / pair.pinion.base_radius, 1e-12);
                        assert!(point.loaded_pairs >= 1 && point.loaded_pairs <= point.pairs);
                    }
                }
            }
        }
    }
}

/// Where the bodies couple, a state must fulfil the conditions it was solved from, with the compliances taken anew.
#[test]
fn coupled_states_fulfil_complementarity() {
    let pair = pair_with_contact_ratio(2.3);
    let compliance = coupled();
    let cycle = cycle(&pair, &compliance);
    let design = ga_design(&pair, 9e-6, 5e-3, 0.0);
    let contact = 4.0 * 0.91 / (std::f64::consts::PI * 206e9 * 18e-3);
    for point in Loading::new(&cycle, &design, 80.0).curve(Wanted::default()) {
        for j in 0..point.pairs {
            let s = |pair_index: usize| point.path_position + BASE_PITCH * pair_index as f64;
            let u1 = |index: usize| s(index) / pair.pinion.base_radius;
            let u2 = |index: usize| (pair.tangent_length - s(index)) / pair.gear.base_radius;
            let mut deflection =
                point.loads[j] * (compliance.pinion.total(u1(j)) + compliance.gear.total(u2(j)) + contact);
            for k in (0..point.pairs).filter(|k| *k != j) {
                let between = j.abs_diff(k) - 1;
                let pinion = compliance.pinion.neighbours[between].value(u1(j.min(k)));
                deflection += point.loads[k] * (pinion + compliance.gear.neighbours[between].value(u2(j.max(k))));
            }
            use crate::gear::geometry::Side::{Gear, Pinion};
            let gap = design.depth(Pinion, u1(j)) + design.depth(Gear, u2(j));
            let open = gap + deflection - point.transmission_error;
            if point.loads[j] > 0.0 {
                assert!(open.abs() < 1e-12 * point.transmission_error, "{open:e}");
            } else {
                assert!(open > -1e-12 * point.transmission_error, "{open:e}");
            }
        }
    }
}

#[test]
fn coupling_of_nothing_is_no_coupling_and_coupling_softens_double_contact() {
    let pair = pair();
    let mut nothing = coupled();
    for tooth in [&mut nothing.pinion, &mut nothing.gear] {
        tooth.neighbours = vec![fixtures::tooth(|_| 0.0).body];
    }
    let design = ga_design(&pair, 6.93e-6, 3.41e-3, 5.67e-6);
    let of =
        |compliance: &PairCompliance| Loading::new(&cycle(&pair, compliance), &design, 50.0).summary(Wanted::default());
    let (summed, zero) = (of(&varying()), of(&nothing));
    close(zero.peak_to_peak, summed.peak_to_peak, 1e-10);
    close(zero.variance, summed.variance, 1e-10);
    let (_, summed) = stiffness(&cycle(&pair, &varying()), 50.0);
    let (_, softer) = stiffness(&cycle(&pair, &coupled()), 50.0);
    close(softer.fewest.most, summed.fewest.most, 1e-12);
    assert!(softer.most.unwrap().most < 0.95 * summed.most.unwrap().most);
}
