//! Places beside the nominal point of contact, and the gap there, as a scan needs it.
//!
//! Contact moves by the same length along both flanks, so that f²/2r + q²/2r′ stays as it is, f and q being their radii of curvature, r and
//! r′ the base radii. The angle between the flanks is then (f − s)/r + (T − s − q)/r′, and the separation S its integral along them:
//! both to the second order in that angle. As S is a turn of the flank before the point, its roll length is longer by S: that of
//! the two which grows. The flank whose roll length changes faster leads, in equal steps. Must not know: how places are followed.

use super::depths::{BLOCK, Depths, block as block_of};
use crate::gear::contact::separation::Touch;

/// The places of a block, with one more on either side.
pub(super) const WITH_NEIGHBOURS: usize = BLOCK + 2;

/// Those places, counted from where the block begins.
const NUMBERS: [f64; WITH_NEIGHBOURS] = [-1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];

/// Both flanks at one path position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scan<'a> {
    leads: &'a Depths,
    follows: &'a Depths,
    /// Which gear leads.
    leading: usize,
    /// Roll lengths at the nominal point of which both leads and follows.
    nominal: [f64; 2],
    /// What the square of one roll length loses when that of the other grows, and the sum that stays.
    ratio: f64,
    sum: f64,
    /// The separation, of the squares and the third powers of the distances from the nominal roll lengths.
    squares: [f64; 2],
    cubes: [f64; 2],
    /// Beyond the ends of contact, far from the nominal point: what roll length of what follows and separation are more.
    more: [f64; 2],
    /// Between which roll lengths of the one that leads both flanks have points, and between which numbers of places.
    pub(super) range: [f64; 2],
    numbers: [f64; 2],
}

/// Where a block begins or ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// The block of what follows, and the number of the place.
    block: usize,
    number: f64,
    /// The separation, and the gap.
    apart: f64,
    gap: f64,
}

impl<'a> Scan<'a> {
    /// `own` are the roll lengths of pinion and gear at the nominal point; beyond the ends of contact `end` is where the end of one flank
    /// is nearest to the other one, which is that of this gear. None where the flanks have no place in common.
    pub(super) fn new(
        depths: &'a [Depths; 2],
        base_radii: [f64; 2],
        own: [f64; 2],
        end: Option<(usize, Touch)>,
    ) -> Option<Self> {
        let leading = usize::from(own[0] * base_radii[1] > own[1] * base_radii[0]);
        let following = 1 - leading;
        let (leads, follows) = (&depths[leading], &depths[following]);
        let (radius, other) = (base_radii[leading], base_radii[following]);
        let nominal = [own[leading], own[following]];
        let ratio = other / radius;
        let sum = nominal[1] * nominal[1] + ratio * nominal[0] * nominal[0];
        let against = |follows: f64| root((sum - follows * follows) / ratio);
        let mut range =
            [larger(leads.range[0], against(follows.range[1])), smaller(leads.range[1], against(follows.range[0]))];
        let (mut squares, mut cubes) = ([0.0; 2], [0.0; 2]);
        for (at, radius) in [radius, other].into_iter().enumerate() {
            let per_square = 1.0 / (radius * radius);
            (squares[at], cubes[at]) = (0.5 * nominal[at] * per_square, per_square / 3.0);
        }
        let known = end.map(|(flank, touch)| {
            let tip = depths[1 - flank].range[1];
            let (leads, follows) = if flank == leading { (touch.curvature, tip) } else { (tip, touch.curvature) };
            range[usize::from(nominal[0] > leads)] = leads;
            (leads, follows, touch.separation)
        });
        if range[0] > range[1] {
            return None;
        }
        let numbers = [leads.number(range[0]), leads.number(range[1])];
        let more = [0.0; 2];
        let mut scan = Self { leads, follows, leading, nominal, ratio, sum, squares, cubes, more, range, numbers };
        if let Some((leads, follows, separation)) = known {
            let [near, apart] = scan.opposite(leads);
            scan.more = [follows - near, separation - apart];
        }
        Some(scan)
    }

    /// The first and the last block of places.
    pub(super) fn blocks(&self) -> [usize; 2] {
        let [first, last] = self.range;
        [first, last].map(|end| block_of(self.leads.number(end)))
    }

    /// The block of the nominal point.
    pub(super) fn nearest_block(&self) -> usize {
        block_of(self.leads.number(self.nominal[0]))
    }

    /// The roll length of what follows, if the flanks did not stand apart.
    #[inline]
    fn following(&self, leads: f64) -> f64 {
        root(self.sum - self.ratio * leads * leads)
    }

    /// The roll length of what follows, and the separation.
    #[inline]
    fn opposite(&self, leads: f64) -> [f64; 2] {
        let follows = self.following(leads);
        let (one, other) = (leads - self.nominal[0], follows - self.nominal[1]);
        let apart = one * one * (self.squares[0] + self.cubes[0] * one)
            + other * other * (self.squares[1] + self.cubes[1] * other)
            + self.more[1];
        // What grows of both roll lengths is longer by the separation.
        let growth = if one > 0.0 { self.ratio * leads / larger(follows, f64::MIN_POSITIVE) } else { 1.0 };
        [follows + growth * apart + self.more[0], apart]
    }

    /// Where a block begins.
    #[inline]
    pub(super) fn edge(&self, block: usize) -> Edge {
        let [follows, apart] = self.opposite(self.leads.place((block * BLOCK) as f64));
        let number = self.follows.number(follows);
        let gap = apart + self.leads.from(block * BLOCK)[0][0] + self.follows.between(number);
        Edge { block: block_of(number), number, apart, gap }
    }

    /// What the gap is not less than in a block, one edge of which is nearer to the nominal point, and what the lower hulls of both flanks
    /// make of it. It falls from one edge to the other by no more than `dip` below both.
    #[inline]
    pub(super) fn at_least(&self, block: usize, near: &Edge, far: &Edge, dip: f64) -> [f64; 2] {
        let ([one, one_hull], [other, other_hull]) =
            (self.follows.least_of(near.block), self.follows.least_of(far.block));
        let [least, hull] = self.leads.least_of(block);
        let least = larger(near.apart + least + smaller(one, other), smaller(near.gap, far.gap) - dip);
        [least, near.apart + hull + smaller(one_hull, other_hull)]
    }

    /// The gap at all places of a block between these edges, with one more on either side; without bound where both flanks have none.
    pub(super) fn values(&self, block: usize, [from, to]: [&Edge; 2]) -> [f64; WITH_NEIGHBOURS] {
        let first = block * BLOCK - 1;
        let [middle, apart] = self.opposite(self.leads.place((block * BLOCK + BLOCK / 2) as f64));
        let middle = self.follows.number(middle);
        // Parabolas: what is of third order over so short a way is less than rounding of the depths.
        let apart = parabola([from.apart, apart, to.apart]);
        let numbers = parabola([from.number, middle, to.number]);
        let (mut values, mut places) = ([0.0; WITH_NEIGHBOURS], [0.0; WITH_NEIGHBOURS]);
        for (at, (value, place)) in values.iter_mut().zip(&mut places).enumerate() {
            let along = NUMBERS[at];
            *value = apart[0] + along * (apart[1] + along * apart[2]);
            *place = numbers[0] + along * (numbers[1] + along * numbers[2]);
        }
        let depths = &self.leads.from(first)[..WITH_NEIGHBOURS];
        for ((value, place), depth) in values.iter_mut().zip(places).zip(depths) {
            *value += depth[0] + self.follows.between(place);
        }
        let [low, high] = [self.numbers[0] - first as f64, self.numbers[1] - first as f64];
        if low > 0.0 || high < (WITH_NEIGHBOURS - 1) as f64 {
            for (at, value) in values.iter_mut().enumerate() {
                if (at as f64) < low || (at as f64) > high {
                    *value = f64::INFINITY;
                }
            }
        }
        values
    }

    /// Which way off the line of action a place is, of the gear's points before the pinion's flank or the reverse, and how far.
    pub(super) fn place(&self, leads: f64) -> (usize, f64) {
        let leads = leads.clamp(self.range[0], self.range[1]);
        let ahead = [leads - self.nominal[0], self.opposite(leads)[0] - self.nominal[1]];
        let [pinion, gear] = [ahead[self.leading], ahead[1 - self.leading]];
        if pinion >= 0.0 { (0, larger(-gear, 0.0)) } else { (1, -pinion) }
    }

    /// The roll length at a number of a place.
    pub(super) fn at(&self, number: f64) -> f64 {
        self.leads.place(number)
    }
}

/// The coefficients of the parabola through values at both ends and in the middle of a block, against the number of the place in it.
#[inline]
fn parabola([from, middle, to]: [f64; 3]) -> [f64; 3] {
    const HALF: f64 = 0.5 * BLOCK as f64;
    let bend = (from - 2.0 * middle + to) / (2.0 * HALF * HALF);
    [from, (to - from) / (2.0 * HALF) - 2.0 * HALF * bend, bend]
}

/// As these are one instruction.
#[inline]
fn larger(one: f64, other: f64) -> f64 {
    if one > other { one } else { other }
}

#[inline]
fn smaller(one: f64, other: f64) -> f64 {
    if one < other { one } else { other }
}

#[inline]
fn root(square: f64) -> f64 {
    larger(square, 0.0).sqrt()
}
