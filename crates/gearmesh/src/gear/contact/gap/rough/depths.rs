//! What a flank has lost at equidistant places along it.
//!
//! Must not know: the other flank.

use super::super::outline::Outline;

/// Places that are looked at together.
pub(super) const BLOCK: usize = 8;
/// Half as much again as 2⁵²: what is added to it is rounded to a whole number, which is in its last bits.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// Depths over roll lengths, in blocks of places, of which one lies before the flank and two behind it.
#[derive(Clone, Debug)]
pub(super) struct Depths {
    /// The flank's own ends.
    pub(super) range: [f64; 2],
    first: f64,
    step: f64,
    per_step: f64,
    /// The depth at each place, and by how much it grows up to the next one.
    places: Vec<[f64; 2]>,
    /// Of each block the least depth, up to the first place of the next one, and what the lower hull of those is there.
    blocks: Vec<[f64; 2]>,
}

impl Depths {
    /// In steps of this length.
    pub(super) fn new(flank: &Outline, step: f64) -> Self {
        let range = flank.range();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // not below 1
        let count = ((range[1] - range[0]) / step).ceil() as usize;
        let blocks = count / BLOCK + 4;
        let first = range[0] - step * BLOCK as f64;
        let depths = flank.depths([first, step], blocks * BLOCK + 1);
        let mut places = Vec::with_capacity(depths.len());
        for ends in depths.windows(2) {
            places.push([ends[0], ends[1] - ends[0]]);
        }
        let least = |block: usize| {
            let of_block = &depths[block * BLOCK..=block * BLOCK + BLOCK];
            of_block.iter().fold(f64::INFINITY, |least, depth| if *depth < least { *depth } else { least })
        };
        let mut blocks: Vec<[f64; 2]> = (0..blocks).map(|block| [least(block); 2]).collect();
        lower_hull(&mut blocks);
        Self { range, first, step, per_step: 1.0 / step, places, blocks }
    }

    /// The number of a place, with its share of the way to the next one.
    #[inline]
    pub(super) fn number(&self, place: f64) -> f64 {
        (place - self.first) * self.per_step
    }

    #[inline]
    pub(super) fn place(&self, number: f64) -> f64 {
        self.first + self.step * number
    }

    /// The depths from one place on, and by how much each grows.
    #[inline]
    pub(super) fn from(&self, number: usize) -> &[[f64; 2]] {
        &self.places[number..]
    }

    /// The depth on the line between two places.
    #[inline]
    pub(super) fn between(&self, number: f64) -> f64 {
        let whole = number + (WHOLE - 0.5);
        let at = low_bits(whole);
        if at >= self.places.len() {
            return f64::INFINITY;
        }
        let [depth, rise] = self.places[at];
        depth + rise * (number - (whole - WHOLE))
    }

    /// The least depth of a block, and what the hull of all such is there; without bound where there is none.
    #[inline]
    pub(super) fn least_of(&self, block: usize) -> [f64; 2] {
        if block < self.blocks.len() { self.blocks[block] } else { [f64::INFINITY; 2] }
    }
}

/// The block of the number of a place.
#[inline]
pub(super) fn block(number: f64) -> usize {
    low_bits((if number > 0.5 { number } else { 0.5 }) + (WHOLE - 0.5)) / BLOCK
}

/// The whole number that is in the last bits.
#[inline]
#[allow(clippy::cast_possible_truncation)] // they are 32
fn low_bits(whole: f64) -> usize {
    whole.to_bits() as u32 as usize
}

/// Puts the lower convex hull of the first value of each into the second one.
fn lower_hull(values: &mut [[f64; 2]]) {
    let mut hull: Vec<usize> = Vec::with_capacity(values.len());
    for next in 0..values.len() {
        while let [.., one, other] = hull[..] {
            let rise = |from: usize, to: usize| values[to][0] - values[from][0];
            // Below the line from `one` to `next`.
            if rise(one, other) * (next - one) as f64 <= rise(one, next) * (other - one) as f64 {
                break;
            }
            hull.pop();
        }
        hull.push(next);
    }
    for ends in hull.windows(2) {
        let [from, to] = [ends[0], ends[1]];
        let slope = (values[to][0] - values[from][0]) / (to - from) as f64;
        for at in from + 1..to {
            values[at][1] = values[from][0] + slope * (at - from) as f64;
        }
    }
}
