//! The depths of one profile along the positions of a [`Facing`], piece by smooth piece.
//!
//! Must not know: the other flank.

use crate::gear::contact::separation::Facing;
use crate::gear::modification::section::Section;
use crate::numeric::extremum::maximum;

/// Samples of each smooth piece of a profile, which say how deep it can get and whether it bends back.
const SAMPLES: usize = 8;
/// Samples of a piece that may be a wave: enough for sixteen humps.
const WAVE_SAMPLES: usize = 64;
/// How often a piece may turn that is not cut there: twice is a hump with a valley beside it.
const MOST_TURNS: usize = 2;
/// By how much of the largest depth a profile must turn between two samples, so that it is not rounding.
const TURN: f64 = 1e-9;
/// Distance of the points from which slopes of a profile are taken, in pieces.
const STEP: f64 = 1e-3;

/// The depths of one profile against positions that count as those of [`Facing`].
#[derive(Clone, Debug)]
pub(super) struct Outline<'a> {
    parts: Vec<Section<'a>>,
    facing: Facing,
    is_point: bool,
    /// Where it is not smooth, with both ends, ascending.
    pub(super) cuts: Vec<f64>,
    /// By piece.
    shapes: Vec<Convexity>,
    /// Positions, ascending, and the least depth that was sampled from there on.
    minimum: Vec<(f64, f64)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Convexity {
    Zero,
    Convex,
    Other,
}

impl<'a> Outline<'a> {
    pub(super) fn new(parts: &[Section<'a>], facing: Facing, is_point: bool) -> Self {
        let mut outline = Self {
            parts: parts.to_vec(),
            facing,
            is_point,
            cuts: vec![facing.start, facing.end],
            shapes: Vec::new(),
            minimum: Vec::new(),
        };
        for roll in parts.iter().flat_map(Section::breaks).copied() {
            let position = if is_point { facing.point_position(roll) } else { facing.flank_position(roll) };
            if position > facing.start && position < facing.end {
                outline.cuts.push(position);
            }
        }
        outline.cuts.sort_by(f64::total_cmp);
        for index in 1..outline.cuts.len() {
            let turns = outline.turns([outline.cuts[index - 1], outline.cuts[index]]);
            outline.cuts.extend(turns);
        }
        outline.cuts.sort_by(f64::total_cmp);
        // Nearer than this two cuts are one.
        let closest = 1e-9 * (facing.end - facing.start);
        outline.cuts.dedup_by(|next, kept| *next - *kept <= closest);
        if let Some(last) = outline.cuts.last_mut() {
            *last = facing.end;
        }
        let mut samples = Vec::new();
        for ends in outline.cuts.windows(2) {
            let place = |index: usize| ends[0] + (ends[1] - ends[0]) * index as f64 / SAMPLES as f64;
            let depths: Vec<f64> = (0..=SAMPLES).map(|index| outline.depth(place(index))).collect();
            let largest = depths.iter().fold(0.0_f64, |maximum, depth| maximum.max(depth.abs()));
            let bends_back = depths.windows(3).any(|d| d[0] - 2.0 * d[1] + d[2] < -1e-12 * largest);
            outline.shapes.push(match (largest > 0.0, bends_back) {
                (false, _) => Convexity::Zero,
                (true, false) => Convexity::Convex,
                (true, true) => Convexity::Other,
            });
            samples.extend((0..=SAMPLES).map(place).zip(depths.iter().copied()));
            // A valley between samples, without which a search towards it would end before it began.
            for index in 1..SAMPLES {
                if depths[index] < depths[index - 1] && depths[index] <= depths[index + 1] {
                    let (from, guess, to) = (place(index - 1), place(index), place(index + 1));
                    let (at, height) = maximum(|x| -outline.depth(x), from, guess, to, 1e-7 * (to - from));
                    samples.push((at, -height));
                }
            }
        }
        samples.sort_by(|one, two| one.0.total_cmp(&two.0));
        let mut minimum = f64::INFINITY;
        for sample in samples.iter_mut().rev() {
            minimum = minimum.min(sample.1);
            sample.1 = minimum;
        }
        outline.minimum = samples;
        outline
    }

    /// About where a smooth piece turns, if it does so more often than a search in a few parts can follow.
    fn turns(&self, [from, to]: [f64; 2]) -> Vec<f64> {
        let place = |index: usize| from + (to - from) * index as f64 / WAVE_SAMPLES as f64;
        let depths: [f64; WAVE_SAMPLES + 1] = std::array::from_fn(|index| self.depth(place(index)));
        let least = TURN * depths.iter().fold(0.0_f64, |largest, depth| largest.max(depth.abs()));
        let rises = |index: usize| depths[index] - depths[index - 1];
        let (mut turns, mut last) = (Vec::new(), 0.0_f64);
        for index in (1..=WAVE_SAMPLES).filter(|index| rises(*index).abs() > least) {
            if last * rises(index) < 0.0 {
                turns.push(place(index - 1));
            }
            last = rises(index);
        }
        if turns.len() > MOST_TURNS { turns } else { Vec::new() }
    }

    pub(super) fn depth(&self, position: f64) -> f64 {
        let roll = if self.is_point { self.facing.point_roll(position) } else { self.facing.flank_roll(position) };
        self.parts.iter().map(|part| part.depth(roll)).sum()
    }

    pub(super) fn least_from(&self, position: f64) -> f64 {
        if self.parts.is_empty() {
            return 0.0;
        }
        let next = self.minimum.partition_point(|sample| sample.0 < position);
        self.depth(position).min(self.minimum.get(next).map_or(f64::INFINITY, |sample| sample.1))
    }

    pub(super) fn pieces(&self) -> usize {
        self.shapes.len()
    }

    pub(super) fn is_zero(&self, piece: usize) -> bool {
        self.shapes[piece] == Convexity::Zero
    }

    pub(super) fn bends_back(&self, piece: usize) -> bool {
        self.shapes[piece] == Convexity::Other
    }

    pub(super) fn piece(&self, position: f64) -> usize {
        let cuts = &self.cuts[1..self.cuts.len() - 1];
        cuts.partition_point(|cut| *cut <= position)
    }

    /// First and second derivative of the depth, of the parabola through three points of the piece.
    pub(super) fn rates(&self, position: f64, piece: usize) -> (f64, f64) {
        if self.is_zero(piece) {
            return (0.0, 0.0);
        }
        let (lower, upper) = (self.cuts[piece], self.cuts[piece + 1]);
        let step = STEP * (upper - lower);
        let middle = position.clamp(lower + step, upper - step);
        let [before, at, after] = [middle - step, middle, middle + step].map(|place| self.depth(place));
        let bend = (before - 2.0 * at + after) / (step * step);
        (0.5 * (after - before) / step + bend * (position - middle), bend)
    }
}
