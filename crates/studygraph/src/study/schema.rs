//! The JSON schema (draft 2020-12) of a study, made from the declarations that also read it, for editors.
//!
//! What JSON can say is said: names, required fields, words, numbers, the look of a quantity. The order follows the
//! declarations, so the same program always gives the same text. Must not know: any kind by name.

mod leaf;
mod shared;

use serde_json::{Map, Value, json};

use super::assemble::{KEYS, SET};
use super::document::{Content, Node, parse};
use super::files::FILES;
use super::quantity::interval::is_single;
use super::words;
use crate::stage::Kind;
use declare::parameter::{Field, Member, Presence, Shape, Span};
use declare::record::varied::Within;

/// The schema of studies made of stages of these kinds, each field in its place.
#[must_use]
pub fn schema(kinds: &[&'static Kind]) -> Value {
    let mut families = Families::default();
    let mut properties = families.properties(KEYS, false);
    let names: Vec<_> = kinds.iter().map(|kind| json!({ "const": kind.name, "description": kind.summary })).collect();
    properties.insert(
        "stages".to_owned(),
        json!({
            "title": "Stages",
            "description": "The stages by name; each reads the tables of others.",
            "type": "object",
            "minProperties": 1,
            "propertyNames": leaf::names(),
            "additionalProperties": { "$ref": "#/$defs/stage" },
        }),
    );
    properties.insert(
        SET.to_owned(),
        json!({
            "title": "Set",
            "description": "Other values for fields, by their paths: `pair.pinion.face_width`.",
            "type": "object",
            "minProperties": 1,
            "propertyNames": leaf::paths(),
            "examples": [{ "pair.pinion.face_width": "22 mm" }],
        }),
    );
    properties.insert(
        FILES.to_owned(),
        json!({
            "title": "Files",
            "description": "Texts of the CSV files that stages name, where they do not lie beside the study.",
            "type": "object",
            "additionalProperties": { "type": "string" },
        }),
    );
    if let Some(Value::Object(study)) = properties.get_mut("study") {
        study.extend(leaf::name().as_object().cloned().unwrap_or_default());
    }
    let conditions: Vec<_> = kinds
        .iter()
        .map(|kind| {
            json!({
                "if": { "properties": { "kind": { "const": kind.name } }, "required": ["kind"] },
                "then": { "$ref": format!("#/$defs/kind_{}", kind.name) },
            })
        })
        .collect();
    let mut definitions = Map::new();
    definitions.insert(
        "stage".to_owned(),
        json!({
            "type": "object",
            "required": ["kind"],
            "properties": { "kind": { "title": "Kind", "description": "What the stage computes.", "oneOf": names } },
            "allOf": conditions,
        }),
    );
    for kind in kinds {
        let mut object = families.object(kind.fields, false);
        object["title"] = json!(leaf::title(kind.name));
        object["description"] = json!(kind.summary);
        if let Some(Value::Object(properties)) = object.get_mut("properties") {
            properties.shift_insert(
                0,
                "kind".to_owned(),
                json!({ "title": "Kind", "description": kind.summary, "const": kind.name }),
            );
        }
        definitions.insert(format!("kind_{}", kind.name), object);
    }
    for (name, definition) in families.finish() {
        definitions.insert(name, definition);
    }
    let mut required: Vec<_> = required(KEYS);
    required.push("stages");
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A study of gearstudy",
        "type": "object",
        "required": required,
        "additionalProperties": false,
        "properties": properties,
        "$defs": definitions,
    })
}

/// The same as text for a file: what occurs more than once is defined once, and a level is indented by a tab.
#[must_use]
pub fn schema_text(kinds: &[&'static Kind]) -> String {
    let text = format!("{:#}", shared::shared(schema(kinds)));
    let indented = |line: &str| {
        let words = line.trim_start();
        "\t".repeat((line.len() - words.len()) / 2) + words + "\n"
    };
    text.lines().map(indented).collect()
}

fn required(fields: &[Field]) -> Vec<&'static str> {
    fields.iter().filter(|field| field.presence == Presence::Required).map(|field| field.name).collect()
}

/// Families that have been met: each is defined once, for it may hold itself.
#[derive(Default)]
struct Families {
    met: Vec<Family>,
}

struct Family {
    key: (Vec<&'static str>, bool),
    name: String,
    schema: Value,
}

impl Families {
    fn finish(self) -> impl Iterator<Item = (String, Value)> {
        self.met.into_iter().map(|family| (family.name, family.schema))
    }

    /// A mapping of declared fields and nothing else.
    fn object(&mut self, fields: &'static [Field], chooses: bool) -> Value {
        let properties = self.properties(fields, chooses);
        let mut object = json!({ "type": "object", "additionalProperties": false, "properties": properties });
        let required = required(fields);
        match fields.iter().find(|field| matches!(field.shape, Shape::File)) {
            // What must be there may stand in the file.
            Some(file) => object["anyOf"] = json!([{ "required": required }, { "required": [file.name] }]),
            None if required.is_empty() => {}
            None => object["required"] = json!(required),
        }
        object
    }

    fn properties(&mut self, fields: &'static [Field], chooses: bool) -> Map<String, Value> {
        fields.iter().map(|field| (field.name.to_owned(), self.field(field, chooses))).collect()
    }

    fn field(&mut self, field: &'static Field, chooses: bool) -> Value {
        let mut described = Map::new();
        described.insert("title".to_owned(), json!(leaf::title(field.name)));
        described.insert("description".to_owned(), json!(description(field)));
        let shape = self.shape(&field.shape, field, chooses || field.chooses);
        if let Value::Object(shape) = shape {
            described.extend(shape);
        }
        if let Presence::Default(text) = field.presence
            && let Ok(Some(node)) = parse(text)
        {
            described.insert("default".to_owned(), plain(&node));
            // The default is the better example.
            described.shift_remove("examples");
        }
        Value::Object(described)
    }

    fn shape(&mut self, shape: &'static Shape, field: &Field, chooses: bool) -> Value {
        let example = words::example_of(field);
        match shape {
            Shape::Quantity { dimension, minimum, maximum } => {
                let range = (*minimum, *maximum);
                spread(&|rounded| leaf::quantity(*dimension, range, example, rounded), field, chooses)
            }
            Shape::Number { minimum, maximum } => {
                spread(&|rounded| leaf::number((*minimum, *maximum), example, rounded), field, chooses)
            }
            Shape::AnyQuantity => leaf::any_quantity(example),
            Shape::Integer { minimum, maximum, multiple } => leaf::integer(*minimum, *maximum, *multiple, example),
            Shape::Flag => json!({ "type": "boolean" }),
            Shape::Text => leaf::text(example),
            Shape::File => leaf::file(),
            Shape::Choice(choices) => {
                let choices =
                    choices.iter().map(|choice| json!({ "const": choice.name, "description": choice.summary }));
                json!({ "oneOf": choices.collect::<Vec<_>>() })
            }
            Shape::Reference(kinds) => leaf::reference(kinds, example),
            Shape::List(of) => {
                let item = self.shape(of, field, chooses);
                let mut ways = vec![json!({ "type": "array", "items": item }), item.clone()];
                if matches!(of, Shape::Quantity { .. } | Shape::Number { .. }) && item.get("examples").is_some() {
                    ways.extend(leaf::many(&item));
                }
                json!({ "anyOf": ways })
            }
            Shape::Map(item) => json!({ "type": "object", "additionalProperties": self.shape(item, field, chooses) }),
            Shape::Group(fields) => self.object(fields, chooses),
            Shape::Member(members) => json!({ "$ref": format!("#/$defs/{}", self.family(members(), field, chooses)) }),
            // Which fields there are depends on the kind of the other stage, which no schema can look up.
            Shape::Overrides(_) => json!({ "type": "object", "propertyNames": { "not": { "const": "kind" } } }),
            Shape::Varied(_) => varied(),
        }
    }

    /// The name under which a family is defined.
    fn family(&mut self, members: &'static [Member], field: &Field, chooses: bool) -> String {
        let key = (members.iter().map(|member| member.name).collect::<Vec<_>>(), chooses);
        if let Some(family) = self.met.iter().find(|family| family.key == key) {
            return family.name.clone();
        }
        let mut name = format!("family_{}", field.name);
        while self.met.iter().any(|family| family.name == name) {
            name.push('_');
        }
        let at = self.met.len();
        self.met.push(Family { key, name: name.clone(), schema: Value::Null });

        let mut alternatives: Vec<Value> = Vec::new();
        let mut properties = Map::new();
        for member in members {
            if required(member.fields).is_empty() {
                alternatives.push(json!({ "const": member.name, "description": member.summary }));
            }
            let mut object = self.object(member.fields, chooses);
            if required(member.fields).is_empty() {
                object["type"] = json!(["object", "null"]);
            }
            object["title"] = json!(leaf::title(member.name));
            object["description"] = json!(member.summary);
            properties.insert(member.name.to_owned(), object);
        }
        alternatives.push(json!({
            "type": "object",
            "minProperties": 1,
            "maxProperties": 1,
            "additionalProperties": false,
            "properties": properties,
        }));
        self.met[at].schema = json!({ "anyOf": alternatives });
        name
    }
}

/// Columns and what is varied; which units there are depends on the field.
fn varied() -> Value {
    let number = leaf::any_quantity(Some("20 mm"));
    let mut properties = json!({
        "field": {
            "title": "Field",
            "type": "string",
            "description": "Path of the field: stage.field, such as `pair.pinion.face_width`.",
            "examples": ["pair.pinion.face_width"],
        },
        "values": {
            "title": "Values",
            "description": "The values, one or several.",
            "anyOf": [number, { "type": "array", "minItems": 1, "items": number }],
        },
        "follows": {
            "title": "Follows",
            "type": "string",
            "description": "In a fit: what it is for the values of the other columns, each in its own unit.",
            "examples": ["2 * bore"],
        },
    });
    if let (Value::Object(properties), Value::Object(ends)) = (&mut properties, leaf::ends(&number)) {
        properties.extend(ends);
        properties.extend(spread_of(&number));
    }
    json!({
        "type": "object",
        "minProperties": 1,
        "propertyNames": leaf::columns(),
        "additionalProperties": {
            "type": "object",
            "required": ["field"],
            "additionalProperties": false,
            "properties": properties,
        },
    })
}

/// What a column has whose field is distributed.
fn spread_of(number: &Value) -> Map<String, Value> {
    let one = |title: &str, description: &str, mut schema: Value| {
        schema["title"] = json!(title);
        schema["description"] = json!(description);
        (title.to_lowercase(), schema)
    };
    let text = |example: &str| json!({ "type": ["string", "number"], "examples": [example] });
    Map::from_iter([
        one("Within", "So far to either side of the value in the study, or of `mean`.", text("± 2 um")),
        one("Shape", "How values lie within the tolerance.", json!({ "enum": Within::WORDS, "default": "uniform" })),
        one(
            "Iso1328",
            "Within the slope tolerance of this class of ISO 1328-1.",
            json!({ "type": "integer", "minimum": 1, "maximum": 11, "examples": [7] }),
        ),
        one("Normal", "Normally distributed with this standard deviation; `from` and `to` cut it off.", text("1 um")),
        one("Mean", "The middle, where that is not the value in the study.", number.clone()),
        one("Mode", "The most frequent value, between `from` and `to`.", number.clone()),
    ])
}

/// The summary, and what the schema cannot say.
fn description(field: &Field) -> String {
    let range = match field.shape {
        Shape::Quantity { dimension, minimum, maximum } => {
            words::range(minimum, maximum, |value| words::quantity(value, dimension))
        }
        Shape::Reference(kinds) => Some(words::stage_of(kinds)),
        _ => None,
    };
    range.map_or(field.summary.to_owned(), |range| format!("{} ({range})", field.summary))
}

/// One value, and the other ways in which a field's span lets it be given; `single` is whether it may be an interval.
fn spread(single: &dyn Fn(bool) -> Value, field: &Field, chooses: bool) -> Value {
    match field.span {
        Span::Axis { .. } => leaf::axis(&single(false)),
        Span::Range if chooses => json!({
            "anyOf": [single(true), { "type": "array", "minItems": 2, "maxItems": 2, "items": single(false) }],
        }),
        Span::Single | Span::Range => single(is_single(field)),
    }
}

/// A tree as JSON, as far as YAML itself would tell numbers from words.
pub(super) fn plain(node: &Node) -> Value {
    match &node.content {
        _ if node.is_null() => Value::Null,
        Content::Scalar { text, quoted: false } => match text.as_str() {
            "true" => json!(true),
            "false" => json!(false),
            number => number.parse::<serde_json::Number>().map_or_else(|_| json!(text), Value::Number),
        },
        Content::Scalar { text, .. } => json!(text),
        Content::Sequence(items) => items.iter().map(plain).collect(),
        Content::Mapping(pairs) => {
            pairs.iter().map(|pair| (pair.key.clone(), plain(&pair.node))).collect::<Map<_, _>>().into()
        }
    }
}
