//! A design with some of its values left open for an optimiser to vary; a fixed design is the case without open values.
//!
//! Must not know: optimisers, compliance, load.

use std::borrow::Cow;

use super::{Design, Family, Gears, Where, family};
use crate::gear::geometry::GearPair;
use declare::declared::{Declared, Words};
use declare::error::Diagnostic;
use declare::parameter::Shape;
use declare::record::{PlacedValue, Record, Value};
use declare::units::{Dimension, RATIO};

/// One open value.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// `family.field`, after the gear where that is not both, and with a number at the end where it would not be unique.
    pub name: String,
    /// What kind of quantity the field is, and so its unit.
    pub dimension: Dimension,
    /// SI.
    pub minimum: f64,
    /// SI.
    pub maximum: f64,
}

/// Modifications as the study states them.
#[derive(Clone)]
pub struct Template {
    parts: Vec<(&'static Family, Record)>,
    variables: Vec<Variable>,
    /// Part and field of each variable, and whether the field is a plain number: a ratio may be either.
    slots: Vec<(usize, usize, bool)>,
}

impl Template {
    /// Reads a list of family members; ranges become variables, in the order of the study.
    ///
    /// # Errors
    /// When the fields of a member contradict each other.
    pub fn new(members: &[PlacedValue]) -> Result<Self, Diagnostic> {
        let mut template = Self { parts: Vec::new(), variables: Vec::new(), slots: Vec::new() };
        for entry in members {
            let Value::Member(name, record) = &entry.value else {
                return Err(Diagnostic::new("a modification is written `family: { fields }`").at(entry.place));
            };
            let family = family(name)
                .ok_or_else(|| Diagnostic::new(format!("there is no modification `{name}`")).at(entry.place))?;
            (family.check)(record).map_err(|diagnostic| diagnostic.or_at(entry.place))?;
            template.open(family, record);
            template.parts.push((family, record.clone()));
        }
        Ok(template)
    }

    fn open(&mut self, family: &'static Family, record: &Record) {
        for (slot, (field, entry)) in record.fields.iter().enumerate() {
            let Value::Range(minimum, maximum) = entry.value else { continue };
            let shape = family.member.fields.iter().find(|declared| declared.name == *field).map(|found| found.shape);
            let dimension = if let Some(Shape::Quantity { dimension, .. }) = shape { dimension } else { RATIO };
            let gears = Where::read(record).gear;
            let gear = if gears == Gears::Both { String::new() } else { format!("{}.", gears.word()) };
            let plain = format!("{gear}{}.{field}", family.member.name);
            let taken = |name: &str| self.variables.iter().any(|variable| variable.name == name);
            let numbered = (2..).map(|number| format!("{plain}_{number}"));
            let name = std::iter::once(plain.clone()).chain(numbered).find(|name| !taken(name)).unwrap_or(plain);
            self.variables.push(Variable { name, dimension, minimum, maximum });
            let plain = !matches!(shape, Some(Shape::Quantity { .. }));
            self.slots.push((self.parts.len(), slot, plain));
        }
    }

    /// The open values.
    #[must_use]
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// For designs on one pair, of which what has no open values is made once.
    #[must_use]
    pub fn on(&self, pair: &GearPair) -> Fitted<'_> {
        let fixed = (0..self.parts.len()).map(|part| {
            let (family, record) = &self.parts[part];
            let mut design = Design::default();
            let is_open = self.slots.iter().any(|(open, ..)| *open == part);
            // What does not fit is told with every design.
            (!is_open && (family.put)(&mut design, record, pair).is_ok()).then_some(design)
        });
        Fitted { template: self, pair: pair.clone(), fixed: fixed.collect() }
    }
}

/// A template on a pair: all that a search asks for again and again.
#[derive(Clone)]
pub struct Fitted<'t> {
    template: &'t Template,
    pair: GearPair,
    /// What has no open values, of each part.
    fixed: Vec<Option<Design>>,
}

impl Fitted<'_> {
    /// The pair that designs are made for.
    #[must_use]
    pub fn pair(&self) -> &GearPair {
        &self.pair
    }

    /// The design with `values` (SI) in place of the variables.
    ///
    /// # Errors
    /// When a modification does not fit the pair, for example a relief longer than the flank. Most bounds are on a single
    /// value; the start of an `arc` or `parabola` bounds its amount.
    ///
    /// # Panics
    /// When there are fewer values than variables.
    pub fn design(&self, values: &[f64]) -> Result<Design, Diagnostic> {
        let Template { parts, slots, .. } = self.template;
        let (mut design, mut records, mut next) = (Design::default(), Vec::new(), 0);
        for (index, ((family, record), fixed)) in parts.iter().zip(&self.fixed).enumerate() {
            let mut record = Cow::Borrowed(record);
            while let Some((_, field, plain)) = slots.get(next).filter(|(part, ..)| *part == index) {
                let value = values[next];
                record.to_mut().fields[*field].1.value =
                    if *plain { Value::Number(value) } else { Value::Quantity(value) };
                next += 1;
            }
            match fixed {
                Some(fixed) => design.append(fixed),
                None => (family.put)(&mut design, &record, &self.pair)?,
            }
            records.push((*family, record));
        }
        // What is left of a tooth is looked at once, and again only to say which part takes it.
        if design.check_rooms(Gears::Both, &self.pair).is_err() {
            design = Design::default();
            for (family, record) in records {
                design.add_record(family, &record, &self.pair)?;
            }
        }
        Ok(design)
    }
}
