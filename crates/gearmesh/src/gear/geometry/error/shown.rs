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

/// Six significant digits, without trailing zeros.
fn significant(value: f64) -> String {
    if value.abs() <= 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = libm::floor(libm::log10(value.abs()));
    if !(-4.0..9.0).contains(&magnitude) {
        return format!("{value:.5e}");
    }
    // In range by the line above.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let text = format!("{value:.*}", (5.0 - magnitude).max(0.0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

impl fmt::Display for Millimetres {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} mm", significant(self.0 * 1e3))
    }
}

impl fmt::Display for Degrees {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} deg", significant(self.0.to_degrees()))
    }
}

impl fmt::Display for Plain {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&significant(self.0))
    }
}
