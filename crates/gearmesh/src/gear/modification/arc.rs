//! An arc from the flank to the tip: the circle that touches the involute in B and passes through A (`mei2016`, 3.2).
//!
//! Must not know: compliance, load.

use std::sync::Arc;

use super::Family;
use super::tip_curve::{self, Conic, CurveThrough, Ends, TipCurve};
use declare::parameter::Member;

pub const FAMILY: Family = Family {
    member: Member {
        name: "arc",
        summary: "Circular arc that leaves the flank along its tangent and ends inside the tip corner (mei2016).",
        fields: &tip_curve::FIELDS,
    },
    check: tip_curve::check,
    build: |record, pair, side| Ok(Arc::new(TipCurve::build(record, pair, side, &CurveThrough { derived, printed })?)),
};

/// κ(X² + Y²) + 2Y = 0: the centre lies on the normal of B, on the bisector of AB.
fn derived(ends: &Ends) -> Conic {
    let [along, across] = ends.a();
    let square = along * along + across * across;
    let curvature = if square > 0.0 { -2.0 * across / square } else { 0.0 };
    Conic { xx: curvature, xy: 0.0, yy: curvature, x: 0.0, y: 1.0, constant: 0.0 }
}

/// Equations 14 and 15.
fn printed([x_a, y_a]: [f64; 2], [x_b, y_b]: [f64; 2], alpha: f64) -> Conic {
    let slope = libm::tan(alpha);
    let bisector = (x_b - x_a) / (y_a - y_b);
    let x_0 = (y_b - slope * x_b - 0.5 * (y_a + y_b) + bisector * 0.5 * (x_a + x_b)) / (bisector - slope);
    let y_0 = slope * x_0 - slope * x_b + y_b;
    let square = (x_b - x_0) * (x_b - x_0) + (y_b - y_0) * (y_b - y_0);
    let curvature = 1.0 / square.sqrt();
    let constant = curvature * (x_0 * x_0 + y_0 * y_0 - square);
    Conic { xx: curvature, xy: 0.0, yy: curvature, x: -curvature * x_0, y: -curvature * y_0, constant }
}
