//! The law of two flanks at one place whose tips are near: approach and load per width.
//!
//! A contact that is resolved has w = p [C + α − β ln p + Σ T], with the compliance C of both teeth, the law of half planes
//! p (α − β ln p), and for the tip of each tooth T, which is −B ln(c/m) far from its corner, at the distance c along the
//! flank, and what [`Wedge`] has near it and beyond. Must not know: how teeth bend, where on the path this is.

use std::cell::OnceCell;
use std::fmt::Debug;

use super::rounding::Rounding;
use super::wedge::{Rates, Spread, Wedge};

/// Newton's method stops here, in ln p: the error that is left is of second order in it.
const CLOSE: f64 = 1e-8;
/// Its most steps; about three are taken.
const STEPS: usize = 50;

/// What a flank ends in.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Of the ratio B/k₀ = B/2β.
    Corner(Box<Wedge>),
    /// With B = 0.
    Rounding(Rounding),
}

impl Shape {
    /// By how much flanks approach more there, over k₀ p and beside the least gap, and its slope over λ.
    #[must_use]
    pub fn more(&self, place: f64) -> [f64; 2] {
        match self {
            Self::Corner(wedge) => wedge.more(place),
            Self::Rounding(rounding) => rounding.more(place),
        }
    }

    /// The same where ln|λ| is known, of another ratio B/k₀ for an inclined load beyond the corner; and what the turn of the
    /// other flank's normal along the contact adds, as [`Wedge::turned`] has it.
    fn rates(&self, place: f64, log: f64, ratio: f64) -> ([f64; 2], [[f64; 2]; 2]) {
        let wedge = match self {
            Self::Corner(wedge) => wedge,
            Self::Rounding(rounding) => return (rounding.more(place), rounding.turned(place)),
        };
        let Rates { more: [more, slope], by_ratio: [by_ratio, by_ratio_slope], turned } = wedge.rates(place, log);
        let change = if place < 0.0 { ratio - wedge.ratio() } else { 0.0 };
        ([more + change * by_ratio, slope + change * by_ratio_slope], turned)
    }

    /// How a contact there spreads, against that of half planes.
    #[must_use]
    pub fn spread(&self, place: f64) -> Spread {
        match self {
            Self::Corner(wedge) => wedge.spread(place),
            Self::Rounding(rounding) => rounding.spread(place),
        }
    }

    /// What is left of it far inside, besides −B/k₀ ln λ, times λ².
    fn rest(&self) -> f64 {
        match self {
            Self::Corner(wedge) => wedge.rest(),
            Self::Rounding(_) => 0.0,
        }
    }

    /// λ from which on that is all.
    fn far(&self) -> f64 {
        match self {
            Self::Corner(_) => Wedge::far(),
            Self::Rounding(_) => Rounding::far(),
        }
    }
}

/// The tip of one of the teeth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner<'a> {
    /// What the flank ends in.
    pub shape: &'a Shape,
    /// B \[1/Pa\]; where the load is inclined at the corner, of that load.
    pub rate: f64,
    /// What the load's inclination does as it changes along the contact.
    pub turned: Turned,
    /// c: how far from the end the flanks would touch without load \[m\], along the flank; negative beyond it.
    pub distance: f64,
    /// What the tooth yields more on its way to a corner that a rounding takes away \[1/Pa\]; 0 at a corner that is there.
    pub softened: f64,
}

/// A load is along the normal of the other flank, which turns along the contact: half of what a compliance gains per angle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turned {
    /// D: that of the tooth, at the corner and without the part of B \[1/Pa\].
    pub tooth: f64,
    /// D_B: that of B \[1/Pa\].
    pub rate: f64,
    /// 1/ρ of the contact \[1/m\]: how fast it turns.
    pub curvature: f64,
}

/// Those of both teeth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tips<'a> {
    /// Pinion and gear.
    pub corners: [Corner<'a>; 2],
    /// Half the width of the contact over the square root of the load per width.
    pub half_width: f64,
    /// The length that distances are compared with \[m\].
    pub unit: f64,
    /// Half the width up to which the law holds \[m\]: beyond, it is continued by its tangent.
    pub widest: f64,
}

impl Corner<'_> {
    /// What the turn of the load adds to w/p over the square of half the width, where the corner is far; `log`: ln(c/m).
    fn turned_far(&self, log: f64) -> f64 {
        let Shape::Corner(wedge) = self.shape else { return 0.0 };
        let Turned { tooth, rate, curvature } = self.turned;
        let ([g, h, log_place], place) = (wedge.turned_far(), 2.0 * Wedge::far());
        curvature * place / self.distance * ((tooth - rate * (log - log_place)) * g - rate * h)
    }

    /// What the turn of the load along the contact adds to w/p, and its slope over ln p, where half the width is so much, with
    /// the logarithm of it over the unit, and the corner does that.
    fn turned(&self, width: f64, log_width: f64, [[g, h], [by_place, h_by_place]]: [[f64; 2]; 2]) -> [f64; 2] {
        let Turned { tooth, rate, curvature } = self.turned;
        if curvature == 0.0 {
            return [0.0; 2];
        }
        let (share, here) = (width * curvature, tooth - rate * log_width);
        let added = share * (here * g - rate * h);
        // Half the width grows as √p, and λ falls as it grows.
        let moved = self.distance / width * (here * by_place - rate * h_by_place);
        [added, 0.5 * (added - share * (rate * g + moved))]
    }
}

/// A value and its slope, held below twice a size that it hardly ever reaches: it is of first order, and where it is as large
/// as the half planes' own change a law would end that it is only to correct.
fn held([value, slope]: [f64; 2], size: f64) -> [f64; 2] {
    let over = value.abs() / size - 1.0;
    if over <= 0.0 {
        return [value, slope];
    }
    let share = 1.0 + over;
    [value.signum() * size * (1.0 + over / share), slope / (share * share)]
}

/// Who knows the tips of both teeth wherever a pair may touch.
pub trait Ended: Debug + Sync {
    /// The tips of a pair at a place \[m\].
    fn tips(&self, s: f64) -> Tips<'_>;

    /// What they add where they are far, to a law with the rate β: [`Far::of`] its tips.
    fn far(&self, s: f64, rate: f64) -> Far {
        Far::of(&self.tips(s), rate)
    }
}

/// What tips add to a law as long as they are far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Far {
    /// What roundings add to the compliance of both teeth \[1/Pa\].
    softened: f64,
    /// The same, with Σ −B ln(c/m) of those that are not beyond.
    compliance: f64,
    /// What the rest of Ψ, which falls as 1/λ², adds to the compliance per load where both corners are far.
    rest: f64,
    /// The load per width up to which they are.
    last: f64,
    /// The load per width from which on the law is continued by its tangent.
    largest: f64,
}

impl Far {
    /// At the rate β.
    #[must_use]
    #[inline]
    pub fn of(tips: &Tips, rate: f64) -> Self {
        let Tips { corners, half_width, unit, widest } = tips;
        let per_half_width = 1.0 / half_width;
        let root = widest * per_half_width;
        let largest = root * root;
        let softened = corners[0].softened + corners[1].softened;
        let mut far = Self { softened, compliance: softened, rest: 0.0, last: largest, largest };
        for corner in corners {
            // A contact as wide as a tenth of it.
            let reach = corner.distance.max(0.0) * per_half_width / corner.shape.far();
            far.last = far.last.min(reach * reach);
            if corner.distance > 0.0 {
                let share = half_width / corner.distance;
                let log = libm::log(corner.distance / unit);
                far.compliance -= corner.rate * log;
                far.rest += 2.0 * rate * corner.shape.rest() * share * share;
                far.rest += half_width * half_width * corner.turned_far(log);
            }
        }
        far
    }
}

impl Far {
    /// What they add to the compliance of both teeth, and to that per load, up to which load per width.
    #[must_use]
    pub const fn parts(&self) -> ([f64; 2], f64) {
        ([self.compliance, self.rest], self.last)
    }
}

/// Tips, and logarithms that no load changes: of half the width over the unit, without the root of the load, and of how far
/// the corners are or how far beyond.
#[derive(Clone, Debug)]
struct Known<'a> {
    tips: Tips<'a>,
    half_width: f64,
    distances: [f64; 2],
}

impl<'a> Known<'a> {
    fn of(tips: Tips<'a>) -> Self {
        let of_unit = |length: f64| libm::log(length / tips.unit);
        let distances = tips.corners.map(|corner| of_unit(corner.distance.abs()));
        Self { half_width: of_unit(tips.half_width), distances, tips }
    }
}

/// C, α and β of a law where tips are far.
#[derive(Clone, Copy)]
pub(super) struct FarLaw {
    pub compliance: f64,
    pub constant: f64,
    pub rate: f64,
}

/// The tips of a law, prepared for many loads.
#[derive(Clone, Debug)]
pub(super) struct NearTips<'a> {
    /// Who knows them, and where; they are needed only where one is near.
    at: Option<(&'a dyn Ended, f64)>,
    tips: OnceCell<Box<Known<'a>>>,
    /// C, with what roundings add.
    compliance: f64,
    far: Far,
}

impl<'a> NearTips<'a> {
    /// At the rate β, with the compliance C of both teeth.
    pub(super) fn new(tips: Tips<'a>, rate: f64, compliance: f64) -> Self {
        let far = Far::of(&tips, rate);
        Self { at: None, tips: OnceCell::from(Box::new(Known::of(tips))), compliance: compliance + far.softened, far }
    }

    /// The same of the tips at a place.
    #[inline]
    pub(super) fn at(ends: &'a dyn Ended, far: Far, s: f64, compliance: f64) -> Self {
        Self { at: Some((ends, s)), tips: OnceCell::new(), compliance: compliance + far.softened, far }
    }

    /// What they add to the compliance of both teeth where they are far.
    pub(super) fn far(&self) -> f64 {
        self.far.compliance
    }

    fn tips(&self) -> &Known<'a> {
        self.tips.get_or_init(|| {
            let (ends, s) = self.at.expect("tips are given, or where they are");
            Box::new(Known::of(ends.tips(s)))
        })
    }

    /// w/p at a load per width with the logarithm `log`, and its slope over ln p.
    fn whole(&self, law: FarLaw, load: f64, log: f64) -> [f64; 2] {
        let (rate, Known { tips, half_width, distances }) = (law.rate, self.tips());
        let (width, log_width) = (tips.half_width * load.sqrt(), half_width + 0.5 * log);
        let start = [self.compliance + law.constant - rate * log, -rate];
        tips.corners.iter().zip(distances).fold(start, |[sum, slope], (corner, log_distance)| {
            let place = corner.distance / width;
            let ([more, by_place], turned) =
                corner.shape.rates(place, log_distance - log_width, 0.5 * corner.rate / rate);
            let [turned, by_log] = held(corner.turned(width, log_width, turned), 0.5 * rate);
            let added = 2.0 * rate * more - corner.rate * log_width + turned;
            [sum + added, slope - rate * by_place * place - 0.5 * corner.rate + by_log]
        })
    }

    /// The penetration at a load per width > 0 whose logarithm is `log`, its slope, the slope of that without what is known of
    /// tips that are near, and whether one is.
    #[inline]
    pub(super) fn at_load(&self, law: FarLaw, load: f64, log: f64) -> ([f64; 3], bool) {
        let rate = law.rate;
        if load < self.far.last {
            let rest = self.far.rest * load;
            let total = law.compliance + law.constant - rate * log + rest;
            return ([load * total, total - rate + rest, (2.0 * rest - rate) / load], false);
        }
        let (held, log) =
            if load > self.far.largest { (self.far.largest, libm::log(self.far.largest)) } else { (load, log) };
        let [total, slope] = self.whole(law, held, log);
        ([held * total + (load - held) * (total + slope), total + slope, -rate / load], true)
    }

    /// Load per width and its slope at the penetration w > 0, where without the tips they would be `load` and its own.
    pub(super) fn load(&self, law: FarLaw, penetration: f64, load: f64) -> (f64, f64) {
        let Far { rest, last: last_far, largest, .. } = self.far;
        let rate = law.rate;
        if load < last_far {
            // What grows with the load is small: two steps of Newton's method.
            let (start, mut load) = (load, load);
            for _ in 0..2 {
                let here = penetration / start - rate * libm::log(load / start) + rest * load;
                load += (penetration - load * here) / (here - rate + rest * load);
            }
            if load < last_far {
                return (load, 1.0 / (penetration / load - rate + rest * load));
            }
        }
        let mut load = load.min(largest);
        let wanted = libm::log(penetration);
        for _ in 0..STEPS {
            let log = libm::log(load);
            let [total, slope] = self.whole(law, load, log);
            let step = (wanted - log - libm::log(total)) / (1.0 + slope / total);
            let next = load * libm::exp(step);
            if next >= largest {
                let [total, slope] = self.whole(law, largest, libm::log(largest));
                let beyond = penetration - largest * total;
                if beyond >= 0.0 {
                    return (largest + beyond / (total + slope), 1.0 / (total + slope));
                }
            }
            load = next.min(largest);
            if step.abs() <= CLOSE {
                break;
            }
        }
        let [total, slope] = self.whole(law, load, libm::log(load));
        (penetration / total, 1.0 / (total + slope))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::contact::flattening::{InSeries, Logarithmic};
    use crate::gear::fixtures::STEELS;

    fn series(shapes: &[Shape; 2], distances: [f64; 2]) -> InSeries<'_> {
        let law = Logarithmic::half_planes(&STEELS, 7e-3, [0.75e-3; 2]);
        let corner = |side: usize| Corner {
            shape: &shapes[side],
            rate: if matches!(shapes[side], Shape::Corner(_)) { [0.15, 0.35][side] * 2.0 * law.rate } else { 0.0 },
            turned: Turned { tooth: -[0.2, 1.0][side] * 1e-11, rate: -[2e-13, 1e-12][side], curvature: 1.0 / 7e-3 },
            distance: distances[side],
            softened: if matches!(shapes[side], Shape::Corner(_)) { 0.0 } else { 1e-12 },
        };
        let tips =
            Tips { corners: [corner(0), corner(1)], half_width: STEELS.half_width(7e-3), unit: 3e-3, widest: 0.75e-3 };
        law.in_series(5e-11).at_tips(tips)
    }

    const DISTANCES: [[f64; 2]; 9] = [
        [5e-3, 4e-3],
        [5e-3, 1e-3],
        [5e-3, 1e-4],
        [5e-3, 1e-6],
        [5e-3, 0.0],
        [5e-3, -1e-9],
        [5e-3, -1e-4],
        [5e-3, -1e-3],
        [1e-4, 2e-4],
    ];

    /// Tier: invariant; the load has the penetration that it was found from, however near the corners are, and its slope is
    /// that of differences.
    #[test]
    fn the_law_inverts_at_every_load() {
        let wedges = [0.15, 0.35].map(|ratio| Shape::Corner(Box::new(Wedge::new(ratio))));
        let roundings = [0.05, 0.3].map(|ratio| Shape::Rounding(Rounding::new(ratio)));
        let mixed = [wedges[0].clone(), roundings[1].clone()];
        let cases = [&wedges, &roundings, &mixed].map(|shapes| DISTANCES.map(|distances| (shapes, distances)));
        for (shapes, distances) in cases.into_iter().flatten() {
            let series = series(shapes, distances);
            let mut before = 0.0;
            for exponent in -60..=40 {
                let load = libm::pow(10.0, f64::from(exponent) * 0.2 + 2.0);
                let penetration = series.penetration(load);
                assert!(penetration > before, "monotonic at {load} {distances:?}");
                before = penetration;
                let (found, slope) = series.load(penetration);
                assert!((found / load - 1.0).abs() < 1e-9, "{distances:?}: {found} for {load}");
                let step = 1e-4 * penetration;
                let difference = series.load(penetration + step).0 - series.load(penetration - step).0;
                let ratio = difference / (2.0 * step) / slope;
                assert!((ratio - 1.0).abs() < 2e-5, "{distances:?}: slope at {load}: {ratio}");
            }
        }
    }
}
