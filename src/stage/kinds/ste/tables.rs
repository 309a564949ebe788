//! The tables of a stage of the kind `ste`: columns and rows.
//!
//! Must not know: how a curve is found.

use super::Answer;
use declare::units::showing;
use gearmesh::gear::transmission_error::curve::Point;
use studygraph::table::columns::Columns;
use studygraph::table::data::Data;
use studygraph::table::schema::{Column, Schema};

/// Design, torque, and what they gave.
pub type Keyed<'a, T = &'a Answer> = (&'a str, f64, T);

/// The columns that say which curve a row is of.
pub fn keyed<'a, T>(name: &str, description: &str) -> Columns<Keyed<'a, T>> {
    Columns::new(name, description)
        .text("design", "Name of the design.", |row: &Keyed<'a, T>| row.0)
        .key()
        .float("torque", "N m", "Torque on the pinion.", |row| row.1)
        .key()
}

/// The same where a table is put together in another way.
pub fn keys() -> Vec<Column> {
    keyed::<()>("", "").schema().columns
}

pub fn summary<'a>() -> Columns<Keyed<'a>> {
    let mean = "Integral mean of the transmission error over the mesh cycle.";
    let variance = "Integral mean of the squared deviation from the mean.";
    let reciprocal = "f = 1/variance (mei2016, equation 16); NaN where nothing varies.";
    let slices = "Slices that were used on each stretch of the face without a closed form.";
    let error = "Estimated relative error of the peak-to-peak from positions and slices.";
    keyed("summary", "What each curve of the transmission error amounts to.")
        .float("mean", "um", mean, |row: &Keyed| row.2.summary.mean)
        .float("peak_to_peak", "um", "Largest less smallest transmission error.", |row| row.2.summary.peak_to_peak)
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("maximum", "um", "Largest transmission error.", |row| row.2.summary.largest.value)
        .float("minimum", "um", "Smallest transmission error.", |row| row.2.summary.smallest.value)
        .float("variance", "um^2", variance, |row| row.2.summary.variance)
        .but(|column| column.tolerance(1e-15, 1e-9))
        .float("reciprocal_variance", "1/um^2", reciprocal, |row| row.2.summary.reciprocal_variance.unwrap_or(f64::NAN))
        .but(|column| column.allows_nan().tolerance(0.0, 1e-8))
        .float("unloaded_peak_to_peak", "um", "The same without load.", |row| row.2.summary.unloaded_peak_to_peak)
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("loaded_contact_ratio", "", "Mean number of pairs that carry load.", |row| {
            row.2.summary.loaded_contact_ratio
        })
        .float("largest_load_share", "", "Largest share of the load on one pair.", |row| {
            row.2.summary.largest_load_share
        })
        .float("largest_pressure", "MPa", "Largest Hertzian pressure in the mesh cycle.", |row| {
            row.2.summary.largest_pressure.map_or(f64::NAN, |largest| largest.value)
        })
        .but(Column::on_demand)
        .integer("positions", "Positions per base pitch that were used.", |row| row.2.settings.positions)
        .integer("slices", slices, |row| row.2.settings.slices)
        .float("error_estimate", "", error, |row| row.2.error)
        .but(|column| column.tolerance(1e-9, 0.0))
}

/// By itself, since a table with measured times differs from run to run.
pub fn cost<'a>() -> Columns<Keyed<'a>> {
    keyed("cost", "Error of each curve against the time it took.")
        .float("peak_to_peak", "um", "As in the table `summary`.", |row: &Keyed| row.2.summary.peak_to_peak)
        .but(|column| column.tolerance(1e-12, 1e-9))
        .integer("positions", "As in the table `summary`.", |row| row.2.settings.positions)
        .integer("slices", "As in the table `summary`.", |row| row.2.settings.slices)
        .float("error_estimate", "", "As in the table `summary`.", |row| row.2.error)
        .but(|column| column.tolerance(1e-9, 0.0))
        .float("seconds", "s", "Time for this row.", |row| row.2.seconds)
        .but(Column::volatile)
        .on_demand()
}

pub fn curve_schema() -> Schema {
    let mut columns = keys();
    columns.extend([
        Column::integer("point", "Counts the positions, from 1; those of the extrema are among them.").key(),
        Column::float("cycle_position", "mm", "Distance from where a pair starts contact, along the line of action.")
            .tolerance(1e-9, 1e-9),
        Column::float("roll_angle", "deg", "The pinion's roll angle at the newest pair."),
        Column::integer("pairs", "Pairs inside the path of contact."),
        Column::integer("loaded_pairs", "Pairs that carry load."),
        Column::float("transmission_error", "um", "Approach of the gears along the line of action."),
        Column::float("unloaded_transmission_error", "um", "The same without load.").tolerance(1e-12, 1e-9),
        Column::float("newest_load_share", "", "Share of the load on the pair that came into contact last.")
            .tolerance(1e-12, 1e-9),
        Column::float(
            "secant_stiffness",
            "N/m",
            "Load over loaded less unloaded transmission error; NaN without load.",
        )
        .allows_nan(),
        Column::float("tangent_stiffness", "N/m", "Slope of load over transmission error; NaN without load.")
            // Where a corner begins to touch, the slope goes with the square root of how far it is in.
            .tolerance(0.0, 1e-5)
            .allows_nan(),
        Column::float("pressure", "MPa", "Largest Hertzian pressure of any pair.").on_demand(),
    ]);
    Schema::new(
        "curve",
        "Transmission error over one mesh cycle, with its extrema. Where the number of pairs changes there are two rows, one \
         for each side.",
        columns,
    )
}

pub fn harmonics_schema() -> Schema {
    let mut columns = keys();
    columns.extend([
        Column::integer("order", "Multiple of the mesh frequency.").key(),
        Column::float("amplitude", "um", "Amplitude of the transmission error.").tolerance(1e-12, 1e-9),
    ]);
    Schema::new("harmonics", "Harmonics of the transmission error.", columns)
}

/// By columns, not rows: curves are by far the longest tables. In the order of the keys, or the table sorts every row.
pub fn curve_columns(answers: &[Keyed], pressure: bool) -> Vec<Data> {
    let points = || answers.iter().flat_map(|(.., answer)| &answer.points);
    let rows = answers.iter().map(|(.., answer)| answer.points.len()).sum();
    let shown = |unit: &str, value: fn(&Point) -> f64| {
        let show = showing(unit);
        let mut values = Vec::with_capacity(rows);
        values.extend(points().map(|point| show(value(point))));
        Data::Float(values)
    };
    let counted = |value: fn(usize, &Point) -> usize| {
        let counts = answers.iter().flat_map(|(.., answer)| answer.points.iter().enumerate());
        let mut values = Vec::with_capacity(rows);
        values.extend(counts.map(|(index, point)| i64::try_from(value(index, point)).unwrap_or(i64::MAX)));
        Data::Integer(values)
    };
    let [designs, torques] = key_columns(answers, |answer| answer.points.len());
    let mut columns = vec![
        designs,
        torques,
        counted(|index, _| index + 1),
        shown("mm", |point| point.cycle_position),
        shown("deg", |point| point.roll_angle),
        counted(|_, point| point.pairs),
        counted(|_, point| point.loaded_pairs),
        shown("um", |point| point.transmission_error),
        shown("um", |point| point.unloaded_transmission_error),
        shown("", |point| {
            let load = point.load();
            if load > 0.0 { point.newest_load / load } else { 0.0 }
        }),
        shown("N/m", |point| point.secant_stiffness),
        shown("N/m", |point| point.tangent_stiffness),
    ];
    if pressure {
        columns.push(shown("MPa", |point| point.pressure.unwrap_or(f64::NAN)));
    }
    columns
}

/// By columns, as the curves.
pub fn harmonics_columns(answers: &[Keyed]) -> Vec<Data> {
    let [designs, torques] = key_columns(answers, |answer| answer.summary.harmonics.len());
    let harmonics = || answers.iter().flat_map(|(.., answer)| answer.summary.harmonics.iter().zip(1..));
    let show = showing("um");
    vec![
        designs,
        torques,
        Data::Integer(harmonics().map(|(_, order)| order).collect()),
        Data::Float(harmonics().map(|(amplitude, _)| show(*amplitude)).collect()),
    ]
}

/// Design and torque of every row, where each answer has so many.
fn key_columns(answers: &[Keyed], rows: fn(&Answer) -> usize) -> [Data; 2] {
    let room = answers.iter().map(|(.., answer)| rows(answer)).sum();
    let (mut designs, mut torques) = (Vec::with_capacity(room), Vec::with_capacity(room));
    for (design, torque, answer) in answers {
        designs.extend(std::iter::repeat_n(*design, rows(answer)).map(str::to_owned));
        torques.extend(std::iter::repeat_n(*torque, rows(answer)));
    }
    [Data::Text(designs), Data::Float(torques)]
}
