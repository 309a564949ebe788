//! Stage kinds as JSON, and the names below a path, from the declarations that read them.
//!
//! Must not know: any kind by name.

use serde_json::{Value, json};

use super::describe::{Inside, holds};
use crate::stage::Kind;
use declare::parameter::{Field, Member, Presence, Shape, Span};

/// Every kind, without its fields.
#[must_use]
pub fn list(kinds: &[&'static Kind]) -> Value {
    kinds.iter().map(|kind| json!({ "name": kind.name, "summary": kind.summary })).collect()
}

/// A kind with all its fields and its example.
#[must_use]
pub fn kind(kind: &'static Kind) -> Value {
    json!({
        "name": kind.name, "summary": kind.summary, "version": kind.version,
        "fields": fields(kind.fields, &mut Vec::new()), "example": kind.example.trim(),
    })
}

/// What a path of names leads to from the fields of a kind: a field, or a member of a family; null where it leads nowhere.
#[must_use]
pub fn within(kind: &'static Kind, path: &str) -> Value {
    match follow(kind, path) {
        Some(Found::Field(found)) => field(found, &mut Vec::new()),
        Some(Found::Member(found)) => member(found, &mut Vec::new()),
        None => Value::Null,
    }
}

/// Names that may follow a path from the fields of a kind, empty for the kind itself, and what they mean.
#[must_use]
pub fn below(kind: &'static Kind, path: &str) -> Vec<(&'static str, &'static str)> {
    let inside = match path {
        "" => Inside::Fields(kind.fields),
        path => match follow(kind, path) {
            Some(Found::Field(found)) => Inside::of(&found.shape),
            Some(Found::Member(found)) => Inside::Fields(found.fields),
            None => Inside::Nothing,
        },
    };
    match inside {
        Inside::Fields(all) => all.iter().map(|field| (field.name, field.summary)).collect(),
        Inside::Members(all) => all.iter().map(|member| (member.name, member.summary)).collect(),
        Inside::Nothing => Vec::new(),
    }
}

/// What a path leads to.
enum Found {
    Field(&'static Field),
    Member(&'static Member),
}

fn follow(kind: &'static Kind, path: &str) -> Option<Found> {
    let mut here = Inside::Fields(kind.fields);
    let mut found = None;
    for name in path.split('.') {
        let next = match here {
            Inside::Fields(all) => Found::Field(all.iter().find(|field| field.name == name)?),
            Inside::Members(all) => Found::Member(all.iter().find(|member| member.name == name)?),
            Inside::Nothing => return None,
        };
        here = match &next {
            Found::Field(field) => Inside::of(&field.shape),
            Found::Member(member) => Inside::Fields(member.fields),
        };
        found = Some(next);
    }
    found
}

/// Families that are being described: one may hold itself.
type Families = Vec<Vec<&'static str>>;

fn fields(all: &'static [Field], families: &mut Families) -> Value {
    all.iter().map(|one| field(one, families)).collect()
}

fn field(field: &'static Field, families: &mut Families) -> Value {
    let (presence, default) = match field.presence {
        Presence::Required => ("required", None),
        Presence::Optional => ("optional", None),
        Presence::Default(default) => ("default", Some(default)),
    };
    let values = match field.span {
        Span::Single => "one",
        Span::Axis { .. } => "axis",
        Span::Range => "range",
    };
    let mut value = json!({
        "name": field.name, "summary": field.summary, "holds": holds(&field.shape), "presence": presence,
        "default": default, "values": values,
    });
    inside(&mut value, &field.shape, families);
    value
}

fn member(member: &'static Member, families: &mut Families) -> Value {
    json!({ "name": member.name, "summary": member.summary, "fields": fields(member.fields, families) })
}

/// What is named below a field: words, fields, members.
fn inside(value: &mut Value, shape: &'static Shape, families: &mut Families) {
    match shape {
        Shape::Choice(words) => {
            value["words"] = words.iter().map(|word| json!({ "name": word.name, "summary": word.summary })).collect();
        }
        Shape::List(item) | Shape::Map(item) => inside(value, item, families),
        Shape::Group(inner) => value["fields"] = fields(inner, families),
        Shape::Member(members) => {
            let names: Vec<_> = members().iter().map(|member| member.name).collect();
            if families.contains(&names) {
                value["members"] = json!(names);
                return;
            }
            families.push(names);
            value["members"] = members().iter().map(|one| member(one, families)).collect();
            families.pop();
        }
        _ => {}
    }
}
