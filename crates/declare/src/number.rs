//! Numbers and units as a reader sees them: significant digits, powers of ten in threes, the digits a paper printed.
//!
//! Must not know: which quantity is shown. Digits are taken from the decimal expansion, never from a logarithm, so the
//! text is the same on every machine.

use super::units::split_quantity;

/// How a number was printed: decimals of the mantissa and power of ten. `2.738e8` has 3 and 8.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Printed {
    pub decimals: usize,
    pub exponent: i32,
}

impl Printed {
    /// Reads the leading number of a text such as `2.316 um`.
    #[must_use]
    pub fn read(text: &str) -> Option<Self> {
        let (number, _) = split_quantity(text);
        number.parse::<f64>().ok()?;
        let (mantissa, exponent) = match number.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse().ok()?),
            None => (number, 0),
        };
        Some(Self { decimals: mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len()), exponent })
    }

    /// Half a unit in the last printed place: how far the number that was rounded may have been away.
    #[must_use]
    pub fn half_unit(self) -> f64 {
        let decimals = i32::try_from(self.decimals).unwrap_or(i32::MAX);
        let place = self.exponent.saturating_sub(decimals).saturating_sub(1);
        format!("5e{place}").parse().unwrap_or(0.0)
    }

    /// `value` in the same manner, with `more` digits.
    #[must_use]
    pub fn show(self, value: f64, more: usize) -> String {
        let decimals = self.decimals.saturating_add(more).min(17);
        let scaled = shifted(value, -self.exponent);
        let mantissa = signed(&format!("{scaled:.decimals$}"));
        if self.exponent == 0 { mantissa } else { format!("{mantissa}×10{}", superscript(self.exponent)) }
    }
}

/// So many things, whose name takes an `s` if they are several: `1 row`, `2 rows`.
#[must_use]
pub fn counted(count: usize, name: &str) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}

/// A typographic minus, and none before a zero.
fn signed(text: &str) -> String {
    match text.strip_prefix('-') {
        Some(digits) if digits.contains(|digit: char| digit.is_ascii_digit() && digit != '0') => format!("−{digits}"),
        Some(digits) => digits.to_owned(),
        None => text.to_owned(),
    }
}

/// `value · 10^ten`, on the decimal text.
fn shifted(value: f64, ten: i32) -> f64 {
    let text = format!("{value:e}");
    let Some((mantissa, exponent)) = text.split_once('e') else { return value };
    let exponent = exponent.parse::<i32>().unwrap_or(0).saturating_add(ten);
    format!("{mantissa}e{exponent}").parse().unwrap_or(value)
}

/// The power of ten of the first of `digits` significant digits, after rounding.
#[must_use]
pub fn magnitude(value: f64, digits: usize) -> i32 {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    text.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

/// `value` with so many significant digits, trailing zeros dropped; large and small ones as `273.8×10⁶`.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if value.is_nan() {
        return "–".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "∞" } else { "−∞" }.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let exponent = magnitude(value, digits);
    let power = if (-4..6).contains(&exponent) { 0 } else { exponent.div_euclid(3) * 3 };
    let mantissa = shifted(value, -power);
    let wanted = i32::try_from(digits).unwrap_or(17) - 1 - (exponent - power);
    let text = format!("{mantissa:.*}", usize::try_from(wanted).unwrap_or(0));
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if power == 0 { signed(text) } else { format!("{}×10{}", signed(text), superscript(power)) }
}

/// `8` as `⁸`.
#[must_use]
pub fn superscript(number: i32) -> String {
    let raised = |digit: char| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => char::from_u32(0x2070 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
    };
    number.to_string().chars().map(raised).collect()
}

/// A unit for reading: `N/(mm um)` as `N/(mm·µm)`, `1/um^2` as `1/µm²`.
#[must_use]
pub fn unit_symbol(unit: &str) -> String {
    let mut shown = String::new();
    let mut word = String::new();
    let flush = |word: &mut String, shown: &mut String| {
        shown.push_str(match word.as_str() {
            "um" => "µm",
            "us" => "µs",
            "urad" => "µrad",
            "deg" => "°",
            other => other,
        });
        word.clear();
    };
    let mut raised = false;
    for character in unit.trim().chars() {
        if raised && character.is_ascii_digit() {
            let digit = character.to_digit(10).and_then(|digit| i32::try_from(digit).ok()).unwrap_or(0);
            shown.push_str(&superscript(digit));
            continue;
        }
        raised = character == '^';
        match character {
            ' ' | '*' | '/' | '(' | ')' | '^' => {
                flush(&mut word, &mut shown);
                match character {
                    ' ' | '*' if !shown.ends_with(['·', '/', '(']) => shown.push('·'),
                    ' ' | '*' | '^' => {}
                    other => shown.push(other),
                }
            }
            other => word.push(other),
        }
    }
    flush(&mut word, &mut shown);
    shown
}

/// A number's text and its unit, with a space where one belongs.
#[must_use]
pub fn with_unit(number: &str, unit: &str) -> String {
    match unit_symbol(unit).as_str() {
        "" | "1" => number.to_owned(),
        "°" => format!("{number}°"),
        symbol => format!("{number}\u{202f}{symbol}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn significant_digits_are_those_of_the_decimal_expansion() {
        for (value, digits, shown) in [
            (2.316, 4, "2.316"),
            (2.738e8, 4, "273.8×10⁶"),
            (4.724_000_1e8, 4, "472.4×10⁶"),
            (50.0, 5, "50"),
            (-0.000_12, 3, "−0.00012"),
            (-0.000_012, 3, "−12×10⁻⁶"),
            (0.001_5, 3, "0.0015"),
            (9.999_96, 5, "10"),
            (999_999.6, 6, "1×10⁶"),
            (123_456.0, 4, "123456"),
            (0.0, 4, "0"),
            (-0.0, 4, "0"),
            (f64::NAN, 4, "–"),
            (1e-300, 3, "1×10⁻³⁰⁰"),
        ] {
            assert_eq!(significant(value, digits), shown, "{value} with {digits}");
        }
    }

    #[test]
    fn printed_numbers_say_how_well_they_are_known() {
        for (text, decimals, exponent, half) in [
            ("2.316 um", 3, 0, 0.0005),
            ("0.40 um", 2, 0, 0.005),
            ("2.738e8 N/m", 3, 8, 5e4),
            ("16", 0, 0, 0.5),
            ("-1.5e-3", 1, -3, 5e-5),
            ("0", 0, 0, 0.5),
        ] {
            let printed = Printed::read(text).unwrap();
            assert_eq!((printed.decimals, printed.exponent), (decimals, exponent), "{text}");
            assert_eq!(printed.half_unit().to_bits(), f64::to_bits(half), "{text}");
        }
        assert_eq!(Printed::read("fast"), None);
        assert_eq!(Printed::read("2.738e8 N/m").unwrap().show(2.737_96e8, 1), "2.7380×10⁸");
        assert_eq!(Printed::read("2.316 um").unwrap().show(-0.000_01, 1), "0.0000");
        assert_eq!(Printed::read("2.316 um").unwrap().show(-0.684_88, 1), "−0.6849");
    }

    #[test]
    fn units_are_set_as_a_journal_would() {
        for (unit, shown) in [
            ("um", "µm"),
            ("N m", "N·m"),
            ("N/(mm um)", "N/(mm·µm)"),
            ("1/um^2", "1/µm²"),
            ("N/m", "N/m"),
            ("deg", "°"),
            ("", ""),
            ("%", "%"),
        ] {
            assert_eq!(unit_symbol(unit), shown, "{unit}");
        }
        assert_eq!(with_unit("20", "deg"), "20°");
        assert_eq!(with_unit("3", ""), "3");
    }
}
