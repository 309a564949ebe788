//! The gap where no profile bends back: the only place where it no longer falls is the least, and is known beforehand.
//!
//! S and convex depths add up to a convex function of the distance from the line of action. Its slope there says towards
//! which side the flanks come nearer, and two steps of Newton's method lead to the place. Where the slope of a relief has
//! a step the flanks touch at that kink over a stretch of the path, whose two ends are roots of one equation each. Must
//! not know: profiles that bend back.

use super::{Gaps, PieceLocation, Spot, Way};
use crate::gear::contact::separation::Touch;
use crate::numeric::crossing::{bracketed, crossing};

/// The last term of a Taylor series that ends a search, over the separation: what it leaves is smaller still.
const CLOSE: f64 = 1e-12;
/// The most steps of a search for the least gap; one or two are taken.
const STEPS: usize = 8;
/// Those of a search for the end of a stretch, and where it stops, over the length of the path: the error of what is
/// integrated is of third order in it.
const SECANTS: usize = 12;
const PLACE: f64 = 1e-9;

/// A place was not found within the steps that a search has.
#[derive(Clone, Copy, Debug)]
struct NotFound;

impl Gaps<'_> {
    /// The least gap inside the path of contact.
    pub(super) fn convex(&self, s: f64) -> (f64, Spot) {
        let beside = self.ways.iter().find_map(|way| {
            let nominal = way.facing.turned(way.side, s);
            way.descend(nominal, 0.0, way.facing.on_line(nominal))
        });
        beside.unwrap_or_else(|| (self.on_line(s), Spot::OnLineOfAction))
    }

    /// Path positions inside the path of contact `known` among its breaks, where the flanks begin and cease to touch at a
    /// kink, at a tip or on the line of action; none where the search for one fails.
    pub(super) fn convex_changes(&self, known: &[f64]) -> Option<Vec<f64>> {
        let mut found: Vec<f64> = known.windows(2).filter_map(|ends| self.turn([ends[0], ends[1]])).collect();
        for way in &self.ways {
            for (outline, is_point) in [(&way.point, true), (&way.flank, false)] {
                for kink in 1..outline.cuts.len() {
                    // Where it comes to the kink on the piece before it, and where it goes on to the next one.
                    for piece in [kink - 1, kink] {
                        if piece < outline.pieces() {
                            found.extend(way.change(outline.cuts[kink], piece, is_point).ok()?);
                        }
                    }
                }
            }
        }
        Some(found)
    }

    /// Between two places before A or after E: where the gap begins or ceases to fall from the end of a flank inwards.
    pub(super) fn leaves_corner(&self, lower: f64, upper: f64) -> Option<f64> {
        let way = self.ways.iter().find(|way| {
            let [one, two] = [lower, upper].map(|s| way.facing.turned(way.side, s));
            one < way.facing.start && two < way.facing.start
        })?;
        if !self.is_convex {
            return None;
        }
        let slope = |s: f64| {
            let nominal = way.facing.turned(way.side, s);
            let before = way.facing.start - nominal;
            let touch = way.facing.flank_end(before);
            way.pull(nominal, before, &touch, way.pieces(way.facing.start, &touch))[1]
        };
        let ends = [lower, upper].map(|s| (s, slope(s)));
        let turns = ends[0].1 * ends[1].1 < 0.0;
        turns.then(|| crossing(slope, ends[0], ends[1], 0.1 * self.closest()))
    }

    /// Between two breaks inside the path of contact: where the depth is least, and the flanks touch on the line of action.
    fn turn(&self, [from, to]: [f64; 2]) -> Option<f64> {
        let way = &self.ways[0];
        let pieces = way.pieces(0.5 * (from + to), &way.facing.on_line(0.5 * (from + to)));
        let slope = |s: f64| way.pull(s, 0.0, &way.facing.on_line(s), pieces)[1];
        let inside = from >= way.facing.start && to <= way.facing.end;
        if inside && slope(from) < 0.0 && slope(to) > 0.0 { bracketed(from, to, slope) } else { None }
    }
}

impl Way<'_> {
    /// The smooth pieces on which both flanks are.
    pub(super) fn pieces(&self, point: f64, touch: &Touch) -> [usize; 2] {
        [self.point.piece(point), self.flank.piece(touch.curvature)]
    }

    /// The least gap from a place on; none if it does not fall there.
    pub(super) fn descend(&self, nominal: f64, mut from: f64, mut touch: Touch) -> Option<(f64, Spot)> {
        let mut pieces = self.pieces(nominal + from, &touch);
        let mut best = None;
        loop {
            let rates = self.pull(nominal, from, &touch, pieces);
            if rates[1] >= 0.0 {
                return best;
            }
            if let Some(gap) = self.fall(nominal, from, pieces, rates, self.third(nominal, from, &touch, pieces[1])) {
                return Some((gap, Spot::Beside { side: self.side, pieces, place: PieceLocation::Inside }));
            }
            let (end, at_end, ended) = self.piece_end(nominal, from, &touch, pieces);
            if self.pull(nominal, end, &at_end, pieces)[1] > 0.0 {
                return Some(self.between(nominal, [from, end], pieces));
            }
            let (gap, place) = if ended[1] {
                (self.point.depth(nominal + end) + self.flank.depth_at_end(pieces[1]), PieceLocation::EndOfFlank)
            } else {
                (self.point.depth_at_end(pieces[0]) + self.flank.depth(at_end.curvature), PieceLocation::EndOfPoint)
            };
            best = Some((at_end.separation + gap, Spot::Beside { side: self.side, pieces, place }));
            pieces = [0, 1].map(|of| pieces[of] + usize::from(ended[of]));
            if pieces[0] >= self.point.pieces() || pieces[1] >= self.flank.pieces() {
                return best;
            }
            (from, touch) = (end, at_end);
        }
    }

    /// The least gap on these pieces between a place where it falls and one where it rises.
    fn between(&self, nominal: f64, [from, to]: [f64; 2], pieces: [usize; 2]) -> (f64, Spot) {
        let rates = |before: f64| self.pull(nominal, before, &self.facing.touch(nominal + before, before), pieces);
        let at = bracketed(from, to, |before| rates(before)[1]).unwrap_or(to);
        (rates(at)[0], Spot::Beside { side: self.side, pieces, place: PieceLocation::Inside })
    }

    /// The least gap inside known pieces, if a few steps lead there.
    pub(super) fn inside(&self, nominal: f64, pieces: [usize; 2]) -> Option<f64> {
        let from = (self.facing.start - nominal).max(0.0);
        if from > 0.0 {
            let touch = self.facing.flank_end(from);
            return self.fall(nominal, from, pieces, self.pull(nominal, from, &touch, pieces), 0.0);
        }
        let touch = self.facing.on_line(nominal);
        let third = self.third_on_line(nominal, &touch, pieces[1]);
        self.fall(nominal, 0.0, pieces, self.pull(nominal, 0.0, &touch, pieces), third)
    }

    /// About the third derivative of the gap where a search begins, for the length of a step: known on the line of action.
    fn third(&self, nominal: f64, from: f64, touch: &Touch, flank: usize) -> f64 {
        if from > 0.0 { 0.0 } else { self.third_on_line(nominal, touch, flank) }
    }

    fn third_on_line(&self, nominal: f64, touch: &Touch, flank: usize) -> f64 {
        let bend = if self.flank.is_zero(flank) { 0.0 } else { self.flank.rates(touch.curvature, flank)[2] };
        self.facing.bend_slope(nominal) + 3.0 * bend * touch.rate * touch.rate_slope
    }

    /// The least gap on these pieces, from a place on where it falls; none where it falls to their end.
    fn fall(
        &self,
        nominal: f64,
        from: f64,
        pieces: [usize; 2],
        [_, mut slope, mut bend]: [f64; 3],
        mut third: f64,
    ) -> Option<f64> {
        let [first, last] = [0, 1].map(|end| self.point.cuts[pieces[0] + end] - nominal);
        let [floor, wall] = [0, 1].map(|end| self.flank.cuts[pieces[1] + end]);
        let mut at = from;
        for _ in 0..STEPS {
            // By the series of the slope to the second order.
            let newton = -slope / bend;
            let step = newton * (1.0 - (0.5 * third * newton / bend).clamp(-0.5, 0.5));
            at += step;
            if !(bend > 0.0 && at >= from && at <= last) {
                return None;
            }
            let touch = self.facing.touch(nominal + at, at);
            if touch.curvature > wall {
                return None;
            }
            let (before, gap);
            (before, [gap, slope, bend]) = (bend, self.pull(nominal, at, &touch, pieces));
            let left = -slope / bend;
            let (place, curvature) = (at + left, touch.curvature + touch.rate * left);
            if curvature > wall || place > last {
                return None;
            }
            // Of the Taylor series to the third order, its last term by how the second derivative has changed.
            third = (bend - before) / step;
            let rest = third * left * left * left / 6.0;
            if rest.abs() <= CLOSE * touch.separation {
                return (place >= first && curvature >= floor).then_some(gap + 0.5 * slope * left + rest);
            }
        }
        None
    }

    /// The path position from which on, or up to which, the flanks touch at the kink of one of them, if they move
    /// towards it this way on that piece; nothing where they do not.
    fn change(&self, kink: f64, piece: usize, is_point: bool) -> Result<Option<f64>, NotFound> {
        // The slope of the gap at the kink when this is the nominal position, which vanishes where it ceases to fall.
        let slope = |nominal: f64| {
            let (before, touch) = if nominal.to_bits() == kink.to_bits() {
                (0.0, self.facing.on_line(kink))
            } else if is_point {
                (kink - nominal, self.facing.touch(kink, kink - nominal))
            } else {
                self.meet(nominal, kink).ok_or(NotFound)?
            };
            let mut pieces = self.pieces(nominal + before, &touch);
            pieces[usize::from(!is_point)] = piece;
            let [_, slope, bend] = self.pull(nominal, before, &touch, pieces);
            Ok((slope, bend))
        };
        let inside = |nominal: f64| nominal > self.facing.start && nominal < self.facing.end;
        let (mut at, mut value) = (kink, slope(kink)?);
        if value.0 >= 0.0 {
            return Ok(None);
        }
        let mut next = kink + value.0 / value.1 * if is_point { 1.0 } else { self.facing.on_line(kink).rate };
        for _ in 0..SECANTS {
            if !inside(next) {
                // It is beyond the end of the path.
                return Ok(None);
            }
            let there = slope(next)?;
            let step = there.0 * (next - at) / (there.0 - value.0);
            (at, value) = (next, there);
            next -= step;
            if step.abs() <= PLACE * self.facing.end {
                return Ok(inside(next).then(|| self.facing.turned(self.side, next)));
            }
        }
        Err(NotFound)
    }

    /// How far from the line of action the flank is met where its radius of curvature is `wall`.
    pub(super) fn meet(&self, nominal: f64, wall: f64) -> Option<(f64, Touch)> {
        let mut touch = self.facing.on_line(nominal);
        let mut before = 0.0;
        for _ in 0..STEPS {
            // Half the square of the curvature is almost straight in the distance.
            let step = (wall * wall - touch.curvature * touch.curvature) / (2.0 * touch.curvature * touch.rate);
            before += step;
            touch = self.facing.touch(nominal + before, before);
            if step.abs() <= PLACE * self.facing.end {
                return Some((before, touch));
            }
        }
        None
    }
}
