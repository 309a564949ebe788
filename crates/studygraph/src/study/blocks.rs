//! The text of a study cut at its stages without being read: which lines belong to which stage.
//!
//! Only where that can hardly be mistaken: stages in block style below `stages:`, nothing that reaches from one into another
//! (anchors, merges), nothing besides that says something of them (`set`, `tolerances`). Whoever relies on a cut has compared
//! it with what the parser found in the same lines. Must not know: fields, kinds.

use std::collections::HashMap;
use std::hash::BuildHasher;
use std::ops::Range;

use super::document::Shift;

/// The lines of one stage, and comments up to the next one.
#[derive(Debug, PartialEq, Eq)]
pub struct Block<'a> {
    pub name: &'a str,
    pub text: &'a str,
    /// Where its name begins in the whole text.
    pub offset: usize,
    /// Where its lines begin, and how many are before them.
    start: usize,
    lines: usize,
}

/// A text cut at its stages.
#[derive(Debug)]
pub struct Blocks<'a> {
    text: &'a str,
    pub stages: Vec<Block<'a>>,
    /// What stands behind the stages, and how many lines are before it.
    tail: usize,
    lines: usize,
}

/// Keys that say nothing of single stages.
const KEYS: [&str; 4] = ["study", "title", "source", "seed"];

impl<'a> Blocks<'a> {
    /// None where the text is not plain enough.
    #[must_use]
    pub fn cut(text: &'a str) -> Option<Self> {
        if !is_plain(text.as_bytes()) {
            return None;
        }
        let mut stages: Vec<Block> = Vec::new();
        let (mut offset, mut count, mut indent) = (0, 0, 0);
        // Where the stages begin and end.
        let (mut begun, mut tail) = (false, None);
        for line in text.split_inclusive('\n') {
            let (start, lines) = (offset, count);
            offset += line.len();
            count += 1;
            let own = line.trim_start_matches(' ');
            let depth = line.len() - own.len();
            if own.trim_end().is_empty() || own.starts_with('#') {
                continue;
            }
            if depth == 0 {
                let (key, rest) = own.split_once(':')?;
                if begun && tail.is_none() {
                    tail = Some((start, lines));
                }
                if key == "stages" && !begun && is_end(rest) {
                    begun = true;
                } else if !KEYS.contains(&key) {
                    return None;
                }
            } else if begun && tail.is_none() {
                if stages.is_empty() {
                    indent = depth;
                }
                if depth < indent {
                    return None;
                }
                if depth == indent {
                    let (name, rest) = own.split_once(':')?;
                    if !is_name(name) || !(rest.starts_with(' ') || is_end(rest)) {
                        return None;
                    }
                    stages.push(Block { name, text: "", offset: start + depth, start, lines });
                }
            }
        }
        let (tail, lines) = tail.unwrap_or((text.len(), count));
        let ends: Vec<usize> = stages.iter().skip(1).map(|next| next.start).chain([tail]).collect();
        for (stage, end) in stages.iter_mut().zip(ends) {
            stage.text = &text[stage.start..end];
        }
        (!stages.is_empty()).then_some(Self { text, stages, tail, lines })
    }

    /// What is no stage's.
    #[must_use]
    pub fn rest(&self) -> [&'a str; 2] {
        let head = self.stages.first().map_or(self.tail, |first| first.start);
        [&self.text[..head], &self.text[self.tail..]]
    }

    #[must_use]
    pub fn text(&self) -> &'a str {
        self.text
    }

    /// A text of some stages alone, and where its pieces lie in the whole.
    pub(super) fn of(&self, stages: &[usize]) -> (String, Vec<Shift>) {
        let [head, tail] = self.rest();
        let (mut part, mut shifts, mut count) = (head.to_owned(), Vec::new(), head.matches('\n').count());
        let kept = stages.iter().map(|&stage| &self.stages[stage]).map(|block| (block.text, block.start, block.lines));
        for (text, start, lines) in kept.chain([(tail, self.tail, self.lines)]) {
            shifts.push(Shift { from: part.len(), bytes: start - part.len(), lines: lines - count });
            part += text;
            count += text.matches('\n').count();
        }
        (part, shifts)
    }
}

/// Whether nothing follows on a line but a comment.
fn is_end(rest: &str) -> bool {
    let own = rest.trim_start_matches(' ');
    own.trim_end().is_empty() || own.starts_with('#') && own.len() < rest.len()
}

/// Names that a look at words finds again.
fn is_name(name: &str) -> bool {
    let fits = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_' || byte == b'-';
    !name.is_empty() && name.bytes().all(fits) && !name.starts_with(['-', '_']) && !name.ends_with('-')
}

/// Whether there are no anchors, aliases and merges, no escapes, and no white space but blanks and line feeds.
fn is_plain(text: &[u8]) -> bool {
    const LOOKED_AT: [bool; 256] = {
        let (mut table, mut at) = ([false; 256], 0);
        let bytes = b"&*\\\t\r\x0b\x0c<\xef\xc2\xe2";
        while at < bytes.len() {
            table[bytes[at] as usize] = true;
            at += 1;
        }
        table
    };
    let is_fine = |(at, &byte): (usize, &u8)| match byte {
        b'&' | b'*' => {
            let before = at.checked_sub(1).map_or(b'\n', |before| text[before]);
            let opens = matches!(before, b'\n' | b' ' | b'[' | b'{' | b',' | b'(' | b':' | b'-');
            !opens || text.get(at + 1).is_none_or(|next| matches!(next, b' ' | b'\n'))
        }
        b'<' => text.get(at + 1) != Some(&b'<'),
        // A byte order mark, and line ends that are no ASCII.
        0xef => text.get(at + 1) != Some(&0xbb),
        0xc2 => text.get(at + 1) != Some(&0x85),
        0xe2 => !matches!(text.get(at + 1..at + 3), Some([0x80, 0xa8 | 0xa9])),
        _ => false,
    };
    text.iter().enumerate().filter(|(_, byte)| LOOKED_AT[usize::from(**byte)]).all(is_fine)
}

/// The stages of `known` that a text may speak of, each once, ascending: every word that is the name of one, be it meant so or
/// not.
pub fn mentions<S: BuildHasher>(text: &str, known: &HashMap<&str, u32, S>) -> Vec<u32> {
    let mut found = Vec::new();
    for word in text.split(|character: char| !is_in_name(character)).filter(|word| !word.is_empty()) {
        found.extend(known.get(word));
        // A difference of two cells is one word as well.
        if word.contains('-') {
            found.extend(parts(word).into_iter().filter_map(|part| known.get(&word[part])));
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

fn is_in_name(character: char) -> bool {
    character.is_ascii_alphanumeric() || character == '_' || character == '-'
}

/// What stands between any two dashes of a word.
fn parts(word: &str) -> Vec<Range<usize>> {
    let dashes: Vec<usize> = word.match_indices('-').map(|(at, _)| at).collect();
    let starts = [0].into_iter().chain(dashes.iter().map(|at| at + 1));
    let ends: Vec<usize> = dashes.iter().copied().chain([word.len()]).collect();
    let mut parts = Vec::new();
    for (first, start) in starts.enumerate() {
        parts.extend(ends[first..].iter().map(|&end| start..end));
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "study: s # a comment\n# another\nstages:\n\n  # of a\n  a: { kind: x,\n    of: b }\n  b-c:\n    kind: y\n\n  # of nobody\n  d:\nseed: 3\n";

    #[test]
    fn every_line_is_of_one_stage_or_of_none() {
        let blocks = Blocks::cut(TEXT).unwrap();
        let cut: Vec<(&str, &str)> = blocks.stages.iter().map(|block| (block.name, block.text)).collect();
        let texts = ["  a: { kind: x,\n    of: b }\n", "  b-c:\n    kind: y\n\n  # of nobody\n", "  d:\n"];
        assert_eq!(cut, [("a", texts[0]), ("b-c", texts[1]), ("d", texts[2])]);
        let [head, tail] = blocks.rest();
        assert_eq!(format!("{head}{}{tail}", texts.concat()), TEXT);
        for block in &blocks.stages {
            assert!(TEXT[block.offset..].starts_with(block.name));
            assert_eq!(block.lines, TEXT[..block.start].matches('\n').count());
        }
    }

    #[test]
    fn what_could_be_mistaken_is_not_cut() {
        for (was, is) in [
            ("kind: y", "kind: &y z"),
            ("kind: y", "kind: [*y]"),
            ("kind: y", "<<: { kind: y }"),
            ("kind: y", "kind: \"\\x79\""),
            ("kind: y", "kind:\ty"),
            ("\n  d:", "\n e: 1\n  d:"),
            ("\n  d:", "\n  }:\n  d:"),
            ("\n  d:", "\n  - d:"),
            ("\n  d:", "\n  \"d\":"),
            ("\n  d:", "\n  d-:"),
            ("seed", "set"),
            ("seed", "tolerances"),
            ("seed", "stages"),
            ("seed: 3", "---"),
            ("stages:\n", "stages: {\n"),
        ] {
            let text = TEXT.replacen(was, is, 1);
            assert_ne!(text, TEXT);
            assert!(Blocks::cut(&text).is_none(), "{text}");
        }
        assert!(Blocks::cut(&TEXT.replace("kind: y", "text: 3 * 4 & 5 - x*y")).is_some());
        assert!(Blocks::cut("study: a\nstages:\n").is_none());
    }

    #[test]
    fn names_are_found_wherever_they_stand() {
        let known = HashMap::from([("a", 0), ("b-c", 1), ("m10", 2), ("kind", 3)]);
        let found = |text: &str| mentions(text, &known);
        assert_eq!(found("x: a.t[k=1].v-b-c.t.v"), [0, 1]);
        assert_eq!(found("[a,a-b,b-c-m10]"), [0, 1, 2]);
        assert!(found("ab m1 m101 b c_b-cd").is_empty());
        assert_eq!(found("(m10)/'a'"), [0, 2]);
    }
}
