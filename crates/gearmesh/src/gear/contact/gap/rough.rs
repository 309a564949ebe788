//! The gap of rough flanks: a scan beside the nominal point of contact, then Newton's method where it is lowest.
//!
//! Where profiles bend back by more than the separation S bends, crests of one flank stand in valleys of the other or on its
//! crests, and the gap is low at as many places. No hull of one flank alone tells how deep crests of the other reach. So all
//! places near enough are looked at, in steps between which the gap falls by no more than is known from how the profiles bend,
//! and those that could be the lowest are followed on the profiles themselves. Must not know: load, what the profiles are.

use super::Way;
use crate::gear::geometry::GearPair;
use depths::Depths;
use scan::{BLOCK, Scan};

mod depths;
mod scan;

/// By how much the gap may be lower between two places of the scan than at both \[m\]: it says how near they are.
const BETWEEN: f64 = 40e-9;
/// The fewest and the most steps of a scan along a flank.
const FEWEST: f64 = 256.0;
const MOST: f64 = 65_536.0;
/// What may be left of the gap to fall \[m\], of which a parabola tells all but a hundredth.
const NEGLIGIBLE: f64 = 1e-11;
/// The most steps of Newton's method and of halving.
const MOST_STEPS: usize = 48;
/// How near two places between which the gap is lowest are one, over the steps of a scan.
const CLOSEST: f64 = 1e-6;
/// Places that wait to be followed.
const WAITING: usize = 16;

/// Depths of the pinion and of the gear over their own roll lengths, which are radii of curvature, at places for a scan.
#[derive(Clone, Debug)]
pub(super) struct Rough {
    depths: [Depths; 2],
    base_radii: [f64; 2],
    tangent_length: f64,
    /// By how much the gap may be lower between two places than at both \[m\].
    between: f64,
}

/// A search for the least gap at one path position.
struct Search<'a, 'b> {
    ways: &'b [Way<'a>; 2],
    scan: Scan<'b>,
    s: f64,
    between: f64,
    /// The least gap that was found, and the least that is known of a place that waits.
    least: f64,
    seen: f64,
    waiting: [(f64, usize); WAITING],
    count: usize,
}

impl Rough {
    pub(super) fn new(pair: &GearPair, ways: &[Way; 2]) -> Self {
        let base_radii = [pair.pinion.base_radius, pair.gear.base_radius];
        let length = pair.tangent_length;
        // Each flank before points of the other one, over its own roll length.
        let flanks = [&ways[0].flank, &ways[1].flank];
        let range = flanks[0].range();
        // How much the separation bends along the flank that leads.
        let bend = |s: f64| {
            let along = |own: f64, radius: f64| own / radius * (own / radius) * (1.0 / s + 1.0 / (length - s));
            along(s, base_radii[0]).min(along(length - s, base_radii[1]))
        };
        let of_separation = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| bend(range[0] + share * (range[1] - range[0])));
        let bends = of_separation.into_iter().fold(0.0, f64::max) + flanks[0].most_bend() + flanks[1].most_bend();
        let kinks = flanks[0].most_kink() + flanks[1].most_kink();
        let step = (4.0 * BETWEEN / bends).sqrt();
        let depths = flanks.map(|flank| {
            let [from, to] = flank.range();
            Depths::new(flank, ((to - from) / step).clamp(FEWEST, MOST))
        });
        let step = depths[0].step.max(depths[1].step);
        // What a function falls by between two places, and what lines between the other flank's places are off.
        let between = step * (0.25 * step * bends + 0.5 * kinks);
        Self { depths, base_radii, tangent_length: length, between }
    }

    /// The least of a gap and of those at all places of both flanks.
    pub(super) fn least(&self, ways: &[Way; 2], s: f64, gap: f64) -> f64 {
        let Some(scan) = self.scan(ways, s) else { return gap };
        let (between, waiting) = (self.between, [(0.0, 0); WAITING]);
        Search { ways, scan, s, between, least: gap, seen: gap, waiting, count: 0 }.run()
    }

    fn scan(&self, ways: &[Way; 2], s: f64) -> Option<Scan<'_>> {
        let beyond = ways.iter().enumerate().find_map(|(flank, way)| {
            let before = way.facing.start - way.facing.turned(way.side, s);
            (before > 0.0).then(|| (flank, way.facing.flank_end(before)))
        });
        Scan::new(&self.depths, self.base_radii, [s, self.tangent_length - s], beyond)
    }
}

impl Search<'_, '_> {
    fn run(mut self) -> f64 {
        for end in self.scan.range {
            if self.scan.at_least(end) < self.least + self.between {
                self.offer_end(end);
            }
        }
        let [first, last] = self.scan.blocks();
        let middle = self.scan.nearest_block().clamp(first, last);
        for distance in 0..=last.max(middle) {
            let mut is_near = false;
            let below = if distance > 0 { middle.checked_sub(distance) } else { None };
            for block in [below, Some(middle + distance)].into_iter().flatten() {
                if block >= first && block <= last {
                    is_near |= self.look_at(block);
                }
            }
            if !is_near {
                break;
            }
        }
        self.follow_those_that_wait();
        self.least
    }

    /// Looks at a block of places. Whether anything that far away can be the lowest.
    fn look_at(&mut self, block: usize) -> bool {
        let reach = self.seen + self.between;
        let [separation, lowest] = self.scan.bounds(block);
        if separation + self.scan.lowest() >= reach {
            return false;
        }
        if separation + lowest >= reach {
            return true;
        }
        let values = self.scan.values(block);
        for place in 1..=BLOCK {
            let value = values[place];
            if value < self.seen + self.between && value <= values[place - 1] && value < values[place + 1] {
                self.seen = self.seen.min(value);
                if self.count == WAITING {
                    self.follow_those_that_wait();
                }
                self.waiting[self.count] = (value, block * BLOCK + place - 1);
                self.count += 1;
            }
        }
        true
    }

    fn follow_those_that_wait(&mut self) {
        let mut waiting = self.waiting;
        let waiting = &mut waiting[..self.count];
        waiting.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
        for (value, place) in waiting {
            if *value < self.least + self.between {
                self.follow(*place);
            }
        }
        self.count = 0;
        self.seen = self.least;
    }

    /// From the way and the place off the line of action; its gap, slope and bend.
    fn pull(&self, way: usize, before: f64) -> [f64; 3] {
        let on = &self.ways[way];
        let nominal = on.facing.turned(on.side, self.s);
        let before = before.max(on.facing.start - nominal);
        let touch = if before > 0.0 { on.facing.touch(nominal + before, before) } else { on.facing.on_line(nominal) };
        on.pull(nominal, before, &touch, on.pieces(nominal + before, &touch))
    }

    fn offer_end(&mut self, end: f64) {
        let (way, before) = self.scan.place(end);
        let [gap, ..] = self.pull(way, before);
        self.least = self.least.min(gap);
        self.seen = self.seen.min(gap);
    }

    /// From one place of the scan down to the lowest one beside it.
    fn follow(&mut self, number: usize) {
        let [lower, at, upper] = self.scan.around(number).map(|place| self.scan.place(place));
        // Beside the line of action, the way is that on which the gap falls from there.
        let is_beside = lower.0 != upper.0;
        let way = if is_beside { usize::from(self.pull(0, 0.0)[1] >= 0.0) } else { at.0 };
        let facing = &self.ways[way].facing;
        let nominal = facing.turned(self.ways[way].side, self.s);
        let (mut low, mut high) = ((facing.start - nominal).max(0.0), facing.end - nominal);
        let mut at = if at.0 == way { at.1.clamp(low, high) } else { low };
        let farthest = (upper.1 - lower.1).abs().max(lower.1.max(upper.1) * f64::from(u8::from(is_beside)));
        for _ in 0..MOST_STEPS {
            let [gap, slope, bend] = self.pull(way, at);
            self.least = self.least.min(gap);
            let down = if slope < 0.0 { 1.0 } else { -1.0 };
            *(if slope < 0.0 { &mut low } else { &mut high }) = at;
            let step = if bend > 0.0 { (-slope / bend).clamp(-farthest, farthest) } else { down * farthest };
            let next = at + step;
            if bend > 0.0 && (slope * step).abs() <= NEGLIGIBLE {
                self.least = self.least.min(gap + 0.5 * slope * step);
                break;
            }
            if high - low <= CLOSEST * farthest {
                break;
            }
            at = if next > low && next < high { next } else { 0.5 * (low + high) };
        }
        self.seen = self.seen.min(self.least);
    }
}
impl Rough {
    #[cfg(test)]
    pub(super) fn debug(&self, ways: &[Way; 2], s: f64) {
        let scan = self.scan(ways, s).unwrap();
        let [first, last] = scan.blocks();
        println!("step {:e} between {:e} blocks {first} {last} middle {}", self.depths[0].step, self.between, scan.nearest_block());
        let mut low = f64::INFINITY;
        for block in first..=last { for v in &scan.values(block)[1..=BLOCK] { low = low.min(*v); } }
        for block in first..=last {
            let values = scan.values(block);
            for place in 1..=BLOCK {
                if values[place] < low + 2e-7 {
                    let number = block * BLOCK + place - 1;
                    let mut search = Search { ways, scan, s, between: self.between, least: f64::INFINITY, seen: f64::INFINITY, waiting: [(0.0, 0); WAITING], count: 0 };
                    let (way, before) = scan.place(scan.around(number)[1]);
                    let exact = search.pull(way, before);
                    search.follow(number);
                    println!("  {number} {:e} way {way} before {before:e} exact {exact:?} followed {:e} bounds {:?}", values[place], search.least, scan.bounds(block));
                }
            }
        }
    }
}
