//! A comparison as one HTML page that needs no other file, in the style of the report.
//!
//! Must not know: where the page goes. The template escapes every text.

use minijinja::Environment;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use serde::Serialize;

use super::model::{Comparison, Difference, Flip, StageDiff, StudyDiff, TableDiff};
use super::words;
use crate::page;

#[derive(Serialize)]
struct View<'a> {
    comparison: &'a Comparison,
    verdict: String,
    damages: String,
    damaged: Vec<String>,
    flips: Vec<FlipView<'a>>,
    studies: Vec<StudyView<'a>>,
    /// The report's own, so that both look alike, and what is added here.
    styles: [&'static str; 2],
}

#[derive(Serialize)]
struct FlipView<'a> {
    flip: &'a Flip,
    sign: &'static str,
    change: String,
    what: String,
    numbers: String,
}

#[derive(Serialize)]
struct StudyView<'a> {
    study: &'a StudyDiff,
    sign: &'static str,
    sum: String,
    /// Of the study as a whole, and of stages that came out the same.
    remarks: Vec<String>,
    stages: Vec<StageView<'a>>,
    tables: Vec<TableView<'a>>,
}

#[derive(Serialize)]
struct StageView<'a> {
    stage: &'a StageDiff,
    sign: &'static str,
    word: String,
    why: Vec<String>,
}

#[derive(Serialize)]
struct TableView<'a> {
    table: &'a TableDiff,
    sign: &'static str,
    word: &'static str,
    rows: String,
    added: String,
    removed: String,
    /// Of sampled curves, in the place of columns and rows.
    curves: String,
    columns: Vec<[String; 6]>,
    worst: Vec<[String; 5]>,
}

/// # Errors
/// When the template cannot be filled, which is a mistake of this program.
pub fn page(comparison: &Comparison) -> Result<String, String> {
    let failed = |error: minijinja::Error| format!("the page could not be made: {error:#}");
    let mut environment = Environment::new();
    environment.set_syntax(SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).build().map_err(failed)?);
    environment.add_template("page.html", include_str!("page.html")).map_err(failed)?;
    let flips = comparison.verdicts.iter().map(|flip| FlipView {
        flip,
        sign: if flip.needs_attention { "!" } else { "≠" },
        change: words::flip(flip),
        what: words::entry(flip),
        numbers: words::numbers(flip),
    });
    let view = View {
        comparison,
        verdict: words::verdict(comparison),
        damages: words::damages(comparison),
        damaged: comparison.damaged.iter().map(words::damage).collect(),
        flips: flips.collect(),
        studies: comparison.studies.iter().map(study).collect(),
        styles: [page::STYLE, include_str!("page.css")],
    };
    environment.get_template("page.html").and_then(|template| template.render(Serde(view))).map_err(failed)
}

fn study(study: &StudyDiff) -> StudyView<'_> {
    let told = words::told(study);
    let changed = told.iter().filter(|stage| stage.state <= Difference::Changed);
    let tables = changed.flat_map(|stage| &stage.tables).filter(|table| table.state != Difference::Same);
    StudyView {
        study,
        sign: study.state.sign(),
        sum: words::sum(study),
        remarks: words::remarks(study).into_iter().chain(words::brief(study)).collect(),
        tables: tables.map(table).collect(),
        stages: told
            .iter()
            .map(|stage| StageView {
                stage,
                sign: stage.state.sign(),
                word: words::state(stage),
                why: words::reasons(&stage.why),
            })
            .collect(),
    }
}

fn table(table: &TableDiff) -> TableView<'_> {
    let by_rows = table.curves.is_none();
    let columns = table.columns.iter().filter(|_| by_rows).map(|column| {
        let (largest, relative) = (column.largest_absolute.as_ref(), column.largest_relative.as_ref());
        [
            words::column(&column.name, &column.unit),
            words::changed(column),
            largest.map_or_else(|| "–".to_owned(), |largest| words::difference(largest.difference)),
            column.shown().map_or_else(String::new, words::change),
            relative.map_or_else(|| "–".to_owned(), |largest| words::relative(largest.difference)),
            column.shown().map_or_else(String::new, |shown| words::key(&shown.key)),
        ]
    });
    let worst = table.worst.iter().filter(|_| by_rows).map(|worst| {
        let (before, after) = words::pair(&worst.before, &worst.after);
        let difference = worst.difference.map_or_else(|| "–".to_owned(), words::difference);
        [words::column(&worst.column, &worst.unit), before, after, difference, words::key(&worst.key)]
    });
    TableView {
        table,
        sign: table.state.sign(),
        word: table.state.word(),
        rows: words::rows(table),
        added: words::keys(&table.added, table.rows_added),
        removed: words::keys(&table.removed, table.rows_removed),
        curves: words::curves(table).unwrap_or_default(),
        columns: columns.collect(),
        worst: worst.collect(),
    }
}
