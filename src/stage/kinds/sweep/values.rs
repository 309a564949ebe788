//! Values of varied fields: as a field holds them and as a column shows them, and where they are drawn from.
//!
//! Must not know: which rows there are.

use super::method::Method;
use declare::seed::Seed;
use declare::units::{parse_quantity, showing};
use gearmesh::optimize::by_number::{LatinHypercube, Random};
use gearmesh::optimize::sobol::Sequence;

/// A value of a field: as the field holds it, and as the column shows it. The first follows from the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    pub si: f64,
    pub shown: f64,
}

/// The level nearest to a value.
pub fn level(si: f64, unit: &str) -> Level {
    if unit.is_empty() {
        return Level { si, shown: si };
    }
    let read = |shown: f64| parse_quantity(&format!("{shown:e} {unit}")).map_or(f64::NAN, |quantity| quantity.value);
    let shown = showing(unit)(si);
    // As somebody would have written it, where that is it.
    let rounded = format!("{shown:.14e}").parse().unwrap_or(shown);
    if read(rounded).to_bits() == si.to_bits() {
        Level { si, shown: rounded }
    } else {
        Level { si: read(shown), shown }
    }
}

/// Where values are drawn from.
#[derive(Debug)]
pub enum Span {
    Between { low: f64, high: f64, whole: Option<f64>, unit: String },
    Of(Vec<Level>),
}

/// Rows of a part, one behind the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RowSet {
    width: usize,
    si: Vec<f64>,
    shown: Vec<f64>,
    /// The numbers of drawn rows, from 1; 0 for others.
    pub numbers: Vec<usize>,
}

impl RowSet {
    /// Without rows yet, of so many columns.
    pub fn new(width: usize) -> Self {
        Self { width, ..Self::default() }
    }

    pub fn len(&self) -> usize {
        self.numbers.len()
    }

    /// By column, in SI.
    pub fn si(&self, row: usize) -> &[f64] {
        &self.si[row * self.width..(row + 1) * self.width]
    }

    /// By column, as shown.
    pub fn shown(&self, row: usize) -> &[f64] {
        &self.shown[row * self.width..(row + 1) * self.width]
    }

    pub fn push(&mut self, number: usize, levels: impl Iterator<Item = Level>) {
        self.numbers.push(number);
        for level in levels {
            self.si.push(level.si);
            self.shown.push(level.shown);
        }
    }

    pub fn pop(&mut self) {
        self.numbers.pop();
        self.si.truncate(self.numbers.len() * self.width);
        self.shown.truncate(self.numbers.len() * self.width);
    }
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
