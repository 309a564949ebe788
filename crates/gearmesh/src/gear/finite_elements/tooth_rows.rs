//! The rows of nodes of a tooth, from where it is cut off the body up to its tip.
//!
//! A row is an arc through both flanks. Where the tip is broken by a chamfer or a rounding the last row lies on it, and
//! those beneath go over into arcs. Lengths in modules. Must not know: elements, elasticity.

use super::outline::{Division, Outline, Stretch};

/// How much steeper than the circumference the cut curve dips at its ends \[rad\]: the angles about its end are then
/// 45°, 67.5° and 67.5°.
const DIP: f64 = std::f64::consts::PI / 8.0;
/// How far beneath a broken tip rows are arcs again, over what it moves them by.
const FADE: f64 = 4.0;
/// The same over the length of the flank, at most.
const LONGEST_FADE: f64 = 0.5;

/// The points of a chain of stretches; where two meet there is only one.
pub(super) fn chain(stretches: &[Stretch], divisions: &[Division], parts: usize) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for (stretch, division) in stretches.iter().zip(divisions) {
        points.pop();
        points.extend(division.parameters(parts).into_iter().map(|parameter| stretch.point(parameter)));
    }
    points
}

/// The rows of the tooth: arcs through both flanks, whose slope at the right end goes over from the cut to the tip.
pub(super) struct ToothRows<'a> {
    points: &'a [[f64; 2]],
    slopes: Vec<f64>,
    /// Parts of the way from the right flank to the left, node by node.
    across: &'a [f64],
    /// From the last arc to the tip, node by node, if that is broken; and how much of it each row has.
    broken: Vec<[f64; 2]>,
    fades: Vec<f64>,
}

impl<'a> ToothRows<'a> {
    pub(super) fn new(outline: &Outline, points: &'a [[f64; 2]], across: &'a [f64]) -> Self {
        let [x, y] = points[0];
        let radius = libm::hypot(x, y);
        let angle = libm::atan2(x, y);
        // Not nearer to the bore than half way from the cut.
        let highest = 2.0 * libm::atan((outline.bore_radius + 0.5 * (radius - outline.bore_radius) - y) / x);
        let first = (angle - DIP).max(highest).min(angle);
        let last = outline.tip_half_angle;
        let mut lengths = vec![0.0];
        for pair in points.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + distance(pair[0], pair[1]));
        }
        let total = lengths[lengths.len() - 1];
        let slopes = lengths.iter().map(|length| first + (last - first) * length / total).collect();
        let mut rows = Self { points, slopes, across, broken: Vec::new(), fades: Vec::new() };
        if let [edge, land] = &outline.top[..] {
            let moved = (top([edge, land], across).into_iter().enumerate())
                .map(|(place, [x, y])| {
                    let [p, q] = rows.on_arc(points.len() - 1, across[place]);
                    [x - p, y - q]
                })
                .collect::<Vec<_>>();
            let largest = moved.iter().map(|step| distance(*step, [0.0; 2])).fold(0.0, f64::max);
            let reach = (FADE * largest).min(LONGEST_FADE * total);
            rows.fades = lengths.iter().map(|length| (1.0 - (total - length) / reach).max(0.0)).collect();
            rows.broken = moved;
        }
        rows
    }

    /// The point of a row, by its place from the right flank to the left.
    pub(super) fn point(&self, row: usize, place: usize) -> [f64; 2] {
        let point = self.on_arc(row, self.across[place]);
        let (Some(fade), Some(step)) = (self.fades.get(row), self.broken.get(place)) else { return point };
        [0, 1].map(|axis| point[axis] + fade * fade * step[axis])
    }

    /// The point of a row that is an arc, at a part of the way from the right flank to the left.
    fn on_arc(&self, row: usize, part: f64) -> [f64; 2] {
        let ([x, y], slope) = (self.points[row], self.slopes[row]);
        let place = 1.0 - 2.0 * part;
        if part <= 0.0 || part >= 1.0 {
            return [x * place, y];
        }
        if slope.abs() < 1e-9 {
            return [x * place, y];
        }
        let sine = libm::sin(slope);
        let rise = 2.0 * libm::sin(0.5 * slope * (1.0 + place)) * libm::sin(0.5 * slope * (1.0 - place)) / sine;
        [x * libm::sin(slope * place) / sine, y + x * rise]
    }
}

fn distance([x, y]: [f64; 2], [p, q]: [f64; 2]) -> f64 {
    libm::hypot(p - x, q - y)
}

/// The points of a row on a broken tip, from the right flank to the left: a chamfer or the rest of a rounding, and the
/// land. A corner of an element is where they meet.
fn top([edge, land]: [&Stretch; 2], across: &[f64]) -> Vec<[f64; 2]> {
    let middle = (across.len() - 1) / 2;
    let [long, short] = [edge, land].map(Stretch::length);
    let share = 0.5 * long / (long + short);
    let corners = (2..middle).step_by(2);
    let nearer = |a: usize, b: usize| if (across[b] - share).abs() < (across[a] - share).abs() { b } else { a };
    let junction = corners.reduce(nearer).unwrap_or(middle);
    let half = (0..=middle).map(|place| {
        let (stretch, from, to) = if place <= junction { (edge, 0, junction) } else { (land, junction, middle) };
        let part = (across[place] - across[from]) / (across[to] - across[from]);
        stretch.point(stretch.lower + (stretch.upper - stretch.lower) * part)
    });
    let half: Vec<[f64; 2]> = half.collect();
    let mirrored = half[..middle].iter().rev().map(|&[x, y]| [-x, y]);
    half.iter().copied().chain(mirrored).collect()
}
