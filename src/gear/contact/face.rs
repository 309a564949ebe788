//! The deviation across the face and how much of an interference it lets through.
//!
//! A tooth pair is a row of independent slices: under the interference w its load is its stiffness times
//! Φ(w) = 1/b ∫ max(0, w − h(z)) dz, where h is the deviation of both flanks above its smallest value. Where h is
//! piecewise quadratic Φ has a closed form (for crowning alone w t − C_β t³/3 with t = min(1, √(w/C_β))); other shapes
//! are cut into slices. Lengths in m. Must not know: stiffness, profile.

use crate::gear::modification::Design;
use crate::numeric::lobatto::Rule;

/// The deviation over the common face width of a pair.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// The smallest deviation: what both flanks lose all along the face.
    pub offset: f64,
    /// The mean deviation above the smallest.
    pub mean: f64,
    shape: Shape,
}

#[derive(Clone, Debug, PartialEq)]
enum Shape {
    Flat,
    Quadratic(Vec<Piece>),
    /// Share of the width and deviation of each slice.
    Sliced(Vec<(f64, f64)>),
}

/// A stretch on which h rises from its lower end: h = base + slope ζ + bend ζ².
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    base: f64,
    slope: f64,
    bend: f64,
    length: f64,
    /// h at the upper end less `base`.
    rise: f64,
    /// How many such stretches there are, over the face width.
    weight: f64,
}

impl Face {
    /// The common face of width `width`, centred, of gears with this design. `slices` is the number of slices on each
    /// stretch on which the deviation is smooth, where there is no closed form, or where `closed_form` is not wanted
    /// because the load is no linear function of the interference.
    #[must_use]
    pub fn new(design: &Design, width: f64, slices: usize, closed_form: bool) -> Self {
        let parts = || design.pinion.iter().chain(&design.gear).map(|part| &part.modification);
        if !parts().any(|part| part.varies_along_face()) {
            return Self { offset: 0.0, mean: 0.0, shape: Shape::Flat };
        }
        let mut cuts = vec![-0.5 * width, 0.5 * width];
        for z in parts().flat_map(|part| part.lead_breaks()).flatten() {
            if z.abs() < 0.5 * width {
                cuts.push(z);
            }
        }
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        let quadratic = |z: f64| {
            parts()
                .map(|part| part.lead_quadratic(z))
                .try_fold([0.0; 3], |sum, part| part.map(|part| [sum[0] + part[0], sum[1] + part[1], sum[2] + part[2]]))
        };
        let stretches = || cuts.windows(2).map(|cut| (cut[0], cut[1]));
        if closed_form {
            let polynomials: Option<Vec<_>> = stretches().map(|(from, to)| quadratic(0.5 * (from + to))).collect();
            if let Some(polynomials) = polynomials {
                return Self::quadratic(stretches().zip(polynomials), width);
            }
        }
        Self::sliced(stretches(), width, slices, |z| design.lead(z))
    }

    fn quadratic(stretches: impl Iterator<Item = ((f64, f64), [f64; 3])>, width: f64) -> Self {
        let mut pieces = Vec::with_capacity(4);
        for ((from, to), polynomial) in stretches {
            let vertex = -0.5 * polynomial[1] / polynomial[2];
            if vertex > from && vertex < to {
                pieces.push(Piece::new(polynomial, from, vertex, width));
                pieces.push(Piece::new(polynomial, vertex, to, width));
            } else {
                pieces.push(Piece::new(polynomial, from, to, width));
            }
        }
        let offset = pieces.iter().map(|piece| piece.base).fold(f64::INFINITY, f64::min);
        let mut merged: Vec<Piece> = Vec::with_capacity(pieces.len());
        for mut piece in pieces {
            piece.base -= offset;
            match merged.iter_mut().find(|other| Piece { weight: piece.weight, ..**other } == piece) {
                Some(twin) => twin.weight += piece.weight,
                None => merged.push(piece),
            }
        }
        let mean = merged.iter().map(Piece::mean).sum();
        Self { offset, mean, shape: Shape::Quadratic(merged) }
    }

    fn sliced(
        stretches: impl Iterator<Item = (f64, f64)>,
        width: f64,
        slices: usize,
        lead: impl Fn(f64) -> f64,
    ) -> Self {
        let rule = Rule::new(slices);
        let mut found = Vec::new();
        for (from, to) in stretches {
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                found.push((weight * (to - from) / width, lead(from + (to - from) * node)));
            }
        }
        let offset = found.iter().map(|slice| slice.1).fold(f64::INFINITY, f64::min);
        for slice in &mut found {
            slice.1 -= offset;
        }
        let mean = found.iter().map(|slice| slice.0 * slice.1).sum();
        Self { offset, mean, shape: Shape::Sliced(found) }
    }

    /// Whether both flanks run parallel across the face.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        self.shape == Shape::Flat
    }

    /// Φ(w) and dΦ/dw, the share of the face in contact, for w > 0.
    #[must_use]
    #[inline]
    pub fn passed(&self, interference: f64) -> (f64, f64) {
        match &self.shape {
            Shape::Flat => (interference, 1.0),
            Shape::Quadratic(pieces) => {
                let (mut sum, mut share) = (0.0, 0.0);
                for piece in pieces {
                    let (part, width) = piece.passed(interference);
                    sum += part;
                    share += width;
                }
                (sum, share)
            }
            Shape::Sliced(_) => self.summed(interference, |depth| (depth, 1.0)),
        }
    }

    /// Width means of `response` (value and slope at a local interference > 0) over the slices.
    #[must_use]
    pub fn summed(&self, interference: f64, response: impl Fn(f64) -> (f64, f64)) -> (f64, f64) {
        let Shape::Sliced(slices) = &self.shape else { return response(interference) };
        let (mut sum, mut slope) = (0.0, 0.0);
        for (share, deviation) in slices {
            let depth = interference - deviation;
            if depth > 0.0 {
                let (value, rise) = response(depth);
                sum += share * value;
                slope += share * rise;
            }
        }
        (sum, slope)
    }
}

impl Piece {
    /// `polynomial` in z from `from` to `to`, between which it is monotonic, seen from its lower end.
    fn new(polynomial: [f64; 3], from: f64, to: f64, width: f64) -> Self {
        let [constant, slope, bend] = polynomial;
        let height = |z: f64| constant + z * (slope + z * bend);
        let low = if height(from) <= height(to) { from } else { to };
        let steepness = (slope + 2.0 * bend * low).abs();
        let length = to - from;
        // Against rounding where the lower end is the vertex.
        let slope = if steepness * length <= 1e-14 * (bend * length * length).abs() { 0.0 } else { steepness };
        let rise = (length * (slope + length * bend)).max(0.0);
        Self { base: height(low), slope, bend, length, rise, weight: 1.0 / width }
    }

    fn mean(&self) -> f64 {
        let Self { base, slope, bend, length, weight, .. } = *self;
        weight * length * (base + length * (0.5 * slope + length * bend / 3.0))
    }

    #[inline]
    fn passed(&self, interference: f64) -> (f64, f64) {
        let depth = interference - self.base;
        if depth <= 0.0 {
            return (0.0, 0.0);
        }
        let reach = if depth >= self.rise {
            self.length
        } else {
            // The root of slope ζ + bend ζ² = depth in the form that does not cancel.
            let root = (self.slope * self.slope + 4.0 * self.bend * depth).max(0.0).sqrt();
            (2.0 * depth / (self.slope + root)).min(self.length)
        };
        let width = self.weight * reach;
        (width * (depth - reach * (0.5 * self.slope + reach * self.bend / 3.0)), width)
    }
}
