//! Mappings that have a field or a member of a name: where a user has to write it.
//!
//! Must not know: any name.

use super::words::alternatives;
use crate::stage::Kind;
use declare::parameter::{Field, Shape};
use declare::units::{ANGLE, FORCE, LENGTH, RATIO};

/// Depth of mappings that are searched.
const DEPTH: usize = 4;
/// Kinds that a message names at most: a name that more kinds have says too little.
const MOST_KINDS: usize = 2;

/// Which of the fields of a name count.
#[derive(Clone, Copy, PartialEq)]
pub enum Counted {
    All,
    /// Those whose name says which quantity they are. The others, such as `angle` of a chamfer, mean something by the mapping around
    /// them, and count in the mappings next to the word alone.
    Telling,
}

/// Where `name` belongs: in a mapping below `fields`, else in stages of other kinds. None if it is in neither, or in too many.
pub fn place(name: &str, fields: &'static [Field], kinds: &[&'static Kind], counted: Counted) -> Option<String> {
    let within = |depth: usize| if counted == Counted::All { usize::MAX } else { depth };
    let own = nearest(name, fields, within(1));
    if !own.is_empty() && !own[0].is_empty() {
        return Some(alternatives(own.iter().map(String::as_str)));
    }
    let of_kind = |kind: &&'static Kind| {
        let ways = nearest(name, kind.fields, within(0));
        let stage = format!("a stage of `kind: {}`", kind.name);
        match ways.first().map(String::as_str)? {
            "" => Some(stage),
            _ => Some(format!("{} of {stage}", alternatives(ways.iter().map(String::as_str)))),
        }
    };
    let found: Vec<String> = kinds.iter().filter_map(of_kind).collect();
    (1..=MOST_KINDS).contains(&found.len()).then(|| found.join(" or "))
}

/// Whether a stage of some kind has a field or a member of this name.
pub fn is_known(name: &str, kinds: &[&'static Kind]) -> bool {
    kinds.iter().any(|kind| !nearest(name, kind.fields, usize::MAX).is_empty())
}

/// Whether a name says which quantity it is, wherever it stands: one of several words, one of a mapping, or one of a quantity that
/// few fields have.
fn is_telling(name: &str, shape: Option<&Shape>) -> bool {
    let by_shape = match shape {
        Some(Shape::Group(_) | Shape::Member(_) | Shape::Map(_)) => true,
        Some(Shape::Quantity { dimension, .. }) => ![LENGTH, ANGLE, FORCE, RATIO].contains(dimension),
        _ => false,
    };
    name.contains('_') || by_shape
}

/// The shortest ways to a field or member of this name, as `a.b`; one that is empty is that of a field among `fields` themselves.
/// Names that say little count down to this depth.
fn nearest(name: &str, fields: &'static [Field], depth: usize) -> Vec<String> {
    let mut ways = Vec::new();
    below(name, fields, &mut Vec::new(), &mut |way: &[&'static str], shape: Option<&Shape>| {
        if way.len() <= depth || is_telling(name, shape) {
            ways.push(way.to_vec());
        }
    });
    let least = ways.iter().map(Vec::len).min().unwrap_or_default();
    ways.retain(|way| way.len() == least);
    let mut shown: Vec<String> = ways.iter().map(|way| way.join(".")).collect();
    shown.dedup();
    shown
}

/// Receives every way to a field or member of the name, and the shape of the field.
type Visit<'a> = dyn FnMut(&[&'static str], Option<&'static Shape>) + 'a;

fn below(name: &str, fields: &'static [Field], way: &mut Vec<&'static str>, visit: &mut Visit) {
    for field in fields {
        if field.name == name {
            visit(way, Some(&field.shape));
        } else if way.len() < DEPTH {
            way.push(field.name);
            inside(name, &field.shape, way, visit);
            way.pop();
        }
    }
}

fn inside(name: &str, shape: &'static Shape, way: &mut Vec<&'static str>, visit: &mut Visit) {
    match shape {
        Shape::List(item) | Shape::Map(item) => inside(name, item, way, visit),
        Shape::Group(fields) => below(name, fields, way, visit),
        Shape::Member(members) => {
            for member in members() {
                if member.name == name {
                    visit(way, None);
                } else if way.len() < DEPTH {
                    way.push(member.name);
                    below(name, member.fields, way, visit);
                    way.pop();
                }
            }
        }
        _ => {}
    }
}
