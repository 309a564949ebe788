//! The report of a study: the page and its figures as files, and the sentence that sums the verdicts up.
//!
//! Must not know: how anything is drawn, where and when files are written.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::format::plain;
use crate::report;
use crate::report::{comparison, text as as_text};
use studygraph::history::side::published;
use studygraph::store::cache::Cache;
use studygraph::store::manifest::Manifest;
use studygraph::store::results::{Drawn, FIGURES, Folder, MEASURED, PAGE, Tables};
use studygraph::table::data::{Data, Table};

/// Tables of a report that say what is found of the study.
pub(super) const REPORTED: [&str; 3] = ["verdict_counts", "verdicts", "comparisons"];

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
fn of_reports(manifest: &Manifest, tables: Tables<'_>, name: &str) -> Vec<Arc<Table>> {
    let reports = manifest.stages.iter().filter(|stage| stage.kind == "report");
    reports.filter_map(|stage| tables(&format!("{}.{name}", stage.name))).collect()
}

/// How many verdicts or comparisons there are of one word.
pub(super) struct Count {
    pub(super) verdict: String,
    pub(super) entries: i64,
    pub(super) needs_attention: bool,
}

/// What all reports of a study say together, by words.
#[derive(Default)]
pub(super) struct Counts {
    /// What needs attention first.
    pub(super) verdicts: Vec<Count>,
    /// Results beside others.
    pub(super) comparisons: Vec<Count>,
}

impl Counts {
    #[must_use]
    pub(super) fn of(manifest: &Manifest, tables: Tables<'_>) -> Self {
        Self { verdicts: verdict_counts(manifest, tables), comparisons: comparison_counts(manifest, tables) }
    }

    /// The number of verdicts and comparisons that somebody has to look at.
    #[must_use]
    pub(super) fn attention(&self) -> i64 {
        attention(&self.verdicts) + attention(&self.comparisons)
    }

    /// A sentence for verdicts and one for comparisons, where some need attention.
    #[must_use]
    pub(super) fn complaints(&self) -> Vec<String> {
        let both = [(attention(&self.verdicts), "verdict"), (attention(&self.comparisons), "comparison")];
        let some = both.into_iter().filter(|(count, _)| *count > 0);
        some.map(|(count, what)| match count {
            1 => format!("1 {what} needs attention"),
            _ => format!("{count} {what}s need attention"),
        })
        .collect()
    }

    /// One sentence about them; empty where there are none.
    #[must_use]
    pub(super) fn summary(&self) -> String {
        let both = [sentence(&self.verdicts, "verdict"), sentence(&self.comparisons, "comparison")];
        both.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("; ")
    }
}

fn attention(counts: &[Count]) -> i64 {
    counts.iter().filter(|count| count.needs_attention).map(|count| count.entries).sum()
}

fn comparison_counts(manifest: &Manifest, tables: Tables<'_>) -> Vec<Count> {
    let mut all: Vec<Count> = Vec::new();
    for table in of_reports(manifest, tables, "comparisons") {
        let Some(Data::Text(words)) = table.column("verdict") else { continue };
        for word in words {
            match all.iter_mut().find(|count| count.verdict == *word) {
                Some(count) => count.entries += 1,
                None => {
                    let needs_attention = comparison::needs_attention(word);
                    all.push(Count { verdict: word.clone(), entries: 1, needs_attention });
                }
            }
        }
    }
    all.sort_by_key(|count| !count.needs_attention);
    all
}

fn verdict_counts(manifest: &Manifest, tables: Tables<'_>) -> Vec<Count> {
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

fn sentence(counts: &[Count], what: &str) -> String {
    let parts: Vec<String> = counts
        .iter()
        .filter(|count| count.entries > 0)
        .map(|count| format!("{} {}", count.entries, count.verdict))
        .collect();
    match counts.iter().map(|count| count.entries).sum() {
        0 => String::new(),
        1 => format!("1 {what}: {}", parts.join(", ")),
        all => format!("{all} {what}s: {}", parts.join(", ")),
    }
}

/// The tables of a folder of results, for those who read it; from the cache where another run left its own there.
pub(super) fn read<'a>(
    folder: &'a Folder,
    manifest: &'a Manifest,
    cache: &'a Path,
) -> impl Fn(&str) -> Option<Arc<Table>> + 'a {
    |name| {
        let records = manifest.stages.iter().flat_map(|stage| stage.tables.iter().map(move |record| (stage, record)));
        let mut named = records.filter(|(_, record)| record.name == name);
        let open = || Cache::open_if_there(cache);
        named.find_map(|(stage, record)| published(folder, stage, record, &open).ok().map(Arc::new))
    }
}

/// The tables of verdicts and of comparisons of a run.
pub(super) fn verdict_tables(manifest: &Manifest, tables: Tables<'_>) -> [Vec<Arc<Table>>; 2] {
    ["verdicts", "comparisons"].map(|name| of_reports(manifest, tables, name))
}

/// The verdicts and comparisons of a run as text.
///
/// # Errors
/// When one of the tables is of another shape.
pub(super) fn verdicts(manifest: &Manifest, tables: Tables<'_>) -> Result<String, String> {
    let width = terminal_width();
    let [verdicts, comparisons] = verdict_tables(manifest, tables);
    let verdicts = verdicts.iter().filter(|table| table.rows() > 0).map(|table| as_text::verdicts(table, width));
    let comparisons = comparisons.iter().map(|table| as_text::comparisons(table, width));
    let shown = verdicts.chain(comparisons).map(|text| text.map_err(|error| error.to_string()));
    Ok(shown.collect::<Result<Vec<String>, String>>()?.concat())
}

/// Columns of the terminal; of a page of text where there is none.
pub(super) fn terminal_width() -> u16 {
    comfy_table::Table::new().width().unwrap_or(120)
}
