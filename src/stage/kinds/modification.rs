//! `kind: modification`: named designs, each a list of modifications that add up.
//!
//! Families and their parameters come from `gear/modification`; this file only reads them and shows what they come to
//! on the pair. Must not know: any single family.

use crate::stage::designs::{self, Element, NamedDesign};
use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Port, RowCount, Stage, pair};
use declare::error::{Diagnostic, Failure};
use declare::parameter::{Field, Shape};
use declare::record::{PlacedValue, Record, Value};
use declare::units::in_unit;
use gearmesh::gear::geometry::Side;
use gearmesh::gear::modification::Design;
use gearmesh::gear::modification::template::Template;
use studygraph::table::data::{Row, Table};
use studygraph::table::schema::{Column, Schema};

pub const KIND: Kind = Kind {
    name: "modification",
    version: 1,
    summary: "Named designs of flank modifications (ISO 21771): tip and root relief, arcs, parabolas, crowning, slopes, end \
              relief.",
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
    Field::new("designs", Shape::Map(&designs::ELEMENTS), "The designs by name; an empty list is the unmodified pair."),
];

struct Modification {
    pair: String,
    designs: Vec<NamedDesign>,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Diagnostic> {
    let mut designs = Vec::new();
    for (name, entry) in record.map("designs") {
        designs.push(NamedDesign { name: name.clone(), elements: elements(entry)? });
    }
    if designs.is_empty() {
        return Err(Diagnostic::new("no designs are given")
            .at(record.place_of("designs"))
            .help("an empty list is the unmodified pair: `designs: { unmodified: [] }`"));
    }
    Ok(Box::new(Modification { pair: record.reference("pair").to_owned(), designs }))
}

/// The modifications of one design, each checked for what no declaration can express.
fn elements(entry: &PlacedValue) -> Result<Vec<Element>, Diagnostic> {
    let Value::List(items) = &entry.value else { return Ok(Vec::new()) };
    Template::new(items)?;
    let member = |item: &PlacedValue| match &item.value {
        Value::Member(family, record) => Some(Element { family, record: record.clone() }),
        _ => None,
    };
    Ok(items.iter().filter_map(member).collect())
}

/// Resolved parameters that have a column of their own; others are not shown.
const RESOLVED: &[(&str, &str, &str)] = &[
    ("amount", "um", "Depth at its deepest place."),
    ("length", "mm", "Length along the line of action, or across the face for an end relief."),
    ("start_roll_angle", "deg", "Roll angle where a relief starts."),
    ("start_diameter", "mm", "Diameter where a relief starts."),
];

/// The most parameters that a modification comes to.
const MOST_RESOLVED: usize = 24;

fn resolved_schema() -> Schema {
    let mut columns = vec![
        Column::text("design", "Name of the design.").key(),
        Column::text("gear", "Which gear: pinion or gear.").key(),
        Column::integer("element", "Counts the modifications of a gear, from 1.").key(),
        Column::text("family", "Family of the modification."),
    ];
    columns
        .extend(RESOLVED.iter().map(|(name, unit, description)| Column::float(name, unit, description).allows_nan()));
    Schema::new(
        "resolved",
        "What each modification comes to on the pair; NaN where a family has no such parameter.",
        columns,
    )
}

fn parameters_schema() -> Schema {
    Schema::new(
        "parameters",
        "Everything a modification was given and comes to on the pair, one row per parameter.",
        vec![
            Column::text("design", "Name of the design.").key(),
            Column::text("gear", "Which gear: pinion or gear.").key(),
            Column::integer("element", "Counts the modifications of a gear, from 1.").key(),
            Column::text("family", "Family of the modification."),
            Column::text("parameter", "Name of the parameter.").key(),
            Column::float("value", "", "Value in SI."),
        ],
    )
    .on_demand()
}

fn parameter_rows(name: &str, design: &Design) -> Vec<Row> {
    let mut rows = Vec::new();
    for side in [Side::Pinion, Side::Gear] {
        for (index, part) in design.side(side).iter().enumerate() {
            rows.extend(part.modification.resolved().into_iter().map(|(parameter, value)| -> Row {
                let element: Row = vec![name.into(), side.name().into(), (index + 1).into(), part.family.into()];
                [element, vec![parameter.into(), value.into()]].concat()
            }));
        }
    }
    rows
}

fn resolved_rows(name: &str, design: &Design) -> Vec<Row> {
    let mut rows = Vec::new();
    for side in [Side::Pinion, Side::Gear] {
        for (index, part) in design.side(side).iter().enumerate() {
            let values = part.modification.resolved();
            let mut row: Row = vec![name.into(), side.name().into(), (index + 1).into(), part.family.into()];
            row.extend(RESOLVED.iter().map(|(parameter, unit, _)| {
                let found = values.iter().find(|(given, _)| given == parameter);
                found.map_or(f64::NAN, |(_, value)| in_unit(*value, unit)).into()
            }));
            rows.push(row);
        }
    }
    rows
}

impl Stage for Modification {
    fn inputs(&self) -> Vec<Port> {
        vec![Port::tables("pair", &self.pair, &["gears", "pair"])]
    }

    fn outputs(&self) -> Vec<Schema> {
        vec![designs::designs_schema(), designs::elements_schema(), resolved_schema(), parameters_schema()]
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let elements = || self.designs.iter().flat_map(|design| &design.elements);
        // A modification of both gears is one of each.
        let resolved = 2 * elements().count();
        Estimate::new(false)
            .rows(demand, designs::designs_schema(), RowCount::exact(self.designs.len()))
            .rows(demand, designs::elements_schema(), RowCount::exact(elements().map(designs::rows_of).sum()))
            .rows(demand, resolved_schema(), RowCount::at_most(resolved))
            .rows(demand, parameters_schema(), RowCount::at_most(resolved * MOST_RESOLVED))
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let pair = pair::read(inputs.table("pair", "gears")?, inputs.table("pair", "pair")?)?;
        let (mut rows, mut parameters): (Vec<Row>, Vec<Row>) = Default::default();
        for named in &self.designs {
            let design = named.built(&pair)?;
            rows.extend(resolved_rows(&named.name, &design));
            parameters.extend(parameter_rows(&named.name, &design));
        }
        let failed = |error: studygraph::table::data::TableError| Failure::new(error.to_string());
        let mut tables = Vec::from(designs::write(&self.designs).map_err(failed)?);
        tables.push(Table::from_rows(resolved_schema(), rows).map_err(failed)?);
        if context.demand.table("parameters") {
            tables.push(Table::from_rows(parameters_schema(), parameters).map_err(failed)?);
        }
        Ok(tables)
    }
}
