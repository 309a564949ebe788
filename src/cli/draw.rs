//! How a message about a study is drawn: the line it is about, the place in it, what to write instead.
//!
//! On a terminal with colours and a frame, elsewhere as one plain line that tools can read. Must not know: what the
//! message means.

use std::io::{IsTerminal, Write};

use miette::{GraphicalReportHandler, LabeledSpan, MietteDiagnostic, NamedSource, Report};

use crate::study::LoadError;

/// Writes the message to standard error.
pub fn invalid_study(error: &LoadError) {
    let mut stderr = std::io::stderr().lock();
    // Nothing sensible is left to do when standard error itself is gone.
    let _ = if stderr.is_terminal() { writeln!(stderr, "{}", framed(error)) } else { writeln!(stderr, "{error}") };
}

fn framed(error: &LoadError) -> String {
    let diagnostic = &error.diagnostic;
    let mut drawn = MietteDiagnostic::new(diagnostic.message.clone());
    if let Some(help) = &diagnostic.help {
        drawn = drawn.with_help(help.clone());
    }
    if let Some(place) = diagnostic.place {
        drawn = drawn.with_label(LabeledSpan::underline(place.offset..place.offset + place.length.max(1)));
    }
    let source = NamedSource::new(error.path.display().to_string(), error.text.clone());
    let report = Report::new(drawn).with_source_code(source);
    let mut text = String::new();
    let handler = GraphicalReportHandler::new().with_links(false);
    match handler.render_report(&mut text, report.as_ref()) {
        Ok(()) => text,
        Err(_) => error.to_string(),
    }
}
