//! `report`: the verdicts of a study that was run, and its page drawn anew.
//!
//! Must not know: how verdicts are found, how anything is drawn.

use std::cell::RefCell;
use std::sync::Arc;

use serde_json::{Value, json};

use super::arguments::Places;
use super::pages::{self, Counts};
use super::print::objects;
use super::progress::{self, out};
use super::show::{none_yet, tell_stale};
use super::status::{OTHER_PAGE, is_up_to_date, not_here};
use super::{Ending, json as shapes, studies};
use crate::program::PROGRAM;
use studygraph::history::side::{cached, published};
use studygraph::runner::standing::standing_of;
use studygraph::store::cache::Cache;
use studygraph::store::manifest::{Manifest, TableRecord};
use studygraph::store::results::{Folder, Tables};
use studygraph::study::Study;
use studygraph::table::data::Table;

/// What a report says.
struct Said {
    counts: Counts,
    /// Of verdicts, and of comparisons.
    tables: [Vec<Arc<Table>>; 2],
    /// Both with their reasons.
    text: String,
}

impl Said {
    fn of(manifest: &Manifest, tables: Tables<'_>) -> Result<Self, String> {
        Ok(Self {
            counts: Counts::of(manifest, tables),
            tables: pages::verdict_tables(manifest, tables),
            text: pages::verdicts(manifest, tables)?,
        })
    }
}

/// Prints them for every study. `check`: nothing is written, and what needs attention or is stale ends with code 4.
pub(super) fn report(
    studies: &[Study],
    places: &Places,
    check: bool,
    as_json: bool,
    quiet: bool,
) -> Result<(), Ending> {
    let (mut values, mut problems) = (Vec::new(), Vec::new());
    for study in studies {
        let folder = Folder::new(&places.results, &study.name).telling(progress::told);
        let said = if check { looked_at(study, &folder, places)? } else { drawn(study, &folder, places)? };
        let stale = if check {
            stale(study, &folder, places)?
        } else {
            tell_stale(study, &folder, quiet);
            None
        };
        if as_json {
            values.push(value(study, &folder, &said, stale.as_deref(), check));
        } else if !quiet {
            let summary = said.counts.summary();
            let summary = if summary.is_empty() { "no verdicts" } else { &summary };
            out(&format!("{}{}: {summary}; {}\n", said.text, study.name, pages::path(&folder).display()));
        }
        if check {
            problems.extend(said.counts.complaints().into_iter().map(|words| format!("{}: {words}", study.name)));
        }
        problems.extend(stale.map(|problem| {
            format!("{}: {problem}; first: gearstudy run {}", study.name, studies::shell_word(&study.path))
        }));
    }
    if as_json {
        shapes::answer(&Value::Array(values));
    }
    if problems.is_empty() { Ok(()) } else { Err(Ending::Differs(problems.join("\n"))) }
}

/// As the results have it.
fn looked_at(study: &Study, folder: &Folder, places: &Places) -> Result<Said, Ending> {
    let look = || {
        let manifest = folder.read_manifest().map_err(|error| Ending::Usage(error.to_string()))?;
        let manifest = manifest.ok_or_else(|| none_yet(study, folder))?;
        // Verdicts that nobody has are not the same as none.
        let open = || Cache::open_if_there(&places.cache);
        for stage in manifest.stages.iter().filter(|stage| stage.kind == "report") {
            for record in stage.tables.iter().filter(|record| pages::REPORTED.contains(&record.table())) {
                published(folder, stage, record, &open).map_err(Ending::Usage)?;
            }
        }
        Said::of(&manifest, &pages::read(folder, &manifest, &places.cache)).map_err(Ending::Usage)
    };
    folder.settled(look)
}

/// The same, with page and figures drawn anew.
fn drawn(study: &Study, folder: &Folder, places: &Places) -> Result<Said, Ending> {
    let said = RefCell::new(None);
    let draw = |manifest: &Manifest, tables: Tables<'_>| {
        let drawn = pages::draw(manifest, tables)?;
        said.replace(Some(Said::of(manifest, tables)?));
        Ok(drawn)
    };
    // Where it cannot be opened, only what it would have given is missing, and reported.
    let cache = || Cache::open_if_there(&places.cache).ok().flatten();
    let manifest = folder.read_manifest().map_err(|error| Ending::Usage(error.to_string()))?.unwrap_or_default();
    let elsewhere = |record: &TableRecord| {
        let stage = manifest.stages.iter().find(|stage| stage.tables.contains(record))?;
        cached(cache().as_ref(), stage, record)
    };
    let published =
        folder.redraw(&draw, PROGRAM.about.code, &elsewhere).map_err(|error| Ending::Usage(error.to_string()))?;
    if let Some(problem) = published.ok_or_else(|| none_yet(study, folder))?.undrawn {
        return Err(Ending::Usage(problem));
    }
    said.take().ok_or_else(|| none_yet(study, folder))
}

/// Why the verdicts are not those of the study as it is now, or not all of the results is here.
fn stale(study: &Study, folder: &Folder, places: &Places) -> Result<Option<String>, Ending> {
    let usage = |problem: String| Ending::Usage(format!("{}: {problem}", study.path.display()));
    let known = folder.known().map_err(|error| usage(error.to_string()))?;
    let standing = standing_of(study, known.as_ref()).map_err(|error| usage(error.message))?;
    if let Some(problem) = standing.problem() {
        return Ok(Some(problem));
    }
    let is_all_here = standing.absent().is_empty() && standing.missing.is_empty();
    // Only tables that are not here are looked for in it.
    let cache = if is_all_here { Ok(None) } else { Cache::open_if_there(&places.cache) };
    let (_, lost) = not_here(&standing, cache.map_err(|error| usage(error.to_string()))?.as_ref());
    let missing = lost.first().map(|file| format!("`{}` is missing", folder.path().join(file).display()));
    Ok(missing.or_else(|| (!is_up_to_date(&standing)).then(|| OTHER_PAGE.to_owned())))
}

fn value(study: &Study, folder: &Folder, said: &Said, stale: Option<&str>, check: bool) -> Value {
    let [entries, comparisons] =
        said.tables.each_ref().map(|tables| tables.iter().flat_map(|table| objects(table)).collect::<Vec<Value>>());
    let mut value = json!({
        "study": study.name, "file": study.path.to_string_lossy(), "page": pages::path(folder).to_string_lossy(),
        "verdicts": shapes::verdicts(&said.counts.verdicts), "needs_attention": said.counts.attention(),
        "entries": entries, "comparisons": comparisons,
    });
    if check {
        value["stale"] = json!(stale);
    }
    value
}
