//! How far profiles that are splines through many points bend back, against how much the separation bends.
//!
//! Must not know: what the points are of.

use super::outline::{Outline, PARTS};
use crate::gear::contact::separation::Facing;

/// How much of what the separation bends by is left under splines that bend back, for the gap to have one least place.
const LEFT: f64 = 0.5;

/// Whether profiles bend back by more than the separation bends, anywhere: their sum is not convex then, and the gap has more than one place
/// where it is low.
pub(super) fn are_rough(facing: &Facing, point: &Outline, flank: &Outline) -> bool {
    if !point.is_sampled && !flank.is_sampled {
        return false;
    }
    if !(point.is_convex() && flank.is_convex()) {
        return true;
    }
    // Mostly nothing bends back anywhere by what is the least all over the path, or something by more than the most.
    if let (Some(one), Some(other)) = (point.least_bend(), flank.least_bend()) {
        let [start, end] = [facing.start, facing.end].map(|place| facing.on_line(place));
        let (least, most) = (start.rate.min(end.rate), start.rate.max(end.rate));
        if -one - other * most * most <= (1.0 - LEFT) * facing.least_bend() {
            return false;
        }
        if (-one).max(-other * least * least) > (1.0 - LEFT) * start.bend {
            return true;
        }
    }
    let none = [f64::NEG_INFINITY; PARTS];
    let [of_point, of_flank] = [point, flank].map(|outline| outline.least_bends().unwrap_or(none));
    (0..PARTS).any(|part| {
        let end = |end: usize| facing.start + (facing.end - facing.start) * end as f64 / PARTS as f64;
        let ends = [part, part + 1].map(|at| facing.on_line(end(at)));
        let bend = ends[0].bend.min(ends[1].bend);
        let rate = ends[0].rate.max(ends[1].rate);
        // Off the line of action they touch in parts beside each other.
        let near = part.saturating_sub(1)..(part + 2).min(PARTS);
        let least = |of: &[f64; PARTS]| of[near.clone()].iter().copied().fold(0.0, f64::min);
        -least(&of_point) - least(&of_flank) * rate * rate > (1.0 - LEFT) * bend
    })
}
