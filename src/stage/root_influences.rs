//! What loads do to the roots of teeth as a table: what the stiffness stage writes and `ste` reads back.
//!
//! Values stand at Chebyshev nodes of the loads' roll angles. Must not know: which method made them.

use super::compliance::interval;
use super::names::root_influences as names;
use super::names::{ROOT_INFLUENCES_PORT, summary};
use super::pair::si;
use crate::stage::names::curve;
use crate::stage::{Demand, Inputs, Port};
use declare::error::Failure;
use gearmesh::gear::compliance::RootInfluences;
use gearmesh::gear::geometry::Side;
use gearmesh::numeric::chebyshev::{Series, nodes};
use studygraph::table::columns::Columns;
use studygraph::table::data::{Table, TableError};
use studygraph::table::schema::Schema;

/// A place of the root and a load on a tooth.
struct Row {
    side: Side,
    /// How many pitches further than the stressed tooth the loaded one is.
    tooth: isize,
    /// From 1; 0 for a load along the flank.
    node: usize,
    /// From 1.
    place: usize,
    roll: f64,
    radius: f64,
    length: f64,
    stress: f64,
    /// Of the gear.
    error_estimate: f64,
}

fn columns() -> Columns<Row> {
    let description = "Stress along the surface of a tooth's root, on the side of the loads, under loads on it and on its \
                       neighbours.";
    let tooth = "Which tooth is loaded: so many pitches further than the stressed one, where roll angles are larger.";
    let length = "Length along the surface up to the place, from beside the middle of the root land.";
    Columns::new(names::TABLE, description)
        .text(names::GEAR, "Which gear: pinion or gear.", |row: &Row| row.side.name())
        .key()
        .integer(names::TOOTH, tooth, |row| row.tooth)
        .key()
        .integer(names::NODE, "Chebyshev node of the load, from 1 at the root side; 0: along the flank at the last one, towards the root.", |row| row.node)
        .key()
        .integer(names::PLACE, "Place along the surface, from 1 at the root land.", |row| row.place)
        .key()
        .float(names::ROLL_ANGLE, "rad", "Roll angle of the loaded point.", |row| row.roll)
        .float(names::RADIUS, "mm", "Radius of the place.", |row| row.radius)
        .float(names::LENGTH, "mm", length, |row| row.length)
        .float(names::STRESS, "MPa mm/N", "Stress per load per face width, positive in tension.", |row| row.stress)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float(names::ERROR_ESTIMATE, "%", ERROR_ESTIMATE, |row| row.error_estimate)
        // The difference of two stresses.
        .but(|column| column.tolerance(1e-7, 1e-9))
        .on_demand()
}

/// Description of the column of that name, here and elsewhere.
pub const ERROR_ESTIMATE: &str = "Estimated error of the largest stress of the gear's roots, from a mesh half as fine.";

/// That of the table that [`write()`] makes.
#[must_use]
pub fn schema() -> Schema {
    columns().schema()
}

/// The table of pinion and gear.
///
/// # Errors
/// When a stress is not finite.
pub fn write(influences: &[RootInfluences; 2]) -> Result<Table, TableError> {
    let mut rows = Vec::new();
    for (side, RootInfluences { radii, lengths, stresses, along, error_estimate }) in
        [Side::Pinion, Side::Gear].into_iter().zip(influences)
    {
        let neighbours = (stresses.len() / 2).cast_signed();
        for (of_tooth, tooth) in stresses.iter().zip(-neighbours..) {
            for (place, (series, (&radius, &length))) in (1..).zip(of_tooth.iter().zip(radii.iter().zip(lengths))) {
                let rolls = nodes(series.lower(), series.upper(), series.coefficients().len());
                let of_tip =
                    usize::try_from(tooth + neighbours).ok().and_then(|tooth| along.get(tooth)?.get(place - 1));
                let last = rolls.last().copied().unwrap_or(series.upper());
                rows.extend(of_tip.map(|&stress| Row {
                    side,
                    tooth,
                    node: 0,
                    place,
                    roll: last,
                    radius,
                    length,
                    stress,
                    error_estimate: *error_estimate,
                }));
                rows.extend((1..).zip(rolls).map(|(node, roll)| Row {
                    side,
                    tooth,
                    node,
                    place,
                    roll,
                    radius,
                    length,
                    stress: series.value(roll),
                    error_estimate: *error_estimate,
                }));
            }
        }
    }
    columns().table(&rows)
}

/// The port through which [`of`] reads, for a stage that gives root stresses on demand.
#[must_use]
pub fn port(stage: &str) -> Port {
    const FOR: &[(&str, &str)] = &[
        (summary::TABLE, summary::LARGEST_ROOT_STRESS_PINION),
        (summary::TABLE, summary::LARGEST_ROOT_STRESS_GEAR),
        (summary::TABLE, summary::ROOT_STRESS_POSITION_PINION),
        (summary::TABLE, summary::ROOT_STRESS_POSITION_GEAR),
        (summary::TABLE, summary::ROOT_STRESS_RADIUS_PINION),
        (summary::TABLE, summary::ROOT_STRESS_RADIUS_GEAR),
        (summary::TABLE, summary::ROOT_STRESS_ERROR_PINION),
        (summary::TABLE, summary::ROOT_STRESS_ERROR_GEAR),
        (curve::TABLE, curve::ROOT_STRESS_PINION),
        (curve::TABLE, curve::ROOT_STRESS_GEAR),
    ];
    Port::tables(ROOT_INFLUENCES_PORT, stage, &[names::TABLE]).only_for(FOR)
}

/// Whether anything is demanded of a stage that reads through [`port`].
#[must_use]
pub fn are_wanted(demand: &Demand) -> bool {
    port("").is_wanted(demand)
}

/// The influences that came in.
///
/// # Errors
/// When their table did not, or is not what [`write()`] made.
pub fn of(inputs: &Inputs) -> Result<[RootInfluences; 2], Failure> {
    let table = inputs.table(ROOT_INFLUENCES_PORT, names::TABLE)?;
    Ok([read(table, Side::Pinion)?, read(table, Side::Gear)?])
}

/// Those of a gear: rows are in the order of their keys, by the loaded tooth, the load and the place.
fn read(table: &Table, side: Side) -> Result<RootInfluences, Failure> {
    let gears = table.texts(names::GEAR);
    let rows: Vec<usize> = (0..table.rows()).filter(|&row| gears[row] == side.name()).collect();
    let most = |column: &str| rows.iter().map(|&row| table.integers(column)[row]).max().unwrap_or(-1);
    let count = |most: i64| usize::try_from(most).unwrap_or(0);
    let (places, loads) = (count(most(names::PLACE)), count(most(names::NODE)));
    let teeth = 2 * count(most(names::TOOTH)) + 1;
    let turned = usize::from(rows.iter().any(|&row| table.integers(names::NODE)[row] == 0));
    let all = turned + loads;
    if rows.is_empty() || rows.len() != teeth * all * places {
        return Err(Failure::new(format!("table `{}` does not have what a {} needs", names::TABLE, side.name())));
    }
    let of_places = |column: &str| rows[..places].iter().map(|&row| si(table, column, row)).collect();
    let rolls: Vec<f64> =
        rows.iter().step_by(places).skip(turned).take(loads).map(|&row| table.floats(names::ROLL_ANGLE)[row]).collect();
    let (lower, upper) = interval(&rolls);
    let series = |tooth: usize, place: usize| {
        let of_load = |load: usize| si(table, names::STRESS, rows[(tooth * all + turned + load) * places + place]);
        Series::from_values(lower, upper, &(0..loads).map(of_load).collect::<Vec<f64>>())
    };
    let along = |tooth: usize, place: usize| si(table, names::STRESS, rows[tooth * all * places + place]);
    Ok(RootInfluences {
        radii: of_places(names::RADIUS),
        lengths: of_places(names::LENGTH),
        stresses: (0..teeth).map(|tooth| (0..places).map(|place| series(tooth, place)).collect()).collect(),
        along: (0..teeth).map(|tooth| (0..turned * places).map(|place| along(tooth, place)).collect()).collect(),
        error_estimate: si(table, names::ERROR_ESTIMATE, rows[0]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn influences_come_back_to_the_last_bits() {
        let of = |count: usize, scale: f64, along: usize| RootInfluences {
            radii: (0..count).map(|place| 0.02 + 1e-4 * place as f64).collect(),
            lengths: (0..count).map(|place| 1e-4 * place as f64).collect(),
            stresses: (0..3)
                .map(|tooth| {
                    let part = |place: usize| scale * (1.0 + f64::from(tooth) + 0.1 * place as f64);
                    (0..count).map(|place| Series::fit(0.07, 0.62, 12, |u| part(place) * libm::exp(u))).collect()
                })
                .collect(),
            along: (0..3).map(|tooth| (0..along).map(|place| scale * (tooth * 10 + place) as f64).collect()).collect(),
            error_estimate: 1e-6 * scale,
        };
        let both = [of(5, 700.0, 5), of(7, 400.0, 0)];
        let table = write(&both).unwrap();
        for (side, known) in [Side::Pinion, Side::Gear].into_iter().zip(&both) {
            let back = read(&table, side).unwrap();
            let near = |one: &[f64], other: &[f64]| {
                assert_eq!(one.len(), other.len());
                one.iter().zip(other).for_each(|(one, other)| assert!((one - other).abs() <= 1e-15 * other.abs()));
            };
            near(&back.radii, &known.radii);
            near(&back.lengths, &known.lengths);
            near(&[back.error_estimate], &[known.error_estimate]);
            assert_eq!(back.along.len(), 3);
            back.along.iter().zip(&known.along).for_each(|(back, known)| near(back, known));
            assert_eq!(back.stresses.len(), 3);
            for (one, other) in back.stresses.iter().flatten().zip(known.stresses.iter().flatten()) {
                assert!((one.value(0.4) / other.value(0.4) - 1.0).abs() < 1e-13);
            }
        }
    }
}
