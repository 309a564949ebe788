//! Where the values of drawn rows come from.
//!
//! Must not know: which rows there are.

use super::method::Method;
use crate::stage::rows::values::{Level, level};
use declare::seed::Seed;
use gearmesh::optimize::by_number::{LatinHypercube, Random};
use gearmesh::optimize::sobol::Sequence;

/// Where values are drawn from.
#[derive(Debug)]
pub enum Span {
    Between { low: f64, high: f64, whole: Option<f64>, unit: String },
    Of(Vec<Level>),
}

impl Span {
    /// The value at a share of the span, 0 to 1.
    pub fn at(&self, share: f64) -> Level {
        // Below the count, which is far below 2^53.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let of = |count: f64| (share * count).floor().min(count - 1.0);
        match self {
            Self::Between { low, high, whole: Some(step), .. } => {
                let si = low + step * of((high - low) / step + 1.0);
                Level { si, shown: si }
            }
            Self::Between { low, high, whole: None, unit } => {
                // The weighted mean, as `Bounds::point` has it: no rounding leaves the span.
                level((low * (1.0 - share) + high * share).clamp(*low, *high), unit)
            }
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            Self::Of(levels) => levels[of(levels.len() as f64) as usize],
        }
    }
}

/// Where the shares come from.
pub enum Draw {
    Strata(LatinHypercube),
    Sobol(Sequence),
    Random(Random),
}

impl Draw {
    pub fn new(method: Method, dimension: usize, seed: &Seed) -> Self {
        match method {
            Method::LatinHypercube(one) => Self::Strata(LatinHypercube::new(one.samples, dimension, seed)),
            Method::Sobol(_) => Self::Sobol(Sequence::new(dimension)),
            _ => Self::Random(Random::new(*seed)),
        }
    }

    pub fn point(&self, number: usize, point: &mut [f64]) {
        match self {
            Self::Strata(sample) => sample.point(number, point),
            Self::Sobol(sequence) => {
                point
                    .iter_mut()
                    .enumerate()
                    .for_each(|(variable, share)| *share = sequence.coordinate(variable, number));
            }
            Self::Random(sample) => sample.point(number, point),
        }
    }
}
