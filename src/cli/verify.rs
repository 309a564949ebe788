//! `verify`: what an archive holds, computed again and compared.
//!
//! Must not know: how anything is compared.

use std::path::Path;

use serde_json::{Value as Json, json};

use super::arguments::Limits;
use super::progress::{self, Watcher, out};
use super::scratch::Scratch;
use super::signals::stop_flag;
use super::{Ending, pages, run};
use crate::program::PROGRAM;
use declare::number::{counted, with_unit};
use studygraph::diff::model::{ColumnDiff, Difference, Extreme, TableDiff, Value};
use studygraph::diff::words;
use studygraph::runner::execute::RunError;
use studygraph::runner::options::Options;
use studygraph::runner::verify::{Agreement, Verification, Verified, VerifiedFile, VerifyError, verify as verified};
use studygraph::store::archive::open::open;

/// Says per table whether it came out as archived; differences end with code 4.
pub(super) fn verify(
    file: &Path,
    jobs: Option<usize>,
    limits: &Limits,
    as_json: bool,
    quiet: bool,
) -> Result<(), Ending> {
    let mut archive = open(file).map_err(|error| Ending::Usage(error.to_string()))?;
    let work = Scratch::new()?;
    let bars = progress::bars(quiet || as_json);
    let stop = stop_flag(bars.clone());
    // Names of stages are not known before the study is read; they are seldom longer.
    let watcher = Watcher::new(quiet || as_json, 12, bars);
    let options = Options { jobs: jobs.unwrap_or(0), limits: run::limits(limits), ..Options::default() };
    let verification =
        verified(&mut archive, work.path(), &options, &watcher, &stop, &pages::draw, &PROGRAM).map_err(|error| {
            match error {
                VerifyError::Study(error) => Ending::Invalid(error),
                VerifyError::Stopped => Ending::Stopped,
                VerifyError::Run(RunError::Beyond(found)) => Ending::Beyond(
                    found.help.iter().fold(found.message.clone(), |all, help| format!("{all}\n  help: {help}")),
                ),
                VerifyError::Failed(_) => Ending::Failed(format!("{}: {error}", file.display())),
                other => Ending::Usage(other.to_string()),
            }
        })?;
    if as_json {
        out(&format!("{:#}\n", as_value(file, &verification)));
    } else if !quiet {
        out(&as_text(&verification));
    }
    let [_, _, different] = verification.counts();
    let others = of_files(&verification)[2];
    if different == 0 && others == 0 {
        return Ok(());
    }
    let (tables, files) = (verification.tables.len(), verification.files.len());
    let mut parts = Vec::new();
    if different > 0 {
        parts.push(format!("{different} of {tables} tables came out different"));
    }
    if others > 0 {
        parts.push(format!("{others} of {files} other files are not what the tables hold"));
    }
    Err(Ending::Differs(format!("{}: {}", verification.study, parts.join("; "))))
}

/// Identical, made otherwise, different: how many files that are not tables.
fn of_files(verification: &Verification) -> [usize; 3] {
    let mut counts = [0; 3];
    for file in &verification.files {
        counts[match file.agreement {
            Agreement::Identical => 0,
            Agreement::Otherwise(_) => 1,
            Agreement::Different(_) => 2,
        }] += 1;
    }
    counts
}

/// One word for a file that is not a table, and why it is not identical.
fn word_of(file: &VerifiedFile) -> (&'static str, &str) {
    match &file.agreement {
        Agreement::Identical => ("identical", ""),
        Agreement::Otherwise(why) => ("otherwise", why),
        Agreement::Different(why) => ("different", why),
    }
}

/// One word for a table.
fn word(diff: &TableDiff) -> &'static str {
    match diff.state {
        Difference::Same => "identical",
        Difference::WithinTolerance => "within tolerance",
        Difference::Unknown | Difference::Changed | Difference::Removed | Difference::Added => "different",
    }
}

fn as_text(verification: &Verification) -> String {
    let mut text = format!("{}: {}\n", verification.study, verification.title);
    for note in &verification.notes {
        text += &format!("  note: {note}\n");
    }
    let width = verification.tables.iter().map(|table| table.name.chars().count()).max().unwrap_or(0);
    for file in verification.files.iter().filter(|file| file.agreement != Agreement::Identical) {
        let (word, why) = word_of(file);
        text += &format!("  {}: {word}: {why}\n", file.file);
    }
    for Verified { name, diff, .. } in &verification.tables {
        text += format!("  {name:width$}  {:16}  {}", word(diff), sentence(diff)).trim_end();
        text += "\n";
    }
    let [identical, within, different] = verification.counts();
    let [same, otherwise, other] = of_files(verification);
    text + &format!(
        "{0}: {1}: {identical} identical, {within} within tolerance, {different} different\n\
         {0}: {2}: {same} identical, {otherwise} made otherwise, {other} different\n",
        verification.study,
        counted(verification.tables.len(), "table"),
        counted(verification.files.len(), "other file")
    )
}

/// What is not the same; of values the one that is over its tolerance by most, or nearest to it.
fn sentence(diff: &TableDiff) -> String {
    let mut parts = Vec::new();
    if !diff.note.is_empty() {
        parts.push(diff.note.clone());
    }
    if diff.rows_added + diff.rows_removed > 0 {
        parts.push(words::rows(diff));
    }
    parts.extend(words::curves(diff).filter(|_| diff.columns.is_empty()));
    parts.extend(diff.schema.iter().filter(|change| change.differs).map(|change| {
        let values = [&change.before, &change.after].map(|value| if value.is_empty() { "–" } else { value });
        format!("column {} {}: {} → {}", change.column, change.what, values[0], values[1])
    }));
    if let Some((column, worst)) = worst(diff) {
        let (was, is) = words::pair(&worst.before, &worst.after);
        let with = |value: &str| with_unit(value, &column.unit);
        let by = relative(worst).map_or_else(String::new, |by| format!(", by {by:.2e} of it"));
        let row = words::key(&worst.key);
        parts.push(format!("worst in {} at {row}: {} archived, {} computed{by}", column.name, with(&was), with(&is)));
    }
    parts.join("; ")
}

/// The value that is over its tolerance by most, or nearest to it, and its column.
fn worst(diff: &TableDiff) -> Option<(&ColumnDiff, &Extreme)> {
    let all = diff.columns.iter().filter_map(|column| Some((column, column.largest_over.as_ref()?)));
    // The first of equals.
    all.reduce(|maximum, other| if other.1.difference > maximum.1.difference { other } else { maximum })
}

/// By how much of the larger of the two values, where both are numbers.
fn relative(worst: &Extreme) -> Option<f64> {
    match (&worst.before, &worst.after) {
        (Value::Float(a), Value::Float(b)) => {
            let (difference, size) = ((a - b).abs(), a.abs().max(b.abs()));
            Some(difference / size).filter(|share| share.is_finite())
        }
        _ => None,
    }
}

fn as_value(file: &Path, verification: &Verification) -> Json {
    let tables: Vec<Json> = verification
        .tables
        .iter()
        .map(|table| {
            let mut value = json!({ "name": table.name, "rows": table.rows, "agreement": word(&table.diff) });
            if table.diff.state != Difference::Same {
                value["why"] = json!(sentence(&table.diff));
            }
            if let Some((column, worst)) = worst(&table.diff) {
                value["worst"] = worst_value(column, worst);
            }
            value
        })
        .collect();
    let files: Vec<Json> = verification
        .files
        .iter()
        .map(|file| {
            let (word, why) = word_of(file);
            if why.is_empty() {
                json!({ "file": file.file, "agreement": word })
            } else {
                json!({ "file": file.file, "agreement": word, "why": why })
            }
        })
        .collect();
    let [identical, within, different] = verification.counts();
    json!({
        "file": file, "study": verification.study, "made_by": verification.version, "verified_by": PROGRAM.about.version,
        "notes": verification.notes, "identical": identical, "within_tolerance": within, "different": different,
        "tables": tables, "files": files,
    })
}

fn worst_value(column: &ColumnDiff, worst: &Extreme) -> Json {
    let key: serde_json::Map<String, Json> =
        worst.key.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
    json!({
        "column": column.name, "unit": column.unit, "key": key, "archived": worst.before, "computed": worst.after,
        "relative": relative(worst), "over_tolerance": worst.difference,
    })
}
