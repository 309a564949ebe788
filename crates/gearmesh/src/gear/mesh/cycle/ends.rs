//! Where contact is resolved: the tips of both teeth, which a pair passes at the ends of its path.
//!
//! Must not know: modification, load.

use super::closed::Closed;
use super::path::Path;
use crate::gear::compliance::inclined::Inclined;
use crate::gear::compliance::{PairCompliance, ToothCompliance};
use crate::gear::contact::flattening::{Bodies, combined_radius};
use crate::gear::contact::rounding::Rounding;
use crate::gear::contact::tip::{Corner, Ended, Far, Shape, Tips, Turned};
use crate::gear::contact::wedge::Wedge;
use crate::gear::geometry::{GearPair, Side};
use crate::numeric::chebyshev::Series;
use crate::numeric::graded::Graded;

/// Roll angle below which compliances are taken not to change any faster along the flank.
const STRAIGHTEST: f64 = 0.01;

/// Against the path position.
#[derive(Clone, Debug)]
pub(in crate::gear::mesh) struct Ends {
    shapes: [Shape; 2],
    /// B \[1/Pa\].
    rates: [f64; 2],
    /// From the corners along the flanks \[m\].
    distances: [Closed; 2],
    half_width: Closed,
    rounded: [Option<Rounded>; 2],
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

/// A rounding, and the corner that it takes away.
#[derive(Clone, Debug)]
struct Rounded {
    /// What the tooth yields more on its way to that corner \[1/Pa\].
    softened: Graded,
    /// How far that corner is from the end of the flank \[m\].
    distance: f64,
    /// Its B \[1/Pa\].
    rate: f64,
}

impl Ends {
    pub(in crate::gear::mesh) fn new(pair: &GearPair, compliance: &PairCompliance, path: &Path) -> Self {
        let bodies = Bodies::of(pair, compliance.plane);
        let corners = [compliance.pinion.corner, compliance.gear.corner];
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
        // The same all over the flank; no series is good beyond it.
        let depth = |tooth: &ToothCompliance| tooth.contact_depth.value(tooth.contact_depth.lower());
        let shapes = [(Side::Pinion, pair.end_of_contact), (Side::Gear, pair.start_of_contact)].map(|(side, end)| {
            let radius = pair.side(side).flank_end.radius;
            if radius > 0.0 {
                let radii = path.radii(end);
                let (own, mate) = (radii[side as usize], radii[side.other() as usize]);
                return Shape::Rounding(Rounding::new(combined_radius([radius, mate]) / combined_radius([own, mate])));
            }
            Shape::Corner(Box::new(Wedge::new(corners[side as usize] / bodies.linear())))
        });
        let module = pair.pinion.specification.module;
        let rounded = [(Side::Pinion, pair.end_of_contact), (Side::Gear, pair.start_of_contact)].map(|(side, end)| {
            let (gear, rate) = (pair.side(side), corners[side as usize]);
            if gear.flank_end.radius <= 0.0 {
                return None;
            }
            let tip = gear.base_radius * gear.last_corner().roll;
            let distance = |s: f64| {
                let here = path.radii(s)[side as usize];
                0.5 * (tip - here) * (tip + here) / gear.base_radius
            };
            let softened = |s: f64| {
                let rate = rate + Inclined::added(inclined[side as usize][1], path.inclination(side, s));
                -rate * libm::log(distance(s) / module)
            };
            Some(Rounded { softened: fit(&softened), distance: distance(end), rate })
        });
        Self {
            shapes,
            rates: [0, 1].map(|side| if rounded[side].is_some() { 0.0 } else { corners[side] }),
            rounded,
            distances: [Side::Pinion, Side::Gear].map(|side| Closed::distance(path, side)),
            half_width: Closed::half_width(path, bodies.half_width(1.0)),
            inclinations: [Side::Pinion, Side::Gear].map(|side| fit(&|s| path.inclination(side, s))),
            inclined,
            slope: fit(&slope),
            linear: bodies.linear(),
            module,
            widest: depth(&compliance.pinion).min(depth(&compliance.gear)),
        }
    }

    /// The tips of a pair where flanks touch on the line of action and none is rounded.
    #[inline]
    fn inside(&self, s: f64) -> Tips<'_> {
        let half_width = self.half_width.inside(s);
        let per_curvature = half_width * half_width * 0.5 / self.linear;
        let curvature = 1.0 / per_curvature;
        let slope = self.slope.value(s);
        let corner = |side: usize| {
            let [own, of_corner] = self.inclined[side];
            let inwards = if side == 0 { -slope } else { slope };
            Corner {
                shape: &self.shapes[side],
                rate: self.rates[side],
                softened: 0.0,
                turned: Turned { tooth: own[0] + 0.5 * inwards * per_curvature, rate: of_corner[0], curvature },
                distance: self.distances[side].inside(s),
            }
        };
        Tips { corners: [corner(0), corner(1)], half_width, unit: self.module, widest: self.widest }
    }

    #[inline]
    fn is_inside(&self, s: f64) -> bool {
        self.half_width.is_inside(s) && self.rounded[0].is_none() && self.rounded[1].is_none()
    }
}

impl Ended for Ends {
    #[inline]
    fn far(&self, s: f64, rate: f64) -> Far {
        if self.is_inside(s) { Far::of(&self.inside(s), rate) } else { Far::of(&self.tips(s), rate) }
    }

    fn tips(&self, s: f64) -> Tips<'_> {
        if self.is_inside(s) {
            return self.inside(s);
        }
        let half_width = self.half_width.value(s);
        // b_H² = 2 k₀ p ρ.
        let curvature = 2.0 * self.linear / (half_width * half_width);
        let slope = self.slope.value(s);
        let corner = |side: usize| {
            let (distance, [own, of_corner]) = (self.distances[side].value(s), self.inclined[side]);
            let inclination = if distance < 0.0 { self.inclinations[side].value(s) } else { 0.0 };
            // Away from the corner of its tip the gear's load goes to the root, and the pinion's to the tip.
            let inwards = if side == 0 { -slope } else { slope };
            let (turn, of_turn) = (Inclined::rate(own, inclination), Inclined::rate(of_corner, inclination));
            let corner = Corner {
                shape: &self.shapes[side],
                rate: self.rates[side],
                softened: 0.0,
                turned: Turned { tooth: turn + 0.5 * inwards / curvature, rate: of_turn, curvature },
                distance,
            };
            let Some(Rounded { softened, distance, rate }) = &self.rounded[side] else {
                return Corner { rate: corner.rate + Inclined::added(of_corner, inclination), ..corner };
            };
            let turn = turn - of_turn * libm::log(distance / self.module);
            let tooth = turn + 0.5 * (inwards - rate / distance) / curvature;
            Corner { softened: softened.value(s), turned: Turned { tooth, rate: 0.0, curvature }, ..corner }
        };
        Tips { corners: [corner(0), corner(1)], half_width, unit: self.module, widest: self.widest }
    }
}
