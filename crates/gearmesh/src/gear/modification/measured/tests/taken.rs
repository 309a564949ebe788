//! Who takes a trace like any family: finite elements, and a search that varies something beside it.

use super::*;
use crate::gear::compliance::finite_element::FiniteElement;
use crate::gear::compliance::{Assumptions, Method};
use crate::gear::fixtures::standard;
use crate::gear::modification::template::Template;
use declare::declared::{Registrable, Words, entry};
use declare::record::{PlacedValue, Value};

/// Tier: second method; a trace of crowning is that crowning to finite elements and their resolved contact.
#[test]
fn finite_elements_take_a_trace() {
    let [pinion, gear] = [19, 48].map(|teeth| standard(teeth, 3e-3, 1.6));
    let pair = GearPair::new(pinion, gear, None).unwrap();
    let method = FiniteElement { elements_across: 12, ..FiniteElement::default() };
    let assumptions = Assumptions { contact: ContactLaw::Resolved, ..Assumptions::default() };
    let compliance = method.tabulate(&pair, assumptions).unwrap().compliance;
    let plain = crowned(&pair);
    let trace = traced(&pair, &plain, 500);
    for corner_contact in [CornerContact::None, CornerContact::Exact] {
        let settings = Settings { positions: 8, corner_contact, ..Settings::default() };
        let cycle = Mesh::new(&pair, &compliance, settings).unwrap();
        let off = off(&cycle, [&trace, &plain], 150.0);
        assert!(off < 1e-7, "{corner_contact:?}: {off:e}");
    }
}

/// A member of a family for both gears, or for one of them.
fn member(gears: Gears, family: &impl Registrable) -> PlacedValue {
    let Value::Member(name, mut record) = family.member() else { unreachable!("a member") };
    record.fields.insert(0, ("gear", entry(Value::Choice(gears.word()))));
    entry(Value::Member(name, record))
}

/// Tier: second method; what a search sees of a relief whose amount it varies is the same beside a crowning and beside its trace.
#[test]
fn a_search_varies_a_relief_beside_a_trace() {
    let (pair, compliance) = (pair(), varying());
    let cycle = Mesh::new(&pair, &compliance, Settings::default()).unwrap();
    let plain = crowned(&pair);
    let mut open = member(Gears::Both, &relief(1e-6, 4e-3, SMOOTH));
    let Value::Member(_, record) = &mut open.value else { unreachable!("a member") };
    for (name, field) in &mut record.fields {
        if *name == "amount" {
            field.value = Value::Range(0.0, 30e-6);
        }
    }
    let traces = SIDES.map(|(gears, side)| member(gears, &profile(&pair, side, 500, |roll| -plain.depth(side, roll))));
    let crowning = member(Gears::Both, &ProfileCrowning { amount: 9e-6 });
    let [by_trace, by_crowning] = [traces.to_vec(), vec![crowning]].map(|mut parts| {
        parts.push(open.clone());
        Template::new(&parts).unwrap()
    });
    assert_eq!(by_trace.variables(), by_crowning.variables());
    for amount in [0.0, 4e-6, 11e-6, 23e-6] {
        let [one, other] = [&by_trace, &by_crowning].map(|template| {
            let design = template.on(&pair).design(&[amount]).unwrap();
            cycle.loaded(&design, 150.0).peak_to_peak()
        });
        assert!((one - other).abs() < 1e-7 * other, "{amount}: {one:e} {other:e}");
    }
}
