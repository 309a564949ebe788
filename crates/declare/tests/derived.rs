//! What the derives make of a struct and an enum, against declarations written by hand.

#![allow(clippy::float_cmp, reason = "values are copied, not computed")]

use std::fmt::Debug;

use declare::declared::{Declared, Placed, Registrable, Words, entry, record_of};
use declare::digest::Writer;
use declare::error::Place;
use declare::parameter::{Field, Presence, Shape, Span};
use declare::record::{PlacedValue, Record, Value, Variant};
use declare::units::LENGTH;
use declare::{Alternatives, Declared, Tagged, Words, registry};

/// Where a search starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
enum Start {
    /// the middle of every range
    Centre,
    /// a random point,
    /// from the seed
    ///
    /// Not for users.
    AtRandom,
}

/// what holds the ends
#[derive(Clone, Debug, PartialEq, Declared)]
struct Ends {
    /// whether both are held
    #[declared(default = "true")]
    pub both: bool,
}

/// a search that exists only here
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "toy")]
struct Toy {
    /// individuals
    #[declared(minimum = 2, maximum = 100, multiple = 2, default = "10")]
    pub population: u32,
    /// first step
    #[declared(minimum = 0.0, maximum = 1e-3, dimension = LENGTH, default = "30 um", range)]
    pub step: f64,
    /// where it starts
    #[declared(default = "centre")]
    pub start: Start,
    /// patience
    #[declared(minimum = 1, maximum = 9)]
    pub patience: Option<usize>,
    /// levels
    #[declared(minimum = 2, maximum = 50, default = "11")]
    pub levels: Vec<usize>,
    /// the ends
    #[declared(default = "{}")]
    pub ends: Ends,
}

fn written(record: &Record) -> String {
    let mut writer = Writer::new("test");
    record.write(&mut writer);
    writer.finish().to_string()
}

#[test]
fn a_struct_declares_what_a_table_of_fields_would() {
    let Toy { .. } = Toy::default();
    let member = Toy::MEMBER;
    assert_eq!((member.name, member.summary), ("toy", "a search that exists only here"));
    let names: Vec<_> = member.fields.iter().map(|field| field.name).collect();
    assert_eq!(names, ["population", "step", "start", "patience", "levels", "ends"]);
    let by_hand = [
        Field::integer("population", 2, 100, "individuals").multiple_of(2).default("10"),
        Field::quantity("step", LENGTH, 0.0, 1e-3, "first step").default("30 um").range(),
    ];
    for (derived, by_hand) in member.fields.iter().zip(&by_hand) {
        assert_eq!((derived.name, derived.summary), (by_hand.name, by_hand.summary));
        assert!(derived.presence == by_hand.presence && derived.span == by_hand.span && !derived.chooses);
    }
    assert!(matches!(member.fields[0].shape, Shape::Integer { minimum: 2, maximum: 100, multiple: 2 }));
    assert!(matches!(member.fields[1].shape, Shape::Quantity { dimension: LENGTH, minimum: 0.0, maximum: 1e-3 }));
    assert!(matches!(member.fields[3].presence, Presence::Optional) && member.fields[3].span == Span::Single);
    assert!(matches!(member.fields[4].shape, Shape::List(Shape::Integer { minimum: 2, maximum: 50, multiple: 1 })));
    assert!(matches!(member.fields[5].shape, Shape::Group(fields) if fields[0].name == "both"));
    let Shape::Choice(choices) = member.fields[2].shape else { panic!("words") };
    let choices: Vec<_> = choices.iter().map(|choice| (choice.name, choice.summary)).collect();
    assert_eq!(choices, [("centre", "the middle of every range"), ("at_random", "a random point, from the seed")]);
    assert_eq!(Toy::NAMES.population, "population");
}

#[test]
fn a_struct_and_its_record_say_the_same() {
    let toy = Toy::default();
    let expected = Toy {
        population: 10,
        step: 30e-6,
        start: Start::Centre,
        patience: None,
        levels: vec![11],
        ends: Ends { both: true },
    };
    assert_eq!(toy, expected);
    let other = Toy { start: Start::AtRandom, patience: Some(4), levels: vec![3, 4], step: 1e-4, ..toy.clone() };
    for toy in [&toy, &other] {
        assert_eq!(Toy::read(&toy.record()), *toy);
    }
    assert_ne!(written(&toy.record()), written(&other.record()));
    assert_eq!(other.record().choice("start"), "at_random");
    assert!(matches!(other.record().list("levels")[1].value, Value::Integer(4)));
    assert_eq!([Start::of("at_random"), Start::of("random")], [Some(Start::AtRandom), None]);
    assert_eq!(Start::AtRandom.word(), "at_random");
}

#[test]
fn a_number_outside_its_range_is_refused() {
    let refused = |toy: Toy| toy.in_range().err().map(|error| format!("{}; {}", error.message, error.help.unwrap()));
    assert_eq!(refused(Toy::default()), None);
    let few = Toy { population: 1, ..Toy::default() };
    assert_eq!(refused(few).as_deref(), Some("`population` is 1; it may be 2 to 100"));
    let odd = Toy { population: 7, ..Toy::default() };
    assert_eq!(refused(odd).as_deref(), Some("`population` is 7; it may be multiples of 2"));
    let long = Toy { step: f64::NAN, ..Toy::default() };
    assert_eq!(refused(long).as_deref(), Some("`step` is NaN; it may be 0 to 0.001"));
    let level = Toy { levels: vec![5, 51], ..Toy::default() };
    assert_eq!(refused(level).as_deref(), Some("`levels` is 51; it may be 2 to 50"));
    let impatient = Toy { patience: Some(0), ..Toy::default() };
    assert_eq!(refused(impatient).as_deref(), Some("`patience` is 0; it may be 1 to 9"));
}

/// How far.
#[derive(Clone, Copy, Debug, PartialEq, Alternatives)]
enum Reach {
    /// L.
    #[declared(minimum = 0.0, maximum = 1.0, dimension = LENGTH, range)]
    Length(f64),
    /// As a share.
    #[declared(name = "length_share", minimum = 0.0, maximum = 2.0)]
    Share(f64),
}

/// How it grows.
#[derive(Clone, Copy, Debug, PartialEq, Tagged)]
#[declared(name = "curve", default = "straight")]
enum Growth {
    /// t
    Straight,
    /// t^n
    Power {
        /// n
        #[declared(minimum = 1.0, maximum = 9.0)]
        exponent: f64,
    },
}

/// relief that exists only here
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "relief")]
struct Relief {
    #[declared(flatten)]
    pub reach: Reach,
    #[declared(flatten)]
    pub growth: Growth,
}

#[test]
fn an_enum_stands_for_fields_that_exclude_each_other() {
    let names: Vec<_> = Relief::MEMBER.fields.iter().map(|field| field.name).collect();
    assert_eq!(names, ["length", "length_share", "curve", "exponent"]);
    assert!(Relief::MEMBER.fields[..2].iter().all(|field| field.presence == Presence::Optional));
    assert!(Relief::MEMBER.fields[0].span == Span::Range && Relief::MEMBER.fields[1].span == Span::Single);
    assert_eq!([Reach::Length(0.5).field(), Reach::Share(0.5).field()], ["length", "length_share"]);
    for relief in [
        Relief { reach: Reach::Length(0.25), growth: Growth::Straight },
        Relief { reach: Reach::Share(1.5), growth: Growth::Power { exponent: 2.0 } },
    ] {
        let record = relief.record();
        assert!(Relief::consistent(&record).is_ok() && relief.in_range().is_ok());
        assert_eq!(Relief::read(&record), relief);
    }
    let outside = Relief { reach: Reach::Share(3.0), growth: Growth::Straight };
    assert_eq!(outside.in_range().unwrap_err().message, "`length_share` is 3");
}

#[test]
fn fields_that_do_not_go_together_are_refused() {
    let refused =
        |given: &[(&str, Value)]| Relief::consistent(&record_of(Relief::MEMBER.fields, given)).unwrap_err().message;
    let (length, share) = (("length", Value::Quantity(0.1)), ("length_share", Value::Number(0.1)));
    let both = "exactly one of `length`, `length_share` is needed, not both `length` and `length_share`";
    assert_eq!(refused(&[length.clone(), share]), both);
    assert_eq!(refused(&[]), "exactly one of `length`, `length_share` is needed, and there is none");
    let power = ("curve", Value::Choice("power"));
    assert_eq!(refused(&[length.clone(), power]), "the curve `power` needs its `exponent`");
    let exponent = ("exponent", Value::Number(2.0));
    assert_eq!(refused(&[length, exponent]), "`exponent` goes with `curve: power` only");
    // A range is as good as a value until somebody chooses.
    let range = record_of(Relief::MEMBER.fields, &[("length", Value::Range(0.1, 0.2))]);
    assert!(Relief::consistent(&range).is_ok());
    assert_eq!(Relief::read(&range.without_ranges(Relief::MEMBER.fields)).reach, Reach::Length(0.1));
}

/// What hills are.
trait Hill: Debug + Registrable {
    fn height(&self) -> f64;
}

/// as high everywhere
#[derive(Debug, Declared)]
#[declared(name = "flat")]
struct Flat {}

impl Hill for Flat {
    fn height(&self) -> f64 {
        0.0
    }
}

/// one that ends somewhere
#[derive(Debug, Declared)]
#[declared(name = "round")]
struct Round {
    #[declared(flatten)]
    pub reach: Reach,
}

impl Hill for Round {
    fn height(&self) -> f64 {
        let (Reach::Length(height) | Reach::Share(height)) = self.reach;
        height
    }
}

registry!(HILLS: Hill = Flat, Round);

/// a stage that exists only here
#[derive(Debug, Declared)]
struct Stage {
    /// where
    #[declared(kinds = ["field", "wood"])]
    pub ground: String,
    /// who
    #[declared(kinds = ["walker"])]
    pub walkers: Vec<Placed<String>>,
    /// how far
    #[declared(minimum = 0.0, maximum = 1.0, dimension = LENGTH, axis = 4)]
    pub way: Vec<f64>,
    /// how often
    #[declared(minimum = 0.0, maximum = 9.0, axis = usize::MAX)]
    pub times: Option<Vec<f64>>,
    /// over what
    #[declared(default = "flat", chooses)]
    pub hill: Box<dyn Hill>,
    /// what else
    pub others: Option<Vec<Relief>>,
    /// by names
    pub names: Vec<(String, Placed<String>)>,
    /// as it is best
    #[declared(overrides = Stage::NAMES.ground)]
    pub best: Variant,
    /// as it may be
    #[declared(overrides = Stage::NAMES.ground)]
    pub steps: Vec<(String, Vec<Variant>)>,
}

fn at(line: usize, value: Value) -> PlacedValue {
    PlacedValue { value, place: Place { line, ..Place::default() } }
}

fn stage(hill: Value, others: Vec<Value>) -> Record {
    let variant = |written: &str| {
        Value::Variant(Variant { kind: "field", written: written.to_owned(), record: Record::default() })
    };
    let text = |text: &str| Value::Text(text.to_owned());
    record_of(
        Stage::MEMBER.fields,
        &[
            ("ground", Value::Reference("meadow".to_owned())),
            (
                "walkers",
                Value::List(vec![at(3, Value::Reference("ann".into())), at(4, Value::Reference("bob".into()))]),
            ),
            ("way", Value::Axis(vec![0.25, 0.5])),
            ("hill", hill),
            ("others", Value::List(others.into_iter().map(entry).collect())),
            ("names", Value::Map(vec![("a".to_owned(), at(7, text("one"))), ("b".to_owned(), at(8, text("two")))])),
            ("best", variant("wet")),
            ("steps", Value::Map(vec![("dry".to_owned(), entry(Value::List(vec![entry(variant("sandy"))])))])),
        ],
    )
}

#[test]
fn references_axes_members_maps_and_variants_are_declared_as_by_hand() {
    let by_hand = [
        Field::reference("ground", &["field", "wood"], "where"),
        Field::new("walkers", Shape::List(&Shape::Reference(&["walker"])), "who"),
        Field::quantity("way", LENGTH, 0.0, 1.0, "how far").axis(4),
        Field::number("times", 0.0, 9.0, "how often").axis(usize::MAX).optional(),
        Field::new("hill", Shape::Member(members), "over what").default("flat").chooses(),
        Field::new("others", Shape::List(&Shape::Group(Relief::MEMBER.fields)), "what else").optional(),
        Field::new("names", Shape::Map(&Shape::Text), "by names"),
        Field::new("best", Shape::Overrides("ground"), "as it is best"),
        Field::new("steps", Shape::Map(&Shape::List(&Shape::Overrides("ground"))), "as it may be"),
    ];
    assert_eq!(Stage::MEMBER.fields.len(), by_hand.len());
    for (derived, by_hand) in Stage::MEMBER.fields.iter().zip(&by_hand) {
        assert_eq!((derived.name, derived.summary), (by_hand.name, by_hand.summary));
        assert!(derived.presence == by_hand.presence && derived.span == by_hand.span, "{}", derived.name);
        assert_eq!(derived.chooses, by_hand.chooses, "{}", derived.name);
        assert!(same(&derived.shape, &by_hand.shape), "{}", derived.name);
    }
}

fn same(one: &Shape, two: &Shape) -> bool {
    match (one, two) {
        (Shape::Reference(one), Shape::Reference(two)) => one == two,
        (Shape::List(one), Shape::List(two)) | (Shape::Map(one), Shape::Map(two)) => same(one, two),
        (
            Shape::Quantity { dimension, minimum, maximum },
            Shape::Quantity { dimension: other, minimum: least, maximum: most },
        ) => (dimension, minimum, maximum) == (other, least, most),
        (Shape::Number { minimum, maximum }, Shape::Number { minimum: least, maximum: most }) => {
            (minimum, maximum) == (least, most)
        }
        (Shape::Member(one), Shape::Member(two)) => {
            one().iter().map(|member| member.name).eq(two().iter().map(|member| member.name))
        }
        (Shape::Group(one), Shape::Group(two)) => {
            one.iter().map(|field| field.name).eq(two.iter().map(|field| field.name))
        }
        (Shape::Overrides(one), Shape::Overrides(two)) => one == two,
        (Shape::Text, Shape::Text) => true,
        _ => false,
    }
}

#[test]
fn they_are_read_with_their_places_and_written_as_they_were() {
    let round = Value::Member("round", Round { reach: Reach::Length(0.5) }.record());
    let record =
        stage(round, vec![Value::Group(Relief { reach: Reach::Share(1.0), growth: Growth::Straight }.record())]);
    let stage = Stage::checked(&record).unwrap();
    assert_eq!((stage.ground.as_str(), stage.way.as_slice(), stage.times.as_ref()), ("meadow", &[0.25, 0.5][..], None));
    let walkers: Vec<_> = stage.walkers.iter().map(|walker| (walker.value.as_str(), walker.place.line)).collect();
    assert_eq!(walkers, [("ann", 3), ("bob", 4)]);
    let names: Vec<_> = stage.names.iter().map(|(name, text)| (name.as_str(), text.value.as_str())).collect();
    assert_eq!((names, stage.names[1].1.place.line), (vec![("a", "one"), ("b", "two")], 8));
    assert_eq!((stage.hill.name(), stage.hill.height()), ("round", 0.5));
    assert_eq!((stage.best.written.as_str(), stage.steps[0].1[0].written.as_str()), ("wet", "sandy"));
    assert_eq!(stage.record(), record);
    assert!(stage.in_range().is_ok());
    let refused = |stage: Stage| stage.in_range().unwrap_err().message;
    assert_eq!(refused(Stage { way: vec![0.5, 2.0], ..Stage::read(&record) }), "`way` is 2");
    let far = Box::new(Round { reach: Reach::Length(3.0) });
    assert_eq!(refused(Stage { hill: far, ..Stage::read(&record) }), "`length` is 3");
}

#[test]
fn what_does_not_go_together_is_refused_wherever_it_is() {
    let refused = |hill, others| Stage::checked(&stage(hill, others)).unwrap_err().message;
    let nothing = || Record::default();
    let flat = || Value::Member("flat", nothing());
    let none = "exactly one of `length`, `length_share` is needed, and there is none";
    assert_eq!(refused(Value::Member("round", nothing()), vec![]), none);
    assert_eq!(refused(flat(), vec![Value::Group(nothing())]), none);
    assert!(Stage::checked(&stage(flat(), vec![])).is_ok());
}
