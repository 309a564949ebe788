//! The JSON form of REXS (`.rexsj`). Must not know: what any attribute means.

use serde::Deserialize;
use serde_json::Value;

use super::Refusal;
use super::model::{Attribute, Component, Model, Relation};

/// Largest text that is read as JSON \[bytes\]: each of its values takes more memory than an element of XML.
const MOST_BYTES: usize = 16 << 20;

#[derive(Deserialize)]
struct JsonFile {
    model: JsonModel,
}

#[derive(Deserialize)]
struct JsonModel {
    #[serde(default)]
    version: Value,
    #[serde(default)]
    relations: Vec<JsonRelation>,
    #[serde(default)]
    components: Vec<JsonComponent>,
}

#[derive(Deserialize)]
struct JsonRelation {
    #[serde(default, rename = "type")]
    kind: String,
    order: Option<u32>,
    #[serde(default)]
    refs: Vec<JsonReference>,
}

#[derive(Deserialize)]
struct JsonReference {
    id: Value,
    #[serde(default)]
    role: String,
}

#[derive(Deserialize)]
struct JsonComponent {
    id: Value,
    #[serde(default, rename = "type")]
    kind: String,
    #[serde(default)]
    attributes: Vec<JsonAttribute>,
}

#[derive(Deserialize)]
struct JsonAttribute {
    #[serde(default)]
    id: String,
    unit: Option<String>,
    floating_point: Option<Value>,
    integer: Option<Value>,
    string: Option<String>,
    #[serde(rename = "enum")]
    choice: Option<String>,
    boolean: Option<bool>,
}

/// The version and the model of a text.
pub(super) fn model(text: &str) -> Result<(String, Model), Refusal> {
    if text.len() > MOST_BYTES {
        return Err(Refusal::new(format!(
            "the file is larger than {} MiB, the most in JSON; save it as XML (`.rexs`)",
            MOST_BYTES >> 20
        )));
    }
    let JsonFile { model } = serde_json::from_str(text).map_err(|error| {
        let place = u32::try_from(error.line()).ok().zip(u32::try_from(error.column()).ok());
        Refusal { place, ..Refusal::new(format!("it is no file of REXS in JSON: {error}")) }
    })?;
    let components = model.components.into_iter().map(|component| Component {
        id: plain(&component.id),
        kind: component.kind,
        at: None,
        attributes: component.attributes.into_iter().map(attribute).collect(),
    });
    let relations = model.relations.into_iter().map(|relation| Relation {
        kind: relation.kind,
        order: relation.order,
        refs: relation.refs.into_iter().map(|one| (one.role, plain(&one.id))).collect(),
        at: None,
    });
    Ok((plain(&model.version), Model::new(components, relations, None, |_| None)?))
}

fn attribute(attribute: JsonAttribute) -> Attribute {
    let number = attribute.floating_point.or(attribute.integer).map(|value| plain(&value));
    let word = attribute.string.or(attribute.choice).or(attribute.boolean.map(|flag| flag.to_string()));
    Attribute::new(&attribute.id, attribute.unit.as_deref().unwrap_or(""), number.or(word), None)
}

/// A number or a text without quotes.
fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
