//! Where contact is resolved: the tips of both teeth, which a pair passes at the ends of its path.
//!
//! Must not know: modification, load.

use super::path::Path;
use crate::gear::compliance::PairCompliance;
use crate::gear::contact::flattening::{Bodies, combined_radius};
use crate::gear::contact::tip::{Corner, Tips};
use crate::gear::contact::wedge::Wedge;
use crate::gear::geometry::{GearPair, Side};
use crate::numeric::graded::Graded;

/// Against the path position.
#[derive(Clone, Debug)]
pub(super) struct Ends {
    wedges: [Wedge; 2],
    /// B \[1/Pa\].
    rates: [f64; 2],
    /// From the corners along the flanks \[m\].
    distances: [Graded; 2],
    half_width: Graded,
    /// m.
    module: f64,
    /// Half the width up to which the surfaces are half planes \[m\].
    widest: f64,
}

impl Ends {
    pub(super) fn new(pair: &GearPair, compliance: &PairCompliance, path: &Path) -> Self {
        let bodies = Bodies::of(pair, compliance.plane);
        let rates = [compliance.pinion.corner, compliance.gear.corner];
        let fit = |function: &dyn Fn(f64) -> f64| path.fit(0.0, function).unwrap_or_default();
        Self {
            wedges: rates.map(|rate| Wedge::new(rate / bodies.linear())),
            rates,
            distances: [Side::Pinion, Side::Gear].map(|side| fit(&|s| path.corner_distance(side, s))),
            half_width: fit(&|s| bodies.half_width(combined_radius(path.radii(s)))),
            module: pair.pinion.specification.module,
            widest: compliance.pinion.contact_depth.value(0.0).min(compliance.gear.contact_depth.value(0.0)),
        }
    }

    /// The tips of a pair there.
    pub(super) fn tips(&self, s: f64) -> Tips<'_> {
        let corner = |side: usize| Corner {
            wedge: &self.wedges[side],
            rate: self.rates[side],
            distance: self.distances[side].value(s),
        };
        Tips {
            corners: [corner(0), corner(1)],
            half_width: self.half_width.value(s),
            unit: self.module,
            widest: self.widest,
        }
    }
}
