//! A parabola from the flank to the tip: y = a x² + b x + c in the frame in which the involute starts on the x axis,
//! tangent to the involute in B and through A (`mei2016`, 3.1).
//!
//! Must not know: compliance, load.

use std::sync::Arc;

use super::tip_curve::{Conic, CurveThrough, Ends, Through, TipCurve};
use super::{Modification, Specified};
use crate::gear::geometry::{GearPair, Side};
use declare::Declared;
use declare::error::Diagnostic;

/// Parabola that leaves the flank along its tangent and ends inside the tip corner (mei2016).
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
#[declared(name = "parabola")]
pub struct ParabolicRelief {
    /// Where it starts and ends.
    #[declared(flatten)]
    pub through: Through,
}

impl Specified for ParabolicRelief {
    fn on(&self, pair: &GearPair, side: Side) -> Result<Arc<dyn Modification>, Diagnostic> {
        Ok(Arc::new(TipCurve::new(self.through, pair.side(side), &CurveThrough { derived, printed })?))
    }
}

/// With q = X cos t + Y sin t, the distance from B along the article's x axis: y − y_B − q tan t = −Y/cos t = a q².
fn derived(ends: &Ends) -> Conic {
    let [along, across] = ends.a();
    let (s, c) = libm::sincos(ends.start);
    let distance = along * c + across * s;
    let bend = if distance > 0.0 { -2.0 * across / (distance * distance) } else { 0.0 };
    Conic { xx: bend * c * c, xy: bend * s * c, yy: bend * s * s, x: 0.0, y: 1.0, constant: 0.0 }
}

/// Equation 13.
fn printed([x_a, y_a]: [f64; 2], [x_b, y_b]: [f64; 2], alpha: f64) -> Conic {
    let cotangent = 1.0 / libm::tan(alpha);
    let a = ((y_a - y_b) + cotangent * (x_b - x_a)) / ((x_b + x_a - 2.0) * (x_b - x_a));
    let b = -cotangent - 2.0 * a * x_b;
    let c = y_b - a * x_b * x_b + (cotangent + 2.0 * a * x_b);
    Conic { xx: 2.0 * a, xy: 0.0, yy: 0.0, x: b, y: -1.0, constant: 2.0 * c }
}
