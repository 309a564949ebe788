//! End relief C_βI, C_βII: material taken off towards one or both ends of the face (ISO 21771-1).
//!
//! End I is at z = −b/2, end II at z = +b/2. Must not know: compliance, load.

use std::sync::Arc;

use super::curve::{CURVE, Curve, EXPONENT};
use super::{Family, GEAR, MOST_AMOUNT, Modification};
use declare::error::Diagnostic;
use declare::parameter::{Choice, Field, Member};
use declare::units;

const AMOUNT: Field =
    Field::quantity("amount", units::LENGTH, 0.0, MOST_AMOUNT, "C_βI, C_βII: depth at the end of the gear's own face.")
        .range();
const LENGTH: Field = Field::quantity(
    "length",
    units::LENGTH,
    0.0,
    10.0,
    "L_CβI, L_CβII: how far from the end of the face the relief starts; at most the face width for one end, half of it \
     for both; a relief of no length removes nothing.",
)
.range();
const END: Field = Field::choice(
    "end",
    &[
        Choice { name: "I", summary: "the end at z = −b/2" },
        Choice { name: "II", summary: "the end at z = +b/2" },
        Choice { name: "both", summary: "both, alike" },
    ],
    "Which end of the face is relieved; two of them with different values are two entries.",
)
.default("both");

pub const FAMILY: Family = Family {
    member: Member {
        name: "end_relief",
        summary: "C_βI, C_βII: relief that grows from a start on the face to one or both of its ends.",
        fields: &[GEAR, AMOUNT, LENGTH, END, CURVE, EXPONENT],
    },
    check: Curve::check,
    build: |record, pair, side| {
        let (end, length) = (record.choice(END.name), record.quantity(LENGTH.name));
        let face_width = pair.side(side).specification.face_width;
        let longest = if end == "both" { 0.5 * face_width } else { face_width };
        if length > longest {
            let (given, longest) = (length * 1e3, longest * 1e3);
            let message =
                format!("the end relief is {given:.6} mm long; the face leaves room for 0 to {longest:.6} mm");
            return Err(Diagnostic::new(message).at(record.place_of(LENGTH.name)));
        }
        Ok(Arc::new(EndRelief {
            amount: record.quantity(AMOUNT.name),
            length,
            start: 0.5 * face_width - length,
            first: end != "II",
            second: end != "I",
            curve: Curve::read(record),
        }))
    },
};

#[derive(Debug)]
struct EndRelief {
    amount: f64,
    length: f64,
    /// Distance from the middle of the face at which the relief starts; negative when it crosses the middle.
    start: f64,
    first: bool,
    second: bool,
    curve: Curve,
}

impl EndRelief {
    /// −1 or 1 where z lies in a relief towards end I or II, 0 elsewhere.
    fn direction(&self, z: f64) -> f64 {
        if self.second && z > self.start {
            1.0
        } else if self.first && -z > self.start {
            -1.0
        } else {
            0.0
        }
    }
}

impl Modification for EndRelief {
    fn lead(&self, z: f64) -> f64 {
        let distance = self.direction(z) * z - self.start;
        if self.direction(z) == 0.0 || self.length == 0.0 {
            0.0
        } else {
            self.amount * self.curve.value(distance / self.length)
        }
    }

    fn lead_quadratic(&self, z: f64) -> Option<[f64; 3]> {
        let direction = self.direction(z);
        if direction == 0.0 || self.length == 0.0 {
            return Some([0.0; 3]);
        }
        let Curve::Quadratic { linear } = self.curve else { return None };
        // amount · (a t + (1 − a) t²) with t = (±z − start)/length.
        let (start, scale) = (self.start / self.length, direction / self.length);
        let bend = 1.0 - linear;
        let coefficients =
            [start * (bend * start - linear), scale * (linear - 2.0 * bend * start), scale * scale * bend];
        Some(coefficients.map(|coefficient| self.amount * coefficient))
    }

    fn lead_breaks(&self) -> [Option<f64>; 2] {
        [self.first.then_some(-self.start), self.second.then_some(self.start)]
    }

    fn varies_along_face(&self) -> bool {
        self.amount != 0.0 && self.length != 0.0
    }

    fn lead_is_even(&self) -> bool {
        self.first == self.second || !self.varies_along_face()
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        vec![("amount", self.amount), ("length", self.length)]
    }
}
