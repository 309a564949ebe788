//! Pressures of a stage of the kind `ste`: columns of its summary and its curve, the table `pressure`, what is warned of.
//!
//! Must not know: how a pressure is found.

use super::rows::{Contacts, Keyed, Load, PAIRS as COUNT, PointRow, keyed};
use crate::stage::names::{curve, summary};
use crate::stage::{Context, Demand};
use gearmesh::gear::mesh::answers::corner_stretches::CornerStretches;
use gearmesh::gear::mesh::answers::face_map::Cell;
use gearmesh::gear::mesh::answers::quantities::{Need, QUANTITIES};
use gearmesh::gear::mesh::{Loaded, Mesh};
use studygraph::table::columns::Columns;
use studygraph::table::schema::Column;
use studygraph::warning::{Cases, Warning};

/// The table of path and face.
pub const TABLE: &str = "pressure";

/// A pair by how many pitches it is ahead of the newest one inside the path of contact.
struct OfPair {
    ahead: isize,
    which: &'static str,
    pressure: &'static str,
    half_width: &'static str,
}

macro_rules! pairs {
    ($($ahead:literal $name:literal $which:literal),* $(,)?) => {
        [$(OfPair {
            ahead: $ahead,
            which: $which,
            pressure: concat!($name, "_pressure"),
            half_width: concat!($name, "_half_width"),
        }),*]
    };
}

/// All that a position may have: with corner contact there is one before A.
const PAIRS: [OfPair; COUNT] = pairs![
    -1 "coming" "the pair before A",
    0 "newest" "the pair that came into contact last",
    1 "second" "the pair one pitch ahead of the newest",
    2 "third" "the pair two pitches ahead of the newest",
    3 "fourth" "the pair three pitches ahead of the newest",
    4 "fifth" "the pair four pitches ahead of the newest",
    5 "sixth" "the pair five pitches ahead of the newest",
];

/// Columns of the summary beside those of [`QUANTITIES`].
const PAIR: &str = "pressure_pair";
const CORNER: &str = "corner_load_share";

/// Whether anything that is demanded takes the contacts of all pairs of a curve.
pub fn of_pairs_are_wanted(demand: &Demand) -> bool {
    let wanted = |name: &str| demand.column(curve::TABLE, name);
    PAIRS.iter().any(|pair| wanted(pair.pressure) || wanted(pair.half_width))
}

/// Whether anything that is demanded takes the pressure at every position.
pub fn are_wanted(demand: &Demand) -> bool {
    let of_curve = QUANTITIES.iter().filter(|quantity| quantity.need == Need::Pressure).map(|quantity| quantity.name);
    of_curve.chain([PAIR, CORNER]).any(|name| demand.column(summary::TABLE, name))
        || demand.column(curve::TABLE, curve::PRESSURE)
        || of_pairs_are_wanted(demand)
        || demand.table(TABLE)
}

/// The pair with the largest pressure.
pub fn of_pair(columns: Columns<Keyed<'_>>) -> Columns<Keyed<'_>> {
    let about = "How many pitches that pair is ahead of the newest inside the path of contact; -1 before A.";
    columns
        .integer(PAIR, about, |row: &Keyed| row.2.summary.largest_pressure.map_or(0, |largest| largest.ahead))
        .but(Column::on_demand)
}

/// The load on sharp corners.
pub fn of_corner(columns: Columns<Keyed<'_>>) -> Columns<Keyed<'_>> {
    let about =
        "Largest share of the load on a pair that the sharp corner of a tip touches: the pressure is infinite there.";
    columns
        .float(CORNER, "", about, |row: &Keyed| row.2.cornered.as_ref().map_or(0.0, |cornered| cornered.share))
        .but(|column| column.on_demand().tolerance(1e-9, 1e-6))
}

/// Pressure and half width of each pair, where its face is loaded most.
pub fn of_curve(columns: Columns<PointRow<'_>>) -> Columns<PointRow<'_>> {
    PAIRS.iter().enumerate().fold(columns, |columns, (index, pair)| {
        let of = move |row: &PointRow| row.2.contacts.map(|contacts| contacts[index]);
        let pressure = format!("Largest pressure of {}.", pair.which);
        let half_width = format!("Half the width of the contact of {}, where its face is loaded most.", pair.which);
        columns
            .float(pair.pressure, "MPa", &pressure, move |row| of(row).map_or(f64::NAN, |contact| contact.pressure))
            // Pressure and width go with the square root of a load that begins.
            .but(|column| column.on_demand().tolerance(1e-3, 1e-9))
            .float(pair.half_width, "um", &half_width, move |row| {
                of(row).map_or(f64::NAN, |contact| contact.half_width)
            })
            .but(|column| column.on_demand().tolerance(1e-4, 1e-9))
    })
}

/// The contacts at a position of a curve.
pub fn contacts(loading: &Loaded, position: f64, pairs: usize) -> Contacts {
    let by_spring = loading.contacts(position, pairs, &loading.state(position, pairs));
    let newest = loading.mesh().newest().cast_signed();
    PAIRS.each_ref().map(|pair| {
        let spring = usize::try_from(newest + pair.ahead).ok();
        spring.and_then(|spring| by_spring.get(spring)).copied().unwrap_or_default()
    })
}

/// A place of the map.
pub type CellRow<'a> = Keyed<'a, Cell>;

/// The map.
pub fn map<'a>(stated: &[usize]) -> Columns<CellRow<'a>> {
    let description = "Load per width and pressure over the path of contact and the face, on a regular grid of both.";
    let step = "Counts the positions of the pair: from 0 in A, so many in a base pitch; below 0 before A.";
    let strip = "Counts the strips of the face, equally wide, from 1; one where nothing varies across it.";
    let position = "Distance of the pair from A along the line of action.";
    let corner = "Whether the sharp corner of a tip is in contact: the pressure is infinite there.";
    keyed(TABLE, description, stated)
        .integer("step", step, |row: &CellRow| row.2.step)
        .key()
        .integer("strip", strip, |row| row.2.strip)
        .key()
        .float("path_position", "mm", position, |row| row.2.path_position)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("roll_angle", "deg", "The pinion's roll angle where the pair touches.", |row| row.2.roll_angle)
        .float("z", "mm", "Middle of the strip, from the middle of the face.", |row| row.2.z)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("load_per_width", "N/mm", "Mean load per width of the strip.", |row| row.2.contact.load)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("pressure", "MPa", "Largest pressure under that load.", |row| row.2.contact.pressure)
        .but(|column| column.tolerance(1e-3, 1e-9))
        .float("half_width", "um", "Half the width of the contact under that load.", |row| row.2.contact.half_width)
        .but(|column| column.tolerance(1e-4, 1e-9))
        .flag("at_corner", corner, |row| row.2.contact.at_corner)
        .on_demand()
}

/// Says of which designs under which torques a sharp corner is in contact: how much of the load it has and where, and whether
/// it is the largest pressure.
pub fn warn(context: &Context, cycle: &Mesh, answers: &[Keyed]) {
    let what = if cycle.knows_corners() {
        "the contact reaches the sharp corner of a tip, where the pressure is infinite; the pressures there are those of a \
         contact that just reaches it"
    } else {
        "the sharp corner of a tip touches, where the pressure is infinite; this law of contact does not know it, and the \
         pressures there are those of the flank beside it"
    };
    for (design, Load { torque, .. }, answer) in answers {
        let Some(CornerStretches { share, stretches }) = &answer.cornered else { continue };
        let is_largest = answer.summary.largest_pressure.is_some_and(|largest| largest.contact.at_corner);
        let largest = if is_largest { ", the largest of the curve among them" } else { "" };
        let stretches: Vec<String> =
            stretches.iter().map(|[from, to]| format!("{:.3} to {:.3} mm", from * 1e3, to * 1e3)).collect();
        let sentence = format!(
            "design `{design}` at {torque} N m: {what}{largest}. It has up to {:.1} % of the load, on {} of the mesh cycle",
            100.0 * share,
            stretches.join(" and "),
        );
        let case = Cases::one("sharp corner", design, (*torque, "N m"), (*share, sentence));
        (context.warn)(Warning::Cases(case.with_each("`summary.corner_load_share`")));
    }
}
