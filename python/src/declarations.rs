//! The declarations of everything that Python can state, for `gearstudy/declared.py`, which is written from them.
//!
//! Must not know: how that is written.

use pyo3::prelude::*;
use serde_json::{Map, Value, json};

use declare::declared::Declared;
use declare::parameter::{Field, Member, Presence, Shape, Span};
use gearmesh::gear::modification::FAMILIES;
use gearmesh::optimize;
use gearstudy::stage::kinds::geometry::stated::StatedGears;
use gearstudy::stage::kinds::stiffness::Deflection;

use crate::stiffness::CYCLE;

/// All of them, as JSON: what a pair, a stiffness and a mesh cycle are made of, and the members of each family.
#[pyfunction]
#[must_use]
pub fn declarations() -> String {
    let families: Vec<Value> = FAMILIES.iter().map(|family| member(&family.member)).collect();
    let searches: Vec<Value> = optimize::METHODS.iter().map(|method| member(&method.member)).collect();
    let all = json!({
        "Pair": { "summary": StatedGears::MEMBER.summary, "fields": fields(StatedGears::MEMBER.fields) },
        "Stiffness": { "summary": Deflection::MEMBER.summary, "fields": fields(Deflection::MEMBER.fields) },
        "cycle": fields(CYCLE),
        "modifications": families,
        "searches": searches,
    });
    all.to_string()
}

fn member(member: &Member) -> Value {
    json!({ "name": member.name, "summary": member.summary, "fields": fields(member.fields) })
}

fn fields(fields: &[Field]) -> Vec<Value> {
    // A file is read by whoever reads a study; Python has its own ways to arrays.
    fields.iter().filter(|field| !matches!(field.shape, Shape::File)).map(field).collect()
}

fn field(field: &Field) -> Value {
    let mut told = Map::new();
    told.insert("name".to_owned(), json!(field.name));
    told.insert("summary".to_owned(), json!(field.summary));
    told.insert("required".to_owned(), json!(field.presence == Presence::Required));
    if let Presence::Default(text) = field.presence {
        told.insert("default".to_owned(), json!(text));
    }
    told.insert("array".to_owned(), json!(field.span == Span::Range));
    told.insert("shape".to_owned(), shape(&field.shape));
    Value::Object(told)
}

fn shape(of: &Shape) -> Value {
    match *of {
        Shape::Quantity { dimension, minimum, maximum } => {
            json!({ "type": "quantity", "unit": dimension.si(), "minimum": minimum, "maximum": maximum })
        }
        Shape::Number { minimum, maximum } => json!({ "type": "number", "minimum": minimum, "maximum": maximum }),
        Shape::Integer { minimum, maximum, .. } => {
            json!({ "type": "integer", "minimum": minimum, "maximum": maximum })
        }
        Shape::Flag => json!({ "type": "flag" }),
        Shape::Choice(choices) => {
            json!({ "type": "choice", "words": choices.iter().map(|choice| choice.name).collect::<Vec<_>>() })
        }
        Shape::List(item) => json!({ "type": "list", "item": shape(item) }),
        Shape::Group(inside) => json!({ "type": "group", "fields": fields(inside) }),
        Shape::Member(members) => {
            json!({ "type": "member", "members": members().iter().map(member).collect::<Vec<_>>() })
        }
        Shape::Text
        | Shape::File
        | Shape::AnyQuantity
        | Shape::Reference(_)
        | Shape::Map(_)
        | Shape::Overrides(_)
        | Shape::Varied(_) => json!({ "type": "text" }),
    }
}
