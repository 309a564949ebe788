//! Helix slope C_Hβ: a straight line across the gear's own face width (ISO 21771-1).
//!
//! The end that keeps its material only shifts the transmission error by a constant. Must not know: compliance, load.

use std::sync::Arc;

use super::{Family, GEAR, MOST_AMOUNT, Modification, no_check};
use declare::parameter::{Field, Member};
use declare::units;

const AMOUNT: Field = Field::quantity(
    "amount",
    units::LENGTH,
    -MOST_AMOUNT,
    MOST_AMOUNT,
    "C_Hβ over the face width: positive takes material off at z = +b/2, negative at z = −b/2; the other end keeps it.",
)
.range();

pub const FAMILY: Family = Family {
    member: Member {
        name: "helix_slope",
        summary: "C_Hβ: straight line across the gear's own face width; also stands for a misalignment.",
        fields: &[GEAR, AMOUNT],
    },
    check: no_check,
    build: |record, pair, side| {
        let face_width = pair.side(side).specification.face_width;
        Ok(Arc::new(HelixSlope { amount: record.quantity(AMOUNT.name), face_width }))
    },
};

#[derive(Debug)]
struct HelixSlope {
    amount: f64,
    face_width: f64,
}

impl Modification for HelixSlope {
    fn lead_quadratic(&self, _z: f64) -> Option<[f64; 3]> {
        Some([0.5 * self.amount.abs(), self.amount / self.face_width, 0.0])
    }

    fn varies_along_face(&self) -> bool {
        self.amount != 0.0
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        vec![("amount", self.amount), ("face_width", self.face_width)]
    }
}
