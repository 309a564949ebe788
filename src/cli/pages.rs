//! The report of a study: the page and its figures as files, and the sentence that sums the verdicts up.
//!
//! Must not know: how anything is drawn, where and when files are written.

use std::path::PathBuf;

use super::progress::plain;
use crate::report;
use crate::report::text as as_text;
use studygraph::store::manifest::Manifest;
use studygraph::store::results::{Drawn, FIGURES, Folder, MEASURED, PAGE, Tables};
use studygraph::table::data::Table;

#[must_use]
pub(super) fn path(folder: &Folder) -> PathBuf {
    folder.path().join(PAGE)
}

/// Page and figures of a run.
///
/// # Errors
/// When a table is missing or of another shape.
pub(super) fn draw(manifest: &Manifest, tables: Tables<'_>) -> Result<Vec<Drawn>, String> {
    let rendered = report::render(manifest, tables).map_err(|error| error.to_string())?;
    let figures = rendered.figures.into_iter().flat_map(|figure| {
        let folder = if figure.varies { MEASURED } else { FIGURES };
        let drawn = |ending: &str, text: String| Drawn {
            file: format!("{folder}/{}.{ending}", figure.name),
            bytes: text.into_bytes(),
            varies: figure.varies,
        };
        [drawn("svg", figure.svg), drawn("vl.json", figure.vega_lite)]
    });
    let html = plain(&rendered.html).into_owned() + "\n";
    // It ends with the facts of the run.
    let page = Drawn { file: PAGE.to_owned(), bytes: html.into_bytes(), varies: true };
    Ok(figures.chain([page]).collect())
}

/// The tables of this name that report stages gave.
fn of_reports(manifest: &Manifest, tables: Tables<'_>, name: &str) -> Vec<Table> {
    let reports = manifest.stages.iter().filter(|stage| stage.kind == "report");
    reports.filter_map(|stage| tables(&format!("{}.{name}", stage.name))).collect()
}

/// One sentence about the verdicts; empty where there are none.
pub(super) fn summary(manifest: &Manifest, tables: Tables<'_>) -> String {
    let mut parts = Vec::new();
    let mut all = 0;
    for counts in of_reports(manifest, tables, "verdict_counts") {
        for (word, count) in counts.texts("verdict").iter().zip(counts.integers("count")) {
            all += count;
            if *count > 0 {
                parts.push(format!("{count} {word}"));
            }
        }
    }
    match all {
        0 => String::new(),
        1 => format!("1 verdict: {}", parts.join(", ")),
        all => format!("{all} verdicts: {}", parts.join(", ")),
    }
}

/// The verdicts of a run as text.
///
/// # Errors
/// When the table of verdicts is not one.
pub(super) fn verdicts(manifest: &Manifest, tables: Tables<'_>) -> Result<String, String> {
    let width = terminal_width();
    let tables = of_reports(manifest, tables, "verdicts");
    let shown: Result<Vec<String>, String> =
        tables.iter().map(|table| as_text::verdicts(table, width).map_err(|error| error.to_string())).collect();
    Ok(shown?.concat())
}

/// Columns of the terminal; of a page of text where there is none.
pub(super) fn terminal_width() -> u16 {
    comfy_table::Table::new().width().unwrap_or(120)
}
