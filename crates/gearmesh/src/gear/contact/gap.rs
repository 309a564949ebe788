//! The gap of a tooth pair at a path position, wherever its flanks come nearest to each other.
//!
//! A flank point off the line of action stands clear by the separation S and by what both flanks have lost there, C1 + C2;
//! the gap of the pair is the least of S + C1 + C2 over the flanks, which end at their tips. Without modification that is 0
//! from A to E, and the separation of the tip corner before A and after E. A steep relief touches off the line of action,
//! away from its deepest end. First order in the depths. Must not know: load, compliance.

use super::separation::{Facing, Touch};
use crate::gear::geometry::{GearPair, Side};
use crate::gear::modification::section::Profiles;
use bends::may_be_rough;
use beyond::Turn;
use outline::Outline;
use rough::Rough;

mod bends;
mod beyond;
mod convex;
mod copy;
mod outline;
mod rough;

/// Where the search for a minimum stops, in pieces; the error of the gap is of second order in it.
const PLACE: f64 = 1e-6;
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
    /// Whether no profile bends back.
    is_convex: bool,
    /// What flanks are searched by that bend back more than the separation bends.
    rough: Option<Rough>,
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

/// The state of a search: the current point, its smooth piece, and the least gap so far.
struct Search<'a, 'b> {
    way: &'b Way<'a>,
    nominal: f64,
    pieces: [usize; 2],
    minimum: (f64, Spot),
}

impl<'a> Gaps<'a> {
    /// `profiles` of one section across the face.
    #[must_use]
    pub fn new(pair: &GearPair, profiles: &Profiles<'a>) -> Self {
        let gaps = Self::of(pair, profiles);
        if gaps.is_convex || gaps.rough.is_some() { gaps } else { gaps.thorough() }
    }

    fn of(pair: &GearPair, [pinion, gear]: &Profiles<'a>) -> Self {
        let facings = [Side::Gear, Side::Pinion].map(|side| Facing::new(pair, side));
        let (point, flank) = (Outline::new(gear, facings[0], true), Outline::new(pinion, facings[0], false));
        let may_be_rough = may_be_rough(&facings[0], &point, &flank);
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
        let rough = if may_be_rough { Rough::new(pair, &ways, is_convex) } else { None };
        Self { ways, modified, is_convex: is_convex && rough.is_none(), rough }
    }

    /// For a search that needs no convexity.
    fn thorough(mut self) -> Self {
        for outline in self.ways.iter_mut().flat_map(|way| [&mut way.point, &mut way.flank]) {
            outline.sample_minimum();
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
                if let Some(rough) = &self.rough {
                    return (rough.least(&self.ways, s, gap), spot);
                }
                return if self.is_convex {
                    way.descend(nominal, before, way.facing.flank_end(before)).unwrap_or((gap, spot))
                } else {
                    way.search(nominal, before, way.facing.flank_end(before), (gap, spot))
                };
            }
        }
        if !self.modified {
            return (0.0, Spot::OnLineOfAction);
        }
        if self.is_convex {
            return self.convex(s);
        }
        if let Some(rough) = &self.rough {
            return (rough.least(&self.ways, s, f64::INFINITY), Spot::OnLineOfAction);
        }
        let mut minimum = (self.on_line(s), Spot::OnLineOfAction);
        for way in &self.ways {
            let nominal = nominal(way);
            // The first check of the search, before anything is computed.
            if way.least_from(nominal, nominal) < minimum.0 {
                minimum = way.search(nominal, 0.0, way.facing.touch(nominal, 0.0), minimum);
            }
        }
        minimum
    }

    /// Whether a profile is a spline through so many points that no few polynomials follow the gap.
    #[must_use]
    pub fn is_sampled(&self) -> bool {
        self.ways[0].point.is_sampled || self.ways[0].flank.is_sampled
    }

    /// Between how many crests contact goes over on rough flanks.
    #[must_use]
    pub fn crests(&self) -> usize {
        self.rough.as_ref().map_or(0, |rough| rough.crests)
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
        // Where the contact goes over from one crest to another is told by nothing: there are as many such places as crests.
        if !self.modified || self.rough.is_some() {
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

    fn least_from(&self, point: f64, flank: f64) -> f64 {
        self.point.least_from(point) + self.flank.least_from(flank)
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

    /// The least of `minimum` and of what lies farther than `before` from the nominal point.
    fn search(&self, nominal: f64, before: f64, touch: Touch, minimum: (f64, Spot)) -> (f64, Spot) {
        let pieces = [self.point.piece(nominal + before), self.flank.piece(touch.curvature)];
        Search { way: self, nominal, pieces, minimum }.run(before, touch)
    }
}

impl Search<'_, '_> {
    fn run(mut self, mut before: f64, mut touch: Touch) -> (f64, Spot) {
        let way = self.way;
        // The separation only grows: no farther than it alone would be too large.
        while touch.separation + way.least_from(self.nominal + before, touch.curvature) < self.minimum.0 {
            let [point, flank] = self.pieces;
            let (next, at_next, ended) = way.piece_end(self.nominal, before, &touch, self.pieces);
            if !(way.point.is_zero(point) && way.flank.is_zero(flank)) {
                let parts = if way.point.bends_back(point) || way.flank.bends_back(flank) { 4 } else { 1 };
                self.descend((before, touch), (next, at_next), parts);
            }
            (before, touch) = (next, at_next);
            self.offer(before, &touch, if ended[1] { PieceLocation::EndOfFlank } else { PieceLocation::EndOfPoint });
            self.pieces = [point + usize::from(ended[0]), flank + usize::from(ended[1])];
            if self.pieces[0] >= way.point.pieces() || self.pieces[1] >= way.flank.pieces() {
                break;
            }
        }
        self.minimum
    }

    fn pull(&self, before: f64, touch: &Touch) -> (f64, f64) {
        let [_, slope, bend] = self.way.pull(self.nominal, before, touch, self.pieces);
        (slope, bend)
    }

    fn touch(&self, before: f64) -> Touch {
        self.way.facing.touch(self.nominal + before, before)
    }

    fn offer(&mut self, before: f64, touch: &Touch, place: PieceLocation) {
        let gap = touch.separation + self.way.depth(self.nominal + before, touch.curvature);
        if gap < self.minimum.0 {
            self.minimum = (gap, Spot::Beside { side: self.way.side, pieces: self.pieces, place });
        }
    }

    /// Offers the minima between two places of one smooth piece, searched in equal parts.
    fn descend(&mut self, from: (f64, Touch), to: (f64, Touch), parts: u32) {
        let width = (to.0 - from.0) / f64::from(parts);
        let mut lower = (from.0, self.pull(from.0, &from.1));
        for part in 1..=parts {
            let end = if part == parts { to.0 } else { from.0 + width * f64::from(part) };
            let upper = (end, || self.pull(end, &if part == parts { to.1 } else { self.touch(end) }));
            let next = if parts > 1 { Some(upper.1()) } else { None };
            if lower.1.0 < 0.0 && next.is_none_or(|next| next.0 > 0.0) {
                self.newton(lower, end);
            }
            if let Some(next) = next {
                lower = (end, next);
            }
        }
    }

    /// From a place where the gap falls to where it rises again, at the latest at `end`.
    fn newton(&mut self, (start, (slope, bend)): (f64, (f64, f64)), end: f64) {
        let (mut lower, mut upper, mut tried_end) = (start, end, false);
        let mut at = if bend > 0.0 { start - slope / bend } else { end };
        for _ in 0..60 {
            if at >= upper {
                at = if tried_end { 0.5 * (lower + upper) } else { end };
            } else if at <= lower {
                at = 0.5 * (lower + upper);
            }
            let touch = self.touch(at);
            let (slope, bend) = self.pull(at, &touch);
            if at >= end {
                tried_end = true;
                if slope <= 0.0 {
                    // Lowest at the end of the piece, which is looked at in any case.
                    return;
                }
            }
            if slope < 0.0 {
                lower = at;
            } else {
                upper = at;
            }
            let next = if bend > 0.0 { at - slope / bend } else { 0.5 * (lower + upper) };
            if (next - at).abs() <= PLACE * (end - start) || upper - lower <= PLACE * (end - start) {
                let at = next.clamp(lower, upper);
                let touch = self.touch(at);
                self.offer(at, &touch, PieceLocation::Inside);
                return;
            }
            at = next;
        }
    }
}

#[cfg(test)]
mod tests;
