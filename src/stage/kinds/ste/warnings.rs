//! What a stage of the kind `ste` warns of in every case.
//!
//! Must not know: how a curve is found.

use super::tables::{Keyed, Load};
use super::{Named, Ste};
use crate::stage::doubts::Doubted;
use crate::stage::neglected_corners::{self, REMEDY, WithoutCorners};
use crate::stage::{Context, Inputs};
use gearmesh::gear::transmission_error::cycle::MeshCycle;
use gearmesh::gear::transmission_error::load_case::LoadCase;
use studygraph::warning::{Cases, Warning};

/// Of the module: an approach beyond it is told, since nothing here is linear any more. The article `mei2016` goes to 0.18.
const LARGE_APPROACH: f64 = 0.5;

/// An estimated error of the peak-to-peak that is told although nobody asked for an accuracy.
const POOR: f64 = 0.01;

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
            let doubted = answer.doubt.map(|doubt| Doubted { design: name, torque: *torque, doubt, peak_to_peak });
            if let Some(case) = doubted.and_then(|doubted| doubted.told()) {
                (context.warn)(Warning::Cases(case.with_each("`summary.contact_doubt`")));
            }
        }
    }

    /// Reports the error of the curve that loses most by `corner_contact: none`; answers are in the order of the tasks.
    pub fn warn_of_corners(
        &self,
        (context, inputs): (&Context, &Inputs),
        base: &MeshCycle,
        answers: &[Keyed],
        tasks: &[(&Named, f64)],
    ) {
        let without: Vec<Option<WithoutCorners>> = answers
            .iter()
            .map(|(name, Load { torque, .. }, answer)| {
                let (peak_to_peak, mean) = (answer.summary.peak_to_peak, answer.summary.mean);
                let of = |estimated| WithoutCorners { name, torque: *torque, peak_to_peak, mean, estimated };
                answer.left_out.map(of)
            })
            .collect();
        let Some(worst) = WithoutCorners::worst(&without) else { return };
        let (((design, ..), torque), settings) = (tasks[worst], answers[worst].2.settings);
        // Friction at a corner is in no balance: both curves are then without.
        let compared = if self.is_resisted() {
            WithoutCorners::of(answers[worst].0, torque, &LoadCase::new(&base.sampled(settings), design, torque))
        } else {
            without[worst]
        };
        let Some(cycle) = neglected_corners::cycle(inputs, settings) else { return };
        let found = compared.and_then(|without| without.compared(&LoadCase::new(&cycle, design, torque), REMEDY));
        if let Some(warning) = found {
            (context.warn)(warning);
        }
    }
}
