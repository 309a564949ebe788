//! The page: what stands on it, put into words and handed to the template, which escapes every text.
//!
//! Must not know: how a figure is drawn. Everything that differs from run to run stands behind the template's last mark.

use std::collections::BTreeMap;

use minijinja::Environment;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use serde::Serialize;

use super::choice::{self, Choice};
use super::figure::Figure;
use super::{ReportError, flags, integers, plot, seconds, texts, verdict};
use declare::number::{significant, unit_symbol};
use studygraph::store::bundle;
use studygraph::store::manifest::{Manifest, OmissionRecord, StageRecord, TableRecord};
use studygraph::table::data::{Data, Table};

/// Rows of a table shown on the page.
const SHOWN_ROWS: usize = 8;

/// Stages of a kind shown on the page where there are more than their tables have files for.
const SHOWN_STAGES: usize = 8;

/// What one report stage contributes.
pub struct ReportPart {
    pub stage: String,
    pub verdicts: Table,
    pub counts: Table,
    pub figures: Vec<Figure>,
}

/// Everything the template can name.
#[derive(Serialize)]
struct View<'a> {
    /// Without stages and files.
    manifest: Manifest,
    counts: Vec<Count>,
    total: i64,
    attention: i64,
    parts: Vec<PartView>,
    /// Whether a figure shows what differs from run to run.
    varies: bool,
    choices: Vec<Choice>,
    left_out: Vec<Remark>,
    warnings: Vec<Remark>,
    failures: Vec<&'a StageRecord>,
    stages: Vec<StageView<'a>>,
    /// Of kinds with very many stages, those that are not shown.
    more: Vec<More>,
    tables: Vec<TableView<'a>>,
    seconds: String,
    style: &'static str,
    plot_style: &'static str,
    script: &'static str,
}

#[derive(Serialize)]
struct Count {
    verdict: String,
    entries: i64,
    sign: &'static str,
    needs_attention: bool,
    meaning: String,
}

#[derive(Serialize)]
struct PartView {
    stage: String,
    rows: Vec<verdict::Row>,
    figures: Vec<FigureView>,
}

#[derive(Serialize)]
struct FigureView {
    name: String,
    title: String,
    note: String,
    tables: String,
    /// Made by `plot`, which escapes what it is given.
    svg: String,
    varies: bool,
}

#[derive(Serialize)]
struct Remark {
    stage: String,
    what: String,
    why: String,
    saved: String,
}

#[derive(Serialize)]
struct More {
    kind: String,
    stages: usize,
}

#[derive(Serialize)]
struct StageView<'a> {
    record: &'a StageRecord,
    seconds: String,
    work: String,
    rows: usize,
    key: String,
}

#[derive(Serialize)]
struct TableView<'a> {
    record: &'a TableRecord,
    name: String,
    /// How many stages have such a table, all of them here.
    stages: usize,
    count: usize,
    content: String,
    columns: Vec<ColumnView<'a>>,
    rows: Vec<Vec<String>>,
    is_stored: bool,
}

#[derive(Serialize)]
struct ColumnView<'a> {
    name: &'a str,
    unit: String,
    description: &'a str,
    key: bool,
    volatile: bool,
    is_number: bool,
}

/// # Errors
/// When a table is of another shape.
pub fn html(
    manifest: &Manifest,
    parts: &[ReportPart],
    tables: &dyn Fn(&str) -> Option<Table>,
) -> Result<String, ReportError> {
    let failed = |error: minijinja::Error| ReportError::Page(format!("{error:#}"));
    let mut environment = Environment::new();
    environment.set_syntax(SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).build().map_err(failed)?);
    environment.add_template("page.html", include_str!("page.html")).map_err(failed)?;
    let counts = counts(parts)?;
    let total: i64 = counts.iter().map(|count| count.entries).sum();
    let attention: i64 = counts.iter().filter(|count| count.needs_attention).map(|count| count.entries).sum();
    let (shown, more) = shown_stages(manifest);
    let all: Vec<&StageRecord> = manifest.stages.iter().collect();
    let remarks = |stages: &[&StageRecord], pick: fn(&StageRecord) -> Vec<(String, String, String)>| -> Vec<Remark> {
        let of = |stage: &StageRecord| {
            let name = stage.name.clone();
            pick(stage).into_iter().map(move |(what, why, saved)| Remark { stage: name.clone(), what, why, saved })
        };
        stages.iter().copied().flat_map(of).collect()
    };
    let left_out = remarks(&shown, |stage| {
        let saved = |left: &OmissionRecord| left.saved_seconds.map_or_else(String::new, seconds);
        stage.left_out.iter().map(|left| (left.what.clone(), left.why.clone(), saved(left))).collect()
    });
    let warnings = remarks(&all, |stage| {
        stage.warnings.iter().map(|warning| (warning.clone(), String::new(), String::new())).collect()
    });
    let failures: Vec<&StageRecord> =
        manifest.stages.iter().filter(|stage| matches!(stage.status.as_str(), "failed" | "skipped")).collect();
    let stages: Vec<StageView> = shown.iter().copied().map(stage_view).collect();
    let index: Vec<TableView> =
        bundle::published(manifest).map(|(group, record)| table_view(manifest, group, record, tables)).collect();
    let parts = parts.iter().map(part_view).collect::<Result<Vec<_>, _>>()?;
    let view = View {
        manifest: Manifest {
            study: manifest.study.clone(),
            title: manifest.title.clone(),
            seed: manifest.seed,
            source: manifest.source.clone(),
            study_digest: manifest.study_digest.clone(),
            program: manifest.program.clone(),
            study_folder: manifest.study_folder.clone(),
            machine: manifest.machine.clone(),
            written: manifest.written.clone(),
            ..Manifest::default()
        },
        counts,
        total,
        attention,
        varies: parts.iter().flat_map(|part| &part.figures).any(|figure| figure.varies),
        parts,
        choices: choice::choices(manifest, tables)?,
        left_out,
        warnings,
        failures,
        stages,
        more,
        tables: index,
        seconds: seconds(manifest.seconds),
        style: studygraph::page::STYLE,
        plot_style: plot::STYLE,
        script: include_str!("page.js"),
    };
    environment.get_template("page.html").and_then(|template| template.render(Serde(view))).map_err(failed)
}

fn counts(parts: &[ReportPart]) -> Result<Vec<Count>, ReportError> {
    let mut counts: Vec<Count> = Vec::new();
    for part in parts {
        let (verdicts, numbers) = (texts(&part.counts, "verdict")?, integers(&part.counts, "count")?);
        let (attention, meanings) = (flags(&part.counts, "needs_attention")?, texts(&part.counts, "meaning")?);
        for row in 0..part.counts.rows() {
            match counts.iter_mut().find(|count| count.verdict == verdicts[row]) {
                Some(count) => count.entries += numbers[row],
                None => counts.push(Count {
                    verdict: verdicts[row].clone(),
                    entries: numbers[row],
                    sign: verdict::sign(&verdicts[row]),
                    needs_attention: attention[row],
                    meaning: meanings[row].clone(),
                }),
            }
        }
    }
    Ok(counts)
}

fn part_view(part: &ReportPart) -> Result<PartView, ReportError> {
    let figures = part.figures.iter().map(|figure| FigureView {
        name: figure.name.clone(),
        title: figure.plot.title.clone(),
        note: figure.note.clone(),
        tables: figure.tables.clone(),
        svg: figure.plot.svg(false),
        varies: figure.varies,
    });
    Ok(PartView { stage: part.stage.clone(), rows: verdict::rows(&part.verdicts)?, figures: figures.collect() })
}

/// The stages that the page shows; of a kind with very many the first ones and how many more there are.
fn shown_stages(manifest: &Manifest) -> (Vec<&StageRecord>, Vec<More>) {
    let mut counts: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    manifest.stages.iter().for_each(|stage| counts.entry(&stage.kind).or_default().0 += 1);
    let mut shown = Vec::new();
    for stage in &manifest.stages {
        let Some((all, met)) = counts.get_mut(stage.kind.as_str()) else { continue };
        if *all <= bundle::MANY || *met < SHOWN_STAGES {
            *met += 1;
            shown.push(stage);
        }
    }
    let more = counts.into_iter().filter(|(_, (all, met))| all > met);
    (shown, more.map(|(kind, (all, met))| More { kind: kind.to_owned(), stages: all - met }).collect())
}

fn stage_view(record: &StageRecord) -> StageView<'_> {
    let key = match record.keys.as_slice() {
        [] => String::new(),
        [only] => only.key.short(),
        [first, rest @ ..] => format!("{} and {} more", first.key.short(), rest.len()),
    };
    let rows = record.tables.iter().map(|table| table.rows).sum();
    let work = record.work.iter().map(|(counter, count)| format!("{count} {}", counter.replace('_', " ")));
    let work = work.collect::<Vec<_>>().join(", ");
    StageView { record, seconds: seconds(record.seconds), work, rows, key }
}

/// A table, or that of many stages as one.
fn table_view<'a>(
    manifest: &Manifest,
    group: &str,
    record: &'a TableRecord,
    tables: &dyn Fn(&str) -> Option<Table>,
) -> TableView<'a> {
    let name = format!("{group}.{}", record.table());
    let table = tables(&name);
    let (of, rows) = if bundle::is_bundle(&record.file) {
        let alike = || manifest.stages.iter().flat_map(|stage| &stage.tables).filter(|one| one.file == record.file);
        (alike().count(), alike().map(|one| one.rows).sum())
    } else {
        (1, record.rows)
    };
    let columns = record.columns.iter().map(|column| ColumnView {
        name: &column.name,
        unit: unit_symbol(&column.unit),
        description: &column.description,
        key: column.key,
        volatile: column.volatile,
        is_number: matches!(column.kind.as_str(), "float" | "integer"),
    });
    let shown = table.as_ref().map_or_else(Vec::new, |table| {
        // By the record's columns, and only what it says: a volatile value would make the page differ from run to run.
        let cell = |row: usize, column: &studygraph::store::manifest::ColumnRecord| match table.column(&column.name) {
            None => String::new(),
            Some(_) if column.volatile => "varies".to_owned(),
            Some(Data::Float(values)) => significant(values[row], 6),
            Some(other) => other.cell(row).to_string(),
        };
        (0..table.rows().min(SHOWN_ROWS))
            .map(|row| record.columns.iter().map(|column| cell(row, column)).collect())
            .collect()
    });
    let content = if of == 1 { short(&record.content) } else { String::new() };
    let (columns, is_stored) = (columns.collect(), table.is_some());
    TableView { record, name, stages: of, count: rows, content, columns, rows: shown, is_stored }
}

fn short(digest: &str) -> String {
    digest.chars().take(12).collect()
}
