//! `kind: modification`: named designs, each a list of modifications that add up.
//!
//! Families and their parameters come from `gear/modification`; this file only reads them and shows what they come to
//! on the pair. Must not know: any single family.

use crate::base::error::{Diagnostic, Failure};
use crate::base::parameter::{Field, Shape};
use crate::base::record::{Entry, Record};
use crate::base::units::in_unit;
use crate::gear::geometry::{Pair, Side};
use crate::gear::modification::{self, Design};
use crate::stage::designs::{self, Element, NamedDesign};
use crate::stage::{Context, Inputs, Kind, Port, Stage, pair};
use crate::table::data::{Row, Table};
use crate::table::schema::{Column, Schema};

pub const KIND: Kind = Kind {
    name: "modification",
    version: 1,
    summary: "Named designs of flank modifications (ISO 21771 names): tip and root relief, crowning, slopes, end relief.",
    fields: FIELDS,
    example: "
kind: modification
pair: geometry
designs:
  unmodified: []
  relieved:
    - tip_relief: { gear: both, amount: 7.81 um, length: 5.05 mm, curve: parabolic }
    - lead_crowning: { gear: pinion, amount: 6.34 um }
",
    build,
};

const FIELDS: &[Field] = &[
    Field::reference("pair", &["geometry"], "The pair that is modified."),
    Field::new("designs", Shape::Map(&ELEMENTS), "The designs by name; an empty list is the unmodified pair."),
];

/// A design: a list of members of the modification families.
pub const ELEMENTS: Shape = Shape::List(&Shape::Member(modification::members));

struct Modification {
    pair: String,
    designs: Vec<NamedDesign>,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Diagnostic> {
    let designs = record
        .map("designs")
        .iter()
        .map(|(name, entry)| NamedDesign { name: name.clone(), elements: elements(entry) })
        .collect();
    Ok(Box::new(Modification { pair: record.reference("pair").to_owned(), designs }))
}

/// The modifications that stand in a list.
#[must_use]
pub fn elements(entry: &Entry) -> Vec<Element> {
    entry.value.items().iter().filter_map(|item| item.value.as_member()).map(|(family, record)| Element { family, record: record.clone() }).collect()
}
