//! Numbers as other programs and other readers of YAML write them: what to write in a study instead.
//!
//! A study has decimal digits, one point and an exponent. YAML 1.1 read `030` as 24, `1:30` as 90 and `1_000` as 1000,
//! and programs differ to this day, so what only some of them take for the same number is refused, never guessed. Must not
//! know: what a number is for.

/// Of a comma in a number.
pub const COMMA: &str = "a decimal point, not a comma, and nothing parts thousands";

/// The number that is meant by one with a comma, in quotes; both where the comma may also part thousands.
pub fn with_point(whole: &str, fraction: &str, rest: &str) -> String {
    let point = format!("`{whole}.{fraction}{rest}`");
    if fraction.len() == 3 && !whole.trim_start_matches(['+', '-']).starts_with('0') {
        return format!("{point}, or `{whole}{fraction}{rest}` if the comma parts thousands");
    }
    point
}

/// What to write instead of a text that is, or begins with, a number in another notation; nothing where it is not.
pub fn help(text: &str) -> Option<String> {
    let text = text.trim();
    let (sign, unsigned) = match text.strip_prefix('-') {
        Some(rest) => ("-", rest),
        None => ("", text.strip_prefix('+').unwrap_or(text)),
    };
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

/// Whether a zero stands before another digit: eight times as much to some readers of YAML as to others.
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
            ("1:30", "nothing is counted in sixties: write one number in decimal digits, `1.5` for `1:30`"),
        ] {
            assert_eq!(help(text).as_deref(), Some(says), "{text}");
        }
        for text in ["0", "0.5", "-0.0", "30", "+30", ".5", "5.", "3e1", "0xyz", "19 mm", "", "-", "two", "µ_1", "0e5"]
        {
            assert_eq!(help(text), None, "{text}");
        }
    }
}
