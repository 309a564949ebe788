//! Many values of a spline in a row.
//!
//! Roots and cubics of the places in one interval are found side by side, in registers as wide as the processor has, by which no bit
//! differs. Must not know: what the places are.

use super::Spline;
use pulp::{Arch, Simd, WithSimd};

/// Places side by side.
const LANES: usize = 4;
const PLACES: [f64; LANES] = [0.0, 1.0, 2.0, 3.0];

/// Places whose squares grow in equal steps, and what is known where they are.
struct Row<'a> {
    spline: &'a Spline,
    /// The first interval that has any.
    from: usize,
    first: f64,
    step: f64,
    /// With room for whole groups behind the last one.
    values: &'a mut [f32],
    count: usize,
}

impl Spline {
    /// The values at so many places above 0 whose squares grow in equal steps, from that of `first` on, of single precision; outside of its
    /// ends those at the ends.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // of single precision
    pub fn at_roots(&self, [first, step]: [f64; 2], count: usize) -> Vec<f32> {
        let [low, high] = self.between;
        let place = |at: usize| (first + step * at as f64).max(0.0).sqrt().clamp(low, high);
        let interval = |place: f64| self.index.interval(self.pieces.len(), place, |at| self.pieces[at][0]);
        let from = interval(place(0));
        if interval(place(count)) - from > 2 * count {
            return (0..count).map(|at| self.value(place(at)) as f32).collect();
        }
        let mut values = vec![0.0; count + LANES];
        Arch::new().dispatch(Row { spline: self, from, first, step, values: &mut values, count });
        values.truncate(count);
        values
    }
}

impl WithSimd for Row<'_> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::inline_always)] // what is not inlined has registers of its own
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // of single precision; not below 0
    fn with_simd<S: Simd>(self, _registers: S) {
        let Self { spline, from, first, step, values, count } = self;
        let ([low, high], per_step) = (spline.between, 1.0 / step);
        // The first place that is farther than this, or as far.
        let reaches = |place: f64| (((place * place - first) * per_step + 1.0) as u32 as usize).min(count);
        let mut at = reaches(low);
        values[..at].fill(spline.value(low) as f32);
        for (piece, end) in spline.pieces[from..].iter().zip(&spline.knots[from + 1..]) {
            let [begin, c0, c1, c2, c3] = *piece;
            let next = reaches(if *end < high { *end } else { high }).max(at);
            let mut group = at;
            while group < next {
                let (square, mut found) = (first + step * group as f64, [0.0_f32; LANES]);
                for lane in 0..LANES {
                    // Of what is behind the interval nothing stays.
                    let t = (square + step * PLACES[lane]).sqrt() - begin;
                    found[lane] = (c0 + t * (c1 + t * (c2 + t * c3))) as f32;
                }
                values[group..][..LANES].copy_from_slice(&found);
                group += LANES;
            }
            at = next;
            if at == count {
                break;
            }
        }
        values[at..].fill(spline.value(high) as f32);
    }
}
