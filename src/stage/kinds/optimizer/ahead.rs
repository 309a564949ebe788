//! What a stage of the kind `optimizer` will take: so much per evaluation that its method may ask for.
//!
//! Must not know: how any method searches.

use super::{EVALUATIONS, Optimizer, passes};
use crate::stage::designs::{self, rows_of};
use crate::stage::{Ahead, Demand, Estimate, RowCount, common};
use declare::work::Work;
use gearmesh::gear::work::CONTACT_SOLVES;

/// Solves for the objective under one torque: so many, and so many for each position.
const SOLVES: f64 = 50.0;
const SOLVES_PER_POSITION: f64 = 0.8;
/// Bytes of a pair with its compliances, ready to be loaded.
const CYCLE: u64 = 4 << 20;

impl Optimizer {
    pub fn ahead(&self, demand: &Demand, _ahead: &Ahead) -> Estimate {
        let dimension = self.template.variables().len();
        // What the method refuses was refused when the stage was built.
        let Ok(foreseen) = self.foresee() else {
            return Estimate::new(true);
        };
        let as_many = |count| if foreseen.exact { RowCount::exact(count) } else { RowCount::at_most(count) };
        let each = SOLVES + SOLVES_PER_POSITION * self.settings.positions as f64;
        // Far below 2^53, or the estimate is beyond any limit.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let solves = (foreseen.evaluations as f64 * self.cases.all.len() as f64 * each) as usize;
        let kept = if demand.table(EVALUATIONS) { foreseen.evaluations as u64 } else { 0 };
        let [designs, elements] = designs::schemas();
        let points = if self.goal.has_front() { self.stated.front_points } else { 0 };
        let count = |of_design: usize| {
            let most = of_design.saturating_mul(points + 1);
            if points == 0 { RowCount::exact(most) } else { RowCount::at_most(most) }
        };
        let parameters = self.stated.design.elements().iter().map(rows_of).sum();
        let estimate = Estimate::new(true)
            .work(&Work::of(&CONTACT_SOLVES, solves), common::solve_times(self.settings))
            .holding((foreseen.memory as u64 + CYCLE).saturating_add(kept.saturating_mul(8 * dimension as u64 + 40)))
            .rows(demand, self.best().schema(), RowCount::exact(1))
            .rows(demand, self.history().schema(), as_many(foreseen.batches))
            .rows(demand, self.passes().schema(), RowCount::at_most(passes::MOST))
            .rows(demand, designs, count(1))
            .rows(demand, elements, count(parameters))
            .columns(demand, self.evaluations().schema(), as_many(foreseen.evaluations));
        if points == 0 { estimate } else { estimate.rows(demand, self.front().schema(), RowCount::at_most(points)) }
    }
}
