//! Places beside the nominal point of contact, and the gap there, as a scan needs it.
//!
//! Contact moves by the same length along both flanks, so that f²/2r + q²/2r′ stays as it is, f and q being their radii of curvature, r and
//! r′ the base radii. The angle between the flanks is then (f − s)/r + (T − s − q)/r′, and the separation S its integral along them:
//! both to the second order in that angle. As S is a turn of the flank before the point, its roll length is longer by S: that of
//! the two which grows. The flank whose roll length changes faster leads, in equal steps. Must not know: how places are followed.

use super::depths::Depths;
use crate::gear::contact::separation::Touch;

/// Places that are looked at together.
pub(super) const BLOCK: usize = 8;
/// With one more on either side.
const WITH_NEIGHBOURS: usize = BLOCK + 2;

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
    /// Between which roll lengths of the one that leads both flanks have points.
    pub(super) range: [f64; 2],
    /// The first and the last place between them.
    numbers: [usize; 2],
    /// Beyond the ends of contact, far from the nominal point: what separation and roll length of what follows are more.
    more: [f64; 2],
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
        let [leads, follows] = [leading, 1 - leading].map(|side| &depths[side]);
        let [radius, other] = [leading, 1 - leading].map(|side| base_radii[side]);
        let nominal = [own[leading], own[1 - leading]];
        let ratio = other / radius;
        let sum = nominal[1] * nominal[1] + ratio * nominal[0] * nominal[0];
        let against = |follows: f64| ((sum - follows * follows) / ratio).max(0.0).sqrt();
        let mut range = [leads.first.max(against(follows.last)), leads.last.min(against(follows.first))];
        let squares = [0.5 * nominal[0] / (radius * radius), 0.5 * nominal[1] / (other * other)];
        let cubes = [1.0 / (3.0 * radius * radius), 1.0 / (3.0 * other * other)];
        let known = end.map(|(flank, touch)| {
            let tip = depths[1 - flank].last;
            let [leads, follows] = if flank == leading { [touch.curvature, tip] } else { [tip, touch.curvature] };
            range[usize::from(nominal[0] > leads)] = leads;
            (leads, follows, touch.separation)
        });
        if range[0] > range[1] {
            return None;
        }
        let numbers = [leads.number(range[0]).ceil(), leads.number(range[1]).floor()];
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the table
        let numbers = numbers.map(|number| number as usize);
        let more = [0.0; 2];
        let scan = Self { leads, follows, leading, nominal, ratio, sum, squares, cubes, range, numbers, more };
        let Some((leads, follows, separation)) = known else { return Some(scan) };
        let [near, apart] = scan.opposite(leads, scan.growth(leads));
        Some(Self { more: [follows - near, separation - apart], ..scan })
    }

    /// The first and the last block of places.
    pub(super) fn blocks(&self) -> [usize; 2] {
        [self.numbers[0] / BLOCK, self.numbers[1].max(self.numbers[0]) / BLOCK]
    }

    /// The block of the nominal point.
    pub(super) fn nearest_block(&self) -> usize {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // of what is below, the first one
        let number = self.leads.number(self.nominal[0]).max(0.0) as usize;
        number / BLOCK
    }

    /// The roll length of what follows, if the flanks did not stand apart.
    #[inline]
    fn following(&self, leads: f64) -> f64 {
        (self.sum - self.ratio * leads * leads).max(0.0).sqrt()
    }

    /// By how much the roll length of what follows is larger since the flanks stand apart, over that distance.
    fn growth(&self, leads: f64) -> f64 {
        if leads < self.nominal[0] { 1.0 } else { self.ratio * leads / self.following(leads).max(f64::MIN_POSITIVE) }
    }

    /// The roll length of what follows, and the separation.
    #[inline]
    fn opposite(&self, leads: f64, growth: f64) -> [f64; 2] {
        let follows = self.following(leads);
        let (one, other) = (leads - self.nominal[0], follows - self.nominal[1]);
        let [square, cube] = [self.squares, self.cubes];
        let apart =
            one * one * (square[0] + cube[0] * one) + other * other * (square[1] + cube[1] * other) + self.more[1];
        [follows + growth * apart + self.more[0], apart]
    }

    /// The least that both flanks take off anywhere.
    pub(super) fn lowest(&self) -> f64 {
        self.leads.least + self.follows.least
    }

    /// What the gap is not less than at a place.
    pub(super) fn at_least(&self, leads: f64) -> f64 {
        self.opposite(leads, 0.0)[1] + self.lowest()
    }

    /// The least separation in a block, and the least that both flanks take off there.
    #[inline(never)]
    pub(super) fn bounds(&self, block: usize) -> [f64; 2] {
        let ends = [block * BLOCK, (block + 1) * BLOCK].map(|number| self.leads.place(number));
        let opposite = ends.map(|end| self.opposite(end, self.growth(end)));
        let is_inside = ends[0] <= self.nominal[0] && ends[1] >= self.nominal[0];
        let apart = if is_inside { 0.0 } else { opposite[usize::from(ends[1] < self.nominal[0])][1] };
        let follows = opposite.map(|opposite| opposite[0]);
        [apart, self.leads.least_of(block) + self.follows.least_between([follows[1], follows[0]])]
    }

    /// The gap at all places of a block, with one more on either side; without bound where there is none.
    #[inline(never)]
    pub(super) fn values(&self, block: usize) -> [f64; WITH_NEIGHBOURS] {
        let from = self.leads.place(block * BLOCK) - self.leads.step;
        let (mut values, mut follows) = ([0.0; WITH_NEIGHBOURS], [0.0; WITH_NEIGHBOURS]);
        let growth = self.growth(from);
        for at in 0..WITH_NEIGHBOURS {
            let [other, apart] = self.opposite(from + self.leads.step * at as f64, growth);
            values[at] = apart;
            follows[at] = self.follows.number(other).max(0.0);
        }
        let first = block * BLOCK;
        for at in 0..WITH_NEIGHBOURS {
            let number = first + at;
            values[at] = if number > self.numbers[0] && number <= self.numbers[1] + 1 {
                values[at] + self.leads.at(number - 1) + self.follows.between(follows[at])
            } else {
                f64::INFINITY
            };
        }
        values
    }

    /// A place and its neighbours, as far as both flanks have points there.
    pub(super) fn around(&self, number: usize) -> [f64; 3] {
        let at = self.leads.place(number);
        [at - self.leads.step, at, at + self.leads.step].map(|place| place.clamp(self.range[0], self.range[1]))
    }

    /// Which way off the line of action a place is, of the gear's points before the pinion's flank or the reverse, and how far.
    pub(super) fn place(&self, leads: f64) -> (usize, f64) {
        let ahead = [leads - self.nominal[0], self.opposite(leads, self.growth(leads))[0] - self.nominal[1]];
        // Of the pinion and the gear.
        let [pinion, gear] = [ahead[self.leading], ahead[1 - self.leading]];
        if pinion >= 0.0 { (0, (-gear).max(0.0)) } else { (1, -pinion) }
    }
}
