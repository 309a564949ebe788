//! How far splines bend back, and what is bridged of their valleys.
//!
//! Must not know: the other flank.

use std::sync::Arc;

use super::{Convexity, Outline, Piece, Told};
use crate::gear::modification::section::Section;
use crate::numeric::spline::Spline;

/// Parts of the path in each of which it is known how far a spline bends back.
pub(in super::super) const PARTS: usize = 32;
/// Into how many parts the path is cut at the least where valleys are bridged, and how near two places may be, of such a part.
const FINEST: usize = 256;
const CLOSEST: f64 = 0.005;

impl Outline<'_> {
    /// The least second derivative of a spline in each of equal parts of the path \[1/m\], not above 0; none where a part of the profile
    /// does not know its own. It is straight between knots, and looked at there.
    pub(in super::super) fn least_bends(&self) -> Option<[f64; PARTS]> {
        let mut least = [0.0_f64; PARTS];
        if !self.is_sampled {
            return Some(least);
        }
        let (from, to) = (self.facing.start, self.facing.end);
        let [start, rate] = self.rolls;
        // The share of the path that lies before a roll angle.
        let per_roll = 1.0 / (rate * (to - from));
        let before = -(start + rate * from) * per_roll;
        let mut put = |roll: f64, bend: f64| {
            let share = before + roll * per_roll;
            if (0.0..=1.0).contains(&share) {
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a share
                let part = ((share * PARTS as f64) as usize).min(PARTS - 1);
                least[part] = least[part].min(bend * rate * rate);
            }
        };
        if let Some(told) = &self.spline {
            told.spline().knots().iter().zip(told.spline().bends()).for_each(|(roll, bend)| put(*roll, bend));
            return Some(least);
        }
        for roll in self.parts.iter().flat_map(Section::knots) {
            put(*roll, self.parts.iter().try_fold(0.0, |sum, part| Some(sum + part.rates(*roll, *roll)?[2]))?);
        }
        Some(least)
    }

    /// The least second derivative anywhere \[1/m\], not above 0, if it is known at once.
    pub(in super::super) fn least_bend(&self) -> Option<f64> {
        let [_, rate] = self.rolls;
        match &self.spline {
            Some(told) => Some((told.spline().least_bend() * rate * rate).min(0.0)),
            None => (!self.is_sampled).then_some(0.0),
        }
    }

    /// Whether a valley of it is bridged.
    pub(in super::super) fn is_bridged(&self) -> bool {
        matches!(self.spline, Some(Told::Bridged(_)))
    }

    /// Bridges what bends back by more than `bends` (at equal parts of the path, not below 0) allow, as something that is bent the other way
    /// by as much would that is laid over it.
    pub(in super::super) fn bridge(&mut self, bends: &[f64; PARTS]) {
        let (from, to) = (self.facing.start, self.facing.end);
        let [_, rate] = self.rolls;
        let (mut range, mut bends) = ([from, to].map(|place| self.roll(place)), bends.map(|bend| bend / (rate * rate)));
        if self.is_point {
            range.reverse();
            bends.reverse();
        }
        let finest = (range[1] - range[0]) / FINEST as f64;
        // Where it ends on the path and is held, its slope has a step, which a spline through all depths has not.
        let closest = CLOSEST * finest;
        let covers = |spline: &Spline| spline.ends()[0] <= range[0] + closest && spline.ends()[1] >= range[1] - closest;
        let bridged = match &self.spline {
            Some(told) if covers(told.spline()) => told.spline().bridged(range, &bends, finest),
            _ => self.through_depths().bridged(range, &bends, finest),
        };
        self.spline = Some(Told::Bridged(Arc::new(bridged)));
        for piece in &mut self.pieces {
            *piece = Piece { shape: Convexity::Convex, is_held: false, quadratic: None };
        }
    }

    /// The spline over the roll angle through the depths at all knots of all parts and between them.
    fn through_depths(&self) -> Spline {
        let (from, to) = (self.facing.start, self.facing.end);
        let knots = self.parts.iter().flat_map(Section::knots).map(|roll| self.position(*roll));
        let step = (to - from) / FINEST as f64;
        let between = (1..FINEST).map(|at| from + step * at as f64);
        let inner = knots.filter(|place| *place > from && *place < to);
        let mut places: Vec<f64> = inner.chain(between).chain(self.cuts.iter().copied()).collect();
        places.sort_by(f64::total_cmp);
        places.dedup_by(|next, kept| *next - *kept <= CLOSEST * step);
        if self.is_point {
            places.reverse();
        }
        let rolls: Vec<f64> = places.iter().map(|place| self.roll(*place)).collect();
        let depths: Vec<f64> = places.iter().map(|place| self.sum(*place)).collect();
        Spline::new(&rolls, &depths)
    }
}
