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

use crate::stage::{Ahead, Context, Demand, Estimate, Inputs, Kind, Port, RowCount, Stage, names};
use contour::{Contour, contours};
use declare::declared::{Declared, Placed, Words};
use declare::error::{Diagnostic, Failure, Faults};
use declare::record::Record;
use declare::{Declared, Words};
use studygraph::table::columns::Columns;
use studygraph::table::data::{Row, Table, TableError};
use studygraph::table::schema::{Column, Schema};

pub const KIND: Kind = Kind {
    name: "export",
    version: 1,
    summary: Export::MEMBER.summary,
    fields: Export::MEMBER.fields,
    curves: &[],
    example: "
kind: export
pair: geometry
gear: both
formats: [dxf, svg, csv]
",
    build,
};

/// Profiles as files for drawing, cutting and meshing programs: DXF, SVG, CSV.
#[derive(Debug, Declared)]
struct Export {
    /// The pair; its `outline` says what is drawn and how densely.
    #[declared(kinds = ["geometry"])]
    pub pair: String,
    /// Which gears; each has files of its own.
    #[declared(default = "both")]
    pub gear: Which,
    /// Which files.
    #[declared(default = "[dxf, svg, csv]")]
    pub formats: Vec<Placed<Format>>,
}

/// Which gears.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
enum Which {
    /// pinion and gear
    Both,
    /// the pinion
    Pinion,
    /// the mating gear
    Gear,
}

/// A format of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
enum Format {
    /// DXF of AutoCAD 2000 in mm: ARC, LINE, LWPOLYLINE, the bore as CIRCLE
    Dxf,
    /// SVG, true to scale in mm
    Svg,
    /// the points, in mm
    Csv,
}

impl Which {
    fn names(self) -> &'static [&'static str] {
        match self {
            Self::Both => &["pinion", "gear"],
            Self::Pinion => &["pinion"],
            Self::Gear => &["gear"],
        }
    }
}

/// Lines of a file for each point, where they are more than one, and beside the points.
const DXF_LINES: usize = 4;
const HEAD: usize = 200;
/// Bytes of a point while its contour is drawn, and of a line that is longer than a word.
const CONTOUR_POINT: u64 = 160;
const LINE: u64 = 80;

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let export = Export::checked(record)?;
    for (index, Placed { value: format, place }) in export.formats.iter().enumerate() {
        if export.formats[..index].iter().any(|other| other.value == *format) {
            return Err(Diagnostic::new(format!("the format `{}` is named twice", format.word())).at(*place).into());
        }
    }
    if export.formats.is_empty() {
        return Err(Diagnostic::new("no format is named")
            .at(record.place_of(Export::NAMES.formats))
            .help("name at least one of dxf, svg, csv")
            .into());
    }
    Ok(Box::new(export))
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

/// The name of a file of a gear.
fn file(gear: &str, format: Format) -> String {
    format!("{gear}.{}", format.word())
}

impl Export {
    fn formats(&self) -> impl Iterator<Item = Format> {
        self.formats.iter().map(|format| format.value)
    }

    fn files_schema(&self) -> Schema {
        let names = |gear: &&str| self.formats().map(|format| file(gear, format)).collect::<Vec<_>>();
        let files = self.gear.names().iter().flat_map(names).collect();
        Schema::of_files("files", "The files, line by line; each also lies beside the tables.", files)
    }
}

impl Stage for Export {
    fn inputs(&self) -> Vec<Port> {
        vec![Port::tables(names::PAIR_PORT, &self.pair, &[names::gears::TABLE, names::outline::TABLE])]
    }

    fn outputs(&self) -> Vec<Schema> {
        vec![drawn().schema(), self.files_schema()]
    }

    fn estimate(&self, demand: &Demand, ahead: &Ahead) -> Estimate {
        // Both gears have about as many points.
        let points = ahead.rows("pair", "outline").index().saturating_mul(self.gear.names().len()) / 2;
        let per_point: usize = self.formats().map(|format| if format == Format::Dxf { DXF_LINES } else { 1 }).sum();
        let lines =
            points.saturating_mul(per_point).saturating_add(HEAD * self.gear.names().len() * self.formats.len());
        Estimate::new(false)
            .holding((points as u64).saturating_mul(CONTOUR_POINT).saturating_add(lines as u64 * LINE))
            .rows(demand, drawn().schema(), RowCount::exact(self.gear.names().len()))
            .rows(demand, self.files_schema(), RowCount::about(lines))
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        let table = |table| inputs.table(names::PAIR_PORT, table);
        let all = contours(table(names::outline::TABLE)?, table(names::gears::TABLE)?)?;
        let wanted: Vec<&Contour> =
            self.gear.names().iter().filter_map(|gear| all.iter().find(|contour| contour.gear == *gear)).collect();
        if wanted.len() < self.gear.names().len() {
            return Err(Failure::new(format!("`{}` has one gear: write `gear: pinion`", self.pair)));
        }
        let mut rows = Vec::new();
        for contour in &wanted {
            for format in self.formats() {
                context.check_stop()?;
                let lines = match format {
                    Format::Dxf => dxf::lines(contour),
                    Format::Svg => svg::lines(contour),
                    Format::Csv => contour.csv(),
                };
                let file = file(&contour.gear, format);
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
