//! Words that messages, the schema and the descriptions of kinds share: quoted text, ranges, what a field expects.
//!
//! Values come in SI and are shown in the unit in which they are shortest. Must not know: YAML, stages.

use declare::error::Diagnostic;
use declare::parameter::{Field, Presence, Shape};
use declare::text::{code_point, is_invisible};
use declare::units::{Dimension, RATIO, in_unit, parse_quantity, parse_unit, split_quantity};

/// Characters of a user's text that a message repeats.
const LONGEST_QUOTE: usize = 60;

/// Names that a message lists.
const MOST_NAMES: usize = 30;

/// The text in backticks, on one line, cut when long; an invisible character by its number.
pub fn quote(text: &str) -> String {
    let mut shown = String::new();
    for (at, character) in text.chars().enumerate() {
        if at == LONGEST_QUOTE {
            shown.push('…');
            break;
        }
        if matches!(character, '\n' | '\r' | '\t') {
            shown.extend(character.escape_default());
        } else if is_invisible(character) {
            shown.push_str(&code_point(character));
        } else {
            shown.push(character);
        }
    }
    format!("`{shown}`")
}

/// `` `a`, `b` or `c` ``.
pub fn alternatives<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names: Vec<_> = names.into_iter().map(quote).collect();
    if names.len() > MOST_NAMES {
        let others = format!("one of {} others", names.len() - MOST_NAMES);
        names.truncate(MOST_NAMES);
        names.push(others);
    }
    match names.as_slice() {
        [] => "nothing".to_owned(),
        [only] => only.clone(),
        [front @ .., last] => format!("{} or {last}", front.join(", ")),
    }
}

/// `a`, `an` in front of a word.
pub fn article(word: &str) -> &'static str {
    if word.trim_start_matches('`').starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" }
}

/// A number with at most 12 digits that count, without the noise of binary fractions.
pub fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.11e}").parse().unwrap_or(value);
    let size = rounded.abs();
    if size != 0.0 && !(1e-4..1e7).contains(&size) { format!("{rounded:e}") } else { format!("{rounded}") }
}

/// A quantity in the unit of its dimension that makes it shortest.
pub fn quantity(si: f64, dimension: Dimension) -> String {
    let (_, units) = dimension.describe();
    if dimension == RATIO || units.is_empty() {
        return number(si);
    }
    if si == 0.0 {
        return format!("0 {}", units[0]);
    }
    let shown = units.iter().map(|unit| (number(in_unit(si, unit)), unit));
    shown
        .min_by_key(|(text, _)| (text.contains('e'), text.len()))
        .map_or_else(String::new, |(text, unit)| format!("{text} {unit}"))
}

/// `between 0.01 mm and 1 m`, `at least 0`; `None` when everything finite is allowed.
pub fn range(minimum: f64, maximum: f64, show: impl Fn(f64) -> String) -> Option<String> {
    match (minimum.is_finite(), maximum.is_finite()) {
        (true, true) => Some(format!("between {} and {}", show(minimum), show(maximum))),
        (true, false) => Some(format!("at least {}", show(minimum))),
        (false, true) => Some(format!("at most {}", show(maximum))),
        (false, false) => None,
    }
}

/// The same for whole numbers, where the widest values mean that there is no bound.
pub fn integer_range(minimum: i64, maximum: i64) -> Option<String> {
    match (minimum != i64::MIN, maximum != i64::MAX) {
        (true, true) => Some(format!("between {minimum} and {maximum}")),
        (true, false) => Some(format!("at least {minimum}")),
        (false, true) => Some(format!("at most {maximum}")),
        (false, false) => None,
    }
}

/// The whole numbers that are multiples of this one.
pub fn integer(multiple: i64) -> String {
    match multiple {
        1 => "a whole number".to_owned(),
        2 => "an even number".to_owned(),
        _ => format!("a multiple of {multiple}"),
    }
}

/// What a study might say in a field, as text: its example, or its default.
pub fn example_of(field: &Field) -> Option<&'static str> {
    match field.presence {
        _ if field.example.is_some() => field.example,
        Presence::Default(text) if !text.starts_with(['[', '{']) => Some(text),
        _ => None,
    }
}

/// A quantity that would be accepted.
pub fn example(dimension: Dimension, minimum: f64, maximum: f64) -> Option<String> {
    let (_, units) = dimension.describe();
    units.iter().find_map(|unit| {
        let fits = |amount: &&str| with_unit(amount, unit, dimension, minimum, maximum).is_some();
        ["3", "20", "200", "1", "0.5", "0.1", "0"].into_iter().find(fits).map(|amount| format!("{amount} {unit}"))
    })
}

/// Ratio of a number to the usual one from which on another unit was meant.
const FAR: f64 = 500.0;

/// The user's own number with the unit that brings it nearest to `such`; `such` itself, or any acceptable quantity, if it is far from
/// that in every unit.
pub fn example_like(
    amount: &str,
    dimension: Dimension,
    minimum: f64,
    maximum: f64,
    such: Option<&str>,
) -> Option<String> {
    let usual = such.map(|such| split_quantity(such).1).filter(|unit| !unit.is_empty());
    let units = usual.into_iter().chain(dimension.describe().1.iter().copied());
    let si = |text: &str| parse_quantity(text).ok().map(|read| read.value).filter(|si| *si != 0.0);
    let distance = |text: &str| {
        let ratio = such.and_then(si).zip(si(text)).map(|(usual, own)| (own / usual).abs());
        ratio.map_or(0.0, |ratio| ratio.ln().abs())
    };
    let mut own: Vec<(f64, String)> = units
        .filter_map(|unit| with_unit(amount, unit, dimension, minimum, maximum))
        .map(|text| (distance(&text), text))
        .filter(|(distance, _)| *distance < FAR.ln())
        .collect();
    own.sort_by(|one, other| one.0.total_cmp(&other.0));
    own.into_iter()
        .next()
        .map(|(_, text)| text)
        .or_else(|| such.map(str::to_owned))
        .or_else(|| example(dimension, minimum, maximum))
}

fn with_unit(amount: &str, unit: &str, dimension: Dimension, minimum: f64, maximum: f64) -> Option<String> {
    let text = format!("{amount} {unit}");
    let read = declare::units::parse_quantity(&text).ok()?;
    (read.dimension == dimension && (minimum..=maximum).contains(&read.value) && amount.len() < 20).then_some(text)
}

/// What to write instead of a quantity whose unit cannot be read.
pub fn unit_instead(text: &str, instead: Option<&str>) -> String {
    match (instead, split_quantity(text).0) {
        (Some(unit), number) if number.len() < 20 => format!("write `{number} {unit}`"),
        (Some(unit), _) => format!("write the unit as `{unit}`"),
        (None, _) => "units are written like `mm`, `N m`, `N/(mm um)` or `1/um^2`".to_owned(),
    }
}

/// What to write instead of a quantity whose unit can be read in two ways: both, or the one that is wanted.
pub fn unit_readings(text: &str, readings: &[String; 2], wanted: Option<Dimension>) -> String {
    const LONGEST: usize = 60;
    let fits = |unit: &str| wanted.is_none_or(|wanted| parse_unit(unit).is_ok_and(|unit| unit.dimension == wanted));
    let offered = match readings.each_ref().map(|unit| fits(unit)) {
        [true, false] => &readings[..1],
        [false, true] => &readings[1..],
        _ => readings,
    };
    if readings.iter().any(|unit| unit.len() > LONGEST) {
        return "put what it is divided by in brackets, as in `N/(mm um)`".to_owned();
    }
    match (offered, split_quantity(text).0) {
        ([unit], number) if number.len() < 20 => format!("write `{number} {unit}`"),
        _ => format!("write the unit as {}", alternatives(offered.iter().map(String::as_str))),
    }
}

/// What a number must be: `` a length (for example `3 mm`) ``; no dimension means a plain number.
pub fn measure(dimension: Option<Dimension>, minimum: f64, maximum: f64, such: Option<&str>) -> String {
    match dimension {
        None => "a plain number".to_owned(),
        Some(RATIO) => "a ratio (a plain number or one with `%`)".to_owned(),
        Some(dimension) => {
            let example = such.map(str::to_owned).or_else(|| example(dimension, minimum, maximum));
            let example = example.map_or(String::new(), |text| format!(" (for example `{text}`)"));
            format!("{}{example}", dimension.describe().0)
        }
    }
}

/// That a field, or something in it, has no value.
pub fn no_value(name: &str, shape: &'static Shape, field: &'static Field) -> Diagnostic {
    let is_needed = std::ptr::eq(shape, &raw const field.shape) && field.presence == Presence::Required;
    let may_be_empty = matches!(shape, Shape::List(_)) && !is_needed;
    let help = if may_be_empty { "write `[]` for an empty list" } else { field.summary };
    let message = format!("{} has no value; {} is expected", quote(name), expected(shape, example_of(field)));
    Diagnostic::new(message).help(help)
}

/// What a shape holds, as the subject of "is expected"; `such` is an example.
pub fn expected(shape: &Shape, such: Option<&str>) -> String {
    match shape {
        Shape::Quantity { dimension, minimum, maximum } => measure(Some(*dimension), *minimum, *maximum, such),
        Shape::AnyQuantity => "a number, with its unit if it has one,".to_owned(),
        Shape::Number { minimum, maximum } => measure(None, *minimum, *maximum, None),
        Shape::Integer { multiple, .. } => integer(*multiple),
        Shape::Flag => "`true` or `false`".to_owned(),
        Shape::Text => "text".to_owned(),
        Shape::File => "the name of a CSV file beside the study, such as `trace.csv`,".to_owned(),
        Shape::Choice(choices) => alternatives(choices.iter().map(|choice| choice.name)),
        Shape::Reference(kinds) => stage_of(kinds),
        Shape::List(_) => "a list".to_owned(),
        Shape::Map(_) => "a mapping from names".to_owned(),
        Shape::Group(fields) => format!("a mapping with the fields {}", names(fields)),
        Shape::Member(members) => alternatives(members().iter().map(|member| member.name)),
        Shape::Overrides(of) => format!("a mapping from fields of the stage in {} to other values", quote(of)),
        Shape::Varied(_) => "a mapping from names of columns to fields and their values".to_owned(),
    }
}

/// `` the name of a `geometry` stage ``.
pub fn stage_of(kinds: &[&str]) -> String {
    if kinds.is_empty() {
        return "the name of a stage".to_owned();
    }
    let kinds = alternatives(kinds.iter().copied());
    format!("the name of {} {kinds} stage", article(&kinds))
}

fn names(fields: &[Field]) -> String {
    fields.iter().map(|field| quote(field.name)).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use declare::units::{ANGLE, FORCE, LENGTH, STRESS};

    #[test]
    fn quantities_are_shown_in_the_unit_that_makes_them_shortest() {
        assert_eq!(quantity(1e-5, LENGTH), "10 um");
        assert_eq!(quantity(1.0, LENGTH), "1 m");
        assert_eq!(quantity(0.02, LENGTH), "20 mm");
        assert_eq!(quantity(std::f64::consts::FRAC_PI_4, ANGLE), "45 deg");
        assert_eq!(quantity(206e9, STRESS), "206 GPa");
        assert_eq!(quantity(0.01, RATIO), "0.01");
        assert_eq!(quantity(0.0, LENGTH), "0 mm");
    }

    #[test]
    fn an_example_is_acceptable_and_keeps_the_users_number_when_it_can() {
        assert_eq!(example_like("3", LENGTH, 1e-4, 0.1, None).as_deref(), Some("3 mm"));
        assert_eq!(example_like("3", LENGTH, 0.0, 5e-3, Some("12 um")).as_deref(), Some("3 um"));
        assert_eq!(example_like("206", STRESS, 1e9, 1e12, None).as_deref(), Some("206 GPa"));
        assert_eq!(example_like("-5", FORCE, 0.0, 1e6, None).as_deref(), Some("3 N"));
        assert_eq!(example(LENGTH, 1e-7, 1e-6).as_deref(), Some("1 um"));
    }

    #[test]
    fn ranges_leave_out_the_bound_that_is_none() {
        assert_eq!(range(0.0, f64::INFINITY, number).as_deref(), Some("at least 0"));
        assert_eq!(range(f64::NEG_INFINITY, 2.5, number).as_deref(), Some("at most 2.5"));
        assert_eq!(range(f64::NEG_INFINITY, f64::INFINITY, number), None);
        assert_eq!(integer_range(1, i64::MAX).as_deref(), Some("at least 1"));
        assert_eq!(integer_range(1, 9).as_deref(), Some("between 1 and 9"));
    }

    #[test]
    fn quotes_are_one_short_line() {
        assert_eq!(quote("a\nb"), "`a\\nb`");
        assert_eq!(quote(&"µ".repeat(1000)).chars().count(), LONGEST_QUOTE + 3);
    }
}
