//! Sub-schemas that occur in several places, defined once.
//!
//! A place keeps its own annotations beside the reference, and readers merge both: every place says the same as before. Must not
//! know: the meaning of any field.

use std::collections::HashMap;

use serde_json::{Map, Value, json};

const DEFINITIONS: &str = "$defs";
const REFERENCE: &str = "$ref";

/// Annotations that a place keeps: first of the field, then of the form of its value.
const LAYERS: [&[&str]; 2] =
    [&["title", "description", "default"], &["examples", "errorMessage", "patternErrorMessage", "defaultSnippets"]];

/// Keywords of sub-schemas without a title of their own.
const UNTITLED: [&str; 5] = ["anyOf", "oneOf", "allOf", "items", "additionalProperties"];

/// Bytes of the smallest sub-schema that is worth a definition.
const MIN_BYTES: usize = 100;

/// The same schema, with a definition of each sub-schema that occurs more than once.
pub fn shared(schema: Value) -> Value {
    let Value::Object(schema) = schema else { return schema };
    let mut found = Found::default();
    let mut root = found.within(schema, "");
    let mut definitions = match root.remove(DEFINITIONS) {
        Some(Value::Object(declared)) => declared,
        _ => Map::new(),
    };
    // Inner parts come before outer ones.
    let mut finished: Vec<Value> = Vec::new();
    for part in found.parts {
        let mut schema = resolved(part.schema, &finished);
        if part.uses > 1 {
            let mut names = (1..).map(|count| match count {
                1 => part.field.clone(),
                _ => format!("{}_{count}", part.field),
            });
            let name = names.find(|name| !definitions.contains_key(name)).unwrap_or_default();
            let reference = json!({ REFERENCE: format!("#/{DEFINITIONS}/{name}") });
            definitions.insert(name, std::mem::replace(&mut schema, reference));
        }
        finished.push(schema);
    }
    root.insert(DEFINITIONS.to_owned(), Value::Object(definitions));
    resolved(Value::Object(root), &finished)
}

/// A sub-schema without the annotations of its places.
struct Part {
    /// The name of the first field that has it.
    field: String,
    /// With numbers of parts as references.
    schema: Value,
    uses: usize,
}

#[derive(Default)]
struct Found {
    parts: Vec<Part>,
    by_text: HashMap<String, usize>,
}

impl Found {
    /// A schema in its place: its annotations, and the number of the part.
    fn placed(&mut self, schema: Map<String, Value>, field: &str, layers: &[&[&str]]) -> Map<String, Value> {
        let Some((annotations, further)) = layers.split_first() else { return self.within(schema, field) };
        let (mut beside, part): (Map<_, _>, Map<_, _>) =
            schema.into_iter().partition(|(keyword, _)| annotations.contains(&keyword.as_str()));
        let text = Value::Object(part.clone()).to_string();
        if text.len() < MIN_BYTES || (beside.is_empty() && further.is_empty()) {
            beside.extend(self.placed(part, field, further));
            return beside;
        }
        // An editor shows an untitled sub-schema by the title of the field, so fields of other names do not share it.
        let is_untitled = |keyword: &&str| part.get(*keyword).is_some_and(|inner| !inner.is_boolean());
        let text = if UNTITLED.iter().any(is_untitled) { format!("{field} {text}") } else { text };
        let number = match self.by_text.get(&text) {
            Some(&number) => number,
            None => {
                let schema = Value::Object(self.placed(part, field, further));
                self.parts.push(Part { field: field.to_owned(), schema, uses: 0 });
                self.by_text.insert(text, self.parts.len() - 1);
                self.parts.len() - 1
            }
        };
        self.parts[number].uses += 1;
        beside.insert(REFERENCE.to_owned(), json!(number));
        beside
    }

    /// A schema whose sub-schemas are in their places.
    fn within(&mut self, mut schema: Map<String, Value>, field: &str) -> Map<String, Value> {
        let mut place = |inner: &mut Value, field: &str| {
            if let Value::Object(object) = inner {
                *inner = Value::Object(self.placed(std::mem::take(object), field, &LAYERS));
            }
        };
        for (keyword, inner) in &mut schema {
            match (keyword.as_str(), inner) {
                ("properties" | DEFINITIONS, Value::Object(fields)) => {
                    for (field, inner) in fields {
                        place(inner, field);
                    }
                }
                (_, Value::Array(ways)) if UNTITLED.contains(&keyword.as_str()) => {
                    for way in ways {
                        place(way, field);
                    }
                }
                (_, inner) if UNTITLED.contains(&keyword.as_str()) => place(inner, field),
                _ => {}
            }
        }
        schema
    }
}

/// A schema whose numbers are what the parts became: references, or the parts where they have one place.
fn resolved(schema: Value, parts: &[Value]) -> Value {
    match schema {
        Value::Array(all) => all.into_iter().map(|inner| resolved(inner, parts)).collect(),
        Value::Object(all) => {
            let mut merged = Map::new();
            for (keyword, inner) in all {
                let number = inner.as_u64().filter(|_| keyword == REFERENCE);
                let part = number.and_then(|number| parts.get(usize::try_from(number).ok()?));
                match part.and_then(Value::as_object) {
                    Some(part) => merged.extend(part.clone()),
                    None => drop(merged.insert(keyword, resolved(inner, parts))),
                }
            }
            Value::Object(merged)
        }
        other => other,
    }
}
