//! A convex function that the depths of a flank are nowhere less than.
//!
//! The separation is convex along the flanks too: where both hulls and it together grow, they go on growing. Must not know: places.

use super::super::outline::Outline;

/// Parts of a flank.
const PARTS: usize = 64;
/// How much lower than the depths it may be for being found sooner \[m\].
const NEGLIGIBLE: f64 = 2e-8;

/// Straight on equal parts of the flank.
#[derive(Clone, Debug)]
pub(super) struct Hull {
    /// Where the first part begins, and how many there are in a length.
    first: f64,
    per_length: f64,
    /// Where each part begins and the last one ends, and by how much it grows up to the next.
    values: [[f32; 2]; PARTS + 1],
}

impl Hull {
    /// Of a flank with this base radius, over its own roll length, between these lengths.
    #[allow(clippy::cast_possible_truncation)] // of single precision
    pub(super) fn new(flank: &Outline, base_radius: f64, [from, to]: [f64; 2]) -> Self {
        let per_length = PARTS as f64 / (to - from);
        let (begin, per_square) = (from * per_length, 0.5 * per_length / base_radius);
        let mut values = [[f32::INFINITY, 0.0]; PARTS + 1];
        // A straight line is no higher than the higher one of its ends.
        let mut lower = |[first, last]: [usize; 2], least: f64| {
            for value in &mut values[first..last + 2] {
                value[0] = value[0].min(least as f32);
            }
        };
        let (mut first, mut lowest, mut up_to) = (0, f64::INFINITY, 0.0);
        flank.visit_least(NEGLIGIBLE, |end, least| {
            lowest = if least < lowest { least } else { lowest };
            if end < up_to {
                return;
            }
            let last = part(per_square * end * end - begin);
            lower([first, last], lowest);
            (first, lowest) = (last, least);
            up_to = ((begin + last as f64 + 1.0) / per_square).sqrt();
        });
        lower([first, PARTS - 1], lowest);
        lower_hull(&mut values);
        Self { first: from, per_length, values }
    }

    /// The least value of all.
    pub(super) fn least(&self) -> f32 {
        self.values.iter().map(|value| value[0]).fold(f32::INFINITY, f32::min)
    }

    /// The value at a length along the flank, and its slope.
    #[inline]
    pub(super) fn at(&self, place: f64) -> [f32; 2] {
        let number = (place - self.first) * self.per_length;
        let part = part(number);
        let [value, rise] = self.values[part];
        #[allow(clippy::cast_possible_truncation)] // shares, and parts of a flank
        let (share, per_length) = ((number - part as f64) as f32, self.per_length as f32);
        [value + rise * share, rise * per_length]
    }
}

/// The part that a number of parts from the first one ends in.
#[inline]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // what is below 0 is 0
fn part(number: f64) -> usize {
    (number as u32 as usize).min(PARTS - 1)
}

/// Makes the first of each pair their lower convex hull, and the second one what it grows by up to the next.
fn lower_hull(values: &mut [[f32; 2]; PARTS + 1]) {
    let mut hull = [0; PARTS + 1];
    let mut count = 0;
    for next in 0..=PARTS {
        while count > 1 {
            let [one, other] = [hull[count - 2], hull[count - 1]];
            let rise = |from: usize, to: usize| values[to][0] - values[from][0];
            // Below the line from `one` to `next`.
            if rise(one, other) * (next - one) as f32 <= rise(one, next) * (other - one) as f32 {
                break;
            }
            count -= 1;
        }
        hull[count] = next;
        count += 1;
    }
    for ends in hull[..count].windows(2) {
        let [from, to] = [ends[0], ends[1]];
        let (begin, slope) = (values[from][0], (values[to][0] - values[from][0]) / (to - from) as f32);
        for (value, parts) in values[from..to].iter_mut().zip(0_u8..) {
            *value = [begin + slope * f32::from(parts), slope];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: invariant; it bends back nowhere, and is below a function of which it was told the least values.
    #[test]
    fn it_is_convex_and_below() {
        let mut values = [[0.0; 2]; PARTS + 1];
        let function = |at: usize| libm::sinf(0.7 * at as f32) + 1e-3 * (at as f32 - 40.0) * (at as f32 - 40.0);
        for (at, value) in values.iter_mut().enumerate() {
            value[0] = function(at);
        }
        lower_hull(&mut values);
        let hull = Hull { first: 2.0, per_length: 10.0, values };
        let mut before = f32::NEG_INFINITY;
        for at in 0..PARTS {
            let [value, slope] = hull.at(2.0 + 0.1 * (at as f64 + 0.5));
            assert!(value <= 0.5 * (function(at) + function(at + 1)) + 1e-6, "{at}");
            assert!(slope >= before - 1e-5, "{at}");
            before = slope;
        }
        assert!((hull.at(2.0)[0] - function(0)).abs() < 1e-6);
    }
}
