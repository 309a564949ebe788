//! Licence and authors of an archive, as words of the command line.
//!
//! SPDX licence list: <https://spdx.org/licenses/>. ORCID iD: 16 digits, the last a check by ISO/IEC 7064:2003, MOD 11-2.
//! Must not know: what they are put into.

use declare::error::nearest;
use declare::text;
use spdx::identifiers::{EXCEPTIONS, LICENSES};
use spdx::{Expression, ParseMode};
use studygraph::store::archive::metadata::Author;

const ORCID: &str = "https://orcid.org/";

/// An SPDX expression of one or more licences, with the names and operators in the letters of the SPDX list.
///
/// # Errors
/// When a name is not in the list, with the nearest that is; when the expression is incomplete.
pub(super) fn license(text: &str) -> Result<String, String> {
    let mut expression = String::new();
    for word in text.replace('(', " ( ").replace(')', " ) ").split_whitespace() {
        if !expression.is_empty() && !expression.ends_with('(') && word != ")" {
            expression.push(' ');
        }
        expression.push_str(&identifier(word)?);
    }
    let mode = ParseMode { allow_deprecated: true, allow_postfix_plus_on_gpl: true, ..ParseMode::STRICT };
    match Expression::parse_mode(&expression, mode) {
        Ok(_) => Ok(expression),
        Err(error) => {
            let example = "for example `CC-BY-4.0`, or `MIT OR Apache-2.0`";
            Err(format!("`{text}` is no SPDX expression of licences: {}; {example}", error.reason))
        }
    }
}

/// A word of an SPDX expression as the standard writes it.
fn identifier(word: &str) -> Result<String, String> {
    if ["(", ")"].contains(&word) || is_own(word) {
        return Ok(word.to_owned());
    }
    let (name, later) = word.strip_suffix('+').map_or((word, ""), |name| (name, "+"));
    let licenses = || LICENSES.iter().map(|license| license.name);
    let known = licenses().chain(EXCEPTIONS.iter().map(|exception| exception.name)).chain(["AND", "OR", "WITH"]);
    if let Some(known) = known.into_iter().find(|known| known.eq_ignore_ascii_case(name)) {
        return Ok(format!("{known}{later}"));
    }
    // `CC-BY-4` is version 4.0; a name with other digits is another licence.
    let version = |license: &&str| license.strip_prefix(name).is_some_and(|rest| rest.starts_with('.'));
    let near = licenses().find(version).or_else(|| nearest(word, licenses()));
    let help = near.map_or_else(|| "for example `CC-BY-4.0`".to_owned(), |near| format!("did you mean `{near}`?"));
    Err(format!("`{word}` is no SPDX identifier of a licence; {help}"))
}

/// Whether a word names a licence, or an addition to one, that is not in the SPDX list, by SPDX 3.0, annex B: `LicenseRef-` or
/// `AdditionRef-` and a name of its own, and before it the document that has it, if that is another one.
fn is_own(word: &str) -> bool {
    let is_name = |text: &str, start: &str| {
        let own = text.strip_prefix(start).unwrap_or_default();
        !own.is_empty() && own.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-.".contains(&byte))
    };
    let (document, name) = word.split_once(':').unwrap_or(("DocumentRef-this", word));
    is_name(document, "DocumentRef-") && (is_name(name, "LicenseRef-") || is_name(name, "AdditionRef-"))
}

/// A name, and an ORCID iD behind it where there is one.
///
/// # Errors
/// When there is no name, or the last digit of the iD does not fit the others.
pub(super) fn author(given: &str) -> Result<Author, String> {
    let (name, orcid) = match given.trim().rsplit_once(' ') {
        Some((name, last)) if looks_like_orcid(last) => (name.trim(), Some(last.trim_start_matches(ORCID).to_owned())),
        _ => (given.trim(), None),
    };
    if let Some(character) = name.chars().find(|c| text::is_unfit(*c) || matches!(c, '\n' | '\t')) {
        let number = text::number(character);
        return Err(format!("`{given}` is not an author: a name is one line without the character {number}"));
    }
    if name.is_empty() || looks_like_orcid(name) {
        return Err(format!("`{given}` is not an author; write a name, or a name and an ORCID iD"));
    }
    if let Some(orcid) = orcid.as_ref().filter(|orcid| !is_orcid(orcid)) {
        return Err(format!("`{orcid}` is no ORCID iD: its last digit does not fit the others; is one mistyped?"));
    }
    Ok(Author { name: name.to_owned(), orcid })
}

/// Four groups of four digits.
fn looks_like_orcid(word: &str) -> bool {
    let digits: Vec<&str> = word.trim_start_matches(ORCID).split('-').collect();
    let group = |digits: &&str| digits.len() == 4 && digits.chars().all(|c| c.is_ascii_digit() || c == 'X');
    digits.len() == 4 && digits.iter().all(group)
}

/// Whether the last digit is the check of the others; `X` is ten.
fn is_orcid(orcid: &str) -> bool {
    let digits: Option<Vec<u32>> = orcid
        .chars()
        .filter(|c| *c != '-')
        .enumerate()
        .map(|(place, c)| if c == 'X' && place == 15 { Some(10) } else { c.to_digit(10) })
        .collect();
    let Some((check, others)) = digits.as_deref().and_then(<[u32]>::split_last) else { return false };
    let total = others.iter().fold(0, |total, digit| (total + digit) * 2 % 11);
    others.len() == 15 && (12 - total) % 11 == *check
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The iDs are those of <https://support.orcid.org/hc/en-us/articles/360006897674> (its example, and one with `X`).
    #[test]
    fn authors_are_names_with_or_without_an_orcid() {
        let parsed = |text| author(text).map(|author| (author.name, author.orcid));
        let orcid = Some("0000-0002-1825-0097".to_owned());
        assert_eq!(parsed("Ada Lovelace"), Ok(("Ada Lovelace".to_owned(), None)));
        assert_eq!(parsed("Ada Lovelace 0000-0002-1825-0097"), Ok(("Ada Lovelace".to_owned(), orcid.clone())));
        assert_eq!(parsed(" Ada https://orcid.org/0000-0002-1825-0097"), Ok(("Ada".to_owned(), orcid)));
        assert_eq!(parsed("Ada 0000-0002-1694-233X").unwrap().1.as_deref(), Some("0000-0002-1694-233X"));
        assert!(parsed("").is_err() && parsed("0000-0002-1825-0097").is_err());
        for wrong in ["A\0da", "Ada\nLovelace", "Ada\u{1b}[2J", "Ada\r", "\tAda\tL"] {
            let refused = parsed(wrong).is_err_and(|error| error.contains("is one line without"));
            assert_eq!(refused, wrong != "Ada\r", "{wrong:?}");
        }
        // Any one digit mistyped, and any two neighbours swapped that differ, is found.
        let right = "0000-0002-1825-0097";
        for place in (0..right.len()).filter(|place| right.as_bytes()[*place] != b'-') {
            for digit in b'0'..=b'9' {
                let mut wrong = right.as_bytes().to_vec();
                wrong[place] = digit;
                let wrong = String::from_utf8(wrong).unwrap();
                assert_eq!(is_orcid(&wrong), wrong == right, "{wrong}");
            }
        }
        assert!(parsed("Ada 0000-0002-1825-0079").unwrap_err().contains("does not fit"));
        assert!(parsed("Ada 0000-X002-1825-0097").is_err());
    }

    #[test]
    fn licences_are_those_of_the_list() {
        assert_eq!(license("CC-BY-4.0").as_deref(), Ok("CC-BY-4.0"));
        assert!(license("LGPL-2.1+").is_ok() && license("MIT").is_ok());
        assert!(license("CC-BY-4").unwrap_err().contains("did you mean `CC-BY-4.0`?"), "{:?}", license("CC-BY-4"));
        for wrong in ["", "my own", "../x", "NO-SUCH-1.0", "LicenseRef-", "LicenseRef-a_b", "DocumentRef-a:MIT"] {
            assert!(license(wrong).unwrap_err().contains("no SPDX "), "{wrong}");
        }
    }

    /// SPDX 3.0, annex B: operators and names in any letters, brackets, exceptions.
    #[test]
    fn expressions_of_several_licences_are_licences() {
        for (given, expected) in [
            ("MIT OR Apache-2.0", "MIT OR Apache-2.0"),
            ("mit or apache-2.0", "MIT OR Apache-2.0"),
            (" (MIT  OR ISC )and( CC-BY-4.0)", "(MIT OR ISC) AND (CC-BY-4.0)"),
            ("GPL-2.0-or-later WITH Classpath-exception-2.0", "GPL-2.0-or-later WITH Classpath-exception-2.0"),
            ("EUPL-1.1+", "EUPL-1.1+"),
            ("LicenseRef-own.1", "LicenseRef-own.1"),
            ("mit or DocumentRef-a:LicenseRef-b", "MIT OR DocumentRef-a:LicenseRef-b"),
        ] {
            assert_eq!(license(given).as_deref(), Ok(expected));
        }
        for wrong in
            ["MIT OR", "MIT Apache-2.0", "(MIT", "MIT)", "OR", "MIT WITH ISC", "Classpath-exception-2.0", "MIT/ISC"]
        {
            assert!(license(wrong).unwrap_err().contains("no SPDX "), "{wrong}: {:?}", license(wrong));
        }
    }
}
