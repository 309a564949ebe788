//! Running one variant: as often and with as many seeds as was asked for, timed, its memory measured.
//!
//! Must not know: what the values are compared with.

use std::time::Instant;

use super::quantity::{Quantity, Value};
use super::variant::Variant;
use crate::stage::{Context, Inputs, Stage};
use declare::error::Failure;
use studygraph::stage::memory::most_during;

/// How often a variant runs.
pub struct Plan {
    pub repeats: usize,
    pub seeds: usize,
}

impl Plan {
    /// The seeds a stage is run with: one where it draws no random numbers.
    pub fn seeds(&self, stage: &dyn Stage) -> usize {
        if stage.uses_seed() { self.seeds } else { 1 }
    }

    pub fn runs(&self, stage: &dyn Stage) -> usize {
        self.repeats * self.seeds(stage)
    }
}

/// What came of a variant.
pub struct Trial {
    /// For each seed what each quantity was.
    pub values: Vec<Vec<Vec<Value>>>,
    /// Median of all runs \[s\].
    pub seconds: f64,
    /// Median over the seeds; NaN where nothing counts.
    pub evaluations: f64,
    /// The most bytes that a run held; NaN where nobody counts them.
    pub bytes: f64,
}

/// Runs a variant; `asked` are the quantities and, if any, the column that counts its work.
///
/// # Errors
/// When it fails, or gives other values when it is repeated.
pub fn run(
    variant: &Variant,
    plan: &Plan,
    asked: (&[Quantity], Option<&Quantity>),
    context: &Context,
    inputs: &Inputs,
) -> Result<Trial, Failure> {
    let (mut values, mut seconds, mut evaluations) = (Vec::new(), Vec::new(), Vec::new());
    let mut bytes: Option<usize> = None;
    let runs = plan.runs(variant.stage.as_ref()) as f64;
    let failed = |problem: String| Failure::new(format!("{}, `{}`: {problem}", variant.label, variant.written));
    for seed in 0..plan.seeds(variant.stage.as_ref()) {
        for repeat in 0..plan.repeats {
            context.check_stop()?;
            let done = seconds.len() as f64;
            let progress = |share: f64| (context.progress)((done + share) / runs);
            let inner = Context { seed: context.seed.branch(seed), progress: &progress, ..*context };
            let began = Instant::now();
            let (result, held) = most_during(|| variant.stage.run(&inner, inputs));
            seconds.push(began.elapsed().as_secs_f64());
            bytes = bytes.max(held);
            let tables = result.map_err(|failure| match failure {
                Failure::Failed(message) => failed(message),
                Failure::Study(wrong) => failed(wrong.first.message),
                Failure::Stopped => Failure::Stopped,
            })?;
            let found: Vec<_> =
                asked.0.iter().map(|quantity| quantity.take(&tables)).collect::<Result<_, _>>().map_err(failed)?;
            if repeat == 0 {
                let counted = asked.1.map(|quantity| quantity.take(&tables)).transpose().map_err(failed)?;
                evaluations.push(counted.map_or(f64::NAN, |rows| rows.iter().map(|row| row.value).sum()));
                values.push(found);
            } else if !alike(&values[seed], &found) {
                return Err(failed(
                    "it gives other values when it is run again with the same inputs and seed".to_owned(),
                ));
            }
        }
    }
    let bytes = bytes.map_or(f64::NAN, |bytes| bytes as f64);
    Ok(Trial { values, seconds: quantile(&mut seconds, 0.5), evaluations: quantile(&mut evaluations, 0.5), bytes })
}

/// To the last bit.
fn alike(one: &[Vec<Value>], two: &[Vec<Value>]) -> bool {
    let bits = |all: &[Vec<Value>]| -> Vec<u64> { all.iter().flatten().map(|value| value.value.to_bits()).collect() };
    bits(one) == bits(two)
}

/// Where `share` of the values lie below, linear between two of them; sorts them.
pub fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let Some(last) = values.len().checked_sub(1) else { return f64::NAN };
    let at = share * last as f64;
    // Within the list.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let below = at.floor() as usize;
    let above = (below + 1).min(last);
    if below == above { values[below] } else { values[below] + (at - at.floor()) * (values[above] - values[below]) }
}
