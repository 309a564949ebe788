//! Texts that every file which is published can hold, and names that every file system takes.
//!
//! HDF5 ends words at U+0000, XML and so SVG has no control characters besides tab and line ends, and neither U+FFFE nor
//! U+FFFF. A lone carriage return is a line end to some readers and none to others. Must not know: what a text is for.

use std::borrow::Cow;

/// Whether some of the files that are published cannot hold a character as it is.
#[must_use]
pub fn is_unfit(character: char) -> bool {
    let control = character.is_control() && character != '\n' && character != '\t';
    control || matches!(character, '\u{fffe}' | '\u{ffff}')
}

/// The first such character, and the byte where it stands.
#[must_use]
pub fn unfit(text: &str) -> Option<(usize, char)> {
    text.char_indices().find(|(_, character)| is_unfit(*character))
}

/// A character by its number: it cannot be shown.
#[must_use]
pub fn number(character: char) -> String {
    let name = match character {
        '\0' => " (NUL)",
        '\r' => " (carriage return)",
        '\u{1b}' => " (escape)",
        _ => "",
    };
    code_point(character) + name
}

/// Characters that a reader cannot see, or cannot tell from a space: of Unicode 16 the control characters (`Cc`), the format
/// characters (`Cf`, with those of `Bidi_Control`), `Default_Ignorable_Code_Point`, and `White_Space` but for U+0020; those that no
/// font has a shape for, of private use (`Co`) and `Noncharacter_Code_Point`; U+FFFC, which stands for an object; and U+2800, a
/// pattern of no dots. In order.
const INVISIBLE: [(char, char); 47] = [
    ('\0', '\u{1f}'),
    ('\u{7f}', '\u{a0}'),
    ('\u{ad}', '\u{ad}'),
    ('\u{34f}', '\u{34f}'),
    ('\u{600}', '\u{605}'),
    ('\u{61c}', '\u{61c}'),
    ('\u{6dd}', '\u{6dd}'),
    ('\u{70f}', '\u{70f}'),
    ('\u{890}', '\u{891}'),
    ('\u{8e2}', '\u{8e2}'),
    ('\u{115f}', '\u{1160}'),
    ('\u{1680}', '\u{1680}'),
    ('\u{17b4}', '\u{17b5}'),
    ('\u{180b}', '\u{180f}'),
    ('\u{2000}', '\u{200f}'),
    ('\u{2028}', '\u{202f}'),
    ('\u{205f}', '\u{206f}'),
    ('\u{2800}', '\u{2800}'),
    ('\u{3000}', '\u{3000}'),
    ('\u{3164}', '\u{3164}'),
    ('\u{e000}', '\u{f8ff}'),
    ('\u{fdd0}', '\u{fdef}'),
    ('\u{fe00}', '\u{fe0f}'),
    ('\u{feff}', '\u{feff}'),
    ('\u{ffa0}', '\u{ffa0}'),
    ('\u{fff0}', '\u{fffc}'),
    ('\u{fffe}', '\u{ffff}'),
    ('\u{110bd}', '\u{110bd}'),
    ('\u{110cd}', '\u{110cd}'),
    ('\u{13430}', '\u{1343f}'),
    ('\u{1bca0}', '\u{1bca3}'),
    ('\u{1d173}', '\u{1d17a}'),
    ('\u{1fffe}', '\u{1ffff}'),
    ('\u{2fffe}', '\u{2ffff}'),
    ('\u{3fffe}', '\u{3ffff}'),
    ('\u{4fffe}', '\u{4ffff}'),
    ('\u{5fffe}', '\u{5ffff}'),
    ('\u{6fffe}', '\u{6ffff}'),
    ('\u{7fffe}', '\u{7ffff}'),
    ('\u{8fffe}', '\u{8ffff}'),
    ('\u{9fffe}', '\u{9ffff}'),
    ('\u{afffe}', '\u{affff}'),
    ('\u{bfffe}', '\u{bffff}'),
    ('\u{cfffe}', '\u{cffff}'),
    ('\u{dfffe}', '\u{dffff}'),
    ('\u{e0000}', '\u{e0fff}'),
    ('\u{efffe}', '\u{10ffff}'),
];

/// Whether a message shows a character by its number, since nobody would see it.
#[must_use]
pub fn is_invisible(character: char) -> bool {
    let at = INVISIBLE.partition_point(|(_, last)| *last < character);
    INVISIBLE.get(at).is_some_and(|(first, _)| *first <= character)
}

/// A text in which everything can be seen: `U+200B` stands for an invisible character. Line ends, tabs, and the narrow space
/// U+202F, which this program sets before units, stay.
#[must_use]
pub fn visible(text: &str) -> Cow<'_, str> {
    let is_hidden = |character: char| is_invisible(character) && !matches!(character, '\n' | '\t' | '\u{202f}');
    if !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    for character in text.chars() {
        if is_hidden(character) {
            shown.push_str(&code_point(character));
        } else {
            shown.push(character);
        }
    }
    Cow::Owned(shown)
}

/// `U+200B`.
#[must_use]
pub fn code_point(character: char) -> String {
    format!("U+{:04X}", u32::from(character))
}

/// The marks that a merge leaves at the start of a line: of both versions, of their ancestor, between them. git writes seven of
/// them, and more where merges nest.
const MERGE_MARKS: [char; 4] = ['<', '|', '=', '>'];
const MERGE_MARK_LENGTH: usize = 7;

/// The first and the last line, counted from 1, of the first conflict of a merge in a text: from one mark to the `>>>>>>>` that ends
/// it, or to the last mark where that is gone.
#[must_use]
pub fn merge_conflict(text: &str) -> Option<(usize, usize)> {
    let marks = text.lines().enumerate().filter_map(|(at, line)| Some((at + 1, merge_mark(line)?)));
    let mut found: Option<(usize, usize)> = None;
    for (line, mark) in marks {
        found = Some((found.map_or(line, |(first, _)| first), line));
        if mark == '>' {
            break;
        }
    }
    found
}

/// The mark that a line begins with, a word of its own.
fn merge_mark(line: &str) -> Option<char> {
    let mark = line.chars().next().filter(|first| MERGE_MARKS.contains(first))?;
    let rest = line.trim_start_matches(mark);
    let is_alone = rest.is_empty() || rest.starts_with([' ', '\t', '\r']);
    (line.len() - rest.len() >= MERGE_MARK_LENGTH && is_alone).then_some(mark)
}

/// Whether Windows takes a name for a device, whatever ending follows it: no file and no folder there can have it.
#[must_use]
pub fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or(name).to_ascii_lowercase();
    let port = stem.strip_prefix("com").or_else(|| stem.strip_prefix("lpt"));
    let numbered = port.is_some_and(|digit| {
        let mut digits = digit.chars();
        digits.next().is_some_and(|digit| digit.is_ascii_digit() || "¹²³".contains(digit)) && digits.next().is_none()
    });
    numbered || matches!(stem.as_str(), "con" | "prn" | "aux" | "nul")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_unfit_but_for_line_breaks_and_tabs() {
        for fit in ["", "a\tb\nc", "µ → 1 %", "\u{2028}\u{202e}\u{feff}\u{e000}\u{10ffff}", "'\"<>&]]>-->=@"] {
            assert_eq!(unfit(fit), None, "{fit:?}");
        }
        for (text, at, number_of) in [
            ("a\0", 1, "U+0000 (NUL)"),
            ("µ\u{1b}[m", 2, "U+001B (escape)"),
            ("a\r\nb", 1, "U+000D (carriage return)"),
            ("\u{7f}", 0, "U+007F"),
            ("\u{85}", 0, "U+0085"),
            ("\u{fffe}", 0, "U+FFFE"),
        ] {
            let found = unfit(text).map(|(at, character)| (at, number(character)));
            assert_eq!(found, Some((at, number_of.to_owned())), "{text:?}");
        }
    }

    /// One character at least of each class, the first and the last of each range, and their neighbours.
    #[test]
    fn what_cannot_be_seen_is_shown_by_its_number() {
        assert!(INVISIBLE.is_sorted_by(|one, other| one.1 < other.0));
        for character in ('\0'..=char::MAX).filter(|character| character.is_control() || character.is_whitespace()) {
            assert_eq!(is_invisible(character), character != ' ', "{}", code_point(character));
        }
        let hidden = "\u{ad}\u{34f}\u{61c}\u{115f}\u{1160}\u{17b4}\u{180b}\u{180e}\u{200b}\u{200c}\u{200d}\u{200e}\u{200f}\u{202a}\
                      \u{202e}\u{2060}\u{2064}\u{2066}\u{2069}\u{206f}\u{2800}\u{3164}\u{fe00}\u{fe0f}\u{feff}\u{ffa0}\u{fff9}\u{fffb}\
                      \u{110bd}\u{13430}\u{1bca0}\u{1d173}\u{1d17a}\u{e0001}\u{e0020}\u{e007f}\u{e0100}\u{e01ef}\u{e0fff}\
                      \u{e000}\u{f8ff}\u{fdd0}\u{fdef}\u{fffc}\u{1fffe}\u{dffff}\u{efffe}\u{f0000}\u{10fffd}\u{10ffff}";
        for character in hidden.chars() {
            assert_eq!(visible(&format!("te{character}eth")), format!("te{}eth", code_point(character)));
        }
        for text in [
            "µm\t→ 1\n2",
            "25\u{202f}N·m",
            "é\u{301} \u{1f600} 中 \u{ac}\u{ae}\u{2010}\u{2027}\u{2070}\u{f900}\u{fdcf}\u{fdf0}\u{fffd}\u{1d17b}\u{e1000}",
        ] {
            assert_eq!(visible(text), text);
        }
        assert_eq!(visible("\u{1b}[2J\r\u{9b}\u{7f}"), "U+001B[2JU+000DU+009BU+007F");
    }

    #[test]
    fn a_conflict_of_a_merge_has_its_lines() {
        let two = "a: 1\n<<<<<<< HEAD\nb: 1\n=======\nb: 2\n>>>>>>> f\nc: 3\n<<<<<<< HEAD\n=======\n>>>>>>> f\n";
        assert_eq!(merge_conflict(two), Some((2, 6)));
        assert_eq!(merge_conflict(&two.replace('\n', "\r\n")), Some((2, 6)));
        let base = "<<<<<<< HEAD\n||||||| 1234567\n=======\n>>>>>>> f\n";
        assert_eq!(merge_conflict(base), Some((1, 4)));
        // Merges that nest, and what somebody who resolved it forgot.
        assert_eq!(merge_conflict("<<<<<<<<< Temporary merge branch 1\n=========\n"), Some((1, 2)));
        assert_eq!(merge_conflict("a\n>>>>>>> f\n=======\n"), Some((2, 2)));
        for none in ["", "a: 1\n", "  <<<<<<< HEAD\n", "<<: *a\n", "======\n", "=======a\n", "# =======\n", "<<<<<<\n"]
        {
            assert_eq!(merge_conflict(none), None, "{none:?}");
        }
    }

    #[test]
    fn devices_are_told_in_any_letters_and_with_any_ending() {
        for name in ["con", "NUL", "Aux", "prn.svg", "com1", "LPT9.a.parquet", "com0", "lpt³"] {
            assert!(is_device(name), "{name}");
        }
        for name in ["console", "com", "com10", "lpta", "a.con", "null", "co1", "connect.con", ""] {
            assert!(!is_device(name), "{name}");
        }
    }
}
