//! What modifications take off a flank, for charts: along the profile in the middle of the face, and across the face.
//!
//! What is not a sum of both, such as a twist, is taken in the middle of the face and of the active flank. Must not know:
//! any single family, how a chart is drawn.

use gearmesh::gear::geometry::{GearPair, Side};
use gearmesh::gear::modification::Design;
use studygraph::table::columns::Columns;

pub const PROFILE: &str = "profile";
pub const LEAD: &str = "lead";

/// Regular places on a flank or a face; places where a depth is not smooth come to them.
const PLACES: usize = 200;

/// A place of a chart.
pub struct ChartRow<'a> {
    design: &'a str,
    side: Side,
    /// From 1.
    point: usize,
    /// Roll angle \[rad\] or z \[m\].
    place: f64,
    base_radius: f64,
    depth: f64,
}

fn chart<'a>(name: &str, description: &str) -> Columns<ChartRow<'a>> {
    Columns::new(name, description)
        .text("design", "Name of the design.", |row: &ChartRow<'a>| row.design)
        .key()
        .text("gear", "Which gear: pinion or gear.", |row| row.side.name())
        .key()
        .integer("point", "Counts the places, from 1.", |row| row.point)
        .key()
        .on_demand()
}

#[must_use]
pub fn profile<'a>() -> Columns<ChartRow<'a>> {
    let description = "Depth of all modifications of a gear along its active flank, in the middle of the face.";
    let depth = "What is taken off, normal to the flank; what changes across the face alone is not in it.";
    chart(PROFILE, description)
        .float("roll_angle", "deg", "Roll angle of the gear, from the root end to the tip.", |row| row.place)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("roll_length", "mm", "r_b times the roll angle.", |row| row.place * row.base_radius)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("radius", "mm", "r_b √(1 + u²).", |row| row.base_radius * (1.0 + row.place * row.place).sqrt())
        .float("depth", "um", depth, |row| row.depth)
        .but(|column| column.tolerance(1e-9, 1e-9))
}

#[must_use]
pub fn lead<'a>() -> Columns<ChartRow<'a>> {
    let description = "Depth of all modifications of a gear across its face, in the middle of the active flank.";
    let depth = "What is taken off, normal to the flank; what changes along the profile alone is not in it.";
    chart(LEAD, description)
        .float("z", "mm", "From the middle of the face.", |row| row.place)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("depth", "um", depth, |row| row.depth)
        .but(|column| column.tolerance(1e-9, 1e-9))
}

/// About so many rows has either table for a design.
pub const ROWS: usize = 2 * PLACES;

/// The rows of `profile` and of `lead` for a design.
#[must_use]
pub fn rows<'a>(design: &'a str, built: &Design, pair: &GearPair) -> [Vec<ChartRow<'a>>; 2] {
    let mut found = [Vec::new(), Vec::new()];
    for side in [Side::Pinion, Side::Gear] {
        let (gear, parts) = (pair.side(side), built.side(side));
        let base_radius = gear.base_radius;
        let ends = [pair.start_of_contact, pair.end_of_contact].map(|position| pair.roll(side, position));
        let [root, tip] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        let middle = 0.5 * (root + tip);
        let surface = |roll: f64, z: f64| -> f64 { parts.iter().map(|part| part.modification.surface(roll, z)).sum() };
        let row = |point: usize, place: f64, depth: f64| ChartRow { design, side, point, place, base_radius, depth };
        let breaks = parts.iter().flat_map(|part| part.modification.profile_breaks().iter().copied());
        let rolls = places(root, tip, breaks);
        found[0].extend(
            (1..).zip(rolls).map(|(point, roll)| row(point, roll, built.depth(side, roll) + surface(roll, 0.0))),
        );
        let breaks = parts.iter().flat_map(|part| part.modification.lead_breaks().iter().copied());
        let across = |z: f64| -> f64 { parts.iter().map(|part| part.modification.lead(z)).sum() };
        let half = 0.5 * gear.specification.face_width;
        let zs = places(-half, half, breaks);
        found[1].extend((1..).zip(zs).map(|(point, z)| row(point, z, across(z) + surface(middle, z))));
    }
    found
}

/// Regular places from `low` to `high`, and the breaks between.
fn places(low: f64, high: f64, breaks: impl Iterator<Item = f64>) -> Vec<f64> {
    let last = (PLACES - 1) as f64;
    let regular =
        (0..PLACES).map(|index| if index == PLACES - 1 { high } else { low + (high - low) * index as f64 / last });
    let mut all: Vec<f64> = regular.chain(breaks.filter(|place| *place > low && *place < high)).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearmesh::prelude::*;

    /// Parabolic tip relief is C(0.44 t + 0.56 t²) over its length before the tip, crowning C(2z/b)²; one is in the profile, the
    /// other in the lead, and neither in both.
    #[test]
    fn charts_are_the_closed_forms() {
        let gear = |teeth: u32, bore_radius: f64| Specification {
            teeth,
            module: 3e-3,
            pressure_angle: 20_f64.to_radians(),
            profile_shift: 0.0,
            thickness_allowance: 0.0,
            cutter: None,
            rack: Rack::ISO_53_A,
            tip_radius: None,
            face_width: 20e-3,
            bore_radius,
            material: Material::STEEL,
        };
        let pair = GearPair::new(gear(24, 18e-3), gear(36, 28e-3), None).unwrap();
        let (amount, start) = (Amount::Depth(12e-6), Start::Length(4e-3));
        let relief = TipRelief { amount, start, counted_from: FromTip::Tip, curve: Curve::Parabolic };
        let mut design = Design::default();
        design.add(Gears::Pinion, &relief, &pair).unwrap();
        design.add(Gears::Pinion, &LeadCrowning { amount: 4e-6 }, &pair).unwrap();
        let [profile, lead] = rows("d", &design, &pair);
        let pinion = |rows: &[ChartRow]| -> Vec<(f64, f64)> {
            rows.iter().filter(|row| row.side == Side::Pinion).map(|row| (row.place, row.depth)).collect()
        };
        let (along, across) = (pinion(&profile), pinion(&lead));
        let tip = along.last().unwrap().0;
        let base_radius = pair.pinion.base_radius;
        assert!(along.iter().any(|(_, depth)| *depth == 0.0) && along.iter().any(|(_, depth)| *depth > 0.0));
        for (roll, depth) in &along {
            let t = (1.0 - (tip - roll) * base_radius / 4e-3).max(0.0);
            assert!((depth - 12e-6 * (0.44 * t + 0.56 * t * t)).abs() < 1e-18, "{roll}: {depth}");
        }
        for (z, depth) in &across {
            assert!((depth - 4e-6 * (2.0 * z / 20e-3).powi(2)).abs() < 1e-18, "{z}: {depth}");
        }
        assert_eq!((across[0].0, across[across.len() - 1].0), (-10e-3, 10e-3));
        // Where the relief starts is a place of its own, and the gear has nothing.
        assert_eq!(along.len(), PLACES + 1);
        assert!(profile.iter().chain(&lead).filter(|row| row.side == Side::Gear).all(|row| row.depth == 0.0));
    }
}
