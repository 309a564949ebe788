//! Lead crowning C_β: C_β(2z/b)² over the gear's own face width b (ISO 21771-1).
//!
//! Must not know: compliance, load.

use std::sync::Arc;

use super::{Family, GEAR, MOST_AMOUNT, Modification, no_check};
use declare::parameter::{Field, Member};
use declare::units;

const AMOUNT: Field =
    Field::quantity("amount", units::LENGTH, 0.0, MOST_AMOUNT, "C_β: depth at both ends of the gear's own face.")
        .range();

pub const FAMILY: Family = Family {
    member: Member {
        name: "lead_crowning",
        summary: "C_β: parabola C_β(2z/b)² across the gear's own face width.",
        fields: &[GEAR, AMOUNT],
    },
    check: no_check,
    build: |record, pair, side| {
        let face_width = pair.side(side).specification.face_width;
        Ok(Arc::new(LeadCrowning { amount: record.quantity(AMOUNT.name), face_width }))
    },
};

#[derive(Debug)]
struct LeadCrowning {
    amount: f64,
    face_width: f64,
}

impl Modification for LeadCrowning {
    fn lead_quadratic(&self, _z: f64) -> Option<[f64; 3]> {
        let per_length = 2.0 / self.face_width;
        Some([0.0, 0.0, self.amount * per_length * per_length])
    }

    fn varies_along_face(&self) -> bool {
        self.amount != 0.0
    }

    fn lead_is_even(&self) -> bool {
        true
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        vec![("amount", self.amount), ("face_width", self.face_width)]
    }
}
