//! The article's root arc as curves to draw: circles, centre, tangent, the angle θ, the points A, B, C (zhai2020, Figures 12
//! and 14).
//!
//! Frame: the gear's, with the tooth's centreline on the y axis. Must not know: how it is drawn.

use std::f64::consts::{FRAC_PI_2, PI};

use super::drawn::{Drawn, LINE, of_gear};
use gearmesh::gear::geometry::Side;
use gearmesh::gear::geometry::outline::curve::OutlinePart;
use gearmesh::gear::geometry::outline::sample::Density;
use gearmesh::gear::problem::root_arc::RootArc;
use studygraph::table::columns::Columns;

/// Points of an arc.
const ARC: u32 = 90;

/// A point of a curve.
pub struct ArcPoint {
    side: Side,
    curve: &'static str,
    line: &'static str,
    /// From 1, as the run.
    point: usize,
    run: usize,
    step: &'static str,
    at: [f64; 2],
}

#[must_use]
pub fn columns() -> Columns<ArcPoint> {
    let description = "How zhai2020 constructs the root arc: right half of a tooth, circles, points; no rows where \
                       there is no such arc.";
    let step = "boundary: up to the tangent in A (Figure 12); arc: what follows from it (Figure 14).";
    of_gear(Columns::new("arc_drawing", description), |row: &ArcPoint| row.side)
        .text("curve", "What is drawn; A, B, C and θ are points.", |row| row.curve)
        .key()
        .integer("point", "Number of the point on it.", |row| row.point)
        .key()
        .integer("run", "Counts lines of one name that do not meet.", |row| row.run)
        .text("step", step, |row| row.step)
        .text("line", LINE, |row| row.line)
        .float("x", "mm", "Place across, in the gear's frame.", |row| row.at[0])
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("y", "mm", "Place upwards, in the gear's frame.", |row| row.at[1])
        .but(|column| column.tolerance(1e-9, 1e-9))
        .on_demand()
}

/// The most rows of a gear with so many points on half a tooth.
#[must_use]
pub fn maximum(half: usize) -> usize {
    // Eight arcs or less, and a few points.
    half + 8 * (ARC as usize + 1)
}

struct Part {
    curve: &'static str,
    line: &'static str,
    step: &'static str,
    runs: Vec<Vec<[f64; 2]>>,
}

#[must_use]
pub fn rows(drawn: &Drawn, density: Density) -> Vec<ArcPoint> {
    let Ok(arc) = RootArc::new(&drawn.gear) else { return Vec::new() };
    let (base, circle) = (arc.base, arc.article());
    let ([a, c], r) = ([base.a, circle.centre], circle.radius);
    // B is the lowest point of the arc on the page.
    let b = [c[0], c[1] - r];
    let about = |[x, y]: [f64; 2], radius: f64, from: f64, to: f64| -> Vec<[f64; 2]> {
        let point = |step: u32| {
            let (sine, cosine) = libm::sincos(from + (to - from) * f64::from(step) / f64::from(ARC));
            [x + radius * cosine, y + radius * sine]
        };
        (0..=ARC).map(point).collect()
    };
    let reach = 1.6 * base.half_pitch;
    let whole = |radius: f64| vec![about([0.0; 2], radius, FRAC_PI_2 - reach, FRAC_PI_2)];
    let along = |from: f64, to: f64, angle: f64| {
        let (sine, cosine) = libm::sincos(angle);
        vec![[from * sine, from * cosine], [to * sine, to * cosine]]
    };
    let flank = drawn.outline.half(density).into_iter();
    let flank = flank.filter(|point| drawn.outline.segments[point.segment].part == OutlinePart::Flank);
    // As far above the base circle as the root circle is below it.
    let high = 2.0 * base.base_radius - base.root_radius;
    let flank = flank.map(|point| point.local.position).filter(|[x, y]| libm::hypot(*x, *y) <= high);
    let flank: Vec<[f64; 2]> = flank.collect();
    let line = |curve, line, step, runs| Part { curve, line, step, runs };
    let lines = [
        line("flank", "wide", "boundary", vec![flank]),
        line("base circle", "dashed", "boundary", whole(base.base_radius)),
        line("root circle", "narrow", "boundary", whole(base.root_radius)),
        line(
            "centrelines of tooth and space",
            "dash-dotted",
            "boundary",
            vec![
                along(base.root_radius - 0.3 * r, high, 0.0),
                along(base.root_radius - 0.3 * r, high, base.half_pitch),
            ],
        ),
        line("tangent in A", "narrow", "boundary", vec![along(base.root_radius, high, base.angle)]),
        line("arc", "wide", "arc", vec![about(c, r, PI - base.angle, 1.5 * PI)]),
        line(
            "rest of its circle, with the radii to A and B",
            "dashed",
            "arc",
            vec![about(c, r, 1.5 * PI, 3.0 * PI - base.angle), vec![a, c, b]],
        ),
        // Between the radius to A and the horizontal through C.
        line(
            "angle θ",
            "narrow",
            "arc",
            vec![about(c, 0.7 * r, PI - base.angle, PI), vec![c, [c[0] - 0.85 * r, c[1]]]],
        ),
        line("A", "wide", "boundary", vec![vec![a]]),
        line("B", "wide", "arc", vec![vec![b]]),
        line("C", "wide", "arc", vec![vec![c]]),
        line(
            "θ",
            "wide",
            "arc",
            vec![about(c, 0.7 * r, PI - base.angle, PI)[ARC as usize / 2..=ARC as usize / 2].to_vec()],
        ),
    ];
    let mut rows = Vec::new();
    for Part { curve, line, step, runs } in lines {
        let points = (1..).zip(&runs).flat_map(|(run, points)| points.iter().map(move |&at| (run, at)));
        let row = |(point, (run, at))| ArcPoint { side: drawn.side, curve, line, point, run, step, at };
        rows.extend((1..).zip(points).map(row));
    }
    rows
}
