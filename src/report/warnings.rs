//! Warnings of a run as the page tells them: by stage, a few of each in sight, numbers in their order.
//!
//! Must not know: HTML.

use std::cmp::Ordering;

use serde::Serialize;

/// Warnings of a stage that are told without being asked for.
const TOLD: usize = 3;

/// What a stage warns of.
#[derive(Debug, PartialEq, Serialize)]
pub struct Warned {
    pub stage: String,
    pub told: Vec<String>,
    pub more: Vec<String>,
}

/// The stages that warn, in their order; each with its name.
pub fn warned<'a>(stages: impl Iterator<Item = (&'a str, &'a [String])>) -> Vec<Warned> {
    let of = |(stage, warnings): (&str, &[String])| {
        let mut told = warnings.to_vec();
        told.sort_by(|a, b| natural(a, b));
        // One more takes no more room than to say that there is one.
        let more = if told.len() > TOLD + 1 { told.split_off(TOLD) } else { Vec::new() };
        Warned { stage: stage.to_owned(), told, more }
    };
    stages.filter(|(_, warnings)| !warnings.is_empty()).map(of).collect()
}

/// As a reader sorts: `at 20 N m` before `at 100 N m`.
fn natural(a: &str, b: &str) -> Ordering {
    let (mut a, mut b) = (a, b);
    loop {
        let (number, other) = (leading(a), leading(b));
        let found = match (number.parse::<f64>(), other.parse::<f64>()) {
            (Ok(one), Ok(two)) => one.total_cmp(&two).then(number.len().cmp(&other.len())),
            _ => a.chars().next().cmp(&b.chars().next()),
        };
        if found != Ordering::Equal || a.is_empty() {
            return found;
        }
        let step = number.len().max(a.chars().next().map_or(0, char::len_utf8));
        (a, b) = (&a[step..], &b[step..]);
    }
}

/// The digits at the start, and those behind a point.
fn leading(text: &str) -> &str {
    let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let whole = digits(text);
    let behind = text[whole..].strip_prefix('.').map_or(0, digits);
    if whole == 0 || behind == 0 { &text[..whole] } else { &text[..whole + 1 + behind] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_in_their_order_and_many_are_folded() {
        let at = |torque: &str| format!("design `a` at {torque} N m: 1.5 um off");
        let torques = ["100", "20", "5", "12.5", "300"].map(at);
        let found = warned([("a", &torques[..]), ("b", &[]), ("c", &torques[..4])].into_iter());
        assert_eq!(found.len(), 2, "a stage without warnings says nothing");
        assert_eq!(found[0].told, ["5", "12.5", "20"].map(at));
        assert_eq!(found[0].more, ["100", "300"].map(at));
        assert_eq!((found[1].told.len(), found[1].more.len()), (4, 0));
    }

    #[test]
    fn whatever_is_said_has_one_order() {
        let texts = ["", "a", "a.", "a.b", "a1", "a01", "a1.5", "a1.5.2", "ä", "µ 3", "µ 20", "1", "."];
        for a in texts {
            for b in texts {
                assert_eq!(natural(a, b), natural(b, a).reverse(), "{a:?} {b:?}");
                assert_eq!(natural(a, b) == Ordering::Equal, a == b, "{a:?} {b:?}");
            }
        }
    }
}
