//! The page: what stands on it, put into words and handed to the template, which escapes every text.
//!
//! Must not know: how a figure is drawn. Everything that differs from run to run stands behind the template's last mark.

use std::sync::Arc;

use minijinja::Environment;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use serde::Serialize;

use super::choice::{self, Choice};
use super::comparison;
use super::figure::Figure;
use super::inputs::Inputs;
use super::records::{self, StageTables};
use super::sheet::{self, Sheet};
use super::sweep::{self, Sweep};
use super::warnings::{self, Warned};
use super::{ReportError, Tables, flags, integers, plot, seconds, texts, verdict};
use studygraph::store::manifest::{Manifest, OmissionRecord, StageRecord};
use studygraph::table::data::Table;

/// The page's script.
pub const SCRIPT: &str =
    concat!(include_str!("page/common.js"), include_str!("page/figure.js"), include_str!("page/tables.js"));

/// What is not computed is named where it would have taken this share of the run.
const WORTH_NAMING: f64 = 0.01;

/// What, why, and about how much it would have taken.
type Said = (String, String, String);

/// What one report stage contributes, beside its figures.
pub struct ReportPart {
    pub stage: String,
    pub verdicts: Arc<Table>,
    pub counts: Arc<Table>,
    pub comparisons: Vec<comparison::Row>,
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
    comparisons: Vec<&'a comparison::Row>,
    /// How many of them need attention.
    differing: usize,
    figures: Vec<FigureView>,
    /// Whether figures show what differs from run to run.
    varies: bool,
    choices: Vec<Choice>,
    sweeps: Vec<Sweep>,
    sheets: Vec<Sheet>,
    /// Whether nothing stands before the data sheet.
    is_plain: bool,
    /// How much was left out, what of it is worth naming.
    omissions: usize,
    left_out: Vec<Remark>,
    warnings: Vec<Warned>,
    failures: Vec<&'a StageRecord>,
    stages: Vec<StageView<'a>>,
    /// Of kinds with very many stages, those that are not shown.
    more: Vec<More>,
    tables: Vec<StageTables<'a>>,
    packed: String,
    seconds: String,
    styles: [&'static str; 2],
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
    /// Those that only read back what the study states.
    inputs: Vec<verdict::Row>,
}

#[derive(Serialize)]
struct FigureView {
    name: String,
    title: String,
    note: String,
    /// Whether there is anything to look at closer.
    is_drawn: bool,
    /// What is not there to be seen.
    remark: String,
    tables: String,
    /// Made by `plot`, which escapes what it is given.
    svg: String,
    legend: Vec<LegendView>,
    /// Width in px, where it is narrower than the page.
    narrow: Option<f64>,
    /// Folder and name of its files, without an ending.
    file: String,
    varies: bool,
}

#[derive(Serialize)]
struct LegendView {
    label: String,
    key: String,
    swatch: String,
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

/// # Errors
/// When a table is of another shape.
pub fn html(
    manifest: &Manifest,
    parts: &[ReportPart],
    figures: &[Figure],
    tables: Tables<'_>,
) -> Result<String, ReportError> {
    let failed = |error: minijinja::Error| ReportError::Page(format!("{error:#}"));
    let mut environment = Environment::new();
    environment.set_syntax(SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).build().map_err(failed)?);
    for (name, text) in [
        ("page.html", include_str!("page/page.html")),
        ("figure.html", include_str!("page/figure.html")),
        ("sheet.html", include_str!("page/sheet.html")),
        ("verdict.html", include_str!("page/verdict.html")),
    ] {
        environment.add_template(name, text).map_err(failed)?;
    }
    let counts = counts(parts)?;
    let total: i64 = counts.iter().map(|count| count.entries).sum();
    let attention: i64 = counts.iter().filter(|count| count.needs_attention).map(|count| count.entries).sum();
    let remarks = |stages: &[StageRecord], pick: &dyn Fn(&StageRecord) -> Vec<Said>| -> Vec<Remark> {
        let of = |stage: &StageRecord| {
            let name = stage.name.clone();
            pick(stage).into_iter().map(move |(what, why, saved)| Remark { stage: name.clone(), what, why, saved })
        };
        stages.iter().flat_map(of).collect()
    };
    let least = WORTH_NAMING * manifest.seconds;
    let is_worth = |left: &&OmissionRecord| left.saved_seconds.is_some_and(|saved| saved >= least);
    let left_out = remarks(&manifest.stages, &|stage| {
        let said = |left: &OmissionRecord| {
            (left.what.to_string(), left.why.to_string(), left.saved_seconds.map_or_else(String::new, seconds))
        };
        stage.left_out.iter().filter(is_worth).map(said).collect()
    });
    let failures: Vec<&StageRecord> = manifest.stages.iter().filter(|stage| !stage.is_complete()).collect();
    let stages: Vec<StageView> = manifest.stages.iter().map(stage_view).collect();
    let more = manifest.more.stages.iter().map(|(kind, &stages)| More { kind: kind.clone(), stages });
    let inputs = Inputs::of(manifest);
    let mut comparisons: Vec<&comparison::Row> = parts.iter().flat_map(|part| &part.comparisons).collect();
    comparisons.sort_by_key(|row| row.rank());
    let parts = parts.iter().map(|part| part_view(part, &inputs)).collect::<Result<Vec<_>, _>>()?;
    let records = records::records(manifest, tables)?;
    let view = View {
        manifest: Manifest { files: Vec::new(), ..manifest.without_stages() },
        counts,
        total,
        attention,
        is_plain: total == 0,
        differing: comparisons.iter().filter(|row| comparison::needs_attention(&row.verdict)).count(),
        comparisons,
        parts,
        varies: figures.iter().any(|figure| figure.varies),
        figures: figures.iter().map(figure_view).collect(),
        choices: choice::choices(manifest, tables)?,
        sweeps: sweep::sweeps(manifest, tables)?,
        sheets: sheet::sheets(manifest, tables),
        omissions: manifest.stages.iter().map(|stage| stage.left_out.len()).sum::<usize>() + manifest.more.omissions,
        left_out,
        warnings: warnings::warned(
            manifest.stages.iter().map(|stage| (stage.name.as_str(), stage.warnings.as_slice())),
        ),
        failures,
        stages,
        more: more.collect(),
        tables: records.stages,
        packed: records.packed,
        seconds: seconds(manifest.seconds),
        styles: [studygraph::page::STYLE, include_str!("page/page.css")],
        plot_style: plot::STYLE,
        script: SCRIPT,
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

fn part_view(part: &ReportPart, inputs: &Inputs) -> Result<PartView, ReportError> {
    let is_input = |row: &verdict::Row| row.verdict == "reproduced" && row.with.is_empty() && inputs.has(&row.cell);
    let (inputs, rows) = verdict::rows(&part.verdicts)?.into_iter().partition(is_input);
    Ok(PartView { stage: part.stage.clone(), rows, inputs })
}

fn figure_view(figure: &Figure) -> FigureView {
    let folder = if figure.varies { "figures/measured" } else { "figures" };
    let item = |item: &super::legend::Item| LegendView {
        label: item.label.clone(),
        key: item.key.clone(),
        swatch: item.swatch(),
    };
    let is_drawn = figure.plot.is_drawn();
    FigureView {
        name: figure.name.clone(),
        title: figure.plot.title.clone(),
        note: figure.note.clone(),
        is_drawn,
        // Where nothing is drawn it stands there instead.
        remark: if is_drawn { figure.plot.remark() } else { String::new() },
        tables: figure.tables.clone(),
        svg: figure.plot.inline(),
        legend: figure.plot.legend().iter().map(item).collect(),
        narrow: figure.plot.narrow(),
        file: format!("{folder}/{}", figure.name),
        varies: figure.varies,
    }
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
