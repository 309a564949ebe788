//! Limits of numbers as a study writes them: `largest_pressure <= 1400 MPa`.
//!
//! Must not know: where the numbers come from.

use super::quantity::read;
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

/// A limit as it is written: a name, a sign, and a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Comparison<'t> {
    pub name: &'t str,
    pub is_upper: bool,
    pub may_be_met: bool,
    quantity: &'t str,
}

const SIGNS: [(&str, bool, bool); 4] =
    [("<=", true, true), (">=", false, true), ("<", true, false), (">", false, false)];

impl<'t> Comparison<'t> {
    /// None where there is no sign.
    pub fn of(text: &'t str) -> Option<Self> {
        SIGNS.iter().find_map(|(sign, is_upper, may_be_met)| {
            let (name, quantity) = text.split_once(sign)?;
            Some(Self { name: name.trim(), is_upper: *is_upper, may_be_met: *may_be_met, quantity: quantity.trim() })
        })
    }

    /// The quantity, and one of this unit, both in SI.
    ///
    /// # Errors
    /// When it is none, or of another dimension.
    pub fn bound(&self, unit: &str) -> Result<[f64; 2], Diagnostic> {
        let quantity = self.quantity;
        let bound = read(quantity).map_err(|error| Diagnostic::new(format!("`{quantity}`: {error}")))?;
        let one =
            parse_quantity(&format!("1 {unit}")).map_err(|error| Diagnostic::new(format!("`{unit}`: {error}")))?;
        if bound.dimension != one.dimension {
            let given = if one.dimension == RATIO { "as a plain number".to_owned() } else { format!("in {unit}") };
            return Err(Diagnostic::new(format!("`{quantity}` is no limit of `{}`", self.name))
                .help(format!("its limit is given {given}")));
        }
        Ok([bound.value, one.value])
    }
}

impl Limit {
    /// Reads a limit of one of these columns, names and units.
    ///
    /// # Errors
    /// When it is no comparison of a column with a quantity of its kind.
    pub fn read(text: &str, place: Place, columns: &[(&str, &str)]) -> Result<Self, Diagnostic> {
        let wrong = |message: String| Diagnostic::new(message).at(place);
        let Some(comparison) = Comparison::of(text) else {
            let example = columns.first().map_or("peak_to_peak <= 1 um".to_owned(), |(name, unit)| {
                format!("{name} <= 1 {unit}").trim().to_owned()
            });
            return Err(wrong(format!("`{text}` is no limit")).help(format!("write for example `{example}`")));
        };
        let name = comparison.name;
        let Some(column) = columns.iter().position(|(known, _)| *known == name) else {
            let help = suggest(name, columns.iter().map(|(name, _)| *name));
            return Err(wrong(format!("`{name}` is none of the outputs")).help(help));
        };
        let [bound, one] = comparison.bound(columns[column].1).map_err(|wrong| wrong.at(place))?;
        let Comparison { is_upper, may_be_met, .. } = comparison;
        Ok(Self { text: text.trim().to_owned(), column, bound: bound / one, is_upper, may_be_met })
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
        assert!(refused("peak_to_peak <= 1 MPa").contains("is no limit of `peak_to_peak` its limit is given in um"));
        assert!(refused("contact_ratio >= 1 um").contains("a plain number"));
        assert!(refused("peak_to_peak <= x").contains("`x`"));
    }
}
