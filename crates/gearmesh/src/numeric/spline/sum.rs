//! A spline and quadratics that begin at places of their own, as one piecewise cubic.
//!
//! Must not know: what is added up.

use super::{Index, Spline};
use crate::numeric::quadratic::Quadratic;

/// Places nearer than this share of the whole are one.
const CLOSEST: f64 = 1e-12;

impl Spline {
    /// The sum with quadratics, each from its place on up to that of the next one, which are ascending. Beyond its ends the spline is held, and
    /// beyond `from` and `to` the sum is.
    #[must_use]
    pub fn with_quadratics(&self, [from, to]: [f64; 2], quadratics: &[(f64, Quadratic)]) -> Self {
        let closest = CLOSEST * (to - from);
        let [low, high] = self.between;
        let held = |place: f64, end: f64| [place, self.value(end), 0.0, 0.0, 0.0];
        let before = (from < low - closest).then(|| held(from, low));
        let behind = (to > high + closest).then(|| held(high, high));
        let all: Vec<[f64; 5]> = before.into_iter().chain(self.pieces.iter().copied()).chain(behind).collect();
        // Where a held end goes on.
        let kinks = [before.map(|_| 1), behind.map(|_| all.len() - 1)];
        let last = to.max(high);
        let (mut pieces, mut jumps) = (Vec::with_capacity(all.len() + quadratics.len()), Vec::new());
        let (mut quadratic, mut next) = (Quadratic::ZERO, quadratics.iter().peekable());
        for (at, cubic) in all.iter().enumerate() {
            let end = all.get(at + 1).map_or(last, |next| next[0]);
            let (mut cubic, mut is_jump) = (*cubic, kinks.contains(&Some(at)));
            loop {
                while let Some((_, begun)) = next.next_if(|(begins, _)| *begins <= cubic[0] + closest) {
                    (quadratic, is_jump) = (*begun, true);
                }
                if is_jump && !pieces.is_empty() {
                    jumps.push(pieces.len());
                }
                let [place, c0, c1, c2, c3] = cubic;
                let [value, slope, bend] = quadratic.rates(place);
                pieces.push([place, c0 + value, c1 + slope, c2 + 0.5 * bend, c3]);
                let Some((begins, _)) = next.peek().filter(|(begins, _)| *begins < end - closest) else { break };
                let t = begins - place;
                cubic = [
                    *begins,
                    c0 + t * (c1 + t * (c2 + t * c3)),
                    c1 + t * (2.0 * c2 + 3.0 * t * c3),
                    c2 + 3.0 * t * c3,
                    c3,
                ];
            }
        }
        let knots: Vec<f64> = pieces.iter().map(|piece| piece[0]).chain([last]).collect();
        let index = Index::new(&knots);
        let between = [from, to];
        let mut sum = Self { knots, pieces, index, least_bend: 0.0, between, jumps };
        sum.find_least_bend();
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: second method; the sum is that of both at every place, held beyond its ends, whether the spline reaches beyond it or not.
    #[test]
    fn a_sum_is_that_of_its_parts() {
        let knots = [0.0, 0.1, 0.35, 0.4, 0.9, 1.0, 1.7];
        let spline = Spline::new(&knots, &[1.0, -0.3, 0.8, 0.2, 0.5, 2.0, -1.0]);
        let quadratics = [
            (f64::NEG_INFINITY, Quadratic { origin: 0.2, coefficients: [0.3, -1.0, 2.0] }),
            (0.2, Quadratic { origin: 0.1, coefficients: [-0.5, 3.0, 0.0] }),
            (0.4, Quadratic { origin: 0.4, coefficients: [0.0, 0.0, -9.0] }),
            (0.4 + 1e-15, Quadratic { origin: 0.4, coefficients: [1.0, 0.0, -7.0] }),
            (0.95, Quadratic::ZERO),
            (1.8, Quadratic { origin: 2.0, coefficients: [0.0, 5.0, 0.0] }),
        ];
        for [from, to] in [[-0.5, 2.5], [0.05, 1.2], [0.0, 1.7]] {
            let sum = spline.with_quadratics([from, to], &quadratics);
            for at in -20_i32..=320 {
                let x = f64::from(at) / 100.0 + 3e-3;
                let place = x.clamp(from, to);
                let (_, quadratic) =
                    quadratics.iter().rfind(|(begins, _)| *begins <= place).expect("one from the first on");
                let held = [spline.value(place.clamp(0.0, 1.7)), 0.0, 0.0];
                let of_spline = if (0.0..=1.7).contains(&place) { spline.rates(place) } else { held };
                let of_quadratic = quadratic.rates(place);
                let found = sum.rates(place);
                for order in 0..3 {
                    let exact = of_spline[order] + of_quadratic[order];
                    assert!(
                        (found[order] - exact).abs() < 1e-11 * exact.abs().max(1.0),
                        "{x} {order}: {found:?} {exact}"
                    );
                }
            }
            // Between two places of the visit bends are straight, and the least is among them.
            let mut before: Option<[f64; 2]> = None;
            sum.visit_bends(|place, bend| {
                assert!(sum.least_bend() <= bend);
                if let Some([last, from]) = before.filter(|[last, _]| place - last > 1e-9) {
                    let middle = sum.rates(0.5 * (last + place))[2];
                    assert!((middle - 0.5 * (from + bend)).abs() < 1e-9, "{place}: {middle} {from} {bend}");
                }
                before = Some([place, bend]);
            });
            assert_eq!(sum.ends().map(f64::to_bits), [from, to].map(f64::to_bits));
        }
    }
}
