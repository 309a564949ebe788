//! Why a stage is not what it was: what differs in the records its keys were made from.
//!
//! Must not know: how keys are made.

use serde_json::Value as Json;

use super::model::{ChangedPart, Reason};
use super::source;
use crate::store::manifest::{KeyRecord, Manifest, Program, Short, StageRecord};

/// Places within one field that are told apart; of a field that differs in more only their number is said.
const MOST_PLACES: usize = 6;

/// What differs between two stages of one name in two runs.
#[must_use]
pub fn reasons(before: (&Manifest, &StageRecord), after: (&Manifest, &StageRecord)) -> Vec<Reason> {
    let ((old_run, old), (new_run, new)) = (before, after);
    let mut why = Vec::new();
    for (stage, is_new) in [(old, false), (new, true)] {
        if !stage.is_complete() && (is_new || new.is_complete()) {
            let text = Some(format!("{}: {}", stage.status, stage.why));
            let (before, after) = if is_new { (None, text) } else { (text, None) };
            why.push(Reason { part: ChangedPart::Status, what: String::new(), from: Vec::new(), before, after });
        }
    }
    if (&old.kind, old.version) != (&new.kind, new.version) {
        let named = |stage: &StageRecord| Some(format!("{} {}", stage.kind, stage.version));
        why.push(Reason {
            part: ChangedPart::Kind,
            what: String::new(),
            from: Vec::new(),
            before: named(old),
            after: named(new),
        });
    }
    let (Some(first), Some(second)) = (old.keys.first(), new.keys.first()) else { return why };
    if old.kind == new.kind {
        let (was, is) = (old.config.value(), new.config.value());
        for name in differing(&first.fields, &second.fields) {
            why.extend(config(&name, was.get(&name), is.get(&name)));
        }
        let axes = |stage: &StageRecord| stage.keys.iter().map(|key| key.axis).collect::<Vec<_>>();
        if axes(old) != axes(new) {
            let axis = axis(&was, first).or_else(|| axis(&is, second));
            let [before, after] = [&was, &is].map(|fields| axis.as_ref().and_then(|name| fields.get(name)));
            why.extend(config(axis.as_deref().unwrap_or("axis"), before, after));
        }
        if first.config != second.config && why.is_empty() {
            why.push(Reason {
                part: ChangedPart::Config,
                what: String::new(),
                from: Vec::new(),
                before: None,
                after: None,
            });
        }
    }
    for port in differing(&first.inputs, &second.inputs) {
        let there = |key: &KeyRecord| key.inputs.iter().any(|(name, _)| *name == port);
        let only = |one, other| (there(one) && !there(other)).then(|| "read".to_owned());
        let from = source::tables((old_run, old), (new_run, new), &port);
        let (before, after) = (only(first, second), only(second, first));
        why.push(Reason { part: ChangedPart::Input, from, before, after, what: port });
    }
    if first.seed != second.seed {
        let seed = |key: &KeyRecord, run: &Manifest| key.seed.map(|_| run.seed.to_string());
        why.push(Reason {
            part: ChangedPart::Seed,
            what: String::new(),
            from: Vec::new(),
            before: seed(first, old_run),
            after: seed(second, new_run),
        });
    }
    if first.code != second.code {
        let (old, new) = (&old_run.program, &new_run.program);
        let (before, after) = if program(old) == program(new) && old.code != new.code {
            // Two builds of one commit and its uncommitted changes.
            let code = |of: &Program| Some(format!("{}, code {:.7}", program(of), of.code));
            (code(old), code(new))
        } else {
            (Some(program(old)), Some(program(new)))
        };
        let (before, after) = if before == after { (None, None) } else { (before, after) };
        why.push(Reason { part: ChangedPart::Code, what: String::new(), from: Vec::new(), before, after });
    }
    if first.demand != second.demand {
        why.push(Reason {
            part: ChangedPart::Demand,
            what: String::new(),
            from: Vec::new(),
            before: None,
            after: None,
        });
    }
    why
}

/// When the same key gave another content: what else is known of the two runs.
#[must_use]
pub fn unknown(before: &Manifest, after: &Manifest) -> Reason {
    let facts = |run: &Manifest| {
        // Some systems do not name their processor.
        let processor = Some(&run.machine.processor).filter(|name| !name.is_empty() && *name != "unknown");
        let parts: Vec<String> = processor.cloned().into_iter().chain([program(&run.program)]).collect();
        parts.join("; ")
    };
    let what = "the same key gave other values".to_owned();
    let (before, after) = (facts(before), facts(after));
    let (before, after) = if before == after { (None, None) } else { (Some(before), Some(after)) };
    Reason { part: ChangedPart::Unknown, what, from: Vec::new(), before, after }
}

fn program(program: &Program) -> String {
    let commit = program.commit.as_ref().map(|commit| {
        let short: String = commit.chars().take(7).collect();
        let changes = if program.uncommitted_changes == Some(true) { " with uncommitted changes" } else { "" };
        format!(" at {short}{changes}")
    });
    format!("gearstudy {}{}", program.version, commit.unwrap_or_default())
}

/// Names whose digest differs, or that only one has, in the order of the first.
fn differing(before: &[(String, Short)], after: &[(String, Short)]) -> Vec<String> {
    let gone_or_other = before.iter().filter(|pair| !after.contains(pair)).map(|(name, _)| name);
    let new = after.iter().map(|(name, _)| name).filter(|name| !before.iter().any(|(old, _)| old == *name));
    gone_or_other.chain(new).cloned().collect()
}

/// The field along which a stage is cut: the one that is shown but has no digest of its own.
fn axis(config: &Json, key: &KeyRecord) -> Option<String> {
    key.axis?;
    let mut fields = config.as_object()?.keys();
    fields.find(|name| !key.fields.iter().any(|(field, _)| field == *name)).cloned()
}

/// From what to what a field changed, place by place.
fn config(name: &str, before: Option<&Json>, after: Option<&Json>) -> Vec<Reason> {
    let mut places = Vec::new();
    walk(name.to_owned(), before, after, &mut places);
    if places.len() > MOST_PLACES {
        let more = places.len() - MOST_PLACES;
        places.truncate(MOST_PLACES);
        places.push(Reason {
            part: ChangedPart::Config,
            what: format!("{name}: {more} more places"),
            from: Vec::new(),
            before: None,
            after: None,
        });
    }
    if places.is_empty() {
        // The manifest of an earlier version, or a difference beyond the digits that are shown.
        places.push(Reason {
            part: ChangedPart::Config,
            what: name.to_owned(),
            from: Vec::new(),
            before: None,
            after: None,
        });
    }
    places
}

fn walk(path: String, before: Option<&Json>, after: Option<&Json>, places: &mut Vec<Reason>) {
    match (before, after) {
        (before, after) if before == after => {}
        (Some(Json::Object(old)), Some(Json::Object(new))) => {
            for (name, value) in old {
                walk(format!("{path}.{name}"), Some(value), new.get(name), places);
            }
            for (name, value) in new.iter().filter(|(name, _)| !old.contains_key(*name)) {
                walk(format!("{path}.{name}"), None, Some(value), places);
            }
        }
        (Some(Json::Array(old)), Some(Json::Array(new))) => lists(&path, old, new, places),
        (before, after) => {
            let text = |value: Option<&Json>| value.map(words);
            places.push(Reason {
                part: ChangedPart::Config,
                what: path,
                from: Vec::new(),
                before: text(before),
                after: text(after),
            });
        }
    }
}

fn lists(path: &str, old: &[Json], new: &[Json], places: &mut Vec<Reason>) {
    let plain = |list: &[Json]| list.iter().all(|item| !item.is_object() && !item.is_array());
    if plain(old) && plain(new) {
        // Of a list of values, those that came and went.
        let only = |of: &[Json], not_in: &[Json]| {
            let items: Vec<String> = of.iter().filter(|item| !not_in.contains(item)).map(words).collect();
            (!items.is_empty()).then(|| items.join(", "))
        };
        let (before, after) = match (only(old, new), only(new, old)) {
            (None, None) => (Some(words(&Json::Array(old.to_vec()))), Some(words(&Json::Array(new.to_vec())))),
            other => other,
        };
        places.push(Reason { part: ChangedPart::Config, what: path.to_owned(), from: Vec::new(), before, after });
        return;
    }
    // Items that have a name or a label are found by it, others by their place.
    let named = |item: &Json| ["label", "name"].iter().find_map(|key| Some(item.get(key)?.as_str()?.to_owned()));
    let distinct = |list: &[Json]| {
        let mut names: Vec<_> = list.iter().map(named).collect();
        names.sort();
        names.windows(2).all(|pair| pair[0] != pair[1]) && names.iter().all(Option::is_some)
    };
    if distinct(old) && distinct(new) {
        let find = |list: &'_ [Json], name: &Option<String>| list.iter().position(|item| named(item) == *name);
        for item in old {
            let name = named(item);
            let there = find(new, &name).map(|at| &new[at]);
            walk(format!("{path}[{}]", name.unwrap_or_default()), Some(item), there, places);
        }
        for item in new.iter().filter(|item| find(old, &named(item)).is_none()) {
            walk(format!("{path}[{}]", named(item).unwrap_or_default()), None, Some(item), places);
        }
        return;
    }
    for index in 0..old.len().max(new.len()) {
        walk(format!("{path}[{}]", index + 1), old.get(index), new.get(index), places);
    }
}

/// A value as it would be written in a study.
fn words(value: &Json) -> String {
    match value {
        Json::String(text) => text.clone(),
        Json::Array(items) => format!("[{}]", items.iter().map(words).collect::<Vec<_>>().join(", ")),
        Json::Object(fields) => {
            let one = |(name, value): (&String, &Json)| format!("{name}: {}", words(value));
            format!("{{ {} }}", fields.iter().map(one).collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}
