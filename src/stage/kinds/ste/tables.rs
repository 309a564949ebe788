//! The tables of a stage of the kind `ste`: columns and rows.
//!
//! Must not know: how a curve is found.

use super::rows::{Found, Keyed, OfCurve, PointRow, keyed};
use super::{friction, pressures};
use crate::stage::names;
use gearmesh::gear::geometry::Side;
use gearmesh::gear::mesh::answers::contact_law_error::ContactLawError;
use gearmesh::gear::mesh::answers::quantities::{Need, QUANTITIES, Quantity};
use studygraph::table::columns::Columns;
use studygraph::table::schema::Column;

pub const HARMONICS: &str = "harmonics";
pub const COST: &str = "cost";

/// Those of friction are there where it is stated.
pub fn summary<'a>(stated: &[usize], rubs: bool) -> Columns<Keyed<'a>> {
    let slices = "Slices that were used on each stretch of the face without a closed form.";
    let error = "Estimated relative error of the peak-to-peak from positions and slices.";
    let columns = keyed(names::summary::TABLE, "What each curve of the transmission error amounts to.", stated);
    let columns = QUANTITIES.iter().fold(columns, |columns, quantity| {
        let columns = of_curve_summary(columns, quantity);
        // Columns beside these that are not numbers of the curve alone.
        match quantity.name {
            "pressure_roll_angle" => pressures::of_pair(columns),
            "pressure_half_width" => pressures::of_corner(columns),
            names::summary::ROOT_STRESS_ERROR_PINION => of_iso6336(columns, Side::Pinion),
            names::summary::ROOT_STRESS_ERROR_GEAR => of_iso6336(columns, Side::Gear),
            _ => columns,
        }
    });
    let columns = of_doubt(columns);
    let columns = if rubs { friction::of_summary(columns) } else { columns };
    columns
        .integer("positions", "Positions per base pitch that were used.", |row| row.2.settings.positions)
        .integer("slices", slices, |row| row.2.settings.slices)
        .float("error_estimate", "", error, |row| row.2.error)
        .but(|column| column.tolerance(1e-9, 0.0))
}

/// What the law of contact may be off by, and where most.
fn of_doubt(columns: Columns<Keyed<'_>>) -> Columns<Keyed<'_>> {
    let size = "What the law of contact may be off by in the transmission error; NaN where it knows no width.";
    let position = "Distance from where a pair starts contact, where that is most.";
    let of = |get: fn(&ContactLawError) -> f64| move |row: &Keyed| row.2.doubt.as_ref().map_or(f64::NAN, get);
    columns
        .float("contact_doubt", "um", size, of(|doubt| doubt.size))
        .but(|column| column.on_demand().allows_nan().tolerance(1e-9, 1e-6))
        .float("contact_doubt_position", "mm", position, of(|doubt| doubt.position))
        .but(|column| column.on_demand().allows_nan().tolerance(1e-6, 1e-9))
}

/// The column of a quantity.
fn of_curve_summary<'a>(columns: Columns<Keyed<'a>>, quantity: &'static Quantity) -> Columns<Keyed<'a>> {
    columns.float(quantity.name, quantity.unit, quantity.description, |row: &Keyed| (quantity.get)(&row.2.summary)).but(
        |column| {
            let column = match quantity.tolerance {
                Some([absolute, relative]) => column.tolerance(absolute, relative),
                None => column,
            };
            let column = if quantity.allows_nan { column.allows_nan() } else { column };
            if matches!(quantity.need, Need::Pressure | Need::RootStress) { column.on_demand() } else { column }
        },
    )
}

/// The root stress of a gear by the standard.
fn of_iso6336(columns: Columns<Keyed<'_>>, side: Side) -> Columns<Keyed<'_>> {
    let (name, at, column) = match side {
        Side::Pinion => ("pinion", 0, names::summary::ISO6336_ROOT_STRESS_PINION),
        Side::Gear => ("gear", 1, names::summary::ISO6336_ROOT_STRESS_GEAR),
    };
    let iso = format!("Nominal root stress σ_F0 of the {name} by ISO 6336-3, method B; NaN outside its ranges.");
    columns
        .float(column, "MPa", &iso, move |row: &Keyed| row.2.iso6336[at])
        .but(|column| column.on_demand().allows_nan())
}

/// By itself, since a table with measured times differs from run to run.
pub fn cost<'a>(stated: &[usize]) -> Columns<Keyed<'a>> {
    keyed(COST, "Error of each curve against the time it took.", stated)
        .float("peak_to_peak", "um", "As in the table `summary`.", |row: &Keyed| row.2.summary.peak_to_peak)
        .but(|column| column.tolerance(1e-12, 1e-9))
        .integer("positions", "As in the table `summary`.", |row| row.2.settings.positions)
        .integer("slices", "As in the table `summary`.", |row| row.2.settings.slices)
        .float("error_estimate", "", "As in the table `summary`.", |row| row.2.error)
        .but(|column| column.tolerance(1e-9, 0.0))
        .float("seconds", "s", "Time for this row.", |row| row.2.seconds)
        .but(Column::volatile)
        .on_demand()
}

/// By far the longest tables. Columns of friction are there where it is stated.
pub fn curve<'a>(stated: &[usize], rubs: bool) -> Columns<PointRow<'a>> {
    let description = "Transmission error over one mesh cycle, with its extrema. Where the number of pairs changes there are \
                       two rows, one for each side.";
    let position = "Distance from where a pair starts contact, along the line of action.";
    let share = "Share of the load on the pair that came into contact last.";
    let secant = "Load over loaded less unloaded transmission error; NaN without load.";
    let root = |side: Side| match side {
        Side::Pinion => "Largest tensile stress at the roots of the pinion's loaded teeth.",
        Side::Gear => "Largest tensile stress at the roots of the gear's loaded teeth.",
    };
    let counts = "Counts the positions, from 1; those of the extrema are among them.";
    let columns = keyed(names::curve::TABLE, description, stated)
        .integer("point", counts, |row: &PointRow| row.2.number)
        .key()
        .float("cycle_position", "mm", position, |row| row.2.point.cycle_position)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("roll_angle", "deg", "The pinion's roll angle at the newest pair.", |row| row.2.point.roll_angle)
        .integer("pairs", "Pairs inside the path of contact.", |row| row.2.point.pairs)
        .integer("loaded_pairs", "Pairs that carry load.", |row| row.2.point.loaded_pairs)
        .float("transmission_error", "um", "Approach of the gears along the line of action.", |row| {
            row.2.point.transmission_error
        })
        .float("unloaded_transmission_error", "um", "The same without load.", |row| {
            row.2.point.unloaded_transmission_error
        })
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("newest_load_share", "", share, |row| {
            let load = row.2.point.load();
            if load > 0.0 { row.2.point.newest_load / load } else { 0.0 }
        })
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("secant_stiffness", "N/m", secant, |row| row.2.point.secant_stiffness)
        .but(Column::allows_nan)
        .float("tangent_stiffness", "N/m", "Slope of load over transmission error; NaN without load.", |row| {
            row.2.point.tangent_stiffness
        })
        // Where a corner begins to touch, the slope goes with the square root of how far it is in.
        .but(|column| column.tolerance(0.0, 1e-5).allows_nan())
        .float(names::curve::PRESSURE, "MPa", "Largest pressure of any pair.", |row| {
            row.2.point.pressed.map_or(f64::NAN, |pressed| pressed.largest)
        })
        .but(Column::on_demand)
        .float(names::curve::ROOT_STRESS_PINION, "MPa", root(Side::Pinion), |row| {
            row.2.point.root_stress.map_or(f64::NAN, |of_gears| of_gears[0])
        })
        .but(Column::on_demand)
        .float(names::curve::ROOT_STRESS_GEAR, "MPa", root(Side::Gear), |row| {
            row.2.point.root_stress.map_or(f64::NAN, |of_gears| of_gears[1])
        })
        .but(Column::on_demand);
    let columns = pressures::of_curve(columns);
    if rubs { friction::of_curve(columns) } else { columns }
}

/// The points of curves, in the order of the keys, or the table sorts every row.
pub fn points<'a>(curves: &'a [Keyed<'a, Found>]) -> impl Iterator<Item = PointRow<'a>> + Clone {
    curves.iter().flat_map(|(design, load, found)| {
        (1..).zip(&found.points).map(move |(number, point)| {
            let (contacts, left) = (found.contacts.get(number - 1), found.left.get(number - 1).copied());
            (*design, *load, OfCurve { number, point, contacts, left })
        })
    })
}

/// A harmonic: its order and its amplitude.
pub type HarmonicRow<'a> = Keyed<'a, (usize, f64)>;

pub fn harmonics<'a>(stated: &[usize]) -> Columns<HarmonicRow<'a>> {
    keyed(HARMONICS, "Harmonics of the transmission error.", stated)
        .integer("order", "Multiple of the mesh frequency.", |(.., (order, _)): &HarmonicRow| *order)
        .key()
        .float("amplitude", "um", "Amplitude of the transmission error.", |(.., (_, amplitude))| *amplitude)
        .but(|column| column.tolerance(1e-12, 1e-9))
}

/// The harmonics of curves, in the order of the keys.
pub fn amplitudes<'a>(answers: &'a [Keyed<'a>]) -> impl Iterator<Item = HarmonicRow<'a>> + Clone {
    answers.iter().flat_map(|(design, load, answer)| {
        (1..).zip(&answer.summary.harmonics).map(move |(order, amplitude)| (*design, *load, (order, *amplitude)))
    })
}
