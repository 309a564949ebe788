//! How far splines bend back.
//!
//! Must not know: the other flank.

use super::Outline;
use crate::gear::modification::section::Section;

/// The share of the path that one crest takes at the least: what rings about a kink is one.
const CREST: f64 = 1.0 / 32.0;

impl Outline<'_> {
    /// Visits all knots of splines that lie on the path: the roll angle, and the second derivative of the profile there over the position,
    /// between two knots straight; none where a part of it does not know its own.
    #[inline]
    fn visit_bends(&self, mut visit: impl FnMut(f64, f64)) -> Option<()> {
        let [at_zero, rate] = self.rolls;
        let ends = [self.facing.start, self.facing.end].map(|position| at_zero + rate * position);
        let (from, to) = if rate > 0.0 { (ends[0], ends[1]) } else { (ends[1], ends[0]) };
        let square = rate * rate;
        let mut put = |roll: f64, bend: f64| {
            if roll >= from && roll <= to {
                visit(roll, bend * square);
            }
        };
        if let Some(spline) = &self.spline {
            spline.visit_bends(put);
            return Some(());
        }
        for roll in self.parts.iter().flat_map(Section::knots) {
            put(*roll, self.parts.iter().try_fold(0.0, |sum, part| Some(sum + part.rates(*roll, *roll)?[2]))?);
        }
        Some(())
    }

    /// On how many stretches a spline bends back by more than `most` \[1/m\], which begin a [`CREST`] from each other.
    pub(in super::super) fn crests(&self, most: f64) -> usize {
        let [_, rate] = self.rolls;
        let closest = CREST * (self.facing.end - self.facing.start) * rate.abs();
        let (mut crests, mut on_crest, mut last) = (0, false, f64::INFINITY);
        let known = self.visit_bends(|roll, bend| {
            let is_crest = bend < -most.max(0.0);
            if is_crest && !on_crest && (roll - last).abs() > closest {
                (crests, last) = (crests + 1, roll);
            }
            on_crest = is_crest;
        });
        known.map_or(0, |()| crests)
    }

    /// The least second derivative anywhere \[1/m\], not above 0, if it is known at once.
    pub(in super::super) fn least_bend(&self) -> Option<f64> {
        let [_, rate] = self.rolls;
        match &self.spline {
            Some(spline) => Some((spline.least_bend() * rate * rate).min(0.0)),
            None => (!self.is_sampled).then_some(0.0),
        }
    }
}
