//! A comparison as Markdown, for a comment on a merge request.
//!
//! Must not know: who shows it. Every text of a study is escaped.

use super::model::{Comparison, Difference, StudyDiff, TableDiff};
use super::words;

/// The whole comparison.
#[must_use]
pub fn text(comparison: &Comparison) -> String {
    let mut text = format!("## {}\n\n", escaped(&words::verdict(comparison)));
    text += &format!("{} → {}\n", escaped(&comparison.before), escaped(&comparison.after));
    if !comparison.damaged.is_empty() {
        text += &format!("\n### {}\n\n", escaped(&words::damages(comparison)));
        for damage in &comparison.damaged {
            text += &format!("- {}\n", escaped(&words::damage(damage)));
        }
    }
    if !comparison.verdicts.is_empty() {
        text += "\n### Verdicts that flipped\n\n";
        let rows = comparison.verdicts.iter().map(|flip| {
            let sign = if flip.needs_attention { "**!**" } else { "≠" };
            let place = format!("{}.{}", flip.study, flip.stage);
            [
                sign.to_owned(),
                escaped(&words::flip(flip)),
                escaped(&words::entry(flip)),
                escaped(&words::numbers(flip)),
                escaped(&place),
            ]
        });
        text += &table(["", "Verdict", "What", "Numbers", "Where"], rows);
    }
    if comparison.studies.is_empty() {
        comparison.problems.iter().for_each(|problem| text += &format!("\n{}\n", escaped(problem)));
    }
    for study in &comparison.studies {
        text += &self::study(study);
    }
    for remark in &comparison.remarks {
        text += &format!("\n{}\n", escaped(remark));
    }
    text
}

fn study(study: &StudyDiff) -> String {
    let mut text =
        format!("\n### {} {}\n\n{}\n", study.state.sign(), escaped(&study.name), escaped(&words::sum(study)));
    let told = words::told(study);
    for sentence in words::remarks(study).into_iter().chain(words::brief(study)) {
        text += &format!("\n{}\n", escaped(&sentence));
    }
    if told.is_empty() {
        return text;
    }
    let rows = told.iter().map(|stage| {
        let why: Vec<String> = words::reasons(&stage.why).iter().map(|reason| escaped(reason)).collect();
        let state = format!("{} {}", stage.state.sign(), escaped(&words::state(stage)));
        [code(&stage.name), escaped(&stage.kind), state, why.join("<br>")]
    });
    text += "\n";
    text += &table(["Stage", "Kind", "State", "Why"], rows);
    for stage in told.iter().filter(|stage| stage.state <= Difference::Changed) {
        for table in stage.tables.iter().filter(|table| table.state != Difference::Same) {
            text += &of_table(table);
        }
    }
    text
}

fn of_table(diff: &TableDiff) -> String {
    let head = format!("{} {}: {}; {}", diff.state.sign(), code(&diff.name), diff.state.word(), words::rows(diff));
    let mut text = format!("\n#### {head}\n");
    if !diff.note.is_empty() {
        let lead = if diff.by_values { "" } else { "Compared by content hash alone: it " };
        text += &format!("\n{lead}{}\n", escaped(&diff.note));
    }
    if !diff.schema.is_empty() {
        let rows = diff.schema.iter().map(|change| {
            [code(&change.column), change.what.to_owned(), escaped(&change.before), escaped(&change.after)]
        });
        text += &format!("\n{}", table(["Column", "Change", "Before", "After"], rows));
    }
    for (word, keys, all) in [("Added", &diff.added, diff.rows_added), ("Removed", &diff.removed, diff.rows_removed)] {
        if all > 0 {
            text += &format!("\n{word}: {}\n", escaped(&words::keys(keys, all)));
        }
    }
    if let Some(curves) = words::curves(diff) {
        return text + &format!("\n{}\n", escaped(&curves));
    }
    if !diff.columns.is_empty() {
        let rows = diff.columns.iter().map(|column| {
            let largest = column.largest_absolute.as_ref();
            let relative = column.largest_relative.as_ref();
            [
                escaped(&words::column(&column.name, &column.unit)),
                words::changed(column),
                largest.map_or_else(|| "–".to_owned(), |largest| words::difference(largest.difference)),
                column.shown().map_or_else(String::new, |shown| escaped(&words::change(shown))),
                relative.map_or_else(|| "–".to_owned(), |largest| words::relative(largest.difference)),
                column.shown().map_or_else(String::new, |shown| escaped(&words::key(&shown.key))),
            ]
        });
        text += &format!(
            "\n{}",
            table(["Column", "Changed", "Largest", "Values there", "Relative", "Largest where"], rows)
        );
    }
    if !diff.worst.is_empty() {
        let rows = diff.worst.iter().map(|worst| {
            let (before, after) = words::pair(&worst.before, &worst.after);
            let difference = worst.difference.map_or_else(|| "–".to_owned(), words::difference);
            let column = words::column(&worst.column, &worst.unit);
            [escaped(&column), escaped(&before), escaped(&after), difference, escaped(&words::key(&worst.key))]
        });
        text += &format!("\n{}", table(["Worst rows", "Before", "After", "Difference", "Where"], rows));
    }
    text
}

fn table<const N: usize>(header: [&str; N], rows: impl Iterator<Item = [String; N]>) -> String {
    let mut text = format!("| {} |\n|{}\n", header.join(" | "), " --- |".repeat(N));
    for row in rows {
        text += &format!("| {} |\n", row.join(" | "));
    }
    text
}

/// A name; what is none for this program, but stands in a manifest, is text like any other.
fn code(name: &str) -> String {
    let plain = name.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | '.'));
    if plain && !name.is_empty() { format!("`{name}`") } else { escaped(name) }
}

/// A text that Markdown shows as it is, on one line.
pub fn escaped(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '\n' | '\r' => shown.push(' '),
            '<' => shown += "&lt;",
            '>' => shown += "&gt;",
            '&' => shown += "&amp;",
            '\\' | '`' | '*' | '_' | '[' | ']' | '|' | '#' | '~' | '!' | '@' => {
                shown.push('\\');
                shown.push(character);
            }
            other => shown.push(other),
        }
    }
    shown
}
