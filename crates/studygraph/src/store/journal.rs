//! What each stage of a study was last computed from: the memory that lets a run say *why* it computes.
//!
//! Kept in the cache, one file per study, so that it outlives a deleted results folder. Losing it costs explanations,
//! never results. Must not know: how keys are made.

use std::collections::HashMap;
use std::fmt;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::manifest::KeyRecord;
use declare::digest::Digest;

/// The last state of a study, as text: JSON with a line for each stage, of which only those are read that are asked for.
#[derive(Clone, PartialEq, Eq)]
pub struct Journal {
    text: Vec<u8>,
    /// Where the lines of stages lie.
    lines: Vec<Range<usize>>,
}

const BEGIN: &[u8] = b"{\"stages\":[";
const END: &[u8] = b"\n]}\n";
const NAME: &[u8] = b"{\"name\":\"";

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JournalStage {
    pub name: String,
    /// Of the last success, one per chunk.
    pub keys: Vec<KeyRecord>,
    /// The key under which the chunks are put together, where there are several.
    #[serde(default, with = "whole")]
    pub whole: Option<Digest>,
    /// The keys that failed since.
    pub failed: Vec<Failed>,
}

/// A key that failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Failed(#[serde(with = "super::hexadecimal")] pub Digest);

mod whole {
    use declare::digest::Digest;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::Failed;

    #[allow(clippy::ref_option)] // as serde calls it
    pub fn serialize<S: Serializer>(whole: &Option<Digest>, serializer: S) -> Result<S::Ok, S::Error> {
        whole.map(Failed).serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Digest>, D::Error> {
        Ok(Option::<Failed>::deserialize(deserializer)?.map(|Failed(digest)| digest))
    }
}

impl Default for Journal {
    fn default() -> Self {
        Self { text: BEGIN.to_vec(), lines: Vec::new() }
    }
}

impl fmt::Debug for Journal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&String::from_utf8_lossy(&self.text))
    }
}

impl Journal {
    #[must_use]
    pub fn of(stages: &[JournalStage]) -> Self {
        let mut journal = Self::default();
        for stage in stages {
            journal.add(stage);
        }
        journal
    }

    /// # Errors
    /// When it is none.
    pub fn parse(text: Vec<u8>) -> Result<Self, serde_json::Error> {
        #[derive(Deserialize)]
        struct Whole {
            stages: Vec<JournalStage>,
        }
        match Self::cut(&text) {
            Some(lines) => {
                let end = text.len() - END.len();
                let mut journal = Self { text, lines };
                journal.text.truncate(end);
                Ok(journal)
            }
            // Of an earlier version, on one line.
            None => serde_json::from_slice::<Whole>(&text).map(|whole| Self::of(&whole.stages)),
        }
    }

    fn cut(text: &[u8]) -> Option<Vec<Range<usize>>> {
        let inside = text.strip_prefix(BEGIN)?.strip_suffix(END)?;
        let mut lines = Vec::new();
        let mut at = BEGIN.len();
        for line in inside.split(|byte| *byte == b'\n') {
            let own = line.strip_suffix(b",").unwrap_or(line);
            if at > BEGIN.len() {
                (own.starts_with(NAME) && own.ends_with(b"}")).then_some(())?;
                lines.push(at..at + own.len());
            } else if !line.is_empty() {
                return None;
            }
            at += line.len() + 1;
        }
        Some(lines)
    }

    /// As it is written.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        [&self.text, END].concat()
    }

    pub fn add(&mut self, stage: &JournalStage) {
        self.begin();
        // What a stage holds can be written as JSON.
        let _ = serde_json::to_writer(&mut self.text, stage);
        self.end();
    }

    /// Adds a stage of another journal as it is.
    pub fn add_from(&mut self, other: &Self, place: usize) {
        self.begin();
        self.text.extend_from_slice(&other.text[other.lines[place].clone()]);
        self.end();
    }

    fn begin(&mut self) {
        self.text.extend_from_slice(if self.lines.is_empty() { b"\n" } else { b",\n" });
        self.lines.push(self.text.len()..self.text.len());
    }

    fn end(&mut self) {
        let end = self.text.len();
        self.lines.last_mut().into_iter().for_each(|line| line.end = end);
    }

    /// One stage; nothing of a line that is damaged.
    #[must_use]
    pub fn stage(&self, place: usize) -> Option<JournalStage> {
        serde_json::from_slice(&self.text[self.lines[place].clone()]).ok()
    }

    /// All stages whose lines can be read.
    pub fn stages(&self) -> impl Iterator<Item = JournalStage> {
        (0..self.lines.len()).filter_map(|place| self.stage(place))
    }

    /// The places of all stages, to look many of them up.
    #[must_use]
    pub fn by_name(&self) -> HashMap<String, usize> {
        let name = |line: &Range<usize>| {
            let rest = &self.text[line.start + NAME.len()..line.end];
            let end = rest.iter().position(|byte| *byte == b'"').unwrap_or(0);
            String::from_utf8_lossy(&rest[..end]).into_owned()
        };
        self.lines.iter().enumerate().map(|(place, line)| (name(line), place)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stage(name: &str, failed: u8) -> JournalStage {
        JournalStage { name: name.to_owned(), failed: vec![Failed(Digest([failed; 32]))], ..JournalStage::default() }
    }

    #[test]
    fn a_journal_is_read_line_by_line_and_as_earlier_versions_wrote_it() {
        let stages = [stage("a", 1), stage("b-2", 2), stage("c", 3)];
        for count in 0..=3 {
            let journal = Journal::of(&stages[..count]);
            let text = journal.bytes();
            let back = Journal::parse(text.clone()).unwrap();
            assert_eq!(back, journal);
            assert_eq!(back.stages().collect::<Vec<_>>(), stages[..count]);
            assert!(serde_json::from_slice::<serde_json::Value>(&text).unwrap()["stages"].is_array());
            let one_line: Vec<u8> = text.into_iter().filter(|byte| *byte != b'\n').collect();
            assert_eq!(Journal::parse(one_line).unwrap(), journal);
        }
        let journal = Journal::of(&stages);
        assert_eq!(journal.by_name()["b-2"], 1);
        let mut other = Journal::default();
        other.add_from(&journal, 2);
        other.add(&stages[0]);
        assert_eq!(other, Journal::of(&[stages[2].clone(), stages[0].clone()]));
    }

    #[test]
    fn a_damaged_journal_is_none_and_a_damaged_line_nothing() {
        let text = Journal::of(&[stage("a", 1), stage("b", 2)]).bytes();
        // Without its last line feed it is one still.
        for end in 0..text.len() - 1 {
            assert!(Journal::parse(text[..end].to_vec()).is_err(), "{end}");
        }
        let mut damaged = text.clone();
        let at = text.windows(2).position(|two| two == b"02").unwrap();
        damaged[at] = b'}';
        let left: Vec<String> = Journal::parse(damaged).unwrap().stages().map(|stage| stage.name).collect();
        assert_eq!(left, ["a"]);
    }
}
