//! Both flanks along their lengths at one path position.
//!
//! Contact moves by the same length along both, so that places of both lie beside each other whose lengths from the base circles add up to what
//! they do at the nominal point. Must not know: depths.

use super::super::Way;
use super::depths::along;
use crate::gear::geometry::GearPair;

/// What all path positions have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) base_radii: [f64; 2],
    /// Between which roll lengths each flank has points, and between which lengths from its base circle.
    pub(super) roll_lengths: [[f64; 2]; 2],
    pub(super) ranges: [[f64; 2]; 2],
    pub(super) tangent_length: f64,
}

impl Pair {
    pub(super) fn new(pair: &GearPair, ways: &[Way; 2]) -> Self {
        let base_radii = [pair.pinion.base_radius, pair.gear.base_radius];
        // A tip may reach beyond the other base circle, where that flank has no points.
        let roll_lengths = [0, 1].map(|at| ways[at].flank.range().map(|roll_length| roll_length.max(0.0)));
        let ranges = [0, 1].map(|at| roll_lengths[at].map(|roll_length| along(roll_length, base_radii[at])));
        Self { base_radii, roll_lengths, ranges, tangent_length: pair.tangent_length }
    }

    /// The length of the longer one of both flanks.
    pub(super) fn longest(&self) -> f64 {
        self.ranges.iter().map(|range| range[1] - range[0]).fold(0.0, f64::max)
    }
}

/// Both flanks at one path position, along the length of both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    pub(super) pair: &'a Pair,
    /// Roll lengths at the nominal point.
    pub(super) nominal: [f64; 2],
    /// What both lengths along the flanks add up to.
    pub(super) sum: f64,
    /// Between which lengths along the pinion's flank both flanks have points.
    pub(super) range: [f64; 2],
    /// Beyond the ends of contact, what the separation is more, from where that counts, and by what length places of the pinion are farther that
    /// are beside those of the gear then.
    pub(super) more: f64,
    pub(super) aligned: f64,
    pub(super) shift: f64,
    /// What the lengths of places add up to that are beside each other.
    pub(super) beside: f64,
}

impl<'a> Line<'a> {
    /// `nominal` are the roll lengths of pinion and gear at the nominal point. None where the flanks have no place in common.
    #[inline]
    pub(super) fn new(pair: &'a Pair, nominal: [f64; 2]) -> Option<Self> {
        let Pair { base_radii, ranges: [pinion, gear], .. } = pair;
        let along = |at: usize| 0.5 * nominal[at] * nominal[at] / base_radii[at];
        let sum = along(0) + along(1);
        let range = [larger(pinion[0], sum - gear[1]), smaller(pinion[1], sum - gear[0])];
        let line = Self { pair, nominal, sum, range, more: 0.0, aligned: 0.0, shift: 0.0, beside: sum };
        (range[0] <= range[1]).then_some(line)
    }

    /// The length along the pinion's flank at the nominal point.
    #[inline]
    pub(super) fn nominal(&self) -> f64 {
        0.5 * self.nominal[0] * self.nominal[0] / self.pair.base_radii[0]
    }

    /// Roll lengths of pinion and gear at a length along the pinion's flank, and whether that of the pinion has grown.
    #[inline]
    pub(super) fn roll_lengths(&self, place: f64) -> ([f64; 2], bool) {
        let [pinion, gear] = self.pair.base_radii;
        let roll_lengths = [root(2.0 * pinion * place), root(2.0 * gear * (self.sum - place))];
        (roll_lengths, roll_lengths[0] >= self.nominal[0])
    }

    /// What counts for the square and the third power of the distance from the nominal roll length of each flank, for the separation.
    #[inline]
    pub(super) fn turns(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|at| {
            let per_square = 1.0 / (self.pair.base_radii[at] * self.pair.base_radii[at]);
            [0.5 * self.nominal[at] * per_square, per_square * (1.0 / 3.0)]
        })
    }

    /// Counts the separation, and by how much the roll length of the flank that is met is more, from what they are at these roll lengths, which
    /// are far from the nominal ones.
    pub(super) fn count_from(&mut self, roll_lengths: [f64; 2], separation: f64, met: [f64; 2]) {
        let turns = self.turns();
        let [pinion, gear] = [0, 1].map(|at| {
            let off = roll_lengths[at] - self.nominal[at];
            off * off * (turns[at][0] + turns[at][1] * off)
        });
        self.more = separation - pinion - gear;
        let along = |at: usize, roll_length: f64| 0.5 * roll_length * roll_length / self.pair.base_radii[at];
        self.shift = along(0, met[0]) - along(0, roll_lengths[0]);
        self.beside = along(0, met[0]) + along(1, met[1]);
        // Both have points at the places that lie beside each other now.
        let [pinion, gear] = self.pair.ranges;
        self.range = [
            larger(self.range[0], larger(pinion[0], self.beside - gear[1]) - self.shift),
            smaller(self.range[1], smaller(pinion[1], self.beside - gear[0]) - self.shift),
        ];
        self.aligned = separation;
    }
}

/// As these are one instruction.
#[inline]
pub(super) fn larger(one: f64, other: f64) -> f64 {
    if one > other { one } else { other }
}

#[inline]
pub(super) fn smaller(one: f64, other: f64) -> f64 {
    if one < other { one } else { other }
}

#[inline]
fn root(square: f64) -> f64 {
    larger(square, 0.0).sqrt()
}
