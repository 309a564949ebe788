//! `archive`: a study and its results as one file.
//!
//! Must not know: how the file is written.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::arguments::Places;
use super::progress::{self, out};
use super::{Ending, pages, rights};
use crate::runner::graph::Graph;
use crate::runner::standing::{self, standing};
use crate::stage::{self, kinds::KINDS};
use crate::store::archive::metadata::{Author, Description, Step, metadata};
use crate::store::archive::open::MOST_BYTES;
use crate::store::archive::pack::{Entries, pack};
use crate::store::archive::{self, METADATA, about};
use crate::store::file::{self, Durability};
use crate::store::manifest::Manifest;
use crate::store::results::{Folder, MANIFEST, held_text};
use crate::study::{Study, schema};

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
    quiet: bool,
) -> Result<(), Ending> {
    let usage = |problem: String| Ending::Usage(format!("{}: {problem}", study.name));
    refuse_to_lose(output, study, places).map_err(usage)?;
    let license = about.license.map(rights::license).transpose().map_err(Ending::Usage)?;
    let authors: Vec<Author> =
        about.authors.iter().map(|text| rights::author(text)).collect::<Result<_, _>>().map_err(Ending::Usage)?;
    let folder = Folder::new(&places.results, &study.name).telling(progress::told);
    // So that nobody publishes while the files are read.
    let _lock = folder.path().is_dir().then(|| folder.lock()).transpose().map_err(|error| usage(error.to_string()))?;
    let standing = standing(study, &folder, stage::code_digest).map_err(|error| usage(error.message))?;
    let first = |command: &str| format!("first: gearstudy {command} {}", study.path.display());
    if let Some(problem) = standing.problem() {
        return Err(usage(format!("{problem}; {}", first("run"))));
    }
    if let Some(file) = standing.absent().first() {
        return Err(usage(format!("`{file}` is not here; {}", first("run"))));
    }
    let manifest = folder
        .read_manifest()
        .map_err(|error| usage(error.to_string()))?
        .ok_or_else(|| usage(format!("there are no results; {}", first("run"))))?;
    let Some(pages) = pages::current(&folder) else {
        return Err(usage(format!("the report is not that of the last run; {}", first("report"))));
    };
    let mut entries = results(&folder, &manifest, &pages).map_err(usage)?;
    entries.insert(archive::study(&study.name), study.text.clone().into_bytes());
    entries.insert(archive::SCHEMA.to_owned(), schema::schema_text(KINDS).into_bytes());
    entries.insert(archive::CITATION.to_owned(), about::CITATION.as_bytes().to_vec());
    let steps = steps(study, &manifest).map_err(usage)?;
    let description = Description {
        manifest: &manifest,
        entries: &entries,
        steps: &steps,
        license: license.as_deref(),
        authors: &authors,
    };
    let described = metadata(&description).map_err(usage)?;
    entries.insert(METADATA.to_owned(), described);
    let bytes = pack(&entries).map_err(usage)?;
    file::write(output, &bytes, Durability::Synced).map_err(|error| Ending::Usage(error.to_string()))?;
    if !quiet {
        let size = bytes.len().div_ceil(1000);
        out(&format!("{}: {} files, {size} kB; {}\n", study.name, entries.len(), output.display()));
    }
    Ok(())
}

/// An archive replaces an archive of before and nothing else: neither the study, nor its results, nor what is no zip.
fn refuse_to_lose(output: &Path, study: &Study, places: &Places) -> Result<(), String> {
    let refused = |why: &str| Err(format!("{} is {why}; name another file with -o", output.display()));
    let full = |path: &Path| fs::canonicalize(path).ok();
    let folder = output.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if let (Some(folder), Some(results)) = (full(folder), full(&places.results))
        && folder.starts_with(&results)
    {
        return refused("inside the results");
    }
    if full(output).is_some_and(|path| full(&study.path) == Some(path)) {
        return refused("the study itself");
    }
    match fs::metadata(output) {
        Err(_) => Ok(()),
        Ok(facts) if facts.is_file() && (facts.len() == 0 || is_archive(output).unwrap_or(false)) => Ok(()),
        Ok(_) => refused("there already and no archive"),
    }
}

fn is_archive(path: &Path) -> std::io::Result<bool> {
    let mut start = [0; 4];
    fs::File::open(path)?.read_exact(&mut start)?;
    Ok(start == *b"PK\x03\x04")
}

/// The files of the last run, by their names in the archive.
fn results(folder: &Folder, manifest: &Manifest, pages: &[PathBuf]) -> Result<Entries, String> {
    let inside = archive::results(&manifest.study);
    let mut entries = Entries::new();
    let mut put = |name: &str| -> Result<(), String> {
        let path = folder.path().join(name);
        let bytes =
            file::read(&path, MOST_BYTES).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        entries.insert(format!("{inside}{name}"), bytes);
        Ok(())
    };
    put(MANIFEST)?;
    for record in &manifest.files {
        // A manifest from elsewhere may name anything; only files right here are ours.
        if Path::new(&record.file).file_name().is_none_or(|name| *name != *record.file) {
            return Err(format!("the manifest names a file elsewhere: {}", record.file));
        }
        put(&record.file)?;
    }
    for page in pages {
        put(&page.to_string_lossy())?;
    }
    for record in manifest.stages.iter().flat_map(|stage| &stage.tables) {
        let table = folder.table(record).map_err(|error| error.to_string())?;
        for file in &record.files {
            let packed = entries.get(&format!("{inside}{file}")).map(Vec::as_slice);
            if packed != held_text(&table, file).as_deref().map(str::as_bytes) {
                return Err(format!(
                    "`{file}` is not what the table `{}` says; delete it, and the next run writes it anew",
                    record.name
                ));
            }
        }
    }
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
