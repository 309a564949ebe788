//! Times and texts as a terminal shows them.
//!
//! Must not know: where they are written.

use std::borrow::Cow;

use declare::text::visible;

/// A text that no terminal takes for more than text: what would move the cursor, colour, hide or turn round is written as
/// JSON writes it. Titles, labels and cells come from files that anybody may have made.
#[must_use]
pub fn plain(text: &str) -> Cow<'_, str> {
    if is_printable_ascii(text) || !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    let shown = |mut all: String, c: char| {
        if is_hidden(c) {
            all += &format!("\\u{:04x}", u32::from(c));
        } else {
            all.push(c);
        }
        all
    };
    Cow::Owned(text.chars().fold(String::with_capacity(text.len()), shown))
}

/// A text in which everything can be seen, as [`visible`] has it.
pub(super) fn shown(text: &str) -> Cow<'_, str> {
    if is_printable_ascii(text) { Cow::Borrowed(text) } else { visible(text) }
}

/// True if a text is printable ASCII with line ends and tabs: most texts are, and this is known ten times as fast.
fn is_printable_ascii(text: &str) -> bool {
    text.bytes().all(|byte| matches!(byte, b' '..=b'~' | b'\n' | b'\t'))
}

/// Control characters but line ends and tabs, and those that turn the direction of writing round.
fn is_hidden(c: char) -> bool {
    let turns = matches!(c, '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || (c.is_control() && c != '\n' && c != '\t')
}

/// Seconds in the unit that suits them.
#[must_use]
pub fn duration(seconds: f64) -> String {
    if seconds < 0.9995e-3 {
        format!("{:.0} µs", seconds * 1e6)
    } else if seconds < 0.9995 {
        format!("{:.1} ms", seconds * 1e3)
    } else {
        format!("{seconds:.2} s")
    }
}

/// A time that is estimated, or of which nobody wants to know more: one or two digits, minutes and hours.
#[must_use]
pub fn rough(seconds: f64) -> String {
    match seconds {
        ..0.0095 => "10 ms".to_owned(),
        ..0.0995 => format!("{:.0} ms", (seconds * 100.0).round() * 10.0),
        ..0.95 => format!("{:.0} ms", (seconds * 10.0).round() * 100.0),
        ..99.5 => format!("{seconds:.0} s"),
        ..5970.0 => format!("{:.0} min", seconds / 60.0),
        ..172_800.0 => format!("{:.0} h", seconds / 3600.0),
        _ => format!("{:.0} days", seconds / 86_400.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimates_have_few_digits() {
        let shown = [0.0, 0.034, 0.26, 4.4, 61.0, 600.0, 9000.0, 400_000.0].map(rough);
        assert_eq!(shown, ["10 ms", "30 ms", "300 ms", "4 s", "61 s", "10 min", "2 h", "5 days"]);
    }

    #[test]
    fn no_text_steers_a_terminal() {
        assert_eq!(plain("µm\t→ 1\n"), "µm\t→ 1\n");
        assert_eq!(plain("\u{1b}[2J\r\u{7}\u{9b}\u{7f}a\u{202e}"), "\\u001b[2J\\u000d\\u0007\\u009b\\u007fa\\u202e");
        // In JSON it stays the same text.
        let text = "a\u{1b}\u{9b}\u{202e}\u{7f}";
        let json = serde_json::to_string(text).unwrap();
        assert_eq!(serde_json::from_str::<String>(&plain(&json)).unwrap(), text);
    }
}
