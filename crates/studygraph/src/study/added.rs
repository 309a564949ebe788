//! Text behind that of a study's file: what was set from outside and the texts of its files, with places of their own.
//!
//! Must not know: what any key is for.

use super::document::{Content, Node, Shift, parse};
use super::place::place_at;
use declare::error::Diagnostic;

/// What was added behind the text of a file, so that it has places there.
pub struct Added {
    pub text: String,
    /// Bytes of the file itself.
    file: usize,
}

impl Added {
    /// Nothing behind this text yet.
    pub fn to(text: &str) -> Self {
        Self { text: text.to_owned(), file: text.len() }
    }

    pub fn behind(&self) -> &str {
        &self.text[self.file..]
    }
}

/// Entries under one key of a study that are written behind its text, in a document of their own.
pub struct Section<'a> {
    added: &'a mut Added,
    key: &'static str,
    /// Where it begins, and how many lines are before it.
    start: usize,
    lines: usize,
}

impl<'a> Section<'a> {
    pub fn new(added: &'a mut Added, key: &'static str) -> Self {
        if !added.text.ends_with(['\n', '\r']) {
            added.text.push('\n');
        }
        let (start, lines) = (added.text.len(), place_at(&added.text, added.text.len(), 0).line - 1);
        added.text += &format!("{key}:\n");
        Self { added, key, start, lines }
    }

    pub fn put(&mut self, text: &str) {
        self.added.text += text;
    }

    /// Byte behind what was put.
    pub fn end(&self) -> usize {
        self.added.text.len()
    }

    /// The line, counted from 1, in which the next byte stands.
    pub fn line(&self) -> usize {
        self.lines + 1 + self.added.text[self.start..].matches('\n').count()
    }

    /// Puts the entries into the tree of the study.
    ///
    /// # Errors
    /// When they are not YAML.
    pub fn merge(self, root: &mut Node) -> Result<(), Diagnostic> {
        let shift = Shift { bytes: self.start, lines: self.lines };
        let mut read = parse(&self.added.text[self.start..]).map_err(|mut wrong| {
            wrong.place = wrong.place.map(|place| shift.moved(place));
            wrong
        })?;
        let Some(Content::Mapping(sections)) = read.as_mut().map(|read| {
            read.shift(shift);
            &mut read.content
        }) else {
            return Ok(());
        };
        let Content::Mapping(pairs) = &mut root.content else { return Ok(()) };
        match pairs.iter_mut().find(|pair| pair.key == self.key) {
            None => pairs.append(sections),
            // What is no mapping is refused with its own message.
            Some(own) => {
                if let (Content::Mapping(own), Some(Content::Mapping(more))) =
                    (&mut own.node.content, sections.first_mut().map(|section| &mut section.node.content))
                {
                    own.append(more);
                }
            }
        }
        Ok(())
    }
}
