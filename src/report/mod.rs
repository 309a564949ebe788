//! From a manifest and tables to what people read: one HTML page, figures, the verdicts on a terminal.
//!
//! Must not know: how anything was computed, and where tables are kept. The same tables give the same bytes, apart from
//! the section of the page about the run itself.

mod axes;
mod cells;
mod choice;
pub mod comparison;
mod data;
mod defaults;
mod drawing;
mod figure;
mod frame;
mod inputs;
mod isolines;
mod legend;
mod look;
mod marks;
mod order;
mod page;
mod palette;
mod plot;
mod records;
mod scale;
mod scattered;
mod shapes;
mod sheet;
mod spec;
mod spread;
mod svg;
mod sweep;
pub mod text;
mod thin;
mod vega;
mod verdict;
mod warnings;

use std::cell::RefCell;
use std::sync::Arc;

use figure::Figure;
use order::Order;
pub use page::SCRIPT;

use declare::number::{significant, with_unit};
use studygraph::store::manifest::{Manifest, StageRecord};
use studygraph::table::data::{Data, Table};

/// The kind of stage that says what is shown.
const REPORT: &str = "report";

/// A table by its full name, `stage.table`.
pub type Tables<'a> = &'a dyn Fn(&str) -> Option<Arc<Table>>;

/// What a run's results look like.
pub struct Rendered {
    /// One file that needs no other.
    pub html: String,
    pub figures: Vec<RenderedFigure>,
}

/// A figure as a file by itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenderedFigure {
    /// Without an ending.
    pub name: String,
    pub svg: String,
    /// The same as Vega-Lite.
    pub vega_lite: String,
    /// Whether it shows what differs from run to run.
    pub varies: bool,
}

/// Why there is no report.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReportError {
    #[error("table `{0}` is needed for the report, but is not among the results")]
    Missing(String),
    /// A table is not of the shape that this version writes.
    #[error("{0}; run the study again with this version")]
    Unfit(String),
    #[error("the page could not be made: {0}")]
    Page(String),
}

/// Makes the report; `tables` gives a table by its full name, `stage.table`.
///
/// # Errors
/// When a report stage's table, or one that a figure draws, is missing or of another shape.
pub fn render(manifest: &Manifest, tables: Tables<'_>) -> Result<Rendered, ReportError> {
    let manifest = &manifest.shown(REPORT);
    // Figures of one table follow each other: it is read and checked once.
    let last: RefCell<Option<(String, Arc<Table>)>> = RefCell::default();
    let tables = &|name: &str| {
        let mut last = last.borrow_mut();
        if last.as_ref().is_none_or(|(known, _)| known != name) {
            *last = Some((name.to_owned(), tables(name)?));
        }
        last.as_ref().map(|(_, table)| Arc::clone(table))
    };
    let stages: Vec<&StageRecord> = manifest.stages.iter().filter(|stage| stage.kind == REPORT).collect();
    let order = Order::of(manifest, tables);
    let mut parts = Vec::new();
    for stage in &stages {
        match part(&stage.name, &order, tables) {
            Ok(mut part) => {
                if stages.len() > 1 {
                    for figure in &mut part.figures {
                        figure.name = format!("{}-{}", stage.name, figure.name);
                    }
                }
                parts.push(part);
            }
            // What is left of an earlier run is shown where it can be; the page says that the stage did not finish.
            Err(_) if !stage.is_complete() => {}
            Err(error) => return Err(error),
        }
    }
    let mut figures: Vec<Figure> = parts.iter_mut().flat_map(|part| std::mem::take(&mut part.figures)).collect();
    if figures.is_empty() {
        figures = defaults::figures(manifest, &order, tables)?;
    }
    palette::assign(figures.iter_mut().map(|figure| &mut figure.plot));
    let html = page::html(manifest, &parts, &figures, tables)?;
    let figures = figures.iter().map(|figure| RenderedFigure {
        name: figure.name.clone(),
        svg: figure.plot.file(),
        vega_lite: figure.plot.vega_lite(),
        varies: figure.varies,
    });
    Ok(Rendered { html, figures: figures.collect() })
}

fn part(stage: &str, order: &Order, tables: Tables<'_>) -> Result<page::ReportPart, ReportError> {
    let table = |name: &str| {
        let name = format!("{stage}.{name}");
        tables(&name).ok_or(ReportError::Missing(name))
    };
    let figures = figure::figures(&*table("figures")?, &*table("figure_published")?, order, tables)?;
    let (verdicts, counts) = (table("verdicts")?, table("verdict_counts")?);
    let comparisons = comparison::rows(&*table("comparisons")?)?;
    Ok(page::ReportPart { stage: stage.to_owned(), verdicts, counts, comparisons, figures })
}

fn column<'a>(table: &'a Table, name: &str) -> Result<&'a Data, ReportError> {
    table.column(name).ok_or_else(|| ReportError::Unfit(format!("table `{}` has no column `{name}`", table.name())))
}

fn wrong_type(table: &Table, name: &str) -> ReportError {
    ReportError::Unfit(format!("column `{name}` of table `{}` is of another type", table.name()))
}

fn texts<'a>(table: &'a Table, name: &str) -> Result<&'a [String], ReportError> {
    match column(table, name)? {
        Data::Text(values) => Ok(values),
        _ => Err(wrong_type(table, name)),
    }
}

fn floats<'a>(table: &'a Table, name: &str) -> Result<&'a [f64], ReportError> {
    match column(table, name)? {
        Data::Float(values) => Ok(values),
        _ => Err(wrong_type(table, name)),
    }
}

fn integers<'a>(table: &'a Table, name: &str) -> Result<&'a [i64], ReportError> {
    match column(table, name)? {
        Data::Integer(values) => Ok(values),
        _ => Err(wrong_type(table, name)),
    }
}

fn flags<'a>(table: &'a Table, name: &str) -> Result<&'a [bool], ReportError> {
    match column(table, name)? {
        Data::Flag(values) => Ok(values),
        _ => Err(wrong_type(table, name)),
    }
}

/// A time as pages write it.
fn seconds(seconds: f64) -> String {
    if seconds < 0.1 {
        with_unit(&significant(1e3 * seconds, 3), "ms")
    } else {
        with_unit(&significant(seconds, 3), "s")
    }
}
