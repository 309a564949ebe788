//! Keys do not change by accident.

use super::*;
use crate::runner::graph::Graph;
use crate::runner::graph::code;
use crate::runner::key::Parts;
use crate::stage::Demand;
use crate::store::bundle::MANY;
use declare::digest::Digest;
use declare::seed::Seed;

fn parts<'a>(record: &'a Record, demand: &'a Demand) -> Parts<'a> {
    Parts {
        code: code(&CUT, "code"),
        record,
        rows: vec!["torque"],
        shared: None,
        inputs: vec![("pair".to_owned(), Digest([7; 32]))],
        seed: Some(Seed::of_stage(1, "ste")),
        demand,
    }
}

fn record() -> Record {
    let entry = |value| PlacedValue { value, place: Place::default() };
    let fields = vec![
        ("value", entry(Value::Quantity(0.25))),
        ("torque", entry(Value::Axis(vec![25.0, 50.0]))),
        ("mode", entry(Value::Choice("iso"))),
    ];
    Record { fields, place: Place::default() }
}

fn demand() -> Demand {
    Demand { tables: [("values".to_owned(), ["extra".to_owned()].into())].into() }
}

/// If this fails, every cache in the world is void: nobody's results change, but all is computed again. When that is
/// meant (another digest, another part of the key), put the new digests here and say so in the change log; when it is
/// not, something that should not be in a key has got into it, or something that should is gone.
#[test]
fn golden_keys() {
    let (record, demand) = (record(), demand());
    let parts = parts(&record, &demand);
    let digests = [&[][..], &[25.0], &[25.0, 50.0]].map(|values| parts.record(Some(values)).key.short());
    assert_eq!(digests, ["383d39fe2cd4", "aa4c0e25e7d2", "19a87f545dd4"]);
    let whole = Parts { rows: Vec::new(), seed: None, inputs: Vec::new(), ..parts };
    assert_eq!(whole.record(None).key.short(), "c84a8d1a4ec7");
}

#[test]
fn every_part_is_in_the_key_and_has_a_name() {
    use crate::runner::key::{Why, explain};
    let (record, demand) = (record(), demand());
    let base = || parts(&record, &demand);
    let last = [base().record(Some(&[25.0]))];
    let why = |parts: Parts, values: &[f64]| {
        let now = parts.record(Some(values));
        assert_ne!(now.key, last[0].key);
        explain(&last, &now, Some("torque"))
    };
    let mut other = record.clone();
    other.fields[0].1.value = Value::Quantity(0.5);
    assert_eq!(why(Parts { record: &other, ..base() }, &[25.0]), [Why::Config(vec!["value".to_owned()])]);
    other.fields.remove(0);
    assert_eq!(why(Parts { record: &other, ..base() }, &[25.0]), [Why::Config(vec!["value".to_owned()])]);
    assert_eq!(why(base(), &[50.0]), [Why::Axis("torque")]);
    assert_eq!(why(Parts { code: code(&CUT, "new"), ..base() }, &[25.0]), [Why::Code]);
    assert_eq!(why(Parts { code: code(&PLAIN, "code"), ..base() }, &[25.0]), [Why::Code]);
    assert_eq!(why(Parts { seed: None, ..base() }, &[25.0]), [Why::Seed]);
    assert_eq!(why(Parts { demand: &Demand::default(), ..base() }, &[25.0]), [Why::Demand]);
    let inputs = vec![("pair".to_owned(), Digest([8; 32]))];
    assert_eq!(why(Parts { inputs, ..base() }, &[25.0]), [Why::Input("pair".to_owned())]);
    let inputs = vec![("gear".to_owned(), Digest([7; 32]))];
    let both = [Why::Input("gear".to_owned()), Why::Input("pair".to_owned())];
    assert_eq!(why(Parts { inputs, ..base() }, &[25.0]), both);
    assert_eq!(explain(&[], &last[0], None), [Why::NeverRan]);
    // Where something stands in the file is in no key.
    let mut moved = record.clone();
    moved.fields[0].1.place = Place { line: 9, column: 9, offset: 99, length: 9 };
    assert_eq!(parts(&moved, &demand).record(Some(&[25.0])), last[0]);
}

static DRAWN: Program = Program {
    pictures: Pictures { reader: "report", tables: &[("plain", &["sketch", "detail"])] },
    kinds: &[],
    foreign: &[],
    derived: &[],
    named: &[],
    code_of: |_| String::from("code"),
    counters: &[],
    about: ABOUT,
};

/// What is drawn although nobody asked for it takes no more where there are thousands of stages: of 5,000 it took minutes.
#[test]
fn tables_are_added_for_figures_of_a_few_stages_alone() {
    let names: Vec<&'static str> = (0..=MANY).map(|index| &*Box::leak(format!("m{index}").into_boxed_str())).collect();
    let bench = Bench { program: &DRAWN, ..Bench::new() };
    let drawn = |count: usize| {
        let specs: Vec<Spec> = names[..count].iter().map(|name| stage(name, 1.0)).collect();
        let graph = Graph::new(&bench.study(&specs), &[]).unwrap();
        graph.demands.iter().filter(|demand| demand.table("detail")).count()
    };
    assert_eq!([1, MANY, MANY + 1].map(drawn), [1, MANY, 0]);
}
