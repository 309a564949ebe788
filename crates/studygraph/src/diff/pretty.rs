//! A comparison for a terminal.
//!
//! Must not know: whether there is a terminal, or its colours; the width is given.

use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, LineStyle, Table as Drawn, presets};

use super::model::{Comparison, Difference, StageDiff, TableDiff};
use super::words;

/// Of the worst rows, so many: every table has some.
const SHOWN: usize = 3;

/// The whole comparison; no line is longer than `width`, 60 at least, but where one word is.
#[must_use]
pub fn text(comparison: &Comparison, width: u16) -> String {
    let width = width.max(60);
    let mut page = Page { text: String::new(), width: usize::from(width) };
    page.wrap("", &format!("{} → {}", comparison.before, comparison.after));
    if !comparison.damaged.is_empty() {
        page.blank();
        page.wrap("", &words::damages(comparison));
        for damage in &comparison.damaged {
            page.wrap("  ! ", &words::damage(damage));
        }
    }
    if !comparison.verdicts.is_empty() {
        page.blank();
        page.wrap("", &format!("{} flipped", words::count(comparison.verdicts.len(), "verdict")));
        for flip in &comparison.verdicts {
            let sign = if flip.needs_attention { "!" } else { "≠" };
            page.wrap(&format!("  {sign} "), &format!("{}: {}", words::flip(flip), words::entry(flip)));
            page.wrap("      ", &format!("{}.{}: {}", flip.study, flip.stage, words::numbers(flip)));
        }
    }
    if comparison.studies.is_empty() {
        page.blank();
        comparison.problems.iter().for_each(|problem| page.wrap("  ! ", problem));
    }
    for study in &comparison.studies {
        page.blank();
        page.wrap("", &format!("{} {}: {}", study.state.sign(), study.name, words::sum(study)));
        for remark in words::remarks(study) {
            page.wrap("  ", &remark);
        }
        for stage in words::told(study) {
            page.stage(stage);
        }
        for sentence in words::brief(study) {
            page.wrap("  = ", &sentence);
        }
    }
    for remark in &comparison.remarks {
        page.blank();
        page.wrap("", remark);
    }
    page.blank();
    page.wrap("", &words::verdict(comparison));
    page.text
}

struct Page {
    text: String,
    width: usize,
}

impl Page {
    fn blank(&mut self) {
        self.text.push('\n');
    }

    fn stage(&mut self, stage: &StageDiff) {
        self.wrap("  ", &format!("{} {} ({}): {}", stage.state.sign(), stage.name, stage.kind, words::state(stage)));
        for reason in words::reasons(&stage.why) {
            self.wrap("      why: ", &reason);
        }
        // What is new or gone as a whole has been said.
        if stage.state <= Difference::Changed {
            stage.tables.iter().filter(|table| table.state != Difference::Same).for_each(|table| self.table(table));
        }
    }

    fn table(&mut self, table: &TableDiff) {
        let what = format!("{} {}: {}; {}", table.state.sign(), table.name, table.state.word(), words::rows(table));
        self.wrap("    ", &what);
        if !table.by_values && table.state == Difference::Changed {
            self.wrap("      ", &format!("compared by content hash alone: it {}", table.note));
        } else if !table.note.is_empty() {
            self.wrap("      ", &table.note);
        }
        for change in &table.schema {
            let values = match (change.before.as_str(), change.after.as_str()) {
                ("", after) => after.to_owned(),
                (before, "") => before.to_owned(),
                (before, after) => format!("{before} → {after}"),
            };
            self.wrap("      ", &format!("column {}: {}: {values}", change.column, change.what));
        }
        for (word, keys, all) in
            [("added", &table.added, table.rows_added), ("removed", &table.removed, table.rows_removed)]
        {
            if all > 0 {
                self.wrap(&format!("      {word}: "), &words::keys(keys, all));
            }
        }
        if let Some(curves) = words::curves(table) {
            return self.wrap("      ", &curves);
        }
        self.columns(table);
        if !table.worst.is_empty() && table.columns.iter().any(|column| column.compared > 1) {
            self.worst(table);
        }
    }

    fn columns(&mut self, table: &TableDiff) {
        let rows: Vec<[String; 5]> = table
            .columns
            .iter()
            .map(|column| {
                let relative = column.largest_relative.as_ref();
                // Words have no distance: what the first of them was and is.
                let largest = match (&column.largest_absolute, column.shown()) {
                    (Some(largest), _) => words::difference(largest.difference),
                    (None, shown) => shown.map_or_else(|| "–".to_owned(), words::change),
                };
                [
                    words::column(&column.name, &column.unit),
                    words::changed(column),
                    largest,
                    relative.map_or_else(|| "–".to_owned(), |largest| words::relative(largest.difference)),
                    column.shown().map_or_else(String::new, |shown| words::key(&shown.key)),
                ]
            })
            .collect();
        self.drawn(["column", "changed", "largest", "relative", "largest where"], &rows);
    }

    fn worst(&mut self, table: &TableDiff) {
        let rows: Vec<[String; 5]> = table
            .worst
            .iter()
            .take(SHOWN)
            .map(|worst| {
                let (before, after) = words::pair(&worst.before, &worst.after);
                let difference = worst.difference.map_or_else(|| "–".to_owned(), words::difference);
                [words::column(&worst.column, &worst.unit), before, after, difference, words::key(&worst.key)]
            })
            .collect();
        self.drawn(["worst rows", "before", "after", "difference", "where"], &rows);
    }

    fn drawn(&mut self, header: [&str; 5], rows: &[[String; 5]]) {
        if rows.is_empty() {
            return;
        }
        let indent = 6;
        let mut drawn = Drawn::new();
        let style = presets::UTF8_HORIZONTAL_ONLY.row_separator(LineStyle::none());
        drawn.load_style(style).set_content_arrangement(ContentArrangement::Dynamic);
        drawn.set_width(u16::try_from(self.width - indent).unwrap_or(u16::MAX)).force_no_tty();
        drawn.set_header(header);
        for row in rows {
            drawn.add_row(row);
        }
        // Numbers stay whole while they are short; words give way.
        for column in 1..4 {
            let longest = rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
            if let Some(drawn) = drawn.column_mut(column) {
                drawn.set_cell_alignment(CellAlignment::Right);
                if longest <= 16 {
                    drawn.set_constraint(ColumnConstraint::ContentWidth);
                }
            }
        }
        for line in drawn.trim_fmt().lines() {
            self.text += &format!("{}{line}\n", " ".repeat(indent));
        }
    }

    /// Sets words into lines behind `lead`; further lines are indented as far.
    fn wrap(&mut self, lead: &str, words: &str) {
        let indent = lead.chars().count();
        let (mut line, mut used) = (lead.to_owned(), indent);
        for word in words.split_whitespace() {
            let length = word.chars().count();
            if used > indent && used + 1 + length > self.width {
                self.text += line.trim_end();
                self.text.push('\n');
                line = " ".repeat(indent);
                used = indent;
            }
            if used > indent {
                line.push(' ');
                used += 1;
            }
            line += word;
            used += length;
        }
        self.text += line.trim_end();
        self.text.push('\n');
    }
}
