//! What all samples come to: numbers with their errors, quantiles, yields, indices.
//!
//! The outputs of all samples are in memory, eight bytes each; the rest of the rows passes by part by part. Sums run in the
//! order of the samples. Must not know: what a column means.

use super::Scatter;
use super::distributions::described;
use super::tables::{self, About, Bin, FieldRow, OfField, Quantile, Statistics, YieldRow};
use crate::stage::RowCount;
use crate::stage::rows::Column;
use crate::stage::rows::computed::REASON;
use crate::stage::rows::counting::bin;
use crate::stage::rows::gathered::Tally;
use crate::stage::rows::invalid::{self, Invalid, MOST_REASONS};
use declare::units::showing;
use gearmesh::numeric::indices::{Pair, indices};
use gearmesh::numeric::replicates::{Sample, share};
use studygraph::table::data::{Data, Table, TableError};
use studygraph::table::schema::Schema;

/// Steps of the table `distribution`, for so many samples: about their cube root (Rice), within what can be seen.
fn steps(samples: usize) -> usize {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small and positive
    let steps = (2.0 * libm::cbrt(samples as f64)) as usize;
    steps.clamp(8, 64)
}

/// Shares of which the quantiles are found, unless others are asked.
pub const SHARES: [f64; 7] = [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99];
/// Rows of the table `yield` that no study states.
const VALID: &str = "valid";
const ALL: &str = "all limits";

/// What of the rows is kept.
pub struct Results<'s> {
    scatter: &'s Scatter,
    /// By case and output the number of each sample; NaN where there is none.
    values: Vec<Vec<f64>>,
    /// The same of the first samples with each field replaced, and with all.
    replaced: Vec<Vec<f64>>,
    invalid: Invalid,
    invalid_samples: usize,
    last_invalid: Option<usize>,
}

impl<'s> Results<'s> {
    pub fn new(scatter: &'s Scatter) -> Self {
        let layout = &scatter.layout;
        let groups = layout.cases() * scatter.asked.outputs.len();
        let variations = layout.pairs * (layout.distributions.len() + 1);
        Self {
            scatter,
            values: vec![vec![f64::NAN; layout.samples]; groups],
            replaced: vec![vec![f64::NAN; variations]; groups],
            invalid: Invalid::default(),
            invalid_samples: 0,
            last_invalid: None,
        }
    }

    fn made(self) -> Result<Vec<Table>, TableError> {
        let (layout, asked) = (&self.scatter.layout, &self.scatter.asked);
        let cases: Vec<Vec<f64>> = (0..layout.cases()).map(|case| layout.case(case)).collect();
        let names: Vec<&str> = asked.outputs.iter().map(|output| output.column.name.as_str()).collect();
        let fields: Vec<&str> = self.scatter.drawn().map(|column| column.axis.name.as_str()).collect();
        let (mut statistics, mut quantiles, mut bins, mut of_fields) = (vec![], vec![], vec![], vec![]);
        for (group, values) in self.values.iter().enumerate() {
            let (case, output) = (&cases[group / names.len()], names[group % names.len()]);
            let about = |what| About { output, case, what };
            let sample = Sample::new(values);
            let Some(range) = sample.range() else { continue };
            let (mean, deviation) = (sample.mean(), sample.deviation());
            statistics.push(about(Statistics { valid: sample.count(), mean, deviation, range }));
            quantiles.extend(self.scatter.shares.iter().map(|share| About {
                output,
                case,
                what: Quantile { share: *share, at: sample.quantile(*share) },
            }));
            bins.extend(binned(values, range).into_iter().map(|what| About { output, case, what }));
            let count = fields.len() + 1;
            let pairs = self.replaced[group]
                .chunks_exact(count.max(1))
                .zip(values)
                .map(|(replaced, own)| Pair { both: [*own, replaced[count - 1]], replaced: &replaced[..count - 1] });
            if layout.pairs > 0 {
                let (found, pairs) = indices(pairs, fields.len());
                of_fields.extend(fields.iter().zip(found).map(|(field, indices)| About {
                    output,
                    case,
                    what: OfField { field, indices, pairs },
                }));
            }
        }
        let crossed: Vec<&Column> = self.scatter.crossed().collect();
        let yields = self.yields(&cases);
        let drawn: Vec<FieldRow> = self.scatter.drawn().zip(&layout.distributions).map(field_row).collect();
        Ok(vec![
            tables::statistics(&crossed).table(&statistics)?,
            tables::quantiles(&crossed).table(&quantiles)?,
            tables::distribution(&crossed).table(&bins)?,
            tables::yields(&crossed).table(&yields)?,
            tables::indices(&crossed).table(&of_fields)?,
            tables::fields().table(&drawn)?,
            self.invalid.table()?,
        ])
    }

    fn yields(&self, cases: &[Vec<f64>]) -> Vec<YieldRow<'s>> {
        let (scatter, outputs) = (self.scatter, self.scatter.asked.outputs.len());
        let limits = &scatter.limits;
        // By case, then by limit, whether each sample keeps to it; the first is that it has all its numbers.
        let keeps = |case: usize, limit: Option<usize>, sample: usize| match limit {
            None => (0..outputs).any(|output| !self.values[case * outputs + output][sample].is_nan()),
            Some(at) => limits[at].holds(self.values[case * outputs + limits[at].column][sample]),
        };
        let mut asked: Vec<(&'s str, Vec<Option<usize>>)> = vec![(VALID, vec![None])];
        asked.extend(limits.iter().enumerate().map(|(at, limit)| (limit.text.as_str(), vec![Some(at)])));
        if limits.len() > 1 {
            asked.push((ALL, (0..limits.len()).map(Some).collect()));
        }
        let mut rows = Vec::new();
        for (limit, of) in asked {
            let mut row = |number: usize, case: Vec<f64>, looked_at: std::ops::Range<usize>| {
                let kept: Vec<bool> = (0..scatter.layout.samples)
                    .map(|sample| looked_at.clone().all(|case| of.iter().all(|limit| keeps(case, *limit, sample))))
                    .collect();
                let (samples, count) = (kept.len(), kept.iter().filter(|kept| **kept).count());
                rows.push(YieldRow { limit, number, case, samples, kept: count, share: share(&kept) });
            };
            let crossed = cases.first().map_or(0, Vec::len);
            row(0, vec![f64::NAN; crossed], 0..cases.len());
            for (at, case) in cases.iter().enumerate().filter(|_| cases.len() > 1) {
                row(at + 1, case.clone(), at..at + 1);
            }
        }
        rows
    }
}

fn binned(values: &[f64], (low, high): (f64, f64)) -> Vec<Bin> {
    let valid = || values.iter().filter(|value| !value.is_nan());
    let steps = steps(valid().count());
    let mut counts = vec![0_usize; steps];
    valid().for_each(|value| counts[bin(*value, low, high, steps)] += 1);
    let width = (high - low) / steps as f64;
    let of = |(at, count): (usize, usize)| Bin {
        number: at + 1,
        from: low + width * at as f64,
        to: if at + 1 == steps { high } else { low + width * (at + 1) as f64 },
        count,
    };
    counts.into_iter().enumerate().map(of).collect()
}

fn field_row<'a>((field, distribution): (&'a Column, &gearmesh::numeric::distribution::Distribution)) -> FieldRow<'a> {
    let show = showing(&field.axis.unit);
    let (mean, deviation) = distribution.moments();
    let (low, high) = distribution.range();
    let numbers = [show(mean), show(deviation), show(low), show(high)];
    FieldRow { field, described: described(field, distribution), numbers }
}

impl Tally for Results<'_> {
    fn add(&mut self, _pass: usize, table: &Table) {
        let (layout, asked) = (&self.scatter.layout, &self.scatter.asked);
        let (samples, replaced) = (table.integers(super::NUMBER), table.integers(super::REPLACED));
        let outputs: Vec<&[f64]> = asked.outputs.iter().map(|output| table.floats(&output.column.name)).collect();
        let reasons = table.texts(REASON);
        let fields: Vec<&Data> = asked.columns.iter().filter_map(|column| table.column(&column.axis.name)).collect();
        let variations = layout.distributions.len() + 1;
        for (row, reason) in reasons.iter().enumerate() {
            let (Ok(sample), Ok(replaced)) = (usize::try_from(samples[row] - 1), usize::try_from(replaced[row])) else {
                continue;
            };
            if !reason.is_empty() && replaced == 0 {
                self.invalid.add(reason, || row_described(&asked.columns, &fields, row));
                if self.last_invalid != Some(sample) {
                    self.invalid_samples += 1;
                    self.last_invalid = Some(sample);
                }
            }
            // Every part has whole samples, each with all its cases, one behind the other.
            let case = row % layout.cases();
            for (at, values) in outputs.iter().enumerate() {
                let group = case * outputs.len() + at;
                if replaced == 0 {
                    self.values[group][sample] = values[row];
                } else {
                    self.replaced[group][sample * variations + replaced - 1] = values[row];
                }
            }
        }
    }

    /// What is told of samples without numbers.
    fn warning(&self) -> Option<String> {
        let (reason, row) = self.invalid.most_frequent()?;
        let all = self.scatter.layout.samples;
        let share = 100.0 * self.invalid_samples as f64 / all as f64;
        let count = self.invalid_samples;
        let have = if count == 1 { "has" } else { "have" };
        Some(format!("{count} of {all} samples ({share:.3} %) {have} no numbers, most often, with {row}: {reason}"))
    }

    fn tables(self: Box<Self>) -> Result<Vec<Table>, TableError> {
        self.made()
    }
}

fn row_described(columns: &[Column], fields: &[&Data], row: usize) -> String {
    let one = |(column, data): (&Column, &&Data)| {
        format!("{} = {} {}", column.axis.name, data.cell(row), column.axis.unit).trim().to_owned()
    };
    columns.iter().zip(fields).map(one).collect::<Vec<_>>().join(", ")
}

/// The schemas of these tables, in their order.
pub fn schemas(scatter: &Scatter) -> Vec<Schema> {
    let crossed: Vec<&Column> = scatter.crossed().collect();
    vec![
        tables::statistics(&crossed).schema(),
        tables::quantiles(&crossed).schema(),
        tables::distribution(&crossed).schema(),
        tables::yields(&crossed).schema(),
        tables::indices(&crossed).schema(),
        tables::fields().schema(),
        invalid::columns().schema(),
    ]
}

/// How many rows they have, in the order of [`schemas`].
pub fn foreseen(scatter: &Scatter) -> Vec<RowCount> {
    let layout = &scatter.layout;
    let groups = layout.cases() * scatter.asked.outputs.len();
    let limits = scatter.limits.len() + 1 + usize::from(scatter.limits.len() > 1);
    let cases = if layout.cases() > 1 { layout.cases() + 1 } else { 1 };
    let fields = layout.distributions.len();
    vec![
        RowCount::at_most(groups),
        RowCount::at_most(groups * scatter.shares.len()),
        RowCount::at_most(groups * steps(layout.samples)),
        RowCount::exact(limits * cases),
        RowCount::at_most(if layout.pairs > 0 { groups * fields } else { 0 }),
        RowCount::exact(fields),
        RowCount::at_most(MOST_REASONS.min(layout.samples)),
    ]
}

/// Bytes that they take before they are tables: all numbers, and one output's again in order.
pub fn held(scatter: &Scatter) -> u64 {
    let layout = &scatter.layout;
    let groups = (layout.cases() * scatter.asked.outputs.len()) as u64;
    let (samples, pairs) = (layout.samples as u64, layout.pairs as u64 * (layout.distributions.len() as u64 + 1));
    groups.saturating_mul(samples.saturating_add(pairs)).saturating_add(3 * samples).saturating_mul(8)
}
