//! Global minimum of the gap between flanks that are not convex, by branch and bound.
//!
//! The search cuts the path at every kink of either flank. Between two cuts the second derivative of the gap S + C1 + C2 over the distance e from
//! the nominal point has a lower bound β, the sum of the bounds for S and for both depths. If β ≥ 0 the gap is convex, and Newton's method finds its
//! minimum. Otherwise the gap plus β/2 (e − e1)(e2 − e) is a convex underestimator on [e1, e2] (αBB: Adjiman et al., Computers & Chemical
//! Engineering 22, 1998). The search discards intervals whose underestimator does not fall below the smallest gap found, and bisects the others.
//! Must not know: load.
//!
//! Assumes that d²S/de² and df/de lie between their values at both ends of an interval, and d²f/de² within [`RATE_SLOPE_MARGIN`] of them;
//! `the_separation_stays_within_its_bounds` tests it.

use super::outline::{Cells, Underestimator};
use super::{PieceLocation, Spot, Way};
use crate::gear::contact::separation::Touch;

/// Absolute tolerance of the smallest gap, as a share of the length of the path of contact.
const GAP_TOLERANCE: f64 = 1e-14;
/// Shortest interval that is bisected, as a share of the length of the path of contact.
const SHORTEST_INTERVAL: f64 = 1e-10;
/// Largest relative excess of d²f/de² inside an interval over its values at both ends, per square of the relative change of df/de.
pub(super) const RATE_SLOPE_MARGIN: f64 = 0.5;
/// Limit on the steps of Newton's method and of bisection together.
const MAX_STEPS: usize = 64;

/// A position of the point in front of the flank, with the values and derivatives of both profiles.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Distance e from the nominal point \[m\].
    at: f64,
    touch: Touch,
    /// Depth and its first two derivatives: the point's over its path position, the flank's over its radius of curvature.
    point: [f64; 3],
    flank: [f64; 3],
    cells: [usize; 2],
}

impl Place {
    fn gap(&self) -> f64 {
        self.touch.separation + self.point[0] + self.flank[0]
    }

    fn slope(&self) -> f64 {
        self.touch.slope + self.point[1] + self.flank[1] * self.touch.rate
    }

    fn bend(&self) -> f64 {
        let Touch { bend, rate, rate_slope, .. } = self.touch;
        bend + self.point[2] + self.flank[2] * rate * rate + self.flank[1] * rate_slope
    }
}

/// A search in one direction at one path position.
pub(super) struct Search<'a, 'b> {
    way: &'b Way<'a>,
    cells: [&'b Cells; 2],
    nominal: f64,
    tolerance: f64,
    shortest: f64,
    minimum: (f64, Spot),
}

impl<'a, 'b> Search<'a, 'b> {
    /// The smaller of `minimum` and of the gap at all distances beyond `before` from the nominal point.
    pub(super) fn least(
        way: &'b Way<'a>,
        nominal: f64,
        before: f64,
        touch: Touch,
        minimum: (f64, Spot),
    ) -> (f64, Spot) {
        let cells = [way.point.cells(), way.flank.cells()];
        let [tolerance, shortest] =
            [GAP_TOLERANCE, SHORTEST_INTERVAL].map(|share| share * (way.facing.end - way.facing.start));
        let mut search = Self { way, cells, nominal, tolerance, shortest, minimum };
        search.run(before, touch);
        search.minimum
    }

    fn place(&self, at: f64, touch: Touch, cells: [usize; 2]) -> Place {
        let [of_point, of_flank] = self.cells;
        Place {
            at,
            touch,
            point: of_point.rates(&self.way.point, self.nominal + at, cells[0]),
            flank: of_flank.rates(&self.way.flank, touch.curvature, cells[1]),
            cells,
        }
    }

    /// The place at a distance `at` that lies within these cells.
    fn inside(&self, at: f64, [point, flank]: [[usize; 2]; 2]) -> Place {
        let touch = self.way.facing.touch(self.nominal + at, at);
        let cells = [self.cells[0].cell(self.nominal + at, point), self.cells[1].cell(touch.curvature, flank)];
        self.place(at, touch, cells)
    }

    fn offer(&mut self, gap: f64, cells: [usize; 2], place: PieceLocation) {
        if gap < self.minimum.0 {
            let pieces = [0, 1].map(|of| self.cells[of].piece(cells[of]));
            self.minimum = (gap, Spot::Beside { side: self.way.side, pieces, place });
        }
    }

    fn run(&mut self, before: f64, touch: Touch) {
        let [point, flank] = self.cells;
        let mut cells = [
            point.cell(self.nominal + before, [0, point.count() - 1]),
            flank.cell(touch.curvature, [0, flank.count() - 1]),
        ];
        let (mut at, mut touch) = (before, touch);
        loop {
            // The separation grows monotonically.
            if touch.separation + point.least_from(cells[0]) + flank.least_from(cells[1])
                >= self.minimum.0 - self.tolerance
            {
                return;
            }
            let corners = [point.next_corner(cells[0]), flank.next_corner(cells[1])];
            let (end, at_end, ended) = self.next_cut(at, &touch, [point.end(corners[0]), flank.end(corners[1])]);
            let last = [0, 1].map(|of| {
                let position = if of == 0 { self.nominal + end } else { at_end.curvature };
                if ended[of] { corners[of] - 1 } else { self.cells[of].cell(position, [cells[of], corners[of] - 1]) }
            });
            let [from, to] = [self.place(at, touch, cells), self.place(end, at_end, last)];
            cells = [0, 1].map(|of| if ended[of] { corners[of] } else { last[of] });
            let goes_on = cells[0] < point.count() && cells[1] < flank.count();
            // Rounding differs between both sides of a corner, notably where the profile is steep.
            let behind = if goes_on { self.place(end, at_end, cells).gap() } else { f64::INFINITY };
            let place = if ended[1] { PieceLocation::EndOfFlank } else { PieceLocation::EndOfPoint };
            self.offer(to.gap().min(behind), last, place);
            self.branch(&from, &to);
            if !goes_on {
                return;
            }
            (at, touch) = (end, at_end);
        }
    }

    /// The nearer of the next corners of the point's profile and of the flank's.
    fn next_cut(&self, from: f64, touch: &Touch, [cut, wall]: [f64; 2]) -> (f64, Touch, [bool; 2]) {
        let last = (cut - self.nominal).max(from);
        let facing = &self.way.facing;
        let at_last = facing.touch(cut, last);
        if at_last.curvature <= wall {
            return (last, at_last, [true, false]);
        }
        // Newton on the square of the radius of curvature, which is almost linear in the distance.
        let (mut at, mut there) = (from, *touch);
        for _ in 0..30 {
            let step = (wall * wall - there.curvature * there.curvature) / (2.0 * there.curvature * there.rate);
            at = (at + step).clamp(from, last);
            there = facing.touch(self.nominal + at, at);
            if step.abs() <= 1e-13 * facing.end {
                break;
            }
        }
        there.curvature = wall;
        (at, there, [false, true])
    }

    /// Searches an interval without a corner inside, whose end values are already offered.
    fn branch(&mut self, from: &Place, to: &Place) {
        let width = to.at - from.at;
        let cells = [0, 1].map(|of| [from.cells[of], to.cells[of]]);
        let least = self.cells[0].least(cells[0]) + self.cells[1].least(cells[1]);
        if from.touch.separation + least >= self.minimum.0 - self.tolerance || width <= self.shortest {
            return;
        }
        let under = self.bound(from, to, cells);
        if under.least([from.gap(), to.gap()], width) >= self.minimum.0 - self.tolerance {
            return;
        }
        if under.bend >= 0.0 && under.is_exact {
            self.descend(*from, *to);
            return;
        }
        let middle = self.inside(0.5 * (from.at + to.at), cells);
        self.offer(middle.gap(), middle.cells, PieceLocation::Inside);
        self.branch(from, &middle);
        self.branch(&middle, to);
    }

    /// A convex underestimator of the gap between two places.
    fn bound(&self, from: &Place, to: &Place, cells: [[usize; 2]; 2]) -> Underestimator {
        let along = [from.touch.curvature, to.touch.curvature];
        let own = [from, to].map(|place| self.nominal + place.at);
        let point = self.cells[0].underestimator(&self.way.point, cells[0], own, [&from.point, &to.point]);
        let flank = self.cells[1].underestimator(&self.way.flank, cells[1], along, [&from.flank, &to.flank]);
        let [rate, rate_slope] = [[from.touch.rate, to.touch.rate], [from.touch.rate_slope, to.touch.rate_slope]];
        let stretched = if flank.bend < 0.0 { rate[0].max(rate[1]) } else { rate[0].min(rate[1]) };
        // Bounds of the slope of the flank's profile.
        let beyond = (-flank.bend).max(0.0) * (along[1] - along[0]);
        let [one, other] = flank.slopes;
        // d²f/de² may leave the range of its end values, to second order in the length of the interval.
        let share = 1.0 - rate[0].min(rate[1]) / rate[0].max(rate[1]).max(f64::MIN_POSITIVE);
        let more = RATE_SLOPE_MARGIN * share * share * rate_slope[0].abs().min(rate_slope[1].abs());
        let rate_slopes = [rate_slope[0].min(rate_slope[1]) - more, rate_slope[0].max(rate_slope[1]) + more];
        let turned = [one.min(other) - beyond, one.max(other) + beyond]
            .map(|slope| (slope * rate_slopes[0]).min(slope * rate_slopes[1]));
        Underestimator {
            bend: from.touch.bend.min(to.touch.bend)
                + point.bend
                + flank.bend * stretched * stretched
                + turned[0].min(turned[1]),
            slopes: [
                from.touch.slope + point.slopes[0] + one * rate[0],
                to.touch.slope + point.slopes[1] + other * rate[1],
            ],
            is_exact: point.is_exact && flank.is_exact,
        }
    }

    /// The minimum of a convex interval whose gap falls inward from both ends, by safeguarded Newton steps.
    fn descend(&mut self, mut low: Place, mut high: Place) {
        let cells = [0, 1].map(|of| [low.cells[of], high.cells[of]]);
        let mut nearer = if low.slope().abs() < high.slope().abs() { low } else { high };
        for step in 0..MAX_STEPS {
            let newton = -nearer.slope() / nearer.bend();
            let next = nearer.at + newton;
            let next = if next > low.at && next < high.at && step % 4 != 3 { next } else { 0.5 * (low.at + high.at) };
            if !(next > low.at && next < high.at) {
                return;
            }
            nearer = self.inside(next, cells);
            let (gap, slope, bend) = (nearer.gap(), nearer.slope(), nearer.bend());
            // A parabola of the least curvature on the falling side bounds the remaining descent.
            let [from, to] = if slope < 0.0 { [&nearer, &high] } else { [&low, &nearer] };
            let least_bend = self.bound(from, to, [0, 1].map(|of| [from.cells[of], to.cells[of]])).bend;
            if least_bend > 0.0 && 0.5 * slope * slope <= self.tolerance * least_bend {
                self.offer(gap - 0.5 * slope * slope / bend, nearer.cells, PieceLocation::Inside);
                return;
            }
            self.offer(gap, nearer.cells, PieceLocation::Inside);
            *(if slope < 0.0 { &mut low } else { &mut high }) = nearer;
            let under = Underestimator { bend: 0.0, slopes: [low.slope(), high.slope()], is_exact: true };
            if under.least([low.gap(), high.gap()], high.at - low.at) >= self.minimum.0 - self.tolerance {
                return;
            }
        }
    }
}
