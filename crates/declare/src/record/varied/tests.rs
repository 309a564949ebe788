//! Slots, own values, and what of varied fields is in which digest.

use super::*;
use crate::units::LENGTH;

type Change<'a> = &'a dyn Fn(&mut Varied);

fn at(line: usize) -> Place {
    Place { line, ..Place::default() }
}

fn entry(value: Value, line: usize) -> PlacedValue {
    PlacedValue { value, place: at(line) }
}

fn record() -> Record {
    let relief = Record { fields: vec![("amount", entry(Value::Quantity(1e-6), 7))], place: at(6) };
    let design = Value::List(vec![entry(Value::Flag(true), 5), entry(Value::Member("relief", relief), 6)]);
    let designs = Value::Map(vec![("a".into(), entry(Value::List(vec![]), 3)), ("b".into(), entry(design, 4))]);
    Record {
        fields: vec![("pair", entry(Value::Reference("p".into()), 1)), ("designs", entry(designs, 2))],
        place: at(0),
    }
}

fn axis() -> Axis {
    Axis {
        name: "amount".into(),
        path: "s.designs.b[1].relief.amount".into(),
        place: at(9),
        stage: 0,
        slot: Slot(vec![1, 1, 1, 0]),
        dimension: Some(LENGTH),
        unit: "um".into(),
        multiple: None,
        values: Values::Each(vec![1e-6, 2e-6]),
        values_place: at(9),
        range: (0.0, 1e-3),
    }
}

#[test]
fn a_slot_leads_to_the_value_at_a_place_and_nowhere_else() {
    let mut record = record();
    let slot = Slot::of_place(&record, at(7)).unwrap();
    assert_eq!(slot, axis().slot);
    assert_eq!(slot.entry(&record).map(|entry| &entry.value), Some(&Value::Quantity(1e-6)));
    assert_eq!(slot.path(&record), ".designs.b[1].relief.amount");
    axis().put(&mut record, 5e-6);
    assert_eq!(slot.entry(&record).map(|entry| &entry.value), Some(&Value::Quantity(5e-6)));
    assert_eq!(Slot::of_place(&record, at(8)), None);
    assert_eq!(Slot::of_place(&record, at(6)), None, "a member is no value");
    assert_eq!(Slot(vec![1, 2, 0]).entry(&record), None);
    assert!(Slot(vec![0, 1]).entry_mut(&mut record).is_none() && Slot::default().entry(&record).is_none());
}

#[test]
fn the_study_s_own_value_is_found_whatever_it_leaves_out() {
    // The study says neither `length`, which is varied too, nor `pair`; of what is varied the last comes after both.
    let mut filled = record();
    let Some(entry) = Slot(vec![1, 1, 1]).entry_mut(&mut filled) else { panic!("there is a relief") };
    if let Value::Member(_, relief) = &mut entry.value {
        relief.fields.insert(0, ("length", self::entry(Value::Quantity(3e-3), 8)));
    }
    let mut own = record();
    own.fields.remove(0);
    let slots = [Slot(vec![1, 1, 1, 0]), Slot(vec![1, 1, 1, 1])];
    let stage = Stage { name: "s".into(), kind: "k", record: own, filled, reads: vec![] };
    let varied = Varied { stages: vec![stage], ..Varied::default() };
    let found = slots.map(|slot| varied.own(&Axis { slot, ..axis() }));
    assert_eq!(found, [None, Some(1e-6)]);
}

#[test]
fn values_are_in_the_digest_of_all_and_not_in_that_of_what_is_shared() {
    let varied = |first: f64, values: Vec<f64>| {
        let mut filled = record();
        axis().put(&mut filled, first);
        let stage = Stage { name: "s".into(), kind: "k", record: record(), filled, reads: vec![None] };
        Varied { stages: vec![stage], axes: vec![Axis { values: Values::Each(values), ..axis() }], ..Varied::default() }
    };
    let digests = |varied: &Varied| {
        let (mut shared, mut all) = (Writer::new("test"), Writer::new("test"));
        varied.write_shared(&mut shared);
        varied.write(&mut all);
        (shared.finish(), all.finish())
    };
    let (one, two) = (varied(1e-6, vec![1e-6, 2e-6]), varied(3e-6, vec![3e-6]));
    assert_eq!(digests(&one).0, digests(&two).0);
    assert_ne!(digests(&one).1, digests(&two).1);
    let mut other = one.clone();
    other.stages[0].filled.fields.pop();
    assert_ne!(digests(&one).0, digests(&other).0);
    let mut renamed = one.clone();
    renamed.stages[0].name = "t".into();
    assert_eq!(digests(&one).0, digests(&renamed).0, "rows do not show the names of stages");
}

/// Everything that a stage can read of it, beside places and what follows from declarations.
#[test]
fn whatever_a_stage_can_read_is_in_the_digest_of_all() {
    let stage =
        |name: &str| Stage { name: name.into(), kind: "k", record: record(), filled: record(), reads: vec![None] };
    let axes = [axis(), Axis { name: "again".into(), place: at(10), ..axis() }];
    let varied = Varied { stages: vec![stage("s")], axes: axes.into(), ..Varied::default() };
    let digest = |varied: &Varied| {
        let mut writer = Writer::new("test");
        varied.write(&mut writer);
        writer.finish()
    };
    let changes: [(&str, Change); 9] = [
        ("own value", &|varied| axis().put(&mut varied.stages[0].record, 9e-6)),
        ("name of a stage", &|varied| varied.stages[0].name = "t".into()),
        ("field of a stage", &|varied| drop(varied.stages[0].record.fields.remove(0))),
        ("what a stage reads", &|varied| varied.stages[0].reads = vec![Some(0)]),
        ("path", &|varied| varied.axes[0].path = "t.amount".into()),
        ("unit", &|varied| varied.axes[0].unit = "mm".into()),
        ("one number for two", &|varied| varied.axes[1].place = varied.axes[0].place),
        ("nearby stages", &|varied| varied.nearby = vec![("k", record())]),
        ("held stages", &|varied| varied.held = vec!["h".into()]),
    ];
    for (what, change) in changes {
        let mut other = varied.clone();
        change(&mut other);
        assert_ne!(digest(&varied), digest(&other), "{what}");
    }
}
