//! Profile crowning C_α: a parabola over the active flank, zero in its middle (ISO 21771-1).
//!
//! Must not know: compliance, load.

use std::sync::Arc;

use super::flank::Flank;
use super::{MOST_AMOUNT, Modification, Specified};
use crate::gear::geometry::{GearPair, Side};
use crate::numeric::quadratic::Quadratic;
use declare::Declared;
use declare::error::Diagnostic;
use declare::units::LENGTH;

/// C_α: parabola over the roll length of the active flank, nothing in its middle.
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
#[declared(name = "profile_crowning")]
pub struct ProfileCrowning {
    /// C_α: depth at both ends of the active flank.
    #[declared(dimension = LENGTH, minimum = 0.0, maximum = MOST_AMOUNT, range, example = "3 um")]
    pub amount: f64,
}

impl Specified for ProfileCrowning {
    fn on(&self, pair: &GearPair, side: Side) -> Result<Arc<dyn Modification>, Diagnostic> {
        let flank = Flank::new(pair, side);
        let middle = 0.5 * (flank.tip_roll + flank.root_roll);
        let per_roll = 2.0 / (flank.tip_roll - flank.root_roll);
        Ok(Arc::new(Parabola { amount: self.amount, middle, per_roll }))
    }
}

/// The same on a gear.
#[derive(Debug)]
struct Parabola {
    amount: f64,
    middle: f64,
    per_roll: f64,
}

impl Modification for Parabola {
    fn depth(&self, roll: f64) -> f64 {
        let t = (roll - self.middle) * self.per_roll;
        self.amount * t * t
    }

    fn profile_quadratic(&self, _roll: f64) -> Option<Quadratic> {
        let bend = self.amount * self.per_roll * self.per_roll;
        Some(Quadratic { origin: self.middle, coefficients: [0.0, 0.0, bend] })
    }

    fn varies_along_profile(&self) -> bool {
        self.amount != 0.0
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        vec![("amount", self.amount), ("middle_roll_angle", self.middle)]
    }
}
