//! The report of a study: the page and its figures as files, and the sentence that sums the verdicts up.
//!
//! Must not know: how anything is drawn, where and when files are written.

use std::path::PathBuf;

use super::progress::plain;
use crate::report;
use crate::report::text as as_text;
use studygraph::store::manifest::Manifest;
use studygraph::store::results::{Drawn, FIGURES, Folder, MEASURED, PAGE, Tables};
use studygraph::table::data::{Data, Table};

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

/// How many verdicts there are of one word.
pub(super) struct Count {
    pub(super) verdict: String,
    pub(super) entries: i64,
    pub(super) needs_attention: bool,
}

/// How many verdicts there are of each word, of all reports together; what needs attention first.
pub(super) fn counts(manifest: &Manifest, tables: Tables<'_>) -> Vec<Count> {
    let mut all: Vec<Count> = Vec::new();
    for table in of_reports(manifest, tables, "verdict_counts") {
        let columns = ["verdict", "count", "needs_attention"].map(|name| table.column(name));
        let [Some(Data::Text(words)), Some(Data::Integer(entries)), Some(Data::Flag(attention))] = columns else {
            continue;
        };
        for ((word, &entries), &needs_attention) in words.iter().zip(entries).zip(attention) {
            match all.iter_mut().find(|count| count.verdict == *word) {
                Some(count) => count.entries += entries,
                None => all.push(Count { verdict: word.clone(), entries, needs_attention }),
            }
        }
    }
    all
}

/// The number of verdicts that somebody has to look at.
pub(super) fn attention(counts: &[Count]) -> i64 {
    counts.iter().filter(|count| count.needs_attention).map(|count| count.entries).sum()
}

/// One sentence about the verdicts; empty where there are none.
pub(super) fn summary(counts: &[Count]) -> String {
    let parts: Vec<String> = counts
        .iter()
        .filter(|count| count.entries > 0)
        .map(|count| format!("{} {}", count.entries, count.verdict))
        .collect();
    match counts.iter().map(|count| count.entries).sum() {
        0 => String::new(),
        1 => format!("1 verdict: {}", parts.join(", ")),
        all => format!("{all} verdicts: {}", parts.join(", ")),
    }
}

/// The tables of a folder of results, for those who read it.
pub(super) fn read<'a>(folder: &'a Folder, manifest: &'a Manifest) -> impl Fn(&str) -> Option<Table> + 'a {
    |name| {
        let records = manifest.stages.iter().flat_map(|stage| &stage.tables);
        records.filter(|record| record.name == name).find_map(|record| folder.table(record).ok())
    }
}

/// The tables of verdicts of a run.
pub(super) fn verdict_tables(manifest: &Manifest, tables: Tables<'_>) -> Vec<Table> {
    of_reports(manifest, tables, "verdicts")
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
