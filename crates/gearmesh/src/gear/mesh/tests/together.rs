//! Equilibria at several positions at once.

use super::*;
use crate::gear::mesh::Equilibrium;
use crate::numeric::logarithm::Known;

fn together<const M: usize>(loading: &Loaded, positions: &[f64; M], pairs: usize) -> Option<[Equilibrium; M]> {
    let mut found = [Equilibrium::NONE; M];
    loading.case.together(positions, pairs, &mut found).map(|()| found)
}

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
            let loading = cycle.loaded(design, torque(force));
            for zone in &cycle.zones {
                let place = |index: u32| zone.start + (zone.end - zone.start) * f64::from(index) / 60.0;
                for first in (0..=54).step_by(3) {
                    let positions: [f64; 6] = std::array::from_fn(|index| place(first + u32::try_from(index).unwrap()));
                    let found = together(&loading, &positions, zone.pairs).expect("they are alike");
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

/// Tier: second method; pairs whose law is known at once share a load as they do by the search for any of them, and several
/// positions at once have what each has alone.
#[test]
fn pairs_of_logarithmic_laws_share_as_by_the_general_search() {
    let pair = pair();
    let designs = [Design::default(), relief(&pair, 9e-6, 0.3), relief(&pair, 25e-6, 0.6)];
    let (mut found, mut all) = (0, 0);
    for contact in [ContactLaw::LoadDependent, ContactLaw::Resolved] {
        let compliance = PairCompliance { contact: Some(contact), ..varying() };
        let cycle = cycle(&pair, &compliance);
        for (design, force) in designs.iter().flat_map(|design| [20.0, 700.0, 9000.0].map(|force| (design, force))) {
            let loading = cycle.loaded(design, torque(force));
            for zone in &cycle.zones {
                let place = |index: u32| zone.start + (zone.end - zone.start) * f64::from(index) / 300.0;
                for first in (0..300).step_by(3) {
                    let positions = [first, first + 1, first + 2].map(place);
                    all += 1;
                    let Some(both) = together(&loading, &positions, zone.pairs) else { continue };
                    found += 1;
                    for (position, state) in positions.into_iter().zip(both) {
                        assert_eq!(state, loading.state(position, zone.pairs), "{position} under {force}");
                        let exact = loading.case.in_general(position, zone.pairs);
                        close(state.unloaded, exact.unloaded, 1e-14);
                        close(state.balance.approach, exact.balance.approach, 3e-14);
                        close(state.balance.slope, exact.balance.slope, 1e-9);
                        close(state.balance.loads.iter().sum(), force, 1e-15);
                        for spring in 0..zone.pairs {
                            let (one, other) = (&state.balance, &exact.balance);
                            assert!((one.loads[spring] - other.loads[spring]).abs() < 1e-12 * force);
                            let apart = (one.penetration[spring] - other.penetration[spring]).abs();
                            assert!(apart < 1e-13 * other.approach, "{position} under {force}: {apart}");
                        }
                    }
                }
            }
        }
    }
    assert!(100 * found > 85 * all, "{found} of {all}");
}

/// Tier: second method; how far a pair is pressed by another one that carries all of the load, from the other's law put
/// together at its place and from gaps without copies. Next to tips of resolved contact that law is not known at once.
#[test]
fn one_pair_presses_another_as_its_own_law_says() {
    let pair = pair();
    let designs = [Design::default(), relief(&pair, 9e-6, 0.3), relief(&pair, 25e-6, 0.6)];
    for (contact, least) in [(ContactLaw::LoadDependent, 1.0), (ContactLaw::Resolved, 0.6)] {
        let compliance = PairCompliance { contact: Some(contact), ..varying() };
        let cycle = cycle(&pair, &compliance);
        let (mut quick, mut all) = (0, 0);
        for (design, force) in designs.iter().flat_map(|design| [20.0, 700.0, 9000.0].map(|force| (design, force))) {
            let loading = cycle.loaded(design, torque(force));
            let line_load = Known::new(force / cycle.face_width);
            let zone = cycle.zones[0];
            assert_eq!(zone.pairs, 2);
            for (index, spring) in (1..100).flat_map(|index| [(index, 0), (index, 1)]) {
                let position = zone.start + (zone.end - zone.start) * f64::from(index) / 100.0;
                let [here, there] = [spring, 1 - spring].map(|spring| cycle.path_position(position, spring));
                let [gap, beside] =
                    [here, there].map(|s| loading.case.flanks.searched(s).expect("they touch on the line"));
                let alone = cycle.elasticity.series(there, None).at_known_load(line_load.number, line_load.log).0;
                let found = loading.case.pressed_by_others(position, 2, spring).expect("there is another");
                assert!((found - (beside + alone - gap)).abs() < 1e-13 * (alone + beside + gap), "{position}");
                quick += i32::from(loading.case.of_plain_pair(position, 1 - spring).is_some());
                all += 1;
            }
        }
        assert!(f64::from(quick) >= least * f64::from(all), "{contact:?}: {quick} of {all}");
    }
}

/// Pairs of what is not alike are not put together.
#[test]
fn what_has_more_to_it_is_left_to_others() {
    let pair = pair();
    let logarithmic = PairCompliance { contact: Some(ContactLaw::LoadDependent), ..varying() };
    for (compliance, design) in [(coupled(), Design::default()), (logarithmic, crowned(&pair, 8e-6))] {
        let cycle = cycle(&pair, &compliance);
        assert!(together(&cycle.loaded(&design, 30.0), &[1e-3], 2).is_none());
    }
    let cycle = cycle(&pair, &varying());
    let design = Design::default();
    assert!(together(&cycle.loaded(&design, 0.0), &[1e-3], 2).is_none(), "nothing is transmitted");
}
