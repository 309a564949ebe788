//! What a flank has lost at equidistant places along it.
//!
//! Must not know: the other flank.

use super::super::outline::Outline;
use super::scan::BLOCK;

/// Half as much again as 2⁵²: what is added to it is rounded to a whole number, which is in its last bits.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// Depths over roll lengths.
#[derive(Clone, Debug)]
pub(super) struct Depths {
    pub(super) first: f64,
    pub(super) last: f64,
    pub(super) step: f64,
    per_step: f64,
    /// The depth at each place, and by how much it grows up to the next one.
    places: Vec<[f64; 2]>,
    /// The least depth at the places of each block and at the first one of the next.
    blocks: Vec<f64>,
    pub(super) least: f64,
}

impl Depths {
    /// In so many steps, from one end of a flank to the other.
    pub(super) fn new(flank: &Outline, steps: f64) -> Self {
        let [first, last] = flank.range();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // not below 1
        let count = steps.ceil() as usize;
        let depths = flank.depths(count);
        let rise = |at: usize| depths.get(at + 1).map_or(0.0, |next| next - depths[at]);
        let places = (0..=count).map(|at| [depths[at], rise(at)]).collect();
        let least = |depths: &[f64]| depths.iter().copied().fold(f64::INFINITY, f64::min);
        let ends = |block: usize| block * BLOCK..(block * BLOCK + BLOCK + 1).min(count + 1);
        let blocks: Vec<f64> = (0..=count / BLOCK).map(|block| least(&depths[ends(block)])).collect();
        let step = (last - first) / count as f64;
        Self { first, last, step, per_step: 1.0 / step, places, least: least(&blocks), blocks }
    }

    /// The number of a place, with its share of the way to the next one.
    #[inline]
    pub(super) fn number(&self, place: f64) -> f64 {
        (place - self.first) * self.per_step
    }

    #[inline]
    pub(super) fn place(&self, number: usize) -> f64 {
        self.first + self.step * number as f64
    }

    #[inline]
    pub(super) fn at(&self, number: usize) -> f64 {
        self.places[number][0]
    }

    /// On the line between two places, of a number that is not negative.
    #[inline]
    pub(super) fn between(&self, number: f64) -> f64 {
        let whole = number - 0.5 + WHOLE;
        // The last bits are those of the whole number below.
        #[allow(clippy::cast_possible_truncation)]
        let at = (whole.to_bits() as u32 as usize).min(self.places.len() - 1);
        let [depth, rise] = self.places[at];
        depth + rise * (number - (whole - WHOLE))
    }

    /// The least depth at the places of a block, up to the next one.
    pub(super) fn least_of(&self, block: usize) -> f64 {
        self.blocks.get(block).copied().unwrap_or(f64::INFINITY)
    }

    /// The least depth at the places of all blocks between two places.
    pub(super) fn least_between(&self, ends: [f64; 2]) -> f64 {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // of what is below, the first one
        let blocks = ends.map(|end| (self.number(end).max(0.0) as usize / BLOCK).min(self.blocks.len() - 1));
        self.blocks[blocks[0]..=blocks[1]].iter().copied().fold(f64::INFINITY, f64::min)
    }
}
