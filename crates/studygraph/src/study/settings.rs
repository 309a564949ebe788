//! A stage's fields after defaults as JSON a reader understands: `"3 mm"`, not `0.003`.
//!
//! For showing what differs between two runs; never read back, never part of a key. Must not know: any kind by name.

use serde::{Serialize, Serializer};
use serde_json::{Value as Json, json};

use super::words;
use declare::parameter::{Field, Shape};
use declare::record::varied::{Axis, Form, INTERVALS, Spread, Values, Varied};
use declare::record::{Record, Value};
use declare::units::{RATIO, in_unit};

/// The fields of a record, by their declarations.
pub struct Shown<'a> {
    pub fields: &'a [Field],
    pub record: &'a Record,
}

/// One value of a shape.
struct Member<'a>(&'a Shape, &'a Value);

/// A number of a shape.
struct Number<'a>(&'a Shape, f64);

impl Serialize for Shown<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let fields = self.fields.iter().filter_map(|field| {
            let entry = self.record.entry(field.name)?;
            Some((field.name, Entry::Of(&field.shape, &entry.value)))
        });
        // What it knows of the inputs of others, beside its own.
        let intervals = Varied::intervals(self.record).map(|varied| (INTERVALS, Entry::Intervals(varied)));
        serializer.collect_map(fields.chain(intervals))
    }
}

/// What stands behind a name.
enum Entry<'a> {
    Of(&'a Shape, &'a Value),
    Intervals(&'a Varied),
}

impl Serialize for Entry<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Of(shape, value) => Member(shape, value).serialize(serializer),
            Self::Intervals(varied) => {
                serializer.collect_map(varied.axes.iter().filter_map(|axis| Some((&axis.path, interval(axis)?))))
            }
        }
    }
}

/// As a study has it, `0.504 ± 0.0005`.
fn interval(axis: &Axis) -> Option<String> {
    let Values::Spread(Spread { form: Form::Within(half, _), about, .. }) = &axis.values else { return None };
    let number = |si: f64| words::number(if axis.unit.is_empty() { si } else { in_unit(si, &axis.unit) });
    Some(format!("{} ± {} {}", number(*about), number(*half), axis.unit).trim_end().to_owned())
}

impl Serialize for Number<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Shape::Quantity { dimension, .. } if *dimension != RATIO => {
                serializer.serialize_str(&words::quantity(self.1, *dimension))
            }
            _ => serializer.serialize_f64(self.1),
        }
    }
}

impl Serialize for Member<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(shape, value) = *self;
        let number = |si: &f64| Number(shape, *si);
        match value {
            Value::Quantity(si) | Value::Number(si) => number(si).serialize(serializer),
            Value::AnyQuantity { .. } => serializer.serialize_str(&any_quantity(value)),
            Value::Axis(values) => serializer.collect_seq(values.iter().map(number)),
            Value::Range(minimum, maximum) => {
                serializer.collect_map([("least", number(minimum)), ("most", number(maximum))])
            }
            Value::Integer(value) => value.serialize(serializer),
            Value::Flag(value) => value.serialize(serializer),
            Value::Text(text) | Value::Reference(text) => text.serialize(serializer),
            Value::Choice(name) => name.serialize(serializer),
            Value::List(entries) => match shape {
                Shape::List(item) => serializer.collect_seq(entries.iter().map(|entry| Member(item, &entry.value))),
                _ => serializer.serialize_unit(),
            },
            Value::Map(entries) => match shape {
                Shape::Map(item) => {
                    serializer.collect_map(entries.iter().map(|(name, entry)| (name, Member(item, &entry.value))))
                }
                _ => serializer.serialize_unit(),
            },
            Value::Group(record) => match shape {
                Shape::Group(fields) => Shown { fields, record }.serialize(serializer),
                _ => serializer.serialize_unit(),
            },
            // The rest is that of the other stage, which the manifest shows as well.
            Value::Variant(variant) => variant.written.serialize(serializer),
            Value::Varied(varied) => {
                serializer.collect_map(varied.axes.iter().map(|axis| (&axis.name, axis_shown(axis))))
            }
            Value::Member(name, record) => {
                let Shape::Member(family) = shape else { return serializer.serialize_unit() };
                match family().iter().find(|member| member.name == *name) {
                    Some(member) if !record.fields.is_empty() => {
                        serializer.collect_map([(name, Shown { fields: member.fields, record })])
                    }
                    _ => name.serialize(serializer),
                }
            }
        }
    }
}

/// A field and its values as written; of many values the first and the last, and how many there are.
fn axis_shown(axis: &Axis) -> Json {
    const MOST: usize = 12;
    let one = |si: f64| {
        if axis.unit.is_empty() {
            json!(si)
        } else {
            json!(format!("{} {}", words::number(in_unit(si, &axis.unit)), axis.unit))
        }
    };
    let shown = match &axis.values {
        Values::Between(from, to) => json!({ "from": one(*from), "to": one(*to) }),
        Values::Follows(formula) => json!({ "follows": formula }),
        Values::Spread(spread) => spread_shown(spread, &one),
        Values::Each(values) if values.len() <= MOST => values.iter().map(|si| one(*si)).collect(),
        Values::Each(values) => {
            json!({ "first": one(values[0]), "last": one(values[values.len() - 1]), "count": values.len() })
        }
    };
    json!({ "field": axis.path, "values": shown })
}

fn spread_shown(spread: &Spread, one: &dyn Fn(f64) -> Json) -> Json {
    let mut shown = match spread.form {
        Form::Within(half, within) => {
            json!({ "within": one(half), "shape": within.word(), "about": one(spread.about) })
        }
        Form::Class(class, within) => json!({ "iso1328": class, "shape": within.word(), "about": one(spread.about) }),
        Form::Normal(deviation) => json!({ "normal": one(deviation), "mean": one(spread.about) }),
        Form::Triangular => json!({ "mode": one(spread.about) }),
    };
    for (name, end) in ["from", "to"].into_iter().zip(spread.ends) {
        if let Some(end) = end {
            shown[name] = one(end);
        }
    }
    shown
}

/// A quantity in the unit it was written in; other values give no text.
#[must_use]
pub fn any_quantity(value: &Value) -> String {
    match value {
        Value::AnyQuantity { value, unit, .. } if unit.is_empty() => words::number(*value),
        Value::AnyQuantity { value, unit, .. } => format!("{} {unit}", words::number(in_unit(*value, unit))),
        _ => String::new(),
    }
}
