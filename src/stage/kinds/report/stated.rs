//! What a paper printed, as a study states it: values, and how far a computed one may be from them and still agree.
//!
//! Must not know: what is compared with them.

use super::operand::in_si;
use crate::stage::quantity::{Number, described, same_dimension};
use declare::Declared;
use declare::declared::Placed;
use declare::error::{Diagnostic, Place};
use declare::number::Printed;
use declare::units::{Dimension, RATIO, in_unit, parse_quantity, split_quantity};

/// One of the paper's numbers or claims.
#[derive(Debug, Declared)]
pub struct Published {
    /// what it is, in words
    #[declared(example = "Largest transmission error")]
    pub label: Option<String>,
    /// where the paper says it: a table, an equation, a page
    #[declared(name = "where", example = "Table 3")]
    pub location: Option<String>,
    /// the computed cell, `stage.table[key=value, …].column`
    #[declared(example = "ste.summary[design=long, torque=100 N m].peak_to_peak")]
    pub cell: Option<Placed<String>>,
    /// or arithmetic over the names in `with`: + - * / ^ sqrt abs min max
    #[declared(example = "a / b - 1")]
    pub formula: Option<Placed<String>>,
    /// or a comparison that the paper says is true, in every row of its cells
    #[declared(example = "a < b")]
    pub claim: Option<Placed<String>>,
    /// what the names in a formula or claim stand for: cells or quantities
    #[declared(example = "stiffness.summary.mean")]
    pub with: Option<Vec<(String, Placed<String>)>>,
    /// the published value as printed, with its unit
    #[declared(example = "4.2 um")]
    pub value: Option<Placed<String>>,
    /// how far apart counts as equal: `digits` (half a unit in the last printed place), `1 %`, or a quantity
    #[declared(default = "digits")]
    pub tolerance: Placed<String>,
    /// where the computed value stands today, so that it cannot drift unseen
    pub expected: Option<Expected>,
    /// why they differ
    #[declared(example = "the paper rounds its stiffness")]
    pub because: Option<String>,
    /// arithmetic that proves the reason
    pub proof: Option<StatedProof>,
    /// a remark that claims no difference
    #[declared(example = "read off the figure")]
    pub note: Option<String>,
}

/// A table as it was printed: a line for each number.
#[derive(Debug, Declared)]
pub struct PrintedTable {
    /// where it is printed: a page, a section of a printout
    #[declared(name = "where", example = "Printout, page 3")]
    pub location: Option<String>,
    /// what the cells of its rows begin with, so that a row names a column alone
    #[declared(example = "pair.gears[gear=pinion]")]
    pub of: Option<Placed<String>>,
    /// how far apart counts as equal in rows that say nothing of it: `digits`, `1 %`, or a quantity
    #[declared(default = "digits")]
    pub tolerance: Placed<String>,
    /// why they differ, in rows that say nothing of it
    #[declared(example = "the program rounds the centre distance")]
    pub because: Option<String>,
    /// what is printed
    pub rows: Vec<PrintedRow>,
}

/// A number of a printed table.
#[derive(Debug, Declared)]
pub struct PrintedRow {
    /// what it is, in words
    #[declared(example = "Span measurement W_k")]
    pub label: String,
    /// the computed cell, or its column where the table says the rest
    #[declared(example = "tip_radius")]
    pub cell: Option<Placed<String>>,
    /// or arithmetic over the names in `let`
    #[declared(example = "a / b - 1")]
    pub formula: Option<Placed<String>>,
    /// the value as printed, with its unit
    #[declared(example = "33.129 mm")]
    pub value: Placed<String>,
    /// how far apart counts as equal in this row
    #[declared(example = "1 %")]
    pub tolerance: Option<Placed<String>>,
    /// where the computed value stands today, so that it cannot drift unseen
    pub expected: Option<Expected>,
    /// why they differ
    #[declared(example = "the program rounds its stiffness")]
    pub because: Option<String>,
    /// a remark that claims no difference
    #[declared(example = "read off the figure")]
    pub note: Option<String>,
}

impl PrintedTable {
    /// The rows as entries of their own.
    pub fn entries(self) -> impl Iterator<Item = Published> {
        let Self { location, of, tolerance, because, rows } = self;
        rows.into_iter().map(move |row| {
            let whole = |cell: Placed<String>| match &of {
                Some(of) if !cell.value.contains('.') => {
                    Placed { value: format!("{}.{}", of.value.trim(), cell.value.trim()), place: cell.place }
                }
                _ => cell,
            };
            Published {
                label: Some(row.label),
                location: location.clone(),
                cell: row.cell.map(whole),
                formula: row.formula,
                claim: None,
                with: None,
                value: Some(row.value),
                tolerance: row.tolerance.unwrap_or_else(|| tolerance.clone()),
                expected: row.expected,
                because: row.because.or_else(|| because.clone()),
                proof: None,
                note: row.note,
            }
        })
    }
}

/// Where a computed value stands.
#[derive(Debug, Declared)]
pub struct Expected {
    /// the value the study stands by, with its unit; for a claim the number of rows
    #[declared(example = "4.18 um")]
    pub value: Placed<String>,
    /// how far apart counts as equal: `digits` (half a unit in the last printed place), `1 %`, or a quantity
    #[declared(default = "digits")]
    pub tolerance: Placed<String>,
}

/// What proves a reason.
#[derive(Debug, Declared)]
pub struct StatedProof {
    /// a comparison that must hold; `published` and `computed` are known in it
    #[declared(example = "computed < published")]
    pub claim: Placed<String>,
    /// what its other names stand for: cells or quantities
    #[declared(example = "stiffness.summary.mean")]
    pub with: Option<Vec<(String, Placed<String>)>>,
}

/// A value as printed.
pub struct Stated {
    pub text: String,
    /// In `unit`.
    pub number: f64,
    pub unit: String,
    pub dimension: Dimension,
    pub printed: Printed,
}

/// A stated value and how far a computed one may be from it, in the stated unit.
pub struct Target {
    pub stated: Stated,
    pub tolerance: f64,
    /// Where the value stands.
    pub place: Place,
}

impl Target {
    /// Value and tolerance in another unit.
    ///
    /// # Errors
    /// When a unit is none.
    pub fn within(&self, unit: &str) -> Result<(f64, f64), String> {
        Ok((convert(self.stated.number, &self.stated.unit, unit)?, convert(self.tolerance, &self.stated.unit, unit)?))
    }
}

impl Stated {
    pub fn check_dimension(&self, number: Number) -> Result<(), String> {
        if same_dimension(number.dimension, self.dimension) {
            return Ok(());
        }
        let (found, stated) = (described(number.dimension), described(self.dimension));
        Err(format!("what is computed is {found}, but the published `{}` is {stated}", self.text))
    }
}

fn convert(value: f64, from: &str, to: &str) -> Result<f64, String> {
    if from == to { Ok(value) } else { in_si(value, from).map(|number| in_unit(number.si, to)) }
}

/// Reads a value and its tolerance; `dimension` is what the value must have, where that is known.
pub fn read_target(
    value: &Placed<String>,
    tolerance: &Placed<String>,
    dimension: Option<Dimension>,
) -> Result<Target, Diagnostic> {
    let wrong = |message: String| Diagnostic::new(message).at(value.place);
    let text = value.value.trim();
    let quantity = parse_quantity(text).map_err(|error| wrong(format!("value `{text}`: {error}")))?;
    if let Some(wanted) = dimension.filter(|wanted| !same_dimension(*wanted, quantity.dimension)) {
        let (found, wanted) = (described(quantity.dimension), described(wanted));
        return Err(wrong(format!("`{text}` is {found}; the published value is {wanted}")));
    }
    let (number, unit) = split_quantity(text);
    let (Ok(number), Some(printed)) = (number.parse::<f64>(), Printed::read(text)) else {
        return Err(wrong(format!("`{text}` is not a number followed by a unit")));
    };
    let stated =
        Stated { text: text.to_owned(), number, unit: unit.to_owned(), dimension: quantity.dimension, printed };
    let tolerance = read_tolerance(tolerance, &stated)?;
    Ok(Target { stated, tolerance, place: value.place })
}

/// `digits`, `1 %` of the value, or a quantity.
fn read_tolerance(tolerance: &Placed<String>, stated: &Stated) -> Result<f64, Diagnostic> {
    const HELP: &str =
        "write `digits` (as far as the printed digits go), `1 %` (of the value), or a quantity in the value's unit";
    let wrong = |message: String| Diagnostic::new(message).at(tolerance.place).help(HELP);
    let text = tolerance.value.trim();
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
    // A bare number is in the value's unit, where that is not a unit; beside a `%` it could mean two things.
    let fits =
        if quantity.has_unit { same_dimension(quantity.dimension, stated.dimension) } else { stated.unit.is_empty() };
    if !fits {
        return Err(wrong(format!("the tolerance `{text}` does not fit the value `{}`", stated.text)));
    }
    Ok(in_unit(quantity.value, &stated.unit))
}
