//! The small tables that are made of all rows.
//!
//! Must not know: how any of it is counted.

use super::Sweep;
use studygraph::table::columns::Columns;
use studygraph::table::schema::Column;

/// Shares of the rows below the quantiles of an output.
pub const QUANTILES: [f64; 7] = [0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0];

/// One of the best rows: its fields and its outputs as shown.
pub struct BestRow {
    pub rank: usize,
    pub values: Vec<f64>,
}

pub fn best(sweep: &Sweep) -> Columns<BestRow> {
    let by = &sweep.asked.outputs[sweep.objective].column.name;
    let columns = Columns::new("best", &format!("The rows with the smallest `{by}`."))
        .integer("rank", "Counts them, from 1, the smallest first.", |row: &BestRow| row.rank)
        .key();
    let fields = sweep.layout.columns.iter().map(|column| {
        (column.axis.name.clone(), column.axis.unit.clone(), format!("Value of `{}`.", column.axis.path), None)
    });
    let outputs = sweep.asked.outputs.iter().map(|output| {
        let Column { name, unit, description, tolerance, .. } = output.column.clone();
        (name, unit, description, Some(tolerance))
    });
    fields.chain(outputs).enumerate().fold(columns, |columns, (at, (name, unit, description, tolerance))| {
        let columns = columns.shown(&name, &unit, &description, move |row| row.values[at]);
        columns.but(|column| match tolerance {
            // Of rows that are nearly alike another one may come first.
            Some(tolerance) => Column { tolerance, allows_nan: true, ..column },
            None => column,
        })
    })
}

/// An output where a field has a value.
pub struct EffectRow<'a> {
    pub field: &'a str,
    pub value: f64,
    pub output: &'a str,
    pub count: u64,
    pub mean: f64,
    pub deviation: f64,
    pub quantiles: [f64; QUANTILES.len()],
}

const QUANTILE_COLUMNS: [(&str, &str); QUANTILES.len()] = [
    ("minimum", "The smallest."),
    ("quantile_5", "Of these rows 5 % are below; right to 1/1024 of their range."),
    ("quantile_25", "Of these rows 25 % are below."),
    ("median", "Half of these rows are below."),
    ("quantile_75", "Of these rows 75 % are below."),
    ("quantile_95", "Of these rows 95 % are below."),
    ("maximum", "The largest."),
];

pub fn effects<'a>() -> Columns<EffectRow<'a>> {
    let description = "Main effects: each output over each value of each varied field, whatever the others are. Numbers are \
                       in the units of their columns in the table `rows`.";
    let value =
        "Its value; of a field that is drawn, or has very many values, the middle of one of up to twenty equal strata.";
    let columns = Columns::new("effects", description)
        .text("field", "Column of the varied field.", |row: &EffectRow<'a>| row.field)
        .key()
        .shown("value", "", value, |row| row.value)
        .key()
        .text("output", "Column of the output.", |row| row.output)
        .key()
        .integer("rows", "How many valid rows there are.", |row| row.count)
        .shown("mean", "", "Their mean.", |row| row.mean)
        .shown("standard_deviation", "", "Root of their mean squared deviation from it.", |row| row.deviation)
        .but(|column| column.tolerance(1e-12, 1e-6));
    QUANTILE_COLUMNS.iter().enumerate().fold(columns, |columns, (at, (name, description))| {
        columns.shown(name, "", description, move |row| row.quantiles[at]).but(|column| column.tolerance(1e-12, 1e-3))
    })
}

/// How much of the variance of an output a field explains by itself.
pub struct Share<'a> {
    pub field: &'a str,
    pub output: &'a str,
    pub explained: f64,
}

pub fn shares<'a>() -> Columns<Share<'a>> {
    let description =
        "How much of the variance of each output each field explains by itself (first-order sensitivity).";
    let share = "Variance of the means over the field's values, over the variance of all rows; NaN where nothing varies. Of \
                 drawn designs corrected for chance, so that it may be a little below 0.";
    Columns::new("sensitivity", description)
        .text("field", "Column of the varied field.", |row: &Share<'a>| row.field)
        .key()
        .text("output", "Column of the output.", |row| row.output)
        .key()
        .shown("share", "", share, |row| row.explained)
        .but(|column| column.allows_nan().tolerance(1e-9, 1e-6))
}

/// The objective where two fields have their values.
pub struct MapCell<'a> {
    pub output: &'a str,
    pub fields: [&'a str; 2],
    pub values: [f64; 2],
    pub count: u64,
    pub mean: f64,
    pub low: f64,
}

pub fn maps<'a>() -> Columns<MapCell<'a>> {
    let description = "The output that is to be small over each two fields that have up to 40 values or strata.";
    Columns::new("map", description)
        .text("output", "Column of the output.", |row: &MapCell<'a>| row.output)
        .key()
        .text("first", "Column of the first field.", |row| row.fields[0])
        .key()
        .text("second", "Column of the second field.", |row| row.fields[1])
        .key()
        .shown("first_value", "", "Value of the first field, in its unit.", |row| row.values[0])
        .key()
        .shown("second_value", "", "Value of the second field, in its unit.", |row| row.values[1])
        .key()
        .integer("rows", "How many valid rows there are.", |row| row.count)
        .shown("mean", "", "Mean of the output, in its unit.", |row| row.mean)
        .shown("minimum", "", "The smallest that the other fields leave.", |row| row.low)
}

/// How many rows have an output between two values.
pub struct Bin<'a> {
    pub output: &'a str,
    pub number: usize,
    pub from: f64,
    pub to: f64,
    pub count: u64,
}

pub fn distribution<'a>() -> Columns<Bin<'a>> {
    Columns::new("distribution", "How many rows have an output in each of 32 equal steps between its extremes.")
        .text("output", "Column of the output.", |row: &Bin<'a>| row.output)
        .key()
        .integer("bin", "Counts the steps, from 1.", |row| row.number)
        .key()
        .shown("from", "", "Where it begins, in the unit of the output.", |row| row.from)
        .but(|column| column.tolerance(1e-12, 1e-6))
        .shown("to", "", "Where it ends.", |row| row.to)
        .but(|column| column.tolerance(1e-12, 1e-6))
        .integer("rows", "How many rows are in it.", |row| row.count)
}

/// Below which value a share of the rows is.
pub struct Quantile<'a> {
    pub output: &'a str,
    pub share: f64,
    pub at: f64,
}

pub fn quantiles<'a>() -> Columns<Quantile<'a>> {
    let value = "The value, in the unit of the output; right to 1/1024 of its range.";
    Columns::new("quantiles", "Below which value a share of the rows has an output.")
        .text("output", "Column of the output.", |row: &Quantile<'a>| row.output)
        .key()
        .shown("share", "", "The share of the rows.", |row| row.share)
        .key()
        .shown("value", "", value, |row| row.at)
        .but(|column| column.tolerance(1e-12, 1e-3))
}
