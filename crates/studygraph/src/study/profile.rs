//! Other YAML files than studies, read by declared fields with the same messages.
//!
//! Must not know: what any field means.

use std::path::Path;

use super::decode::Decoder;
use super::document::{nothing, parse};
use super::overrides::Stages;
use super::{LoadError, read};
use declare::error::Place;
use declare::parameter::Field;
use declare::record::Record;

/// Reads a file that is a mapping of these fields; messages call it `label`. An empty one has the defaults.
///
/// # Errors
/// One message for the first thing that is wrong with it.
pub fn record(path: &Path, fields: &'static [Field], label: &str) -> Result<Record, LoadError> {
    record_text(&read::read(path)?, path, fields, label)
}

/// The same of a text.
///
/// # Errors
/// As [`record`].
pub fn record_text(text: &str, path: &Path, fields: &'static [Field], label: &str) -> Result<Record, LoadError> {
    let start = Place { line: 1, column: 1, ..Place::default() };
    let read = parse(text).and_then(|root| {
        let root = root.unwrap_or_else(|| nothing(start));
        Decoder::new("nowhere here", Stages::default()).record(&root, fields, &[], label, start)
    });
    read.map_err(|wrong| LoadError::new(path, text.to_owned(), wrong))
}
