//! Characters that no text of a study can hold, as they are or as escapes, and where they stand.
//!
//! Titles, names, reasons and labels go into files of every format that is published. What one of those cannot hold is
//! refused before anything runs; see `text.rs` of `declare`. Must not know: fields.

use super::place::place_at;
use declare::error::{Diagnostic, Place};
use declare::text::{is_unfit, merge_conflict, number};

/// Looks through a whole file, comments too: the parser takes some of these characters for the end of the text. Line ends
/// may be of any kind.
///
/// # Errors
/// The first one that cannot stand there.
pub fn check(text: &str) -> Result<(), Diagnostic> {
    let found = text.char_indices().find(|(_, character)| *character != '\r' && is_unfit(*character));
    let refused = |(at, character): (usize, char)| cannot_hold(character).at(place_at(text, at, character.len_utf8()));
    found.map_or(Ok(()), |found| Err(refused(found)))
}

/// Looks for the marks of a merge, which the parser would take for names.
///
/// # Errors
/// The lines of the first conflict.
pub fn check_merged(text: &str) -> Result<(), Diagnostic> {
    let Some((first, last)) = merge_conflict(text) else { return Ok(()) };
    let offset = text.split_inclusive('\n').take(first - 1).map(str::len).sum();
    let length = text[offset..].lines().next().map_or(0, str::len);
    let lines = if first == last { format!("at line {first}") } else { format!("from line {first} to {last}") };
    let help = "remove the other, and the lines that begin with `<<<<<<<`, `|||||||`, `=======` or `>>>>>>>`";
    let message = format!("a merge left both versions {lines}; keep one");
    Err(Diagnostic::new(message).at(place_at(text, offset, length)).help(help))
}

pub fn cannot_hold(character: char) -> Diagnostic {
    Diagnostic::new(format!("no text of a study can hold the character {}", number(character)))
        .help("leave it out: of control characters, files of every format hold only line breaks and tabs")
}

/// Where an escape for a character stands in a text in double quotes, which begins at `place` and ends before the byte
/// `end`; where it is not found, the place of the text.
pub fn escape(text: &str, place: Place, end: usize, character: char) -> Place {
    let mut at = place.offset;
    while let Some(next) = text.get(at..end).and_then(|rest| rest.find('\\')) {
        at += next;
        let (written, length) = escaped(&text[at + 1..end]);
        if written == Some(character) {
            return place_at(text, at, 1 + length);
        }
        at += 1 + length;
    }
    place
}

/// What an escape stands for, as far as studies cannot hold it, and its bytes behind the backslash.
fn escaped(rest: &str) -> (Option<char>, usize) {
    let Some(first) = rest.chars().next() else { return (None, 0) };
    let digits = match first {
        'x' => 2,
        'u' => 4,
        'U' => 8,
        _ => 0,
    };
    let written = match first {
        '0' => Some('\0'),
        'a' => Some('\u{7}'),
        'b' => Some('\u{8}'),
        'v' => Some('\u{b}'),
        'f' => Some('\u{c}'),
        'r' => Some('\r'),
        'e' => Some('\u{1b}'),
        'N' => Some('\u{85}'),
        _ => rest.get(1..=digits).and_then(|hex| u32::from_str_radix(hex, 16).ok()).and_then(char::from_u32),
    };
    (written, first.len_utf8() + digits)
}
