//! Units as they are written: `N/(mm um)`, `N m^-2`, `1/um²`.
//!
//! A unit that two people would read differently is refused, and so is an operator with nothing to work on: a slip of
//! the pen must not become another unit. Must not know: numbers, and what a unit is for.

use super::{Dimension, RATIO, UNITS, Unit, UnitError};

/// Characters of a unit that a message offers instead; a longer one does not help the reader.
const LONGEST_OFFER: usize = 40;
const POWERS: &str = "a power is a whole number from 1 to 9 or from -9 to -1";

/// Reads a unit: symbols multiplied by a space or `*`, divided by `/`, with `^n`, `^-n` and one level of brackets.
///
/// # Errors
/// When a symbol is unknown, the text is malformed, or a product follows a division: `N/mm um` may be meant either way.
pub fn parse_unit(text: &str) -> Result<Unit, UnitError> {
    let malformed = |why: String, instead| UnitError::Malformed { unit: text.to_owned(), why, instead };
    let tokens = tokens(text).map_err(|why| malformed(why, None))?;
    let factors = match read(&tokens) {
        Ok(factors) => factors,
        Err(why) => return Err(malformed(why, repaired(&tokens))),
    };
    let mut unit = Unit { ten: 0, factor: 1.0, dimension: RATIO };
    for &(symbol, [power, _]) in &factors {
        let &(_, ten, factor, dimension) = known(symbol).ok_or_else(|| UnitError::Unknown(symbol.to_owned()))?;
        unit.ten += ten * i32::from(power);
        #[allow(clippy::float_cmp)] // exactly 1 means: a power of ten, nothing to multiply
        if factor != 1.0 {
            unit.factor *= factor.powi(i32::from(power));
        }
        unit.dimension = unit.dimension.times(dimension, power);
    }
    if factors.iter().any(|(_, [all, next])| all != next) {
        let readings = [0, 1].map(|reading| spelled(&factors, reading));
        return Err(UnitError::Ambiguous { unit: text.to_owned(), readings });
    }
    Ok(unit)
}

fn known(symbol: &str) -> Option<&'static (&'static str, i32, f64, Dimension)> {
    UNITS.iter().find(|unit| unit.0 == symbol)
}

#[derive(Clone, Copy, PartialEq)]
enum Token<'a> {
    /// A symbol and its power.
    Symbol(&'a str, i8),
    Times,
    Over,
    Open,
    Close,
}

impl Token<'_> {
    fn shown(self) -> &'static str {
        match self {
            Self::Symbol(..) => "",
            Self::Times => "*",
            Self::Over => "/",
            Self::Open => "(",
            Self::Close => ")",
        }
    }

    fn is_operator(self) -> bool {
        matches!(self, Self::Times | Self::Over)
    }
}

fn tokens(text: &str) -> Result<Vec<Token<'_>>, String> {
    let mut tokens = Vec::new();
    let mut rest = text.trim();
    while let Some(first) = rest.chars().next() {
        let single = match first {
            '*' | '·' => Some(Token::Times),
            '/' => Some(Token::Over),
            '(' => Some(Token::Open),
            ')' => Some(Token::Close),
            _ => None,
        };
        if let Some(token) = single {
            tokens.push(token);
            rest = &rest[first.len_utf8()..];
        } else {
            let end = rest.find(|c: char| c.is_whitespace() || "*·/()^⁻¹²³".contains(c)).unwrap_or(rest.len());
            let (symbol, after) = rest.split_at(end);
            if symbol.is_empty() {
                return Err(format!("`{first}` follows no symbol"));
            }
            let (power, after) = power(after)?;
            tokens.push(Token::Symbol(symbol, power));
            rest = after;
        }
        rest = rest.trim_start();
    }
    Ok(tokens)
}

/// Reads `^n`, `^-n`, `²`, `⁻²` or nothing.
fn power(rest: &str) -> Result<(i8, &str), String> {
    if let Some(after) = rest.strip_prefix('^') {
        let end = after.find(|c: char| !c.is_ascii_digit() && c != '-').unwrap_or(after.len());
        let (digits, after) = after.split_at(end);
        let power = digits.parse::<i8>().ok().filter(|power| (1..=9).contains(&power.unsigned_abs()));
        return power.map(|power| (power, after)).ok_or_else(|| POWERS.to_owned());
    }
    let (sign, unsigned) = rest.strip_prefix('⁻').map_or((1, rest), |after| (-1, after));
    for (mark, power) in [('¹', 1), ('²', 2), ('³', 3)] {
        if let Some(after) = unsigned.strip_prefix(mark) {
            return Ok((sign * power, after));
        }
    }
    if sign < 0 { Err(POWERS.to_owned()) } else { Ok((1, rest)) }
}

/// A symbol with its power in the whole unit: where a `/` divides by all of the product after it, as is often printed,
/// and where it divides by the next symbol or bracket, as programs compute it.
type Factor<'a> = (&'a str, [i8; 2]);

fn read<'a>(tokens: &'a [Token<'a>]) -> Result<Vec<Factor<'a>>, String> {
    let mut reader = Reader { tokens, at: 0, factors: Vec::new() };
    if !tokens.is_empty() {
        reader.product([1, 1], false)?;
    }
    Ok(reader.factors)
}

struct Reader<'a> {
    tokens: &'a [Token<'a>],
    at: usize,
    factors: Vec<Factor<'a>>,
}

impl Reader<'_> {
    /// Reads up to the end, or to the bracket that closes this product; `outer` is the sign of its powers.
    fn product(&mut self, outer: [i8; 2], inside: bool) -> Result<(), String> {
        let mut sign = outer;
        loop {
            match self.tokens.get(self.at) {
                Some(&Token::Symbol(symbol, power)) => self.factors.push((symbol, sign.map(|sign| sign * power))),
                Some(Token::Open) if inside => return Err("a bracket stands inside a bracket".to_owned()),
                Some(Token::Open) => {
                    self.at += 1;
                    self.product(sign, true)?;
                }
                found => return Err(self.missing(found.copied())),
            }
            self.at += 1;
            match self.tokens.get(self.at) {
                None if inside => return Err("a bracket is not closed".to_owned()),
                None => return Ok(()),
                Some(Token::Close) if inside => return Ok(()),
                Some(Token::Close) => return Err("a bracket is closed that is not open".to_owned()),
                Some(Token::Over) => {
                    sign = outer.map(|sign| -sign);
                    self.at += 1;
                }
                Some(token) => {
                    self.at += usize::from(*token == Token::Times);
                    sign[1] = outer[1];
                }
            }
        }
    }

    /// Why there is no symbol here.
    fn missing(&self, found: Option<Token>) -> String {
        let before = self.at.checked_sub(1).and_then(|at| self.tokens.get(at)).map(|token| token.shown());
        match (before, found.map(Token::shown)) {
            (None, Some(")")) => "a bracket is closed that is not open".to_owned(),
            (Some("("), None) => "a bracket is not closed".to_owned(),
            (Some(before), Some(found)) => format!("nothing stands between `{before}` and `{found}`"),
            (None, Some(found)) => format!("nothing stands before `{found}`"),
            (before, None) => format!("nothing stands after `{}`", before.unwrap_or_default()),
        }
    }
}

fn with_power(symbol: &str, power: i8) -> String {
    if power == 1 { symbol.to_owned() } else { format!("{symbol}^{power}") }
}

/// One reading of the factors, as a text that reads only one way.
fn spelled(factors: &[Factor], reading: usize) -> String {
    let part = |sign: i8| {
        let of_sign = factors.iter().filter(|(symbol, powers)| *symbol != "1" && powers[reading].signum() == sign);
        of_sign.map(|(symbol, powers)| with_power(symbol, powers[reading].abs())).collect::<Vec<_>>()
    };
    let above = Some(part(1).join(" ")).filter(|above| !above.is_empty()).unwrap_or_else(|| "1".to_owned());
    match part(-1).as_slice() {
        [] => above,
        [only] => format!("{above}/{only}"),
        several => format!("{above}/({})", several.join(" ")),
    }
}

/// The unit without the `*` that have nothing to multiply, and with the 1 that a leading `/` divides.
fn repaired(tokens: &[Token]) -> Option<String> {
    let mut kept: Vec<Token> = Vec::new();
    for (at, &token) in tokens.iter().enumerate() {
        let before = kept.last().is_none_or(|last| last.is_operator() || *last == Token::Open);
        let after = tokens.get(at + 1).is_none_or(|next| next.is_operator() || *next == Token::Close);
        match token {
            Token::Times if before || after => {}
            Token::Over if kept.is_empty() => kept.extend([Token::Symbol("1", 1), token]),
            _ => kept.push(token),
        }
    }
    let factors = read(&kept).ok().filter(|factors| !factors.is_empty())?;
    let clear = factors.iter().all(|(symbol, [all, next])| all == next && known(symbol).is_some());
    let text = spelled(&factors, 0);
    (clear && text.chars().count() <= LONGEST_OFFER).then_some(text)
}

#[cfg(test)]
mod tests {
    use super::super::{PER_AREA, SPECIFIC_STIFFNESS, STRESS, TIME, parse_quantity};
    use super::*;

    #[test]
    fn what_means_the_same_has_the_same_bits() {
        for (forms, dimension) in [
            (
                &["N/(mm um)", "N/(mm·µm)", "N/mm/um", "N mm^-1 um^-1", "(N/mm)/um", "N/(mm) /um"][..],
                SPECIFIC_STIFFNESS,
            ),
            (&["N m^-2", "N/m/m", "N/m^2", "N/m²", "N m⁻²", "Pa", "m^-2 N", "N*m^-2", "1/(m^2/N)"], STRESS),
            (&["1/um^2", "um^-2", "1/um/um", "um⁻²", "1/um²", "1/(um um)"], PER_AREA),
            (&["s", "1/s^-1", "s^2/s", "s s⁻¹ s"], TIME),
        ] {
            for form in forms {
                let unit = parse_unit(form).unwrap_or_else(|error| panic!("{form}: {error}"));
                assert_eq!((unit.dimension, unit), (dimension, parse_unit(forms[0]).unwrap()), "{form}");
            }
        }
        assert_eq!(parse_quantity("19.05 N/mm/um").unwrap().value.to_bits(), 19.05e9_f64.to_bits());
        assert_eq!(parse_unit("MPa mm/N").unwrap().dimension, parse_unit("1/mm").unwrap().dimension);
    }

    /// A product after a division has two readings; what is offered reads one way only, and as it says.
    #[test]
    fn a_product_after_a_division_is_refused_with_both_readings() {
        for (text, all, next) in [
            ("N/mm um", "N/(mm um)", "N um/mm"),
            ("N/mm*um", "N/(mm um)", "N um/mm"),
            ("N/mm(um)", "N/(mm um)", "N um/mm"),
            ("N/(mm um) s", "N/(mm um s)", "N s/(mm um)"),
            ("N/mm/um s", "N/(mm um s)", "N s/(mm um)"),
            ("1/m N", "1/(m N)", "N/m"),
            ("s/(N/mm um)", "s mm um/N", "s mm/(N um)"),
            ("N/mm^2 um^-1", "N um/mm^2", "N/(mm^2 um)"),
        ] {
            let readings = [all.to_owned(), next.to_owned()];
            assert_eq!(parse_unit(text), Err(UnitError::Ambiguous { unit: text.to_owned(), readings }));
            assert_ne!(parse_unit(all).unwrap(), parse_unit(next).unwrap(), "{text}");
        }
        let said = parse_unit("N/mm um").unwrap_err().to_string();
        assert_eq!(said, "`N/mm um` can be read in two ways: write `N/(mm um)` or `N um/mm`");
    }

    #[test]
    fn operators_with_nothing_to_work_on_are_refused() {
        for (text, why, instead) in [
            ("*Pa*", "nothing stands before `*`", Some("Pa")),
            ("*GPa", "nothing stands before `*`", Some("GPa")),
            ("Pa *", "nothing stands after `*`", Some("Pa")),
            ("N**m", "nothing stands between `*` and `*`", Some("N m")),
            ("N*·*m", "nothing stands between `*` and `*`", Some("N m")),
            ("N/*mm", "nothing stands between `/` and `*`", Some("N/mm")),
            ("N*/mm", "nothing stands between `*` and `/`", Some("N/mm")),
            ("N/(*mm um*)", "nothing stands between `(` and `*`", Some("N/(mm um)")),
            ("/mm^2", "nothing stands before `/`", Some("1/mm^2")),
            ("um**2", "nothing stands between `*` and `*`", None),
            ("*", "nothing stands before `*`", None),
            ("N/", "nothing stands after `/`", None),
            ("N//mm", "nothing stands between `/` and `/`", None),
            ("N()", "nothing stands between `(` and `)`", None),
            ("N/(mm", "a bracket is not closed", None),
            ("m(", "a bracket is not closed", None),
            (")", "a bracket is closed that is not open", None),
            ("N/mm)", "a bracket is closed that is not open", None),
            ("N/((mm) um)", "a bracket stands inside a bracket", None),
            ("(mm)^2", "`^` follows no symbol", None),
            ("⁻¹", "`⁻` follows no symbol", None),
            ("m^", POWERS, None),
            ("m^0", POWERS, None),
            ("m^10", POWERS, None),
            ("m^--2", POWERS, None),
            ("m^-128", POWERS, None),
            ("m⁻", POWERS, None),
        ] {
            let (why, instead) = (why.to_owned(), instead.map(str::to_owned));
            assert_eq!(parse_unit(text), Err(UnitError::Malformed { unit: text.to_owned(), why, instead }));
        }
        let said = parse_unit("*Pa*").unwrap_err().to_string();
        assert_eq!(said, "`*Pa*` cannot be read as a unit: nothing stands before `*`; write `Pa`");
    }

    #[test]
    fn an_unknown_symbol_is_said_before_anything_else() {
        for text in ["N/mm furlong", "furlong^-2", "N/furlong/mm"] {
            assert_eq!(parse_unit(text), Err(UnitError::Unknown("furlong".to_owned())), "{text}");
        }
    }

    /// What is read is spelled and read again as the same unit, whatever operators, powers and brackets it has.
    #[test]
    fn spelling_a_unit_and_reading_it_again_gives_the_same_unit() {
        let symbols = ["N", "mm", "um^2", "s^-3", "GPa⁻¹"];
        let between = [" ", "*", "/", "/(", ") ", ")/", " ("];
        let mut read_again = 0;
        for number in 0..symbols.len().pow(3) * between.len().pow(2) {
            let (pick, places) = (number / between.len().pow(2), number % between.len().pow(2));
            let symbol = |at: u32| symbols[pick / symbols.len().pow(at) % symbols.len()];
            let join = |at: u32| between[places / between.len().pow(at) % between.len()];
            let open = [0, 1].map(join).join("");
            let close = if open.matches('(').count() > open.matches(')').count() { ")" } else { "" };
            let text = format!("{}{}{}{}{}{close}", symbol(0), join(0), symbol(1), join(1), symbol(2));
            let Ok(unit) = parse_unit(&text) else { continue };
            let tokens = tokens(&text).unwrap();
            let again = spelled(&read(&tokens).unwrap(), 0);
            assert_eq!(parse_unit(&again), Ok(unit), "{text} as {again}");
            read_again += 1;
        }
        assert!(read_again > 1000, "{read_again}");
    }
}
