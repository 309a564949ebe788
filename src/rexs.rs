//! An existing gear pair from REXS, the gear industry's exchange format, as the text of a study.
//!
//! Source: FVA GmbH, REXS 1.0 to 2.0: the schema of files (`rexs-file.xsd`) and the lists of components, attributes and
//! relations (`rexs_schema_*.xml`) in the reference implementation `fva-net/rexs-api-java`, under Apache-2.0. A stage
//! relates two gears, a flank relation their flanks, a reference the material and the modifications. A tool is related by
//! `ordered_reference` to the gear up to 1.2, by `manufacturing_step` to the flank from 1.3 on. Every attribute of the stage's
//! components is reported as read, as one that follows from others, or as not supported; a default that stands for what the file
//! does not say is named. What a spur gear pair cannot have is refused, with line and column of the file: the study that comes
//! out is read, so its own limits hold. The file may come from anybody: its size, its elements and their attributes are limited,
//! its depth needs no stack (the parser has a counter), components and relations are found by id in indices, and a document type,
//! which entities come from, is refused: time goes with the size of the file.
//! Must not know: stages that are run, files.

mod around;
mod cutting;
mod gear;
mod json;
mod model;
mod modifications;
mod packed;
mod report;
mod tags;
mod ways;
mod written;

use std::fmt;
use std::path::Path;

use declare::text::merge_conflict;
use roxmltree::{Document, ParsingOptions};

use self::gear::RexsPair;
use self::model::Model;
pub use self::packed::text_of;

/// Largest file that is read \[bytes\].
pub const MOST_BYTES: usize = 64 << 20;
const MOST_NODES: u32 = 4_000_000;

/// Versions of the format whose names of attributes and relations are read.
const VERSIONS: [(u32, u32); 2] = [(1, 0), (2, 0)];

/// Characters of a message.
const LONGEST_MESSAGE: usize = 500;

/// The pair of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Imported {
    /// The text of the study, with all of the below as comments before it.
    pub study: String,
    /// Attributes by component, such as `cylindrical_gear 2: face_width`: that are in the study, that follow from those, and that
    /// have no field there.
    pub read: Vec<String>,
    pub follows: Vec<String>,
    /// Attributes that say another value than one that is read.
    pub contradicting: Vec<String>,
    pub not_supported: Vec<String>,
    /// Sentences: defaults that stand for what the file does not say, and what else is to be known.
    pub notes: Vec<String>,
}

/// Why a file cannot be used: a sentence, behind line and column where it is about a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    message: String,
    /// Byte of the file.
    at: Option<usize>,
    /// Line and column, counted from 1.
    place: Option<(u32, u32)>,
}

impl fmt::Display for Refusal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((line, column)) = self.place {
            write!(formatter, "{line}:{column}: ")?;
        }
        // Names in a file from elsewhere may be as long as the file.
        let mut shown = self.message.chars();
        formatter.write_str(&shown.by_ref().take(LONGEST_MESSAGE).collect::<String>())?;
        if shown.next().is_some() { formatter.write_str(" …") } else { Ok(()) }
    }
}

impl Refusal {
    fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), at: None, place: None }
    }

    /// The sentence behind the file's name.
    #[must_use]
    pub fn in_file(&self, file: &Path) -> String {
        let between = if self.place.is_some() { ":" } else { ": " };
        format!("{}{between}{self}", file.display())
    }

    fn maybe_at(self, at: Option<usize>) -> Self {
        Self { at: self.at.or(at), ..self }
    }
}

/// The text of a study whose first stage is the geometry of a cylindrical stage in a text of REXS, XML or JSON; `stage` is its
/// id, needed where there are several.
///
/// # Errors
/// A sentence that says what is wrong with the file, or with the pair, and where.
pub fn geometry(text: &str, stage: Option<&str>) -> Result<String, Refusal> {
    import(text, stage).map(|imported| imported.study)
}

/// The same, with what became of each attribute.
///
/// # Errors
/// As [`geometry`].
pub fn import(text: &str, stage: Option<&str>) -> Result<Imported, Refusal> {
    imported(text, stage).map_err(|refusal| merged(text).unwrap_or(refusal))
}

/// Both versions of a merge in a file that is refused. A single mark may be a line of a comment.
fn merged(text: &str) -> Option<Refusal> {
    let (first, last) = merge_conflict(text).filter(|(first, last)| first < last)?;
    let message = format!(
        "a merge left both versions from line {first} to {last}; keep one, and remove the lines that begin with `<<<<<<<`, \
         `|||||||`, `=======` or `>>>>>>>`"
    );
    Some(Refusal { place: Some((u32::try_from(first).ok()?, 1)), ..Refusal::new(message) })
}

fn imported(text: &str, stage: Option<&str>) -> Result<Imported, Refusal> {
    if text.len() > MOST_BYTES {
        return Err(too_large());
    }
    let text = text.trim_start_matches('\u{feff}');
    if text.trim_start().starts_with('{') {
        let (version, model) = json::model(text)?;
        return read(&version, &model, stage);
    }
    tags::check(text)?;
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|error| {
        let place = error.pos();
        let refusal = Refusal::new(match error {
            roxmltree::Error::DtdDetected => "it has a document type, which files of REXS have not".to_owned(),
            roxmltree::Error::NodesLimitReached => format!("it has more than {MOST_NODES} elements"),
            other => format!("it is not XML: {other}"),
        });
        Refusal { place: Some((place.row, place.col)), ..refusal }
    })?;
    let found = model::of_xml(&document).and_then(|(version, model)| read(&version, &model, stage));
    found.map_err(|refusal| {
        let place = refusal.at.map(|at| document.text_pos_at(at)).map(|place| (place.row, place.col));
        Refusal { place, ..refusal }
    })
}

fn too_large() -> Refusal {
    Refusal::new(format!("the file is larger than {} MiB", MOST_BYTES >> 20))
}

fn read(version: &str, model: &Model, stage: Option<&str>) -> Result<Imported, Refusal> {
    let mut notes = Vec::from_iter(version_note(version).map_err(|refusal| refusal.maybe_at(model.at))?);
    let pair = RexsPair::read(model, model.stage(stage)?)?;
    let (body, missing, open) = pair.text()?;
    // Names of the file are in them.
    notes.extend(pair.remarks.notes.iter().map(|note| note.replace(char::is_control, " ")));
    let fates = report::Fates::of(model, &pair.remarks.components);
    let mut head = vec![format!("# From a file of REXS {version}.")];
    head.extend(fates.lines().into_iter().chain(notes.iter().cloned()).map(|line| format!("# {line}")));
    head.extend(missing.iter().map(|what| format!("# It does not say: {what}.")));
    let study = written::with_head(head, &body, &open);
    notes.extend(missing.iter().map(|what| format!("It does not say: {what}.")));
    notes.extend(open.iter().map(|(_, what, _)| format!("It does not say: {what}; it must be filled in.")));
    let report::Fates { read, follows, contradicting, not_supported, .. } = fates;
    Ok(Imported { study, read, follows, contradicting, not_supported, notes })
}

/// A sentence about a version whose names may be others than those that are read.
fn version_note(version: &str) -> Result<Option<String>, Refusal> {
    let numbers: Option<Vec<u32>> = version.split('.').map(|part| part.parse().ok()).collect();
    let [(first, _), (last, newest)] = VERSIONS;
    match numbers.as_deref() {
        Some(&[major, minor] | &[major, minor, _]) if (first..=last).contains(&major) => {
            let is_known = major < last && minor <= 7 || major == last && minor <= newest;
            Ok((!is_known).then(|| {
                format!("Version {version} of REXS is newer than this reader, which knows 1.0 to 1.7 and 2.0: check what it did not read.")
            }))
        }
        _ => {
            let shown: String = version.escape_debug().take(16).collect();
            Err(Refusal::new(format!("its version is `{shown}`; versions 1.0 to 2.0 of REXS can be read")))
        }
    }
}
