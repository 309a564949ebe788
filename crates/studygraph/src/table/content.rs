//! The digest of a table that need not be there as a whole: column by column, each in pieces.
//!
//! Must not know: where the pieces come from.

use super::data::{Data, Table};
use super::schema::{Column, Schema, Type};
use declare::digest::{Digest, Writer};

/// What is digested of a table: its schema and its values, without volatile columns.
pub struct Content {
    writer: Writer,
    rows: usize,
}

impl Content {
    #[must_use]
    pub fn new(schema: &Schema, rows: usize) -> Self {
        let mut writer = Writer::new("gearstudy 1 table content");
        schema.write(&mut writer);
        writer.count(rows);
        Self { writer, rows }
    }

    /// The values of a column follow, all rows of it; columns come in their order, and volatile ones not at all.
    pub fn begin(&mut self, column: &Column) {
        if column.kind == Type::Float {
            self.writer.begin_floats(self.rows);
        }
    }

    /// The next values of the column that was begun.
    pub fn add(&mut self, data: &Data) {
        let writer = &mut self.writer;
        match data {
            Data::Float(values) => {
                writer.more_floats(values);
            }
            Data::Integer(values) => values.iter().for_each(|value| {
                writer.integer(*value);
            }),
            Data::Text(values) => values.iter().for_each(|value| {
                writer.text(value);
            }),
            Data::Flag(values) => values.iter().for_each(|value| {
                writer.flag(*value);
            }),
        }
    }

    #[must_use]
    pub fn finish(&self) -> Digest {
        self.writer.finish()
    }
}

impl Table {
    /// The digest of schema and values, without volatile columns.
    #[must_use]
    pub fn content_hash(&self) -> Digest {
        let mut content = Content::new(self.schema(), self.rows());
        for (column, data) in self.schema().columns.iter().zip(self.columns()).filter(|(column, _)| !column.volatile) {
            content.begin(column);
            content.add(data);
        }
        content.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: second way; the digest of a table is that of its pieces, wherever it is cut.
    #[test]
    fn pieces_have_the_digest_of_the_whole() {
        let columns = vec![
            Column::integer("number", "").key(),
            Column::float("value", "", "").allows_nan(),
            Column::float("seconds", "s", "").volatile(),
            Column::text("word", ""),
            Column::flag("flag", ""),
        ];
        let row = |at: usize| {
            let value = if at.is_multiple_of(9) { f64::NAN } else { 1.0 / at as f64 - 1.0 };
            vec![at.into(), value.into(), 0.5.into(), format!("{at}").into(), at.is_multiple_of(3).into()]
        };
        let table = Table::from_rows(Schema::new("t", "", columns), (1..=101).map(row).collect()).unwrap();
        for cuts in [vec![], vec![50], vec![0, 1, 7, 7, 100, 101]] {
            let borders: Vec<usize> = [0].into_iter().chain(cuts).chain([101]).collect();
            let mut content = Content::new(table.schema(), table.rows());
            for (column, data) in table.schema().columns.iter().zip(table.columns()) {
                if column.volatile {
                    continue;
                }
                content.begin(column);
                borders.windows(2).for_each(|ends| content.add(&data.slice(ends[0]..ends[1])));
            }
            assert_eq!(content.finish(), table.content_hash(), "{borders:?}");
        }
    }
}
