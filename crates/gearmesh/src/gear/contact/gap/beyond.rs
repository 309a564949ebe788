//! What touches beyond the end of a flank: the corner of the tip, or the arc of a rounding.
//!
//! A rounding begins with the tangent of the flank as it is modified. Lengths in m. Must not know: how places are searched.

use super::Way;
use crate::gear::contact::separation::Touch;
use crate::numeric::crossing::bracketed;

/// How the slope of the profiles at the end of a flank turns the rounding that follows it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turn {
    /// How much farther inside the arc's own position is \[m\].
    shift: f64,
    /// What the separation of the arc gains by that, in second order \[m\].
    offset: f64,
}

impl Way<'_> {
    /// What comes nearest when the flank ends `before` its own position, if no place of the flank does.
    pub(super) fn tip(&self, before: f64) -> Touch {
        let touch = self.facing.turned_tip(before, self.turn.shift);
        Touch { separation: touch.separation + self.turn.offset, ..touch }
    }

    /// A rounding begins with the tangent of the flank as it is modified: when its beginning touches, the mate is met where
    /// the flank's end meets it, and the gap is the same.
    pub(super) fn turned(&self) -> Turn {
        let facing = self.facing;
        let slope = |before: f64| {
            let touch = facing.flank_end(before);
            self.pull(
                facing.start - before,
                before,
                &touch,
                [self.point.piece(facing.start), self.flank.piece(touch.curvature)],
            )[1]
        };
        let reach = facing.reach(facing.end - facing.start);
        // Where the gap does not fall towards the inside, the rounding begins to touch with the end of contact.
        let first = if slope(0.0) < 0.0 { bracketed(0.0, reach, slope).unwrap_or(reach) } else { 0.0 };
        let end = facing.flank_end(first);
        let miss = |shift: f64| facing.turned_tip(first, shift).curvature - end.curvature;
        let shift = bracketed(-first, facing.end - facing.start, miss).unwrap_or(0.0);
        Turn { shift, offset: end.separation - facing.turned_tip(first, shift).separation }
    }
}
