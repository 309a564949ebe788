//! The gap of rough flanks: a scan beside the nominal point of contact, then Newton's method where it is lowest.
//!
//! Where profiles bend back by more than the separation S bends, crests of one flank stand in valleys of the other or on its
//! crests, and the gap is low at as many places. No hull of one flank alone tells how deep crests of the other reach. So all
//! places near enough are looked at, in steps between which the gap falls by no more than is known from how the profiles bend,
//! and those that could be the lowest are followed on the profiles themselves. Must not know: load, what the profiles are.

use super::{Way, pulled};
use crate::gear::geometry::GearPair;
use depths::{BLOCK, LANES};
use hull::Hull;
use near::{NEAR, Near};
use scan::{Flanks, Pair, Scan, positive, single};
use steps::{Need, Steps};

mod depths;
mod hull;
mod near;
mod scan;
mod steps;

/// By how much the gap may still be lower between two places than a parabola through three tells, over how much it may be lower than at both.
const LEFT: f64 = 0.5;
/// What may be left of the gap to fall \[m\], of which a parabola tells all but a hundredth.
const NEGLIGIBLE: f64 = 1e-10;
/// The most steps of Newton's method and of halving.
const MOST_STEPS: usize = 48;
/// How short a step is of which a parabola tells nearly all, over those of a scan.
const SHORT: f64 = 0.05;
/// How near two places between which the gap is lowest are one, over the steps of a scan.
const CLOSEST: f64 = 1e-6;
/// Of single precision, over the length of the line of action: a hundredth of a half of its last bits, as flanks turn by no more.
const ROUNDING: f32 = 1e-9;
/// By how many steps two estimates of the lowest place between two differ at the most, where it is one.
const ALIKE: f32 = 0.2;
/// Places that wait to be followed.
const WAITING: usize = 8;
/// Parts of the path in each of which it is known how near places have to be.
const PARTS: usize = 16;

/// Both flanks for scans.
#[derive(Clone, Debug)]
pub(super) struct Rough {
    pair: Pair,
    /// Tables of both flanks, each for parts of the path that want the same steps.
    stretches: Vec<Flanks>,
    tangent_length: f64,
    /// Where parts of the path begin, and how many there are in a length.
    from: f64,
    per_length: f64,
    parts: [Part; PARTS],
    /// On how many stretches either flank bends back by more than the separation bends where it does so least.
    pub(super) crests: usize,
}

/// What a scan goes by on a part of the path.
#[derive(Clone, Copy, Debug, Default)]
struct Part {
    stretch: usize,
    /// By how much the gap is lower between two places than at both, and what is left of that when a parabola tells by how much \[m\].
    dip: f32,
    between: f32,
}

/// A search for the least gap at one path position.
struct Search<'a, 'b> {
    near: Near<'a, 'b>,
    scan: Scan<'b>,
    part: Part,
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
        // Each flank before points of the other one, over its own roll length.
        let outlines = [&ways[0].flank, &ways[1].flank];
        let steps = Steps::new(pair, outlines);
        let [from, to] = steps.roll_lengths;
        let (mut parts, mut wanted) = ([Part::default(); PARTS], Vec::<Need>::new());
        let needs = steps.of::<PARTS>();
        let finest = needs.iter().map(|need| need.step).fold(f64::INFINITY, f64::min);
        for (part, need) in parts.iter_mut().zip(needs) {
            // Parts beside each other have one table, unless one of them can do with half as many places.
            let step = finest * libm::exp2(libm::log2(need.step / finest).floor());
            match wanted.last_mut() {
                Some(last) if last.step.total_cmp(&step).is_eq() => last.widen(&need.lengths),
                _ => wanted.push(Need { step, ..need }),
            }
            // What a function falls by between two places at which it is as high.
            let [dip, of_kinks] = [0.125 * step * step * need.bend, 0.5 * step * need.kink];
            *part =
                Part { stretch: wanted.len() - 1, dip: single(dip + of_kinks), between: single(LEFT * dip + of_kinks) };
        }
        let stretches: Vec<Flanks> =
            wanted.iter().map(|need| Flanks::new(outlines, steps.base_radii, need.lengths, need.step)).collect();
        let hulls = [0, 1].map(|at| Hull::new(steps.ranges[at], stretches.iter().map(|flanks| &flanks.depths[at])));
        // Over the own roll length, at its lower end.
        let separation = |at: usize| {
            let (own, length, radius) = (outlines[at].range()[0].max(0.0), pair.tangent_length, steps.base_radii[at]);
            length * own / ((length - own) * radius * radius)
        };
        // One where only both together bend back so much.
        let crests = (outlines[0].crests(separation(0)) + outlines[1].crests(separation(1))).max(1);
        Self {
            pair: Pair { base_radii: steps.base_radii, ranges: steps.ranges, hulls },
            stretches,
            tangent_length: pair.tangent_length,
            from,
            per_length: PARTS as f64 / (to - from),
            parts,
            crests,
        }
    }

    /// The least of a gap and of those at all places of both flanks.
    pub(super) fn least(&self, ways: &[Way; 2], s: f64, gap: f64) -> f64 {
        let part = self.parts[positive((s - self.from) * self.per_length).min(PARTS - 1)];
        let nominal = [s, self.tangent_length - s];
        let flanks = &self.stretches[part.stretch];
        let Some(mut scan) = Scan::new(&self.pair, flanks, nominal) else { return gap };
        let near = Near { ways, base_radii: self.pair.base_radii, nominal };
        // Beyond an end of contact, where the end of one flank is nearest to the other one: anywhere on that, so that places are told there only.
        let beside;
        if let Some(end) = ways.iter().position(|way| way.facing.start > way.facing.turned(way.side, s)) {
            let (roll_lengths, is_ahead) = scan.roll_lengths(scan.range[end]);
            let here = near.at(roll_lengths, is_ahead);
            beside = self.pair.beside([&ways[0].flank, &ways[1].flank], [roll_lengths, here.met], &here, flanks.step);
            scan = scan.on(&beside);
            scan.count_from(roll_lengths, here.apart, here.met);
            if scan.range[0] > scan.range[1] {
                return gap;
            }
        }
        let waiting = [(0.0, 0.0); WAITING];
        let rounding = ROUNDING * single(self.tangent_length);
        Search { near, scan, part, rounding, least: gap, seen: single(gap), waiting, count: 0 }.run()
    }
}

impl Search<'_, '_> {
    #[allow(clippy::cast_possible_truncation)] // numbers of places
    fn run(mut self) -> f64 {
        let width = BLOCK.cast_signed();
        let (ends, [lowest, highest]) = (self.scan.numbers, self.scan.known());
        let (first, last) = ((ends[0] as isize).max(lowest), (ends[1] as isize + 1).min(highest + width - 1));
        debug_assert!(first <= highest, "a scan begins where there are depths");
        if first > highest {
            return self.least;
        }
        let middle = (self.scan.nominal() as isize - width / 2).min(last + 1 - width).max(first);
        let [mut down, mut up] = [middle, middle + width];
        let apart = self.look_at(middle);
        let mut least = [self.scan.least_before(middle, &apart), self.scan.least_behind(middle + width - 1, &apart)];
        // Both ways, until no place farther out can be the lowest.
        loop {
            let goes_on = [down > first && least[0] < self.seen, up <= last && least[1] < self.seen];
            if goes_on[0] {
                down = (down - width).max(lowest);
                let apart = self.look_at(down);
                least[0] = self.scan.least_before(down, &apart);
            }
            if goes_on[1] {
                let from = up.min(highest);
                up = from + width;
                let apart = self.look_at(from);
                least[1] = self.scan.least_behind(up - 1, &apart);
            }
            if goes_on == [false; 2] {
                break;
            }
        }
        if down <= first {
            self.follow_end(false);
        }
        if up > last {
            self.follow_end(true);
        }
        self.follow_those_that_wait();
        self.least
    }

    /// Lets those of a block of places wait that may be the lowest; tells how far the flanks stand apart there.
    fn look_at(&mut self, first: isize) -> [f32; LANES] {
        let [mut values, apart] = self.scan.values(first - 1);
        // A place is not as high in the next block, to the last bits: neither may leave the lowest one to the other.
        values[0] += self.rounding;
        values[LANES - 1] += self.rounding;
        let mut low = low(&values, self.seen + self.part.dip);
        while low != 0 {
            self.offer(first - 1, low.trailing_zeros() as usize, &values);
            low &= low - 1;
        }
        apart
    }

    /// Lets a place wait that is lower than both beside it.
    #[inline]
    fn offer(&mut self, first: isize, place: usize, values: &[f32; LANES]) {
        let [before, value, after] = [values[place - 1], values[place], values[place + 1]];
        // The lowest place of the parabola through the three.
        let bend = before - 2.0 * value + after;
        let mut vertex =
            if bend > 0.0 && bend < f32::INFINITY { (0.5 * (before - after) / bend).clamp(-1.0, 1.0) } else { 0.0 };
        let dip = 0.5 * bend.clamp(0.0, f32::MAX) * vertex * vertex;
        let between = self.part.between;
        if value - 1.5 * dip - between >= self.seen {
            return;
        }
        // Where two more places hardly change that, it is nearer, and one step of Newton's method ends there; else there may be another low place.
        if place > 1 && place < LANES - 2 {
            let nearer = lowest([values[place - 2], before, value, after, values[place + 2]]);
            vertex = if (nearer - vertex).abs() < ALIKE { nearer } else { vertex };
        }
        if self.count == WAITING {
            self.follow_those_that_wait();
        }
        self.seen = self.seen.min(value - 0.5 * dip + between);
        let number = (first + place.cast_signed()) as f64 + f64::from(vertex);
        self.waiting[self.count] = (value - 1.5 * dip - between, number);
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
            self.follow(self.scan.at(number));
        }
        self.count = 0;
        self.seen = self.seen.min(single(self.least));
    }

    /// At a length along the pinion's flank, by the separation in closed form or, far off, as exactly as anything is known.
    fn pull(&self, place: f64) -> [f64; 3] {
        let (roll_lengths, is_ahead) = self.scan.roll_lengths(place);
        if self.near.angle(roll_lengths) > NEAR {
            self.exactly(place)
        } else {
            self.near.at(roll_lengths, is_ahead).rates
        }
    }

    /// The same from the separation of points.
    fn exactly(&self, place: f64) -> [f64; 3] {
        let (roll_lengths, is_ahead) = self.scan.roll_lengths(place);
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

    /// The gap may be lowest at an end, or between that and the place next to it.
    fn follow_end(&mut self, is_up: bool) {
        // Not beyond it, where depths are held.
        let [low, high] = self.scan.range;
        let inside = CLOSEST * self.scan.step();
        let end = if is_up { (high - inside).max(low) } else { (low + inside).min(high) };
        let [gap, slope, bend] = self.pull(end);
        self.least = self.least.min(gap);
        let falls = if is_up { slope } else { -slope };
        if bend > 0.0 && falls > 0.0 && falls < 2.0 * bend * self.scan.step() {
            self.follow(end);
        }
    }

    /// From one place down to the lowest one beside it.
    fn follow(&mut self, place: f64) {
        let (ends, step) = (self.scan.range, self.scan.step());
        let [mut low, mut high] = ends;
        let mut at = place.clamp(low, high);
        for _ in 0..MOST_STEPS {
            let [gap, slope, bend] = self.pull(at);
            let newton = if bend > 0.0 { -slope / bend } else { (2.0 * step).copysign(-slope) };
            let next = at + newton.clamp(-2.0 * step, 2.0 * step);
            // Of so short a step the parabola tells all but a hundredth.
            let negligible = if newton.abs() <= SHORT * step { 10.0 * NEGLIGIBLE } else { NEGLIGIBLE };
            if bend > 0.0 && (slope * newton).abs() <= negligible && next >= low && next <= high {
                self.least = self.least.min(gap + 0.5 * slope * newton);
                break;
            }
            self.least = self.least.min(gap);
            *(if slope < 0.0 { &mut low } else { &mut high }) = at;
            // What falls beyond an end is lowest there, and each end is looked at for itself.
            if high - low <= CLOSEST * step
                || (next <= ends[0] && low <= ends[0])
                || (next >= ends[1] && high >= ends[1])
            {
                break;
            }
            at = if next > low && next < high { next } else { 0.5 * (low + high) };
        }
    }
}

/// A bit for each place that is lower than both beside it and than this.
#[inline]
fn low(values: &[f32; LANES], reach: f32) -> u32 {
    let mut bits = [0_u32; LANES];
    for at in 1..LANES - 1 {
        let [is_near, has_fallen, rises] =
            [values[at] < reach, values[at] <= values[at - 1], values[at] < values[at + 1]].map(u32::from);
        bits[at] = (is_near & has_fallen & rises) << at;
    }
    bits.iter().fold(0, |all, bit| all | bit)
}

/// Where the polynomial through five places is lowest, from the middle one, to the second order of the distance.
#[inline]
fn lowest([far, before, at, after, behind]: [f32; 5]) -> f32 {
    let slope = (8.0 * (after - before) - (behind - far)) / 12.0;
    let bend = (16.0 * (before + after) - (far + behind) - 30.0 * at) / 12.0;
    let third = 0.5 * ((behind - far) - 2.0 * (after - before));
    let step = -slope / bend;
    step - 0.5 * third / bend * step * step
}
