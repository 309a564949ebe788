//! Where contact is resolved: the tips of both teeth, which a pair passes at the ends of its path.
//!
//! Must not know: modification, load.

use super::closed::Closed;
use super::path::Path;
use crate::gear::compliance::{PairCompliance, ToothCompliance};
use crate::gear::contact::flattening::{Bodies, combined_radius};
use crate::gear::contact::rounding::Rounding;
use crate::gear::contact::tip::{Corner, Shape, Tips};
use crate::gear::contact::wedge::Wedge;
use crate::gear::geometry::{GearPair, Side};
use crate::numeric::graded::Graded;

/// Against the path position.
#[derive(Clone, Debug)]
pub(super) struct Ends {
    shapes: [Shape; 2],
    /// B \[1/Pa\].
    rates: [f64; 2],
    /// From the corners along the flanks \[m\].
    distances: [Closed; 2],
    half_width: Closed,
    /// By corners that roundings take away \[1/Pa\].
    softened: [Option<Graded>; 2],
    /// m.
    module: f64,
    /// Half the width up to which the surfaces are half planes \[m\].
    widest: f64,
}

impl Ends {
    pub(super) fn new(pair: &GearPair, compliance: &PairCompliance, path: &Path) -> Self {
        let bodies = Bodies::of(pair, compliance.plane);
        let corners = [compliance.pinion.corner, compliance.gear.corner];
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
        let is_rounded = |side: Side| pair.side(side).flank_end.radius > 0.0;
        let softened = [Side::Pinion, Side::Gear].map(|side| {
            let (gear, corner) = (pair.side(side), corners[side as usize]);
            let tip = gear.base_radius * gear.last_corner().roll;
            let distance = |here: f64| 0.5 * (tip - here) * (tip + here) / gear.base_radius;
            let module = gear.specification.module;
            let more = |s: f64| -corner * libm::log(distance(path.radii(s)[side as usize]) / module);
            is_rounded(side).then(|| fit(&more))
        });
        Self {
            shapes,
            softened,
            rates: [Side::Pinion, Side::Gear].map(|side| if is_rounded(side) { 0.0 } else { corners[side as usize] }),
            distances: [Side::Pinion, Side::Gear].map(|side| Closed::distance(path, side)),
            half_width: Closed::half_width(path, bodies.half_width(1.0)),
            module: pair.pinion.specification.module,
            widest: depth(&compliance.pinion).min(depth(&compliance.gear)),
        }
    }

    /// The tips of a pair there.
    pub(super) fn tips(&self, s: f64) -> Tips<'_> {
        let corner = |side: usize| Corner {
            shape: &self.shapes[side],
            rate: self.rates[side],
            distance: self.distances[side].value(s),
            softened: self.softened[side].as_ref().map_or(0.0, |softened| softened.value(s)),
        };
        Tips {
            corners: [corner(0), corner(1)],
            half_width: self.half_width.value(s),
            unit: self.module,
            widest: self.widest,
        }
    }
}
