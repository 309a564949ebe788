//! A stage's fields after defaults as JSON a reader understands: `"3 mm"`, not `0.003`.
//!
//! For showing what differs between two runs; never read back, never part of a key. Must not know: any kind by name.

use serde_json::{Map, Value as Json, json};

use super::words;
use crate::base::parameter::{Field, Shape};
use crate::base::record::{Record, Value};
use crate::base::units::{RATIO, in_unit};

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
        Value::Range(least, most) => json!({ "least": number(shape, *least), "most": number(shape, *most) }),
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::study::load_text;

    #[test]
    fn fields_are_shown_as_they_would_be_written() {
        let text = include_str!("../../studies/quick.yaml");
        let study = load_text(text, Path::new("quick.yaml")).unwrap();
        let stage = |name: &str| {
            let node = study.nodes.iter().find(|node| node.name == name).unwrap();
            shown(node.kind.fields, &node.record)
        };
        let pair = stage("pair");
        assert_eq!(pair["module"], "3 mm");
        assert_eq!(pair["material"]["youngs_modulus"], "206 GPa");
        assert_eq!(pair["pinion"]["teeth"], 24);
        let designs = stage("designs");
        assert_eq!(designs["pair"], "pair");
        assert_eq!(designs["designs"]["unmodified"], json!([]));
        assert_eq!(designs["designs"]["long"][1]["lead_crowning"]["amount"], "4 um");
        let optimum = stage("optimum");
        assert_eq!(optimum["design"][0]["tip_relief"]["amount"], json!({ "least": "0 mm", "most": "30 um" }));
        assert_eq!(optimum["method"]["differential_evolution"]["population"], 24);
        assert_eq!(stage("ste")["torque"], json!(["50 N m", "100 N m", "150 N m", "200 N m", "250 N m"]));
        let claim = stage("report");
        assert!(claim["published"][0]["claim"].as_str().is_some_and(|claim| claim.contains("best <= short")));
        assert!(claim["figures"][0]["name"] == "stiffness");
    }
}
