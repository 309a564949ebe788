//! Places beside the nominal point of contact, and the gap there, as a scan needs it.
//!
//! Contact moves by the same length along both flanks: their lengths from the base circles, f²/2r and q²/2r′ with the radii of curvature
//! f and q and the base radii r and r′, add up to what they do at the nominal point s. Places in equal steps along one are therefore in
//! equal steps along the other. The angle between the flanks is (f − s)/r + (T − s − q)/r′, and the separation S its integral along them:
//! both to the second order in that angle. Must not know: how places are followed.

use super::depths::{BLOCK, Depths, GROUP, LANES};

/// What makes numbers of places positive, whose fractions are wanted: the most places of all.
const POSITIVE: usize = 1 << 20;

/// The places of a block with their neighbours.
const PLACES: [f32; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];

/// Where blocks of a group begin and end.
const NUMBERS: [f32; GROUP + 1] = {
    let mut numbers = [0.0; GROUP + 1];
    let mut at = 0;
    while at < GROUP {
        numbers[at + 1] = numbers[at] + BLOCK as f32;
        at += 1;
    }
    numbers
};

/// What all scans of two flanks have in common.
#[derive(Clone, Debug)]
pub(super) struct Flanks {
    /// Of the pinion from its root, and of the gear from its tip.
    pub(super) depths: [Depths; 2],
    /// The distance of places \[m\].
    pub(super) step: f64,
    pub(super) base_radii: [f64; 2],
}

/// Both flanks at one path position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scan<'a> {
    flanks: &'a Flanks,
    /// Roll lengths at the nominal point.
    nominal: [f64; 2],
    /// What both lengths along the flanks add up to.
    sum: f64,
    /// By how many places that of the gear is ahead of the pinion's, and by which share of a step more.
    ahead: isize,
    share: f32,
    /// The same in whole blocks.
    blocks_ahead: isize,
    /// For the separation at places: of each flank how the square of the roll length grows in a step, the nominal roll length, and what counts
    /// for the square and the third power of the distance from it; and beyond the ends of contact what it is more.
    turns: [[f32; 4]; 2],
    more: f32,
    /// The separation for which places are beside each other, by what length those of the pinion are farther for that, and by how many steps
    /// roll lengths grow for what it is more.
    aligned: f32,
    shift: f64,
    growths: [f32; 2],
    /// Between which lengths along the pinion's flank both flanks have points, and between which numbers of places.
    pub(super) range: [f64; 2],
    numbers: [f64; 2],
}

/// Blocks beside each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    /// The first of them.
    pub(super) from: isize,
    /// What the gap is not less than in each, and not less than that by the lower hulls of both flanks.
    pub(super) least: [f32; GROUP],
    pub(super) hull: [f32; GROUP],
}

impl<'a> Scan<'a> {
    /// `nominal` are the roll lengths of pinion and gear at the nominal point. None where the flanks have no place in common.
    #[inline]
    pub(super) fn new(flanks: &'a Flanks, nominal: [f64; 2]) -> Option<Self> {
        let Flanks { depths: [pinion, gear], step, base_radii } = flanks;
        let per_step = 1.0 / step;
        let per_radius = base_radii.map(|radius| 1.0 / radius);
        let per_square = per_radius.map(|per| per * per);
        let along = |at: usize| 0.5 * nominal[at] * nominal[at] * per_radius[at];
        let mut scan = Self {
            flanks,
            nominal,
            sum: along(0) + along(1),
            ahead: 0,
            share: 0.0,
            blocks_ahead: 0,
            turns: [0, 1].map(|at| {
                let growth = if at == 0 { 2.0 } else { -2.0 } * base_radii[at] * step;
                let [square, cube] = [0.5 * nominal[at] * per_square[at], per_square[at] * (1.0 / 3.0)];
                [growth, nominal[at], square, cube].map(single)
            }),
            more: 0.0,
            aligned: 0.0,
            shift: 0.0,
            growths: [0, 1].map(|at| single(nominal[at] * per_radius[at] * per_step)),
            range: [0.0; 2],
            numbers: [0.0; 2],
        };
        let sum = scan.sum;
        scan.range = [larger(pinion.range[0], sum - gear.range[1]), smaller(pinion.range[1], sum - gear.range[0])];
        if scan.range[0] > scan.range[1] {
            return None;
        }
        scan.align(sum);
        Some(scan)
    }

    /// Lays places of both flanks beside each other whose lengths add up to this.
    #[inline]
    fn align(&mut self, sum: f64) {
        let Flanks { depths: [pinion, gear], step, .. } = self.flanks;
        let ahead = (pinion.first + gear.first - sum) / step + POSITIVE as f64;
        let whole = positive(ahead);
        (self.ahead, self.share) = (whole.cast_signed() - POSITIVE.cast_signed(), single(ahead - whole as f64));
        self.blocks_ahead = self.ahead.div_euclid(BLOCK.cast_signed());
        self.numbers = self.range.map(|place| self.number(place));
    }

    /// The first and the last block of places, and that of the nominal point or what is nearest to it.
    #[inline]
    pub(super) fn blocks(&self) -> [usize; 3] {
        let [radius, _] = self.flanks.base_radii;
        let nominal = 0.5 * self.nominal[0] * self.nominal[0] / radius;
        let number = self.number(nominal);
        let [low, high] = self.numbers;
        [low, high, smaller(larger(number, low), high)].map(|number| positive(number) / BLOCK)
    }

    /// Roll lengths of pinion and gear at a length along the pinion's flank, and whether that of the pinion has grown.
    #[inline]
    pub(super) fn roll_lengths(&self, place: f64) -> ([f64; 2], bool) {
        let [pinion, gear] = self.flanks.base_radii;
        let roll_lengths = [root(2.0 * pinion * place), root(2.0 * gear * (self.sum - place))];
        (roll_lengths, roll_lengths[0] >= self.nominal[0])
    }

    /// Counts the separation, and by how much the roll length of the flank that is met is more, from what they are at these roll lengths, which
    /// are far from the nominal ones.
    pub(super) fn count_from(&mut self, roll_lengths: [f64; 2], separation: f64, met: [f64; 2]) {
        let [pinion, gear] = [0, 1].map(|at| {
            let [_, _, square, cube] = self.turns[at].map(f64::from);
            let off = roll_lengths[at] - self.nominal[at];
            off * off * (square + cube * off)
        });
        self.more = single(separation - pinion - gear);
        let along = |at: usize, roll_length: f64| 0.5 * roll_length * roll_length / self.flanks.base_radii[at];
        self.shift = along(0, met[0]) - along(0, roll_lengths[0]);
        let sum = along(0, met[0]) + along(1, met[1]);
        // Both have points at the places that lie beside each other now.
        let [pinion, gear] = &self.flanks.depths;
        self.range = [
            larger(self.range[0], larger(pinion.range[0], sum - gear.range[1]) - self.shift),
            smaller(self.range[1], smaller(pinion.range[1], sum - gear.range[0]) - self.shift),
        ];
        self.align(sum);
        self.aligned = single(separation);
    }

    /// How far the flanks stand apart at places so many steps from this one.
    #[inline]
    fn separations<const N: usize>(&self, from: isize, mut steps: [f32; N]) -> [f32; N] {
        let [pinion, gear] = self.flanks.base_radii;
        let place = self.at(from as f64);
        // In single precision, in which roll lengths are known to a nanometre, and separations to a picometre.
        let squares = [2.0 * pinion * place, 2.0 * gear * (self.sum - place)].map(single);
        for step in &mut steps {
            *step = part(squares[0], self.turns[0], *step) + part(squares[1], self.turns[1], *step) + self.more;
        }
        steps
    }

    /// The blocks from this one on, of which one may be that of the nominal point.
    #[inline]
    pub(super) fn group(&self, from: isize, nominal: usize) -> Group {
        let [pinion, gear] = &self.flanks.depths;
        let apart = self.separations(from * BLOCK.cast_signed(), NUMBERS);
        let mut nearer = [0.0; GROUP];
        for at in 0..GROUP {
            nearer[at] = if apart[at] < apart[at + 1] { apart[at] } else { apart[at + 1] };
        }
        if let Ok(at) = usize::try_from(nominal.cast_signed() - from)
            && at < GROUP
        {
            nearer[at] = self.more;
        }
        let ahead = from + self.blocks_ahead;
        let both = |own: &[f32; GROUP + 1], other: &[f32; GROUP + 1]| {
            let mut both = nearer;
            for at in 0..GROUP {
                both[at] += own[at] + if other[at] < other[at + 1] { other[at] } else { other[at + 1] };
            }
            both
        };
        let (least, hull) = (both(pinion.least(from), gear.least(ahead)), both(pinion.hull(from), gear.hull(ahead)));
        Group { from, least, hull }
    }

    /// The gap at all places of a block with one more on either side; without bound where both flanks have none. The roll length of the pinion's
    /// flank grows by the separation if `is_up`, and else that of the gear's.
    #[inline]
    pub(super) fn values(&self, block: usize, is_up: bool) -> [f32; LANES] {
        let first = block * BLOCK - 1;
        let ahead = first.wrapping_add_signed(self.ahead);
        let [pinion, gear] = &self.flanks.depths;
        let (pinion, bends, gear) = (pinion.from(first), gear.bends_from(ahead), gear.from(ahead));
        let mut values = self.separations(first.cast_signed(), PLACES);
        let share = self.share;
        // A quarter of the second differences at both is what a cubic about falls by between two places.
        let fall = share * (share - 1.0);
        let apart = values;
        for at in 0..LANES {
            values[at] +=
                pinion[at] + (gear[at] + share * (gear[at + 1] - gear[at]) + fall * (bends[at] + bends[at + 1]));
        }
        if self.aligned > 0.0 {
            for at in 0..LANES {
                let rise = if is_up { pinion[at + 1] - pinion[at] } else { gear[at] - gear[at + 1] };
                values[at] += (apart[at] - self.aligned) * self.growths[usize::from(!is_up)] * rise;
            }
        }
        let [low, high] = self.numbers;
        if low > first as f64 || high < (first + LANES) as f64 {
            for (at, value) in values.iter_mut().enumerate() {
                if ((first + at) as f64) < low || (first + at) as f64 > high {
                    *value = f32::INFINITY;
                }
            }
        }
        values
    }

    /// The distance of places.
    pub(super) fn step(&self) -> f64 {
        self.flanks.step
    }

    /// The length along the pinion's flank at a number of a place.
    #[inline]
    pub(super) fn at(&self, number: f64) -> f64 {
        self.flanks.depths[0].first + self.flanks.step * number - self.shift
    }

    #[inline]
    fn number(&self, place: f64) -> f64 {
        (place + self.shift - self.flanks.depths[0].first) / self.flanks.step
    }
}

/// What one flank turns by, from the square of its roll length at a place and as in [`Scan`].
#[inline]
fn part(square: f32, [growth, nominal, squares, cubes]: [f32; 4], steps: f32) -> f32 {
    let square = square + growth * steps;
    let off = (if square > 0.0 { square } else { 0.0 }).sqrt() - nominal;
    off * off * (squares + cubes * off)
}

#[inline]
#[allow(clippy::cast_possible_truncation)] // lengths of gears
pub(super) fn single(value: f64) -> f32 {
    value as f32
}

/// The whole part; of what is below 0 that is 0.
#[inline]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
pub(super) fn positive(number: f64) -> usize {
    number as u32 as usize
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
