//! A name that is no field: the nearest one, what others call a field, and the other half of a number with a comma.
//!
//! Must not know: what any field means.

use super::document::{Content, KeyValue, Node};
use super::notation;
use super::overrides::Stages;
use super::quantity::interval::halves;
use super::words::quote;
use crate::program::{Around, Foreign};
use declare::error::{Diagnostic, Place, suggest};
use declare::units::{Quantity, foreign_quantity, parse_quantity};

/// What is wrong with every key of `pairs` that is not `known`; the mapping is called `label`.
///
/// `distance` of a field and a number is how far that is from what the field usually has.
pub fn fields(
    pairs: &[KeyValue],
    known: &[&str],
    label: &str,
    stages: Stages,
    distance: &dyn Fn(&str, &str) -> f64,
) -> Vec<Diagnostic> {
    let mut wrong = Vec::new();
    let mut told = 0;
    for (at, pair) in pairs.iter().enumerate().filter(|(_, pair)| !known.contains(&pair.key.as_str())) {
        if at < told {
            continue;
        }
        let comma = at.checked_sub(1).and_then(|before| with_commas(&pairs[before], &pairs[at..], distance));
        if let Some((found, keys)) = comma {
            told = at + keys;
            wrong.push(found);
            continue;
        }
        wrong.push({
            let message = format!("unknown field {} of {label}", quote(&pair.key));
            let help =
                called((pairs, pair), known, stages).or_else(|| without_space(pair, known)).unwrap_or_else(|| {
                    let help = suggest(&pair.key, known.iter().copied());
                    match elsewhere(&pair.key, stages.foreign) {
                        Some(lead) if help.starts_with("known here") => format!("{lead}; {help}"),
                        _ => help,
                    }
                });
            Diagnostic::new(message).at(pair.place).help(help)
        });
    }
    wrong
}

/// `{ teeth:24 }` is a key `teeth:24` to YAML.
fn without_space(pair: &KeyValue, known: &[&str]) -> Option<String> {
    let (name, value) = pair.key.split_once(':').filter(|(name, _)| known.contains(name) && pair.node.is_null())?;
    Some(format!("a space is missing behind the `:`; write {}", quote(&format!("{name}: {value}"))))
}

/// What the word of others in `pair` is called here, where a field of that name is known; or why there is no such field anywhere.
fn called((pairs, pair): (&[KeyValue], &KeyValue), known: &[&str], stages: Stages) -> Option<String> {
    let mut words = stages.foreign.iter().filter(|other| other.word.eq_ignore_ascii_case(&pair.key));
    let other = words.find(|other| other.field.is_none_or(|field| known.contains(&field)))?;
    let said = match other.field {
        Some(field) if other.remark.is_empty() => format!("here it is called `{field}`"),
        Some(field) if other.is_other => format!("state `{field}` instead: {}", other.remark),
        Some(field) => format!("here it is called `{field}`: {}", other.remark),
        None => other.remark.to_owned(),
    };
    let around = Around {
        value: number(&pair.node),
        beside: &|name| beside(pairs, name),
        anywhere: &|path| anywhere(stages.pairs, path),
    };
    let remedy = other.remedy.and_then(|remedy| remedy(&around));
    Some(remedy.map_or_else(|| said.clone(), |remedy| format!("{said}; {remedy}")))
}

/// The number of a scalar, in any unit that is known anywhere.
fn number(node: &Node) -> Option<Quantity> {
    let Content::Scalar { text, quoted: false } = &node.content else { return None };
    let foreign = || foreign_quantity(text).map(|(value, dimension)| Quantity { value, dimension, has_unit: true });
    parse_quantity(text).ok().or_else(foreign)
}

fn beside(pairs: &[KeyValue], name: &str) -> Option<Quantity> {
    pairs.iter().find(|pair| pair.key.eq_ignore_ascii_case(name)).and_then(|pair| number(&pair.node))
}

/// The number that all stages have at the end of these names, of those that have one.
fn anywhere(stages: &[KeyValue], path: &[&str]) -> Option<Quantity> {
    let of_stage = |stage: &KeyValue| {
        let mut node = &stage.node;
        for name in path {
            let Content::Mapping(pairs) = &node.content else { return None };
            node = &pairs.iter().find(|pair| pair.key == *name)?.node;
        }
        number(node)
    };
    let mut found = stages.iter().filter_map(of_stage);
    let first = found.next()?;
    found.all(|other| other == first).then_some(first)
}

/// What a word of others is called where there is such a field.
fn elsewhere(word: &str, foreign: &[Foreign]) -> Option<String> {
    let mut words = foreign.iter().filter(|other| other.word.eq_ignore_ascii_case(word));
    words.find_map(|other| {
        let field = other.field?;
        Some(if other.is_other {
            format!("a study states `{field}` instead, in another place: {}", other.remark)
        } else {
            format!("a study calls it `{field}`, in another place")
        })
    })
}

/// Whether this can stand behind the digits of a number: nothing, its unit, or the other half of an interval.
fn is_number_s(rest: &str) -> bool {
    rest.is_empty()
        || rest.starts_with(char::is_whitespace)
        || halves(rest).is_some_and(|(before, _)| before.is_empty())
}

/// `{ amount: 0,012 mm }` is `amount: 0` and a key `012 mm` to YAML. How many keys are parts of the number is told with it.
fn with_commas(
    before: &KeyValue,
    rest: &[KeyValue],
    distance: &dyn Fn(&str, &str) -> f64,
) -> Option<(Diagnostic, usize)> {
    let Content::Scalar { text: whole, quoted: false } = &before.node.content else { return None };
    let is_digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    // Behind the last sign of an interval a number may go on, as behind nothing but digits.
    let is_open = |text: &str| {
        let last = halves(text).map_or(text, |(_, behind)| behind);
        is_digits(last.trim_start_matches(['+', '-']))
    };
    if !is_open(whole) {
        return None;
    }
    let (mut text, mut length, mut keys) = (whole.clone(), before.node.place.length, 0);
    for part in rest {
        let digits = part.key.find(|c: char| !c.is_ascii_digit()).unwrap_or(part.key.len());
        let follows = part.place.offset == before.node.place.offset + length + 1;
        if !follows || !part.node.is_null() || digits == 0 || !is_number_s(&part.key[digits..]) {
            break;
        }
        text += &format!(",{}", part.key);
        // Behind a unit comes another field.
        let ends = !is_open(&part.key);
        length += 1 + if ends { digits } else { part.place.length };
        keys += 1;
        if ends {
            break;
        }
    }
    if keys == 0 {
        return None;
    }
    let place = Place { length, ..before.node.place };
    let message = format!(
        "{} is {} values to YAML: {}",
        quote(&text),
        if keys == 1 { "two" } else { "several" },
        notation::COMMA
    );
    let found = Diagnostic::new(message).at(place);
    let help = notation::without_commas(&text, &|text| distance(&before.key, text));
    Some((if let Some(help) = help { found.help(help) } else { found }, keys))
}
