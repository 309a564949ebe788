//! Equilibria at several positions at once.

use super::*;

/// Tier: second method, to the last bit; each position alone. Over ends of reliefs and touches too, where some of the positions
/// have one pair that carries load and others two.
#[test]
fn positions_at_once_have_what_each_has_alone() {
    let pair = pair();
    let designs =
        [Design::default(), crowned(&pair, 8e-6), relief(&pair, 9e-6, 0.3), ga_design(&pair, 9e-6, 4e-3, 6e-6)];
    for compliance in [constant(&pair, STIFFNESS), varying()] {
        let cycle = cycle(&pair, &compliance);
        for (design, force) in designs.iter().flat_map(|design| [20.0, 700.0, 3000.0].map(|force| (design, force))) {
            let loading = LoadCase::new(&cycle, design, torque(force));
            for zone in &cycle.zones {
                let place = |index: u32| zone.start + (zone.end - zone.start) * f64::from(index) / 60.0;
                for first in (0..=54).step_by(3) {
                    let positions: [f64; 6] = std::array::from_fn(|index| place(first + u32::try_from(index).unwrap()));
                    let found = loading.together(&positions, zone.pairs).expect("they are alike");
                    for (position, state) in positions.into_iter().zip(found) {
                        let alone = loading.state(position, zone.pairs);
                        assert_eq!(state, alone, "{position} under {force}");
                        close(state.balance.loads.iter().sum(), force, 1e-14);
                    }
                }
            }
        }
    }
}

/// Pairs of what is not alike are not put together.
#[test]
fn what_has_more_to_it_is_left_to_others() {
    let pair = pair();
    let logarithmic = PairCompliance { contact: Some(ContactLaw::LoadDependent), ..varying() };
    for compliance in [coupled(), logarithmic] {
        let cycle = cycle(&pair, &compliance);
        let design = Design::default();
        assert!(LoadCase::new(&cycle, &design, 30.0).together(&[1e-3], 2).is_none());
    }
    let cycle = cycle(&pair, &varying());
    let design = Design::default();
    assert!(LoadCase::new(&cycle, &design, 0.0).together(&[1e-3], 2).is_none(), "nothing is transmitted");
}
