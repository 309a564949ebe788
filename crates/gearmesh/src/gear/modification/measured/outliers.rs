//! Points that no flank has: spikes, and points so near each other that the flank between them would swing.
//!
//! Must not know: gears, messages.

use crate::numeric::spline::Spline;

/// How much farther than usual around it a spike stands out, and how far at the least \[m\].
const SPIKE: f64 = 10.0;
const LEAST_SPIKE: f64 = 5e-6;
const FEWEST_FOR_SPIKES: usize = 7;
/// How many points a spike is wide at the most, and how many to either side are around it.
const WIDEST_SPIKE: usize = 3;
const AROUND: usize = 10;
/// By how much of all that it deviates, and of what the points beside deviate, a flank may swing beyond these; by so much \[m\] it always may.
const SWING: f64 = 0.1;
const LEAST_SWING: f64 = 1e-6;
/// How near two points are, over the usual distance, that a flank swings about; about others it does as splines do.
const NEAR: f64 = 0.1;
/// Where between two points that is looked for.
const BETWEEN: [f64; 4] = [0.2, 0.4, 0.6, 0.8];

/// A point of what stands out from the trace before it and behind it, which meet there, and how far \[m\]: a spike comes back. Kinks, steps
/// and reliefs go on as they are on one side. The last point, and the first, have but one side: they stand out where nothing else does.
pub(super) fn spike(places: &[f64], values: &[f64]) -> Option<(usize, f64)> {
    let count = values.len();
    if count < FEWEST_FOR_SPIKES {
        return None;
    }
    let trace = Trace { places, values };
    let wide = (1..=WIDEST_SPIKE).flat_map(|width| (1..count - width).map(move |first| (first, width)));
    let inside = wide.filter_map(|(first, width)| trace.out(first, first + width - 1));
    let found = inside.chain([0, count - 1].into_iter().filter_map(|end| trace.end_out(end)));
    found.reduce(|one, other| if other.1 > one.1 { other } else { one })
}

struct Trace<'a> {
    places: &'a [f64],
    values: &'a [f64],
}

impl Trace<'_> {
    /// The point of a block that stands out farthest, and how far, if all of them do.
    fn out(&self, first: usize, last: usize) -> Option<(usize, f64)> {
        let lines = [[first.saturating_sub(2), first - 1], [(last + 2).min(self.values.len() - 1), last + 1]];
        let beyond = |at: usize| lines.map(|line| self.values[at] - self.straight(line, self.places[at]));
        let mut least = f64::INFINITY;
        let mut farthest = (first, 0.0_f64);
        for at in first..=last {
            let [before, behind] = beyond(at);
            let out = before.abs().min(behind.abs());
            let meets = (before - behind).abs() <= 0.5 * out;
            if !meets || before * beyond(first)[0] <= 0.0 {
                return None;
            }
            least = least.min(out);
            farthest = if out > farthest.1 { (at, out) } else { farthest };
        }
        if least <= LEAST_SPIKE {
            return None;
        }
        let around = self.around(first, last);
        let gap = first - first.saturating_sub(AROUND);
        let [before, behind] = [&around[gap.saturating_sub(2)..gap], &around[gap..(gap + 2).min(around.len())]];
        let most = |heights: &[f64]| heights.iter().copied().fold(0.0, f64::max);
        let beside = most(before).min(most(behind));
        let mut ordered = around.clone();
        // Three of four are less: other spikes are not among them.
        let usual = *ordered.select_nth_unstable_by(around.len() * 3 / 4, f64::total_cmp).1;
        (least > SPIKE * usual.max(beside)).then_some(farthest)
    }

    /// The same of the first or the last point.
    fn end_out(&self, end: usize) -> Option<(usize, f64)> {
        let line = if end == 0 { [2, 1] } else { [end - 2, end - 1] };
        let beyond = (self.values[end] - self.straight(line, self.places[end])).abs();
        let rest = self.around(end, end).into_iter().fold(0.0, f64::max);
        // From a single side a kink, or the first point of a relief, is no other than a spike.
        (beyond > LEAST_SPIKE && beyond > 2.0 * SPIKE * rest).then_some((end, beyond))
    }

    /// How far each point around a block is from the line through those beside it, without the block; of the first and the last point half
    /// of how far from the line through the next two, so that a parabola through even points has one height.
    fn around(&self, first: usize, last: usize) -> Vec<f64> {
        let count = self.values.len();
        let left: Vec<usize> =
            (first.saturating_sub(AROUND)..first).chain(last + 1..(last + 1 + AROUND).min(count)).collect();
        let end = left.len() - 1;
        let height = |at: usize| {
            let (beside, share) = match at {
                0 => ([left[1], left[2]], 0.5),
                at if at == end => ([left[end - 2], left[end - 1]], 0.5),
                at => ([left[at - 1], left[at + 1]], 1.0),
            };
            share * (self.values[left[at]] - self.straight(beside, self.places[left[at]])).abs()
        };
        (0..left.len()).map(height).collect()
    }

    /// The line through two points, at a place; of one point twice what that has.
    fn straight(&self, [one, other]: [usize; 2], place: f64) -> f64 {
        if one == other {
            return self.values[other];
        }
        let share = (place - self.places[one]) / (self.places[other] - self.places[one]);
        self.values[one] + share * (self.values[other] - self.values[one])
    }
}

/// The first of two points that are so near each other that a flank through both goes beyond those around them, and how far \[m\]: what they
/// deviate by makes it steep. The worst such place.
pub(super) fn swing(places: &[f64], values: &[f64]) -> Option<(usize, f64)> {
    let step = |at: usize| places[at + 1] - places[at];
    let mut steps: Vec<f64> = (0..places.len() - 1).map(step).collect();
    let middle = steps.len() / 2;
    let near = NEAR * *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let between = |values: &[f64]| {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        (least, values.iter().copied().fold(f64::NEG_INFINITY, f64::max))
    };
    if steps.iter().all(|step| *step >= near) {
        return None;
    }
    let (least, most) = between(values);
    let spline = Spline::new(places, values);
    let beyond = |at: usize| {
        let (low, high) = between(&values[at.saturating_sub(1)..(at + 3).min(values.len())]);
        let inside = BETWEEN.map(|share| spline.value(places[at] + share * step(at)));
        let beyond = inside.into_iter().map(|value| (low - value).max(value - high)).fold(0.0, f64::max);
        if beyond > high - low { beyond } else { 0.0 }
    };
    let around = |at: usize| (at.saturating_sub(1)..(at + 2).min(places.len() - 1)).map(beyond).fold(0.0, f64::max);
    let swings = (0..places.len() - 1).filter(|at| step(*at) < near).map(|at| (at, around(at)));
    let worst = swings.reduce(|one, other| if other.1 > one.1 { other } else { one })?;
    (worst.1 > LEAST_SWING && worst.1 > SWING * (most - least)).then_some(worst)
}
