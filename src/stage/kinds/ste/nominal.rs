//! Nominal root stresses by the standard, beside those that are found.
//!
//! Must not know: how a curve is found.

use crate::stage::Context;
use crate::stage::names::summary;
use gearmesh::gear::geometry::{GearPair, Side};
use gearmesh::gear::rating::root::nominal_root_stress;

/// The standard's root stress of both gears per torque on the pinion, where it is wanted and holds; a warning says why not.
pub fn nominal_root_stresses(context: &Context, pair: &GearPair) -> [f64; 2] {
    let of = |side: Side, column: &str| {
        if !context.demand.column(summary::TABLE, column) {
            return f64::NAN;
        }
        nominal_root_stress(pair, side, 1.0).unwrap_or_else(|why| {
            let who = side.name();
            (context.warn)(format!("`{column}` is left empty: ISO 6336-3 does not hold for the {who}: {why}").into());
            f64::NAN
        })
    };
    [of(Side::Pinion, summary::ISO6336_ROOT_STRESS_PINION), of(Side::Gear, summary::ISO6336_ROOT_STRESS_GEAR)]
}
