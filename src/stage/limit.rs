//! Limits of numbers as a study writes them: `largest_pressure <= 1400 MPa`.
//!
//! Must not know: where the numbers come from.

use declare::error::{Diagnostic, Place, suggest};
use declare::units::{RATIO, parse_quantity};

/// A limit of one number.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// As written.
    pub text: String,
    /// Which of the known columns it is of.
    pub column: usize,
    /// In the unit of that column.
    bound: f64,
    is_upper: bool,
    may_be_met: bool,
}

const SIGNS: [(&str, bool, bool); 4] =
    [("<=", true, true), (">=", false, true), ("<", true, false), (">", false, false)];

impl Limit {
    /// Reads a limit of one of these columns, names and units.
    ///
    /// # Errors
    /// When it is no comparison of a column with a quantity of its kind.
    pub fn read(text: &str, place: Place, columns: &[(&str, &str)]) -> Result<Self, Diagnostic> {
        let wrong = |message: String| Diagnostic::new(message).at(place);
        let found = SIGNS.iter().find_map(|(sign, is_upper, may_be_met)| {
            let (name, bound) = text.split_once(sign)?;
            Some((name.trim(), bound.trim(), *is_upper, *may_be_met))
        });
        let Some((name, written, is_upper, may_be_met)) = found else {
            let example = columns.first().map_or("peak_to_peak <= 1 um".to_owned(), |(name, unit)| {
                format!("{name} <= 1 {unit}").trim().to_owned()
            });
            return Err(wrong(format!("`{text}` is no limit")).help(format!("write for example `{example}`")));
        };
        let Some(column) = columns.iter().position(|(known, _)| *known == name) else {
            let help = suggest(name, columns.iter().map(|(name, _)| *name));
            return Err(wrong(format!("`{name}` is none of the outputs")).help(help));
        };
        let unit = columns[column].1;
        let bound = parse_quantity(written).map_err(|error| wrong(format!("`{written}`: {error}")))?;
        let one = parse_quantity(&format!("1 {unit}")).map_err(|error| wrong(format!("`{unit}`: {error}")))?;
        if bound.dimension != one.dimension {
            let is = if one.dimension == RATIO { "a plain number".to_owned() } else { format!("in {unit}") };
            return Err(wrong(format!("`{written}` is not of the kind of `{name}`, which is {is}")));
        }
        let text = text.trim().to_owned();
        Ok(Self { text, column, bound: bound.value / one.value, is_upper, may_be_met })
    }

    /// Whether a number in the unit of its column keeps to it; NaN does not.
    pub fn holds(&self, value: f64) -> bool {
        match (self.is_upper, self.may_be_met) {
            (true, true) => value <= self.bound,
            (true, false) => value < self.bound,
            (false, true) => value >= self.bound,
            (false, false) => value > self.bound,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: [(&str, &str); 3] = [("peak_to_peak", "um"), ("largest_pressure", "MPa"), ("contact_ratio", "")];

    fn read(text: &str) -> Result<Limit, Diagnostic> {
        Limit::read(text, Place::default(), &COLUMNS)
    }

    #[test]
    fn a_number_keeps_to_its_limit_in_any_unit() {
        let limit = read("largest_pressure <= 1.4 GPa").unwrap();
        assert!(limit.holds(1399.999) && !limit.holds(1400.001) && !limit.holds(f64::NAN));
        let least = read("contact_ratio >= 1.2").unwrap();
        assert!(least.holds(1.2) && !least.holds(1.19));
        assert!(!read("peak_to_peak < 1 um").unwrap().holds(1.0) && read("peak_to_peak > 1 um").unwrap().holds(1.5));
    }

    #[test]
    fn what_is_no_limit_is_refused() {
        let refused = |text: &str| {
            let wrong = read(text).unwrap_err();
            format!("{} {}", wrong.message, wrong.help.unwrap_or_default())
        };
        assert!(
            refused("peak_to_peak").contains("no limit") && refused("peak_to_peak").contains("peak_to_peak <= 1 um")
        );
        assert!(refused("peak_to_peek <= 1 um").contains("peak_to_peak"));
        assert!(refused("peak_to_peak <= 1 MPa").contains("not of the kind"));
        assert!(refused("contact_ratio >= 1 um").contains("a plain number"));
        assert!(refused("peak_to_peak <= x").contains("`x`"));
    }
}
