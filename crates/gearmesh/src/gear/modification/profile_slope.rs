//! Profile slope C_Hα: a straight line over the active flank (ISO 21771-1).
//!
//! The end that keeps its material only shifts the transmission error by a constant. Must not know: compliance, load.

use std::sync::Arc;

use super::flank::Flank;
use super::{MOST_AMOUNT, Modification, Specified};
use crate::gear::geometry::{GearPair, Side};
use crate::numeric::quadratic::Quadratic;
use declare::Declared;
use declare::error::Diagnostic;
use declare::units::LENGTH;

/// C_Hα: straight line over the roll length of the active flank.
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
#[declared(name = "profile_slope")]
pub struct ProfileSlope {
    /// C_Hα: positive takes material off at the tip, negative at the root end; the other end keeps it.
    #[declared(dimension = LENGTH, minimum = -MOST_AMOUNT, maximum = MOST_AMOUNT, range, example = "5 um")]
    pub amount: f64,
}

impl Specified for ProfileSlope {
    fn on(&self, pair: &GearPair, side: Side) -> Result<Arc<dyn Modification>, Diagnostic> {
        let flank = Flank::new(pair, side);
        let kept = if self.amount < 0.0 { flank.tip_roll } else { flank.root_roll };
        let per_roll = self.amount / (flank.tip_roll - flank.root_roll);
        Ok(Arc::new(Line { amount: self.amount, kept, per_roll }))
    }
}

/// The same on a gear.
#[derive(Debug)]
struct Line {
    amount: f64,
    /// Roll angle of the end that keeps its material.
    kept: f64,
    per_roll: f64,
}

impl Modification for Line {
    fn depth(&self, roll: f64) -> f64 {
        (roll - self.kept) * self.per_roll
    }

    fn profile_quadratic(&self, _roll: f64) -> Option<Quadratic> {
        Some(Quadratic { origin: self.kept, coefficients: [0.0, self.per_roll, 0.0] })
    }

    fn varies_along_profile(&self) -> bool {
        self.amount != 0.0
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        vec![("amount", self.amount)]
    }
}
