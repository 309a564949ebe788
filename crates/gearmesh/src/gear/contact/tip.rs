//! The law of two flanks at one place whose tips are near: approach and load per width.
//!
//! A contact that is resolved has w = p [C + α − β ln p + Σ T], with the compliance C of both teeth, the law of half planes
//! p (α − β ln p), and for the tip of each tooth T, which is −B ln(c/m) far from its corner, at the distance c along the
//! flank, and what [`Wedge`] has near it and beyond. Must not know: how teeth bend, where on the path this is.

use super::flattening::InSeries;
use super::wedge::Wedge;

/// Newton's method stops here, in ln p: the error that is left is of second order in it.
const CLOSE: f64 = 1e-8;
/// Its most steps; about three are taken.
const STEPS: usize = 50;

/// The tip of one of the teeth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner<'a> {
    /// Of the ratio B/k₀ = B/2β.
    pub wedge: &'a Wedge,
    /// B \[1/Pa\].
    pub rate: f64,
    /// c: how far from the corner the flanks would touch without load \[m\], along the flank; negative beyond it.
    pub distance: f64,
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

impl Tips<'_> {
    /// What the corners add where they are far: Σ −B ln(c/m), of those that are not beyond.
    #[must_use]
    pub fn far(&self) -> f64 {
        let seen = self.corners.iter().filter(|corner| corner.distance > 0.0);
        seen.map(|corner| -corner.rate * libm::log(corner.distance / self.unit)).sum()
    }

    /// What they add to the compliance at ln p, and its slope over ln p.
    fn added(&self, rate: f64, log: f64) -> [f64; 2] {
        let half_log = 0.5 * log;
        let width = self.half_width * libm::exp(half_log);
        let log_width = libm::log(self.half_width / self.unit) + half_log;
        self.corners.iter().fold([0.0; 2], |[sum, slope], corner| {
            let place = corner.distance / width;
            let [more, by_place] = corner.wedge.more(place);
            [sum + 2.0 * rate * more - corner.rate * log_width, slope - rate * by_place * place - 0.5 * corner.rate]
        })
    }

    /// The load per width from which on the law is continued by its tangent.
    fn largest(&self) -> f64 {
        let root = self.widest / self.half_width;
        root * root
    }

    /// w/p at ln p, and its slope over ln p.
    fn whole(&self, series: &InSeries, log: f64) -> [f64; 2] {
        let rate = series.law.rate;
        let [added, slope] = self.added(rate, log);
        [series.without_tips() + series.law.constant - rate * log + added, slope - rate]
    }

    /// What the rest of Ψ, which falls as 1/λ², adds to the compliance per load where both corners are far.
    fn rest(&self, rate: f64) -> f64 {
        let rest = |corner: &Corner| {
            let share = self.half_width / corner.distance;
            2.0 * rate * corner.wedge.rest() * share * share
        };
        self.corners.iter().map(rest).sum()
    }

    /// Whether both corners are far from a contact of this load per width.
    fn are_far(&self, load: f64) -> bool {
        let width = self.half_width * load.sqrt();
        width < self.widest && self.corners.iter().all(|corner| corner.distance >= Wedge::far() * width)
    }

    /// The penetration at a load per width > 0, and its slope.
    pub(super) fn at_load(&self, series: &InSeries, load: f64) -> (f64, f64) {
        let rate = series.law.rate;
        if self.are_far(load) {
            let rest = self.rest(rate) * load;
            let total = series.compliance + series.law.constant - rate * libm::log(load) + rest;
            return (load * total, total - rate + rest);
        }
        let held = load.min(self.largest());
        let [total, slope] = self.whole(series, libm::log(held));
        (held * total + (load - held) * (total + slope), total + slope)
    }

    /// Load per width and its slope at the penetration w > 0, where without tips they would be `load` and its own.
    pub(super) fn load(&self, series: &InSeries, penetration: f64, load: f64) -> (f64, f64) {
        let largest = self.largest();
        let rate = series.law.rate;
        if self.are_far(load) {
            // The rest of Ψ falls as 1/λ², which is in proportion to p: one step of Newton's method.
            let rest = self.rest(rate);
            let load = load - load * load * rest / (penetration / load - rate + 2.0 * rest * load);
            return (load, 1.0 / (penetration / load - rate + rest * load));
        }
        let most = libm::log(largest);
        let (mut log, wanted) = (libm::log(load).min(most), libm::log(penetration));
        for _ in 0..STEPS {
            let [total, slope] = self.whole(series, log);
            let step = (wanted - log - libm::log(total)) / (1.0 + slope / total);
            if log + step >= most {
                let [total, slope] = self.whole(series, most);
                let rest = penetration - largest * total;
                if rest >= 0.0 {
                    return (largest + rest / (total + slope), 1.0 / (total + slope));
                }
            }
            log = (log + step).min(most);
            if step.abs() <= CLOSE {
                break;
            }
        }
        let [total, slope] = self.whole(series, log);
        (penetration / total, 1.0 / (total + slope))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::contact::flattening::Logarithmic;
    use crate::gear::fixtures::STEELS;

    fn series(wedges: &[Wedge; 2], distances: [f64; 2]) -> InSeries<'_> {
        let law = Logarithmic::half_planes(&STEELS, 7e-3, [0.75e-3; 2]);
        let corner = |side: usize| Corner {
            wedge: &wedges[side],
            rate: [0.15, 0.35][side] * 2.0 * law.rate,
            distance: distances[side],
        };
        let tips =
            Tips { corners: [corner(0), corner(1)], half_width: STEELS.half_width(7e-3), unit: 3e-3, widest: 0.75e-3 };
        law.in_series(5e-11).at_tips(tips)
    }

    /// Tier: invariant; the load has the penetration that it was found from, however near the corners are, and its slope is
    /// that of differences.
    #[test]
    fn the_law_inverts_at_every_load() {
        let wedges = [0.15, 0.35].map(Wedge::new);
        for distances in [
            [5e-3, 4e-3],
            [5e-3, 1e-3],
            [5e-3, 1e-4],
            [5e-3, 1e-6],
            [5e-3, 0.0],
            [5e-3, -1e-9],
            [5e-3, -1e-4],
            [5e-3, -1e-3],
            [1e-4, 2e-4],
        ] {
            let series = series(&wedges, distances);
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
