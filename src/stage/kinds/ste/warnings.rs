//! What a stage of the kind `ste` warns of in every case.
//!
//! Must not know: how a curve is found.

use super::rows::{Keyed, Load};
use super::{Named, Ste};
use crate::stage::contact_law_error::ReportedContactLawError;
use crate::stage::neglected_corners::{self, REMEDY, WithoutCorners};
use crate::stage::{Context, Inputs};
use gearmesh::gear::mesh::Mesh;
use studygraph::warning::{Cases, Warning};

/// Of the module: an approach beyond it is told, since nothing here is linear any more. The article `mei2016` goes to 0.18.
const LARGE_APPROACH: f64 = 0.5;

/// An estimated error of the peak-to-peak that is told although nobody asked for an accuracy.
const POOR: f64 = 0.01;

/// Most curves with corner contact that are computed to state the error of leaving it out.
const MAX_COMPARED: usize = 8;

/// Ends a warning of corners where friction takes part in the load balance.
const REMEDY_OF_FRICTION: &str = "all of it without friction in the load balance, which `corner_contact: exact` does not have: leave out \
     `in_load_balance` and set `corner_contact: exact`";

impl Ste {
    /// Of approaches that no linear model is for, of contacts that no law is for, and of accuracies that were not reached.
    pub fn warn(&self, context: &Context, answers: &[Keyed], module: f64) {
        for (name, Load { torque, .. }, answer) in answers {
            let (largest, reached) = (answer.summary.largest.value, answer.error);
            let tell = |about: &str, size: f64, what: String| {
                let sentence = format!("design `{name}` at {torque} N m: {what}");
                (context.warn)(Warning::Cases(Cases::one(about, name, (*torque, "N m"), (size, sentence))));
            };
            if largest > LARGE_APPROACH * module {
                tell(
                    "approach",
                    largest,
                    format!(
                        "the gears approach by {:.6} mm, more than {LARGE_APPROACH} of the module of {:.6} mm; teeth that bend \
                         so far are no longer linear, and the numbers are those of a linear model",
                        largest * 1e3,
                        module * 1e3,
                    ),
                );
            }
            let accurate = format!("the peak-to-peak is accurate to {reached:.1e}");
            match self.accuracy {
                Some(accuracy) if reached > accuracy => {
                    tell("accuracy", reached, format!("{accurate}, not to {accuracy:.1e}"));
                }
                None if reached > POOR => {
                    let help = "take more `slices` or `positions`, or ask for an `accuracy`";
                    tell("accuracy", reached, format!("{accurate} only; {help}"));
                }
                _ => (),
            }
            let peak_to_peak = answer.summary.peak_to_peak;
            let doubted = answer.doubt.map(|doubt| ReportedContactLawError {
                design: name,
                torque: *torque,
                doubt,
                peak_to_peak,
            });
            if let Some(case) = doubted.and_then(|doubted| doubted.told()) {
                (context.warn)(Warning::Cases(case.with_each("`summary.contact_doubt`")));
            }
        }
    }

    /// Reports the error of the curve that loses most by `corner_contact: none`; answers are in the order of the tasks.
    pub fn warn_of_corners(
        &self,
        (context, inputs): (&Context, &Inputs),
        base: &Mesh,
        answers: &[Keyed],
        tasks: &[(&Named, f64)],
    ) {
        let deviations: Vec<String> = answers.iter().map(|(_, load, _)| load.deviation.words()).collect();
        let without: Vec<Option<WithoutCorners>> = answers
            .iter()
            .zip(&deviations)
            .map(|((name, Load { torque, .. }, answer), deviations)| {
                let (peak_to_peak, mean) = (answer.summary.peak_to_peak, answer.summary.mean);
                let of =
                    |estimated| WithoutCorners { name, torque: *torque, peak_to_peak, mean, estimated, deviations };
                answer.left_out.map(of)
            })
            .collect();
        // The estimate ranks curves with the same deviations; between deviations the curves with corner contact decide.
        let change = |index: &usize| without[*index].map_or(0.0, |one| one.estimated.change);
        let mut compared: Vec<usize> = Vec::new();
        for index in (0..answers.len()).filter(|index| without[*index].is_some_and(|one| one.may_matter())) {
            let deviation = |index: usize| answers[index].1.deviation;
            match compared.iter_mut().find(|other| deviation(**other) == deviation(index)) {
                Some(other) if change(&index) > change(other) => *other = index,
                Some(_) => {}
                None => compared.push(index),
            }
        }
        compared.sort_by(|one, two| change(two).total_cmp(&change(one)).then(one.cmp(two)));
        compared.truncate(MAX_COMPARED);
        let found = compared.into_iter().filter_map(|index| {
            let (((design, ..), torque), settings) = (tasks[index], answers[index].2.settings);
            // Friction at a corner is not modelled: both curves are without.
            let (without, remedy) = if self.is_resisted() {
                let cycle = base.sampled(settings);
                let loading = cycle.loaded(design, torque);
                let without = WithoutCorners::of(answers[index].0, torque, &loading)?;
                (WithoutCorners { deviations: &deviations[index], ..without }, REMEDY_OF_FRICTION)
            } else {
                (without[index]?, REMEDY)
            };
            let cycle = neglected_corners::cycle(inputs, settings)?;
            let (size, sentence) = without.error(&cycle.loaded(design, torque), remedy)?;
            Some((size, without.warning(size, &sentence)))
        });
        if let Some((_, warning)) = found.reduce(|worst, other| if other.0 > worst.0 { other } else { worst }) {
            (context.warn)(warning);
        }
    }
}
