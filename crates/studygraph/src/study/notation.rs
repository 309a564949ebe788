//! Numbers as other programs and other readers of YAML write them: what to write in a study instead.
//!
//! A study has decimal digits, one point and an exponent. YAML 1.1 read `030` as 24, `1:30` as 90 and `1_000` as 1000,
//! and programs differ to this day, so what only some of them take for the same number is refused, never guessed. Must not
//! know: what a number is for.

use declare::units::split_quantity;

/// As which a half-width may be marked.
const SIGNS: [&str; 4] = ["±", "+/-", "+-", r"\pm"];
/// Of a comma in a number.
pub const COMMA: &str = "a decimal point, not a comma, and nothing parts thousands";

/// A tolerance without its sign, which may be left out where nothing stands before it.
pub fn without_sign(text: &str) -> &str {
    let text = text.trim();
    SIGNS.iter().find_map(|sign| text.strip_prefix(sign)).unwrap_or(text).trim()
}

/// What stands before and behind the sign; none where there is none.
pub fn halves(text: &str) -> Option<(&str, &str)> {
    let first = SIGNS.iter().filter_map(|sign| Some((text.find(sign)?, sign.len())));
    let (at, length) = first.min()?;
    Some((text[..at].trim(), text[at + length..].trim()))
}

/// The middle with its unit, which may stand behind both.
pub fn middle(text: &str) -> Option<String> {
    let (middle, half) = halves(text)?;
    let (number, unit) = split_quantity(half);
    let is_behind_both = split_quantity(middle).1.is_empty() && !number.is_empty() && !unit.is_empty();
    Some(if is_behind_both { format!("{middle} {unit}") } else { middle.to_owned() })
}

/// What to write instead of a number with commas, which may stand for a point or part thousands: both where nothing tells, the
/// one first that is nearer to what the field usually has, as `distance` says.
#[must_use]
pub fn without_commas(text: &str, distance: &dyn Fn(&str) -> f64) -> Option<String> {
    if !text.contains(',') {
        return None;
    }
    let [point, thousands] = match halves(text) {
        // Both numbers of an interval are written in one manner.
        Some((before, behind)) => {
            let [of_middle, of_half] = [before, behind].map(readings);
            let both = |(middle, half): (Option<String>, Option<String>)| Some(format!("{} ± {}", middle?, half?));
            let [middle, other_middle] = of_middle;
            let [half, other_half] = of_half;
            [both((middle, half)), both((other_middle, other_half))]
        }
        None => readings(text),
    };
    Some(match (point, thousands) {
        (Some(point), Some(thousands)) if distance(&thousands) < distance(&point) => {
            format!("write `{thousands}`, or `{point}` if the comma is a decimal one")
        }
        (Some(point), Some(thousands)) => format!("write `{point}`, or `{thousands}` if the comma parts thousands"),
        (point, thousands) => format!("write `{}`", point.or(thousands)?),
    })
}

/// A number with commas as points, and with none because they part thousands, each where it can be; one without is as it is.
fn readings(text: &str) -> [Option<String>; 2] {
    let end = text.find(|c: char| !c.is_ascii_digit() && !"+-.,".contains(c)).unwrap_or(text.len());
    let (number, rest) = text.split_at(end);
    let groups: Vec<&str> = number.split(',').collect();
    let [whole, inner @ .., last] = &groups[..] else { return [(); 2].map(|()| Some(text.to_owned())) };
    let is_group = |group: &&str| group.len() == 3 && group.bytes().all(|byte| byte.is_ascii_digit());
    let starts_with_zero = whole.trim_start_matches(['+', '-']).starts_with('0');
    let last_group = last.split('.').next().unwrap_or(last);
    let parts_thousands =
        !starts_with_zero && !whole.contains('.') && inner.iter().all(is_group) && is_group(&last_group);
    let thousands = parts_thousands.then(|| format!("{}{rest}", groups.concat()));
    let point = (inner.is_empty() && !number.contains('.')).then(|| format!("{whole}.{last}{rest}"));
    [point, thousands]
}

/// A help of [`help`], and behind it what to write instead of a number with commas.
#[must_use]
pub fn with_reading(help: String, text: &str, distance: &dyn Fn(&str) -> f64) -> String {
    match without_commas(text.trim(), distance) {
        Some(meant) => format!("{help}: {meant}"),
        None => help,
    }
}

/// What to write instead of a text that is, or begins with, a number in another notation; nothing where it is not.
#[must_use]
pub fn help(text: &str) -> Option<String> {
    let text = text.trim();
    let (sign, unsigned) = match text.strip_prefix('-') {
        Some(rest) => ("-", rest),
        None => ("", text.strip_prefix('+').unwrap_or(text)),
    };
    if let Some(help) = with_brackets(text) {
        return Some(help);
    }
    let word = unsigned.split_whitespace().next().unwrap_or("");
    if let Some(value) = in_another_base(word) {
        return Some(format!("`{sign}{word}` in decimal digits is `{sign}{value}`"));
    }
    let end = unsigned.find(|c: char| !c.is_ascii_digit() && !"._,:".contains(c)).unwrap_or(unsigned.len());
    let (number, rest) = unsigned.split_at(end);
    if !number.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let short = |number: &str| number.chars().take(40).collect::<String>();
    if number.contains(':') {
        return Some("nothing is counted in sixties: write one number in decimal digits, `1.5` for `1:30`".to_owned());
    }
    if number.contains(',') {
        return Some(COMMA.to_owned());
    }
    if number.contains('_') {
        let plain = number.replace('_', "");
        return Some(format!("nothing parts thousands: write `{sign}{}{rest}`", short(&plain)));
    }
    if starts_with_zero(number) {
        let plain = number.trim_start_matches('0');
        let zero = if plain.starts_with(|c: char| c.is_ascii_digit()) { "" } else { "0" };
        return Some(format!("write `{sign}{zero}{}{rest}`, without zeros in front", short(plain)));
    }
    None
}

/// `14.079(1) mm`: digits in brackets are what the last ones may be off by, to those who write them.
fn with_brackets(text: &str) -> Option<String> {
    let [number, half] = in_brackets(text)?;
    let (digits, unit) = split_quantity(&half);
    let interval = format!("{} ± {digits} {unit}", split_quantity(&number).0);
    Some(format!("digits in brackets are not read: write `{number}`, or as an interval `{}`", interval.trim()))
}

/// The number and what it may be off by, both with the unit.
fn in_brackets(text: &str) -> Option<[String; 2]> {
    let (number, rest) = split_quantity(text);
    let (digits, unit) = rest.strip_prefix('(')?.split_once(')')?;
    let is_digits = (1..=9).contains(&digits.len()) && digits.bytes().all(|byte| byte.is_ascii_digit());
    if !is_digits || number.is_empty() || number.contains(['e', 'E']) || text.contains(" (") {
        return None;
    }
    let decimals = number.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let padded = format!("{digits:0>width$}", width = decimals + 1);
    let (whole, fraction) = padded.split_at(padded.len() - decimals);
    let half = if decimals == 0 { whole.to_owned() } else { format!("{whole}.{fraction}") };
    Some([number, &half].map(|number| format!("{number} {}", unit.trim()).trim_end().to_owned()))
}

/// The number and what it may be off by, where a text is an interval, and where one number alone can stand.
#[must_use]
pub fn halves_of(text: &str) -> Option<[String; 2]> {
    if let Some(both) = in_brackets(text.trim()) {
        return Some(both);
    }
    let bare = text.trim().strip_prefix('(').and_then(|text| text.split_once(')'));
    let bare = bare.map_or_else(|| text.to_owned(), |(inside, unit)| format!("{inside} {unit}"));
    let (before, half) = halves(&bare)?;
    let (is_there, middle) = (!before.is_empty(), middle(&bare)?);
    is_there.then(|| [middle, half.split_whitespace().collect::<Vec<_>>().join(" ")])
}

/// A quantity whose number has a fraction, `1 1/2 in`, or minutes and seconds of an angle, `20°30'`, with one decimal number.
#[must_use]
pub fn in_decimals(text: &str) -> Option<String> {
    sexagesimal(text.trim()).or_else(|| fraction(text.trim()))
}

fn sexagesimal(text: &str) -> Option<String> {
    let (degrees, rest) = text.split_once('°')?;
    let (minutes, rest) = rest.split_once(['\'', '′'])?;
    let seconds = rest.trim().trim_end_matches(['"', '″', '\'', '′']).trim();
    let part = |text: &str| text.trim().parse::<f64>().ok().filter(|part| (0.0..60.0).contains(part));
    let seconds = if seconds.is_empty() { 0.0 } else { part(seconds)? };
    let (whole, part) = (degrees.trim().parse::<f64>().ok()?, part(minutes)? / 60.0 + seconds / 3600.0);
    Some(format!(
        "{} deg",
        super::words::number(if degrees.trim().starts_with('-') { whole - part } else { whole + part })
    ))
}

fn fraction(text: &str) -> Option<String> {
    let (before, behind) = text.split_once('/')?;
    let (whole, numerator) = before.trim().rsplit_once(' ').unwrap_or(("0", before.trim()));
    let end = behind.find(|c: char| !c.is_ascii_digit()).unwrap_or(behind.len());
    let (denominator, unit) = behind.split_at(end);
    let digits = |text: &str| text.parse::<u32>().ok().map(f64::from);
    let (whole, numerator, denominator) = (digits(whole.trim())?, digits(numerator)?, digits(denominator)?);
    let value = (denominator > 0.0).then(|| whole + numerator / denominator)?;
    Some(format!("{} {}", super::words::number(value), unit.trim()).trim_end().to_owned())
}

/// Whether a zero stands before another digit: eight times as much to some readers of YAML as to others.
#[must_use]
pub fn starts_with_zero(text: &str) -> bool {
    let digits = text.trim().trim_start_matches(['+', '-']).as_bytes();
    digits.first() == Some(&b'0') && digits.get(1).is_some_and(u8::is_ascii_digit)
}

fn in_another_base(word: &str) -> Option<u64> {
    let bases = [("0x", 16), ("0X", 16), ("0o", 8), ("0O", 8), ("0b", 2), ("0B", 2)];
    let (digits, base) = bases.iter().find_map(|(prefix, base)| Some((word.strip_prefix(prefix)?, *base)))?;
    u64::from_str_radix(&digits.replace('_', ""), base).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_halves_have_a_unit_of_their_own_or_share_one() {
        for (text, expected) in [
            ("0.504 ± 0.0005", Some("0.504")),
            ("0.504±0.0005", Some("0.504")),
            ("0.504 +- 0.0005", Some("0.504")),
            ("-0.504 +/- 0.0005", Some("-0.504")),
            ("5.05 ± 0.005 mm", Some("5.05 mm")),
            ("5.05 mm ± 5 um", Some("5.05 mm")),
            ("5 % ± 0.5 %", Some("5 %")),
            (r"0.504 \pm 0.0005", Some("0.504")),
            ("5.05 mm", None),
            ("1e+3", None),
        ] {
            assert_eq!(middle(text).as_deref(), expected, "{text}");
        }
        assert_eq!((without_sign("± 2 um"), without_sign(" +-2 um"), without_sign("2 um")), ("2 um", "2 um", "2 um"));
    }

    #[test]
    fn other_notations_are_told_in_decimal_digits() {
        for (text, says) in [
            ("0x18", "`0x18` in decimal digits is `24`"),
            ("-0X1_f", "`-0X1_f` in decimal digits is `-31`"),
            ("0o30", "`0o30` in decimal digits is `24`"),
            ("0b11 mm", "`0b11` in decimal digits is `3`"),
            ("030", "write `30`, without zeros in front"),
            ("00", "write `0`, without zeros in front"),
            ("-007.5 mm", "write `-7.5 mm`, without zeros in front"),
            ("1_000 mm", "nothing parts thousands: write `1000 mm`"),
            ("1,5 mm", COMMA),
            (
                "14.079(1) mm",
                "digits in brackets are not read: write `14.079 mm`, or as an interval `14.079 ± 0.001 mm`",
            ),
            ("-0.50(12)", "digits in brackets are not read: write `-0.50`, or as an interval `-0.50 ± 0.12`"),
            ("19(1)", "digits in brackets are not read: write `19`, or as an interval `19 ± 1`"),
            ("1:30", "nothing is counted in sixties: write one number in decimal digits, `1.5` for `1:30`"),
        ] {
            assert_eq!(help(text).as_deref(), Some(says), "{text}");
        }
        for text in [
            "0",
            "0.5",
            "-0.0",
            "30",
            "+30",
            ".5",
            "5.",
            "3e1",
            "0xyz",
            "19 mm",
            "",
            "-",
            "two",
            "µ_1",
            "0e5",
            "3 (1/um^2)",
            "3(1/um^2)",
            "3 m(",
        ] {
            assert_eq!(help(text), None, "{text}");
        }
    }

    #[test]
    fn an_interval_where_one_number_is_meant_is_that_number_and_its_tolerance() {
        for text in ["5.171 ± 0.001 mm", "(5.171 ± 0.001) mm", "5.171(1) mm"] {
            assert_eq!(halves_of(text), Some(["5.171 mm".to_owned(), "0.001 mm".to_owned()]), "{text}");
        }
        assert_eq!(halves_of("5.171 mm ± 1 um"), Some(["5.171 mm".to_owned(), "1 um".to_owned()]));
        assert!(["5.171 mm", "3 1/(um^2)", "1e+3", "5 N/(mm um)"].into_iter().all(|text| halves_of(text).is_none()));
    }

    #[test]
    fn commas_are_points_or_part_thousands_whichever_is_nearer_to_the_usual() {
        let near = |usual: f64| {
            move |text: &str| (text.split(' ').next().unwrap().parse::<f64>().unwrap().abs() / usual).ln().abs()
        };
        for (text, usual, says) in [
            ("206,000 MPa", 2e5, "write `206000 MPa`, or `206.000 MPa` if the comma is a decimal one"),
            ("206,000 MPa", 2e2, "write `206.000 MPa`, or `206000 MPa` if the comma parts thousands"),
            ("3,5 mm", 1e4, "write `3.5 mm`"),
            ("0,125 mm", 1e4, "write `0.125 mm`"),
            ("-1,250", 1.0, "write `-1.250`, or `-1250` if the comma parts thousands"),
            ("1,234.5 mm", 1.0, "write `1234.5 mm`"),
            ("206,000,000 kPa", 1.0, "write `206000000 kPa`"),
            ("14,079 ± 0,001 mm", 18.0, "write `14.079 ± 0.001 mm`"),
            ("14.079+-0,001 mm", 18.0, "write `14.079 ± 0.001 mm`"),
            ("14,079 ± 1 mm", 18.0, "write `14.079 ± 1 mm`, or `14079 ± 1 mm` if the comma parts thousands"),
        ] {
            assert_eq!(without_commas(text, &near(usual)).as_deref(), Some(says), "{text}");
        }
        for text in ["1,2,3", "1.5,000", "1,00,000 mm"] {
            assert_eq!(without_commas(text, &near(1.0)), None, "{text}");
        }
    }
}
