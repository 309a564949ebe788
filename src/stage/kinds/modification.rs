//! `kind: modification`: named designs, each a list of modifications that add up.
//!
//! Families and their parameters come from `gear/modification`; this file only reads them and shows what they come to
//! on the pair. Must not know: any single family.

mod charts;

use crate::stage::designs::{self, Elements, NamedDesign};
use crate::stage::evaluated::{self, Evaluated};
use crate::stage::{
    Ahead, Context, Curves, Demand, Estimate, Inputs, KeysOf, Kind, Port, RowCount, Stage, names, pair,
};
use declare::Declared;
use declare::declared::Declared;
use declare::error::{Diagnostic, Failure, Faults};
use declare::record::Record;
use gearmesh::gear::geometry::Side;
use gearmesh::gear::modification::{self, Design};
use studygraph::table::columns::Columns;
use studygraph::table::data::{Cell, Table, TableError};
use studygraph::table::schema::{Column, Schema};

const PARAMETERS: &str = "parameters";
const EVALUATED: &str = "measured";

pub const KIND: Kind = Kind {
    name: "modification",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[
        Curves { table: charts::PROFILE, along: "roll_angle", quantity: "depth" },
        Curves { table: charts::LEAD, along: "z", quantity: "depth" },
    ],
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

/// Named designs of flank modifications (ISO 21771): tip and root relief, arcs, parabolas, crowning, slopes, end
/// relief.
#[derive(Debug, Declared)]
struct Stated {
    /// The pair that is modified.
    #[declared(kinds = ["geometry"])]
    pub pair: String,
    /// The designs by name; an empty list is the unmodified pair.
    pub designs: Vec<(String, Elements)>,
}

struct Modification {
    pair: String,
    designs: Vec<NamedDesign>,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let Stated { pair, designs } = Stated::checked(record)?;
    Faults::collect(designs.iter().map(|(_, design)| design.template()))?;
    if designs.is_empty() {
        return Err(Diagnostic::new("no designs are given")
            .at(record.place_of(Stated::NAMES.designs))
            .help("an empty list is the unmodified pair: `designs: { unmodified: [] }`")
            .into());
    }
    let named = |(name, design): (String, Elements)| NamedDesign { name, elements: design.elements() };
    Ok(Box::new(Modification { pair, designs: designs.into_iter().map(named).collect() }))
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

/// What a modification comes to on a gear.
struct ResolvedRow<'a> {
    design: &'a str,
    side: Side,
    /// From 1.
    element: usize,
    family: &'static str,
    values: Vec<(&'static str, f64)>,
}

/// The columns that say which modification it is, the same in both tables; `get` finds it in a row.
fn of_modification<'a, T>(
    columns: Columns<T>,
    get: impl for<'b> Fn(&'b T) -> &'b ResolvedRow<'a> + Copy + 'static,
) -> Columns<T> {
    columns
        .text("design", "Name of the design.", move |row| get(row).design)
        .key()
        .text("gear", "Which gear: pinion or gear.", move |row| get(row).side.name())
        .key()
        .integer("element", "Counts the modifications of a gear, from 1.", move |row| get(row).element)
        .key()
        .text("family", "Family of the modification.", move |row| get(row).family)
}

fn resolved<'a>() -> Columns<ResolvedRow<'a>> {
    let description = "What each modification comes to on the pair; NaN where a family has no such parameter.";
    let columns = of_modification(Columns::new("resolved", description), |row| row);
    RESOLVED.iter().fold(columns, |columns, (parameter, unit, description)| {
        let value = move |row: &ResolvedRow| {
            let found = row.values.iter().find(|(given, _)| given == parameter);
            found.map_or(f64::NAN, |(_, value)| *value)
        };
        columns.float(parameter, unit, description, value).but(Column::allows_nan)
    })
}

/// A modification, and the name and value of one of its parameters.
type ParameterRow<'a> = (&'a ResolvedRow<'a>, &'static str, f64);

fn parameters<'a>() -> Columns<ParameterRow<'a>> {
    let description = "Everything a modification was given and comes to on the pair, one row per parameter.";
    of_modification(Columns::new(PARAMETERS, description), |row: &ParameterRow<'a>| row.0)
        .text("parameter", "Name of the parameter.", |row| row.1)
        .key()
        .float("value", "", "Value in SI.", |row| row.2)
        .on_demand()
}

fn resolved_rows<'a>(design: &'a str, built: &Design) -> Vec<ResolvedRow<'a>> {
    let of = |side: Side| {
        (1..).zip(built.side(side)).map(move |(element, part)| {
            let values = part.modification.resolved();
            ResolvedRow { design, side, element, family: part.family, values }
        })
    };
    of(Side::Pinion).chain(of(Side::Gear)).collect()
}

fn parameter_rows<'a>(rows: &'a [ResolvedRow<'a>]) -> Vec<ParameterRow<'a>> {
    rows.iter().flat_map(|row| row.values.iter().map(move |(name, value)| (row, *name, *value))).collect()
}

/// What a measured trace of a modification comes to.
struct EvaluatedRow<'a> {
    of: &'a ResolvedRow<'a>,
    evaluated: Evaluated,
}

fn evaluated<'a>() -> Columns<EvaluatedRow<'a>> {
    let description = "What each measured trace comes to after ISO 1328-1:2013, of a grid those in the middle of its other way; positive \
                       where there is more material than designed.";
    let columns = of_modification(Columns::new(EVALUATED, description), |row: &EvaluatedRow<'a>| row.of);
    evaluated::columns(columns, |row| &row.evaluated).on_demand()
}

fn evaluated_rows<'a>(rows: &'a [ResolvedRow<'a>]) -> Vec<EvaluatedRow<'a>> {
    let of = |row: &'a ResolvedRow<'a>| {
        Evaluated::all(&row.values).into_iter().map(move |evaluated| EvaluatedRow { of: row, evaluated })
    };
    rows.iter().flat_map(of).collect()
}

impl Stage for Modification {
    fn inputs(&self) -> Vec<Port> {
        vec![pair::port(&self.pair)]
    }

    fn outputs(&self) -> Vec<Schema> {
        let [designs, elements] = designs::schemas();
        let charts = [charts::profile().schema(), charts::lead().schema()];
        let own = [resolved().schema(), parameters().schema(), evaluated().schema()];
        [designs, elements].into_iter().chain(own).chain(charts).collect()
    }

    fn keys(&self, _table: &str, column: &str, _of: KeysOf) -> Option<Vec<Cell>> {
        let names = self.designs.iter().map(|design| Cell::Text(design.name.clone()));
        (column == names::designs::DESIGN).then(|| names.collect())
    }

    fn gives_what_its_kind_does(&self) -> bool {
        true
    }

    fn estimate(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let elements = || self.designs.iter().flat_map(|design| &design.elements);
        // A modification of both gears is one of each.
        let maximum = 2 * elements().count();
        let [of_designs, of_elements] = designs::schemas();
        Estimate::new(false)
            .rows(demand, of_designs, RowCount::exact(self.designs.len()))
            .rows(demand, of_elements, RowCount::exact(elements().map(designs::rows_of).sum()))
            .rows(demand, resolved().schema(), RowCount::at_most(maximum))
            .rows(demand, parameters().schema(), RowCount::at_most(maximum * MOST_RESOLVED))
            .rows(demand, evaluated().schema(), RowCount::at_most(2 * maximum))
            .rows(demand, charts::profile().schema(), RowCount::about(self.designs.len() * charts::ROWS))
            .rows(demand, charts::lead().schema(), RowCount::about(self.designs.len() * charts::ROWS))
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let pair = pair::of(inputs)?;
        let (mut rows, mut profiles, mut leads) = (Vec::new(), Vec::new(), Vec::new());
        let is_charted = context.demand.table(charts::PROFILE) || context.demand.table(charts::LEAD);
        for named in &self.designs {
            let built = named.built(&pair)?;
            rows.extend(resolved_rows(&named.name, &built));
            if is_charted {
                let [profile, lead] = charts::rows(&named.name, &built, &pair);
                profiles.extend(profile);
                leads.extend(lead);
            }
        }
        let failed = |error: TableError| Failure::new(error.to_string());
        let mut tables = Vec::from(designs::write(&self.designs, modification::members()).map_err(failed)?);
        tables.push(resolved().table(&rows).map_err(failed)?);
        if context.demand.table(PARAMETERS) {
            tables.push(parameters().table(&parameter_rows(&rows)).map_err(failed)?);
        }
        if context.demand.table(EVALUATED) {
            tables.push(evaluated().table(&evaluated_rows(&rows)).map_err(failed)?);
        }
        if context.demand.table(charts::PROFILE) {
            tables.push(charts::profile().table(&profiles).map_err(failed)?);
        }
        if context.demand.table(charts::LEAD) {
            tables.push(charts::lead().table(&leads).map_err(failed)?);
        }
        Ok(tables)
    }
}
