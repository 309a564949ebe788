//! A design with some of its values left open for an optimiser to vary; a fixed design is the case without open values.
//!
//! Must not know: optimisers, compliance, load.

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

    /// The design with `values` (SI) in place of the variables.
    ///
    /// # Errors
    /// When a modification does not fit the pair, for example a relief longer than the flank. Most bounds are on a single
    /// value; the start of an `arc` or `parabola` bounds its amount.
    ///
    /// # Panics
    /// When there are fewer values than variables.
    pub fn design(&self, pair: &GearPair, values: &[f64]) -> Result<Design, Diagnostic> {
        // Optimisers come by often: what is left of a tooth is looked at once, and again only to say which part takes it.
        let design = self.put(values, |design, family, record| (family.put)(design, record, pair))?;
        match design.check_rooms(Gears::Both, pair) {
            Ok(()) => Ok(design),
            Err(_) => self.put(values, |design, family, record| design.add_record(family, record, pair)),
        }
    }

    fn put(
        &self,
        values: &[f64],
        put: impl Fn(&mut Design, &'static Family, &Record) -> Result<(), Diagnostic>,
    ) -> Result<Design, Diagnostic> {
        let mut design = Design::default();
        let mut next = 0;
        for (index, (family, record)) in self.parts.iter().enumerate() {
            if self.slots.get(next).is_none_or(|(part, ..)| *part != index) {
                put(&mut design, family, record)?;
                continue;
            }
            let mut record = record.clone();
            while let Some((_, field, plain)) = self.slots.get(next).filter(|(part, ..)| *part == index) {
                let value = values[next];
                record.fields[*field].1.value = if *plain { Value::Number(value) } else { Value::Quantity(value) };
                next += 1;
            }
            put(&mut design, family, &record)?;
        }
        Ok(design)
    }
}
