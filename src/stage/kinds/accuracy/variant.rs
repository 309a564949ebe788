//! A stage with some of its settings replaced, what it reads, and which number was refined.
//!
//! Must not know: what is compared.

use std::collections::BTreeMap;

use crate::stage::{self, Ahead, Inputs, Port, Stage};
use declare::error::Diagnostic;
use declare::record::{self, Record, Value};

/// A stage as it is tried.
pub struct Variant {
    /// `reference`, or the ladder's name and the number of the step.
    pub label: String,
    /// What was replaced, as written.
    pub written: String,
    pub stage: Box<dyn Stage>,
    pub record: Record,
}

impl Variant {
    /// # Errors
    /// What the stage's kind refuses.
    pub fn build(label: String, variant: &record::Variant) -> Result<Self, Diagnostic> {
        let unknown = || Diagnostic::new(format!("there is no kind `{}`", variant.kind));
        let stage =
            (stage::kind(variant.kind).ok_or_else(unknown)?.build)(&variant.record).map_err(|wrong| *wrong.first)?;
        Ok(Self { label, written: variant.written.clone(), stage, record: variant.record.clone() })
    }

    /// What became of the one number in which two settings differ: from the coarser to the finer one; none where they
    /// differ in something else or in several numbers.
    pub fn refined(&self, coarser: &Self) -> Option<(f64, f64)> {
        let mut found = Vec::new();
        differences(&coarser.record, &self.record, &mut found);
        match found[..] {
            [Some((from, to))] if from > 0.0 && to > 0.0 => Some((from, to)),
            _ => None,
        }
    }
}

/// Every leaf in which two records differ, as two numbers where it is one.
fn differences(one: &Record, two: &Record, found: &mut Vec<Option<(f64, f64)>>) {
    for (name, entry) in &one.fields {
        match two.entry(name) {
            Some(other) => differing(&entry.value, &other.value, found),
            None => found.push(None),
        }
    }
    found.extend(two.fields.iter().filter(|(name, _)| one.entry(name).is_none()).map(|_| None));
}

fn differing(one: &Value, two: &Value, found: &mut Vec<Option<(f64, f64)>>) {
    let number = |value: &Value| match value {
        Value::Integer(value) => Some(*value as f64),
        Value::Number(value) | Value::Quantity(value) => Some(*value),
        _ => None,
    };
    match (one, two) {
        (Value::Group(one), Value::Group(two)) => differences(one, two, found),
        (Value::Member(name, one), Value::Member(other, two)) if name == other => differences(one, two, found),
        (Value::List(one), Value::List(two)) if one.len() == two.len() => {
            one.iter().zip(two).for_each(|(one, two)| differing(&one.value, &two.value, found));
        }
        // Places in the study differ in all of them.
        (Value::List(_) | Value::Map(_) | Value::Group(_) | Value::Member(..), _) => {
            if !same(one, two) {
                found.push(None);
            }
        }
        _ if one == two => {}
        _ => found.push(number(one).zip(number(two))),
    }
}

/// Whether two values are alike, wherever they stand.
fn same(one: &Value, two: &Value) -> bool {
    let digest = |value: &Value| {
        let entry = record::PlacedValue { value: value.clone(), place: declare::error::Place::default() };
        let record = Record { fields: vec![("value", entry)], place: declare::error::Place::default() };
        let mut writer = declare::digest::Writer::new("gearstudy 1 variant");
        record.write(&mut writer);
        writer.finish()
    };
    digest(one) == digest(two)
}

/// What all variants read together, each port with the variants that read it and its name there.
///
/// A port that all variants have alike keeps its name. Others say in their name whose they are: a cache key knows ports
/// by name and content alone, and two variants that swap what they read are not the same study.
pub fn ports(variants: &[&Variant]) -> Vec<(Port, Vec<(usize, String)>)> {
    let mut found: Vec<(Port, Vec<(usize, String)>)> = Vec::new();
    for (index, variant) in variants.iter().enumerate() {
        for port in variant.stage.inputs() {
            let name = port.name.clone();
            match found.iter_mut().find(|(other, _)| *other == port) {
                Some((_, readers)) => readers.push((index, name)),
                None => found.push((port, vec![(index, name)])),
            }
        }
    }
    for (port, readers) in &mut found {
        if readers.len() < variants.len() {
            let labels: Vec<&str> = readers.iter().map(|(index, _)| variants[*index].label.as_str()).collect();
            port.name = format!("{} of {}", port.name, labels.join(", "));
        }
    }
    found
}

/// What is known ahead of what variant `index` reads, under the names it knows.
pub fn ahead(ports: &[(Port, Vec<(usize, String)>)], index: usize, ahead: &Ahead) -> Ahead {
    let own = |name: &str| {
        let (_, readers) = ports.iter().find(|(port, _)| port.name == name)?;
        readers.iter().find(|(reader, _)| *reader == index).map(|(_, name)| name.clone())
    };
    ahead.renamed(own)
}

/// What variant `index` reads, under the names it knows.
pub fn inputs<'a>(ports: &[(Port, Vec<(usize, String)>)], index: usize, inputs: &Inputs<'a>) -> Inputs<'a> {
    let mut own = BTreeMap::new();
    for (port, readers) in ports {
        if let Some((_, name)) = readers.iter().find(|(reader, _)| *reader == index) {
            own.insert(name.clone(), inputs.ports.get(&port.name).cloned().unwrap_or_default());
        }
    }
    Inputs { ports: own }
}
