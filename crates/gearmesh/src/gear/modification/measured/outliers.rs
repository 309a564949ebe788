//! Points that no flank has: spikes, and points so near each other that the flank between them would swing.
//!
//! Must not know: gears, messages.

use crate::numeric::spline::Spline;

/// How much farther than what is left without them spikes stand out, and how far at the least \[m\].
const SPIKE: f64 = 10.0;
const LEAST_SPIKE: f64 = 5e-6;
const FEWEST_FOR_SPIKES: usize = 7;
/// Points without which the rest would say nothing.
const FEWEST_LEFT: usize = 4;
/// By how much of all that it deviates, and of what the points beside deviate, a flank may swing beyond these.
const SWING: f64 = 0.1;
/// How near two points are, over the usual distance, that a flank swings about; about others it does as splines do.
const NEAR: f64 = 0.1;
/// Where between two points that is looked for.
const BETWEEN: [f64; 4] = [0.2, 0.4, 0.6, 0.8];

/// The point that stands out from the others farthest, and how far \[m\], if some few stand out far more than all others do without
/// them. A kink is none: it is left, whatever points are.
pub(super) fn spike(places: &[f64], values: &[f64]) -> Option<(usize, f64)> {
    if values.len() < FEWEST_FOR_SPIKES {
        return None;
    }
    let all: Vec<usize> = (0..values.len()).collect();
    let heights = heights(places, values, &all);
    let mut ordered = heights.clone();
    let usual = *ordered.select_nth_unstable_by(values.len() / 2, f64::total_cmp).1;
    let is_out = |at: &usize| heights[*at] > LEAST_SPIKE && heights[*at] > SPIKE * usual;
    let (out, left): (Vec<usize>, Vec<usize>) = all.into_iter().partition(is_out);
    if out.is_empty() || left.len() < FEWEST_LEFT.max(values.len() / 2) {
        return None;
    }
    let rest = self::heights(places, values, &left).into_iter().fold(0.0, f64::max);
    let beyond = |at: usize| {
        let before = left.iter().rposition(|near| *near < at);
        let [one, other] = match before {
            None => [left[0], left[1]],
            Some(before) if before + 1 == left.len() => [left[before - 1], left[before]],
            Some(before) => [left[before], left[before + 1]],
        };
        (values[at] - straight(places, values, [one, other], places[at])).abs()
    };
    let farther = |one: (usize, f64), other: (usize, f64)| if other.1 > one.1 { other } else { one };
    let farthest = out.into_iter().map(|at| (at, beyond(at))).reduce(farther)?;
    (farthest.1 > LEAST_SPIKE && farthest.1 > SPIKE * rest).then_some(farthest)
}

/// How far each of some points is from the line through those beside it: half as far of the first and the last, from the line through
/// the next two, so that a parabola through even points has one height.
fn heights(places: &[f64], values: &[f64], points: &[usize]) -> Vec<f64> {
    let last = points.len() - 1;
    let height = |at: usize| {
        let (beside, share) = match at {
            0 => ([points[1], points[2]], 0.5),
            at if at == last => ([points[last - 2], points[last - 1]], 0.5),
            at => ([points[at - 1], points[at + 1]], 1.0),
        };
        share * (values[points[at]] - straight(places, values, beside, places[points[at]])).abs()
    };
    (0..points.len()).map(height).collect()
}

/// The line through two points, at a place.
fn straight(places: &[f64], values: &[f64], [one, other]: [usize; 2], place: f64) -> f64 {
    let share = (place - places[one]) / (places[other] - places[one]);
    values[one] + share * (values[other] - values[one])
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
    (worst.1 > SWING * (most - least) && worst.1 > 0.0).then_some(worst)
}
