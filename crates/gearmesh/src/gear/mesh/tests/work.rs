//! What is not needed is not computed: slices, pressures, the second half of what is even. Counted, not timed.

use super::*;
use crate::gear::contact::SliceCoupling;
use crate::gear::fixtures::NamedModification;
use crate::gear::mesh::answers::curve::Summary;
use crate::gear::work::{CONTACT_PRESSURES, CONTACT_SOLVES, SLICES};

const TORQUE: f64 = 50.0;

/// The summary of a design on a cycle of its own, and what it took.
fn counted(
    contact: ContactLaw,
    settings: Settings,
    parts: &[NamedModification],
    pressure: bool,
) -> (Summary, [u64; 3]) {
    let pair = pair();
    let cycle = Mesh::new(&pair, &PairCompliance { contact: Some(contact), ..varying() }, settings).unwrap();
    let design = design(&pair, parts).unwrap();
    let summary = cycle.loaded(&design, TORQUE).summary(Wanted { harmonics: 2, pressure, ..Wanted::default() });
    let work = cycle.work();
    (summary, [&SLICES, &CONTACT_SOLVES, &CONTACT_PRESSURES].map(|counter| work.count(counter)))
}

fn amount(value: f64) -> (&'static str, declare::record::Value) {
    ("amount", Quantity(value))
}

#[test]
fn a_face_is_cut_into_slices_only_where_no_closed_form_exists() {
    let settings = Settings { slices: 9, ..Settings::default() };
    let crown = [amount(8e-6)];
    let ends = [amount(8e-6), ("length", Quantity(5e-3)), ("curve", Choice("power")), ("exponent", Number(1.7))];
    let slices = |contact, parts: &[NamedModification]| counted(contact, settings, parts, false).1[0];
    for contact in [ContactLaw::Linear, ContactLaw::LoadDependent] {
        assert_eq!(slices(contact, &[]), 1, "nothing varies across the face");
        assert_eq!(slices(contact, &[("tip_relief", "both", &[amount(8e-6), ("fraction", Quantity(0.5))])]), 1);
    }
    assert_eq!(slices(ContactLaw::Linear, &[("lead_crowning", "pinion", &crown)]), 1, "the closed form");
    assert_eq!(slices(ContactLaw::LoadDependent, &[("lead_crowning", "pinion", &crown)]), 9, "half of the face");
    // Two ends and the middle, 9 slices each, of which the first 14 stand for all 27.
    assert_eq!(slices(ContactLaw::Linear, &[("end_relief", "gear", &ends)]), 14);
    let plate = Settings { slice_coupling: SliceCoupling::Plate, ..settings };
    assert_eq!(counted(ContactLaw::Linear, plate, &[], false).1[0], 1);
    assert_eq!(counted(ContactLaw::Linear, plate, &[("lead_crowning", "pinion", &crown)], false).1[0], 5);
}

#[test]
fn pressures_are_found_only_when_asked_for() {
    for contact in [ContactLaw::Linear, ContactLaw::LoadDependent] {
        let (without, [_, solves, none]) = counted(contact, Settings::default(), &[], false);
        let (with, [_, more, some]) = counted(contact, Settings::default(), &[], true);
        assert!(none == 0 && without.largest_pressure.is_none());
        assert!(some > 64 && more >= solves && with.largest_pressure.is_some());
        assert_eq!(with.peak_to_peak, without.peak_to_peak);
    }
}

/// Tier: invariant. A slope of nothing makes a face that is even into one that is not for all the program knows: the same
/// numbers with twice the slices.
#[test]
fn half_of_an_even_face_stands_for_both() {
    let crown = [amount(30e-6)];
    let ends = [amount(30e-6), ("length", Quantity(5e-3)), ("curve", Choice("power")), ("exponent", Number(1.7))];
    let nothing = [amount(1e-300)];
    for (coupling, counts) in [(SliceCoupling::None, [9, 10]), (SliceCoupling::Plate, [9, 10])] {
        for contact in [ContactLaw::Linear, ContactLaw::LoadDependent] {
            for (part, slices) in [("lead_crowning", counts[0]), ("end_relief", counts[1]), ("end_relief", counts[0])] {
                let settings = Settings { slices, slice_coupling: coupling, ..Settings::default() };
                let values: &[_] = if part == "lead_crowning" { &crown } else { &ends };
                let even: Vec<NamedModification> = vec![(part, "pinion", values)];
                let not_even: Vec<NamedModification> = vec![even[0], ("helix_slope", "gear", &nothing)];
                let (half, [few, ..]) = counted(contact, settings, &even, true);
                let (whole, [many, ..]) = counted(contact, settings, &not_even, true);
                let expected = if many == 1 { 1 } else { many.div_ceil(2) };
                assert_eq!(few, expected, "{coupling:?} {contact:?} {part} {slices}: {many}");
                assert!(many > 1 || contact == ContactLaw::Linear);
                close(half.mean, whole.mean, 1e-12);
                close(half.peak_to_peak, whole.peak_to_peak, 1e-9);
                close(half.variance, whole.variance, 1e-9);
                let pressure = |summary: &Summary| summary.largest_pressure.unwrap().extremum.value;
                close(pressure(&half), pressure(&whole), 1e-9);
            }
        }
    }
}
