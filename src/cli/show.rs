//! Commands that only show something: check, status, kinds, schema, table, import, and writing a study to start from.
//!
//! Must not know: execution.

use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use serde_json::json;

use super::Ending;
use super::arguments::{Format, Places};
use super::progress::out;
use super::{draw, pages, print};
use crate::base::error::suggest;
use crate::runner::standing::{StageStanding, Standing, State, standing};
use crate::stage::{self, kinds::KINDS};
use crate::store::manifest::{Manifest, TableRecord};
use crate::store::results::Folder;
use crate::study::{Study, describe, load, load_text, rexs, schema as studies};
use crate::table::data::Table;

/// Where `status` looks when no study is named.
const STUDIES: &str = "studies";
const TEMPLATE: &str = include_str!("../../studies/quick.yaml");

/// Writes a small study; never over a file that is there.
pub(super) fn new_study(file: &Path) -> Result<(), Ending> {
    let stem = file.file_stem().map(|stem| stem.to_string_lossy().to_lowercase()).unwrap_or_default();
    let allowed = |c: char| if c.is_ascii_alphanumeric() || c == '_' { c } else { '-' };
    let name: String = stem.chars().map(allowed).take(64).collect();
    let name = name.trim_matches(['-', '_']);
    // The first line points editors to this repository's schema, which a study elsewhere has not beside it.
    let text: String = TEMPLATE.split_inclusive('\n').skip(1).collect();
    let named = |name: &str| text.replacen("study: quick", &format!("study: {name}"), 1);
    // Nothing is left of some names, and YAML reads `null` otherwise.
    let text = Some(named(name)).filter(|text| load_text(text, file).is_ok()).unwrap_or_else(|| named("study"));
    let cannot = |error: std::io::Error| Ending::Usage(format!("cannot write {}: {error}", file.display()));
    let mut opened = OpenOptions::new().write(true).create_new(true).open(file).map_err(cannot)?;
    opened.write_all(text.as_bytes()).map_err(cannot)?;
    out(&format!("wrote {0}; next: gearstudy run {0}\n", file.display()));
    Ok(())
}

/// Prints the pair of a REXS file as a study.
pub(super) fn import(file: &Path, stage: Option<&str>) -> Result<(), Ending> {
    let cannot = |error: std::io::Error| Ending::Usage(format!("cannot read {}: {error}", file.display()));
    let refused = |problem: String| Ending::Usage(format!("{}: {problem}", file.display()));
    let mut bytes = Vec::new();
    // No more than one byte too many, whatever the file says of its size.
    File::open(file).map_err(cannot)?.take(rexs::MOST_BYTES as u64 + 1).read_to_end(&mut bytes).map_err(cannot)?;
    let text = String::from_utf8(bytes).map_err(|_| refused("it is not UTF-8".to_owned()))?;
    out(&rexs::geometry(&text, stage).map_err(|error| Ending::Usage(error.in_file(file)))?);
    Ok(())
}

/// Says of every file whether it is a valid study.
pub(super) fn check(files: &[PathBuf], quiet: bool) -> Result<(), Ending> {
    let mut last = None;
    for file in files {
        match load(file) {
            Ok(study) if !quiet => {
                out(&format!("{}: `{}` is valid, {} stages\n", file.display(), study.name, study.nodes.len()));
            }
            Ok(_) => {}
            Err(error) => {
                if let Some(earlier) = last.replace(error) {
                    draw::invalid_study(&earlier);
                }
            }
        }
    }
    last.map_or(Ok(()), |error| Err(Ending::Invalid(Box::new(error))))
}

/// The studies that were named, or all in the folder `studies`.
pub(super) fn named_or_all(named: &[PathBuf]) -> Result<Vec<PathBuf>, Ending> {
    if !named.is_empty() {
        return Ok(named.to_vec());
    }
    let entries = std::fs::read_dir(STUDIES).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut all: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|word| word == "yaml")).collect();
    all.sort();
    if all.is_empty() {
        return Err(Ending::Usage(format!("there are no studies in `{STUDIES}` here; name one")));
    }
    Ok(all)
}

/// Says of every study what of its results is up to date, what is not, and why.
pub(super) fn status(studies: &[Study], places: &Places, as_json: bool) -> Result<(), Ending> {
    let mut all = Vec::new();
    for study in studies {
        let folder = Folder::new(&places.results, &study.name);
        let standing = standing(study, &folder, stage::code_digest, false)
            .map_err(|error| Ending::Usage(format!("{}: {}", study.path.display(), error.message)))?;
        let report = pages::are_current(&folder);
        if as_json {
            let stages: Vec<_> = standing
                .stages
                .iter()
                .map(|stage| json!({ "name": stage.name, "state": stage.state.word(), "why": stage.state.why() }))
                .collect();
            all.push(json!({
                "study": study.name, "file": study.path, "up_to_date": standing.is_up_to_date() && report,
                "results": standing.has_results, "text_changed": standing.text_changed, "gone": standing.gone,
                "report_up_to_date": report, "stages": stages,
            }));
        } else {
            out(&status_text(study, &standing, report));
        }
    }
    if as_json {
        out(&format!("{:#}\n", serde_json::Value::Array(all)));
    }
    Ok(())
}

fn status_text(study: &Study, standing: &Standing, report: bool) -> String {
    if !standing.has_results {
        return format!("{}: no results; next: gearstudy run {}\n", study.name, study.path.display());
    }
    let others: Vec<&StageStanding> = standing.stages.iter().filter(|stage| stage.state != State::UpToDate).collect();
    let mut parts = Vec::new();
    if !others.is_empty() {
        parts.push(format!("{} of {} stages are not up to date", others.len(), standing.stages.len()));
    }
    if !standing.gone.is_empty() {
        parts.push(format!("the results have stages that the study has not: {}", standing.gone.join(", ")));
    }
    if parts.is_empty() && standing.text_changed {
        parts.push("the study's file has changed, but no stage of it".to_owned());
    }
    let command = if parts.is_empty() && !report { "report" } else { "run" };
    if parts.is_empty() && !report {
        parts.push("the report is not that of the last run".to_owned());
    }
    if parts.is_empty() {
        return format!("{}: up to date\n", study.name);
    }
    let mut text =
        format!("{}: {}; next: gearstudy {command} {}\n", study.name, parts.join("; "), study.path.display());
    let width = others.iter().map(|stage| stage.name.chars().count()).max().unwrap_or(0);
    for stage in others {
        text += &format!("  {:width$}  {:7}  {}\n", stage.name, stage.state.word(), stage.state.why());
    }
    text
}

pub(super) fn kinds(name: Option<&str>) -> Result<(), Ending> {
    let Some(name) = name else {
        out(&describe::list(KINDS));
        return Ok(());
    };
    let Some(kind) = stage::kind(name) else {
        let known = KINDS.iter().map(|kind| kind.name);
        return Err(Ending::Usage(format!("there is no kind `{name}`; {}", suggest(name, known))));
    };
    out(&describe::kind(kind));
    Ok(())
}

pub(super) fn schema() {
    out(&studies::schema_text(KINDS));
}

/// Prints a table of the last run, or which tables there are.
pub(super) fn table(
    study: &Study,
    places: &Places,
    name: Option<&str>,
    conditions: &[String],
    columns: &[String],
    format: Format,
) -> Result<(), Ending> {
    let (folder, manifest) = last_run(study, places)?;
    let records: Vec<&TableRecord> = manifest.stages.iter().flat_map(|stage| &stage.tables).collect();
    let Some(name) = name else {
        let width = records.iter().map(|record| record.name.len()).max().unwrap_or(0);
        for record in records {
            out(&format!("{:width$}  {:>8} rows  {}\n", record.name, record.rows, record.description));
        }
        return Ok(());
    };
    let found = records.iter().find(|record| record.name == name);
    let Some(record) = found else {
        let known: Vec<&str> = records.iter().map(|record| record.name.as_str()).collect();
        return Err(Ending::Usage(format!("there is no table `{name}`; {}", suggest(name, known.iter().copied()))));
    };
    let table: Table = folder.table(record).map_err(|error| Ending::Usage(error.to_string()))?;
    out(&print::table(&table, conditions, columns, format).map_err(Ending::Usage)?);
    Ok(())
}

/// The results folder of a study and the manifest in it.
pub(super) fn last_run(study: &Study, places: &Places) -> Result<(Folder, Manifest), Ending> {
    let folder = Folder::new(&places.results, &study.name);
    let manifest = folder.manifest().ok_or_else(|| {
        let (path, file) = (folder.path().display(), study.path.display());
        Ending::Usage(format!("there are no results in {path}; first: gearstudy run {file}"))
    })?;
    Ok((folder, manifest))
}
