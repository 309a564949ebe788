//! What is asked of a curve and no more: for many designs, of which nobody looks at the points.
//!
//! The values are those of [`Summary`], from the same spans, to the last bit; where nothing but extremes is asked, those of
//! [`LoadCase::peak_to_peak`], which agree with them to rounding. Must not know: tables, units other than SI.
//!
//! [`Summary`]: super::curve::Summary

use super::load_case::{Equilibrium, LoadCase};
use super::pressure::LargestPressure;
use super::trace::{Extremum, Trace};
use crate::numeric::harmonics;

/// What is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Asked {
    /// Whether integrals are: mean and variance.
    pub integrals: bool,
    /// How many harmonics.
    pub harmonics: usize,
    /// For how many harmonics the spans are short enough: at least as many as are asked.
    pub spans_for: usize,
    /// Whether the largest pressure is.
    pub pressure: bool,
    /// Whether the peak-to-peak without load is.
    pub unloaded: bool,
}

/// What was found; what was not asked is 0 or none.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The largest δ \[m\], and where it is.
    pub largest: Extremum,
    /// The smallest δ \[m\], and where it is.
    pub smallest: Extremum,
    /// Integral mean over the cycle \[m\].
    pub mean: f64,
    /// Integral mean of the squared deviation from the mean \[m²\].
    pub variance: f64,
    /// Amplitudes of the harmonics 1, 2 … of the mesh frequency \[m\].
    pub harmonics: Vec<f64>,
    /// The largest pressure in the cycle.
    pub pressure: Option<LargestPressure>,
    /// Peak-to-peak of the transmission error without load \[m\].
    pub unloaded_peak_to_peak: f64,
}

impl Asked {
    /// Whether the curve is walked once, with all that its integrals need.
    fn is_more_than_extremes(self) -> bool {
        self.integrals || self.harmonics > 0 || self.pressure
    }
}

impl LoadCase<'_> {
    /// What is asked of the curve.
    #[must_use]
    pub fn asked(&self, asked: Asked) -> Found {
        let unloaded_peak_to_peak = if asked.unloaded {
            let nominal = self.without_load();
            nominal.between(nominal.extremes())
        } else {
            0.0
        };
        if !asked.is_more_than_extremes() {
            let [largest, smallest] = self.for_values().extremes();
            let (harmonics, pressure) = (Vec::new(), None);
            return Found { largest, smallest, mean: 0.0, variance: 0.0, harmonics, pressure, unloaded_peak_to_peak };
        }
        let (period, rows) = (self.cycle.period(), &self.cycle.rows);
        let (mut error, mut pressure) = (Trace { spans: Vec::with_capacity(32) }, Trace::default());
        self.walk(self.span_length(asked.spans_for.max(asked.harmonics)), |span, states| {
            error.spans.push((*span, states.each_ref().map(Equilibrium::transmission_error)));
            if asked.pressure {
                let pressed = |node: usize| self.pressed(span.position(rows, node), span.pairs, &states[node]).largest;
                pressure.spans.push((*span, std::array::from_fn(pressed)));
            }
        });
        let value = |position: f64, pairs: usize| self.state(position, pairs).transmission_error();
        let (largest, smallest) =
            (error.largest(rows, self.refining(), value), error.smallest(rows, self.refining(), value));
        let nodes = error.nodes(rows);
        let (mean, variance) = if asked.integrals { harmonics::mean_and_variance(period, &nodes) } else { (0.0, 0.0) };
        Found {
            largest,
            smallest,
            mean,
            variance,
            harmonics: harmonics::amplitudes(period, &nodes, asked.harmonics),
            pressure: asked.pressure.then(|| self.largest_pressure(&pressure)),
            unloaded_peak_to_peak,
        }
    }
}
