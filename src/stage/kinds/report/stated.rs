//! Values as a paper prints them, and how far a computed one may be from them and still agree.
//!
//! Must not know: what is compared with them.

use super::operand::in_si;
use super::quantity::{Number, described, same_dimension};
use declare::error::Diagnostic;
use declare::number::Printed;
use declare::record::Record;
use declare::units::{Dimension, RATIO, in_unit, parse_quantity, split_quantity};

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
}

impl Stated {
    pub fn check_dimension(&self, number: Number) -> Result<(), String> {
        if same_dimension(number.dimension, self.dimension) {
            return Ok(());
        }
        let (found, stated) = (described(number.dimension), described(self.dimension));
        Err(format!("what is computed is {found}, but the published `{}` is {stated}", self.text))
    }

    pub fn in_unit(&self, unit: &str) -> Result<f64, String> {
        convert(self.number, &self.unit, unit)
    }
}

pub fn convert(value: f64, from: &str, to: &str) -> Result<f64, String> {
    if from == to { Ok(value) } else { in_si(value, from).map(|number| in_unit(number.si, to)) }
}

/// Reads `value` and `tolerance`; `dimension` is what the value must have, where that is known.
pub fn read_target(record: &Record, dimension: Option<Dimension>) -> Result<Target, Diagnostic> {
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
