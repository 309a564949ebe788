//! Sweeps as the page shows them: a map of two fields, main effects, the distribution, the best rows, all from the small tables
//! that a sweep makes of its rows.
//!
//! Must not know: how any row was computed; the table of rows, which may be long, is never read.

use serde::Serialize;

use super::svg::{at, escape};
use super::{ReportError, floats, integers, texts};
use declare::number::{significant, unit_symbol};
use studygraph::store::manifest::{Manifest, StageRecord};
use studygraph::table::data::{Data, Table};

/// A sweep on the page.
#[derive(Serialize)]
pub struct Sweep {
    stage: String,
    /// How many rows there are, and why some have no numbers.
    said: String,
    figures: Vec<Drawn>,
    best_title: String,
    columns: Vec<Heading>,
    best: Vec<Vec<String>>,
}

#[derive(Serialize)]
struct Drawn {
    title: String,
    note: String,
    /// Made here, where every text is escaped.
    svg: String,
}

#[derive(Serialize)]
struct Heading {
    name: String,
    unit: String,
}

/// Sizes of a panel.
const WIDTH: f64 = 300.0;
const HEIGHT: f64 = 190.0;
/// Room beside it for its axes.
const LEFT: f64 = 66.0;
const BELOW: f64 = 44.0;
const ABOVE: f64 = 22.0;
const GAP: f64 = 18.0;

/// # Errors
/// When a table is of another shape.
pub fn sweeps(manifest: &Manifest, tables: &dyn Fn(&str) -> Option<Table>) -> Result<Vec<Sweep>, ReportError> {
    let stages = manifest.stages.iter().filter(|stage| stage.kind == "sweep");
    // What is left of an earlier run is shown, and nothing is where there is none.
    let found = stages.filter_map(|stage| of_stage(stage, tables).transpose());
    found.collect()
}

fn of_stage(stage: &StageRecord, tables: &dyn Fn(&str) -> Option<Table>) -> Result<Option<Sweep>, ReportError> {
    let table = |name: &str| tables(&format!("{}.{name}", stage.name));
    let rows = stage.tables.iter().find(|table| table.table() == "rows").map_or(0, |table| table.rows);
    let (Some(best), Some(effects), Some(shares), Some(map), Some(distribution), Some(invalid)) =
        (table("best"), table("effects"), table("sensitivity"), table("map"), table("distribution"), table("invalid"))
    else {
        return Ok(None);
    };
    let unit = |column: &str| {
        let columns = stage.tables.iter().find(|table| table.table() == "rows").map(|table| &table.columns[..]);
        let found = columns.unwrap_or_default().iter().find(|known| known.name == column);
        found.map_or_else(String::new, |column| unit_symbol(&column.unit))
    };
    let labelled = |column: &str| {
        let unit = unit(column);
        if unit.is_empty() { column.to_owned() } else { format!("{column} [{unit}]") }
    };
    let objective = texts(&map, "output")?.first().or(texts(&effects, "output")?.first()).cloned().unwrap_or_default();
    let mut figures = Vec::new();
    if let Some(pair) = most_telling(&shares, &map, &objective)? {
        figures.push(heat_map(&map, &pair, &objective, &labelled)?);
    }
    if effects.rows() > 0 {
        figures.push(main_effects(&effects, &shares, &objective, &labelled)?);
    }
    if distribution.rows() > 0 {
        figures.push(histogram(&distribution, &objective, &labelled)?);
    }
    let lost: i64 = integers(&invalid, "rows")?.iter().sum();
    let reasons: Vec<String> = (0..invalid.rows().min(3))
        .map(|row| Ok(format!("{} × {}", integers(&invalid, "rows")?[row], texts(&invalid, "reason")?[row])))
        .collect::<Result<_, ReportError>>()?;
    let more = if invalid.rows() > 3 { ", and others" } else { "" };
    let said = match lost {
        0 => format!("{rows} designs, all of them with numbers."),
        _ => format!("{rows} designs, {lost} of them without numbers: {}{more}.", reasons.join(", ")),
    };
    let columns = &best.schema().columns;
    let cell = |data: &Data, row: usize| match data {
        Data::Float(values) => significant(values[row], 6),
        other => other.cell(row).to_string(),
    };
    Ok(Some(Sweep {
        stage: stage.name.clone(),
        said,
        figures,
        best_title: best.schema().description.clone(),
        columns: columns
            .iter()
            .map(|column| Heading { name: column.name.clone(), unit: unit_symbol(&column.unit) })
            .collect(),
        best: (0..best.rows()).map(|row| best.columns().iter().map(|data| cell(data, row)).collect()).collect(),
    }))
}

/// The two fields with a map that explain most of the objective.
fn most_telling(shares: &Table, map: &Table, objective: &str) -> Result<Option<[String; 2]>, ReportError> {
    let share = |field: &str| -> Result<f64, ReportError> {
        let (fields, outputs, values) = (texts(shares, "field")?, texts(shares, "output")?, floats(shares, "share")?);
        let found = (0..shares.rows()).find(|row| fields[*row] == field && outputs[*row] == objective);
        Ok(found.map_or(0.0, |row| if values[row].is_finite() { values[row] } else { 0.0 }))
    };
    let mut found: Option<(f64, [String; 2])> = None;
    for (first, second) in texts(map, "first")?.iter().zip(texts(map, "second")?) {
        if found.as_ref().is_some_and(|(_, pair)| pair[0] == *first && pair[1] == *second) {
            continue;
        }
        let sum = share(first)? + share(second)?;
        if found.as_ref().is_none_or(|(known, _)| sum > *known) {
            found = Some((sum, [first.clone(), second.clone()]));
        }
    }
    Ok(found.map(|(_, pair)| pair))
}

/// A line from one end of numbers to the other.
struct Scale {
    low: f64,
    high: f64,
}

impl Scale {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let start = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = values
            .filter(|value| value.is_finite())
            .fold(start, |(low, high), value| (low.min(value), high.max(value)));
        if low < high { Self { low, high } } else { Self { low: low.min(0.0), high: low.max(0.0) + f64::MIN_POSITIVE } }
    }

    fn share(&self, value: f64) -> f64 {
        ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }
}

/// A rectangle with names and ends on its axes.
fn frame(x: f64, y: f64, title: &str, [across, up]: [&str; 2], [horizontal, vertical]: [&Scale; 2]) -> String {
    let text = |x: f64, y: f64, anchor: &str, text: &str| {
        format!(
            "<text x=\"{}\" y=\"{}\" text-anchor=\"{anchor}\" font-size=\"11\" fill=\"currentColor\">{}</text>",
            at(x),
            at(y),
            escape(text)
        )
    };
    let end = |value: f64| significant(value, 3);
    let mut svg = format!(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"currentColor\" stroke-opacity=\"0.4\"/>",
        at(x),
        at(y),
        at(WIDTH),
        at(HEIGHT)
    );
    svg += &text(x, y - 7.0, "start", title);
    svg += &text(x, y + HEIGHT + 14.0, "start", &end(horizontal.low));
    svg += &text(x + WIDTH, y + HEIGHT + 14.0, "end", &end(horizontal.high));
    svg += &text(x + WIDTH / 2.0, y + HEIGHT + 28.0, "middle", across);
    svg += &text(x - 5.0, y + HEIGHT, "end", &end(vertical.low));
    svg += &text(x - 5.0, y + 10.0, "end", &end(vertical.high));
    svg + &format!(
        "<text transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\" font-size=\"11\" fill=\"currentColor\">{}</text>",
        at(x - 48.0),
        at(y + HEIGHT / 2.0),
        escape(up)
    )
}

fn picture(panels: usize, across: usize, label: &str, inside: &str) -> String {
    let down = panels.div_ceil(across);
    let width = across.min(panels) as f64 * (LEFT + WIDTH + GAP);
    let height = down as f64 * (ABOVE + HEIGHT + BELOW);
    format!(
        "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\" style=\"max-width:{}px;width:100%;height:auto\">{inside}</svg>",
        at(width),
        at(height),
        escape(label),
        at(width)
    )
}

fn corner(panel: usize, across: usize) -> (f64, f64) {
    let (column, row) = ((panel % across) as f64, (panel / across) as f64);
    (LEFT + column * (LEFT + WIDTH + GAP), ABOVE + row * (ABOVE + HEIGHT + BELOW))
}

fn heat_map(
    map: &Table,
    pair: &[String; 2],
    objective: &str,
    labelled: &dyn Fn(&str) -> String,
) -> Result<Drawn, ReportError> {
    let (first, second) = (texts(map, "first")?, texts(map, "second")?);
    let (x, y) = (floats(map, "first_value")?, floats(map, "second_value")?);
    let rows: Vec<usize> = (0..map.rows()).filter(|row| first[*row] == pair[0] && second[*row] == pair[1]).collect();
    let distinct = |values: &[f64]| {
        let mut all: Vec<f64> = rows.iter().map(|row| values[*row]).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    };
    let (columns, lines) = (distinct(x), distinct(y));
    let mut inside = String::new();
    for (panel, (column, title)) in
        [("mean", "mean of all others"), ("minimum", "smallest of all others")].iter().enumerate()
    {
        let values = floats(map, column)?;
        let scale = Scale::of(rows.iter().map(|row| values[*row]));
        let (left, top) = corner(panel, 2);
        let (width, height) = (WIDTH / columns.len() as f64, HEIGHT / lines.len() as f64);
        for row in &rows {
            let column = columns.partition_point(|value| *value < x[*row]) as f64;
            let line = lines.partition_point(|value| *value < y[*row]) as f64;
            inside += &format!(
                "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"><title>{} = {}, {} = {}: {}</title></rect>",
                at(left + column * width),
                at(top + HEIGHT - (line + 1.0) * height),
                at(width + 0.3),
                at(height + 0.3),
                colour(scale.share(values[*row])),
                escape(&pair[0]),
                significant(x[*row], 4),
                escape(&pair[1]),
                significant(y[*row], 4),
                significant(values[*row], 4),
            );
        }
        let title = format!("{title}: {} to {}", significant(scale.low, 3), significant(scale.high, 3));
        let axes = [labelled(&pair[0]), labelled(&pair[1])];
        let scales = [&Scale::of(columns.iter().copied()), &Scale::of(lines.iter().copied())];
        inside += &frame(left, top, &title, [&axes[0], &axes[1]], scales);
    }
    Ok(Drawn {
        title: format!("{} over {} and {}", labelled(objective), pair[0], pair[1]),
        note: " The two fields that explain most of it; the darker, the smaller. Each cell is one value or stratum of both.".to_owned(),
        svg: picture(2, 2, &format!("{objective} over {} and {}", pair[0], pair[1]), &inside),
    })
}

/// From dark blue, small, to pale yellow, large: lightness grows all the way, so that it is read without colours too.
fn colour(share: f64) -> String {
    const STOPS: [[f64; 3]; 5] =
        [[31.0, 26.0, 84.0], [45.0, 86.0, 138.0], [43.0, 145.0, 140.0], [122.0, 200.0, 104.0], [250.0, 231.0, 120.0]];
    let place = share * (STOPS.len() - 1) as f64;
    // From 0 to 4.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let index = (place as usize).min(STOPS.len() - 2);
    let part = |channel: usize| {
        STOPS[index][channel] + (place - index as f64) * (STOPS[index + 1][channel] - STOPS[index][channel])
    };
    format!("rgb({:.0} {:.0} {:.0})", part(0), part(1), part(2))
}

fn main_effects(
    effects: &Table,
    shares: &Table,
    objective: &str,
    labelled: &dyn Fn(&str) -> String,
) -> Result<Drawn, ReportError> {
    let (fields, outputs) = (texts(effects, "field")?, texts(effects, "output")?);
    let column = |name: &str| floats(effects, name);
    let (value, mean, low, high) = (column("value")?, column("mean")?, column("quantile_5")?, column("quantile_95")?);
    let of_objective: Vec<usize> = (0..effects.rows()).filter(|row| outputs[*row] == objective).collect();
    let vertical = Scale::of(of_objective.iter().flat_map(|row| [low[*row], high[*row], mean[*row]]));
    let mut names: Vec<&String> = of_objective.iter().map(|row| &fields[*row]).collect();
    names.dedup();
    let share = |field: &str| -> Result<String, ReportError> {
        let (known, outputs, values) = (texts(shares, "field")?, texts(shares, "output")?, floats(shares, "share")?);
        let found = (0..shares.rows()).find(|row| known[*row] == field && outputs[*row] == objective);
        Ok(found.map_or_else(String::new, |row| format!("explains {} %", significant(100.0 * values[row], 2))))
    };
    let mut inside = String::new();
    for (panel, field) in names.iter().enumerate() {
        let rows: Vec<usize> = of_objective.iter().copied().filter(|row| fields[*row] == **field).collect();
        let horizontal = Scale::of(rows.iter().map(|row| value[*row]));
        let (left, top) = corner(panel, 3);
        let point = |row: usize, of: &[f64]| {
            let (x, y) = (left + WIDTH * horizontal.share(value[row]), top + HEIGHT * (1.0 - vertical.share(of[row])));
            format!("{} {}", at(x), at(y))
        };
        let line = |of: &[f64]| rows.iter().map(|row| point(*row, of)).collect::<Vec<_>>().join(" ");
        let back = rows.iter().rev().map(|row| point(*row, low)).collect::<Vec<_>>().join(" ");
        inside += &format!("<polygon points=\"{} {back}\" fill=\"#2d568a\" fill-opacity=\"0.18\"/>", line(high));
        inside += &format!("<polyline points=\"{}\" fill=\"none\" stroke=\"#2d568a\" stroke-width=\"2\"/>", line(mean));
        inside += &frame(left, top, &share(field)?, [&labelled(field), &labelled(objective)], [&horizontal, &vertical]);
    }
    Ok(Drawn {
        title: format!("Main effects on {objective}"),
        note: " The line is the mean over all other fields; 90 % of the rows are in the band.".to_owned(),
        svg: picture(names.len(), 3, &format!("main effects on {objective}"), &inside),
    })
}

fn histogram(distribution: &Table, objective: &str, labelled: &dyn Fn(&str) -> String) -> Result<Drawn, ReportError> {
    let (outputs, counts) = (texts(distribution, "output")?, integers(distribution, "rows")?);
    let (from, to) = (floats(distribution, "from")?, floats(distribution, "to")?);
    let mut names: Vec<&String> = outputs.iter().collect();
    names.dedup();
    names.sort_by_key(|name| *name != objective);
    let mut inside = String::new();
    for (panel, name) in names.iter().enumerate() {
        let rows: Vec<usize> = (0..distribution.rows()).filter(|row| outputs[*row] == **name).collect();
        let horizontal = Scale::of(rows.iter().flat_map(|row| [from[*row], to[*row]]));
        let vertical = Scale::of(rows.iter().map(|row| counts[*row] as f64).chain([0.0]));
        let (left, top) = corner(panel, 3);
        for row in &rows {
            let (start, end) = (horizontal.share(from[*row]), horizontal.share(to[*row]));
            let height = HEIGHT * vertical.share(counts[*row] as f64);
            inside += &format!(
                "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"#2d568a\" fill-opacity=\"0.75\"/>",
                at(left + WIDTH * start),
                at(top + HEIGHT - height),
                at(WIDTH * (end - start)),
                at(height)
            );
        }
        inside += &frame(left, top, "", [&labelled(name), "rows"], [&horizontal, &vertical]);
    }
    Ok(Drawn {
        title: "Distribution".to_owned(),
        note: " Of all rows with numbers.".to_owned(),
        svg: picture(names.len(), 3, "distribution of every output", &inside),
    })
}
