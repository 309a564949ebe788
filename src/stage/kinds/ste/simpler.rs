//! Whether long relief does as well as a design, under each torque by itself.
//!
//! What counts is the peak-to-peak, the largest of all that the pair is off by. Torques are chunks of the stage, so none knows
//! of the others. Must not know: how a curve is found.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::Ste;
use super::rows::{Keyed, Load};
use crate::stage::{Context, simpler};
use declare::error::Failure;
use declare::number::significant;
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::mesh::Mesh;
use studygraph::warning::{Cases, Warning};

impl Ste {
    /// Says of which designs, but those that are `simple` themselves; answers of a design under a torque stand together.
    pub fn tell_if_simpler_does(
        &self,
        context: &Context,
        (pair, cycle): (&GearPair, &Mesh),
        (answers, simple): (&[Keyed], &BTreeSet<String>),
    ) -> Result<(), Failure> {
        let Some(within) = self.simpler_within else { return Ok(()) };
        let groups = answers.chunk_by(|one, other| one.0 == other.0 && one.1.torque.total_cmp(&other.1.torque).is_eq());
        let groups: Vec<&[Keyed]> = groups.filter(|group| !simple.contains(group[0].0)).collect();
        let judged = groups.par_iter().map(|group| {
            context.check_stop()?;
            let (name, Load { torque, .. }, _) = group[0];
            let largest = |of: fn(&Keyed) -> f64| group.iter().map(of).fold(0.0, f64::max);
            let peak_to_peak = largest(|(.., answer)| answer.summary.peak_to_peak);
            let deflection = largest(|(.., answer)| answer.summary.largest.value);
            let value = |amount: f64| self.with_long_relief(amount, (pair, cycle), torque).unwrap_or(f64::INFINITY);
            let found = simpler::as_good(peak_to_peak, within, deflection, value);
            Ok(found.map(|simpler| {
                let said = simpler.said("peak-to-peak");
                let counts = significant(100.0 * within, 2);
                let said = format!("design `{name}` at {torque} N m: {said}, and `simpler_within` is {counts} %");
                // The one is told that gains most by it.
                Cases::one("simpler", name, (torque, "N m"), (1.0 - simpler.value / peak_to_peak, said))
            }))
        });
        let judged: Vec<Option<Cases>> = judged.collect::<Result<_, Failure>>()?;
        judged.into_iter().flatten().for_each(|case| (context.warn)(Warning::Cases(case)));
        Ok(())
    }

    /// The peak-to-peak, the largest of all deviations; none where the relief does not fit.
    fn with_long_relief(&self, amount: f64, (pair, cycle): (&GearPair, &Mesh), torque: f64) -> Option<f64> {
        let design = simpler::long_relief(amount, pair).ok()?;
        self.deviations.combinations().iter().try_fold(0.0_f64, |largest, deviation| {
            let off = deviation.on(&design, pair).ok()?;
            Some(largest.max(self.loading(cycle, &off, torque).peak_to_peak()))
        })
    }
}
