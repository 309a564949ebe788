//! The table of verdicts for a terminal.
//!
//! Must not know: whether there is a terminal, or its colours; the width is given.

use std::fmt::Write;

use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, LineStyle, Table as Drawn, presets};

use super::ReportError;
use super::comparison;
use super::verdict::{self, Row};
use studygraph::table::data::Table;

/// Below this the columns would break their numbers.
const NARROWEST_TABLE: u16 = 96;

/// The verdicts as a table (as a list where that would not fit), then every reason with its proof.
///
/// No line is longer than `width`, 60 at least.
///
/// # Errors
/// When the table is of another shape.
pub fn verdicts(table: &Table, width: u16) -> Result<String, ReportError> {
    let rows = verdict::rows(table)?;
    let width = width.max(60);
    let mut text = if width < NARROWEST_TABLE { listed(&rows, width) } else { tabulated(&rows, width) };
    text.push('\n');
    for row in &rows {
        let parts = [&row.because, &row.proof, &row.failing, &row.rounding, &row.note];
        for (index, part) in parts.into_iter().filter(|part| !part.is_empty()).enumerate() {
            let lead = if index == 0 { format!("{:>4}  ", row.number) } else { " ".repeat(6) };
            wrap(&mut text, &lead, part, usize::from(width));
        }
    }
    Ok(text)
}

/// The comparisons as a list, each with its reason; what needs attention first.
///
/// No line is longer than `width`, 60 at least.
///
/// # Errors
/// When the table is of another shape.
pub fn comparisons(table: &Table, width: u16) -> Result<String, ReportError> {
    let mut rows = comparison::rows(table)?;
    rows.sort_by_key(comparison::Row::rank);
    let (mut text, width) = (String::new(), usize::from(width.max(60)));
    for row in &rows {
        let what = if row.label.is_empty() { &row.cell } else { &row.label };
        let apart = if row.relative.is_empty() { &row.difference } else { &row.relative };
        let allowed = if row.tolerance.is_empty() { String::new() } else { format!("; {}", row.tolerance) };
        let words = format!("{}: {what}: {} beside {}, {apart}{allowed}", row.verdict, row.value, row.reference);
        wrap(&mut text, &format!("{:>4}  ", row.sign), &words, width);
        if !row.because.is_empty() {
            wrap(&mut text, "      ", &row.because, width);
        }
    }
    Ok(text)
}

fn what(row: &Row) -> &str {
    if row.label.is_empty() { &row.cell } else { &row.label }
}

fn difference(row: &Row) -> &str {
    if row.relative.is_empty() { &row.difference } else { &row.relative }
}

fn tabulated(rows: &[Row], width: u16) -> String {
    let mut drawn = Drawn::new();
    let style = presets::UTF8_HORIZONTAL_ONLY.row_separator(LineStyle::none());
    drawn.load_style(style).set_content_arrangement(ContentArrangement::Dynamic).set_width(width);
    drawn.force_no_tty();
    drawn.set_header(["#", "where", "what", "published", "computed", "difference", "verdict"]);
    for row in rows {
        let verdict = format!("{} {}", row.sign, row.verdict);
        let number = row.number.to_string();
        drawn.add_row([&number, &row.location, what(row), &row.published, &row.computed, difference(row), &verdict]);
    }
    // Numbers and verdicts stay whole; words give way.
    for column in [0, 3, 4, 5, 6] {
        if let Some(drawn) = drawn.column_mut(column) {
            drawn.set_constraint(ColumnConstraint::ContentWidth);
            drawn.set_cell_alignment(if column == 6 { CellAlignment::Left } else { CellAlignment::Right });
        }
    }
    let mut text = drawn.trim_fmt();
    text.push('\n');
    text
}

fn listed(rows: &[Row], width: u16) -> String {
    let mut text = String::new();
    for row in rows {
        let place = if row.location.is_empty() { String::new() } else { format!(" ({})", row.location) };
        let lead = format!("{:>4}  ", row.number);
        wrap(&mut text, &lead, &format!("{} {}: {}{place}", row.sign, row.verdict, what(row)), usize::from(width));
        let apart = if difference(row).is_empty() { String::new() } else { format!(", {}", difference(row)) };
        let values = format!("{} published, {} computed{apart}", row.published, row.computed);
        let values = if row.is_claim { row.computed.clone() } else { values };
        wrap(&mut text, &" ".repeat(6), &values, usize::from(width));
    }
    text
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
