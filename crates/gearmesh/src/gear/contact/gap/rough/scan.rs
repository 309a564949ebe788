//! Places beside the nominal point of contact, and the gap there, as a scan needs it.
//!
//! Contact moves by the same length along both flanks: their lengths from the base circles, f²/2r and q²/2r′ with the radii of curvature
//! f and q and the base radii r and r′, add up to what they do at the nominal point s. Places in equal steps along one are therefore in
//! equal steps along the other. The angle between the flanks is (f − s)/r + (T − s − q)/r′, and the separation S its integral along them:
//! both to the second order in that angle. Must not know: how places are followed.

use super::super::outline::Outline;
use super::depths::{Depths, LANES, along};
use super::hull::Hull;
use super::line::{Line, Pair};
use super::near::Here;
use super::steps::reach;

/// What makes numbers of places positive, whose fractions are wanted: the most places of all.
const POSITIVE: usize = 1 << 20;

/// The places of a block with their neighbours.
const PLACES: [f32; LANES] = {
    let (mut places, mut at) = ([0.0; LANES], 1);
    while at < LANES {
        places[at] = places[at - 1] + 1.0;
        at += 1;
    }
    places
};

/// Both flanks on a stretch of the path.
#[derive(Clone, Debug)]
pub(super) struct Flanks {
    /// Of the pinion from its root, and of the gear from its tip.
    pub(super) depths: [Depths; 2],
    /// The distance of places \[m\].
    pub(super) step: f64,
}

impl Flanks {
    /// Between these lengths along each flank, which are over their own roll lengths.
    pub(super) fn new(outlines: [&Outline; 2], base_radii: [f64; 2], lengths: [[f64; 2]; 2], step: f64) -> Self {
        let steps = [step, -step];
        Self { depths: [0, 1].map(|at| Depths::new(outlines[at], base_radii[at], lengths[at], steps[at])), step }
    }
}

impl Pair {
    /// Tables about roll lengths at which both flanks are nearest to each other, as far as anything there may be lower.
    pub(super) fn beside(
        &self,
        (outlines, hulls): ([&Outline; 2], &[Hull; 2]),
        met: [[f64; 2]; 2],
        here: &Here,
        step: f64,
    ) -> Flanks {
        let [pinion, gear] = hulls;
        // Farther along both they stand apart by as much more as if they touched here, or by more than that.
        let lower = here.rates[0] - here.apart - f64::from(pinion.least()) - f64::from(gear.least());
        let [down, up] = reach(self.base_radii, met[0], lower.max(0.0));
        let lengths = [0, 1].map(|at| {
            let [one, other] = met.map(|roll_lengths| along(roll_lengths[at], self.base_radii[at]));
            let farther = if at == 0 { [down, up] } else { [up, down] };
            let [least, most] = self.ranges[at];
            [(one.min(other) - farther[0]).clamp(least, most), (one.max(other) + farther[1]).clamp(least, most)]
        });
        Flanks::new(outlines, self.base_radii, lengths, step)
    }
}

/// Places at one path position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scan<'a> {
    pub(super) line: Line<'a>,
    flanks: &'a Flanks,
    hulls: &'a [Hull; 2],
    /// By how many places that of the gear is ahead of the pinion's, and by which share of a step more.
    ahead: isize,
    share: f32,
    /// For the separation at places: of each flank how the square of the roll length grows in a step, the nominal roll length, and what counts
    /// for the square and the third power of the distance from it; and what it is more.
    turns: [[f32; 4]; 2],
    more: f32,
    /// The separation for which places are beside each other, and by how many steps roll lengths grow for what it is more.
    aligned: f32,
    growths: [f32; 2],
    /// The number of the nominal point, and between which ones both flanks have points.
    pub(super) nominal: f64,
    pub(super) numbers: [f64; 2],
}

/// A line that depths of both flanks together are nowhere lower than.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tangent {
    /// A place and its value, and by how much it rises from place to place.
    number: isize,
    value: f32,
    rise: f32,
}

impl Tangent {
    /// What the gap is no less than before the first place of a block or behind its last one, where flanks stand apart so far in the block and beside it.
    #[inline]
    pub(super) fn least_before(&self, first: isize, apart: &[f32; LANES]) -> f32 {
        self.least_from(first, [apart[1], apart[2]], -self.rise)
    }

    #[inline]
    pub(super) fn least_behind(&self, last: isize, apart: &[f32; LANES]) -> f32 {
        self.least_from(last, [apart[LANES - 2], apart[LANES - 3]], self.rise)
    }

    /// From a place on, where they stand apart by these at it and at the one before, and the line rises so; without bound where it may be any less: all of it
    /// is convex.
    #[inline]
    #[allow(clippy::cast_precision_loss)] // numbers of places
    fn least_from(&self, number: isize, [apart, before]: [f32; 2], rise: f32) -> f32 {
        let line = self.value + self.rise * (number - self.number) as f32;
        if apart - before + rise < 0.0 { f32::NEG_INFINITY } else { apart + line }
    }
}

impl<'a> Scan<'a> {
    #[inline]
    pub(super) fn new(line: Line<'a>, flanks: &'a Flanks, hulls: &'a [Hull; 2]) -> Self {
        let Flanks { depths: [pinion, gear], step } = flanks;
        let ahead = (pinion.first + gear.first - line.beside) / step + POSITIVE as f64;
        let whole = positive(ahead);
        let (base_radii, turns) = (line.pair.base_radii, line.turns());
        let mut scan = Self {
            line,
            flanks,
            hulls,
            ahead: whole.cast_signed() - POSITIVE.cast_signed(),
            share: single(ahead - whole as f64),
            turns: [0, 1].map(|at| {
                let growth = if at == 0 { 2.0 } else { -2.0 } * base_radii[at] * step;
                [growth, line.nominal[at], turns[at][0], turns[at][1]].map(single)
            }),
            more: single(line.more),
            aligned: single(line.aligned),
            growths: [0, 1].map(|at| single(line.nominal[at] / (base_radii[at] * step))),
            nominal: 0.0,
            numbers: [0.0; 2],
        };
        scan.nominal = scan.number(line.nominal());
        scan.numbers = line.range.map(|place| scan.number(place));
        scan
    }

    /// The first and the last place that both flanks have depths of, and a block with one more on either side.
    #[inline]
    pub(super) fn known(&self) -> [isize; 2] {
        let [pinion, gear] =
            self.flanks.depths.each_ref().map(|depths| depths.count().cast_signed() - LANES.cast_signed());
        [1.max(1 - self.ahead), (pinion - 1).min(gear - 1 - self.ahead)]
    }

    /// How far the flanks stand apart at places from this one on.
    #[inline(always)]
    #[allow(clippy::inline_always)] // as in `Look`
    fn separations(&self, first: isize) -> [f32; LANES] {
        let [pinion, gear] = self.line.pair.base_radii;
        let place = self.at(first as f64);
        // In single precision, in which roll lengths are known to a nanometre, and separations to a picometre.
        let squares = [2.0 * pinion * place, 2.0 * gear * (self.line.sum - place)].map(single);
        let mut apart = [0.0; LANES];
        for (apart, steps) in apart.iter_mut().zip(PLACES) {
            *apart = part(squares[0], self.turns[0], steps) + part(squares[1], self.turns[1], steps) + self.more;
        }
        apart
    }

    /// The gap at places from this one on, and how far the flanks stand apart there; without bound where both flanks have none.
    #[inline(always)]
    #[allow(clippy::inline_always)] // as in `Look`
    pub(super) fn values(&self, first: isize) -> [[f32; LANES]; 2] {
        let [pinion, gear] = &self.flanks.depths;
        let number = first.cast_unsigned();
        let ahead = number.wrapping_add_signed(self.ahead);
        let (pinion, bends, gear) = (pinion.from(number), gear.bends_from(ahead), gear.from(ahead));
        let apart = self.separations(first);
        // The roll length that grows is longer by the separation.
        let ([up, down], nominal) = (self.growths, single(self.nominal - first as f64));
        let share = self.share;
        // A quarter of the second differences at both is what a cubic about falls by between two places.
        let fall = share * (share - 1.0);
        let mut values = [0.0; LANES];
        for at in 0..LANES {
            let rises = gear[at + 1] - gear[at];
            let rise = if PLACES[at] > nominal { up * (pinion[at + 1] - pinion[at]) } else { -down * rises };
            let longer = (apart[at] - self.aligned) * rise;
            let between = gear[at] + share * rises + fall * (bends[at] + bends[at + 1]);
            values[at] = apart[at] + pinion[at] + between + longer;
        }
        let [low, high] = self.numbers;
        if low > first as f64 || high < (first + LANES.cast_signed()) as f64 {
            for (value, number) in values.iter_mut().zip(first..) {
                if (number as f64) < low || number as f64 > high {
                    *value = f32::INFINITY;
                }
            }
        }
        [values, apart]
    }

    /// The tangent of both hulls at a place, which nothing is lower than anywhere.
    #[inline]
    pub(super) fn tangent(&self, number: isize) -> Tangent {
        let ([pinion, gear], step) = (&self.flanks.depths, self.flanks.step);
        let [own, other] = self.hulls;
        let [own, grows] = own.at(pinion.first + step * number as f64);
        let [other, falls] = other.at(gear.first - step * ((number + self.ahead) as f64 + f64::from(self.share)));
        Tangent { number, value: own + other, rise: single(step) * (grows - falls) }
    }

    /// The length along the pinion's flank at a number of a place.
    #[inline]
    pub(super) fn at(&self, number: f64) -> f64 {
        self.flanks.depths[0].first + self.flanks.step * number - self.line.shift
    }

    #[inline]
    fn number(&self, place: f64) -> f64 {
        (place + self.line.shift - self.flanks.depths[0].first) / self.flanks.step
    }
}

/// What one flank turns by, from the square of the roll length at a place and as in [`Scan`].
#[inline(always)]
#[allow(clippy::inline_always)] // as in `Look`
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
