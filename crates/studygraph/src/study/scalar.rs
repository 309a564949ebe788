//! Scalars of a study: the text of one, and whole numbers.
//!
//! Must not know: what is counted.

use super::document::{Content, Node};
use super::notation;
use super::words::{self, alternatives, quote};
use declare::error::Diagnostic;
use declare::parameter::Shape;
use declare::units::{parse_unit, split_quantity};

/// A value of another shape than that of the field called `name`.
pub fn not_a(name: &str, node: &Node, shape: &Shape) -> Diagnostic {
    let message = format!("{} is {}; {} is expected", quote(name), node.describe(), words::expected(shape, None));
    Diagnostic::new(message).at(node.place)
}

/// The text of the field called `name`.
///
/// # Errors
/// A list or a mapping.
pub fn scalar<'n>(name: &str, node: &'n Node, shape: &Shape) -> Result<&'n str, Diagnostic> {
    match &node.content {
        Content::Scalar { text, .. } => Ok(text),
        _ => Err(not_a(name, node, shape)),
    }
}

/// Reads a whole number of a field called `name`, within its bounds.
///
/// # Errors
/// What is no whole number, or outside its bounds, and what to write instead.
pub fn integer(
    name: &str,
    node: &Node,
    shape: &Shape,
    (minimum, maximum): (i64, i64),
    multiple: i64,
) -> Result<i64, Diagnostic> {
    let text = scalar(name, node, shape)?;
    let shown = quote(text);
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    let other = notation::help(text);
    if node.plain().is_none() || other.is_some() || !is_digits(digits) {
        let (number, unit) = split_quantity(text);
        let has_unit = !number.is_empty() && !unit.is_empty() && parse_unit(unit).is_ok();
        let how = match node.plain() {
            None => "without quotes",
            Some(_) if has_unit && other.is_none() => "without a unit",
            Some(_) => "in digits",
        };
        let wrong =
            Diagnostic::new(format!("{} must be a whole number {how}, not {shown}", quote(name))).at(node.place);
        if let Some(help) = other {
            return Err(wrong.help(help));
        }
        // Only where all of the text is understood is it known which number is meant.
        let whole = number.parse::<f64>().ok().filter(|_| unit.is_empty());
        let whole = whole.filter(|value| value.fract() == 0.0 && value.abs() < 1e15);
        return Err(match whole {
            Some(value) => wrong.help(format!("write `{value}`")),
            None if has_unit => wrong.help(format!("a quantity in {} is another quantity, no count", quote(unit))),
            None => wrong,
        });
    }
    let read = text.parse::<i64>();
    if let Ok(value) = read
        && (minimum..=maximum).contains(&value)
        && value % multiple == 0
    {
        return Ok(value);
    }
    // A number that no computer word holds needs both bounds said, even where they are those of the word.
    let admissible = words::integer_range(minimum, maximum).filter(|_| read.is_ok());
    let admissible = admissible.unwrap_or_else(|| format!("between {minimum} and {maximum}"));
    if multiple == 1 {
        return Err(Diagnostic::new(format!("{} must be {admissible}, not {shown}", quote(name))).at(node.place));
    }
    let message = format!("{} must be {} {admissible}, not {shown}", quote(name), words::integer(multiple));
    let wrong = Diagnostic::new(message).at(node.place);
    let Ok(value) = read else { return Err(wrong) };
    let below = value.clamp(minimum, maximum).div_euclid(multiple) * multiple;
    let nearest = if below < value && below < maximum { vec![below, below + multiple] } else { vec![below] };
    let nearest: Vec<String> = nearest.iter().map(i64::to_string).collect();
    Err(wrong.help(format!("write {}", alternatives(nearest.iter().map(String::as_str)))))
}

fn is_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}
