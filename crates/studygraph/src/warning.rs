//! What a stage says of its result besides its tables: a sentence, or one of many cases that are told as one.
//!
//! A stage may be computed in parts, and each says only what it knows. Cases about the same thing become one sentence, that of
//! the worst, with how many others there are and where: so a user reads one line, however many parts there were. Must not know:
//! stages, where it is shown.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

/// Begins a text that is kept of cases; no sentence begins with it.
const CASES: &str = "\u{1f}";
/// So many names are told.
const NAMED: usize = 4;

/// What a user should know about a result.
/// Kept as a text, which every format of the cache has.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub enum Warning {
    /// A sentence by itself.
    Alone(String),
    /// One case of many, or many of them.
    Cases(Cases),
}

impl Warning {
    /// Whether it becomes one with others.
    #[must_use]
    pub fn is_of_cases(&self) -> bool {
        matches!(self, Self::Cases(_))
    }

    /// Of two about the same thing the worse one.
    #[must_use]
    pub fn worse(self, other: Self) -> Self {
        match (&self, &other) {
            (Self::Cases(one), Self::Cases(two)) if two.worst.size > one.worst.size => other,
            _ => self,
        }
    }

    /// Whether it is of cases about this.
    #[must_use]
    pub fn is_about(&self, about: &str) -> bool {
        matches!(self, Self::Cases(cases) if cases.about == about)
    }
}

impl From<String> for Warning {
    fn from(text: String) -> Self {
        let cases = text.strip_prefix(CASES).and_then(|json| serde_json::from_str(json).ok());
        cases.map_or(Self::Alone(text), Self::Cases)
    }
}

impl From<Warning> for String {
    fn from(warning: Warning) -> Self {
        match warning {
            Warning::Alone(sentence) => sentence,
            // Texts and numbers that are finite are always JSON.
            Warning::Cases(cases) => {
                serde_json::to_string(&cases).map_or_else(|_| cases.sentence(), |json| CASES.to_owned() + &json)
            }
        }
    }
}

/// Cases that are told as one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cases {
    /// Those of a stage that have the same here are one.
    about: String,
    worst: Measured,
    /// What is largest of all by another measure than the worst.
    most: Option<Measured>,
    count: usize,
    /// The first ones.
    names: BTreeSet<String>,
    /// Least and largest value of what they are at.
    range: [f64; 2],
    unit: String,
    /// Where each can be looked up.
    each: String,
}

/// Words with a measure by which they are chosen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Measured {
    size: f64,
    words: String,
}

impl Measured {
    /// Of two that are equal the one with the lesser words, so that their order does not matter.
    fn larger(self, other: Self) -> Self {
        let order = self.size.total_cmp(&other.size).then_with(|| other.words.cmp(&self.words));
        if order.is_lt() { other } else { self }
    }
}

impl Cases {
    /// One case: a sentence, chosen where its `size` is the largest.
    #[must_use]
    pub fn one(about: &str, name: &str, (at, unit): (f64, &str), (size, sentence): (f64, String)) -> Self {
        // No text has infinity.
        let size = size.clamp(-f64::MAX, f64::MAX);
        Self {
            about: about.to_owned(),
            worst: Measured { size, words: sentence },
            most: None,
            count: 1,
            names: BTreeSet::from([name.to_owned()]),
            range: [at, at],
            unit: unit.to_owned(),
            each: String::new(),
        }
    }

    /// With what is told of the one case where `size` is the largest, beside the worst one.
    #[must_use]
    pub fn with_most(self, size: f64, words: String) -> Self {
        Self { most: Some(Measured { size: size.clamp(-f64::MAX, f64::MAX), words }), ..self }
    }

    /// With where each of them can be looked up.
    #[must_use]
    pub fn with_each(self, each: &str) -> Self {
        Self { each: each.to_owned(), ..self }
    }

    fn and(self, other: Self) -> Self {
        let most = match (self.most, other.most) {
            (Some(one), Some(two)) => Some(one.larger(two)),
            (one, two) => one.or(two),
        };
        Self {
            worst: self.worst.larger(other.worst),
            most,
            count: self.count + other.count,
            names: self.names.into_iter().chain(other.names).collect::<BTreeSet<_>>().into_iter().take(NAMED).collect(),
            range: [self.range[0].min(other.range[0]), self.range[1].max(other.range[1])],
            ..self
        }
    }

    fn sentence(&self) -> String {
        let Self { worst, most, count, names, range: [from, to], unit, each, .. } = self;
        if *count == 1 {
            return worst.words.clone();
        }
        // How many names there are beyond those is not known.
        let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        let more = if names.len() == NAMED { " …" } else { "" };
        let at = if from < to { format!("{from} to {to} {unit}") } else { format!("{from} {unit}") };
        let most = match most {
            Some(most) if !worst.words.contains(&most.words) => format!("; at most {}", most.words),
            _ => String::new(),
        };
        let each = if each.is_empty() { String::new() } else { format!("; {each} has each") };
        format!("{}. This is the worst of {count}: {}{more} at {at}{most}{each}", worst.words, quoted.join(", "))
    }
}

/// All of them, cases about the same thing put together: the same however they were divided, and in whatever order.
#[must_use]
pub fn gathered(all: impl IntoIterator<Item = Warning>) -> Vec<Warning> {
    let mut alone = BTreeSet::new();
    let mut cases: BTreeMap<String, Cases> = BTreeMap::new();
    for warning in all {
        match warning {
            Warning::Alone(sentence) => {
                alone.insert(sentence);
            }
            Warning::Cases(more) => {
                let together = match cases.remove(&more.about) {
                    Some(before) => before.and(more),
                    None => more,
                };
                cases.insert(together.about.clone(), together);
            }
        }
    }
    alone.into_iter().map(Warning::Alone).chain(cases.into_values().map(Warning::Cases)).collect()
}

/// What is said of all of them, in order.
#[must_use]
pub fn sentences(all: impl IntoIterator<Item = Warning>) -> Vec<String> {
    let mut told: Vec<String> = gathered(all)
        .into_iter()
        .map(|warning| match warning {
            Warning::Alone(sentence) => sentence,
            Warning::Cases(cases) => cases.sentence(),
        })
        .collect();
    told.sort();
    told
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(name: &str, at: f64, size: f64, most: f64) -> Warning {
        let sentence = format!("`{name}` at {at} N m is off by {size} %");
        let one = Cases::one("off", name, (at, "N m"), (size, sentence));
        Warning::Cases(one.with_most(most, format!("{most} um with `{name}`")).with_each("`table`"))
    }

    #[test]
    fn one_case_is_its_sentence() {
        assert_eq!(sentences([case("a", 5.0, 3.0, 1.0)]), ["`a` at 5 N m is off by 3 %"]);
        assert_eq!(sentences(["b".to_owned(), "a".to_owned(), "b".to_owned()].map(Warning::from)), ["a", "b"]);
    }

    /// Tier: invariant; any division into parts, in any order, and through text, says the same.
    #[test]
    fn many_cases_are_one_sentence_however_they_are_divided() {
        let all: Vec<Warning> = (0..30)
            .map(|index: u32| {
                let (name, at) = (["a", "b", "c", "d", "e"][index as usize % 5], f64::from(index / 5) * 10.0 + 5.0);
                case(name, at, f64::from(index * 7 % 30), f64::from(index * 11 % 30))
            })
            .chain([Warning::Alone("alone".to_owned())])
            .collect();
        let told = sentences(all.clone());
        let [worst, alone] = &told[..] else { panic!("{told:?}") };
        assert_eq!(alone, "alone");
        // 7 · 17 is 29 of 30, and 11 · 19.
        assert_eq!(
            worst,
            "`c` at 35 N m is off by 29 %. This is the worst of 30: `a`, `b`, `c`, `d` … at 5 to 55 N m; at most 29 um with `e`; \
             `table` has each"
        );
        for parts in [2, 3, 7] {
            let mut divided: Vec<Warning> = all.chunks(parts).flat_map(|part| gathered(part.to_vec())).collect();
            divided.reverse();
            let text = serde_json::to_string(&divided).unwrap();
            let read: Vec<Warning> = serde_json::from_str(&text).unwrap();
            assert_eq!(sentences(read), told, "{parts}");
        }
    }

    #[test]
    fn cases_about_other_things_stay_apart() {
        let other = Warning::Cases(Cases::one("other", "a", (5.0, "N m"), (f64::INFINITY, "else".to_owned())));
        assert_eq!(sentences([case("a", 5.0, 3.0, 1.0), other]), ["`a` at 5 N m is off by 3 %", "else"]);
    }

    /// Cases come back to the last bit from the formats of the cache, one of which knows no types.
    #[test]
    fn cases_are_kept_in_every_format() {
        for size in [0.1, 1.0 / 3.0, 1e-300, -f64::MAX, 5e-324] {
            let all = [case("a", size, size, size), Warning::Alone("alone".to_owned())];
            let bytes = postcard::to_allocvec(&all).unwrap();
            assert_eq!(postcard::from_bytes::<[Warning; 2]>(&bytes).unwrap(), all);
            let text = serde_json::to_string(&all).unwrap();
            assert_eq!(serde_json::from_str::<[Warning; 2]>(&text).unwrap(), all);
        }
    }

    /// What was kept before there were cases is read.
    #[test]
    fn texts_are_warnings() {
        let read: Vec<Warning> = serde_json::from_str(r#"["careful"]"#).unwrap();
        assert_eq!(read, [Warning::Alone("careful".to_owned())]);
    }
}
