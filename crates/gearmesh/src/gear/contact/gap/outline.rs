//! The depths of one profile along the positions of a [`Facing`], piece by smooth piece.
//!
//! Must not know: the other flank.

use crate::gear::contact::separation::Facing;
use crate::gear::modification::section::Section;
use crate::numeric::quadratic::Quadratic;

mod cells;
pub(super) use cells::{Cells, Underestimator};

/// Samples of a piece that may be a wave: enough for sixteen humps.
const WAVE_SAMPLES: usize = 64;
/// Samples of a piece of a wave.
const SAMPLES: usize = 8;
/// How often a piece may turn that is not cut there: twice is a hump with a valley beside it.
const MOST_TURNS: usize = 2;
/// By how much of the largest depth a profile must turn between two samples, so that it is not rounding.
const TURN: f64 = 1e-9;
/// By how much of the largest depth it must bend back between three samples.
const BEND: f64 = 1e-12;
/// By how much of its largest slope a profile may bend back at a kink: slopes are those of parabolas, and the gap is off by
/// the square of it.
const KINK: f64 = 1e-5;
/// Roundings of a position.
const ROUNDINGS: f64 = 4.0;
/// Distance of the points from which slopes of a profile are taken, in pieces.
const STEP: f64 = 1e-3;

/// Shares of a cell at which the derivatives of a profile determine a cubic.
const TAYLOR: [f64; 2] = [0.25, 0.75];
/// Largest error of that cubic, as a share of the depth there.
const CUBIC_TOLERANCE: f64 = 1e-12;

/// The depths of one profile against positions that count as those of [`Facing`].
#[derive(Clone, Debug)]
pub(super) struct Outline<'a> {
    parts: Vec<Section<'a>>,
    facing: Facing,
    is_point: bool,
    /// Where it is not smooth, with both ends, ascending.
    pub(super) cuts: Vec<f64>,
    pieces: Vec<Piece>,
    /// Whether it is, in part, a spline through many points.
    pub(super) is_sampled: bool,
    /// The roll angle at the position 0, and by how much it grows with the position.
    rolls: [f64; 2],
    /// Of profiles that may bend back.
    cells: Cells,
}

/// A smooth one, between two cuts.
#[derive(Clone, Copy, Debug)]
struct Piece {
    shape: Convexity,
    /// What it is against the position, where it is a quadratic.
    quadratic: Option<Quadratic>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Convexity {
    Zero,
    Convex,
    Other,
}

impl Convexity {
    fn of(depths: &[f64]) -> Self {
        // At the ends rounding may have put a sample on the next piece.
        if depths[1..depths.len() - 1].iter().all(|depth| *depth == 0.0) {
            return Self::Zero;
        }
        let largest = largest(depths);
        let bends_back = depths.windows(3).any(|d| d[0] - 2.0 * d[1] + d[2] < -BEND * largest);
        if bends_back { Self::Other } else { Self::Convex }
    }

    /// Between two places, as samples would tell.
    fn of_quadratic(quadratic: &Quadratic, ends: &[f64]) -> Self {
        if quadratic.is_zero() {
            return Self::Zero;
        }
        let depths = [0, 1, 2].map(|index| quadratic.value(share(ends, index, 2)));
        let step = (ends[1] - ends[0]) / WAVE_SAMPLES as f64;
        let bends_back = 2.0 * quadratic.coefficients[2] * step * step < -BEND * largest(&depths);
        if bends_back { Self::Other } else { Self::Convex }
    }
}

impl<'a> Outline<'a> {
    pub(super) fn new(parts: &[Section<'a>], facing: Facing, is_point: bool) -> Self {
        let mut outline = Self {
            parts: parts.to_vec(),
            facing,
            is_point,
            cuts: vec![facing.start, facing.end],
            pieces: Vec::new(),
            is_sampled: parts.iter().any(|part| !part.knots().is_empty()),
            rolls: [0.0; 2],
            cells: Cells::default(),
        }
        .turning();
        for roll in parts.iter().flat_map(Section::breaks).copied() {
            let position = outline.position(roll);
            if position > facing.start && position < facing.end {
                outline.cuts.push(position);
            }
        }
        outline.cuts.sort_by(f64::total_cmp);
        // Nearer than this two cuts are one.
        let closest = 1e-9 * (facing.end - facing.start);
        let mut farthest = 0.0_f64;
        outline.cuts.dedup_by(|next, kept| {
            let apart = *next - *kept;
            if apart <= closest {
                farthest = farthest.max(apart);
            }
            apart <= closest
        });
        if let Some(last) = outline.cuts.last_mut() {
            *last = facing.end;
        }
        outline.find_pieces(farthest <= ROUNDINGS * f64::EPSILON * facing.end);
        outline
    }

    /// The same profile with points for the flank, or the reverse.
    pub(super) fn mirrored(&self, facing: Facing) -> Self {
        let place = |cut: f64| facing.start + (self.facing.end - cut);
        let mut cuts: Vec<f64> = self.cuts.iter().rev().map(|cut| place(*cut)).collect();
        if let Some(last) = cuts.last_mut() {
            *last = facing.end;
        }
        let turned = |piece: &Piece| {
            let quadratic = piece.quadratic.map(|quadratic| quadratic.against(place(quadratic.origin), -1.0));
            Piece { quadratic, ..*piece }
        };
        let pieces = self.pieces.iter().rev().map(turned).collect();
        Self {
            parts: self.parts.clone(),
            facing,
            is_point: !self.is_point,
            cuts,
            pieces,
            is_sampled: self.is_sampled,
            rolls: self.rolls,
            cells: Cells::default(),
        }
        .turning()
    }

    fn turning(self) -> Self {
        let [of_point, of_flank] = self.facing.roll_rates();
        Self { rolls: [self.roll(0.0), if self.is_point { of_point } else { of_flank }], ..self }
    }

    /// The position of a roll angle, and the reverse.
    fn position(&self, roll: f64) -> f64 {
        if self.is_point { self.facing.point_position(roll) } else { self.facing.flank_position(roll) }
    }

    fn roll(&self, position: f64) -> f64 {
        if self.is_point { self.facing.point_roll(position) } else { self.facing.flank_roll(position) }
    }

    /// The sum of the parts between two cuts, if each is a quadratic there.
    fn quadratic(&self, ends: &[f64]) -> Option<Quadratic> {
        let roll = self.roll(share(ends, 1, 2));
        let [_, rate] = self.rolls;
        self.parts.iter().try_fold(Quadratic::ZERO, |sum, part| {
            let part = part.quadratic(roll)?;
            Some(sum.plus(&part.against(self.position(part.origin), rate)))
        })
    }

    /// Tells the shape of every piece, and cuts waves where they turn. Parts have no break inside a piece if it is `whole`.
    fn find_pieces(&mut self, whole: bool) {
        let mut cuts = Vec::with_capacity(self.cuts.len());
        cuts.push(self.facing.start);
        self.pieces.reserve(self.cuts.len());
        for ends in self.cuts.windows(2) {
            if let Some(quadratic) = if whole { self.quadratic(ends) } else { None } {
                cuts.push(ends[1]);
                let shape = Convexity::of_quadratic(&quadratic, ends);
                self.pieces.push(Piece { shape, quadratic: Some(quadratic) });
                continue;
            }
            if self.is_sampled {
                cuts.push(ends[1]);
                self.pieces.push(Piece { shape: Convexity::Other, quadratic: None });
                continue;
            }
            let depths: [f64; WAVE_SAMPLES + 1] =
                std::array::from_fn(|index| self.sum(share(ends, index, WAVE_SAMPLES)));
            let shape = Convexity::of(&depths);
            if shape == Convexity::Other {
                cuts.extend(turns(&depths).into_iter().map(|index| share(ends, index, WAVE_SAMPLES)));
                cuts.push(ends[1]);
                let first = self.pieces.len();
                for ends in cuts[first..].windows(2) {
                    let depths: [f64; SAMPLES + 1] = std::array::from_fn(|index| self.sum(share(ends, index, SAMPLES)));
                    self.pieces.push(Piece { shape: Convexity::of(&depths), quadratic: None });
                }
            } else {
                cuts.push(ends[1]);
                self.pieces.push(Piece { shape, quadratic: None });
            }
        }
        self.cuts = cuts;
    }

    /// Cuts the profile into cells, which a search needs where it bends back.
    pub(super) fn find_cells(&mut self) {
        self.cells = Cells::new(self);
    }

    /// The cubic that the profile is between two positions on a piece and between its knots, over the distance from the first; none where it is
    /// another function.
    fn cubic(&self, piece: usize, ends: [f64; 2]) -> Option<[f64; 4]> {
        let Piece { shape, quadratic } = &self.pieces[piece];
        match (shape, quadratic) {
            (Convexity::Zero, _) => Some([0.0; 4]),
            (_, Some(quadratic)) => {
                let [value, slope, bend] = quadratic.rates(ends[0]);
                Some([value, slope, 0.5 * bend, 0.0])
            }
            (_, None) => self.fitted(piece, ends),
        }
    }

    /// The same from the derivatives at both [`TAYLOR`], if it has the value and the slope of the profile at the second.
    fn fitted(&self, piece: usize, [from, to]: [f64; 2]) -> Option<[f64; 4]> {
        let [first, second] = TAYLOR.map(|share| share * (to - from));
        let [value, slope, bend] = self.known_rates(from + first, piece)?;
        let [value_there, slope_there, bend_there] = self.known_rates(from + second, piece)?;
        let width = second - first;
        let (c2, c3) = (0.5 * bend, (bend_there - bend) / (6.0 * width));
        let at = |t: f64| [value + t * (slope + t * (c2 + t * c3)), slope + t * (2.0 * c2 + 3.0 * t * c3)];
        let [end, end_slope] = at(width);
        let allowed = CUBIC_TOLERANCE * value.abs().max(value_there.abs()).max(width * slope.abs());
        let is_cubic = (end - value_there).abs() <= allowed && width * (end_slope - slope_there).abs() <= allowed;
        let [c0, c1] = at(-first);
        is_cubic.then_some([c0, c1, c2 - 3.0 * first * c3, c3])
    }

    /// An underestimator of the profile between two positions on a piece that has no knot in between. The second derivative of each part counts as
    /// monotone there, as it is for powers and cubics. The chord replaces a part whose second derivative has no bound, as a power below 1 at its start.
    fn underestimator(&self, piece: usize, ends: [f64; 2]) -> Underestimator {
        let (chord, [_, rate]) = (1.0 / (ends[1] - ends[0]), self.rolls);
        let rolls = ends.map(|end| self.roll(end));
        let inside = self.roll(0.5 * (self.cuts[piece] + self.cuts[piece + 1]));
        let of_parts =
            self.parts.iter().try_fold(Underestimator { bend: 0.0, slopes: [0.0; 2], is_exact: true }, |sum, part| {
                let rates = [part.rates(rolls[0], inside)?, part.rates(rolls[1], inside)?];
                let bend = rates[0][2].min(rates[1][2]) * rate * rate;
                let is_exact = bend.is_finite();
                let slopes = if is_exact {
                    rates.map(|rates| rates[1] * rate)
                } else {
                    [(rates[1][0] - rates[0][0]) * chord; 2]
                };
                Some(Underestimator {
                    bend: sum.bend + if is_exact { bend } else { 0.0 },
                    slopes: [sum.slopes[0] + slopes[0], sum.slopes[1] + slopes[1]],
                    is_exact: sum.is_exact && is_exact,
                })
            });
        of_parts.unwrap_or_else(|| {
            let rates: [[f64; 3]; SAMPLES + 1] =
                std::array::from_fn(|at| self.sampled_rates(share(&ends, at, SAMPLES), piece));
            let least = rates.iter().map(|rates| rates[2]).fold(0.0, f64::min);
            Underestimator { bend: 2.0 * least, slopes: [rates[0][1], rates[SAMPLES][1]], is_exact: true }
        })
    }

    pub(super) fn cells(&self) -> &Cells {
        &self.cells
    }

    /// Whether the profile bends back nowhere, at a kink neither.
    pub(super) fn is_convex(&self) -> bool {
        self.pieces.iter().all(|piece| piece.shape != Convexity::Other) && self.kinks_back().is_empty()
    }

    /// The cuts at which it bends back.
    fn kinks_back(&self) -> Vec<f64> {
        if self.parts.is_empty() {
            return Vec::new();
        }
        // At both ends of every piece.
        let slopes: Vec<[f64; 2]> = (0..self.pieces())
            .map(|piece| [piece, piece + 1].map(|end| self.rates(self.cuts[end], piece)[1]))
            .collect();
        let largest = slopes.iter().flatten().fold(0.0_f64, |largest, slope| largest.max(slope.abs()));
        let kinks = slopes.windows(2).zip(&self.cuts[1..]);
        kinks.filter(|(pieces, _)| pieces[1][0] - pieces[0][1] < -KINK * largest).map(|(_, cut)| *cut).collect()
    }

    pub(super) fn depth(&self, position: f64) -> f64 {
        self.depth_on(position, self.piece(position))
    }

    /// The depth on a known piece.
    pub(super) fn depth_on(&self, position: f64, piece: usize) -> f64 {
        self.pieces[piece].quadratic.map_or_else(|| self.sum(position), |quadratic| quadratic.value(position))
    }

    fn sum(&self, position: f64) -> f64 {
        let roll = self.roll(position);
        self.parts.iter().map(|part| part.depth(roll)).sum()
    }

    /// The depth where a piece ends: none at all where a relief starts, whatever rounding makes of its place.
    pub(super) fn depth_at_end(&self, piece: usize) -> f64 {
        let starts = piece + 1 < self.pieces() && self.is_zero(piece + 1);
        if starts || self.is_zero(piece) { 0.0 } else { self.depth_on(self.cuts[piece + 1], piece) }
    }

    pub(super) fn pieces(&self) -> usize {
        self.pieces.len()
    }

    pub(super) fn is_zero(&self, piece: usize) -> bool {
        self.pieces[piece].shape == Convexity::Zero
    }

    pub(super) fn piece(&self, position: f64) -> usize {
        if self.pieces.len() == 1 {
            return 0;
        }
        let cuts = &self.cuts[1..self.cuts.len() - 1];
        cuts.partition_point(|cut| *cut <= position)
    }

    /// Depth, and its first and second derivative; of what is no quadratic those of the parabola through three points of the
    /// piece.
    #[inline]
    pub(super) fn rates(&self, position: f64, piece: usize) -> [f64; 3] {
        let Piece { shape, quadratic, .. } = &self.pieces[piece];
        match (shape, quadratic) {
            (Convexity::Zero, _) => [0.0; 3],
            (_, Some(quadratic)) => quadratic.rates(position),
            (_, None) => self.known_rates(position, piece).unwrap_or_else(|| self.sampled_rates(position, piece)),
        }
    }

    /// Of the parts, which all know theirs.
    #[inline]
    fn known_rates(&self, position: f64, piece: usize) -> Option<[f64; 3]> {
        let [_, rate] = self.rolls;
        let roll = self.roll(position);
        let inside = self.roll(0.5 * (self.cuts[piece] + self.cuts[piece + 1]));
        let [depth, slope, bend] = self.parts.iter().try_fold([0.0; 3], |sum, part| {
            let rates = part.rates(roll, inside)?;
            Some([sum[0] + rates[0], sum[1] + rates[1], sum[2] + rates[2]])
        })?;
        Some([depth, slope * rate, bend * rate * rate])
    }

    fn sampled_rates(&self, position: f64, piece: usize) -> [f64; 3] {
        let (lower, upper) = (self.cuts[piece], self.cuts[piece + 1]);
        let step = STEP * (upper - lower);
        let middle = position.clamp(lower + step, upper - step);
        let [before, at, after] = [middle - step, middle, middle + step].map(|place| self.sum(place));
        let (slope, bend) = (0.5 * (after - before) / step, (before - 2.0 * at + after) / (step * step));
        let off = position - middle;
        [if off == 0.0 { at } else { self.sum(position) }, slope + bend * off, bend]
    }
}

/// A share of the way from one end to the other.
fn share(ends: &[f64], index: usize, count: usize) -> f64 {
    ends[0] + (ends[1] - ends[0]) * index as f64 / count as f64
}

fn largest(depths: &[f64]) -> f64 {
    depths.iter().fold(0.0_f64, |largest, depth| largest.max(depth.abs()))
}

/// Between which samples depths turn, if they do so more often than a search in a few parts can follow.
fn turns(depths: &[f64]) -> Vec<usize> {
    let least = TURN * largest(depths);
    let (mut turns, mut last) = (Vec::new(), 0.0_f64);
    for index in 1..depths.len() {
        let rise = depths[index] - depths[index - 1];
        if rise.abs() <= least {
            continue;
        }
        if last * rise < 0.0 {
            turns.push(index - 1);
        }
        last = rise;
    }
    if turns.len() > MOST_TURNS { turns } else { Vec::new() }
}
