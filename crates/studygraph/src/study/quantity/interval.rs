//! Numbers that were printed rounded: `0.504 ± 0.0005`, `5.05 ± 0.005 mm`, `5.05 mm ± 5 um`.
//!
//! The middle is the number, read as it would be by itself; half the width says what else it may be. Must not know: what is
//! done with it.

use super::super::document::{Content, Node};
use super::super::words::quote;
use super::Measure;
use declare::error::{Diagnostic, Place};
use declare::record::Record;
use declare::record::varied::{Axis, Form, Slot, Spread, Values, Within};
use declare::units::{Dimension, RATIO, split_quantity};

/// As which a half-width may be marked.
const SIGNS: [&str; 3] = ["±", "+/-", "+-"];

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
    place: Place,
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

/// A tolerance without its sign, which may be left out where nothing stands before it.
pub fn without_sign(text: &str) -> &str {
    let text = text.trim();
    SIGNS.iter().find_map(|sign| text.strip_prefix(sign)).unwrap_or(text).trim()
}

/// What stands before and behind the sign; none where there is none.
pub fn halves(text: &str) -> Option<(&str, &str)> {
    let first = SIGNS.iter().filter_map(|sign| Some((text.find(sign)?, sign.len())));
    let (at, length) = first.min()?;
    Some((text[..at].trim(), text[at + length..].trim()))
}

/// The middle with its unit, which may stand behind both.
fn middle(text: &str) -> Option<String> {
    let (middle, half) = halves(text)?;
    let (number, unit) = split_quantity(half);
    let is_behind_both = split_quantity(middle).1.is_empty() && !number.is_empty() && !unit.is_empty();
    Some(if is_behind_both { format!("{middle} {unit}") } else { middle.to_owned() })
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

impl Measure<'_> {
    /// What a single number of a field may be besides itself; none where it is no interval.
    ///
    /// # Errors
    /// When a half is missing or cannot be read, has no width, or an end is outside the range.
    pub fn interval(&self, node: &Node) -> Result<Option<Interval>, Diagnostic> {
        let Content::Scalar { text, quoted } = &node.content else { return Ok(None) };
        let Some((before, behind)) = halves(text) else { return Ok(None) };
        let wrong = |message: String| Diagnostic::new(message).at(node.place);
        let shown = quote(text);
        if before.is_empty() || behind.is_empty() {
            let where_to = if before.is_empty() { "before" } else { "behind" };
            let message = format!("nothing stands {where_to} the sign of {shown}; {} is expected", self.expected());
            return Err(wrong(message).help("an interval is written `0.504 ± 0.0005`, or `5.05 ± 0.005 mm`"));
        }
        let is_percent = [before, behind].map(|half| split_quantity(half).1 == "%");
        if self.dimension == Some(RATIO) && is_percent[0] != is_percent[1] {
            let message = format!("{shown} can be read in two ways; {} is expected", self.expected());
            return Err(wrong(message).help("write `%` behind both numbers, or behind none"));
        }
        let part = |text: String| Node { content: Content::Scalar { text, quoted: *quoted }, place: node.place };
        let own = middle(text).unwrap_or_default();
        let middle = self.single(&part(own.clone()))?;
        let width = Self { minimum: f64::NEG_INFINITY, maximum: f64::INFINITY, ..*self };
        let half = width.single(&part(behind.to_owned()))?;
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
        Ok(Some(Interval { middle, half, unit, dimension: self.dimension, range, place: node.place }))
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
    use declare::units::LENGTH;

    #[test]
    fn both_halves_have_a_unit_of_their_own_or_share_one() {
        for (text, expected) in [
            ("0.504 ± 0.0005", Some("0.504")),
            ("0.504±0.0005", Some("0.504")),
            ("0.504 +- 0.0005", Some("0.504")),
            ("-0.504 +/- 0.0005", Some("-0.504")),
            ("5.05 ± 0.005 mm", Some("5.05 mm")),
            ("5.05 mm ± 5 um", Some("5.05 mm")),
            ("5 % ± 0.5 %", Some("5 %")),
            ("5.05 mm", None),
            ("1e+3", None),
        ] {
            assert_eq!(middle(text).as_deref(), expected, "{text}");
        }
        assert_eq!((without_sign("± 2 um"), without_sign(" +-2 um"), without_sign("2 um")), ("2 um", "2 um", "2 um"));
    }

    #[test]
    fn an_interval_is_its_middle_as_it_is_by_itself() {
        let measure =
            Measure { name: "bore", dimension: Some(LENGTH), minimum: 0.0, maximum: 1.0, example: Some("12 mm") };
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
