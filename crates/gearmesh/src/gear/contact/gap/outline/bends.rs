//! How far splines bend back, how far profiles bend at all, and their depths at places for a scan.
//!
//! Must not know: the other flank.

use super::{Outline, SAMPLES, share};
use crate::gear::modification::section::Section;

/// Parts of the path in each of which it is known how far a spline bends back.
pub(in super::super) const PARTS: usize = 32;

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

    /// The least second derivative of a spline in each of equal parts of the path \[1/m\], not above 0; none where a part of the profile
    /// does not know its own.
    pub(in super::super) fn least_bends(&self) -> Option<[f64; PARTS]> {
        let mut least = [0.0_f64; PARTS];
        if !self.is_sampled {
            return Some(least);
        }
        let (from, to) = (self.facing.start, self.facing.end);
        let [at_zero, rate] = self.rolls;
        // Parts in a roll angle, and the first one's begin.
        let per_part = PARTS as f64 / (to - from);
        let (per_roll, begin) = (per_part / rate, at_zero + rate * from);
        self.visit_bends(|roll, bend| {
            if bend >= 0.0 {
                return;
            }
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a share
            let part = (((roll - begin) * per_roll) as u32 as usize).min(PARTS - 1);
            least[part] = if bend < least[part] { bend } else { least[part] };
        })?;
        Some(least)
    }

    /// On how many stretches it bends back by more than that \[1/m\], which begin a part of the path from each other: what rings about a kink is
    /// one. None where a part of it does not know its own.
    pub(in super::super) fn crests(&self, most: f64) -> usize {
        let apart = self.rolls[1].abs() * (self.facing.end - self.facing.start) / PARTS as f64;
        let (mut crests, mut on_crest, mut last) = (0, false, f64::INFINITY);
        let known = self.visit_bends(|roll, bend| {
            let bends_back = bend < -most;
            if bends_back && !on_crest && (roll - last).abs() > apart {
                (crests, last) = (crests + 1, roll);
            }
            on_crest = bends_back;
        });
        if known.is_some() { crests } else { 0 }
    }

    /// The least second derivative anywhere \[1/m\], not above 0, if it is known at once.
    pub(in super::super) fn least_bend(&self) -> Option<f64> {
        let [_, rate] = self.rolls;
        match &self.spline {
            Some(spline) => Some((spline.least_bend() * rate * rate).min(0.0)),
            None => (!self.is_sampled).then_some(0.0),
        }
    }

    /// The largest second derivative \[1/m\], not below 0, as far as knots and a few places of every piece tell.
    pub(in super::super) fn most_bend(&self) -> f64 {
        if let Some(spline) = &self.spline {
            let [_, rate] = self.rolls;
            return (spline.most_bend() * rate * rate).max(0.0);
        }
        let mut most = 0.0_f64;
        let is_known = self.visit_bends(|_, bend| most = most.max(bend)).is_some();
        let count = if is_known { SAMPLES } else { super::WAVE_SAMPLES };
        for (piece, ends) in self.cuts.windows(2).enumerate() {
            let bends = (0..=count).map(|at| self.rates(share(ends, at, count), piece)[2]);
            most = bends.fold(most, f64::max);
        }
        most
    }

    /// Depth, slope and bend of what is a spline alone, beyond whose ends it is held; of anything else those of its piece.
    #[inline]
    pub(in super::super) fn held_rates(&self, position: f64) -> [f64; 3] {
        let Some(spline) = &self.spline else { return self.rates(position, self.piece(position)) };
        let [at_zero, rate] = self.rolls;
        let [depth, slope, bend] = spline.held_rates(at_zero + rate * position);
        [depth, slope * rate, bend * rate * rate]
    }

    /// By how much the slope grows at a cut, at the most, not below 0.
    pub(in super::super) fn most_kink(&self) -> f64 {
        let kink = |cut: usize| self.rates(self.cuts[cut], cut)[1] - self.rates(self.cuts[cut], cut - 1)[1];
        (1..self.pieces()).map(kink).fold(0.0, f64::max)
    }

    /// How short its waves are: over 2π of what is one spline, and the distance of knots of several.
    pub(in super::super) fn shortest(&self) -> f64 {
        let [_, rate] = self.rolls;
        if let Some(spline) = &self.spline {
            return spline.shortest() / rate.abs();
        }
        let knots = self.parts.iter().map(|part| part.knots().len()).max().unwrap_or(0);
        (self.facing.end - self.facing.start) / knots.max(1) as f64
    }

    /// Between which positions it lies.
    pub(in super::super) fn range(&self) -> [f64; 2] {
        [self.facing.start, self.facing.end]
    }

    /// The depths at so many places in equal steps along the flank of a gear with this base radius, counted from its base circle; beyond its
    /// ends those at its ends.
    #[allow(clippy::cast_possible_truncation)] // of single precision
    pub(in super::super) fn depths(&self, base_radius: f64, [first, step]: [f64; 2], count: usize) -> Vec<f32> {
        // Half the square of the roll angle times the base radius is the length.
        let per_length = 2.0 / base_radius;
        if let (Some(spline), false) = (&self.spline, self.is_point) {
            return spline.at_roots([first * per_length, step * per_length], count);
        }
        let [from, to] = self.range();
        let place = |at: usize| base_radius * (per_length * (first + step * at as f64)).max(0.0).sqrt();
        (0..count).map(|at| self.depth(place(at).clamp(from, to)) as f32).collect()
    }
}
