//! What a flank has lost at places in equal steps along it.
//!
//! Depths are of single precision: of 100 µm that is 4 pm. Must not know: the other flank.

use super::super::outline::Outline;

/// Places that are looked at together, with one more on either side.
pub(super) const LANES: usize = 16;
pub(super) const BLOCK: usize = LANES - 2;
/// Blocks of which it is known together what the gap there is no less than.
pub(super) const GROUP: usize = 8;
/// Places before a flank and behind it, where depths are those at its ends: blocks of one flank lie askew to those of the other.
const BESIDE: usize = 3 * BLOCK;

/// Depths over the length along the flank from its base circle, in blocks of places.
#[derive(Clone, Debug)]
pub(super) struct Depths {
    /// The flank's own ends.
    pub(super) range: [f64; 2],
    /// Where its first place is \[m\].
    pub(super) first: f64,
    places: Vec<f32>,
    /// A quarter of the second difference at each place.
    bends: Vec<f32>,
    /// Of each block, up to the first place of the next one, the least depth, between its places too, and what the lower hull of these is there;
    /// without bound in some beside the flank.
    least: Vec<f32>,
    hull: Vec<f32>,
}

impl Depths {
    /// In steps of this length, towards the tip where it is above 0 and else from there; `flank` is over its own roll length.
    pub(super) fn new(flank: &Outline, base_radius: f64, step: f64) -> Self {
        let range = flank.range().map(|roll_length| along(roll_length, base_radius));
        let length = step.abs();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // not below 1
        let count = ((range[1] - range[0]) / length).ceil() as usize;
        let blocks = (count + 2 * BESIDE).div_ceil(BLOCK);
        let lowest = range[0] - length * BESIDE as f64;
        let count = blocks * BLOCK + 1;
        let mut places = flank.depths(base_radius, [lowest, length], count);
        let first = if step > 0.0 { lowest } else { lowest + length * (count - 1) as f64 };
        if step < 0.0 {
            places.reverse();
        }
        let mut bends = vec![0.0; places.len()];
        for (bend, places) in bends[1..].iter_mut().zip(places.windows(3)) {
            *bend = 0.25 * (places[0] - 2.0 * places[1] + places[2]);
        }
        let least = |block: usize| {
            let of_block = block * BLOCK..=block * BLOCK + BLOCK;
            // The parabola through a place and its neighbours is lowest by no more than an eighth of what it bends by below that place, if
            // this is lower than they are; twice that is for cubics.
            let lowest = places[of_block.clone()].iter().zip(&bends[of_block]).map(|(place, bend)| place - bend);
            lowest.fold(f32::INFINITY, |least, depth| if depth < least { depth } else { least })
        };
        let inside = GROUP..GROUP + blocks;
        let mut depths = vec![f32::INFINITY; blocks + 2 * GROUP];
        for (depth, block) in depths[inside.clone()].iter_mut().zip(0..) {
            *depth = least(block);
        }
        let mut hull = depths.clone();
        lower_hull(&mut hull[inside]);
        Self { range, first, places, bends, least: depths, hull }
    }

    /// The depths from one place on.
    #[inline]
    pub(super) fn from(&self, number: usize) -> &[f32; LANES + 1] {
        self.places[number..].first_chunk().expect("there are places on either side")
    }

    /// A quarter of their second differences.
    #[inline]
    pub(super) fn bends_from(&self, number: usize) -> &[f32; LANES + 1] {
        self.bends[number..].first_chunk().expect("there are places on either side")
    }

    /// The least depths of a group of blocks, from this one on, and of one more.
    #[inline]
    pub(super) fn least(&self, from: isize) -> &[f32; GROUP + 1] {
        group(&self.least, from)
    }

    /// Their lower hull.
    #[inline]
    pub(super) fn hull(&self, from: isize) -> &[f32; GROUP + 1] {
        group(&self.hull, from)
    }
}

#[inline]
fn group(of_blocks: &[f32], from: isize) -> &[f32; GROUP + 1] {
    of_blocks[(from + GROUP.cast_signed()).cast_unsigned()..].first_chunk().expect("there are blocks on either side")
}

/// How long an involute is from its base circle to where its roll length is this one.
pub(super) fn along(roll_length: f64, base_radius: f64) -> f64 {
    0.5 * roll_length * roll_length / base_radius
}

/// Makes values their lower convex hull.
#[allow(clippy::cast_possible_truncation)] // so many are the most
fn lower_hull(values: &mut [f32]) {
    let mut hull: Vec<u16> = Vec::with_capacity(values.len());
    for next in 0..values.len() as u16 {
        let value = |at: u16| values[usize::from(at)];
        while let [.., one, other] = hull[..] {
            // Below the line from `one` to `next`.
            let (to_other, to_next) = (value(other) - value(one), value(next) - value(one));
            if to_other * f32::from(next - one) <= to_next * f32::from(other - one) {
                break;
            }
            hull.pop();
        }
        hull.push(next);
    }
    for ends in hull.windows(2) {
        let [from, to] = [ends[0], ends[1]].map(usize::from);
        let slope = (values[to] - values[from]) / f32::from(ends[1] - ends[0]);
        for at in from + 1..to {
            values[at] = values[at - 1] + slope;
        }
    }
}
