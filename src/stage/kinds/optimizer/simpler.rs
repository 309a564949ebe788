//! Whether a simpler design does as well as the one that was found: long relief, the tip relief of the handbooks.
//!
//! Long relief is linear and as long as p_b(ε_α − 1), from the highest point of single contact to the tip, on both gears
//! (Smith, Gear Noise and Vibration, 2nd edition 2003, chapter 2; Munro, Proc. Inst. Mech. Eng. 204 C (1990)). Its amount is
//! all that is left open; it is found between nothing and twice the largest deflection in the best design. Must not know: how
//! the design was found.

use super::Optimizer;
use super::passes::Found;
use crate::stage::Context;
use declare::error::Failure;
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
use gearmesh::optimize;
use gearmesh::optimize::bounds::Bounds;

/// Amounts that are tried evenly, and evaluations of a simplex that begins at the best of them, at most.
const AMOUNTS: usize = 6;
const EVALUATIONS_OF_IT: usize = 40;

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
        let value = |amount: f64| self.with_long_relief(pair, cycle, amount).unwrap_or(f64::INFINITY);
        let scanned = (0..=AMOUNTS).map(|at| most * at as f64 / AMOUNTS as f64);
        let from = scanned.min_by(|a, b| value(*a).total_cmp(&value(*b)))?;
        let bounds = Bounds::new(vec![(0.0, most)]).ok()?;
        let mut search = optimize::refinement(bounds, &[from], 0.5 / AMOUNTS as f64, EVALUATIONS_OF_IT);
        let values = |points: &[Vec<f64>]| points.iter().map(|point| value(point[0])).collect();
        search.run(|points| Ok::<Vec<f64>, Failure>(values(points))).ok()?;
        search.best().map(|best| Long { amount: best.point[0], value: best.value })
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
