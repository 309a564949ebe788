//! An arc from the flank to the tip: the circle that touches the involute in B and passes through A (`mei2016`, 3.2).
//!
//! Must not know: compliance, load.

use std::sync::Arc;

use super::tip_curve::{Conic, CurveThrough, Ends, Through, TipCurve};
use super::{Modification, Specified};
use crate::gear::geometry::{GearPair, Side};
use declare::Declared;
use declare::error::Diagnostic;

/// Circular arc that leaves the flank along its tangent and ends inside the tip corner (mei2016).
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
#[declared(name = "arc")]
pub struct ArcRelief {
    /// Where it starts and ends.
    #[declared(flatten)]
    pub through: Through,
}

impl Specified for ArcRelief {
    fn on(&self, pair: &GearPair, side: Side) -> Result<Arc<dyn Modification>, Diagnostic> {
        Ok(Arc::new(TipCurve::new(self.through, pair.side(side), &CurveThrough { derived, printed })?))
    }
}

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
