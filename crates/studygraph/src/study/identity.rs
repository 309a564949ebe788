//! The name that a text states for its study, and the files in a folder that state the same one.
//!
//! A valid study is not needed: a file that is refused still owns its name. Must not know: where results lie.

use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};

use super::document::{Content, Node, parse};
use super::read::LARGEST;
use crate::presence;

/// The folder whose studies are found by their names.
pub const FOLDER: &str = "studies";

/// The key at the top of a study that has its name.
const KEY: &str = "study";

/// The value of `study:` in a text; none where it has none, or is no YAML.
#[must_use]
pub fn stated_name(text: &str) -> Option<String> {
    let mut lines = text.lines().filter_map(|line| line.strip_prefix(KEY)?.strip_prefix(':'));
    if let (Some(value), None) = (lines.next(), lines.next()) {
        let value = value.split(" #").next().unwrap_or_default().trim();
        // Anything else, quotes for one, is for YAML to read.
        if !value.is_empty() && value.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-_".contains(&byte)) {
            return Some(value.to_owned());
        }
    }
    let Node { content: Content::Mapping(pairs), .. } = parse(text).ok()?? else { return None };
    pairs.into_iter().find(|pair| pair.key == KEY).and_then(|pair| match pair.node.content {
        Content::Scalar { text, .. } => Some(text),
        _ => None,
    })
}

/// The name that the study in a file states; none where there is no such file, or it states none.
///
/// # Errors
/// When the file cannot be read.
pub fn name_of(file: &Path) -> io::Result<Option<String>> {
    // A pipe would be waited for; what is too large is no study.
    let is_study = presence::metadata(file)?.is_some_and(|found| found.is_file() && found.len() <= LARGEST);
    if !is_study {
        return Ok(None);
    }
    match std::fs::read(file) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        read => Ok(stated_name(&String::from_utf8_lossy(&read?))),
    }
}

/// The YAML files in a folder, sorted; what is not a file would be waited for.
///
/// # Errors
/// When the folder cannot be read.
pub fn files_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for (path, _) in presence::entries(folder)? {
        if path.extension().is_some_and(|word| word == "yaml") && presence::is_file(&path)? {
            files.push(path);
        }
    }
    Ok(files)
}

/// The paths without those that lead to the file of another one, in the same order. Of two, a link gives way to a file.
/// Paths that cannot be followed all stay.
#[must_use]
pub fn one_path_each(paths: impl IntoIterator<Item = PathBuf>) -> Vec<PathBuf> {
    let is_link = |path: &Path| matches!(presence::link_metadata(path), Ok(Some(found)) if found.is_symlink());
    let mut kept: Vec<PathBuf> = Vec::new();
    let mut places = HashMap::new();
    for path in paths {
        let place = match presence::identity(&path) {
            Ok(Some(identity)) => *places.entry(identity).or_insert(kept.len()),
            _ => kept.len(),
        };
        match kept.get_mut(place) {
            None => kept.push(path),
            Some(known) if is_link(known) && !is_link(&path) => *known = path,
            Some(_) => {}
        }
    }
    kept
}

/// Another file beside `file` in a folder `studies` whose study has this name.
///
/// # Errors
/// When the folder cannot be read. A file in it that cannot be read has no name that is known.
pub fn namesake(file: &Path, name: &str) -> io::Result<Option<PathBuf>> {
    let folder = file.parent().unwrap_or(Path::new(""));
    if folder.file_name().is_none_or(|own| own != FOLDER) {
        return Ok(None);
    }
    let own = presence::identity(file)?;
    for other in files_in(folder)? {
        if name_of(&other).is_ok_and(|stated| stated.is_some_and(|stated| stated == name))
            && presence::identity(&other)? != own
        {
            return Ok(Some(other));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stated_name_is_found_in_every_form_of_yaml() {
        for text in [
            "study: q\nstages: {}\n",
            "title: x\nstudy: q  # which one\n",
            "# study: other\nstudy: \"q\"\n",
            "{ \"study\": \"q\", \"stages\": {} }",
            "title: \"a\n  study: other\"\nstudy: q\n",
            "study:\n  q\n",
            "study: q\nstages: [",
        ] {
            assert_eq!(stated_name(text).as_deref(), Some("q"), "{text}");
        }
        for text in ["", "stages: {}\n", "- study: q\n", "study: [q]\n", "  study: q"] {
            assert_eq!(stated_name(text).filter(|name| name != "q"), None, "{text}");
        }
    }
}
