//! Numbers of a study around a word or a value: the input of the formulas by which messages find a remedy.
//!
//! Must not know: any formula.

use super::document::{Content, KeyValue, Node};
use super::notation::halves_of;
use super::overrides::Stages;
use crate::program::Around;
use declare::parameter::{Field, Shape};
use declare::units::{LENGTH, Quantity, foreign_quantity, parse_quantity};

/// The number of a scalar, in any unit that is known anywhere; of an interval its middle.
pub fn number(node: &Node) -> Option<Quantity> {
    interval(node).map(|(middle, _)| middle)
}

/// The number of a scalar and half the width of its interval in SI, 0 of a single number. None of an interval whose numbers are of
/// different kinds.
fn interval(node: &Node) -> Option<(Quantity, f64)> {
    let Content::Scalar { text, quoted: false } = &node.content else { return None };
    let read = |text: &str| {
        let foreign = || foreign_quantity(text).map(|(value, dimension)| Quantity { value, dimension, has_unit: true });
        parse_quantity(text).ok().or_else(foreign)
    };
    let Some([middle, half]) = halves_of(text) else { return Some((read(text)?, 0.0)) };
    let (middle, half) = (read(&middle)?, read(&half)?);
    let is_width = half.dimension == middle.dimension && half.has_unit == middle.has_unit && half.value >= 0.0;
    is_width.then_some((middle, half.value))
}

/// The number of a scalar that is no interval: a formula with an interval would need its width too.
fn single(node: &Node) -> Option<Quantity> {
    interval(node).and_then(|(middle, half)| (half == 0.0).then_some(middle))
}

/// The result of a remedy for the value at `node`, which stands among `pairs`.
pub fn remedied(
    remedy: fn(&Around) -> Option<String>,
    node: &Node,
    pairs: &[KeyValue],
    stages: Stages,
) -> Option<String> {
    let own = interval(node);
    remedy(&Around {
        value: own.map(|(middle, _)| middle),
        half: own.map_or(0.0, |(_, half)| half),
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
    pairs.iter().find(|pair| pair.key.eq_ignore_ascii_case(name)).and_then(|pair| single(&pair.node))
}

/// The number that all stages have at the end of these names, of those that have one.
fn anywhere(stages: &[KeyValue], path: &[&str]) -> Option<Quantity> {
    let of_stage = |stage: &KeyValue| {
        let mut node = &stage.node;
        for name in path {
            let Content::Mapping(pairs) = &node.content else { return None };
            node = &pairs.iter().find(|pair| pair.key == *name)?.node;
        }
        single(node)
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
    let read = parse_quantity(pair.node.plain()?).ok().filter(|read| read.dimension == LENGTH)?;
    Some((field.name, read.value))
}
