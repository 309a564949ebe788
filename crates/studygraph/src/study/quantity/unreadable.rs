//! Units that a number cannot have: what to write instead, or which quantity stands there.
//!
//! Nothing is offered that means another quantity: no number without its unit, and no unit of another kind. Must not know: how
//! a number is read.

use super::Measure;
use crate::study::notation;
use crate::study::words::{self, quote};
use declare::error::{Diagnostic, suggest};
use declare::units::{self, ForeignUnit, LENGTH, Quantity, RATIO, UnitError, parse_quantity, split_quantity};

/// Letters from which on a unit is a word.
const SPELLED_OUT: usize = 4;
/// Words for the module behind a factor of it, in small letters.
const MODULES: [&str; 6] = ["module", "modules", "modul", "mod", "mn", "m_n"];

impl Measure<'_> {
    /// What to write for a quantity where a plain number stands. Another quantity is not that number without its unit.
    pub(super) fn without_unit(&self, text: &str, read: Quantity) -> String {
        if read.dimension == RATIO {
            return format!("write `{}`", words::number(read.value));
        }
        let Some((field, unit)) = self.counts_in.filter(|_| read.dimension == LENGTH) else {
            let unit = split_quantity(text).1;
            return format!("a quantity in {} is another quantity, not this number with a unit", quote(unit));
        };
        let name = quote(self.name);
        // `1.25 m` is often written for 1.25 modules.
        if split_quantity(text).1 == "m" {
            let number = split_quantity(text).0;
            return format!(
                "{name} counts in `{field}`, and `m` is the metre; for {number} times the {field} write `{number}`"
            );
        }
        match unit.filter(|unit| *unit > 0.0) {
            Some(unit) => {
                let (number, of) = (words::number(read.value / unit), words::quantity(unit, LENGTH));
                format!("{name} counts in `{field}`: {} / {of} = {number}; write `{number}`", text.trim())
            }
            None => format!("{name} counts in `{field}`: divide the length by that of `{field}`"),
        }
    }

    /// The number of a text that says so many times the module in words or with its symbol, and the field of the module.
    fn times_modules<'t>(&self, text: &'t str) -> Option<(&'t str, &'static str)> {
        let (field, _) = self.counts_in?;
        let (number, unit) = split_quantity(text);
        let factor = unit.trim_start_matches(['*', '·', '×', 'x', ' ']);
        let is_module = match factor {
            "m" => factor.len() < unit.len(),
            _ => MODULES.contains(&factor.to_lowercase().as_str()),
        };
        (is_module && number.parse::<f64>().is_ok()).then_some((number, field))
    }

    /// What to write for a unit that no study has.
    fn foreign(&self, text: &str) -> Option<String> {
        if let Some(decimal) = notation::in_decimals(text) {
            let help = self.read(&decimal, false).err().and_then(|wrong| wrong.help);
            return Some(help.unwrap_or_else(|| format!("write `{decimal}`")));
        }
        let (number, unit) = split_quantity(text);
        let is_expected = |dimension| self.dimension == Some(dimension);
        if let Some(powers) = units::with_powers(unit) {
            let read = parse_quantity(&format!("{number} {powers}")).ok()?;
            return match (self.dimension, read.dimension.describe()) {
                (Some(dimension), _) if dimension == read.dimension => Some(format!("write `{number} {powers}`")),
                // A unit of nothing that has a name is not the one that was meant.
                (_, (_, [])) => None,
                (_, (name, _)) => Some(format!("{} is {}, the unit of {name}", quote(unit), quote(&powers))),
            };
        }
        let (factor, own) = match units::foreign_unit(unit)? {
            ForeignUnit::None(why) => return Some(why.to_owned()),
            ForeignUnit::Of(factor, own) => (factor, own),
        };
        let one = format!("1 {unit} is {} {own}", words::number(factor));
        let (value, dimension) = units::foreign_quantity(text)?;
        let read = Quantity { value, dimension, has_unit: true };
        Some(match self.dimension {
            Some(_) if is_expected(dimension) => {
                let converted = number.parse::<f64>().ok()? * factor;
                format!("write `{} {own}`: {one}", words::number(converted))
            }
            Some(_) => format!("{one}, {}", units::described(dimension)),
            None => format!("{one}; {}", self.without_unit(text, read)),
        })
    }

    /// A symbol that was meant by another: with it the unit is what the field takes.
    fn near_symbol(&self, text: &str, symbol: &str) -> Option<&'static str> {
        let unit = split_quantity(text).1;
        let fits = |known: &&'static str| {
            let read = units::parse_unit(&unit.replacen(symbol, known, 1));
            read.is_ok_and(|read| self.dimension.is_none_or(|own| own == read.dimension))
        };
        let mut same = units::symbols().filter(|known| known.eq_ignore_ascii_case(symbol)).filter(fits);
        match (same.next(), same.next()) {
            // Another letter is another unit: `mN` is a thousandth of a newton, and no slip for `kN`.
            (Some(only), None) => Some(only),
            _ => None,
        }
    }

    pub(super) fn unreadable(&self, text: &str, error: UnitError) -> Diagnostic {
        let shown = quote(text);
        if let Some((number, field)) = self.times_modules(text) {
            let message = format!("{shown} has a unit; {} is a plain number", quote(self.name));
            return Diagnostic::new(message)
                .help(format!("{} counts in `{field}`; write `{number}`", quote(self.name)));
        }
        let is_unit = matches!(error, UnitError::Unknown(_) | UnitError::Malformed { .. });
        if let Some(help) = if is_unit { self.foreign(text) } else { None } {
            let unit = quote(split_quantity(text).1);
            return Diagnostic::new(format!("unknown unit {unit} in {shown}; {} is expected", self.expected()))
                .help(help);
        }
        match error {
            UnitError::Unknown(symbol) => {
                let message = format!("unknown unit {} in {shown}; {} is expected", quote(&symbol), self.expected());
                let own = self.dimension.map_or::<&[&str], _>(&[], |dimension| dimension.describe().1);
                Diagnostic::new(message).help(match self.near_symbol(text, &symbol) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None if symbol.len() < SPELLED_OUT && !own.is_empty() => {
                        let own: Vec<String> = own.iter().map(|unit| quote(unit)).collect();
                        format!("known here: {}", own.join(", "))
                    }
                    None => suggest(&symbol, own.iter().copied()),
                })
            }
            UnitError::Malformed { unit, why, instead } => {
                let message = format!(
                    "{} in {shown} cannot be read as a unit: {why}; {} is expected",
                    quote(&unit),
                    self.expected()
                );
                let fits =
                    |unit: &String| units::parse_unit(unit).is_ok_and(|unit| Some(unit.dimension) == self.dimension);
                Diagnostic::new(message).help(match self.dimension {
                    None => "write the number without a unit".to_owned(),
                    Some(_) => words::unit_instead(text, instead.filter(fits).as_deref()),
                })
            }
            UnitError::Ambiguous { unit, readings } => {
                let message =
                    format!("{} in {shown} can be read in two ways; {} is expected", quote(&unit), self.expected());
                Diagnostic::new(message).help(words::unit_readings(text, &readings, self.dimension))
            }
            UnitError::NotFinite => {
                Diagnostic::new(format!("{shown} is too large a number; {} is expected", self.expected()))
            }
            UnitError::NotANumber(_) | UnitError::Missing => {
                let endless = matches!(
                    text.trim_start_matches(['+', '-', '.']).to_ascii_lowercase().as_str(),
                    "nan" | "inf" | "infinity"
                );
                let is = if endless { "is not finite" } else { "is not a number" };
                Diagnostic::new(format!("{shown} {is}; {} is expected", self.expected()))
            }
        }
    }
}
