//! Verdicts on published numbers that are other words than they were.
//!
//! An entry is found again by what it is, not by its number, so one put in before it changes nothing. Must not know: how
//! a verdict comes about.

use super::model::Flip;
use crate::table::data::{Data, Table};

/// What an entry is: the columns that say it, in the order of the study.
const IDENTITY: [&str; 3] = ["label", "where", "cell"];

/// The columns by which rows are matched: the first that tell them apart.
pub const KEYS: [&[&str]; 2] = [&["label", "where"], &IDENTITY];

/// The table of verdicts of a stage of kind `report`.
pub const TABLE: &str = "verdicts";

struct VerdictRow<'a> {
    identity: [&'a str; 3],
    verdict: &'a str,
    published: &'a str,
    computed: Option<f64>,
    unit: &'a str,
    /// For a claim: in how many rows it holds.
    found: &'a str,
}

impl VerdictRow<'_> {
    fn is(&self, other: &Self) -> bool {
        self.identity == other.identity
    }

    fn is_called(&self, other: &Self) -> bool {
        !self.identity[0].is_empty() && self.identity[..2] == other.identity[..2]
    }
}

/// Entries whose verdict differs, that came or went, those that need attention first.
#[must_use]
pub fn flips(study: &str, stage: &str, before: &Table, after: &Table) -> Vec<Flip> {
    let (old, new) = (entries(before), entries(after));
    let flip = |old: Option<&VerdictRow<'_>>, new: Option<&VerdictRow<'_>>| {
        let shown = new.or(old)?;
        let [label, location, cell] = shown.identity.map(str::to_owned);
        Some(Flip {
            study: study.to_owned(),
            stage: stage.to_owned(),
            label,
            location,
            cell,
            before: old.map(|entry| entry.verdict.to_owned()),
            after: new.map(|entry| entry.verdict.to_owned()),
            published: shown.published.to_owned(),
            computed_before: old.and_then(|entry| entry.computed),
            computed_after: new.and_then(|entry| entry.computed),
            unit: shown.unit.to_owned(),
            found_before: old.map(|entry| entry.found.to_owned()).unwrap_or_default(),
            found_after: new.map(|entry| entry.found.to_owned()).unwrap_or_default(),
            needs_attention: new.is_some_and(|entry| needs_attention(entry.verdict)),
        })
    };
    let mut left: Vec<&VerdictRow<'_>> = old.iter().collect();
    // Of entries that say the same, the first belongs to the first. A formula may have been corrected since: what is
    // left is matched by its words alone.
    let mut matched: Vec<Option<&VerdictRow<'_>>> = vec![None; new.len()];
    for same in [VerdictRow::is, VerdictRow::is_called] {
        for (entry, matched) in new.iter().zip(&mut matched).filter(|(_, matched)| matched.is_none()) {
            *matched = left.iter().position(|other| same(other, entry)).map(|at| left.remove(at));
        }
    }
    let mut found = Vec::new();
    for (entry, earlier) in new.iter().zip(matched) {
        if earlier.is_none_or(|earlier| earlier.verdict != entry.verdict) {
            found.extend(flip(earlier, Some(entry)));
        }
    }
    found.extend(left.into_iter().filter_map(|entry| flip(Some(entry), None)));
    found
}

/// The entries of a table that is gone.
#[must_use]
pub fn gone(study: &str, stage: &str, before: &Table) -> Vec<Flip> {
    let nothing = Table::from_rows(before.schema().clone(), Vec::new());
    nothing.map_or_else(|_| Vec::new(), |nothing| flips(study, stage, before, &nothing))
}

/// Those that need attention first; then those that changed, came, went.
pub fn sort(flips: &mut [Flip]) {
    flips.sort_by_key(|flip| (!flip.needs_attention, flip.after.is_none(), flip.before.is_none()));
}

fn entries(table: &Table) -> Vec<VerdictRow<'_>> {
    let text = |name: &str, row: usize| match table.column(name) {
        Some(Data::Text(values)) => values[row].as_str(),
        _ => "",
    };
    let number = |name: &str, row: usize| match table.column(name) {
        Some(Data::Float(values)) => Some(values[row]),
        _ => None,
    };
    let one = |row: usize| VerdictRow {
        identity: IDENTITY.map(|name| text(name, row)),
        verdict: text("verdict", row),
        published: text("published_text", row),
        computed: number("computed", row),
        unit: text("unit", row),
        found: text("found", row),
    };
    (0..table.rows()).map(one).collect()
}

fn needs_attention(verdict: &str) -> bool {
    !matches!(verdict, "reproduced" | "holds" | "explained" | "refuted")
}
