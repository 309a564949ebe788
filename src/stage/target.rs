//! A value as printed, and how far a computed one may be from it and still agree.
//!
//! Must not know: what is compared with it.

use super::operand::in_si;
use super::quantity::{Number, described, read, same_dimension};
use declare::declared::Placed;
use declare::error::{Diagnostic, Place};
use declare::number::Printed;
use declare::units::{Dimension, RATIO, in_unit, split_quantity};
use studygraph::study::notation::without_sign;

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
    /// # Errors
    /// When a number is of another sort.
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
///
/// # Errors
/// What is wrong with either, at its place.
pub fn read_target(
    value: &Placed<String>,
    tolerance: &Placed<String>,
    dimension: Option<Dimension>,
) -> Result<Target, Diagnostic> {
    let wrong = |message: String| Diagnostic::new(message).at(value.place);
    let text = value.value.trim();
    let quantity = read(text).map_err(|error| wrong(format!("value `{text}`: {error}")))?;
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
    let text = without_sign(&tolerance.value);
    if text == "digits" {
        return Ok(stated.printed.half_unit());
    }
    let quantity = read(text).map_err(|error| wrong(format!("tolerance `{text}`: {error}")))?;
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
