//! What a flank has lost at places in equal steps along it.
//!
//! Depths are of single precision: of 100 µm that is 4 pm. Must not know: the other flank.

use super::super::outline::Outline;

/// Places that are looked at together, with one more on either side.
pub(super) const LANES: usize = 32;
pub(super) const BLOCK: usize = LANES - 2;
/// Places more on either side: those of one flank lie beside those of the other.
const BESIDE: usize = LANES + 4;

/// Depths over the length along the flank from its base circle.
#[derive(Clone, Debug)]
pub(super) struct Depths {
    /// Where its first place is \[m\].
    pub(super) first: f64,
    places: Vec<f32>,
    /// A quarter of the second difference at each place.
    bends: Vec<f32>,
}

impl Depths {
    /// Between two lengths in steps of this one, towards the tip where it is above 0 and else from there; beyond the ends of the flank what it has lost
    /// there. `flank` is over its own roll length.
    pub(super) fn new(flank: &Outline, base_radius: f64, [from, to]: [f64; 2], step: f64) -> Self {
        let length = step.abs();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // not below 1
        let count = ((to - from) / length).ceil() as usize + 2 * BESIDE;
        let lowest = from - length * BESIDE as f64;
        let mut places = flank.depths(base_radius, [lowest, length], count);
        let first = if step > 0.0 { lowest } else { lowest + length * (count - 1) as f64 };
        if step < 0.0 {
            places.reverse();
        }
        let mut bends = vec![0.0; count];
        let (before, behind) = (&places[..count - 2], &places[2..]);
        for ((bend, here), (before, behind)) in bends[1..].iter_mut().zip(&places[1..]).zip(before.iter().zip(behind)) {
            *bend = 0.25 * ((before - here) + (behind - here));
        }
        Self { first, places, bends }
    }

    pub(super) fn count(&self) -> usize {
        self.places.len()
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
}

/// How long an involute is from its base circle to where its roll length is this one.
pub(super) fn along(roll_length: f64, base_radius: f64) -> f64 {
    0.5 * roll_length * roll_length / base_radius
}
