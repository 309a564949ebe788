//! What is known beforehand of the law of a pair, against the law itself.

use super::*;
use crate::gear::contact::CornerContact;

/// Tier: second method; the law put together at each place, from A to E and under loads from vanishing ones up. Next to the
/// tips nothing is known of resolved contact, and nowhere beyond them.
#[test]
fn what_is_known_of_a_law_is_the_law() {
    let pair = pair();
    for (contact, corner_contact, least) in [
        (ContactLaw::LoadDependent, CornerContact::None, 1.0),
        (ContactLaw::Resolved, CornerContact::None, 0.5),
        (ContactLaw::Resolved, CornerContact::Exact, 0.5),
    ] {
        for model in [varying(), inclined(coupled())] {
            let compliance = PairCompliance { contact: Some(contact), ..model };
            let settings = Settings { corner_contact, ..Settings::default() };
            let cycle = Mesh::new(&pair, &compliance, settings).unwrap();
            let (from, to) = (pair.start_of_contact, pair.end_of_contact);
            let rate = cycle.elasticity.rates()[0];
            for load in [1e-6, 1.0, 1e3, 1e5] {
                let (log, mut known) = (libm::log(load), 0);
                for index in 0..=400 {
                    let s = from + (to - from) * f64::from(index) / 400.0;
                    let plain = cycle.elasticity.plain(s);
                    if !plain.holds(load) {
                        continue;
                    }
                    known += 1;
                    let ([penetration, slope, _], is_rough) = cycle.elasticity.series(s, None).rates_at(load, log);
                    let [found, rise, _] = plain.rates_at(rate, load, log);
                    assert!(!is_rough, "{contact:?} at {s} under {load}: a tip is near");
                    close(found, penetration, 1e-13);
                    close(rise, slope, 1e-13);
                }
                assert!(f64::from(known) >= 401.0 * least, "{contact:?} under {load}: {known} of 401");
            }
            let tips = [from, to].map(|s| cycle.elasticity.plain(s).holds(1e5));
            assert!(tips == [contact == ContactLaw::LoadDependent; 2], "{contact:?}");
            let beyond = [from - 1e-9, to + 1e-9].map(|s| cycle.elasticity.plain(s).holds(1e-6));
            assert!(beyond == [false; 2], "{contact:?}");
        }
    }
}
