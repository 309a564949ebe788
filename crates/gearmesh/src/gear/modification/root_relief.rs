//! Root relief C_αf: material taken off towards the root end of the active flank (ISO 21771-1).
//!
//! Must not know: compliance, load.

use std::sync::Arc;

use super::curve::Curve;
use super::flank::Flank;
use super::relief::{Amount, End, FromRoot, Ramp, Start, Stated};
use super::{Modification, Specified};
use crate::gear::geometry::{GearPair, Side};
use declare::Declared;
use declare::declared::Words;
use declare::error::Diagnostic;

/// C_αf: relief that grows from a start on the flank to the root end of its active part.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "root_relief")]
pub struct RootRelief {
    /// C_αf: depth at the root end of the active flank.
    #[declared(flatten)]
    pub amount: Amount,
    /// Where on the flank it starts.
    #[declared(flatten)]
    pub start: Start,
    /// Where `length` or `fraction` counts from.
    #[declared(default = "root")]
    pub counted_from: FromRoot,
    /// How the depth grows from the start to the root end.
    #[declared(flatten)]
    pub curve: Curve,
}

impl RootRelief {
    fn stated(&self) -> Stated<'_> {
        let (start, origin, curve) = (self.start, self.counted_from.origin(), self.curve);
        Stated { amount: &self.amount, start, origin, curve, end: End::Root }
    }
}

impl Specified for RootRelief {
    fn check(&self) -> Result<(), Diagnostic> {
        self.stated().check(self.counted_from.word())
    }

    fn on(&self, pair: &GearPair, side: Side) -> Result<Arc<dyn Modification>, Diagnostic> {
        Ok(Arc::new(Ramp::new(&self.stated(), pair, &Flank::new(pair, side))?))
    }
}
