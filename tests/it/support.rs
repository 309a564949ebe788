//! What several tests need: records of declared parameters without a YAML file.

use declare::error::Place;
use declare::parameter::{Field, Presence, Shape};
use declare::record::{PlacedValue, Record, Value};
use gearstudy::program::PROGRAM;
use studygraph::program::Program;
use studygraph::study::Study;

/// The record of `fields` with their defaults, and `given` instead where a name is among them.
pub fn record(fields: &[Field], given: &[(&str, Value)]) -> Record {
    let mut record = Record::default();
    for field in fields {
        let value = given.iter().find(|(name, _)| *name == field.name).map(|(_, value)| value.clone());
        let value = value.or_else(|| match field.presence {
            Presence::Default(text) => Some(read(&field.shape, text)),
            Presence::Optional => None,
            Presence::Required => panic!("`{}` must be given", field.name),
        });
        if let Some(value) = value {
            record.fields.push((field.name, PlacedValue { value, place: record.place }));
        }
    }
    for (name, _) in given {
        assert!(fields.iter().any(|field| field.name == *name), "`{name}` is not declared");
    }
    record
}

fn read(shape: &Shape, text: &str) -> Value {
    match shape {
        Shape::Number { least, most } => {
            let value = text.parse().unwrap();
            assert!((*least..=*most).contains(&value), "the default {value} is outside {least}..={most}");
            Value::Number(value)
        }
        Shape::Integer { least, most, multiple } => {
            let value: i64 = text.parse().unwrap();
            assert!((*least..=*most).contains(&value), "the default {value} is outside {least}..={most}");
            assert_eq!(value % multiple, 0, "the default {value} is no multiple of {multiple}");
            Value::Integer(value)
        }
        Shape::Choice(choices) => {
            Value::Choice(choices.iter().find(|choice| choice.name == text).expect("the default is a choice").name)
        }
        Shape::Flag => Value::Flag(text.parse().unwrap()),
        Shape::List(item) => Value::List(vec![PlacedValue { value: read(item, text), place: Place::default() }]),
        _ => panic!("a default of this shape is not read here"),
    }
}

/// A study as a program with other code reads it.
pub fn with_code(study: Study, code_of: fn(&str) -> String) -> Study {
    let program = Program { kinds: PROGRAM.kinds, code_of, counters: PROGRAM.counters, about: PROGRAM.about };
    Study { program: Box::leak(Box::new(program)), ..study }
}
