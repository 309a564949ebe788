//! Points on an outline: a number per tooth, or as many as keep every chord within a distance of its curve.
//!
//! The points are exact; only the chords between them are not. Must not know: files, drawings.

use std::f64::consts::PI;

use super::Outline;
use super::curve::{Local, Segment};

/// How densely points lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Density {
    /// Points per tooth, at least; every segment has its ends.
    pub points: usize,
    /// The farthest a chord may lie from its curve \[m\].
    pub chord_error: Option<f64>,
}

/// The most chords of a segment, used when a chord error cannot be met.
const MOST_CHORDS: usize = 1 << 14;

/// A point of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Index of the segment it lies on; the end of the last one, or else the beginning of the next.
    pub segment: usize,
    /// The segment's own parameter.
    pub parameter: f64,
    /// In the tooth's frame.
    pub local: Local,
    /// Whether it lies on the left half, the mirror image.
    pub mirrored: bool,
}

impl Point {
    /// The mirror image on the left half of the tooth.
    #[must_use]
    fn image(mut self) -> Self {
        self.local.position[0] = -self.local.position[0];
        self.local.tangent[1] = -self.local.tangent[1];
        self.mirrored = true;
        self
    }
}

impl Outline {
    /// The curves of the right half of a tooth, upwards, each with both its ends.
    fn curves(&self, density: Density) -> Vec<Vec<Point>> {
        let chords = self.chords(density);
        let curve = |(index, (segment, &count)): (usize, (&Segment, &usize))| {
            let point = |step: usize| {
                let parameter = segment.parameter(step as f64 / count as f64);
                Point { segment: index, parameter, local: segment.local(parameter), mirrored: false }
            };
            (0..=count).map(point).collect()
        };
        self.segments.iter().zip(&chords).enumerate().map(curve).collect()
    }

    /// The right half of a tooth, from the middle of the space to the tooth's centreline, both included.
    #[must_use]
    pub fn half(&self, density: Density) -> Vec<Point> {
        let curves = self.curves(density);
        let mut points: Vec<Point> = curves.iter().flat_map(|curve| &curve[..curve.len() - 1]).copied().collect();
        points.extend(curves.last().and_then(|curve| curve.last()));
        points
    }

    /// One tooth with half a space on either side, counterclockwise; the first and the last point are a pitch apart.
    #[must_use]
    pub fn tooth(&self, density: Density) -> Vec<Point> {
        let mut points = self.half(density);
        let left: Vec<Point> = points.iter().rev().skip(1).map(|point| point.image()).collect();
        points.extend(left);
        points
    }

    /// The same, curve by curve, each with both its ends; the tip land is one curve.
    #[must_use]
    pub fn tooth_by_curves(&self, density: Density) -> Vec<Vec<Point>> {
        let mut curves = self.curves(density);
        let mirrored = |curve: &Vec<Point>| -> Vec<Point> { curve.iter().rev().map(|point| point.image()).collect() };
        let left: Vec<Vec<Point>> = curves.iter().rev().map(mirrored).collect();
        let mut left = left.into_iter();
        if let (Some(top), Some(other)) = (curves.last_mut(), left.next()) {
            top.extend_from_slice(&other[1..]);
        }
        curves.extend(left);
        curves
    }

    /// How many points [`Outline::half`] has, without making them.
    #[must_use]
    pub fn points_of_half(&self, density: Density) -> usize {
        self.chords(density).iter().sum::<usize>() + 1
    }

    /// How many points [`Outline::tooth_by_curves`] has on all its curves, without making them.
    #[must_use]
    pub fn points_by_curves(&self, density: Density) -> usize {
        // Every curve has both its ends, the tip land in the middle its middle once.
        2 * (self.points_of_half(density) - 1 + self.segments.len()) - 1
    }

    /// The whole gear, counterclockwise from the middle of the space to the right of the tooth on the y axis; closed,
    /// without a repeated point.
    #[must_use]
    pub fn whole(&self, density: Density) -> Vec<[f64; 2]> {
        let half = self.half(density);
        // The last point of a tooth is the first of the next.
        let right = half.iter().map(|point| point.local.position);
        let left = half.iter().rev().skip(1).map(|point| [-point.local.position[0], point.local.position[1]]);
        let tooth: Vec<[f64; 2]> = right.chain(left).take(2 * (half.len() - 1)).collect();
        let mut points = Vec::with_capacity(tooth.len() * self.teeth as usize);
        for number in 0..self.teeth {
            let (sine, cosine) = libm::sincos(2.0 * PI * f64::from(number) / f64::from(self.teeth));
            points.extend(tooth.iter().map(|[x, y]| [cosine * x - sine * y, sine * x + cosine * y]));
        }
        points
    }

    /// How many chords each segment is given.
    fn chords(&self, density: Density) -> Vec<usize> {
        let lengths: Vec<f64> = self.segments.iter().map(length).collect();
        let total: f64 = lengths.iter().sum();
        let half = density.points.div_ceil(2);
        // One each, and the rest by length: whole numbers first, then the largest remainders.
        let rest = half.saturating_sub(self.segments.len()) as f64;
        let shares: Vec<f64> =
            lengths.iter().map(|length| if total > 0.0 { rest * length / total } else { 0.0 }).collect();
        // A share of the points asked for, which fits an index.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let mut chords: Vec<usize> = shares.iter().map(|share| 1 + *share as usize).collect();
        let mut order: Vec<usize> = (0..chords.len()).collect();
        order.sort_by(|&a, &b| (shares[b] - shares[b].floor()).total_cmp(&(shares[a] - shares[a].floor())));
        let missing = half.saturating_sub(chords.iter().sum());
        for &index in order.iter().take(missing) {
            chords[index] += 1;
        }
        if let Some(error) = density.chord_error {
            for (count, segment) in chords.iter_mut().zip(&self.segments) {
                while *count < MOST_CHORDS && farthest(segment, *count) > error {
                    *count += count.div_ceil(2);
                }
            }
        }
        chords
    }
}

/// About the length of a segment \[m\].
fn length(segment: &Segment) -> f64 {
    let points: Vec<[f64; 2]> =
        (0..=8).map(|step| segment.curve.point(segment.parameter(f64::from(step) / 8.0))).collect();
    points.windows(2).map(|pair| libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1])).sum()
}

/// How far the middles of the chords lie from the curve, at most \[m\].
fn farthest(segment: &Segment, count: usize) -> f64 {
    let at = |place: usize| segment.curve.point(segment.parameter(place as f64 / (2 * count) as f64));
    let sagitta = |chord: usize| {
        let ([a, b], [c, d], [x, y]) = (at(2 * chord), at(2 * chord + 2), at(2 * chord + 1));
        let length = libm::hypot(c - a, d - b);
        if length > 0.0 { ((x - a) * (d - b) - (y - b) * (c - a)).abs() / length } else { 0.0 }
    };
    (0..count).map(sagitta).fold(0.0, f64::max)
}
