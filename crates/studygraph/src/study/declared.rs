//! What is wrong with declarations, whoever hands them in: for the tests of a program that has kinds of stages.
//!
//! Must not know: which kinds there are.

use super::decode::Decoder;
use super::document::{Node, nothing, parse};
use super::overrides::Stages;
use crate::stage::Kind;
use declare::error::Place;
use declare::parameter::{Field, Presence, Shape};

/// Every field that no study could give, or whose default cannot be read, a sentence each.
#[must_use]
pub fn faults(kinds: &[&'static Kind]) -> Vec<String> {
    let mut faults = Vec::new();
    for kind in kinds {
        if kind.fields.iter().any(|field| field.name == "kind") {
            faults.push(format!("`kind` of {} is taken", kind.name));
        }
        walk(kind.fields, kind.name, &mut Vec::new(), &mut faults);
    }
    faults
}

/// Walks through all fields, also those of members; families that hold themselves end the walk.
fn walk(fields: &'static [Field], owner: &str, met: &mut Vec<&'static str>, faults: &mut Vec<String>) {
    let mut names: Vec<_> = fields.iter().map(|field| field.name).collect();
    names.sort_unstable();
    if names.windows(2).any(|pair| pair[0] == pair[1]) {
        faults.push(format!("a name stands twice among {names:?} of {owner}"));
    }
    for field in fields {
        faults.extend(fault(field).map(|fault| format!("{} of {owner}: {fault}", field.name)));
        let mut shape = &field.shape;
        while let Shape::List(item) | Shape::Map(item) = shape {
            shape = item;
        }
        match shape {
            Shape::Group(inner) => walk(inner, owner, met, faults),
            Shape::Member(members) if !met.contains(&field.name) => {
                met.push(field.name);
                for member in members() {
                    walk(member.fields, owner, met, faults);
                }
            }
            _ => {}
        }
    }
}

fn fault(field: &'static Field) -> Option<String> {
    let is_plain = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
    if !field.name.bytes().all(is_plain) {
        return Some("it can only have small letters, digits and `_`".to_owned());
    }
    if field.summary.len() < 4 {
        return Some("it says nothing of itself".to_owned());
    }
    if let Shape::Quantity { minimum, maximum, .. } = field.shape
        && minimum >= maximum
    {
        return Some(format!("{minimum} is not below {maximum}"));
    }
    let (fields, place) = (std::slice::from_ref(field), Place::default());
    let read = |node: &Node, what: &str| {
        let read = Decoder::new("", Stages::default()).record(node, fields, &[], what, place);
        read.err().map(|error| format!("{what}: {}", error.message))
    };
    if matches!(field.presence, Presence::Default(_)) {
        if let Some(fault) = read(&nothing(place), "the default") {
            return Some(fault);
        }
    } else if field.example.is_none() && is_written_freely(&field.shape) {
        return Some("it has neither a default nor an example".to_owned());
    }
    let example = field.example?;
    let given = match field.shape {
        Shape::Map(_) => format!("{}:\n  any: {example}", field.name),
        _ => format!("{}: {example}", field.name),
    };
    match parse(&given) {
        Ok(Some(node)) => read(&node, "the example"),
        _ => Some("its example is no YAML".to_owned()),
    }
}

/// Whether a value has no words to choose from, and is no name of a stage.
fn is_written_freely(shape: &Shape) -> bool {
    match shape {
        Shape::Quantity { .. } | Shape::AnyQuantity | Shape::Number { .. } | Shape::Integer { .. } | Shape::Text => {
            true
        }
        Shape::List(item) | Shape::Map(item) => is_written_freely(item),
        _ => false,
    }
}
