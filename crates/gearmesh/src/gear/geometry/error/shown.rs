//! Numbers as messages show them: their unit, and their significant digits. Must not know: what they are of.

use std::fmt;

/// A length, shown in mm with its significant digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Millimetres(pub f64);

/// An angle, shown in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Degrees(pub f64);

/// A plain number, shown with its significant digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plain(pub f64);

/// Significant digits that are shown where nothing asks for more.
const DIGITS: usize = 6;
/// With so many every number is told from any other.
const ALL_DIGITS: usize = 17;

/// A number that can be shown with some number of significant digits.
pub trait Shown {
    /// The number with its unit.
    fn with_digits(&self, digits: usize) -> String;
}

/// A number beside another one that it must not be: with as many digits as tell them apart, unless they are the same.
pub fn beside<T: Shown>(value: &T, other: &T) -> String {
    let differs = |digits: &usize| value.with_digits(*digits) != other.with_digits(*digits);
    value.with_digits((DIGITS..=ALL_DIGITS).find(differs).unwrap_or(DIGITS))
}

/// The same beside two others.
pub fn beside_both<T: Shown>(value: &T, others: [&T; 2]) -> String {
    let differs = |digits: &usize| others.iter().all(|other| value.with_digits(*digits) != other.with_digits(*digits));
    value.with_digits((DIGITS..=ALL_DIGITS).find(differs).unwrap_or(DIGITS))
}

/// Decimals with which two numbers are not the same text, and six at the least.
#[must_use]
pub fn decimals(value: f64, other: f64) -> usize {
    (6..=15).find(|decimals| format!("{value:.decimals$}") != format!("{other:.decimals$}")).unwrap_or(6)
}

/// So many significant digits, without trailing zeros.
fn significant(value: f64, digits: usize) -> String {
    if value.abs() <= 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = libm::floor(libm::log10(value.abs()));
    if !(-4.0..9.0).contains(&magnitude) {
        return format!("{value:.*e}", digits - 1);
    }
    // In range by the line above.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let text = format!("{value:.*}", (digits as f64 - 1.0 - magnitude).max(0.0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

impl Shown for Millimetres {
    fn with_digits(&self, digits: usize) -> String {
        format!("{} mm", significant(self.0 * 1e3, digits))
    }
}

impl Shown for Degrees {
    fn with_digits(&self, digits: usize) -> String {
        format!("{} deg", significant(self.0.to_degrees(), digits))
    }
}

impl Shown for Plain {
    fn with_digits(&self, digits: usize) -> String {
        significant(self.0, digits)
    }
}

impl fmt::Display for Millimetres {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.with_digits(DIGITS))
    }
}

impl fmt::Display for Degrees {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.with_digits(DIGITS))
    }
}

impl fmt::Display for Plain {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.with_digits(DIGITS))
    }
}
