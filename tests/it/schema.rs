//! The schema that editors read, `schemas/study.schema.json`, is the one the program prints.

use std::fs;
use std::io::Write;
use std::path::Path;

use serde_json::{Map, Value};

use crate::python;
use gearstudy::stage::kinds::KINDS;
use studygraph::study::schema::schema_text;

#[test]
fn the_schema_in_the_repository_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas/study.schema.json");
    let kept = fs::read_to_string(&path).unwrap_or_default();
    let refresh = "cargo run -- schema > schemas/study.schema.json";
    assert!(kept == schema_text(KINDS), "schemas/study.schema.json is out of date; refresh it with: {refresh}");
}

/// A schema with the definitions of `shared` in the places that refer to them.
fn restored(schema: &Value, shared: &Map<String, Value>) -> Value {
    match schema {
        Value::Array(all) => all.iter().map(|inner| restored(inner, shared)).collect(),
        Value::Object(object) => {
            let mut whole = Map::new();
            for (keyword, inner) in object {
                let name = inner.as_str().and_then(|text| text.strip_prefix("#/$defs/"));
                match name.and_then(|name| shared.get(name)).filter(|_| keyword == "$ref") {
                    Some(definition) => {
                        let definition = restored(definition, shared);
                        let definition = definition.as_object().unwrap();
                        // A keyword on both sides would have another meaning in an editor.
                        assert!(!definition.keys().any(|keyword| object.contains_key(keyword)), "{schema}");
                        whole.extend(definition.clone());
                    }
                    None => drop(whole.insert(keyword.clone(), restored(inner, shared))),
                }
            }
            Value::Object(whole)
        }
        other => other.clone(),
    }
}

/// Tier: invariant; the schema in the file is smaller than the declared one, and has every annotation and limit in the same place.
#[test]
fn shared_definitions_leave_every_place_as_declared() {
    let declared = studygraph::study::schema::schema(KINDS);
    let text = schema_text(KINDS);
    assert!(text.len() < 300_000, "{} bytes", text.len());
    let mut file: Value = serde_json::from_str(&text).unwrap();
    let definitions = file["$defs"].as_object_mut().unwrap();
    let (kept, shared): (Map<_, _>, Map<_, _>) =
        std::mem::take(definitions).into_iter().partition(|(name, _)| declared["$defs"].get(name).is_some());
    file["$defs"] = Value::Object(kept);
    assert!(shared.len() > 100, "{}", shared.len());
    assert!(restored(&file, &shared) == declared);
}

/// Second method: another program reads the schema by the specification, and the studies with another YAML reader.
#[test]
fn another_validator_accepts_the_studies_and_refuses_mistakes() {
    python::run("schema.py", &[]);
}

/// What an editor has of a schema: walked as JSON, by the names that an editor looks for.
struct Walk {
    faults: Vec<String>,
    fields: usize,
    patterns: usize,
}

impl Walk {
    fn all(root: &Value) -> Self {
        let mut walk = Self { faults: Vec::new(), fields: 0, patterns: 0 };
        walk.schema(root, "");
        walk
    }

    fn check(&mut self, holds: bool, place: &str, what: &str) {
        if !holds {
            self.faults.push(format!("{place}: {what}"));
        }
    }

    fn schema(&mut self, schema: &Value, place: &str) {
        let Some(object) = schema.as_object() else { return };
        let text = |name: &str| schema[name].as_str().unwrap_or_default();
        if object.contains_key("pattern") {
            self.patterns += 1;
            let message = text("patternErrorMessage");
            // Units have powers, patterns begin with a bracket.
            let is_raw = message.contains("^[") || message.contains("^(");
            self.check(message.len() > 20 && !is_raw, place, "a pattern without words");
        }
        for (name, inner) in object {
            match (name.as_str(), inner) {
                ("properties", Value::Object(fields)) => {
                    for (field, inner) in fields {
                        self.field(inner, &format!("{place}/{field}"));
                    }
                }
                ("$defs", Value::Object(definitions)) => {
                    for (name, inner) in definitions {
                        self.schema(inner, &format!("{place}/{name}"));
                    }
                }
                ("anyOf" | "oneOf" | "allOf", Value::Array(ways)) => {
                    for way in ways {
                        self.schema(way, place);
                    }
                }
                // A condition tells kinds apart; what it leads to is a definition.
                ("items" | "additionalProperties" | "propertyNames", inner) => self.schema(inner, place),
                _ => {}
            }
        }
    }

    fn field(&mut self, field: &Value, place: &str) {
        self.fields += 1;
        let text = |name: &str| field[name].as_str().unwrap_or_default();
        let title = text("title");
        self.check(title.starts_with(char::is_uppercase) && !title.contains('_'), place, "no title");
        self.check(text("description").len() > 3, place, "no description");
        self.check(offers(field), place, "nothing is offered: neither words, examples nor a default");
        self.schema(field, place);
    }
}

/// Whether there is something to take: what is known to an editor of the value, or of the values below.
fn offers(schema: &Value) -> bool {
    let has = |name: &str| schema.get(name).is_some();
    let below = |name: &str| schema[name].as_array().into_iter().flatten().any(offers);
    has("default")
        || has("examples")
        || has("const")
        || has("$ref")
        || schema["type"] == "boolean"
        || is_mapping(&schema["type"])
        || below("anyOf")
        || below("oneOf")
        || offers_items(schema)
}

/// Fields are offered there.
fn is_mapping(kind: &Value) -> bool {
    kind == "object" || kind.as_array().is_some_and(|kinds| kinds.iter().any(|kind| kind == "object"))
}

fn offers_items(schema: &Value) -> bool {
    schema.get("items").is_some_and(offers)
}

#[test]
fn an_editor_finds_a_title_words_for_patterns_and_something_to_take_in_every_field() {
    let schema = studygraph::study::schema::schema(KINDS);
    let walk = Walk::all(&schema);
    assert_eq!(walk.faults, Vec::<String>::new());
    assert!(walk.fields > 200 && walk.patterns > 100, "{} fields, {} patterns", walk.fields, walk.patterns);
    // It does find what is not there.
    let mut poorer = schema;
    let pinion = &mut poorer["$defs"]["kind_geometry"]["properties"]["module"];
    for name in ["title", "examples", "patternErrorMessage"] {
        assert!(pinion.as_object_mut().unwrap().remove(name).is_some(), "{name}");
    }
    assert_eq!(Walk::all(&poorer).faults.len(), 3);
}

/// The server that most editors have for YAML: its diagnostics with the schema, its completions and its hover.
#[test]
fn the_yaml_language_server_finds_mistakes_and_speaks_in_words() {
    if let Some(skipped) = python::run("yaml_language_server.py", &[]).filter(|said| said.starts_with("SKIPPED")) {
        std::io::stderr().write_all(format!("\n{skipped}").as_bytes()).unwrap();
    }
}

/// Names of studies as they are written, their values to readers of YAML 1.2 as JSON, and whether these are names; `schema.py` holds
/// the schema to the same table.
const NAMES: &str = include_str!("../python/names_of_studies.tsv");

/// Tier: invariant; the program takes a name as it is written if and only if the schema takes its value.
#[test]
fn schema_and_program_agree_about_names() {
    let mut tried = 0;
    for line in NAMES.lines().filter(|line| !line.starts_with('#')) {
        let [written, _, name] = line.split('\t').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let text = format!(
            "study: {written}\nstages:\n  pair:\n    kind: geometry\n    module: 3 mm\n    \
             pinion: {{ teeth: 20, face_width: 20 mm, bore_radius: 10 mm }}\n    \
             gear: {{ teeth: 30, face_width: 20 mm, bore_radius: 10 mm }}\n"
        );
        let read = gearstudy::program::load_text(&text, Path::new("named.yaml"));
        let found = read.as_ref().map_or("-", |study| study.name.as_str());
        assert_eq!(found, name, "{written}");
        if name != "-" {
            assert_eq!(studygraph::study::identity::stated_name(&text).as_deref(), Some(name), "{written}");
        }
        tried += 1;
    }
    assert!(tried > 30, "{tried}");
}

/// Tier: invariant; limits of whole numbers that stand in the schema are those at which the program refuses.
#[test]
fn schema_and_program_agree_about_limits_of_whole_numbers() {
    let schema = studygraph::study::schema::schema(KINDS);
    let read = |seed: &str, count: &str| {
        let text = format!(
            "study: a\nseed: {seed}\nstages:\n  pair:\n    kind: geometry\n    module: 3 mm\n    pinion: {{ teeth: 20, \
             face_width: 20 mm, bore_radius: 10 mm }}\n    gear: {{ teeth: 30, face_width: 20 mm, bore_radius: 10 mm }}\n  \
             stiffness: {{ kind: stiffness, pair: pair }}\n  designs: {{ kind: modification, pair: pair, designs: {{ e: [] }} }}\n  \
             ste: {{ kind: ste, stiffness: stiffness, designs: designs, torque: {{ from: 1 N m, to: 9 N m, count: {count} }} }}\n"
        );
        gearstudy::program::load_text(&text, Path::new("limits.yaml")).is_ok()
    };
    let seed = &schema["properties"]["seed"];
    assert_eq!((seed["minimum"].as_i64(), seed["maximum"].as_i64()), (Some(0), Some(i64::MAX)));
    assert!(read("9223372036854775807", "2") && !read("9223372036854775808", "2") && !read("-1", "2"));
    let torque = &schema["$defs"]["kind_ste"]["properties"]["torque"]["anyOf"];
    let count = &torque[2]["properties"]["count"];
    assert_eq!((count["minimum"].as_i64(), count["maximum"].as_i64()), (Some(2), Some(100_000)), "{torque}");
    assert_eq!(torque[1]["maxItems"].as_i64(), Some(100_000));
    assert!(read("0", "100000") && !read("0", "100001") && !read("0", "1"));
}

/// Tier: invariant; no whole number of the schema is without both limits.
#[test]
fn every_whole_number_of_the_schema_has_its_limits() {
    fn integers(schema: &Value, wrong: &mut Vec<String>, found: &mut usize) {
        if schema["type"] == "integer" {
            *found += 1;
            if schema.get("minimum").is_none() || schema.get("maximum").is_none() {
                wrong.push(schema.to_string());
            }
        }
        match schema {
            Value::Object(inner) => inner.values().for_each(|inner| integers(inner, wrong, found)),
            Value::Array(inner) => inner.iter().for_each(|inner| integers(inner, wrong, found)),
            _ => {}
        }
    }
    let (mut wrong, mut found) = (Vec::new(), 0);
    integers(&studygraph::study::schema::schema(KINDS), &mut wrong, &mut found);
    assert!(wrong.is_empty() && found > 50, "{found}: {wrong:?}");
}

/// What another validator accepts in `schema.py` the program accepts too: names that are numbers, spaces that do not break a line,
/// block scalars and merged stages.
#[test]
fn the_program_accepts_what_the_schema_does() {
    let pair = "kind: geometry\n    pinion: { teeth: 20, face_width: 20 mm, bore_radius: 10 mm }\n    module:";
    for text in [
        format!("study: 2024\nstages:\n  pair:\n    {pair} 3 mm\n"),
        format!("study: 1e3\nstages:\n  pair:\n    {pair} 3 mm\n"),
        format!("study: true\nstages:\n  pair:\n    {pair} 3 mm\n"),
        format!(
            "study: a\nstages:\n  1:\n    {pair} 3 mm\n  d: {{ kind: modification, pair: 1, designs: {{ e: [] }} }}\n"
        ),
        format!("study: a\nstages:\n  pair:\n    {pair} 3\u{a0}mm\n"),
        format!("study: a\nstages:\n  pair:\n    {pair} 3\u{202f}mm\n"),
        format!("study: a\nstages:\n  pair:\n    {pair} |\n      3 mm\n"),
        format!("study: a\nstages:\n  <<: &s\n    pair:\n      {}\n", format!("{pair} 3 mm").replace('\n', "\n  ")),
    ] {
        let read = gearstudy::program::load_text(&text, Path::new("agreed.yaml"));
        let wrong = read.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(wrong.is_empty() || wrong.contains("it has one gear"), "{text}{wrong}");
    }
}
