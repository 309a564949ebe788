//! What is made from the declarations: the schema agrees with the reader, and the descriptions say everything.

use serde_json::Value;

use super::{KINDS, VALID, changed, load};
use crate::study::document::parse;
use crate::study::{declared, describe, schema};

/// The part of JSON schema that ours uses, except the patterns.
fn accepts(root: &Value, schema: &Value, value: &Value) -> bool {
    let all = |name: &str| schema[name].as_array().into_iter().flatten();
    let object = value.as_object();
    let typed = |name: &str| match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_i64() || value.is_u64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        other => panic!("unknown type {other}"),
    };
    let types = match &schema["type"] {
        Value::Null => true,
        Value::String(name) => typed(name),
        names => names.as_array().unwrap().iter().any(|name| typed(name.as_str().unwrap())),
    };
    let count = object.map(serde_json::Map::len).or(value.as_array().map(Vec::len)).unwrap_or(0) as f64;
    let at_least =
        |name: &str, found: Option<f64>| schema[name].as_f64().zip(found).is_none_or(|(bound, found)| found >= bound);
    let at_most =
        |name: &str, found: Option<f64>| schema[name].as_f64().zip(found).is_none_or(|(bound, found)| found <= bound);
    let reference = schema["$ref"].as_str().is_none_or(|name| {
        let target = root.pointer(name.strip_prefix('#').unwrap()).unwrap_or_else(|| panic!("{name} is not defined"));
        accepts(root, target, value)
    });
    let condition =
        schema.get("if").is_none_or(|test| !accepts(root, test, value) || accepts(root, &schema["then"], value));
    let members = object.is_none_or(|object| {
        object.iter().all(|(name, inner)| match (schema["properties"].get(name), &schema["additionalProperties"]) {
            (Some(known), _) => accepts(root, known, inner),
            (None, Value::Bool(allowed)) => *allowed,
            (None, Value::Null) => true,
            (None, other) => accepts(root, other, inner),
        })
    });
    types
        && reference
        && condition
        && members
        && schema.get("const").is_none_or(|wanted| wanted == value)
        && all("required").all(|name| object.is_none_or(|object| object.contains_key(name.as_str().unwrap())))
        && all("allOf").all(|part| accepts(root, part, value))
        && schema.get("anyOf").is_none_or(|_| all("anyOf").any(|part| accepts(root, part, value)))
        && schema.get("oneOf").is_none_or(|_| all("oneOf").filter(|part| accepts(root, part, value)).count() == 1)
        && schema
            .get("items")
            .is_none_or(|items| value.as_array().is_none_or(|all| all.iter().all(|item| accepts(root, items, item))))
        && at_least("minimum", value.as_f64())
        && at_most("maximum", value.as_f64())
        && schema["multipleOf"].as_i64().zip(value.as_i64()).is_none_or(|(of, value)| value % of == 0)
        && (!value.is_object() || at_least("minProperties", Some(count)) && at_most("maxProperties", Some(count)))
        && (!value.is_array() || at_least("minItems", Some(count)) && at_most("maxItems", Some(count)))
}

fn fits(text: &str) -> bool {
    let schema = schema::schema(KINDS);
    accepts(&schema, &schema, &schema::plain(&parse(text).unwrap().unwrap()))
}

#[test]
fn the_schema_accepts_what_the_reader_accepts() {
    for text in [
        VALID.to_owned(),
        changed("title: A small study of 5 µm\n", ""),
        changed("{ from: 25 N m, to: 100 N m, count: 16 }", "[1 N m, 2 N m]"),
        changed("amount: [0 um, 8 um]", "amount: 8 um"),
        changed("plain: []", "plain: nothing"),
        changed("plain: []", "plain: [nothing: ]"),
        changed("overlap: 12.5 %", "overlap: 0.125\n    bolts: 6\n    side: left\n    ground: true\n    note: 7"),
    ] {
        assert!(load(&text).is_ok(), "{text}");
        assert!(fits(&text), "{text}");
    }
}

#[test]
fn the_schema_refuses_what_an_editor_should_underline() {
    for (old, new) in [
        ("study: small", "stduy: small"),
        ("study: small\n", ""),
        ("seed: 7", "seed: -1"),
        ("seed: 7", "seed: many"),
        ("module: 3 mm", "modul: 3 mm"),
        ("module: 3 mm\n    ", ""),
        ("module: 3 mm", "module: 3"),
        ("module: 3 mm", "module: [3 mm]"),
        ("kind: geometry", "kind: geometri"),
        ("    kind: geometry\n", ""),
        ("{ addendum: 1.25 }", "{ addendum: 5 }"),
        ("{ addendum: 1.25 }", "{ dedendum: 1 }"),
        ("teeth: 19", "teeth: 19.5"),
        ("teeth: 19", "teeth: 3"),
        ("overlap: 12.5 %", "bolts: 7"),
        ("overlap: 12.5 %", "side: up"),
        ("overlap: 12.5 %", "ground: 1"),
        ("plain: []", "plain: [tip_releif]"),
        ("plain: []", "plain: [tip_relief]"),
        ("plain: []", "plain: { tip_relief: { amount: 1 um }, nothing: {} }"),
        ("plain: []", "plain: { tip_relief: { amount: [0 um, 8 um] } }"),
        ("amount: [0 um, 8 um]", "amount: [0 um]"),
        ("count: 16", "steps: 16"),
        ("count: 16", "count: 1"),
    ] {
        let text = changed(old, new);
        assert!(load(&text).is_err(), "{new}");
        assert!(!fits(&text), "{new}");
    }
}

#[test]
fn a_family_is_defined_once_for_each_way_of_reading_it() {
    let schema = schema::schema(KINDS);
    let names: Vec<_> = schema["$defs"].as_object().unwrap().keys().map(String::as_str).collect();
    let families: Vec<_> = names.iter().filter(|name| name.starts_with("family_")).collect();
    assert_eq!(families, [&"family_designs", &"family_design"]);
    assert_eq!(schema["$defs"]["kind_optimizer"]["properties"]["method"]["$ref"], "#/$defs/family_designs");
    assert_eq!(schema::schema_text(KINDS), schema::schema_text(KINDS));
}

#[test]
fn a_description_names_every_field_with_range_default_and_choices() {
    let text = describe::kind(KINDS[0]);
    for line in [
        "geometry\n  A stage of the tests: geometry.\n",
        "  module: a length in mm, um, m, between 10 um and 100 mm (required)\n      Module m.\n",
        "  pressure_angle: an angle in deg, rad, between 0.1 rad and 0.8 rad (default `20 deg`)\n",
        "  rack: these fields (default `{}`)\n      The basic rack.\n    addendum: a plain number, between 0.1 and 2 (default `1.0`)\n",
        "    shift: a plain number, at least -1 (optional)\n",
        "    teeth: a whole number, between 5 and 1000 (required)\n",
        "  overlap: a ratio, between 0 and 1 (optional)\n",
        "    - left: The left flank.\n",
        "\nexample\n  kind: geometry\n",
    ] {
        assert!(text.contains(line), "{line}\nis not in\n{text}");
    }
    let text = describe::kind(KINDS[2]);
    for line in [
        "  pair: the name of a `geometry` stage (required)\n",
        "  design: a list, each one of these, `name` or `name: { fields }` (required)\n",
        "    - tip_relief: Relief of the tip.\n        amount: a length in mm, um, m, between 0 mm and 1 mm; [least, most] where an optimiser chooses (required)\n",
        "    - the same as above: `tip_relief`, `lead_crowning` or `nothing`\n",
    ] {
        assert!(text.contains(line), "{line}\nis not in\n{text}");
    }
    assert!(
        describe::kind(KINDS[3])
            .contains("torque: a torque in N m, N mm, between 0 N m and 1e7 N m; one value, a list, or")
    );
    assert!(describe::list(KINDS).starts_with("geometry      A stage of the tests: geometry.\nmodification  A"));
}

#[test]
fn every_declared_field_is_one_that_a_study_can_give() {
    assert_eq!(declared::faults(KINDS), Vec::<String>::new());
}
