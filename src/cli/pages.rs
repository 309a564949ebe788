//! The report of a study on disk: the page, its figures, and the sentence that sums the verdicts up.
//!
//! Must not know: how anything is drawn.

use std::fs;
use std::path::{Path, PathBuf};

use super::progress::plain;
use crate::base::digest::Writer;
use crate::report::text as as_text;
use crate::report::{self, ReportError};
use crate::store::file::{self, Durability};
use crate::store::manifest::Manifest;
use crate::store::results::{Folder, MANIFEST};
use crate::table::data::Table;

const PAGE: &str = "report.html";
const FIGURES: &str = "figures";
const MARK_END: &str = "-->";

#[must_use]
pub(super) fn path(folder: &Folder) -> PathBuf {
    folder.path().join(PAGE)
}

/// Whether the page is there with its figures, and is that of the manifest as it stands: a run may have been killed
/// between the two.
#[must_use]
pub(super) fn are_current(folder: &Folder) -> bool {
    current(folder).is_some()
}

/// The page and its figures, relative to the folder, when they are those of the manifest as it stands.
#[must_use]
pub(super) fn current(folder: &Folder) -> Option<Vec<PathBuf>> {
    let page = text(&path(folder))?;
    let figures = page.lines().last()?.strip_prefix(&mark(folder))?.trim_end_matches(MARK_END);
    let figures = figures.split_whitespace().map(|name| Path::new(FIGURES).join(name));
    let files: Vec<PathBuf> = std::iter::once(PathBuf::from(PAGE)).chain(figures).collect();
    files.iter().all(|file| folder.path().join(file).is_file()).then_some(files)
}

/// None for what is no file of text.
fn text(path: &Path) -> Option<String> {
    String::from_utf8(file::read(path, file::MOST_TABLE).ok()?).ok()
}

/// How the last line of a page begins: of which manifest it is.
fn mark(folder: &Folder) -> String {
    let manifest = text(&folder.path().join(MANIFEST)).unwrap_or_default();
    format!("<!-- manifest {} figures ", Writer::new("page").text(&manifest).finish())
}

/// Draws the page and the figures of a run; one sentence about the verdicts.
///
/// # Errors
/// When a table cannot be read or a file not be written.
pub(super) fn write(folder: &Folder, manifest: &Manifest) -> Result<String, String> {
    let rendered = report::render(manifest, &|name| table(folder, manifest, name))
        .map_err(|error| damage(folder, manifest, &error).unwrap_or_else(|| error.to_string()))?;
    let _lock = folder.lock().map_err(|error| error.to_string())?;
    let figures = folder.path().join(FIGURES);
    let cannot = |path: &Path, error: &dyn std::fmt::Display| format!("cannot write {}: {error}", path.display());
    fs::create_dir_all(&figures).map_err(|error| cannot(&figures, &error))?;
    let put =
        |path: &Path, bytes: &[u8]| file::write(path, bytes, Durability::Lazy).map_err(|error| cannot(path, &error));
    file::sweep(&figures);
    file::sweep(folder.path());
    let mut page = plain(&rendered.html).into_owned() + "\n" + &mark(folder);
    for (name, svg) in &rendered.figures {
        page += &format!("{name}.svg ");
        put(&figures.join(format!("{name}.svg")), svg.as_bytes())?;
    }
    // Figures that are no more would be taken for current ones.
    for entry in fs::read_dir(&figures).map_err(|error| cannot(&figures, &error))?.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let kept = |figure: &str| rendered.figures.iter().any(|(name, _)| name == figure);
        if name.strip_suffix(".svg").is_some_and(|figure| !kept(figure)) {
            fs::remove_file(entry.path()).map_err(|error| cannot(&entry.path(), &error))?;
        }
    }
    put(&path(folder), (page + MARK_END + "\n").as_bytes())?;
    Ok(summary(folder, manifest))
}

/// What is wrong with the file of a table that a report misses although it is listed.
fn damage(folder: &Folder, manifest: &Manifest, error: &ReportError) -> Option<String> {
    let ReportError::Missing(name) = error else { return None };
    let record = manifest.stages.iter().flat_map(|stage| &stage.tables).find(|record| record.name == *name)?;
    folder.table(record).err().map(|error| error.to_string())
}

fn table(folder: &Folder, manifest: &Manifest, name: &str) -> Option<Table> {
    let record = manifest.stages.iter().flat_map(|stage| &stage.tables).find(|record| record.name == name)?;
    folder.table(record).ok()
}

/// The tables of this name that report stages gave.
fn of_reports(folder: &Folder, manifest: &Manifest, name: &str) -> Vec<Table> {
    let reports = manifest.stages.iter().filter(|stage| stage.kind == "report");
    reports.filter_map(|stage| table(folder, manifest, &format!("{}.{name}", stage.name))).collect()
}

fn summary(folder: &Folder, manifest: &Manifest) -> String {
    let mut parts = Vec::new();
    let mut all = 0;
    for counts in of_reports(folder, manifest, "verdict_counts") {
        for (word, count) in counts.texts("verdict").iter().zip(counts.integers("count")) {
            all += count;
            if *count > 0 {
                parts.push(format!("{count} {word}"));
            }
        }
    }
    match all {
        0 => String::new(),
        1 => format!("1 verdict: {}", parts.join(", ")),
        all => format!("{all} verdicts: {}", parts.join(", ")),
    }
}

/// The verdicts of a run as text.
///
/// # Errors
/// When the table of verdicts is not one.
pub(super) fn verdicts(folder: &Folder, manifest: &Manifest) -> Result<String, String> {
    let width = terminal_width();
    let tables = of_reports(folder, manifest, "verdicts");
    let shown: Result<Vec<String>, String> =
        tables.iter().map(|table| as_text::verdicts(table, width).map_err(|error| error.to_string())).collect();
    Ok(shown?.concat())
}

/// Columns of the terminal; of a page of text where there is none.
pub(super) fn terminal_width() -> u16 {
    comfy_table::Table::new().width().unwrap_or(120)
}
