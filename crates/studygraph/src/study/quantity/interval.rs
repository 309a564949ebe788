//! Numbers that were printed rounded: `0.504 ± 0.0005`, `5.05 ± 0.005 mm`, `5.05 mm ± 5 um`.
//!
//! The middle is the number, read as it would be by itself; half the width says what else it may be. Must not know: what is
//! done with it.

use super::super::document::{Content, Node};
use super::super::notation::{self, halves, middle};
use super::super::words::{self, quote};
use super::Measure;
use declare::error::{Diagnostic, Place};
use declare::parameter::{Field, Shape, Span};
use declare::record::Record;
use declare::record::varied::{Axis, Form, Slot, Spread, Values, Within};
use declare::units::{Dimension, LENGTH, RATIO, foreign_quantity, parse_quantity, split_quantity};

/// What stands for it elsewhere: markup, escapes outside of double quotes, other strokes, words.
const OTHER_SIGNS: [&str; 15] = [
    r"$\pm$", r"\u00b1", r"\u00B1", r"\xb1", "&plusmn;", "&pm;", "&#177;", "(±)", "(+/-)", "+/−", "+−", "-+", "−+",
    "∓", "+ -",
];
/// So many times what is usual, or a part of it, is far off; so many is near.
const FAR: f64 = 100.0;
const NEAR: f64 = 10.0;

/// A number that was printed rounded.
#[derive(Clone, Debug)]
pub struct Interval {
    pub middle: f64,
    /// Half the width, above 0, in SI as the middle is.
    half: f64,
    /// In which the middle is written.
    unit: String,
    /// None of a plain number.
    dimension: Option<Dimension>,
    /// What the field may be.
    range: (f64, f64),
    pub place: Place,
    /// As it is written.
    pub text: String,
}

impl Interval {
    /// The field of the stage `name`, the `stage`th of several, where it is marked in the record, which is then as if it had never
    /// been; none where the record has no such mark.
    pub fn axis(&self, name: &str, stage: usize, record: &mut Record, mark: Place) -> Option<Axis> {
        let slot = Slot::of_place(record, mark)?;
        slot.entry_mut(record)?.place = self.place;
        let path = format!("{name}{}", slot.path(record));
        let form = Form::Within(self.half, Within::Uniform);
        Some(Axis {
            name: path.clone(),
            path,
            place: self.place,
            stage,
            slot,
            dimension: self.dimension,
            unit: self.unit.clone(),
            multiple: None,
            values: Values::Spread(Spread { form, about: self.middle, ends: [None; 2] }),
            values_place: self.place,
            range: self.range,
        })
    }
}

/// Whether each number that a field has stands by itself, in no list and on no axis.
pub fn is_single(field: &Field) -> bool {
    let mut shape = &field.shape;
    while let Shape::Map(item) = shape {
        shape = item;
    }
    !matches!(shape, Shape::List(_)) && !matches!(field.span, Span::Axis { .. })
}

/// What an interval in another notation is here; none where a text is no such interval.
pub(super) fn elsewhere(text: &str) -> Option<String> {
    let written =
        |before: &str, behind: &str| format!("an interval is written `{} ± {}`", before.trim(), behind.trim());
    let text = text.trim();
    if let Some((at, sign)) = OTHER_SIGNS.iter().find_map(|sign| Some((text.find(sign)?, sign))) {
        return Some(written(&text[..at], &text[at + sign.len()..]));
    }
    if let Some((inside, unit)) = text.strip_prefix('(').and_then(|text| text.split_once(')'))
        && let Some((before, behind)) = halves(inside)
    {
        return Some(written(before, &format!("{behind} {}", unit.trim())));
    }
    let (number, rest) = split_quantity(text);
    let is_limit = |word: &str| {
        word.strip_prefix(['+', '-', '−'])
            .is_some_and(|size| size.starts_with(|c: char| c.is_ascii_digit() || c == '.'))
    };
    let starts_so = rest.starts_with(['+', '-', '−']) || rest.split_whitespace().skip(1).any(is_limit);
    let is_sided = !number.is_empty() && halves(text).is_none() && starts_so;
    is_sided.then(|| {
        "an interval is as wide to both sides: `0.504 ± 0.0005` is its middle and half of its width".to_owned()
    })
}

/// A value of a study without what it may be off by.
pub fn without_interval(mut node: Node) -> Node {
    if let Content::Scalar { text, .. } = &mut node.content
        && let Some(middle) = middle(text)
    {
        *text = middle;
    }
    node
}

/// The text that a help offers, `write ...`.
fn written(help: &str) -> Option<&str> {
    help.split_once("write `")?.1.split_once('`').map(|(text, _)| text)
}

/// A help for one of the numbers of an interval with both of them, as they are to be written; none if one is not known.
fn of_both(help: &str, [middle, half]: [Option<&str>; 2]) -> Option<String> {
    let Some(alone) = written(help) else { return Some(help.to_owned()) };
    Some(help.replacen(&quote(alone), &quote(&format!("{} ± {}", middle?, half?)), 1))
}

/// The error of one of the numbers of an interval, `texts`, with a help for the whole.
fn of_whole(found: &Diagnostic, texts: [&str; 2], read: &[Result<f64, Diagnostic>; 2], shown: &str) -> Diagnostic {
    let of =
        |at: usize| read[at].as_ref().map_or_else(|wrong| wrong.help.as_deref().and_then(written), |_| Some(texts[at]));
    let help = found.help.as_deref().and_then(|help| of_both(help, [of(0), of(1)]));
    let mut message = found.message.clone();
    if texts.iter().all(|text| split_quantity(text).1.is_empty()) {
        let [middle, half] = texts;
        let example = message.replace(&format!("`{middle} "), &format!("`{middle} ± {half} "));
        message = example.replace(&quote(middle), shown);
    }
    Diagnostic { message, help, ..found.clone() }
}

/// A length in SI, in any unit that is known anywhere.
fn length_of(text: &str) -> Option<f64> {
    let foreign = || foreign_quantity(text).filter(|read| read.1 == LENGTH).map(|read| read.0);
    let own = parse_quantity(text).ok().filter(|read| read.dimension == LENGTH).map(|read| read.value);
    own.or_else(foreign)
}

impl Measure<'_> {
    /// The error of a value of a field, which may be an interval where it is a single number.
    pub fn refused(&self, node: &Node, field: &Field) -> Option<Diagnostic> {
        match if is_single(field) { self.interval(node) } else { Ok(None) } {
            Ok(Some(_)) => None,
            Ok(None) => self.value(node, field.span, Ok(())).err(),
            Err(wrong) => Some(wrong),
        }
    }

    /// What a single number of a field may be besides itself; none where it is no interval.
    ///
    /// # Errors
    /// When a half is missing or cannot be read, has no width, or an end is outside the range.
    pub fn interval(&self, node: &Node) -> Result<Option<Interval>, Diagnostic> {
        let Content::Scalar { text, .. } = &node.content else { return Ok(None) };
        let wrong = |message: String| Diagnostic::new(message).at(node.place);
        let shown = quote(text);
        let other_notation =
            || wrong(format!("{shown} is not a number as a study has it; {} is expected", self.expected()));
        if let Some(help) = elsewhere(text) {
            return Err(other_notation().help(help));
        }
        let Some((before, behind)) = halves(text) else { return Ok(None) };
        if before.is_empty() || behind.is_empty() {
            let where_to = if before.is_empty() { "before" } else { "behind" };
            let message = format!("nothing stands {where_to} the sign of {shown}; {} is expected", self.expected());
            return Err(wrong(message).help("an interval is written `0.504 ± 0.0005`, or `5.05 ± 0.005 mm`"));
        }
        if halves(behind).is_some() {
            let message = format!("{shown} has more than one sign; {} is expected", self.expected());
            return Err(wrong(message).help("an interval is written `0.504 ± 0.0005`, or `5.05 ± 0.005 mm`"));
        }
        let helps = [before, behind].map(notation::help);
        if let Some(help) = helps.iter().flatten().next() {
            let parts = [(before, helps[0].as_deref()), (behind, helps[1].as_deref())];
            let help = of_both(help, parts.map(|(text, help)| help.map_or(Some(text), written)));
            let found = help.map(|help| notation::with_reading(help, text, &|text| self.distance(text)));
            return Err(Diagnostic { help: found, ..other_notation() });
        }
        let mut found = self.counted(before, behind, &shown);
        found = found.or_else(|| self.in_percent(before, behind, &shown));
        if let Some(found) = found.or_else(|| self.of_one_unit(before, behind, &shown)) {
            return Err(found.at(node.place));
        }
        // It is text to any reader of YAML, in quotes or not.
        let part = |text: String| Node { content: Content::Scalar { text, quoted: false }, place: node.place };
        let width = Self { minimum: f64::NEG_INFINITY, maximum: f64::INFINITY, ..*self };
        let own = middle(text).unwrap_or_default();
        let read = [self.single(&part(own.clone())), width.single(&part(behind.to_owned()))];
        // A fault of a unit behind both is reported of the text as it is written.
        let first = usize::from(own != before || split_quantity(behind).0.is_empty());
        if let Some(found) = [first, 1 - first].into_iter().find_map(|at| read[at].as_ref().err()) {
            return Err(of_whole(found, [&own, behind], &read, &shown));
        }
        let [middle, half] = read;
        let (middle, half) = (middle?, half?);
        if half <= 0.0 {
            let message =
                format!("{} behind the sign of {shown} is no half of a width: it is not above 0", quote(behind));
            return Err(wrong(message).help(format!("what is not off by anything is written `{own}`")));
        }
        if middle - half < self.minimum || middle + half > self.maximum {
            let range = self.range().unwrap_or_else(|| "finite".to_owned());
            let message = format!("{} must be {range}, also at both ends of {shown}", quote(self.name));
            return Err(wrong(message));
        }
        let unit = if self.dimension.is_none_or(|dimension| dimension == RATIO) { "" } else { split_quantity(&own).1 };
        let (unit, range) = (unit.to_owned(), (self.minimum, self.maximum));
        let text = text.clone();
        Ok(Some(Interval { middle, half, unit, dimension: self.dimension, range, place: node.place, text }))
    }

    /// Two lengths of a number that counts in a length: both of them divided by it.
    pub(super) fn counted(&self, before: &str, behind: &str, shown: &str) -> Option<Diagnostic> {
        let (field, unit) = self.counts_in?;
        let [middle, half] = [before, behind].map(|text| (split_quantity(text), length_of(text)));
        let has_unit = [middle.0.1, half.0.1].map(|unit| !unit.is_empty());
        let is_length = [middle.1, half.1].map(|length| length.is_some());
        let is_share = half.0.1 == "%" && is_length[0];
        let fits = |at: usize| is_length[at] || !has_unit[at];
        if !is_length.contains(&true) || !(fits(0) && (fits(1) || is_share)) {
            return None;
        }
        let wrong = Diagnostic::new(format!("{shown} has a unit; {} is a plain number", quote(self.name)));
        let [number, of_half] = [middle.0.0, half.0.0].map(|number| number.parse::<f64>().ok());
        let (number, of_half) = (number?, of_half?);
        if [middle.0.1, half.0.1].iter().all(|unit| matches!(*unit, "" | "m")) {
            let modules = format!("{} ± {}", middle.0.0, half.0.0);
            let help = format!("`m` is the metre; for {modules} times the {field} write `{modules}`");
            return Some(wrong.help(format!("{} counts in `{field}`, and {help}", quote(self.name))));
        }
        let Some(unit) = unit.filter(|unit| *unit > 0.0) else {
            let help = format!("{} counts in `{field}`: divide both lengths by that of `{field}`", quote(self.name));
            return Some(wrong.help(help));
        };
        let written = |middle: f64, half: f64| format!("`{} ± {}`", words::number(middle), words::number(half));
        // The unit behind both numbers is that of both.
        let shared = |text: &str| length_of(&format!("{text} {}", if has_unit[0] { middle.0.1 } else { half.0.1 }));
        let in_modules = middle.1.or_else(|| shared(before))? / unit;
        let half_in_modules =
            if is_share { in_modules.abs() * of_half / 100.0 } else { half.1.or_else(|| shared(behind))? / unit };
        let other = match is_length {
            [false, true] => Some(written(number, half_in_modules)),
            [true, false] if !is_share => Some(written(in_modules, of_half)),
            _ => None,
        };
        let one = words::quantity(unit, LENGTH);
        let other = other
            .map_or(String::new(), |other| format!(", or {other} if the number without a unit is one of {field}s"));
        let help = format!(
            "{} counts in `{field}`, {one}: write {}{other}",
            quote(self.name),
            written(in_modules, half_in_modules)
        );
        Some(wrong.help(help))
    }

    /// A half-width in percent, which may be a share of the number, or as many hundredths; what else in percent is no ratio.
    fn in_percent(&self, before: &str, behind: &str, shown: &str) -> Option<Diagnostic> {
        let [(number, unit), (share, of_half)] = [before, behind].map(split_quantity);
        let is_percent = [unit, of_half].map(|unit| unit == "%");
        let is_ratio = self.dimension == Some(RATIO);
        if !is_percent.contains(&true) || is_ratio && is_percent == [true; 2] {
            return None;
        }
        let (Ok(number), Ok(share)) = (number.parse::<f64>(), share.parse::<f64>()) else { return None };
        let written = |half: f64, unit: &str| {
            let [middle, half] = [number, half].map(|value| format!("{} {unit}", words::number(value)));
            format!("`{} ± {}`", middle.trim(), half.trim())
        };
        let two_ways = format!("{shown} can be read in two ways; {} is expected", self.expected());
        let of_it = written(number.abs() * share / 100.0, unit);
        Some(match (self.dimension, is_percent) {
            (None, [true, _]) => {
                let half = if is_percent[1] { share / 100.0 } else { share };
                let [middle, half] = [number / 100.0, half].map(words::number);
                let message = format!("{shown} has a unit; {} is a plain number", quote(self.name));
                Diagnostic::new(message).help(format!("write `{middle} ± {half}`"))
            }
            (Some(RATIO), [true, _]) => Diagnostic::new(two_ways).help("write `%` behind both numbers, or behind none"),
            (None | Some(RATIO), _) => {
                let both = if is_ratio { format!(", or {} in percent", written(share, "%")) } else { String::new() };
                let help = format!(
                    "write {of_it} for {share} % of {number}, {} for {share} % of 1{both}",
                    written(share / 100.0, "")
                );
                Diagnostic::new(two_ways).help(help)
            }
            (Some(dimension), [false, true]) => {
                let message =
                    format!("`{behind}` behind the sign of {shown} is a ratio; {} is expected", self.expected());
                let example = words::example_like(before, dimension, self.minimum, self.maximum, self.example);
                let unit =
                    if unit.is_empty() { example.as_deref().map_or("", |text| split_quantity(text).1) } else { unit };
                Diagnostic::new(message).help(format!("write {}", written(number.abs() * share / 100.0, unit)))
            }
            _ => return None,
        })
    }

    /// A unit behind both numbers with which the middle is far from what is usual here, and without which it is near.
    fn of_one_unit(&self, before: &str, behind: &str, shown: &str) -> Option<Diagnostic> {
        let unit = split_quantity(behind).1;
        let usual =
            self.example.map(|text| split_quantity(text).1).filter(|usual| !usual.is_empty() && *usual != unit)?;
        if unit.is_empty() || !split_quantity(before).1.is_empty() {
            return None;
        }
        let is_own = parse_quantity(behind).is_ok_and(|read| Some(read.dimension) == self.dimension);
        let [as_written, as_usual] = [unit, usual].map(|unit| format!("{before} {unit}"));
        if !is_own || self.distance(&as_written) < FAR.ln() || self.distance(&as_usual) > NEAR.ln() {
            return None;
        }
        let message =
            format!("the unit of {shown} is that of both numbers, so {} would be `{as_written}`", quote(self.name));
        Some(
            Diagnostic::new(message)
                .help(format!("write `{as_usual} ± {behind}`, or `{as_written} ± {behind}` if it is")),
        )
    }

    /// That an interval stands where none can.
    pub(super) fn no_interval(&self, text: &str) -> Diagnostic {
        let message = format!("{} is an interval; {} is expected here", quote(text), self.expected());
        Diagnostic::new(message)
            .help("an interval is the single number of a field of a stage, not one of a list or an axis")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_is_its_middle_as_it_is_by_itself() {
        let shape = Shape::Quantity { dimension: LENGTH, minimum: 0.0, maximum: 1.0 };
        let measure = Measure::new("bore", &shape, Some("12 mm"));
        let node = |text: &str| Node {
            content: Content::Scalar { text: text.to_owned(), quoted: false },
            place: Place::default(),
        };
        let alone = measure.single(&node("5.05 mm")).unwrap();
        for text in ["5.05 ± 0.005 mm", "5.05 mm ± 5 um", "5.05 mm +/- 5e-3 mm"] {
            let read = measure.interval(&node(text)).unwrap().unwrap();
            assert_eq!(read.middle.to_bits(), alone.to_bits(), "{text}");
            assert!((read.half - 5e-6).abs() < 1e-20 && read.unit == "mm", "{text}: {read:?}");
        }
        assert!(measure.interval(&node("5.05 mm")).unwrap().is_none());
        // An end may be where the range ends, and no further.
        assert!(measure.interval(&node("5 ± 5 mm")).is_ok());
        assert!(measure.interval(&node("5 ± 5.01 mm")).is_err());
    }
}
