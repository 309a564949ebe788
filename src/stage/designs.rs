//! Designs as tables: named lists of modifications, written by whoever makes them and read by whoever loads them.
//!
//! One row per parameter, so families of any shape share one table and a reader can query it. Values are in SI because
//! a column of many parameters has no unit of its own. Must not know: what any parameter means.

use super::names;
use crate::stage::{Inputs, Port};
use std::collections::BTreeMap;

use declare::declared::{self, Parameter};
use declare::error::{Diagnostic, Failure, Place};
use declare::parameter::{Field, Member, Shape};
use declare::record::{PlacedValue, Record, Value};
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::modification::template::Template;
use gearmesh::gear::modification::{self, Design};
use studygraph::table::columns::Columns;
use studygraph::table::data::{Table, TableError};
use studygraph::table::schema::{Column, Schema};

/// The modifications of a design as a study writes them, members of the families: as records, since any of their values
/// may be a range, which no struct of a family holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Elements(Vec<PlacedValue>);

impl Elements {
    /// Ranges become variables.
    ///
    /// # Errors
    /// What no declaration can express: fields of a modification that contradict each other.
    pub fn template(&self) -> Result<Template, Diagnostic> {
        Template::new(&self.0)
    }

    #[must_use]
    pub fn elements(&self) -> Vec<Element> {
        let of = |item: &PlacedValue| match &item.value {
            Value::Member(family, record) => Some(Element { family, record: record.clone() }),
            _ => None,
        };
        let mut elements: Vec<Element> = self.0.iter().filter_map(of).collect();
        // Mostly one, with room for four.
        elements.shrink_to_fit();
        elements
    }
}

impl Parameter for Elements {
    const SHAPE: Shape = Shape::List(&Shape::Member(modification::members));

    fn of_value(value: &Value) -> Self {
        Self(declared::items(value).to_vec())
    }

    fn to_value(&self) -> Value {
        Value::List(self.0.clone())
    }
}

/// One modification: the family and its parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    pub family: &'static str,
    pub record: Record,
}

/// A named list of modifications that add up; an empty one is the unmodified pair.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedDesign {
    pub name: String,
    pub elements: Vec<Element>,
}

impl NamedDesign {
    /// The design on a pair.
    ///
    /// # Errors
    /// When a modification does not fit the pair; the message names the design, and the place where a study states it.
    pub fn built(&self, pair: &GearPair) -> Result<Design, Failure> {
        let mut design = Design::default();
        for Element { family, record } in &self.elements {
            let known = modification::family(family)
                .ok_or_else(|| Failure::new(format!("design `{}`: unknown family `{family}`", self.name)))?;
            design.add_record(known, record, pair).map_err(|wrong| {
                let message = format!("design `{}`, {family}: {}", self.name, wrong.message);
                Failure::of(Diagnostic { message, ..wrong })
            })?;
        }
        Ok(design)
    }
}

/// A design and its place in the study, from 1.
type DesignRow<'a> = (usize, &'a NamedDesign);

fn listed<'a>() -> Columns<DesignRow<'a>> {
    Columns::new(names::designs::TABLE, "The designs, in the order of the study.")
        .text(names::designs::DESIGN, "Name of the design.", |row: &DesignRow<'a>| row.1.name.as_str())
        .key()
        .integer(names::designs::ORDER, "Place in the study, from 1.", |row| row.0)
        .integer(names::designs::ELEMENTS, "How many modifications it adds up.", |row| row.1.elements.len())
}

/// A parameter of a modification.
struct ParameterRow<'a> {
    design: &'a str,
    /// Place in the design, from 1.
    element: usize,
    family: &'static str,
    parameter: Flat,
    unit: &'static str,
}

fn parameters<'a>() -> Columns<ParameterRow<'a>> {
    Columns::new(names::elements::TABLE, "The modifications of each design, one row per parameter.")
        .text(names::elements::DESIGN, "Name of the design.", |row: &ParameterRow<'a>| row.design)
        .key()
        .integer(names::elements::ELEMENT, "Place in the design, from 1.", |row| row.element)
        .key()
        .text(names::elements::FAMILY, "Family of the modification.", |row| row.family)
        .text(names::elements::PARAMETER, "Name of the parameter.", |row| row.parameter.0.clone())
        .key()
        .float(names::elements::VALUE, "", "Value in SI; NaN where the parameter is a word.", |row| row.parameter.1)
        .but(Column::allows_nan)
        .text(names::elements::UNIT, "Unit of the value; empty for plain numbers and words.", |row| row.unit)
        .text(names::elements::WORD, "The word, where the parameter is one.", |row| row.parameter.2.clone())
}

/// Those of the tables that [`write()`] makes.
#[must_use]
pub fn schemas() -> [Schema; 2] {
    [listed().schema(), parameters().schema()]
}

/// The two tables of a list of designs; `families` says what the parameters are.
///
/// # Errors
/// When two designs have one name, or a parameter has a value that no row holds.
pub fn write(designs: &[NamedDesign], families: &[Member]) -> Result<[Table; 2], TableError> {
    let mut rows = Vec::new();
    for NamedDesign { name: design, elements } in designs {
        for (element, Element { family, record }) in (1..).zip(elements) {
            let mut flat = Vec::new();
            flatten("", record, &mut flat).map_err(|problem| TableError::Column {
                table: names::elements::TABLE.to_owned(),
                column: "value".to_owned(),
                problem: format!("design `{design}`, {family}: {problem}"),
            })?;
            let fields = families.iter().find(|member| member.name == *family).map_or(&[][..], |member| member.fields);
            rows.extend(flat.into_iter().map(|parameter| {
                let unit = unit_of(fields, &parameter.0);
                ParameterRow { design, element, family, parameter, unit }
            }));
        }
    }
    let designs: Vec<DesignRow> = (1..).zip(designs).collect();
    Ok([listed().table(&designs)?, parameters().table(&rows)?])
}

/// The unit of SI that a parameter has, by its name as in the table.
fn unit_of(fields: &[Field], parameter: &str) -> &'static str {
    let (name, below) = parameter.split_once('.').unwrap_or((parameter, ""));
    let (name, is_item) = name.split_once('[').map_or((name, false), |(name, _)| (name, true));
    let shape = fields.iter().find(|field| field.name == name).map(|field| &field.shape);
    match shape {
        Some(Shape::Quantity { dimension, .. }) => dimension.si(),
        Some(Shape::List(Shape::Quantity { dimension, .. })) if is_item => dimension.si(),
        Some(Shape::Group(inner) | Shape::List(Shape::Group(inner))) => unit_of(inner, below),
        _ => "",
    }
}

/// How many rows of the table of elements a modification takes, ranges among its parameters included.
#[must_use]
pub fn rows_of(element: &Element) -> usize {
    fn rows(value: &Value) -> usize {
        match value {
            Value::Group(record) => of(record),
            Value::List(items) => 1 + items.iter().map(|item| rows(&item.value)).sum::<usize>(),
            _ => 1,
        }
    }
    fn of(record: &Record) -> usize {
        record.fields.iter().map(|(_, entry)| rows(&entry.value)).sum()
    }
    of(&element.record)
}

/// A row of a parameter: its name, its number, its word.
type Flat = (String, f64, String);

fn flatten(prefix: &str, record: &Record, flat: &mut Vec<Flat>) -> Result<(), String> {
    record.fields.iter().try_for_each(|(name, entry)| flatten_value(format!("{prefix}{name}"), &entry.value, flat))
}

fn flatten_value(name: String, value: &Value, flat: &mut Vec<Flat>) -> Result<(), String> {
    match value {
        Value::Quantity(value) | Value::Number(value) => flat.push((name, *value, String::new())),
        Value::Integer(value) => flat.push((name, *value as f64, String::new())),
        Value::Flag(value) => flat.push((name, f64::from(u8::from(*value)), String::new())),
        Value::Choice(word) => flat.push((name, f64::NAN, (*word).to_owned())),
        Value::Text(word) => flat.push((name, f64::NAN, word.clone())),
        Value::Group(record) => flatten(&format!("{name}."), record, flat)?,
        // The length has a row of its own, so that an empty list comes back as one.
        Value::List(items) => {
            flat.push((name.clone(), items.len() as f64, String::new()));
            for (item, place) in items.iter().zip(1..) {
                flatten_value(format!("{name}[{place}]"), &item.value, flat)?;
            }
        }
        // Ranges are replaced before a design is written. What no row holds must not vanish without a word.
        Value::Range(..)
        | Value::AnyQuantity { .. }
        | Value::Axis(_)
        | Value::Reference(_)
        | Value::Map(_)
        | Value::Member(..)
        | Value::Variant(_)
        | Value::Varied(_) => return Err(format!("no row of a table holds the value of `{name}`: {value:?}")),
    }
    Ok(())
}

/// The rows of a table of elements by design and place in the design.
type Index<'a> = BTreeMap<(&'a str, i64), Vec<usize>>;

/// The port of this name through which [`of`] reads.
#[must_use]
pub fn port(name: String, stage: &str) -> Port {
    Port::tables(name, stage, &[names::designs::TABLE, names::elements::TABLE])
}

/// The designs that came in through a port.
///
/// # Errors
/// When their tables did not, or when a family or a word is not known any more.
pub fn of(inputs: &Inputs, port: &str, families: &[Member]) -> Result<Vec<NamedDesign>, Failure> {
    let table = |table| inputs.table(port, table);
    read(table(names::designs::TABLE)?, table(names::elements::TABLE)?, families)
}

/// The designs that [`write()`] wrote, in their order; `families` says what the parameters are.
///
/// # Errors
/// When a family or a word is not known any more.
pub fn read(designs: &Table, elements: &Table, families: &[Member]) -> Result<Vec<NamedDesign>, Failure> {
    let mut index = Index::new();
    for (row, key) in elements
        .texts(names::elements::DESIGN)
        .iter()
        .map(String::as_str)
        .zip(elements.integers(names::elements::ELEMENT))
        .enumerate()
    {
        index.entry((key.0, *key.1)).or_default().push(row);
    }
    let (called, counts) = (designs.texts(names::designs::DESIGN), designs.integers(names::designs::ELEMENTS));
    let mut order: Vec<usize> = (0..designs.rows()).collect();
    order.sort_by_key(|&row| designs.integers(names::designs::ORDER)[row]);
    order.into_iter().map(|row| read_one(&called[row], counts[row], elements, &index, families)).collect()
}

fn read_one(name: &str, count: i64, table: &Table, index: &Index, families: &[Member]) -> Result<NamedDesign, Failure> {
    let (words, parameters) = (table.texts(names::elements::FAMILY), table.texts(names::elements::PARAMETER));
    let mut elements = Vec::new();
    for place in 1..=count {
        let rows = index
            .get(&(name, place))
            .ok_or_else(|| Failure::new(format!("design `{name}`: modification {place} has no rows")))?;
        let word = &words[rows[0]];
        let family = families.iter().find(|family| family.name == word);
        let family = family.ok_or_else(|| Failure::new(format!("design `{name}`: unknown family `{word}`")))?;
        // A trace has thousands.
        let by_name: BTreeMap<&str, usize> = rows.iter().rev().map(|&row| (parameters[row].as_str(), row)).collect();
        let lookup = |parameter: &str| {
            let row = by_name.get(parameter);
            row.map(|&row| {
                (table.floats(names::elements::VALUE)[row], table.texts(names::elements::WORD)[row].as_str())
            })
        };
        elements.push(Element { family: family.name, record: rebuilt("", family.fields, &lookup)? });
    }
    Ok(NamedDesign { name: name.to_owned(), elements })
}

fn rebuilt<'a>(
    prefix: &str,
    fields: &[Field],
    lookup: &impl Fn(&str) -> Option<(f64, &'a str)>,
) -> Result<Record, Failure> {
    let mut record = Record::default();
    for field in fields {
        if let Some(value) = rebuilt_value(&format!("{prefix}{}", field.name), &field.shape, lookup)? {
            record.fields.push((field.name, PlacedValue { value, place: Place::default() }));
        }
    }
    Ok(record)
}

fn rebuilt_value<'a>(
    name: &str,
    shape: &Shape,
    lookup: &impl Fn(&str) -> Option<(f64, &'a str)>,
) -> Result<Option<Value>, Failure> {
    Ok(match (shape, lookup(name)) {
        (Shape::Group(inner), _) => {
            let inner = rebuilt(&format!("{name}."), inner, lookup)?;
            (!inner.fields.is_empty()).then_some(Value::Group(inner))
        }
        (_, None) => None,
        // A length by construction.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        (Shape::List(item), Some((length, _))) => {
            let mut items = Vec::new();
            for place in 1..=length as usize {
                let name = format!("{name}[{place}]");
                let value = rebuilt_value(&name, item, lookup)?;
                let value = value.ok_or_else(|| Failure::new(format!("`{name}` has no row")))?;
                items.push(PlacedValue { value, place: Place::default() });
            }
            Some(Value::List(items))
        }
        (Shape::Choice(choices), Some((_, word))) => {
            let choice = choices.iter().find(|choice| choice.name == word);
            let choice = choice.ok_or_else(|| Failure::new(format!("`{word}` is not a value of `{name}`")))?;
            Some(Value::Choice(choice.name))
        }
        (Shape::Quantity { .. }, Some((value, _))) => Some(Value::Quantity(value)),
        (Shape::Number { .. }, Some((value, _))) => Some(Value::Number(value)),
        // Whole by construction and far below 2^53.
        #[allow(clippy::cast_possible_truncation)]
        (Shape::Integer { .. }, Some((value, _))) => Some(Value::Integer(value as i64)),
        (Shape::Flag, Some((value, _))) => Some(Value::Flag(value != 0.0)),
        (_, Some((_, word))) => Some(Value::Text(word.to_owned())),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use declare::parameter::Choice;
    use declare::units::LENGTH;

    const INNER: &[Field] = &[Field::number("factor", 0.0, 9.0, "")];
    const FIELDS: &[Field] = &[
        Field::choice("gear", &[Choice { name: "both", summary: "" }], ""),
        Field::quantity("amount", LENGTH, 0.0, 1.0, "").optional(),
        Field::group("preset", INNER, "").optional(),
    ];

    #[test]
    fn designs_come_back_as_they_were_in_their_order() {
        let entry = |value| PlacedValue { value, place: Place::default() };
        let both = ("gear", entry(Value::Choice("both")));
        let preset = Record { fields: vec![("factor", entry(Value::Number(1.25)))], place: Place::default() };
        let with_amount =
            Record { fields: vec![both.clone(), ("amount", entry(Value::Quantity(7.81e-6)))], place: Place::default() };
        let with_preset =
            Record { fields: vec![both, ("preset", entry(Value::Group(preset)))], place: Place::default() };
        let element = |record: &Record| Element { family: "relief", record: record.clone() };
        let designs = vec![
            NamedDesign { name: "z".into(), elements: vec![element(&with_amount), element(&with_preset)] },
            NamedDesign { name: "a".into(), elements: vec![] },
        ];
        let families = [Member { name: "relief", summary: "", fields: FIELDS }];
        let [names, rows] = write(&designs, &families).unwrap();
        assert_eq!(rows.texts("unit"), ["m", "", "", ""], "amount, gear; gear, preset.factor");
        assert_eq!(read(&names, &rows, &families).unwrap(), designs);
        assert!(read(&names, &rows, &[]).is_err());
    }

    const POINT: &[Field] = &[Field::number("x", 0.0, 9.0, ""), Field::integer("y", 0, 9, "").optional()];
    const LISTS: &[Field] = &[
        Field::new("depths", Shape::List(&Shape::Quantity { dimension: LENGTH, minimum: 0.0, maximum: 1.0 }), ""),
        Field::new("points", Shape::List(&Shape::Group(POINT)), "").optional(),
    ];

    fn entry(value: Value) -> PlacedValue {
        PlacedValue { value, place: Place::default() }
    }

    fn record(fields: Vec<(&'static str, PlacedValue)>) -> Record {
        Record { fields, place: Place::default() }
    }

    fn design(name: &str, fields: Vec<(&'static str, PlacedValue)>) -> NamedDesign {
        NamedDesign { name: name.into(), elements: vec![Element { family: "curve", record: record(fields) }] }
    }

    #[test]
    fn lists_come_back_as_they_were_even_empty_ones() {
        let list = |values: Vec<Value>| entry(Value::List(values.into_iter().map(entry).collect()));
        let depths = |count: u32| list((0..count).map(|at| Value::Quantity(f64::from(at) * 1e-6)).collect());
        let point = |x: f64, y: Option<i64>| {
            let y = y.map(|y| ("y", entry(Value::Integer(y))));
            Value::Group(record([("x", entry(Value::Number(x)))].into_iter().chain(y).collect()))
        };
        let points = list(vec![point(1.0, None), point(2.0, Some(3))]);
        let designs = vec![
            design("many", vec![("depths", depths(12)), ("points", points)]),
            design("none", vec![("depths", depths(0))]),
        ];
        let families = [Member { name: "curve", summary: "", fields: LISTS }];
        let [names, rows] = write(&designs, &families).unwrap();
        assert_eq!(rows.rows(), designs.iter().map(|design| rows_of(&design.elements[0])).sum::<usize>());
        // Each depth is a length; how many there are is none.
        let lengths = rows.texts("parameter").iter().zip(rows.texts("unit")).filter(|(_, unit)| *unit == "m");
        assert!(lengths.clone().all(|(name, _)| name.starts_with("depths[")) && lengths.count() == 12);
        assert_eq!(read(&names, &rows, &families).unwrap(), designs);
    }

    #[test]
    fn what_no_row_holds_is_an_error_and_not_dropped() {
        let refused =
            write(&[design("a", vec![("amount", entry(Value::Range(0.0, 1.0)))])], &[]).unwrap_err().to_string();
        let said = "design `a`, curve: no row of a table holds the value of `amount`";
        assert!(refused.contains(said), "{refused}");
    }
}
