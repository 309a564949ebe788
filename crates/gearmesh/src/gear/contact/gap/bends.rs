//! How far profiles that are splines through many points bend back, against how much the separation bends.
//!
//! Must not know: what the points are of.

use super::Way;
use super::outline::Outline;
use crate::gear::contact::separation::Facing;

/// How much of what the separation bends by is left under splines that bend back, for the gap to have one least place.
pub(super) const LEFT: f64 = 0.5;

/// Whether profiles may bend back by more than the separation bends, anywhere: their sum is not convex then, and the gap has more than one place
/// where it is low. Told at a glance.
pub(super) fn may_be_rough(facing: &Facing, point: &Outline, flank: &Outline) -> bool {
    if !point.is_sampled && !flank.is_sampled {
        return false;
    }
    if !(point.is_convex() && flank.is_convex()) {
        return true;
    }
    // Mostly nothing bends back anywhere by what is the least all over the path.
    let (Some(one), Some(other)) = (point.least_bend(), flank.least_bend()) else { return true };
    let [start, end] = [facing.start, facing.end].map(|place| facing.on_line(place).rate);
    let most = start.max(end);
    -one - other * most * most > (1.0 - LEFT) * facing.least_bend()
}

/// On how many stretches splines bend back more than the separation bends where it does so least, of both flanks.
pub(super) fn crests(ways: &[Way; 2]) -> usize {
    let of = |way: &Way| {
        // Over the flank's own roll length.
        let touch = way.facing.on_line(way.facing.start.max(0.0));
        way.flank.crests(touch.bend / (touch.rate * touch.rate))
    };
    ways.iter().map(of).sum()
}
