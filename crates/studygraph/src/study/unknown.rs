//! A name that is no field: the nearest one, what others call a field, and the other half of a number with a comma.
//!
//! Must not know: what any field means.

use super::document::{Content, KeyValue};
use super::notation;
use super::words::quote;
use crate::program::Foreign;
use declare::error::{Diagnostic, Place, suggest};

/// What is wrong with every key of `pairs` that is not `known`; the mapping is called `label`.
pub fn fields(pairs: &[KeyValue], known: &[&str], label: &str, foreign: &[Foreign]) -> Vec<Diagnostic> {
    let mut wrong = Vec::new();
    for (at, pair) in pairs.iter().enumerate().filter(|(_, pair)| !known.contains(&pair.key.as_str())) {
        let before = at.checked_sub(1).map(|before| &pairs[before]);
        wrong.push(before.and_then(|before| decimal_comma(before, pair)).unwrap_or_else(|| {
            let message = format!("unknown field {} of {label}", quote(&pair.key));
            let help = called(&pair.key, known, foreign).unwrap_or_else(|| {
                let help = suggest(&pair.key, known.iter().copied());
                match elsewhere(&pair.key, foreign) {
                    Some(lead) if help.starts_with("known here") => format!("{lead}; {help}"),
                    _ => help,
                }
            });
            Diagnostic::new(message).at(pair.place).help(help)
        }));
    }
    wrong
}

/// What a word of others is called here, where a field of that name is known; or why there is no such field anywhere.
fn called(word: &str, known: &[&str], foreign: &[Foreign]) -> Option<String> {
    let same = |other: &&Foreign| other.word.eq_ignore_ascii_case(word);
    let said = |other: &Foreign| match other.field {
        Some(field) if other.remark.is_empty() => format!("here it is called `{field}`"),
        Some(field) => format!("here it is called `{field}`: {}", other.remark),
        None => other.remark.to_owned(),
    };
    let mut words = foreign.iter().filter(same);
    words.find(|other| other.field.is_none_or(|field| known.contains(&field))).map(said)
}

/// What a word of others is called where there is such a field.
fn elsewhere(word: &str, foreign: &[Foreign]) -> Option<String> {
    let mut words = foreign.iter().filter(|other| other.word.eq_ignore_ascii_case(word));
    let field = words.find_map(|other| other.field)?;
    Some(format!("a study calls it `{field}`, in another place"))
}

/// `{ amount: 0,012 mm }` is `amount: 0` and a key `012 mm` to YAML.
fn decimal_comma(before: &KeyValue, rest: &KeyValue) -> Option<Diagnostic> {
    let Content::Scalar { text: whole, quoted: false } = &before.node.content else { return None };
    let is_digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let fraction = rest.key.split_whitespace().next().filter(|digits| is_digits(digits))?;
    let follows = rest.place.offset == before.node.place.offset + before.node.place.length + 1;
    if !follows || !rest.node.is_null() || !is_digits(whole.trim_start_matches(['+', '-'])) {
        return None;
    }
    let place = Place { length: before.node.place.length + 1 + fraction.len(), ..before.node.place };
    let message = format!("{} is two values to YAML: {}", quote(&format!("{whole},{}", rest.key)), notation::COMMA);
    let unit = rest.key.strip_prefix(fraction).unwrap_or_default();
    Some(Diagnostic::new(message).at(place).help(format!("write {}", notation::with_point(whole, fraction, unit))))
}
