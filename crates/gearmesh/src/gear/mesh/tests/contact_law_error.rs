//! What of a transmission error is in doubt where the law of contact is: when it is said, and that it is as large as it is.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::*;
use crate::gear::geometry::{Rack, Side, Specification};
use crate::gear::material::Material;
use crate::gear::mesh::answers::contact_law_error::{Cause, ContactLawError};
use crate::gear::modification::{Modification, NamedModification};

fn resolved() -> PairCompliance {
    let mut compliance = PairCompliance { contact: Some(ContactLaw::Resolved), ..varying() };
    for tooth in [&mut compliance.pinion, &mut compliance.gear] {
        tooth.contact_depth = crate::numeric::chebyshev::Series::from_values(0.0, 2.0, &[0.75e-3]);
    }
    compliance
}

fn doubt(pair: &GearPair, compliance: &PairCompliance, design: &Design, torque: f64) -> ContactLawError {
    let cycle = cycle(pair, compliance);
    let loading = cycle.loaded(design, torque);
    loading.contact_law_error().unwrap()
}

/// Tier: invariant; narrow contacts are in no doubt, wide ones are, and the more the wider they are. Nothing is said without a
/// load, or of a law that knows no width.
#[test]
fn wide_contacts_are_in_doubt() {
    let (pair, none) = (pair(), Design::default());
    let mut before = 0.0;
    for (torque, matters) in [(2.0, false), (20.0, false), (500.0, true), (2000.0, true), (20_000.0, true)] {
        let found = doubt(&pair, &resolved(), &none, torque);
        assert_eq!(found.matters(), matters, "{torque}: {found:?}");
        let by_width = (found.size - found.by_shape) / found.approach;
        assert!(by_width > 1.3 * before, "{torque}: {found:?}");
        before = by_width;
    }
    // By its tangent the law is less off than by what a contact four times as wide may be.
    assert!((0.005..0.3).contains(&before), "{before}");
    let weber = PairCompliance { contact: Some(ContactLaw::LoadDependent), ..varying() };
    assert!(!doubt(&pair, &weber, &none, 20.0).matters() && doubt(&pair, &weber, &none, 50_000.0).matters());
    for (compliance, torque) in [(varying(), 500.0), (resolved(), 0.0)] {
        let cycle = cycle(&pair, &compliance);
        assert!(cycle.loaded(&none, torque).contact_law_error().is_none());
    }
}

/// Tier: closed form; a profile crowning bends both flanks evenly along the path, so that ρ is another one and the approach
/// differs by k₀ p/2 times the logarithm of their ratio.
#[test]
fn a_crown_is_another_radius() {
    let (pair, compliance) = (pair(), resolved());
    let crown = design(&pair, &[("profile_crowning", "both", &[("amount", Quantity(60e-6))])]).unwrap();
    let found = doubt(&pair, &compliance, &crown, 50.0);
    assert_eq!(found.cause, Cause::Shape, "{found:?}");
    assert!(found.matters());
    // The crown over half of the path, bent by twice that over its square; along the flank u times as long as the path.
    let half = 0.5 * (pair.end_of_contact - pair.start_of_contact);
    let (s, line_load) = (0.5 * (pair.start_of_contact + pair.end_of_contact), 50.0 / pair.pinion.base_radius / 18e-3);
    let bodies = crate::gear::contact::flattening::Bodies::of(&pair, compliance.plane);
    let bend: f64 =
        [Side::Pinion, Side::Gear].map(|side| 2.0 * 60e-6 / (half * half) / pair.roll(side, s).powi(2)).iter().sum();
    let radius = crate::gear::contact::flattening::combined_radius([s, pair.tangent_length - s]);
    let exact = 0.5 * (1.0 + bend * radius).ln() * bodies.linear() * line_load;
    assert!(found.by_shape > 0.7 * exact && found.by_shape < 2.0 * exact, "{found:?} {exact}");
}

/// Flanks with crests, as machining leaves them.
#[derive(Debug)]
struct Wave {
    height: f64,
    length: f64,
}

impl Modification for Wave {
    fn depth(&self, roll: f64) -> f64 {
        0.5 * self.height * (1.0 - libm::cos(TAU * roll / self.length))
    }

    fn varies_along_profile(&self) -> bool {
        true
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }
}

/// Tier: invariant; between the crests of a wave the flanks touch at both, and no farther apart than crests are.
#[test]
fn two_touches_are_told() {
    let (pair, compliance) = (pair(), resolved());
    let mut waved = Design::default();
    let length = 0.034;
    waved.pinion.push(NamedModification { family: "wave", modification: Arc::new(Wave { height: 1.5e-6, length }) });
    assert!(doubt(&pair, &compliance, &waved, 100.0).matters());
    let cycle = cycle(&pair, &compliance);
    let loading = cycle.loaded(&waved, 100.0);
    let mut told = 0;
    for position in (0..40).map(|k| 4e-3 + 0.08e-3 * f64::from(k)) {
        let found = loading.contact_law_error_at(position, 2).unwrap();
        // Where the line of action meets a crest the contact is only narrower than the law has it.
        if let Cause::TwoTouches(apart) = found.cause {
            told += 1;
            // The flank is u times as long as the wave.
            let crest = length * cycle.path_position(position, 0);
            assert!(apart > 0.6 * crest && apart < 1.1 * crest, "{found:?} {crest}");
        }
    }
    assert!(told >= 8, "{told}");
}

/// Tier: invariant; a steep relief that begins in a knee is told, a gentle one is not.
#[test]
fn a_knee_is_told() {
    let (pair, compliance) = (pair(), resolved());
    for (amount, length, told) in [(2e-6, 5e-3, false), (60e-6, 2e-3, true)] {
        let values = [("amount", Quantity(amount)), ("length", Quantity(length)), ("curve", Choice("linear"))];
        let relieved = design(&pair, &[("tip_relief", "both", &values)]).unwrap();
        let found = doubt(&pair, &compliance, &relieved, 100.0);
        assert_eq!(found.by_shape > 1e-2 * found.approach, told, "{amount}: {found:?}");
    }
}

/// Tier: invariant; where contact begins beside the base circle, a contact is wider than the flank is long down to it.
#[test]
fn contact_beside_the_base_circle_is_told() {
    let gear = |teeth| Specification {
        teeth,
        module: 3e-3,
        pressure_angle: 20_f64.to_radians(),
        profile_shift: 0.0,
        thickness_allowance: 0.0,
        cutter: None,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A },
        tip_radius: None,
        face_width: 18e-3,
        bore_radius: 12e-3,
        material: Material::STEEL,
    };
    let pair = GearPair::new(gear(17), gear(150), None).unwrap();
    let found = [10.0, 100.0, 1000.0].map(|torque| doubt(&pair, &resolved(), &Design::default(), torque));
    // It is the narrow ones that are so near to it; of the widest the width says more.
    assert!(
        found[..2].iter().all(|found| found.cause == Cause::BaseCircle(Side::Pinion) && found.matters()),
        "{found:?}"
    );
    assert!(found[2].cause == Cause::Width && found[2].matters(), "{found:?}");
}

/// Tier: second method; flanks are pressed together only where most is expected, and the worst of all positions is found.
#[test]
fn no_position_is_in_more_doubt_than_is_told() {
    let pair = pair();
    let (mut told, mut quiet) = (0, 0);
    for compliance in [resolved(), PairCompliance { contact: Some(ContactLaw::LoadDependent), ..varying() }] {
        let cycle = cycle(&pair, &compliance);
        for (amount, length, curve) in
            [(2e-6, 5e-3, "linear"), (10e-6, 4e-3, "parabolic"), (60e-6, 2e-3, "linear"), (90e-6, 4e-3, "parabolic")]
        {
            let values = [("amount", Quantity(amount)), ("length", Quantity(length)), ("curve", Choice(curve))];
            let relieved = design(&pair, &[("tip_relief", "both", &values)]).unwrap();
            for torque in [1.0, 30.0, 300.0] {
                let loading = cycle.loaded(&relieved, torque);
                let found = loading.contact_law_error().unwrap();
                let places = cycle.zones.iter().flat_map(|zone| {
                    let place = |share: f64| (zone.start + (zone.end - zone.start) * share, zone.pairs);
                    [0.0, 0.25, 0.5, 0.75, 1.0].map(place)
                });
                for (position, pairs) in places {
                    let here = loading.contact_law_error_at(position, pairs).unwrap();
                    assert!(
                        here.size <= found.size * (1.0 + 1e-12),
                        "{amount} {torque} {position}: {here:?} {found:?}"
                    );
                    assert!(found.matters() || !here.matters(), "{amount} {torque} {position}: {here:?} {found:?}");
                }
                if found.matters() { told += 1 } else { quiet += 1 }
            }
        }
    }
    assert!(told >= 4 && quiet >= 4, "{told} {quiet}");
}
