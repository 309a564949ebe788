//! What inputs that were printed rounded may be besides their middles, for stages that set something against what comes of them.
//!
//! A field with `intervals` says that what is stated in it names cells of other stages. Those stages and all that they read,
//! near or far, are looked through for numbers written as intervals, as far as their kinds are computed anew. Where there are
//! none the record stays as it is, and so do all keys. Must not know: what any field means, which kind sets what against what.

use std::collections::BTreeSet;

use super::decode::Decoder;
use super::document::{Content, Node};
use super::links::Draft;
use super::notation::{halves, middle};
use super::overrides::Stages;
use super::place::mark;
use super::quantity::interval::Interval;
use super::words::quote;
use crate::stage::Kind;
use declare::error::{Diagnostic, Place};
use declare::record::varied::{INTERVALS, Slot, Stage, Varied};
use declare::record::{PlacedValue, Record, Value};

/// A stage that is named, or read by one that is.
struct Link {
    name: String,
    kind: &'static Kind,
    /// Its intervals stand at marks. None of a stage whose kind is not computed anew.
    record: Option<Record>,
    intervals: Vec<Interval>,
    /// The stages that it refers to.
    reads: Vec<String>,
}

/// A record of a kind with the intervals of the inputs of all that it is set against, if there are any. What is wrong with other
/// stages is told where they are read.
pub fn with_intervals(mut record: Record, kind: &'static Kind, stages: Stages) -> Record {
    let asks = || kind.fields.iter().filter(|field| !field.intervals.is_empty());
    if asks().next().is_none() || !stages.pairs.iter().any(|pair| may_have_one(&pair.node)) {
        return record;
    }
    let mut links = Vec::new();
    for field in asks() {
        let Some(entry) = record.entry(field.name) else { continue };
        let mut named = BTreeSet::new();
        gather(&entry.value, stages, &mut named);
        for name in named {
            if link(stages, name, field.intervals, &mut Vec::new(), &mut links).is_err() {
                return record;
            }
        }
    }
    let varied = varied(links);
    if !varied.axes.is_empty() {
        let place = record.place;
        record.fields.push((INTERVALS, PlacedValue { value: Value::Varied(varied), place }));
    }
    record
}

/// That the widths of some intervals change no result: those of stages that no stage is set against. None where there are none.
/// An interval of several stages, by an alias, has an effect if it has one in any of them.
pub fn without_effect(drafts: &[Draft]) -> Option<Diagnostic> {
    let records = drafts.iter().filter_map(|draft| draft.record.as_ref());
    let used: Vec<Place> =
        records.filter_map(Varied::intervals).flat_map(|varied| &varied.axes).map(|axis| axis.values_place).collect();
    let mut idle: Vec<(&Draft, &Interval)> = Vec::new();
    for (draft, interval) in
        drafts.iter().flat_map(|draft| draft.intervals.iter().map(move |interval| (draft, interval)))
    {
        if !used.contains(&interval.place) && idle.iter().all(|(_, other)| other.place != interval.place) {
            idle.push((draft, interval));
        }
    }
    let (first, others) = idle.split_first()?;
    let (draft, interval) = first;
    let slot = draft.record.as_ref().and_then(|record| Some(Slot::of_place(record, interval.place)?.path(record)));
    let field = format!("{}{}", draft.name, slot.unwrap_or_default());
    let (of_middle, half) = (middle(&interval.text)?, halves(&interval.text)?.1);
    let more = match others {
        [] => String::new(),
        [(_, only)] => format!("; the same is true of the interval in line {}", only.place.line),
        others => {
            let lines: Vec<String> = others.iter().map(|(_, other)| other.place.line.to_string()).collect();
            format!("; the same is true of the intervals in lines {}", lines.join(", "))
        }
    };
    let message = format!(
        "{} is {}: an interval is an input that was printed rounded, not a tolerance. It is computed with {}, and no report sets \
         anything against it, so that {} changes no result{more}",
        quote(&field),
        quote(&interval.text),
        quote(&of_middle),
        quote(&format!("± {half}"))
    );
    let help = format!("a tolerance is stated in a stage of kind `scatter`: `{{ field: {field}, within: ± {half} }}`");
    Some(Diagnostic::new(message).at(interval.place).help(help))
}

/// Whether a tree has a text that looks like an interval; most studies have none, and nothing of theirs is read twice.
fn may_have_one(node: &Node) -> bool {
    match &node.content {
        Content::Scalar { text, .. } => halves(text).is_some(),
        Content::Sequence(items) => items.iter().any(may_have_one),
        Content::Mapping(pairs) => pairs.iter().any(|pair| may_have_one(&pair.node)),
    }
}

/// The stages that texts of a value name: with which they begin, `stage.table[gear=pinion].column`, or, in a formula, `stage.table.column`.
fn gather<'s>(value: &Value, stages: Stages<'s>, named: &mut BTreeSet<&'s str>) {
    match value {
        Value::Text(text) => {
            let first = text.trim().split_once('.').map(|(first, _)| first);
            let words = text.split(|character: char| !(character.is_alphanumeric() || "_.-".contains(character)));
            let cells = words.filter(|word| word.matches('.').count() > 1).filter_map(|word| word.split_once('.'));
            // In front of a name there may be a minus.
            let in_formula =
                cells.flat_map(|(stage, _)| stage.match_indices('-').map(|(at, _)| &stage[at + 1..]).chain([stage]));
            for name in in_formula.chain(first) {
                named.extend(stages.pairs.iter().map(|pair| pair.key.as_str()).find(|key| *key == name));
            }
        }
        Value::List(entries) => entries.iter().for_each(|entry| gather(&entry.value, stages, named)),
        Value::Map(entries) => entries.iter().for_each(|(_, entry)| gather(&entry.value, stages, named)),
        other => {
            let fields = other.record().into_iter().flat_map(|record| &record.fields);
            fields.for_each(|(_, entry)| gather(&entry.value, stages, named));
        }
    }
}

/// Gathers a stage after all that it reads; those of these kinds are computed anew. `open` are those that are being gathered.
fn link(
    stages: Stages,
    name: &str,
    kinds: &[&str],
    open: &mut Vec<String>,
    links: &mut Vec<Link>,
) -> Result<(), Diagnostic> {
    // Stages that read each other in a circle are told of when all are known.
    if open.iter().any(|other| other == name) || links.iter().any(|link| link.name == name) {
        return Ok(());
    }
    let Some(pair) = stages.pairs.iter().find(|pair| pair.key == name) else { return Ok(()) };
    let place = pair.place;
    let Ok((kind, stage)) = stages.any(name, place) else { return Ok(()) };
    let is_anew = kinds.contains(&kind.name);
    open.push(name.to_owned());
    let mut decoder = Decoder::new("where an optimiser chooses", if is_anew { Stages::default() } else { stages });
    decoder.marks_intervals = is_anew;
    let record = decoder.record(&stage.node, kind.fields, &["kind"], &quote(name), stage.place)?;
    let record = is_anew.then_some(record);
    let (references, intervals) = (decoder.references, decoder.intervals);
    for reference in &references {
        link(stages, &reference.stage, kinds, open, links)?;
    }
    open.pop();
    let reads = references.into_iter().map(|reference| reference.stage).collect();
    links.push(Link { name: name.to_owned(), kind, record, intervals, reads });
    Ok(())
}

/// The stages that have an interval and those that read one of them, each after all that it reads, and the intervals.
fn varied(links: Vec<Link>) -> Varied {
    let mut found = Varied::default();
    let mut kept: Vec<(Link, Record)> = Vec::new();
    for mut link in links {
        let is_kept = |read: &String| kept.iter().any(|(other, _)| other.name == *read) || found.held.contains(read);
        if link.intervals.is_empty() && !link.reads.iter().any(is_kept) {
            continue;
        }
        match link.record.take() {
            Some(record) => kept.push((link, record)),
            None => found.held.push(link.name),
        }
    }
    let names: Vec<String> = kept.iter().map(|(link, _)| link.name.clone()).collect();
    for (index, (Link { name, kind, intervals, reads, .. }, mut record)) in kept.into_iter().enumerate() {
        let axes = intervals.iter().enumerate();
        found.axes.extend(axes.filter_map(|(at, interval)| interval.axis(&name, index, &mut record, mark(at))));
        found.stages.push(Stage {
            name,
            kind: kind.name,
            record: record.clone(),
            filled: record,
            reads: reads.iter().map(|read| names.iter().position(|name| name == read)).collect(),
        });
    }
    found
}
