//! What the comparison says, held to hand-made values.

#![allow(clippy::float_cmp)] // where a result must be exact, that is what is asked

use super::quantity::{Value, distance};
use super::trial::quantile;
use super::variant::{Variant, inputs, ports};
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Port, Stage};
use declare::error::{Failure, Place};
use declare::record::{self, PlacedValue, Record};
use studygraph::table::data::Table;
use studygraph::table::schema::Schema;

fn rows(values: &[(&str, f64)]) -> Vec<Value> {
    values.iter().map(|(row, value)| Value { row: (*row).to_owned(), value: *value }).collect()
}

#[test]
fn the_row_farthest_off_counts() {
    let reference = rows(&[("a=1", 100.0), ("a=2", 1.0), ("a=3", f64::NAN)]);
    let found = distance(&rows(&[("a=1", 101.0), ("a=2", 0.98), ("a=3", f64::NAN)]), &reference).unwrap();
    assert_eq!(found.row, "a=2");
    assert!((found.relative() - 0.02).abs() < 1e-15 && (found.absolute() - 0.02).abs() < 1e-15);
    // What is missing on one side only is not agreement.
    let found = distance(&rows(&[("a=1", 101.0), ("a=2", 0.98), ("a=3", 5.0)]), &reference).unwrap();
    assert!(found.row == "a=3" && found.rank().is_infinite());
    let found = distance(&rows(&[("", 1e-9)]), &rows(&[("", 0.0)])).unwrap();
    assert!(found.relative().is_nan() && found.absolute() == 1e-9 && found.rank().is_infinite());
    assert!(distance(&rows(&[("a=1", 1.0)]), &reference).unwrap_err().contains("1 row against 3"));
    assert!(distance(&rows(&[("a=1", 1.0), ("a=2", 1.0), ("a=4", 1.0)]), &reference).is_err());
}

#[test]
fn quantiles_lie_between_values() {
    let mut values = [4.0, 1.0, 3.0, 2.0];
    let found = [0.0, 0.25, 0.5, 1.0].map(|share| quantile(&mut values, share));
    assert_eq!(found, [1.0, 1.75, 2.5, 4.0]);
    assert_eq!(quantile(&mut [7.0], 0.5), 7.0);
    assert!(quantile(&mut [], 0.5).is_nan());
}

/// A stage that only reads.
struct Reader(Vec<Port>);

impl Stage for Reader {
    fn inputs(&self) -> Vec<Port> {
        self.0.clone()
    }

    fn outputs(&self) -> Vec<Schema> {
        Vec::new()
    }

    fn estimate(&self, _: &Demand, _: &Ahead) -> Estimate {
        Estimate::default()
    }

    fn run(&self, _: &Context, _: &Inputs) -> Result<Vec<Table>, Failure> {
        Ok(Vec::new())
    }
}

fn variant(label: &str, reads: &[(&str, &str)], fields: Vec<(&'static str, record::Value)>) -> Variant {
    let ports = reads.iter().map(|(port, stage)| Port::tables(*port, *stage, &["t"])).collect();
    let fields =
        fields.into_iter().map(|(name, value)| (name, PlacedValue { value, place: Place::default() })).collect();
    Variant {
        label: label.to_owned(),
        written: String::new(),
        stage: Box::new(Reader(ports)),
        record: Record { fields, place: Place::default() },
    }
}

/// Two variants that swap what they read give other ports, and each finds its own under the name it knows.
#[test]
fn ports_say_whose_they_are_unless_all_agree() {
    let common = ("pair", "pair");
    let of = |own: [&str; 2]| {
        let one = variant("one 1", &[common, ("stiffness", own[0])], Vec::new());
        let two = variant("one 2", &[common, ("stiffness", own[1])], Vec::new());
        ports(&[&one, &two])
    };
    let names = |own| of(own).into_iter().map(|(port, _)| (port.name, port.stage)).collect::<Vec<_>>();
    let pair = |name: &str, stage: &str| (name.to_owned(), stage.to_owned());
    assert_eq!(names(["k", "k"]), [pair("pair", "pair"), pair("stiffness", "k")]);
    let swapped = [pair("pair", "pair"), pair("stiffness of one 1", "k"), pair("stiffness of one 2", "l")];
    assert_eq!(names(["k", "l"]), swapped);
    let table = Table::from_rows(Schema::new("t", "", Vec::new()), Vec::new()).unwrap();
    let mut all = Inputs::default();
    all.ports.insert("pair".to_owned(), Vec::new());
    all.ports.insert("stiffness of one 2".to_owned(), vec![&table]);
    let own = inputs(&of(["k", "l"]), 1, &all);
    assert_eq!(own.ports.keys().collect::<Vec<_>>(), ["pair", "stiffness"]);
    assert_eq!(own.ports["stiffness"].len(), 1);
    assert!(inputs(&of(["k", "l"]), 0, &all).ports["stiffness"].is_empty());
}

#[test]
fn an_order_is_observed_only_where_one_number_was_changed() {
    use record::Value::{Choice, Flag, Integer, Member, Quantity};
    let of = |fields| variant("", &[], fields);
    let member = |name, value| {
        let fields =
            vec![("points", PlacedValue { value: Integer(value), place: Place { line: 3, ..Place::default() } })];
        ("method", Member(name, Record { fields, place: Place { line: 7, ..Place::default() } }))
    };
    let coarse = of(vec![member("a", 8), ("word", Choice("x")), ("length", Quantity(2e-3))]);
    let refined = |fields| of(fields).refined(&coarse);
    assert_eq!(refined(vec![member("a", 16), ("word", Choice("x")), ("length", Quantity(2e-3))]), Some((8.0, 16.0)));
    assert_eq!(refined(vec![member("a", 8), ("word", Choice("x")), ("length", Quantity(1e-3))]), Some((2e-3, 1e-3)));
    assert_eq!(refined(vec![member("a", 16), ("word", Choice("x")), ("length", Quantity(1e-3))]), None);
    assert_eq!(refined(vec![member("a", 16), ("word", Choice("y")), ("length", Quantity(2e-3))]), None);
    assert_eq!(refined(vec![member("b", 16), ("word", Choice("x")), ("length", Quantity(2e-3))]), None);
    assert_eq!(
        refined(vec![member("a", 8), ("word", Choice("x")), ("length", Quantity(2e-3))]),
        None,
        "nothing changed"
    );
    let more = vec![member("a", 16), ("word", Choice("x")), ("length", Quantity(2e-3)), ("more", Flag(true))];
    assert_eq!(refined(more), None);
}
