//! The gap of a tooth pair at a path position, wherever its flanks come nearest to each other.
//!
//! A flank point off the line of action stands clear by the separation S and by what both flanks have lost there, C1 + C2;
//! the gap of the pair is the least of S + C1 + C2 over the flanks, which end at their tips. Without modification that is 0
//! from A to E, and the separation of the tip corner before A and after E. A steep relief touches off the line of action,
//! away from its deepest end. First order in the depths. Must not know: load, compliance.

use super::separation::{Facing, Touch};
use crate::gear::geometry::{GearPair, Side};
use crate::gear::modification::section::Profiles;
use beyond::Turn;
use branch_and_bound::Search;
use outline::Outline;

mod beyond;
mod branch_and_bound;
mod convex;
mod copy;
mod outline;

/// Places between two known breaks, as shares of the way, at which the spot of contact is determined: denser towards
/// both ends, since the least relief lasts only for a moment.
const PROBES: [f64; 11] = {
    let [a, b, c, d, e] = [1.0 / 512.0, 1.0 / 128.0, 1.0 / 32.0, 1.0 / 8.0, 0.3];
    [a, b, c, d, e, 0.5, 1.0 - e, 1.0 - d, 1.0 - c, 1.0 - b, 1.0 - a]
};

/// Where on the flanks a pair touches: the same value all over a stretch on which the gap is smooth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Spot {
    OnLineOfAction,
    /// A tip corner, on this piece of the other flank.
    Corner {
        flank: usize,
    },
    /// Off the line of action, towards a side, on these pieces of the point's profile and of the flank's.
    Beside {
        side: Side,
        pieces: [usize; 2],
        place: PieceLocation,
    },
    /// A flank that has ended.
    Nowhere,
}

/// Where on a smooth piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PieceLocation {
    Inside,
    EndOfPoint,
    EndOfFlank,
}

/// Both ways in which flanks touch off the line of action under one design.
#[derive(Clone, Debug)]
pub struct Gaps<'a> {
    /// The contact lies ahead of the line of action: the gear's flank points before the pinion's flank, and the reverse.
    ways: [Way<'a>; 2],
    modified: bool,
    /// Whether the gap has one lowest place, since no profile bends back, or less than the separation bends.
    is_convex: bool,
}

#[derive(Clone, Debug)]
struct Way<'a> {
    side: Side,
    facing: Facing,
    point: Outline<'a>,
    flank: Outline<'a>,
    turn: Turn,
}

/// The gap of two profiles, its slope and its bend along the points, of what each has lost there against its own position.
#[inline]
fn pulled(touch: &Touch, point: [f64; 3], flank: [f64; 3]) -> [f64; 3] {
    [
        touch.separation + point[0] + flank[0],
        touch.slope + point[1] + flank[1] * touch.rate,
        touch.bend + point[2] + flank[2] * touch.rate * touch.rate + flank[1] * touch.rate_slope,
    ]
}

impl<'a> Gaps<'a> {
    /// `profiles` of one section across the face.
    #[must_use]
    pub fn new(pair: &GearPair, profiles: &Profiles<'a>) -> Self {
        let gaps = Self::of(pair, profiles);
        if gaps.is_convex { gaps } else { gaps.thorough() }
    }

    fn of(pair: &GearPair, [pinion, gear]: &Profiles<'a>) -> Self {
        let facings = [Side::Gear, Side::Pinion].map(|side| Facing::new(pair, side));
        let (point, flank) = (Outline::new(gear, facings[0], true), Outline::new(pinion, facings[0], false));
        let is_convex = point.is_convex() && flank.is_convex();
        let (flank_too, point_too) = (point.mirrored(facings[1]), flank.mirrored(facings[1]));
        let turn = Turn::default();
        let mut ways = [
            Way { side: Side::Gear, facing: facings[0], point, flank, turn },
            Way { side: Side::Pinion, facing: facings[1], point: point_too, flank: flank_too, turn },
        ];
        let modified = !pinion.is_empty() || !gear.is_empty();
        for way in ways.iter_mut().filter(|way| modified && way.facing.round > 0.0) {
            way.turn = way.turned();
        }
        Self { ways, modified, is_convex }
    }

    /// For a search that needs no convexity.
    fn thorough(mut self) -> Self {
        for outline in self.ways.iter_mut().flat_map(|way| [&mut way.point, &mut way.flank]) {
            outline.find_cells();
        }
        Self { is_convex: false, ..self }
    }

    /// The gap at a path position; none where a tip corner would have to reach beyond the other tip.
    #[must_use]
    pub fn at(&self, s: f64) -> Option<f64> {
        let (gap, spot) = self.touching(s);
        (spot != Spot::Nowhere).then_some(gap)
    }

    /// Whether anything is taken off.
    #[must_use]
    pub fn is_modified(&self) -> bool {
        self.modified
    }

    /// How far the flanks stand apart at a place beside the nominal point of contact, along the flanks and towards the pinion's
    /// tip \[m\]; none beyond one of their tips, without bound beyond one of their base circles.
    #[must_use]
    pub fn beside(&self, s: f64, along: f64) -> Option<f64> {
        let way = &self.ways[usize::from(along < 0.0)];
        let nominal = way.facing.turned(way.side, s);
        let Some(before) = way.facing.before(nominal, along.abs()) else { return Some(f64::INFINITY) };
        if nominal + before < way.facing.start {
            return None;
        }
        let touch = way.facing.touch(nominal + before, before);
        (touch.curvature <= way.facing.end).then(|| touch.separation + way.depth(nominal + before, touch.curvature))
    }

    fn touching(&self, s: f64) -> (f64, Spot) {
        let nominal = |way: &Way| way.facing.turned(way.side, s);
        for way in &self.ways {
            let nominal = nominal(way);
            let before = way.facing.start - nominal;
            if before > 0.0 {
                let touch = way.tip(before);
                if touch.curvature > way.facing.end {
                    return (f64::INFINITY, Spot::Nowhere);
                }
                let gap = touch.separation + way.depth(way.facing.start, touch.curvature);
                let spot = Spot::Corner { flank: way.flank.piece(touch.curvature) };
                if !self.modified {
                    return (gap, spot);
                }
                return if self.is_convex {
                    way.descend(nominal, before, way.facing.flank_end(before)).unwrap_or((gap, spot))
                } else {
                    Search::least(way, nominal, before, way.facing.flank_end(before), (gap, spot))
                };
            }
        }
        if !self.modified {
            return (0.0, Spot::OnLineOfAction);
        }
        if self.is_convex {
            return self.convex(s);
        }
        let mut minimum = (self.on_line(s), Spot::OnLineOfAction);
        for way in &self.ways {
            let nominal = nominal(way);
            minimum = Search::least(way, nominal, 0.0, way.facing.on_line(nominal), minimum);
        }
        minimum
    }

    /// Whether a profile is a spline through so many points that no few polynomials follow the gap.
    #[must_use]
    pub fn is_sampled(&self) -> bool {
        let Way { point, flank, .. } = &self.ways[0];
        point.is_sampled || flank.is_sampled
    }

    /// Path positions in `window` at which the gap is not smooth: ends of contact and of reliefs, and where the flanks
    /// begin to touch at another place.
    #[must_use]
    pub fn breaks(&self, window: (f64, f64)) -> Vec<f64> {
        let Way { facing, point, flank, .. } = &self.ways[0];
        let mut known = vec![window.0, window.1];
        let inner = [facing.start, facing.end].into_iter().chain(point.cuts.iter().chain(&flank.cuts).copied());
        known.extend(inner.filter(|s| *s > window.0 && *s < window.1));
        known.sort_by(f64::total_cmp);
        known.dedup();
        // Contact passes from crest to crest of a sampled flank; a search for these positions would cost more than the curve.
        if !self.modified || self.is_sampled() {
            return known;
        }
        let (start, end) = (facing.start, facing.end);
        let changes = if self.is_convex { self.convex_changes(&known) } else { None };
        let inside = changes.is_some();
        let mut found = changes.unwrap_or_default();
        found.retain(|s| *s > window.0 && *s < window.1);
        for ends in known.windows(2) {
            if inside && ends[0] >= start && ends[1] <= end {
                continue;
            }
            let places = PROBES.map(|share| ends[0] + share * (ends[1] - ends[0]));
            let spots = places.map(|place| self.touching(place).1);
            for probe in 1..places.len() {
                let mut before = (places[probe - 1], spots[probe - 1]);
                while before.1 != spots[probe] && before.0 < places[probe] {
                    before = self.change(before, places[probe]);
                    found.push(before.0);
                }
            }
        }
        known.extend(found);
        known.sort_by(f64::total_cmp);
        known.dedup_by(|next, kept| *next - *kept <= self.closest());
        known
    }

    /// The depths at the nominal point of contact.
    fn on_line(&self, s: f64) -> f64 {
        if self.is_unmodified(s) { 0.0 } else { self.ways[0].depth(s, s) }
    }

    /// Whether nothing is taken off around the nominal point of contact, whatever rounding makes of where reliefs start.
    fn is_unmodified(&self, s: f64) -> bool {
        let Way { point, flank, .. } = &self.ways[0];
        point.is_zero(point.piece(s)) && flank.is_zero(flank.piece(s))
    }

    /// Places nearer than this are one.
    fn closest(&self) -> f64 {
        1e-11 * (self.ways[0].facing.end - self.ways[0].facing.start)
    }

    /// Where the spot is no longer the one at the lower end, and which it is then.
    fn change(&self, (mut lower, spot): (f64, Spot), mut upper: f64) -> (f64, Spot) {
        let closest = self.closest();
        let mut next = self.touching(upper).1;
        if let Some(at) = self.leaves_corner(lower, upper) {
            let [from, to] = [at - closest, at + closest].map(|s| self.touching(s.clamp(lower, upper)).1);
            if from == spot && to != spot {
                return ((at + closest).min(upper), to);
            }
        }
        while upper - lower > closest {
            let middle = 0.5 * (lower + upper);
            let here = self.touching(middle).1;
            if here == spot {
                lower = middle;
            } else {
                (upper, next) = (middle, here);
            }
        }
        (upper, next)
    }
}

impl Way<'_> {
    fn depth(&self, point: f64, flank: f64) -> f64 {
        self.point.depth(point) + self.flank.depth(flank)
    }

    /// The gap, its slope and its bend against the distance from the nominal point, on these pieces.
    fn pull(&self, nominal: f64, before: f64, touch: &Touch, pieces: [usize; 2]) -> [f64; 3] {
        let point = self.point.rates(nominal + before, pieces[0]);
        let flank = self.flank.rates(touch.curvature, pieces[1]);
        pulled(touch, point, flank)
    }

    /// The end of the smooth pieces: where the profile of the point or that of the flank has its next cut.
    fn piece_end(
        &self,
        nominal: f64,
        before: f64,
        touch: &Touch,
        [point, flank]: [usize; 2],
    ) -> (f64, Touch, [bool; 2]) {
        let (cut, wall) = (self.point.cuts[point + 1], self.flank.cuts[flank + 1]);
        let last = (cut - nominal).max(before);
        let at_last = self.facing.touch(cut, last);
        if at_last.curvature <= wall {
            return (last, at_last, [true, false]);
        }
        // Half the square of the curvature is almost straight in the distance.
        let (mut at, mut there) = (before, *touch);
        for _ in 0..30 {
            let step = (wall * wall - there.curvature * there.curvature) / (2.0 * there.curvature * there.rate);
            at = (at + step).clamp(before, last);
            there = self.facing.touch(nominal + at, at);
            if step.abs() <= 1e-13 * self.facing.end {
                break;
            }
        }
        there.curvature = wall;
        (at, there, [false, true])
    }
}

#[cfg(test)]
mod tests;
