//! A restricted summary agrees with the whole one.

use super::super::answers::needs::Needs;
use super::*;
use crate::gear::contact::CornerContact;
use crate::gear::mesh::answers::curve::Summary;

const ALL: Needs = Needs {
    integrals: true,
    harmonics: 3,
    spans_for: 8,
    pressure: true,
    unloaded: true,
    load_sharing: false,
    root_stress: false,
};

fn bits(found: &Summary) -> [u64; 7] {
    let pressure = found.largest_pressure.map_or(0.0, |pressure| pressure.extremum.value);
    let values = [
        found.largest.value,
        found.smallest.value,
        found.mean,
        found.variance,
        found.harmonics.iter().take(3).sum(),
        pressure,
        found.unloaded_peak_to_peak,
    ];
    values.map(f64::to_bits)
}

/// Tier: second method, to the last bit: another torque on gaps that were found for one, and gaps of its own.
#[test]
fn another_torque_leaves_the_gaps_as_they_are() {
    let pair = pair();
    for compliance in [constant(&pair, STIFFNESS), varying(), coupled()] {
        for corner_contact in [CornerContact::None, CornerContact::Exact] {
            let settings = Settings { positions: 8, corner_contact, ..Settings::default() };
            let cycle = Mesh::new(&pair, &compliance, settings).unwrap();
            for design in [Design::default(), ga_design(&pair, 8e-6, 4e-3, 5e-6)] {
                for first in [0.0, 700.0] {
                    for force in [0.0, 300.0, 701.0, 1867.0] {
                        let mut known = cycle.design(&design);
                        let [_, shared] = [first, force].map(|force| known.under(torque(force)));
                        let own = cycle.loaded(&design, torque(force));
                        let case = format!("{corner_contact:?}, {first}, then {force}");
                        assert_eq!(bits(&shared.summary_of(ALL)), bits(&own.summary_of(ALL)), "{case}");
                        assert_eq!(
                            shared.case.largest_approach().to_bits(),
                            own.case.largest_approach().to_bits(),
                            "{case}"
                        );
                    }
                }
            }
        }
    }
}

/// Tier: second method, to the last bit.
#[test]
fn what_is_asked_is_what_the_summary_has() {
    let pair = pair();
    for compliance in [constant(&pair, STIFFNESS), varying(), coupled()] {
        for positions in [8, 64] {
            let settings = Settings { positions, ..Settings::default() };
            let cycle = Mesh::new(&pair, &compliance, settings).unwrap();
            for design in [Design::default(), ga_design(&pair, 8e-6, 4e-3, 5e-6)] {
                for force in [0.0, 300.0, 1867.0] {
                    let loading = cycle.loaded(&design, torque(force));
                    let wanted = Wanted { harmonics: 8, pressure: true, ..Wanted::default() };
                    let summary = loading.summary(wanted);
                    assert_eq!(bits(&loading.summary_of(ALL)), bits(&summary), "{positions}, {force}");
                    // What is left out changes nothing of the rest.
                    let fewer = loading.summary_of(Needs { harmonics: 0, pressure: false, unloaded: false, ..ALL });
                    let less = Summary {
                        harmonics: Vec::new(),
                        largest_pressure: None,
                        unloaded_peak_to_peak: f64::NAN,
                        ..summary
                    };
                    assert_eq!(bits(&fewer), bits(&less));
                    let extremes = loading.summary_of(Needs::default());
                    let apart = extremes.largest.value - extremes.smallest.value;
                    assert_eq!(apart.to_bits(), loading.peak_to_peak().to_bits());
                }
            }
        }
    }
}
