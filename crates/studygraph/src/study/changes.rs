//! A study with something set from outside: `--set PATH=VALUE`, `--name NAME`.
//!
//! What is set is merged into the tree of the file, under the key `set`, with places behind its text; a message about it has
//! the option for its place. The text that manifests and archives store is one document of the whole study (`stored.rs`):
//! read by itself, it gives the same tables.
//! Must not know: the command line beyond the names of its two options.

use std::path::{Path, PathBuf};

use super::added::{Added, Section};
use super::assemble::{self, LONGEST_NAME, SET};
use super::document::{Content, Node, parse};
use super::files::{self, Attached};
use super::path::FieldPath;
use super::words::quote;
use super::{LoadError, Study, stored};
use crate::program::Program;
use declare::digest::Writer;
use declare::error::{Diagnostic, Faults, Place};
use declare::parameter::FILE;

/// What is to be set.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// Each as `PATH=VALUE`.
    pub set: Vec<String>,
    /// How the study is called then; without one its own name gets the start of a digest of what is set.
    pub name: Option<String>,
}

impl Settings {
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.set.is_empty() && self.name.is_none()
    }
}

/// What was set beside a text, and the files that were read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    set: Vec<Change>,
    files: Vec<Attached>,
    /// The text in which places count, that of the file and what was added behind it; empty where the study's own text is that.
    text: String,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Change {
    /// As on the command line: the option, and its value.
    option: &'static str,
    value: String,
    /// Where its line begins and ends in the text of the study, and where the option's value begins in it.
    from: usize,
    to: usize,
    /// Characters by which the option's value is shorter before the path's value: `=` stands for `: `.
    key: usize,
}

/// Digits of the digest in a name.
const DIGITS: usize = 8;

/// A study that is refused.
pub struct Refused {
    error: LoadError,
    changes: Box<Changes>,
    /// The stages with which nothing is wrong, nor with any that they read from; none where that cannot be told.
    pub sound: Option<Box<Study>>,
}

impl From<LoadError> for Refused {
    fn from(error: LoadError) -> Self {
        Self { error, changes: Box::default(), sound: None }
    }
}

impl Refused {
    /// Everything that is wrong with it.
    #[must_use]
    pub fn error(self) -> LoadError {
        self.changes.placed(self.error)
    }

    /// The same with what was found out about what is sound of it.
    #[must_use]
    pub fn with(self, found: Vec<Diagnostic>) -> LoadError {
        let LoadError { path, text, diagnostic, mut others, .. } = self.error;
        others.extend(found);
        self.changes.placed(LoadError::new(&path, text, Faults { first: diagnostic, others }))
    }
}

/// Makes a study of a text and what is set.
///
/// # Errors
/// All that is wrong with it.
pub fn examine(text: &str, path: &Path, program: &'static Program, settings: &Settings) -> Result<Study, Refused> {
    let Whole { root, added: Added { text: shown, .. }, stored, changes } = Whole::of(text, path, program, settings)?;
    let (study, wrong) = assemble::examine(root, &shown, path, program);
    let changes = Changes { text: if shown == stored { String::new() } else { shown.clone() }, ..changes };
    match (Faults::all(wrong), study) {
        (Ok(()), Some(study)) => Ok(Study { text: stored, changes, ..study }),
        (Err(wrong), sound) => {
            let error = LoadError::new(path, shown, wrong);
            let sound = sound.map(|study| Box::new(Study { changes: changes.clone(), text: stored, ..study }));
            Err(Refused { error, changes: Box::new(changes), sound })
        }
        // What is no study has something wrong with it.
        (Ok(()), None) => Err(LoadError::new(path, shown, Diagnostic::new("this is not a study")).into()),
    }
}

/// A study with what is set, and the files that it names.
struct Whole {
    root: Option<Node>,
    added: Added,
    /// One YAML document of all of it.
    stored: String,
    changes: Changes,
}

impl Whole {
    fn of(text: &str, path: &Path, program: &'static Program, settings: &Settings) -> Result<Self, LoadError> {
        let refused = |wrong: Diagnostic| LoadError::new(path, text.to_owned(), wrong);
        let mut root = parse(text).map_err(refused)?;
        let mut added = Added::to(text);
        let mut changes = Changes::default();
        if let Some(root) = root.as_mut().filter(|root| root.is_mapping()) {
            changed(root, &mut added, path, settings, &mut changes)?;
            if added.text.contains(FILE.name)
                && let Ok(set) = assemble::with_what_is_set(root.clone(), program.kinds)
            {
                changes.files = files::attach(root, &mut added, &set, path).map_err(|error| changes.placed(error))?;
            }
        }
        let stored = match &root {
            Some(root) if added.text.len() > text.len() => stored::stored(text, added.behind(), root),
            _ => text.to_owned(),
        };
        Ok(Self { root, added, stored, changes })
    }
}

/// As [`super::files`].
pub(super) fn files(text: &str, path: &Path, program: &'static Program, settings: &Settings) -> Vec<PathBuf> {
    let Ok(Some(root)) = parse(text) else { return Vec::new() };
    let mut added = Added::to(text);
    let mut changed = root.clone();
    let is_changed = self::changed(&mut changed, &mut added, path, settings, &mut Changes::default()).is_ok();
    let root = if is_changed { changed } else { root };
    let named = assemble::with_what_is_set(root, program.kinds).map_or_else(|_| Vec::new(), |root| files::named(&root));
    named.into_iter().map(|(name, _)| path.with_file_name(name)).collect()
}

impl Changes {
    /// The files that were read beside the study.
    pub(super) fn files(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(Attached::path)
    }

    /// A message with the option or the file for its place, where it is about what that says.
    pub(super) fn placed(&self, error: LoadError) -> LoadError {
        if let Some(error) = error.each().find_map(|wrong| self.files.iter().find_map(|file| file.placed(wrong))) {
            return error;
        }
        let about = |wrong: &Diagnostic| {
            let place = wrong.place?;
            let change = self.set.iter().find(|change| (change.from..=change.to).contains(&place.offset))?;
            Some((change, place, wrong.clone()))
        };
        // What was set last is the likeliest to be wrong.
        let Some((change, place, wrong)) = error.each().find_map(about) else { return error };
        let offset = place.offset - change.from;
        // Before the value stands `PATH=` on the command line, `PATH: ` in the text, and nothing of a name.
        let offset = if offset <= change.key { offset } else { offset - 1 };
        let offset = if change.option == NAME { 0 } else { offset.min(change.value.len()) };
        Change::refused(change.option, &change.value, offset, place.length, wrong)
    }

    /// The text in which the places of a study count whose own text is `stored`.
    pub(super) fn text<'t>(&'t self, stored: &'t str) -> &'t str {
        if self.text.is_empty() { stored } else { &self.text }
    }
}

const OPTION: &str = "--set";
const NAME: &str = "--name";
/// The key of a study that is its name.
const STUDY: &str = "study";

impl Change {
    fn refused(option: &str, value: &str, offset: usize, length: usize, wrong: Diagnostic) -> LoadError {
        let column = value.get(..offset).map_or(1, |before| before.chars().count() + 1);
        let place = Place { line: 1, column, offset, length };
        LoadError::new(&PathBuf::from(format!("{option} {value}")), value.to_owned(), wrong.at(place))
    }
}

/// Sets what is to be set in the tree of a study, and adds it behind its text.
fn changed(
    root: &mut Node,
    added: &mut Added,
    path: &Path,
    settings: &Settings,
    changes: &mut Changes,
) -> Result<(), LoadError> {
    let Content::Mapping(pairs) = &root.content else { return Ok(()) };
    let mut entries = Vec::new();
    for set in &settings.set {
        entries.push((OPTION, set.clone(), entry(set)?));
    }
    let named = settings.name.clone().map(|name| (NAME, name.clone(), (STUDY.to_owned(), name)));
    let set = pairs.iter().find(|pair| pair.key == SET).map(|pair| pair.node.clone());
    let set = if let Some(Node { content: Content::Mapping(set), .. }) = set { set } else { Vec::new() };
    // What the study sets itself is its name.
    let own = set.iter().chain(pairs).find(|pair| pair.key == STUDY).map(|pair| pair.node.content.clone());
    let is_set = entries.iter().any(|(_, _, (path, _))| path == STUDY);
    match (named, own) {
        (Some(named), _) => entries.insert(0, named),
        (None, Some(Content::Scalar { text, .. })) if !is_set && !entries.is_empty() => {
            let name = name_of(&text, &settings.set);
            entries.insert(0, (NAME, name.clone(), (STUDY.to_owned(), name)));
        }
        _ => {}
    }
    if entries.is_empty() {
        return Ok(());
    }
    let mut section = Section::new(added, SET);
    for (at, (option, value, (key, written))) in entries.iter().enumerate() {
        let first = entries[..at].iter().find(|(_, _, (earlier, _))| earlier == key);
        let first = first.map(|(option, value, _)| format!("`{option} {value}`")).or_else(|| {
            let own = set.iter().find(|own| own.key == *key && own.key != STUDY)?;
            Some(format!("in line {} of {}", own.place.line, path.display()))
        });
        if let Some(first) = first {
            let wrong = Diagnostic::new(format!("{} stands here a second time", quote(key)));
            let wrong = wrong.help(format!("the first is {first}; keep one of them"));
            return Err(Change::refused(option, value, 0, key.len(), wrong));
        }
        section.put("  ");
        let from = section.end();
        section.put(&format!("{key}: {written}"));
        changes.set.push(Change { option, value: value.clone(), from, to: section.end(), key: key.len() });
        section.put("\n");
    }
    if let Content::Mapping(pairs) = &mut root.content
        && let Some(Content::Mapping(own)) =
            pairs.iter_mut().find(|pair| pair.key == SET).map(|pair| &mut pair.node.content)
    {
        own.retain(|own| own.key != STUDY);
    }
    section.merge(root).map_err(|wrong| changes.placed(LoadError::new(path, added.text.clone(), wrong)))
}

/// Path and value of one option, both sound by themselves.
fn entry(set: &str) -> Result<(String, String), LoadError> {
    let wrong = |offset: usize, length: usize, wrong: Diagnostic| Change::refused(OPTION, set, offset, length, wrong);
    let Some((path, value)) = set.split_once('=') else {
        let help = "for example `pair.pinion.face_width=20 mm`";
        return Err(wrong(0, set.len(), Diagnostic::new("a path, `=` and a value are expected").help(help)));
    };
    let whole = Place { line: 1, column: 1, offset: 0, length: path.len() };
    FieldPath::parse(path, whole).map_err(|found| {
        let place = found.place.unwrap_or(whole);
        wrong(place.offset, place.length, found)
    })?;
    let start = path.len() + 1;
    if value.contains(['\n', '\r']) {
        return Err(wrong(
            start,
            0,
            Diagnostic::new("a value is on one line").help("lists are `[a, b]`, mappings `{ a: b }`"),
        ));
    }
    let parsed = parse(value).map_err(|found| {
        let place = found.place.unwrap_or_default();
        wrong(start + place.offset, place.length, found)
    })?;
    match parsed {
        None => Err(wrong(start, 0, Diagnostic::new(format!("{} has no value", quote(path))))),
        // What a mapping without braces says would be read as more paths.
        Some(Node { content: Content::Mapping(_) | Content::Sequence(_), place })
            if !value.trim_start().starts_with(['{', '[']) =>
        {
            let help = "put lists between `[` and `]`, mappings between `{` and `}`";
            Err(wrong(start + place.offset, place.length, Diagnostic::new("this cannot be on one line").help(help)))
        }
        Some(_) => Ok((path.to_owned(), value.to_owned())),
    }
}

/// The study's own name with the start of a digest of what is set, whatever the order: other settings, other results.
fn name_of(own: &str, set: &[String]) -> String {
    let mut sorted: Vec<&String> = set.iter().collect();
    sorted.sort();
    let digest = sorted.into_iter().fold(&mut Writer::new("gearstudy 1 set"), |writer, one| writer.text(one)).finish();
    let short: String = own.chars().take(LONGEST_NAME - DIGITS - 1).collect();
    format!("{short}-{}", &digest.to_string()[..DIGITS])
}
