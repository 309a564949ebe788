//! Tables `samples` and `sample_summary`: the transmission error at equidistant positions, as articles print it.
//!
//! A mean, a variance or an extreme of a few samples is not that of the curve; these are here to be put beside printed
//! ones. Must not know: how a position is solved.

use super::rows::{Keyed, keyed};
use gearmesh::gear::mesh::Loaded;
use studygraph::table::columns::Columns;

pub const TABLE: &str = "samples";
pub const SUMMARY: &str = "sample_summary";

/// So near to the end of the base pitch a position is its start, whatever rounding made of it.
const BORDER: f64 = 1e-12;

/// One of the equidistant positions.
#[derive(Clone, Copy)]
pub struct Sample {
    /// From 1.
    number: usize,
    /// From the first sample \[deg\]: in degrees from the start, so that a twelfth of a thirtieth of a turn is 1.
    angle: f64,
    position: f64,
    error: f64,
}

pub fn samples<'a>(stated: &[usize]) -> Columns<Keyed<'a, Sample>> {
    let position = "Distance from where a pair starts contact, along the line of action.";
    keyed(TABLE, "Transmission error at equidistant positions of the mesh cycle.", stated)
        .integer("sample", "Counts the positions, from 1.", |row: &Keyed<Sample>| row.2.number)
        .key()
        .shown("rotation_angle", "deg", "Rotation of the pinion from the first sample.", |row| row.2.angle)
        .float("cycle_position", "mm", position, |row| row.2.position)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("transmission_error", "um", "Approach of the gears along the line of action.", |row| row.2.error)
        .on_demand()
}

/// What the samples of a curve amount to.
#[derive(Clone, Copy)]
pub struct Samples {
    mean: f64,
    peak_to_peak: f64,
    variance: f64,
}

impl Samples {
    fn fitness(&self) -> f64 {
        if self.variance > 0.0 { 1.0 / self.variance } else { f64::NAN }
    }
}

pub fn summary<'a>(stated: &[usize]) -> Columns<Keyed<'a, Samples>> {
    let fitness = "f = n/Σ(TE − mean)² (mei2016, equation 16); NaN where nothing varies.";
    keyed(SUMMARY, "What the samples of each curve amount to.", stated)
        .float("mean", "um", "Mean of the samples.", |row: &Keyed<Samples>| row.2.mean)
        .float("peak_to_peak", "um", "Largest less smallest sample.", |row| row.2.peak_to_peak)
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("variance", "um^2", "Mean squared deviation from the mean.", |row| row.2.variance)
        .but(|column| column.tolerance(1e-15, 1e-9))
        .float("fitness", "1/um^2", fitness, |row| row.2.fitness())
        .but(|column| column.allows_nan().tolerance(0.0, 1e-8))
        .on_demand()
}

/// The samples of a curve, and what they amount to; `first` is the pinion's rotation from where
/// a pair starts contact \[rad\].
pub fn taken(loading: &Loaded, first: f64, count: usize) -> (Vec<Sample>, Samples) {
    let cycle = loading.mesh();
    let teeth = f64::from(cycle.pair.pinion.specification.teeth);
    let sample = |index: usize| {
        let share = (first * teeth / std::f64::consts::TAU + index as f64 / count as f64).rem_euclid(1.0);
        let position = if share < 1.0 - BORDER { share * cycle.period() } else { 0.0 };
        let error = loading.state(position, cycle.pairs_behind(position)).transmission_error();
        Sample { number: index + 1, angle: 360.0 * index as f64 / (count as f64 * teeth), position, error }
    };
    let samples: Vec<_> = (0..count).map(sample).collect();
    let errors = || samples.iter().map(|sample| sample.error);
    let mean = errors().sum::<f64>() / count as f64;
    let variance = errors().map(|error| (error - mean) * (error - mean)).sum::<f64>() / count as f64;
    let [maximum, minimum] = [errors().fold(f64::NEG_INFINITY, f64::max), errors().fold(f64::INFINITY, f64::min)];
    let summary = Samples { mean, peak_to_peak: maximum - minimum, variance };
    (samples, summary)
}
