//! Profile crowning C_α: a parabola over the active flank, zero in its middle (ISO 21771-1).
//!
//! Must not know: compliance, load.

use std::sync::Arc;

use super::flank::Flank;
use super::{Family, GEAR, MOST_AMOUNT, Modification, no_check};
use declare::parameter::{Field, Member};
use declare::units;

const AMOUNT: Field =
    Field::quantity("amount", units::LENGTH, 0.0, MOST_AMOUNT, "C_α: depth at both ends of the active flank.").range();

pub const FAMILY: Family = Family {
    member: Member {
        name: "profile_crowning",
        summary: "C_α: parabola over the roll length of the active flank, nothing in its middle.",
        fields: &[GEAR, AMOUNT],
    },
    check: no_check,
    build: |record, pair, side| {
        let flank = Flank::new(pair, side);
        let middle = 0.5 * (flank.tip_roll + flank.root_roll);
        let per_roll = 2.0 / (flank.tip_roll - flank.root_roll);
        Ok(Arc::new(ProfileCrowning { amount: record.quantity(AMOUNT.name), middle, per_roll }))
    },
};

#[derive(Debug)]
struct ProfileCrowning {
    amount: f64,
    middle: f64,
    per_roll: f64,
}

impl Modification for ProfileCrowning {
    fn depth(&self, roll: f64) -> f64 {
        let t = (roll - self.middle) * self.per_roll;
        self.amount * t * t
    }

    fn varies_along_profile(&self) -> bool {
        self.amount != 0.0
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        vec![("amount", self.amount), ("middle_roll_angle", self.middle)]
    }
}
