//! Components, their attributes, and relations of a file of REXS, whatever its form.
//!
//! Attributes remember what became of them. Must not know: what any attribute means, studies.

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

use roxmltree::{Document, Node};

use super::Refusal;

/// Most ids in a message.
const MOST_NAMED: usize = 20;
/// No number of a gear is larger, in any unit of REXS.
const LARGEST: f64 = 1e9;

/// What became of an attribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    NotSupported,
    Read,
    /// It says again what another one says, or what follows from those that are read.
    Follows,
    /// It says another value of a quantity than the attribute that is read.
    Contradicts,
}

#[derive(Debug)]
pub(super) struct Attribute {
    pub name: String,
    unit: String,
    /// None of an array.
    value: Option<String>,
    at: Option<usize>,
    pub fate: Cell<Fate>,
}

impl Attribute {
    pub(super) fn new(name: &str, unit: &str, value: Option<String>, at: Option<usize>) -> Self {
        let fate = Cell::new(Fate::NotSupported);
        Self { name: name.to_owned(), unit: unit.to_owned(), value, at, fate }
    }
}

#[derive(Debug)]
pub(super) struct Component {
    pub id: String,
    pub kind: String,
    pub at: Option<usize>,
    pub attributes: Vec<Attribute>,
}

#[derive(Debug)]
pub(super) struct Relation {
    pub kind: String,
    /// Which manufacturing step it is.
    pub order: Option<u32>,
    /// Role and id.
    pub refs: Vec<(String, String)>,
    pub at: Option<usize>,
}

/// Kinds of relations that say something of a pair.
pub(super) const RELATIONS: [&str; 8] =
    ["stage", "flank", "manufacturing_step", "reference", "ordered_reference", "assembly", "side", "stage_gear_data"];

/// The components of a file by id, and its relations by whom they are about.
#[derive(Debug)]
pub(super) struct Model {
    pub components: Vec<Component>,
    by_id: BTreeMap<String, usize>,
    relations: Vec<Relation>,
    /// Relations by the ids in them.
    of: BTreeMap<String, Vec<usize>>,
    /// Where the file begins.
    pub at: Option<usize>,
}

/// A number of the file, and the byte where it stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Said {
    pub value: f64,
    pub at: Option<usize>,
}

impl Said {
    pub(super) fn map(self, change: impl FnOnce(f64) -> f64) -> Self {
        Self { value: change(self.value), ..self }
    }
}

/// Units of one dimension, and by what a number in each is multiplied.
pub(super) type Units = &'static [(&'static str, f64)];

pub(super) fn refuse<T>(at: Option<usize>, message: impl Into<String>) -> Result<T, Refusal> {
    Err(Refusal::new(message).maybe_at(at))
}

/// The version and the model of a file in XML.
pub(super) fn of_xml(document: &Document) -> Result<(String, Model), Refusal> {
    let root = document.root_element();
    let at = Some(root.range().start);
    if !root.has_tag_name("model") {
        let name = root.tag_name().name();
        return refuse(at, format!("it is no REXS file: its outermost element is `{name}`, not `model`"));
    }
    let inside = |list: &'static str, name: &'static str| {
        let lists = root.children().filter(move |node| node.has_tag_name(list));
        lists.flat_map(move |list| list.children().filter(move |node| node.has_tag_name(name)))
    };
    let relations = inside("relations", "relation").map(|node| {
        let is_ref = |node: &Node| node.has_tag_name("ref");
        let reference = |node: Node| Some((node.attribute("role")?.to_owned(), node.attribute("id")?.to_owned()));
        Relation {
            kind: node.attribute("type").unwrap_or("").to_owned(),
            order: node.attribute("order").and_then(|order| order.parse().ok()),
            refs: node.children().filter(is_ref).filter_map(reference).collect(),
            at: Some(node.range().start),
        }
    });
    let components = inside("components", "component").map(|node| {
        let attribute = |node: Node| {
            let is_array = node.children().any(|inner| inner.is_element());
            let value = (!is_array).then(|| node.text().unwrap_or("").trim().to_owned());
            let word = |name| node.attribute(name).unwrap_or("");
            Attribute::new(word("id"), word("unit"), value, Some(node.range().start))
        };
        Component {
            id: node.attribute("id").unwrap_or("").to_owned(),
            kind: node.attribute("type").unwrap_or("").to_owned(),
            at: Some(node.range().start),
            attributes: node.children().filter(|node| node.has_tag_name("attribute")).map(attribute).collect(),
        }
    });
    let line = |at: usize| Some(document.text_pos_at(at).row);
    let model = Model::new(components, relations, at, line)?;
    Ok((root.attribute("version").unwrap_or("").to_owned(), model))
}

impl Model {
    pub(super) fn new(
        components: impl Iterator<Item = Component>,
        relations: impl Iterator<Item = Relation>,
        at: Option<usize>,
        line: impl Fn(usize) -> Option<u32>,
    ) -> Result<Self, Refusal> {
        let components: Vec<Component> = components.filter(|component| !component.id.is_empty()).collect();
        let mut by_id = BTreeMap::new();
        for (index, component) in components.iter().enumerate() {
            let Some(first) = by_id.insert(component.id.clone(), index) else { continue };
            let line = components[first].at.and_then(&line).map(|line| format!(", first in line {line}"));
            let message =
                format!("the component {} is given twice{}; ids are unique", component.id, line.unwrap_or_default());
            return refuse(component.at, message);
        }
        let relations: Vec<Relation> =
            relations.filter(|relation| RELATIONS.contains(&relation.kind.as_str())).collect();
        let mut of: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for (index, relation) in relations.iter().enumerate() {
            for (_, id) in &relation.refs {
                of.entry(id.clone()).or_default().push(index);
            }
        }
        Ok(Self { components, by_id, relations, of, at })
    }

    pub(super) fn component(&self, id: &str) -> Option<&Component> {
        self.by_id.get(id).map(|index| &self.components[*index])
    }

    /// The components in a role of the relations of some kinds in which a component has another role, each once, in the order of
    /// the file, with the number of the step that a relation has.
    pub(super) fn related(
        &self,
        kinds: &[&str],
        id: &str,
        role: &str,
        wanted: &[&str],
    ) -> Vec<(&Component, Option<u32>)> {
        let mut seen = BTreeSet::new();
        let mut found = Vec::new();
        for index in self.of.get(id).into_iter().flatten() {
            let relation = &self.relations[*index];
            if !kinds.contains(&relation.kind.as_str()) || relation.in_role(role) != Some(id) {
                continue;
            }
            for wanted in wanted {
                let Some(other) = relation.in_role(wanted).filter(|other| seen.insert((*other, relation.order))) else {
                    continue;
                };
                found.extend(self.component(other).map(|component| (component, relation.order)));
            }
        }
        found
    }

    /// The relation of the cylindrical stage that is meant.
    pub(super) fn stage(&self, wanted: Option<&str>) -> Result<&Relation, Refusal> {
        let stage_of = |relation: &Relation| {
            let id = (relation.kind == "stage").then(|| relation.in_role("stage"))??;
            self.component(id).filter(|stage| stage.kind == "cylindrical_stage").map(|_| id.to_owned())
        };
        let stages: Vec<(String, &Relation)> =
            self.relations.iter().filter_map(|relation| Some((stage_of(relation)?, relation))).collect();
        // A message is not a list of a whole factory.
        let shown: Vec<&str> = stages.iter().take(MOST_NAMED).map(|(id, _)| id.as_str()).collect();
        let named = shown.join(", ") + if stages.len() > MOST_NAMED { ", …" } else { "" };
        match (wanted, stages.as_slice()) {
            (_, []) => refuse(self.at, "it has no stage of two cylindrical gears"),
            (None, [(_, one)]) => Ok(one),
            (None, [_, (_, second), ..]) => {
                refuse(second.at, format!("it has {} cylindrical stages; name one of {named}", stages.len()))
            }
            (Some(wanted), _) => match stages.iter().find(|(id, _)| id == wanted) {
                Some((_, found)) => Ok(found),
                None => refuse(self.at, format!("it has no cylindrical stage `{wanted}`; it has {named}")),
            },
        }
    }
}

impl Relation {
    /// The id that it has in a role.
    pub(super) fn in_role(&self, role: &str) -> Option<&str> {
        self.refs.iter().find(|(own, _)| own == role).map(|(_, id)| id.as_str())
    }
}

impl Component {
    fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.name == name)
    }

    /// Notes that an attribute says what is known without it.
    pub(super) fn follows(&self, name: &str) {
        if let Some(attribute) = self.attribute(name).filter(|attribute| attribute.fate.get() == Fate::NotSupported) {
            attribute.fate.set(Fate::Follows);
        }
    }

    /// Notes what became of an attribute that was looked at and is not in the study.
    pub(super) fn set(&self, name: &str, fate: Fate) {
        self.attribute(name).into_iter().for_each(|attribute| attribute.fate.set(fate));
    }

    /// Notes that nothing of it is in the study after all.
    pub(super) fn is_not_supported(&self) {
        self.attributes.iter().for_each(|attribute| attribute.fate.set(Fate::NotSupported));
    }

    /// A word, such as the shape of a relief.
    pub(super) fn word(&self, name: &str) -> Option<&str> {
        let attribute = self.attribute(name)?;
        attribute.fate.set(Fate::Read);
        attribute.value.as_deref()
    }

    /// A number in one of these units; none when it is not given.
    pub(super) fn number(&self, name: &str, units: Units) -> Result<Option<Said>, Refusal> {
        let mut given = self.attributes.iter().filter(|attribute| attribute.name == name);
        let Some(attribute) = given.next() else { return Ok(None) };
        let (kind, id, at) = (&self.kind, &self.id, attribute.at);
        if let Some(second) = given.next() {
            return refuse(second.at, format!("`{name}` of the {kind} {id} is given twice"));
        }
        let unit = &attribute.unit;
        let Some((_, factor)) = units.iter().find(|(name, _)| name == unit) else {
            let (unit, expected) = (unit.escape_debug(), units[0].0);
            return refuse(at, format!("`{name}` of the {kind} {id} is in `{unit}`, not in {expected}"));
        };
        let text = attribute.value.as_deref().unwrap_or("a list");
        match text.parse::<f64>() {
            Ok(value) if value.abs() <= LARGEST => {
                attribute.fate.set(Fate::Read);
                Ok(Some(Said { value: value * factor, at }))
            }
            Ok(value) if value.is_finite() => {
                refuse(at, format!("`{name}` of the {kind} {id} is {value:e}; it must be -{LARGEST:e} to {LARGEST:e}"))
            }
            _ => {
                let shown: String = text.escape_debug().take(40).collect();
                refuse(at, format!("`{name}` of the {kind} {id} is `{shown}`, which is not a number"))
            }
        }
    }
}
