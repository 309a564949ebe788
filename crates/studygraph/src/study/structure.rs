//! Where lines and brackets do not fit together: what is wrong in the words of somebody who wrote them.
//!
//! The parser tells where it stopped and which rule of YAML's grammar it could not go on with; the lines around tell
//! what was most likely meant: a line that stands between two levels, a list that goes on without its dash, a bracket
//! that is still open. Must not know: fields, stages.

use serde_saphyr::granit_parser::ErrorKind;

use super::place::place_at;
use super::words::{alternatives, quote};
use declare::error::{Diagnostic, Place};

/// The cause of what the parser refused at `place`; none where it is not one of structure.
pub fn cause(text: &str, kind: &ErrorKind, place: Place) -> Option<Diagnostic> {
    if *kind == ErrorKind::InvalidQuotedScalarIndent {
        return quote_opened(text, place);
    }
    let at = |line: &Line| place_at(text, line.offset + line.indent, line.body.len());
    let lines = Line::all(text);
    let stopped = lines.iter().position(|line| line.number >= place.line)?;
    let (line, before) = (&lines[stopped], &lines[..stopped]);
    let flow = matches!(
        kind,
        ErrorKind::ExpectedFlowMappingSeparator
            | ErrorKind::ExpectedFlowSequenceSeparator
            | ErrorKind::InvalidColonPlacement
            | ErrorKind::InvalidFlowScalarIndent
            | ErrorKind::BlockEntryInFlowCollection
            | ErrorKind::UnexpectedEofFlowMapping
            | ErrorKind::UnexpectedEofFlowSequence
    );
    if flow && let Some((bracket, offset)) = open_at(text, place.offset).bracket {
        let opened = place_at(text, offset, 1);
        let closing = if bracket == '{' { '}' } else { ']' };
        let message = format!("`{bracket}` is opened in line {} and not closed here", opened.line);
        let help = format!("close it with `{closing}`, or put a comma between its items");
        return Some(Diagnostic::new(message).at(place).help(help));
    }
    match kind {
        ErrorKind::MisplacedFlowCollectionEnd => {
            Some(Diagnostic::new("this bracket closes nothing: none like it is open").at(place).help("remove it"))
        }
        ErrorKind::MismatchedFlowCollectionEnd { open, close } => {
            let message = format!("`{open}` is opened here and closed by `{close}`");
            Some(Diagnostic::new(message).at(place))
        }
        ErrorKind::SimpleKeyExpected => Some(without_colon(line).at(at(line))),
        ErrorKind::MappingValueNotAllowed => value_below_value(line, before, place).map(|found| match found {
            Deeper(found) => found.at(at(line)),
            Above(found, above) => found.at(at(above)),
        }),
        ErrorKind::ExpectedBlockMappingKey
        | ErrorKind::ExpectedBlockSequenceEntry
        | ErrorKind::InvalidIndentation
        | ErrorKind::BlockSequenceEntryNotAllowed => match first_without_dash(line, before) {
            Some((found, first)) => Some(found.at(at(first))),
            None => between_levels(line, before).map(|found| found.at(at(line))),
        },
        _ => None,
    }
}

/// A quote that is not closed, where it opens: the parser may go on to the end of the text before it gives up.
fn quote_opened(text: &str, place: Place) -> Option<Diagnostic> {
    let (_, offset) = open_at(text, place.offset).quote?;
    let ends = text[place.offset..].trim().is_empty();
    let message =
        if ends { "a quote is opened and never closed" } else { "a quote is opened and not closed in its line" };
    Some(Diagnostic::new(message).at(place_at(text, offset, 1)))
}

/// Why a name stands in a mapping a second time, where it is more than that: a list goes on without its dash, or a name
/// above it should have what is below it, but is indented as deep.
pub fn second(text: &str, first: usize, place: Place) -> Option<String> {
    let lines = Line::all(text);
    let at = |number: usize| lines.iter().position(|line| line.number == number);
    let (first, here) = (at(first)?, at(place.line)?);
    let (line, opening) = (&lines[here], &lines[first]);
    if line.is_item() || line.indent + 1 != place.column {
        return None;
    }
    if opening.is_item() && opening.keys_at() == line.indent {
        return Some(format!("write {} for another item of the list", quote(&format!("- {}", line.body))));
    }
    let is_bare = |line: &&Line| line.body.ends_with(':') && !line.is_item();
    let between = lines[first + 1..here].iter().zip(&lines[first + 2..=here]);
    let mut empty =
        between.filter(|(above, below)| is_bare(above) && above.indent == line.indent && below.indent == line.indent);
    let (above, _) = empty.next_back()?;
    let name = quote(above.body.trim_end_matches(':'));
    Some(format!(
        "{name} in line {} is indented as deep as what follows it: indent it less, or what belongs to it further",
        above.number
    ))
}

/// A line that says something.
struct Line<'a> {
    number: usize,
    offset: usize,
    indent: usize,
    /// Without indentation, and without spaces at its end.
    body: &'a str,
}

impl<'a> Line<'a> {
    fn all(text: &'a str) -> Vec<Self> {
        let (mut offset, mut all) = (0, Vec::new());
        for (number, line) in (1..).zip(text.split_inclusive('\n')) {
            let body = line.trim();
            if !body.is_empty() && !body.starts_with('#') {
                all.push(Self { number, offset, indent: line.len() - line.trim_start().len(), body });
            }
            offset += line.len();
        }
        all
    }

    fn is_item(&self) -> bool {
        self.body == "-" || self.body.starts_with("- ")
    }

    /// Where keys of its own mapping stand: behind the dash, where there is one.
    fn keys_at(&self) -> usize {
        let behind = self.body.strip_prefix('-').map_or(0, |rest| self.body.len() - rest.trim_start().len());
        self.indent + if self.is_item() { behind } else { 0 }
    }

    /// Key and value, where it has both.
    fn pair(&self) -> Option<(&str, &str)> {
        let (key, value) = self.body.trim_start_matches("- ").split_once(": ")?;
        let value = value.split(" #").next().unwrap_or("").trim();
        (!value.is_empty()).then_some((key, value))
    }
}

enum Misplaced<'a> {
    /// The line itself.
    Deeper(Diagnostic),
    /// A line above it.
    Above(Diagnostic, &'a Line<'a>),
}
use Misplaced::{Above, Deeper};

/// `kind geometry`, `module:3 mm`.
fn without_colon(line: &Line) -> Diagnostic {
    let shown = line.body.trim_start_matches("- ");
    match shown.split_once(':') {
        Some((key, value)) if !value.starts_with(' ') => {
            let message = format!("a space is missing behind the `:` of {}", quote(shown));
            Diagnostic::new(message).help(format!("write {}", quote(&format!("{key}: {value}"))))
        }
        _ => {
            let message = format!("{} has no `:` between a name and its value", quote(shown));
            let (key, value) = shown.split_once([' ', '=']).unwrap_or((shown, "…"));
            let value = value.trim_start_matches(['=', ' ']);
            Diagnostic::new(message).help(format!("write {}", quote(&format!("{key}: {value}"))))
        }
    }
}

/// A `:` where none can stand: a second one in a line, a line below one that has its value already or has no `:` itself.
fn value_below_value<'a>(line: &Line, before: &'a [Line<'a>], place: Place) -> Option<Misplaced<'a>> {
    let column = place.offset.saturating_sub(line.offset + line.indent);
    if let Some((key, value)) = line.pair().filter(|_| line.body.get(..column).is_some_and(|left| left.contains(": ")))
    {
        let message = format!("a second `:` stands in the value of {}", quote(key));
        if value.ends_with('}') && !value.contains('{') {
            let message = format!("a `{{` is missing in the value of {}", quote(key));
            return Some(Deeper(Diagnostic::new(message).help(format!("write `{key}: {{ {value}`"))));
        }
        return Some(Deeper(Diagnostic::new(message).help(format!("put the text in quotes: `{key}: \"{value}\"`"))));
    }
    let above = before.last()?;
    if !above.body.contains(": ") && !above.body.ends_with(':') && !above.is_item() {
        return Some(Above(without_colon(above), above));
    }
    let (key, _) = above.pair().filter(|_| line.indent > above.keys_at())?;
    let message =
        format!("{} is indented further than {} above it, which has its value already", quote(line.body), quote(key));
    Some(Deeper(Diagnostic::new(message).help(format!("indent it by {} spaces, as {}", above.keys_at(), quote(key)))))
}

/// The first item of a list whose second one, the line, has a dash: it stands below the name of the list, and no other list does.
fn first_without_dash<'a>(line: &Line, before: &'a [Line<'a>]) -> Option<(Diagnostic, &'a Line<'a>)> {
    let deep = before.iter().rev().take_while(|above| above.indent >= line.indent);
    let (owner, items) = before.split_at(before.len() - deep.count());
    let (owner, first) = (owner.last()?, items.first()?);
    let is_list = line.is_item() && owner.body.ends_with(':') && items.iter().all(|item| !item.is_item());
    if !is_list || ![line.indent, line.keys_at()].contains(&first.indent) {
        return None;
    }
    let message =
        format!("{} has no dash, and the list that begins with it goes on in line {}", quote(first.body), line.number);
    let deeper = if items.len() > 1 && first.indent == line.indent {
        format!(", and indent what belongs to it by {} spaces", line.keys_at())
    } else {
        String::new()
    };
    Some((Diagnostic::new(message).help(format!("write {}{deeper}", quote(&format!("- {}", first.body)))), first))
}

fn spaces(count: usize) -> String {
    if count == 1 { "1 space".to_owned() } else { format!("{count} spaces") }
}

/// A line that belongs to no level that is open above it.
fn between_levels(line: &Line, before: &[Line]) -> Option<Diagnostic> {
    let mut levels: Vec<(usize, &Line)> = Vec::new();
    let mut least = usize::MAX;
    for above in before.iter().rev() {
        for level in [above.keys_at(), above.indent] {
            if level < least {
                levels.push((level, above));
                least = level;
            }
        }
    }
    // A list goes on with dashes.
    let item = levels.iter().find(|(level, above)| *level == line.indent && above.is_item() && above.indent == *level);
    if let Some((_, above)) = item.filter(|_| !line.is_item()) {
        let message = format!("{} has no dash, and stands in a list", quote(line.body));
        let help = format!(
            "write {} for another item, or indent it by {} spaces if it belongs to the item in line {}",
            quote(&format!("- {}", line.body)),
            above.keys_at(),
            above.number
        );
        return Some(Diagnostic::new(message).help(help));
    }
    if levels.iter().any(|(level, _)| *level == line.indent) {
        if line.is_item() {
            let message = format!("{} is an item of a list, and stands among names", quote(line.body));
            return Some(Diagnostic::new(message).help("indent it further than the name that the list belongs to"));
        }
        return None;
    }
    let below = levels.iter().find(|(level, _)| *level < line.indent);
    let above = levels.iter().rev().find(|(level, _)| *level > line.indent);
    let near = [below, above].into_iter().flatten();
    let levels: Vec<String> = near.map(|(level, _)| level.to_string()).collect();
    let message = format!(
        "{} is indented by {}, which no line above it that it could belong to is",
        quote(line.body),
        spaces(line.indent)
    );
    let help = format!("indent it by {} spaces", alternatives(levels.iter().map(String::as_str)).replace('`', ""));
    Some(Diagnostic::new(message).help(help))
}

/// What is not closed, each with its place.
struct Opened {
    /// The innermost one.
    bracket: Option<(char, usize)>,
    quote: Option<(char, usize)>,
}

/// What is open before `end`.
fn open_at(text: &str, end: usize) -> Opened {
    let (mut open, mut quote, mut before, mut comment) = (Vec::new(), None, '\n', false);
    for (offset, c) in text.char_indices().take_while(|(offset, _)| *offset < end) {
        match (quote, c) {
            (_, '\n') => comment = false,
            _ if comment => {}
            // Behind a backslash it is a part of the text.
            (Some(('"', _)), '"') if before == '\\' => {}
            (Some((mark, _)), _) => quote = quote.filter(|_| mark != c),
            (None, '#') if before.is_whitespace() => comment = true,
            // In the middle of a word it is an apostrophe.
            (None, '"' | '\'') if !before.is_alphanumeric() => quote = Some((c, offset)),
            (None, '{' | '[') => open.push((c, offset)),
            (None, '}' | ']') => drop(open.pop()),
            _ => {}
        }
        // Two of them are one that is meant.
        before = if (before, c) == ('\\', '\\') { ' ' } else { c };
    }
    Opened { bracket: open.pop(), quote }
}
