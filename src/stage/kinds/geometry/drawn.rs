//! The tables of the full profiles: points and junctions.
//!
//! Must not know: how a profile is made.

use crate::stage::names;
use std::f64::consts::PI;

use super::stated::MeasuredWith;
use declare::error::Failure;
use declare::units::in_unit;
use gearmesh::gear::geometry::outline::Outline;
use gearmesh::gear::geometry::outline::curve::Local;
use gearmesh::gear::geometry::outline::junction::{Junction, Place};
use gearmesh::gear::geometry::outline::sample::{Density, Point};
use gearmesh::gear::geometry::thickness::Limits;
use gearmesh::gear::geometry::{Gear, Side};
use studygraph::table::columns::{Columns, finite};
use studygraph::table::data::{Data, Row};
use studygraph::table::schema::{Column, Schema};

/// What a column of types of lines says of itself.
pub const LINE: &str = "Type of line, by what it is, as in a technical drawing: wide, narrow, dashed or dash-dotted.";

/// A gear with its full profile.
pub struct Drawn {
    /// What it is called: a gear alone is a pinion.
    pub side: Side,
    pub gear: Gear,
    pub outline: Outline,
    /// Between which its thickness may be.
    pub limits: Option<Limits>,
    pub measured_with: MeasuredWith,
}

/// The column that says which gear a row is of.
pub fn of_gear<T>(columns: Columns<T>, side: impl Fn(&T) -> Side + 'static) -> Columns<T> {
    columns.text("gear", "Which gear: pinion or gear.", move |row| side(row).name()).key()
}

#[must_use]
pub fn outline_schema() -> Schema {
    Schema::new(
        names::outline::TABLE,
        "Points on the profile, counterclockwise; tooth 1 is symmetric about the gear's y axis.",
        vec![
            Column::text(names::outline::GEAR, "Which gear: pinion or gear.").key(),
            Column::integer(names::outline::TOOTH, "Number of the tooth, counterclockwise.").key(),
            Column::integer(
                names::outline::POINT,
                "Number of the point on the tooth, from the middle of the space to its right.",
            )
            .key(),
            Column::integer(names::outline::STRETCH, "Number of the curve on the tooth; both its ends stand in it."),
            Column::text(
                names::outline::PART,
                "What it is part of: root_land, root, step, flank, tip_break, tip_land.",
            ),
            Column::text(names::outline::CURVE, "What it lies on: line, arc, trochoid, involute, modified_involute."),
            Column::float("radius", "mm", "Distance from the gear's centre."),
            Column::float("angle", "deg", "Polar angle from the y axis, counterclockwise.").tolerance(1e-9, 1e-9),
            Column::float(names::outline::X, "mm", "Place across, in the gear's frame.").tolerance(1e-9, 1e-9),
            Column::float(names::outline::Y, "mm", "Place upwards, in the gear's frame.").tolerance(1e-9, 1e-9),
            Column::float(
                names::outline::DIRECTION,
                "deg",
                "Direction of the tangent from the x axis, counterclockwise.",
            )
            .tolerance(1e-7, 1e-9),
            Column::float(
                names::outline::CURVATURE,
                "1/mm",
                "Curvature, positive where convex; NaN where it is infinite.",
            )
            .allows_nan()
            .tolerance(1e-6, 1e-6),
        ],
    )
    .on_demand()
}

impl Drawn {
    /// How many rows the outline of so many teeth has.
    #[must_use]
    pub fn outline_rows(&self, density: Density, teeth: u32) -> usize {
        self.outline.points_by_curves(density) * teeth as usize
    }

    /// Adds the outline to the columns of its table, tooth by tooth; `begin` is called before each and may end it.
    ///
    /// By columns, not rows: of all points of a whole gear these would be several times as large.
    fn outline(
        &self,
        density: Density,
        teeth: u32,
        columns: &mut [Data],
        begin: &mut impl FnMut() -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let curves = self.outline.tooth_by_curves(density);
        for number in 0..teeth {
            begin()?;
            let (sine, cosine) = libm::sincos(2.0 * PI * f64::from(number) / f64::from(self.outline.teeth));
            let points = curves.iter().enumerate().flat_map(|(at, curve)| curve.iter().map(move |point| (at, point)));
            for (place, (stretch, point)) in points.enumerate() {
                let local = turned(point.local, sine, cosine);
                let row = self.outline_row([number as usize, place, stretch].map(|index| index + 1), point, local);
                for (column, cell) in columns.iter_mut().zip(row) {
                    column.push(cell).map_err(|cell| Failure::new(format!("`{cell}` does not fit its column")))?;
                }
            }
        }
        Ok(())
    }

    fn outline_row(&self, numbers: [usize; 3], point: &Point, local: Local) -> Row {
        let segment = &self.outline.segments[point.segment];
        let [x, y] = local.position;
        let mut row: Row = vec![self.side.name().into()];
        row.extend(numbers.map(Into::into));
        row.extend([segment.part.name(), segment.curve.name()].map(Into::into));
        let values = [
            in_unit(libm::hypot(x, y), "mm"),
            in_unit(libm::atan2(-x, y), "deg"),
            in_unit(x, "mm"),
            in_unit(y, "mm"),
            in_unit(libm::atan2(local.tangent[1], local.tangent[0]), "deg"),
            in_unit(finite(local.curvature), "1/mm"),
        ];
        row.extend(values.map(Into::into));
        row
    }

    #[must_use]
    pub fn junction_rows(&self) -> Vec<JunctionRow<'_>> {
        (1..)
            .zip(self.outline.junctions())
            .map(|(number, junction)| JunctionRow { drawn: self, number, junction })
            .collect()
    }
}

/// Where two curves of a gear meet.
pub struct JunctionRow<'a> {
    drawn: &'a Drawn,
    /// From 1.
    number: usize,
    junction: Junction,
}

impl JunctionRow<'_> {
    /// Part and curve of the segments that end and begin.
    fn names(&self) -> [String; 2] {
        let segments = &self.drawn.outline.segments;
        let last = segments.len() - 1;
        let meeting = match self.junction.place {
            Place::Space => [0, 0],
            Place::Behind(at) => [at, at + 1],
            Place::Centreline => [last, last],
        };
        meeting.map(|at| format!("{} {}", segments[at].part.name(), segments[at].curve.name()))
    }
}

fn turned(local: Local, sine: f64, cosine: f64) -> Local {
    let turn = |[x, y]: [f64; 2]| [cosine * x - sine * y, sine * x + cosine * y];
    Local { position: turn(local.position), tangent: turn(local.tangent), ..local }
}

/// The outlines of gears, so many teeth of each; `begin` is told the share that is done, tooth by tooth, and may end it.
///
/// # Errors
/// Those of `begin`.
pub fn outline_columns(
    gears: &[Drawn],
    density: Density,
    teeth: impl Fn(&Drawn) -> u32,
    mut begin: impl FnMut(f64) -> Result<(), Failure>,
) -> Result<Vec<Data>, Failure> {
    let rows = gears.iter().map(|drawn| drawn.outline_rows(density, teeth(drawn))).sum();
    let room = |column: &Column| Data::with_room(column.kind, rows);
    let mut columns: Vec<Data> = outline_schema().columns.iter().map(room).collect();
    // In the order of the table, which need not be sorted then.
    let mut sorted: Vec<&Drawn> = gears.iter().collect();
    sorted.sort_by_key(|drawn| drawn.side.name());
    let all: u32 = gears.iter().map(&teeth).sum();
    let mut done = 0_u32;
    for drawn in sorted {
        drawn.outline(density, teeth(drawn), &mut columns, &mut || {
            done += 1;
            begin(f64::from(done - 1) / f64::from(all))
        })?;
    }
    Ok(columns)
}

#[must_use]
pub fn junctions<'a>() -> Columns<JunctionRow<'a>> {
    let description =
        "Where the curves of the right half of a tooth meet, from the middle of the space to the tooth's centreline.";
    let number = "Number, upwards; the first is in the middle of the space, the last on the tooth's centreline.";
    let angle = "Polar angle from the tooth's centreline, counterclockwise.";
    let turn = "By how much the direction turns there, to the left.";
    let curvature = |column: Column| column.allows_nan().tolerance(1e-6, 1e-6);
    of_gear(Columns::new("junctions", description), |row: &JunctionRow| row.drawn.side)
        .integer("junction", number, |row| row.number)
        .key()
        .text("before", "Part and curve that end.", |row| {
            let [before, _] = row.names();
            before
        })
        .text("after", "Part and curve that begin.", |row| {
            let [_, after] = row.names();
            after
        })
        .float("radius", "mm", "Distance from the gear's centre.", |row| {
            let [x, y] = row.junction.after.position;
            libm::hypot(x, y)
        })
        .float("angle", "deg", angle, |row| {
            let [x, y] = row.junction.after.position;
            libm::atan2(-x, y)
        })
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("position_jump", "um", "How far the two curves are apart.", |row| row.junction.position_jump())
        .but(|column| column.tolerance(1e-9, 1e-6))
        .float("tangent_jump", "deg", turn, |row| row.junction.tangent_jump())
        .but(|column| column.tolerance(1e-5, 1e-6))
        .float("curvature_before", "1/mm", "Curvature below; NaN where it is infinite.", |row| {
            finite(row.junction.before.curvature)
        })
        .but(curvature)
        .float("curvature_after", "1/mm", "Curvature above; NaN where it is infinite.", |row| {
            finite(row.junction.after.curvature)
        })
        .but(curvature)
        .on_demand()
}
