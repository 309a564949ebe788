//! Counts attributes and namespaces of an XML text before it is parsed: the parser compares the attributes of an element
//! with each other, and copies the namespaces of an element to what is inside it.
//!
//! One pass over the bytes. What is no XML is left to the parser, which says so better: it never gets farther than this
//! does. Must not know: what elements mean.

use super::Refusal;

/// Attributes of one element; those of REXS have five at most.
const MOST_ATTRIBUTES: usize = 100;
/// Namespaces that all elements declare; files of REXS have one or two.
const MOST_NAMESPACES: usize = 100;

/// Looks through the tags of a text.
///
/// # Errors
/// The first element with more attributes, or namespaces, than are read.
pub(super) fn check(xml: &str) -> Result<(), Refusal> {
    let bytes = xml.as_bytes();
    let (mut at, mut namespaces) = (0, 0);
    while let Some(start) = from(bytes, at, |byte| byte == b'<') {
        let rest = &bytes[start..];
        let until = |end: &str| xml[start..].find(end).map_or(bytes.len(), |found| start + found + end.len());
        at = match rest {
            [b'<', b'?', ..] => until("?>"),
            [b'<', b'!', b'-', b'-', ..] => until("-->"),
            [b'<', b'!', b'[', ..] => until("]]>"),
            [b'<', b'!' | b'/', ..] => start + 2,
            _ => tag(xml, start, &mut namespaces)?,
        };
    }
    Ok(())
}

/// Counts what stands in the tag that begins at a byte; the byte behind it.
fn tag(xml: &str, start: usize, namespaces: &mut usize) -> Result<usize, Refusal> {
    let bytes = xml.as_bytes();
    let (mut at, mut word, mut attributes) = (start + 1, start + 1, 0);
    while let Some(next) =
        from(bytes, at, |byte| matches!(byte, b'=' | b'>' | b'<' | b'"' | b'\'' | b' ' | b'\t' | b'\n' | b'\r'))
    {
        at = next + 1;
        match bytes[next] {
            b'>' => return Ok(at),
            // No tag has another one inside.
            b'<' => return Ok(next),
            quote @ (b'"' | b'\'') => {
                at = from(bytes, at, |byte| byte == quote).map_or(bytes.len(), |end| end + 1);
                word = at;
            }
            b'=' => {
                attributes += 1;
                *namespaces += usize::from(bytes[word..next].starts_with(b"xmlns"));
            }
            // A space may stand before the sign.
            _ if bytes.get(at) != Some(&b'=') && word_ends(bytes, at) => word = at,
            _ => {}
        }
        let too_many = if attributes > MOST_ATTRIBUTES {
            format!("an element has more than {MOST_ATTRIBUTES} attributes; those of REXS have a few")
        } else if *namespaces > MOST_NAMESPACES {
            format!("more than {MOST_NAMESPACES} namespaces are declared; files of REXS have one or two")
        } else {
            continue;
        };
        return Err(Refusal { place: Some(place(xml, start)), ..Refusal::new(too_many) });
    }
    Ok(bytes.len())
}

/// Whether a new word begins at a byte.
fn word_ends(bytes: &[u8], at: usize) -> bool {
    bytes.get(at).is_some_and(|byte| !byte.is_ascii_whitespace())
}

fn from(bytes: &[u8], at: usize, wanted: impl Fn(u8) -> bool) -> Option<usize> {
    bytes.get(at..)?.iter().position(|byte| wanted(*byte)).map(|found| at + found)
}

/// Line and column of a byte, counted from 1 as the parser counts them.
fn place(xml: &str, byte: usize) -> (u32, u32) {
    let before = &xml[..byte];
    let line = before.rfind('\n').map_or(0, |at| at + 1);
    let count = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
    (count(before.matches('\n').count() + 1), count(before[line..].chars().count() + 1))
}
