//! The rows of a scatter: samples by their number, each at all values of what is looked at for every sample.
//!
//! The first samples also come with one field after the other as another point has it, and with all of them: what Sobol' indices
//! are made of. A sample is known by its number, whatever others there are; but in a Latin hypercube, whose strata follow from
//! how many there are. Must not know: what is computed of a row.

use std::ops::Range;

use super::correlation::Copula;
use crate::stage::RowCount;
use crate::stage::rows::gathered::RowParts;
use crate::stage::rows::values::{Level, RowSet, level};
use crate::stage::rows::{Column, rows_of_part};
use declare::Words;
use declare::declared::Words as _;
use declare::digest::{Digest, Writer};
use declare::error::Failure;
use declare::record::varied::Values;
use declare::seed::Seed;
use gearmesh::numeric::distribution::Distribution;
use gearmesh::numeric::replicates::REPLICATES;
use gearmesh::optimize::by_number::{LatinHypercube, Random};
use gearmesh::optimize::scrambled::Scrambled;

/// Where samples come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Method {
    /// evenly spread points, scrambled: errors fall fastest; best when there are eight times a power of two
    Sobol,
    /// one point in each of as many strata of every field as there are points
    LatinHypercube,
    /// independent points
    Random,
}

/// A column's values.
#[derive(Clone, Debug)]
enum Source {
    /// Index among those that are distributed.
    Drawn(usize),
    /// Index among those that are looked at in every sample.
    Crossed(usize),
}

/// All rows.
#[derive(Debug)]
pub struct Layout {
    pub method: Method,
    pub samples: usize,
    /// Samples that come with other values of each field.
    pub pairs: usize,
    /// By column.
    sources: Vec<Source>,
    units: Vec<String>,
    pub distributions: Vec<Distribution>,
    /// Ascending.
    crossed: Vec<Vec<Level>>,
    copula: Option<Copula>,
    /// Samples of each part.
    parts: Vec<Range<usize>>,
}

impl Layout {
    /// Columns with their distributions; those without have values.
    pub fn new(
        columns: &[Column],
        distributions: &[Option<Distribution>],
        method: Method,
        [samples, pairs]: [usize; 2],
        copula: Option<Copula>,
    ) -> Self {
        let (mut drawn, mut crossed, mut sources) = (Vec::new(), Vec::new(), Vec::new());
        for (column, distribution) in columns.iter().zip(distributions) {
            if let Some(distribution) = distribution {
                sources.push(Source::Drawn(drawn.len()));
                drawn.push(*distribution);
                continue;
            }
            sources.push(Source::Crossed(crossed.len()));
            let values: &[f64] = if let Values::Each(values) = &column.axis.values { values } else { &[] };
            let mut levels: Vec<Level> = values.iter().map(|si| level(*si, &column.axis.unit)).collect();
            levels.sort_by(|one, two| one.shown.total_cmp(&two.shown));
            crossed.push(levels);
        }
        let units = columns.iter().map(|column| column.axis.unit.clone()).collect();
        let pairs = pairs.min(samples);
        let mut layout =
            Self { method, samples, pairs, sources, units, distributions: drawn, crossed, copula, parts: Vec::new() };
        layout.parts = layout.cut();
        layout
    }

    /// Rows of a sample: of one of the first, and of one that comes by itself, each for all that is looked at in it.
    fn of_sample(&self) -> [usize; 2] {
        [self.cases() * (self.distributions.len() + 2), self.cases()]
    }

    /// How many combinations there are of what is looked at in every sample.
    pub fn cases(&self) -> usize {
        self.crossed.iter().map(Vec::len).product()
    }

    /// Values as shown, in the order of the columns that are looked at in every sample, of a combination.
    pub fn case(&self, mut number: usize) -> Vec<f64> {
        let mut found = vec![0.0; self.crossed.len()];
        for (slot, levels) in found.iter_mut().zip(&self.crossed).rev() {
            *slot = levels[number % levels.len()].shown;
            number /= levels.len();
        }
        found
    }

    pub fn is_crossed(&self, column: usize) -> bool {
        matches!(self.sources[column], Source::Crossed(_))
    }

    pub fn count(&self) -> usize {
        self.count_between(&(0..self.samples))
    }

    fn count_between(&self, samples: &Range<usize>) -> usize {
        let [with, without] = self.of_sample();
        let first = samples.end.min(self.pairs).saturating_sub(samples.start);
        first.saturating_mul(with).saturating_add((samples.len() - first).saturating_mul(without))
    }

    fn cut(&self) -> Vec<Range<usize>> {
        let target = rows_of_part(self.count());
        let [with, without] = self.of_sample();
        let stretch = |from: usize, to: usize, rows: usize| {
            let each = (target / rows).max(1);
            (from..to).step_by(each).map(move |start| start..to.min(start + each))
        };
        stretch(0, self.pairs, with).chain(stretch(self.pairs, self.samples, without)).collect()
    }

    /// Of the fields that are distributed.
    fn values(&self, shares: &[f64]) -> Vec<Level> {
        let drawn = self.sources.iter().zip(&self.units).filter(|(source, _)| matches!(source, Source::Drawn(_)));
        let of = |((distribution, share), (_, unit)): ((&Distribution, &f64), (&Source, &String))| {
            let found = level(distribution.quantile(*share), unit);
            // What is written with fewer digits may be beyond an end by a rounding.
            let (low, high) = distribution.range();
            Level { si: found.si.clamp(low, high), ..found }
        };
        self.distributions.iter().zip(shares).zip(drawn).map(of).collect()
    }

    fn levels<'l>(
        &'l self,
        own: &'l [Level],
        other: &'l [Level],
        replaced: usize,
        case: usize,
    ) -> impl Iterator<Item = Level> + 'l {
        let all = replaced == self.distributions.len() + 1;
        self.sources.iter().map(move |source| match *source {
            Source::Drawn(field) => {
                if all || replaced == field + 1 {
                    other[field]
                } else {
                    own[field]
                }
            }
            Source::Crossed(at) => {
                let behind: usize = self.crossed[at + 1..].iter().map(Vec::len).product();
                self.crossed[at][case / behind % self.crossed[at].len()]
            }
        })
    }
}

/// Where shares come from: replicates that were drawn apart, in turn.
enum Draw {
    Sobol(Scrambled),
    Strata(Vec<LatinHypercube>),
    Random(Random),
}

impl RowParts for Layout {
    fn parts(&self) -> usize {
        self.parts.len()
    }

    /// What is in a part: its rows, whatever others there are.
    fn digest(&self, part: usize) -> Digest {
        let mut writer = Writer::new("gearstudy 1 scatter part");
        let range = &self.parts[part];
        writer.text(self.method.word()).count(range.start).count(range.end);
        writer.flag(range.start < self.pairs);
        writer.count(if self.method == Method::LatinHypercube { self.samples } else { 0 });
        for distribution in &self.distributions {
            match *distribution {
                Distribution::Uniform { low, high } => writer.text("uniform").float(low).float(high),
                Distribution::Triangular { low, mode, high } => {
                    writer.text("triangular").float(low).float(mode).float(high)
                }
                Distribution::Normal { mean, deviation, low, high } => {
                    writer.text("normal").float(mean).float(deviation).float(low).float(high)
                }
            };
        }
        for levels in &self.crossed {
            writer.floats(&levels.iter().map(|level| level.shown).collect::<Vec<_>>());
        }
        if let Some(copula) = &self.copula {
            writer.text("correlated").floats(&copula.factors());
        }
        writer.finish()
    }

    fn rows(&self, part: usize, seed: &Seed) -> Result<RowSet, Failure> {
        let fields = self.distributions.len();
        let draw = Draw::new(self.method, self.samples, 2 * fields, seed);
        let mut rows = RowSet::new(2, self.sources.len());
        let mut points = vec![0.0; 2 * fields];
        for number in self.parts[part].clone() {
            draw.point(number, &mut points);
            let (first, second) = points.split_at_mut(fields);
            if let Some(copula) = &self.copula {
                copula.correlate(first);
            }
            let [own, other] = [&*first, &*second].map(|shares| self.values(shares));
            let replaced = if number < self.pairs { fields + 2 } else { 1 };
            for replaced in 0..replaced {
                for case in 0..self.cases() {
                    rows.push(&[number + 1, replaced], self.levels(&own, &other, replaced, case));
                }
            }
        }
        Ok(rows)
    }

    fn row_count(&self, part: Option<usize>) -> RowCount {
        RowCount::exact(part.map_or_else(|| self.count(), |part| self.count_between(&self.parts[part])))
    }
}

impl Draw {
    fn new(method: Method, samples: usize, dimension: usize, seed: &Seed) -> Self {
        match method {
            Method::Sobol => Self::Sobol(Scrambled::new(REPLICATES, dimension, seed)),
            Method::LatinHypercube => {
                let count = |replicate: usize| (samples + REPLICATES - 1 - replicate) / REPLICATES;
                let of = |replicate: usize| LatinHypercube::new(count(replicate), dimension, &seed.branch(replicate));
                Self::Strata((0..REPLICATES).map(of).collect())
            }
            Method::Random => Self::Random(Random::new(*seed)),
        }
    }

    fn point(&self, number: usize, point: &mut [f64]) {
        let (replicate, index) = (number % REPLICATES, number / REPLICATES);
        match self {
            Self::Sobol(sequence) => {
                for (variable, share) in point.iter_mut().enumerate() {
                    *share = sequence.coordinate(replicate, variable, index);
                }
            }
            Self::Strata(samples) => samples[replicate].point(index, point),
            Self::Random(sample) => sample.point(number, point),
        }
        // A normal number of 0 or 1 is endless.
        for share in point {
            *share = share.clamp(f64::EPSILON, 1.0 - f64::EPSILON);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(method: Method, samples: usize) -> Vec<Vec<f64>> {
        let draw = Draw::new(method, samples, 3, &Seed::of_stage(3, "draw"));
        (0..samples)
            .map(|number| {
                let mut point = vec![0.0; 3];
                draw.point(number, &mut point);
                point
            })
            .collect()
    }

    #[test]
    fn more_samples_leave_the_first_as_they_are_but_in_a_latin_hypercube() {
        for method in [Method::Sobol, Method::Random] {
            assert_eq!(points(method, 100), points(method, 260)[..100]);
        }
        assert_ne!(points(Method::LatinHypercube, 100), points(Method::LatinHypercube, 260)[..100]);
    }

    /// Each replicate by itself fills its strata.
    #[test]
    fn replicates_are_samples_by_themselves() {
        for method in [Method::Sobol, Method::LatinHypercube] {
            let all = points(method, 8 * 32);
            for replicate in 0..REPLICATES {
                for variable in 0..3 {
                    let own = all.iter().skip(replicate).step_by(REPLICATES).map(|point| point[variable]);
                    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                    let mut strata: Vec<usize> = own.map(|share| (share * 32.0) as usize).collect();
                    strata.sort_unstable();
                    assert!(strata.into_iter().eq(0..32), "{method:?} {replicate} {variable}");
                }
            }
        }
    }
}
