//! One published number or claim: read from its record, then compared with what was computed.
//!
//! Must not know: figures, other entries.

pub mod subject;
mod units;

use self::subject::{Proof, Subject, given, read_proof, read_subject};
use super::printed::Printed;
use super::rounded::said::Inside;
use super::stated::{Expected, Published};
use super::verdict::{Comparison, Verdict};
use crate::stage::Inputs;
use crate::stage::formula::Outcome;
use crate::stage::operand::names::Shared;
use crate::stage::operand::rows::OperandRows;
use crate::stage::operand::{Operand, in_si};
use crate::stage::quantity::Number;
use crate::stage::target::{Target, read_target};
use declare::error::{Diagnostic, Place};
use declare::record::Record;
use declare::units::{Dimension, RATIO, in_unit};
use studygraph::table::columns::Columns;
use studygraph::table::schema::Column;
use studygraph::table::select::CellName;

pub struct ReportEntry {
    /// From 1, in the order of the study.
    pub number: usize,
    /// Where cell, formula or claim stands.
    place: Place,
    label: String,
    location: String,
    subject: Subject,
    /// None for a claim.
    published: Option<Target>,
    expected: Option<Target>,
    because: String,
    note: String,
    proof: Option<Proof>,
}

/// What came of an entry.
pub struct Finding<'a> {
    entry: &'a ReportEntry,
    inside: Option<Inside>,
    comparison: Comparison,
    pub verdict: Verdict,
    /// In how many rows a claim holds, in words.
    found: String,
    /// The formula's names with their values.
    numbers: String,
    proof: String,
    /// The rows in which a claim does not hold.
    failing: String,
}

impl Finding<'_> {
    fn difference(&self) -> f64 {
        self.comparison.computed - self.comparison.published
    }

    fn relative_difference(&self) -> f64 {
        let published = self.comparison.published;
        if published == 0.0 { f64::NAN } else { self.difference() / published.abs() }
    }

    /// The least and the largest value inside the intervals of its inputs.
    fn range(&self) -> (f64, f64) {
        self.comparison.range.unwrap_or((f64::NAN, f64::NAN))
    }

    /// What is said of that.
    fn rounding(&self) -> String {
        self.inside.as_ref().map_or_else(String::new, |inside| inside.said(&self.comparison, self.entry.unit()))
    }

    /// The value the study stands by, and its tolerance.
    fn expected(&self) -> (f64, f64) {
        self.comparison.expected.unwrap_or((f64::NAN, f64::NAN))
    }
}

/// Values in the row's unit, as printed.
pub fn verdicts<'a>() -> Columns<Finding<'a>> {
    let description = "What the paper printed, what was computed, and what is to be said about it.";
    let with = "What the names in a formula or claim stand for.";
    let published = "The published value in the row's unit; for a claim the number of rows.";
    let computed = "The computed value in the row's unit; for a claim the rows in which it holds.";
    let least = "The least value inside the intervals of its inputs, as far as computed; NaN where none matters.";
    let largest = "The largest one; every value between both is taken inside, if the computed one is continuous there.";
    let rounding = "Whether some value inside the intervals of its inputs reproduces it; empty where none matters.";
    let unit = "Unit of published, computed, least, largest, difference, tolerance and expected.";
    let relative = "(computed − published)/|published|; NaN where that is 0.";
    let tolerance = "How far apart the two may be and still agree.";
    let expected_tolerance = "How far the computed value may be from the expected one.";
    let verdict = "Unexplained, moved, outdated, explained, refuted, reproduced or holds.";
    let proof = "The arithmetic that proves the reason, with its numbers.";
    Columns::new("verdicts", description)
        .integer("number", "Number of the entry, in the order of the study.", |row: &Finding<'a>| row.entry.number)
        .key()
        .text("label", "What it is, in words.", |row| row.entry.label.as_str())
        .text("where", "Where the paper says it.", |row| row.entry.location.as_str())
        .text("cell", "The computed cell, formula or claim.", |row| row.entry.subject.text())
        .text("with", with, |row| row.entry.subject.with())
        .text("kind", "Value or claim.", |row| if row.comparison.is_claim { "claim" } else { "value" })
        .text("published_text", "The published value as printed, with its unit.", |row| {
            row.entry.published.as_ref().map_or("holds", |target| target.stated.text.as_str())
        })
        .float("published", "", published, |row| row.comparison.published)
        .float("computed", "", computed, |row| row.comparison.computed)
        .float("least", "", least, |row| row.range().0)
        .but(Column::allows_nan)
        .float("largest", "", largest, |row| row.range().1)
        .but(Column::allows_nan)
        .text("found", "For a claim: in how many rows it holds.", |row| row.found.clone())
        .text("unit", unit, |row| row.entry.unit())
        .float("difference", "", "Computed − published.", Finding::difference)
        .but(|column| column.tolerance(1e-12, 1e-6))
        .float("relative_difference", "", relative, Finding::relative_difference)
        .but(|column| column.tolerance(1e-9, 1e-6).allows_nan())
        .float("tolerance", "", tolerance, |row| row.comparison.tolerance)
        .float("expected", "", "The value the study stands by.", |row| row.expected().0)
        .but(Column::allows_nan)
        .float("expected_tolerance", "", expected_tolerance, |row| row.expected().1)
        .but(Column::allows_nan)
        .text("verdict", verdict, |row| row.verdict.word())
        .text("because", "Why they differ.", |row| row.entry.because.as_str())
        .text("note", "A remark that claims no difference.", |row| row.entry.note.as_str())
        .text("rounding", rounding, Finding::rounding)
        .text("numbers", "The formula's names with their values.", |row| row.numbers.clone())
        .text("proof", proof, |row| row.proof.clone())
        .text("failing", "For a claim: the rows in which it does not hold.", |row| row.failing.clone())
}

impl ReportEntry {
    /// # Errors
    /// What is wrong with the entry, at the place of the field.
    pub fn read(number: usize, printed: &Printed, record: &Record, shared: &Shared) -> Result<Self, Diagnostic> {
        let Printed { published: stated, row } = printed;
        let subject = read_subject(stated, row.as_ref(), record, shared)?;
        let is_claim = matches!(subject, Subject::Claim(..));
        let published = match (&stated.value, is_claim) {
            (Some(value), false) => Some(read_target(value, &stated.tolerance, None)?),
            (None, false) => {
                return Err(Diagnostic::new("the published `value` is missing")
                    .at(record.place)
                    .help("write `value: 2.316 um`"));
            }
            (Some(value), true) => {
                return Err(Diagnostic::new("a claim holds or not; it has no `value`").at(value.place));
            }
            (None, true) => None,
        };
        let unit = published.as_ref().map_or(RATIO, |target| target.stated.dimension);
        let expected = stated.expected.as_ref();
        let expected = expected.map(|Expected { value, tolerance }| read_target(value, tolerance, Some(unit)));
        let expected = expected.transpose()?;
        let proof = stated.proof.as_ref().map(|proof| read_proof(proof, shared)).transpose()?;
        let because = trimmed(stated.because.as_deref());
        if because.is_empty() && proof.is_some() {
            return Err(Diagnostic::new("a proof is given, but not the reason it proves")
                .at(record.place_of(Published::NAMES.proof))
                .help("add `because: …`"));
        }
        let entry = Self {
            number,
            place: given(stated).next().map_or(record.place, |(_, text)| text.place),
            label: trimmed(stated.label.as_deref()),
            location: trimmed(stated.location.as_deref()),
            subject,
            published,
            expected,
            because,
            note: trimmed(stated.note.as_deref()),
            proof,
        };
        entry.check_quantities(stated)?;
        Ok(entry)
    }

    /// Evaluates what needs no table, so that units which do not go together are found before anything runs.
    fn check_quantities(&self, stated: &Published) -> Result<(), Diagnostic> {
        if let Subject::Formula(formula, with) | Subject::Claim(formula, with) = &self.subject
            && with.iter().all(|(_, operand)| operand.cell().is_none())
        {
            let given = if formula.is_claim() { &stated.claim } else { &stated.formula };
            let place = given.as_ref().map_or(self.place, |given| given.place);
            let wrong = |message: String| Diagnostic::new(message).at(place);
            let rows = OperandRows::of(&Inputs::default(), with)?;
            let outcome = formula.evaluate(rows.names(0, &rows.lookup(None))).map_err(wrong)?;
            if let (Outcome::Number(number), Some(target)) = (outcome, &self.published) {
                target.stated.check_dimension(number).map_err(wrong)?;
            }
        }
        if let Some(Proof { claim, with, .. }) = &self.proof
            && with.iter().all(|(_, operand)| operand.cell().is_none())
            && claim.names().all(|name| name != "computed" && (name != "published" || self.published.is_some()))
        {
            self.prove(
                &Inputs::default(),
                self.published.as_ref().map_or(f64::NAN, |target| target.stated.number),
                f64::NAN,
            )?;
        }
        Ok(())
    }

    /// Every operand that names cells, and whether it must be one.
    pub fn operands(&self) -> impl Iterator<Item = (&Operand, bool)> {
        let (cell, formula, with) = match &self.subject {
            Subject::Cell(operand) => (Some((operand, true)), None, [].as_slice()),
            Subject::Formula(formula, with) => (None, Some(formula), with.as_slice()),
            // Judged in every row.
            Subject::Claim(_, with) => (None, None, with.as_slice()),
        };
        let with =
            with.iter().map(move |named| (&named.1, formula.is_some_and(|formula| formula.row_by_row(&named.0))));
        let proof = self
            .proof
            .iter()
            .flat_map(|Proof { claim, with, .. }| with.iter().map(move |named| (&named.1, claim.row_by_row(&named.0))));
        cell.into_iter().chain(with).chain(proof)
    }

    /// What a cell is compared with by itself: its dimension, its text, and its place.
    pub fn beside(&self, operand: &Operand) -> Option<(Dimension, String, Place)> {
        let is_it = matches!(&self.subject, Subject::Cell(cell) if cell.place == operand.place);
        let target = self.published.as_ref().filter(|_| is_it)?;
        Some((target.stated.dimension, target.stated.text.clone(), target.place))
    }

    /// The cells that its number comes from; a claim has none.
    pub fn cells(&self) -> impl Iterator<Item = &CellName> {
        let (cell, with) = match &self.subject {
            Subject::Cell(operand) => (Some(operand), [].as_slice()),
            Subject::Formula(_, with) => (None, with.as_slice()),
            Subject::Claim(..) => (None, [].as_slice()),
        };
        cell.into_iter().chain(with.iter().map(|(_, operand)| operand)).filter_map(Operand::cell)
    }

    /// The number in the published unit, and what the names of a formula come to; a claim has none.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn number(&self, inputs: &Inputs) -> Result<Option<(f64, String)>, Diagnostic> {
        Ok(match &self.subject {
            Subject::Cell(operand) => {
                let values = operand.resolve(inputs)?;
                Some((self.in_published_unit(values.single(operand)?)?, String::new()))
            }
            Subject::Formula(formula, with) => {
                let rows = OperandRows::of(inputs, with)?;
                rows.single(formula)?;
                match formula.evaluate(rows.names(0, &rows.lookup(None))).map_err(Diagnostic::new)? {
                    Outcome::Number(number) => Some((self.in_published_unit(number)?, rows.written(0))),
                    Outcome::Truth(_) => return Err(Diagnostic::new("a formula gives a number")),
                }
            }
            Subject::Claim(..) => None,
        })
    }

    /// The published value, and how far a number may be off it; a claim has none.
    pub fn aim(&self) -> Option<(f64, f64)> {
        self.published.as_ref().map(|target| (target.stated.number, target.tolerance))
    }

    /// Compares; `inside` is what its number is inside the intervals of its inputs.
    ///
    /// # Errors
    /// What is wrong with it, at its place.
    pub fn find(&self, inputs: &Inputs, inside: Option<Inside>) -> Result<Finding<'_>, Diagnostic> {
        self.compare(inputs, inside).map_err(|found| found.or_at(self.place))
    }

    fn compare(&self, inputs: &Inputs, inside: Option<Inside>) -> Result<Finding<'_>, Diagnostic> {
        let unit = self.unit();
        let (computed, total, numbers, failing) = match &self.subject {
            Subject::Cell(_) | Subject::Formula(..) => {
                let (number, numbers) = self.number(inputs)?.unwrap_or((f64::NAN, String::new()));
                (number, 0.0, numbers, String::new())
            }
            Subject::Claim(formula, with) => {
                let rows = OperandRows::of(inputs, with)?;
                let (value, count) = (rows.lookup(None), rows.judged(formula));
                let mut failing = Vec::new();
                for row in 0..count {
                    if formula.evaluate(rows.names(row, &value)).map_err(Diagnostic::new)? == Outcome::Truth(false) {
                        failing.push(row);
                    }
                }
                let remark = rows.remark(&failing, formula).map_err(Diagnostic::new)?;
                let held = (count - failing.len()) as f64;
                (held, count as f64, if count == 1 { rows.written(0) } else { String::new() }, remark)
            }
        };
        let (published, tolerance) = self.aim().unwrap_or((total, 0.0));
        let expected = self.expected.as_ref().map(|target| target.within(unit)).transpose().map_err(Diagnostic::new)?;
        let (proof_holds, proof) = self.prove(inputs, published, computed)?.unzip();
        let proof = proof.unwrap_or_default();
        let has_reason = !self.because.is_empty();
        let is_claim = self.published.is_none();
        let range = inside.as_ref().and_then(Inside::ends);
        let is_broken = inside.as_ref().is_some_and(Inside::is_broken);
        let comparison = Comparison {
            published,
            computed,
            range,
            is_broken,
            tolerance,
            expected,
            has_reason,
            proof_holds,
            is_claim,
        };
        let verdict = comparison.judge().map_err(Diagnostic::new)?;
        let found = match (is_claim, total > 1.0) {
            (false, _) => String::new(),
            (true, true) => format!("holds in {computed} of {total}"),
            (true, false) => (if computed > 0.0 { "holds" } else { "does not hold" }).to_owned(),
        };
        Ok(Finding { entry: self, inside, comparison, verdict, found, numbers, proof, failing })
    }

    /// Of the published value; none for a claim.
    fn unit(&self) -> &str {
        self.published.as_ref().map_or("", |target| target.stated.unit.as_str())
    }

    fn in_published_unit(&self, number: Number) -> Result<f64, Diagnostic> {
        let Some(target) = &self.published else { return Ok(number.si) };
        target.stated.check_dimension(number).map_err(|message| Diagnostic::new(message).at(target.place))?;
        Ok(in_unit(number.si, &target.stated.unit))
    }

    /// Whether the proof holds, and its text with the numbers put in.
    fn prove(&self, inputs: &Inputs, published: f64, computed: f64) -> Result<Option<(bool, String)>, Diagnostic> {
        let Some(Proof { claim, place, with }) = &self.proof else { return Ok(None) };
        let rows = OperandRows::of(inputs, with)?;
        rows.single(claim)?;
        let wrong = |problem: String| Diagnostic::new(format!("proof: {problem}")).at(*place);
        let unit = self.unit();
        // A value that is not known yet is NaN, which no formula lets pass.
        let number = |value: f64| if value.is_nan() { Ok(Number::plain(value)) } else { in_si(value, unit) };
        let given = (number(published).map_err(wrong)?, number(computed).map_err(wrong)?);
        let value = rows.lookup(Some(given));
        let names = rows.names(0, &value);
        let outcome = claim.evaluate(names).map_err(wrong)?;
        let numbers = claim.with_numbers(names, unit).map_err(wrong)?;
        let written = rows.written(0);
        let written = if written.is_empty() { written } else { format!(", with {written}") };
        let holds = outcome == Outcome::Truth(true);
        let mark = if holds { "" } else { " — does not hold" };
        Ok(Some((holds, format!("{}: {numbers}{mark}{written}", claim.text))))
    }
}

fn trimmed(text: Option<&str>) -> String {
    text.unwrap_or_default().trim().to_owned()
}
