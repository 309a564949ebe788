//! Rust source as the layer test sees it: without comments, the contents of strings, and test modules, and the paths
//! that are left. No parser: the few shapes of text that matter, each with a test.

/// `text` with comments and the contents of string and character literals blanked; line breaks stay.
pub fn code(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    while at < chars.len() {
        let end = match (chars[at], chars.get(at + 1)) {
            ('/', Some('/')) => find(&chars, at, |at| chars[at] == '\n'),
            ('/', Some('*')) => block_comment(&chars, at),
            ('"', _) => 1 + string(&chars, at + 1, 0),
            ('r', Some('"' | '#')) if !is_word(chars.get(at.wrapping_sub(1))) => raw_string(&chars, at),
            ('\'', Some('\\')) => 1 + find(&chars, at + 3, |at| chars[at] == '\''),
            ('\'', Some(_)) if chars.get(at + 2) == Some(&'\'') => at + 3,
            _ => at,
        };
        if end == at {
            out.push(chars[at]);
            at += 1;
        } else {
            let end = end.min(chars.len());
            out.extend(chars[at..end].iter().map(|c| if *c == '\n' { '\n' } else { ' ' }));
            at = end;
        }
    }
    out
}

fn find(chars: &[char], from: usize, wanted: impl Fn(usize) -> bool) -> usize {
    (from..chars.len()).find(|at| wanted(*at)).unwrap_or(chars.len())
}

fn is_word(c: Option<&char>) -> bool {
    c.is_some_and(|c| c.is_alphanumeric() || *c == '_')
}

fn block_comment(chars: &[char], from: usize) -> usize {
    let mut depth = 0_usize;
    let mut at = from;
    while at + 1 < chars.len() {
        match (chars[at], chars[at + 1]) {
            ('/', '*') => (depth, at) = (depth + 1, at + 2),
            ('*', '/') => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            return at;
        }
    }
    chars.len()
}

/// The place of the quote that ends a string with `hashes` hashes (without: an ordinary string with escapes).
fn string(chars: &[char], from: usize, hashes: usize) -> usize {
    let mut at = from;
    while at < chars.len() {
        match chars[at] {
            '\\' if hashes == 0 => at += 2,
            '"' if chars[at + 1..].iter().take(hashes).filter(|c| **c == '#').count() == hashes => return at,
            _ => at += 1,
        }
    }
    chars.len()
}

fn raw_string(chars: &[char], from: usize) -> usize {
    let hashes = chars[from + 1..].iter().take_while(|c| **c == '#').count();
    if chars.get(from + 1 + hashes) != Some(&'"') {
        return from; // r#type: an identifier
    }
    let start = from + 2 + hashes;
    if hashes == 0 {
        return 1 + find(chars, start, |at| chars[at] == '"');
    }
    string(chars, start, hashes) + 1 + hashes
}

/// `code` with the items under `#[cfg(test)]` blanked.
pub fn without_tests(code: &str) -> String {
    const MARK: &str = "#[cfg(test)]";
    let mut out = code.to_owned();
    let mut from = 0;
    while let Some(found) = out[from..].find(MARK) {
        let start = from + found;
        let end = item_end(&out, start + MARK.len());
        let blank: String = out[start..end].chars().map(|c| if c == '\n' { '\n' } else { ' ' }).collect();
        out.replace_range(start..end, &blank);
        from = start + blank.len();
    }
    out
}

/// Where the item that follows ends: behind its braces, or at its semicolon when that comes first.
fn item_end(code: &str, from: usize) -> usize {
    let mut depth = 0_usize;
    for (at, c) in code[from..].char_indices() {
        match c {
            ';' if depth == 0 => return from + at + 1,
            '{' => depth += 1,
            '}' if depth <= 1 => return from + at + 1,
            '}' => depth -= 1,
            _ => {}
        }
    }
    code.len()
}

/// The paths in `code` that begin with `root` (as in `crate::a::b`, or `use crate::{a::b, c}`), without the root, each
/// with its line.
pub fn paths(code: &str, root: &str) -> Vec<(usize, Vec<String>)> {
    let start = format!("{root}::");
    let mut found = Vec::new();
    for (at, _) in code.match_indices(&start) {
        let before = code[..at].chars().next_back();
        if is_word(before.as_ref()) || before == Some(':') {
            continue;
        }
        let line = 1 + code[..at].matches('\n').count();
        tree(&code[at + start.len()..], &mut Vec::new(), &mut |path| found.push((line, path.to_vec())));
    }
    found
}

/// Walks `a::b`, `a::{b, c::d}`, `*`, calling `visit` with every full path; gives the text behind.
fn tree<'a>(mut rest: &'a str, prefix: &mut Vec<String>, visit: &mut impl FnMut(&[String])) -> &'a str {
    let depth = prefix.len();
    loop {
        rest = rest.trim_start();
        if let Some(inside) = rest.strip_prefix('{') {
            rest = inside.trim_start();
            while !rest.is_empty() && !rest.starts_with('}') {
                let before = rest.len();
                rest = tree(rest, prefix, visit).trim_start();
                // `a as b` and whatever else stands before the next comma is of no interest.
                let skip = rest.find([',', '}']).unwrap_or(rest.len());
                rest = rest[skip..].strip_prefix(',').unwrap_or(&rest[skip..]).trim_start();
                if rest.len() == before {
                    break;
                }
            }
            prefix.truncate(depth);
            return rest.strip_prefix('}').unwrap_or(rest);
        }
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let word = if end == 0 && rest.starts_with('*') { "*" } else { &rest[..end] };
        if word.is_empty() {
            break;
        }
        prefix.push(word.to_owned());
        rest = &rest[word.len()..];
        match rest.trim_start().strip_prefix("::") {
            Some(more) => rest = more,
            None => break,
        }
    }
    visit(prefix);
    prefix.truncate(depth);
    rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> Vec<String> {
        paths(&code(text), "crate").into_iter().map(|(_, path)| path.join("::")).collect()
    }

    #[test]
    fn comments_and_strings_are_no_code() {
        let text =
            "a /* crate::x /* b */ c */ d // crate::y\n\"crate::z \\\" \" r#\"crate::w \" \"# '\"' 'e' '\\'' &'a f";
        assert_eq!(code(text).split_whitespace().collect::<Vec<_>>(), ["a", "d", "&'a", "f"]);
        assert_eq!(code(text).lines().count(), 2);
        assert_eq!(code("r\"\\\" x r#type for\"").trim(), "x r#type for".to_owned() + "");
    }

    #[test]
    fn test_modules_are_cut_out_and_what_follows_is_kept() {
        let text = "a;\n#[cfg(test)]\nmod tests { fn f() { {} } }\nb; #[cfg(test)] mod more; c;";
        assert_eq!(without_tests(text).split_whitespace().collect::<Vec<_>>(), ["a;", "b;", "c;"]);
        assert_eq!(without_tests(text).lines().count(), text.lines().count());
    }

    #[test]
    fn paths_of_all_shapes_are_found() {
        assert_eq!(found("use crate::a::b;"), ["a::b"]);
        assert_eq!(found("use crate::{a::b as c, d::{e, self}, f::*};"), ["a::b", "d::e", "d::self", "f::*"]);
        assert_eq!(found("fn f(x: crate::a::B<crate::c::D>) { crate::e::f(); }"), ["a::B", "c::D", "e::f"]);
        assert_eq!(found("pub(crate) fn f() {} notcrate::a::b; mac!(crate::g::h)"), ["g::h"]);
        assert_eq!(found("use crate::{\n    a::{b,\n c},\n};"), ["a::b", "a::c"]);
    }

    #[test]
    fn lines_are_counted_from_one() {
        assert_eq!(paths("\n\nuse crate::a;", "crate"), [(3, vec!["a".to_owned()])]);
    }
}
