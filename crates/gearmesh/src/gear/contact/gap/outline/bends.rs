//! How far splines bend back, how far profiles bend at all, and their depths at places for a scan.
//!
//! Must not know: the other flank.

use super::{Convexity, Outline, SAMPLES, share};
use crate::gear::modification::section::Section;

/// Parts of the path in each of which it is known how far a spline bends back.
const PARTS: usize = 32;

/// How far a profile bends back along the path.
#[derive(Clone, Debug)]
pub(in super::super) struct Back {
    /// The least second derivative in each of equal parts \[1/m\], not above 0; without bound where it kinks back, or nobody knows.
    least: [f64; PARTS],
    pub(in super::super) crests: usize,
    from: f64,
    per_length: f64,
}

impl Back {
    fn part(&self, position: f64) -> usize {
        part((position - self.from) * self.per_length)
    }

    fn lower(&mut self, ends: [f64; 2], bend: f64) {
        let [first, last] = ends.map(|end| self.part(end));
        for least in &mut self.least[first..=last] {
            *least = least.min(bend);
        }
    }

    /// The least between two positions.
    pub(in super::super) fn between(&self, ends: [f64; 2]) -> f64 {
        let [first, last] = ends.map(|end| self.part(end));
        self.least[first..=last].iter().copied().fold(0.0, f64::min)
    }
}

/// The part that a number of parts ends in.
#[inline]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // what is below 0 is 0
fn part(parts: f64) -> usize {
    (parts as u32 as usize).min(PARTS - 1)
}

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

    /// How far it bends back in parts of the path, and on how many stretches by more than `most` \[1/m\], which begin a part from each other:
    /// what rings about a kink is one.
    pub(in super::super) fn least_bends(&self, most: f64) -> Back {
        let (from, to) = (self.facing.start, self.facing.end);
        let per_length = PARTS as f64 / (to - from);
        let mut back = Back { least: [0.0; PARTS], crests: 0, from, per_length };
        let [at_zero, rate] = self.rolls;
        let (per_roll, begin) = (per_length / rate, at_zero + rate * from);
        let (mut on_crest, mut last) = (false, f64::INFINITY);
        let known = self.visit_bends(|roll, bend| {
            if bend >= 0.0 {
                on_crest = false;
                return;
            }
            let parts = (roll - begin) * per_roll;
            let least = &mut back.least[part(parts)];
            *least = if bend < *least { bend } else { *least };
            let is_crest = bend < -most;
            if is_crest && !on_crest && (parts - last).abs() > 1.0 {
                (back.crests, last) = (back.crests + 1, parts);
            }
            on_crest = is_crest;
        });
        if known.is_none() {
            return Back { least: [f64::NEG_INFINITY; PARTS], crests: 0, ..back };
        }
        for cut in self.kinks_back() {
            back.lower([cut, cut], f64::NEG_INFINITY);
        }
        for (piece, ends) in
            self.pieces.iter().zip(self.cuts.windows(2)).filter(|(piece, _)| piece.shape == Convexity::Other)
        {
            let bend = piece.quadratic.map_or(f64::NEG_INFINITY, |quadratic| 2.0 * quadratic.coefficients[2]);
            back.lower([ends[0], ends[1]], bend);
        }
        back
    }

    /// Visits the ends of stretches of positions, ascending from where it begins, with what it is no less than on each \[m\], but for so much.
    pub(in super::super) fn visit_least(&self, negligible: f64, mut visit: impl FnMut(f64, f64)) {
        if let Some(spline) = &self.spline {
            let [at_zero, rate] = self.rolls;
            let per_rate = 1.0 / rate;
            let [low, high] = spline.ends();
            visit((low - at_zero) * per_rate, spline.value(low));
            spline.visit_least(negligible, |roll, least| visit((roll - at_zero) * per_rate, least));
            visit(self.facing.end, spline.value(high));
            return;
        }
        let mut knots: Vec<f64> = self.parts.iter().flat_map(Section::knots).map(|roll| self.position(*roll)).collect();
        knots.sort_by(f64::total_cmp);
        for (piece, ends) in self.cuts.windows(2).enumerate() {
            let samples = if self.pieces[piece].quadratic.is_some() { SAMPLES } else { super::WAVE_SAMPLES };
            let mut places: Vec<f64> = (0..=samples).map(|at| share(ends, at, samples)).collect();
            places.extend(knots.iter().filter(|knot| **knot > ends[0] && **knot < ends[1]));
            places.sort_by(f64::total_cmp);
            let rates: Vec<[f64; 3]> = places.iter().map(|place| self.rates(*place, piece)).collect();
            for (places, rates) in places.windows(2).zip(rates.windows(2)) {
                // As of a cubic, in Bernstein's form.
                let third = (places[1] - places[0]) * (1.0 / 3.0);
                let [[before, rise, _], [behind, fall, _]] = [rates[0], rates[1]];
                let least = before.min(behind).min(before + third * rise).min(behind - third * fall);
                visit(places[1], least);
            }
        }
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

    /// The cuts at which the slope grows, and by how much.
    pub(in super::super) fn kinks(&self) -> Vec<(f64, f64)> {
        let slope = |cut: usize, piece: usize| self.rates(self.cuts[cut], piece)[1];
        let kinks = (1..self.pieces()).map(|cut| (self.cuts[cut], slope(cut, cut) - slope(cut, cut - 1)));
        kinks.filter(|(_, kink)| *kink > 0.0).collect()
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
