//! The small tables that are made of all samples.
//!
//! Must not know: how any of it is estimated.

use crate::stage::rows::Column as Field;
use gearmesh::numeric::indices::Indices;
use gearmesh::numeric::replicates::{Estimate, Share};
use studygraph::table::columns::Columns;
use studygraph::table::schema::Column;

/// What a row is about: an output where what is looked at in every sample has these values, as shown.
pub struct About<'a, T> {
    pub output: &'a str,
    pub case: &'a [f64],
    pub what: T,
}

fn about<'a, T: 'a>(name: &str, description: &str, crossed: &[&Field]) -> Columns<About<'a, T>> {
    let columns =
        Columns::new(name, description).text("output", "Column of the output.", |row: &About<'a, T>| row.output).key();
    crossed.iter().enumerate().fold(columns, |columns, (at, field)| {
        let description = format!("Value of `{}`.", field.axis.path);
        columns.shown(&field.axis.name, &field.axis.unit, &description, move |row| row.case[at]).key()
    })
}

/// What numbers of samples are compared by: other seeds are told by their own errors.
const LOOSE: (f64, f64) = (1e-12, 1e-6);

fn loose(column: Column) -> Column {
    column.tolerance(LOOSE.0, LOOSE.1).allows_nan()
}

/// Numbers of an output.
pub struct Statistics {
    pub valid: usize,
    pub mean: Estimate,
    pub deviation: Estimate,
    pub range: (f64, f64),
}

pub fn statistics<'a>(crossed: &[&Field]) -> Columns<About<'a, Statistics>> {
    about("statistics", "How each output scatters, in the unit of its column in the table `rows`.", crossed)
        .integer("samples", "Samples that have a number.", |row: &About<'a, Statistics>| row.what.valid)
        .shown("mean", "", "Their mean.", |row| row.what.mean.value)
        .but(loose)
        .shown("mean_error", "", "Standard error of the mean.", |row| row.what.mean.error)
        .but(loose)
        .shown("standard_deviation", "", "Their standard deviation.", |row| row.what.deviation.value)
        .but(loose)
        .shown("standard_deviation_error", "", "Standard error of that.", |row| row.what.deviation.error)
        .but(loose)
        .shown("minimum", "", "The smallest.", |row| row.what.range.0)
        .but(loose)
        .shown("maximum", "", "The largest.", |row| row.what.range.1)
        .but(loose)
}

/// A share, and the value below which it lies.
pub struct Quantile {
    pub share: f64,
    pub at: Estimate,
}

pub fn quantiles<'a>(crossed: &[&Field]) -> Columns<About<'a, Quantile>> {
    about("quantiles", "Below which value a share of the samples has an output.", crossed)
        .shown("share", "", "The share of the samples that have a number.", |row: &About<'a, Quantile>| row.what.share)
        .key()
        .shown("value", "", "The value, in the unit of the output.", |row| row.what.at.value)
        .but(loose)
        .shown("error", "", "Its standard error.", |row| row.what.at.error)
        .but(loose)
}

/// How many samples have an output between two values.
pub struct Bin {
    pub number: usize,
    pub from: f64,
    pub to: f64,
    pub count: usize,
}

pub fn distribution<'a>(crossed: &[&Field]) -> Columns<About<'a, Bin>> {
    let description = "How many samples have an output in each of equal steps between its extremes.";
    about("distribution", description, crossed)
        .integer("bin", "Counts the steps, from 1.", |row: &About<'a, Bin>| row.what.number)
        .key()
        .shown("from", "", "Where it begins, in the unit of the output.", |row| row.what.from)
        .but(loose)
        .shown("to", "", "Where it ends.", |row| row.what.to)
        .but(loose)
        .integer("samples", "How many samples are in it.", |row| row.what.count)
}

/// Indices of a field.
pub struct OfField<'a> {
    pub field: &'a str,
    pub indices: Indices,
    pub pairs: usize,
}

pub fn indices<'a>(crossed: &[&Field]) -> Columns<About<'a, OfField<'a>>> {
    let description = "Sobol' indices: how much of the variance of each output each field explains; NaN where nothing \
                       varies. No rows where fields are correlated.";
    let first = "Share of the variance that the field explains by itself.";
    let total = "Share of the variance that the field explains by itself and together with others.";
    about("indices", description, crossed)
        .text("field", "Column of the varied field.", |row: &About<'a, OfField<'a>>| row.what.field)
        .key()
        .shown("first_order", "", first, |row| row.what.indices.first.value)
        .but(loose)
        .shown("first_order_error", "", "Its standard error.", |row| row.what.indices.first.error)
        .but(loose)
        .shown("total", "", total, |row| row.what.indices.total.value)
        .but(loose)
        .shown("total_error", "", "Its standard error.", |row| row.what.indices.total.error)
        .but(loose)
        .integer("pairs", "Pairs of points of which all numbers are there.", |row| row.what.pairs)
}

/// How many samples keep to a limit.
pub struct YieldRow<'a> {
    pub limit: &'a str,
    /// 0 for all that is looked at in a sample; otherwise its number.
    pub number: usize,
    pub case: Vec<f64>,
    pub samples: usize,
    pub kept: usize,
    pub share: Share,
}

pub fn yields<'a>(crossed: &[&Field]) -> Columns<YieldRow<'a>> {
    let limit = "The limit; `valid` for samples that have numbers at all, `all limits` for those that keep to each.";
    let case = "0 for all that is looked at in every sample together; otherwise counts it, from 1.";
    let columns = Columns::new("yield", "How many samples keep to a limit; those without numbers do not.")
        .text("limit", limit, |row: &YieldRow<'a>| row.limit)
        .key()
        .integer("case", case, |row| row.number)
        .key();
    let columns = crossed.iter().enumerate().fold(columns, |columns, (at, field)| {
        let description = format!("Value of `{}`; NaN for all together.", field.axis.path);
        columns.shown(&field.axis.name, &field.axis.unit, &description, move |row| row.case[at]).but(Column::allows_nan)
    });
    columns
        .integer("samples", "How many samples there are.", |row| row.samples)
        .integer("kept", "How many of them keep to it.", |row| row.kept)
        .shown("yield", "", "Their share.", |row| row.share.share.value)
        .but(loose)
        .shown("standard_error", "", "Its standard error.", |row| row.share.share.error)
        .but(loose)
        .shown("low", "", "Lower end of Wilson's interval that has it with 95 %.", |row| row.share.low)
        .but(loose)
        .shown("high", "", "Upper end of it.", |row| row.share.high)
        .but(loose)
}

/// A field and how it is distributed.
pub struct FieldRow<'a> {
    pub field: &'a Field,
    pub described: String,
    /// Mean, standard deviation, and between which values it lies, as shown.
    pub numbers: [f64; 4],
}

pub fn fields<'a>() -> Columns<FieldRow<'a>> {
    let said = "How it is distributed, in the unit of its column; a class of tolerances as what it comes to.";
    Columns::new("fields", "The fields that scatter, in the units of their columns in the table `rows`.")
        .text("field", "Its column.", |row: &FieldRow<'a>| row.field.axis.name.clone())
        .key()
        .text("path", "The field.", |row| row.field.axis.path.clone())
        .text("distribution", said, |row| row.described.clone())
        .shown("mean", "", "Mean of the distribution.", |row| row.numbers[0])
        .shown("standard_deviation", "", "Its standard deviation.", |row| row.numbers[1])
        .shown("from", "", "The smallest value.", |row| row.numbers[2])
        .shown("to", "", "The largest value.", |row| row.numbers[3])
}
