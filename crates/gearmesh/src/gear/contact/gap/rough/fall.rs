//! From a place beside the nominal point of contact down to the lowest one next to it, on the profiles themselves.
//!
//! Must not know: which places are lowest of all.

use super::super::{Way, pulled};
use super::line::{Line, Pair};
use super::near::{NEAR, Near};

/// What may be left of the gap to fall \[m\], of which a parabola tells all but a hundredth.
const NEGLIGIBLE: f64 = 1e-10;
/// The same where tangents tell, of which the gap may be all of it lower.
const LOWER: f64 = 1e-11;
/// The most steps of Newton's method, of tangents and of halving.
const MOST_STEPS: usize = 48;
/// How short a step is of which a parabola tells nearly all, over the distance of places.
const SHORT: f64 = 0.05;
/// A place is given up where a parabola's lowest point is nearer than this, over the distance of places, and would be no lower than the
/// least gap found so far even if it lay four times as far down.
const NEAR_BY: f64 = 0.25;
/// Four times as far, in terms of slope times step: a parabola falls by half of that.
const LEAVES_OUT: f64 = 2.0;
/// How near two places between which the gap is lowest are one, over the distance of places.
const CLOSEST: f64 = 1e-6;

/// The lowest place that was found at one path position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fall<'a, 'b> {
    pub(super) near: Near<'a, 'b>,
    pub(super) line: Line<'b>,
    /// The distance of places \[m\].
    pub(super) step: f64,
    pub(super) least: f64,
}

impl<'a, 'b> Fall<'a, 'b> {
    /// Of flanks over their own roll lengths. None where they have no place in common.
    pub(super) fn new(pair: &'b Pair, ways: &'b [Way<'a>; 2], s: f64, step: f64) -> Option<Self> {
        let nominal = [s, pair.tangent_length - s];
        let near = Near { ways, base_radii: pair.base_radii, nominal };
        Some(Self { near, line: Line::new(pair, nominal)?, step, least: f64::INFINITY })
    }

    /// The gap, its slope and its bend at a length along the pinion's flank, by the separation in closed form or, far off, as exactly as anything
    /// is known.
    fn pull(&self, place: f64) -> [f64; 3] {
        let (roll_lengths, is_ahead) = self.line.roll_lengths(place);
        if self.near.angle(roll_lengths) > NEAR {
            self.exactly(roll_lengths, is_ahead)
        } else {
            self.near.at(roll_lengths, is_ahead).rates
        }
    }

    /// The same from the separation of points.
    fn exactly(&self, roll_lengths: [f64; 2], is_ahead: bool) -> [f64; 3] {
        let Near { ways, nominal, base_radii } = self.near;
        let (way, point) = (&ways[usize::from(!is_ahead)], usize::from(is_ahead));
        let own = way.facing.turned(way.side, nominal[0]);
        let before = (nominal[point] - roll_lengths[point]).max(way.facing.start - own).max(0.0);
        let touch = way.facing.touch(own + before, before);
        let [gap, slope, bend] =
            pulled(&touch, way.point.held_rates(own + before), way.flank.held_rates(touch.curvature));
        // Over the length along the flank, against which the point moves.
        let rate = base_radii[point] / roll_lengths[point];
        let bend = (bend + slope / roll_lengths[point]) * rate * rate;
        [gap, if is_ahead { slope * rate } else { -slope * rate }, bend]
    }

    /// An end of what both flanks have, or just before it: beyond it depths are held.
    fn end(&self, is_up: bool) -> f64 {
        let [low, high] = self.line.range;
        let inside = CLOSEST * self.step;
        if is_up { (high - inside).max(low) } else { (low + inside).min(high) }
    }

    /// The gap may be lowest at an end, or between that and the place next to it.
    pub(super) fn down_from_end(&mut self, is_up: bool) {
        let end = self.end(is_up);
        let [gap, slope, bend] = self.pull(end);
        self.least = self.least.min(gap);
        let falls = if is_up { slope } else { -slope };
        if bend > 0.0 && falls > 0.0 && falls < 2.0 * bend * self.step {
            self.down_from(end);
        }
    }

    /// From one place down to the lowest one beside it, an end among them.
    pub(super) fn down_from(&mut self, place: f64) {
        let (ends, step) = (self.line.range, self.step);
        let [mut low, mut high] = ends;
        // The last place where it falls, and the last one where it rises: place, gap, slope.
        let mut sides: [Option<[f64; 3]>; 2] = [None; 2];
        let mut at = place.clamp(low, high);
        for _ in 0..MOST_STEPS {
            let [gap, slope, bend] = self.pull(at);
            let newton = if bend > 0.0 { -slope / bend } else { (2.0 * step).copysign(-slope) };
            let next = at + newton.clamp(-2.0 * step, 2.0 * step);
            // Of so short a step the parabola tells all but a hundredth.
            let negligible = if newton.abs() <= SHORT * step { 10.0 * NEGLIGIBLE } else { NEGLIGIBLE };
            if bend > 0.0 && (slope * newton).abs() <= negligible && next >= low && next <= high {
                self.least = self.least.min(gap + 0.5 * slope * newton);
                return;
            }
            // So near the lowest point that it is no lower than another one, whatever the parabola leaves out.
            if bend > 0.0 && newton.abs() <= NEAR_BY * step && gap + LEAVES_OUT * slope * newton >= self.least {
                return;
            }
            self.least = self.least.min(gap);
            let side = usize::from(slope >= 0.0);
            sides[side] = Some([at, gap, slope]);
            *(if side == 0 { &mut low } else { &mut high }) = at;
            let is_beyond = [next <= ends[0] && low <= ends[0], next >= ends[1] && high >= ends[1]];
            if is_beyond.contains(&true) {
                let [gap, ..] = self.pull(self.end(is_beyond[1]));
                self.least = self.least.min(gap);
                return;
            }
            if high - low <= CLOSEST * step {
                return;
            }
            at = if next > low && next < high { next } else { 0.5 * (low + high) };
            // At a kink, over which Newton's method leads to and fro, tangents from both sides meet.
            if let [Some([before, above, falls]), Some([behind, other, rises])] = sides {
                let met = (other - above + falls * before - rises * behind) / (falls - rises);
                let bound = above + falls * (met - before);
                if (gap - bound).abs() <= LOWER {
                    return;
                }
                if !(next > low && next < high) && met > low && met < high {
                    at = met;
                }
            }
        }
    }
}
