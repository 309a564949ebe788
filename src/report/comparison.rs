//! Results beside others, as the page says them, from the tables `comparisons` of report stages.
//!
//! Must not know: HTML, how they were found.

use serde::Serialize;

use super::verdict::{apart, percent};
use super::{ReportError, floats, integers, texts};
use declare::number::{significant, with_unit};
use studygraph::table::data::Table;

/// Whether somebody has to look at a comparison of this verdict.
#[must_use]
pub fn needs_attention(verdict: &str) -> bool {
    !["agrees", "explained", "stated"].contains(&verdict)
}

#[derive(Debug, Serialize)]
pub struct Row {
    pub label: String,
    pub cell: String,
    against: String,
    /// The row that is furthest apart.
    furthest: String,
    rows: i64,
    pub value: String,
    pub reference: String,
    pub relative: String,
    pub difference: String,
    pub tolerance: String,
    pub verdict: String,
    /// The class of a verdict on a published value that looks like it.
    class: &'static str,
    pub sign: &'static str,
    pub because: String,
    note: String,
}

impl Row {
    /// What needs attention comes first.
    #[must_use]
    pub fn rank(&self) -> usize {
        match self.class {
            "unexplained" => 0,
            "explained" => 1,
            _ => 2,
        }
    }
}

/// # Errors
/// When the table is of another shape.
pub fn rows(table: &Table) -> Result<Vec<Row>, ReportError> {
    let text = |name: &str| texts(table, name);
    let number = |name: &str| floats(table, name);
    let (labels, cells, against, places) = (text("label")?, text("cell")?, text("against")?, text("row")?);
    let (values, references, differences) = (number("value")?, number("reference")?, number("difference")?);
    let (relative, tolerances, counts) =
        (number("relative_difference")?, number("tolerance")?, integers(table, "rows")?);
    let (units, verdicts, because, note) = (text("unit")?, text("verdict")?, text("because")?, text("note")?);
    let one = |row: usize| {
        let said = |value: f64| with_unit(&significant(value, 5), &units[row]);
        let said_apart = |value: f64| apart(&significant(value, 5), &units[row]);
        let tolerance = tolerances[row];
        let is_nothing = differences[row].abs() < 1e-3 * tolerance;
        let (class, sign) = match verdicts[row].as_str() {
            "agrees" => ("reproduced", "✓"),
            "explained" => ("explained", "≠"),
            "stated" => ("stated", "±"),
            _ => ("unexplained", "!"),
        };
        Row {
            label: labels[row].clone(),
            cell: cells[row].clone(),
            against: against[row].clone(),
            furthest: places[row].clone(),
            rows: counts[row],
            value: said(values[row]),
            reference: said(references[row]),
            relative: if relative[row].is_nan() { String::new() } else { percent(relative[row]) },
            difference: said_apart(if is_nothing { 0.0 } else { differences[row] }),
            tolerance: if tolerance.is_nan() { String::new() } else { format!("± {}", said_apart(tolerance)) },
            verdict: verdicts[row].clone(),
            class,
            sign,
            because: because[row].clone(),
            note: note[row].clone(),
        }
    };
    Ok((0..table.rows()).map(one).collect())
}
