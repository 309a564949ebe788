//! Lines and columns of a text.
//!
//! Must not know: what the text is.

use declare::error::Place;

/// The place of a byte, where nobody has counted lines yet.
pub fn place_at(text: &str, offset: usize, length: usize) -> Place {
    let before = &text[..offset];
    let line = before.rfind(['\n', '\r']).map_or(0, |at| at + 1);
    // A line may end in LF, CR or both; a byte order mark at the start is not a character of the first.
    let breaks = before.matches('\n').count() + before.matches('\r').count() - before.matches("\r\n").count();
    let marks = usize::from(line == 0 && before.starts_with('\u{feff}'));
    let column = before[line..].chars().count() + 1 - marks;
    Place { line: breaks + 1, column, offset, length }
}

/// A place that no text has: what is written once and used twice stands twice at one place.
pub fn mark(index: usize) -> Place {
    Place { line: usize::MAX, column: index, offset: usize::MAX, length: 0 }
}
