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

/// Largest number that a schema takes for a name: one of more digits is too long.
pub const MOST: f64 = 1e64;

/// The name that a plain scalar is to readers of YAML 1.2: a hexadecimal or octal number, and a number or a truth value that cannot be
/// a name as it is written, such as `+5` or `True`, is the same value in decimal digits or small letters. None for a number that is no
/// name in any form.
#[must_use]
pub fn plain_name(text: &str) -> Option<String> {
    if matches!(text, "True" | "TRUE" | "False" | "FALSE") {
        return Some(text.to_ascii_lowercase());
    }
    let is_name = text.len() <= 64
        && text.starts_with(|c: char| c.is_ascii_alphanumeric())
        && text.bytes().all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || b"-_".contains(&byte));
    let own = || Some(text.to_owned());
    if let Some((digits, base)) =
        [("0x", 16), ("0o", 8)].iter().find_map(|(sign, base)| Some((text.strip_prefix(sign)?, *base)))
    {
        return in_decimal_digits(digits, base).or_else(own);
    }
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    if !unsigned.is_empty() && unsigned.bytes().all(|byte| byte.is_ascii_digit()) {
        let digits = unsigned.trim_start_matches('0');
        return match (is_name, digits) {
            (false, "") => Some("0".to_owned()),
            (false, digits) if !text.starts_with('-') => Some(digits.to_owned()),
            _ => own(),
        };
    }
    let is_number = unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.')
        && unsigned.bytes().all(|byte| byte.is_ascii_digit() || b".eE+-".contains(&byte));
    let Some(value) = text.parse::<f64>().ok().filter(|_| is_number) else { return own() };
    let value = (value.fract() == 0.0 && (0.0..MOST).contains(&value)).then_some(value)?;
    if is_name { own() } else { Some(format!("{:.0}", value.abs())) }
}

/// A whole number of any length in another base; none where these are no digits of it.
fn in_decimal_digits(digits: &str, base: u32) -> Option<String> {
    // The last digit first.
    let mut decimal = vec![0];
    for digit in digits.chars() {
        let mut carry = digit.to_digit(base)?;
        for place in &mut decimal {
            carry += *place * base;
            *place = carry % 10;
            carry /= 10;
        }
        while carry > 0 {
            decimal.push(carry % 10);
            carry /= 10;
        }
    }
    let text = || decimal.iter().rev().map(u32::to_string).collect();
    (!digits.is_empty()).then(text)
}

/// The value of `study:` in a text; none where it has none, or is no YAML.
#[must_use]
pub fn stated_name(text: &str) -> Option<String> {
    let mut lines = text.lines().filter_map(|line| line.strip_prefix(KEY)?.strip_prefix(':'));
    if let (Some(value), None) = (lines.next(), lines.next()) {
        let value = value.split(" #").next().unwrap_or_default().trim();
        // Anything else, quotes for one, is for YAML to read.
        if !value.is_empty() && value.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-_".contains(&byte)) {
            return plain_name(value).or_else(|| Some(value.to_owned()));
        }
    }
    let Node { content: Content::Mapping(pairs), .. } = parse(text).ok()?? else { return None };
    pairs.into_iter().find(|pair| pair.key == KEY).and_then(|pair| match pair.node.content {
        Content::Scalar { text, quoted: false } => plain_name(&text).or(Some(text)),
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

/// The YAML files in a folder, sorted, without hidden ones: editors and other systems leave locks and copies beside a file. What is
/// not a file would be waited for.
///
/// # Errors
/// When the folder cannot be read.
pub fn files_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for (path, _) in presence::entries(folder)? {
        let is_hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
        if !is_hidden && path.extension().is_some_and(|word| word == "yaml") && presence::is_file(&path)? {
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
