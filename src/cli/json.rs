//! What answers in JSON have in common. `docs/json.md` describes every shape; `tests/it/e2e/json.rs` compares.
//!
//! Shapes are kept: additions only. Must not know: any command.

use serde_json::{Map, Value, json};

use super::pages::Count;
use super::progress::out;
use declare::error::Diagnostic;
use studygraph::study::LoadError;

/// Prints an answer.
pub(super) fn answer(value: &Value) {
    out(&format!("{value:#}\n"));
}

/// Everything that is wrong with a study, in the order of the text.
pub(super) fn mistakes(error: &LoadError) -> Value {
    error.each().map(|found| mistake(error, found)).collect()
}

fn mistake(error: &LoadError, found: &Diagnostic) -> Value {
    json!({
        "file": error.path.to_string_lossy(), "line": found.place.map(|place| place.line),
        "column": found.place.map(|place| place.column), "message": found.message, "help": found.help,
    })
}

/// How many verdicts there are of each word.
pub(super) fn verdicts(counts: &[Count]) -> Value {
    let words: Map<String, Value> = counts.iter().map(|count| (count.verdict.clone(), json!(count.entries))).collect();
    Value::Object(words)
}
