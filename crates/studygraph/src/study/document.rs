//! YAML text as a tree in which every scalar keeps its text and everything its place.
//!
//! The events of the YAML parser are gathered without recursion and under limits (levels, nodes, aliases), so that no
//! text can exhaust the stack, the memory or the user's patience. Scalars are not interpreted: what a field may hold is
//! known from its declaration, not from how YAML guesses. Must not know: fields, stages, studies.

use std::collections::BTreeMap;

use serde_saphyr::granit_parser::{
    ErrorKind, Event, Marker, Parser, ScalarStyle, ScanError, Span, StructureStyle, options,
};

use super::characters;
use super::place::place_at;
use super::structure;
use super::words::quote;
use declare::error::{Diagnostic, Place};
use declare::text::unfit;

/// Levels of nesting, aliases included.
const DEEPEST: usize = 64;
/// Scalars, lists and mappings, copies made by anchors and aliases included.
const MOST_NODES: usize = 100_000;

/// One value of the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    pub content: Content,
    pub place: Place,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// The text after YAML's escapes, and whether it stood in quotes or in a block.
    Scalar {
        text: String,
        quoted: bool,
    },
    Sequence(Vec<Node>),
    Mapping(Vec<KeyValue>),
}

/// A key and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyValue {
    pub key: String,
    /// Where the key stands.
    pub place: Place,
    pub node: Node,
}

impl Node {
    /// The text of a scalar without quotes.
    pub fn plain(&self) -> Option<&str> {
        if let Content::Scalar { text, quoted: false } = &self.content { Some(text) } else { None }
    }

    /// Whether nothing was given: an empty value, `~` or `null`.
    pub fn is_null(&self) -> bool {
        matches!(self.plain(), Some("" | "~" | "null" | "Null" | "NULL"))
    }

    pub fn is_mapping(&self) -> bool {
        matches!(self.content, Content::Mapping(_))
    }

    /// What was found, for a message.
    pub fn describe(&self) -> String {
        match &self.content {
            _ if self.is_null() => "nothing".to_owned(),
            Content::Scalar { text, .. } => quote(text),
            Content::Sequence(_) => "a list".to_owned(),
            Content::Mapping(_) => "a mapping".to_owned(),
        }
    }

    /// Moves the whole tree to one place: a default stands where its parent does.
    pub fn moved_to(mut self, place: Place) -> Self {
        self.place = place;
        match &mut self.content {
            Content::Scalar { .. } => {}
            Content::Sequence(items) => {
                for item in items {
                    *item = std::mem::replace(item, nothing(place)).moved_to(place);
                }
            }
            Content::Mapping(pairs) => {
                for pair in pairs {
                    pair.place = place;
                    pair.node = std::mem::replace(&mut pair.node, nothing(place)).moved_to(place);
                }
            }
        }
        self
    }
}

/// How far a piece of a text lies behind its place in another one.
#[derive(Clone, Copy, Debug)]
pub struct Shift {
    pub bytes: usize,
    pub lines: usize,
}

impl Shift {
    /// The place in the whole of one in the piece.
    pub fn moved(self, place: Place) -> Place {
        Place { offset: place.offset + self.bytes, line: place.line + self.lines, ..place }
    }
}

impl Node {
    /// Moves all places of the tree from the piece to the whole text.
    pub fn shift(&mut self, shift: Shift) {
        self.place = shift.moved(self.place);
        match &mut self.content {
            Content::Scalar { .. } => {}
            Content::Sequence(items) => items.iter_mut().for_each(|item| item.shift(shift)),
            Content::Mapping(pairs) => {
                for pair in pairs {
                    pair.place = shift.moved(pair.place);
                    pair.node.shift(shift);
                }
            }
        }
    }
}

/// A node without a value.
pub fn nothing(place: Place) -> Node {
    Node { content: Content::Scalar { text: String::new(), quoted: false }, place }
}

/// Reads one YAML document; `None` when the text holds none.
///
/// # Errors
/// When the text is not YAML, or is more than a study can need.
pub fn parse(text: &str) -> Result<Option<Node>, Diagnostic> {
    let options = options! {
        emit_comments: false,
        disallow_directives: true,
        flow_nesting_limit: DEEPEST,
        block_nesting_limit: DEEPEST,
    };
    characters::check_merged(text)?;
    characters::check(text)?;
    let mut tree = Tree::new(text);
    for event in Parser::new_from_str_with_options(text, options) {
        let (event, span) = event.map_err(|error| tree.refused(&error))?;
        tree.take(event, &span)?;
    }
    Ok(tree.root.map(|grown| grown.node))
}

/// A finished node with what it counts against the limits.
#[derive(Clone)]
struct Grown {
    node: Node,
    nodes: usize,
    levels: usize,
}

/// A list or mapping that is not closed yet.
struct Open {
    place: Place,
    flow: bool,
    anchor: usize,
    nodes: usize,
    levels: usize,
    inside: Inside,
}

enum Inside {
    Sequence(Vec<Node>),
    Mapping {
        pairs: Vec<KeyValue>,
        lines: BTreeMap<String, usize>,
        key: Option<(String, Place, bool)>,
        /// Before how many of the pairs `<<` stands, and what it merges.
        merged: (usize, Vec<KeyValue>),
    },
}

struct Tree<'a> {
    text: &'a str,
    open: Vec<Open>,
    anchors: BTreeMap<usize, Grown>,
    nodes: usize,
    documents: usize,
    root: Option<Grown>,
}

impl<'a> Tree<'a> {
    fn new(text: &'a str) -> Self {
        Self { text, open: Vec::new(), anchors: BTreeMap::new(), nodes: 0, documents: 0, root: None }
    }

    fn take(&mut self, event: Event<'_>, span: &Span) -> Result<(), Diagnostic> {
        if span.tag_start().is_some() {
            let at = span.tag_span().map_or_else(|| self.place(span), |tag| self.place(&tag));
            let help = "the type of a value follows from its field";
            return Err(Diagnostic::new("YAML tags have no meaning in a study").at(at).help(help));
        }
        match event {
            Event::DocumentStart(..) => {
                self.documents += 1;
                if self.documents > 1 {
                    let message = "a study is one YAML document; a second one starts here";
                    return Err(Diagnostic::new(message).at(self.place(span)).help("put it into a file of its own"));
                }
                Ok(())
            }
            Event::Scalar(text, style, anchor, _) => {
                let place = self.place(span);
                self.count(1, 1, place)?;
                let quoted = style != ScalarStyle::Plain;
                if let Some((_, character)) = unfit(&text) {
                    let at = characters::escape(self.text, place, self.offset(span.end), character);
                    return Err(characters::cannot_hold(character).at(at));
                }
                // The parser gives a value that is not there a `~` of its own.
                let text = if span.is_empty() && !quoted { String::new() } else { text.into_owned() };
                let node = Node { content: Content::Scalar { text, quoted }, place };
                self.finish(Grown { node, nodes: 1, levels: 1 }, anchor)
            }
            Event::SequenceStart(style, anchor, _) => self.begin(span, style, anchor, Inside::Sequence(Vec::new())),
            Event::MappingStart(style, anchor, _) => {
                let inside =
                    Inside::Mapping { pairs: Vec::new(), lines: BTreeMap::new(), key: None, merged: (0, Vec::new()) };
                self.begin(span, style, anchor, inside)
            }
            Event::SequenceEnd | Event::MappingEnd => self.end(span),
            Event::Alias(anchor) => {
                let place = self.place(span);
                let Some(mut grown) = self.anchors.get(&anchor).cloned() else {
                    return Err(Diagnostic::new("this alias stands inside the value it stands for").at(place));
                };
                self.count(grown.nodes, grown.levels, place)?;
                // A number stands where it is written, as those inside of lists and mappings do.
                if !matches!(grown.node.content, Content::Scalar { .. }) {
                    grown.node.place = place;
                }
                self.finish(grown, 0)
            }
            _ => Ok(()),
        }
    }

    fn begin(&mut self, span: &Span, style: StructureStyle, anchor: usize, inside: Inside) -> Result<(), Diagnostic> {
        let place = Place { length: usize::from(!self.text[self.offset(span.start)..].is_empty()), ..self.place(span) };
        self.count(1, 1, place)?;
        self.open.push(Open { place, flow: style == StructureStyle::Flow, anchor, nodes: 1, levels: 1, inside });
        Ok(())
    }

    fn end(&mut self, span: &Span) -> Result<(), Diagnostic> {
        let Some(mut open) = self.open.pop() else { return Ok(()) };
        // Most have one or two values, and room for four: half of a tree with thousands of them.
        let content = match open.inside {
            Inside::Sequence(mut items) => {
                items.shrink_to_fit();
                Content::Sequence(items)
            }
            Inside::Mapping { mut pairs, mut lines, merged, .. } => {
                if let Some(first) = pairs.first().filter(|_| !open.flow) {
                    open.place = first.place;
                }
                let (before, mut merged) = merged;
                // What the mapping says itself, and what was merged first, stands.
                merged.retain(|pair| lines.insert(pair.key.clone(), pair.place.line).is_none());
                pairs.splice(before..before, merged);
                pairs.shrink_to_fit();
                Content::Mapping(pairs)
            }
        };
        if open.flow && span.end.line() == open.place.line {
            open.place.length = self.offset(span.end).saturating_sub(open.place.offset);
        }
        let node = Node { content, place: open.place };
        self.finish(Grown { node, nodes: open.nodes, levels: open.levels }, open.anchor)
    }

    /// Remembers an anchored node and hands the node to what is open around it.
    fn finish(&mut self, mut grown: Grown, anchor: usize) -> Result<(), Diagnostic> {
        if anchor != 0 {
            self.count(grown.nodes, 0, grown.node.place)?;
            self.anchors.insert(anchor, grown.clone());
        }
        let Some(around) = self.open.last_mut() else {
            self.root = Some(grown);
            return Ok(());
        };
        around.nodes += grown.nodes;
        around.levels = around.levels.max(grown.levels + 1);
        let text = self.text;
        match &mut around.inside {
            Inside::Sequence(items) => items.push(grown.node),
            Inside::Mapping { pairs, lines, key, merged } => match key.take() {
                None => *key = Some(new_key(grown.node, lines, text)?),
                Some((_, place, true)) => {
                    merged.0 = pairs.len();
                    merge(grown.node, place, &mut merged.1)?;
                }
                Some((name, place, false)) => {
                    // A value that is not there has no place of its own.
                    if grown.node.plain() == Some("") {
                        grown.node.place = place;
                    }
                    pairs.push(KeyValue { key: name, place, node: grown.node });
                }
            },
        }
        Ok(())
    }

    fn count(&mut self, nodes: usize, levels: usize, place: Place) -> Result<(), Diagnostic> {
        self.nodes = self.nodes.saturating_add(nodes);
        if self.nodes > MOST_NODES {
            let message =
                format!("more than {MOST_NODES} values, those that aliases repeat included: too much for a study");
            return Err(Diagnostic::new(message).at(place));
        }
        if self.open.len() + levels > DEEPEST { Err(too_deep().at(place)) } else { Ok(()) }
    }

    fn offset(&self, marker: Marker) -> usize {
        let offset = marker.byte_offset().unwrap_or(0).min(self.text.len());
        (0..=offset).rev().find(|&at| self.text.is_char_boundary(at)).unwrap_or(0)
    }

    /// The first line of a span.
    fn place(&self, span: &Span) -> Place {
        let (offset, end) = (self.offset(span.start), self.offset(span.end));
        let covered = self.text.get(offset..end).unwrap_or("");
        let length = covered.lines().next().unwrap_or("").len();
        Place { line: span.start.line(), column: span.start.col() + 1, offset, length }
    }

    /// What the parser found wrong, in words for somebody who does not know its grammar.
    fn refused(&self, error: &ScanError) -> Diagnostic {
        let place = self.point(*error.marker());
        if let Some(cause) = structure::cause(self.text, error.kind(), place) {
            return cause;
        }
        let quotes = "put a text that holds such characters in quotes, and look at the indentation";
        match error.kind() {
            ErrorKind::RecursionLimitExceeded => too_deep().at(place),
            ErrorKind::TabNotAllowed
            | ErrorKind::TabInBlockIndentation
            | ErrorKind::TabInIndentation
            | ErrorKind::TabInPlainScalar
            | ErrorKind::TabAtBlockScalarStart => {
                let message = "a tab stands where YAML allows only spaces";
                Diagnostic::new(message).at(self.tab(place)).help("indent with spaces")
            }
            ErrorKind::UnknownAnchor => Diagnostic::new("this alias has no anchor (`&name`) before it").at(place),
            ErrorKind::UnclosedQuotedScalar => Diagnostic::new("a quote is opened and never closed").at(place),
            ErrorKind::UnclosedFlowCollection { open } => {
                Diagnostic::new(format!("`{open}` is opened and never closed")).at(place)
            }
            ErrorKind::DirectiveDisallowed => {
                Diagnostic::new("YAML directives (`%…`) have no meaning in a study").at(place)
            }
            ErrorKind::UnknownQuotedScalarEscape => {
                let message = "a `\\` in double quotes begins an escape, and there is none of this letter";
                Diagnostic::new(message).at(place).help("write the text in single quotes, or without any")
            }
            ErrorKind::MappingValueNotAllowed => Diagnostic::new("a `:` cannot stand here").at(place).help(quotes),
            ErrorKind::UnexpectedCharacter { character } => {
                let shown = quote(&character.to_string());
                Diagnostic::new(format!("{shown} cannot stand here")).at(place).help(quotes)
            }
            kind => Diagnostic::new(format!("not valid YAML: {kind}")).at(place).help(quotes),
        }
    }

    /// The character at a marker.
    fn point(&self, marker: Marker) -> Place {
        let offset = self.offset(marker);
        let next = self.text[offset..].chars().next().filter(|character| !character.is_whitespace());
        Place { line: marker.line(), column: marker.col() + 1, offset, length: next.map_or(0, char::len_utf8) }
    }

    /// The tab itself: the parser stops behind it or before the line that it is in.
    fn tab(&self, place: Place) -> Place {
        let line = self.text[..place.offset].rfind(['\n', '\r']).map_or(0, |at| at + 1);
        let before = self.text[line..place.offset].find('\t').map(|at| line + at);
        let offset = before.or_else(|| self.text[place.offset..].find('\t').map(|at| place.offset + at));
        offset.map_or(place, |offset| place_at(self.text, offset, 1))
    }
}

fn too_deep() -> Diagnostic {
    Diagnostic::new(format!("nested more than {DEEPEST} levels deep: too deep for a study"))
}

/// Takes a node as the key of the next value: its name, place, and whether it merges (`<<`).
fn new_key(node: Node, lines: &mut BTreeMap<String, usize>, whole: &str) -> Result<(String, Place, bool), Diagnostic> {
    let Content::Scalar { text, quoted } = node.content else {
        return Err(Diagnostic::new("a name is expected before the colon").at(node.place));
    };
    if text.is_empty() {
        return Err(Diagnostic::new("a name is missing before the colon").at(node.place));
    }
    if let Some(line) = lines.insert(text.clone(), node.place.line) {
        let message = format!("{} stands here a second time", quote(&text));
        if text == "<<" && !quoted {
            let help = format!("the first is in line {line}; one `<<` merges several mappings: `<<: [*one, *other]`");
            return Err(Diagnostic::new(message).at(node.place).help(help));
        }
        let cause = structure::second(whole, line, node.place).unwrap_or_else(|| "keep one of them".to_owned());
        return Err(Diagnostic::new(message).at(node.place).help(format!("the first is in line {line}; {cause}")));
    }
    let merges = !quoted && text == "<<";
    Ok((text, node.place, merges))
}

fn merge(node: Node, place: Place, into: &mut Vec<KeyValue>) -> Result<(), Diagnostic> {
    let wrong = || Diagnostic::new("`<<` merges a mapping, or a list of mappings").at(place);
    match node.content {
        Content::Mapping(pairs) => into.extend(pairs),
        Content::Sequence(items) => {
            for item in items {
                let Content::Mapping(pairs) = item.content else { return Err(wrong()) };
                into.extend(pairs);
            }
        }
        Content::Scalar { .. } => return Err(wrong()),
    }
    Ok(())
}
