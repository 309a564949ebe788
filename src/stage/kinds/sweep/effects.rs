//! What all rows come to: main effects, maps of two fields, distributions, the best rows, the invalid ones.
//!
//! Rows pass by twice, part by part: first for their extremes, then for the counts between them, so that memory does not
//! grow with their number. Quantiles are read off 1024 equal steps between the extremes and are right to one of them.
//! Sums run in the order of the rows. Must not know: what a column means.

use super::Sweep;
use super::tables::{self, BestRow, Bin, EffectRow, MapCell, QUANTILES, Quantile, Share};
use crate::stage::RowCount;
use crate::stage::rows::Column;
use crate::stage::rows::computed::REASON;
use crate::stage::rows::counting::{BINS, Group, Moments, bin, quantile, strata};
use crate::stage::rows::gathered::Tally;
use crate::stage::rows::invalid::{self, Invalid, MOST_REASONS};
use studygraph::table::data::{Data, Table, TableError};
use studygraph::table::schema::Schema;

/// Steps of the table `distribution`.
const SHOWN_BINS: usize = 32;
/// The most values or strata that a map has of a field.
const MOST_OF_MAP: usize = 40;

/// What of the rows is kept.
pub struct Effects<'s> {
    sweep: &'s Sweep,
    groups: Vec<Group>,
    /// By output.
    all: Vec<Moments>,
    /// By field, group and output.
    of_groups: Vec<Vec<Vec<Moments>>>,
    /// Counts in steps, by field, group and output; and by output alone.
    steps: Vec<Vec<Vec<Vec<u32>>>>,
    whole: Vec<Vec<u64>>,
    /// Of the objective, by pair of fields.
    maps: Vec<([usize; 2], Vec<Moments>)>,
    best: Vec<(f64, Vec<f64>)>,
    invalid: Invalid,
    rows: u64,
}

impl<'s> Effects<'s> {
    pub fn new(sweep: &'s Sweep) -> Self {
        let (groups, outputs) = (groups(sweep), sweep.asked.outputs.len());
        let effects = groups.iter().map(|group| vec![vec![Moments::default(); outputs]; group.len()]).collect();
        let steps = groups.iter().map(|group| vec![vec![vec![0; BINS]; outputs]; group.len()]).collect();
        let maps = pairs(&groups).into_iter().map(|pair| {
            let cells = pair.map(|field| groups[field].len()).iter().product();
            (pair, vec![Moments::default(); cells])
        });
        Self {
            sweep,
            all: vec![Moments::default(); outputs],
            of_groups: effects,
            steps,
            whole: vec![vec![0; BINS]; outputs],
            maps: maps.collect(),
            best: Vec::new(),
            invalid: Invalid::default(),
            rows: 0,
            groups,
        }
    }

    fn add_row(&mut self, at: &[usize], fields: &[&Data], outputs: &[&[f64]], row: usize) {
        for (index, values) in outputs.iter().enumerate() {
            let value = values[row];
            if value.is_nan() {
                continue;
            }
            self.all[index].add(value);
            for (effects, group) in self.of_groups.iter_mut().zip(at) {
                effects[*group][index].add(value);
            }
        }
        let objective = outputs[self.sweep.objective][row];
        if objective.is_nan() {
            return;
        }
        for ([one, two], cells) in &mut self.maps {
            cells[at[*one] * self.groups[*two].len() + at[*two]].add(objective);
        }
        let full = self.best.len() >= self.sweep.best;
        if full && self.best.last().is_some_and(|(last, _)| objective.total_cmp(last).is_ge()) {
            return;
        }
        // Of rows alike the first one stays ahead.
        let place = self.best.partition_point(|(other, _)| other.total_cmp(&objective).is_le());
        let values = fields.iter().map(|data| number(data, row)).chain(outputs.iter().map(|values| values[row]));
        self.best.insert(place, (objective, values.collect()));
        self.best.truncate(self.sweep.best);
    }

    fn count_row(&mut self, at: &[usize], outputs: &[&[f64]], row: usize) {
        for (index, values) in outputs.iter().enumerate() {
            let value = values[row];
            if value.is_nan() {
                continue;
            }
            let Moments { low, high, .. } = self.all[index];
            self.whole[index][bin(value, low, high, BINS)] += 1;
            for ((field, group), effects) in at.iter().enumerate().zip(&self.of_groups) {
                let Moments { low, high, .. } = effects[*group][index];
                self.steps[field][*group][index][bin(value, low, high, BINS)] += 1;
            }
        }
    }

    /// Variance of the means of a field's groups over the variance of all, of one output.
    fn share(&self, field: usize, output: usize) -> f64 {
        let all = &self.all[output];
        if all.squares <= 0.0 || all.count < 2 {
            return f64::NAN;
        }
        let between = |moments: &Moments| moments.count as f64 * (moments.mean - all.mean) * (moments.mean - all.mean);
        let groups = self.of_groups[field].iter().map(|outputs| &outputs[output]).filter(|moments| moments.count > 0);
        let (sum, count) = groups.fold((0.0, 0.0), |(sum, count), moments| (sum + between(moments), count + 1.0));
        let share = sum / all.squares;
        if !self.sweep.layout.is_drawn() || all.count as f64 <= count {
            return share;
        }
        // A few rows in every stratum differ by chance: Kelley's correction (PNAS 21 (1935) 554).
        1.0 - (1.0 - share) * (all.count as f64 - 1.0) / (all.count as f64 - count)
    }

    fn made(self) -> Result<Vec<Table>, TableError> {
        let sweep = self.sweep;
        let (mut effects, mut shares, mut quantiles, mut bins) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (output, asked) in sweep.asked.outputs.iter().enumerate() {
            let name = asked.column.name.as_str();
            for (field, column) in sweep.layout.columns.iter().enumerate() {
                shares.push(Share { field: &column.axis.name, output: name, explained: self.share(field, output) });
                for group in 0..self.groups[field].len() {
                    let moments = &self.of_groups[field][group][output];
                    if moments.count == 0 {
                        continue;
                    }
                    let steps: Vec<u64> =
                        self.steps[field][group][output].iter().map(|count| u64::from(*count)).collect();
                    effects.push(EffectRow {
                        field: &column.axis.name,
                        value: self.groups[field].value(group),
                        output: name,
                        count: moments.count,
                        mean: moments.mean,
                        deviation: (moments.squares / moments.count as f64).sqrt(),
                        quantiles: QUANTILES.map(|share| quantile(&steps, moments, share)),
                    });
                }
            }
            let moments = &self.all[output];
            if moments.count == 0 {
                continue;
            }
            quantiles.extend(QUANTILES.map(|share| {
                let value = quantile(&self.whole[output], moments, share);
                Quantile { output: name, share, at: value }
            }));
            let width = (moments.high - moments.low) / SHOWN_BINS as f64;
            bins.extend(self.whole[output].chunks(BINS / SHOWN_BINS).enumerate().map(|(at, counts)| Bin {
                output: name,
                number: at + 1,
                from: moments.low + width * at as f64,
                to: moments.low + width * (at + 1) as f64,
                count: counts.iter().sum(),
            }));
        }
        let mut cells = Vec::new();
        for ([one, two], all) in &self.maps {
            let across = self.groups[*two].len();
            let filled = all.iter().enumerate().filter(|(_, moments)| moments.count > 0);
            cells.extend(filled.map(|(at, moments)| MapCell {
                output: &sweep.asked.outputs[sweep.objective].column.name,
                fields: [one, two].map(|field| sweep.layout.columns[*field].axis.name.as_str()),
                values: [self.groups[*one].value(at / across), self.groups[*two].value(at % across)],
                count: moments.count,
                mean: moments.mean,
                low: moments.low,
            }));
        }
        let best: Vec<BestRow> = (1..).zip(self.best).map(|(rank, (_, values))| BestRow { rank, values }).collect();
        Ok(vec![
            tables::best(sweep).table(&best)?,
            tables::effects().table(&effects)?,
            tables::shares().table(&shares)?,
            tables::maps().table(&cells)?,
            tables::distribution().table(&bins)?,
            tables::quantiles().table(&quantiles)?,
            self.invalid.table()?,
        ])
    }
}

impl Tally for Effects<'_> {
    fn add(&mut self, pass: usize, table: &Table) {
        let sweep = self.sweep;
        let fields: Vec<&Data> =
            sweep.layout.columns.iter().filter_map(|column| table.column(&column.axis.name)).collect();
        let outputs: Vec<&[f64]> = sweep.asked.outputs.iter().map(|output| table.floats(&output.column.name)).collect();
        let reasons = table.texts(REASON);
        let mut at = vec![0; fields.len()];
        for (row, reason) in reasons.iter().enumerate() {
            if !reason.is_empty() {
                if pass == 0 {
                    self.rows += 1;
                    self.invalid.add(reason, || described(sweep, &fields, row));
                }
                continue;
            }
            for (slot, (group, data)) in at.iter_mut().zip(self.groups.iter().zip(&fields)) {
                *slot = group.at(number(data, row));
            }
            if pass == 0 {
                self.rows += 1;
                self.add_row(&at, &fields, &outputs, row);
            } else {
                self.count_row(&at, &outputs, row);
            }
        }
    }

    /// What is told where nothing, or nothing valid, came of it.
    fn warning(&self) -> Option<String> {
        match (self.rows, self.invalid.most_frequent()) {
            (0, _) => Some("no row passes `where`".to_owned()),
            (rows, Some((reason, row))) if self.invalid.count() == rows => {
                Some(format!("none of the {rows} rows is valid; {row}: {reason}"))
            }
            _ => None,
        }
    }

    fn tables(self: Box<Self>) -> Result<Vec<Table>, TableError> {
        self.made()
    }
}

/// The schemas of these tables, in their order.
pub fn schemas(sweep: &Sweep) -> Vec<Schema> {
    vec![
        tables::best(sweep).schema(),
        tables::effects().schema(),
        tables::shares().schema(),
        tables::maps().schema(),
        tables::distribution().schema(),
        tables::quantiles().schema(),
        invalid::columns().schema(),
    ]
}

/// How many rows they have, in the order of [`schemas`].
pub fn foreseen(sweep: &Sweep) -> Vec<RowCount> {
    let (groups, outputs) = (groups(sweep), sweep.asked.outputs.len());
    let values: usize = groups.iter().map(Group::len).sum();
    let cells =
        pairs(&groups).into_iter().map(|pair| pair.map(|field| groups[field].len()).iter().product::<usize>()).sum();
    vec![
        RowCount::at_most(sweep.best.min(sweep.layout.count())),
        RowCount::at_most(values * outputs),
        RowCount::exact(groups.len() * outputs),
        RowCount::at_most(cells),
        RowCount::at_most(SHOWN_BINS * outputs),
        RowCount::at_most(QUANTILES.len() * outputs),
        RowCount::at_most(MOST_REASONS.min(sweep.layout.count())),
    ]
}

/// Bytes that counting takes.
pub fn held(sweep: &Sweep) -> u64 {
    let values: usize = groups(sweep).iter().map(Group::len).sum();
    (values * sweep.asked.outputs.len() * (4 * BINS + size_of::<Moments>())) as u64
}

fn groups(sweep: &Sweep) -> Vec<Group> {
    let count = strata(sweep.layout.count());
    let of = |column: usize| match (sweep.layout.levels(column), sweep.layout.drawn_between(column)) {
        (Some(levels), _) => {
            let mut values: Vec<f64> = levels.iter().map(|level| level.shown).collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            if values.len() <= MOST_VALUES {
                return Group::Each(values);
            }
            Group::Strata { low: values[0], high: values[values.len() - 1], count }
        }
        (None, Some([low, high])) => Group::Strata { low, high, count },
        (None, None) => Group::Strata { low: 0.0, high: 1.0, count },
    };
    (0..sweep.layout.columns.len()).map(of).collect()
}

/// Values of a field that are looked at one by one.
const MOST_VALUES: usize = 200;

/// Pairs of fields of which a map is made: those that have few enough values.
fn pairs(groups: &[Group]) -> Vec<[usize; 2]> {
    let few = |field: &usize| groups[*field].len() <= MOST_OF_MAP;
    let fields: Vec<usize> = (0..groups.len()).filter(few).collect();
    fields.iter().enumerate().flat_map(|(at, one)| fields[at + 1..].iter().map(move |two| [*one, *two])).collect()
}

fn number(data: &Data, row: usize) -> f64 {
    match data {
        Data::Float(values) => values[row],
        Data::Integer(values) => values[row] as f64,
        _ => f64::NAN,
    }
}

fn described(sweep: &Sweep, fields: &[&Data], row: usize) -> String {
    let one = |(column, data): (&Column, &&Data)| {
        format!("{} = {} {}", column.axis.name, data.cell(row), column.axis.unit).trim().to_owned()
    };
    sweep.layout.columns.iter().zip(fields).map(one).collect::<Vec<_>>().join(", ")
}
