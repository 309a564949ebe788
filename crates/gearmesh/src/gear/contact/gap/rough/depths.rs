//! What a flank has lost at places in equal steps along it.
//!
//! Depths are of single precision: of 100 µm that is 4 pm. Must not know: the other flank.

use super::super::outline::Outline;

/// Places that are looked at together, with one more on either side.
pub(super) const LANES: usize = 16;
pub(super) const BLOCK: usize = LANES - 2;
/// Places of which it is known together how deep they are.
pub(super) const TOGETHER: usize = 8;
/// What waves fall by between their places, over that of a parabola, with its eighth.
const STEEPER: f32 = 1.6 / 8.0;
/// Places more on either side: those of one flank lie beside those of the other.
const BESIDE: usize = LANES + 4;

/// Depths over the length along the flank from its base circle.
#[derive(Clone, Debug)]
pub(super) struct Depths {
    /// Where its first place is \[m\].
    pub(super) first: f64,
    /// The distance of places, below 0 where they are counted towards the root \[m\].
    pub(super) step: f64,
    places: Vec<f32>,
    /// A quarter of the second difference at each place.
    bends: Vec<f32>,
    /// By how much it is lower between a place that is lower than both beside it and those.
    dips: Vec<f32>,
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
        let (mut bends, mut dips) = (vec![0.0; count], vec![0.0; count]);
        let (before, behind) = (&places[..count - 2], &places[2..]);
        let both = bends[1..count - 1].iter_mut().zip(&mut dips[1..count - 1]);
        for (((bend, dip), here), (before, behind)) in both.zip(&places[1..]).zip(before.iter().zip(behind)) {
            let (fall, rise) = (before - here, behind - here);
            *bend = 0.25 * (fall + rise);
            // The parabola through the three is lower by an eighth of the square of what they rise by over what they bend by.
            let deep = STEEPER * (rise - fall) * (rise - fall) / (fall + rise);
            let least = if fall < rise { fall } else { rise };
            *dip = if least > 0.0 { deep } else { 0.0 };
        }
        Self { first, step, places, bends, dips }
    }

    /// What depths are no less than, of so many places after so many with those between them and the next ones.
    pub(super) fn least(&self) -> impl Iterator<Item = f32> {
        let groups = self.places.chunks_exact(TOGETHER).zip(self.dips.chunks_exact(TOGETHER));
        groups.map(|(places, dips)| {
            let mut least = [f32::INFINITY; 4];
            for at in 0..TOGETHER {
                let depth = places[at] - dips[at];
                least[at % 4] = if depth < least[at % 4] { depth } else { least[at % 4] };
            }
            least.into_iter().fold(f32::INFINITY, |one, other| if one < other { one } else { other })
        })
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
