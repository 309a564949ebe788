//! What the numbers of a report come to inside the intervals of inputs that were printed rounded.
//!
//! Every stage that a number comes from is computed anew with one input after the other at both ends of its interval, or as near
//! to an end that is refused as it is not, and then, for each number, with all of them at their ends: at all corners where they are few,
//! or else at those ends that alone made it least, or largest. The least and the largest value of all that was computed are what is told. A
//! number that is continuous takes every value between both somewhere inside; where what was published is among these, a
//! place at which it is taken is looked for, so that a pole or a jump does not pass for it. Beyond them there is none where the
//! number is monotone in each input over its interval, and with many inputs whatever the others are; an input in whose middle it
//! is beyond both ends is looked at closer. A number that was stated once, and is used in several places, is one input. Must not know:
//! verdicts, how a stage computes. Values in the row's unit.

pub(super) mod said;
mod search;

use std::collections::BTreeMap;

use self::said::{Inside, Range};
use self::search::{Goal, Place};
use super::entry::ReportEntry;
use crate::stage::rows::chain;
use crate::stage::rows::output;
use crate::stage::rows::points::{Asked, Found, Memory, Points};
use crate::stage::rows::values::level;
use crate::stage::{Context, Demand, Inputs, Port};
use declare::error::{Diagnostic, Failure};
use declare::number::{significant, with_unit};
use declare::record::varied::{Form, Spread, Values, Varied};
use gearmesh::optimize::least_squares::uncertainty::digits;

/// The intervals of the inputs of a report.
pub struct Rounded {
    points: Points,
    /// Of the stages that are computed anew, by link.
    names: Vec<String>,
    /// In SI, by field.
    ends: Vec<[f64; 2]>,
    middles: Vec<f64>,
    inputs: Vec<Input>,
    /// By entry.
    rows: Vec<Row>,
}

/// A number that was stated as an interval.
struct Input {
    /// The fields that have it: several where the study has it by an alias.
    fields: Vec<usize>,
    /// The first of them, as written, and the unit of its middle.
    path: String,
    unit: String,
}

/// What a number depends on.
struct Row {
    /// By link.
    needs: Vec<bool>,
    /// Those of the inputs that could matter.
    inputs: Vec<usize>,
    /// A stage that it comes from, which depends on an input and is not computed anew.
    held: Option<String>,
}

impl Rounded {
    /// # Errors
    /// What a kind refuses of the study as it is.
    pub fn new(varied: &Varied, entries: &[ReportEntry]) -> Result<Self, Diagnostic> {
        let names: Vec<String> = varied.stages.iter().map(|stage| stage.name.clone()).collect();
        let demand = |stage| {
            let (schemas, mut demand) = (chain::built(stage)?.outputs(), Demand::default());
            let cells = entries.iter().flat_map(ReportEntry::cells);
            cells.filter(|cell| cell.stage == stage.name).for_each(|cell| output::ask(cell, &schemas, &mut demand));
            Ok(demand)
        };
        let demands = varied.stages.iter().map(demand).collect::<Result<_, Diagnostic>>()?;
        let points = Points::new(varied, demands)?;
        let (mut ends, mut middles) = (Vec::new(), Vec::new());
        let mut inputs: Vec<Input> = Vec::new();
        let mut places = Vec::new();
        for axis in &varied.axes {
            let Values::Spread(Spread { form: Form::Within(half, _), about, .. }) = axis.values else { continue };
            match places.iter().position(|place| *place == axis.place) {
                Some(known) => inputs[known].fields.push(ends.len()),
                None => {
                    places.push(axis.place);
                    inputs.push(Input { fields: vec![ends.len()], path: axis.path.clone(), unit: axis.unit.clone() });
                }
            }
            ends.push([about - half, about + half]);
            middles.push(about);
        }
        let row = |entry: &ReportEntry| {
            let named: Vec<bool> = names.iter().map(|name| entry.cells().any(|cell| cell.stage == *name)).collect();
            let links = || named.iter().enumerate().filter(|(_, is_named)| **is_named);
            let matters = |input: &usize| {
                inputs[*input].fields.iter().any(|field| links().any(|(link, _)| points.depends(link, *field)))
            };
            let held = entry.cells().find(|cell| varied.held.contains(&cell.stage)).map(|cell| cell.stage.clone());
            let inputs = if held.is_none() { (0..inputs.len()).filter(matters).collect() } else { Vec::new() };
            Row { needs: points.needed(&named), inputs, held }
        };
        let rows = entries.iter().map(row).collect();
        Ok(Self { points, names, ends, middles, inputs, rows })
    }

    /// What the stages read of the study.
    pub fn ports(&self) -> &[Port] {
        self.points.ports()
    }

    pub fn uses_seed(&self) -> bool {
        self.points.uses_seed()
    }

    /// What all of it takes, on one thread \[s\]: each stage at both ends of every interval that it depends on, and at the corners
    /// for each number that depends on several.
    pub fn seconds(&self) -> f64 {
        let of_link = |(link, seconds): (usize, f64)| {
            let depends = |input: &Input| input.fields.iter().any(|field| self.points.depends(link, *field));
            let alone = self.inputs.iter().filter(|input| depends(input)).count();
            let together = self.rows.iter().filter(|row| row.needs[link]).map(Row::corners).sum::<usize>();
            // No more corners than the box has.
            let corners = together.min(1 << alone.min(20));
            seconds * (2 * alone + if alone > 1 { corners } else { 0 }) as f64
        };
        self.points.seconds_of_each().into_iter().enumerate().map(of_link).sum()
    }

    /// What each number comes to; none where no interval matters to it. `inputs` are the tables of the study as it is.
    ///
    /// # Errors
    /// When the user stopped, or the stages cannot go on at all; an entry that has no number as it is.
    pub fn ranges(
        &self,
        entries: &[ReportEntry],
        (context, inputs): (&Context, &Inputs),
    ) -> Result<Vec<Option<Inside>>, Failure> {
        let mut memory = Memory::default();
        let goal = |(entry, row): (&ReportEntry, &Row)| {
            let (published, tolerance) = entry.aim()?;
            let stated = number(entry, inputs).ok()?;
            (!row.inputs.is_empty()).then_some(Goal { inputs: row.inputs.len(), stated, published, tolerance })
        };
        let goals: Vec<Option<Goal>> = entries.iter().zip(&self.rows).map(goal).collect();
        let mut ask = |wanted: &[(usize, Place)]| {
            // The same place for several numbers is one point, at which all that any of them needs is asked for.
            let mut asked: Vec<Asked> = Vec::new();
            let mut known: BTreeMap<Vec<u64>, usize> = BTreeMap::new();
            let mut at = Vec::with_capacity(wanted.len());
            for (row, place) in wanted {
                let (row, point) = (&self.rows[*row], self.point(&self.rows[*row], place));
                let bits = point.iter().map(|value| value.to_bits()).collect();
                let index = *known.entry(bits).or_insert(asked.len());
                if index == asked.len() {
                    asked.push((point, vec![false; self.names.len()]));
                }
                asked[index].1.iter_mut().zip(&row.needs).for_each(|(asked, needs)| *asked |= needs);
                at.push(index);
            }
            let found = self.points.each(&asked, &mut memory, (context, inputs))?;
            let number = |((row, _), at): (&(usize, Place), usize)| {
                self.number_at(&entries[*row], &self.rows[*row], &found[at], inputs)
            };
            Ok(wanted.iter().zip(at).map(number).collect())
        };
        let found = search::look(&goals, &mut ask)?;
        let one = |(row, found): (&Row, Option<search::Found>)| match &row.held {
            Some(stage) => Some(Inside::Held(stage.clone())),
            None => found.and_then(|found| Range::of(found, |place| self.words(row, place)).map(Inside::Range)),
        };
        Ok(self.rows.iter().zip(found).map(one).collect())
    }

    /// The values of all fields at a place of the inputs of a row.
    fn point(&self, row: &Row, place: &[f64]) -> Vec<f64> {
        let mut point = self.middles.clone();
        for (&input, &share) in row.inputs.iter().zip(place) {
            for &field in &self.inputs[input].fields {
                let ([low, high], middle) = (self.ends[field], self.middles[field]);
                point[field] = match share {
                    -1.0 => low,
                    1.0 => high,
                    share if share < 0.0 => middle + share * (middle - low),
                    share => middle + share * (high - middle),
                };
            }
        }
        point
    }

    /// The inputs of a row that are not in their middle at a place, with their values.
    fn words(&self, row: &Row, place: &[f64]) -> Vec<String> {
        let point = self.point(row, place);
        let moved = row.inputs.iter().zip(place).filter(|(_, share)| **share != 0.0);
        let word = |(&input, _): (&usize, &f64)| {
            let Input { fields, path, unit } = &self.inputs[input];
            let Some(&field) = fields.first() else { return String::new() };
            let [low, high] = self.ends[field];
            let (value, step) =
                (level(point[field], unit).shown, 1e-6 * (level(high, unit).shown - level(low, unit).shown));
            format!("`{path}` at {}", with_unit(&significant(value, digits(value, step).clamp(3, 15)), unit))
        };
        moved.map(word).collect()
    }

    /// The number of an entry with the tables of a point.
    fn number_at(&self, entry: &ReportEntry, row: &Row, found: &[Found], inputs: &Inputs) -> Result<f64, String> {
        let mut own = Inputs { ports: inputs.ports.clone() };
        for ((name, found), _) in self.names.iter().zip(found).zip(&row.needs).filter(|(_, needs)| **needs) {
            let tables = found.as_ref().map_err(Clone::clone)?;
            own.ports.insert(name.clone(), tables.iter().collect());
        }
        number(entry, &own)
    }
}

impl Row {
    /// How many corners are tried.
    fn corners(&self) -> usize {
        search::corners_of(self.inputs.len())
    }
}

/// The number of an entry, which is finite.
fn number(entry: &ReportEntry, inputs: &Inputs) -> Result<f64, String> {
    match entry.number(inputs) {
        Ok(Some((value, _))) if value.is_finite() => Ok(value),
        Ok(Some((value, _))) => Err(format!("the computed value is {value}")),
        Ok(None) => Err("a claim has no number".to_owned()),
        Err(wrong) => Err(wrong.message),
    }
}

#[cfg(test)]
mod tests;
