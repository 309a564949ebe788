//! Whether a simpler design does as well as the one that was found: long relief, the tip relief of the handbooks.
//!
//! Long relief is linear and as long as p_b(ε_α − 1), from the highest point of single contact to the tip, on both gears
//! (Smith, Gear Noise and Vibration, 2nd edition 2003, chapter 2; Munro, Proc. Inst. Mech. Eng. 204 C (1990)). Its amount is
//! all that is left open; it is found between nothing and twice the largest deflection in the best design. Must not know: how
//! the design was found.

use super::Optimizer;
use super::passes::Found;
use crate::stage::Context;
use declare::number::significant;
use declare::units::in_unit;
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::modification::curve::Curve;
use gearmesh::gear::modification::relief::{Amount, FromTip, Start};
use gearmesh::gear::modification::tip_relief::TipRelief;
use gearmesh::gear::modification::{Design, Gears};
use gearmesh::gear::transmission_error::asked::Asked;
use gearmesh::gear::transmission_error::cycle::MeshCycle;
use gearmesh::gear::transmission_error::load_case::LoadCase;

/// Amounts that are tried: evenly, and then twice between the neighbours of the best.
const AMOUNTS: usize = 6;
const CLOSER: usize = 2;

/// Long relief of some amount, and its objective.
struct Long {
    amount: f64,
    value: f64,
}

impl Optimizer {
    /// Says that long relief is as good as what was found, within what counts as a gain, where that has more parts or more
    /// that was left open.
    pub fn tell_if_simpler_does(&self, context: &Context, found: &Found, (pair, cycle): (&GearPair, &MeshCycle)) {
        if self.goal.has_front() || !self.is_staged() || self.template.variables().len() < 2 {
            return;
        }
        let Some(long) = self.long_relief(found, pair, cycle) else { return };
        let (best, gain) = (found.best.value, self.rule().improvement);
        if long.value - best > gain * best.abs() {
            return;
        }
        let amount = significant(in_unit(long.amount, "um"), 4);
        let what = if long.amount > 0.0 {
            format!(
                "linear tip relief of both gears by {amount} um from the highest point of single contact (`tip_relief: \
                 {{ gear: both, amount: {amount} um, fraction: 1, curve: linear }}`)"
            )
        } else {
            "no modification at all".to_owned()
        };
        let [more, counts] = [long.value / best - 1.0, gain].map(|share| significant(100.0 * share, 2));
        let said = format!(
            "a simpler design is as good: {what}, whose objective is larger by {more} %, and {counts} % is what counts as \
             a gain"
        );
        (context.warn)(said.into());
    }

    /// The best amount that keeps the constraints.
    fn long_relief(&self, found: &Found, pair: &GearPair, cycle: &MeshCycle) -> Option<Long> {
        let design = self.template.design(pair, &found.best.point).ok()?;
        let deflections = self.of_cases(pair, &design, |design, torque| {
            LoadCase::new(cycle, design, torque).asked(Asked::default()).largest.value
        });
        let most = 2.0 * deflections?.into_iter().fold(0.0, f64::max);
        let (mut from, mut to) = (0.0, most);
        let mut best: Option<Long> = None;
        for _ in 0..=CLOSER {
            let step = (to - from) / AMOUNTS as f64;
            for amount in (0..=AMOUNTS).map(|at| from + step * at as f64) {
                let Some(value) = self.with_long_relief(pair, cycle, amount) else { continue };
                if best.as_ref().is_none_or(|best| value < best.value) {
                    best = Some(Long { amount, value });
                }
            }
            let middle = best.as_ref()?.amount;
            (from, to) = ((middle - step).max(0.0), middle + step);
        }
        best
    }

    /// The objective; none where the relief does not fit or a constraint is broken.
    fn with_long_relief(&self, pair: &GearPair, cycle: &MeshCycle, amount: f64) -> Option<f64> {
        let relief = TipRelief {
            amount: Amount::Depth(amount),
            start: Start::Fraction(1.0),
            counted_from: FromTip::Tip,
            curve: Curve::Linear,
        };
        let mut design = Design::default();
        design.add(Gears::Both, &relief, pair).ok()?;
        let worth = self.goal.worth(&self.cases, &self.measured(cycle, pair, &design)?);
        let is_kept = worth.evaluation.value.is_finite() && worth.evaluation.violation() == 0.0;
        is_kept.then_some(worth.evaluation.value)
    }
}
