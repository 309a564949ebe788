//! Warnings of an optimum that was found with `corner_contact: none`: its own error, and whether another design is better with corner
//! contact.
//!
//! Must not know: how any method searches.

use super::Optimizer;
use super::passes::Found;
use crate::stage::neglected_corners::{self, WithoutCorners};
use crate::stage::{Context, Inputs};
use declare::number::significant;
use gearmesh::gear::mesh::Mesh;
use gearmesh::gear::modification::template::Fitted;

/// Ends a warning of corner contact.
const CHOICE: &str = "another design may be the best with corner contact; set `corner_contact: exact`";

impl Optimizer {
    /// Reports the error of the load case of the best design that loses most by `corner_contact: none`, and whether the design with the
    /// least value of every variable is better with corner contact: there reliefs keep corners apart least.
    pub(super) fn warn_of_corners(&self, (context, inputs): (&Context, &Inputs), found: &Found, of: (&Fitted, &Mesh)) {
        if !context.is_heard {
            return;
        }
        let best = found.best.point.as_slice();
        let least: Vec<f64> = self.template.variables().iter().map(|variable| variable.minimum).collect();
        let of_best = self.without_corners(of, best);
        let worst = WithoutCorners::worst(&of_best);
        let least = Some(least).filter(|least| {
            least != best && !self.goal.has_front() && WithoutCorners::worst(&self.without_corners(of, least)).is_some()
        });
        if worst.is_none() && least.is_none() {
            return;
        }
        let Some(cycle) = neglected_corners::cycle(inputs, found.settings) else { return };
        if let Some((worst, compared)) = worst.and_then(|worst| Some((worst, of_best[worst]?)))
            && let Ok(design) = of.0.design(best)
        {
            let mut call = 0;
            self.of_cases((of.0, &cycle), &design, |loading, _| {
                if call == worst
                    && let Some(warning) = compared.compared(loading, CHOICE)
                {
                    (context.warn)(warning);
                }
                call += 1;
            });
        }
        let kept = |point: &[f64]| {
            let evaluation = self.worth(&cycle, of.0, point).evaluation;
            (evaluation.violation() == 0.0).then_some(evaluation.value).filter(|value| value.is_finite())
        };
        if let Some(least) = least
            && let Some((least, best)) = kept(&least).zip(kept(best))
            && least < best
        {
            let percent = significant(100.0 * (1.0 - least / best), 2);
            let sentence = format!(
                "`corner_contact` is `none`; with `exact` another design than `{}` is better: the one with the least value of every \
                 variable, by {percent} % of the objective; set `corner_contact: exact`",
                self.stated.name
            );
            (context.warn)(sentence.into());
        }
    }

    /// Each load case of a design.
    fn without_corners(&self, of: (&Fitted, &Mesh), point: &[f64]) -> Vec<Option<WithoutCorners<'_>>> {
        let mut without = Vec::new();
        if let Ok(design) = of.0.design(point) {
            self.of_cases(of, &design, |loading, torque| {
                without.push(WithoutCorners::of(&self.stated.name, torque, loading));
            });
        }
        without
    }
}
