//! The table of verdicts for a terminal.
//!
//! Must not know: whether there is a terminal, or its colours; the width is given.

use std::fmt::Write;

use comfy_table::{CellAlignment, ContentArrangement, Table as Drawn, presets};

use super::{ReportError, verdict};
use crate::table::data::Table;

/// The verdicts as a table, then every reason with its proof; no line is longer than `width`, 60 at least.
///
/// # Errors
/// When the table is of another shape.
pub fn verdicts(table: &Table, width: u16) -> Result<String, ReportError> {
    let rows = verdict::rows(table)?;
    let width = width.max(60);
    let mut drawn = Drawn::new();
    drawn
        .load_style(presets::UTF8_HORIZONTAL_ONLY)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(width);
    drawn.force_no_tty();
    drawn.set_header(["#", "where", "what", "published", "computed", "difference", "verdict"]);
    for row in &rows {
        let what = if row.label.is_empty() { &row.cell } else { &row.label };
        let difference = if row.relative.is_empty() { &row.difference } else { &row.relative };
        let verdict = format!("{} {}", row.sign, row.verdict);
        drawn.add_row([
            &row.number.to_string(),
            &row.location,
            what,
            &row.published,
            &row.computed,
            difference,
            &verdict,
        ]);
    }
    for column in [0, 3, 4, 5] {
        if let Some(column) = drawn.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let mut text = drawn.trim_fmt();
    text.push('\n');
    for row in &rows {
        let parts = [&row.because, &row.proof, &row.failing, &row.note];
        for (index, part) in parts.into_iter().filter(|part| !part.is_empty()).enumerate() {
            let lead = if index == 0 { format!("{:>4}  ", row.number) } else { " ".repeat(6) };
            wrap(&mut text, &lead, part, usize::from(width));
        }
    }
    Ok(text)
}

/// Sets words into lines of at most `width` characters behind `lead`; further lines are indented as far.
fn wrap(text: &mut String, lead: &str, words: &str, width: usize) {
    let indent = lead.chars().count();
    let mut line = lead.to_owned();
    let mut used = indent;
    for word in words.split(' ') {
        let length = word.chars().count();
        if used > indent && used + 1 + length > width {
            let _ = writeln!(text, "{}", line.trim_end());
            line = " ".repeat(indent);
            used = indent;
        }
        if used > indent {
            line.push(' ');
            used += 1;
        }
        line.push_str(word);
        used += length;
    }
    let _ = writeln!(text, "{}", line.trim_end());
}
