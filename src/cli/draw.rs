//! How a message about a study is drawn: the line it is about, the place in it, what to write instead.
//!
//! On a terminal with colours and a frame, elsewhere as one plain line that tools can read. Must not know: what the
//! message means.

use std::io::{IsTerminal, Write};

use miette::{GraphicalReportHandler, LabeledSpan, MietteDiagnostic, NamedSource, Report};

use super::progress::{is_hidden, plain};
use declare::error::Diagnostic;
use studygraph::study::LoadError;

/// Writes the message to standard error.
pub fn invalid_study(error: &LoadError) {
    let mut stderr = std::io::stderr().lock();
    // Nothing sensible is left to do when standard error itself is gone.
    let _ = if stderr.is_terminal() {
        writeln!(stderr, "{}", framed(error))
    } else {
        writeln!(stderr, "{}", plain(&error.to_string()))
    };
}

fn framed(error: &LoadError) -> String {
    let told: String = error.told().map(|found| framed_one(error, found)).collect();
    told + &error.more().map_or_else(String::new, |more| more + "\n")
}

fn framed_one(error: &LoadError, diagnostic: &Diagnostic) -> String {
    let mut drawn = MietteDiagnostic::new(plain(&diagnostic.message));
    if let Some(help) = &diagnostic.help {
        drawn = drawn.with_help(plain(help));
    }
    if let Some(place) = diagnostic.place {
        drawn = drawn.with_label(LabeledSpan::underline(place.offset..place.offset + place.length.max(1)));
    }
    let source = NamedSource::new(plain(&error.path.display().to_string()), masked(&error.text));
    let report = Report::new(drawn).with_source_code(source);
    let mut text = String::new();
    let handler = GraphicalReportHandler::new().with_links(false);
    match handler.render_report(&mut text, report.as_ref()) {
        Ok(()) => text,
        Err(_) => plain(&error.to_string()).into_owned(),
    }
}

/// The text with a mark for every byte that would steer the terminal, so that places in it stay.
fn masked(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if is_hidden(c) && c != '\r' {
            shown.extend(std::iter::repeat_n('?', c.len_utf8()));
        } else {
            shown.push(c);
        }
    }
    shown
}
