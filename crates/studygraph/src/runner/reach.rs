//! Which entries of a cache the results that somebody has still need.
//!
//! Must not know: where those results lie.

use std::collections::BTreeSet;

use super::key;
use crate::store::cache::{Cache, Lookup};
use crate::store::manifest::Manifest;
use declare::digest::Digest;

/// The keys that a run which finds everything up to date looks up for these results: those of the chunks, and those of
/// what they are together.
#[must_use]
pub fn reached(manifest: &Manifest, cache: &Cache) -> BTreeSet<Digest> {
    let mut all = BTreeSet::new();
    for stage in &manifest.stages {
        let keys: Vec<Digest> = stage.keys.iter().map(|record| record.key).collect();
        if keys.len() > 1 {
            let found = keys.iter().map_while(|key| match cache.look_up(*key) {
                Lookup::Found(entry) => Some(entry.tables),
                Lookup::Missing | Lookup::Damaged(_) => None,
            });
            let tables: Vec<_> = found.collect();
            if tables.len() == keys.len() {
                all.insert(key::whole(tables.iter().map(Vec::as_slice)));
            }
        }
        all.extend(keys);
    }
    all
}
