//! The pair in mesh as curves to draw: three teeth of each gear, path of contact with its points A to E, circles.
//!
//! Frame: the pinion's centre is the origin, the gear's is at (0, a_w); a tooth of the pinion points at a space of the
//! gear. Must not know: how it is drawn.

use std::f64::consts::PI;

use super::drawn::{Drawn, LINE};
use gearmesh::gear::geometry::outline::sample::Density;
use gearmesh::gear::geometry::{GearPair, Side};
use studygraph::table::columns::Columns;

/// Half the angle of the circles that are drawn, in pitches.
const REACH: f64 = 1.6;
/// Points of an arc of a circle.
const ARC: usize = 60;

/// A point of a curve.
pub struct DrawnPoint {
    curve: &'static str,
    line: &'static str,
    /// From 1, as the point.
    run: usize,
    point: usize,
    at: [f64; 2],
}

#[must_use]
pub fn columns() -> Columns<DrawnPoint> {
    let description = "The pair in mesh: teeth near the pitch point, path of contact, and circles. The pinion's centre \
                       is the origin.";
    let curve = "What is drawn: a gear, a line, circles, or one of the points A to E.";
    let run = "Counts lines that do not meet, such as the circles of the two gears.";
    Columns::new("mesh_drawing", description)
        .text("curve", curve, |row: &DrawnPoint| row.curve)
        .key()
        .integer("run", run, |row| row.run)
        .key()
        .integer("point", "Number of the point on it.", |row| row.point)
        .key()
        .text("line", LINE, |row| row.line)
        .float("x", "mm", "Across the line of centres.", |row| row.at[0])
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("y", "mm", "Along the line of centres, from the pinion to the gear.", |row| row.at[1])
        .but(|column| column.tolerance(1e-9, 1e-9))
        .on_demand()
}

/// The rows of a pair with its two profiles, the pinion's and the gear's.
#[must_use]
pub fn rows(pair: &GearPair, gears: &[Drawn], density: Density) -> Vec<DrawnPoint> {
    let [pinion, gear] = gears else { return Vec::new() };
    let mut lines: Vec<(&'static str, &'static str, Vec<[f64; 2]>)> = Vec::new();
    let half_gear_pitch = PI / f64::from(pair.gear.specification.teeth);
    lines.push(("pinion", "wide", teeth(pinion, density, -1..=1, 0.0)));
    let upside_down = teeth(gear, density, -2..=1, half_gear_pitch);
    lines.push(("gear", "wide", upside_down.into_iter().map(|point| opposite(pair, point)).collect()));
    let (sine, cosine) = libm::sincos(pair.working_pressure_angle);
    let on_path = |s: f64| {
        let foot = pair.pinion.base_radius;
        [s * cosine - foot * sine, foot * cosine + s * sine]
    };
    lines.push(("line of action", "narrow", vec![on_path(0.0), on_path(pair.tangent_length)]));
    lines.push(("path of contact", "wide", vec![on_path(pair.start_of_contact), on_path(pair.end_of_contact)]));
    let zone = pair.zone_points();
    let points = [("A", zone.a), ("B", zone.b), ("C", zone.c), ("D", zone.d), ("E", zone.e)];
    lines.extend(points.map(|(name, s)| (name, "wide", vec![on_path(s)])));
    for side in [Side::Pinion, Side::Gear] {
        let of = pair.side(side);
        let reach = REACH * 2.0 * PI / f64::from(of.specification.teeth);
        let circles = [
            ("base circles", "dashed", of.base_radius),
            ("pitch circles", "dash-dotted", of.base_radius / cosine),
            ("tip circles", "narrow", of.tip_radius),
        ];
        for (name, line, radius) in circles {
            let arc = (0..=ARC).map(|step| {
                let (sine, cosine) = libm::sincos(reach * (2.0 * step as f64 / ARC as f64 - 1.0));
                let point = [radius * sine, radius * cosine];
                if side == Side::Pinion { point } else { opposite(pair, point) }
            });
            lines.push((name, line, arc.collect()));
        }
    }
    let mut rows = Vec::new();
    for (at, (name, line, points)) in lines.iter().enumerate() {
        let run = 1 + lines[..at].iter().filter(|(other, ..)| other == name).count();
        rows.extend((1..).zip(points).map(|(point, &at)| DrawnPoint { curve: name, line, run, point, at }));
    }
    rows
}

/// How many rows [`rows`] gives, where the profiles have so many points on half a tooth.
#[must_use]
pub fn count(halves: [usize; 2]) -> usize {
    let teeth = |number: usize, half: usize| number * 2 * (half - 1) + 1;
    teeth(3, halves[0]) + teeth(4, halves[1]) + 2 * 2 + 5 + 6 * (ARC + 1)
}

/// From the gear's own frame, y towards the pinion, to the pair's.
fn opposite(pair: &GearPair, [x, y]: [f64; 2]) -> [f64; 2] {
    [-x, pair.centre_distance - y]
}

/// Neighbouring teeth in the gear's own frame, turned by an angle.
fn teeth(drawn: &Drawn, density: Density, numbers: std::ops::RangeInclusive<i32>, turn: f64) -> Vec<[f64; 2]> {
    let tooth = drawn.outline.tooth(density);
    let first = *numbers.start();
    numbers
        .flat_map(|number| {
            let angle = turn + 2.0 * drawn.outline.half_pitch() * f64::from(number);
            let (sine, cosine) = libm::sincos(angle);
            let points = tooth.iter().skip(usize::from(number > first)).map(move |point| {
                let [x, y] = point.local.position;
                [cosine * x - sine * y, sine * x + cosine * y]
            });
            points.collect::<Vec<_>>()
        })
        .collect()
}
