//! Profile slope C_Hα: a straight line over the active flank (ISO 21771-1).
//!
//! The end that keeps its material only shifts the transmission error by a constant. Must not know: compliance, load.

use std::sync::Arc;

use super::flank::Flank;
use super::{Family, GEAR, MOST_AMOUNT, Modification, no_check};
use declare::parameter::{Field, Member};
use declare::units;

const AMOUNT: Field = Field::quantity(
    "amount",
    units::LENGTH,
    -MOST_AMOUNT,
    MOST_AMOUNT,
    "C_Hα: positive takes material off at the tip, negative at the root end; the other end keeps it.",
)
.range();

pub const FAMILY: Family = Family {
    member: Member {
        name: "profile_slope",
        summary: "C_Hα: straight line over the roll length of the active flank.",
        fields: &[GEAR, AMOUNT],
    },
    check: no_check,
    build: |record, pair, side| {
        let flank = Flank::new(pair, side);
        let amount = record.quantity(AMOUNT.name);
        let kept = if amount < 0.0 { flank.tip_roll } else { flank.root_roll };
        Ok(Arc::new(ProfileSlope { amount, kept, per_roll: amount / (flank.tip_roll - flank.root_roll) }))
    },
};

#[derive(Debug)]
struct ProfileSlope {
    amount: f64,
    /// Roll angle of the end that keeps its material.
    kept: f64,
    per_roll: f64,
}

impl Modification for ProfileSlope {
    fn depth(&self, roll: f64) -> f64 {
        (roll - self.kept) * self.per_roll
    }

    fn varies_along_profile(&self) -> bool {
        self.amount != 0.0
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        vec![("amount", self.amount)]
    }
}
