//! Whether long relief does as well as the design that was found.
//!
//! Its largest amount is twice the largest deflection in the best design. Must not know: how the design was found.

use super::Optimizer;
use super::passes::Found;
use crate::stage::{Context, simpler};
use declare::number::significant;
use gearmesh::gear::mesh::Mesh;
use gearmesh::gear::mesh::answers::needs::Needs;
use gearmesh::gear::modification::template::Fitted;

impl Optimizer {
    /// Says that long relief is as good as what was found, within what counts as a gain, where that has more parts or more
    /// that was left open.
    pub fn tell_if_simpler_does(&self, context: &Context, found: &Found, (fitted, cycle): (&Fitted, &Mesh)) {
        if self.goal.has_front() || !self.is_staged() || self.template.variables().len() < 2 {
            return;
        }
        let Some(deflection) = self.deflection(found, fitted, cycle) else { return };
        let gain = self.rule().improvement;
        let value = |amount: f64| self.with_long_relief(fitted, cycle, amount).unwrap_or(f64::INFINITY);
        if let Some(simpler) = simpler::as_good(found.best.value, gain, deflection, value) {
            let counts = significant(100.0 * gain, 2);
            let said = simpler.said("objective");
            (context.warn)(format!("{said}, and {counts} % is what counts as a gain").into());
        }
    }

    /// The largest one of all cases.
    fn deflection(&self, found: &Found, fitted: &Fitted, cycle: &Mesh) -> Option<f64> {
        let design = fitted.design(&found.best.point).ok()?;
        let deflections =
            self.of_cases((fitted, cycle), &design, |loading, _| loading.summary_of(Needs::default()).largest.value);
        Some(deflections?.into_iter().fold(0.0, f64::max))
    }

    /// The objective; none where the relief does not fit or a constraint is broken.
    fn with_long_relief(&self, fitted: &Fitted, cycle: &Mesh, amount: f64) -> Option<f64> {
        let design = simpler::long_relief(amount, fitted.pair()).ok()?;
        let worth = self.goal.worth(&self.cases, &self.measured(cycle, fitted, &design)?);
        let is_kept = worth.evaluation.value.is_finite() && worth.evaluation.violation() == 0.0;
        is_kept.then_some(worth.evaluation.value)
    }
}
