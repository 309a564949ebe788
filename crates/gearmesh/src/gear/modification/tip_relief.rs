//! Tip relief C_αa: material taken off towards the tip (ISO 21771-1).
//!
//! Must not know: compliance, load.

use std::sync::Arc;

use super::curve::{CURVE, EXPONENT};
use super::flank::Flank;
use super::relief::{
    self, AMOUNT, COUNTED_FROM_TIP, End, FRACTION, ISO_AMOUNT, LENGTH, Ramp, START_DIAMETER, START_ROLL_ANGLE,
};
use super::{Family, GEAR};
use declare::parameter::Member;

pub const FAMILY: Family = Family {
    member: Member {
        name: "tip_relief",
        summary: "C_αa: relief that grows from a start on the flank to the tip.",
        fields: &[
            GEAR,
            AMOUNT,
            ISO_AMOUNT,
            LENGTH,
            FRACTION,
            START_ROLL_ANGLE,
            START_DIAMETER,
            COUNTED_FROM_TIP,
            CURVE,
            EXPONENT,
        ],
    },
    check: relief::check,
    build: |record, pair, side| Ok(Arc::new(Ramp::build(record, pair, &Flank::new(pair, side), End::Tip)?)),
};
