//! The gap of rough flanks: a scan beside the nominal point of contact, then Newton's method where it is lowest.
//!
//! Where profiles bend back by more than the separation S bends, crests of one flank stand in valleys of the other or on its
//! crests, and the gap is low at as many places. No hull of one flank alone tells how deep crests of the other reach. So all
//! places near enough are looked at, in steps between which the gap falls by no more than is known from how the profiles bend,
//! and those that could be the lowest are followed on the profiles themselves. Must not know: load, what the profiles are.

use super::Way;
use crate::gear::geometry::GearPair;
use depths::{BLOCK, LANES};
use fall::Fall;
use hull::Hull;
use line::Pair;
use pulp::{Arch, Simd, WithSimd};
use scan::{Flanks, Scan, positive, single};
use steps::{Need, Steps};

mod depths;
mod fall;
mod hull;
mod line;
mod near;
mod scan;
mod steps;
#[cfg(test)]
mod tests;

/// By how much the gap may still be lower between two places than a parabola through three tells, over how much it may be lower than at both.
const LEFT: f64 = 0.5;
/// Of single precision, over the length of the line of action: a hundredth of a half of its last bits, as flanks turn by no more.
const ROUNDING: f32 = 1e-9;
/// By how many steps two estimates of the lowest place between two differ at the most, where it is one.
const ALIKE: f32 = 0.2;
/// How far a step of a search may be where there is one lowest place, over the length of a flank.
const FAR: f64 = 0.01;
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
    /// What depths are no less than, over the lengths along both flanks.
    hulls: [Hull; 2],
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
    /// Of tables; none where the flanks bend back by less than the separation bends.
    stretch: Option<usize>,
    /// The distance of places \[m\].
    step: f64,
    /// By how much the gap is lower between two places than at both, and what is left of that when a parabola tells by how much \[m\].
    dip: f32,
    between: f32,
}

/// A search for the least gap at one path position.
struct Search<'a, 'b> {
    fall: Fall<'a, 'b>,
    scan: Scan<'b>,
    part: Part,
    /// By how much depths and separations of one place differ \[m\].
    rounding: f32,
    /// What the least gap that was found, or is at places that wait, is no higher than.
    seen: f32,
    registers: Arch,
    /// The gap there by a parabola, and the number of the place.
    waiting: [(f32, f64); WAITING],
    count: usize,
}

/// One for the first and the last place of a block with those beside it.
const ENDS: [f32; LANES] = {
    let mut ends = [0.0; LANES];
    (ends[0], ends[LANES - 1]) = (1.0, 1.0);
    ends
};

/// A look at places from this one on.
struct Look<'s, 'a, 'b> {
    search: &'s mut Search<'a, 'b>,
    first: isize,
}

impl WithSimd for Look<'_, '_, '_> {
    type Output = [f32; LANES];

    #[inline(always)]
    #[allow(clippy::inline_always)] // what is not inlined has registers of its own
    fn with_simd<S: Simd>(self, _registers: S) -> Self::Output {
        self.search.look_closely_at(self.first)
    }
}

impl Rough {
    /// None where flanks bend back by less than the separation bends, if they do so wherever they may touch and bend back at no kink elsewhere.
    pub(super) fn new(pair: &GearPair, ways: &[Way; 2], is_convex: bool) -> Option<Self> {
        let pair = Pair::new(pair, ways);
        // Each flank before points of the other one, over its own roll length.
        let outlines = [&ways[0].flank, &ways[1].flank];
        let steps = Steps::new(pair, outlines);
        let [from, to] = pair.roll_lengths[0];
        // Over the own roll length, at its lower end.
        let separation = |at: usize| {
            let (own, length, radius) = (outlines[at].range()[0].max(0.0), pair.tangent_length, pair.base_radii[at]);
            length * own / ((length - own) * radius * radius)
        };
        let back = [0, 1].map(|at| outlines[at].least_bends(separation(at)));
        let needs = steps.of::<PARTS>();
        let are_rough = needs.map(|need| steps.are_rough(&back, need.lengths));
        if is_convex && !are_rough.contains(&true) {
            return None;
        }
        let finest = needs.iter().map(|need| need.step).fold(f64::INFINITY, f64::min);
        let (mut parts, mut wanted) = ([Part::default(); PARTS], Vec::<Need>::new());
        let mut is_after_rough = false;
        for ((part, need), is_rough) in parts.iter_mut().zip(needs).zip(are_rough) {
            // Parts beside each other have one table, unless one of them can do with half as many places.
            let step = finest * libm::exp2(libm::log2(need.step / finest).floor());
            if is_rough {
                match wanted.last_mut() {
                    Some(last) if is_after_rough && last.step.total_cmp(&step).is_eq() => last.widen(&need.lengths),
                    _ => wanted.push(Need { step, ..need }),
                }
            }
            is_after_rough = is_rough;
            // What a function falls by between two places at which it is as high.
            let [dip, of_kinks] = [0.125 * step * step * need.bend, 0.5 * step * need.kink];
            let stretch = is_rough.then(|| wanted.len() - 1);
            *part = Part { stretch, step, dip: single(dip + of_kinks), between: single(LEFT * dip + of_kinks) };
        }
        let stretches: Vec<Flanks> =
            wanted.iter().map(|need| Flanks::new(outlines, pair.base_radii, need.lengths, need.step)).collect();
        let hulls = [0, 1].map(|at| Hull::new(outlines[at], pair.base_radii[at], pair.ranges[at]));
        Some(Self {
            pair,
            stretches,
            hulls,
            from,
            per_length: PARTS as f64 / (to - from),
            parts,
            // One where only both together bend back so much.
            crests: (back[0].crests + back[1].crests).max(1),
        })
    }

    fn part(&self, s: f64) -> &Part {
        &self.parts[positive((s - self.from) * self.per_length).min(PARTS - 1)]
    }

    /// The least of a gap and of those at all places of both flanks.
    pub(super) fn least(&self, ways: &[Way; 2], s: f64, gap: f64) -> f64 {
        let part = *self.part(s);
        let Some(mut fall) = Fall::new(&self.pair, ways, s, part.step) else { return gap };
        fall.least = gap;
        let Fall { near, mut line, .. } = fall;
        // Beyond an end of contact, where the end of one flank is nearest to the other one: anywhere on that, so that places are told there only.
        let beside;
        let flanks = if let Some(end) = ways.iter().position(|way| way.facing.start > way.facing.turned(way.side, s)) {
            let (roll_lengths, is_ahead) = line.roll_lengths(line.range[end]);
            let here = near.at(roll_lengths, is_ahead);
            let outlines = [&ways[0].flank, &ways[1].flank];
            beside = self.pair.beside((outlines, &self.hulls), [roll_lengths, here.met], &here, part.step);
            line.count_from(roll_lengths, here.apart, here.met);
            if line.range[0] > line.range[1] {
                return gap;
            }
            &beside
        } else {
            let Some(stretch) = part.stretch else {
                // There is one lowest place, however far.
                fall.step = FAR * self.pair.longest();
                fall.down_from(line.nominal());
                return fall.least;
            };
            &self.stretches[stretch]
        };
        let scan = Scan::new(line, flanks, &self.hulls);
        let waiting = [(0.0, 0.0); WAITING];
        let rounding = ROUNDING * single(self.pair.tangent_length);
        let registers = Arch::new();
        fall.line = line;
        Search { fall, scan, part, rounding, seen: single(gap), registers, waiting, count: 0 }.run()
    }
}

impl Search<'_, '_> {
    #[allow(clippy::cast_possible_truncation)] // numbers of places
    fn run(&mut self) -> f64 {
        let width = BLOCK.cast_signed();
        let (ends, [lowest, highest]) = (self.scan.numbers, self.scan.known());
        let (first, last) = ((ends[0] as isize).max(lowest), (ends[1] as isize + 1).min(highest + width - 1));
        debug_assert!(first <= highest, "a scan begins where there are depths");
        if first > highest {
            return self.fall.least;
        }
        let middle = (self.scan.nominal as isize - width / 2).min(last + 1 - width).max(first);
        let [mut down, mut up] = [middle, middle + width];
        let apart = self.look_at(middle);
        let tangent = self.scan.tangent(middle + width / 2);
        let mut least = [tangent.least_before(middle, &apart), tangent.least_behind(middle + width - 1, &apart)];
        // Both ways, until no place farther out can be the lowest.
        loop {
            let goes_on = [down > first && least[0] < self.seen, up <= last && least[1] < self.seen];
            if goes_on[0] {
                down = (down - width).max(lowest);
                let apart = self.look_at(down);
                least[0] = tangent.least_before(down, &apart);
            }
            if goes_on[1] {
                let from = up.min(highest);
                up = from + width;
                let apart = self.look_at(from);
                least[1] = tangent.least_behind(up - 1, &apart);
            }
            if goes_on == [false; 2] {
                break;
            }
        }
        if down <= first {
            self.fall.down_from_end(false);
        }
        if up > last {
            self.fall.down_from_end(true);
        }
        self.follow_those_that_wait();
        self.fall.least
    }

    /// Lets those of a block of places wait that may be the lowest; tells how far the flanks stand apart there. With registers as wide as the
    /// processor has, by which no bit differs.
    fn look_at(&mut self, first: isize) -> [f32; LANES] {
        self.registers.dispatch(Look { search: self, first })
    }

    #[inline(always)]
    #[allow(clippy::inline_always)] // as in `Look`
    fn look_closely_at(&mut self, first: isize) -> [f32; LANES] {
        let [values, apart] = self.scan.values(first - 1);
        let mut low = low(&values, self.seen + self.part.dip, self.rounding);
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
            if f64::from(lowest) >= self.fall.least {
                break;
            }
            self.count -= 1;
            self.waiting[next] = self.waiting[self.count];
            self.fall.down_from(self.scan.at(number));
        }
        self.count = 0;
        self.seen = self.seen.min(single(self.fall.least));
    }
}

/// A bit for each place that is lower than both beside it and than this. A place is not as high in the next block, to the last bits, which is why those at the
/// ends count for so much more: neither block may leave the lowest one to the other.
#[inline(always)]
#[allow(clippy::inline_always)] // as in `Look`
fn low(values: &[f32; LANES], reach: f32, rounding: f32) -> u32 {
    // None at the ends is lower than both beside it.
    let mut beside = [f32::NEG_INFINITY; LANES + 2];
    for at in 0..LANES {
        beside[at + 1] = values[at] + ENDS[at] * rounding;
    }
    let mut bits = [0_u32; LANES];
    for (at, bit) in bits.iter_mut().enumerate() {
        let [before, here, after] = [beside[at], beside[at + 1], beside[at + 2]];
        let [is_near, has_fallen, rises] = [here < reach, here <= before, here < after].map(u32::from);
        *bit = (is_near & has_fallen & rises) << at;
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
