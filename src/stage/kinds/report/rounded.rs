//! What the numbers of a report come to inside the intervals of inputs that were printed rounded.
//!
//! Every stage that a number comes from is computed anew with one input after the other at both ends of its interval, and
//! then, for each number, with all of them at those ends that alone made it least, or largest. The least and the largest of all
//! that was computed are what is told. A number that is continuous takes every value between both somewhere inside, so that a
//! published value there is reproduced. That none inside reproduces one beyond them holds where the number is monotone in
//! each input over its interval, whatever the others are. Must not know: verdicts, how a stage computes. Values in the row's unit.

use super::entry::ReportEntry;
use super::verdict::Comparison;
use crate::stage::rows::chain;
use crate::stage::rows::output;
use crate::stage::rows::points::{Asked, Found, Memory, Points};
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
    /// In SI, by input.
    ends: Vec<[f64; 2]>,
    middles: Vec<f64>,
    /// By entry.
    rows: Vec<Row>,
}

/// What a number depends on.
struct Row {
    /// By link.
    needs: Vec<bool>,
    /// Those of the inputs that could matter.
    inputs: Vec<usize>,
}

/// What a number comes to.
#[derive(Clone, Debug)]
pub struct Range {
    least: f64,
    largest: f64,
    points: usize,
    /// At how many of them there is none, and why at the first.
    refused: usize,
    reason: String,
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
        let mut ends = Vec::new();
        let mut middles = Vec::new();
        for axis in &varied.axes {
            if let Values::Spread(Spread { form: Form::Within(half, _), about, .. }) = axis.values {
                ends.push([about - half, about + half]);
                middles.push(about);
            }
        }
        let row = |entry: &ReportEntry| {
            let named: Vec<bool> = names.iter().map(|name| entry.cells().any(|cell| cell.stage == *name)).collect();
            let links = || named.iter().enumerate().filter(|(_, is_named)| **is_named);
            let matters = |input: &usize| links().any(|(link, _)| points.depends(link, *input));
            Row { needs: points.needed(&named), inputs: (0..ends.len()).filter(matters).collect() }
        };
        let rows = entries.iter().map(row).collect();
        Ok(Self { points, names, ends, middles, rows })
    }

    /// What the stages read of the study.
    pub fn ports(&self) -> &[Port] {
        self.points.ports()
    }

    pub fn uses_seed(&self) -> bool {
        self.points.uses_seed()
    }

    /// What all of it takes, on one thread \[s\]: each stage at both ends of every interval that it depends on, and at two more
    /// points for each number that depends on several.
    pub fn seconds(&self) -> f64 {
        let of_link = |(link, seconds): (usize, f64)| {
            let alone = (0..self.ends.len()).filter(|input| self.points.depends(link, *input)).count();
            let together = self.rows.iter().filter(|row| row.needs[link] && row.inputs.len() > 1).count();
            // No more corners than the box has.
            let corners = (2 * together).min(1 << alone.min(20));
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
    ) -> Result<Vec<Option<Range>>, Failure> {
        let mut memory = Memory::default();
        let as_stated: Vec<Option<f64>> = entries.iter().map(|entry| number(entry, inputs).ok()).collect();
        // One input after the other: two points each.
        let alone: Vec<Asked> = (0..self.ends.len())
            .flat_map(|input| {
                let needs = |link: usize| self.rows.iter().any(|row| row.inputs.contains(&input) && row.needs[link]);
                let needed: Vec<bool> = (0..self.names.len()).map(needs).collect();
                self.ends[input].map(|end| {
                    let mut point = self.middles.clone();
                    point[input] = end;
                    (point, needed.clone())
                })
            })
            .collect();
        let found = self.points.each(&alone, &mut memory, (context, inputs))?;
        let mut gathered: Vec<Option<Gathered>> = as_stated.iter().map(|number| number.map(Gathered::new)).collect();
        let mut corners: Vec<Asked> = Vec::new();
        let mut corners_of: Vec<[Option<usize>; 2]> = Vec::new();
        for (at, (entry, row)) in entries.iter().zip(&self.rows).enumerate() {
            let mut extreme = [self.middles.clone(), self.middles.clone()];
            if let (Some(own), Some(stated)) = (&mut gathered[at], as_stated[at]) {
                for &input in &row.inputs {
                    let mut of_input = [stated; 2];
                    for (side, end) in self.ends[input].into_iter().enumerate() {
                        let value = self.number_at(entry, row, &found[2 * input + side], inputs);
                        if let Ok(value) = value {
                            for (which, is_further) in
                                [value < of_input[0], value > of_input[1]].into_iter().enumerate()
                            {
                                if is_further {
                                    of_input[which] = value;
                                    extreme[which][input] = end;
                                }
                            }
                        }
                        own.add(value);
                    }
                }
            }
            corners_of.push(extreme.map(|point| {
                let bits = |point: &[f64]| point.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
                let moved = bits(&point).iter().zip(bits(&self.middles)).filter(|(one, other)| *one != other).count();
                // What a single input does is known.
                if moved < 2 {
                    return None;
                }
                let known = corners.iter().position(|(other, _)| bits(other) == bits(&point));
                let index = known.unwrap_or_else(|| {
                    corners.push((point, vec![false; self.names.len()]));
                    corners.len() - 1
                });
                corners[index].1.iter_mut().zip(&row.needs).for_each(|(asked, needs)| *asked |= needs);
                Some(index)
            }));
        }
        // All of them together, where each alone made a number least, or largest.
        let found = self.points.each(&corners, &mut memory, (context, inputs))?;
        for (at, (entry, row)) in entries.iter().zip(&self.rows).enumerate() {
            let Some(own) = &mut gathered[at] else { continue };
            for corner in corners_of[at].into_iter().flatten() {
                own.add(self.number_at(entry, row, &found[corner], inputs));
            }
        }
        Ok(gathered.into_iter().map(|gathered| gathered.and_then(Gathered::range)).collect())
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

/// The number of an entry, which is finite.
fn number(entry: &ReportEntry, inputs: &Inputs) -> Result<f64, String> {
    match entry.number(inputs) {
        Ok(Some((value, _))) if value.is_finite() => Ok(value),
        Ok(Some((value, _))) => Err(format!("the computed value is {value}")),
        Ok(None) => Err("a claim has no number".to_owned()),
        Err(wrong) => Err(wrong.message),
    }
}

/// The values of a number so far.
struct Gathered {
    range: Range,
    is_changed: bool,
}

impl Gathered {
    /// Begins with that of the inputs in the middle.
    fn new(number: f64) -> Self {
        let range = Range { least: number, largest: number, points: 0, refused: 0, reason: String::new() };
        Self { range, is_changed: false }
    }

    fn add(&mut self, value: Result<f64, String>) {
        let range = &mut self.range;
        range.points += 1;
        match value {
            Ok(value) => {
                range.least = range.least.min(value);
                range.largest = range.largest.max(value);
            }
            Err(reason) => {
                if range.refused == 0 {
                    range.reason = reason;
                }
                range.refused += 1;
            }
        }
        self.is_changed = range.least < range.largest || range.refused > 0;
    }

    /// None where nothing changes it.
    fn range(self) -> Option<Range> {
        self.is_changed.then_some(self.range)
    }
}

impl Range {
    /// The least and the largest value.
    pub fn ends(&self) -> (f64, f64) {
        (self.least, self.largest)
    }

    /// Between what it is, and whether some value inside agrees with what is published.
    pub fn said(&self, comparison: &Comparison, unit: &str) -> String {
        let (least, largest) = (self.least, self.largest);
        // To a hundredth of what is between them.
        let shown = digits(least.abs().max(largest.abs()), (largest - least) / 2000.0).clamp(3, 12);
        let (low, high) = (significant(least, shown), significant(largest, shown));
        let range = format!("{low} to {} over the rounded inputs", with_unit(&high, unit));
        let reached = match (comparison.agrees_as_stated(), comparison.is_reached()) {
            (true, _) => "as stated they reproduce it",
            (false, Some(true)) => "some value inside reproduces it",
            (false, _) => "none inside reproduces it",
        };
        let Self { refused, points, reason, .. } = self;
        let refused = match refused {
            0 => String::new(),
            _ => format!("; no value at {refused} of {points} points, for example: {reason}"),
        };
        format!("{range}; {reached}{refused}")
    }
}
