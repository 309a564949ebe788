//! The stage kind `report`: what a paper printed beside what was computed, with a verdict on each, and the figures.
//!
//! It computes nothing about gears: it reads cells of other stages' tables. Every published number may be compared with
//! a cell, with a formula over cells, or stand as a claim that is true or false in every row. A reason for a difference
//! can carry arithmetic that proves it and the value that is expected instead; both are checked each time. Must not
//! know: how the report is drawn. Values in the row's unit, as printed.
//!
//! Where inputs of what is compared were printed rounded, `0.504 ± 0.0005`, the stages are computed anew inside their intervals, and each
//! row says whether some value there reproduces it.

mod compare;
mod entry;
mod figure;
mod printed;
mod rounded;
mod stated;
mod stated_figure;
mod verdict;

use std::collections::BTreeSet;

use crate::stage::operand::Operand;
use crate::stage::operand::names::Shared;
use crate::stage::{Ahead, Context, Demand, DimensionOf, Estimate, Inputs, Kind, Named, Port, RowCount, Stage, Want};
use compare::{Compared, Comparison, comparisons};
use declare::Declared;
use declare::declared::{Declared, Placed};
use declare::error::{Diagnostic, Failure, Faults};
use declare::record::Record;
use declare::record::varied::Varied;
use entry::{ReportEntry, verdicts};
use figure::{Figure, figures, marks};
use rounded::Rounded;
use stated::{PrintedTable, Published};
use stated_figure::StatedFigure;
use studygraph::table::columns::Columns;
use studygraph::table::data::Table;
use studygraph::table::schema::Schema;
use verdict::Verdict;

pub const KIND: Kind = Kind {
    name: "report",
    version: 1,
    summary: Stated::MEMBER.summary,
    fields: Stated::MEMBER.fields,
    curves: &[],
    example: "\
kind: report
published:
  - label: Peak-to-peak transmission error, unmodified
    where: Table 2
    cell: ste.summary[design=unmodified, torque=50 N m].peak_to_peak
    value: 2.316 um
    tolerance: 1 %
    because: the stiffnesses the paper prints bound it from below
    proof:
      claim: F / k1 - F / k2 > published
      with: { F: 1866.98 N, k1: 2.738e8 N/m, k2: 4.724e8 N/m }
figures:
  - name: transmission_error
    title: Static transmission error over the mesh cycle at 50 N m
    table: ste.curve
    x: cycle_position
    y: transmission_error
    series: design
    where: { torque: 50 N m }
",
    build,
};

/// A verdict on every published number, and the figures of the report.
#[derive(Debug, Declared)]
struct Stated {
    /// the paper's numbers and claims
    #[declared(intervals = ["geometry", "modification", "stiffness", "ste", "rating"])]
    pub published: Option<Vec<Published>>,
    /// printed tables: a line for each number
    #[declared(intervals = ["geometry", "modification", "stiffness", "ste", "rating"])]
    pub printout: Option<Vec<PrintedTable>>,
    /// what names stand for in every formula, claim and proof that does not say it itself: cells or quantities
    #[declared(
        name = "let",
        example = "stiffness.summary.mean",
        intervals = ["geometry", "modification", "stiffness", "ste", "rating"]
    )]
    pub shared: Option<Vec<(String, Placed<String>)>>,
    /// results beside others: methods, settings, designs
    pub compare: Option<Vec<Compared>>,
    /// the figures of the report
    pub figures: Option<Vec<StatedFigure>>,
}

/// Points of a figure that its drawing shows at most, about: a few lines, each as fine as the drawing.
const MOST_DRAWN: u64 = 50_000;
/// Bytes in memory of a point that is read, and of one that is drawn: the table and its copy; the figure, and the page.
const BYTES_OF_POINT: u64 = 250;
const BYTES_OF_DRAWN: u64 = 400;
const SECONDS_OF_POINT: f64 = 5e-7;
const SECONDS_OF_DRAWN: f64 = 5e-6;

/// The stage as configured.
struct Report {
    entries: Vec<ReportEntry>,
    /// None where no input of theirs is an interval.
    rounded: Option<Rounded>,
    comparisons: Vec<Comparison>,
    figures: Vec<Figure>,
    /// What is wrong with others of them.
    wrong: Vec<Diagnostic>,
}

fn build(record: &Record) -> Result<Box<dyn Stage>, Faults> {
    let stated = Stated::checked(record)?;
    let shared = Shared::read(stated.shared.as_deref().unwrap_or_default(), &entry::subject::GIVEN)?;
    let published = stated.published.into_iter().flatten().zip(record.each_inside(Stated::NAMES.published));
    let published = published.map(|(stated, record)| Ok((stated.into(), record)));
    let tables = stated.printout.into_iter().flatten().zip(record.each_inside(Stated::NAMES.printout));
    let printed = tables.flat_map(|(table, record)| printed::entries(&table, record));
    let entries = (1..).zip(published.chain(printed)).map(|(number, stated)| {
        let (stated, record) = stated?;
        ReportEntry::read(number, &stated, record, &shared)
    });
    let (entries, mut wrong) = Faults::apart(entries);
    if wrong.is_empty() {
        wrong.extend(shared.check_used().err());
    }
    let compared = (1..).zip(stated.compare.iter().flatten()).zip(record.each_inside(Stated::NAMES.compare));
    let comparisons = compared.map(|((number, stated), record)| Comparison::read(number, stated, record));
    let (comparisons, of_comparisons) = Faults::apart(comparisons);
    let drawn = (1..).zip(stated.figures.iter().flatten()).zip(record.each_inside(Stated::NAMES.figures));
    let figures = drawn.map(|((number, stated), record)| Figure::read(number, stated, record));
    let (figures, of_figures) = Faults::apart(figures);
    wrong.extend(of_comparisons.into_iter().chain(of_figures).chain(figure::twice(&figures)));
    // What a kind refuses is told of the stage itself.
    let rounded = Varied::intervals(record).and_then(|varied| Rounded::new(varied, &entries).ok());
    Ok(Box::new(Report { entries, rounded, comparisons, figures, wrong }))
}

impl Report {
    /// All that names cells, and whether it must be one.
    fn operands(&self) -> impl Iterator<Item = (&Operand, bool)> {
        let compared = self.comparisons.iter().flat_map(Comparison::operands);
        self.entries.iter().flat_map(ReportEntry::operands).chain(compared.map(|operand| (operand, false)))
    }
}

impl Stage for Report {
    fn inputs(&self) -> Vec<Port> {
        let mut ports: Vec<Port> = Vec::new();
        let cells = self.operands().filter_map(|(operand, _)| operand.cell()).map(|cell| {
            let columns = cell.conditions.iter().map(|(column, _)| column.as_str()).chain([cell.column.as_str()]);
            (cell.stage.as_str(), cell.table.as_str(), columns.collect())
        });
        for (stage, table, columns) in cells.chain(self.figures.iter().flat_map(Figure::wants)) {
            want(&mut ports, stage, table, columns);
        }
        ports.extend(self.rounded.iter().flat_map(|rounded| rounded.ports().to_vec()));
        ports
    }

    fn uses_seed(&self) -> bool {
        self.rounded.as_ref().is_some_and(Rounded::uses_seed)
    }

    fn wrong(&self) -> &[Diagnostic] {
        &self.wrong
    }

    fn named(&self) -> Vec<Named> {
        let of_operand = |(operand, is_one): (&Operand, bool), beside| {
            Some(Named { cell: operand.cell()?.clone(), place: operand.place, rows: operand.rows, is_one, beside })
        };
        let entries = self.entries.iter().flat_map(|entry| {
            let subject = entry.operands().filter_map(move |named| of_operand(named, entry.beside(named.0)));
            subject.collect::<Vec<_>>()
        });
        let compared = self.comparisons.iter().flat_map(Comparison::operands);
        let compared = compared.filter_map(|operand| of_operand((operand, false), None));
        entries.chain(compared).chain(self.figures.iter().flat_map(Figure::named)).collect()
    }

    fn at_odds(&self, of: DimensionOf) -> Vec<Diagnostic> {
        let of_entries = self.entries.iter().flat_map(|entry| entry.at_odds(of));
        let of_comparison = |comparison: &Comparison| {
            let dimensions: Vec<_> = comparison.operands().map(|operand| operand.cell().and_then(of)).collect();
            comparison.of_one_sort([dimensions[0], dimensions[1]]).err()
        };
        of_entries.chain(self.comparisons.iter().filter_map(of_comparison)).collect()
    }

    fn outputs(&self) -> Vec<Schema> {
        let of_verdicts = [verdicts().schema(), verdict_counts().schema()];
        of_verdicts.into_iter().chain([figures().schema(), marks().schema(), comparisons().schema()]).collect()
    }

    fn estimate(&self, demand: &Demand, ahead: &Ahead) -> Estimate {
        let points: Vec<u64> = self.figures.iter().map(|figure| figure.points(ahead)).collect();
        let (all, maximum) = (points.iter().sum::<u64>(), points.iter().copied().max().unwrap_or(0));
        let drawn = points.iter().map(|points| points.min(&MOST_DRAWN)).sum::<u64>();
        Estimate::new(self.rounded.is_some())
            .holding(maximum.saturating_mul(BYTES_OF_POINT).saturating_add(drawn * BYTES_OF_DRAWN))
            .taking(all as f64 * SECONDS_OF_POINT + drawn as f64 * SECONDS_OF_DRAWN)
            .holding(self.entries.len() as u64 * 1000)
            .taking(self.rounded.as_ref().map_or(0.0, Rounded::seconds))
            .rows(demand, verdicts().schema(), RowCount::exact(self.entries.len()))
            .rows(demand, verdict_counts().schema(), RowCount::exact(Verdict::ALL.len()))
            .rows(demand, comparisons().schema(), RowCount::exact(self.comparisons.len()))
            .rows(demand, figures().schema(), RowCount::exact(self.figures.len()))
            .rows(demand, marks().schema(), RowCount::exact(self.figures.iter().map(Figure::marks).sum()))
    }

    fn refuses(&self, inputs: &Inputs) -> Result<(), Failure> {
        let is_there = |(stage, table): (&str, &str)| inputs.table(stage, table).is_ok();
        let are_there = |operands: &mut dyn Iterator<Item = &Operand>| {
            operands.filter_map(Operand::cell).all(|cell| is_there((&cell.stage, &cell.table)))
        };
        let entries = self.entries.iter().filter(|entry| are_there(&mut entry.operands().map(|(operand, _)| operand)));
        let comparisons = self.comparisons.iter().filter(|comparison| are_there(&mut comparison.operands()));
        let figures =
            self.figures.iter().filter(|figure| figure.wants().all(|(stage, table, _)| is_there((stage, table))));
        let wrong = entries.filter_map(|entry| entry.find(inputs, None).err());
        let wrong = wrong.chain(comparisons.filter_map(|comparison| comparison.find(inputs).err()));
        let wrong = wrong.chain(figures.filter_map(|figure| figure.marked(inputs).err()));
        Ok(Faults::all(told_once(wrong))?)
    }

    fn run(&self, context: &Context, inputs: &Inputs) -> Result<Vec<Table>, Failure> {
        context.check_stop()?;
        let ranges = match &self.rounded {
            Some(rounded) => rounded.ranges(&self.entries, (context, inputs))?,
            None => vec![None; self.entries.len()],
        };
        let found = Faults::collect(self.entries.iter().zip(ranges).map(|(entry, range)| entry.find(inputs, range)));
        context.check_stop()?;
        let compared = Faults::collect(self.comparisons.iter().map(|comparison| comparison.find(inputs)));
        let marked = Faults::collect(self.figures.iter().map(|figure| figure.marked(inputs)));
        let wrong = [found.as_ref().err(), compared.as_ref().err(), marked.as_ref().err()];
        Faults::all(told_once(wrong.into_iter().flatten().cloned().flatten()))?;
        let (found, compared) = (found?, compared?);
        let marked = marked?;
        let said = self.figures.iter().zip(&marked).flat_map(|(figure, marks)| figure.warned(inputs, marks));
        said.for_each(|said| (context.warn)(said.into()));
        let marked: Vec<_> = marked.into_iter().flatten().collect();
        let count = |verdict| found.iter().filter(|finding| finding.verdict == verdict).count();
        let counts = (1..).zip(Verdict::ALL).map(|(order, verdict)| CountRow { order, verdict, count: count(verdict) });
        let counts: Vec<_> = counts.collect();
        let drawn: Vec<&Figure> = self.figures.iter().collect();
        let table = |name: &str| match name {
            "verdicts" => verdicts().table(&found),
            "verdict_counts" => verdict_counts().table(&counts),
            "comparisons" => comparisons().table(&compared),
            "figures" => figures().table(&drawn),
            _ => marks().table(&marked),
        };
        let wanted = self.outputs().into_iter().filter(|schema| context.demand.table(&schema.name));
        wanted.map(|schema| table(&schema.name).map_err(|error| Failure::new(error.to_string()))).collect()
    }
}

/// What is wrong, each once: rows of a printed table may have theirs from one place.
fn told_once(wrong: impl Iterator<Item = Diagnostic>) -> Vec<Diagnostic> {
    let mut told = BTreeSet::new();
    wrong.filter(|wrong| told.insert((wrong.place.map(|place| place.offset), wrong.message.clone()))).collect()
}

/// Adds a table and columns to the port of a stage.
fn want(ports: &mut Vec<Port>, stage: &str, table: &str, columns: Vec<&str>) {
    let at = ports.iter().position(|port| port.stage == stage).unwrap_or_else(|| {
        ports.push(Port::tables(stage, stage, &[]));
        ports.len() - 1
    });
    let wants = &mut ports[at].wants;
    let at = wants.iter().position(|want| want.table == table).unwrap_or_else(|| {
        wants.push(Want { table: table.to_owned(), columns: Vec::new() });
        wants.len() - 1
    });
    let all: BTreeSet<String> = wants[at].columns.drain(..).chain(columns.into_iter().map(str::to_owned)).collect();
    wants[at].columns = all.into_iter().collect();
}

/// How often a verdict was given, and its place among all, from 1.
struct CountRow {
    order: usize,
    verdict: Verdict,
    count: usize,
}

fn verdict_counts() -> Columns<CountRow> {
    Columns::new("verdict_counts", "How often each verdict was given, and what it means.")
        .integer("order", "What needs attention comes first.", |row: &CountRow| row.order)
        .key()
        .text("verdict", "The verdict's word.", |row| row.verdict.word())
        .integer("count", "Entries with this verdict.", |row| row.count)
        .flag("needs_attention", "Whether somebody has to look at it.", |row| row.verdict.needs_attention())
        .text("meaning", "What it means.", |row| row.verdict.meaning())
}

#[cfg(test)]
mod tests;
