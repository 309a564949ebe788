//! How near to each other places of a scan are, and which ones it may come to.
//!
//! Waves are as long over the roll length everywhere; along the flank, in which places of both flanks are in equal steps, they are the shorter
//! the nearer it is to the base circle. Must not know: depths.

use super::super::bends::LEFT;
use super::super::outline::{Back, Outline};
use super::depths::along;
use super::line::Pair;

/// By how much the gap may be lower between two places of the scan than at both \[m\], where it bends most: it says how near they are.
const BETWEEN: f64 = 1200e-9;
/// The fewest and the most steps of a scan along a flank.
const FEWEST: f64 = 100.0;
const MOST: f64 = 65_536.0;
/// How near to a base circle it is asked how much the gap bends, over the length of the line of action.
const NEAREST: f64 = 1e-3;
/// How far apart places are at the most, over the shortest wave over 2π.
const SHORTEST: f64 = 1.2;
/// Parts of a flank of which it is known what depths are between.
const CELLS: usize = 32;
/// How much more they may differ, between the places that are looked at.
const MARGIN: f64 = 1.25;
/// How often it is found how far the gap may be lowest, from what holds up to there.
const NARROWER: usize = 2;

/// Both flanks, as far as it counts for steps.
#[derive(Clone, Debug)]
pub(super) struct Steps {
    pair: Pair,
    /// The most that each bends over its roll length, and how far places may be from each other for its waves.
    bends: [f64; 2],
    waves: [f64; 2],
    /// At which lengths from its base circle the slope of each grows, and by how much.
    kinks: [Vec<(f64, f64)>; 2],
    /// What depths are between.
    cells: [Cells; 2],
    /// The fewest and the most steps are of this length.
    within: [f64; 2],
}

/// Equal parts of a flank, with the least and the largest depth in each \[m\], of three places.
#[derive(Clone, Debug)]
struct Cells {
    from: f64,
    per_length: f64,
    between: [[f32; 2]; CELLS],
}

impl Cells {
    fn new(flank: &Outline, base_radius: f64, [from, to]: [f64; 2]) -> Self {
        let depths = flank.depths(base_radius, [from, (to - from) / (2 * CELLS) as f64], 2 * CELLS + 1);
        let between = std::array::from_fn(|cell| {
            let none = [f32::INFINITY, f32::NEG_INFINITY];
            let widen = |[least, most]: [f32; 2], depth: &f32| [least.min(*depth), most.max(*depth)];
            depths[2 * cell..2 * cell + 3].iter().fold(none, widen)
        });
        Self { from, per_length: CELLS as f64 / (to - from), between }
    }

    /// Between two lengths.
    fn between(&self, lengths: [f64; 2]) -> [f32; 2] {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // what is below 0 is 0
        let [first, last] =
            lengths.map(|length| (((length - self.from) * self.per_length) as u32 as usize).min(CELLS - 1));
        let [mut least, mut most] = self.between[first];
        for [lower, upper] in &self.between[first..=last.max(first)] {
            least = if *lower < least { *lower } else { least };
            most = if *upper > most { *upper } else { most };
        }
        [least, most]
    }
}

/// What is needed on a part of the path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Need {
    /// How far places may be from each other, and by how much the gap bends and its slope grows along the flanks at the most.
    pub(super) step: f64,
    pub(super) bend: f64,
    pub(super) kink: f64,
    /// Between which lengths along each flank the gap may be lowest.
    pub(super) lengths: [[f64; 2]; 2],
}

impl Need {
    /// Over these lengths too.
    pub(super) fn widen(&mut self, lengths: &[[f64; 2]; 2]) {
        for (own, other) in self.lengths.iter_mut().zip(lengths) {
            *own = [own[0].min(other[0]), own[1].max(other[1])];
        }
    }
}

impl Steps {
    /// Of flanks over their own roll lengths.
    pub(super) fn new(pair: Pair, outlines: [&Outline; 2]) -> Self {
        let kinks = |at: usize| {
            let kinks = outlines[at].kinks().into_iter();
            kinks.map(|(place, kink)| (along(place, pair.base_radii[at]), kink)).collect()
        };
        Self {
            pair,
            bends: outlines.map(Outline::most_bend),
            kinks: [kinks(0), kinks(1)],
            waves: outlines.map(|outline| SHORTEST * outline.shortest()),
            cells: [0, 1].map(|at| Cells::new(outlines[at], pair.base_radii[at], pair.ranges[at])),
            within: [pair.longest() / MOST, pair.longest() / FEWEST],
        }
    }

    /// On so many equal parts of the path.
    pub(super) fn of<const PARTS: usize>(&self) -> [Need; PARTS] {
        let [from, to] = self.pair.roll_lengths[0];
        std::array::from_fn(|part| {
            let lengths = self.beside([part, part + 1].map(|end| from + (to - from) * end as f64 / PARTS as f64));
            // All of it is the most at one of the ends.
            let [one, other] = lengths[0].map(|length| self.at((2.0 * self.pair.base_radii[0] * length).sqrt()));
            // The outermost parts stand for what is beyond the ends of contact too, where flanks touch farther along them.
            let touched = if part == 0 || part + 1 == PARTS { self.pair.ranges } else { lengths };
            Need { step: one[0].min(other[0]), bend: one[1].max(other[1]), kink: self.kink(touched), lengths }
        })
    }

    /// Between which lengths along each flank the gap may be lowest between two path positions: where the flanks stand apart by no more than depths at
    /// the nominal points exceed the least ones there.
    fn beside(&self, ends: [f64; 2]) -> [[f64; 2]; 2] {
        let nominal = [ends, [self.pair.tangent_length - ends[1], self.pair.tangent_length - ends[0]]];
        let nominal =
            [0, 1].map(|at| nominal[at].map(|roll_length| along(roll_length.max(0.0), self.pair.base_radii[at])));
        let most = self.cells[0].between(nominal[0])[1] + self.cells[1].between(nominal[1])[1];
        let mut lengths = self.pair.ranges;
        for _ in 0..NARROWER {
            let least = self.cells[0].between(lengths[0])[0] + self.cells[1].between(lengths[1])[0];
            let apart = MARGIN * f64::from(most - least);
            let [one, other] = ends.map(|s| reach(self.pair.base_radii, [s, self.pair.tangent_length - s], apart));
            let [down, up] = [0, 1].map(|way| one[way].max(other[way]));
            let inside = |at: usize, length: f64| length.clamp(self.pair.ranges[at][0], self.pair.ranges[at][1]);
            lengths = [
                [inside(0, nominal[0][0] - down), inside(0, nominal[0][1] + up)],
                [inside(1, nominal[1][0] - up), inside(1, nominal[1][1] + down)],
            ];
        }
        lengths
    }

    /// Whether flanks that bend back so far do so by more than the separation bends, anywhere between these lengths along both.
    pub(super) fn are_rough(&self, back: &[Back; 2], lengths: [[f64; 2]; 2]) -> bool {
        let least = NEAREST * self.pair.tangent_length;
        let ends =
            [0, 1].map(|at| lengths[at].map(|length| (2.0 * self.pair.base_radii[at] * length).sqrt().max(least)));
        let of_flanks: f64 = (0..2)
            .map(|at| {
                let rate = self.pair.base_radii[at] / ends[at][0];
                back[at].between(ends[at]) * rate * rate
            })
            .sum();
        -of_flanks > (1.0 - LEFT) * (1.0 / ends[0][1] + 1.0 / ends[1][1])
    }

    /// By how much the slope of the gap grows anywhere between these lengths along both flanks.
    fn kink(&self, lengths: [[f64; 2]; 2]) -> f64 {
        let of = |at: usize| {
            let [low, high] = lengths[at];
            let inside = self.kinks[at].iter().filter(|(place, _)| *place >= low && *place <= high);
            // How roll lengths grow.
            let radius = self.pair.base_radii[at];
            let least = NEAREST * self.pair.tangent_length;
            inside.map(|(place, kink)| kink * radius / (2.0 * radius * place).sqrt().max(least)).fold(0.0, f64::max)
        };
        of(0) + of(1)
    }

    /// How far places may be from each other at a roll length of the pinion, and by how much the gap bends.
    fn at(&self, s: f64) -> [f64; 2] {
        let [from, to] = self.pair.roll_lengths[0];
        // A flank may begin at its base circle.
        let s = s.clamp(from, to).clamp(NEAREST * self.pair.tangent_length, (1.0 - NEAREST) * self.pair.tangent_length);
        // How roll lengths grow.
        let [one, two] = [self.pair.base_radii[0] / s, self.pair.base_radii[1] / (self.pair.tangent_length - s)];
        let of_separation = one / self.pair.base_radii[0] + two / self.pair.base_radii[1];
        let bend = self.bends[0] * one * one + self.bends[1] * two * two + of_separation;
        let step = (4.0 * BETWEEN / bend).sqrt().min(self.waves[0] / one).min(self.waves[1] / two);
        [step.clamp(self.within[0], self.within[1]), bend]
    }
}

/// How far down and up both flanks from these roll lengths of pinion and gear, at which they touch, they stand apart by this.
///
/// They have turned by p + w, the pinion's along f p + r p²/2 and the gear's along q w − r′w²/2 (w and p as w/f = p/q make one of both lengths
/// too long), and from there stand apart by that angle times what is farther.
pub(super) fn reach(base_radii: [f64; 2], roll_lengths: [f64; 2], apart: f64) -> [f64; 2] {
    let least = NEAREST * (roll_lengths[0] + roll_lengths[1]);
    let [pinion, gear] = roll_lengths.map(|roll_length| roll_length.max(least));
    let per_length = 1.0 / (pinion + gear);
    let curvature = pinion * gear * per_length;
    // Of a parabola the angle would be that there.
    let angle = (apart / curvature).sqrt();
    let turned = angle * per_length;
    let farther = 2.0 * angle * curvature;
    [(pinion, base_radii[1]), (gear, base_radii[0])]
        .map(|(other, radius)| farther + 0.5 * radius * (turned * other) * (turned * other))
}
