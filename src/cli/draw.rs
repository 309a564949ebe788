//! How a message about a study is drawn: the line it is about, the place in it, what to write instead.
//!
//! On a terminal with colours and a frame, elsewhere as one plain line that tools can read. Must not know: what the
//! message means.

use std::io::{IsTerminal, Write};
use std::ops::Range;
use std::path::Path;

use miette::{
    GraphicalReportHandler, LabeledSpan, MietteDiagnostic, MietteError, MietteSpanContents, NamedSource, Report,
    SourceCode, SourceSpan, SpanContents,
};

use declare::error::Diagnostic;
use declare::text::{is_invisible, visible};
use studygraph::study::LoadError;

/// Writes the message to standard error.
pub fn invalid_study(error: &LoadError) {
    let mut stderr = std::io::stderr().lock();
    // Nothing sensible is left to do when standard error itself is gone.
    let _ = if stderr.is_terminal() {
        writeln!(stderr, "{}", framed(error))
    } else {
        writeln!(stderr, "{}", visible(&error.to_string()))
    };
}

fn framed(error: &LoadError) -> String {
    let one =
        |found| framed_one(&error.path, &error.text, found).unwrap_or_else(|| visible(&error.to_string()).into_owned());
    let told: String = error.told().map(one).collect();
    told + &error.more().map_or_else(String::new, |more| more + "\n")
}

/// None where it cannot be drawn.
fn framed_one(path: &Path, text: &str, diagnostic: &Diagnostic) -> Option<String> {
    let mut drawn = MietteDiagnostic::new(visible(&diagnostic.message));
    if let Some(help) = &diagnostic.help {
        drawn = drawn.with_help(visible(help));
    }
    let place = diagnostic.place.map(|place| place.offset..place.offset + place.length.max(1));
    let (shown, place, cut) = shortened(&masked(text), place.as_ref());
    if let Some(place) = place {
        drawn = drawn.with_label(LabeledSpan::underline(place));
    }
    let source = Shown { source: NamedSource::new(visible(&path.display().to_string()), shown), cut };
    let report = Report::new(drawn).with_source_code(source);
    let mut text = String::new();
    let handler = GraphicalReportHandler::new().with_links(false);
    handler.render_report(&mut text, report.as_ref()).ok().map(|()| text)
}

/// A text of which lines are shortened, with the columns that it had.
struct Shown {
    source: NamedSource<String>,
    /// By how many bytes the line of the place begins later \[-\].
    cut: usize,
}

impl SourceCode for Shown {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        behind: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let found = self.source.read_span(span, before, behind)?;
        // What begins with a line begins at its first column.
        let column = if found.column() > 0 { found.column() + self.cut } else { 0 };
        let name = found.name().unwrap_or_default().to_owned();
        let (data, span, line, lines) = (found.data(), *found.span(), found.line(), found.line_count());
        Ok(Box::new(MietteSpanContents::new_named(name, data, span, line, column, lines)))
    }
}

/// The longest line that is shown whole, and how much of a longer one is shown on either side of the place \[bytes\].
const LONGEST: usize = 120;
const BESIDE: usize = 50;
/// Where something is left out.
const LEFT_OUT: &str = "…";

/// The text with no more of long lines than their beginning, or than what is about the place: a list of 500 values is one line. With it, where the
/// place is then, and by how many bytes its line begins later.
fn shortened(text: &str, place: Option<&Range<usize>>) -> (String, Option<Range<usize>>, usize) {
    let (mut shown, mut now, mut cut) = (String::with_capacity(text.len()), place.cloned(), 0);
    let mut begin = 0;
    for line in text.split_inclusive('\n') {
        let end = begin + line.len();
        let words = line.trim_end_matches(['\n', '\r']);
        let here = place.filter(|place| place.start >= begin && (place.start < end || end == text.len()));
        let (from, to) = match here {
            _ if words.len() <= LONGEST => (0, words.len()),
            None => (0, words.floor_char_boundary(LONGEST)),
            Some(place) => {
                let from = words.floor_char_boundary((place.start - begin).saturating_sub(BESIDE));
                // Of a long place too.
                let to = (place.end - begin).min(place.start - begin + BESIDE) + BESIDE;
                (from, words.floor_char_boundary(to.min(words.len())))
            }
        };
        let mark = if from > 0 { LEFT_OUT } else { "" };
        if let Some(place) = here {
            let start = shown.len() + mark.len() + place.start - begin - from;
            let length = if words.len() <= LONGEST {
                place.len()
            } else {
                place.len().min((begin + to).saturating_sub(place.start))
            };
            (now, cut) = (Some(start..start + length.max(1)), from.saturating_sub(mark.len()));
        }
        shown.push_str(mark);
        shown.push_str(&words[from..to]);
        shown.push_str(if to < words.len() { LEFT_OUT } else { "" });
        shown.push_str(&line[words.len()..]);
        begin = end;
    }
    (shown, now, cut)
}

/// The text with a mark for every byte of what cannot be seen or would steer the terminal, so that places in it stay.
fn masked(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if is_invisible(c) && !matches!(c, '\n' | '\r' | '\t') {
            shown.extend(std::iter::repeat_n('?', c.len_utf8()));
        } else {
            shown.push(c);
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;
    use declare::error::Place;

    fn drawn(text: &str, word: &str) -> String {
        let offset = text.find(word).expect("it is there");
        let line = text[..offset].matches('\n').count() + 1;
        let column = text[..offset].chars().rev().take_while(|c| *c != '\n').count() + 1;
        let place = Place { line, column, offset, length: word.len() };
        let framed =
            framed_one(Path::new("a.yaml"), text, &Diagnostic::new("wrong").at(place)).expect("it can be drawn");
        assert!(framed.contains(&format!("[a.yaml:{line}:{column}]")), "{framed}");
        framed
    }

    /// Of a list on one line no more is shown than what is about the place, which keeps its column, and of its neighbours their beginnings.
    #[test]
    fn long_lines_are_shortened_and_places_stay() {
        let values: Vec<String> = (0..500).map(|at| format!("{at} um")).collect();
        let list = format!("deviations: [{}]", values.join(", "));
        let text = format!("first: line\n  {list}\n  mesured: x\n  {list}\nlast: one\n");
        for word in ["mesured", "251 um", "deviations", "499 um"] {
            let framed = drawn(&text, word);
            assert!(framed.lines().all(|line| line.chars().count() < 220), "{framed}");
            assert!(framed.contains(word) && framed.contains('…') && framed.contains("^^^^^^"), "{framed}");
        }
        // What is short stays as it is, without an end of its line too.
        for text in ["a: 1\nb: \u{e4}, c\n", "a: 1\nb: \u{e4}, c"] {
            assert_eq!(shortened(text, Some(&(5..6))), (text.to_owned(), Some(5..6), 0));
            assert!(drawn(text, "b").contains("b: ä, c"));
        }
        let wide = format!("b: {}\n", "ä".repeat(300));
        assert!(drawn(&wide, "ääääää").lines().all(|line| line.chars().count() < 220));
        assert_eq!(shortened(&text, None).1, None);
    }
}
