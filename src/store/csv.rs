//! Tables as CSV: one header line with the units, then the rows, numbers with every digit that tells them apart.
//!
//! An empty cell is a number that does not apply. Must not know: where the text goes.

use std::io;

use crate::table::data::{Cell, Table};
use crate::table::schema::Column;

/// A column as a reader sees it: `torque [N m]`.
#[must_use]
pub fn heading(column: &Column) -> String {
    if column.unit.is_empty() { column.name.clone() } else { format!("{} [{}]", column.name, column.unit) }
}

/// Writes the rows and columns given by index, in their order.
///
/// # Errors
/// When `sink` cannot be written to.
pub fn write(table: &Table, columns: &[usize], rows: &[usize], sink: &mut dyn io::Write) -> io::Result<()> {
    let headings = columns.iter().map(|&column| heading(&table.schema().columns[column]));
    let cells = |&row: &usize| columns.iter().map(move |&column| Some(table.columns()[column].cell(row)));
    write_cells(headings, rows.iter().map(cells), sink)
}

/// Writes cells row by row; `None` is an empty cell too.
///
/// # Errors
/// When `sink` cannot be written to.
pub fn write_cells(
    headings: impl Iterator<Item = String>,
    rows: impl Iterator<Item = impl Iterator<Item = Option<Cell>>>,
    sink: &mut dyn io::Write,
) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(sink);
    writer.write_record(headings.collect::<Vec<_>>())?;
    for row in rows {
        writer.write_record(row.map(|cell| match cell {
            None => String::new(),
            Some(Cell::Float(value)) if value.is_nan() => String::new(),
            Some(cell) => cell.to_string(),
        }))?;
    }
    writer.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::parquet::tests::everything;

    #[test]
    fn cells_are_quoted_where_needed_and_numbers_read_back() {
        let table = everything(4);
        let mut bytes = Vec::new();
        write(&table, &[0, 2, 4], &[0, 1, 2, 3], &mut bytes).unwrap();
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        assert_eq!(reader.headers().unwrap(), ["design", "te [um]", "inside"].as_slice());
        let records: Vec<_> = reader.records().map(Result::unwrap).collect();
        assert_eq!(records.len(), 4);
        for (row, record) in records.iter().enumerate() {
            assert_eq!(record[0], table.texts("design")[row]);
            let te = table.floats("te")[row];
            let read = if record[1].is_empty() { f64::NAN } else { record[1].parse().unwrap() };
            assert!(te.to_bits() == read.to_bits() || (te.is_nan() && read.is_nan()), "{te} {read}");
        }
    }
}
