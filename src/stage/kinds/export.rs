//! `kind: export`: the profiles of a pair as files that other programs read: DXF, SVG, points as CSV.
//!
//! Everything is taken from the points of the table `outline`; arcs and lines are rebuilt exactly from what the table says
//! of their ends, every other curve becomes the chords between its points. So how dense the points are, whether one tooth
//! or the whole gear is drawn, and with which root, is said where the outline is made. The files travel as lines of a
//! table: they are cached, compared, archived and removed like any other result.
//!
//! Why there is no STEP: docs/decisions/no-step.md. Must not know: how a profile is made.

mod contour;
mod dxf;
mod svg;
#[cfg(test)]
mod tests;

use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Port, RowCount, Stage};
use contour::{Contour, contours};
use declare::error::{Diagnostic, Failure};
use declare::parameter::{Choice, Field, Shape};
use declare::record::{Record, Value};
use studygraph::table::columns::Columns;
use studygraph::table::data::{Row, Table, TableError};
use studygraph::table::schema::{Column, Schema};

pub const KIND: Kind = Kind {
    name: "export",
    version: 1,
    summary: "Profiles as files for drawing, cutting and meshing programs: DXF, SVG, CSV.",
    fields: FIELDS,
    example: "
kind: export
pair: geometry
gear: both
formats: [dxf, svg, csv]
",
    build,
};

const FIELDS: &[Field] = &[
    Field::reference("pair", &["geometry"], "The pair; its `outline` says what is drawn and how densely."),
    Field::choice("gear", GEARS, "Which gears; each has files of its own.").default("both"),
    Field::new("formats", Shape::List(&Shape::Choice(FORMATS)), "Which files.").default("[dxf, svg, csv]"),
];

const GEARS: &[Choice] = &[
    Choice { name: "both", summary: "pinion and gear" },
    Choice { name: "pinion", summary: "the pinion" },
    Choice { name: "gear", summary: "the mating gear" },
];

const FORMATS: &[Choice] = &[
    Choice { name: "dxf", summary: "DXF of AutoCAD 2000 in mm: ARC, LINE, LWPOLYLINE, the bore as CIRCLE" },
    Choice { name: "svg", summary: "SVG, true to scale in mm" },
    Choice { name: "csv", summary: "the points, in mm" },
];

/// Lines of a file for each point, where they are more than one, and beside the points.
const DXF_LINES: usize = 4;
const HEAD: usize = 200;
/// Bytes of a point while its contour is drawn, and of a line that is longer than a word.
const CONTOUR_POINT: u64 = 160;
const LINE: u64 = 80;

struct Export {
    pair: String,
    gears: Vec<&'static str>,
    formats: Vec<&'static str>,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Diagnostic> {
    let gears = match record.choice("gear") {
        "both" => vec!["pinion", "gear"],
        one => vec![one],
    };
    let mut formats = Vec::new();
    for entry in record.list("formats") {
        let Value::Choice(format) = entry.value else { continue };
        if formats.contains(&format) {
            return Err(Diagnostic::new(format!("the format `{format}` is named twice")).at(entry.place));
        }
        formats.push(format);
    }
    if formats.is_empty() {
        return Err(Diagnostic::new("no format is named")
            .at(record.place_of("formats"))
            .help("name at least one of dxf, svg, csv"));
    }
    Ok(Box::new(Export { pair: record.reference("pair").to_owned(), gears, formats }))
}

fn drawn<'a>() -> Columns<&'a Contour> {
    let gap = "Largest distance from the end of a curve to the start of the next.";
    let area = "Area inside the closed contour as drawn, less the bore; NaN for one tooth.";
    // Files are in mm, and so is what was drawn.
    Columns::new("contours", "What was drawn of each gear.")
        .text("gear", "Which gear: pinion or gear.", |contour: &&Contour| contour.gear.as_str())
        .key()
        .flag("closed", "Whether it is the whole gear; else one tooth, from space to space.", |contour| contour.closed)
        .integer("lines", "Number of straight lines.", |contour| contour.counts()[0])
        .integer("arcs", "Number of arcs.", |contour| contour.counts()[1])
        .integer("polylines", "Number of curves drawn as chords between points.", |contour| contour.counts()[2])
        .integer("points", "Number of points on these curves.", |contour| contour.points.len())
        .shown("chord_error", "um", "No chord is farther than this from its curve.", |contour| {
            1e3 * contour.chord_error()
        })
        .but(|column| column.tolerance(1e-9, 1e-6))
        .shown("gap", "mm", gap, |contour| contour.gap())
        .but(|column| column.tolerance(1e-9, 0.0))
        .shown("area", "mm^2", area, |contour| contour.area())
        .but(Column::allows_nan)
}

impl Export {
    fn files_schema(&self) -> Schema {
        let names = |gear: &&str| self.formats.iter().map(|format| format!("{gear}.{format}")).collect::<Vec<_>>();
        let files = self.gears.iter().flat_map(names).collect();
        Schema::of_files("files", "The files, line by line; each also lies beside the tables.", files)
    }
}

impl Stage for Export {
    fn inputs(&self) -> Vec<Port> {
        vec![Port::tables("pair", &self.pair, &["gears", "outline"])]
    }

    fn outputs(&self) -> Vec<Schema> {
        vec![drawn().schema(), self.files_schema()]
    }

    fn estimate(&self, demand: &Demand, ahead: &Ahead) -> Estimate {
        // Both gears have about as many points.
        let points = ahead.rows("pair", "outline").index().saturating_mul(self.gears.len()) / 2;
        let per_point: usize = self.formats.iter().map(|format| if *format == "dxf" { DXF_LINES } else { 1 }).sum();
        let lines = points.saturating_mul(per_point).saturating_add(HEAD * self.gears.len() * self.formats.len());
        Estimate::new(false)
            .holding((points as u64).saturating_mul(CONTOUR_POINT).saturating_add(lines as u64 * LINE))
            .rows(demand, drawn().schema(), RowCount::exact(self.gears.len()))
            .rows(demand, self.files_schema(), RowCount::about(lines))
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let all = contours(inputs.table("pair", "outline")?, inputs.table("pair", "gears")?)?;
        let wanted: Vec<&Contour> =
            self.gears.iter().filter_map(|gear| all.iter().find(|contour| contour.gear == *gear)).collect();
        if wanted.len() < self.gears.len() {
            return Err(Failure::new(format!("`{}` has one gear: write `gear: pinion`", self.pair)));
        }
        let mut rows = Vec::new();
        for contour in &wanted {
            for format in &self.formats {
                context.check_stop()?;
                let lines = match *format {
                    "dxf" => dxf::lines(contour),
                    "svg" => svg::lines(contour),
                    _ => contour.csv(),
                };
                let file = format!("{}.{format}", contour.gear);
                let numbered = lines.into_iter().enumerate();
                rows.extend(
                    numbered.map(|(at, line)| -> Row { vec![file.as_str().into(), (at + 1).into(), line.into()] }),
                );
            }
        }
        let failed = |error: TableError| Failure::new(error.to_string());
        Ok(vec![drawn().table(&wanted).map_err(failed)?, Table::from_rows(self.files_schema(), rows).map_err(failed)?])
    }
}
