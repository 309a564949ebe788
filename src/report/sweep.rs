//! Sweeps as the page shows them: a map of two fields, main effects, the distribution, the best rows, all from the small tables
//! that a sweep makes of its rows.
//!
//! Must not know: how any row was computed; the table of rows, which may be long, is never read.

mod panels;

use serde::Serialize;

use self::panels::Named;
use super::{ReportError, Tables, floats, integers, texts};
use declare::number::{counted, significant, unit_symbol};
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

/// # Errors
/// When a table is of another shape.
pub fn sweeps(manifest: &Manifest, tables: Tables<'_>) -> Result<Vec<Sweep>, ReportError> {
    let stages = manifest.stages.iter().filter(|stage| stage.kind == "sweep");
    // What is left of an earlier run is shown, and nothing is where there is none.
    let found = stages.filter_map(|stage| of_stage(stage, tables).transpose());
    found.collect()
}

fn of_stage(stage: &StageRecord, tables: Tables<'_>) -> Result<Option<Sweep>, ReportError> {
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
    let named = |column: &str| Named { name: column.to_owned(), unit: unit(column) };
    let objective = texts(&map, "output")?.first().or(texts(&effects, "output")?.first()).cloned().unwrap_or_default();
    let mut figures = Vec::new();
    if let Some(pair) = most_telling(&shares, &map, &objective)? {
        figures.push(heat_map(&map, &pair, &objective, &named)?);
    }
    if effects.rows() > 0 {
        figures.push(main_effects(&effects, &shares, &objective, &named)?);
    }
    if distribution.rows() > 0 {
        figures.push(histogram(&distribution, &objective, &named)?);
    }
    let lost: i64 = integers(&invalid, "rows")?.iter().sum();
    let reasons: Vec<String> = (0..invalid.rows().min(3))
        .map(|row| Ok(format!("{} × {}", integers(&invalid, "rows")?[row], texts(&invalid, "reason")?[row])))
        .collect::<Result<_, ReportError>>()?;
    let more = if invalid.rows() > 3 { ", and others" } else { "" };
    let said = match lost {
        0 if rows == 1 => "1 design, with numbers.".to_owned(),
        0 => format!("{rows} designs, all of them with numbers."),
        _ => format!("{}, {lost} of them without numbers: {}{more}.", counted(rows, "design"), reasons.join(", ")),
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
        best_title: format!("The rows with the smallest {objective}"),
        columns: columns
            .iter()
            .map(|column| Heading { name: column.name.clone(), unit: unit_symbol(&column.unit) })
            .collect(),
        best: (0..best.rows()).map(|row| best.columns().iter().map(|data| cell(data, row)).collect()).collect(),
    }))
}

/// The share of the variance of an output that a field explains.
fn explained(shares: &Table, field: &str, output: &str) -> Result<Option<f64>, ReportError> {
    let (fields, outputs, values) = (texts(shares, "field")?, texts(shares, "output")?, floats(shares, "share")?);
    Ok((0..shares.rows()).find(|row| fields[*row] == field && outputs[*row] == output).map(|row| values[row]))
}

/// The two fields with a map that explain most of the objective.
fn most_telling(shares: &Table, map: &Table, objective: &str) -> Result<Option<[String; 2]>, ReportError> {
    let share = |field: &str| -> Result<f64, ReportError> {
        Ok(explained(shares, field, objective)?.filter(|share| share.is_finite()).unwrap_or(0.0))
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

fn heat_map(
    map: &Table,
    pair: &[String; 2],
    objective: &str,
    named: &dyn Fn(&str) -> Named,
) -> Result<Drawn, ReportError> {
    let (first, second) = (texts(map, "first")?, texts(map, "second")?);
    let (x, y) = (floats(map, "first_value")?, floats(map, "second_value")?);
    let rows: Vec<usize> = (0..map.rows()).filter(|row| first[*row] == pair[0] && second[*row] == pair[1]).collect();
    let mut svg = String::new();
    for (column, title) in [("mean", "mean over the others"), ("minimum", "smallest that the others leave")] {
        let values = floats(map, column)?;
        let cells: Vec<[f64; 3]> = rows.iter().map(|row| [x[*row], y[*row], values[*row]]).collect();
        svg += &panels::cells(title, [named(&pair[0]), named(&pair[1]), named(objective)], &cells);
    }
    Ok(Drawn {
        title: format!("{objective} over {} and {}", pair[0], pair[1]),
        note: " The two fields that explain most of it. Each cell is one value or stratum of both.".to_owned(),
        svg,
    })
}

fn main_effects(
    effects: &Table,
    shares: &Table,
    objective: &str,
    named: &dyn Fn(&str) -> Named,
) -> Result<Drawn, ReportError> {
    let (fields, outputs) = (texts(effects, "field")?, texts(effects, "output")?);
    let column = |name: &str| floats(effects, name);
    let (value, mean, low, high) = (column("value")?, column("mean")?, column("quantile_5")?, column("quantile_95")?);
    let of_objective: Vec<usize> = (0..effects.rows()).filter(|row| outputs[*row] == objective).collect();
    let vertical = of_objective.iter().flat_map(|row| [low[*row], high[*row], mean[*row]]);
    let vertical: Vec<f64> = vertical.collect();
    let mut names: Vec<&String> = of_objective.iter().map(|row| &fields[*row]).collect();
    names.dedup();
    let share = |field: &str| -> Result<String, ReportError> {
        Ok(match explained(shares, field, objective)? {
            Some(share) if share > 0.0 => format!("explains {} %", significant(100.0 * share, 2)),
            // Of drawn designs it is corrected for chance.
            Some(share) if share <= 0.0 => "explains no more than chance".to_owned(),
            _ => String::new(),
        })
    };
    let mut svg = String::new();
    for field in names {
        let rows = of_objective.iter().copied().filter(|row| fields[*row] == *field);
        let points: Vec<[f64; 4]> = rows.map(|row| [value[row], low[row], mean[row], high[row]]).collect();
        svg += &panels::band(&share(field)?, [named(field), named(objective)], &points, &vertical);
    }
    Ok(Drawn {
        title: format!("Main effects on {objective}"),
        note: " The line is the mean over all other fields; 90 % of the rows are in the band.".to_owned(),
        svg,
    })
}

fn histogram(distribution: &Table, objective: &str, named: &dyn Fn(&str) -> Named) -> Result<Drawn, ReportError> {
    let (outputs, counts) = (texts(distribution, "output")?, integers(distribution, "rows")?);
    let (from, to) = (floats(distribution, "from")?, floats(distribution, "to")?);
    let mut names: Vec<&String> = outputs.iter().collect();
    names.dedup();
    names.sort_by_key(|name| *name != objective);
    let mut svg = String::new();
    for name in names {
        let rows = (0..distribution.rows()).filter(|row| outputs[*row] == *name);
        let bars: Vec<[f64; 3]> = rows.map(|row| [from[row], to[row], counts[row] as f64]).collect();
        svg += &panels::bars([named(name), Named { name: "rows".to_owned(), unit: String::new() }], &bars);
    }
    Ok(Drawn { title: "Distribution".to_owned(), note: " Of all rows with numbers.".to_owned(), svg })
}
