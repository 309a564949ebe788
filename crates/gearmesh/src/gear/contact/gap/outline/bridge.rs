//! How far splines bend back, and the bridges over their valleys.
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
        let [_, rate] = self.rolls;
        let mut put = |roll: f64, bend: f64| {
            let share = (self.position(roll) - from) / (to - from);
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

    /// Bridges what bends back by more than `bends` (at equal parts of the path, not below 0) allow, as something that is bent the other way
    /// by as much would that is laid over it: the lower hull of the depths and of what bends so. The spline through that is smooth.
    pub(in super::super) fn bridge(&mut self, bends: &[f64; PARTS]) {
        let (from, to) = (self.facing.start, self.facing.end);
        let knots = self.parts.iter().flat_map(Section::knots).map(|roll| self.position(*roll));
        let step = (to - from) / FINEST as f64;
        let between = (1..FINEST).map(|at| from + step * at as f64);
        let inner = knots.filter(|place| *place > from && *place < to);
        let mut places: Vec<f64> = inner.chain(between).chain(self.cuts.iter().copied()).collect();
        places.sort_by(f64::total_cmp);
        places.dedup_by(|next, kept| *next - *kept <= CLOSEST * step);
        // Bent by `bends`: integrated twice, from place to place.
        let (mut slope, mut raised) = (0.0, 0.0);
        let mut lifts = Vec::with_capacity(places.len());
        for (index, place) in places.iter().enumerate() {
            let width = if index > 0 { place - places[index - 1] } else { 0.0 };
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a share of the path
            let part = (((place - from) / (to - from) * PARTS as f64) as usize).min(PARTS - 1);
            raised += width * (slope + 0.5 * width * bends[part]);
            slope += width * bends[part];
            lifts.push(raised);
        }
        let depths: Vec<f64> = places.iter().zip(&lifts).map(|(place, lift)| self.sum(*place) + lift).collect();
        let hull = lower_hull(&places, &depths);
        let mut at = 0;
        let mut points: Vec<[f64; 2]> = Vec::with_capacity(places.len());
        for (index, place) in places.iter().enumerate() {
            if index > hull[at + 1] {
                at += 1;
            }
            let [one, other] = [hull[at], hull[at + 1]];
            let share = (place - places[one]) / (places[other] - places[one]);
            let bridge = depths[one] + share * (depths[other] - depths[one]);
            points.push([self.roll(*place), bridge - lifts[index]]);
        }
        if self.is_point {
            points.reverse();
        }
        let [rolls, values]: [Vec<f64>; 2] = [0, 1].map(|of| points.iter().map(|point| point[of]).collect());
        self.spline = Some(Told::Bridged(Arc::new(Spline::new(&rolls, &values))));
        for piece in &mut self.pieces {
            *piece = Piece { shape: Convexity::Convex, is_held: false, quadratic: None };
        }
    }
}

/// The places, by their number, of the lower convex hull of points whose places ascend; the first and the last are among them.
fn lower_hull(places: &[f64], heights: &[f64]) -> Vec<usize> {
    let mut hull: Vec<usize> = Vec::with_capacity(places.len());
    for next in 0..places.len() {
        while let [.., one, other] = hull[..] {
            let rise = |from: usize, to: usize| (heights[to] - heights[from]) * (places[next] - places[one]);
            let run = |from: usize, to: usize| places[to] - places[from];
            // Below the line from `one` to `next`.
            if rise(one, other) < rise(one, next) / run(one, next) * run(one, other) {
                break;
            }
            hull.pop();
        }
        hull.push(next);
    }
    hull
}
