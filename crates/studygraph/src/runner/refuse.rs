//! What is said of a run that would take more than it may: which stage, why, and what to write instead.
//!
//! Refused is what was foreseen, before anything runs. What would fit is found by trying: every number, choice and axis
//! of the stage that takes most, one at a time. Must not know: how it is shown; which field means what.

use super::board::Board;
use super::foresee::{Expected, Foresight, foresee};
use super::limits::Limits;
use declare::error::{Diagnostic, Place};
use declare::parameter::{Field, Shape};
use declare::record::{Record, Value};

/// Remedies that a message names at most.
const MOST_REMEDIES: usize = 3;

/// One of the two, with what it counts.
#[derive(Clone, Copy)]
enum Limited {
    Rows,
    Memory,
}

impl Limited {
    fn of(self, expected: &Expected) -> u64 {
        match self {
            Self::Rows => expected.tables.iter().fold(0, |sum, (_, rows)| sum.saturating_add(rows.count)),
            Self::Memory => expected.memory,
        }
    }

    fn shown(self, amount: u64) -> String {
        match self {
            Self::Rows => format!("{} rows", grouped(amount)),
            Self::Memory => format!("{} of memory", size(amount)),
        }
    }

    /// The option that allows as much, a little more than it must.
    fn option(self, amount: u64) -> String {
        match self {
            Self::Rows => format!("--limit-rows {amount}"),
            Self::Memory => format!("--limit-memory {}MB", amount.saturating_add(amount / 50).div_ceil(1_000_000)),
        }
    }
}

/// What is to be said where a run would take more than it may.
#[must_use]
pub fn refusal(board: &Board, foresight: &Foresight, limits: &Limits, threads: usize) -> Option<Diagnostic> {
    let memory = limits.bytes();
    let beyond = [(Limited::Rows, limits.rows), (Limited::Memory, memory)];
    let (limited, limit) = beyond.into_iter().find(|(limited, limit)| limited.of(&foresight.total) > *limit)?;
    let maximum = |node: &usize| foresight.stages[*node].as_ref().map_or(0, |stage| limited.of(stage));
    // Of several alike the first one: what reads from it follows it.
    let node = board.graph.order.iter().copied().rev().max_by_key(maximum)?;
    let of_study = &board.study.nodes[node];
    let table =
        foresight.stages[node].as_ref().and_then(|stage| stage.tables.iter().max_by_key(|(_, rows)| rows.count));
    let table = table.map_or_else(String::new, |(table, rows)| {
        format!(", for {}{} rows of its table `{table}`", rows.certainty.sign(), grouped(rows.count))
    });
    let total = limited.of(&foresight.total);
    let why = match limited {
        Limited::Memory if limits.memory.is_none() => ", half of what this machine has",
        _ => "",
    };
    let message = format!(
        "this run would take about {}, and may take {}{why}; stage `{}` takes {}{table}",
        limited.shown(total),
        limited.shown(limit),
        of_study.name,
        limited.shown(maximum(&node)),
    );
    let remedied = above(board, node).into_iter().find_map(|near| {
        let fits = |record: &Record| limited.of(&foresee(board, threads, Some((near, record))).total) <= limit;
        let found = remedies(board, near, &fits);
        (!found.is_empty()).then_some((near, found))
    });
    let option = format!("`{}`", limited.option(total));
    Some(match remedied {
        Some((near, found)) => {
            let written: Vec<&str> = found.iter().map(|(text, _)| text.as_str()).collect();
            let stage = &board.study.nodes[near].name;
            let help = format!("in stage `{stage}` write {}, or allow more with {option}", written.join(" or "));
            Diagnostic::new(message).at(found[0].1).help(help)
        }
        None => Diagnostic::new(message).at(of_study.place).help(format!("ask for less, or allow more with {option}")),
    })
}

/// A stage and those with something to compute that it reads, near ones first.
fn above(board: &Board, node: usize) -> Vec<usize> {
    let mut found = vec![node];
    let mut next = 0;
    while let Some(&reader) = found.get(next) {
        for input in &board.graph.inputs[reader] {
            if !found.contains(&input.node) && !board.nodes[input.node].state.is_final() {
                found.push(input.node);
            }
        }
        next += 1;
    }
    found
}

/// What may be written in a stage so that the run fits, each with its place; a few will do.
fn remedies(board: &Board, node: usize, fits: &dyn Fn(&Record) -> bool) -> Vec<(String, Place)> {
    let of_study = &board.study.nodes[node];
    let mut found = Vec::new();
    gather(of_study.kind.fields, &of_study.record, &mut Vec::new(), &mut |path, place, find| {
        let fits = |value: Value| {
            let record = with(&of_study.record, path, &value);
            (of_study.kind.build)(&record).is_ok() && fits(&record)
        };
        if found.len() < MOST_REMEDIES
            && let Some(text) = find(&fits)
        {
            found.push((format!("`{}{text}`", path.join(".")), place));
        }
    });
    found
}

type Fits<'a> = &'a dyn Fn(Value) -> bool;
/// Told of every field: its path, its place, and how to find what would fit there.
type Visit<'a> = &'a mut dyn FnMut(&[&'static str], Place, &dyn Fn(Fits) -> Option<String>);

/// Visits every field of a record of which less may be written.
fn gather(fields: &'static [Field], record: &Record, path: &mut Vec<&'static str>, visit: Visit) {
    for (name, entry) in &record.fields {
        let Some(field) = fields.iter().find(|field| field.name == *name) else { continue };
        path.push(name);
        match (&field.shape, &entry.value) {
            (Shape::Integer { minimum, multiple, .. }, Value::Integer(value)) => visit(path, entry.place, &|fits| {
                let found = largest(*minimum, *value, &|value| fits(Value::Integer(value)))?;
                Some(format!(": {}", rounded(found, *minimum) / multiple * multiple))
            }),
            (_, Value::Axis(values)) => visit(path, entry.place, &|fits| {
                let maximum = i64::try_from(values.len()).ok()?;
                let first = |count: i64| values[..usize::try_from(count).unwrap_or(0)].to_vec();
                let count = largest(1, maximum, &|count| fits(Value::Axis(first(count))))?;
                Some(format!("` of {count} value{} instead of `{maximum}", if count == 1 { "" } else { "s" }))
            }),
            (Shape::Choice(choices), Value::Choice(chosen)) => visit(path, entry.place, &|fits| {
                let others = choices.iter().filter(|choice| choice.name != *chosen);
                others.map(|choice| choice.name).find(|name| fits(Value::Choice(name))).map(|name| format!(": {name}"))
            }),
            (Shape::Group(inner), Value::Group(record)) => gather(inner, record, path, visit),
            (Shape::Member(members), Value::Member(name, record)) => {
                if let Some(member) = members().iter().find(|member| member.name == *name) {
                    path.push(member.name);
                    gather(member.fields, record, path, visit);
                    path.pop();
                }
            }
            _ => {}
        }
        path.pop();
    }
}

/// The largest number below `maximum`, which does not fit, that does.
fn largest(minimum: i64, maximum: i64, fits: &dyn Fn(i64) -> bool) -> Option<i64> {
    if minimum >= maximum || !fits(minimum) {
        return None;
    }
    let (mut good, mut bad) = (minimum, maximum);
    while bad - good > 1 {
        let middle = good + (bad - good) / 2;
        if fits(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    Some(good)
}

/// Down to two digits, which nobody takes for more than an estimate.
fn rounded(value: i64, minimum: i64) -> i64 {
    let mut unit = 1;
    while value / unit >= 100 {
        unit *= 10;
    }
    (value / unit * unit).max(minimum)
}

/// The record with another value at a path.
fn with(record: &Record, path: &[&'static str], value: &Value) -> Record {
    let mut changed = record.clone();
    let Some((first, rest)) = path.split_first() else { return changed };
    for (_, entry) in changed.fields.iter_mut().filter(|(name, _)| name == first) {
        entry.value = match (&entry.value, rest) {
            (_, []) => value.clone(),
            (Value::Group(inner), _) => Value::Group(with(inner, rest, value)),
            // A member's name is a step of the path.
            (Value::Member(name, inner), _) => Value::Member(name, with(inner, &rest[1..], value)),
            (other, _) => other.clone(),
        };
    }
    changed
}

/// A number with its digits in threes.
#[must_use]
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let threes: Vec<&str> = digits.as_bytes().rchunks(3).rev().filter_map(|three| str::from_utf8(three).ok()).collect();
    threes.join(" ")
}

/// Bytes in the unit that suits them, of 1000 and its powers.
#[must_use]
pub fn size(bytes: u64) -> String {
    let (mut value, mut units) = (bytes as f64, ["B", "kB", "MB", "GB", "TB", "PB"].into_iter());
    let mut unit = units.next().unwrap_or_default();
    for larger in units {
        if value < 999.5 {
            break;
        }
        (value, unit) = (value / 1000.0, larger);
    }
    if unit == "B" || value >= 99.5 { format!("{value:.0} {unit}") } else { format!("{value:.1} {unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!([0, 999, 1000, 20_000_000].map(grouped), ["0", "999", "1 000", "20 000 000"]);
        assert_eq!([7, 999, 1000, 12_340_000, 999_600_000].map(size), ["7 B", "999 B", "1.0 kB", "12.3 MB", "1.0 GB"]);
        assert_eq!([rounded(29_850, 8), rounded(99, 8), rounded(8, 8)], [29_000, 99, 8]);
        assert_eq!(largest(8, 1000, &|value| value <= 77), Some(77));
        assert_eq!(largest(8, 1000, &|_| false), None);
    }
}
