//! CSV files beside a study that stand for some of its fields.
//!
//! What is read is merged into the tree of the study, under the key `files`, as what is set from outside is: the text that
//! manifests, archives and shards store is the whole study, and by itself gives the same tables. `file: NAME.csv` in a stage is then
//! what the file says (`columns.rs`). A message about it has the file for its place. Must not know: fields, what any is for.

use std::fs;
use std::path::{Component, Path, PathBuf};

use super::added::{Added, Section};
use super::columns;
use super::conditions::{Condition, file_and_conditions};
use super::document::{Content, KeyValue, Node, nothing};
use super::words::quote;
use super::{LoadError, read};
use declare::error::{Diagnostic, Place};
use declare::parameter::FILE;

/// The key of a study under which the texts of the files stand that its stages name.
pub const FILES: &str = "files";
/// The key under which the line that names the columns of a file stands where the file was named: no study can write it.
const READ: &str = "\0";
/// Columns by which a file's lines are set in below its name, and from the edge.
const INDENT: usize = 2;
const WIDTH: usize = 2 + INDENT;

/// A file whose text was written behind that of a study.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Attached {
    path: PathBuf,
    /// With LF for every line end.
    text: String,
    /// Where it begins and ends in the text of the study, the line before its first there, and by how much all are set in.
    from: usize,
    to: usize,
    line: usize,
    indent: usize,
}

impl Attached {
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// A message with this file for its place, where it is about what stands in it.
    pub(super) fn placed(&self, wrong: &Diagnostic) -> Option<LoadError> {
        let place = wrong.place.filter(|place| (self.from..self.to).contains(&place.offset))?;
        let line = place.line.saturating_sub(self.line).max(1);
        let column = place.column.saturating_sub(self.indent).max(1);
        let before: usize = self.text.split('\n').take(line - 1).map(|line| line.len() + 1).sum();
        let inside = self.text[before.min(self.text.len())..].char_indices().nth(column - 1).map_or(0, |(at, _)| at);
        let place = Place { line, column, offset: before + inside, ..place };
        Some(LoadError::new(&self.path, self.text.clone(), wrong.clone().at(place)))
    }
}

/// Whether this is what is left of the name of a file that has been put in its place.
pub(super) fn is_read(pair: &KeyValue) -> bool {
    pair.key == READ
}

/// The names of the files that a study says its stages have, where each stands first.
pub(super) fn named(root: &Node) -> Vec<(String, Place)> {
    fn walk(node: &Node, found: &mut Vec<(String, Place)>) {
        match &node.content {
            Content::Scalar { .. } => {}
            Content::Sequence(items) => items.iter().for_each(|item| walk(item, found)),
            Content::Mapping(pairs) => {
                for pair in pairs {
                    match &pair.node.content {
                        Content::Scalar { text, .. } if pair.key == FILE.name && is_csv(name_of(text)) => {
                            if !found.iter().any(|(name, _)| name == name_of(text)) {
                                found.push((name_of(text).to_owned(), pair.node.place));
                            }
                        }
                        _ => walk(&pair.node, found),
                    }
                }
            }
        }
    }
    let mut found = Vec::new();
    if let Some(stages) = pair(root, "stages") {
        walk(&stages.node, &mut found);
    }
    found
}

/// The name of a file without its conditions.
fn name_of(text: &str) -> &str {
    text.strip_suffix(']').and_then(|rest| rest.split_once('[')).map_or(text, |(name, _)| name)
}

fn is_csv(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"))
}

fn pair<'n>(root: &'n Node, key: &str) -> Option<&'n KeyValue> {
    let Content::Mapping(pairs) = &root.content else { return None };
    pairs.iter().find(|pair| pair.key == key)
}

/// Adds the text of each file that a study names and does not hold yet behind its own text and under the key `files` of its tree;
/// `set` is that tree with what is set.
///
/// # Errors
/// When one cannot be read.
pub(super) fn attach(root: &mut Node, added: &mut Added, set: &Node, path: &Path) -> Result<Vec<Attached>, LoadError> {
    let held = |name: &str| pair(root, FILES).is_some_and(|held| pair(&held.node, name).is_some());
    let missing: Vec<_> = named(set).into_iter().filter(|(name, _)| !held(name)).collect();
    if missing.is_empty() {
        return Ok(Vec::new());
    }
    let study = added.text.clone();
    let refused = |found: Diagnostic| LoadError::new(path, study.clone(), found);
    let mut section = Section::new(added, FILES);
    let mut attached = Vec::with_capacity(missing.len());
    for (name, place) in missing {
        let file = beside(path, &name).map_err(|found| refused(found.at(place)))?;
        leads_below(path, &file, &name).map_err(|found| refused(found.at(place)))?;
        let read = read::beside(&file, &name, (&study, place, path))?;
        let read = read.trim_start_matches('\u{feff}').replace("\r\n", "\n").replace('\r', "\n");
        let read = read.trim_end().to_owned();
        // A name in double quotes of JSON is one in those of YAML.
        section.put(&format!("  {}: |{INDENT}\n", serde_json::Value::from(name)));
        let (from, line) = (section.end(), section.line() - 1);
        for row in read.split('\n') {
            if !row.is_empty() {
                section.put(&format!("{:WIDTH$}{row}", ""));
            }
            section.put("\n");
        }
        // What is archived is read as one file.
        if section.end() as u64 > read::LARGEST {
            let message = format!("the study and its files together are larger than {} KiB", read::LARGEST >> 10);
            return Err(refused(Diagnostic::new(message).at(place).help("leave out points, or average them")));
        }
        attached.push(Attached { path: file, text: read, from, to: section.end(), line, indent: WIDTH });
    }
    section.merge(root).map_err(|wrong| {
        let about = attached.iter().find_map(|file| file.placed(&wrong));
        about.unwrap_or_else(|| LoadError::new(path, added.text.clone(), wrong))
    })?;
    Ok(attached)
}

/// Where the file of this name is.
fn beside(study: &Path, name: &str) -> Result<PathBuf, Diagnostic> {
    // `./` at its beginning says the same folder.
    let is_below = Path::new(name).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if !is_below || name.contains('\\') {
        let message = format!("{} does not lie beside the study, or below", quote(name));
        return Err(Diagnostic::new(message).help("move it there, and write its path from the study on, with `/`"));
    }
    Ok(study.parent().unwrap_or(Path::new("")).join(name))
}

/// Whether a file lies below the folder of the study also where links lead: what is read goes into results and archives.
fn leads_below(study: &Path, file: &Path, name: &str) -> Result<(), Diagnostic> {
    let folder = study.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // A file that is not there is reported when it is read.
    let (Ok(folder), Ok(target)) = (fs::canonicalize(folder), fs::canonicalize(file)) else { return Ok(()) };
    if target.starts_with(&folder) {
        return Ok(());
    }
    let message = format!("{} is a link that leads out of the folder of the study", quote(name));
    Err(Diagnostic::new(message).help("put a copy of the file there"))
}

/// The tree of a study with what its files say in the places where they are named; `text` is the whole of it.
///
/// # Errors
/// The first thing that is wrong with a file.
pub(super) fn expanded(mut root: Node, text: &str) -> Result<Node, Diagnostic> {
    let Some(held) = pair(&root, FILES).cloned() else { return Ok(root) };
    let Content::Mapping(held) = held.node.content else {
        let message = format!("`{FILES}` is {}; a mapping from names to texts is expected", held.node.describe());
        return Err(Diagnostic::new(message).at(held.node.place));
    };
    if let Content::Mapping(pairs) = &mut root.content
        && let Some(stages) = pairs.iter_mut().find(|pair| pair.key == "stages")
    {
        expand(&mut stages.node, &held, text)?;
    }
    Ok(root)
}

fn expand(node: &mut Node, held: &[KeyValue], whole: &str) -> Result<(), Diagnostic> {
    match &mut node.content {
        Content::Scalar { .. } => Ok(()),
        Content::Sequence(items) => items.iter_mut().try_for_each(|item| expand(item, held, whole)),
        Content::Mapping(pairs) => {
            let named = pairs.iter().position(|pair| pair.key == FILE.name);
            let file = named.and_then(|at| match &pairs[at].node.content {
                Content::Scalar { text, .. } => Some((at, held.iter().find(|file| file.key == name_of(text))?, text)),
                _ => None,
            });
            if let Some((at, file, text)) = file {
                let (_, conditions) = file_and_conditions(text).map_err(|wrong| wrong.at(pairs[at].node.place))?;
                let (fields, header) = said_by(file, whole, &conditions)?;
                READ.clone_into(&mut pairs[at].key);
                pairs[at].node = nothing(header);
                for field in fields {
                    if let Some(own) = pairs.iter().find(|pair| pair.key == field.key) {
                        let message =
                            format!("{} stands in the study too, in line {}", quote(&field.key), own.place.line);
                        return Err(Diagnostic::new(message).at(field.place).help("keep one of them"));
                    }
                    pairs.push(field);
                }
            }
            pairs.iter_mut().try_for_each(|pair| expand(&mut pair.node, held, whole))
        }
    }
}

/// The fields of a file, and the line that names its columns, with their places in the whole text.
fn said_by(file: &KeyValue, whole: &str, conditions: &[Condition]) -> Result<(Vec<KeyValue>, Place), Diagnostic> {
    let Content::Scalar { text, .. } = &file.node.content else {
        let message = format!("{} is {}; the text of a file is expected", quote(&file.key), file.node.describe());
        return Err(Diagnostic::new(message).at(file.node.place).help("write it line by line behind `|`"));
    };
    let block = Block::of(file, text, whole);
    let at = |place: Place| block.as_ref().map_or(file.node.place, |block| block.place(place));
    let (mut fields, header) =
        columns::fields(text.trim_end_matches('\n'), conditions).map_err(|found| match found.place {
            Some(place) => found.at(at(place)),
            None => found.at(file.node.place),
        })?;
    for field in &mut fields {
        field.place = at(field.place);
        move_all(&mut field.node, &at);
    }
    Ok((fields, at(header)))
}

fn move_all(node: &mut Node, at: &dyn Fn(Place) -> Place) {
    node.place = at(node.place);
    match &mut node.content {
        Content::Scalar { .. } => {}
        Content::Sequence(items) => items.iter_mut().for_each(|item| move_all(item, at)),
        Content::Mapping(pairs) => {
            for pair in pairs {
                pair.place = at(pair.place);
                move_all(&mut pair.node, at);
            }
        }
    }
}

/// Lines of a file as they stand in the text of a study, below `NAME: |`.
struct Block {
    /// Where each begins there, and in the file's own text.
    starts: Vec<[usize; 2]>,
    /// By how much all are set in.
    indent: usize,
    /// The line before the first.
    line: usize,
}

impl Block {
    /// None where they are written otherwise.
    fn of(file: &KeyValue, text: &str, whole: &str) -> Option<Self> {
        let mut start = file.place.offset + whole.get(file.place.offset..)?.find('\n')? + 1;
        let (mut starts, mut own, mut indent) = (Vec::new(), 0, None);
        for line in text.trim_end_matches('\n').split('\n') {
            let written = whole.get(start..)?.split('\n').next()?;
            starts.push([start, own]);
            start += written.len() + 1;
            own += line.len() + 1;
            if !line.is_empty() {
                let before = written.trim_end_matches('\r').strip_suffix(line)?.len();
                if *indent.get_or_insert(before) != before {
                    return None;
                }
            }
        }
        Some(Self { starts, indent: indent.unwrap_or(0), line: file.place.line })
    }

    fn place(&self, inside: Place) -> Place {
        let [start, own] = self.starts[inside.line - 1];
        let offset = start + self.indent + (inside.offset - own);
        Place { line: self.line + inside.line, column: inside.column + self.indent, offset, ..inside }
    }
}
