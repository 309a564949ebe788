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
mod tests {
    use super::*;
    use crate::units::LENGTH;

    fn at(line: usize) -> Place {
        Place { line, ..Place::default() }
    }

    fn entry(value: Value, line: usize) -> PlacedValue {
        PlacedValue { value, place: at(line) }
    }

    fn record() -> Record {
        let relief = Record { fields: vec![("amount", entry(Value::Quantity(1e-6), 7))], place: at(6) };
        let design = Value::List(vec![entry(Value::Flag(true), 5), entry(Value::Member("relief", relief), 6)]);
        let designs = Value::Map(vec![("a".into(), entry(Value::List(vec![]), 3)), ("b".into(), entry(design, 4))]);
        Record {
            fields: vec![("pair", entry(Value::Reference("p".into()), 1)), ("designs", entry(designs, 2))],
            place: at(0),
        }
    }

    fn axis() -> Axis {
        Axis {
            name: "amount".into(),
            path: "s.designs.b[1].relief.amount".into(),
            place: at(9),
            stage: 0,
            slot: Slot(vec![1, 1, 1, 0]),
            dimension: Some(LENGTH),
            unit: "um".into(),
            multiple: None,
            values: Values::Each(vec![1e-6, 2e-6]),
            values_place: at(9),
            range: (0.0, 1e-3),
        }
    }

    #[test]
    fn a_slot_leads_to_the_value_at_a_place_and_nowhere_else() {
        let mut record = record();
        let slot = Slot::of_place(&record, at(7)).unwrap();
        assert_eq!(slot, axis().slot);
        assert_eq!(slot.entry(&record).map(|entry| &entry.value), Some(&Value::Quantity(1e-6)));
        assert_eq!(slot.path(&record), ".designs.b[1].relief.amount");
        axis().put(&mut record, 5e-6);
        assert_eq!(slot.entry(&record).map(|entry| &entry.value), Some(&Value::Quantity(5e-6)));
        assert_eq!(Slot::of_place(&record, at(8)), None);
        assert_eq!(Slot::of_place(&record, at(6)), None, "a member is no value");
        assert_eq!(Slot(vec![1, 2, 0]).entry(&record), None);
        assert!(Slot(vec![0, 1]).entry_mut(&mut record).is_none() && Slot::default().entry(&record).is_none());
    }

    #[test]
    fn the_study_s_own_value_is_found_whatever_it_leaves_out() {
        // The study says neither `length`, which is varied too, nor `pair`; of what is varied the last comes after both.
        let mut filled = record();
        let Some(entry) = Slot(vec![1, 1, 1]).entry_mut(&mut filled) else { panic!("there is a relief") };
        if let Value::Member(_, relief) = &mut entry.value {
            relief.fields.insert(0, ("length", self::entry(Value::Quantity(3e-3), 8)));
        }
        let mut own = record();
        own.fields.remove(0);
        let slots = [Slot(vec![1, 1, 1, 0]), Slot(vec![1, 1, 1, 1])];
        let stage = Stage { name: "s".into(), kind: "k", record: own, filled, reads: vec![] };
        let varied = Varied { stages: vec![stage], ..Varied::default() };
        let found = slots.map(|slot| varied.own(&Axis { slot, ..axis() }));
        assert_eq!(found, [None, Some(1e-6)]);
    }

    #[test]
    fn values_are_in_the_digest_of_all_and_not_in_that_of_what_is_shared() {
        let varied = |first: f64, values: Vec<f64>| {
            let mut filled = record();
            axis().put(&mut filled, first);
            let stage = Stage { name: "s".into(), kind: "k", record: record(), filled, reads: vec![None] };
            Varied {
                stages: vec![stage],
                axes: vec![Axis { values: Values::Each(values), ..axis() }],
                ..Varied::default()
            }
        };
        let digests = |varied: &Varied| {
            let (mut shared, mut all) = (Writer::new("test"), Writer::new("test"));
            varied.write_shared(&mut shared);
            varied.write(&mut all);
            (shared.finish(), all.finish())
        };
        let (one, two) = (varied(1e-6, vec![1e-6, 2e-6]), varied(3e-6, vec![3e-6]));
        assert_eq!(digests(&one).0, digests(&two).0);
        assert_ne!(digests(&one).1, digests(&two).1);
        let mut other = one.clone();
        other.stages[0].filled.fields.pop();
        assert_ne!(digests(&one).0, digests(&other).0);
        let mut renamed = one.clone();
        renamed.stages[0].name = "t".into();
        assert_eq!(digests(&one).0, digests(&renamed).0, "rows do not show the names of stages");
    }

    /// Everything that a stage can read of it, beside places and what follows from declarations.
    #[test]
    fn whatever_a_stage_can_read_is_in_the_digest_of_all() {
        let stage = |name: &str| Stage {
            name: name.into(),
            kind: "k",
            record: record(),
            filled: record(),
            reads: vec![None],
        };
        let axes = [axis(), Axis { name: "again".into(), place: at(10), ..axis() }];
        let varied = Varied { stages: vec![stage("s")], axes: axes.into(), ..Varied::default() };
        let digest = |varied: &Varied| {
            let mut writer = Writer::new("test");
            varied.write(&mut writer);
            writer.finish()
        };
        let changes: [(&str, &dyn Fn(&mut Varied)); 9] = [
            ("own value", &|varied| axis().put(&mut varied.stages[0].record, 9e-6)),
            ("name of a stage", &|varied| varied.stages[0].name = "t".into()),
            ("field of a stage", &|varied| drop(varied.stages[0].record.fields.remove(0))),
            ("what a stage reads", &|varied| varied.stages[0].reads = vec![Some(0)]),
            ("path", &|varied| varied.axes[0].path = "t.amount".into()),
            ("unit", &|varied| varied.axes[0].unit = "mm".into()),
            ("one number for two", &|varied| varied.axes[1].place = varied.axes[0].place),
            ("nearby stages", &|varied| varied.nearby = vec![("k", record())]),
            ("held stages", &|varied| varied.held = vec!["h".into()]),
        ];
        for (what, change) in changes {
            let mut other = varied.clone();
            change(&mut other);
            assert_ne!(digest(&varied), digest(&other), "{what}");
        }
    }
}
