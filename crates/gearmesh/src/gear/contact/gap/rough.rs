//! The gap of rough flanks: a scan beside the nominal point of contact, then Newton's method where it is lowest.
//!
//! Where profiles bend back by more than the separation S bends, crests of one flank stand in valleys of the other or on its
//! crests, and the gap is low at as many places. No hull of one flank alone tells how deep crests of the other reach. So all
//! places near enough are looked at, in steps between which the gap falls by no more than is known from how the profiles bend,
//! and those that could be the lowest are followed on the profiles themselves. Must not know: load, what the profiles are.

use super::{Way, pulled};
use crate::gear::geometry::GearPair;
use depths::{BLOCK, Depths};
use scan::{Edge, Scan, WITH_NEIGHBOURS};

mod depths;
mod scan;

/// By how much the gap may be lower between two places of the scan than at both \[m\]: it says how near they are.
const BETWEEN: f64 = 150e-9;
/// The fewest and the most steps of a scan along the path.
const FEWEST: f64 = 256.0;
const MOST: f64 = 65_536.0;
/// What may be left of the gap to fall \[m\], of which a parabola tells all but a hundredth.
const NEGLIGIBLE: f64 = 1e-9;
/// The most steps of Newton's method and of halving.
const MOST_STEPS: usize = 48;
/// How near two places between which the gap is lowest are one, over the steps of a scan.
const CLOSEST: f64 = 1e-6;
/// By how much it may be lower in a block than at both its edges, over that: the square of its steps, of which half is for lines.
const DIP: f64 = 0.5 * (BLOCK * BLOCK) as f64 + 1.0;
/// Places that wait to be followed.
const WAITING: usize = 16;

/// Depths of the pinion and of the gear over their own roll lengths, which are radii of curvature, at places for a scan.
#[derive(Clone, Debug)]
pub(super) struct Rough {
    depths: [Depths; 2],
    step: f64,
    base_radii: [f64; 2],
    tangent_length: f64,
    /// By how much the gap may be lower between two places than at both \[m\].
    between: f64,
    /// On how many stretches either flank bends back by more than the separation bends where it does so least.
    pub(super) crests: usize,
}

/// A search for the least gap at one path position.
struct Search<'a, 'b> {
    ways: &'b [Way<'a>; 2],
    scan: Scan<'b>,
    s: f64,
    between: f64,
    step: f64,
    /// The least gap that was found, and the least of a place that waits.
    least: f64,
    seen: f64,
    /// The gap there, and the number of the place.
    waiting: [[f64; 2]; WAITING],
    count: usize,
}

/// Blocks of places in one direction from the nominal point.
#[derive(Clone, Copy, Debug)]
struct Direction {
    is_up: bool,
    block: usize,
    /// The edge that is nearer to the nominal point.
    near: Edge,
    /// What the gap was at least by the hulls of both flanks, in the block before.
    before: f64,
}

impl Rough {
    pub(super) fn new(pair: &GearPair, ways: &[Way; 2]) -> Self {
        let base_radii = [pair.pinion.base_radius, pair.gear.base_radius];
        let length = pair.tangent_length;
        // Each flank before points of the other one, over its own roll length.
        let flanks = [&ways[0].flank, &ways[1].flank];
        let [from, to] = flanks[0].range();
        // How much the separation bends along the flank that leads.
        let bend = |s: f64| {
            let along = |own: f64, radius: f64| own / radius * (own / radius) * (1.0 / s + 1.0 / (length - s));
            along(s, base_radii[0]).min(along(length - s, base_radii[1]))
        };
        let of_separation = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| bend(from + share * (to - from)));
        let bends = of_separation.into_iter().fold(0.0, f64::max) + flanks[0].most_bend() + flanks[1].most_bend();
        let kinks = flanks[0].most_kink() + flanks[1].most_kink();
        // Short waves show at six places each, however low they are.
        let shortest = flanks[0].shortest().min(flanks[1].shortest());
        let step = (4.0 * BETWEEN / bends).sqrt().min(shortest).clamp((to - from) / MOST, (to - from) / FEWEST);
        // What a function falls by between two places, and what lines between the other flank's places are off.
        let between = step * (0.25 * step * bends + 0.5 * kinks);
        let depths = flanks.map(|flank| Depths::new(flank, step));
        // Over the own roll length, at its lower end.
        let separation = |at: usize| {
            let own = flanks[at].range()[0];
            length * own / ((length - own) * base_radii[at] * base_radii[at])
        };
        let crests = flanks[0].crests(separation(0)) + flanks[1].crests(separation(1));
        Self { depths, step, base_radii, tangent_length: length, between, crests }
    }

    /// The least of a gap and of those at all places of both flanks.
    pub(super) fn least(&self, ways: &[Way; 2], s: f64, gap: f64) -> f64 {
        let beyond = ways.iter().enumerate().find_map(|(flank, way)| {
            let before = way.facing.start - way.facing.turned(way.side, s);
            (before > 0.0).then(|| (flank, way.facing.flank_end(before)))
        });
        let own = [s, self.tangent_length - s];
        let Some(scan) = Scan::new(&self.depths, self.base_radii, own, beyond) else { return gap };
        let Self { between, step, .. } = *self;
        let waiting = [[0.0; 2]; WAITING];
        Search { ways, scan, s, between, step, least: gap, seen: gap, waiting, count: 0 }.run()
    }
}

impl Search<'_, '_> {
    fn run(mut self) -> f64 {
        let [first, last] = self.scan.blocks();
        let middle = self.scan.nearest_block().clamp(first, last);
        let edges = [self.scan.edge(middle), self.scan.edge(middle + 1)];
        self.look_at(middle, [&edges[0], &edges[1]]);
        let up = Direction { is_up: true, block: middle, near: edges[1], before: f64::NEG_INFINITY };
        let down = Direction { is_up: false, near: edges[0], ..up };
        let (mut up, mut down) = (Some(up), Some(down));
        while up.is_some() || down.is_some() {
            up = up.and_then(|direction| self.go_on(direction, [first, last]));
            down = down.and_then(|direction| self.go_on(direction, [first, last]));
        }
        self.follow_those_that_wait();
        self.least
    }

    /// Looks at the next block in a direction, as long as anything farther in it can be the lowest: what both hulls and the separation make
    /// together is convex.
    #[inline]
    fn go_on(&mut self, from: Direction, [first, last]: [usize; 2]) -> Option<Direction> {
        let Direction { is_up, block, near, before } = from;
        if block == if is_up { last } else { first } {
            self.offer_end(self.scan.range[usize::from(is_up)]);
            return None;
        }
        let block = if is_up { block + 1 } else { block - 1 };
        let far = self.scan.edge(if is_up { block + 1 } else { block });
        // At an end of a flank there is no bend that would be known.
        let dip = if block == first || block == last { f64::INFINITY } else { DIP * self.between };
        let [least, hull] = self.scan.at_least(block, &near, &far, dip);
        let reach = self.seen + self.between;
        if hull >= reach && hull >= before {
            return None;
        }
        if least < reach {
            self.look_at(block, if is_up { [&near, &far] } else { [&far, &near] });
        }
        Some(Direction { block, near: far, before: hull, ..from })
    }

    /// Lets the places of a block wait that may be the lowest.
    fn look_at(&mut self, block: usize, edges: [&Edge; 2]) {
        let values = self.scan.values(block, edges);
        let least =
            values[1..=BLOCK].iter().fold(f64::INFINITY, |least, value| if *value < least { *value } else { least });
        if least >= self.seen + self.between {
            return;
        }
        for place in 1..WITH_NEIGHBOURS - 1 {
            let [before, value, after] = [values[place - 1], values[place], values[place + 1]];
            if value < self.seen + self.between && value <= before && value < after {
                if self.count == WAITING {
                    self.follow_those_that_wait();
                }
                self.seen = self.seen.min(value);
                // The lowest place of the parabola through the three.
                let bend = before - 2.0 * value + after;
                let vertex = if bend < f64::INFINITY { 0.5 * (before - after) / bend } else { 0.0 };
                self.waiting[self.count] = [value, (block * BLOCK + place - 1) as f64 + vertex];
                self.count += 1;
            }
        }
    }

    fn follow_those_that_wait(&mut self) {
        while let Some(next) =
            (0..self.count).min_by(|one, other| self.waiting[*one][0].total_cmp(&self.waiting[*other][0]))
        {
            let [value, number] = self.waiting[next];
            if value >= self.least + self.between {
                break;
            }
            self.count -= 1;
            self.waiting[next] = self.waiting[self.count];
            self.follow(number);
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
        pulled(&touch, on.point.held_rates(nominal + before), on.flank.held_rates(touch.curvature))
    }

    fn offer_end(&mut self, end: f64) {
        let (way, before) = self.scan.place(end);
        let [gap, ..] = self.pull(way, before);
        self.least = self.least.min(gap);
        self.seen = self.seen.min(gap);
    }

    /// From one place of the scan down to the lowest one beside it.
    fn follow(&mut self, number: f64) {
        let (mut way, mut at) = self.scan.place(self.scan.at(number));
        let ends = |way: &Way, s: f64| {
            let nominal = way.facing.turned(way.side, s);
            ((way.facing.start - nominal).max(0.0), way.facing.end - nominal)
        };
        let (mut low, mut high) = ends(&self.ways[way], self.s);
        let (mut may_turn, farthest) = (low <= 0.0, 2.0 * self.step);
        for _ in 0..MOST_STEPS {
            let [gap, slope, bend] = self.pull(way, at);
            self.least = self.least.min(gap);
            if slope >= 0.0 && at <= 0.0 {
                if !may_turn {
                    break;
                }
                // It falls from the line of action to the other side of it, or nowhere.
                (way, may_turn) = (1 - way, false);
                (low, high) = ends(&self.ways[way], self.s);
                at = low;
                continue;
            }
            let newton = if bend > 0.0 { -slope / bend } else { farthest.copysign(-slope) };
            if bend > 0.0 && (slope * newton).abs() <= NEGLIGIBLE && newton >= low - at {
                self.least = self.least.min(gap + 0.5 * slope * newton);
                break;
            }
            *(if slope < 0.0 { &mut low } else { &mut high }) = at;
            if high - low <= CLOSEST * farthest {
                break;
            }
            let next = at + newton.clamp(-farthest, farthest);
            at = if next > low && next < high {
                next
            } else if next <= low && may_turn {
                0.0
            } else {
                0.5 * (low + high)
            };
        }
        self.seen = self.seen.min(self.least);
    }
}
