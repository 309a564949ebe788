//! A stage of the study with some of its fields replaced: what fields of the shape `Overrides` are read as.
//!
//! A replaced field is replaced as a whole: `method: { grid: { levels: 5 } }` says nothing of what the method was. Must
//! not know: what any field means.

use super::document::{Content, KeyValue, Node};
use super::files;
use super::path::kind_of;
use super::words::quote;
use crate::program::{Derived, Foreign};
use crate::stage::Kind;
use declare::error::{Diagnostic, Place, suggest};
use declare::parameter::{Field, Shape};

/// The stages of a study as written, the kinds there are, the words of others for their fields, and rules that lead to them.
#[derive(Clone, Copy, Default)]
pub struct Stages<'a> {
    pub pairs: &'a [KeyValue],
    pub kinds: &'a [&'static Kind],
    pub foreign: &'a [&'static [Foreign]],
    pub derived: &'a [Derived],
}

impl<'a> Stages<'a> {
    /// The stage `name`, which is named at `place`, and its kind.
    ///
    /// # Errors
    /// When there is no such stage, it has no kind, or it replaces fields of another stage itself.
    pub fn plain(&self, name: &str, place: Place) -> Result<(&'static Kind, &'a KeyValue), Diagnostic> {
        let (kind, stage) = self.any(name, place)?;
        if kind.fields.iter().any(replaces) {
            let message = format!("{} replaces fields of another stage itself, so none of its own can be", quote(name));
            return Err(Diagnostic::new(message).at(place));
        }
        Ok((kind, stage))
    }

    /// The same, whatever its fields hold.
    ///
    /// # Errors
    /// When there is no such stage, or it has no kind.
    pub fn any(&self, name: &str, place: Place) -> Result<(&'static Kind, &'a KeyValue), Diagnostic> {
        let stage = self.pairs.iter().find(|pair| pair.key == name).ok_or_else(|| {
            let names = self.pairs.iter().map(|pair| pair.key.as_str());
            Diagnostic::new(format!("there is no stage {}", quote(name))).at(place).help(suggest(name, names))
        })?;
        match kind_of(stage, self.kinds) {
            Some(kind) => Ok((kind, stage)),
            None => Err(Diagnostic::new(format!("stage {} has no kind that is known", quote(name))).at(stage.place)),
        }
    }

    /// The tree of the stage `name`, which is named at `place`, with `replaced` in the place of its own fields.
    ///
    /// # Errors
    /// When there is no such stage, it has no kind, or it replaces fields of another stage itself.
    pub fn merged(&self, name: &str, place: Place, replaced: &[KeyValue]) -> Result<(&'static Kind, Node), Diagnostic> {
        let (kind, stage) = self.plain(name, place)?;
        let own = if let Content::Mapping(pairs) = &stage.node.content { pairs.as_slice() } else { &[] };
        if let Some(pair) = replaced.iter().find(|pair| pair.key == "kind") {
            return Err(Diagnostic::new("the kind of a stage cannot be replaced").at(pair.place));
        }
        let is_replaced = |pair: &&KeyValue| replaced.iter().any(|other| other.key == pair.key);
        let kept = own.iter().filter(|pair| !is_replaced(pair)).chain(replaced).cloned();
        Ok((kind, Node { content: Content::Mapping(kept.collect()), place: stage.node.place }))
    }
}

/// Whether a field holds those of other stages.
pub fn replaces(field: &Field) -> bool {
    fn inside(shape: &Shape) -> bool {
        match shape {
            Shape::Overrides(_) | Shape::Varied(_) => true,
            Shape::List(item) | Shape::Map(item) => inside(item),
            Shape::Group(fields) => fields.iter().any(replaces),
            _ => false,
        }
    }
    inside(&field.shape)
}

/// The replaced fields on one line, as a study would have them; of none, `as it is`.
pub fn written(pairs: &[KeyValue]) -> String {
    if pairs.is_empty() { "as it is".to_owned() } else { fields(pairs) }
}

fn fields(pairs: &[KeyValue]) -> String {
    let own = pairs.iter().filter(|pair| !files::is_read(pair));
    own.map(|pair| format!("{}: {}", pair.key, inline(&pair.node))).collect::<Vec<_>>().join(", ")
}

fn inline(node: &Node) -> String {
    match &node.content {
        Content::Scalar { text, .. } => text.split_whitespace().collect::<Vec<_>>().join(" "),
        Content::Sequence(items) => format!("[{}]", items.iter().map(inline).collect::<Vec<_>>().join(", ")),
        Content::Mapping(pairs) if pairs.is_empty() => "{}".to_owned(),
        Content::Mapping(pairs) => format!("{{ {} }}", fields(pairs)),
    }
}
