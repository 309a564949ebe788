//! Stages of a study of which some fields are given many values, as a sweep has them.
//!
//! A field is found in the record of its stage by a [`Slot`], so that a value can be put there without a look at names. Must
//! not know: YAML, and what any field means.

use super::{PlacedValue, Record, Value};
use crate::digest::Writer;
use crate::error::Place;
use crate::units::Dimension;

/// The name under which a record has the intervals of the inputs of the stages that it is set against, if any has one. No field
/// of a study is called so: a field of the record says that they are gathered.
pub const INTERVALS: &str = "intervals";

/// What is varied, and the stages that this concerns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Varied {
    /// Kind and fields, as the study has them, of the asked stage and of all that it reads, near or far. Empty unless an axis
    /// states a class of tolerances, whose width depends on them.
    pub nearby: Vec<(&'static str, Record)>,
    /// Those that have a varied field, those that read them, and the asked one, each after all it reads.
    pub stages: Vec<Stage>,
    /// In the order of the study; no two have one name.
    pub axes: Vec<Axis>,
    /// Stages that depend on what varies, and stay as in the study all the same.
    pub held: Vec<String>,
}

/// A stage that comes out otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// As the study calls it.
    pub name: String,
    /// The stage's kind.
    pub kind: &'static str,
    /// All fields as the study has them.
    pub record: Record,
    /// The same with one value of each varied field in its place, where the slots lead.
    pub filled: Record,
    /// For each reference in it, in the order of its fields: which of these stages it means; none for one that comes out as
    /// in the study.
    pub reads: Vec<Option<usize>>,
}

/// A field and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The column.
    pub name: String,
    /// As written.
    pub path: String,
    /// Where the path stands.
    pub place: Place,
    /// Index of the stage that has the field.
    pub stage: usize,
    /// Where it is in that stage's record.
    pub slot: Slot,
    /// None of a plain or a whole number.
    pub dimension: Option<Dimension>,
    /// In which unit the first value is written; empty where there is none.
    pub unit: String,
    /// Of a whole number: what it must be a multiple of.
    pub multiple: Option<i64>,
    pub values: Values,
    /// Where the values stand.
    pub values_place: Place,
    /// What the field may be, in SI.
    pub range: (f64, f64),
}

/// The values of a field, in SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// These, in their order; not empty.
    Each(Vec<f64>),
    /// Any from the first to the second, which is larger.
    Between(f64, f64),
    /// As a distribution has them.
    Spread(Spread),
    /// What a formula over the other columns gives; the numbers of both are those of their units.
    Follows(String),
}

/// How a field is distributed, as a study states it, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    pub form: Form,
    /// The middle, the mean or the mode: as stated, or the value that the study has.
    pub about: f64,
    /// Where it is cut off, or begins and ends.
    pub ends: [Option<f64>; 2],
}

/// The forms in which it can be stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// So far to either side.
    Within(f64, Within),
    /// As far as a class of tolerances allows.
    Class(i64, Within),
    /// Normal with this standard deviation.
    Normal(f64),
    /// Rising to a mode and falling, from end to end.
    Triangular,
}

/// How values lie within a tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Within {
    /// All alike.
    Uniform,
    /// Most in the middle, none at the limits.
    Triangular,
    /// Normal, three standard deviations to either limit, and nothing beyond.
    Normal,
}

impl Within {
    pub const WORDS: [&'static str; 3] = ["uniform", "triangular", "normal"];

    #[must_use]
    pub fn of(word: &str) -> Option<Self> {
        let at = Self::WORDS.iter().position(|known| *known == word)?;
        Some([Self::Uniform, Self::Triangular, Self::Normal][at])
    }

    #[must_use]
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }
}

impl Spread {
    fn write(&self, writer: &mut Writer) {
        match self.form {
            Form::Within(half, within) => writer.text("within").float(half).text(within.word()),
            Form::Class(class, within) => writer.text("class").integer(class).text(within.word()),
            Form::Normal(deviation) => writer.text("normal").float(deviation),
            Form::Triangular => writer.text("triangular"),
        };
        writer.float(self.about);
        for end in self.ends {
            writer.flag(end.is_some()).float(end.unwrap_or(0.0));
        }
    }
}

impl Axis {
    /// The value as the field holds it.
    #[must_use]
    pub fn value(&self, si: f64) -> Value {
        match (self.multiple, self.dimension) {
            // Whole and within the bounds of the field, where it was read.
            #[allow(clippy::cast_possible_truncation)]
            (Some(_), _) => Value::Integer(si as i64),
            (None, Some(_)) => Value::Quantity(si),
            (None, None) => Value::Number(si),
        }
    }

    /// Puts a value into the record of the axis' stage.
    pub fn put(&self, record: &mut Record, si: f64) {
        if let Some(entry) = self.slot.entry_mut(record) {
            entry.value = if matches!(entry.value, Value::Axis(_)) { Value::Axis(vec![si]) } else { self.value(si) };
        }
    }
}

impl Varied {
    /// What a record has of it under [`INTERVALS`].
    #[must_use]
    pub fn intervals(record: &Record) -> Option<&Self> {
        match &record.entry(INTERVALS)?.value {
            Value::Varied(varied) => Some(varied),
            _ => None,
        }
    }

    /// The number that the study itself has where an axis is; none where it has nothing there, or several.
    #[must_use]
    pub fn own(&self, axis: &Axis) -> Option<f64> {
        let stage = self.stages.get(axis.stage)?;
        match &axis.slot.same_in(&stage.filled, &stage.record)?.value {
            Value::Quantity(value) | Value::Number(value) => Some(*value),
            Value::Integer(value) => Some(*value as f64),
            Value::Axis(values) if values.len() == 1 => Some(values[0]),
            _ => None,
        }
    }

    /// Digest of the input that all values share: the stages without the varied values, and which fields those are.
    ///
    /// For stages that cut themselves into rows. A row has its own value in each axis, so the study's own values are left out
    /// here; a stage that reads one, or anything that follows from one, must write it beside this.
    pub fn write_shared(&self, writer: &mut Writer) {
        writer.text("varied").count(self.stages.len());
        for (index, stage) in self.stages.iter().enumerate() {
            // Destructured in full, here and in `write`: whoever adds a field has to decide whether it is written.
            let Stage { name: _, kind, record: _, filled, reads } = stage;
            let mut filled = filled.clone();
            for axis in self.axes.iter().filter(|axis| axis.stage == index) {
                if let Some(entry) = axis.slot.entry_mut(&mut filled) {
                    entry.value = Value::Flag(true);
                }
            }
            writer.text(kind).count(reads.len());
            for read in reads {
                writer.count(read.map_or(0, |index| index + 1));
            }
            filled.write(writer);
        }
        writer.count(self.axes.len());
        for axis in &self.axes {
            writer.text(&axis.name).text(&axis.unit).count(axis.stage).count(axis.slot.0.len());
            for &step in &axis.slot.0 {
                writer.count(step);
            }
        }
    }

    /// Digest of everything in it that a stage can read: also the study's own values, and the names that appear in messages.
    pub fn write(&self, writer: &mut Writer) {
        let Self { nearby, stages, axes, held } = self;
        self.write_shared(writer);
        writer.count(nearby.len());
        for (kind, record) in nearby {
            writer.text(kind);
            record.write(writer);
        }
        for Stage { name, kind: _, record, filled: _, reads: _ } in stages {
            writer.text(name);
            record.write(writer);
        }
        for axis in axes {
            // Dimension, multiple and range follow from the declaration of the field, which is part of the code of its kind.
            let Axis {
                path,
                place,
                values,
                name: _,
                stage: _,
                slot: _,
                unit: _,
                dimension: _,
                multiple: _,
                values_place: _,
                range: _,
            } = axis;
            // Axes at one place of the text are one number that the study uses several times.
            let first = axes.iter().position(|other| other.place == *place);
            writer.text(path).count(first.unwrap_or_default());
            match values {
                Values::Each(values) => writer.text("each").floats(values),
                Values::Between(from, to) => writer.text("between").float(*from).float(*to),
                Values::Follows(formula) => writer.text("follows").text(formula),
                Values::Spread(spread) => {
                    spread.write(writer);
                    continue;
                }
            };
        }
        writer.count(held.len());
        for name in held {
            writer.text(name);
        }
    }
}

/// The way to a value in a record: positions of fields, items and labels.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Slot(pub Vec<usize>);

impl Slot {
    /// The way to the entry that stands at `place`; none where there is none.
    #[must_use]
    pub fn of_place(record: &Record, place: Place) -> Option<Self> {
        let mut steps = Vec::new();
        in_record(record, place, &mut steps).then_some(Self(steps))
    }

    /// How a study writes the way to it: names of fields, members and labels with a `.` before each, `[0]` for the first item of
    /// a list.
    #[must_use]
    pub fn path(&self, record: &Record) -> String {
        let mut path = String::new();
        let Some((first, rest)) = self.0.split_first() else { return path };
        let Some((name, mut entry)) = record.fields.get(*first).map(|(name, entry)| (*name, entry)) else {
            return path;
        };
        path += &format!(".{name}");
        for step in rest {
            let next = match &entry.value {
                Value::List(items) => items.get(*step).map(|item| (format!("[{step}]"), item)),
                Value::Map(entries) => entries.get(*step).map(|(label, item)| (format!(".{label}"), item)),
                Value::Member(member, inner) => {
                    inner.fields.get(*step).map(|(name, item)| (format!(".{member}.{name}"), item))
                }
                other => other
                    .record()
                    .and_then(|inner| inner.fields.get(*step))
                    .map(|(name, item)| (format!(".{name}"), item)),
            };
            let Some((step, inner)) = next else { break };
            path += &step;
            entry = inner;
        }
        path
    }

    /// What is there.
    #[must_use]
    pub fn entry<'r>(&self, record: &'r Record) -> Option<&'r PlacedValue> {
        let (first, rest) = self.0.split_first()?;
        let mut entry = record.fields.get(*first).map(|(_, entry)| entry)?;
        for step in rest {
            entry = match &entry.value {
                Value::List(items) => items.get(*step)?,
                Value::Map(entries) => &entries.get(*step)?.1,
                other => &other.record()?.fields.get(*step)?.1,
            };
        }
        Some(entry)
    }

    /// What another record of the same stage has where this one has the slot. A field that one of them leaves out moves those
    /// after it, so fields are found by their names.
    #[must_use]
    pub fn same_in<'r>(&self, own: &Record, other: &'r Record) -> Option<&'r PlacedValue> {
        let (first, rest) = self.0.split_first()?;
        let (name, entry) = own.fields.get(*first)?;
        let (mut here, mut there) = (entry, other.entry(name)?);
        for step in rest {
            (here, there) = match (&here.value, &there.value) {
                (Value::List(items), Value::List(others)) => (items.get(*step)?, others.get(*step)?),
                (Value::Map(entries), Value::Map(others)) => {
                    let (label, entry) = entries.get(*step)?;
                    (entry, &others.iter().find(|(known, _)| known == label)?.1)
                }
                (one, two) => {
                    let (name, entry) = one.record()?.fields.get(*step)?;
                    (entry, two.record()?.entry(name)?)
                }
            };
        }
        Some(there)
    }

    /// The same to be changed.
    pub fn entry_mut<'r>(&self, record: &'r mut Record) -> Option<&'r mut PlacedValue> {
        let (first, rest) = self.0.split_first()?;
        let mut entry = record.fields.get_mut(*first).map(|(_, entry)| entry)?;
        for step in rest {
            entry = match &mut entry.value {
                Value::List(items) => items.get_mut(*step)?,
                Value::Map(entries) => &mut entries.get_mut(*step)?.1,
                Value::Group(record) | Value::Member(_, record) => &mut record.fields.get_mut(*step)?.1,
                _ => return None,
            };
        }
        Some(entry)
    }
}

fn in_record(record: &Record, place: Place, steps: &mut Vec<usize>) -> bool {
    among(&mut record.fields.iter().map(|(_, entry)| entry), place, steps)
}

fn among(entries: &mut dyn Iterator<Item = &PlacedValue>, place: Place, steps: &mut Vec<usize>) -> bool {
    for (index, entry) in entries.enumerate() {
        steps.push(index);
        let found = match &entry.value {
            Value::List(items) => among(&mut items.iter(), place, steps),
            Value::Map(entries) => among(&mut entries.iter().map(|(_, entry)| entry), place, steps),
            Value::Group(record) | Value::Member(_, record) => in_record(record, place, steps),
            _ => entry.place == place,
        };
        if found {
            return true;
        }
        steps.pop();
    }
    false
}

#[cfg(test)]
mod tests;
