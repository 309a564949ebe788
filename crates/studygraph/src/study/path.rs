//! Paths of fields: `ste.torque`, `pair.pinion.face_width`, `designs.designs.long[1].tip_relief.amount`.
//!
//! A path is a stage and the way to a field in it: names of fields, of members of families and of labels, joined by dots;
//! `[0]` is the first item of a list. It is followed in the tree of the study beside the declarations, so what is left
//! out in the text has a path too, and a wrong step is answered with the nearest name that there is. Must not know: what
//! any field means, who sets what.

use super::document::{Content, KeyValue, Node, nothing, parse};
use super::words::{alternatives, quote};
use crate::stage::Kind;
use declare::error::{Diagnostic, Place, suggest};
use declare::parameter::{Field, Member, Presence, Shape};

/// A path that was read; whether it leads anywhere is seen in a study.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldPath {
    /// As it was written.
    pub text: String,
    pub place: Place,
    /// At least one; the first is a name.
    steps: Vec<Step>,
}

#[derive(Clone, Debug, PartialEq)]
struct Step {
    word: Word,
    place: Place,
}

#[derive(Clone, Debug, PartialEq)]
enum Word {
    Name(String),
    /// Counted from 0.
    Item(usize),
}

/// Where a path leads.
#[derive(Clone, Copy)]
pub struct Target {
    /// The declared field; of an item, a label or a member the field that has it.
    pub field: &'static Field,
    /// What is expected there.
    pub shape: &'static Shape,
    /// Where the value stands; the stage's or the field's around it, where it is left out in the text.
    pub place: Place,
}

/// What the steps so far lead to.
#[derive(Clone, Copy)]
enum At {
    Fields(&'static [Field]),
    Value(&'static Field, &'static Shape),
}

impl FieldPath {
    /// Reads a path that stands at `at`.
    ///
    /// # Errors
    /// When it is not written as a path.
    pub fn parse(text: &str, at: Place) -> Result<Self, Diagnostic> {
        // Where the text stands as it is, every step has a place of its own.
        let placed = |offset: usize, length: usize| {
            let column = at.column + text[..offset].chars().count();
            if at.length == text.len() { Place { column, offset: at.offset + offset, length, ..at } } else { at }
        };
        let help =
            "write stage.field, for example `pair.pinion.face_width` or `designs.designs.long[1].tip_relief.amount`";
        let wrong = |message: String, offset: usize, length: usize| {
            Err(Diagnostic::new(message).at(placed(offset, length)).help(help))
        };
        let mut steps = Vec::new();
        let mut offset = 0;
        while offset < text.len() {
            let rest = &text[offset..];
            if let Some(inside) = rest.strip_prefix('[').filter(|_| !steps.is_empty()) {
                let length = inside.find(']').map_or(rest.len(), |end| end + 2);
                let number = inside.split(']').next().unwrap_or(inside);
                let digits = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
                let number = number.parse().ok().filter(|_| digits && rest[..length].ends_with(']'));
                let Some(number) = number else {
                    let message =
                        format!("{} is not an item of a list, such as `[0]` for the first", quote(&rest[..length]));
                    return wrong(message, offset, length);
                };
                steps.push(Step { word: Word::Item(number), place: placed(offset, length) });
                offset += length;
                continue;
            }
            let dot = usize::from(!steps.is_empty());
            if dot == 1 && !rest.starts_with('.') {
                return wrong(format!("`.` or `[` is expected before {}", quote(rest)), offset, rest.len());
            }
            let name = rest[dot..].split(['.', '[']).next().unwrap_or_default();
            if name.is_empty() {
                return wrong(format!("a name is missing in {}", quote(text)), offset, rest.len().min(1));
            }
            if let Some(found) = name.chars().find(|&c| !(c.is_alphanumeric() || c == '-' || c == '_')) {
                let message = format!("{} cannot stand in a path", quote(&found.to_string()));
                return wrong(message, offset + dot + name.find(found).unwrap_or(0), found.len_utf8());
            }
            steps.push(Step { word: Word::Name(name.to_owned()), place: placed(offset + dot, name.len()) });
            offset += dot + name.len();
        }
        if steps.is_empty() {
            wrong("a path is missing".to_owned(), 0, 0)
        } else {
            Ok(Self { text: text.to_owned(), place: at, steps })
        }
    }

    /// The one name of a path that is no more than that: a key of the study itself.
    #[must_use]
    pub fn only(&self) -> Option<&str> {
        if let [Step { word: Word::Name(name), .. }] = &self.steps[..] { Some(name) } else { None }
    }

    /// Where it leads, among the stages of a study as they are written.
    ///
    /// # Errors
    /// The first step that leads nowhere, with the nearest name that there is.
    pub fn find(&self, stages: &[KeyValue], kinds: &[&'static Kind]) -> Result<Target, Diagnostic> {
        // What is left out in the text is filled in on the way.
        self.reach(&mut stages.to_vec(), kinds, false).map(|(_, target)| target)
    }

    /// What stands where it leads, or, where it is left out in the text, its default; nothing where there is none.
    ///
    /// # Errors
    /// As [`FieldPath::find`].
    pub fn written(&self, stages: &[KeyValue], kinds: &[&'static Kind]) -> Result<Node, Diagnostic> {
        self.reach(&mut stages.to_vec(), kinds, false).map(|(node, _)| node.clone())
    }

    /// Puts `value` where it leads, in the place of what was written there or left out; a label that is not there yet, such as
    /// that of a new design, is added.
    ///
    /// # Errors
    /// As [`FieldPath::find`].
    pub fn set(&self, stages: &mut [KeyValue], kinds: &[&'static Kind], value: Node) -> Result<(), Diagnostic> {
        let (node, _) = self.reach(stages, kinds, true)?;
        *node = value;
        Ok(())
    }

    fn reach<'t>(
        &self,
        stages: &'t mut [KeyValue],
        kinds: &[&'static Kind],
        adds: bool,
    ) -> Result<(&'t mut Node, Target), Diagnostic> {
        let (stage, place) = (self.steps[0].shown(""), self.steps[0].place);
        let position = stages.iter().position(|pair| pair.key == stage).ok_or_else(|| {
            let names = stages.iter().map(|pair| pair.key.as_str()).collect::<Vec<_>>();
            Diagnostic::new(format!("there is no stage {}", quote(&stage))).at(place).help(suggest(&stage, names))
        })?;
        let (before, rest) = stages.split_at_mut(position);
        let [own, after @ ..] = rest else { unreachable!("it was found there") };
        let others = before.iter().chain(after.iter());
        let kind = kind_of(own, kinds).ok_or_else(|| {
            Diagnostic::new(format!("stage {} has no kind that is known", quote(&stage))).at(own.place)
        })?;
        if self.steps.len() == 1 {
            let message = format!("{} is a stage; name one of its fields", quote(&stage));
            return Err(Diagnostic::new(message).at(place).help(fields_are(&stage, kind.fields)));
        }
        let mut node = &mut own.node;
        let mut written = node.place;
        let mut at = At::Fields(kind.fields);
        let mut label = stage;
        // Stages that fields on the way refer to, and the one whose fields are replaced here.
        let mut named: Vec<(&'static str, String)> = Vec::new();
        let mut replaced: &[KeyValue] = &[];
        let mut next = 1;
        while next < self.steps.len() {
            let (step, current) = (&self.steps[next], node);
            if let At::Value(_, Shape::Group(fields)) = at {
                at = At::Fields(fields);
            }
            if let At::Value(field, Shape::Overrides(of)) = at {
                let about = named.iter().find(|(name, _)| name == of).map(|(_, stage)| stage);
                let about = about.and_then(|about| others.clone().find(|other| other.key == *about));
                let kind = about.and_then(|about| kind_of(about, kinds)).ok_or_else(|| {
                    let message = format!("{} names no stage, so {} has no fields", quote(of), quote(field.name));
                    Diagnostic::new(message).at(step.place)
                })?;
                if let Some(Content::Mapping(pairs)) = about.map(|about| &about.node.content) {
                    replaced = pairs;
                }
                at = At::Fields(kind.fields);
            }
            let mut taken = 1;
            (node, at) = match at {
                At::Fields(fields) => {
                    let wanted = step.name(&label, "has fields")?;
                    let field = fields.iter().find(|field| field.name == wanted).ok_or_else(|| {
                        let names: Vec<_> = fields.iter().map(|field| field.name).collect();
                        let message = format!("unknown field {} of {}", quote(wanted), quote(&label));
                        Diagnostic::new(message).at(step.place).help(suggest(wanted, names))
                    })?;
                    let pairs = mapping(current).ok_or_else(|| step.nothing_below(&label))?;
                    named.extend(references(fields, pairs));
                    (entry(pairs, field, replaced, self.place)?, At::Value(field, &field.shape))
                }
                At::Value(_, Shape::Member(members)) => {
                    let (node, member) = member(current, members(), step, &label)?;
                    (node, At::Fields(member.fields))
                }
                At::Value(field, Shape::List(item)) => {
                    // An item by itself is a list of one.
                    let node = if let Content::Sequence(_) = current.content {
                        let Content::Sequence(items) = &mut current.content else { unreachable!("seen before") };
                        step.item(items, &label)?
                    } else if current.is_null() {
                        step.item(&mut [], &label)?
                    } else {
                        step.item(std::slice::from_mut(current), &label)?
                    };
                    (node, At::Value(field, item))
                }
                At::Value(field, Shape::Map(item)) => {
                    let pairs = mapping(current).ok_or_else(|| step.nothing_below(&label))?;
                    let labelled = self.labelled(next, pairs, &label);
                    if let (Err(_), true, [Step { word: Word::Name(new), .. }]) = (&labelled, adds, &self.steps[next..])
                    {
                        pairs.push(KeyValue { key: new.clone(), place: self.place, node: nothing(self.place) });
                    }
                    let (position, steps) = labelled.or_else(|_| self.labelled(next, pairs, &label))?;
                    taken = steps;
                    (&mut pairs[position].node, At::Value(field, item))
                }
                // The items of a list of numbers, the words of `{ from, to, count }`.
                At::Value(field, shape) => {
                    let node = match (&mut current.content, &step.word) {
                        (Content::Sequence(items), _) => step.item(items, &label)?,
                        (Content::Mapping(pairs), Word::Name(wanted)) => {
                            let names: Vec<_> = pairs.iter().map(|pair| pair.key.clone()).collect();
                            pairs.iter_mut().find(|pair| pair.key == *wanted).map(|pair| &mut pair.node).ok_or_else(
                                || {
                                    let message = format!("there is no {} in {}", quote(wanted), quote(&label));
                                    let help = suggest(wanted, names.iter().map(String::as_str).collect::<Vec<_>>());
                                    Diagnostic::new(message).at(step.place).help(help)
                                },
                            )?
                        }
                        _ => return Err(step.nothing_below(&label)),
                    };
                    (node, At::Value(field, shape))
                }
            };
            if node.place != self.place {
                written = node.place;
            }
            next += taken;
            label = self.steps[next - 1].shown(&label);
        }
        match at {
            At::Value(field, shape) => Ok((node, Target { field, shape, place: written })),
            At::Fields(fields) => {
                let message = format!("{} has fields of its own; name one of them", quote(&label));
                Err(Diagnostic::new(message).at(self.steps[next - 1].place).help(fields_are(&label, fields)))
            }
        }
    }

    /// The label at this step, which may have dots itself: its position, and how many steps it takes.
    fn labelled(&self, next: usize, pairs: &[KeyValue], label: &str) -> Result<(usize, usize), Diagnostic> {
        let step = &self.steps[next];
        let first = step.name(label, "has labels")?;
        let mut wanted = String::new();
        let mut found = None;
        for (more, step) in self.steps[next..].iter().enumerate() {
            let Word::Name(name) = &step.word else { break };
            wanted += if more == 0 { "" } else { "." };
            wanted += name;
            if let Some(position) = pairs.iter().position(|pair| pair.key == wanted) {
                found = Some((position, more + 1));
            }
        }
        found.ok_or_else(|| {
            let names: Vec<_> = pairs.iter().map(|pair| pair.key.as_str()).collect();
            let message = format!("there is no {} in {}", quote(first), quote(label));
            Diagnostic::new(message).at(step.place).help(suggest(first, names))
        })
    }
}

impl Step {
    fn name(&self, label: &str, has: &str) -> Result<&str, Diagnostic> {
        match &self.word {
            Word::Name(name) => Ok(name),
            Word::Item(_) => Err(Diagnostic::new(format!("{} {has}, not items", quote(label))).at(self.place)),
        }
    }

    fn item<'n>(&self, items: &'n mut [Node], label: &str) -> Result<&'n mut Node, Diagnostic> {
        let count = items.len();
        let have = match count {
            0 => format!("{} is an empty list", quote(label)),
            1 => format!("{} is a list of one item, `[0]`", quote(label)),
            _ => format!("{} is a list of {count} items, `[0]` to `[{}]`", quote(label), count - 1),
        };
        match &self.word {
            Word::Name(name) => Err(Diagnostic::new(format!("{have}; {} is none of them", quote(name))).at(self.place)),
            Word::Item(item) => {
                let missing = || Diagnostic::new(format!("{have}; there is no `[{item}]`")).at(self.place);
                items.get_mut(*item).ok_or_else(missing)
            }
        }
    }

    fn nothing_below(&self, label: &str) -> Diagnostic {
        Diagnostic::new(format!("{} is a value; nothing is below it", quote(label))).at(self.place)
    }

    fn shown(&self, before: &str) -> String {
        match &self.word {
            Word::Name(name) => name.clone(),
            Word::Item(item) => format!("{before}[{item}]"),
        }
    }
}

/// The kind of a stage, as it is written.
pub fn kind_of(stage: &KeyValue, kinds: &[&'static Kind]) -> Option<&'static Kind> {
    let Content::Mapping(pairs) = &stage.node.content else { return None };
    let Content::Scalar { text, .. } = &pairs.iter().find(|pair| pair.key == "kind")?.node.content else { return None };
    kinds.iter().copied().find(|kind| kind.name == text)
}

fn fields_are(label: &str, fields: &[Field]) -> String {
    let names = fields.iter().map(|field| field.name);
    if fields.is_empty() {
        format!("{} has none", quote(label))
    } else {
        format!("its fields are {}", alternatives(names))
    }
}

/// What a mapping holds; what is not there becomes an empty one.
fn mapping(node: &mut Node) -> Option<&mut Vec<KeyValue>> {
    if node.is_null() {
        node.content = Content::Mapping(Vec::new());
    }
    if let Content::Mapping(pairs) = &mut node.content { Some(pairs) } else { None }
}

/// The fields that name stages, and those they name.
fn references(fields: &[Field], pairs: &[KeyValue]) -> Vec<(&'static str, String)> {
    let names = fields.iter().filter(|field| matches!(field.shape, Shape::Reference(_))).filter_map(|field| {
        let pair = pairs.iter().find(|pair| pair.key == field.name)?;
        if let Content::Scalar { text, .. } = &pair.node.content { Some((field.name, text.clone())) } else { None }
    });
    names.collect()
}

/// The value of a field; where it is left out, that of the stage whose fields are replaced here, or its default.
fn entry<'n>(
    pairs: &'n mut Vec<KeyValue>,
    field: &'static Field,
    replaced: &[KeyValue],
    place: Place,
) -> Result<&'n mut Node, Diagnostic> {
    if let Some(position) = pairs.iter().position(|pair| pair.key == field.name) {
        return Ok(&mut pairs[position].node);
    }
    let own = replaced.iter().find(|pair| pair.key == field.name).map(|pair| pair.node.clone());
    let node = match (own, field.presence) {
        (Some(own), _) => own,
        (None, Presence::Default(text)) => parse(text)?.unwrap_or_else(|| nothing(place)).moved_to(place),
        (None, _) => nothing(place),
    };
    pairs.push(KeyValue { key: field.name.to_owned(), place, node });
    let last = pairs.len() - 1;
    Ok(&mut pairs[last].node)
}

/// The fields of the member that stands there, which must be the one that the step names.
fn member<'n>(
    node: &'n mut Node,
    members: &'static [Member],
    step: &Step,
    label: &str,
) -> Result<(&'n mut Node, &'static Member), Diagnostic> {
    let wanted = step.name(label, "has a name and fields")?;
    let member = members.iter().find(|member| member.name == wanted).ok_or_else(|| {
        let names: Vec<_> = members.iter().map(|member| member.name).collect();
        let message = format!("unknown name {} in {}", quote(wanted), quote(label));
        Diagnostic::new(message).at(step.place).help(suggest(wanted, names))
    })?;
    let place = node.place;
    let is_bare = matches!(&node.content, Content::Scalar { text, .. } if text == wanted);
    if node.is_null() || is_bare {
        node.content = Content::Mapping(vec![KeyValue { key: wanted.to_owned(), place, node: nothing(place) }]);
    }
    let other = match &node.content {
        Content::Scalar { text, .. } => Some(text.clone()),
        Content::Mapping(pairs) => pairs.first().map(|pair| pair.key.clone()).filter(|key| key != wanted),
        Content::Sequence(_) => Some("a list".to_owned()),
    };
    if let Some(other) = other {
        let message = format!("{} is {} here, not {}", quote(label), quote(&other), quote(wanted));
        let help = format!("replace it as a whole: `{{ {wanted}: {{ … }} }}` is the value of {}", quote(label));
        return Err(Diagnostic::new(message).at(step.place).help(help));
    }
    match &mut node.content {
        Content::Mapping(pairs) if !pairs.is_empty() => Ok((&mut pairs[0].node, member)),
        _ => Err(step.nothing_below(label)),
    }
}
