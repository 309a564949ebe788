//! One YAML document of a study, of what was set from outside, and of its files: the text that manifests, archives and shards store.
//!
//! The text of the file stays as it is, and the additions follow it, before the end marker `...`, where that reads as the same
//! tree; else (a study between braces, one with its own `set` or `files`) the whole tree is written anew, without comments and
//! with aliases resolved. Must not know: fields, what any key is for.

use declare::error::Place;

use super::document::{Content, KeyValue, Node, parse};

/// The document of a text, what was added behind it, and the tree of both.
pub(super) fn stored(text: &str, added: &str, root: &Node) -> String {
    let appended = appended(text, added, root);
    let place = Place::default();
    match parse(&appended) {
        Ok(Some(read)) if read.clone().moved_to(place) == root.clone().moved_to(place) => appended,
        _ => written(root),
    }
}

/// The additions as the last keys of the text.
fn appended(text: &str, added: &str, root: &Node) -> String {
    let (own, tail) = text.split_at(end(text, root.place.offset));
    let line = own[..root.place.offset].rfind(['\n', '\r']).map_or(0, |at| at + 1);
    let first = own[line..].trim_start_matches('\u{feff}');
    let indent = &first[..first.len() - first.trim_start_matches(' ').len()];
    let mut whole = own.to_owned();
    for line in added.split_inclusive('\n') {
        if line != "\n" && !whole.is_empty() && whole.ends_with(['\n', '\r']) {
            whole += indent;
        }
        whole += line;
    }
    whole + tail
}

/// Byte at which the document ends that begins before `start`: a line that begins with `...` cannot be inside of one.
fn end(text: &str, start: usize) -> usize {
    let mut at = start;
    for line in text[start..].split_inclusive(['\n', '\r']) {
        let rest = line.strip_prefix("...");
        if at > start && rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(char::is_whitespace)) {
            break;
        }
        at += line.len();
    }
    at
}

/// A tree as YAML in block style.
fn written(root: &Node) -> String {
    let mut text = String::new();
    write(root, 0, &mut text);
    text.trim_start().to_owned()
}

fn write(node: &Node, indent: usize, into: &mut String) {
    let spaces = " ".repeat(indent);
    match &node.content {
        Content::Scalar { text, .. } if is_block(text) => {
            *into += " |2\n";
            for line in text.trim_end_matches('\n').split('\n') {
                *into += if line.is_empty() { "" } else { &spaces };
                *into += line;
                into.push('\n');
            }
        }
        Content::Scalar { text, quoted } if *quoted || text.contains('\n') => {
            *into += &format!(" {}\n", serde_json::Value::from(text.as_str()));
        }
        Content::Scalar { text, .. } => *into += &format!(" {text}\n"),
        Content::Sequence(items) if items.is_empty() => *into += " []\n",
        Content::Mapping(pairs) if pairs.is_empty() => *into += " {}\n",
        Content::Sequence(items) => {
            into.push('\n');
            for item in items {
                *into += &format!("{spaces}-");
                write(item, indent + 2, into);
            }
        }
        Content::Mapping(pairs) => {
            into.push('\n');
            for KeyValue { key, node, .. } in pairs {
                *into += &format!("{spaces}{}:", name(key));
                write(node, indent + 2, into);
            }
        }
    }
}

/// Whether a text can be written line by line: it ends with one line break, and its first line is one that blocks keep.
fn is_block(text: &str) -> bool {
    let lines = text.strip_suffix('\n');
    lines.is_some_and(|lines| !lines.is_empty() && !lines.ends_with('\n') && !lines.contains('\r'))
}

/// A key, in quotes where it could be taken for anything else.
fn name(key: &str) -> String {
    let is_plain = |character: char| character.is_ascii_alphanumeric() || matches!(character, '_' | '-' | '.');
    if key.starts_with(|character: char| character.is_ascii_alphanumeric()) && key.chars().all(is_plain) {
        key.to_owned()
    } else {
        serde_json::Value::from(key).to_string()
    }
}
