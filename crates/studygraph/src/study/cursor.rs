//! What stands at a place of a study that is being written: what it means, where it is declared, what else could stand there.
//!
//! For editors, which ask while a text is no study yet. So nothing is decoded: the tree is walked beside the declarations,
//! and for what could stand at the cursor a word is put there and looked for. Must not know: how an editor asks.

use std::ops::Range;

use super::assemble::KEYS;
use super::describe;
use super::document::{Content, KeyValue, Node, parse};
use super::path::kind_of;
use super::words;
use crate::program::Program;
use crate::stage::Kind;
use declare::error::Place;
use declare::parameter::{Field, Member, Presence, Shape};
use declare::units::{Dimension, RATIO, in_unit, parse_quantity, split_quantity};
use naming::Naming;

mod naming;

/// What is known of a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// What it is, in a few lines.
    pub described: String,
    /// Where what it names is declared.
    pub declared: Option<Place>,
}

/// What could stand at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Offer {
    pub label: String,
    pub detail: String,
    /// What is written where it is taken.
    pub text: String,
}

/// What could stand at a place, and the bytes of the text in whose place it is written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Offers {
    pub range: Range<usize>,
    pub all: Vec<Offer>,
}

/// What stands beside a value.
#[derive(Clone, Copy)]
struct Beside<'a> {
    /// The stage that it is in, and whose fields are there; none in the head of a study.
    stage: Option<&'a str>,
    kind: Option<&'static Kind>,
    /// The fields that could stand beside its own, and those that do.
    fields: &'static [Field],
    pairs: &'a [KeyValue],
    /// In a map: all that is in it, and the name of the value.
    map: &'a [KeyValue],
    name: Option<&'a str>,
}

/// What the cursor is at.
enum Here<'a> {
    /// A key of a mapping with these fields; others of its keys.
    Key {
        fields: &'static [Field],
        key: &'a str,
        pairs: &'a [KeyValue],
        kind: bool,
    },
    /// A name of a stage.
    Stage(&'a KeyValue),
    /// The kind of a stage.
    Kind(&'a str),
    Member(&'static [Member], &'a str),
    /// A name of the user's own, for a value of a field.
    Own(&'static Field, &'a str, Beside<'a>),
    Value(&'static Field, &'static Shape, &'a Node, Beside<'a>),
}

/// A text whose tree is walked to a byte of it.
struct Walk<'a> {
    root: &'a Node,
    offset: usize,
    program: &'a Program,
}

/// What stands at a byte of the text; nothing where nothing is known of it.
#[must_use]
pub fn at(text: &str, offset: usize, program: &Program) -> Option<Found> {
    let root = parse(text).ok()??;
    let plain = |described: String| Some(Found { described, declared: None });
    let naming = |field, beside| Naming::of(field, beside, stages(&root), program);
    match (Walk { root: &root, offset, program }).locate()? {
        Here::Key { key: "kind", kind: true, .. } => plain("kind: what the stage computes".to_owned()),
        Here::Key { fields, key, .. } => plain(describe::field(fields.iter().find(|field| field.name == key)?)),
        Here::Stage(stage) => plain(of_kind(kind_of(stage, program.kinds)?)),
        Here::Kind(name) => plain(of_kind(program.kind(name)?)),
        Here::Member(members, name) => plain(of_member(members.iter().find(|member| member.name == name)?)),
        Here::Own(field, name, beside) => naming(field, beside)?.found_name(name),
        Here::Value(field, shape, node, beside) => {
            let Content::Scalar { text: word, .. } = &node.content else { return plain(describe::field(field)) };
            if let Some(found) = naming(field, beside).and_then(|naming| naming.found(text, node, offset)) {
                return Some(found);
            }
            match shape {
                Shape::Reference(_) => {
                    let stage = stages(&root).iter().find(|stage| stage.key == *word)?;
                    let described = kind_of(stage, program.kinds).map_or_else(String::new, of_kind);
                    Some(Found { described, declared: Some(stage.place) })
                }
                Shape::Choice(choices) => {
                    let choice = choices.iter().find(|choice| choice.name == word)?;
                    plain(format!("{}: {}", choice.name, choice.summary))
                }
                Shape::Member(members) => plain(of_member(members().iter().find(|member| member.name == word)?)),
                _ => plain(describe::field(field)),
            }
        }
    }
}

/// Stands for what is not written yet.
const WORD: &str = "zzzz";

/// What could stand at a byte of the text, in the place of what is there.
#[must_use]
pub fn offers(text: &str, offset: usize, program: &Program) -> Offers {
    let in_word = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    let before = text[..offset].trim_end_matches(in_word).len();
    let after = text.len() - text[offset..].trim_start_matches(in_word).len();
    // A dash by itself begins an item.
    let before = before + usize::from(text[before..].starts_with("- ") || &text[before..offset] == "-");
    let range = before..after.max(before);
    // As a value or a key that has its colon, else as a key with a value.
    for word in [WORD.to_owned(), format!("{WORD}: 0")] {
        let changed = format!("{}{word}{}", &text[..before], &text[after..]);
        let Ok(Some(root)) = parse(&changed) else { continue };
        let Some(here) = (Walk { root: &root, offset: before, program }).locate() else { continue };
        let naming = |field, beside| Naming::of(field, beside, stages(&root), program);
        let named = match here {
            Here::Own(field, _, beside) | Here::Value(field, Shape::Map(_), _, beside) => {
                naming(field, beside).and_then(|naming| naming.own_names(range.clone()))
            }
            Here::Value(field, _, node, beside) => {
                naming(field, beside).and_then(|naming| naming.offers(text, node, offset))
            }
            _ => None,
        };
        return named.unwrap_or_else(|| Offers { range, all: of(&here, &root, program) });
    }
    Offers::default()
}

fn of(here: &Here, root: &Node, program: &Program) -> Vec<Offer> {
    match here {
        Here::Key { fields, pairs, kind, .. } => {
            let is_free = |name: &str| !pairs.iter().any(|pair| pair.key == name);
            let first = if *kind && is_free("kind") {
                vec![offer("kind", "what the stage computes", "kind: ")]
            } else {
                Vec::new()
            };
            let mut free: Vec<&Field> = fields.iter().filter(|field| is_free(field.name)).collect();
            // What must be there comes first.
            free.sort_by_key(|field| field.presence != Presence::Required);
            let fields = free.into_iter().map(|field| offer(field.name, field.summary, &format!("{}: ", field.name)));
            first.into_iter().chain(fields).collect()
        }
        Here::Stage(_) | Here::Own(..) => Vec::new(),
        Here::Kind(_) => program.kinds.iter().map(|kind| offer(kind.name, kind.summary, kind.name)).collect(),
        Here::Member(members, _) => of_members(members),
        Here::Value(field, shape, node, _) => of_value(field, shape, node, root, program),
    }
}

fn of_value(field: &Field, shape: &'static Shape, node: &Node, root: &Node, program: &Program) -> Vec<Offer> {
    match shape {
        Shape::List(item) => of_value(field, item, node, root, program),
        Shape::Quantity { dimension, .. } => of_quantity(field, *dimension, node),
        Shape::Number { .. } | Shape::Integer { .. } | Shape::AnyQuantity | Shape::Text => {
            words::example_of(field).into_iter().map(|text| offer(text, "for example", text)).collect()
        }
        Shape::File => vec![offer("trace.csv", "for example", "trace.csv")],
        _ => of_shape(shape, root, program),
    }
}

/// The units of a number that stands there, or an example in each unit.
fn of_quantity(field: &Field, dimension: Dimension, node: &Node) -> Vec<Offer> {
    let units = dimension.describe().1;
    let written = match &node.content {
        Content::Scalar { text, .. } => text.trim_end_matches(WORD).trim_end(),
        _ => "",
    };
    if written.parse::<f64>().is_ok() {
        return units.iter().map(|unit| offer(unit, &format!("{written} {unit}"), unit)).collect();
    }
    let Some(example) = words::example_of(field) else { return Vec::new() };
    let Ok(read) = parse_quantity(example) else { return Vec::new() };
    let own = split_quantity(example).1;
    let others = units.iter().filter(|unit| **unit != own && dimension != RATIO);
    let others = others.map(|unit| format!("{} {unit}", words::number(in_unit(read.value, unit))));
    std::iter::once(example.to_owned()).chain(others).map(|text| offer(&text, "for example", &text)).collect()
}

fn of_shape(shape: &'static Shape, root: &Node, program: &Program) -> Vec<Offer> {
    match shape {
        Shape::Reference(kinds) => {
            let fits = |kind: &&'static Kind| kinds.is_empty() || kinds.contains(&kind.name);
            let named = |stage: &KeyValue| {
                let kind = kind_of(stage, program.kinds).filter(fits)?;
                Some(offer(&stage.key, kind.name, &stage.key))
            };
            stages(root).iter().filter_map(named).collect()
        }
        Shape::Choice(choices) => choices.iter().map(|one| offer(one.name, one.summary, one.name)).collect(),
        Shape::Flag => ["true", "false"].into_iter().map(|word| offer(word, "", word)).collect(),
        Shape::Member(members) => of_members(members()),
        Shape::List(item) => of_shape(item, root, program),
        _ => Vec::new(),
    }
}

fn of_members(members: &[Member]) -> Vec<Offer> {
    let written = |member: &Member| {
        let is_bare = !member.fields.iter().any(|field| field.presence == Presence::Required);
        let text = if is_bare { member.name.to_owned() } else { format!("{}: {{ }}", member.name) };
        offer(member.name, member.summary, &text)
    };
    members.iter().map(written).collect()
}

fn offer(label: &str, detail: &str, text: &str) -> Offer {
    Offer { label: label.to_owned(), detail: detail.to_owned(), text: text.to_owned() }
}

fn of_kind(kind: &Kind) -> String {
    format!("{}: {}", kind.name, kind.summary)
}

fn of_member(member: &Member) -> String {
    let own = format!("{}: {}", member.name, member.summary);
    member.fields.iter().fold(own, |text, field| text + "\n- " + &describe::field(field))
}

fn stages(root: &Node) -> &[KeyValue] {
    let Content::Mapping(pairs) = &root.content else { return &[] };
    match pairs.iter().find(|pair| pair.key == "stages").map(|pair| &pair.node.content) {
        Some(Content::Mapping(stages)) => stages,
        _ => &[],
    }
}

/// The last of several that begins at the offset or before.
fn last_before<T>(all: &[T], offset: usize, begins: impl Fn(&T) -> usize) -> Option<&T> {
    all.iter().filter(|one| begins(one) <= offset).max_by_key(|one| begins(one))
}

fn is_on(place: Place, offset: usize) -> bool {
    (place.offset..=place.offset + place.length).contains(&offset)
}

impl<'a> Walk<'a> {
    fn locate(&self) -> Option<Here<'a>> {
        let Content::Mapping(pairs) = &self.root.content else { return None };
        let pair = last_before(pairs, self.offset, |pair| pair.place.offset)?;
        if is_on(pair.place, self.offset) {
            return Some(Here::Key { fields: KEYS, key: &pair.key, pairs, kind: false });
        }
        let head = Beside { stage: None, kind: None, fields: KEYS, pairs, map: &[], name: None };
        if pair.key != "stages" {
            let field = KEYS.iter().find(|field| field.name == pair.key)?;
            return self.in_value(field, &field.shape, &pair.node, head);
        }
        let stage = last_before(stages(self.root), self.offset, |stage| stage.place.offset)?;
        if is_on(stage.place, self.offset) {
            return Some(Here::Stage(stage));
        }
        let Content::Mapping(pairs) = &stage.node.content else { return None };
        let kind = kind_of(stage, self.program.kinds);
        let fields = kind.map_or(&[][..], |kind| kind.fields);
        self.in_fields(Beside { stage: Some(&stage.key), kind, fields, pairs, ..head }, true)
    }

    fn in_fields(&self, beside: Beside<'a>, is_stage: bool) -> Option<Here<'a>> {
        let Beside { fields, pairs, .. } = beside;
        let pair = last_before(pairs, self.offset, |pair| pair.place.offset)?;
        if is_on(pair.place, self.offset) {
            return Some(Here::Key { fields, key: &pair.key, pairs, kind: is_stage });
        }
        if is_stage && pair.key == "kind" {
            let Content::Scalar { text, .. } = &pair.node.content else { return None };
            return Some(Here::Kind(text));
        }
        let field = fields.iter().find(|field| field.name == pair.key)?;
        // The fields of another stage, which a field beside this one names.
        if let Shape::Overrides(of) = field.shape {
            let named = &pairs.iter().find(|pair| pair.key == of)?.node.content;
            let Content::Scalar { text, .. } = named else { return None };
            let other = stages(self.root).iter().find(|stage| stage.key == *text)?;
            let Content::Mapping(inside) = &pair.node.content else { return None };
            let kind = kind_of(other, self.program.kinds)?;
            return self.in_fields(Beside { kind: Some(kind), fields: kind.fields, pairs: inside, ..beside }, false);
        }
        self.in_value(field, &field.shape, &pair.node, beside)
    }

    fn in_value(
        &self,
        field: &'static Field,
        shape: &'static Shape,
        node: &'a Node,
        beside: Beside<'a>,
    ) -> Option<Here<'a>> {
        match (shape, &node.content) {
            (Shape::List(item), Content::Sequence(items)) => {
                let inside = last_before(items, self.offset, |item| item.place.offset)?;
                self.in_value(field, item, inside, beside)
            }
            (Shape::List(item), _) => self.in_value(field, item, node, beside),
            (Shape::Map(item), Content::Mapping(map)) => {
                let pair = last_before(map, self.offset, |pair| pair.place.offset)?;
                let beside = Beside { map, name: Some(&pair.key), ..beside };
                if is_on(pair.place, self.offset) {
                    return Some(Here::Own(field, &pair.key, beside));
                }
                self.in_value(field, item, &pair.node, beside)
            }
            (Shape::Group(fields), Content::Mapping(pairs)) => {
                self.in_fields(Beside { fields, pairs, map: &[], name: None, ..beside }, false)
            }
            (Shape::Member(members), Content::Mapping(pairs)) => {
                let pair = last_before(pairs, self.offset, |pair| pair.place.offset)?;
                if is_on(pair.place, self.offset) {
                    return Some(Here::Member(members(), &pair.key));
                }
                let member = members().iter().find(|member| member.name == pair.key)?;
                let Content::Mapping(inside) = &pair.node.content else { return None };
                let inside = Beside { fields: member.fields, pairs: inside, map: &[], name: None, ..beside };
                self.in_fields(inside, false)
            }
            (_, Content::Scalar { .. }) => Some(Here::Value(field, shape, node, beside)),
            _ => None,
        }
    }
}
