//! A tree and a table of declared fields become a record: the only reader of everything a study can say.
//!
//! Every wrong input ends in one diagnostic: where, what was found, what was expected, and the nearest known name.
//! Names of stages are gathered and checked later, when all stages are known. Must not know: what any field means.

pub mod varied;

use super::around::{self, is_number, length};
use super::document::{Content, KeyValue, Node, nothing, parse};
use super::overrides::{self, Stages};
use super::place::mark;
use super::quantity::interval::{Interval, is_single};
use super::quantity::{Measure, any_quantity};
use super::scalar::{integer, not_a, scalar};
use super::words::{self, alternatives, quote};
use super::{files, unknown};
use declare::error::{Diagnostic, Place, suggest};
use declare::parameter::{Field, Member, Presence, Shape};
use declare::record::{PlacedValue, Record, Value, Variant};
use declare::units::parse_quantity;

/// The name of a stage that a field refers to.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The field.
    pub field: &'static str,
    pub stage: String,
    pub place: Place,
    pub kinds: &'static [&'static str],
}

/// Reads fields, and gathers the references among them.
pub struct Decoder<'a> {
    pub references: Vec<Reference>,
    /// The numbers that were printed rounded; all else has their middles alone.
    pub intervals: Vec<Interval>,
    /// Whether they stand in the record at [`mark`]s, by which their slots are found.
    pub marks_intervals: bool,
    /// Whatever is wrong besides what was returned as an error.
    pub faults: Vec<Diagnostic>,
    /// Where `[least, most]` belongs: `` in the `design` of an `optimizer` stage ``.
    pub ranges_belong: &'a str,
    /// All stages as written, for fields that override those of another one.
    stages: Stages<'a>,
    chooses: bool,
    /// The lengths of the mappings around, in SI: what plain numbers below may count in.
    lengths: Vec<(&'static str, f64)>,
}

/// A mapping whose fields are read, and how it is called in messages.
struct Owner<'a> {
    label: &'a str,
    /// Where it stands: the place of what is missing in it.
    place: Place,
    /// Where the columns are named of a file that stands in it: the place of a list that is missing.
    columns: Option<Place>,
}

impl<'a> Decoder<'a> {
    pub fn new(ranges_belong: &'a str, stages: Stages<'a>) -> Self {
        let (references, intervals, faults) = (Vec::new(), Vec::new(), Vec::new());
        Self {
            references,
            intervals,
            marks_intervals: false,
            faults,
            ranges_belong,
            stages,
            chooses: false,
            lengths: Vec::new(),
        }
    }

    /// Reads the fields of a mapping called `label` that stands at `place`; `others` are keys that somebody else reads.
    ///
    /// # Errors
    /// The first field that is unknown, missing or wrong; the others are among the faults.
    pub fn record(
        &mut self,
        node: &Node,
        fields: &'static [Field],
        others: &[&str],
        label: &str,
        place: Place,
    ) -> Result<Record, Diagnostic> {
        let pairs = match &node.content {
            Content::Mapping(pairs) => pairs.as_slice(),
            // A member without its fields may be written `name:`.
            Content::Scalar { .. } if node.is_null() => &[],
            _ => return Err(not_fields(node, fields, others, label)),
        };
        let read = pairs.iter().position(files::is_read);
        let owner = Owner { label, place, columns: read.map(|at| pairs[at].node.place) };
        let without;
        let pairs = match read {
            Some(at) => {
                without = [&pairs[..at], &pairs[at + 1..]].concat();
                &without
            }
            None => pairs,
        };
        let is_known =
            |pair: &KeyValue| others.contains(&pair.key.as_str()) || fields.iter().any(|field| field.name == pair.key);
        let mut wrong = Vec::new();
        if !pairs.iter().all(is_known) {
            let known: Vec<_> = others.iter().copied().chain(fields.iter().map(|field| field.name)).collect();
            let field = |name: &str| fields.iter().find(|field| field.name == name);
            let distance =
                |name: &str, text: &str| field(name).map(Measure::of).map_or(0.0, |measure| measure.distance(text));
            let length_of = |name: &str| pairs.iter().filter_map(|pair| length(fields, pair)).find(|own| own.0 == name);
            let refused = |name: &str, node: &Node| {
                let field = field(name).filter(|field| is_number(&field.shape))?;
                let of = |unit: &str| length_of(unit).map(|own| own.1).or_else(|| self.length_around(unit));
                let wrong = Measure::of(field).counting(field, of).refused(node, field)?;
                Some(self.with_rule(wrong, field, node, pairs))
            };
            let (known, stages) = (known.as_slice(), self.stages);
            let mapping =
                unknown::Mapping { pairs, known, fields, label, stages, distance: &distance, refused: &refused };
            wrong = mapping.unknown();
        }
        // What is missing may stand under another name, or in a file that is not there.
        let has_file = pairs.iter().any(|pair| is_file(fields, &pair.key));
        let is_renamed = !wrong.is_empty() || has_file;
        let around = self.lengths.len();
        self.lengths.extend(pairs.iter().filter_map(|pair| length(fields, pair)));
        let mut record = Record { fields: Vec::with_capacity(fields.len()), place };
        for field in fields {
            let is_missing = || !pairs.iter().any(|pair| pair.key == field.name);
            if is_renamed && field.presence == Presence::Required && is_missing() {
                continue;
            }
            // The first half of a number with a comma has been told.
            let is_told = |pair: &KeyValue| {
                wrong.iter().any(|found| found.place.is_some_and(|place| place.offset == pair.node.place.offset))
            };
            if is_renamed && pairs.iter().any(|pair| pair.key == field.name && is_told(pair)) {
                continue;
            }
            match self.field(field, pairs, &owner) {
                Ok(Some(entry)) => record.fields.push((field.name, entry)),
                Ok(None) => {}
                Err(found) => wrong.push(found),
            }
        }
        self.lengths.truncate(around);
        self.all_right(record, wrong)
    }

    /// What was read, or the first fault; the others are kept.
    fn all_right<T>(&mut self, read: T, wrong: Vec<Diagnostic>) -> Result<T, Diagnostic> {
        let mut wrong = wrong.into_iter();
        let Some(first) = wrong.next() else { return Ok(read) };
        self.faults.extend(wrong);
        Err(first)
    }

    /// Reads each of several, whatever is wrong with the others.
    fn each<N, T>(
        &mut self,
        nodes: impl IntoIterator<Item = N>,
        mut read: impl FnMut(&mut Self, N) -> Result<T, Diagnostic>,
    ) -> Result<Vec<T>, Diagnostic> {
        let nodes = nodes.into_iter();
        let (mut all, mut wrong) = (Vec::with_capacity(nodes.size_hint().0), Vec::new());
        for node in nodes {
            match read(self, node) {
                Ok(one) => all.push(one),
                Err(found) => wrong.push(found),
            }
        }
        self.all_right(all, wrong)
    }

    fn field(
        &mut self,
        field: &'static Field,
        pairs: &[KeyValue],
        owner: &Owner,
    ) -> Result<Option<PlacedValue>, Diagnostic> {
        let around = self.chooses;
        self.chooses |= field.chooses;
        let entry = match (pairs.iter().find(|pair| pair.key == field.name), field.presence) {
            (Some(pair), _) => {
                let value = self.value(&pair.node, &field.shape, field, field.name, pair.place);
                value.map(Some).map_err(|wrong| self.with_rule(wrong, field, &pair.node, pairs))
            }
            (None, Presence::Optional) => Ok(None),
            (None, Presence::Required) => {
                let expected = words::expected(&field.shape, words::example_of(field));
                let message = format!("{} has no {}; {expected} is expected", owner.label, quote(field.name));
                let is_column = matches!(field.shape, Shape::List(Shape::Quantity { .. } | Shape::Number { .. }));
                let place = owner.columns.filter(|_| is_column).unwrap_or(owner.place);
                Err(Diagnostic::new(message).at(place).help(field.summary))
            }
            (None, Presence::Default(text)) => {
                let node = parse(text)?.unwrap_or_else(|| nothing(owner.place)).moved_to(owner.place);
                self.value(&node, &field.shape, field, field.name, owner.place).map(Some)
            }
        };
        self.chooses = around;
        entry
    }

    /// Reads one value of a field; messages call it `name`, which stands at `key`.
    fn value(
        &mut self,
        node: &Node,
        shape: &'static Shape,
        field: &'static Field,
        name: &str,
        key: Place,
    ) -> Result<PlacedValue, Diagnostic> {
        let example = words::example_of(field);
        if node.is_null() {
            return Err(words::no_value(name, shape, field).at(node.place));
        }
        let value = match shape {
            Shape::Quantity { .. } | Shape::Number { .. } => {
                let measure = Measure::new(name, shape, example).counting(field, |unit| self.length_around(unit));
                if let Some(interval) = if is_single(field) { measure.interval(node)? } else { None } {
                    let value = measure.number(interval.middle);
                    let place = if self.marks_intervals { mark(self.intervals.len()) } else { node.place };
                    self.intervals.push(interval);
                    return Ok(PlacedValue { value, place });
                }
                measure.value(node, field.span, self.ranges()).map_err(|wrong| negative(field, node, wrong))?
            }
            Shape::AnyQuantity => any_quantity(name, node)?,
            Shape::Integer { minimum, maximum, multiple } => {
                let read = integer(name, node, shape, (*minimum, *maximum), *multiple);
                Value::Integer(read.map_err(|wrong| negative(field, node, wrong))?)
            }
            Shape::Flag => match node.plain() {
                Some("true" | "True" | "TRUE") => Value::Flag(true),
                Some("false" | "False" | "FALSE") => Value::Flag(false),
                _ => return Err(not_a(name, node, shape)),
            },
            Shape::Text => Value::Text(scalar(name, node, shape)?.to_owned()),
            // A file that is there has been put in its place.
            Shape::File => return Err(not_a(name, node, shape)),
            Shape::Choice(choices) => {
                let text = scalar(name, node, shape)?;
                let found = choices.iter().find(|choice| choice.name == text);
                let found = found.ok_or_else(|| {
                    let help = self.suggested(text, name, choices.iter().map(|choice| choice.name));
                    Diagnostic::new(format!("{} cannot be {}", quote(name), quote(text))).at(node.place).help(help)
                })?;
                Value::Choice(found.name)
            }
            Shape::Reference(kinds) => {
                let stage = scalar(name, node, shape)?.to_owned();
                self.references.push(Reference { field: field.name, stage: stage.clone(), place: node.place, kinds });
                Value::Reference(stage)
            }
            Shape::List(item @ (Shape::Quantity { .. } | Shape::Number { .. })) if node.is_mapping() => {
                Value::List(Measure::new(name, item, example).many(node)?)
            }
            Shape::List(item) => {
                let items = match &node.content {
                    Content::Sequence(items) => items.as_slice(),
                    _ => std::slice::from_ref(node),
                };
                // An item stands where it is written, not where the list does.
                let at = |item: &Node| if std::ptr::eq(item, node) { key } else { item.place };
                Value::List(self.each(items, |decoder, node| decoder.value(node, item, field, name, at(node)))?)
            }
            Shape::Map(item) => {
                let Content::Mapping(pairs) = &node.content else { return Err(not_a(name, node, shape)) };
                Value::Map(self.each(pairs, |decoder, pair| {
                    check_label(name, pair)?;
                    Ok((pair.key.clone(), decoder.value(&pair.node, item, field, &pair.key, pair.place)?))
                })?)
            }
            Shape::Group(fields) => Value::Group(self.record(node, fields, &[], &quote(name), key)?),
            Shape::Member(members) => {
                let (member, record) = self.member(name, node, members())?;
                Value::Member(member, record)
            }
            Shape::Overrides(of) => {
                let Content::Mapping(pairs) = &node.content else { return Err(not_a(name, node, shape)) };
                Value::Variant(self.variant(of, node, pairs)?)
            }
            Shape::Varied(of) => {
                let Content::Mapping(pairs) = &node.content else { return Err(not_a(name, node, shape)) };
                Value::Varied(varied::varied(self.stages, self.named(of, node)?, pairs)?)
            }
        };
        Ok(PlacedValue { value, place: node.place })
    }

    /// `name`, or `name: { fields }`.
    fn member(
        &mut self,
        field: &str,
        node: &Node,
        members: &'static [Member],
    ) -> Result<(&'static str, Record), Diagnostic> {
        let names = || members.iter().map(|member| member.name);
        let bare;
        let (name, place, inside) = match &node.content {
            Content::Scalar { text, .. } => {
                bare = nothing(node.place);
                (text, node.place, &bare)
            }
            Content::Mapping(pairs) => match pairs.as_slice() {
                [pair] => (&pair.key, pair.place, &pair.node),
                [] => {
                    let message = format!("{} is empty; {} is expected", quote(field), alternatives(names()));
                    return Err(Diagnostic::new(message).at(node.place));
                }
                [first, second, ..] => return Err(side_by_side(field, first, second, members)),
            },
            Content::Sequence(_) => {
                let message = format!("{} takes one of {}, not a list", quote(field), alternatives(names()));
                return Err(Diagnostic::new(message).at(node.place));
            }
        };
        let member = members.iter().find(|member| member.name == name).ok_or_else(|| {
            let message = if matches!(node.content, Content::Scalar { .. }) && parse_quantity(name).is_ok() {
                format!("{} is {}; it takes fields, not a number", quote(field), quote(name))
            } else {
                format!("unknown name {} in {}", quote(name), quote(field))
            };
            Diagnostic::new(message).at(place).help(self.suggested(name, field, names()))
        })?;
        if !inside.is_null() && !matches!(inside.content, Content::Mapping(_)) {
            return Err(not_fields(inside, member.fields, &[], &quote(member.name)));
        }
        Ok((member.name, self.record(inside, member.fields, &[], &quote(member.name), place)?))
    }

    /// The name among `known` that a word in `field` stands for, or is near to.
    fn suggested<'n>(&self, word: &str, field: &str, known: impl Iterator<Item = &'n str> + Clone) -> String {
        let called = unknown::called_among(word, field, &known, self.stages.foreign);
        called.unwrap_or_else(|| suggest(word, known))
    }

    /// A message about a value, with the rule by which its field follows from what stands there.
    fn with_rule(&self, wrong: Diagnostic, field: &Field, node: &Node, pairs: &[KeyValue]) -> Diagnostic {
        let Some(rule) = around::rule(field, node, pairs, self.stages) else { return wrong };
        let help = wrong.help.as_ref().map_or_else(|| rule.clone(), |help| format!("{help}; {rule}"));
        wrong.help(help)
    }

    /// The length of this name in the mappings around, in SI.
    fn length_around(&self, unit: &str) -> Option<f64> {
        self.lengths.iter().rev().find(|(name, _)| *name == unit).map(|(_, si)| *si)
    }

    /// The fields of the stage that the field `of` names, with those in `pairs` in the place of its own.
    fn variant(&mut self, of: &str, node: &Node, pairs: &[KeyValue]) -> Result<Variant, Diagnostic> {
        let Reference { stage, place, .. } = self.named(of, node)?.clone();
        let (kind, merged) = self.stages.merged(&stage, place, pairs)?;
        let around = std::mem::replace(&mut self.chooses, false);
        let record = self.record(&merged, kind.fields, &["kind"], &quote(&stage), node.place);
        self.chooses = around;
        Ok(Variant { kind: kind.name, written: overrides::written(pairs), record: record? })
    }

    /// What the field `of` names, for a field that stands at `node`.
    fn named(&self, of: &str, node: &Node) -> Result<&Reference, Diagnostic> {
        self.references.iter().find(|reference| reference.field == of).ok_or_else(|| {
            let message = format!("{} is not known, so nothing of it can be replaced", quote(of));
            Diagnostic::new(message).at(node.place)
        })
    }

    fn ranges(&self) -> Result<(), &'a str> {
        if self.chooses { Ok(()) } else { Err(self.ranges_belong) }
    }
}

/// The remedy for a negative value, where the field has one.
fn negative(field: &Field, node: &Node, wrong: Diagnostic) -> Diagnostic {
    let is_negative = node.plain().is_some_and(|text| text.starts_with('-')) && wrong.help.is_none();
    if is_negative && !field.negative.is_empty() { wrong.help(field.negative) } else { wrong }
}

/// More than one member where one is expected; often its fields are only not indented far enough.
fn side_by_side(field: &str, first: &KeyValue, second: &KeyValue, members: &[Member]) -> Diagnostic {
    let message =
        format!("{} and {} stand side by side; {} takes one", quote(&first.key), quote(&second.key), quote(field));
    let slipped = members.iter().any(|member| {
        member.name == first.key && first.node.is_null() && member.fields.iter().any(|field| field.name == second.key)
    });
    let help = if slipped {
        format!("indent {} and what follows further than {}", quote(&second.key), quote(&first.key))
    } else {
        "in a list, each starts with `- ` on a line of its own".to_owned()
    };
    Diagnostic::new(message).at(second.place).help(help)
}

/// Names that a user gives end up in tables, in conditions and in file names.
fn check_label(field: &str, pair: &KeyValue) -> Result<(), Diagnostic> {
    let fits = pair.key.chars().all(|c| c.is_alphanumeric() || "-_.".contains(c)) && pair.key.chars().count() <= 64;
    if fits {
        return Ok(());
    }
    let message = format!("{} cannot be a name in `{field}`", quote(&pair.key));
    Err(Diagnostic::new(message)
        .at(pair.place)
        .help("letters, digits, `-`, `_` and `.` make a name, at most 64 of them"))
}

fn is_file(fields: &[Field], name: &str) -> bool {
    fields.iter().any(|field| field.name == name && matches!(field.shape, Shape::File))
}

fn not_fields(node: &Node, fields: &[Field], others: &[&str], label: &str) -> Diagnostic {
    let message = format!("{label} is {}; a mapping from its fields to their values is expected", node.describe());
    let names: Vec<_> = others.iter().copied().chain(fields.iter().map(|field| field.name)).map(quote).collect();
    let help = if names.is_empty() {
        "it has no fields: write only its name".to_owned()
    } else {
        format!("its fields are {}", names.join(", "))
    };
    Diagnostic::new(message).at(node.place).help(help)
}
