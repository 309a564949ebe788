//! Studies that have another name on the other side.
//!
//! Must not know: how two studies are compared.

use std::cmp::Reverse;
use std::collections::BTreeSet;

use crate::store::manifest::Manifest;

/// A study's name and its manifests, with the folder each lies in.
pub struct ManifestPair {
    /// That of the later side where they differ.
    pub name: String,
    /// That of the earlier side where they differ.
    pub renamed_from: Option<String>,
    pub before: Option<(String, Manifest)>,
    pub after: Option<(String, Manifest)>,
    /// The reasons for which a manifest that is there could not be read.
    pub unread: Vec<String>,
}

/// Makes one pair of a study that is gone and a new one of which at least half of the tables are the same: names are part of no
/// table. The most alike come first.
pub fn join(pairs: &mut Vec<ManifestPair>) {
    let is_read = |pair: &ManifestPair| pair.unread.is_empty();
    let only = |is_gone: bool| {
        let pairs = pairs.iter().enumerate();
        let here = pairs.filter(move |(_, pair)| (pair.before.is_some(), pair.after.is_some()) == (is_gone, !is_gone));
        here.filter(move |(_, pair)| is_read(pair)).map(|(at, pair)| (at, tables(pair))).collect::<Vec<_>>()
    };
    let (gone, new) = (only(true), only(false));
    let mut alike = Vec::new();
    for (before, old) in &gone {
        for (after, tables) in &new {
            let same = old.intersection(tables).count();
            if same > 0 && 2 * same >= old.len().max(tables.len()) {
                alike.push((Reverse(same), *before, *after));
            }
        }
    }
    alike.sort_unstable();
    let mut joined = BTreeSet::new();
    for (_, before, after) in alike {
        if !joined.contains(&before) && pairs[after].before.is_none() {
            pairs[after].before = pairs[before].before.take();
            pairs[after].renamed_from = Some(pairs[before].name.clone());
            joined.insert(before);
        }
    }
    let mut at = 0..;
    pairs.retain(|_| at.next().is_none_or(|at| !joined.contains(&at)));
}

/// Names and contents of all tables of a study that only one side has.
fn tables(pair: &ManifestPair) -> BTreeSet<(String, String)> {
    let manifest = pair.before.as_ref().or(pair.after.as_ref());
    let stages = manifest.into_iter().flat_map(|(_, manifest)| &manifest.stages);
    stages.flat_map(|stage| &stage.tables).map(|table| (table.name.clone(), table.content.clone())).collect()
}
