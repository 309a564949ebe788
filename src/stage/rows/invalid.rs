//! Rows without numbers, counted by their reason.
//!
//! Must not know: what makes a row invalid.

use std::collections::BTreeMap;

use super::counting::without_numbers;
use studygraph::table::columns::Columns;
use studygraph::table::data::{Table, TableError};

/// Reasons that are told apart.
pub const MOST_REASONS: usize = 1000;

/// Rows without numbers for one reason.
pub struct InvalidRow {
    pub reason: String,
    pub count: u64,
    pub example: String,
    pub row: String,
}

pub fn columns() -> Columns<InvalidRow> {
    Columns::new("invalid", "Why rows have no numbers, and how many.")
        .text("reason", "The reason, without its numbers.", |row: &InvalidRow| row.reason.clone())
        .key()
        .integer("rows", "How many rows have no numbers for it.", |row| row.count)
        .text("example", "The reason of the first of them.", |row| row.example.clone())
        .text("first_row", "The values of that row.", |row| row.row.clone())
}

/// All of them.
#[derive(Default)]
pub struct Invalid {
    /// Count, the first one's reason and its values, by the reason without its numbers.
    reasons: BTreeMap<String, (u64, String, String)>,
    others: u64,
}

impl Invalid {
    pub fn add(&mut self, reason: &str, row: impl Fn() -> String) {
        let kind = without_numbers(reason);
        if let Some((count, ..)) = self.reasons.get_mut(&kind) {
            *count += 1;
        } else if self.reasons.len() < MOST_REASONS {
            self.reasons.insert(kind, (1, reason.to_owned(), row()));
        } else {
            self.others += 1;
        }
    }

    pub fn count(&self) -> u64 {
        self.reasons.values().map(|(count, ..)| count).sum::<u64>() + self.others
    }

    /// The most frequent reason of them, and a row that has it.
    pub fn most_frequent(&self) -> Option<(&str, &str)> {
        let most = self.reasons.values().max_by_key(|(count, ..)| *count);
        most.map(|(_, reason, row)| (reason.as_str(), row.as_str()))
    }

    /// # Errors
    /// As [`Table::from_columns`].
    pub fn table(self) -> Result<Table, TableError> {
        let mut rows: Vec<InvalidRow> = self
            .reasons
            .into_iter()
            .map(|(reason, (count, example, row))| InvalidRow { reason, count, example, row })
            .collect();
        if self.others > 0 {
            let (reason, text) = ("others".to_owned(), String::new());
            rows.push(InvalidRow { reason, count: self.others, example: text.clone(), row: text });
        }
        columns().table(&rows)
    }
}
