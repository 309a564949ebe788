//! Mappings that have a field or a member of a name: where a user has to write it.
//!
//! Must not know: any name.

use super::words::alternatives;
use crate::stage::Kind;
use declare::parameter::{Field, Shape};

/// Depth of mappings that are searched.
const DEPTH: usize = 4;
/// Kinds that a message names at most: a name that more kinds have says too little.
const MOST_KINDS: usize = 2;

/// Where `name` belongs: in a mapping below `fields`, else in stages of other kinds. None if it is in neither, or in too many.
pub fn place(name: &str, fields: &'static [Field], kinds: &[&'static Kind]) -> Option<String> {
    let own = nearest(name, fields);
    if !own.is_empty() && !own[0].is_empty() {
        return Some(alternatives(own.iter().map(String::as_str)));
    }
    let of_kind = |kind: &&'static Kind| {
        let ways = nearest(name, kind.fields);
        let stage = format!("a stage of `kind: {}`", kind.name);
        match ways.first().map(String::as_str)? {
            "" => Some(stage),
            _ => Some(format!("{} of {stage}", alternatives(ways.iter().map(String::as_str)))),
        }
    };
    let found: Vec<String> = kinds.iter().filter_map(of_kind).collect();
    (1..=MOST_KINDS).contains(&found.len()).then(|| found.join(" or "))
}

/// The shortest ways to a field or member of this name, as `a.b`; one that is empty is that of a field among `fields` themselves.
fn nearest(name: &str, fields: &'static [Field]) -> Vec<String> {
    let mut ways = Vec::new();
    below(name, fields, &mut Vec::new(), &mut ways);
    let least = ways.iter().map(Vec::len).min().unwrap_or_default();
    ways.retain(|way| way.len() == least);
    let mut shown: Vec<String> = ways.iter().map(|way| way.join(".")).collect();
    shown.dedup();
    shown
}

fn below(name: &str, fields: &'static [Field], way: &mut Vec<&'static str>, ways: &mut Vec<Vec<&'static str>>) {
    for field in fields {
        if field.name == name {
            ways.push(way.clone());
        } else if way.len() < DEPTH {
            way.push(field.name);
            inside(name, &field.shape, way, ways);
            way.pop();
        }
    }
}

fn inside(name: &str, shape: &'static Shape, way: &mut Vec<&'static str>, ways: &mut Vec<Vec<&'static str>>) {
    match shape {
        Shape::List(item) | Shape::Map(item) => inside(name, item, way, ways),
        Shape::Group(fields) => below(name, fields, way, ways),
        Shape::Member(members) => {
            for member in members() {
                if member.name == name {
                    ways.push(way.clone());
                } else if way.len() < DEPTH {
                    way.push(member.name);
                    below(name, member.fields, way, ways);
                    way.pop();
                }
            }
        }
        _ => {}
    }
}
