//! Fields of other stages with many values: what fields of the shape `Varied` are read as.
//!
//! A value is put where its path leads in the tree of the study, and read with the stage it belongs to; where it comes out
//! in the record is its slot. So whatever a stage can be told can be varied, with the unit and the range that its own
//! declaration has. Must not know: what any field means, which combinations of values are taken.

use super::{Decoder, Reference};
use crate::study::document::{Content, KeyValue, Node};
use crate::study::overrides::Stages;
use crate::study::path::FieldPath;
use crate::study::place::mark;
use crate::study::quantity::Measure;
use crate::study::quantity::interval::without_interval;
use crate::study::scalar::{integer, scalar};
use crate::study::words::{alternatives, expected, quote};
use crate::study::{spread, unknown};
use declare::error::{Diagnostic, Place};
use declare::parameter::Shape;
use declare::record::Record;
use declare::record::varied::{Axis, Form, Slot, Spread, Stage, Values, Varied};
use declare::units::{LENGTH, RATIO, parse_quantity, split_quantity};

/// What names of columns look like, as a regular expression: they are words of formulas and of SQL.
pub const COLUMN_PATTERN: &str = "^[a-z][a-z0-9_]{0,63}$";
const FIELDS: [&str; 12] =
    ["field", "values", "from", "to", "count", "follows", "within", "shape", "iso1328", "normal", "mean", "mode"];

/// A stage that the asked one reads, near or far.
struct Link {
    name: String,
    kind: &'static crate::stage::Kind,
    record: Record,
    /// The stages that it refers to.
    reads: Vec<String>,
}

/// Reads the mapping `pairs` of columns to fields of the stage that `of` names and of those it reads.
///
/// # Errors
/// A path that leads nowhere or to no number; values that the field does not take; a stage that has nothing to do with it.
pub fn varied(stages: Stages, of: &Reference, pairs: &[KeyValue]) -> Result<Varied, Diagnostic> {
    let mut links = Vec::new();
    link(stages, &of.stage, of.place, &mut Vec::new(), &mut links)?;
    let mut tree = stages.pairs.to_vec();
    let mut axes = Vec::new();
    for (index, pair) in pairs.iter().enumerate() {
        let (axis, stage, value) = axis(stages, &links, pair, &of.stage)?;
        let path = FieldPath::parse(&axis.path, axis.place)?;
        path.set(&mut tree, stages.kinds, Node { place: mark(index), ..value })?;
        axes.push((axis, stage));
    }
    // Those that have a varied field, those that read one of them, and the asked one, which comes last.
    let mut kept: Vec<&Link> = Vec::new();
    for link in &links {
        let has = axes.iter().any(|(_, stage)| *stage == link.name);
        if has || link.reads.iter().any(|read| kept.iter().any(|link| link.name == *read)) || link.name == of.stage {
            kept.push(link);
        }
    }
    let index = |name: &str| kept.iter().position(|link| link.name == name);
    let filled = Stages { pairs: &tree, ..stages };
    let is_class =
        |(axis, _): &(Axis, String)| matches!(axis.values, Values::Spread(Spread { form: Form::Class(..), .. }));
    let mut found = Varied::default();
    if axes.iter().any(is_class) {
        found.nearby = links.iter().map(|link| (link.kind.name, link.record.clone())).collect();
    }
    for link in &kept {
        // What is wrong with the values together is no mistake of the text in any one place.
        let (record, _) = read(filled, &link.name, of.place).map_err(|wrong| wrong.at(of.place))?;
        let reads = link.reads.iter().map(|name| index(name)).collect();
        found.stages.push(Stage {
            name: link.name.clone(),
            kind: link.kind.name,
            record: link.record.clone(),
            filled: record,
            reads,
        });
    }
    for (number, (mut axis, stage)) in axes.into_iter().enumerate() {
        axis.stage = index(&stage).unwrap_or_default();
        let slot = Slot::of_place(&found.stages[axis.stage].filled, mark(number));
        axis.slot = slot.ok_or_else(|| {
            let message = format!(
                "{} cannot be varied by itself: another column varies it, or all of it is one axis",
                quote(&axis.path)
            );
            Diagnostic::new(message).at(axis.place)
        })?;
        found.axes.push(axis);
    }
    Ok(found)
}

/// Gathers a stage after all that it reads; `open` are those that are being gathered.
fn link(
    stages: Stages,
    name: &str,
    place: Place,
    open: &mut Vec<String>,
    links: &mut Vec<Link>,
) -> Result<(), Diagnostic> {
    // Stages that read each other in a circle are told of when all are known.
    if open.iter().any(|other| other == name) || links.iter().any(|link| link.name == name) {
        return Ok(());
    }
    open.push(name.to_owned());
    let (kind, _) = stages.plain(name, place)?;
    let (record, references) = read(stages, name, place)?;
    for reference in &references {
        link(stages, &reference.stage, reference.place, open, links)?;
    }
    open.pop();
    let reads = references.into_iter().map(|reference| reference.stage).collect();
    links.push(Link { name: name.to_owned(), kind, record, reads });
    Ok(())
}

fn read(stages: Stages, name: &str, place: Place) -> Result<(Record, Vec<Reference>), Diagnostic> {
    let (kind, stage) = stages.plain(name, place)?;
    let mut decoder = Decoder::new("where an optimiser chooses", Stages::default());
    let record = decoder.record(&stage.node, kind.fields, &["kind"], &quote(name), stage.place)?;
    Ok((record, decoder.references))
}

/// A column: its axis, the stage that has the field, and the first value as written.
fn axis(stages: Stages, links: &[Link], pair: &KeyValue, of: &str) -> Result<(Axis, String, Node), Diagnostic> {
    let name = &pair.key;
    let mut characters = name.chars();
    let fits = characters.next().is_some_and(|first| first.is_ascii_lowercase())
        && characters.all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
        && name.len() <= 64;
    if !fits {
        return Err(Diagnostic::new(format!("{} cannot be the name of a column", quote(name)))
            .at(pair.place)
            .help("lower-case letters, digits and `_` make a name, at most 64 of them, a letter first"));
    }
    let Content::Mapping(fields) = &pair.node.content else {
        let message = format!("{} is {}; `{{ field: …, values: […] }}` is expected", quote(name), pair.node.describe());
        return Err(Diagnostic::new(message).at(pair.node.place));
    };
    if let Some(wrong) =
        unknown::Mapping::plain(fields, &FIELDS, &quote(name), &|_, _| 0.0).unknown().into_iter().next()
    {
        return Err(wrong);
    }
    let given = |field: &str| fields.iter().find(|given| given.key == field && !given.node.is_null());
    let Some(written) = given("field") else {
        return Err(Diagnostic::new(format!("{} does not say which `field` it varies", quote(name)))
            .at(pair.place)
            .help("for example `field: pair.pinion.face_width`"));
    };
    let text = scalar("field", &written.node, &Shape::Text)?;
    let path = FieldPath::parse(text, written.node.place)?;
    let target = path.find(stages.pairs, stages.kinds)?;
    let stage = text.split(['.', '[']).next().unwrap_or_default();
    if !links.iter().any(|link| link.name == stage) {
        let names = alternatives(links.iter().map(|link| link.name.as_str()));
        return Err(Diagnostic::new(format!(
            "{} does not read {}, so nothing of it changes there",
            quote(of),
            quote(stage)
        ))
        .at(written.node.place)
        .help(format!("fields of {names} can be varied")));
    }
    let (dimension, multiple) = match target.shape {
        Shape::Quantity { dimension, .. } => (Some(*dimension), None),
        Shape::Number { .. } => (None, None),
        Shape::Integer { multiple, .. } => (None, Some(*multiple)),
        other => {
            let message = format!("only numbers are varied, and {} takes {}", quote(text), expected(other, None));
            return Err(Diagnostic::new(message).at(written.node.place));
        }
    };
    let measure = Measure::new(name, target.shape, None).counting(target.field, |unit| length_of(&stages, stage, unit));
    let one = |node: &Node| number(measure, target.shape, node);
    let path_text = text;
    let about = || path.written(stages.pairs, stages.kinds).map(without_interval);
    let stated = spread::Stated { name, fields, place: pair.place, measure };
    let (values, first, values_place) = if let Some(formula) = given("follows") {
        if let Some(other) = fields.iter().find(|other| !["field", "follows"].contains(&other.key.as_str())) {
            let message = format!("{} does not go with `follows`, which says all of it", quote(&other.key));
            return Err(Diagnostic::new(message).at(other.place));
        }
        let text = scalar("follows", &formula.node, &Shape::Text)?;
        let written = about()?;
        if written.is_null() {
            let message = format!("the study has no value of {}, by which its unit were known", quote(path_text));
            return Err(Diagnostic::new(message).at(formula.node.place).help("write one in its stage"));
        }
        (Values::Follows(text.to_owned()), written, formula.node.place)
    } else if let Some((spread, first, place)) = stated.spread(multiple, about)? {
        (Values::Spread(spread), first, place)
    } else {
        match (given("values"), given("from"), given("to"), given("count")) {
            (Some(values), None, None, None) => {
                let items = if let Content::Sequence(items) = &values.node.content {
                    items.as_slice()
                } else {
                    std::slice::from_ref(&values.node)
                };
                let Some(first) = items.first() else {
                    return Err(Diagnostic::new(format!("{} has no values", quote(name))).at(values.node.place));
                };
                (Values::Each(items.iter().map(one).collect::<Result<_, _>>()?), first.clone(), values.node.place)
            }
            (None, Some(from), Some(to), None) => {
                let (low, high) = (one(&from.node)?, one(&to.node)?);
                if low >= high {
                    let message =
                        format!("`to` ({}) must be above `from` ({})", to.node.describe(), from.node.describe());
                    return Err(Diagnostic::new(message).at(to.node.place));
                }
                (Values::Between(low, high), from.node.clone(), from.node.place)
            }
            (None, Some(from), Some(_), Some(_)) => {
                let ends = fields.iter().filter(|field| field.key != "field").cloned().collect();
                let node = Node { content: Content::Mapping(ends), place: pair.node.place };
                (Values::Each(spaced(name, target.shape, &node)?), from.node.clone(), from.node.place)
            }
            _ => {
                let message = format!("{} needs its `values`, or `from` and `to`", quote(name));
                return Err(Diagnostic::new(message)
                    .at(pair.place)
                    .help("write `values: […]`, `from: …, to: …, count: …`, or for random designs `from: …, to: …`"));
            }
        }
    };
    let unit = match (&first.content, dimension) {
        (Content::Scalar { text, .. }, Some(dimension)) if dimension != RATIO => split_quantity(text).1.to_owned(),
        _ => String::new(),
    };
    let Measure { minimum, maximum, .. } = Measure::new(name, target.shape, None);
    let (name, place) = (name.clone(), written.node.place);
    let axis = Axis {
        name,
        path: text.to_owned(),
        place,
        stage: 0,
        slot: Slot::default(),
        dimension,
        unit,
        multiple,
        values,
        values_place,
        range: (minimum, maximum),
    };
    Ok((axis, stage.to_owned(), first))
}

fn number(measure: Measure, shape: &Shape, node: &Node) -> Result<f64, Diagnostic> {
    match shape {
        Shape::Integer { minimum, maximum, multiple } => {
            Ok(integer(measure.name, node, shape, (*minimum, *maximum), *multiple)? as f64)
        }
        _ => measure.single(node),
    }
}

/// A length that a stage has in a field of its own, in SI.
fn length_of(stages: &Stages, stage: &str, field: &str) -> Option<f64> {
    let Content::Mapping(pairs) = &stages.pairs.iter().find(|pair| pair.key == stage)?.node.content else {
        return None;
    };
    let Content::Scalar { text, .. } = &pairs.iter().find(|pair| pair.key == field)?.node.content else { return None };
    parse_quantity(text).ok().filter(|read| read.dimension == LENGTH).map(|read| read.value)
}

/// The points of `{ from, to, count }`, which must be whole where the field is.
fn spaced(name: &str, shape: &Shape, node: &Node) -> Result<Vec<f64>, Diagnostic> {
    let values = match Measure::new(name, shape, None).spaced(node)? {
        declare::record::Value::Axis(values) => values,
        _ => Vec::new(),
    };
    if let Shape::Integer { multiple, .. } = shape
        && let Some(value) = values.iter().find(|value| *value % *multiple as f64 != 0.0)
    {
        let message = format!("{} takes whole numbers, multiples of {multiple}; {value} is none", quote(name));
        return Err(Diagnostic::new(message).at(node.place).help("take another `count`, or write the `values`"));
    }
    Ok(values)
}
