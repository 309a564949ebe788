//! Numbers with dimensions: what may be added, multiplied, raised, and how it is shown.
//!
//! Must not know: formulas. SI; an angle counts as a plain number.

use declare::number::{significant, with_unit};
use declare::units::{
    Dimension, FORCE, LENGTH, Quantity, RATIO, STIFFNESS, STRESS, TORQUE, in_unit, parse_quantity, parse_unit,
};
use studygraph::study::notation;

pub use declare::units::{described, same_dimension};

/// A number in SI and its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    pub si: f64,
    pub dimension: Dimension,
}

impl Number {
    #[must_use]
    pub const fn plain(si: f64) -> Self {
        Self { si, dimension: RATIO }
    }

    pub fn fits(self, other: Self) -> bool {
        let is_zero = |number: Self| number.si == 0.0 && number.dimension == RATIO;
        same_dimension(self.dimension, other.dimension) || is_zero(self) || is_zero(other)
    }
}

/// A quantity as a study writes it.
///
/// # Errors
/// Why it is none, and what to write where it is a number in another notation.
pub fn read(text: &str) -> Result<Quantity, String> {
    if let Some([number, half]) = notation::halves_of(text) {
        return Err(format!(
            "one number is meant, and this is an interval: write `{number}`, and `{half}` as its tolerance"
        ));
    }
    if let Some(help) = notation::help(text) {
        let help = notation::with_reading(help, text, &|_| 0.0);
        return Err(format!("not a number as a study has it: {help}"));
    }
    parse_quantity(text).map_err(|error| error.to_string())
}

/// The dimension of a sum, where a plain zero may stand for any.
pub fn wider(a: Number, b: Number) -> Dimension {
    if a.dimension == RATIO { b.dimension } else { a.dimension }
}

pub fn product(a: Dimension, b: Dimension, power: i8) -> Dimension {
    let join = |a: i8, b: i8| a.saturating_add(b.saturating_mul(power));
    Dimension {
        length: join(a.length, b.length),
        mass: join(a.mass, b.mass),
        time: join(a.time, b.time),
        angle: join(a.angle, b.angle),
    }
}

/// # Errors
/// A sentence: an exponent that has a unit, or a power that has none.
pub fn power(base: Dimension, exponent: Number) -> Result<Dimension, String> {
    if !same_dimension(exponent.dimension, RATIO) {
        return Err(format!("an exponent is a plain number, not {}", described(exponent.dimension)));
    }
    if same_dimension(base, RATIO) {
        return Ok(RATIO);
    }
    let raise = |part: i8| {
        let raised = f64::from(part) * exponent.si;
        // Within i8 and whole: only then is there such a dimension.
        #[allow(clippy::cast_possible_truncation)]
        if raised.fract() == 0.0 && raised.abs() < 100.0 { Some(raised as i8) } else { None }
    };
    let raised = (raise(base.length), raise(base.mass), raise(base.time));
    let (Some(length), Some(mass), Some(time)) = raised else {
        return Err(format!("{} to the power {} has no unit", described(base), exponent.si));
    };
    Ok(Dimension { length, mass, time, angle: 0 })
}

/// `number` in `unit` when that fits, otherwise in the field's usual unit.
#[must_use]
pub fn shown(number: Number, unit: &str, digits: usize) -> String {
    let fits = |unit: &str| parse_unit(unit).is_ok_and(|parsed| same_dimension(parsed.dimension, number.dimension));
    let usual = match number.dimension {
        LENGTH if number.si.abs() < 1e-4 => "um",
        LENGTH => "mm",
        FORCE => "N",
        TORQUE => "N m",
        STRESS => "MPa",
        STIFFNESS => "N/m",
        _ => "",
    };
    let unit = if !unit.is_empty() && fits(unit) { unit } else { usual };
    if unit.is_empty() && !same_dimension(number.dimension, RATIO) {
        return format!("{} ({} in SI)", significant(number.si, digits), described(number.dimension));
    }
    with_unit(&significant(in_unit(number.si, unit), digits), unit)
}
