//! A stretch of the face on which the deviation is a polynomial of the second degree that rises from one end to the other.
//!
//! Lengths in m. Must not know: stiffness, the stretches beside it.

/// A stretch on which h rises from its lower end: h = base + slope ζ + bend ζ².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    pub(super) base: f64,
    pub(super) slope: f64,
    pub(super) bend: f64,
    pub(super) length: f64,
    /// 1/`bend`.
    pub(super) per_bend: f64,
    /// h at the upper end less `base`.
    pub(super) rise: f64,
    /// z of the lower end.
    pub(super) low: f64,
    /// How many such stretches there are, over the face width.
    pub(super) weight: f64,
}

impl Piece {
    /// One that does not rise.
    pub(super) const FLAT: Self =
        Self { base: 0.0, slope: 0.0, bend: 0.0, per_bend: 0.0, length: 1.0, rise: 0.0, low: 0.0, weight: 1.0 };

    /// `polynomial` in z from `from` to `to`, between which it is monotonic, seen from its lower end.
    pub(super) fn new(polynomial: [f64; 3], from: f64, to: f64, width: f64) -> Self {
        let [constant, slope, bend] = polynomial;
        let height = |z: f64| constant + z * (slope + z * bend);
        let low = if height(from) <= height(to) { from } else { to };
        let steepness = (slope + 2.0 * bend * low).abs();
        let length = to - from;
        // Against rounding where the lower end is the vertex.
        let slope = if steepness * length <= 1e-14 * (bend * length * length).abs() { 0.0 } else { steepness };
        let rise = (length * (slope + length * bend)).max(0.0);
        Self { base: height(low), slope, bend, per_bend: 1.0 / bend, length, rise, low, weight: 1.0 / width }
    }

    pub(super) fn mean(&self) -> f64 {
        let Self { base, slope, bend, length, weight, .. } = *self;
        weight * length * (base + length * (0.5 * slope + length * bend / 3.0))
    }

    /// How far h stays below base + `depth`, for `depth` > 0.
    #[inline]
    pub(super) fn reach(&self, depth: f64) -> f64 {
        let reach = if self.slope == 0.0 {
            (depth * self.per_bend).sqrt()
        } else {
            // The root of slope ζ + bend ζ² = depth in the form that does not cancel.
            2.0 * depth / (self.slope + (self.slope * self.slope + 4.0 * self.bend * depth).max(0.0).sqrt())
        };
        if depth >= self.rise { self.length } else { reach.min(self.length) }
    }

    /// How fast it grows with the depth.
    pub(super) fn widening(&self, depth: f64, reach: f64) -> f64 {
        if depth >= self.rise { 0.0 } else { 1.0 / (self.slope + 2.0 * self.bend * reach) }
    }

    /// What [`Face::passed`] has of it.
    #[must_use]
    #[inline]
    pub fn passed(&self, penetration: f64) -> (f64, f64) {
        // Without a branch: it is computed for several penetrations at a time.
        let depth = penetration - self.base;
        let reach = self.reach(depth);
        let width = self.weight * reach;
        let passed = width * (depth - reach * (0.5 * self.slope + reach * (self.bend / 3.0)));
        if depth > 0.0 { (passed, width) } else { (0.0, 0.0) }
    }
}
