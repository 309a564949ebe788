//! Structs that are their own declaration: what the derives implement, and what they call.
//!
//! A record comes from a study, a struct from anybody; either can be made of the other, and both have the same digest. Must
//! not know: YAML, and what any parameter means.

use crate::error::{Diagnostic, Place};
use crate::parameter::{Choice, FILE, Field, Member, Presence, Shape};
use crate::record::varied::Varied;
use crate::record::{PlacedValue, Record, Value, Variant};
use crate::units::parse_quantity;

/// A struct whose fields are parameters.
pub trait Declared: Sized {
    /// Its name among the members of its family (empty for what is none), what it is, and its fields.
    const MEMBER: Member;

    /// Refuses fields that do not go together; values may still be ranges.
    ///
    /// # Errors
    /// The first such field, with its place.
    fn consistent(record: &Record) -> Result<(), Diagnostic>;

    /// Itself, as a consistent record without ranges that was decoded by [`Declared::MEMBER`] says.
    fn read(record: &Record) -> Self;

    /// Itself, as a record without ranges of its own says.
    ///
    /// # Errors
    /// When fields do not go together.
    fn checked(record: &Record) -> Result<Self, Diagnostic> {
        Self::consistent(record)?;
        Ok(Self::read(record))
    }

    /// The record that says the same.
    fn record(&self) -> Record;

    /// Refuses a number that is not within its declared range: a struct that was written by hand may hold anything.
    ///
    /// # Errors
    /// The first such number, with what it may be; lengths and the like in SI.
    fn in_range(&self) -> Result<(), Diagnostic> {
        check(&self.record(), Self::MEMBER.fields)
    }
}

/// An enum whose variants are words.
pub trait Words: Copy + Sized {
    const CHOICES: &'static [Choice];

    /// The variant that is this word.
    fn of(word: &str) -> Option<Self>;

    /// As a study writes it.
    fn word(self) -> &'static str;
}

/// What has fields that stand beside those of the struct that has it: an enum whose variants have some of their own, or
/// another struct.
pub trait Joint: Sized {
    const FIELDS: &'static [Field];

    /// Refuses fields that do not go together; values may still be ranges.
    ///
    /// # Errors
    /// The first such field, with its place.
    fn consistent(record: &Record) -> Result<(), Diagnostic>;

    /// Itself, as a consistent record says.
    fn read(record: &Record) -> Self;

    /// Adds the fields that say the same.
    fn write(&self, fields: &mut Vec<(&'static str, PlacedValue)>);
}

/// The field [`FILE`] of a struct whose lists may stand in a CSV file: nothing is left of it in a record.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FromFile;

impl Joint for FromFile {
    const FIELDS: &'static [Field] = &[FILE];

    fn consistent(_record: &Record) -> Result<(), Diagnostic> {
        Ok(())
    }

    fn read(_record: &Record) -> Self {
        Self
    }

    fn write(&self, _fields: &mut Vec<(&'static str, PlacedValue)>) {}
}

/// What a field may be beside numbers, flags and texts.
pub trait Parameter: Sized {
    const SHAPE: Shape;

    /// Refuses fields inside that do not go together; values may still be ranges.
    ///
    /// # Errors
    /// The first such field, with its place.
    fn consistent(_value: &Value) -> Result<(), Diagnostic> {
        Ok(())
    }

    /// From a value of this shape.
    fn of_value(value: &Value) -> Self;

    fn to_value(&self) -> Value;
}

/// A declared struct of which nobody knows more than its family: what the trait of a family asks of its members.
pub trait Registrable {
    /// Its name among the members of its family.
    fn name(&self) -> &'static str;

    /// As [`Shape::Member`] has it.
    fn member(&self) -> Value;
}

impl<T: Declared> Registrable for T {
    fn name(&self) -> &'static str {
        T::MEMBER.name
    }

    fn member(&self) -> Value {
        Value::Member(T::MEMBER.name, self.record())
    }
}

/// A value and where it stands, for messages about one of several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placed<T> {
    pub value: T,
    pub place: Place,
}

/// The record of a study that gives these values and leaves the other fields to their defaults, those of groups in them
/// too.
///
/// # Panics
/// When a field must be given and is not, or has another name: the declaration and its caller are one program.
#[must_use]
pub fn record_of(fields: &[Field], given: &[(&str, Value)]) -> Record {
    for (name, _) in given {
        assert!(fields.iter().any(|field| field.name == *name), "`{name}` is not declared");
    }
    let value_of = |field: &Field| {
        let value = given.iter().find(|(name, _)| *name == field.name);
        let value = value.map(|(_, value)| completed(&field.shape, value.clone()));
        value.or_else(|| match field.presence {
            Presence::Optional => None,
            Presence::Required => panic!("`{}` must be given", field.name),
            Presence::Default(text) => Some(default(&field.shape, text)),
        })
    };
    let fields = fields.iter().filter_map(|field| Some((field.name, entry(value_of(field)?)))).collect();
    Record { fields, place: Place::default() }
}

fn completed(shape: &Shape, value: Value) -> Value {
    match (value, shape) {
        (Value::Group(record), Shape::Group(fields)) => {
            let given: Vec<_> = record.fields.iter().map(|(name, entry)| (*name, entry.value.clone())).collect();
            let mut all = record_of(fields, &given);
            all.place = record.place;
            for (name, entry) in &mut all.fields {
                entry.place = record.entry(name).map_or(record.place, |entry| entry.place);
            }
            Value::Group(all)
        }
        (Value::List(items), Shape::List(item)) => Value::List(
            items.into_iter().map(|entry| PlacedValue { value: completed(item, entry.value), ..entry }).collect(),
        ),
        (value, _) => value,
    }
}

// Here and not beside the getters, since it knows declarations.
impl Record {
    /// The same record with the least value of each range.
    #[must_use]
    pub fn without_ranges(&self, fields: &[Field]) -> Self {
        let mut fixed = self.clone();
        for (name, entry) in &mut fixed.fields {
            let Value::Range(minimum, _) = entry.value else { continue };
            let shape = fields.iter().find(|field| field.name == *name).map(|field| field.shape);
            let plain = matches!(shape, Some(Shape::Number { .. }));
            entry.value = if plain { Value::Number(minimum) } else { Value::Quantity(minimum) };
        }
        fixed
    }
}

/// A default as a study would write it.
///
/// # Panics
/// When it cannot be read: a mistake of a declaration, which its tests find.
#[must_use]
pub fn default(shape: &Shape, text: &str) -> Value {
    let read = match shape {
        Shape::Number { .. } => text.parse().ok().map(Value::Number),
        Shape::Integer { .. } => text.parse().ok().map(Value::Integer),
        Shape::Flag => text.parse().ok().map(Value::Flag),
        Shape::Text => Some(Value::Text(text.to_owned())),
        Shape::Quantity { .. } => parse_quantity(text).ok().map(|quantity| Value::Quantity(quantity.value)),
        Shape::Choice(choices) => {
            choices.iter().find(|choice| choice.name == text).map(|choice| Value::Choice(choice.name))
        }
        Shape::List(_) if text == "[]" => Some(Value::List(Vec::new())),
        Shape::List(item) => Some(Value::List(vec![entry(default(item, text))])),
        Shape::Group(fields) if text == "{}" => Some(Value::Group(record_of(fields, &[]))),
        Shape::Member(members) => {
            let member = members().iter().find(|member| member.name == text);
            member.map(|member| Value::Member(member.name, record_of(member.fields, &[])))
        }
        _ => None,
    };
    read.unwrap_or_else(|| panic!("the default `{text}` cannot be read"))
}

fn check(record: &Record, fields: &[Field]) -> Result<(), Diagnostic> {
    for field in fields {
        let Some(entry) = record.entry(field.name) else { continue };
        check_value(&entry.value, &field.shape, field.name)?;
    }
    Ok(())
}

fn check_value(value: &Value, shape: &Shape, name: &str) -> Result<(), Diagnostic> {
    let outside = |value: String, minimum: String, maximum: String| {
        Err(Diagnostic::new(format!("`{name}` is {value}")).help(format!("it may be {minimum} to {maximum}")))
    };
    match (value, shape) {
        (Value::Quantity(value), Shape::Quantity { minimum, maximum, .. })
        | (Value::Number(value), Shape::Number { minimum, maximum })
            if !(*minimum..=*maximum).contains(value) =>
        {
            outside(value.to_string(), minimum.to_string(), maximum.to_string())
        }
        (Value::Integer(value), Shape::Integer { minimum, maximum, .. }) if !(*minimum..=*maximum).contains(value) => {
            outside(value.to_string(), minimum.to_string(), maximum.to_string())
        }
        (Value::Integer(value), Shape::Integer { multiple, .. }) if value % multiple != 0 => {
            Err(Diagnostic::new(format!("`{name}` is {value}")).help(format!("it may be multiples of {multiple}")))
        }
        (Value::Axis(values), Shape::Quantity { .. }) => {
            values.iter().try_for_each(|value| check_value(&Value::Quantity(*value), shape, name))
        }
        (Value::Axis(values), Shape::Number { .. }) => {
            values.iter().try_for_each(|value| check_value(&Value::Number(*value), shape, name))
        }
        (Value::Group(record), Shape::Group(fields)) => check(record, fields),
        (Value::Member(name, record), Shape::Member(members)) => {
            members().iter().find(|member| member.name == *name).map_or(Ok(()), |member| check(record, member.fields))
        }
        (Value::Map(entries), Shape::Map(item)) => {
            entries.iter().try_for_each(|(name, entry)| check_value(&entry.value, item, name))
        }
        (Value::List(items), Shape::List(item)) => {
            items.iter().try_for_each(|entry| check_value(&entry.value, item, name))
        }
        _ => Ok(()),
    }
}

/// Refuses all but exactly one of several fields.
///
/// # Errors
/// When there is none, or a second one.
pub fn exactly_one(record: &Record, names: &[&str]) -> Result<(), Diagnostic> {
    let mut given = names.iter().filter(|name| record.entry(name).is_some());
    let (first, second) = (given.next(), given.next());
    let list = || names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    match (first, second) {
        (Some(_), None) => Ok(()),
        (None, _) => {
            Err(Diagnostic::new(format!("exactly one of {} is needed, and there is none", list())).at(record.place))
        }
        (Some(one), Some(other)) => {
            let message = format!("exactly one of {} is needed, not both `{one}` and `{other}`", list());
            Err(Diagnostic::new(message).at(record.place_of(other)))
        }
    }
}

/// Refuses a field that goes with one word of another field only, and that word without it.
///
/// # Errors
/// Which of both.
pub fn goes_with(record: &Record, field: &str, [tag, word]: [&str; 2]) -> Result<(), Diagnostic> {
    let place = record.place_of(field);
    match (record.choice(tag) == word, record.entry(field).is_some()) {
        (true, false) => Err(Diagnostic::new(format!("the {tag} `{word}` needs its `{field}`")).at(place)),
        (false, true) => Err(Diagnostic::new(format!("`{field}` goes with `{tag}: {word}` only")).at(place)),
        _ => Ok(()),
    }
}

// What follows is called by derived code. A record was decoded by the declaration that was derived with the code, so none
// of the panics can be reached by a study.

/// # Panics
/// Always.
#[cold]
pub fn of_another_declaration() -> ! {
    panic!("a record of another declaration")
}

fn mistyped(value: &Value) -> ! {
    panic!("a record of another declaration: {value:?}")
}

/// The value of a field that is always there.
///
/// # Panics
/// When the record is of another declaration.
#[must_use]
pub fn given<'a>(record: &'a Record, name: &str) -> &'a PlacedValue {
    record.entry(name).unwrap_or_else(|| panic!("a record of another declaration has no `{name}`"))
}

/// A value that stands nowhere.
#[must_use]
pub fn entry(value: Value) -> PlacedValue {
    PlacedValue { value, place: Place::default() }
}

#[must_use]
pub fn quantity(value: &Value) -> f64 {
    if let Value::Quantity(value) = value { *value } else { mistyped(value) }
}

#[must_use]
pub fn number(value: &Value) -> f64 {
    if let Value::Number(value) = value { *value } else { mistyped(value) }
}

#[must_use]
pub fn integer<T: TryFrom<i64>>(value: &Value) -> T {
    if let Value::Integer(integer) = value
        && let Ok(integer) = T::try_from(*integer)
    {
        return integer;
    }
    mistyped(value)
}

/// What does not fit is far beyond any declared range, and found outside of it.
#[must_use]
pub fn of_integer<T: TryInto<i64>>(value: T) -> Value {
    Value::Integer(value.try_into().unwrap_or(i64::MAX))
}

#[must_use]
pub fn flag(value: &Value) -> bool {
    if let Value::Flag(value) = value { *value } else { mistyped(value) }
}

#[must_use]
pub fn text(value: &Value) -> String {
    if let Value::Text(value) = value { value.clone() } else { mistyped(value) }
}

#[must_use]
pub fn word<T: Words>(value: &Value) -> T {
    if let Value::Choice(word) = value
        && let Some(word) = T::of(word)
    {
        return word;
    }
    mistyped(value)
}

#[must_use]
pub fn group(value: &Value) -> &Record {
    if let Value::Group(record) = value { record } else { mistyped(value) }
}

#[must_use]
pub fn reference(value: &Value) -> String {
    if let Value::Reference(stage) = value { stage.clone() } else { mistyped(value) }
}

#[must_use]
pub fn axis(value: &Value) -> Vec<f64> {
    if let Value::Axis(values) = value { values.clone() } else { mistyped(value) }
}

#[must_use]
pub fn member(value: &Value) -> (&'static str, &Record) {
    if let Value::Member(name, record) = value { (name, record) } else { mistyped(value) }
}

#[must_use]
pub fn variant(value: &Value) -> Variant {
    if let Value::Variant(variant) = value { variant.clone() } else { mistyped(value) }
}

#[must_use]
pub fn varied(value: &Value) -> Varied {
    if let Value::Varied(varied) = value { varied.clone() } else { mistyped(value) }
}

#[must_use]
pub fn items(value: &Value) -> &[PlacedValue] {
    if let Value::List(items) = value { items } else { mistyped(value) }
}

#[must_use]
pub fn named(value: &Value) -> &[(String, PlacedValue)] {
    if let Value::Map(entries) = value { entries } else { mistyped(value) }
}
