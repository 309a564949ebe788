//! How far profiles that are splines through many points may bend back: less than the separation bends, so that the gap has one least place.
//!
//! Must not know: what the points are of.

use super::outline::{Outline, PARTS};
use crate::gear::contact::separation::Facing;

/// How much of what the separation bends by is left under splines that bend back, for the gap to have one least place: where none is
/// bridged, and where one is.
const LEFT: [f64; 2] = [0.1, 0.03];

/// Lets splines bend back by less than the separation bends: their sum is convex then, though they are not. A valley that is bent more
/// is one that the mate does not get to the bottom of: it is bridged, by what is bent a little less than the mate, which takes
/// 0.03 S″ d²/8 from it at the most, d being the distance of the crests on both its sides.
pub(super) fn bridge<'a>(facing: &Facing, point: &mut Outline<'a>, flank: &mut Outline<'a>) {
    if !point.is_sampled && !flank.is_sampled {
        return;
    }
    // Mostly nothing bends back anywhere by what is the least all over the path.
    if let (Some(one), Some(other)) = (point.least_bend(), flank.least_bend())
        && point.is_convex()
        && flank.is_convex()
    {
        let [start, end] = [facing.start, facing.end].map(|place| facing.on_line(place));
        let rate = start.rate.max(end.rate);
        if -one - other * rate * rate <= (1.0 - LEFT[0]) * facing.least_bend() {
            return;
        }
    }
    let none = [f64::NEG_INFINITY; PARTS];
    let [of_point, of_flank] = [&*point, &*flank].map(|outline| outline.least_bends().unwrap_or(none));
    let [mut for_point, mut for_flank] = [[0.0; PARTS]; 2];
    let mut is_bridged = !(point.is_convex() && flank.is_convex());
    for part in 0..PARTS {
        let end = |end: usize| facing.start + (facing.end - facing.start) * end as f64 / PARTS as f64;
        let ends = [part, part + 1].map(|at| facing.on_line(end(at)));
        let bend = ends[0].bend.min(ends[1].bend);
        let square = ends[0].rate.max(ends[1].rate) * ends[0].rate.max(ends[1].rate);
        // Off the line of action they touch in parts beside each other.
        let near = part.saturating_sub(1)..(part + 2).min(PARTS);
        let least = |of: &[f64; PARTS]| of[near.clone()].iter().copied().fold(0.0, f64::min);
        let [one, other] = [-least(&of_point), -least(&of_flank) * square];
        is_bridged |= one + other > (1.0 - LEFT[0]) * bend;
        // Each is allowed what it takes, or half, or what the other leaves.
        let allowed = (1.0 - LEFT[1]) * bend;
        let own = one.min((allowed - other).max(0.5 * allowed));
        for_point[part] = own;
        for_flank[part] = other.min(allowed - own) / square;
    }
    if is_bridged {
        for (outline, bends) in [(point, for_point), (flank, for_flank)] {
            if outline.is_sampled {
                outline.bridge(&bends);
            }
        }
    }
}
