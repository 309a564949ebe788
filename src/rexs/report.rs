//! What became of every attribute of the components of a stage. Must not know: what any attribute means.

use std::collections::BTreeMap;

use super::model::{Component, Fate, Model};

/// Characters of a name from a file, and names of one component, in a comment.
const LONGEST_NAME: usize = 100;
const MOST_NAMES: usize = 400;

/// Attributes by component: `cylindrical_gear 2: face_width`.
pub(super) struct Fates {
    pub read: Vec<String>,
    pub follows: Vec<String>,
    pub contradicting: Vec<String>,
    pub not_supported: Vec<String>,
    lines: Vec<String>,
}

impl Fates {
    /// Those of `concerned`, each once; the other components are counted.
    pub(super) fn of(model: &Model, concerned: &[&Component]) -> Self {
        let [read, follows, contradicting, not_supported, lines] = [const { Vec::new() }; 5];
        let mut fates = Self { read, follows, contradicting, not_supported, lines };
        let each = |fate| -> (Vec<String>, String) { listed(concerned, fate) };
        let words = [
            (Fate::Read, "Read"),
            (Fate::Follows, "Not needed, since they follow from those"),
            (Fate::Contradicts, "Not read, since they contradict those that are"),
            (Fate::NotSupported, "Not supported"),
        ];
        for (fate, word) in words {
            let (all, shown) = each(fate);
            if !all.is_empty() {
                let plural = if all.len() == 1 { "attribute" } else { "attributes" };
                fates.lines.push(format!("{word}, {} {plural}: {shown}.", all.len()));
            }
            match fate {
                Fate::Read => fates.read = all,
                Fate::Follows => fates.follows = all,
                Fate::Contradicts => fates.contradicting = all,
                Fate::NotSupported => fates.not_supported = all,
            }
        }
        let mut others: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
        for component in &model.components {
            if !concerned.iter().any(|other| std::ptr::eq(*other, component)) {
                let [count, attributes] = others.entry(&component.kind).or_default();
                *count += 1;
                *attributes += component.attributes.len();
            }
        }
        if !others.is_empty() {
            let shown: Vec<String> = others
                .iter()
                .take(MOST_NAMES)
                .map(|(kind, [count, attributes])| format!("{count} × {} ({attributes})", name(kind)))
                .collect();
            fates.lines.push(format!("Other components, with their attributes: {}.", shown.join(", ")));
        }
        fates
    }

    pub(super) fn lines(&self) -> Vec<String> {
        self.lines.clone()
    }
}

/// Attributes with a fate, and the same by component; components that have the same ones stand together.
fn listed(components: &[&Component], fate: Fate) -> (Vec<String>, String) {
    let mut all = Vec::new();
    // Kind, identifiers and names.
    let mut groups: Vec<(String, Vec<String>, String)> = Vec::new();
    for component in components {
        let (kind, id) = (name(&component.kind), name(&component.id));
        let names: Vec<String> = component
            .attributes
            .iter()
            .filter(|attribute| attribute.fate.get() == fate)
            .map(|attribute| name(&attribute.name))
            .collect();
        if names.is_empty() {
            continue;
        }
        all.extend(names.iter().map(|name| format!("{kind} {id}: {name}")));
        let mut shown = names[..names.len().min(MOST_NAMES)].join(", ");
        if names.len() > MOST_NAMES {
            shown += &format!(" and {} more", names.len() - MOST_NAMES);
        }
        match groups.iter_mut().find(|(other, _, list)| *other == kind && *list == shown) {
            Some((_, ids, _)) => ids.push(id),
            None => groups.push((kind, vec![id], shown)),
        }
    }
    let groups: Vec<String> =
        groups.into_iter().map(|(kind, ids, shown)| format!("of {kind} {}: {shown}", ids.join(" and "))).collect();
    (all, groups.join("; "))
}

/// A name from a file on one line.
fn name(text: &str) -> String {
    text.escape_debug().take(LONGEST_NAME).collect()
}
