//! What the numbers of a report come to inside the intervals of inputs that were printed rounded.
//!
//! Every stage that a number comes from is computed anew with one input after the other at both ends of its interval, and
//! then, for each number, with all of them at their ends: at all corners where they are few, or else at those ends that alone made
//! it least, or largest. The least and the largest of all that was computed are what is told. A number that is continuous takes
//! every value between both somewhere inside, so that a published value there is reproduced. Beyond them there is none where the
//! number is monotone in each input over its interval, and with many inputs whatever the others are. A number that was stated
//! once, and is used in several places, is one input. Must not know: verdicts, how a stage computes. Values in the row's unit.

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
    /// The first of them, as written.
    path: String,
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

/// So many inputs of a number are tried at all corners.
const MOST_AT_ALL: usize = 4;

/// What is to be said of a number whose inputs were printed rounded.
#[derive(Clone, Debug)]
pub enum Inside {
    Range(Range),
    /// Nothing: this stage depends on them and is not computed anew.
    Held(String),
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
        let (mut ends, mut middles) = (Vec::new(), Vec::new());
        let mut inputs: Vec<Input> = Vec::new();
        let mut places = Vec::new();
        for axis in &varied.axes {
            let Values::Spread(Spread { form: Form::Within(half, _), about, .. }) = axis.values else { continue };
            match places.iter().position(|place| *place == axis.place) {
                Some(known) => inputs[known].fields.push(ends.len()),
                None => {
                    places.push(axis.place);
                    inputs.push(Input { fields: vec![ends.len()], path: axis.path.clone() });
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

    /// Puts an input at an end of its interval.
    fn put(&self, point: &mut [f64], input: usize, side: usize) {
        for &field in &self.inputs[input].fields {
            point[field] = self.ends[field][side];
        }
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
        let as_stated: Vec<Option<f64>> = entries.iter().map(|entry| number(entry, inputs).ok()).collect();
        // One input after the other: two points each.
        let alone: Vec<Asked> = (0..self.inputs.len())
            .flat_map(|input| {
                let needs = |link: usize| self.rows.iter().any(|row| row.inputs.contains(&input) && row.needs[link]);
                let needed: Vec<bool> = (0..self.names.len()).map(needs).collect();
                [0, 1].map(|side| {
                    let mut point = self.middles.clone();
                    self.put(&mut point, input, side);
                    (point, needed.clone())
                })
            })
            .collect();
        let found = self.points.each(&alone, &mut memory, (context, inputs))?;
        let mut gathered: Vec<Option<Gathered>> = as_stated.iter().map(|number| number.map(Gathered::new)).collect();
        let mut corners: Vec<Asked> = Vec::new();
        let mut corners_of: Vec<Vec<usize>> = Vec::new();
        for (at, (entry, row)) in entries.iter().zip(&self.rows).enumerate() {
            // By which end each input alone makes the number least, and largest.
            let mut sides = [vec![None; row.inputs.len()], vec![None; row.inputs.len()]];
            if let (Some(own), Some(stated)) = (&mut gathered[at], as_stated[at]) {
                for (place, &input) in row.inputs.iter().enumerate() {
                    let mut of_input = [stated; 2];
                    for (side, end) in ["lower", "upper"].into_iter().enumerate() {
                        let value = self.number_at(entry, row, &found[2 * input + side], inputs);
                        let path = &self.inputs[input].path;
                        let value = value.map_err(|why| format!("with `{path}` at its {end} end, {why}"));
                        if let Ok(value) = value {
                            for (which, is_further) in
                                [value < of_input[0], value > of_input[1]].into_iter().enumerate()
                            {
                                if is_further {
                                    of_input[which] = value;
                                    sides[which][place] = Some(side);
                                }
                            }
                        }
                        own.add(value);
                    }
                }
            }
            let wanted = row.wanted(sides);
            let index = |sides: &Vec<Option<usize>>| {
                let mut point = self.middles.clone();
                let moved = row.inputs.iter().zip(sides).filter_map(|(input, side)| Some((*input, (*side)?)));
                moved.for_each(|(input, side)| self.put(&mut point, input, side));
                let bits = |point: &[f64]| point.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
                let known = corners.iter().position(|(other, _)| bits(other) == bits(&point));
                let index = known.unwrap_or_else(|| {
                    corners.push((point, vec![false; self.names.len()]));
                    corners.len() - 1
                });
                corners[index].1.iter_mut().zip(&row.needs).for_each(|(asked, needs)| *asked |= needs);
                index
            };
            corners_of.push(wanted.iter().map(index).collect());
        }
        let found = self.points.each(&corners, &mut memory, (context, inputs))?;
        for (at, (entry, row)) in entries.iter().zip(&self.rows).enumerate() {
            let Some(own) = &mut gathered[at] else { continue };
            for corner in &corners_of[at] {
                let value = self.number_at(entry, row, &found[*corner], inputs);
                own.add(value.map_err(|why| format!("with several inputs at their ends, {why}")));
            }
        }
        let one = |(row, gathered): (&Row, Option<Gathered>)| match &row.held {
            Some(stage) => Some(Inside::Held(stage.clone())),
            None => gathered.and_then(Gathered::range).map(Inside::Range),
        };
        Ok(self.rows.iter().zip(gathered).map(one).collect())
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
        match self.inputs.len() {
            0 | 1 => 0,
            few @ ..=MOST_AT_ALL => 1 << few,
            _ => 2,
        }
    }

    /// The corners, as an end of each input; `sides` are the ends that alone make the number least, and largest.
    fn wanted(&self, sides: [Vec<Option<usize>>; 2]) -> Vec<Vec<Option<usize>>> {
        let count = self.inputs.len();
        if count <= MOST_AT_ALL {
            let corner = |corner: usize| (0..count).map(|input| Some(corner >> input & 1)).collect();
            return (0..self.corners()).map(corner).collect();
        }
        // What a single input does is known.
        sides.into_iter().filter(|sides| sides.iter().flatten().count() > 1).collect()
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

impl Inside {
    /// The least and the largest value.
    pub fn ends(&self) -> Option<(f64, f64)> {
        if let Self::Range(range) = self { Some((range.least, range.largest)) } else { None }
    }

    pub fn said(&self, comparison: &Comparison, unit: &str) -> String {
        match self {
            Self::Range(range) => range.said(comparison, unit),
            Self::Held(stage) => {
                format!("inputs were printed rounded; `{stage}` is not computed anew for them, so no range is known")
            }
        }
    }
}

impl Range {
    /// Between what it is, and whether some value inside agrees with what is published.
    fn said(&self, comparison: &Comparison, unit: &str) -> String {
        let (least, largest) = (self.least, self.largest);
        // To a hundredth of what is between them.
        let shown = digits(least.abs().max(largest.abs()), (largest - least) / 2000.0).clamp(3, 12);
        let (low, high) = (significant(least, shown), significant(largest, shown));
        let range = format!("{low} to {} over the rounded inputs", with_unit(&high, unit));
        let reached = match (comparison.agrees_as_stated(), comparison.is_reached()) {
            (true, _) => "as stated they reproduce it",
            (false, Some(true)) => "some value inside reproduces it",
            (false, _) => "none found inside reproduces it",
        };
        let Self { refused, points, reason, .. } = self;
        let refused = match refused {
            0 => String::new(),
            _ => format!("; no value at {refused} of {points} points, for example: {reason}"),
        };
        format!("{range}; {reached}{refused}")
    }
}
