//! Tip relief C_αa: material taken off towards the tip (ISO 21771-1).
//!
//! Must not know: compliance, load.

use std::sync::Arc;

use super::curve::Curve;
use super::flank::Flank;
use super::relief::{Amount, End, FromTip, Ramp, Start, Stated};
use super::{Modification, Specified};
use crate::gear::geometry::{GearPair, Side};
use declare::Declared;
use declare::declared::Words;
use declare::error::Diagnostic;

/// C_αa: relief that grows from a start on the flank to the tip.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "tip_relief")]
pub struct TipRelief {
    /// C_αa: depth at the tip.
    #[declared(flatten)]
    pub amount: Amount,
    /// Where on the flank it starts.
    #[declared(flatten)]
    pub start: Start,
    /// Where `length` or `fraction` counts from.
    #[declared(default = "tip")]
    pub counted_from: FromTip,
    /// How the depth grows from the start to the tip.
    #[declared(flatten)]
    pub curve: Curve,
}

impl TipRelief {
    /// A depth C_αa \[m\] at the tip that grows from its start as this curve does; a length or a fraction counts from the tip.
    #[must_use]
    pub fn new(amount: f64, start: Start, curve: Curve) -> Self {
        Self { amount: Amount::Depth(amount), start, counted_from: FromTip::Tip, curve }
    }

    /// The same with a linear growth.
    #[must_use]
    pub fn linear(amount: f64, start: Start) -> Self {
        Self::new(amount, start, Curve::Linear)
    }

    fn stated(&self) -> Stated<'_> {
        let (start, origin, curve) = (self.start, self.counted_from.origin(), self.curve);
        Stated { amount: &self.amount, start, origin, curve, end: End::Tip }
    }
}

impl Specified for TipRelief {
    fn check(&self) -> Result<(), Diagnostic> {
        self.stated().check(self.counted_from.word())
    }

    fn on(&self, pair: &GearPair, side: Side) -> Result<Arc<dyn Modification>, Diagnostic> {
        Ok(Arc::new(Ramp::new(&self.stated(), pair, &Flank::new(pair, side))?))
    }
}
