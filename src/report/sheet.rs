//! The data sheet of a gear pair, from the tables of a geometry stage: what was given and what follows from it.
//!
//! Must not know: figures. It shows cells and computes none.

use serde::Serialize;

use super::Tables;
use declare::number::{significant, with_unit};
use studygraph::store::manifest::Manifest;
use studygraph::table::data::{Cell, Data, Table};

/// A pair and its loads.
#[derive(Serialize)]
pub struct Sheet {
    stage: String,
    /// Pinion and gear, or the one there is.
    gears: Vec<String>,
    /// Of each gear.
    rows: Vec<Line>,
    /// Of both together.
    pair: Vec<Line>,
    /// What each stage of transmission error loads it with.
    loads: Vec<Line>,
}

#[derive(Serialize)]
struct Line {
    what: &'static str,
    symbol: &'static str,
    /// Its index.
    below: &'static str,
    of: String,
    values: Vec<String>,
}

impl Line {
    /// `symbol` has its index behind `_`.
    fn new(what: &'static str, symbol: &'static str, values: Vec<String>) -> Self {
        let (symbol, below) = symbol.split_once('_').unwrap_or((symbol, ""));
        Self { what, symbol, below, of: String::new(), values }
    }
}

/// What of `gears` is shown: words, symbol by ISO 21771, column.
const GEARS: [(&str, &str, &str); 25] = [
    ("Teeth", "z", "teeth"),
    ("Module", "m", "module"),
    ("Pressure angle", "α", "pressure_angle"),
    ("Profile shift coefficient", "x", "profile_shift"),
    ("Thickness allowance", "A_s", "thickness_allowance"),
    ("Addendum of the rack", "h*_aP", "rack_addendum"),
    ("Dedendum of the rack", "h*_fP", "rack_dedendum"),
    ("Rounding of the rack", "ρ*_fP", "rack_tip_radius"),
    ("Protuberance of the rack", "pr*", "protuberance"),
    ("Machining allowance", "q*", "machining_allowance"),
    ("Teeth of the cutter", "z_0", "cutter_teeth"),
    ("Profile shift coefficient of the cutter", "x_0", "cutter_profile_shift"),
    ("Addendum of the cutter", "h*_aP0", "cutter_addendum"),
    ("Rounding of the cutter", "ρ*_aP0", "cutter_tip_radius"),
    ("Face width", "b", "face_width"),
    ("Reference circle, radius", "r", "reference_radius"),
    ("Base circle, radius", "r_b", "base_radius"),
    ("Tip circle, radius", "r_a", "tip_radius"),
    ("Tip form circle, radius", "r_Fa", "tip_form_radius"),
    ("Form circle, radius", "r_Ff", "form_radius"),
    ("Root circle, radius", "r_f", "root_radius"),
    ("Bore, radius", "", "bore_radius"),
    ("Tooth thickness at the tip", "s_a", "tip_thickness"),
    ("Young's modulus", "E", "youngs_modulus"),
    ("Poisson's ratio", "ν", "poisson_ratio"),
];

/// Columns of the rack that cuts a gear, and of the cutter that shapes one: a gear has the one or the other.
const OF_RACK: [&str; 4] = ["rack_dedendum", "rack_tip_radius", "protuberance", "machining_allowance"];
const OF_CUTTER: [&str; 4] = ["cutter_teeth", "cutter_profile_shift", "cutter_addendum", "cutter_tip_radius"];
/// Those that are left out where all gears have 0.
const SELDOM: [&str; 3] = ["thickness_allowance", "protuberance", "machining_allowance"];

const PAIR: [(&str, &str, &str); 4] = [
    ("Centre distance", "a", "centre_distance"),
    ("Working pressure angle", "α_w", "working_pressure_angle"),
    ("Transverse contact ratio", "ε_α", "contact_ratio"),
    ("Base pitch", "p_b", "base_pitch"),
];

#[must_use]
pub fn sheets(manifest: &Manifest, tables: Tables<'_>) -> Vec<Sheet> {
    let loads: Vec<Line> = manifest
        .stages
        .iter()
        .filter(|stage| stage.kind == "ste")
        .filter_map(|stage| {
            let table = tables(&format!("{}.summary", stage.name))?;
            let torques = distinct(&table, "torque");
            let said = match torques.as_slice() {
                [] => return None,
                [first, .., last] if torques.len() > 4 => format!("{} from {first} to {last}", torques.len()),
                few => few.join(", "),
            };
            Some(Line { of: stage.name.clone(), ..Line::new("Torque on the pinion", "T", vec![said]) })
        })
        .collect();
    let geometries = manifest.stages.iter().filter(|stage| stage.kind == "geometry");
    let mut loads = Some(loads);
    geometries
        .filter_map(|stage| {
            let table = |name: &str| tables(&format!("{}.{name}", stage.name));
            let (gears, pair) = (table("gears")?, table("pair"));
            let lines = |table: &Table, shown: &[(&'static str, &'static str, &'static str)]| -> Vec<Line> {
                let line = |&(what, symbol, column): &(&'static str, &'static str, &'static str)| {
                    let values: Vec<String> =
                        (0..table.rows()).rev().map(|row| of_its_tool(table, column, row)).collect();
                    let is_nothing = |row| is_zero(table, column, row);
                    if SELDOM.contains(&column) && (0..table.rows()).all(is_nothing) {
                        return None;
                    }
                    (!values.iter().all(String::is_empty)).then(|| Line::new(what, symbol, values))
                };
                shown.iter().filter_map(line).collect()
            };
            Some(Sheet {
                stage: stage.name.clone(),
                // By name: the gear stands first in the table.
                gears: (0..gears.rows()).rev().map(|row| cell(&gears, "gear", row)).collect(),
                rows: lines(&gears, &GEARS),
                pair: pair.map_or_else(Vec::new, |pair| {
                    let mut all = lines(&pair, &PAIR);
                    all.extend(path_of_contact(&pair));
                    all
                }),
                loads: loads.take().unwrap_or_default(),
            })
        })
        .collect()
}

/// From A to E.
fn path_of_contact(pair: &Table) -> Option<Line> {
    let ends = ["start_of_contact", "end_of_contact"].map(|name| match pair.column(name) {
        Some(Data::Float(values)) => values.first().copied(),
        _ => None,
    });
    let [Some(start), Some(end)] = ends else { return None };
    let unit = pair.schema().column("end_of_contact").map_or("", |column| column.unit.as_str());
    let length = with_unit(&significant(end - start, 6), unit);
    Some(Line::new("Length of path of contact", "g_α", vec![length]))
}

/// A cell with its unit; empty where there is none.
fn cell(table: &Table, column: &str, row: usize) -> String {
    let unit = table.schema().column(column).map_or("", |column| column.unit.as_str());
    match table.column(column).map(|data| data.cell(row)) {
        Some(Cell::Float(value)) if value.is_finite() => with_unit(&significant(value, 6), unit),
        Some(Cell::Float(_)) | None => String::new(),
        Some(other) => other.to_string(),
    }
}

/// A cell; empty where it is of a tool that the gear does not have.
fn of_its_tool(table: &Table, column: &str, row: usize) -> String {
    let is_cut_by_rack = is_zero(table, "cutter_teeth", row);
    let others = if is_cut_by_rack { OF_CUTTER } else { OF_RACK };
    if others.contains(&column) { String::new() } else { cell(table, column, row) }
}

/// Whether there is a number 0, or none.
fn is_zero(table: &Table, column: &str, row: usize) -> bool {
    match table.column(column).map(|data| data.cell(row)) {
        Some(Cell::Float(value)) => value == 0.0,
        Some(Cell::Integer(value)) => value == 0,
        _ => true,
    }
}

/// The different values of a column, in the order of the rows.
fn distinct(table: &Table, column: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for row in 0..table.rows() {
        let value = cell(table, column, row);
        if !value.is_empty() && !found.contains(&value) {
            found.push(value);
        }
    }
    found
}
