//! Quantities with units: reading `7.81 um` and `19.05 N/(mm um)` into SI, and writing SI in a table's unit.
//!
//! Decimal prefixes are applied to the decimal text, not to the binary number, so `0.00781 mm` and `7.81 um` are the
//! same bits and give the same cache key. Must not know: which field of a study a quantity belongs to.

mod foreign;
mod written;

use std::f64::consts::PI;

pub use foreign::{ForeignUnit, foreign_quantity, foreign_unit, with_powers};
pub use written::parse_unit;

/// Exponents of metre, kilogram, second and radian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dimension {
    pub length: i8,
    pub mass: i8,
    pub time: i8,
    pub angle: i8,
}

const fn dimension(length: i8, mass: i8, time: i8, angle: i8) -> Dimension {
    Dimension { length, mass, time, angle }
}

pub const RATIO: Dimension = dimension(0, 0, 0, 0);
pub const LENGTH: Dimension = dimension(1, 0, 0, 0);
pub const ANGLE: Dimension = dimension(0, 0, 0, 1);
pub const FORCE: Dimension = dimension(1, 1, -2, 0);
pub const TORQUE: Dimension = dimension(2, 1, -2, 0);
pub const STRESS: Dimension = dimension(-1, 1, -2, 0);
/// Stiffness, N/m; also load per face width.
pub const STIFFNESS: Dimension = dimension(0, 1, -2, 0);
/// Stiffness per face width, N/(mm µm): the dimension of a stress.
pub const SPECIFIC_STIFFNESS: Dimension = STRESS;
pub const PER_AREA: Dimension = dimension(-2, 0, 0, 0);
pub const AREA: Dimension = dimension(2, 0, 0, 0);
pub const VOLUME: Dimension = dimension(3, 0, 0, 0);
pub const TIME: Dimension = dimension(0, 0, 1, 0);
/// Angular speed, rad/s.
pub const ANGULAR_SPEED: Dimension = dimension(0, 0, -1, 1);
pub const DENSITY: Dimension = dimension(-3, 1, 0, 0);
/// Kinematic viscosity, m²/s.
pub const VISCOSITY: Dimension = dimension(2, 0, -1, 0);
/// Dynamic viscosity, Pa s.
pub const DYNAMIC_VISCOSITY: Dimension = dimension(-1, 1, -1, 0);
pub const MOMENT_OF_INERTIA: Dimension = dimension(2, 1, 0, 0);
pub const SPEED: Dimension = dimension(1, 0, -1, 0);
pub const POWER: Dimension = dimension(2, 1, -3, 0);

impl Dimension {
    fn times(self, other: Self, power: i8) -> Self {
        dimension(
            self.length.saturating_add(other.length.saturating_mul(power)),
            self.mass.saturating_add(other.mass.saturating_mul(power)),
            self.time.saturating_add(other.time.saturating_mul(power)),
            self.angle.saturating_add(other.angle.saturating_mul(power)),
        )
    }

    /// The unit in which a value is what it is in SI; empty for a plain number.
    #[must_use]
    pub fn si(self) -> &'static str {
        let same = Unit { ten: 0, factor: 1.0, dimension: self };
        let is_it = |unit: &&str| parse_unit(unit).is_ok_and(|unit| unit == same);
        self.describe().1.iter().copied().chain(symbols()).find(is_it).unwrap_or_default()
    }

    /// The name of the dimension and units a user may write, for messages.
    #[must_use]
    pub fn describe(self) -> (&'static str, &'static [&'static str]) {
        match self {
            RATIO => ("a ratio", &["%"]),
            LENGTH => ("a length", &["mm", "um", "m"]),
            ANGLE => ("an angle", &["deg", "rad"]),
            FORCE => ("a force", &["N", "kN"]),
            TORQUE => ("a torque", &["N m", "N mm"]),
            STRESS => ("a stress", &["GPa", "MPa", "Pa", "N/(mm um)"]),
            STIFFNESS => ("a stiffness or a load per width", &["N/m", "N/um", "N/mm"]),
            PER_AREA => ("a reciprocal squared length", &["1/um^2", "1/mm^2"]),
            AREA => ("an area", &["um^2", "mm^2"]),
            VOLUME => ("a volume", &["mm^3", "cm^3"]),
            TIME => ("a time", &["s", "ms", "us"]),
            ANGULAR_SPEED => ("an angular speed", &["rpm", "rad/s"]),
            DENSITY => ("a density", &["kg/m^3"]),
            VISCOSITY => ("a kinematic viscosity", &["mm^2/s", "m^2/s"]),
            DYNAMIC_VISCOSITY => ("a dynamic viscosity", &["mPa s", "Pa s"]),
            MOMENT_OF_INERTIA => ("a moment of inertia", &["kg m^2", "kg mm^2"]),
            SPEED => ("a speed", &["m/s"]),
            POWER => ("a power", &["W", "kW"]),
            _ => ("a quantity", &[]),
        }
    }
}

/// A unit as a power of ten, a factor that is not a power of ten, and its dimension: `SI = value · 10^ten · factor`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    pub ten: i32,
    pub factor: f64,
    pub dimension: Dimension,
}

/// Symbol, power of ten, other factor, dimension.
const UNITS: &[(&str, i32, f64, Dimension)] = &[
    ("m", 0, 1.0, LENGTH),
    ("cm", -2, 1.0, LENGTH),
    ("mm", -3, 1.0, LENGTH),
    ("um", -6, 1.0, LENGTH),
    ("µm", -6, 1.0, LENGTH),
    ("μm", -6, 1.0, LENGTH),
    ("nm", -9, 1.0, LENGTH),
    ("rad", 0, 1.0, ANGLE),
    ("mrad", -3, 1.0, ANGLE),
    ("urad", -6, 1.0, ANGLE),
    ("deg", 0, PI / 180.0, ANGLE),
    ("°", 0, PI / 180.0, ANGLE),
    ("N", 0, 1.0, FORCE),
    ("kN", 3, 1.0, FORCE),
    ("Nm", 0, 1.0, TORQUE),
    ("Nmm", -3, 1.0, TORQUE),
    ("kNm", 3, 1.0, TORQUE),
    ("mPa", -3, 1.0, STRESS),
    ("Pa", 0, 1.0, STRESS),
    ("kPa", 3, 1.0, STRESS),
    ("MPa", 6, 1.0, STRESS),
    ("GPa", 9, 1.0, STRESS),
    ("W", 0, 1.0, POWER),
    ("kW", 3, 1.0, POWER),
    ("kg", 0, 1.0, dimension(0, 1, 0, 0)),
    ("s", 0, 1.0, TIME),
    ("ms", -3, 1.0, TIME),
    ("us", -6, 1.0, TIME),
    ("ns", -9, 1.0, TIME),
    ("rpm", 0, PI / 30.0, ANGULAR_SPEED),
    ("%", -2, 1.0, RATIO),
    ("1", 0, 1.0, RATIO),
];

/// Whether two dimensions are the same when radians count as plain numbers.
#[must_use]
pub fn same_dimension(a: Dimension, b: Dimension) -> bool {
    (a.length, a.mass, a.time) == (b.length, b.mass, b.time)
}

/// The words for a dimension in a message.
#[must_use]
pub fn described(dimension: Dimension) -> String {
    match dimension.describe() {
        (_, []) => {
            let parts = [("m", dimension.length), ("kg", dimension.mass), ("s", dimension.time)];
            let parts = parts.iter().filter(|(_, power)| *power != 0).map(|(unit, power)| match power {
                1 => (*unit).to_owned(),
                power => format!("{unit}^{power}"),
            });
            format!("a quantity in {}", parts.collect::<Vec<_>>().join(" "))
        }
        (name, _) => name.to_owned(),
    }
}

/// The symbols that [`parse_unit`] knows.
pub fn symbols() -> impl Iterator<Item = &'static str> + Clone {
    UNITS.iter().map(|unit| unit.0)
}

/// Why a text is not a quantity of the wanted dimension.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UnitError {
    #[error("`{0}` is not a number followed by a unit")]
    NotANumber(String),
    #[error("the unit is missing")]
    Missing,
    #[error("unknown unit `{0}`")]
    Unknown(String),
    #[error("`{unit}` cannot be read as a unit: {why}{}", instead.as_ref().map_or(String::new(), |text| format!("; write `{text}`")))]
    Malformed {
        unit: String,
        why: String,
        /// What was probably meant, where there is only one such unit.
        instead: Option<String>,
    },
    /// A product follows a division; divided by all of it, or by what stands next.
    #[error("`{unit}` can be read in two ways: write `{}` or `{}`", readings[0], readings[1])]
    Ambiguous { unit: String, readings: [String; 2] },
    #[error("the number is not finite")]
    NotFinite,
}

/// A number and its unit as read; `value` is in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    pub value: f64,
    pub dimension: Dimension,
    /// Whether a unit stood in the text at all.
    pub has_unit: bool,
}

/// Reads `number unit`, for example `7.81 um`, `1 %`, `50 N m`, `2.738e8 N/m`.
///
/// # Errors
/// When there is no number, the unit is unknown or malformed, or the value overflows.
pub fn parse_quantity(text: &str) -> Result<Quantity, UnitError> {
    let (number, unit_text) = split_quantity(text);
    if number.is_empty() || number.parse::<f64>().is_err() {
        return Err(UnitError::NotANumber(text.trim().to_owned()));
    }
    let unit =
        if unit_text.is_empty() { Unit { ten: 0, factor: 1.0, dimension: RATIO } } else { parse_unit(unit_text)? };
    let value = shifted(number, unit.ten)? * unit.factor;
    if !value.is_finite() {
        return Err(UnitError::NotFinite);
    }
    Ok(Quantity { value, dimension: unit.dimension, has_unit: !unit_text.is_empty() })
}

/// The leading number of a text and what follows it, its unit; either may be empty.
#[must_use]
pub fn split_quantity(text: &str) -> (&str, &str) {
    let text = text.trim();
    let (number, unit) = text.split_at(number_length(text));
    (number, unit.trim())
}

/// Bytes of the leading decimal number; an `e` counts only when digits follow it.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut at = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    while at < bytes.len() && (bytes[at].is_ascii_digit() || bytes[at] == b'.') {
        at += 1;
    }
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        let mut end = at + 1 + usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        if bytes.get(end).is_some_and(u8::is_ascii_digit) {
            while bytes.get(end).is_some_and(u8::is_ascii_digit) {
                end += 1;
            }
            at = end;
        }
    }
    at
}

/// `number · 10^ten`, rounded once.
fn shifted(number: &str, ten: i32) -> Result<f64, UnitError> {
    let (mantissa, exponent) = match number.find(['e', 'E']) {
        Some(at) => (&number[..at], number[at + 1..].parse::<i32>().map_err(|_| UnitError::NotFinite)?),
        None => (number, 0),
    };
    format!("{mantissa}e{}", exponent.saturating_add(ten)).parse().map_err(|_| UnitError::NotFinite)
}

/// `si` expressed in `unit` (a text such as `um`); used wherever a number is shown.
///
/// # Panics
/// When `unit` is not a unit. Units of columns are literals of this program, and a test reads every one of them.
#[must_use]
pub fn in_unit(si: f64, unit: &str) -> f64 {
    showing(unit)(si)
}

/// [`in_unit`] for many numbers in one unit.
///
/// # Panics
/// As [`in_unit`].
pub fn showing(unit: &str) -> impl Fn(f64) -> f64 + use<> {
    let (factor, ten) = if unit.is_empty() {
        (1.0, 0)
    } else {
        let unit = parse_unit(unit).expect("a column's unit can be parsed");
        (unit.factor, unit.ten)
    };
    let power = 10f64.powi(ten.abs());
    move |si| {
        // Dividing by an exact power of ten rounds once; multiplying by an inexact 1e-6 would round twice.
        let value = si / factor;
        if ten >= 0 { value / power } else { value * power }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn si(text: &str) -> f64 {
        parse_quantity(text).unwrap().value
    }

    #[test]
    fn the_same_length_in_two_units_has_the_same_bits() {
        for (a, b) in [("7.81 um", "0.00781 mm"), ("206 GPa", "206000 MPa"), ("6.93um", "6.93e-6 m")] {
            assert_eq!(si(a).to_bits(), si(b).to_bits(), "{a} and {b}");
        }
    }

    #[test]
    fn compound_units_have_their_dimension() {
        let stiffness = parse_quantity("19.05 N/(mm um)").unwrap();
        assert_eq!(stiffness.dimension, SPECIFIC_STIFFNESS);
        assert_eq!(stiffness.value.to_bits(), 19.05e9_f64.to_bits());
        assert_eq!(parse_quantity("50 N m").unwrap().dimension, TORQUE);
        assert_eq!(parse_quantity("50 N*m").unwrap().dimension, TORQUE);
        assert_eq!(parse_quantity("3 1/um^2").unwrap().dimension, PER_AREA);
        assert_eq!(si("3 1/um²").to_bits(), 3e12_f64.to_bits());
        assert_eq!(si("1 %").to_bits(), 0.01_f64.to_bits());
        assert_eq!(si("180 deg").to_bits(), PI.to_bits());
    }

    #[test]
    fn what_is_no_quantity_is_refused() {
        assert_eq!(parse_quantity("fast"), Err(UnitError::NotANumber("fast".into())));
        assert_eq!(parse_quantity("3 furlong"), Err(UnitError::Unknown("furlong".into())));
        assert_eq!(parse_quantity("1e999 m"), Err(UnitError::NotFinite));
        assert!(!parse_quantity("3").unwrap().has_unit);
    }

    #[test]
    fn shown_values_round_trip() {
        for (text, unit, shown) in
            [("7.81 um", "um", 7.81), ("14.079 mm", "mm", 14.079), ("2.738e8 N/m", "N/m", 2.738e8)]
        {
            assert!((in_unit(si(text), unit) - shown).abs() <= f64::EPSILON * shown, "{text}");
        }
    }
}
