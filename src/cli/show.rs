//! Commands that only show something: check, kinds, schema, table, import, and writing a study to start from.
//!
//! Must not know: execution.

use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::arguments::{Changes, Format, Places};
use super::progress::{self, out, told};
use super::{Ending, draw, json, print, studies};
use crate::program::{examine, load_text};
use crate::rexs;
use crate::stage::{self, kinds::KINDS};
use declare::error::{Faults, suggest};
use studygraph::history::side::published;
use studygraph::runner::rehearse::rehearse;
use studygraph::runner::standing::standing;
use studygraph::store::cache::Cache;
use studygraph::store::manifest::{ColumnRecord, TableRecord};
use studygraph::store::results::Folder;
use studygraph::study::{LoadError, Refused, Study, describe, described, schema as schemas};
use studygraph::table::data::Table;

/// Studies to start from: what they are asked for by, how they are called, their texts.
pub(super) const TEMPLATES: [(&str, &str, &str); 2] = [
    ("quick", "quick", include_str!("../../studies/quick.yaml")),
    ("sweep", "sweep_quick", include_str!("../../studies/sweep_quick.yaml")),
];

/// Writes a small study; never over a file that is there.
pub(super) fn new_study(file: &Path, template: &str, as_json: bool) -> Result<(), Ending> {
    let found = TEMPLATES.iter().find(|(name, ..)| *name == template);
    let (_, called, template) = found.ok_or_else(|| {
        let names = TEMPLATES.iter().map(|(name, ..)| *name);
        Ending::Usage(format!("there is no template `{template}`; {}", suggest(template, names)))
    })?;
    let stem = file.file_stem().map(|stem| stem.to_string_lossy().to_lowercase()).unwrap_or_default();
    let allowed = |c: char| if c.is_ascii_alphanumeric() || c == '_' { c } else { '-' };
    let name: String = stem.chars().map(allowed).take(64).collect();
    let name = name.trim_matches(['-', '_']);
    // The first line points editors to this repository's schema, which a study elsewhere has not beside it.
    let text: String = template.split_inclusive('\n').skip(1).collect();
    let named = |name: &str| text.replacen(&format!("study: {called}"), &format!("study: {name}"), 1);
    // Nothing is left of some names, and YAML reads `null` otherwise.
    let text = Some(named(name)).filter(|text| load_text(text, file).is_ok()).unwrap_or_else(|| named("study"));
    let cannot = |error: std::io::Error| Ending::Usage(format!("cannot write {}: {error}", file.display()));
    let mut opened = OpenOptions::new().write(true).create_new(true).open(file).map_err(|error| {
        if error.kind() == ErrorKind::AlreadyExists {
            let (shown, word) = (file.display(), studies::shell_word(file));
            return Ending::Usage(format!(
                "{shown} is there already and stays as it is; give another name, or remove it first: rm {word}"
            ));
        }
        cannot(error)
    })?;
    if let Err(error) = opened.write_all(text.as_bytes()) {
        drop(opened);
        // A part of a study would be in the way of the next try; where it cannot be removed, the message names it.
        let _ = std::fs::remove_file(file);
        return Err(cannot(error));
    }
    let shown = file.display().to_string();
    if as_json {
        let study = load_text(&text, file).ok().map(|study| study.name);
        json::answer(&json!({ "file": shown, "study": study, "next": ["gearstudy", "run", shown] }));
    } else {
        out(&format!("wrote {shown}; next: gearstudy run {}\n", studies::shell_word(file)));
    }
    Ok(())
}

/// Prints the pair of a REXS file as a study.
pub(super) fn import(file: &Path, stage: Option<&str>, as_json: bool) -> Result<(), Ending> {
    let cannot = |error: std::io::Error| Ending::Usage(format!("cannot read {}: {error}", file.display()));
    let mut bytes = Vec::new();
    // No more than one byte too many, whatever the file says of its size.
    File::open(file).map_err(cannot)?.take(rexs::MOST_BYTES as u64 + 1).read_to_end(&mut bytes).map_err(cannot)?;
    let text = rexs::text_of(bytes).map_err(|error| Ending::Usage(error.in_file(file)))?;
    let rexs::Imported { study, read, follows, contradicting, not_supported, notes } =
        rexs::import(&text, stage).map_err(|error| Ending::Usage(error.in_file(file)))?;
    if as_json {
        json::answer(&json!({
            "file": file.display().to_string(),
            "study": study,
            "read": read,
            "follows": follows,
            "contradicting": contradicting,
            "not_supported": not_supported,
            "notes": notes,
        }));
    } else {
        out(&study);
    }
    Ok(())
}

/// A study with which nothing is wrong that its quick stages can tell, those of what is sound of it.
pub(super) fn rehearsed(examined: Result<Study, Refused>) -> Result<Study, LoadError> {
    let found = |study: &Study| rehearse(study).unwrap_or_else(|wrong| vec![wrong]);
    match examined {
        Ok(study) => match Faults::all(found(&study)) {
            Ok(()) => Ok(study),
            Err(wrong) => Err(study.refused(wrong)),
        },
        Err(refused) => {
            let found = refused.sound.as_deref().map_or_else(Vec::new, found);
            Err(refused.with(found))
        }
    }
}

/// Says of every file whether it is a valid study.
pub(super) fn check(files: &[PathBuf], changes: &Changes, as_json: bool, quiet: bool) -> Result<(), Ending> {
    let settings = studies::settings(changes);
    let (mut last, mut values, mut is_invalid) = (None, Vec::new(), false);
    for file in files {
        let checked = rehearsed(examine(file, &settings)).map_err(LoadError::in_full);
        if as_json {
            values.push(checked_value(file, &checked));
        }
        if let Ok(study) = &checked {
            progress::warned(study);
        }
        match checked {
            Ok(study) if !quiet && !as_json => {
                let count = study.nodes.len();
                let stages = if count == 1 { "stage" } else { "stages" };
                out(&format!("{}: `{}` is valid, {count} {stages}\n", file.display(), study.name));
            }
            Ok(_) => {}
            Err(error) => {
                is_invalid |= !error.is_of_no_file();
                if let Some(earlier) = last.replace(error).filter(|_| !as_json) {
                    draw::invalid_study(&earlier);
                }
            }
        }
    }
    if as_json {
        json::answer(&Value::Array(values));
        let told = "what is wrong with the study is in the answer".to_owned();
        return last.map_or(Ok(()), |_| Err(if is_invalid { Ending::Unreadable(told) } else { Ending::Usage(told) }));
    }
    match last {
        None => Ok(()),
        // That another one is invalid says more than that this one is not there.
        Some(error) if is_invalid && error.is_of_no_file() => Err(Ending::Unreadable(error.to_string())),
        Some(error) => Err(Ending::Invalid(Box::new(error))),
    }
}

fn checked_value(file: &Path, checked: &Result<Study, LoadError>) -> Value {
    let study = checked.as_ref().ok();
    json!({
        "file": file.to_string_lossy(), "valid": study.is_some(), "study": study.map(|study| study.name.clone()),
        "stages": study.map(|study| study.nodes.len()),
        "mistakes": checked.as_ref().err().map_or_else(|| json!([]), json::mistakes),
    })
}

pub(super) fn kinds(name: Option<&str>, as_json: bool) -> Result<(), Ending> {
    let Some(name) = name else {
        if as_json {
            json::answer(&described::list(KINDS));
        } else {
            out(&describe::list(KINDS));
        }
        return Ok(());
    };
    if let Some((kind, path)) = name.split_once('.').and_then(|(kind, path)| Some((stage::kind(kind)?, path))) {
        let text = describe::within(kind, path).map_err(Ending::Usage)?;
        if as_json {
            json::answer(&described::within(kind, path));
        } else {
            out(&text);
        }
        return Ok(());
    }
    let Some(kind) = stage::kind(name) else {
        let known = KINDS.iter().map(|kind| kind.name);
        let within: Vec<_> = KINDS.iter().filter(|kind| describe::mentions(kind, name)).map(|kind| kind.name).collect();
        let help = match within[..] {
            [] => suggest(name, known),
            [first, ..] => format!("it belongs to {}: `gearstudy kinds {first}` shows it", within.join(", ")),
        };
        return Err(Ending::Usage(format!("there is no kind `{name}`; {help}")));
    };
    if as_json {
        json::answer(&described::kind(kind));
    } else {
        out(&describe::kind(kind));
    }
    Ok(())
}

pub(super) fn schema() {
    out(&schemas::schema_text(KINDS));
}

/// Prints a table of the last run, or which tables there are.
pub(super) fn table(
    study: &Study,
    places: &Places,
    name: Option<&str>,
    conditions: &[String],
    columns: &[String],
    format: Format,
    quiet: bool,
) -> Result<(), Ending> {
    let folder = Folder::new(&places.results, &study.name);
    out(&folder.settled(|| shown(study, places, &folder, name, conditions, columns, format))?);
    tell_stale(study, &folder, quiet);
    Ok(())
}

/// Says in a line on standard error where results are not those of the study and the program as they are now; what cannot be
/// told is not told.
pub(super) fn tell_stale(study: &Study, folder: &Folder, quiet: bool) {
    let outdated = || standing(study, folder).ok()?.outdated();
    if let Some(problem) = (!quiet).then(outdated).flatten() {
        let (name, file) = (&study.name, studies::shell_word(&study.path));
        told(&format!("{name}: the results are not those of the study now: {problem}; first: gearstudy run {file}"));
    }
}

fn shown(
    study: &Study,
    places: &Places,
    folder: &Folder,
    name: Option<&str>,
    conditions: &[String],
    columns: &[String],
    format: Format,
) -> Result<String, Ending> {
    let read = folder.read_manifest().map_err(|error| Ending::Usage(error.to_string()))?;
    let manifest = read.ok_or_else(|| none_yet(study, folder))?;
    let records: Vec<&TableRecord> = manifest.stages.iter().flat_map(|stage| &stage.tables).collect();
    let Some(name) = name else {
        if format == Format::Json {
            let listed: Vec<Value> = records.iter().map(|record| table_value(record, &record.name)).collect();
            return Ok(format!("{:#}\n", Value::Array(listed)));
        }
        let width = records.iter().map(|record| record.name.len()).max().unwrap_or(0);
        let line = |record: &&TableRecord| {
            format!("{:width$}  {:>8} rows  {}\n", record.name, record.rows, record.description)
        };
        return Ok(records.iter().map(line).collect());
    };
    let all = || manifest.stages.iter().flat_map(|stage| stage.tables.iter().map(move |record| (stage, record)));
    let Some((stage, record)) = all().find(|(_, record)| record.name == name) else {
        if let Some(said) = studies::only_on_demand(study, name) {
            return Err(Ending::Usage(said));
        }
        let known: Vec<&str> = records.iter().map(|record| record.name.as_str()).collect();
        return Err(Ending::Usage(format!("there is no table `{name}`; {}", suggest(name, known.iter().copied()))));
    };
    let table: Table =
        published(folder, stage, record, &|| Cache::open_if_there(&places.cache)).map_err(Ending::Usage)?;
    let names = conditions.iter().map(|condition| condition.split('=').next().unwrap_or_default().trim());
    let mut absent =
        names.chain(columns.iter().map(String::as_str)).filter(|name| table.schema().position(name).is_none());
    if let Some(said) = absent.find_map(|column| studies::only_on_demand(study, &format!("{name}.{column}"))) {
        return Err(Ending::Usage(said));
    }
    print::table(&table, conditions, columns, format).map_err(Ending::Usage)
}

/// A table that there is, and its columns.
pub(super) fn table_value(record: &TableRecord, name: &str) -> Value {
    let column = |column: &ColumnRecord| {
        json!({
            "name": column.name, "type": column.kind, "unit": column.unit, "description": column.description,
            "key": column.key,
        })
    };
    json!({
        "name": name, "rows": record.rows, "description": &*record.description, "file": record.file,
        "columns": record.columns.iter().map(column).collect::<Vec<_>>(),
    })
}

/// That a study has no results.
pub(super) fn none_yet(study: &Study, folder: &Folder) -> Ending {
    let (path, file) = (folder.path().display(), studies::shell_word(&study.path));
    Ending::Usage(format!("there are no results in {path}; first: gearstudy run {file}"))
}
