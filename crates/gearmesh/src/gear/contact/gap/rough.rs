//! The gap of rough flanks: a scan beside the nominal point of contact, then Newton's method where it is lowest.
//!
//! Where profiles bend back by more than the separation S bends, crests of one flank stand in valleys of the other or on its
//! crests, and the gap is low at as many places. No hull of one flank alone tells how deep crests of the other reach. So all
//! places near enough are looked at, in steps between which the gap falls by no more than is known from how the profiles bend,
//! and those that could be the lowest are followed on the profiles themselves. Must not know: load, what the profiles are.

use super::outline::Outline;
use super::{Way, pulled};
use crate::gear::geometry::GearPair;
use depths::{BLOCK, Depths, GROUP, LANES, along};
use near::{Here, NEAR, Near};
use scan::{Flanks, Group, Scan, positive, single};

mod depths;
mod near;
mod scan;

/// By how much the gap may be lower between two places of the scan than at both \[m\], where it bends most: it says how near they are.
const BETWEEN: f64 = 1200e-9;
/// What is left of that when a parabola through three places tells where it is lowest.
const LEFT: f64 = 0.5;
/// The fewest and the most steps of a scan along a flank.
const FEWEST: f64 = 400.0;
const MOST: f64 = 65_536.0;
/// What may be left of the gap to fall \[m\], of which a parabola tells all but a hundredth.
const NEGLIGIBLE: f64 = 1e-9;
/// The most steps of Newton's method and of halving.
const MOST_STEPS: usize = 48;
/// How near two places between which the gap is lowest are one, over the steps of a scan.
const CLOSEST: f64 = 1e-6;
/// Of single precision, over the length of the line of action: a hundredth of a half of its last bits, as flanks turn by no more.
const ROUNDING: f32 = 1e-9;
/// Places that wait to be followed.
const WAITING: usize = 8;
/// Blocks of a group before that of the nominal point.
const HALF: usize = GROUP / 2;
/// Parts of the path in each of which it is known what a scan misses.
const PARTS: usize = 32;
/// How near to a base circle it is asked how much the gap bends, over the length of the line of action.
const NEAREST: f64 = 1e-3;
/// How far apart places are at the most, over the shortest wave over 2π.
const SHORTEST: f64 = 2.2;

/// Both flanks for scans.
#[derive(Clone, Debug)]
pub(super) struct Rough {
    flanks: Flanks,
    tangent_length: f64,
    /// Where parts of the path begin, and how many there are in a length.
    from: f64,
    per_length: f64,
    /// Of each what is left when a parabola tells by how much the gap is lower between two places than at both, and how much that is \[m\].
    parts: [(f32, f32); PARTS],
    /// On how many stretches either flank bends back by more than the separation bends where it does so least.
    pub(super) crests: usize,
}

/// A search for the least gap at one path position.
struct Search<'a, 'b> {
    near: Near<'a, 'b>,
    scan: Scan<'b>,
    between: f32,
    dip: f32,
    /// By how much depths and separations of one place differ \[m\].
    rounding: f32,
    /// The least gap that was found, and what that of the places that wait is no higher than.
    least: f64,
    seen: f32,
    /// The gap there by a parabola, and the number of the place.
    waiting: [(f32, f64); WAITING],
    count: usize,
}

impl Rough {
    pub(super) fn new(pair: &GearPair, ways: &[Way; 2]) -> Self {
        let base_radii = [pair.pinion.base_radius, pair.gear.base_radius];
        // Each flank before points of the other one, over its own roll length.
        let outlines = [&ways[0].flank, &ways[1].flank];
        let [bends, kinks] = [Outline::most_bend, Outline::most_kink].map(|most| outlines.map(most));
        let [from, to] = outlines[0].range();
        let lengths = [0, 1].map(|at| outlines[at].range().map(|roll_length| along(roll_length, base_radii[at])));
        let length = (lengths[0][1] - lengths[0][0]).max(lengths[1][1] - lengths[1][0]);
        let waves = outlines.map(|outline| SHORTEST * outline.shortest());
        // By how much the gap bends and its slope grows along the flanks, and how far apart places may be for that.
        let needed = |s: f64| {
            // A flank may begin at its base circle.
            let s = s.clamp(NEAREST * pair.tangent_length, (1.0 - NEAREST) * pair.tangent_length);
            // How roll lengths grow.
            let [one, two] = [base_radii[0] / s, base_radii[1] / (pair.tangent_length - s)];
            let of_separation = one / base_radii[0] + two / base_radii[1];
            let bend = bends[0] * one * one + bends[1] * two * two + of_separation;
            let step = (4.0 * BETWEEN / bend).sqrt().min(waves[0] / one).min(waves[1] / two);
            (bend, kinks[0] * one + kinks[1] * two, step.clamp(length / MOST, length / FEWEST))
        };
        // All of it is the most at one of the ends of a part.
        let needed: [_; PARTS] = std::array::from_fn(|part| {
            let end = |end: usize| needed(from + (to - from) * (part + end) as f64 / PARTS as f64);
            let [one, other] = [end(0), end(1)];
            (one.0.max(other.0), one.1.max(other.1), one.2.min(other.2))
        });
        let step = needed.iter().map(|part| part.2).fold(f64::INFINITY, f64::min);
        let depths = [0, 1].map(|at| Depths::new(outlines[at], base_radii[at], if at == 0 { step } else { -step }));
        // What a function falls by between two places at which it is as high.
        let parts = needed.map(|(bend, kink, _)| {
            let [dip, of_kinks] = [0.125 * step * step * bend, 0.5 * step * kink];
            (single(LEFT * dip + of_kinks), single(dip + of_kinks))
        });
        let flanks = Flanks { depths, step, base_radii };
        // Over the own roll length, at its lower end.
        let separation = |at: usize| {
            let (own, length) = (outlines[at].range()[0], pair.tangent_length);
            length * own / ((length - own) * base_radii[at] * base_radii[at])
        };
        let crests = outlines[0].crests(separation(0)) + outlines[1].crests(separation(1));
        Self {
            flanks,
            tangent_length: pair.tangent_length,
            from,
            per_length: PARTS as f64 / (to - from),
            parts,
            crests,
        }
    }

    /// The least of a gap and of those at all places of both flanks.
    pub(super) fn least(&self, ways: &[Way; 2], s: f64, gap: f64) -> f64 {
        let part = positive((s - self.from) * self.per_length).min(PARTS - 1);
        let (between, dip) = self.parts[part];
        let (flanks, nominal) = (&self.flanks, [s, self.tangent_length - s]);
        let Some(mut scan) = Scan::new(flanks, nominal) else { return gap };
        let near = Near { ways, base_radii: flanks.base_radii, nominal };
        // Beyond an end of contact, where the end of one flank is nearest to the other one.
        if let Some(beyond) = ways.iter().position(|way| way.facing.start > way.facing.turned(way.side, s)) {
            let (roll_lengths, is_ahead) = scan.roll_lengths(scan.range[beyond]);
            let Here { apart, met, .. } = near.at(roll_lengths, is_ahead);
            scan.count_from(roll_lengths, apart, met);
            if scan.range[0] > scan.range[1] {
                return gap;
            }
        }
        let waiting = [(0.0, 0.0); WAITING];
        let rounding = ROUNDING * single(self.tangent_length);
        Search { near, scan, between, dip, rounding, least: gap, seen: single(gap), waiting, count: 0 }.run()
    }
}

impl Search<'_, '_> {
    fn run(mut self) -> f64 {
        let [first, last, nominal] = self.scan.blocks();
        let mut group = self.scan.group(nominal.cast_signed() - HALF.cast_signed(), nominal);
        // First where it may be the lowest, after which most others are out of the question.
        let mut lowest = HALF;
        for at in HALF - (nominal - first).min(HALF)..(HALF + last - nominal + 1).min(GROUP) {
            lowest = if group.least[at] < group.least[lowest] { at } else { lowest };
        }
        self.look_at((group.from + lowest.cast_signed()).cast_unsigned(), lowest >= HALF);
        group.least[lowest] = f32::INFINITY;
        if group.least[HALF] < self.seen {
            self.look_at(nominal, true);
        }
        // Nearer ones first, which leave less to those that are farther away.
        let mut hulls = [group.hull[HALF]; 2];
        let mut goes_on = [true; 2];
        let mut away = 1;
        while away < HALF && (goes_on[0] || goes_on[1]) {
            if goes_on[0] {
                goes_on[0] = self.go_on(&group, HALF - away, &mut hulls[0], nominal + 1 > first + away, false);
            }
            if goes_on[1] {
                goes_on[1] = self.go_on(&group, HALF + away, &mut hulls[1], nominal + away <= last, true);
            }
            away += 1;
        }
        for is_up in [false, true] {
            let mut block = if is_up { nominal + HALF } else { nominal + 1 - HALF.min(nominal + 1) };
            while goes_on[usize::from(is_up)] {
                let from = if is_up { block.cast_signed() - 1 } else { block.cast_signed() + 2 - GROUP.cast_signed() };
                let group = self.scan.group(from, nominal);
                for at in 1..GROUP - 1 {
                    let at = if is_up { at } else { GROUP - 1 - at };
                    let number = from + at.cast_signed();
                    let is_inside = number >= first.cast_signed() && number <= last.cast_signed();
                    goes_on[usize::from(is_up)] =
                        self.go_on(&group, at, &mut hulls[usize::from(is_up)], is_inside, is_up);
                    if !goes_on[usize::from(is_up)] {
                        break;
                    }
                }
                block = if is_up { block + GROUP - 2 } else { (block + 2).saturating_sub(GROUP) };
            }
        }
        self.follow_those_that_wait();
        self.least
    }

    /// Looks at a block of a group; tells whether anything farther out can be the lowest: what both hulls and the separation make together is
    /// convex.
    #[inline]
    fn go_on(&mut self, group: &Group, at: usize, before: &mut f32, is_inside: bool, is_up: bool) -> bool {
        if !is_inside {
            self.offer_end(self.scan.range[usize::from(is_up)]);
            return false;
        }
        let hull = group.hull[at];
        if hull >= self.seen && hull >= *before {
            return false;
        }
        *before = hull;
        if group.least[at] < self.seen {
            self.look_at((group.from + at.cast_signed()).cast_unsigned(), is_up);
        }
        true
    }

    /// Lets the places of a block wait that may be the lowest.
    fn look_at(&mut self, block: usize, is_up: bool) {
        let mut values = self.scan.values(block, is_up);
        // A place is not as high in the next block, to the last bits: neither may leave the lowest one to the other.
        values[0] += self.rounding;
        values[LANES - 1] += self.rounding;
        let mut least = [f32::INFINITY; 4];
        for (at, value) in values.iter().enumerate() {
            let lane = at % 4;
            least[lane] = if *value < least[lane] { *value } else { least[lane] };
        }
        let reach = self.seen + self.dip;
        if least[0] >= reach && least[1] >= reach && least[2] >= reach && least[3] >= reach {
            return;
        }
        for place in 1..LANES - 1 {
            let [before, value, after] = [values[place - 1], values[place], values[place + 1]];
            if value < reach && value <= before && value < after {
                self.offer(block, place, [before, value, after]);
            }
        }
    }

    /// Lets a place wait that is lower than both beside it.
    #[inline]
    fn offer(&mut self, block: usize, place: usize, [before, value, after]: [f32; 3]) {
        // The lowest place of the parabola through the three.
        let bend = before - 2.0 * value + after;
        let vertex =
            if bend > 0.0 && bend < f32::INFINITY { (0.5 * (before - after) / bend).clamp(-1.0, 1.0) } else { 0.0 };
        let dip = 0.5 * bend.clamp(0.0, f32::MAX) * vertex * vertex;
        if value - 1.5 * dip - self.between >= self.seen {
            return;
        }
        if self.count == WAITING {
            self.follow_those_that_wait();
        }
        self.seen = self.seen.min(value - 0.5 * dip + self.between);
        self.waiting[self.count] =
            (value - 1.5 * dip - self.between, (block * BLOCK + place - 1) as f64 + f64::from(vertex));
        self.count += 1;
    }

    fn follow_those_that_wait(&mut self) {
        while let Some(next) =
            (0..self.count).min_by(|one, other| self.waiting[*one].0.total_cmp(&self.waiting[*other].0))
        {
            let (lowest, number) = self.waiting[next];
            if f64::from(lowest) >= self.least {
                break;
            }
            self.count -= 1;
            self.waiting[next] = self.waiting[self.count];
            self.follow(number);
        }
        self.count = 0;
        self.seen = self.seen.min(single(self.least));
    }

    /// At a length along the pinion's flank, by the separation in closed form or, far off, as exactly as anything is known.
    fn pull(&self, place: f64) -> [f64; 3] {
        let (roll_lengths, is_ahead) = self.scan.roll_lengths(place);
        let Here { rates, angle, .. } = self.near.at(roll_lengths, is_ahead);
        if angle > NEAR { self.exactly(roll_lengths, is_ahead) } else { rates }
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
        // Over the length along the flank.
        let rate = base_radii[point] / roll_lengths[point];
        let slope = slope * rate;
        [gap, if is_ahead { slope } else { -slope }, (bend + slope / roll_lengths[point]) * rate * rate]
    }

    fn offer_end(&mut self, end: f64) {
        let (roll_lengths, is_ahead) = self.scan.roll_lengths(end);
        let [gap, ..] = self.exactly(roll_lengths, is_ahead);
        self.least = self.least.min(gap);
        self.seen = self.seen.min(single(gap));
    }

    /// From one place of the scan down to the lowest one beside it.
    fn follow(&mut self, number: f64) {
        let ([mut low, mut high], farthest) = (self.scan.range, 2.0 * self.scan.step());
        let mut at = self.scan.at(number).clamp(low, high);
        for _ in 0..MOST_STEPS {
            let [gap, slope, bend] = self.pull(at);
            let newton = if bend > 0.0 { -slope / bend } else { farthest.copysign(-slope) };
            let next = at + newton.clamp(-farthest, farthest);
            if bend > 0.0 && (slope * newton).abs() <= NEGLIGIBLE && next >= low && next <= high {
                self.least = self.least.min(gap + 0.5 * slope * newton);
                break;
            }
            self.least = self.least.min(gap);
            *(if slope < 0.0 { &mut low } else { &mut high }) = at;
            if high - low <= CLOSEST * farthest {
                break;
            }
            at = if next > low && next < high { next } else { 0.5 * (low + high) };
        }
    }
}
