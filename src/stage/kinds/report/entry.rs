//! One published number or claim: read from its record, then compared with what was computed.
//!
//! Must not know: figures, other entries.

use crate::base::error::{Diagnostic, Place};
use crate::base::number::Printed;
use crate::base::record::{Record, Value};
use crate::base::units::{Dimension, RATIO, in_unit, parse_quantity, split_quantity};
use crate::stage::Inputs;
use crate::table::data::Row;

use super::formula::{Formula, Names, Number, Outcome, described, same_dimension, shown};
use super::operand::{Operand, Values, in_si};
use super::verdict::{Comparison, Verdict};

/// Names that a proof may use without giving them.
const GIVEN: [&str; 2] = ["published", "computed"];

type Operands = Vec<(String, Operand)>;

/// What is compared with the published value.
enum Subject {
    Cell(Operand),
    Formula(Formula, Operands),
    /// True or false in every row.
    Claim(Formula, Operands),
}

/// A value as printed.
struct Stated {
    text: String,
    /// In `unit`.
    number: f64,
    unit: String,
    dimension: Dimension,
    printed: Printed,
}

/// A stated value and how far a computed one may be from it, in the stated unit.
struct Target {
    stated: Stated,
    tolerance: f64,
}

struct Proof {
    claim: Formula,
    with: Operands,
}

pub struct Entry {
    /// From 1, in the order of the study.
    pub number: usize,
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
pub struct Finding {
    pub verdict: Verdict,
    /// A row of the table of verdicts.
    pub row: Row,
}

impl Entry {
    /// # Errors
    /// What is wrong with the entry, at the place of the field.
    pub fn read(number: usize, record: &Record) -> Result<Self, Diagnostic> {
        let wrong = |message: String, field: &str| Diagnostic::new(message).at(record.place_of(field));
        let text = |field: &str| record.maybe_text(field).unwrap_or_default().trim().to_owned();
        let subject = read_subject(record)?;
        let is_claim = matches!(subject, Subject::Claim(..));
        let published = match (record.maybe_text("value"), is_claim) {
            (Some(_), false) => Some(read_target(record, None)?),
            (None, false) => {
                return Err(Diagnostic::new("the published `value` is missing")
                    .at(record.place)
                    .help("write `value: 2.316 um`"));
            }
            (Some(_), true) => return Err(wrong("a claim holds or not; it has no `value`".to_owned(), "value")),
            (None, true) => None,
        };
        let unit = published.as_ref().map_or(RATIO, |target| target.stated.dimension);
        let expected = record.maybe_group("expected").map(|group| read_target(group, Some(unit))).transpose()?;
        let proof = record.maybe_group("proof").map(read_proof).transpose()?;
        let because = text("because");
        if because.is_empty() && proof.is_some() {
            return Err(
                wrong("a proof is given, but not the reason it proves".to_owned(), "proof").help("add `because: …`")
            );
        }
        let entry = Self {
            number,
            place: record.place,
            label: text("label"),
            location: text("where"),
            subject,
            published,
            expected,
            because,
            note: text("note"),
            proof,
        };
        entry.check_quantities(record)?;
        Ok(entry)
    }

    /// Evaluates what needs no table, so that units which do not go together are found before anything runs.
    fn check_quantities(&self, record: &Record) -> Result<(), Diagnostic> {
        if let Subject::Formula(formula, with) | Subject::Claim(formula, with) = &self.subject
            && with.iter().all(|(_, operand)| operand.cell().is_none())
        {
            let field = if formula.is_claim() { "claim" } else { "formula" };
            let wrong = |message: String| Diagnostic::new(message).at(record.place_of(field));
            let outcome = rows_of(&Inputs::default(), with)
                .and_then(|rows| formula.evaluate(&rows.names(0, None)))
                .map_err(wrong)?;
            if let (Outcome::Number(number), Some(target)) = (outcome, &self.published) {
                target.stated.check_dimension(number).map_err(wrong)?;
            }
        }
        if let Some(Proof { claim, with }) = &self.proof
            && with.iter().all(|(_, operand)| operand.cell().is_none())
            && claim.names().all(|name| name != "computed")
        {
            let place = record.maybe_group("proof").map_or(record.place, |proof| proof.place_of("claim"));
            self.prove(&Inputs::default(), f64::NAN).map_err(|message| Diagnostic::new(message).at(place))?;
        }
        Ok(())
    }

    /// Every operand that names cells.
    pub fn operands(&self) -> impl Iterator<Item = &Operand> {
        let (cell, with) = match &self.subject {
            Subject::Cell(operand) => (Some(operand), [].as_slice()),
            Subject::Formula(_, with) | Subject::Claim(_, with) => (None, with.as_slice()),
        };
        let proof = self.proof.as_ref().map_or([].as_slice(), |proof| proof.with.as_slice());
        cell.into_iter().chain(with.iter().chain(proof).map(|(_, operand)| operand))
    }

    /// Compares.
    ///
    /// # Errors
    /// A sentence that names the entry.
    pub fn find(&self, inputs: &Inputs) -> Result<Finding, String> {
        self.compare(inputs).map_err(|problem| {
            let location = if self.location.is_empty() { String::new() } else { format!(", {}", self.location) };
            format!("`published` entry {} (line {}{location}): {problem}", self.number, self.place.line)
        })
    }

    fn compare(&self, inputs: &Inputs) -> Result<Finding, String> {
        let unit = self.published.as_ref().map_or("", |target| target.stated.unit.as_str());
        let (computed, total, numbers, remark) = match &self.subject {
            Subject::Cell(operand) => {
                let values = operand.resolve(inputs)?;
                (self.in_published_unit(values.single(&operand.text)?)?, 0.0, String::new(), String::new())
            }
            Subject::Formula(formula, with) => {
                let rows = rows_of(inputs, with)?;
                rows.single()?;
                match formula.evaluate(&rows.names(0, None))? {
                    Outcome::Number(number) => (self.in_published_unit(number)?, 0.0, rows.written(0), String::new()),
                    Outcome::Truth(_) => return Err("a formula gives a number".to_owned()),
                }
            }
            Subject::Claim(formula, with) => {
                let rows = rows_of(inputs, with)?;
                let mut failing = Vec::new();
                for row in 0..rows.count {
                    if formula.evaluate(&rows.names(row, None))? == Outcome::Truth(false) {
                        failing.push(row);
                    }
                }
                let remark = rows.remark(&failing, formula)?;
                let held = (rows.count - failing.len()) as f64;
                (held, rows.count as f64, if rows.count == 1 { rows.written(0) } else { String::new() }, remark)
            }
        };
        let published = self.published.as_ref().map_or(total, |target| target.stated.number);
        let tolerance = self.published.as_ref().map_or(0.0, |target| target.tolerance);
        let expected = match &self.expected {
            Some(target) => Some((target.stated.in_unit(unit)?, convert(target.tolerance, &target.stated.unit, unit)?)),
            None => None,
        };
        let (proof_holds, proof) = match self.prove(inputs, computed)? {
            Some((holds, text)) => (Some(holds), text),
            None => (None, String::new()),
        };
        let has_reason = !self.because.is_empty();
        let is_claim = self.published.is_none();
        let verdict =
            Comparison { published, computed, tolerance, expected, has_reason, proof_holds, is_claim }.judge()?;
        let (cell, with) = self.subject.written();
        let stated = self.published.as_ref().map_or_else(|| "holds".to_owned(), |target| target.stated.text.clone());
        let found = if is_claim { format!("holds in {computed} of {total}") } else { String::new() };
        let difference = computed - published;
        let row = vec![
            self.number.into(),
            self.label.as_str().into(),
            self.location.as_str().into(),
            cell.into(),
            with.into(),
            (if is_claim { "claim" } else { "value" }).into(),
            stated.into(),
            published.into(),
            computed.into(),
            found.into(),
            unit.into(),
            difference.into(),
            (if published == 0.0 { f64::NAN } else { difference / published.abs() }).into(),
            tolerance.into(),
            expected.map_or(f64::NAN, |(value, _)| value).into(),
            expected.map_or(f64::NAN, |(_, tolerance)| tolerance).into(),
            verdict.word().into(),
            self.because.as_str().into(),
            self.note.as_str().into(),
            numbers.into(),
            proof.into(),
            remark.into(),
        ];
        Ok(Finding { verdict, row })
    }

    fn in_published_unit(&self, number: Number) -> Result<f64, String> {
        let Some(target) = &self.published else { return Ok(number.si) };
        target.stated.check_dimension(number)?;
        Ok(in_unit(number.si, &target.stated.unit))
    }

    /// Whether the proof holds, and its text with the numbers put in.
    fn prove(&self, inputs: &Inputs, computed: f64) -> Result<Option<(bool, String)>, String> {
        let Some(Proof { claim, with }) = &self.proof else { return Ok(None) };
        let rows = rows_of(inputs, with).map_err(|problem| format!("proof: {problem}"))?;
        rows.single().map_err(|problem| format!("proof: {problem}"))?;
        let unit = self.published.as_ref().map_or("", |target| target.stated.unit.as_str());
        let published =
            self.published.as_ref().map_or(Ok(Number::plain(1.0)), |target| in_si(target.stated.number, unit));
        let given = (published?, in_si(computed, unit).unwrap_or(Number::plain(f64::NAN)));
        let names = rows.names(0, Some(given));
        let outcome = claim.evaluate(&names).map_err(|problem| format!("proof: {problem}"))?;
        let numbers = claim.with_numbers(&names, unit).map_err(|problem| format!("proof: {problem}"))?;
        let written = rows.written(0);
        let written = if written.is_empty() { written } else { format!(", with {written}") };
        let holds = outcome == Outcome::Truth(true);
        let mark = if holds { "" } else { " — does not hold" };
        Ok(Some((holds, format!("{}: {numbers}{mark}{written}", claim.text))))
    }
}

impl Subject {
    /// The cell, formula or claim as written, and what its names stand for.
    fn written(&self) -> (String, String) {
        match self {
            Self::Cell(operand) => (operand.text.clone(), String::new()),
            Self::Formula(formula, with) | Self::Claim(formula, with) => {
                let with: Vec<String> =
                    with.iter().map(|(name, operand)| format!("{name} = {}", operand.text)).collect();
                (formula.text.clone(), with.join("; "))
            }
        }
    }
}

impl Stated {
    fn check_dimension(&self, number: Number) -> Result<(), String> {
        if same_dimension(number.dimension, self.dimension) {
            return Ok(());
        }
        let (found, stated) = (described(number.dimension), described(self.dimension));
        Err(format!("what is computed is {found}, but the published `{}` is {stated}", self.text))
    }

    fn in_unit(&self, unit: &str) -> Result<f64, String> {
        convert(self.number, &self.unit, unit)
    }
}

fn convert(value: f64, from: &str, to: &str) -> Result<f64, String> {
    if from == to { Ok(value) } else { in_si(value, from).map(|number| in_unit(number.si, to)) }
}

/// The values of every name, in rows that line up.
struct Rows<'a> {
    with: &'a [(String, Operand)],
    values: Vec<Values>,
    /// The operand whose rows are counted, if any has several.
    leader: Option<usize>,
    count: usize,
}

fn rows_of<'a>(inputs: &Inputs, with: &'a [(String, Operand)]) -> Result<Rows<'a>, String> {
    let values: Vec<Values> = with
        .iter()
        .map(|(name, operand)| operand.resolve(inputs).map_err(|problem| format!("{name} = {problem}")))
        .collect::<Result<_, _>>()?;
    let leader = values.iter().position(|values| values.numbers.len() > 1);
    let count = leader.map_or(1, |leader| values[leader].numbers.len());
    if let Some(leader) = leader {
        for (other, (name, _)) in values.iter().zip(with) {
            if other.numbers.len() > 1 && (&other.keys, &other.rows) != (&values[leader].keys, &values[leader].rows) {
                let (first, keys) = (&with[leader].0, values[leader].keys.join(", "));
                return Err(format!(
                    "the rows of {first} ({count}, by {keys}) and {name} ({}, by {}) do not line up",
                    other.numbers.len(),
                    other.keys.join(", ")
                ));
            }
        }
    }
    Ok(Rows { with, values, leader, count })
}

impl Rows<'_> {
    fn single(&self) -> Result<(), String> {
        for (values, (_, operand)) in self.values.iter().zip(self.with) {
            values.single(&operand.text)?;
        }
        Ok(())
    }

    fn number(&self, operand: usize, row: usize) -> Number {
        let numbers = &self.values[operand].numbers;
        numbers[if numbers.len() == 1 { 0 } else { row }]
    }

    /// The names of one row; `given` are `published` and `computed`, in a proof.
    fn names(&self, row: usize, given: Option<(Number, Number)>) -> impl Fn(&str) -> Option<Number> + '_ {
        move |name| match (name, given) {
            ("published", Some((published, _))) => Some(published),
            ("computed", Some((_, computed))) => Some(computed),
            _ => self.with.iter().position(|(known, _)| known == name).map(|operand| self.number(operand, row)),
        }
    }

    /// `k1 = 273.8×10⁶ N/m, …`
    fn written(&self, row: usize) -> String {
        let one = |(operand, (name, _)): (usize, &(String, Operand))| {
            let text = shown(self.number(operand, row), &self.values[operand].unit, 6);
            format!("{name} = {text}")
        };
        self.with.iter().enumerate().map(one).collect::<Vec<_>>().join(", ")
    }

    /// Where a claim does not hold, with the numbers of the first such row.
    fn remark(&self, failing: &[usize], formula: &Formula) -> Result<String, String> {
        const MOST: usize = 6;
        let (Some(&first), Some(leader)) = (failing.first(), self.leader) else { return Ok(String::new()) };
        let (keys, rows) = (&self.values[leader].keys, &self.values[leader].rows);
        let at = |row: usize| {
            let parts = keys.iter().zip(&rows[row]).map(|(key, value)| format!("{key} {value}"));
            parts.collect::<Vec<_>>().join(", ")
        };
        let mut places: Vec<String> = failing.iter().take(MOST).map(|&row| at(row)).collect();
        if failing.len() > MOST {
            places.push(format!("and {} more", failing.len() - MOST));
        }
        let names: Names = &self.names(first, None);
        let numbers = formula.with_numbers(names, &self.values[leader].unit)?;
        Ok(format!("does not hold at {}; at {}: {numbers}", places.join("; "), at(first)))
    }
}

fn read_subject(record: &Record) -> Result<Subject, Diagnostic> {
    let given: Vec<&str> =
        ["cell", "formula", "claim"].into_iter().filter(|field| record.entry(field).is_some()).collect();
    let [field] = given.as_slice() else {
        let found = if given.is_empty() { "none".to_owned() } else { format!("`{}`", given.join("` and `")) };
        let message = format!("an entry has one of `cell`, `formula` and `claim`; found {found}");
        return Err(Diagnostic::new(message).at(given.get(1).map_or(record.place, |field| record.place_of(field))));
    };
    let place = record.place_of(field);
    let wrong = |message: String| Diagnostic::new(message).at(place);
    let text = record.text(field);
    if *field == "cell" {
        if record.entry("with").is_some() {
            return Err(Diagnostic::new("`with` gives names to a `formula` or `claim`, not to a `cell`")
                .at(record.place_of("with")));
        }
        let operand = Operand::parse(text).map_err(wrong)?;
        return if operand.cell().is_some() {
            Ok(Subject::Cell(operand))
        } else {
            Err(wrong(format!("`{text}` is no cell; write `stage.table[key=value, …].column`")))
        };
    }
    let with = read_operands(record, &[])?;
    let formula = read_formula(text, &with, &[], place)?;
    match (*field, formula.is_claim()) {
        ("formula", false) => Ok(Subject::Formula(formula, with)),
        ("claim", true) => Ok(Subject::Claim(formula, with)),
        ("formula", true) => Err(wrong(format!("`{text}` is true or false; call it `claim` and give no value"))),
        _ => Err(wrong(format!("`{text}` is a number; a claim compares, for example `ga <= iso`"))),
    }
}

fn read_proof(record: &Record) -> Result<Proof, Diagnostic> {
    let with = read_operands(record, &GIVEN)?;
    let place = record.place_of("claim");
    let claim = read_formula(record.text("claim"), &with, &GIVEN, place)?;
    if claim.is_claim() {
        Ok(Proof { claim, with })
    } else {
        Err(Diagnostic::new(format!("`{}` is a number; a proof compares, for example `{0} > published`", claim.text))
            .at(place))
    }
}

/// Reads `with`; refuses the names that stand for something already.
fn read_operands(record: &Record, taken: &[&str]) -> Result<Operands, Diagnostic> {
    let mut operands = Operands::new();
    for (name, entry) in record.maybe_map("with").unwrap_or_default() {
        let wrong = |message: String| Diagnostic::new(message).at(entry.place);
        if taken.contains(&name.as_str()) {
            return Err(wrong(format!("`{name}` stands for the {name} value already; choose another name")));
        }
        let Value::Text(text) = &entry.value else { return Err(wrong(format!("`{name}` is no text"))) };
        operands.push((name.clone(), Operand::parse(text).map_err(wrong)?));
    }
    Ok(operands)
}

fn read_formula(text: &str, with: &Operands, given: &[&str], place: Place) -> Result<Formula, Diagnostic> {
    let names: Vec<&str> = with.iter().map(|(name, _)| name.as_str()).chain(given.iter().copied()).collect();
    let formula = Formula::parse(text, &names).map_err(|message| {
        Diagnostic::new(message).at(place).help("allowed: + - * / ^ sqrt() abs() min() max() < <= > >= == != && || !")
    })?;
    if let Some((unused, _)) = with.iter().find(|(name, _)| formula.names().all(|used| used != name)) {
        return Err(Diagnostic::new(format!("`with` gives `{unused}`, but `{text}` does not use it")).at(place));
    }
    Ok(formula)
}

/// Reads `value` and `tolerance`; `dimension` is what the value must have, where that is known.
fn read_target(record: &Record, dimension: Option<Dimension>) -> Result<Target, Diagnostic> {
    let place = record.place_of("value");
    let wrong = |message: String| Diagnostic::new(message).at(place);
    let text = record.text("value").trim();
    let quantity = parse_quantity(text).map_err(|error| wrong(format!("value `{text}`: {error}")))?;
    if let Some(wanted) = dimension.filter(|wanted| !same_dimension(*wanted, quantity.dimension)) {
        let (found, wanted) = (described(quantity.dimension), described(wanted));
        return Err(wrong(format!("`{text}` is {found}; the published value is {wanted}")));
    }
    let (number, unit) = split_quantity(text);
    let (Ok(number), Some(printed)) = (number.parse::<f64>(), Printed::read(text)) else {
        return Err(wrong(format!("`{text}` is no number followed by a unit")));
    };
    let stated =
        Stated { text: text.to_owned(), number, unit: unit.to_owned(), dimension: quantity.dimension, printed };
    let tolerance = read_tolerance(record, &stated)?;
    Ok(Target { stated, tolerance })
}

/// `digits`, `1 %` of the value, or a quantity.
fn read_tolerance(record: &Record, stated: &Stated) -> Result<f64, Diagnostic> {
    const HELP: &str =
        "write `digits` (as far as the printed digits go), `1 %` (of the value), or a quantity in the value's unit";
    let wrong = |message: String| Diagnostic::new(message).at(record.place_of("tolerance")).help(HELP);
    let text = record.maybe_text("tolerance").unwrap_or("digits").trim();
    if text == "digits" {
        return Ok(stated.printed.half_unit());
    }
    let quantity = parse_quantity(text).map_err(|error| wrong(format!("tolerance `{text}`: {error}")))?;
    if quantity.value < 0.0 {
        return Err(wrong(format!("the tolerance `{text}` is negative")));
    }
    if quantity.has_unit && quantity.dimension == RATIO {
        if stated.number == 0.0 {
            return Err(wrong(format!("`{text}` of a value of 0 is nothing")));
        }
        return Ok(quantity.value * stated.number.abs());
    }
    // A bare number is in the value's unit, where that is no unit; beside a `%` it could mean two things.
    let fits =
        if quantity.has_unit { same_dimension(quantity.dimension, stated.dimension) } else { stated.unit.is_empty() };
    if !fits {
        return Err(wrong(format!("the tolerance `{text}` does not fit the value `{}`", stated.text)));
    }
    Ok(in_unit(quantity.value, &stated.unit))
}
