//! Root relief C_αf: material taken off towards the root end of the active flank (ISO 21771-1).
//!
//! Must not know: compliance, load.

use std::sync::Arc;

use super::curve::{CURVE, EXPONENT};
use super::flank::Flank;
use super::relief::{
    self, AMOUNT, COUNTED_FROM_ROOT, End, FRACTION, ISO_AMOUNT, LENGTH, Ramp, START_DIAMETER, START_ROLL_ANGLE,
};
use super::{Family, GEAR};
use declare::parameter::Member;

pub const FAMILY: Family = Family {
    member: Member {
        name: "root_relief",
        summary: "C_αf: relief that grows from a start on the flank to the root end of its active part.",
        fields: &[
            GEAR,
            AMOUNT,
            ISO_AMOUNT,
            LENGTH,
            FRACTION,
            START_ROLL_ANGLE,
            START_DIAMETER,
            COUNTED_FROM_ROOT,
            CURVE,
            EXPONENT,
        ],
    },
    check: relief::check,
    build: |record, pair, side| Ok(Arc::new(Ramp::build(record, pair, &Flank::new(pair, side), End::Root)?)),
};
