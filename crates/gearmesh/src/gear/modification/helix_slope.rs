//! Helix slope C_Hβ: a straight line across the gear's own face width (ISO 21771-1).
//!
//! The end that keeps its material only shifts the transmission error by a constant. Must not know: compliance, load.

use std::sync::Arc;

use super::{MOST_AMOUNT, Modification, Specified};
use crate::gear::geometry::{GearPair, Side};
use declare::Declared;
use declare::error::Diagnostic;
use declare::units::LENGTH;

/// C_Hβ: straight line across the gear's own face width; also stands for a misalignment.
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
#[declared(name = "helix_slope")]
pub struct HelixSlope {
    /// C_Hβ over the face width: positive takes material off at z = +b/2, negative at z = −b/2; the other end keeps it.
    #[declared(dimension = LENGTH, minimum = -MOST_AMOUNT, maximum = MOST_AMOUNT, range, example = "6 um")]
    pub amount: f64,
}

impl Specified for HelixSlope {
    fn on(&self, pair: &GearPair, side: Side) -> Result<Arc<dyn Modification>, Diagnostic> {
        Ok(Arc::new(Line { amount: self.amount, face_width: pair.side(side).specification.face_width }))
    }
}

/// The same on a gear.
#[derive(Debug)]
struct Line {
    amount: f64,
    face_width: f64,
}

impl Modification for Line {
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
