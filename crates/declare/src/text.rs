//! Texts that every file which is published can hold, and names that every file system takes.
//!
//! HDF5 ends words at U+0000, XML and so SVG has no control characters besides tab and line ends, and neither U+FFFE nor
//! U+FFFF. A lone carriage return is a line end to some readers and none to others. Must not know: what a text is for.

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
    format!("U+{:04X}{name}", u32::from(character))
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
