//! One result set beside another: two methods, two settings, two designs. What nobody published needs no paper.
//!
//! Rows are lined up by their keys; the row that is furthest apart stands for all. Must not know: published values.

use crate::stage::Inputs;
use crate::stage::operand::Operand;
use crate::stage::operand::rows::OperandRows;
use crate::stage::quantity::{Number, described, read, same_dimension};
use declare::Declared;
use declare::declared::Placed;
use declare::error::{Diagnostic, Place};
use declare::record::Record;
use declare::units::{Dimension, RATIO, in_unit};
use studygraph::study::notation::without_sign;
use studygraph::table::columns::Columns;
use studygraph::table::schema::Column;

/// Cells of one table beside those of another.
#[derive(Debug, Declared)]
pub struct Compared {
    /// what it is, in words
    #[declared(example = "Energy method against finite elements")]
    pub label: Option<String>,
    /// the cells that are compared, `stage.table[key=value, …].column`
    #[declared(example = "ste.summary[design=long].peak_to_peak")]
    pub cell: Placed<String>,
    /// the cells that they are compared with, in rows of the same keys
    #[declared(example = "ste_fine.summary[design=long].peak_to_peak")]
    pub against: Placed<String>,
    /// how far apart counts as equal: `1 %` of `against`, or a quantity; without it the difference is only said
    #[declared(example = "1 %")]
    pub tolerance: Option<Placed<String>>,
    /// why they differ
    #[declared(example = "bodies are rigid here")]
    pub because: Option<String>,
    /// a remark that claims no difference
    #[declared(example = "the same mesh")]
    pub note: Option<String>,
}

enum Tolerance {
    None,
    Share(f64),
    /// With where it stands.
    Quantity(Number, Place),
}

pub struct Comparison {
    /// From 1, in the order of the study.
    number: usize,
    label: String,
    /// Cells, and what they are compared with.
    operands: Vec<(String, Operand)>,
    tolerance: Tolerance,
    because: String,
    note: String,
}

/// What came of one; values in the unit of the cells.
pub struct Compare<'a> {
    of: &'a Comparison,
    unit: String,
    rows: usize,
    /// Of the row that is furthest apart.
    place: String,
    value: f64,
    reference: f64,
    tolerance: f64,
}

impl Compare<'_> {
    fn difference(&self) -> f64 {
        self.value - self.reference
    }

    fn relative(&self) -> f64 {
        if self.reference == 0.0 { f64::NAN } else { self.difference() / self.reference.abs() }
    }

    fn word(&self) -> &'static str {
        let has_reason = !self.of.because.is_empty();
        // As a published value: on the edge of the tolerance is inside.
        let room = 1e-12 * self.value.abs().max(self.reference.abs());
        let agrees = self.difference().abs() <= self.tolerance + room;
        match (self.tolerance.is_nan(), agrees, has_reason) {
            (true, ..) => "stated",
            (false, true, false) => "agrees",
            (false, true, true) => "outdated",
            (false, false, true) => "explained",
            (false, false, false) => "differs",
        }
    }
}

impl Comparison {
    /// # Errors
    /// What is wrong with it, at the place of the field.
    pub fn read(number: usize, stated: &Compared, record: &Record) -> Result<Self, Diagnostic> {
        let operand = |given: &Placed<String>| {
            let operand = Operand::read(given)?;
            let message = format!("`{}` is not a cell; write `stage.table[key=value, …].column`", operand.text);
            if operand.cell().is_some() { Ok(operand) } else { Err(operand.refused(message)) }
        };
        let operands =
            vec![("cell".to_owned(), operand(&stated.cell)?), ("against".to_owned(), operand(&stated.against)?)];
        let tolerance = stated.tolerance.as_ref().map_or(Ok(Tolerance::None), read_tolerance)?;
        let text = |text: &Option<String>| text.as_deref().unwrap_or_default().trim().to_owned();
        let because = text(&stated.because);
        if !because.is_empty() && matches!(tolerance, Tolerance::None) {
            let message = "a reason is given, but no `tolerance` beyond which it is needed";
            return Err(Diagnostic::new(message).at(record.place_of(Compared::NAMES.because)));
        }
        Ok(Self { number, label: text(&stated.label), operands, tolerance, because, note: text(&stated.note) })
    }

    pub fn operands(&self) -> impl Iterator<Item = &Operand> {
        self.operands.iter().map(|(_, operand)| operand)
    }

    /// Whether both are of one sort, and the tolerance too, as far as that is known.
    ///
    /// # Errors
    /// At what is compared with, or the tolerance.
    pub fn of_one_sort(&self, [own, other]: [Option<Dimension>; 2]) -> Result<(), Diagnostic> {
        let Some(own) = own else { return Ok(()) };
        let sort = described(own);
        if let Some(other) = other.filter(|other| !same_dimension(own, *other)) {
            return Err(self.operands[1].1.refused(format!("{sort} is compared with {}", described(other))));
        }
        match &self.tolerance {
            Tolerance::Quantity(number, place) if !same_dimension(own, number.dimension) => {
                let message = format!("{sort} is compared, and the tolerance is {}", described(number.dimension));
                Err(Diagnostic::new(message).at(*place))
            }
            _ => Ok(()),
        }
    }

    /// Compares.
    ///
    /// # Errors
    /// What is wrong with it, at its place.
    pub fn find(&self, inputs: &Inputs) -> Result<Compare<'_>, Diagnostic> {
        let rows = OperandRows::of(inputs, &self.operands)?;
        let unit = self.operands[0].1.resolve(inputs)?.unit;
        let apart = |row: usize| {
            let (value, reference) = (rows.number(0, row).si, rows.number(1, row).si);
            let difference = (value - reference).abs();
            if reference == 0.0 { difference } else { difference / reference.abs() }
        };
        self.of_one_sort([0, 1].map(|index| Some(rows.number(index, 0).dimension)))?;
        // By relative distance, unless a reference is 0 somewhere: then all by their absolute one.
        let has_zero = (0..rows.count).any(|row| rows.number(1, row).si == 0.0);
        let absolute = |row: usize| (rows.number(0, row).si - rows.number(1, row).si).abs();
        let distance = |row: usize| if has_zero { absolute(row) } else { apart(row) };
        let largest = (1..rows.count).fold(0, |best, row| if distance(row) > distance(best) { row } else { best });
        let in_unit = |number: Number| in_unit(number.si, &unit);
        let reference = in_unit(rows.number(1, largest));
        let tolerance = match self.tolerance {
            Tolerance::None => f64::NAN,
            Tolerance::Share(share) => share * reference.abs(),
            Tolerance::Quantity(number, _) => in_unit(number),
        };
        Ok(Compare {
            of: self,
            rows: rows.count,
            place: if rows.count > 1 { rows.place(largest) } else { String::new() },
            value: in_unit(rows.number(0, largest)),
            reference,
            tolerance,
            unit,
        })
    }
}

fn read_tolerance(Placed { value, place }: &Placed<String>) -> Result<Tolerance, Diagnostic> {
    const HELP: &str = "write `1 %` (of `against`), or a quantity in its unit";
    let text = without_sign(value);
    let wrong = |message: String| Diagnostic::new(message).at(*place).help(HELP);
    let quantity = read(text).map_err(|error| wrong(format!("tolerance `{text}`: {error}")))?;
    if quantity.value < 0.0 {
        return Err(wrong(format!("the tolerance `{text}` is negative")));
    }
    if quantity.has_unit && quantity.dimension == RATIO {
        return Ok(Tolerance::Share(quantity.value));
    }
    Ok(Tolerance::Quantity(Number { si: quantity.value, dimension: quantity.dimension }, *place))
}

/// Values in the unit of the compared cells.
pub fn comparisons<'a>() -> Columns<Compare<'a>> {
    let relative = "(value − reference)/|reference|; NaN where that is 0.";
    let tolerance = "How far apart the two may be and still agree; NaN where nothing is said.";
    Columns::new("comparisons", "Results beside others, by the row in which they are furthest apart.")
        .integer("number", "Number of the entry, in the order of the study.", |row: &Compare<'a>| row.of.number)
        .key()
        .text("label", "What it is, in words.", |row| row.of.label.as_str())
        .text("cell", "The cells that are compared.", |row| row.of.operands[0].1.text.as_str())
        .text("against", "The cells that they are compared with.", |row| row.of.operands[1].1.text.as_str())
        .integer("rows", "How many rows were compared.", |row| row.rows)
        .text("row", "The row that is furthest apart, where there are several.", |row| row.place.clone())
        .float("value", "", "The compared value there.", |row| row.value)
        .float("reference", "", "What it is compared with.", |row| row.reference)
        .text("unit", "Unit of value, reference, difference and tolerance.", |row| row.unit.clone())
        .float("difference", "", "Value − reference.", Compare::difference)
        .but(|column| column.tolerance(1e-12, 1e-6))
        .float("relative_difference", "", relative, Compare::relative)
        .but(|column| column.tolerance(1e-9, 1e-6).allows_nan())
        .float("tolerance", "", tolerance, |row| row.tolerance)
        .but(Column::allows_nan)
        .text("verdict", "Differs, outdated, explained, agrees or stated.", Compare::word)
        .text("because", "Why they differ.", |row| row.of.because.as_str())
        .text("note", "A remark that claims no difference.", |row| row.of.note.as_str())
}
