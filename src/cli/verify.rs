//! `verify`: what an archive holds, computed again and compared.
//!
//! Must not know: how anything is compared.

use std::path::Path;

use serde_json::{Value, json};

use super::Ending;
use super::progress::{self, Watcher, out};
use super::run::stop_flag;
use crate::runner::agreement::{Agreement, Worst};
use crate::runner::options::Options;
use crate::runner::verify::{Verification, Verified, VerifyError, verify as run};
use crate::store::archive::about;
use crate::store::archive::open::open;
use crate::table::data::Cell;

/// Says per table whether it came out as archived; differences end with code 4.
pub(super) fn verify(file: &Path, jobs: Option<usize>, as_json: bool, quiet: bool) -> Result<(), Ending> {
    let mut archive = open(file).map_err(|error| Ending::Usage(error.to_string()))?;
    let work = tempfile::tempdir().map_err(|error| Ending::Usage(format!("no temporary folder: {error}")))?;
    let bars = progress::bars(quiet || as_json);
    let stop = stop_flag(bars.clone());
    // Names of stages are not known before the study is read; they are seldom longer.
    let watcher = Watcher::new(quiet || as_json, 12, bars);
    let options = Options { jobs: jobs.unwrap_or(0), ..Options::default() };
    let verification = run(&mut archive, work.path(), &options, &watcher, &stop).map_err(|error| match error {
        VerifyError::Study(error) => Ending::Invalid(error),
        VerifyError::Stopped => Ending::Stopped,
        VerifyError::Failed(_) => Ending::Failed(format!("{}: {error}", file.display())),
        other => Ending::Usage(other.to_string()),
    })?;
    if as_json {
        out(&format!("{:#}\n", as_value(file, &verification)));
    } else if !quiet {
        out(&as_text(&verification));
    }
    let [_, _, different] = verification.counts();
    if different == 0 {
        return Ok(());
    }
    let (tables, study) = (verification.tables.len(), &verification.study);
    Err(Ending::Differs(format!("{study}: {different} of {tables} tables came out different")))
}

/// One word for a table.
fn word(agreement: &Agreement) -> &'static str {
    match agreement {
        Agreement::Identical => "identical",
        Agreement::Within(_) => "within tolerance",
        Agreement::Different(_) | Agreement::Incomparable(_) => "different",
    }
}

fn as_text(verification: &Verification) -> String {
    let mut text = format!("{}: {}\n", verification.study, verification.title);
    for note in &verification.notes {
        text += &format!("  note: {note}\n");
    }
    let width = verification.tables.iter().map(|table| table.name.chars().count()).max().unwrap_or(0);
    for Verified { name, agreement, .. } in &verification.tables {
        let detail = match agreement {
            Agreement::Identical => String::new(),
            Agreement::Within(worst) | Agreement::Different(worst) => sentence(worst),
            Agreement::Incomparable(why) => why.clone(),
        };
        text += format!("  {name:width$}  {:16}  {detail}", word(agreement)).trim_end();
        text += "\n";
    }
    let [identical, within, different] = verification.counts();
    text + &format!(
        "{}: {} tables: {identical} identical, {within} within tolerance, {different} different\n",
        verification.study,
        verification.tables.len()
    )
}

/// The worst value, as a sentence.
fn sentence(worst: &Worst) -> String {
    let unit = if worst.unit.is_empty() { String::new() } else { format!(" {}", worst.unit) };
    let key: Vec<String> = worst.key.iter().map(|(name, value)| format!("{name}={value}")).collect();
    let row = if key.is_empty() { format!("row {}", worst.row) } else { key.join(", ") };
    let (was, is) = (&worst.recorded, &worst.computed);
    let by = if worst.absolute.is_finite() { format!(", by {:.2e} of it", worst.relative) } else { String::new() };
    format!("worst in {} at {row}: {was}{unit} archived, {is}{unit} computed{by}", worst.column)
}

fn as_value(file: &Path, verification: &Verification) -> Value {
    let tables: Vec<Value> = verification
        .tables
        .iter()
        .map(|table| {
            let mut value = json!({ "name": table.name, "rows": table.rows, "agreement": word(&table.agreement) });
            match &table.agreement {
                Agreement::Identical => {}
                Agreement::Within(worst) | Agreement::Different(worst) => value["worst"] = worst_value(worst),
                Agreement::Incomparable(why) => value["why"] = json!(why),
            }
            value
        })
        .collect();
    let [identical, within, different] = verification.counts();
    json!({
        "file": file, "study": verification.study, "made_by": verification.version, "verified_by": about::VERSION,
        "notes": verification.notes, "identical": identical, "within_tolerance": within, "different": different,
        "tables": tables,
    })
}

fn worst_value(worst: &Worst) -> Value {
    let key: serde_json::Map<String, Value> =
        worst.key.iter().map(|(name, value)| (name.clone(), cell(value))).collect();
    json!({
        "column": worst.column, "unit": worst.unit, "row": worst.row, "key": key,
        "archived": cell(&worst.recorded), "computed": cell(&worst.computed),
        "absolute": worst.absolute, "relative": worst.relative, "over_tolerance": worst.excess,
    })
}

fn cell(cell: &Cell) -> Value {
    match cell {
        Cell::Float(value) => json!(value),
        Cell::Integer(value) => json!(value),
        Cell::Text(value) => json!(value),
        Cell::Flag(value) => json!(value),
    }
}
