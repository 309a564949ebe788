//! A stage's fields after defaults as JSON a reader understands: `"3 mm"`, not `0.003`.
//!
//! For showing what differs between two runs; never read back, never part of a key. Must not know: any kind by name.

use serde_json::{Map, Value as Json, json};

use super::words;
use declare::parameter::{Field, Shape};
use declare::record::varied::{Axis, Form, Spread, Values};
use declare::record::{Record, Value};
use declare::units::{RATIO, in_unit};

/// The fields of `record`, which were declared by `fields`.
#[must_use]
pub fn shown(fields: &[Field], record: &Record) -> Json {
    let one = |field: &Field| Some((field.name.to_owned(), value(&field.shape, &record.entry(field.name)?.value)));
    Json::Object(fields.iter().filter_map(one).collect())
}

fn value(shape: &Shape, value: &Value) -> Json {
    match value {
        Value::Quantity(si) | Value::Number(si) => number(shape, *si),
        Value::AnyQuantity { .. } => json!(any_quantity(value)),
        Value::Axis(values) => values.iter().map(|si| number(shape, *si)).collect(),
        Value::Range(minimum, maximum) => json!({ "least": number(shape, *minimum), "most": number(shape, *maximum) }),
        Value::Integer(value) => json!(value),
        Value::Flag(value) => json!(value),
        Value::Text(text) | Value::Reference(text) => json!(text),
        Value::Choice(name) => json!(name),
        Value::List(entries) => {
            let Shape::List(item) = shape else { return Json::Null };
            entries.iter().map(|entry| self::value(item, &entry.value)).collect()
        }
        Value::Map(entries) => {
            let Shape::Map(item) = shape else { return Json::Null };
            entries.iter().map(|(name, entry)| (name.clone(), self::value(item, &entry.value))).collect()
        }
        Value::Group(record) => match shape {
            Shape::Group(fields) => shown(fields, record),
            _ => Json::Null,
        },
        // The rest is that of the other stage, which the manifest shows as well.
        Value::Variant(variant) => json!(variant.written),
        Value::Varied(varied) => {
            Json::Object(varied.axes.iter().map(|axis| (axis.name.clone(), axis_shown(axis))).collect())
        }
        Value::Member(name, record) => {
            let Shape::Member(family) = shape else { return Json::Null };
            match family().iter().find(|member| member.name == *name) {
                Some(member) if !record.fields.is_empty() => {
                    Json::Object(Map::from_iter([((*name).to_owned(), shown(member.fields, record))]))
                }
                _ => json!(name),
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

fn number(shape: &Shape, si: f64) -> Json {
    match shape {
        Shape::Quantity { dimension, .. } if *dimension != RATIO => json!(words::quantity(si, *dimension)),
        _ => json!(si),
    }
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
