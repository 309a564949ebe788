//! Where contact is resolved: the tips of both teeth, which a pair passes at the ends of its path.
//!
//! Must not know: modification, load.

use super::path::Path;
use crate::gear::compliance::{Inclined, PairCompliance};
use crate::gear::contact::flattening::{Bodies, combined_radius};
use crate::gear::contact::tip::{Corner, Tips, Turned};
use crate::gear::contact::wedge::Wedge;
use crate::gear::geometry::{GearPair, Side};
use crate::numeric::chebyshev::Series;
use crate::numeric::graded::Graded;

/// Roll angle below which compliances are taken not to change any faster along the flank.
const STRAIGHTEST: f64 = 0.01;

/// Against the path position.
#[derive(Clone, Debug)]
pub(super) struct Ends {
    wedges: [Wedge; 2],
    /// B \[1/Pa\].
    rates: [f64; 2],
    /// From the corners along the flanks \[m\].
    distances: [Graded; 2],
    half_width: Graded,
    /// Of the loads at the corners \[rad\].
    inclinations: [Graded; 2],
    /// What inclined loads do, per width: of the teeth, and of B \[1/Pa\].
    inclined: [[[f64; 2]; 2]; 2],
    /// By how much both teeth yield more, per width, to a load that is farther from the pinion's root, along the flanks
    /// \[1/(Pa m)\].
    slope: Graded,
    /// k₀ \[1/Pa\].
    linear: f64,
    /// m.
    module: f64,
    /// Half the width up to which the surfaces are half planes \[m\].
    widest: f64,
}

impl Ends {
    pub(super) fn new(pair: &GearPair, compliance: &PairCompliance, path: &Path) -> Self {
        let bodies = Bodies::of(pair, compliance.plane);
        let rates = [compliance.pinion.corner, compliance.gear.corner];
        let face_width = pair.pinion.specification.face_width.min(pair.gear.specification.face_width);
        let inclined = [&compliance.pinion, &compliance.gear].map(|tooth| {
            let of = |inclined: &Inclined| [inclined.own.map(|own| own * face_width), inclined.corner];
            tooth.inclined.as_ref().map_or([[0.0; 2]; 2], of)
        });
        // Along the flank a roll angle grows by one over the radius of curvature.
        let slopes =
            [&compliance.pinion, &compliance.gear].map(|tooth| tooth.total_series().map(|total| total.derivative()));
        let slope = |s: f64| {
            let (rolls, [pinion, gear]) = (path.rolls(s), path.radii(s));
            let of = |side: usize, roll: f64, radius: f64, base: f64| {
                // At the base circle a flank has no curvature, and tables end where it begins.
                let held = |slope: &Series| slope.value(roll.clamp(slope.lower(), slope.upper()));
                slopes[side].as_ref().map_or(0.0, held) / libm::hypot(radius, STRAIGHTEST * base)
            };
            let [first, second] = [&pair.pinion, &pair.gear].map(|gear| gear.base_radius);
            face_width * (of(0, rolls.0, pinion, first) - of(1, rolls.1, gear, second))
        };
        let fit = |function: &dyn Fn(f64) -> f64| path.fit(0.0, function).unwrap_or_default();
        Self {
            wedges: rates.map(|rate| Wedge::new(rate / bodies.linear())),
            rates,
            distances: [Side::Pinion, Side::Gear].map(|side| fit(&|s| path.corner_distance(side, s))),
            half_width: fit(&|s| bodies.half_width(combined_radius(path.radii(s)))),
            inclinations: [Side::Pinion, Side::Gear].map(|side| fit(&|s| path.inclination(side, s))),
            inclined,
            slope: fit(&slope),
            linear: bodies.linear(),
            module: pair.pinion.specification.module,
            widest: compliance.pinion.contact_depth.value(0.0).min(compliance.gear.contact_depth.value(0.0)),
        }
    }

    /// The tips of a pair there.
    pub(super) fn tips(&self, s: f64) -> Tips<'_> {
        let half_width = self.half_width.value(s);
        // b_H² = 2 k₀ p ρ.
        let curvature = 2.0 * self.linear / (half_width * half_width);
        let slope = self.slope.value(s);
        let corner = |side: usize| {
            let (distance, [own, of_corner]) = (self.distances[side].value(s), self.inclined[side]);
            let inclination = if distance < 0.0 { self.inclinations[side].value(s) } else { 0.0 };
            Corner {
                wedge: &self.wedges[side],
                rate: self.rates[side] + Inclined::added(of_corner, inclination),
                turned: Turned {
                    // Away from the corner of its tip the gear's load goes to the root, and the pinion's to the tip.
                    tooth: Inclined::rate(own, inclination) + 0.5 * if side == 0 { -slope } else { slope } / curvature,
                    rate: Inclined::rate(of_corner, inclination),
                    curvature,
                },
                distance,
            }
        };
        Tips { corners: [corner(0), corner(1)], half_width, unit: self.module, widest: self.widest }
    }
}
