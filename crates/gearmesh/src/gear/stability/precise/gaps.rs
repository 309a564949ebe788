//! The gap of a built case in twice the precision, its own numbers taken as exact.

use super::super::{Built, Case};
use super::flanks::{Flanks, TipRelief};
use crate::numeric::double_double::Double;

/// The least gap at a path position, with linear reliefs on both tips.
pub(in super::super) fn exact_gap(case: &Case, built: &Built, s: Double) -> Double {
    let pair = &built.pair;
    let relief = TipRelief { depth: case.relief.into(), length: case.relief_length.into() };
    let flanks = Flanks {
        base_radii: [pair.pinion.base_radius, pair.gear.base_radius].map(Double::from),
        tangent_length: pair.tangent_length.into(),
        path: pair.flank_ends().map(Double::from),
        reliefs: [relief; 2],
    };
    flanks.least(s).gap
}
