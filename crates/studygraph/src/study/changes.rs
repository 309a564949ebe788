//! A study with something set from outside: `--set PATH=VALUE`, `--name NAME`.
//!
//! What is set is written behind the text of the file, under the key `set`, so that the text that manifests and archives
//! keep is the whole study: read by itself, it gives the same tables. A message about it has the option for its place.
//! Must not know: the command line beyond the names of its two options.

use std::path::{Path, PathBuf};

use super::assemble::{self, LONGEST_NAME, SET};
use super::document::{Content, Node, parse};
use super::files::{self, Attached};
use super::path::FieldPath;
use super::words::quote;
use super::{LoadError, Study};
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

/// What was set behind a text, and the files that were read, and where they stand in it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    set: Vec<Change>,
    files: Vec<Attached>,
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
    let (text, changes) = whole(text, path, program, settings)?;
    let (study, wrong) = assemble::examine(&text, path, program);
    let study = study.map(|study| Study { changes: changes.clone(), ..study });
    match (Faults::all(wrong), study) {
        (Ok(()), Some(study)) => Ok(study),
        (Err(wrong), sound) => {
            let error = LoadError::new(path, text, wrong);
            Err(Refused { error, changes: Box::new(changes), sound: sound.map(Box::new) })
        }
        // What is no study has something wrong with it.
        (Ok(()), None) => Err(LoadError::new(path, text, Diagnostic::new("this is not a study")).into()),
    }
}

/// The whole text of a study: with what is set, and the files that it names.
fn whole(
    text: &str,
    path: &Path,
    program: &'static Program,
    settings: &Settings,
) -> Result<(String, Changes), LoadError> {
    let (text, mut changes) =
        if settings.is_empty() { (text.to_owned(), Changes::default()) } else { changed(text, path, settings)? };
    let Some(root) = tree(&text, program) else { return Ok((text, changes)) };
    let (text, files) = files::attach(&text, &root, path).map_err(|error| changes.placed(error))?;
    changes.files = files;
    Ok((text, changes))
}

/// The tree of a text that may name files, with what is set; none of one that is refused, by its own message.
fn tree(text: &str, program: &'static Program) -> Option<Node> {
    let root = if text.contains(FILE.name) { parse(text).ok()?? } else { return None };
    assemble::with_what_is_set(root, program.kinds).ok()
}

/// As [`super::files`].
pub(super) fn files(text: &str, path: &Path, program: &'static Program, settings: &Settings) -> Vec<PathBuf> {
    let changed = changed(text, path, settings).map_or_else(|_| text.to_owned(), |(text, _)| text);
    let named = tree(&changed, program).map_or_else(Vec::new, |root| files::named(&root));
    named.into_iter().map(|(name, _)| path.with_file_name(name)).collect()
}

impl Changes {
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
}

const OPTION: &str = "--set";
const NAME: &str = "--name";

impl Change {
    fn refused(option: &str, value: &str, offset: usize, length: usize, wrong: Diagnostic) -> LoadError {
        let column = value.get(..offset).map_or(1, |before| before.chars().count() + 1);
        let place = Place { line: 1, column, offset, length };
        LoadError::new(&PathBuf::from(format!("{option} {value}")), value.to_owned(), wrong.at(place))
    }
}

/// The text with what is set behind it.
fn changed(text: &str, path: &Path, settings: &Settings) -> Result<(String, Changes), LoadError> {
    let refused = |wrong: Diagnostic| LoadError::new(path, text.to_owned(), wrong);
    let root = parse(text).map_err(refused)?;
    let Some(root @ Node { content: Content::Mapping(_), .. }) = root else {
        // Refused with its own message.
        return Ok((text.to_owned(), Changes::default()));
    };
    let (mut whole, inside) = behind(text, &root, SET).map_err(refused)?;
    let Content::Mapping(pairs) = &root.content else { return Ok((text.to_owned(), Changes::default())) };
    let mut entries = Vec::new();
    for set in &settings.set {
        entries.push((OPTION, set.clone(), entry(set)?));
    }
    let named = settings.name.clone().map(|name| (NAME, name.clone(), ("study".to_owned(), name)));
    let own = pairs.iter().find(|pair| pair.key == "study").map(|pair| &pair.node.content);
    let is_set = entries.iter().any(|(_, _, (path, _))| path == "study");
    match (named, own) {
        (Some(named), _) => entries.insert(0, named),
        (None, Some(Content::Scalar { text, .. })) if !is_set => {
            let name = name_of(text, &settings.set);
            entries.insert(0, (NAME, name.clone(), ("study".to_owned(), name)));
        }
        _ => {}
    }
    let mut changes = Vec::new();
    for (option, value, (key, written)) in entries {
        whole += &inside;
        let from = whole.len();
        let key_length = key.len();
        whole += &format!("{key}: {written}");
        changes.push(Change { option, value, from, to: whole.len(), key: key_length });
        whole.push('\n');
    }
    Ok((whole, Changes { set: changes, files: Vec::new() }))
}

/// The text of a study up to where entries under one of its own keys can be written behind it, and by what their lines are set in.
///
/// # Errors
/// When nothing can be written there.
pub(super) fn behind(text: &str, root: &Node, key: &str) -> Result<(String, String), Diagnostic> {
    let refused = |message: &str, help: &str, place: Place| Err(Diagnostic::new(message).at(place).help(help));
    if text[root.place.offset..].starts_with('{') {
        let help = "write `study: NAME` and `stages:` on lines of their own";
        return refused("nothing can be set in a study between braces", help, root.place);
    }
    let Content::Mapping(pairs) = &root.content else { return Ok((text.to_owned(), String::new())) };
    let indent = |column: usize| " ".repeat(column.saturating_sub(1));
    let mut whole = text.trim_end_matches(['\n', '\r', ' ']).to_owned() + "\n";
    let own = pairs.iter().position(|pair| pair.key == key);
    match own.map(|own| (own + 1 == pairs.len(), &pairs[own])) {
        None => {
            let outer = indent(root.place.column);
            whole += &format!("{outer}{key}:\n");
            Ok((whole, outer + "  "))
        }
        Some((true, pair)) => match &pair.node.content {
            Content::Mapping(pairs) if !pairs.is_empty() && !text[pair.node.place.offset..].starts_with('{') => {
                Ok((whole, indent(pairs[0].place.column)))
            }
            _ => refused("nothing can be added to this", "write a path and its value on each line", pair.place),
        },
        Some((false, pair)) => {
            let last = pairs.last().map_or("stages", |pair| pair.key.as_str());
            let help = format!("put it behind `{last}`");
            refused(&format!("`{key}` must be the last key, so that more can be set"), &help, pair.place)
        }
    }
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
