//! What a method says of itself before it runs, against what it then does.

use super::*;
use crate::gear::compliance::finite_element::FiniteElement;
use crate::gear::compliance::iso6336::Iso6336;

/// Methods that integrate along a tooth evaluate as often as they say; ISO 6336 has no neighbours and evaluates less.
#[test]
fn what_methods_take_is_foreseen() {
    let pair = pair(1.4);
    let methods: [&dyn Method; 4] =
        [&Energy::default(), &energy_on(GearBody::Ring), &WeberBanaschek {}, &Iso6336::default()];
    for (coupled, method) in [false, true].into_iter().flat_map(|coupled| methods.map(|method| (coupled, method))) {
        let told = Assumptions { coupled, ..SUMMED };
        let (foreseen, found) = (method.foresee(told), method.tabulate(&pair, told).unwrap());
        let evaluations = [&foreseen.work, &found.work].map(|work| work.count(&COMPLIANCE_EVALUATIONS));
        let what = format!("{method:?}, coupled: {coupled}");
        if method.whole_pair() {
            assert!(evaluations[1] <= evaluations[0] && foreseen.neighbours == 0, "{what}");
        } else {
            assert_eq!(evaluations[0], evaluations[1], "{what}");
        }
        let sides = [&found.compliance.pinion, &found.compliance.gear];
        let longest = |tooth: &ToothCompliance| {
            let parts = [&tooth.bending, &tooth.shear, &tooth.axial, &tooth.body];
            parts.map(|part| part.node_values().len()).into_iter().max().unwrap()
        };
        let nodes: usize = sides.into_iter().map(longest).sum();
        assert!(nodes <= foreseen.nodes && foreseen.nodes <= 5 * nodes / 2, "{what}: {nodes} of {}", foreseen.nodes);
    }
}

/// Only ISO 6336 knows a pair as a whole; only finite elements know the stress at the root, and need it rounded.
#[test]
fn methods_say_what_they_need_and_know() {
    let methods: [(&dyn Method, [bool; 3]); 4] = [
        (&Energy::default(), [false, false, false]),
        (&WeberBanaschek {}, [false, false, false]),
        (&Iso6336::default(), [true, false, false]),
        (&FiniteElement::default(), [false, true, true]),
    ];
    for (method, expected) in methods {
        let said = [method.whole_pair(), method.needs_fillet(), method.root_stresses().is_some()];
        assert_eq!(said, expected, "{method:?}");
    }
}

/// The parts of a tooth have one range, so their sum is one series, which is as right as its parts.
#[test]
fn the_sum_of_the_parts_is_one_series() {
    let found = energy(&pair(1.4), SUMMED).unwrap().compliance;
    for tooth in [&found.pinion, &found.gear] {
        let sum = tooth.total_series().unwrap();
        for step in 0..=50 {
            let roll = tooth.body.lower() + f64::from(step) / 50.0 * (tooth.body.upper() - tooth.body.lower());
            assert!((sum.value(roll) / tooth.total(roll) - 1.0).abs() < 1e-13, "{roll}");
        }
    }
}
