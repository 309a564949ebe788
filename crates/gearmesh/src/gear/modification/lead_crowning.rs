//! Lead crowning C_β: C_β(2z/b)² over the gear's own face width b (ISO 21771-1).
//!
//! Must not know: compliance, load.

use std::sync::Arc;

use super::{MOST_AMOUNT, Modification, Specified};
use crate::gear::geometry::{GearPair, Side};
use declare::Declared;
use declare::error::Diagnostic;
use declare::units::LENGTH;

/// C_β: parabola C_β(2z/b)² across the gear's own face width.
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
#[declared(name = "lead_crowning")]
pub struct LeadCrowning {
    /// C_β: depth at both ends of the gear's own face.
    #[declared(dimension = LENGTH, minimum = 0.0, maximum = MOST_AMOUNT, range, example = "4 um")]
    pub amount: f64,
}

impl Specified for LeadCrowning {
    fn on(&self, pair: &GearPair, side: Side) -> Result<Arc<dyn Modification>, Diagnostic> {
        Ok(Arc::new(Parabola { amount: self.amount, face_width: pair.side(side).specification.face_width }))
    }
}

/// The same on a gear.
#[derive(Debug)]
struct Parabola {
    amount: f64,
    face_width: f64,
}

impl Modification for Parabola {
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
