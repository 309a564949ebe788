//! What is wrong with declarations, whoever hands them in: for the tests of a program that has kinds of stages.
//!
//! Must not know: which kinds there are.

use super::decode::Decoder;
use super::document::nothing;
use super::overrides::Stages;
use super::words::example;
use crate::stage::Kind;
use declare::error::Place;
use declare::parameter::{Field, Presence, Shape};
use declare::units::RATIO;

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
    if let Shape::Quantity { dimension, minimum, maximum } = field.shape {
        if minimum >= maximum {
            return Some(format!("{minimum} is not below {maximum}"));
        }
        if dimension != RATIO && example(dimension, minimum, maximum).is_none() {
            return Some("it has no example".to_owned());
        }
    }
    if matches!(field.presence, Presence::Default(_)) {
        let fields = std::slice::from_ref(field);
        let place = Place::default();
        let read = Decoder::new("", Stages::default()).record(&nothing(place), fields, &[], "the default", place);
        return read.err().map(|error| error.message);
    }
    None
}
