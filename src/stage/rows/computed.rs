//! The rows of a part: taken over where an earlier part had them, computed where none had.
//!
//! Rows with the same pair and compliances come behind each other, so those are found once and kept as long as they are
//! needed. Every row is a function of its values alone, so neither threads nor parts enter it. Must not know: how a number is
//! found.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::chain::{Tables, Trouble};
use super::quick::{self, Before, Quick, Upstream};
use super::values::RowSet;
use super::{Asked, Class};
use crate::stage::{Context, Inputs, Others};
use declare::error::Failure;
use declare::work::{Counter, Tally, Work};
use studygraph::stage::steps::Steps;
use studygraph::table::data::{Cell, Data, Table, TableError};
use studygraph::table::schema::{Column, Schema};
use studygraph::warning::Warning;

pub const TABLE: &str = "rows";
pub const REASON: &str = "reason";

/// Rows that were computed, and rows that an earlier part had.
pub static ROWS_COMPUTED: Counter = Counter { name: "sweep_rows_computed", seconds: 0.0, adds: true };
pub static ROWS_TAKEN_OVER: Counter = Counter { name: "sweep_rows_taken_over", seconds: 0.0, adds: true };

/// Rows that a thread computes at a stretch.
const AT_ONCE: usize = 32;
/// Pairs with their compliances that are held at once, for each thread.
const UPSTREAM_AT_ONCE: usize = 4;

/// The numbers of a row and its values, its asked numbers, and why there are none.
pub fn schema(asked: &Asked) -> Schema {
    let mut columns = asked.leading.clone();
    for (column, is_key) in asked.columns.iter().zip(&asked.is_key) {
        let (name, description) = (&column.axis.name, format!("Value of `{}`.", column.axis.path));
        let column = if column.axis.multiple.is_some() {
            Column::integer(name, &description)
        } else {
            Column::float(name, &column.axis.unit, &description)
        };
        columns.push(if *is_key { column.key() } else { column });
    }
    columns.extend(asked.outputs.iter().map(|output| output.column.clone()));
    columns.push(Column::text(REASON, "Why there are no numbers; empty where there are."));
    Schema::new(TABLE, "Every design with the numbers that are asked of it.", columns)
}

/// What was found of a row.
type Answer = Result<Vec<f64>, String>;

/// The table of some rows.
///
/// # Errors
/// When the user stopped, or the stage cannot go on at all.
pub fn table(
    asked: &Asked,
    rows: &RowSet,
    (context, inputs): (&Context, &Inputs),
    others: &dyn Others,
) -> Result<Table, Failure> {
    let mut answers: Vec<Option<Answer>> = vec![None; rows.len()];
    take_over(asked, rows, others, &mut answers);
    let missing: Vec<usize> = (0..rows.len()).filter(|row| answers[*row].is_none()).collect();
    let work = Work::of(&ROWS_COMPUTED, missing.len()).with(&ROWS_TAKEN_OVER, rows.len() - missing.len());
    context.work.add(&work);
    let steps = Steps::new(context, missing.len());
    for groups in groups(asked, rows, &missing).chunks(UPSTREAM_AT_ONCE * rayon::current_num_threads()) {
        compute(asked, rows, groups, (context, inputs), &steps, &mut answers)?;
    }
    if context.is_heard {
        warn_of_corners(asked, rows, (context, inputs));
    }
    made(asked, rows, answers).map_err(|error| Failure::new(error.to_string()))
}

/// Reports what rows lose by `corner_contact: none`. Of the rows with the largest torque it looks at the first, the last and those
/// with the least and the largest value of a modification: a curve of every row would take too long, and rows that are taken
/// over have none.
fn warn_of_corners(asked: &Asked, rows: &RowSet, (context, inputs): (&Context, &Inputs)) {
    let torque = asked.columns.iter().position(|column| column.class == Class::Torque);
    let at = |column: usize| move |row: &usize| rows.si(*row)[column];
    let most = torque.and_then(|torque| (0..rows.len()).map(|row| at(torque)(&row)).reduce(f64::max));
    let loaded: Vec<usize> =
        (0..rows.len()).filter(|row| torque.is_none_or(|torque| Some(at(torque)(row)) == most)).collect();
    let mut candidates: BTreeSet<_> = loaded.first().into_iter().chain(loaded.last()).copied().collect();
    for (column, _) in asked.columns.iter().enumerate().filter(|(_, column)| column.class == Class::Design) {
        let order = |one: &usize, other: &usize| at(column)(one).total_cmp(&at(column)(other));
        candidates.extend(loaded.iter().copied().min_by(order));
        // Of equal ones the first, which is more like the others.
        candidates.extend(loaded.iter().rev().copied().max_by(order));
    }
    let candidates: Vec<usize> = candidates.into_iter().collect();
    // Work beside the rows is not theirs.
    let aside = Tally::default();
    let context = &Context { work: &aside, ..*context };
    let warnings = candidates.par_iter().map(|row| {
        let row = rows.si(*row);
        let (tables, upstream) = found_upstream(asked, row, context, inputs).ok()?;
        let (chain, columns) = (&asked.chain, asked.columns.as_slice());
        if let (Some(quick), Some(upstream)) = (&asked.quick, &upstream) {
            return quick.neglected_corners((chain, columns), (&tables, inputs), upstream, row);
        }
        chain.warning_of_corners((columns, row), (context, inputs))
    });
    let warnings: Vec<Option<Warning>> = warnings.collect();
    if let Some(worst) = warnings.into_iter().flatten().reduce(Warning::worse) {
        (context.warn)(worst);
    }
}

/// Stretches of missing rows with the same pair and compliances.
fn groups<'m>(asked: &Asked, rows: &RowSet, missing: &'m [usize]) -> Vec<&'m [usize]> {
    let is_upstream: Vec<bool> = asked.columns.iter().map(|column| column.class == Class::Upstream).collect();
    let same = |one: &usize, two: &usize| {
        let pairs = rows.shown(*one).iter().zip(rows.shown(*two)).zip(&is_upstream);
        pairs.filter(|(_, is)| **is).all(|((one, two), _)| one.to_bits() == two.to_bits())
    };
    missing.chunk_by(same).collect()
}

fn compute(
    asked: &Asked,
    rows: &RowSet,
    groups: &[&[usize]],
    (context, inputs): (&Context, &Inputs),
    steps: &Steps,
    answers: &mut [Option<Answer>],
) -> Result<(), Failure> {
    type Found<'q> = (Tables, Option<Upstream<'q>>);
    let upstream = |group: &&[usize]| -> Result<Result<Found<'_>, String>, Failure> {
        context.check_stop()?;
        match found_upstream(asked, rows.si(group[0]), context, inputs) {
            Ok(found) => Ok(Ok(found)),
            Err(Trouble::Invalid(reason)) => Ok(Err(reason)),
            Err(Trouble::Failed(failure)) => Err(failure),
        }
    };
    let found: Vec<Result<Found<'_>, String>> = groups.par_iter().map(upstream).collect::<Result<_, _>>()?;
    let blocks: Vec<(usize, &[usize])> = groups
        .iter()
        .enumerate()
        .flat_map(|(group, rows)| rows.chunks(AT_ONCE).map(move |block| (group, block)))
        .collect();
    let of_block = |(group, block): &(usize, &[usize])| -> Result<Vec<Answer>, Failure> {
        context.check_stop()?;
        let mut before = Before::default();
        let mut all = Vec::with_capacity(block.len());
        match &found[*group] {
            Err(reason) => {
                all.extend(block.iter().map(|_| Err(reason.clone())));
                for _ in *block {
                    steps.done();
                }
            }
            Ok((_, Some(upstream))) => {
                let Some(quick) = &asked.quick else { return Ok(all) };
                let chain = (&asked.chain, asked.columns.as_slice());
                for alike in block.chunk_by(|one, two| differ_in_torque_alone(asked, rows.si(*one), rows.si(*two))) {
                    quick.rows(chain, upstream, &mut before, alike.iter().map(|row| rows.si(*row)), &mut all);
                    for _ in alike {
                        steps.done();
                    }
                }
            }
            Ok((tables, None)) => {
                for row in *block {
                    all.push(match one(asked, rows.si(*row), tables, (context, inputs)) {
                        Ok(values) => Ok(values),
                        Err(Trouble::Invalid(reason)) => Err(reason),
                        Err(Trouble::Failed(failure)) => return Err(failure),
                    });
                    steps.done();
                }
            }
        }
        Ok(all)
    };
    let computed: Vec<Vec<Answer>> = blocks.par_iter().map(of_block).collect::<Result<_, _>>()?;
    for ((_, block), all) in blocks.iter().zip(computed) {
        for (row, answer) in block.iter().zip(all) {
            answers[*row] = Some(answer);
        }
    }
    found
        .iter()
        .flatten()
        .filter_map(|(_, upstream)| upstream.as_ref())
        .for_each(|upstream| quick::count(context, upstream));
    Ok(())
}

/// What rows with these values share: the tables of the stages that no other value changes.
fn found_upstream<'q>(
    asked: &'q Asked,
    row: &[f64],
    context: &Context,
    inputs: &Inputs,
) -> Result<(Tables, Option<Upstream<'q>>), Trouble> {
    let (chain, columns) = (&asked.chain, asked.columns.as_slice());
    let mut tables: Tables = (0..chain.links.len()).map(|_| None).collect();
    for link in 0..chain.links.len() - 1 {
        let is_shared = columns.iter().all(|column| column.axis.stage != link || column.class == Class::Upstream);
        let is_skipped = asked.quick.as_ref().and_then(Quick::skips) == Some(link);
        if is_shared && !is_skipped && chain.can_run(link, &tables) {
            tables[link] = Some(chain.run(link, (columns, row), &tables, (context, inputs))?);
        }
    }
    let quick = asked.quick.as_ref();
    let upstream = quick.map(|quick| quick.upstream(chain, &tables, inputs, asked.design.as_deref())).transpose()?;
    Ok((tables, upstream))
}

fn differ_in_torque_alone(asked: &Asked, one: &[f64], two: &[f64]) -> bool {
    let columns = asked.columns.iter().zip(one.iter().zip(two));
    columns.filter(|(column, _)| column.class != Class::Torque).all(|(_, (one, two))| one.to_bits() == two.to_bits())
}

/// The numbers of a row, from table to table.
fn one(
    asked: &Asked,
    row: &[f64],
    tables: &Tables,
    (context, inputs): (&Context, &Inputs),
) -> Result<Vec<f64>, Trouble> {
    let (chain, columns) = (&asked.chain, asked.columns.as_slice());
    let mut tables = tables.clone();
    for link in 0..chain.links.len() {
        if tables[link].is_none() {
            tables[link] = Some(chain.run(link, (columns, row), &tables, (context, inputs))?);
        }
    }
    let last = tables.pop().flatten().unwrap_or_default();
    let value = |output: &super::output::Output| {
        output.take(&last, asked.design.as_deref()).map_err(|problem| Trouble::Failed(Failure::new(problem)))
    };
    asked.outputs.iter().map(value).collect()
}

/// Fills in what tables of earlier parts know; both are in the order of their keys.
fn take_over(asked: &Asked, rows: &RowSet, others: &dyn Others, answers: &mut [Option<Answer>]) {
    let (Some(first), Some(last)) = ((rows.len() > 0).then_some(0), rows.len().checked_sub(1)) else { return };
    let schema = &asked.schema;
    let keys: Vec<usize> = schema.key_columns().collect();
    for table in others.earlier(TABLE, &key(asked, rows, first), &key(asked, rows, last)) {
        if table.schema() != schema {
            continue;
        }
        let known = Known::of(asked, &table);
        let mut at = 0;
        for (row, answer) in answers.iter_mut().enumerate().filter(|(_, answer)| answer.is_none()) {
            let wanted = key(asked, rows, row);
            let order = |at: usize| {
                let cells = keys.iter().map(|key| table.columns()[*key].cell(at));
                let pairs = cells.zip(&wanted).map(|(cell, wanted)| ordered(&cell, wanted));
                pairs.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
            };
            // Rows come in their order, so what is behind stays behind.
            let mut step = 1;
            while at + step < table.rows() && order(at + step).is_lt() {
                step *= 2;
            }
            let (mut low, mut high) = (at, (at + step).min(table.rows()));
            while low < high {
                let middle = usize::midpoint(low, high);
                if order(middle).is_lt() { low = middle + 1 } else { high = middle }
            }
            at = low;
            if at < table.rows() && order(at).is_eq() && known.has(at, rows.shown(row)) {
                *answer = Some(known.answer(at));
            }
        }
    }
}

fn ordered(one: &Cell, two: &Cell) -> std::cmp::Ordering {
    match (one, two) {
        (Cell::Float(one), Cell::Float(two)) => one.total_cmp(two),
        (Cell::Integer(one), Cell::Integer(two)) => one.cmp(two),
        _ => std::cmp::Ordering::Equal,
    }
}

/// The key of a row.
fn key(asked: &Asked, rows: &RowSet, row: usize) -> Vec<Cell> {
    let numbers = rows.numbers(row).iter().map(|number| Cell::from(*number));
    let keyed = asked.columns.iter().zip(rows.shown(row)).zip(&asked.is_key).filter(|(_, is_key)| **is_key);
    let values =
        keyed.map(
            |((column, value), _)| {
                if column.axis.multiple.is_some() { Cell::Integer(whole(*value)) } else { Cell::Float(*value) }
            },
        );
    numbers.chain(values).collect()
}

fn whole(value: f64) -> i64 {
    // Whole and within the bounds of its field.
    #[allow(clippy::cast_possible_truncation)]
    let whole = value as i64;
    whole
}

/// The columns of a table of rows.
struct Known<'t> {
    values: Vec<&'t Data>,
    outputs: Vec<&'t [f64]>,
    reasons: &'t [String],
}

impl<'t> Known<'t> {
    fn of(asked: &Asked, table: &'t Table) -> Self {
        let values = asked.columns.iter().filter_map(|column| table.column(&column.axis.name));
        let outputs = asked.outputs.iter().map(|output| table.floats(&output.column.name));
        Self { values: values.collect(), outputs: outputs.collect(), reasons: table.texts(REASON) }
    }

    /// Whether a row has these values: of drawn rows the number alone does not say.
    fn has(&self, at: usize, shown: &[f64]) -> bool {
        self.values.iter().zip(shown).all(|(data, shown)| match data {
            Data::Float(values) => values[at].to_bits() == shown.to_bits(),
            Data::Integer(values) => values[at] == whole(*shown),
            _ => false,
        })
    }

    fn answer(&self, at: usize) -> Answer {
        let reason = &self.reasons[at];
        if reason.is_empty() { Ok(self.outputs.iter().map(|values| values[at]).collect()) } else { Err(reason.clone()) }
    }
}

fn made(asked: &Asked, rows: &RowSet, answers: Vec<Option<Answer>>) -> Result<Table, TableError> {
    let count = rows.len();
    let mut columns = Vec::new();
    for at in 0..asked.leading.len() {
        let numbers = (0..count).map(|row| i64::try_from(rows.numbers(row)[at]).unwrap_or(i64::MAX));
        columns.push(Data::Integer(numbers.collect()));
    }
    for (index, column) in asked.columns.iter().enumerate() {
        let values = (0..count).map(|row| rows.shown(row)[index]);
        columns.push(if column.axis.multiple.is_some() {
            Data::Integer(values.map(whole).collect())
        } else {
            Data::Float(values.collect())
        });
    }
    let mut outputs: Vec<Vec<f64>> = asked.outputs.iter().map(|_| Vec::with_capacity(count)).collect();
    let mut reasons = Vec::with_capacity(count);
    for answer in answers {
        let (values, reason) = match answer {
            Some(Ok(values)) => (values, String::new()),
            Some(Err(reason)) => (Vec::new(), reason),
            None => (Vec::new(), "it was not computed".to_owned()),
        };
        for (index, output) in outputs.iter_mut().enumerate() {
            output.push(values.get(index).copied().unwrap_or(f64::NAN));
        }
        reasons.push(reason);
    }
    columns.extend(outputs.into_iter().map(Data::Float));
    columns.push(Data::Text(reasons));
    Table::from_columns(asked.schema.clone(), columns)
}
