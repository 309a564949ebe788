//! Which stage and tables came in through a port: its name is the program's, and a reader knows those of the study.
//!
//! A manifest has ports and digests; who gives what stands in the fields, as the study writes it. Must not know: what a
//! stage does with what it reads.

use serde_json::Value as Json;

use crate::store::manifest::{Manifest, StageRecord};

/// A stage is read through others at most so far: designs through a stiffness through a pair.
const FURTHEST: usize = 4;

/// The tables behind a port that are other ones than they were, as `stage.table`; the stage alone, where its tables do
/// not tell; nothing, where the fields do not say which it is.
pub fn tables(before: (&Manifest, &StageRecord), after: (&Manifest, &StageRecord), port: &str) -> Vec<String> {
    let (old, new) = (giver(before.0, before.1, port, FURTHEST), giver(after.0, after.1, port, FURTHEST));
    let (Some(old), Some(new)) = (old, new) else {
        return old.or(new).map(|stage| stage.name.clone()).into_iter().collect();
    };
    let same = |name: &str, content: &str| old.tables.iter().any(|it| it.table() == name && it.content == content);
    let changed = new.tables.iter().filter(|table| !same(table.table(), &table.content));
    let changed: Vec<String> = changed.map(|table| table.name.clone()).collect();
    if changed.is_empty() { vec![new.name.clone()] } else { changed }
}

/// The stage that a port of another one reads.
fn giver<'a>(run: &'a Manifest, stage: &StageRecord, port: &str, far: usize) -> Option<&'a StageRecord> {
    let find = |name: &str| run.stages.iter().find(|stage| stage.name == name);
    let named = |value: &Json| find(value.as_str()?);
    let config = stage.config.value();
    if let Some(found) = config.get(port).and_then(named) {
        return Some(found);
    }
    // The second of `designs: [ours, optimum]` comes in through `designs_2`.
    if let Some((field, number)) = port.rsplit_once('_')
        && let (Some(value), Ok(number)) = (config.get(field), number.parse::<usize>())
    {
        let one = if value.is_array() { value.get(number.checked_sub(1)?) } else { Some(value) };
        if let Some(found) = one.and_then(named) {
            return Some(found);
        }
    }
    // Read from what another stage reads.
    let fields = config.as_object().into_iter().flat_map(|fields| fields.values());
    let through = || fields.filter_map(named).find_map(|next| giver(run, next, port, far.checked_sub(1)?));
    through().or_else(|| find(port))
}
