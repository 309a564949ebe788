//! Numbers of a study around a word or a value: the input of the formulas by which messages find a remedy.
//!
//! Must not know: any formula.

use super::decode::plain;
use super::document::{Content, KeyValue, Node};
use super::overrides::Stages;
use super::quantity::interval::middle;
use crate::program::Around;
use declare::parameter::{Field, Shape};
use declare::units::{LENGTH, Quantity, foreign_quantity, parse_quantity};

/// The number of a scalar, in any unit that is known anywhere; of an interval its middle.
pub fn number(node: &Node) -> Option<Quantity> {
    let Content::Scalar { text, quoted: false } = &node.content else { return None };
    let middle = middle(text);
    let text = middle.as_deref().unwrap_or(text);
    let foreign = || foreign_quantity(text).map(|(value, dimension)| Quantity { value, dimension, has_unit: true });
    parse_quantity(text).ok().or_else(foreign)
}

/// The result of a remedy for the value at `node`, which stands among `pairs`.
pub fn remedied(
    remedy: fn(&Around) -> Option<String>,
    node: &Node,
    pairs: &[KeyValue],
    stages: Stages,
) -> Option<String> {
    remedy(&Around {
        value: number(node),
        beside: &|name| beside(pairs, name),
        anywhere: &|path| anywhere(stages.pairs, path),
    })
}

/// The rule by which a field follows from the quantity of another kind that stands in its place; `pairs` stand beside it.
pub fn rule(field: &Field, node: &Node, pairs: &[KeyValue], stages: Stages) -> Option<String> {
    let shape = if let Shape::List(item) = field.shape { item } else { &field.shape };
    let Shape::Quantity { dimension, .. } = *shape else { return None };
    let first = if let Content::Sequence(items) = &node.content { items.first()? } else { node };
    let from = number(first)?.dimension;
    let mut rules = stages.derived.iter().filter(|derived| derived.field == field.name && derived.from == from);
    let derived = rules.find(|_| from != dimension)?;
    let remedy = derived.remedy.and_then(|remedy| remedied(remedy, node, pairs, stages));
    Some(remedy.map_or_else(|| derived.rule.to_owned(), |remedy| format!("{}; {remedy}", derived.rule)))
}

fn beside(pairs: &[KeyValue], name: &str) -> Option<Quantity> {
    pairs.iter().find(|pair| pair.key.eq_ignore_ascii_case(name)).and_then(|pair| number(&pair.node))
}

/// The number that all stages have at the end of these names, of those that have one.
fn anywhere(stages: &[KeyValue], path: &[&str]) -> Option<Quantity> {
    let of_stage = |stage: &KeyValue| {
        let mut node = &stage.node;
        for name in path {
            let Content::Mapping(pairs) = &node.content else { return None };
            node = &pairs.iter().find(|pair| pair.key == *name)?.node;
        }
        number(node)
    };
    let mut found = stages.iter().filter_map(of_stage);
    let first = found.next()?;
    found.all(|other| other == first).then_some(first)
}

/// Whether a field has a number.
pub fn is_number(shape: &Shape) -> bool {
    matches!(shape, Shape::Quantity { .. } | Shape::Number { .. })
}

/// A length that stands in a mapping by itself.
pub fn length(fields: &'static [Field], pair: &KeyValue) -> Option<(&'static str, f64)> {
    let is_length = |field: &&Field| matches!(field.shape, Shape::Quantity { dimension: LENGTH, .. });
    let field = fields.iter().find(|field| field.name == pair.key).filter(is_length)?;
    let read = parse_quantity(plain(&pair.node)?).ok().filter(|read| read.dimension == LENGTH)?;
    Some((field.name, read.value))
}
