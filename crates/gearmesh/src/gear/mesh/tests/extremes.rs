//! Balance, complementarity and the traps: vanishing and absurd loads, crowning of every size, reliefs too deep or too
//! short.

use super::*;
use crate::gear::mesh::answers::walk::walk;
use crate::numeric::surface::Surface;

/// Without gaps everything is proportional to the torque, from 1e-12 to 1e9 N·m.
#[test]
fn without_gaps_everything_is_proportional_to_the_torque() {
    let pair = pair();
    for compliance in [varying(), coupled()] {
        let cycle = cycle(&pair, &compliance);
        let design = Design::default();
        let unit = cycle.loaded(&design, 1.0).summary(Wanted::default());
        for torque in [1e-12, 1e-3, 50.0, 1e6, 1e9] {
            let scaled = cycle.loaded(&design, torque).summary(Wanted::default());
            close(scaled.peak_to_peak, torque * unit.peak_to_peak, 1e-12);
            close(scaled.mean, torque * unit.mean, 1e-13);
        }
    }
}

/// Loads are never negative and add up to the force, in every model.
#[test]
fn loads_balance_the_torque() {
    let pair = pair_with_contact_ratio(2.3);
    for contact in [ContactLaw::Linear, ContactLaw::LoadDependent, ContactLaw::Resolved] {
        for compliance in [varying(), coupled()] {
            let compliance = PairCompliance { contact: Some(contact), ..compliance };
            let cycle = cycle(&pair, &compliance);
            for crown in [0.0, 20e-6] {
                for torque in [1e-12, 1.0, 50.0, 1e9] {
                    let design = ga_design(&pair, 15e-6, 5e-3, crown);
                    for point in cycle.loaded(&design, torque).curve(Wanted::default()) {
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
    let gaps = crate::gear::contact::gap::Gaps::new(&pair, &design.profiles(0.0));
    let contact = 4.0 * 0.91 / (std::f64::consts::PI * 206e9 * 18e-3);
    for point in cycle.loaded(&design, 80.0).curve(Wanted::default()) {
        for j in 0..point.pairs {
            let s = |pair_index: usize| point.path_position + BASE_PITCH * pair_index as f64;
            let u1 = |index: usize| s(index) / pair.pinion.base_radius;
            let u2 = |index: usize| (pair.tangent_length - s(index)) / pair.gear.base_radius;
            let mut deflection =
                point.loads[j] * (compliance.pinion.total(u1(j)) + compliance.gear.total(u2(j)) + contact);
            for k in (0..point.pairs).filter(|k| *k != j) {
                let between = j.abs_diff(k) - 1;
                let (behind, ahead) = (j.min(k), j.max(k));
                let pinion = compliance.pinion.neighbours[between].value(u1(behind), u1(ahead));
                let gear = compliance.gear.neighbours[between].value(u2(ahead), u2(behind));
                deflection += point.loads[k] * (pinion + gear);
            }
            let open = gaps.at(s(j)).unwrap() + deflection - point.transmission_error;
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
        tooth.neighbours = vec![Surface::from_values([0.0; 2], [2.0; 2], [1, 1], &[0.0])];
    }
    let design = ga_design(&pair, 6.93e-6, 3.41e-3, 5.67e-6);
    let of = |compliance: &PairCompliance| cycle(&pair, compliance).loaded(&design, 50.0).summary(Wanted::default());
    let (summed, zero) = (of(&varying()), of(&nothing));
    close(zero.peak_to_peak, summed.peak_to_peak, 1e-10);
    close(zero.variance, summed.variance, 1e-10);
    let (_, summed) = stiffness(&cycle(&pair, &varying()), 50.0);
    let (_, softer) = stiffness(&cycle(&pair, &coupled()), 50.0);
    close(softer.fewest_pairs.maximum, summed.fewest_pairs.maximum, 1e-12);
    assert!(softer.most_pairs.unwrap().maximum < 0.95 * summed.most_pairs.unwrap().maximum);
}

/// The law's own closed form: one pair of constant stiffness under crowning C obeys F/k = w t − C t³/3.
#[test]
fn crowning_has_its_closed_form_at_every_size() {
    let pair = pair_with_contact_ratio(1.0);
    let cycle = cycle(&pair, &constant(&pair, STIFFNESS));
    for crown in [0.0, 1e-300, 1e-15, 6e-6, 20e-6] {
        for torque in [1e-12, 1e-3, 50.0, 1e9] {
            let design = crowned(&pair, crown);
            let point = cycle.loaded(&design, torque).curve(Wanted::default())[3];
            let (w, edge) = (point.transmission_error, crown * 0.81);
            let t = if w >= edge { 1.0 } else { (w / edge).sqrt() };
            let force = STIFFNESS * (w * t - edge * t * t * t / 3.0);
            close(force, torque / pair.pinion.base_radius, 1e-11);
            close(point.tangent_stiffness, STIFFNESS * t, 1e-9);
        }
    }
}

/// Relief beyond the deflection: contact is lost there, first touches are found, and the rest stays in order.
#[test]
fn relief_above_the_deflection_shortens_the_contact() {
    let pair = pair();
    let cycle = cycle(&pair, &constant(&pair, STIFFNESS));
    let force = 500.0;
    let (amount, length) = (50e-6, 2.5e-3);
    let linear = [("amount", Quantity(amount)), ("length", Quantity(length))];
    let design = design(&pair, &[("tip_relief", "both", &linear)]).unwrap();
    let summary = cycle.loaded(&design, torque(force)).summary(Wanted::default());
    // A relieved pair carries load as long as its gap is below F/k, at each end of the path.
    let opens = |end: f64, inwards: f64| {
        let open = |along: f64| least_gap(&pair, &design, end + along * inwards) - force / STIFFNESS;
        crate::numeric::crossing::bracketed(0.0, length, open).unwrap()
    };
    let lost = opens(pair.start_of_contact, 1.0) + opens(pair.end_of_contact, -1.0);
    close(summary.loaded_contact_ratio, pair.contact_ratio - lost / BASE_PITCH, 1e-9);
    close(summary.largest_load_share, 1.0, 1e-12);
}

#[test]
fn the_load_dependent_law_survives_vanishing_and_absurd_loads() {
    let pair = pair();
    let cycle = cycle(&pair, &PairCompliance { contact: Some(ContactLaw::LoadDependent), ..varying() });
    let mut before = 0.0;
    for exponent in -12..=9 {
        let torque = libm::pow(10.0, f64::from(exponent));
        for design in [Design::default(), crowned(&pair, 5e-6)] {
            let summary =
                cycle.loaded(&design, torque).summary(Wanted { harmonics: 2, pressure: true, ..Wanted::default() });
            assert!(summary.mean.is_finite() && summary.peak_to_peak > 0.0 && summary.variance > 0.0, "{torque}");
        }
        let (_, stiffness) = stiffness(&cycle, torque);
        assert!(stiffness.mean > before, "stiffer under more load");
        before = stiffness.mean;
    }
    assert_eq!(cycle.loaded(&Design::default(), 0.0).peak_to_peak(), 0.0);
}

/// The driven gear's tip meets the driver's root: relieving either is the same on the line of action, so that what they
/// differ by is of second order in the slope of the relief.
#[test]
fn root_relief_is_the_other_gears_tip_relief() {
    let pair = pair();
    let cycle = cycle(&pair, &varying());
    for counted in ["tip", "single_zone", "zone_end"] {
        let apart = |scale: f64| {
            let values = |counted: &'static str| {
                [
                    ("amount", Quantity(8e-6 * scale)),
                    ("length", Quantity(2.2e-3)),
                    ("curve", Choice("parabolic")),
                    ("counted_from", Choice(counted)),
                ]
            };
            let root = values(if counted == "tip" { "root" } else { counted });
            let root = design(&pair, &[("root_relief", "pinion", &root)]).unwrap();
            let tip = design(&pair, &[("tip_relief", "gear", &values(counted))]).unwrap();
            let [root, tip] = [&root, &tip].map(|design| cycle.loaded(design, 50.0 * scale).summary(Wanted::default()));
            close(root.variance, tip.variance, 0.2 * scale);
            1.0 - root.peak_to_peak / tip.peak_to_peak
        };
        let (small, smaller) = (apart(1e-3), apart(1e-4));
        assert!((small / smaller - 10.0).abs() < 0.1, "{counted}: {small:e} {smaller:e}");
        assert!(small.abs() < 1e-4, "{counted}: {small:e}");
    }
}

/// A relief of vanishing length is not a relief, and lengths near it lead there.
#[test]
fn relief_of_no_length_is_the_limit_of_short_ones() {
    let pair = pair();
    let cycle = cycle(&pair, &varying());
    let of = |design: &Design| cycle.loaded(design, 50.0).summary(Wanted::default());
    let plain = of(&Design::default());
    for length in [0.0, 1e-300, 1e-15, 1e-9] {
        let found = of(&ga_design(&pair, 7e-6, length, 0.0));
        close(found.peak_to_peak, plain.peak_to_peak, 1e-6);
        close(found.variance, plain.variance, 1e-5);
    }
}

/// A torque so large that relief no longer matters, and positions that fall on B and D: both one-sided limits are there.
#[test]
fn both_limits_at_the_ends_of_the_zones_are_sampled() {
    let pair = pair();
    let cycle = cycle(&pair, &constant(&pair, STIFFNESS));
    let design = Design::default();
    let points = cycle.loaded(&design, torque(1000.0)).curve(Wanted::default());
    let shared = pair.end_of_contact - pair.start_of_contact - BASE_PITCH;
    let at_b: Vec<usize> =
        points.iter().filter(|point| (point.cycle_position - shared).abs() < 1e-15).map(|point| point.pairs).collect();
    assert_eq!(at_b, [2, 1]);
    let (first, last) = (points[0], points[points.len() - 1]);
    assert_eq!((first.cycle_position, first.pairs), (0.0, 2));
    assert_eq!((last.cycle_position, last.pairs), (BASE_PITCH, 1));
    assert!(points.windows(2).all(|two| two[0].cycle_position < two[1].cycle_position || two[0].pairs != two[1].pairs));
}

/// Slopes on both flanks whose gaps add up to a constant: without load all pairs touch at once, but for rounding.
#[test]
fn gaps_that_are_equal_but_for_rounding_are_walked_once() {
    let pair = pair();
    let cycle = cycle(&pair, &varying());
    let design = design(&pair, &[("profile_slope", "both", &[("amount", Quantity(8e-6))])]).unwrap();
    for torque in [0.0, 1e-12] {
        let mut visits = 0;
        walk(&cycle.loaded(&design, torque).case, cycle.period() / 16.0, |_, _| visits += 1);
        assert!(visits < 1000, "{visits} spans");
    }
}

/// A minimiser may come upon them: neither is the best of all designs.
#[test]
fn a_torque_that_is_no_number_is_beyond_the_model() {
    let pair = pair();
    let cycle = cycle(&pair, &varying());
    let design = relief(&pair, 9e-6, 0.8);
    for torque in [f64::NAN, f64::INFINITY] {
        let load_case = cycle.loaded(&design, torque);
        assert_eq!([load_case.peak_to_peak(), load_case.variance()], [f64::INFINITY; 2], "{torque}");
    }
    let unloaded = |torque: f64| cycle.loaded(&design, torque).peak_to_peak();
    assert_eq!(unloaded(-150.0), unloaded(0.0));
}
