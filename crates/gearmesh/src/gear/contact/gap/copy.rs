//! Quick copies of a gap: polynomials between its breaks, for what asks for it some hundred times.
//!
//! Between two breaks the flanks touch at one spot, so that most of what a polynomial is made of needs no search. Must not
//! know: how the least gap is found.

use super::{Gaps, PieceLocation, Spot, Way};
use crate::numeric::piecewise::{Piecewise, Rule, Tolerance};

/// How well quick copies follow, over the largest value on a piece: complementarity holds to as much. And over the largest of
/// all, to which depths are rounded.
const ACCURACY: [f64; 2] = [1e-14, 1e-15];
/// How near to where it vanishes, but for rounding, a gap has no copy: over the smooth stretch, and over the largest gap.
const NEAR: f64 = 0.01;
const VANISHES: f64 = 1e-12;

impl Gaps<'_> {
    /// A quick copy of the gap between the first and the last of its [`Gaps::breaks`].
    #[must_use]
    #[allow(clippy::float_cmp)] // asks for the value that is known at a place, not at one nearby
    pub fn copied(&self, rule: &Rule, breaks: &[f64]) -> Piecewise {
        if self.is_sampled() {
            return Piecewise::default();
        }
        let gap = |s: f64| self.at(s).unwrap_or(f64::NAN);
        let at_breaks: Vec<f64> = breaks.iter().map(|s| gap(*s)).collect();
        let largest = at_breaks.iter().copied().fold(0.0, f64::max);
        let tolerance = Tolerance { relative: ACCURACY[0], absolute: ACCURACY[1] * largest };
        let mut copy = Piecewise::from(breaks.first().copied().unwrap_or(0.0));
        for (ends, values) in breaks.windows(2).zip(at_breaks.windows(2)) {
            // The spot is the same all over the stretch.
            let middle = 0.5 * (ends[0] + ends[1]);
            let (in_middle, spot) = self.touching(middle);
            if spot == Spot::OnLineOfAction && self.is_unmodified(middle) {
                // Not what rounding makes of its ends: deflections may be smaller than that.
                copy.push(rule, ends[1], tolerance, |_| 0.0, |_| 0.0);
                continue;
            }
            // Where a gap vanishes it is left as it is: what the copy is rounded to may be larger than a deflection.
            let vanishing = NEAR * (ends[1] - ends[0]);
            let [before, after] = [0, 1].map(|end| if values[end] <= VANISHES * largest { vanishing } else { 0.0 });
            let known = [(ends[0], values[0]), (ends[1], values[1]), (middle, in_middle)];
            let quick = |s: f64| {
                let known = known.iter().find(|known| known.0 == s).map(|known| known.1);
                known.or_else(|| self.at_spot(s, spot)).unwrap_or_else(|| gap(s))
            };
            copy.skip(ends[0] + before);
            copy.push(rule, ends[1] - after, tolerance, quick, gap);
            copy.skip(ends[1]);
        }
        copy.indexed()
    }

    /// The gap where the flanks touch at a known spot, if that saves a search.
    fn at_spot(&self, s: f64, spot: Spot) -> Option<f64> {
        let nominal = |way: &Way| way.facing.turned(way.side, s);
        match spot {
            Spot::OnLineOfAction => Some(self.on_line(s)),
            Spot::Corner { .. } => {
                let way = self.ways.iter().find(|way| way.facing.start > nominal(way))?;
                let touch = way.tip(way.facing.start - nominal(way));
                Some(touch.separation + way.depth(way.facing.start, touch.curvature))
            }
            Spot::Beside { side, pieces, place } => {
                let way = self.ways.iter().find(|way| way.side == side)?;
                let nominal = nominal(way);
                match place {
                    PieceLocation::Inside if self.is_convex => way.inside(nominal, pieces),
                    PieceLocation::Inside => None,
                    PieceLocation::EndOfPoint => {
                        let cut = way.point.cuts[pieces[0] + 1];
                        let touch = way.facing.touch(cut, cut - nominal);
                        Some(touch.separation + way.point.depth_at_end(pieces[0]) + way.flank.depth(touch.curvature))
                    }
                    PieceLocation::EndOfFlank => {
                        let (before, touch) = way.meet(nominal, way.flank.cuts[pieces[1] + 1])?;
                        let of_point = way.point.depth(nominal + before);
                        Some(touch.separation + of_point + way.flank.depth_at_end(pieces[1]))
                    }
                }
            }
            Spot::Nowhere => None,
        }
    }
}
