//! The summary of a curve, restricted to the quantities that are needed: for many designs whose curves are not tabulated.
//!
//! The values are those of [`LoadCase::summary`], from the same spans, to the last bit; if only extrema are needed, those of
//! [`LoadCase::peak_to_peak`], which agree with them to rounding. Must not know: tables, units other than SI.

use super::curve::{Summary, Wanted, difference, extremes, summary};
use super::pressure::{largest_pressure, pressed};
use super::quantities::{Need, Quantity};
use super::walk::{refining, span_length, walk};
use crate::gear::mesh::equilibrium::load_case::LoadCase;
use crate::gear::mesh::equilibrium::state::Equilibrium;
use crate::gear::mesh::trace::Trace;
use crate::numeric::harmonics;

/// What of a summary is needed beside the extrema.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Mean and variance.
    pub integrals: bool,
    /// Number of harmonics.
    pub harmonics: usize,
    /// Number of harmonics for which the spans are short enough, if more than `harmonics`.
    pub spans_for: usize,
    /// The largest pressure.
    pub pressure: bool,
    /// The peak-to-peak without load.
    pub unloaded: bool,
    /// Contact ratio and load shares.
    pub load_sharing: bool,
    /// The largest root stresses.
    pub root_stress: bool,
}

impl Needs {
    /// Adds the prerequisite of a quantity.
    #[must_use]
    pub fn and(mut self, quantity: &Quantity) -> Self {
        match quantity.need {
            Need::Extremes => {}
            Need::Integrals => self.integrals = true,
            Need::Unloaded => self.unloaded = true,
            Need::LoadSharing => self.load_sharing = true,
            Need::Pressure => self.pressure = true,
            Need::RootStress => self.root_stress = true,
        }
        self
    }

    /// True if the curve is walked once, with all cuts that integrals need.
    fn walks(self) -> bool {
        self.integrals || self.harmonics > 0 || self.pressure
    }
}

/// The summary with what is needed; everything else is NaN, empty or none.
#[must_use]
pub(in crate::gear::mesh) fn summary_of(case: &LoadCase, needs: Needs) -> Summary {
    let Needs { harmonics, pressure, root_stress, .. } = needs;
    if needs.load_sharing || root_stress {
        return summary(case, Wanted { harmonics: harmonics.max(needs.spans_for), pressure, root_stress });
    }
    let unloaded_peak_to_peak = if needs.unloaded {
        let nominal = case.without_load();
        difference(&nominal, extremes(&nominal))
    } else {
        f64::NAN
    };
    let (mut error, mut pressures) = (Trace { spans: Vec::with_capacity(32) }, Trace::default());
    let (period, rows) = (case.cycle.period(), &case.cycle.rows);
    let [largest, smallest] = if needs.walks() {
        walk(case, span_length(case, needs.spans_for.max(harmonics)), |span, states| {
            error.spans.push((*span, states.each_ref().map(Equilibrium::transmission_error)));
            if pressure {
                let pressed = |node: usize| pressed(case, span.position(rows, node), span.pairs, &states[node]).largest;
                pressures.spans.push((*span, std::array::from_fn(pressed)));
            }
        });
        let value = |position: f64, pairs: usize| case.state(position, pairs).transmission_error();
        [error.largest(rows, refining(case), value), error.smallest(rows, refining(case), value)]
    } else {
        extremes(&case.for_values())
    };
    let nodes = error.nodes(rows);
    let (mean, variance) =
        if needs.integrals { harmonics::mean_and_variance(period, &nodes) } else { (f64::NAN, f64::NAN) };
    Summary {
        mean,
        peak_to_peak: largest.value - smallest.value,
        largest,
        smallest,
        variance,
        reciprocal_variance: (variance > 0.0).then(|| 1.0 / variance),
        harmonics: harmonics::amplitudes(period, &nodes, harmonics),
        unloaded_peak_to_peak,
        loaded_contact_ratio: f64::NAN,
        largest_load_share: f64::NAN,
        largest_pressure: pressure.then(|| largest_pressure(case, &pressures)),
        largest_root_stress: None,
    }
}
