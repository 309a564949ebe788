//! `gc`: what of the cache goes, what stays and why.
//!
//! Must not know: how files are found and removed.

use std::collections::BTreeSet;
use std::time::Duration;

use serde_json::json;

use super::arguments::{Cleaning, Places};
use super::progress::{self, out};
use super::{Ending, json};
use studygraph::history::git::Repository;
use studygraph::history::side::Side;
use studygraph::presence;
use studygraph::runner::reach::reached;
use studygraph::store::cache::{Cache, Remove};

pub(super) fn gc(places: &Places, asked: &Cleaning) -> Result<(), Ending> {
    let usage = |error: &dyn std::fmt::Display| Ending::Usage(error.to_string());
    let results = Side::folder(&places.results, places.results.display().to_string());
    let mut sides = vec![results.map_err(|error| usage(&error))?];
    for word in &asked.keep {
        let side = Repository::around(&places.results).and_then(|repository| {
            let commit = repository.commit(word)?;
            Side::commit(&repository, &commit, &repository.inside(&places.results)?)
        });
        sides.push(side.map_err(|error| usage(&error))?);
    }
    // Looked into, and let go before it is cleaned; where there is none, nothing is made.
    let mut keep = BTreeSet::new();
    let lock = places.cache.join("lock");
    if presence::is_file(&lock).map_err(|error| usage(&presence::unread(&lock)(error)))? {
        let cache = Cache::open(&places.cache).map_err(|error| usage(&error))?;
        for side in &sides {
            // Results that cannot be read need nobody knows what.
            let studies = side.studies().map_err(|error| usage(&error))?;
            for study in studies {
                let manifest = side.manifest(&study).map_err(|error| usage(&error))?;
                keep.extend(manifest.iter().flat_map(|manifest| reached(manifest, &cache)));
            }
        }
    }
    let unused = Duration::from_secs(u64::from(asked.days) * 86_400);
    let remove = Remove::Unused { keep: &keep, unused, most: asked.max_size };
    let removed = Cache::clean(&places.cache, remove, asked.dry_run).map_err(|error| usage(&error))?;
    if asked.output.is_json() {
        let foreign: Vec<String> = removed.foreign.iter().map(|path| path.display().to_string()).collect();
        json::answer(&json!({
            "dry_run": asked.dry_run, "deleted": { "entries": removed.entries, "bytes": removed.bytes },
            "leftovers": removed.leftovers, "kept": { "entries": removed.kept, "bytes": removed.kept_bytes },
            "needed": { "entries": removed.needed, "bytes": removed.needed_bytes }, "left_alone": foreign,
        }));
        return Ok(());
    }
    let word = if asked.dry_run { "would delete" } else { "deleted" };
    #[allow(clippy::cast_precision_loss)]
    let megabytes = |bytes: u64| bytes as f64 / 1e6;
    let leftovers = match removed.leftovers {
        0 => String::new(),
        1 => ", 1 leftover of a killed run".to_owned(),
        many => format!(", {many} leftovers of killed runs"),
    };
    let needed = match removed.needed {
        0 => String::new(),
        needed => format!(", {needed} of them needed by results ({:.1} MB)", megabytes(removed.needed_bytes)),
    };
    out(&format!(
        "{word} {} entries ({:.1} MB){leftovers}, kept {} ({:.1} MB){needed}\n",
        removed.entries,
        megabytes(removed.bytes),
        removed.kept,
        megabytes(removed.kept_bytes)
    ));
    if let Some(most) = asked.max_size.filter(|most| removed.needed_bytes > *most) {
        progress::told(&format!(
            "what results need is more than {:.1} MB by itself, and stays; remove results, or name fewer commits",
            megabytes(most)
        ));
    }
    for path in &removed.foreign {
        progress::told(&format!("left alone, since it is not a file of the cache: {}", path.display()));
    }
    Ok(())
}
