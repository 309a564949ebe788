//! Values of declared parameters, after defaults, in SI, each with its place in the study.
//!
//! A [`Record`] holds the fields in the order of their declaration, so its digest depends neither on the order nor on
//! the spelling in the YAML. The typed getters panic on a name or type that was not declared, which is a mistake of
//! this program; structs that declare themselves need none of them. Must not know: YAML.

pub mod varied;

use std::collections::BTreeSet;

use super::digest::Writer;
use super::error::{Diagnostic, Place};
use super::units::Dimension;
use varied::Varied;

/// One value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// SI.
    Quantity(f64),
    /// SI, with the dimension that was read and the unit as written.
    AnyQuantity {
        value: f64,
        dimension: Dimension,
        unit: String,
    },
    /// The values of an axis, SI, ascending, without repeats; never empty.
    Axis(Vec<f64>),
    /// Bounds between which an optimiser chooses, SI, least < most.
    Range(f64, f64),
    Number(f64),
    Integer(i64),
    Flag(bool),
    Text(String),
    Choice(&'static str),
    Reference(String),
    List(Vec<PlacedValue>),
    Map(Vec<(String, PlacedValue)>),
    Group(Record),
    Member(&'static str, Record),
    /// Another stage with some of its fields replaced.
    Variant(Variant),
    /// Other stages of which some fields are given many values.
    Varied(Varied),
}

/// A stage's fields, some of them replaced.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// The stage's kind.
    pub kind: &'static str,
    /// What was replaced, as written, on one line.
    pub written: String,
    /// All fields.
    pub record: Record,
}

/// A value and where it stands (a default stands where its parent does).
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedValue {
    pub value: Value,
    pub place: Place,
}

/// The values of a table of fields, in declaration order; an optional field that is not given is absent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    pub fields: Vec<(&'static str, PlacedValue)>,
    /// Where the record itself stands.
    pub place: Place,
}

macro_rules! getter {
    ($(#[$doc:meta])* $name:ident, $maybe:ident, $pattern:pat => $result:expr, $type:ty) => {
        $(#[$doc])*
        #[must_use]
        pub fn $maybe(&self, name: &str) -> Option<$type> {
            self.entry(name).map(|entry| match &entry.value {
                $pattern => $result,
                other => panic!("field `{name}` is not of the type asked for: {other:?}"),
            })
        }

        $(#[$doc])*
        /// # Panics
        /// When the declaration has no such field.
        #[must_use]
        pub fn $name(&self, name: &str) -> $type {
            self.$maybe(name).unwrap_or_else(|| panic!("field `{name}` was not declared, or is optional"))
        }
    };
}

impl Record {
    /// The entry of a field, if it was given or has a default.
    #[must_use]
    pub fn entry(&self, name: &str) -> Option<&PlacedValue> {
        self.fields.iter().find(|(field, _)| *field == name).map(|(_, entry)| entry)
    }

    /// Where a field stands, or the record when it was not given.
    #[must_use]
    pub fn place_of(&self, name: &str) -> Place {
        self.entry(name).map_or(self.place, |entry| entry.place)
    }

    /// The record that a field holds, for places in it, or this one when the field was not given.
    #[must_use]
    pub fn inside(&self, name: &str) -> &Self {
        self.entry(name).and_then(|entry| entry.value.record()).unwrap_or(self)
    }

    /// The records of the list that a field holds, for places in them.
    pub fn each_inside(&self, name: &str) -> impl Iterator<Item = &Self> {
        let items = self.entry(name).map(|entry| match &entry.value {
            Value::List(items) => items.as_slice(),
            _ => &[],
        });
        items.unwrap_or_default().iter().filter_map(|item| item.value.record())
    }

    /// What was found wrong with what was read from here, with the place of the field, or the item of its list, that is meant.
    #[must_use]
    pub fn locate(&self, wrong: Diagnostic) -> Diagnostic {
        let place = wrong.field.map_or(self.place, |field| self.place_of(field));
        let item = wrong.field.zip(wrong.item).and_then(|(field, item)| match &self.entry(field)?.value {
            Value::List(items) => items.get(item as usize).map(|item| item.place),
            _ => None,
        });
        wrong.or_at(item.unwrap_or(place))
    }

    getter!(
        /// A quantity in SI.
        quantity, maybe_quantity, Value::Quantity(value) => *value, f64);
    getter!(number, maybe_number, Value::Number(value) => *value, f64);
    getter!(integer, maybe_integer, Value::Integer(value) => *value, i64);
    getter!(flag, maybe_flag, Value::Flag(value) => *value, bool);
    getter!(text, maybe_text, Value::Text(value) => value.as_str(), &str);
    getter!(choice, maybe_choice, Value::Choice(value) => *value, &'static str);
    getter!(reference, maybe_reference, Value::Reference(value) => value.as_str(), &str);
    getter!(list, maybe_list, Value::List(value) => value.as_slice(), &[PlacedValue]);
    getter!(map, maybe_map, Value::Map(value) => value.as_slice(), &[(String, PlacedValue)]);
    getter!(group, maybe_group, Value::Group(value) => value, &Record);
    getter!(member, maybe_member, Value::Member(name, record) => (*name, record), (&'static str, &Record));
    getter!(
        /// The values of an axis field.
        axis, maybe_axis, Value::Axis(values) => values.as_slice(), &[f64]);

    /// The same record with one axis cut down to `values`: one chunk of a stage.
    #[must_use]
    pub fn with_axis(&self, name: &str, values: &[f64]) -> Self {
        let mut part = self.clone();
        for (field, entry) in &mut part.fields {
            if *field == name {
                entry.value = Value::Axis(values.to_vec());
            }
        }
        part
    }

    /// The kinds of the variants of other stages inside, by name, each once.
    #[must_use]
    pub fn kinds(&self) -> BTreeSet<&'static str> {
        fn gather(value: &Value, into: &mut BTreeSet<&'static str>) {
            match value {
                Value::List(entries) => entries.iter().for_each(|entry| gather(&entry.value, into)),
                Value::Map(entries) => entries.iter().for_each(|(_, entry)| gather(&entry.value, into)),
                Value::Variant(variant) => drop(into.insert(variant.kind)),
                Value::Varied(varied) => into.extend(varied.stages.iter().map(|stage| stage.kind)),
                other => other.record().into_iter().for_each(|record| into.extend(record.kinds())),
            }
        }
        let mut kinds = BTreeSet::new();
        self.fields.iter().for_each(|(_, entry)| gather(&entry.value, &mut kinds));
        kinds
    }

    /// Writes names and values, not places.
    pub fn write(&self, writer: &mut Writer) {
        Self::write_fields(&self.fields, writer);
    }

    /// The same for some fields, as if they were all.
    pub fn write_fields(fields: &[(&'static str, PlacedValue)], writer: &mut Writer) {
        writer.count(fields.len());
        for (name, entry) in fields {
            writer.text(name);
            entry.value.write(writer);
        }
    }
}

impl Value {
    fn write(&self, writer: &mut Writer) {
        match self {
            Self::Quantity(value) => writer.text("quantity").float(*value),
            Self::AnyQuantity { value, dimension, unit } => {
                let Dimension { length, mass, time, angle } = *dimension;
                for exponent in [length, mass, time, angle] {
                    writer.integer(exponent.into());
                }
                writer.text(unit).float(*value)
            }
            Self::Axis(values) => writer.text("axis").floats(values),
            Self::Range(minimum, maximum) => writer.text("range").float(*minimum).float(*maximum),
            Self::Number(value) => writer.text("number").float(*value),
            Self::Integer(value) => writer.integer(*value),
            Self::Flag(value) => writer.flag(*value),
            Self::Text(text) => writer.text("text").text(text),
            Self::Choice(name) => writer.text("choice").text(name),
            // Never a label: the node that is meant enters a key through the content of its tables. Which of several
            // references comes first is kept by the port's name.
            Self::Reference(_) => writer.text("reference"),
            Self::List(entries) => {
                writer.text("list").count(entries.len());
                for entry in entries {
                    entry.value.write(writer);
                }
                writer
            }
            Self::Map(entries) => {
                writer.text("map").count(entries.len());
                for (name, entry) in entries {
                    writer.text(name);
                    entry.value.write(writer);
                }
                writer
            }
            Self::Group(record) => {
                writer.text("group");
                record.write(writer);
                writer
            }
            Self::Member(name, record) => {
                writer.text("member").text(name);
                record.write(writer);
                writer
            }
            Self::Variant(variant) => {
                writer.text("variant").text(variant.kind).text(&variant.written);
                variant.record.write(writer);
                writer
            }
            Self::Varied(varied) => {
                varied.write(writer);
                writer
            }
        };
    }

    /// The record inside, for a group, a member or a variant.
    #[must_use]
    pub fn record(&self) -> Option<&Record> {
        match self {
            Self::Group(record) | Self::Member(_, record) | Self::Variant(Variant { record, .. }) => Some(record),
            _ => None,
        }
    }
}
