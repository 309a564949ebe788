//! A name that is no field: the nearest one, what others call a field, and the other half of a number with a comma.
//!
//! Must not know: what any field means.

use super::around;
use super::document::{Content, KeyValue, Node};
use super::notation::{self, halves};
use super::overrides::Stages;
use super::whereabouts::{self, Counted};
use super::words::{alternatives, quote};
use crate::program::Foreign;
use declare::error::{Diagnostic, Place, suggest, suggest_for_field};
use declare::parameter::Field;

/// A mapping with keys that are no fields of it.
pub struct Mapping<'a> {
    pub pairs: &'a [KeyValue],
    /// The keys that are read.
    pub known: &'a [&'a str],
    /// Those of them that are fields.
    pub fields: &'static [Field],
    pub label: &'a str,
    pub stages: Stages<'a>,
    /// Distance of a number from the usual one of a field, by the name of the field.
    pub distance: &'a dyn Fn(&str, &str) -> f64,
    /// The message of a field, by its name, for a value that it does not take.
    pub refused: &'a dyn Fn(&str, &Node) -> Option<Diagnostic>,
}

impl<'a> Mapping<'a> {
    /// Of keys that no declaration has.
    pub fn plain(
        pairs: &'a [KeyValue],
        known: &'a [&'a str],
        label: &'a str,
        distance: &'a dyn Fn(&str, &str) -> f64,
    ) -> Self {
        Self { pairs, known, fields: &[], label, stages: Stages::default(), distance, refused: &|_, _| None }
    }

    /// Messages of all keys that are not known.
    pub fn unknown(&self) -> Vec<Diagnostic> {
        let Self { pairs, known, label, .. } = *self;
        let mut wrong = Vec::new();
        let mut told = 0;
        for (at, pair) in pairs.iter().enumerate().filter(|(_, pair)| !known.contains(&pair.key.as_str())) {
            if at < told {
                continue;
            }
            let comma = at.checked_sub(1).and_then(|before| self.with_commas(&pairs[before], &pairs[at..]));
            if let Some((found, keys)) = comma {
                told = at + keys;
                wrong.push(found);
                continue;
            }
            let message = format!("unknown field {} of {label}", quote(&pair.key));
            let help = self.called(pair).or_else(|| without_space(pair, known)).unwrap_or_else(|| {
                let names = known.iter().copied();
                let help = if whereabouts::is_known(&pair.key, self.stages.kinds) {
                    suggest_for_field(&pair.key, names)
                } else {
                    suggest(&pair.key, names)
                };
                match self.elsewhere(&pair.key) {
                    Some(lead) if !help.starts_with("did you mean") => format!("{lead}; {help}"),
                    _ => help,
                }
            });
            wrong.push(Diagnostic::new(message).at(pair.place).help(help));
        }
        wrong
    }

    /// `{ amount: 0,012 mm }` is `amount: 0` and a key `012 mm` to YAML. How many keys are parts of the number is told with it.
    fn with_commas(&self, before: &KeyValue, rest: &[KeyValue]) -> Option<(Diagnostic, usize)> {
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
        // A length where a number counts in one: what to write says its field.
        let node = Node { content: Content::Scalar { text: text.clone(), quoted: false }, place };
        let counted =
            (self.refused)(&before.key, &node).and_then(|found| found.help).filter(|help| help.contains("counts in"));
        let help = counted.or_else(|| notation::without_commas(&text, &|text| (self.distance)(&before.key, text)));
        Some((if let Some(help) = help { found.help(help) } else { found }, keys))
    }

    /// The field for the word of others in `pair`, and the remedy for its value; or why there is no such field anywhere.
    fn called(&self, pair: &KeyValue) -> Option<String> {
        let is_known = |field: &str| self.known.contains(&field);
        let other = meant(&pair.key, self.label, self.stages.foreign).find(|other| other.field.is_none_or(is_known))?;
        let said = described(other);
        let of_word = other.remedy.and_then(|remedy| around::remedied(remedy, &pair.node, self.pairs, self.stages));
        let refused = || (self.refused)(other.field.filter(|_| !other.is_other)?, &pair.node);
        let remedy = match other.remedy {
            Some(_) => of_word,
            None => refused().map(|found| found.help.unwrap_or(found.message)),
        };
        Some(remedy.map_or_else(|| said.clone(), |remedy| format!("{said}; {remedy}")))
    }

    /// Where a study has a field of this name, or of that by which it calls this word of others.
    fn elsewhere(&self, word: &str) -> Option<String> {
        let place = |name: &str, counted| whereabouts::place(name, self.fields, self.stages.kinds, counted);
        if let Some(place) = place(word, Counted::Telling) {
            return Some(format!("{} belongs in {place}", quote(word)));
        }
        matching(word, self.stages.foreign).find_map(|other| {
            let field = other.field?;
            let place = match other.inside {
                [] => place(field, Counted::All),
                inside => Some(alternatives(inside.iter().copied())),
            };
            let place = place.unwrap_or_else(|| "another place".to_owned());
            Some(if other.is_other {
                format!("a study states `{field}` instead, in {place}: {}", other.remark)
            } else {
                format!("a study calls it `{field}`, in {place}")
            })
        })
    }
}

/// The name among `known` that a word of others stands for; none where it is not one of these words.
pub fn called_among<'a>(
    word: &str,
    label: &str,
    known: &(impl Iterator<Item = &'a str> + Clone),
    foreign: &[&'static [Foreign]],
) -> Option<String> {
    let is_known = |field: &str| known.clone().any(|name| name == field);
    meant(word, label, foreign).find(|other| other.field.is_some_and(is_known)).map(described)
}

fn described(other: &Foreign) -> String {
    match other.field {
        Some(field) if other.remark.is_empty() => format!("here it is called `{field}`"),
        Some(field) if other.is_other => format!("state `{field}` instead: {}", other.remark),
        Some(field) => format!("here it is called `{field}`: {}", other.remark),
        None => other.remark.to_owned(),
    }
}

/// Entries of a word, those that are written like it first.
fn matching<'a>(word: &str, foreign: &'a [&'static [Foreign]]) -> impl Iterator<Item = &'a Foreign> + use<'a> {
    let all = || foreign.iter().copied().flatten();
    let same = word.to_owned();
    let (alike, exact) = (folded(word), word.to_owned());
    let first = all().filter(move |other| other.word.eq_ignore_ascii_case(&same));
    let then = all().filter(move |other| folded(other.word) == alike && !other.word.eq_ignore_ascii_case(&exact));
    first.chain(then)
}

/// Entries of a word in the mapping called `label`.
fn meant<'a>(
    word: &str,
    label: &str,
    foreign: &'a [&'static [Foreign]],
) -> impl Iterator<Item = &'a Foreign> + use<'a> {
    let label = label.trim_matches('`').to_owned();
    matching(word, foreign).filter(move |other| other.inside.is_empty() || other.inside.contains(&label.as_str()))
}

/// A word without what differs between writers: case, signs between its parts, and the spelling of umlauts.
fn folded(word: &str) -> String {
    let mut text = String::new();
    for letter in word.chars().flat_map(char::to_lowercase).filter(|letter| letter.is_alphanumeric()) {
        match letter {
            'ä' => text.push_str("ae"),
            'ö' => text.push_str("oe"),
            'ü' => text.push_str("ue"),
            'ß' => text.push_str("ss"),
            _ => text.push(letter),
        }
    }
    text
}

/// `{ teeth:24 }` is a key `teeth:24` to YAML.
fn without_space(pair: &KeyValue, known: &[&str]) -> Option<String> {
    let (name, value) = pair.key.split_once(':').filter(|(name, _)| known.contains(name) && pair.node.is_null())?;
    Some(format!("a space is missing behind the `:`; write {}", quote(&format!("{name}: {value}"))))
}

/// Whether this can stand behind the digits of a number: nothing, its unit, or the other half of an interval.
fn is_number_s(rest: &str) -> bool {
    rest.is_empty()
        || rest.starts_with(char::is_whitespace)
        || halves(rest).is_some_and(|(before, _)| before.is_empty())
}
