//! What is drawn of a gear: lines, arcs and chords, one behind the other, counterclockwise, in mm.
//!
//! Must not know: file formats.

use crate::stage::names;
use std::f64::consts::{FRAC_PI_2, PI};

use crate::stage::pair::si;
use declare::error::Failure;
use studygraph::table::data::Table;

/// A point of the table `outline`.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    pub tooth: i64,
    pub number: i64,
    pub part: String,
    pub curve: String,
    /// \[mm\].
    pub at: [f64; 2],
    /// Direction of the tangent \[rad\].
    direction: f64,
    /// \[1/mm\], positive to the left.
    curvature: f64,
}

/// One curve of a contour.
#[derive(Clone, Debug, PartialEq)]
pub enum Piece {
    Line {
        start: [f64; 2],
        end: [f64; 2],
    },
    Arc {
        centre: [f64; 2],
        radius: f64,
        /// Angle of the start from the x axis \[rad\].
        from: f64,
        /// Angle from the start to the end \[rad\], positive counterclockwise.
        turn: f64,
        ends: [[f64; 2]; 2],
    },
    /// Chords between the points of this range of [`Contour::points`].
    Chords(std::ops::Range<usize>),
}

/// The profile of one gear.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    pub gear: String,
    /// Around the whole gear.
    pub closed: bool,
    /// \[mm\]; 0 without a bore.
    pub bore_radius: f64,
    pub pieces: Vec<Piece>,
    pub points: Vec<Point>,
}

/// Shorter curves are left out \[mm\]: they are where two curves meet without anything between them.
const NOTHING: f64 = 1e-12;

/// The contours in a table of points, gear by gear.
///
/// # Errors
/// When a gear has no bore in the other table, or a curve is not an arc although the table says so.
pub fn contours(outline: &Table, gears: &Table) -> Result<Vec<Contour>, Failure> {
    let mut contours: Vec<Contour> = Vec::new();
    let mut stretch = None;
    let mut begin = 0;
    for row in 0..outline.rows() {
        let gear = &outline.texts(names::outline::GEAR)[row];
        if contours.last().is_none_or(|contour| contour.gear != *gear) {
            let place = gears.texts(names::gears::GEAR).iter().position(|name| name == gear);
            let place = place.ok_or_else(|| Failure::new(format!("the geometry has no row for the {gear}")))?;
            let bore_radius = 1e3 * si(gears, names::gears::BORE_RADIUS, place);
            let (pieces, points) = (Vec::new(), Vec::new());
            contours.push(Contour { gear: gear.clone(), closed: false, bore_radius, pieces, points });
        }
        let Some(contour) = contours.last_mut() else { continue };
        let value = |column: &str| outline.floats(column)[row];
        contour.points.push(Point {
            tooth: outline.integers(names::outline::TOOTH)[row],
            number: outline.integers(names::outline::POINT)[row],
            part: outline.texts(names::outline::PART)[row].clone(),
            curve: outline.texts(names::outline::CURVE)[row].clone(),
            at: [value(names::outline::X), value(names::outline::Y)],
            direction: value(names::outline::DIRECTION).to_radians(),
            curvature: value(names::outline::CURVATURE),
        });
        let now = Some((
            gear.clone(),
            outline.integers(names::outline::TOOTH)[row],
            outline.integers(names::outline::STRETCH)[row],
        ));
        if now != stretch {
            (stretch, begin) = (now.clone(), contour.points.len() - 1);
        }
        let next = row + 1;
        let goes_on = next < outline.rows()
            && now
                == Some((
                    outline.texts(names::outline::GEAR)[next].clone(),
                    outline.integers(names::outline::TOOTH)[next],
                    outline.integers(names::outline::STRETCH)[next],
                ));
        if !goes_on {
            contour.take(begin)?;
        }
    }
    for contour in &mut contours {
        contour.closed = contour.points.last().is_some_and(|last| last.tooth > 1);
    }
    Ok(contours)
}

fn distance([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    libm::hypot(c - a, d - b)
}

/// An angle moved by whole turns to −π…π.
fn wrapped(angle: f64) -> f64 {
    angle - 2.0 * PI * (angle / (2.0 * PI)).round()
}

impl Contour {
    /// Makes a piece of the points from `begin` on.
    fn take(&mut self, begin: usize) -> Result<(), Failure> {
        let points = &self.points[begin..];
        let (Some(first), Some(last)) = (points.first(), points.last()) else { return Ok(()) };
        if points.windows(2).map(|pair| distance(pair[0].at, pair[1].at)).sum::<f64>() < NOTHING {
            return Ok(());
        }
        let piece = match first.curve.as_str() {
            "line" => Piece::Line { start: first.at, end: last.at },
            "arc" => self.arc(begin)?,
            _ => Piece::Chords(begin..self.points.len()),
        };
        self.pieces.push(piece);
        Ok(())
    }

    fn arc(&self, begin: usize) -> Result<Piece, Failure> {
        let points = &self.points[begin..];
        let (first, last) = (&points[0], &points[points.len() - 1]);
        let (sine, cosine) = libm::sincos(first.direction);
        let away = 1.0 / first.curvature;
        let centre = [first.at[0] - away * sine, first.at[1] + away * cosine];
        let radius = away.abs();
        let off = |point: &&Point| (distance(centre, point.at) - radius).abs() > 1e-9 * (1.0 + radius);
        if let Some(point) = points.iter().find(off) {
            return Err(Failure::new(format!(
                "point {} of tooth {} of the {} lies on no arc although it should",
                point.number, point.tooth, self.gear
            )));
        }
        // From point to point, so that no arc is too long to be told from its complement.
        let turn = points.windows(2).map(|pair| wrapped(pair[1].direction - pair[0].direction)).sum();
        let from = first.direction - FRAC_PI_2.copysign(away);
        Ok(Piece::Arc { centre, radius, from, turn, ends: [first.at, last.at] })
    }

    /// Start and end of a piece.
    #[must_use]
    pub fn ends(&self, piece: &Piece) -> [[f64; 2]; 2] {
        match piece {
            Piece::Line { start, end } => [*start, *end],
            Piece::Arc { ends, .. } => *ends,
            Piece::Chords(range) => [self.points[range.start].at, self.points[range.end - 1].at],
        }
    }

    /// The points that chords go through.
    #[must_use]
    pub fn chords(&self, range: &std::ops::Range<usize>) -> Vec<[f64; 2]> {
        self.points[range.clone()].iter().map(|point| point.at).collect()
    }

    /// Lines, arcs, polylines.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        self.pieces.iter().fold([0; 3], |mut counts, piece| {
            counts[match piece {
                Piece::Line { .. } => 0,
                Piece::Arc { .. } => 1,
                Piece::Chords(_) => 2,
            }] += 1;
            counts
        })
    }

    /// The farthest a chord can be from its curve \[mm\]: the height of the triangle of the chord and the tangents at its
    /// ends, which holds a curve that turns one way. On an arc that is twice the true distance.
    #[must_use]
    pub fn chord_error(&self) -> f64 {
        let of_chord = |pair: &[Point]| {
            let [a, b] = [pair[0].at, pair[1].at];
            let along = libm::atan2(b[1] - a[1], b[0] - a[0]);
            let [one, other] = [&pair[0], &pair[1]].map(|point| libm::tan(wrapped(point.direction - along)).abs());
            if one + other > 0.0 { distance(a, b) * one * other / (one + other) } else { 0.0 }
        };
        let of_piece = |piece: &Piece| match piece {
            Piece::Chords(range) => self.points[range.clone()].windows(2).map(of_chord).fold(0.0, f64::max),
            _ => 0.0,
        };
        self.pieces.iter().map(of_piece).fold(0.0, f64::max)
    }

    /// The farthest that a piece begins from the end of the one before \[mm\].
    #[must_use]
    pub fn gap(&self) -> f64 {
        let ends: Vec<_> = self.pieces.iter().map(|piece| self.ends(piece)).collect();
        let inside = ends.windows(2).map(|pair| distance(pair[0][1], pair[1][0]));
        let around = match (ends.first(), ends.last()) {
            (Some(first), Some(last)) if self.closed => distance(last[1], first[0]),
            _ => 0.0,
        };
        inside.fold(around, f64::max)
    }

    /// The area inside the closed contour less that of the bore \[mm²\]; NaN when it is not closed.
    #[must_use]
    pub fn area(&self) -> f64 {
        if !self.closed {
            return f64::NAN;
        }
        let cross = |[a, b]: [f64; 2], [c, d]: [f64; 2]| 0.5 * (a * d - b * c);
        let of_piece = |piece: &Piece| {
            let [start, end] = self.ends(piece);
            match piece {
                Piece::Line { .. } => cross(start, end),
                // The chord's triangle and the segment beyond it.
                Piece::Arc { radius, turn, .. } => {
                    cross(start, end) + 0.5 * radius * radius * (turn - libm::sin(*turn))
                }
                Piece::Chords(range) => self.chords(range).windows(2).map(|pair| cross(pair[0], pair[1])).sum(),
            }
        };
        self.pieces.iter().map(of_piece).sum::<f64>() - PI * self.bore_radius * self.bore_radius
    }

    /// Every point, one a line.
    #[must_use]
    pub fn csv(&self) -> Vec<String> {
        let mut lines = vec!["gear,tooth,point,part,curve,x_mm,y_mm".to_owned()];
        lines.extend(self.points.iter().map(|point| {
            let [x, y] = point.at;
            format!("{},{},{},{},{},{x},{y}", self.gear, point.tooth, point.number, point.part, point.curve)
        }));
        lines
    }
}
