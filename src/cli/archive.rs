//! `archive`: a study and its results as one file.
//!
//! Must not know: how the file is written.

use std::fs;
use std::io::Read;
use std::path::Path;

use serde_json::json;

use super::arguments::Places;
use super::progress::{self, out};
use super::{Ending, json, rights};
use crate::program::PROGRAM;
use crate::stage::kinds::KINDS;
use studygraph::presence;
use studygraph::runner::graph::Graph;
use studygraph::runner::standing::{self, standing_of};
use studygraph::store::archive::metadata::{Author, Description, Step, metadata};
use studygraph::store::archive::open::MOST_BYTES;
use studygraph::store::archive::pack::{Entries, pack};
use studygraph::store::archive::{self, METADATA};
use studygraph::store::file::{self, Durability};
use studygraph::store::index::{self, INDEX};
use studygraph::store::manifest::Manifest;
use studygraph::store::results::{Folder, Known, MANIFEST, here};
use studygraph::study::{Study, schema};

/// What only the user knows.
pub(super) struct About<'a> {
    /// SPDX identifier.
    pub(super) license: Option<&'a str>,
    pub(super) authors: &'a [String],
}

/// Writes the archive, or says which command must come first.
pub(super) fn archive(
    study: &Study,
    places: &Places,
    output: &Path,
    about: &About<'_>,
    as_json: bool,
    quiet: bool,
) -> Result<(), Ending> {
    let usage = |problem: String| Ending::Usage(format!("{}: {problem}", study.name));
    refuse_to_lose(output, study, places).map_err(usage)?;
    let license = about.license.map(rights::license).transpose().map_err(Ending::Usage)?;
    let authors: Vec<Author> =
        about.authors.iter().map(|text| rights::author(text)).collect::<Result<_, _>>().map_err(Ending::Usage)?;
    let folder = Folder::new(&places.results, &study.name).telling(progress::told);
    // So that nobody publishes while the files are read.
    let is_there = presence::is_folder(folder.path()).map_err(|error| usage(presence::unread(folder.path())(error)))?;
    let _lock = is_there.then(|| folder.lock()).transpose().map_err(|error| usage(error.to_string()))?;
    // Stamps are for those who look often; what goes out is read.
    let known = folder.known().map_err(|error| usage(error.to_string()))?.map(Known::without_stamps);
    let standing = standing_of(study, known.as_ref()).map_err(|error| usage(error.message))?;
    let first = |command: &str| format!("first: gearstudy {command} {}", study.path.display());
    if let Some(problem) = standing.problem() {
        return Err(usage(format!("{problem}; {}", first("run"))));
    }
    if let Some(file) = standing.pointers.first() {
        return Err(usage(format!("`{file}` {}", file::POINTER)));
    }
    if let Some(file) = standing.absent().first() {
        return Err(usage(format!("`{file}` is not here; {}", first("run"))));
    }
    let known = known.ok_or_else(|| usage(format!("there are no results; {}", first("run"))))?;
    if !standing.report {
        return Err(usage(format!("the report is not that of the last run; {}", first("report"))));
    }
    let manifest = &known.manifest;
    let mut entries = results(&folder, &known).map_err(|problem| usage(format!("{problem}; {}", first("run"))))?;
    entries.insert(archive::study(&study.name), study.text.clone().into_bytes());
    entries.insert(archive::SCHEMA.to_owned(), schema::schema_text(KINDS).into_bytes());
    entries.insert(archive::CITATION.to_owned(), PROGRAM.about.citation.as_bytes().to_vec());
    let steps = steps(study, manifest).map_err(usage)?;
    let description = Description {
        manifest,
        entries: &entries,
        steps: &steps,
        license: license.as_deref(),
        authors: &authors,
        about: &PROGRAM.about,
    };
    let described = metadata(&description).map_err(usage)?;
    entries.insert(METADATA.to_owned(), described);
    let bytes = pack(&entries).map_err(usage)?;
    file::sweep_ended(output.parent().unwrap_or(Path::new("")));
    file::write(output, &bytes, Durability::Synced).map_err(|error| Ending::Usage(error.to_string()))?;
    if as_json {
        json::answer(&json!({
            "study": study.name, "file": output.display().to_string(), "files": entries.len(), "bytes": bytes.len(),
        }));
    } else if !quiet {
        let size = bytes.len().div_ceil(1000);
        out(&format!("{}: {} files, {size} kB; {}\n", study.name, entries.len(), output.display()));
    }
    Ok(())
}

/// An archive replaces an archive of before and nothing else: neither the study, nor its results, nor what is not a
/// zip.
fn refuse_to_lose(output: &Path, study: &Study, places: &Places) -> Result<(), String> {
    let refused = |why: &str| Err(format!("{} is {why}; name another file with -o", output.display()));
    let full = |path: &Path| presence::real_path(path).map_err(presence::unread(path));
    let folder = output.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if let (Some(folder), Some(results)) = (full(folder)?, full(&places.results)?)
        && folder.starts_with(&results)
    {
        return refused("inside the results");
    }
    if let Some(path) = full(output)?
        && full(&study.path)? == Some(path)
    {
        return refused("the study itself");
    }
    match presence::metadata(output).map_err(presence::unread(output))? {
        None => Ok(()),
        Some(facts) if facts.is_file() && (facts.len() == 0 || is_archive(output).unwrap_or(false)) => Ok(()),
        Some(_) => refused("there already and no archive"),
    }
}

fn is_archive(path: &Path) -> std::io::Result<bool> {
    let mut start = [0; 4];
    fs::File::open(path)?.read_exact(&mut start)?;
    Ok(start == *b"PK\x03\x04")
}

/// The files of the last run, by their names in the archive; every one as it was written.
fn results(folder: &Folder, known: &Known) -> Result<Entries, String> {
    let inside = archive::results(&known.manifest.study);
    let read = |name: &str| {
        let path = folder.path().join(name);
        file::read(&path, MOST_BYTES).map_err(|error| format!("cannot read {}: {error}", path.display()))
    };
    let mut entries = Entries::new();
    for record in &known.manifest.files {
        let name = &record.file;
        // A manifest from elsewhere may name anything.
        if !here(name) {
            return Err(format!("the manifest names a file elsewhere: {name}"));
        }
        let bytes = read(name)?;
        if known.expected(name).is_none_or(|(_, digest)| index::digest(&bytes) != digest) {
            return Err(format!("`{name}` is not as the last run wrote it"));
        }
        entries.insert(format!("{inside}{name}"), bytes);
    }
    let bytes = known.index().clone().without_stamps().bytes().map_err(|error| error.to_string())?;
    entries.insert(format!("{inside}{INDEX}"), bytes);
    entries.insert(format!("{inside}{MANIFEST}"), read(MANIFEST)?);
    Ok(entries)
}

/// Who read what.
fn steps(study: &Study, manifest: &Manifest) -> Result<Vec<Step>, String> {
    let graph = Graph::new(study, &standing::demand(study, manifest)).map_err(|error| error.message)?;
    let step = |&node: &usize| {
        let of_study = &study.nodes[node];
        let mut reads: Vec<String> = Vec::new();
        for input in &graph.inputs[node] {
            reads.extend(input.wants.iter().map(|want| format!("{}.{}", study.nodes[input.node].name, want.table)));
        }
        reads.sort();
        reads.dedup();
        Step { stage: of_study.name.clone(), summary: of_study.kind.summary.to_owned(), reads }
    };
    Ok(graph.order.iter().map(step).collect())
}
